"""The realised spectrum's expected scatter against many seeds."""

import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.realised_spectrum import realised_spectrum, tile_band


def test_expected_scatter_is_that_of_seeds():
    """
    Each bin over 100 seeds: its mean is good to a tenth of its scatter, its standard deviation to
    1/sqrt(200) = 7 %.
    """
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=7.0), spreading=fo.CosinePower(s=0.0)
        )
    )
    edges, _, expected, scatter = realised_spectrum(fo.Ocean(sea, n=8, size=160.0))
    seeds = []
    for seed in range(100):
        m = fo.Ocean(sea, n=8, size=160.0, seed=seed).modes()
        seeds.append(np.histogram(m.omega, edges, weights=m.amplitude**2 / 2)[0])
    strong = expected > 0.02 * np.sum(expected)
    assert np.count_nonzero(strong) >= 3
    assert np.all(
        np.abs(np.mean(seeds, axis=0) - expected)[strong] < 0.4 * scatter[strong]
    )  # four of them
    assert np.std(seeds, axis=0)[strong] == pytest.approx(scatter[strong], rel=0.28)  # four of them
    assert not np.any(realised_spectrum(fo.Ocean(sea, n=8, size=160.0, amplitudes="fixed"))[3])


def test_a_tile_without_waves_has_no_bins():
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=5e4), n=1, size=20.0)
    edges, energy, expected, scatter = realised_spectrum(ocean)
    assert (edges.size, energy.size, expected.size, scatter.size) == (1, 0, 0, 0)


def test_the_band_of_a_tile_reaches_half_a_cell_beyond_its_waves():
    """Deep water: omega^2 = g k."""
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=5e4), n=48, size=400.0)
    dk = 2.0 * math.pi / 400.0
    expected = [math.sqrt(9.80665 * dk * cells) for cells in (0.5, 23.5)]
    assert tile_band(ocean) == pytest.approx(expected)


@pytest.mark.parametrize("turned", [False, True])
def test_the_band_of_an_oblong_tile_is_that_of_both_sides(turned):
    """The longest wave lies along the long side, the shortest along the finest samples."""
    n, size = ((24, 48), (400.0, 100.0)) if not turned else ((48, 24), (100.0, 400.0))
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=5e4), n=n, size=size)
    longest, shortest = 0.5 * 2.0 * math.pi / 400.0, 23.5 * 2.0 * math.pi / 100.0
    expected = [math.sqrt(9.80665 * k) for k in (longest, shortest)]
    assert tile_band(ocean) == pytest.approx(expected)


@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_edges_lie_between_the_frequencies_of_a_loop():
    """Waves have whole cycles: an edge at half a cycle has none of them on it."""
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=5e4), n=32, size=200.0, loop=16.0)
    edges, energy, _, _ = realised_spectrum(ocean)
    cycles = edges * 16.0 / (2.0 * math.pi)
    assert np.abs(cycles - np.floor(cycles) - 0.5).max() < 1e-6
    m = ocean.modes()
    assert np.sum(energy) == pytest.approx(np.sum(0.5 * m.amplitude**2), rel=1e-12)
