"""Slope variance: fields of frames, an integral of the spectrum, and the numbers of Cox & Munk."""

import math

import numpy as np
import pytest
from scipy import integrate

import fftocean as fo
from fftocean.slope_variance import FLOOR, captured_by, cox_munk, slope_variance

GRAVITY = 9.80665
TILES = [(64, 300.0), (64, 43.0), (64, 7.1)]


def cascade(speed=11.0, direction=30.0, **more):
    sea = fo.Sea.from_wind(
        speed=speed, fetch=150e3, direction=direction, spreading=fo.CosineSquared()
    )
    return fo.Cascade(sea, TILES, seed=4, **more)


def matrix(entries):
    xx, yy, xy = entries
    return np.array([[xx, xy], [xy, yy]])


def test_captured_is_the_variance_of_the_slopes_of_frames():
    """
    With fixed amplitudes and all waves before the wind, +k and -k never beat: each frame has it.

    Waves across the wind, at 90 degrees, are the exception, and carry next to nothing.
    """
    water = cascade(direction=0.0, amplitudes="fixed", dtype="float64")
    frames = water.frame(12.3, ("slope_x", "slope_y"))
    measured = [
        sum(float(np.mean(f[a] * f[b])) for f in frames)
        for a, b in (("slope_x", "slope_x"), ("slope_y", "slope_y"), ("slope_x", "slope_y"))
    ]
    assert captured_by(water) == pytest.approx(measured, rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("direction", [0.0, 30.0, 200.0])
def test_captured_is_an_integral_of_the_spectrum(direction):
    """
    The integral of k^2 S(k) over the tiles' wavenumbers, and of the directions with cos^2: 3/4 of
    it along the mean direction, 1/4 across.

    In each direction the integral ends at the square of the last tile's cells. Cells are summed at
    their centres: 2 %.
    """
    spectrum = fo.JONSWAP.from_wind(speed=11.0, fetch=150e3)
    half = 2.0 * math.pi / 7.1 * 31.5  # of the side of the square, which the last tile reaches

    def density(log_k):
        k = math.exp(log_k)
        omega = math.sqrt(GRAVITY * k)
        return k * k * float(spectrum(omega)) * 0.5 * omega

    def within(theta):
        """Directions are weighted as the waves are; along each the square ends elsewhere."""
        edge = half / max(abs(math.cos(theta)), abs(math.sin(theta)))
        value, _ = integrate.quad(density, math.log(0.01), math.log(edge), limit=200)
        return value

    mean = math.radians(direction)
    theta = mean + (np.arange(180) + 0.5) * (math.pi / 180.0) - 0.5 * math.pi
    weight = 2.0 / math.pi * np.cos(theta - mean) ** 2 * (math.pi / 180.0)
    radial = np.array([within(t) for t in theta])
    expected = [
        float(np.sum(weight * radial * product))
        for product in (np.cos(theta) ** 2, np.sin(theta) ** 2, np.sin(theta) * np.cos(theta))
    ]
    found = captured_by(cascade(direction=direction))
    assert found == pytest.approx(expected, rel=0.02, abs=0.02 * max(expected))


@pytest.mark.parametrize(
    ("wind", "direction", "expected"),
    [
        (10.0, 0.0, (0.0316, 0.0222, 0.0)),
        (10.0, 90.0, (0.0222, 0.0316, 0.0)),
        (10.0, 180.0, (0.0316, 0.0222, 0.0)),
        (10.0, 45.0, (0.0269, 0.0269, 0.0047)),
        (10.0, -45.0, (0.0269, 0.0269, -0.0047)),
        (0.0, 0.0, (0.0, 0.003, 0.0)),
    ],
)
def test_the_numbers_of_cox_and_munk(wind, direction, expected):
    assert cox_munk(wind, direction) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("direction", [0.0, 30.0, 77.0, 181.0, 300.0])
def test_captured_and_beyond_are_the_total(direction):
    """The total is rotated by matrices, with its mean square along and across written out."""
    water = cascade(direction=direction)
    result = slope_variance(water, wind_speed=11.0, wind_direction=direction)
    turn = np.array(
        [
            [math.cos(math.radians(direction)), -math.sin(math.radians(direction))],
            [math.sin(math.radians(direction)), math.cos(math.radians(direction))],
        ]
    )
    total = turn @ np.diag([0.00316 * 11.0, 0.003 + 0.00192 * 11.0]) @ turn.T
    assert matrix(result.total) == pytest.approx(total, abs=1e-12)
    assert not result.raised
    assert matrix(result.captured) + matrix(result.beyond) == pytest.approx(total, abs=1e-12)
    assert np.min(np.linalg.eigvalsh(matrix(result.beyond))) >= FLOOR


def test_more_waves_than_the_wind_has_leave_the_floor():
    """The nearest matrix whose eigenvalues are at least the floor has the same eigenvectors."""
    water = cascade(speed=20.0)
    result = slope_variance(water, wind_speed=5.0, wind_direction=75.0)
    assert result.raised
    beyond = matrix(result.beyond)
    assert np.min(np.linalg.eigvalsh(beyond)) == pytest.approx(FLOOR, rel=1e-9)
    rest = matrix(result.total) - matrix(result.captured)
    assert beyond @ rest == pytest.approx(rest @ beyond, abs=1e-12)  # they commute


def test_without_a_wind_the_floor_is_beyond_the_tiles():
    result = slope_variance(cascade())
    assert result.beyond == (FLOOR, FLOOR, 0.0)
    assert matrix(result.total) == pytest.approx(matrix(result.captured) + FLOOR * np.eye(2))


def test_one_tile_and_flat_water():
    assert captured_by(fo.Ocean(fo.Sea(), n=16, size=50.0)) == (0.0, 0.0, 0.0)
    flat = slope_variance(fo.Cascade(fo.Sea(), TILES), wind_speed=0.0)
    assert flat.raised
    assert flat.beyond == pytest.approx((FLOOR, 0.003, 0.0))


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"source": None}, "source must be a Cascade or an Ocean, got None"),
        ({"wind_speed": -1.0}, "wind_speed must be"),
        ({"wind_direction": math.nan}, "wind_direction must be"),
    ],
)
def test_values_out_of_range_are_refused(change, rule):
    given = {"source": fo.Cascade(fo.Sea(), TILES), "wind_speed": 10.0, **change}
    with pytest.raises(fo.ParameterError, match=rule):
        slope_variance(given.pop("source"), **given)
