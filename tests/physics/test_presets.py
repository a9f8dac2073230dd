"""Seas of the Beaufort scale and of sea states: heights of the scale, periods of the wind."""

import math

import numpy as np
import pytest

from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.physics.moments import significant_wave_height
from fftocean.physics.presets import Preset, beaufort_table, sea_state_table
from fftocean.physics.sea import Sea
from fftocean.physics.spectra import PiersonMoskowitz
from fftocean.physics.spreading import Blend, CosineSquared
from fftocean.physics.units import FOOT, KNOT, NAUTICAL_MILE, feet, knots, nautical_miles

# WMO-No. 306, code table 1100 (knots) and the probable wave heights beside the scale [m].
KNOTS = [
    (0, 0),
    (1, 3),
    (4, 6),
    (7, 10),
    (11, 16),
    (17, 21),
    (22, 27),
    (28, 33),
    (34, 40),
    (41, 47),
    (48, 55),
    (56, 63),
    (64, 64),
]
HEIGHTS = [0.0, 0.1, 0.2, 0.6, 1.0, 2.0, 3.0, 4.0, 5.5, 7.0, 9.0, 11.5, 14.0]
# WMO-No. 306, code table 3700: limits of height [m].
LIMITS = [0.0, 0.0, 0.1, 0.5, 1.25, 2.5, 4.0, 6.0, 9.0, 14.0]


@pytest.fixture(scope="module")
def scale() -> tuple[Preset, ...]:
    return beaufort_table()


@pytest.fixture(scope="module")
def states() -> tuple[Preset, ...]:
    return sea_state_table()


@pytest.mark.parametrize("number", range(13))
def test_beaufort_keeps_its_promise(number, scale):
    """
    Hs by quadrature is the probable wave height of the scale, to the quadrature's own 1e-10; the
    table says the same.
    """
    sea, row = Sea.beaufort(number, direction=30.0), scale[number]
    assert sea.hs == pytest.approx(HEIGHTS[number], rel=1e-10)
    assert row.measured_hs == pytest.approx(row.hs, rel=1e-10)
    assert (row.number, row.hs) == (number, HEIGHTS[number])
    assert row.tp == pytest.approx(sea.tp, rel=1e-6)  # the curve's own peak, found on a grid
    assert all(system.direction == 30.0 for system in sea.systems)


@pytest.mark.parametrize("number", range(1, 10))
def test_sea_states_lie_within_their_limits(number, states):
    """
    The height is the middle of the code table's range; the last has no upper limit and takes its
    lower.
    """
    sea, row = Sea.sea_state(number, direction=-20.0), states[number]
    expected = 0.5 * (LIMITS[number] + LIMITS[number + 1]) if number < 9 else 14.0
    assert sea.hs == pytest.approx(expected, rel=1e-10)
    assert row.measured_hs == pytest.approx(row.hs, rel=1e-10)
    assert row.hs == pytest.approx(expected, rel=1e-15)
    assert sea.systems[0].direction == -20.0


def test_number_0_is_a_flat_sea(scale, states):
    for sea in (Sea.beaufort(0), Sea.sea_state(0), Sea.beaufort(0, depth=7.0)):
        assert sea.systems == ()
        assert sea.hs == sea.tp == 0.0
    assert Sea.beaufort(0) == Sea()
    assert Sea.beaufort(0, depth=7.0) == Sea(depth=7.0)
    assert scale[0].wind == states[0].wind == 0.0


def test_the_winds_in_metres_per_second_and_in_knots_are_one_scale(scale):
    """
    The WMO gives both: middles in m/s fall within the ranges in knots and agree to a knot (5's own
    ranges are 0.8 apart).
    """
    for row, (low, high) in zip(scale, KNOTS, strict=True):
        assert low - 0.5 <= row.wind_knots <= high + 0.5
        assert row.wind_knots == pytest.approx(0.5 * (low + high), abs=1.0)
        assert row.wind_knots * KNOT == pytest.approx(row.wind, rel=1e-15)


def test_the_tables_rise_from_row_to_row(scale, states):
    for table, count in ((scale, 13), (states, 10)):
        assert [row.number for row in table] == list(range(count))
        for column in ("wind", "hs", "tp"):
            values = [getattr(row, column) for row in table]
            assert all(np.diff(values) > 0.0)
        assert len({row.name for row in table}) == count


@pytest.mark.parametrize("number", range(1, 13))
def test_the_period_is_one_that_the_wind_can_give(number, scale):
    """
    Steepness Hs/(g Tp^2/2 pi) lies between a fully developed sea's 0.0256 and 0.04, where the
    youngest of open seas are.
    """
    sea = Sea.beaufort(number)
    steepness = sea.hs * 2.0 * math.pi / (GRAVITY * sea.tp**2)
    assert 0.0255 < steepness < 0.04
    developed = significant_wave_height(PiersonMoskowitz.from_wind(speed=scale[number].wind))
    assert (steepness > 0.026) == (sea.hs < developed)  # young where the wind could raise more


@pytest.mark.parametrize("number", range(1, 10))
def test_sea_states_are_fully_developed(number, states):
    """The row's wind raises just this sea: `PiersonMoskowitz.from_wind` of it is the same curve."""
    row, sea = states[number], Sea.sea_state(number)
    omega = sea.peak * np.geomspace(0.3, 20.0, 101)
    assert sea(omega) == pytest.approx(PiersonMoskowitz.from_wind(speed=row.wind)(omega), rel=1e-9)


def test_a_promise_holds_in_shallow_water_too():
    for sea in (Sea.beaufort(6, depth=10.0), Sea.sea_state(5, depth=10.0)):
        assert sea.depth == 10.0
    assert Sea.beaufort(6, depth=10.0).hs == pytest.approx(3.0, rel=1e-10)
    assert Sea.sea_state(5, depth=10.0).hs == pytest.approx(3.25, rel=1e-10)
    with pytest.raises(ParameterError, match=r"waves that are possible.* in 0\.5 m of water"):
        Sea.beaufort(12, depth=0.5)


def test_spreading_can_be_chosen():
    assert Sea.beaufort(5).systems[0].spreading == Blend()
    assert Sea.sea_state(5, spreading=CosineSquared()).systems[0].spreading == CosineSquared()


@pytest.mark.parametrize("bad", [-1, 13, 6.0, 6.5, "6", True, None, math.nan, math.inf, 10**400])
def test_numbers_off_the_scale_are_refused(bad):
    with pytest.raises(ParameterError, match="number must be a whole number between 0 and 12"):
        Sea.beaufort(bad)
    if bad != 13:
        with pytest.raises(ParameterError, match="number must be a whole number between 0 and 9"):
            Sea.sea_state(bad)


def test_units_are_exact_by_definition():
    assert (NAUTICAL_MILE, FOOT) == (1852.0, 0.3048)
    assert knots(3600.0) == 1852.0
    assert nautical_miles(2.0) == 3704.0
    assert feet(10.0) == pytest.approx(3.048, rel=1e-15)
    for convert in (knots, nautical_miles, feet):
        for bad in (math.nan, math.inf, "5", True, None, 1e308):
            with pytest.raises(ParameterError, match="must be"):
                convert(bad)
