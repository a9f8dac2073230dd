"""
Growth of a wind sea with fetch, in deep water and in water of finite depth, and the peak
enhancement that belongs to a wave height and a period.

All is dimensionless: with the wind U at 10 m, the fetch F and the depth h,

    energy e = g^2 m0 / U^4,  peak u = omega_p U / g,  fetch x = g F / U^2,  depth d = g h / U^2.

In deep water:

    jonswap         alpha = 0.076 x^-0.22, u = 22 x^(-1/3), e = alpha J(gamma) / u^4
                    (Hasselmann et al. 1973)
    kahma-calkoen   e = 5.2e-7 x^0.9, u = 13.7 x^-0.27, of stable and unstable air together
                    (Kahma & Calkoen 1992)
    young-verhagen  e = E tanh(B1)^1.74, u = 2 pi N tanh(B2)^-0.37

The first two would let a sea grow for ever. Here they hold until the energy is 99 % of the fully
developed sea's (Pierson & Moskowitz 1964); from there on what is missing of that energy falls as
1/x, the peak goes on falling to the developed one, and gamma relaxes to 1 over the same stretch.

In finite depth (Young & Verhagen 1996):

    e = E (T1 tanh(B1 / T1))^1.74,     E = 3.64e-3, T1 = tanh(0.493 d^0.75), B1 = 3.13e-3 x^0.57
    u = 2 pi N (T2 tanh(B2 / T2))^-0.37, N = 0.133, T2 = tanh(0.331 d^1.01), B2 = 5.215e-4 x^0.73

B1 and B2 are what the fetch alone has done: the law of Young and Verhagen has them as given, and
for the other two they are those at which deep water has the law's own energy and peak. So each law
is the limit of deep water, and all three come to the same sea where the bed, not the fetch, stops
it.

Sources: Hasselmann et al., Deutsche Hydrographische Zeitschrift A8 12 (1973); Kahma & Calkoen, J.
Phys. Oceanogr. 22 (1992), 1389-1405; Young & Verhagen, Coastal Engineering 29 (1996), 47-78; DNV,
Recommended practice DNV-RP-C205 (2010), 3.5.5.
"""

import math
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.physics.kinds import Choice
from fftocean.physics.spectra.kitaigorodskii import kitaigorodskii
from fftocean.physics.spectra.pierson_moskowitz import FULLY_DEVELOPED_PEAK

GROWTHS: Final = ("jonswap", "kahma-calkoen", "young-verhagen")
GROWTH = Choice(GROWTHS)
"""The laws of growth by name, as an argument and as a key of a job file."""

BREAKING: Final = 0.6
"""Hs / h above which most waves of a sea have broken  (0.5 to 0.6: Nelson 1994)."""

_DEVELOPED = 8.1e-3 * 0.2 / FULLY_DEVELOPED_PEAK**4  # e of the Pierson-Moskowitz sea
_E, _N = 3.64e-3, 0.133


class WindSea(NamedTuple):
    """A wind sea of the JONSWAP shape, or of the TMA shape where the depth is finite."""

    alpha: float  # Phillips constant [-]
    peak: float  # omega_p U / g [-]
    gamma: float  # [-]
    depth: float = math.inf  # g h / U^2 [-]

    @property
    def energy(self) -> float:
        """g^2 m0 / U^4 [-]."""
        return self.alpha * _shape(self.peak, self.gamma, self.depth) / self.peak**4


def in_deep_water(law: str, x: float, gamma: float) -> WindSea:
    """
    Return the wind sea of a law at a dimensionless fetch.

    Args:
        law: one of `GROWTHS`.
        x: g F / U^2 [-].
        gamma: peak enhancement of the growing sea [-]; the law of Young and Verhagen has no stretch
            over which it would relax, and takes `peak_enhancement` of its sea where that is less.
    """
    if law == "young-verhagen":
        energy = _E * math.tanh(3.13e-3 * x**0.57) ** 1.74
        peak = 2.0 * math.pi * _N * math.tanh(5.215e-4 * x**0.73) ** -0.37
        ratio = math.pi / (peak * energy**0.25 * math.sqrt(GRAVITY))  # Tp/sqrt(Hs), of any wind
        return _of_energy(energy, peak, min(gamma, _by_ratio(ratio)))
    if law == "kahma-calkoen":
        factor, power, start, fall = 5.2e-7, 0.9, 13.7, 0.27
    else:
        factor, power = 0.076 * shape_integral(gamma) / 22.0**4, 4.0 / 3.0 - 0.22
        start, fall = 22.0, 1.0 / 3.0
    nearly = (0.99 * _DEVELOPED / factor) ** (1.0 / power)  # where the energy is 99 % of its limit
    mature = (start / FULLY_DEVELOPED_PEAK) ** (1.0 / fall)  # where the peak is that of the limit
    peak = max(start * x**-fall, FULLY_DEVELOPED_PEAK)
    if x > nearly:
        age = min((x - nearly) / (mature - nearly), 1.0)
        return _of_energy(_DEVELOPED * (1.0 - 0.01 * nearly / x), peak, gamma ** (1.0 - age))
    if law == "jonswap":
        return WindSea(0.076 * x**-0.22, peak, gamma)
    return _of_energy(factor * x**power, peak, gamma)


