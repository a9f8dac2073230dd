"""Sums of wave systems over one depth, their directions, and seas as frozen values."""

import math
import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest

from fftocean.constants import SURFACE_TENSION
from fftocean.errors import ParameterError, SeaWarning
from fftocean.physics.moments import mean_direction_and_spread, moment, peak_period
from fftocean.physics.sea import Sea, WaveSystem, from_compass
from fftocean.physics.spectra import (
    JONSWAP,
    TMA,
    CustomSpectrum,
    FrequencySpectrum,
    PiersonMoskowitz,
    TabulatedSpectrum,
)
from fftocean.physics.spreading import Blend, CosinePower, CosineSquared, DonelanBanner

WIND_SEA = WaveSystem(
    spectrum=JONSWAP.from_sea_state(hs=3.0, tp=7.0), spreading=CosinePower(s=8.0), direction=30.0
)
SWELL = WaveSystem(
    spectrum=JONSWAP.from_sea_state(hs=1.5, tp=14.0, gamma=7.0),
    spreading=CosinePower(s=25.0),
    direction=110.0,
)
OMEGA = np.geomspace(0.1, 10.0, 301)
THETA = np.linspace(-math.pi, math.pi, 360, endpoint=False)


@pytest.mark.parametrize(
    ("bearing", "direction"),
    [
        (270.0, 0.0),
        (180.0, 90.0),
        (0.0, 270.0),
        (90.0, 180.0),
        (360.0, 270.0),
        (-90.0, 0.0),
        (225.0, 45.0),
        (630.0, 0.0),
        (269.5, 0.5),
    ],
)
def test_compass_bearings(bearing, direction):
    """
    A westerly comes from 270 and goes east, 0; a southerly comes from 180 and goes north, 90; from
    north, 0, goes south, 270.
    """
    assert from_compass(bearing) == direction


def test_compass_follows_the_vectors():
    """Toward = minus the vector (sin b, cos b) (east, north) that points to where it comes from."""
    for bearing in np.linspace(-720.0, 720.0, 97):
        toward, b = math.radians(from_compass(float(bearing))), math.radians(bearing)
        assert (math.cos(toward), math.sin(toward)) == pytest.approx(
            (-math.sin(b), -math.cos(b)), abs=1e-14
        )
        assert 0.0 <= from_compass(float(bearing)) < 360.0


def test_systems_add():
    sea = Sea(WIND_SEA, SWELL, depth=40.0)
    assert sea.systems == (WIND_SEA, SWELL)
    assert np.array_equal(sea(OMEGA), WIND_SEA.spectrum(OMEGA) + SWELL.spectrum(OMEGA))
    assert np.array_equal(
        sea.density(OMEGA[:, None], THETA),
        WIND_SEA.density(OMEGA[:, None], THETA) + SWELL.density(OMEGA[:, None], THETA),
    )
    assert sea.variance == pytest.approx((3.0**2 + 1.5**2) / 16.0, rel=1e-10)
    assert sea.hs == pytest.approx(math.hypot(3.0, 1.5), rel=1e-10)
    assert moment(sea, 0) == pytest.approx(sea.variance, rel=1e-10)  # all at once, or one by one


def test_directions_integrate_to_the_frequency_spectrum():
    """cos^2s with whole s is a trigonometric polynomial: 360 equal steps are exact."""
    sea = Sea(WIND_SEA, SWELL)
    assert np.sum(sea.density(OMEGA[:, None], THETA), axis=1) * (
        2.0 * math.pi / 360
    ) == pytest.approx(sea(OMEGA), rel=1e-13)


@pytest.mark.parametrize("direction", [0.0, 30.0, 110.0, 269.0, -45.0, 720.0, 1e6])
def test_waves_go_where_they_are_sent(direction):
    """
    `direction` is toward, counter-clockwise from +x: the density is highest there, and the mean
    direction is it.
    """
    system = replace(WIND_SEA, direction=direction)
    energy = system.density(WIND_SEA.spectrum.peak, THETA)
    mean, _ = mean_direction_and_spread(energy, THETA)
    assert math.cos(math.radians(mean - direction)) == pytest.approx(1.0, abs=1e-14)
    assert (
        abs((math.degrees(THETA[np.argmax(energy)]) - direction + 180.0) % 360.0 - 180.0)
        <= 0.5 + 1e-6
    )


def test_spreading_scales_with_its_own_system():
    """
    Donelan-Banner looks at omega over the peak of *its* system: the swell is broad where the wind
    sea peaks.
    """
    swell = replace(SWELL, spreading=DonelanBanner(), direction=0.0)
    omega = WIND_SEA.spectrum.peak  # twice the swell's
    assert swell.density(omega, 0.0) == swell.spectrum(omega) * DonelanBanner()(2.0, 0.0, 1.0)


