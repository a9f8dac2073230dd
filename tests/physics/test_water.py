"""
One water under a sea and its parts: taken from the part that states it, refused where two differ.
"""

import math
import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest

import fftocean as fo
from fftocean.constants import GRAVITY, SURFACE_TENSION, WATER_DENSITY
from fftocean.errors import ParameterError, SeaWarning
from fftocean.physics.spreading import ElfouhailySpreading

JONSWAP = fo.JONSWAP.from_wind(speed=12.0, fetch=100e3)
TMA = fo.WaveSystem(spectrum=fo.TMA(JONSWAP, depth=40.0))
RIPPLES = fo.WaveSystem(spectrum=fo.Elfouhaily(speed=10.0))


def slope_variance(density, k):
    """Integral of k^2 F over wavenumbers, by the trapezium rule."""
    return np.trapezoid(k**2 * density, k)


def test_the_slopes_of_a_sea_of_ripples_are_those_of_its_spectrum():
    """
    The slope variance is the integral of k^2 F(k), and F(k) = S(omega) d omega/dk with the
    dispersion of the sea.

    That is written out here, omega^2 = g k + (sigma/rho) k^3, so that only the sea's own tension is
    asked of it.
    """
    k = np.geomspace(1e-2, 3e3, 20_001)
    sea = fo.Sea(RIPPLES)
    omega = np.sqrt(GRAVITY * k + sea.surface_tension / WATER_DENSITY * k**3)
    slope = (GRAVITY + 3.0 * sea.surface_tension / WATER_DENSITY * k**2) / (2.0 * omega)
    expected = slope_variance(RIPPLES.spectrum.wavenumber_density(k), k)
    assert slope_variance(sea(omega) * slope, k) == pytest.approx(expected, rel=1e-9)
    assert expected == pytest.approx(
        3e-3 + 5.12e-3 * 10.0, rel=0.2
    )  # Cox & Munk 1954, to 20 % as documented


def test_a_sea_takes_the_water_that_its_parts_state():
    assert fo.Sea(TMA).depth == 40.0
    assert fo.Sea(TMA, depth=40.0).depth == 40.0
    assert fo.Sea(TMA).depth_from == "systems[0].spectrum (TMA)"
    assert fo.Sea(RIPPLES).surface_tension == SURFACE_TENSION
    assert fo.Sea(RIPPLES).surface_tension_from == "systems[0].spectrum (Elfouhaily)"
    plain = fo.Sea(fo.WaveSystem(spectrum=JONSWAP))
    assert (plain.depth, plain.surface_tension) == (math.inf, 0.0)
    assert plain.depth_from is plain.surface_tension_from is None
    assert fo.Sea().depth == math.inf
    ocean = fo.Ocean(fo.Sea(RIPPLES), n=8, size=2.0)
    assert ocean.amplitudes.surface_tension == SURFACE_TENSION
    assert fo.Ocean(fo.Sea(TMA), n=8, size=200.0).depth == 40.0


def test_the_water_stays_with_a_copy():
    sea = fo.Sea(TMA)
    assert replace(sea) == sea == pickle.loads(pickle.dumps(sea))
    assert replace(sea).depth_from == sea.depth_from
    assert replace(sea, surface_tension=0.07).surface_tension == 0.07
    shallower = fo.WaveSystem(spectrum=replace(TMA.spectrum, depth=20.0))
    assert replace(sea, systems=(shallower,), depth=20.0).depth == 20.0
    with pytest.raises(ParameterError, match="got 40 m for the sea and 20 m"):
        replace(sea, systems=(shallower,))


class Sum:
    """A spectrum that holds others in a list, as a user may write it."""

    peak = 1.0

    def __init__(self, *parts):
        self.parts = parts

    def __call__(self, omega):
        return sum(part(omega) for part in self.parts)


NARROW = ElfouhailySpreading(friction_velocity=0.3, depth=25.0, surface_tension=0.05)


