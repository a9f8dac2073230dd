"""Fields of `check.json`, from tables of phasors, against the sum that computes each angle."""

import builders_of_packages as build
import numpy as np
import pytest

import fftocean as fo
from fftocean import gerstner
from fftocean.fields import EIGHT
from fftocean.runtime.reference import ROWS, fields_at, points_of, reference_of
from fftocean.runtime.source import Source

TICKS = 2**20


@pytest.mark.parametrize("depth", [30.0, np.inf])
def test_phasors_that_are_looked_up_give_the_direct_sum(depth):
    """
    To 1e-12 of the largest value: angles of up to 1e4 turns, computed, are off by 1e-12 of a turn.
    """
    sea = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=depth, direction=30.0)
    ocean = fo.Ocean(sea, n=(32, 16), size=(61.0, 40.0), loop=64.0, seed=5)
    columns, rows = points_of(ocean.grid, 40)
    moments = [0, 12345, TICKS - 1]
    found = fields_at(ocean, columns, rows, moments, TICKS)
    assert sorted(ROWS) == sorted(EIGHT)
    for j, tick in enumerate(moments):
        x, y = ocean.grid.x[columns], ocean.grid.y[rows]
        expected = gerstner.surface(ocean, x, y, 64.0 * (tick / TICKS))
        for i, name in enumerate(ROWS):
            wanted = getattr(expected, name)
            assert np.abs(found[j, i] - wanted).max() <= 1e-12 * np.abs(wanted).max(), name


def test_phases_are_exact_at_any_tick():
    """A tick and the same tick after many loops give equal bits."""
    ocean = build.cascade("float64").oceans[1]
    columns, rows = points_of(ocean.grid, 4)
    one, other = (
        fields_at(ocean, columns, rows, [tick], TICKS) for tick in (77, 77 + TICKS * 2**20)
    )
    assert np.array_equal(one, other)


def test_moments_are_three_ticks_of_the_loop():
    """First, middle and last; and each once, where the loop has fewer."""
    source = Source.of(build.cascade("float64"))
    for ticks in (2, 4, 1024, TICKS):
        found = reference_of(source, ticks, 2)
        moments = found["moments"]
        assert (moments[0], moments[-1]) == (0, ticks - 1)
        assert len(set(moments)) == len(moments) == min(3, ticks)
        assert moments == sorted(moments)
        for tile in found["tiles"]:
            assert {len(rows) for rows in tile["fields"].values()} == {len(moments)}


def test_points_are_spread_and_occur_once():
    grid = fo.Ocean.from_modes([], n=(32, 16), size=50.0).grid
    columns, rows = points_of(grid, 10_000)
    assert len(set(zip(columns.tolist(), rows.tolist(), strict=True))) == columns.size == 32 * 16
    columns, rows = points_of(grid, 64)
    assert columns.size == rows.size == 64
    assert len(set(columns.tolist())) > 16
    assert len(set(rows.tolist())) > 8
