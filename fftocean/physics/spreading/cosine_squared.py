"""Cosine-squared spreading, cos^2(theta)."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS


@dataclass(frozen=True, slots=True)
class CosineSquared:
    """
    D = (2/pi) cos^2(theta) in the front half, 0 behind; the same at every frequency  (Horvath
    2015).
    """

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `theta`, [1/rad]."""
        ahead = np.maximum(np.cos(np.asarray(theta, dtype=np.float64)), 0.0)
        shape = np.broadcast_shapes(np.shape(omega), ahead.shape)
        density: Real = np.broadcast_to((2.0 / np.pi) * np.square(ahead), shape)
        return density


SPREADINGS.add("cosine-squared", CosineSquared, Way(CosineSquared))