@pytest.mark.parametrize(
    ("system", "name", "value", "part"),
    [
        (
            fo.WaveSystem(spectrum=Sum(JONSWAP, fo.TMA(JONSWAP, 25.0))),
            "depth",
            25.0,
            "spectrum.parts[1] (TMA)",
        ),
        (
            fo.WaveSystem(spectrum=fo.CustomSpectrum(fo.TMA(JONSWAP, 25.0), peak=1.0)),
            "depth",
            25.0,
            "spectrum.function (TMA)",
        ),
        (
            fo.WaveSystem(spectrum=fo.TMA(fo.Elfouhaily(speed=10.0), 25.0)),
            "surface_tension",
            SURFACE_TENSION,
            "spectrum.spectrum (Elfouhaily)",
        ),
        (
            fo.WaveSystem(spectrum=fo.Phillips(speed=8.0, amplitude=1e-3, depth=25.0)),
            "depth",
            25.0,
            "spectrum (Phillips)",
        ),
        (
            fo.WaveSystem(spectrum=fo.TabulatedSpectrum((0.1, 0.2), (1.0, 1.0), depth=25)),
            "depth",
            25.0,
            "spectrum (TabulatedSpectrum)",
        ),
        (
            fo.WaveSystem(spectrum=JONSWAP, spreading=fo.Blend(fo.DonelanBanner(), NARROW)),
            "depth",
            25.0,
            "spreading.second (ElfouhailySpreading)",
        ),
        (
            fo.WaveSystem(spectrum=JONSWAP, spreading=fo.SwellElongation(NARROW, xi=0.2)),
            "surface_tension",
            0.05,
            "spreading.base (ElfouhailySpreading)",
        ),
        (fo.WaveSystem(spectrum=fo.Sea(TMA)), "depth", 40.0, "spectrum (Sea)"),
    ],
)
def test_parts_within_parts_are_heard_and_may_not_differ(system, name, value, part):
    sea = fo.Sea(system)
    assert getattr(sea, name) == value
    assert getattr(sea, f"{name}_from") == f"systems[0].{part}"
    assert fo.Sea(system, **{name: value}) == sea
    assert (
        fo.Sea(system, **{name: value * (1.0 + 1e-12)}).systems == sea.systems
    )  # what a change of units leaves
    with pytest.raises(ParameterError) as refused:
        fo.Sea(system, **{name: 0.5 * value})
    for text in (name, f"{0.5 * value:g}", f"{value:g}", part):
        assert text in str(refused.value)


def nested(times):
    part = fo.TMA(JONSWAP, 25.0)
    for _ in range(times):
        part = Sum(part)
    return fo.WaveSystem(spectrum=part)


@pytest.mark.parametrize("times", [2, 5, 16])
def test_statements_are_found_sixteen_parts_deep(times):
    """A statement deeper down is not looked for, so an object that holds itself ends the search."""
    assert fo.Sea(nested(times)).depth == 25.0
    assert (
        fo.Sea(nested(times)).depth_from == "systems[0].spectrum" + ".parts[0]" * times + " (TMA)"
    )
    assert fo.Sea(nested(17)).depth == math.inf
    endless = Sum(JONSWAP)
    endless.itself = endless
    assert fo.Sea(fo.WaveSystem(spectrum=endless)).depth == math.inf


def test_two_parts_of_two_waters_are_refused():
    with pytest.raises(
        ParameterError,
        match=r"got 40 m for systems\[0\]\.spectrum \(TMA\) and inf m for systems\[1\]",
    ):
        fo.Sea(TMA, RIPPLES)
    with pytest.raises(
        ParameterError, match=r"surface_tension .* 0\.05 N/m for systems\[0\]\.spreading"
    ):
        fo.Sea(fo.WaveSystem(spectrum=JONSWAP, spreading=replace(NARROW, depth=math.inf)), RIPPLES)
    with pytest.raises(
        ParameterError,
        match=r"got 0 N/m for the sea and 0\.074 N/m for systems\[0\]\.spectrum \(Elfo",
    ):
        fo.Sea(RIPPLES, surface_tension=0.0)
    with pytest.raises(
        ParameterError,
        match=r"must be one of deep water, which TMA carries into 20 m, got spectrum",
    ):
        fo.TMA(fo.TMA(JONSWAP, 40.0), 20.0)
    with pytest.raises(ParameterError, match="got 50 m for the sea and 10 m"):
        fo.Sea(fo.WaveSystem(spectrum=fo.TMA(JONSWAP, 10.0)), depth=50.0)
    with pytest.raises(ParameterError, match="depth must be at least 1e-06 m"):
        fo.Sea(TMA, depth=-1.0)


def test_a_wind_that_differs_within_a_system_is_warned_of():
    with pytest.warns(
        SeaWarning,
        match=r"wind speed .* 10 m/s for its spectrum \(Elfouhaily\) and 20 m/s for its spr",
    ):
        fo.WaveSystem(spectrum=fo.Elfouhaily(speed=10.0), spreading=fo.Hasselmann(20.0))
    with pytest.warns(SeaWarning, match="friction velocity"):
        fo.WaveSystem(
            spectrum=fo.Elfouhaily(speed=10.0), spreading=fo.Elfouhaily(speed=12.0).spreading
        )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fo.WaveSystem(
            spectrum=fo.Elfouhaily(speed=10.0), spreading=fo.Elfouhaily(speed=10.0).spreading
        )
        fo.WaveSystem(spectrum=fo.Elfouhaily(speed=10.0), spreading=fo.Mitsuyasu(10.0))
        fo.WaveSystem(spectrum=JONSWAP, spreading=fo.Mitsuyasu(10.0))


def test_a_sea_shows_where_its_water_is_from():
    assert repr(fo.Sea(TMA)).endswith("depth=40 by systems[0].spectrum (TMA))")
    assert "surface_tension=0.074 by systems[0].spectrum (Elfouhaily)" in repr(fo.Sea(RIPPLES))
    assert repr(fo.Sea(depth=30.0)) == "Sea(depth=30)"
