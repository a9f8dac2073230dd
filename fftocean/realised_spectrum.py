"""Realised frequency spectrum of an ocean's waves."""

import math
from typing import NamedTuple

import numpy as np

from fftocean.arrays import Real
from fftocean.ocean import Ocean
from fftocean.physics import dispersion

_WAVES_A_BIN = 4  # with the opposite waves, eight
_CELLS_A_BIN = 1.0  # in rings of wavenumbers closer than this the number of cells fluctuates


class RealisedSpectrum(NamedTuple):
    """Energy of an ocean's waves in bins of frequency."""

    edges: Real  # of the bins, (b + 1,) [rad/s]
    energy: Real  # a^2/2 of the waves, (b,) [m^2]
    expected: Real  # its mean over seeds, (b,) [m^2]
    scatter: Real  # its standard deviation from seed to seed, (b,) [m^2]


def realised_spectrum(ocean: Ocean) -> RealisedSpectrum:
    """
    Sum the energy of an ocean's waves in bins of frequency, each wide enough for several waves.

    The waves of a loop have a few frequencies only; the edges of their bins lie half way between
    these.

    Args:
        ocean: any ocean.

    Returns:
        `RealisedSpectrum`. Its bins hold every wave of the tile; a tile without waves has no bins.

    Pinned by tests/test_realised_spectrum.py, against sums over the list of waves and many seeds.
    """
    a, grid = ocean.amplitudes, ocean.grid
    once = grid.active & ((grid.mx[None, :] > 0) | (grid.my[:, None] > 0))
    omega = a.running_omega[once]
    if not omega.size:
        return RealisedSpectrum(np.zeros(1), np.zeros(0), np.zeros(0), np.zeros(0))
    highest = float(np.max(omega))
    lowest = tile_band(ocean)[0]
    step = (mean_frequency(ocean) or highest) / 24.0
    if ocean.loop is not None and 2.0 * math.pi / ocean.loop > step:
        step = 2.0 * math.pi / ocean.loop
        lowest = 0.5 * step
    fine = np.arange(min(lowest, float(np.min(omega))), highest + 2.0 * step, step)
    edges = _bin_edges(ocean, omega, fine)
    m = ocean.modes()
    energy, _ = np.histogram(m.omega, edges, weights=0.5 * m.amplitude**2)
    forward, backward = a.variance_forward[once], a.variance_backward[once]
    expected, _ = np.histogram(omega, edges, weights=forward + backward)
    square, _ = np.histogram(omega, edges, weights=forward**2 + backward**2)
    free = a.draw in ("gaussian", "constrained")
    scatter = np.sqrt(square) if free else np.zeros_like(square)
    return RealisedSpectrum(edges, energy, expected, scatter)


def tile_band(ocean: Ocean) -> tuple[float, float]:
    """
    Return the lowest and highest frequency that a tile's cells reach along the axes [rad/s].
    """
    grid, a = ocean.grid, ocean.amplitudes
    reach_x, reach_y = grid.reach
    low = min(grid.dkx, grid.dky) / 2.0
    high = max((reach_x + 0.5) * grid.dkx, (reach_y + 0.5) * grid.dky)
    lowest, highest = (
        float(dispersion.angular_frequency(k, a.depth, a.surface_tension)) for k in (low, high)
    )
    return lowest, highest


def mean_frequency(ocean: Ocean) -> float:
    """Return the energy-weighted mean frequency of an ocean's waves [rad/s]; 0 without waves."""
    m = ocean.modes()
    energy = m.amplitude**2
    total = float(np.sum(energy))
    return float(np.sum(energy * m.omega)) / total if total > 0.0 else 0.0


def _bin_edges(ocean: Ocean, omega: Real, fine: Real) -> Real:
    """
    Merge fine bins until each holds several waves and several rings of wavenumbers.

    Args:
        ocean: the ocean.
        omega: the frequency of each wave [rad/s].
        fine: edges of the fine bins, ascending [rad/s].
    """
    a, grid = ocean.amplitudes, ocean.grid
    waves, _ = np.histogram(omega, fine)
    k = dispersion.wavenumber(fine, a.depth, a.surface_tension) / max(grid.dkx, grid.dky)
    edges, held, since = [fine[0]], 0, k[0]
    for i, count in enumerate(waves, 1):
        held += count
        if held >= _WAVES_A_BIN and k[i] - since >= _CELLS_A_BIN:
            edges.append(fine[i])
            held, since = 0, k[i]
    if len(edges) == 1 or held:
        edges.append(fine[-1])
    return np.asarray(edges)
