"""Numbers of a run-time package that describe its waves, and those that are measured on fields."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.fields import potential_factor
from fftocean.foam import Foam
from fftocean.foam_coverage import GivenWaves, threshold_for
from fftocean.physics import moments
from fftocean.physics.sea import Sea
from fftocean.runtime.records import Records
from fftocean.runtime.source import Source
from fftocean.slope_variance import beyond_tiles, captured_by_tiles
from fftocean.statistics import folding_over, peak_period, specified
from fftocean.wave_list import oceans_of

MOMENTS = 8
"""Moments of the loop at which bounds are measured."""
DEVIATIONS = 5.0
"""Standard deviations of the bounds that are estimated: 1 in 2 million samples lies beyond."""

Wind = tuple[float, float]
"""Speed 10 m above the sea [m/s], and direction toward which it blows [degrees]."""

_BINS = 64
_LOWEST, _HIGHEST, _FREQUENCIES = 0.2, 30.0, 512  # of a spectrum, in its peak frequency


class WaveTable(NamedTuple):
    """All waves of a package, each array (m,)."""

    kx: Real  # [rad/m]
    ky: Real
    variance: Real  # a^2/2 [m^2]
    cycles: Integer  # in a loop


def wave_table(source: Source, records: Sequence[Records]) -> WaveTable:
    """Return the waves of all tiles, as the records have them."""
    columns = []
    for tile, waves in zip(source.tiles, records, strict=True):
        h0 = waves["re"].astype(np.float64) + 1j * waves["im"]
        columns.append(
            (
                waves["mx"] * tile.grid.dkx,
                waves["my"] * tile.grid.dky,
                2.0 * np.abs(h0) ** 2,
                waves["cycles"].astype(np.int64),
            )
        )
    return WaveTable(*(np.concatenate(column) for column in zip(*columns, strict=True)))


def realised_state(waves: WaveTable, loop: float) -> dict[str, float]:
    """Return Hs [m], Tp [s] and mean direction [degrees] of the waves, averaged over time."""
    direction, _ = moments.mean_direction_and_spread(waves.variance, np.arctan2(waves.ky, waves.kx))
    by_cycles = np.bincount(waves.cycles, weights=waves.variance, minlength=1).astype(np.float64)
    omega = np.arange(by_cycles.size) * (2.0 * np.pi / loop)
    return {
        "hs": 4.0 * math.sqrt(float(np.sum(waves.variance))),
        "tp": peak_period(by_cycles, omega),
        "direction": direction,
    }


def specified_state(sea: Sea | None, *, exact: bool) -> dict[str, float] | None:
    """
    Return Hs [m], Tp [s] and mean direction [degrees] of a sea; None for given waves.

    Unless `exact`, integrals are sums over a fixed grid of frequencies, good to 1 %, and the
    direction is the mean of the systems' own directions, weighted with energy.
    """
    if sea is None:
        return None
    if exact:
        state = specified(sea)
        return {"hs": state.hs, "tp": state.tp, "direction": state.mean_direction}
    energy = np.zeros(len(sea.systems))
    for i, system in enumerate(sea.systems):
        omega = np.geomspace(_LOWEST, _HIGHEST, _FREQUENCIES) * system.spectrum.peak
        energy[i] = np.trapezoid(system.spectrum(omega) * omega, np.log(omega))
    direction, _ = moments.mean_direction_and_spread(
        energy, np.radians([system.direction for system in sea.systems])
    )
    return {"hs": 4.0 * math.sqrt(float(np.sum(energy))), "tp": sea.tp, "direction": direction}


def roughness(source: Source, wind: Wind | None) -> dict[str, list[float]]:
    """Return the slope variance of the tiles, of the whole sea, and beyond the tiles [-]."""
    speed, direction = (None, 0.0) if wind is None else wind
    found = beyond_tiles(captured_by_tiles(source.tiles), speed, direction)
    return {name: list(getattr(found, name)) for name in ("captured", "total", "beyond")}


def foam_for(source: Source, wind: Wind | None) -> dict[str, float]:
    """
    Return parameters of foam: such that it covers what whitecaps do in a wind, if that is known.

    All waves of the tiles count: maps of foam take the tiles' samples as they are, unfiltered.
    """
    foam = Foam()
    threshold = foam.threshold
    if wind is not None:
        waves = GivenWaves(source.tiles, source.choppiness)
        threshold = threshold_for(waves, wind[0], tau=foam.tau, strength=foam.strength)
    return {"decay": foam.tau, "threshold": threshold, "strength": foam.strength}


def spectrum_table(waves: WaveTable, loop: float, sea: Sea | None) -> dict[str, Any] | None:
    """
    Return variance densities [m^2/Hz] of the sea and of the waves, in bins of frequency [Hz].

    The waves of a loop have whole cycles only; the edges of the bins lie half way between these.
    """
    by_cycles = np.bincount(waves.cycles, weights=waves.variance)
    some = np.flatnonzero(by_cycles)
    if not some.size:
        return None
    fine = np.geomspace(float(some[0]), float(some[-1]) + 1.0, _BINS + 1)
    first = np.unique(np.floor(fine + 1e-9).astype(np.int64))  # of each bin, and one beyond
    energy = np.add.reduceat(by_cycles, first[:-1])
    edges = (first - 0.5) / loop
    frequency = 0.5 * (edges[1:] + edges[:-1])
    density = None
    if sea is not None:
        density = _rounded(2.0 * np.pi * sea(2.0 * np.pi * frequency))
    return {
        "frequency": _rounded(frequency),
        "density": density,
        "realised": _rounded(energy / np.diff(edges)),
    }


def _rounded(values: Real) -> list[float]:
    """Return numbers with as many digits as a plot can show."""
    return [float(f"{value:.6g}") for value in values]


def estimated_bounds(waves: WaveTable, source: Source) -> dict[str, Any]:
    """
    Return bounds from the standard deviations of the fields.

    The Jacobian is that of the sum of all stretches, whose standard deviation is known.
    """
    factor = potential_factor(np.hypot(waves.kx, waves.ky), source.tiles[0].depth)
    k2 = waves.kx**2 + waves.ky**2
    along = [waves.variance * (k * factor) ** 2 for k in (waves.kx, waves.ky)]
    reach = [
        DEVIATIONS * math.sqrt(float(np.sum(part)))
        for part in (waves.variance, along[0] + along[1], waves.variance * (k2 * factor) ** 2)
    ]
    return {
        "height": reach[0],
        "displacement": source.choppiness * reach[1],
        "jacobian": 1.0 - source.choppiness * reach[2],
        "moments": 0,
    }


def measured_bounds(source: Source) -> dict[str, Any]:
    """
    Return bounds from the fields at `MOMENTS` moments of the loop.

    Those of several tiles are the sums of what each reaches; the Jacobian is that of their sum.
    """
    oceans = oceans_of(source.water())
    height = moved = 0.0
    for ocean in oceans:
        frames = [
            ocean.loop_frame(j, MOMENTS, ("height", "displace_x", "displace_y"))
            for j in range(MOMENTS)
        ]
        height += max(float(np.max(np.abs(f.height))) for f in frames)
        moved += max(float(np.max(np.hypot(f.displace_x, f.displace_y))) for f in frames)
    folding = folding_over(oceans, MOMENTS, source.loop)
    return {
        "height": height,
        "displacement": source.choppiness * moved,
        "jacobian": folding.min_jacobian,
        "moments": MOMENTS,
    }
