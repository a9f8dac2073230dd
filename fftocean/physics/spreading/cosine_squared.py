"""Cosine-squared spreading, cos^2(theta)."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped


@dataclass(frozen=True, slots=True)
class CosineSquared:
    """
    D = (2/pi) cos^2(theta) in the front half, 0 behind; the same at every frequency  (Horvath
    2015).
    """

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `theta`, [1/rad]."""
        theta = wrapped(theta)
        density = np.where(np.abs(theta) < 0.5 * np.pi, np.square(np.cos(theta)), 0.0)
        shape = np.broadcast_shapes(np.shape(omega), density.shape)
        return np.broadcast_to((2.0 / np.pi) * density, shape)


SPREADINGS.add("cosine-squared", CosineSquared, Way(CosineSquared))
