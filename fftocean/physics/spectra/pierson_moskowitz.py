"""Pierson-Moskowitz spectrum of the fully developed sea."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.limits import (
    PEAK,
    PERIOD,
    PHILLIPS_CONSTANT,
    SIGNIFICANT_WAVE_HEIGHT,
    WIND_SPEED,
    keep_checked,
)
from fftocean.physics.kinds import Way
from fftocean.physics.spectra.base import SPECTRA, phillips_constant, relative
from fftocean.physics.spectra.wind import STILL_AIR, checked_wind

FULLY_DEVELOPED_PEAK = 0.877 / 1.026
"""
omega_p U10 / g of a sea that has stopped growing: 0.877 against U19.5 = 1.026 U10  (Pierson &
Moskowitz 1964).
"""


@dataclass(frozen=True, slots=True)
class PiersonMoskowitz:
    """
    S = alpha g^2 omega^-5 exp(-5/4 (omega_p/omega)^4), the fully developed sea  (Pierson &
    Moskowitz 1964).

    Args:
        peak: omega_p [rad/s].
        alpha: Phillips constant [-].

    Raises:
        ParameterError: a peak or alpha out of its range.
    """

    peak: float
    alpha: float = 8.1e-3

    def __post_init__(self) -> None:
        keep_checked(self, peak=PEAK, alpha=PHILLIPS_CONSTANT)

    @classmethod
    def from_wind(cls, *, speed: float) -> "PiersonMoskowitz":
        """
        Return the fully developed sea under a wind of `speed` (U10) [m/s]: omega_p = 0.877 g /
        (1.026 U10).

        Raises:
            ParameterError: a wind speed out of its range.
        """
        speed = checked_wind(speed)
        return cls(
            peak=FULLY_DEVELOPED_PEAK * GRAVITY / max(speed, STILL_AIR),
            alpha=8.1e-3 if speed else 0.0,
        )

    @classmethod
    def from_sea_state(cls, *, hs: float, tp: float) -> "PiersonMoskowitz":
        """
        Return the sea of significant wave height `hs` [m] and peak period `tp` [s]: alpha follows
        from m0 = alpha g^2 / (5 omega_p^4).

        Raises:
            ParameterError: a height or a period out of its range.
        """
        tp = PERIOD.check("tp", tp)
        return cls(peak=2.0 * np.pi / tp, alpha=phillips_constant(hs, tp, 0.2))

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        x = relative(omega, self.peak)
        # x^-4 at a tenth of the time of a power; inverted first, as x^4 may overflow
        x4 = np.square(np.square(1.0 / x))
        s: Real = self.alpha * GRAVITY**2 * self.peak**-5 * (x4 / x) * np.exp(-1.25 * x4)
        return s


SPECTRA.add(
    "pierson-moskowitz",
    PiersonMoskowitz,
    Way(PiersonMoskowitz.from_sea_state, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD),
    Way(PiersonMoskowitz.from_wind, speed=WIND_SPEED),
)
