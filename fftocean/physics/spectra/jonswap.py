"""JONSWAP spectrum of the fetch-limited sea."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.limits import (
    FETCH,
    PEAK,
    PEAK_ENHANCEMENT,
    PERIOD,
    PHILLIPS_CONSTANT,
    SIGNIFICANT_WAVE_HEIGHT,
    WIND_SPEED,
    keep_checked,
)
from fftocean.physics.kinds import Way
from fftocean.physics.spectra.base import SPECTRA, phillips_constant, relative
from fftocean.physics.spectra.growth import (
    GROWTH,
    WindSea,
    in_deep_water,
    peak_enhancement,
    shape_integral,
)
from fftocean.physics.spectra.wind import STILL_AIR, checked_wind, warn_of_short_fetch


@dataclass(frozen=True, slots=True)
class JONSWAP:
    """
    Pierson-Moskowitz spectrum with its peak raised by gamma^r  (Hasselmann et al. 1973).

    r = exp(-(omega - omega_p)^2 / (2 sigma^2 omega_p^2)), sigma = 0.07 up to the peak and 0.09
    beyond.

    Args:
        peak: omega_p [rad/s].
        alpha: Phillips constant [-].
        gamma: peak enhancement [-].

    Raises:
        ParameterError: a peak, alpha or gamma out of its range.
    """

    peak: float
    alpha: float = 8.1e-3
    gamma: float = 3.3

    def __post_init__(self) -> None:
        keep_checked(self, peak=PEAK, alpha=PHILLIPS_CONSTANT, gamma=PEAK_ENHANCEMENT)

    @classmethod
    def from_wind(
        cls, *, speed: float, fetch: float, gamma: float = 3.3, growth: str = "jonswap"
    ) -> "JONSWAP":
        """
        Return the sea raised by a wind of `speed` (U10) [m/s] over `fetch` [m] of deep water.

        The laws of growth, from which `growth` chooses, let a sea grow for ever, or nearly so. Here
        it grows by them until its energy is 99 % of the fully developed sea's; from there on what
        is missing of that energy falls as 1/F, the peak goes on falling by its law to the fully
        developed one, and gamma relaxes to 1 over the same stretch: the limit of a long fetch *is*
        Pierson-Moskowitz, never passed, and Hs(F) only rises. (The law of Young and Verhagen has a
        limit of its own.)

        Args:
            speed: wind speed 10 m above the sea [m/s]; 0 is an exactly flat sea, with a warning
                that says so.
            fetch: distance over which the wind blows [m].
            gamma: peak enhancement of the growing sea [-].
            growth: "jonswap" (Hasselmann et al. 1973), "kahma-calkoen" (1992) or "young-verhagen"
                (1996); see `physics.spectra.growth`.

        Raises:
            ParameterError: a value out of its range (`limits.WIND_SPEED`, `limits.FETCH`,
                `limits.PEAK_ENHANCEMENT`), or an unknown law.

        Pinned by tests/physics/test_growth.py and test_spectra.py.
        """
        speed = checked_wind(speed)
        fetch = FETCH.check("fetch", fetch)
        warn_of_short_fetch(speed, fetch)
        gamma = PEAK_ENHANCEMENT.check("gamma", gamma)
        return fetch_limited(speed, fetch, gamma, GROWTH.check("growth", growth))

    @classmethod
    def from_sea_state(cls, *, hs: float, tp: float, gamma: float | None = None) -> "JONSWAP":
        """
        Return the sea of significant wave height `hs` [m] and peak period `tp` [s], normalised
        exactly: 4 sqrt(m0) is `hs`.

        Without a `gamma` it is that of DNV-RP-C205 for such a sea, from 1 for long low waves to 5
        for short steep ones: exp(5.75 - 1.15 Tp/sqrt(Hs)).

        Raises:
            ParameterError: a value out of its range, or waves too steep to be (alpha > 1).
        """
        hs, tp = SIGNIFICANT_WAVE_HEIGHT.check("hs", hs), PERIOD.check("tp", tp)
        gamma = (
            peak_enhancement(hs, tp) if gamma is None else PEAK_ENHANCEMENT.check("gamma", gamma)
        )
        return cls(
            peak=2.0 * np.pi / tp,
            alpha=phillips_constant(hs, tp, shape_integral(gamma)),
            gamma=gamma,
        )

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        x = relative(omega, self.peak)
        sigma = np.where(x <= 1.0, 0.07, 0.09)
        r = np.exp(-((x - 1.0) ** 2) / (2.0 * sigma**2))
        # x^-4 at a tenth of the time of a power; inverted first, as x^4 may overflow
        x4 = np.square(np.square(1.0 / x))
        s: Real = (
            self.alpha * GRAVITY**2 * self.peak**-5 * (x4 / x) * np.exp(-1.25 * x4) * self.gamma**r
        )
        return s


def fetch_limited(speed: float, fetch: float, gamma: float, growth: str = "jonswap") -> JONSWAP:
    """Return the sea of `JONSWAP.from_wind`, with arguments that have been checked."""
    sea = in_deep_water(growth, GRAVITY * fetch / max(speed, STILL_AIR) ** 2, gamma)
    return of_wind_sea(sea, speed)


def of_wind_sea(sea: WindSea, speed: float) -> JONSWAP:
    """Return a dimensionless wind sea as a spectrum; of one in finite depth, that in deep water."""
    return JONSWAP(
        peak=sea.peak * GRAVITY / max(speed, STILL_AIR),
        alpha=min(sea.alpha, 1.0) if speed else 0.0,
        gamma=sea.gamma,
    )


SPECTRA.add(
    "jonswap",
    JONSWAP,
    Way(JONSWAP.from_sea_state, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD, gamma=PEAK_ENHANCEMENT),
    Way(
        JONSWAP.from_wind,
        speed=WIND_SPEED,
        fetch=FETCH,
        gamma=PEAK_ENHANCEMENT,
        growth=GROWTH,
    ),
)
