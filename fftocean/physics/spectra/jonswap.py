"""JONSWAP spectrum of the fetch-limited sea."""

from dataclasses import dataclass
from functools import lru_cache

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
from fftocean.physics.spectra.pierson_moskowitz import FULLY_DEVELOPED_PEAK
from fftocean.physics.spectra.wind import STILL_AIR, checked_wind, warn_of_short_fetch


@dataclass(frozen=True, slots=True)
class JONSWAP:
    """
    Pierson-Moskowitz spectrum with its peak raised by gamma^r  (Hasselmann et al. 1973).

    r = exp(-(omega - omega_p)^2 / (2 sigma^2 omega_p^2)), sigma = 0.07 up to the peak and 0.09
    beyond.
    """

    peak: float  # omega_p [rad/s]
    alpha: float = 8.1e-3  # Phillips constant [-]
    gamma: float = 3.3  # peak enhancement [-]

    def __post_init__(self) -> None:
        keep_checked(self, peak=PEAK, alpha=PHILLIPS_CONSTANT, gamma=PEAK_ENHANCEMENT)

    @classmethod
    def from_wind(cls, *, speed: float, fetch: float, gamma: float = 3.3) -> "JONSWAP":
        """
        Return the sea raised by a wind of `speed` (U10) [m/s] over `fetch` [m].

        The laws of the JONSWAP experiment, alpha = 0.076 (U^2/gF)^0.22 and omega_p = 22
        (g^2/UF)^(1/3), let a sea grow for ever. Here it grows by them until its energy is 99 % of
        the fully developed sea's; from there on what is missing of that energy falls as 1/F, the
        peak goes on falling by its law to the fully developed one, and gamma relaxes to 1 over the
        same stretch: the limit of a long fetch *is* Pierson-Moskowitz, never passed, and Hs(F) only
        rises.

        Args:
            speed: wind speed 10 m above the sea [m/s]; 0 is an exactly flat sea, with a warning
                that says so.
            fetch: distance over which the wind blows [m].
            gamma: peak enhancement of the growing sea [-].

        Raises:
            ParameterError: a value out of its range (`limits.WIND_SPEED`, `limits.FETCH`,
                `limits.PEAK_ENHANCEMENT`).

        Source: Hasselmann et al. 1973; the limit from Pierson & Moskowitz 1964.
        """
        speed = checked_wind(speed)
        fetch = FETCH.check("fetch", fetch)
        warn_of_short_fetch(speed, fetch)
        return fetch_limited(speed, fetch, PEAK_ENHANCEMENT.check("gamma", gamma))

    @classmethod
    def from_sea_state(cls, *, hs: float, tp: float, gamma: float = 3.3) -> "JONSWAP":
        """
        Return the sea of significant wave height `hs` [m] and peak period `tp` [s], normalised
        exactly: 4 sqrt(m0) is `hs`.

        Raises:
            ParameterError: a value out of its range, or waves too steep to be (alpha > 1).
        """
        tp = PERIOD.check("tp", tp)
        gamma = PEAK_ENHANCEMENT.check("gamma", gamma)
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
        s: Real = (
            self.alpha * GRAVITY**2 * self.peak**-5 * x**-5 * np.exp(-1.25 * x**-4) * self.gamma**r
        )
        return s


def fetch_limited(speed: float, fetch: float, gamma: float) -> JONSWAP:
    """Return the sea of `JONSWAP.from_wind`, with arguments that have been checked."""
    wind = max(speed, STILL_AIR)
    x = GRAVITY * fetch / wind**2  # dimensionless fetch
    # Dimensionless, with u = omega_p U/g and e = g^2 m0 / U^4:  e = alpha J(gamma) / u^4.
    limit = 8.1e-3 * 0.2 / FULLY_DEVELOPED_PEAK**4
    growth = 0.076 * shape_integral(gamma) / 22.0**4
    # fetch at which e is 99 % of its limit
    nearly = (0.99 * limit / growth) ** (1.0 / (4.0 / 3.0 - 0.22))
    mature = (22.0 / FULLY_DEVELOPED_PEAK) ** 3  # fetch at which the peak is that of the limit
    u = max(22.0 * x ** (-1.0 / 3.0), FULLY_DEVELOPED_PEAK)
    alpha = 0.076 * x**-0.22
    if x > nearly:
        age = min((x - nearly) / (mature - nearly), 1.0)
        gamma = gamma ** (1.0 - age)
        alpha = limit * (1.0 - 0.01 * nearly / x) * u**4 / shape_integral(gamma)
    return JONSWAP(peak=u * GRAVITY / wind, alpha=min(alpha, 1.0) if speed else 0.0, gamma=gamma)


@lru_cache(maxsize=256)
def shape_integral(gamma: float) -> float:
    """
    Return J(gamma) = m0 omega_p^4 / (alpha g^2): 1/5 for gamma = 1, then growing.

    It is 1/5 plus the integral of what the peak adds to Pierson-Moskowitz, x^-5 exp(-5/4 x^-4)
    (gamma^r - 1): smooth on either side, and nothing (1e-17) nine sigma away. `moment` would say
    the same, and load half of SciPy before the first frame.
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    from_peak = 4.5 * (1.0 + nodes)  # in sigma
    raised = np.expm1(np.log(gamma) * np.exp(-0.5 * from_peak**2))
    sides = [(sigma, 1.0 + side * sigma * from_peak) for sigma, side in ((0.07, -1.0), (0.09, 1.0))]
    return 0.2 + sum(
        4.5 * sigma * float(np.sum(weights * raised * x**-5 * np.exp(-1.25 * x**-4)))
        for sigma, x in sides
    )


SPECTRA.add(
    "jonswap",
    JONSWAP,
    Way(JONSWAP.from_sea_state, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD, gamma=PEAK_ENHANCEMENT),
    Way(JONSWAP.from_wind, speed=WIND_SPEED, fetch=FETCH, gamma=PEAK_ENHANCEMENT),
)
