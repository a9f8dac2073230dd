"""Mitsuyasu spreading, cos^2s(theta/2) with an exponent that depends on the wave age."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.limits import WIND_SPEED, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, relative, wrapped
from fftocean.physics.spreading.cosine_power import cosine_2s

SHARPEST = 1e4
"""
The exponent s at which the laws of the wind are held: 0.8 degrees wide, narrower than any swell
that was ever measured.
"""


@dataclass(frozen=True, slots=True)
class Mitsuyasu:
    """
    cos^2s(theta/2) with s = s_p x^5 up to the peak and s_p x^-2.5 beyond, x = omega/omega_p, s_p =
    11.5 (U/c_p)^-2.5.

    The older the sea (the slower the wind beside its waves), the narrower. c_p = g/omega_p.

    Args:
        speed: wind speed U10 [m/s].

    Raises:
        ParameterError: a wind speed out of its range.

    Source: Mitsuyasu et al., J. Phys. Oceanogr. 5 (1975), 750-760,
    doi:10.1175/1520-0485(1975)005<0750:OOTDSO>2.0.CO;2.
    """

    speed: float

    def __post_init__(self) -> None:
        keep_checked(self, speed=WIND_SPEED)

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """Return the exponent s [-] at `omega` [rad/s], at most `SHARPEST`, shaped like it."""
        # a hundredth makes s_p a million already
        inverse_age = max(self.speed * peak / GRAVITY, 1e-2)
        return peaked_exponent(relative(omega, peak), 11.5 * inverse_age**-2.5)

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        return cosine_2s(self.exponent(omega, peak), wrapped(theta))


def peaked_exponent(x: Real, s_peak: float) -> Real:
    """Return s_p x^5 below the peak, s_p x^-2.5 above."""
    # np.power, not **, which rounds a lone number otherwise than one in an array
    return np.minimum(
        s_peak
        * np.where(x <= 1.0, np.power(np.minimum(x, 1.0), 5.0), np.power(np.maximum(x, 1.0), -2.5)),
        SHARPEST,
    )


SPREADINGS.add("mitsuyasu", Mitsuyasu, Way(Mitsuyasu, speed=WIND_SPEED))
