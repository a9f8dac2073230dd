"""Numbers, directions and periods as they are written on plots."""

import numpy as np
import pytest

from fftocean.plots.axes import round_periods
from fftocean.plots.text import compass_point, degrees, percent, three_digits


@pytest.mark.parametrize(
    ("direction", "point"),
    [
        (0, "E"),
        (90, "N"),
        (180, "W"),
        (-90, "S"),
        (25, "ENE"),
        (-35, "SE"),
        (359.0, "E"),
        (101, "N"),
    ],
)
def test_points_of_the_compass(direction, point):
    assert compass_point(direction) == point


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (5.8, "5.80"),
        (0.99999, "1.00"),
        (999.6, "1000"),
        (123.4, "123"),
        (1e-7, "1e-07"),
        (0.0123, "0.0123"),
    ],
)
def test_three_digits(value, text):
    assert three_digits(value) == text


@pytest.mark.parametrize(
    ("value", "text"), [(-0.01, "0.0°"), (-35.04, "−35.0°"), (180.0, "180.0°")]
)
def test_degrees(value, text):
    assert degrees(value) == text


@pytest.mark.parametrize(("low", "high"), [(0.3, 3.0), (1e-3, 2e-3), (50.0, 700.0), (0.0, 2.0)])
def test_round_periods_are_round_in_range_and_apart(low, high):
    periods = round_periods(low, high, 0.1 * (high - low))
    omega = 2 * np.pi / np.array(periods)
    assert len(periods) >= 3
    assert np.all((omega >= low) & (omega <= high))
    assert np.all(np.diff(omega) >= 0.1 * (high - low))
    assert all(
        len(f"{period:.1e}") == len("1.5e+00") and float(f"{period:.1e}") == period
        for period in periods
    )


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.0, "0 %"), (4e-5, "0 %"), (0.0123, "1.2 %"), (0.985, "98 %"), (1.0, "100 %")],
)
def test_percent(share, text):
    assert percent(share) == text