def in_finite_depth(deep: WindSea, d: float) -> WindSea:
    """
    Return the wind sea of the same wind and fetch where the water has a depth.

    Args:
        deep: the sea in deep water.
        d: g h / U^2 [-]; inf returns the sea as it is.
    """
    if math.isinf(d):
        return deep
    d = min(d, 1e9)  # deep, and no power of it overflows
    t1, t2 = math.tanh(0.493 * d**0.75), math.tanh(0.331 * d**1.01)
    b1 = _inverse_tanh((deep.energy / _E) ** (1.0 / 1.74))
    b2 = _inverse_tanh((deep.peak / (2.0 * math.pi * _N)) ** (-1.0 / 0.37))
    energy = min(_E * (t1 * math.tanh(b1 / t1)) ** 1.74, (BREAKING * d / 4.0) ** 2)
    peak = 2.0 * math.pi * _N * (t2 * math.tanh(b2 / t2)) ** -0.37
    return _of_energy(energy, peak, deep.gamma, d)


def _of_energy(energy: float, peak: float, gamma: float, depth: float = math.inf) -> WindSea:
    """Return the sea of a dimensionless energy."""
    return WindSea(energy * peak**4 / _shape(peak, gamma, depth), peak, gamma, depth)


def _shape(peak: float, gamma: float, depth: float) -> float:
    """Return m0 omega_p^4 / (alpha g^2)."""
    return shape_integral(gamma) if math.isinf(depth) else shape_integral_at(gamma, peak**2 * depth)


def _inverse_tanh(value: float) -> float:
    """Return the inverse hyperbolic tangent; 1 and roundings above are just below 1."""
    return math.atanh(min(value, 1.0 - 1e-15))


def peak_enhancement(hs: float, tp: float) -> float:
    """
    Return gamma of a sea of `hs` [m] and `tp` [s]: 5 where Tp/sqrt(Hs) is at most 3.6, 1 from 5 on,
    exp(5.75 - 1.15 Tp/sqrt(Hs)) between  (DNV-RP-C205, 3.5.5.5).

    A sea without waves has 1.
    """
    return _by_ratio(tp / math.sqrt(hs) if hs > 0.0 else math.inf)


def _by_ratio(ratio: float) -> float:
    """Return gamma at Tp/sqrt(Hs) [s/m^0.5]."""
    if ratio <= 3.6:
        return 5.0
    return math.exp(5.75 - 1.15 * ratio) if ratio < 5.0 else 1.0


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


_EDGES: Final = (
    *(0.37, 0.5, 0.65, 0.79, 0.86, 0.93, 1.0, 1.09, 1.18, 1.27, 1.45, 1.7, 2.0, 2.5, 3.2, 4.5),
    *(7.0, 12.0, 25.0, 60.0, 200.0, 1000.0),
)
"""Frequencies, in peaks, between which the integrand of `shape_integral_at` is smooth."""


@lru_cache(maxsize=256)
def shape_integral_at(gamma: float, kappa: float) -> float:
    """
    Return m0 omega_p^4 / (alpha g^2) of a TMA sea, in which omega_p^2 h / g is `kappa`: the
    integral of x^-5 exp(-5/4 x^-4) gamma^r Phi.

    Below 0.37 peaks there is nothing (1e-26), and beyond 1000 the factor Phi is 1 unless the water
    is less than 1e-5 of a wave deep.
    """
    nodes, weights = np.polynomial.legendre.leggauss(16)
    low, high = np.array(_EDGES[:-1]), np.array(_EDGES[1:])
    half = 0.5 * (high - low)[:, None]
    x = half * nodes + 0.5 * (high + low)[:, None]
    r = np.exp(-0.5 * ((x - 1.0) / np.where(x <= 1.0, 0.07, 0.09)) ** 2)
    shape = x**-5 * np.exp(-1.25 * x**-4) * gamma**r
    phi = kitaigorodskii(x * math.sqrt(kappa * GRAVITY), 1.0)
    tail = float(kitaigorodskii(1e3 * math.sqrt(kappa * GRAVITY), 1.0)) * 0.25e-12
    return float(np.sum(half * weights * shape * phi)) + tail
