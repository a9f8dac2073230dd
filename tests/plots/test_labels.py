"""Places of labels: on the right flank of their curve, above it, and clear of one another."""

import numpy as np
import pytest

from fftocean.plots.labels import right_flank

X = np.linspace(0.0, 10.0, 11)


@pytest.mark.parametrize(("level", "x"), [(1.0, 4.0), (0.75, 5.0), (0.5, 6.0), (0.25, 7.0)])
def test_a_label_points_to_the_right_flank(level, x):
    """The last point that reaches the level, though the left flank does too."""
    y = np.maximum(4.0 - np.abs(X - 4.0), 0.0)
    assert right_flank(X, y, level) == (x, pytest.approx(4.0 * level))


def test_of_two_peaks_the_last_that_is_high_enough_counts():
    y = np.zeros_like(X)
    y[2], y[7] = 3.0, 2.0
    assert right_flank(X, y, 0.9) == (2.0, 3.0)
    assert right_flank(X, y, 0.5) == (7.0, 2.0)
