"""Integral parameters of a spectrum: m_n, Hs, Tp, Tz, mean direction and spread."""

import math
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError, described

# Any callable with a peak is taken: this module lies below those of spectra and seas.
Spectrum = Any
"""A `FrequencySpectrum`: callable on omega, with `.peak` and, where it has corners, `.breaks`."""


def moment(spectrum: Spectrum, n: int, low: float = 0.0, high: float = math.inf) -> float:
    """
    Return m_n, the integral of omega^n S(omega) from `low` to `high`  [m^2 (rad/s)^n].

    Adaptive Gauss-Kronrod quadrature (QUADPACK) in omega/omega_p, piece by piece between the peak
    and the spectrum's corners.

    Args:
        spectrum: a `FrequencySpectrum`.
        n: the order; any real number.
        low, high: the band [rad/s].

    Returns:
        The moment, to about 1e-11 of itself; inf where the tail falls too slowly for it to exist (n
        >= 4 for omega^-5).

    Raises:
        ParameterError: a band that is not 0 <= low <= high, or a spectrum that the quadrature
            cannot resolve.
    """
    from scipy import integrate

    if not 0.0 <= low <= high:
        raise ParameterError(f"a band must have 0 <= low <= high, got {low} to {high} rad/s")
    peak = _peak_of(spectrum)

    def integrand(x: float) -> float:
        s = float(spectrum(peak * x)) if x > 0.0 else 0.0
        return x**n * s if s > 0.0 else s  # where there is nothing, the power may well overflow

    corners = [c / peak for c in (peak, *getattr(spectrum, "breaks", ()))]
    if not getattr(spectrum, "breaks", ()):
        corners += [
            0.5,
            2.0,
        ]  # keep the peak's own scale in sight of the quadrature, whatever the band
    edges = _refined(
        [low / peak, *sorted(c for c in set(corners) if low / peak < c < high / peak), high / peak]
    )
    if math.isinf(high) and _diverges(spectrum, n):
        return math.inf

    def tail(u: float) -> float:
        # a power law in 1/x is one in u, and its end is in sight
        return integrand(1.0 / u) / u**2 if u > 0.0 else 0.0

    pieces = [
        (integrand, a, b) if b < math.inf else (tail, 0.0, 1.0 / a)
        for a, b in pairwise(edges)
        if _any_energy(integrand, a, b)
    ]
    results = [
        integrate.quad(*piece, epsabs=0.0, epsrel=1e-11, limit=200, full_output=1)
        for piece in pieces
    ]
    whole = sum(part for part, *_ in results)
    total = 0.0
    for (f, a, b), (part, error, _, *complaint) in zip(pieces, results, strict=True):
        # Sharp features: split the piece evenly and add the parts, which resolves all but fractals.
        total += _split(f, a, b, 1e-6 * whole) if complaint and error > 1e-12 * whole else part
    return float(total * peak ** (n + 1))


def _peak_of(spectrum: Spectrum) -> float:
    """
    Return the peak of a spectrum [rad/s].

    Raises:
        ParameterError: not a spectrum.
    """
    if isinstance(spectrum, type) or not callable(spectrum) or not hasattr(spectrum, "peak"):
        of = "; take system.spectrum" if hasattr(spectrum, "spectrum") else ""
        raise ParameterError(
            f"a spectrum must be callable and have a peak, got {described(spectrum)}{of}"
        )
    return float(spectrum.peak)


def _refined(edges: list[float]) -> list[float]:
    """
    Return the edges with more in between, so that no finite piece spans more than a factor of 16: a
    quadrature may overlook a peak at one end of a long piece.
    """
    refined = edges[:1]
    for a, b in pairwise(edges):
        pieces = math.ceil(math.log(b / a) / math.log(16.0)) if 0.0 < a < b < math.inf else 1
        refined += [a * (b / a) ** (i / pieces) for i in range(1, pieces)] + [b]
    return refined


def _any_energy(integrand: Callable[[float], float], a: float, b: float) -> bool:
    """Return True if a piece has any energy: a relative tolerance cannot be met on none."""
    probes = (
        a + (b - a) * np.linspace(0.0, 1.0, 65)
        if math.isfinite(b)
        else a * np.geomspace(1.0, 1e6, 65)
    )
    return any(integrand(float(x)) > 0.0 for x in probes)