def test_peak_and_corners_of_a_sea():
    sea = Sea(WIND_SEA, SWELL)
    assert WIND_SEA.spectrum(WIND_SEA.spectrum.peak) > SWELL.spectrum(SWELL.spectrum.peak)
    assert sea.peak == WIND_SEA.spectrum.peak
    assert sea.breaks == (SWELL.spectrum.peak, WIND_SEA.spectrum.peak)
    assert (
        sea.tp == peak_period(sea) == pytest.approx(2.0 * math.pi / sea.peak, rel=1e-3)
    )  # the other's flank shifts it a little
    table = TabulatedSpectrum((0.05, 0.1, 0.2), (0.0, 1.0, 0.0))
    assert set(table.breaks) < set(Sea(WIND_SEA, WaveSystem(spectrum=table)).breaks)


def test_no_system_is_a_flat_sea():
    sea = Sea(depth=10.0)
    assert sea.systems == ()
    assert sea.variance == sea.hs == sea.tp == 0.0
    assert np.array_equal(sea(OMEGA), np.zeros_like(OMEGA))
    assert sea.density(OMEGA[:, None], THETA).shape == (OMEGA.size, THETA.size)
    assert not np.any(sea.density(OMEGA[:, None], THETA))
    assert sea.peak > 0.0
    assert sea.breaks == ()


def test_still_air_is_a_flat_sea_and_says_so():
    with pytest.warns(
        SeaWarning, match="wind speed 0 m/s raises no waves: the sea is exactly flat"
    ):
        sea = Sea.from_wind(speed=0.0, fetch=200e3, depth=40.0)
    assert sea.hs == 0.0
    assert sea.tp == 0.0
    assert not np.any(sea(np.geomspace(1e-6, 1e6, 301)))
    assert not np.any(sea.density(OMEGA[:, None], THETA))


def test_the_short_way_is_the_long_way():
    short = Sea.from_wind(speed=14.0, fetch=200e3, depth=40.0, direction=30.0)
    system = WaveSystem(
        spectrum=TMA.from_wind(speed=14.0, fetch=200e3, depth=40.0),
        spreading=Blend(DonelanBanner(), CosineSquared(), weight=0.5),
        direction=30.0,
    )
    assert short == Sea(system, depth=40.0)
    assert (
        Sea.from_wind(speed=14.0, fetch=200e3, spreading=CosineSquared()).systems[0].spreading
        == CosineSquared()
    )
    assert (
        Sea.from_wind(speed=30.0, fetch=200e3, gamma=7.0).systems[0].spectrum.spectrum.gamma == 7.0
    )  # still growing
    deep = Sea.from_wind(speed=14.0, fetch=200e3)
    assert deep.depth == math.inf
    assert np.array_equal(deep(OMEGA), JONSWAP.from_wind(speed=14.0, fetch=200e3)(OMEGA))


def test_a_sea_is_a_spectrum():
    """
    A sea can be carried into depth, added to another sea and integrated, since it is called with
    omega and has a peak.
    """
    sea = Sea(WIND_SEA, SWELL)
    assert isinstance(sea, FrequencySpectrum)
    assert Sea(WaveSystem(spectrum=sea), WIND_SEA)(0.8) == pytest.approx(
        2.0 * WIND_SEA.spectrum(0.8) + SWELL.spectrum(0.8), rel=1e-15
    )
    assert np.shape(sea(1.0)) == np.shape(sea.density(1.0, 0.0)) == ()
    assert sea([0.0, -1.0, math.inf]).tolist() == [0.0, 0.0, 0.0]


def test_a_sea_is_a_value():
    sea = Sea(WIND_SEA, SWELL, depth=40.0, surface_tension=SURFACE_TENSION)
    assert sea == Sea(systems=(WIND_SEA, SWELL), depth=40.0, surface_tension=SURFACE_TENSION)
    assert sea == Sea(
        WIND_SEA, systems=[SWELL], depth=np.int64(40), surface_tension=SURFACE_TENSION
    )
    assert sea != Sea(SWELL, WIND_SEA, depth=40.0, surface_tension=SURFACE_TENSION)
    assert len({sea, replace(sea), pickle.loads(pickle.dumps(sea)), replace(sea, depth=50.0)}) == 2
    assert replace(sea, depth=50.0) == Sea(
        WIND_SEA, SWELL, depth=50.0, surface_tension=SURFACE_TENSION
    )
    assert replace(sea, systems=(SWELL,)).systems == (SWELL,)
    assert replace(sea, surface_tension=0.0).surface_tension == 0.0
    for name in ("depth", "dept"):
        with pytest.raises((AttributeError, TypeError)):
            setattr(sea, name, 10.0)
    with pytest.raises(
        ParameterError, match=r"depth must be at least 1e-06 m \(inf is allowed\), got -1\.0"
    ):
        replace(sea, depth=-1.0)


