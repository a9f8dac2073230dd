"""Summary of a sea: against `measure`, the list of waves, and integrals of the spectrum."""

import math

import numpy as np
import pytest
from scipy import integrate

import fftocean as fo
from fftocean.sea_summary import summary

TILES = [(32, 400.0), (32, 51.0)]
SWELL = fo.WaveSystem(
    spectrum=fo.JONSWAP.from_sea_state(hs=1.5, tp=12.0, gamma=7.0),
    spreading=fo.CosinePower(s=25.0),
    direction=110.0,
)
SEAS = {
    "wind sea": fo.Sea.from_wind(speed=11.0, fetch=200e3, direction=30.0),
    "20 m": fo.Sea.from_wind(speed=14.0, fetch=200e3, depth=20.0, direction=-60.0),
    "two systems": fo.Sea(*fo.Sea.from_wind(speed=8.0, fetch=90e3).systems, SWELL),
    "long-crested": fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=8.0),
            spreading=fo.Blend(fo.LongCrested(), fo.CosineSquared(), weight=0.4),
            direction=200.0,
        )
    ),
}


@pytest.mark.parametrize("loop", [64.0, None])
@pytest.mark.parametrize("name", SEAS)
def test_the_sea_states_are_those_of_measure(name, loop):
    """
    `measure` takes the realised waves from frames, and the specified state from adaptive
    quadrature. Spreading at one frequency a panel is within 0.1 degrees.
    """
    water = fo.Cascade(SEAS[name], TILES, seed=5, loop=loop, dtype="float64")
    found, truth = summary(water), fo.measure(water)
    assert truth.specified is not None
    for a, b in ((found.specified, truth.specified), (found.realised, truth)):
        assert a.m0 == pytest.approx(b.m0, rel=1e-6)
        assert a.hs == pytest.approx(b.hs, rel=1e-6)
        assert a.tp == pytest.approx(b.tp, rel=1e-3)
        assert math.remainder(a.mean_direction - b.mean_direction, 360.0) == pytest.approx(
            0.0, abs=0.1
        )
        assert a.spread == pytest.approx(b.spread, abs=0.2)


def test_the_specified_density_is_the_mean_of_the_spectrum():
    sea = SEAS["20 m"]
    found = summary(fo.Cascade(sea, TILES, seed=5))
    for low, high, density in list(zip(found.edges, found.edges[1:], found.density, strict=False))[
        ::5
    ]:
        energy, _ = integrate.quad(sea, 2.0 * math.pi * low, 2.0 * math.pi * high, epsrel=1e-6)
        assert density == pytest.approx(energy / (high - low), rel=2e-3)


@pytest.mark.parametrize("loop", [64.0, 20.0, None])
@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_the_realised_density_is_that_of_the_waves(loop):
    water = fo.Cascade(SEAS["wind sea"], TILES, seed=5, loop=loop)
    found, waves = summary(water), water.modes()
    frequency = waves.omega / (2.0 * np.pi)
    for low, high, density in zip(
        found.edges, found.edges[1:], found.realised_density, strict=False
    ):
        inside = (low <= frequency) & (frequency < high)
        energy = float(np.sum(0.5 * waves.amplitude[inside] ** 2))
        assert density * (high - low) == pytest.approx(energy, rel=1e-9, abs=1e-15)
    assert np.all(found.edges[1:] >= 1.08 * found.edges[:-1] * (1.0 - 1e-9))
    if loop is not None:
        assert found.edges * loop == pytest.approx(np.floor(found.edges * loop) + 0.5, abs=1e-9)


def test_seeds_realise_the_specified_spectrum_on_average():
    """16 seeds, whose m0 scatters by an eighth each; where waves fit the tiles."""
    cascades = [fo.Cascade(SEAS["wind sea"], TILES, seed=s, loop=64.0) for s in range(16)]
    found = [summary(water) for water in cascades]
    mean = np.mean([one.realised_density for one in found], axis=0)
    density, edges = found[0].density, found[0].edges
    held = (edges[:-1] > 0.1) & (edges[1:] < 0.45) & (density > 0.05 * np.max(density))
    assert np.count_nonzero(held) >= 4
    energy = np.diff(edges)[held]
    assert np.sum(mean[held] * energy) == pytest.approx(np.sum(density[held] * energy), rel=0.12)


def test_the_polar_spectrum_holds_the_sea():
    """
    The energy up to its highest frequency, three peaks of the wind sea; midpoints miss a little.
    """
    sea = SEAS["two systems"]
    found = summary(fo.Cascade(sea, TILES, seed=5), rings=64, sectors=36).polar
    assert found.density.shape == (64, 36)
    highest = sea.systems[0].spectrum.peak * 3.0
    assert found.frequency[-1] == pytest.approx(highest / (2.0 * math.pi))
    energy, _ = integrate.quad(sea, 0.0, highest, points=sea.breaks, limit=200)
    cells = np.diff(found.frequency)[:, None] * np.degrees(np.diff(found.theta))
    assert np.sum(found.density * cells) == pytest.approx(energy, rel=0.01)


def test_the_bins_reach_from_the_swell_to_the_ripples_of_a_light_wind():
    swell = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=0.3, tp=16.0, gamma=7.0))
    wind = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=0.2, tp=2.0))
    found = summary(fo.Cascade(fo.Sea(swell, wind), TILES, seed=5, loop=64.0))
    assert found.edges[0] < 0.6 / 16.0
    assert found.edges[-1] > 4.0 / 2.0


def test_plain_data():
    found = summary(fo.Cascade(SEAS["wind sea"], TILES, seed=5, loop=64.0))
    plain = found.as_plain()
    assert list(plain) == ["frequency", "density", "realised"]
    assert {len(column) for column in plain.values()} == {found.edges.size - 1}
    assert all(type(value) is float for column in plain.values() for value in column)
    low, high = found.edges[:2]
    assert low < plain["frequency"][0] < high


def test_a_flat_sea():
    for sea in (fo.Sea(), fo.Sea.beaufort(0)):
        found = summary(fo.Cascade(sea, TILES, loop=64.0))
        assert found.specified == found.realised
        assert (found.specified.hs, found.specified.tp) == (0.0, 0.0)
        assert not np.any(found.density)
        assert not np.any(found.realised_density)
        assert not np.any(found.polar.density)


def test_one_tile():
    ocean = fo.Ocean(SEAS["wind sea"], n=32, size=300.0, seed=5, loop=64.0)
    assert summary(ocean).realised.hs == pytest.approx(fo.measure(ocean).hs, rel=1e-5)


@pytest.mark.parametrize(
    ("source", "rule"),
    [
        (None, "source must be a Cascade or an Ocean, got None"),
        (
            fo.Ocean.from_modes([(1, 2, 0.5, 0.0)], n=16, size=90.0),
            "source must be made of a sea, got the given waves of ",
        ),
    ],
)
def test_what_has_no_sea_is_refused(source, rule):
    with pytest.raises(fo.ParameterError, match=rule):
        summary(source)