def _split(integrand: Callable[[float], float], a: float, b: float, tolerance: float) -> float:
    """Integrate in 64 panels; raise as soon as the errors exceed the tolerance."""
    from scipy import integrate

    total = doubt = 0.0
    for p, q in pairwise(np.linspace(a, b, 65)):
        part, error = integrate.quad(
            integrand, p, q, epsabs=1e-6 * tolerance, epsrel=1e-11, limit=200, full_output=1
        )[:2]
        total, doubt = total + part, doubt + error
        if doubt > tolerance:
            raise ParameterError(
                "the spectrum is too rough to integrate: a part of the moment came out as "
                f"{part:g} +- {error:g}"
            )
    return total


def _diverges(spectrum: Spectrum, n: int) -> bool:
    """
    Return True if omega^(n+1) S no longer falls far out on the tail: 1e10 peaks out, where even the
    shallowest water is deep.
    """
    near, far = (float(spectrum(x * float(spectrum.peak))) for x in (1e10, 1e11))
    return near > 0.0 and far > 0.0 and math.log10(far / near) + n + 1 > math.log10(0.9)


def significant_wave_height(spectrum: Spectrum) -> float:
    """Return Hs = 4 sqrt(m0) [m]."""
    return 4.0 * math.sqrt(moment(spectrum, 0))


def mean_period(spectrum: Spectrum) -> float:
    """Return Tm01 = 2 pi m0/m1 [s]; 0 for a flat sea."""
    m0, m1 = moment(spectrum, 0), moment(spectrum, 1)
    return 2.0 * math.pi * m0 / m1 if m1 > 0.0 else 0.0


def zero_crossing_period(spectrum: Spectrum) -> float:
    """Return Tz = 2 pi sqrt(m0/m2) [s]; 0 for a flat sea."""
    m0, m2 = moment(spectrum, 0), moment(spectrum, 2)
    return 2.0 * math.pi * math.sqrt(m0 / m2) if m2 > 0.0 else 0.0


def peak_period(spectrum: Spectrum) -> float:
    """
    Return Tp = 2 pi / omega at which S is highest [s], found on the curve itself; 0 for a flat sea.

    For a wrapped spectrum (TMA) this is the peak of the product, a little shorter than that
    of the deep-water sea.
    """
    peak = _peak_of(spectrum)
    omega = np.union1d(
        peak * np.geomspace(0.1, 10.0, 4001), np.array(getattr(spectrum, "breaks", (peak,)))
    )
    s = spectrum(omega)
    top = int(np.argmax(s))
    if not s[top] > 0.0:
        return 0.0
    fine = np.linspace(omega[max(top - 1, 0)], omega[min(top + 1, omega.size - 1)], 2001)
    fine = np.append(fine, omega[top])  # where the curve has a corner, the peak is the corner
    return 2.0 * math.pi / float(fine[np.argmax(spectrum(fine))])


def mean_direction_and_spread(variance: Real, theta: Real) -> tuple[float, float]:
    """
    Return the energy-weighted mean direction and the circular spread of waves, both in degrees.

    mean = arg sum(E e^{i theta});  spread = sqrt(2 (1 - |sum E e^{i theta}| / sum E)).

    Args:
        variance: energy of each wave, any shape, any unit.
        theta: direction toward which it goes, same shape, [rad].

    Returns:
        Direction toward, counter-clockwise from +x, in (-180, 180], and spread; (0, 0) for a flat
        sea.

    Source: Kuik, van Vledder & Holthuijsen 1988.
    """
    total = float(np.sum(variance))
    if not total > 0.0:
        return 0.0, 0.0
    mean = np.sum(variance * np.exp(1j * theta)) / total
    direction = math.degrees(math.atan2(mean.imag, mean.real))
    return direction if direction > -180.0 else 180.0, math.degrees(
        math.sqrt(max(2.0 * (1.0 - abs(mean)), 0.0))
    )


def spectral_grid(peaks: Iterable[float], breaks: Iterable[float] = (), points: int = 400) -> Real:
    """
    Return frequencies (n,) [rad/s] that show a sea: from a tenth of its lowest peak to 30 times its
    highest, dense round each peak, with every corner.
    """
    peaks = list(peaks)
    if not peaks:
        return np.geomspace(0.1, 10.0, 16)
    wide = np.geomspace(0.1 * min(peaks), 30.0 * max(peaks), points)
    near = [p * np.geomspace(0.6, 1.8, points) for p in peaks]
    return np.unique(np.concatenate([wide, *near, np.fromiter(breaks, dtype=np.float64)]))
