"""Hasselmann spreading, cos^2s(theta/2) as fitted to the JONSWAP data."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.limits import WIND_SPEED, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, relative, wrapped
from fftocean.physics.spreading.cosine_power import cosine_2s


@dataclass(frozen=True, slots=True)
class Hasselmann:
    """
    cos^2s(theta/2) with s = 6.97 x^4.06 below x = omega/omega_p = 1.05 and 9.77 x^mu from there, mu
    = -2.33 - 1.45 (U/c_p - 1.17).

    The age of the wind (U/c_p, c_p = g/omega_p) sets how fast the short waves scatter, not how
    narrow the peak is. At 1.05 the published fit steps by 3 %; splitting at 1, as is often printed,
    makes that a step of 40 % at the very peak.

    Args:
        speed: wind speed U10 [m/s].

    Raises:
        ParameterError: a wind speed out of its range.

    Source: Hasselmann, Dunckel & Ewing, J. Phys. Oceanogr. 10 (1980), 1264-1280,
    doi:10.1175/1520-0485(1980)010<1264:DWSODJ>2.0.CO;2.
    """

    speed: float

    def __post_init__(self) -> None:
        keep_checked(self, speed=WIND_SPEED)

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """Return the exponent s [-] at `omega` [rad/s], shaped like it."""
        x = relative(omega, peak)
        mu = -2.33 - 1.45 * (self.speed * peak / GRAVITY - 1.17)
        return np.where(
            x < 1.05,
            6.97 * np.power(np.minimum(x, 1.05), 4.06),
            9.77 * np.power(np.maximum(x, 1.05), mu),
        )

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        return cosine_2s(self.exponent(omega, peak), wrapped(theta))


SPREADINGS.add("hasselmann", Hasselmann, Way(Hasselmann, speed=WIND_SPEED))
