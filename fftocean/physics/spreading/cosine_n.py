"""Cosine-power spreading of the front half, cos^n(theta)."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.limits import SPREADING_EXPONENT, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped
from fftocean.physics.spreading.cosine_power import cosine_2s


@dataclass(frozen=True, slots=True, kw_only=True)
class CosineN:
    """
    D = Gamma(n/2 + 1) / (sqrt(pi) Gamma((n + 1)/2)) cos^n(theta) in the front half, 0 behind. Not
    cos^2s(theta/2).

    n = 2 is `CosineSquared`, n = 0 the even half circle. Source: Pierson, Neumann & James 1955 (n =
    2); the general n in DNV-RP-C205.

    Args:
        n: exponent [-].

    Raises:
        ParameterError: an exponent out of its range.
    """

    n: float

    def __post_init__(self) -> None:
        keep_checked(self, n=SPREADING_EXPONENT)

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `theta`, [1/rad]."""
        _, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        front = np.abs(theta) < 0.5 * np.pi
        # cos^n(theta) is cos^2s(phi/2) with s = n/2 and phi = 2 theta, and d phi = 2 d theta.
        return np.where(
            front, 2.0 * cosine_2s(np.float64(0.5 * self.n), np.where(front, 2.0 * theta, 0.0)), 0.0
        )


SPREADINGS.add("cosine-n", CosineN, Way(CosineN, n=SPREADING_EXPONENT))
