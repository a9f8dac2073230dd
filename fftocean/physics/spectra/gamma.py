"""Generalised gamma spectrum with peak enhancement, from which other spectra are composed."""

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import PERIOD, SIGNIFICANT_WAVE_HEIGHT, Quantity, check_bool, keep_checked
from fftocean.physics.kinds import Switch, Way
from fftocean.physics.moments import moment
from fftocean.physics.spectra.base import SPECTRA

# N: m0 exists above 1; below 1.4 half of it would lie beyond ten times the peak
TAIL = Quantity("", 1.4, 1000.0)

FRONT = Quantity("", 1.0, 16.0)  # M

# Torsethaugen's regression reaches 50 in the steepest possible seas
ENHANCEMENT = Quantity("", 1.0, 100.0)

STEEPEST = 4.0 / math.sqrt(5.0)
"""
Hs omega_p^2 / g at which a Pierson-Moskowitz sea has a Phillips constant of 1: the limit of
`base.phillips_constant`, in other words.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GammaSpectrum:
    """
    Generalised gamma spectrum: a front, a tail, and between them a peak that may be raised.

    S = (Hs^2/16) (A G / omega_p) x^-N exp(-(N/M) x^-M) gamma^r,  x = omega/omega_p,
    with r and its widths 0.07 and 0.09 as in JONSWAP, G = M (N/M)^((N-1)/M) / Gamma((N-1)/M), and A
    = 1 where gamma = 1.

    N = 5, M = 4 is Bretschneider's; M = 4 Wallop's and Ochi and Hubble's; with gamma it is each
    half of Torsethaugen's. m0 is Hs^2/16 by construction: A comes from quadrature, or
    (`exact=False`) from the regression that Torsethaugen published.

    Source: Torsethaugen 1996; DNV-RP-C205 (2010), appendix A, gives it with the regression.
    """

    hs: float  # significant wave height [m]
    tp: float  # peak period [s] (of the bell without gamma, to be exact; gamma sits on its top)
    tail: float = 5.0  # N: S falls as omega^-N [-]
    front: float = 4.0  # M: how steeply it rises [-]
    gamma: float = 1.0  # peak enhancement [-]
    # Hs to the last digit, not as the published regression has it
    exact: bool = field(default=True, repr=False)

    def __post_init__(self) -> None:
        keep_checked(
            self, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD, tail=TAIL, front=FRONT, gamma=ENHANCEMENT
        )
        require_possible(self.hs, self.tp)
        check_bool("exact", self.exact)

    @property
    def peak(self) -> float:
        """omega_p [rad/s]."""
        return 2.0 * math.pi / self.tp

    @property
    def breaks(self) -> tuple[float, ...]:
        """
        The scales on which the spectrum bends: its peak, where the width changes, and an octave
        each way [rad/s].
        """
        return 0.5 * self.peak, self.peak, 2.0 * self.peak

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        norm = norm_by_regression if not self.exact else norm_by_quadrature
        scale = self.hs**2 / 16.0 / self.peak * norm(self.tail, self.front, self.gamma)
        # nothing is left there, nor is infinity a frequency
        omega = np.minimum(np.asarray(omega, dtype=np.float64), 1e50)
        return scale * _bell(omega / self.peak, self.tail, self.front, self.gamma)


def _bell(x: Real, tail: float, front: float, gamma: float) -> Real:
    """
    Return G x^-N exp(-(N/M) x^-M) gamma^r, in logarithms: N = 401 (lambda = 100) overflows
    otherwise.
    """
    a = (tail - 1.0) / front
    log_g = math.log(front) + a * math.log(tail / front) - math.lgamma(a)
    x = np.maximum(x, 1e-3)  # there the front is 0 in double precision
    bell: Real = np.exp(log_g - tail * np.log(x) - tail / front * x**-front)
    if gamma > 1.0:
        # 0 at 5 peaks
        bell *= gamma ** np.exp(
            -0.5 * ((np.minimum(x, 5.0) - 1.0) / np.where(x <= 1.0, 0.07, 0.09)) ** 2
        )
    return bell


@lru_cache(maxsize=1024)
def norm_by_quadrature(tail: float, front: float, gamma: float) -> float:
    """Return A = 1 / integral of the bell: exactly 1 for gamma = 1."""
    if gamma == 1.0:
        return 1.0
    return 1.0 / moment(_Shape(tail, front, gamma), 0)


@dataclass(frozen=True, slots=True)
class _Shape:
    """The bell as a spectrum with its peak at 1, for the quadrature."""

    tail: float
    front: float
    gamma: float
    peak: float = 1.0
    # gamma^r ends within 3 widths of the peak
    breaks: tuple[float, ...] = (0.5, 0.8, 1.0, 1.3, 2.0)

    def __call__(self, x: RealLike, /) -> Real:
        return _bell(np.asarray(x, dtype=np.float64), self.tail, self.front, self.gamma)


def norm_by_regression(tail: float, front: float, gamma: float) -> float:
    """
    Return A = (1 + f1 ln^f2 gamma)/gamma, within 5 % of the quadrature up to gamma = 20
    (Torsethaugen 1996; DNV-RP-C205 A.2).
    """
    f1 = 4.1 * (tail - 2.0 * front**0.28 + 5.3) ** (0.96 - 1.45 * front**0.1)
    f2 = (
        (2.2 * front**-3.3 + 0.57) * tail ** (0.53 - 0.58 * front**0.37) + 0.94 - 1.04 * front**-1.9
    )
    return float((1.0 + f1 * math.log(gamma) ** f2) / gamma)


def total(parts: tuple[GammaSpectrum, ...], omega: RealLike) -> Real:
    """Return the sum of the parts' S; 0 of none."""
    omega = np.asarray(omega, dtype=np.float64)
    return sum((part(omega) for part in parts), np.zeros_like(omega))


def breaks_of(parts: tuple[GammaSpectrum, ...]) -> tuple[float, ...]:
    """Return the scales of all parts, ascending [rad/s]."""
    return tuple(sorted({b for part in parts for b in part.breaks}))


def require_possible(hs: float, tp: float) -> None:
    """Raise if waves are steeper than possible."""
    steepness = hs * (2.0 * math.pi / tp) ** 2 / GRAVITY
    if steepness > STEEPEST:
        raise ParameterError(
            "hs and tp must make waves that are possible "
            f"(hs at most {STEEPEST / (2.0 * math.pi):.3f} of the wavelength), "
            f"got {hs:g} m with {tp:g} s ({steepness / (2.0 * math.pi):.3g})"
        )


SPECTRA.add(
    "gamma",
    GammaSpectrum,
    Way(
        GammaSpectrum,
        hs=SIGNIFICANT_WAVE_HEIGHT,
        tp=PERIOD,
        tail=TAIL,
        front=FRONT,
        gamma=ENHANCEMENT,
        exact=Switch(),
    ),
)
