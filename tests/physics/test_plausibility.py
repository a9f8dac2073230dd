"""Limits of real seas, against closed forms and quadrature."""

import math
import warnings

import numpy as np
import pytest

import fftocean as fo
from fftocean.errors import ParameterError, SeaWarning
from fftocean.physics import presets
from fftocean.physics.plausibility import plausibility, steepest

G = 9.80665
TILE = {"n": 16, "size": 60.0}


def sea_of(hs, tp, depth=math.inf):
    return fo.Sea(
        fo.WaveSystem(spectrum=fo.TMA.from_sea_state(hs=hs, tp=tp, depth=depth)), depth=depth
    )


def test_the_limit_of_steepness():
    """1/15 up to 8 s, 1/25 from 15 s on, and half way between in the middle."""
    assert [steepest(tp) for tp in (1.0, 8.0, 15.0, 30.0)] == [1 / 15, 1 / 15, 1 / 25, 1 / 25]
    assert steepest(11.5) == pytest.approx(0.5 * (1 / 15 + 1 / 25), rel=1e-14)


@pytest.mark.parametrize(
    "spectrum",
    [
        fo.JONSWAP.from_sea_state(hs=3.0, tp=9.0, gamma=7.0),
        fo.TMA.from_sea_state(hs=1.0, tp=9.0, depth=4.0),
        fo.Torsethaugen(hs=5.0, tp=11.0),
        fo.OchiHubble.most_probable(hs=4.0),
        fo.Elfouhaily(speed=12.0, fetch=1e5),
        fo.TabulatedSpectrum([0.05, 0.1, 0.11, 0.3], [0.0, 20.0, 0.5, 0.0]),
    ],
)
def test_the_height_is_that_of_quadrature(spectrum):
    sea = fo.Sea(fo.WaveSystem(spectrum=spectrum))
    found = plausibility(sea)
    assert found.hs == pytest.approx(sea.hs, rel=1e-3)
    tp = 2.0 * math.pi / spectrum.peak
    assert found.steepness[0] == pytest.approx(2.0 * math.pi * sea.hs / (G * tp**2), rel=1e-3)


@pytest.mark.parametrize("make", [fo.Ocean, lambda sea, n, size: fo.Cascade(sea, [(n, size)])])
def test_a_sea_too_steep_or_too_high_for_its_depth_is_warned_of(make):
    hs = math.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make(sea_of(0.99 * 64.0 * G / (2.0 * math.pi * 15.0), 8.0), **TILE)
        make(sea_of(1.19, 7.0, depth=2.0), **TILE)
    hs = 1.03 * 64.0 * G / (2.0 * math.pi * 15.0)
    with pytest.warns(
        SeaWarning, match=r"systems\[0\] \(TMA\) are steeper .* is 0.0687 .* at most 0.0667 .*DNV"
    ):
        make(sea_of(hs, 8.0), **TILE)
    with pytest.warns(SeaWarning, match=r"height of 1.3 m is 0.65 of the depth of 2 m: above 0.6"):
        make(sea_of(1.3, 7.0, depth=2.0), **TILE)


@pytest.mark.parametrize("make", [fo.Ocean, lambda sea, n, size: fo.Cascade(sea, [(n, size)])])
def test_a_sea_whose_troughs_bare_the_bed_is_refused(make):
    words = r"depth must be at least the significant wave height, .* got 1 m for waves of 1.1 m"
    with pytest.raises(ParameterError, match=words):
        make(sea_of(1.1, 9.0, depth=1.0), **TILE)


def test_presets_and_seas_of_the_wind_are_all_possible():
    seas = [fo.Sea.beaufort(i) for i in range(13)] + [fo.Sea.sea_state(i) for i in range(10)]
    for speed in (2.0, 10.0, 40.0):
        for x in (101.0, 1e3, 1e5):
            for depth in (0.01, 1.0, 30.0, math.inf):
                fetch = max(x * speed**2 / G, 1.0)
                seas.append(fo.Sea.from_wind(speed=speed, fetch=fetch, depth=depth))
    assert [str(found) for sea in seas if (found := plausibility(sea)).notes] == []
    assert len(presets.beaufort_table()) == 13


def test_a_flat_sea_has_no_steepness():
    assert str(plausibility(fo.Sea())) == "a flat sea"
    assert plausibility(fo.Sea()).as_plain()["steepness"] == []


def test_systems_are_judged_each_by_its_own_period():
    """A long swell with much energy does not make the short sea upon it steep."""
    swell = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=8.0, tp=18.0))
    wind = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=0.3, tp=2.5))
    found = plausibility(fo.Sea(swell, wind))
    assert found.notes == ()
    assert found.hs == pytest.approx(math.hypot(8.0, 0.3), rel=1e-3)
    assert np.all(np.array(found.steepness) < found.limits)
