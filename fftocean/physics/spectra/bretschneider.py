"""Bretschneider (ITTC) spectrum of given height and period."""

import math
from dataclasses import dataclass

from fftocean.arrays import Real, RealLike
from fftocean.limits import PERIOD, SIGNIFICANT_WAVE_HEIGHT, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spectra.base import SPECTRA
from fftocean.physics.spectra.gamma import GammaSpectrum, require_possible


@dataclass(frozen=True, slots=True, kw_only=True)
class Bretschneider:
    """
    The two-parameter spectrum of the ITTC: S = (5/16) Hs^2 omega_p^4 omega^-5 exp(-5/4
    (omega_p/omega)^4).

    Pierson-Moskowitz with height and period set free: any wind sea, developed or not. m0 = Hs^2/16
    in closed form.

    Args:
        hs: significant wave height [m].
        tp: peak period [s].

    Raises:
        ParameterError: a height or a period out of its range.

    Source: Bretschneider 1959; 15th ITTC (1978), S = A omega^-5 exp(-B omega^-4) with A = 173
    Hs^2/T1^4, B = 691/T1^4.
    Pinned by tests/physics/test_composed_spectra.py: 173, 691, and the closed m0.
    """

    hs: float
    tp: float

    def __post_init__(self) -> None:
        keep_checked(self, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD)
        require_possible(self.hs, self.tp)

    @classmethod
    def from_mean_period(cls, *, hs: float, t1: float) -> "Bretschneider":
        """
        Return the sea of mean period `t1` = 2 pi m0/m1 [s]: Tp = (5/4)^(1/4) Gamma(3/4) T1 = 1.296
        T1.

        Raises:
            ParameterError: a height or a period out of its range.
        """
        return cls(hs=hs, tp=PERIOD.check("t1", t1) * 1.25**0.25 * math.gamma(0.75))

    @classmethod
    def from_zero_crossing_period(cls, *, hs: float, tz: float) -> "Bretschneider":
        """
        Return the sea of zero-crossing period `tz` = 2 pi sqrt(m0/m2) [s]: Tp = (5 pi/4)^(1/4) Tz =
        1.408 Tz.

        Raises:
            ParameterError: a height or a period out of its range.
        """
        return cls(hs=hs, tp=PERIOD.check("tz", tz) * (1.25 * math.pi) ** 0.25)

    @property
    def peak(self) -> float:
        """omega_p [rad/s]."""
        return 2.0 * math.pi / self.tp

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        return GammaSpectrum(hs=self.hs, tp=self.tp)(omega)


SPECTRA.add(
    "bretschneider",
    Bretschneider,
    Way(Bretschneider, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD),
    Way(Bretschneider.from_mean_period, hs=SIGNIFICANT_WAVE_HEIGHT, t1=PERIOD),
    Way(Bretschneider.from_zero_crossing_period, hs=SIGNIFICANT_WAVE_HEIGHT, tz=PERIOD),
)
