"""A sea in numbers and curves, specified beside realised, fast enough to accompany a slider."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fftocean.arrays import Real, brief_repr
from fftocean.cascade import Cascade
from fftocean.cells import Part, parts_of_sea
from fftocean.errors import ParameterError, described
from fftocean.ocean import Ocean
from fftocean.physics import dispersion, moments
from fftocean.physics.panels import gauss
from fftocean.polar_spectrum import PolarSpectrum, polar_spectrum
from fftocean.statistics import SeaState, peak_period

_RATIO = 1.08  # of the edges of a bin, at least
_LONGEST, _SHORTEST = 0.35, 6.0  # frequencies of the bins, in peaks of the systems
_POLAR = 3.0  # highest frequency of the polar spectrum, in peaks of the systems
_MINOR = 0.01  # of the variance: systems that the curves need not show
_RANGE = 0.05, 20.0  # in which the peak is looked for, in peaks of the systems


@dataclass(frozen=True, slots=True)
class SeaSummary:
    """Sea states and spectra, of the sea itself and of the waves of one seed."""

    specified: SeaState
    realised: SeaState
    edges: Real  # of the bins of frequency, (bins + 1,) [Hz]
    density: Real  # specified mean variance density of each, (bins,) [m^2/Hz]
    realised_density: Real  # that of the waves, (bins,) [m^2/Hz]
    polar: PolarSpectrum  # specified, over frequency and direction

    __repr__ = brief_repr

    def as_plain(self) -> dict[str, Any]:
        """Return the spectrum as plain data for JSON: frequency, density and realised."""
        return {
            "frequency": (0.5 * (self.edges[1:] + self.edges[:-1])).tolist(),
            "density": self.density.tolist(),
            "realised": self.realised_density.tolist(),
        }


def summary(source: Cascade | Ocean, *, rings: int = 32, sectors: int = 48) -> SeaSummary:
    """
    Return the sea states and spectra of a cascade's sea and of its waves.

    The realised numbers are sums over the amplitudes; `measure` takes them from frames, and has
    more of them. Bins of frequency are at least 8 % wide; on a loop their edges lie half way
    between the frequencies of whole cycles. Specified directions are within 0.1 degrees, since
    spreading is taken at one frequency of each panel.

    Args:
        source: a cascade or an ocean of a sea.
        rings, sectors: the number of cells of the polar spectrum.

    Raises:
        ParameterError: no cascade or ocean, or one of given waves.

    Pinned by tests/test_sea_summary.py, against `measure`, the list of waves and quadrature.
    """
    if not isinstance(source, (Cascade, Ocean)):
        raise ParameterError(f"source must be a Cascade or an Ocean, got {described(source)}")
    if source.sea is None:
        raise ParameterError(f"source must be made of a sea, got the given waves of {source!r:.80}")
    parts = parts_of_sea(source.sea)
    specified = _specified(parts)
    energy, omega, theta = _waves(source)
    m0 = float(np.sum(energy))
    direction, spread = moments.mean_direction_and_spread(energy, theta)
    tp = peak_period(energy, omega)
    peaks = [
        float(part.system.spectrum.peak) / (2.0 * math.pi)
        for part in parts
        if part.share * part.variance > _MINOR * specified.m0
    ] or [0.1]  # a flat sea
    edges = _edges(_LONGEST * min(peaks), _SHORTEST * max(peaks), source.loop)
    held, _ = np.histogram(omega / (2.0 * np.pi), edges, weights=energy)
    return SeaSummary(
        specified=specified,
        realised=SeaState(m0, 4.0 * math.sqrt(m0), tp, direction, spread),
        edges=edges,
        density=_mean_density(parts, edges),
        realised_density=held / np.diff(edges),
        polar=polar_spectrum(source.sea, _POLAR * max(peaks), rings, sectors, parts),
    )


def _specified(parts: list[Part]) -> SeaState:
    """Return the state of a sea, from the panels of its parts."""
    m0 = sum(part.share * part.variance for part in parts)
    if not m0 > 0.0:
        return SeaState(0.0, 0.0, 0.0, 0.0, 0.0)
    mean = 0.0j
    for part in parts:
        turned = np.exp(1j * part.direction)
        if part.long_crested:
            mean += part.share * part.variance * turned
            continue
        some = np.flatnonzero(part.energy > 1e-6 * part.variance)
        middle = 0.5 * (part.k[some] + part.k[some + 1])
        omega = dispersion.angular_frequency(middle, part.depth, part.tension)
        inner = np.abs(part.theta - part.direction) < np.pi * (1.0 - 1e-12)
        panels = np.concatenate([[-np.pi], part.theta[inner] - part.direction, [np.pi]])
        theta, weight = (a.ravel() for a in gauss(panels[:-1], panels[1:], 6))
        spread = part.system.spreading(omega[:, None], theta, float(part.system.spectrum.peak))
        spread = np.broadcast_to(spread, (omega.size, theta.size))
        moment = spread @ (weight * np.exp(1j * theta))
        mean += part.share * turned * np.sum(part.energy[some] * moment)
    return SeaState(
        m0=m0,
        hs=4.0 * math.sqrt(m0),
        tp=_peak_period(parts),
        mean_direction=math.degrees(float(np.angle(mean))),
        spread=math.degrees(math.sqrt(max(2.0 * (1.0 - abs(mean) / m0), 0.0))),
    )


def _peak_period(parts: list[Part]) -> float:
    """Return 2 pi / omega at which the sum of the spectra is highest [s]."""
    peaks = [float(part.system.spectrum.peak) for part in parts]
    ends = np.array([_RANGE[0] * min(peaks), _RANGE[1] * max(peaks)])
    low, high = dispersion.wavenumber(ends, parts[0].depth, parts[0].tension)
    breaks = np.concatenate([part.k for part in parts])
    breaks = breaks[(breaks > low) & (breaks < high)]
    k = np.unique(np.concatenate([np.geomspace(low, high, 600), breaks]))
    top = int(np.argmax(_density(parts, k)))
    fine = np.linspace(k[max(top - 1, 0)], k[min(top + 1, k.size - 1)], 400)
    fine = np.append(fine, k[top])  # where the curve has a corner, the peak is the corner
    best = fine[int(np.argmax(_density(parts, fine)))]
    omega = float(dispersion.angular_frequency(best, parts[0].depth, parts[0].tension))
    return 2.0 * math.pi / omega


def _density(parts: list[Part], k: Real) -> Real:
    """Return S(omega) of all parts at wavenumbers, [m^2 s/rad]."""
    total = np.zeros(k.shape)
    for part in parts:
        total += part.share * part.spectrum_at(k)[1]
    return total


def _mean_density(parts: list[Part], edges: Real) -> Real:
    """Return the mean variance density between frequencies [Hz], (bins,) [m^2/Hz]."""
    if not parts:
        return np.zeros(edges.size - 1)
    depth, tension = parts[0].depth, parts[0].tension
    k = dispersion.wavenumber(2.0 * np.pi * edges, depth, tension)
    points, weights = gauss(k[:-1], k[1:], 4)
    total = np.zeros(k.size - 1)
    for part in parts:
        total += part.share * np.sum(part.radial(points)[1] * weights, axis=1)
    density: Real = total / np.diff(edges)
    return density


def _waves(source: Cascade | Ocean) -> tuple[Real, Real, Real]:
    """Return a^2/2 [m^2], omega [rad/s] and direction [rad] of the waves."""
    columns = []
    for ocean in source.oceans if isinstance(source, Cascade) else (source,):
        a, grid = ocean.amplitudes, ocean.grid
        forward, backward = 2.0 * np.abs(a.forward) ** 2, 2.0 * np.abs(a.backward) ** 2
        backward[:, 0] = 0.0  # those are the waves at -k of the same column's forward ones
        omega = a.running_omega
        for energy, sign in ((forward, 1.0), (backward, -1.0)):
            rows, at = np.nonzero(energy)
            theta = np.arctan2(sign * grid.ky[rows], sign * grid.kx[at])
            columns.append((energy[rows, at], omega[rows, at], theta))
    energy, omega, theta = (np.concatenate(column) for column in zip(*columns, strict=True))
    return energy, omega, theta


def _edges(low: float, high: float, loop: float | None) -> Real:
    """Return edges of bins from one frequency to another [Hz]."""
    count = math.ceil(math.log(high / low) / math.log(_RATIO))
    edges = low * _RATIO ** np.arange(count + 1)
    if loop is None:
        return edges
    # half cycles: waves have whole numbers of cycles
    halves = np.unique(np.floor(edges * loop)) + 0.5
    kept = [halves[0]]
    for half in (*halves[1:], halves[-1] + 1.0):
        if half >= _RATIO * kept[-1] * (1.0 - 1e-12):
            kept.append(half)
    return np.array(kept) / loop