def test_a_system_is_a_value():
    assert replace(WIND_SEA, direction=40) == WaveSystem(
        spectrum=WIND_SEA.spectrum, spreading=WIND_SEA.spreading, direction=40.0
    )
    assert len({WIND_SEA, replace(WIND_SEA), pickle.loads(pickle.dumps(WIND_SEA))}) == 1
    assert WaveSystem(spectrum=PiersonMoskowitz(peak=0.7)).spreading == DonelanBanner()
    for name in ("direction", "dir"):
        with pytest.raises((AttributeError, TypeError)):
            setattr(WIND_SEA, name, 10.0)


@pytest.mark.parametrize("bad", [5, None, np.sin, JONSWAP, "jonswap"])
def test_what_is_no_spectrum_is_refused(bad):
    with pytest.raises(
        ParameterError, match=r"spectrum must be callable and have a peak \(wrap a plain function"
    ):
        WaveSystem(spectrum=bad)


@pytest.mark.parametrize("bad", [5, None, DonelanBanner, "cos2"])
def test_what_is_no_spreading_is_refused(bad):
    with pytest.raises(
        ParameterError, match=r"spreading must be callable as D\(omega, theta, peak\), got "
    ):
        WaveSystem(spectrum=PiersonMoskowitz(peak=0.7), spreading=bad)


def test_a_spreading_that_is_false_is_refused_too():
    with pytest.raises(ParameterError, match="spreading must be callable"):
        Sea.from_wind(speed=10.0, fetch=1e5, spreading=0)


@pytest.mark.parametrize("bad", [5, None, PiersonMoskowitz(peak=0.7), "swell", (WIND_SEA,)])
def test_what_is_no_system_is_refused(bad):
    with pytest.raises(ParameterError, match="a sea must be made of WaveSystem values, got "):
        Sea(bad)
    with pytest.raises(ParameterError, match="a sea must be made of WaveSystem values, got "):
        Sea(systems=(WIND_SEA, bad))
    if not isinstance(bad, tuple):
        with pytest.raises(ParameterError, match="a sea must be made of WaveSystem values, got "):
            Sea(systems=bad)


def test_misspelt_keys_are_refused():
    with pytest.raises(TypeError, match="gama"):
        Sea.from_wind(speed=10.0, fetch=1e5, gama=2.0)
    with pytest.raises(TypeError):
        WaveSystem(
            PiersonMoskowitz(peak=0.7), CosineSquared(), 30.0
        )  # keyword-only: direction and spreading are easily swapped


@pytest.mark.parametrize("depth", [1e-6, 1e-3, 1.0, 50.0, 1e308, math.inf])
@pytest.mark.parametrize("speed", [1e-3, 0.1, 12.0, 150.0])
def test_no_wind_over_any_depth_gives_anything_but_a_finite_sea(speed, depth):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "a fetch of")
        for fetch in (1.0, 1e4, 5e7):
            sea = Sea.from_wind(speed=speed, fetch=fetch, depth=depth)
            omega = sea.peak * np.geomspace(1e-3, 1e3, 61)
            density = sea.density(omega[:, None], np.linspace(-7.0, 7.0, 29))
            assert np.all((density >= 0.0) & (density < math.inf))
            assert np.max(density) > 0.0


def test_plain_functions_are_wrapped_first():
    """
    A spectrum to name its peak, a spreading to see to its integral; an own class may do as it
    likes.
    """
    spectrum = CustomSpectrum(lambda w: np.exp(-w), peak=1.0)
    with pytest.raises(ParameterError, match=r"spreading must integrate to 1 .* CustomSpreading"):
        WaveSystem(spectrum=spectrum, spreading=lambda _omega, theta, _peak: np.exp(-np.abs(theta)))

    class Front:
        def __call__(self, _omega, theta, _peak, /):
            return np.exp(-np.abs(theta))

    sea = Sea(WaveSystem(spectrum=spectrum, spreading=Front()))
    assert sea.variance == pytest.approx(1.0, rel=1e-10)  # the integral of e^-w
    assert sea.density(1.0, 0.5) == pytest.approx(math.exp(-1.5), rel=1e-14)
