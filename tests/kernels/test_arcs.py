"""Energy in arcs: closed forms of one spreading, in every quadrant and across every seam."""

import numpy as np
import pytest

from fftocean.kernels import arcs


def shares(low, high, direction, row=0, along=0.0, nodes=64):
    """Return what one arc holds of D = (1 + cos theta) / 2 pi, and of a third of it above."""
    theta = np.linspace(-np.pi, np.pi, nodes + 1)
    step = theta[1] - theta[0]
    value = (theta + np.pi + np.sin(theta)) / (2.0 * np.pi)
    slope = step * (1.0 + np.cos(theta)) / (2.0 * np.pi)
    rise = np.diff(value)
    cubic = [
        *(value[:-1], slope[:-1]),
        3.0 * rise - 2.0 * slope[:-1] - slope[1:],
        slope[:-1] + slope[1:] - 2.0 * rise,
    ]
    out = np.zeros((4, 1))
    arcs.sums(
        np.array([0, 1]),
        *(np.array([a]) for a in (low, high, 3.0)),
        np.array([row]),
        np.array([along]),
        direction,
        theta,
        np.stack([np.stack(cubic, axis=1), np.stack(cubic, axis=1) / 3.0]),
        out,
    )
    return out[:, 0]


def within(low, high):
    """Return the integral of 3 (1 + cos theta) / 2 pi."""
    return 3.0 * (high - low + np.sin(high) - np.sin(low)) / (2.0 * np.pi)


@pytest.mark.parametrize("direction", [-3.1, -1.0, 0.0, 0.7, 2.2, np.pi, 6.0])
def test_arcs_of_the_four_quadrants(direction):
    """A cubic between nodes 0.1 apart misses the sine by 0.1^4 / 384, 3e-7."""
    low, high = 0.3, 1.2
    expected = [
        within(low - direction, high - direction),
        within(-high - direction, -low - direction),
        within(low - np.pi - direction, high - np.pi - direction),
        within(np.pi - high - direction, np.pi - low - direction),
    ]
    assert shares(low, high, direction) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("direction", [0.0, 0.4, 3.0])
def test_quadrants_share_out_the_circle(direction):
    assert np.sum(shares(0.0, 0.5 * np.pi, direction)) == pytest.approx(3.0, rel=1e-12)


def test_between_rows_the_share_is_linear():
    low, high = 0.3, 1.2
    assert shares(low, high, 0.2, along=0.25) == pytest.approx(
        (0.75 + 0.25 / 3.0) * shares(low, high, 0.2), rel=1e-12
    )


def test_a_ring_without_energy_is_left_out():
    out = np.full((4, 1), 7.0)
    line = np.array([0.0, 1.0])
    arcs.sums(
        np.array([0, 1]),
        *(np.array([a]) for a in (0.1, 0.2, 0.0)),
        np.array([0]),
        np.array([0.0]),
        0.0,
        line,
        np.full((2, 1, 4), np.nan),
        out,
    )
    assert np.all(out == 7.0)
