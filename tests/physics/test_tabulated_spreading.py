"""Tabulated spreading: normalisation, interpolation and refusals."""

import dataclasses
import math

import numpy as np
import pytest
from scipy import interpolate

from fftocean.errors import ParameterError
from fftocean.physics.panels import direction_panels
from fftocean.physics.sea import WaveSystem
from fftocean.physics.spectra import JONSWAP
from fftocean.physics.spreading import TabulatedSpreading

F = [0.05, 0.08, 0.1, 0.2, 0.5]
ANGLES = [-150.0, -90.0, -20.0, 0.0, 35.0, 100.0, 170.0]
TABLE = np.random.default_rng(1).uniform(0.0, 3.0, (5, 7))


def spreading(**changes):
    return TabulatedSpreading(
        **({"frequency": F, "direction": ANGLES, "density": TABLE.tolist()} | changes)
    )


def test_it_integrates_to_one_at_every_frequency():
    """
    Straight lines between its angles: the trapezoid rule on them is exact, and so is that on any
    finer set that contains them.
    """
    d = spreading()
    theta = np.radians(np.union1d(np.linspace(-180.0, 180.0, 361), [*ANGLES, -180.0, 180.0]))
    omega = 2.0 * np.pi * np.geomspace(0.01, 2.0, 41)
    values = d(omega[:, None], theta, 1.0)
    assert np.all(values >= 0.0)
    assert np.sum(0.5 * (values[:, 1:] + values[:, :-1]) * np.diff(theta), axis=1) == pytest.approx(
        np.ones(41), rel=1e-12
    )


def test_between_the_points_it_is_bilinear():
    """Against scipy's interpolator on a table whose angles go round once more on either side."""
    d = spreading()
    angle = np.radians(np.concatenate([np.array(ANGLES) - 360.0, ANGLES, np.array(ANGLES) + 360.0]))
    gaps = np.diff(ANGLES, append=ANGLES[0] + 360.0)
    rows = TABLE / (TABLE @ np.radians(0.5 * (gaps + np.roll(gaps, 1))))[:, None]
    want = interpolate.RegularGridInterpolator(
        (2.0 * np.pi * np.array(F), angle), np.concatenate([rows, rows, rows], axis=1)
    )
    rng = np.random.default_rng(2)
    omega, theta = 2.0 * np.pi * rng.uniform(0.05, 0.5, 500), rng.uniform(-math.pi, math.pi, 500)
    assert d(omega, theta, 1.0) == pytest.approx(want((omega, theta)), rel=1e-12)
    assert d(omega, theta + 6.0 * np.pi, 1.0) == pytest.approx(
        d(omega, theta, 1.0), rel=1e-9
    )  # periodic, to 1e-15 of three turns in a slope


def test_outside_the_table_its_ends_go_on():
    d = spreading()
    theta = np.linspace(-3.0, 3.0, 13)
    assert np.array_equal(d(0.0, theta, 1.0), d(2.0 * np.pi * 0.05, theta, 1.0))
    assert d(1e9, theta, 1.0) == pytest.approx(d(2.0 * np.pi * 0.5, theta, 1.0), rel=1e-12)


def test_the_order_and_the_turn_of_the_angles_do_not_matter():
    shuffle = [3, 0, 6, 2, 1, 5, 4]
    other = spreading(
        direction=(np.array(ANGLES)[shuffle] + 360.0).tolist(), density=TABLE[:, shuffle].tolist()
    )
    omega, theta = 2.0 * np.pi * np.array([[0.06], [0.3]]), np.linspace(-3.0, 3.0, 29)
    assert other(omega, theta, 1.0) == pytest.approx(spreading()(omega, theta, 1.0), rel=1e-12)


def test_an_empty_row_takes_its_nearest_neighbours():
    """0.08 Hz is nearer to 0.1 than to 0.05."""
    table = TABLE.copy()
    table[[1, 4]] = 0.0
    d = spreading(density=table.tolist())
    theta = np.linspace(-3.0, 3.0, 13)
    assert d(2.0 * np.pi * 0.08, theta, 1.0) == pytest.approx(
        d(2.0 * np.pi * 0.1, theta, 1.0), rel=1e-12
    )
    assert d(2.0 * np.pi * 0.5, theta, 1.0) == pytest.approx(
        d(2.0 * np.pi * 0.2, theta, 1.0), rel=1e-12
    )


@pytest.mark.parametrize("scale", [1e-300, 1e300])
def test_the_unit_of_the_table_does_not_matter(scale):
    omega, theta = 2.0 * np.pi * 0.15, np.linspace(-3.0, 3.0, 13)
    assert spreading(density=(scale * TABLE).tolist())(omega, theta, 1.0) == pytest.approx(
        spreading()(omega, theta, 1.0), rel=1e-12
    )


def test_it_is_a_frozen_value():
    assert spreading() == spreading()
    assert hash(spreading()) == hash(spreading())
    assert spreading() != spreading(density=(TABLE + 1.0).tolist())
    with pytest.raises(dataclasses.FrozenInstanceError):
        spreading().frequency = (1.0, 2.0)
    assert len(repr(spreading())) < 300


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"frequency": [0.1]}, "frequency must be at least 2"),
        (
            {"frequency": [0.0, 0.1, 0.2, 0.3, 0.4]},
            r"frequency\[0\] must be positive and finite, got 0",
        ),
        ({"frequency": [0.1, 0.1, 0.2, 0.3, 0.4]}, "strictly ascending"),
        (
            {"frequency": [0.1, math.nan, 0.2, 0.3, 0.4]},
            r"frequency\[1\] must be positive and finite, got nan",
        ),
        ({"direction": [0.0, 90.0]}, "direction must be at least 3"),
        ({"direction": [0.0, 360.0, 20.0, 30.0, 40.0, 50.0, 60.0]}, "each angle once"),
        ({"density": TABLE[:, :6].tolist()}, "5 frequencies by 7 directions, got shape"),
        (
            {"density": (TABLE - 1.0).tolist()},
            r"density\[0\]\[2\] must be at least 0 and finite, got -",
        ),
        ({"density": np.zeros((5, 7)).tolist()}, "more than 0 somewhere"),
        ({"density": [[1.0], [1.0, 2.0]]}, "density must be numbers"),
        ({"density": "rough"}, "density must be a table of numbers .*, got 'rough' "),
        ({"density": 1.0}, "density must be a table of numbers .*, got 1.0"),
    ],
)
def test_what_cannot_be_a_spreading_is_refused(changes, message):
    with pytest.raises(ParameterError, match=message):
        spreading(**changes)


def test_a_smooth_table_of_many_directions_takes_few_panels():
    """
    At most four a direction: panels narrow toward a direction of the table no farther out than to
    the next one.
    """
    angles = np.arange(0.0, 360.0, 5.0)
    bell = np.cos(np.radians(angles - 7.0) / 2.0) ** 8
    table = TabulatedSpreading(
        frequency=[0.05, 0.1, 0.2], direction=angles.tolist(), density=[bell.tolist()] * 3
    )
    system = WaveSystem(spectrum=JONSWAP.from_sea_state(hs=1.0, tp=8.0), spreading=table)
    edges = direction_panels(system, 2.0 * np.pi * np.array([0.06, 0.125])).edges
    assert angles.size < edges.size <= 4 * angles.size
    low, width = edges[:-1], np.diff(edges)
    trapezoid = (
        0.5 * width * (table(0.8, low, 0.8) + table(0.8, low + width, 0.8))
    )  # exact between directions of the table
    assert np.sum(trapezoid) == pytest.approx(1.0, rel=1e-12)
