"""Index order of a tile, and the waves it can hold."""

import numpy as np
import pytest

import fftocean as fo
from fftocean.grid import Grid

pytestmark = pytest.mark.nojit


@pytest.mark.parametrize("n", [1, 2, 3, 8, 9, (8, 5), (1, 6)])
def test_index_order_is_that_of_the_fft(n):
    """
    A wave placed at [my, mx] of the half plane comes out of numpy's own inverse transform with that
    wavenumber.
    """
    grid = Grid.of(n, (10.0, 7.0))
    assert grid.shape == (grid.ny, grid.nx)
    assert np.array_equal(grid.my, np.rint(np.fft.fftfreq(grid.ny) * grid.ny))
    for row, column in zip(*np.nonzero(grid.active), strict=True):
        spectrum = np.zeros(grid.half_shape, dtype=complex)
        spectrum[row, column] = 0.5
        if column == 0:
            spectrum[-row, 0] = 0.5
        wave = np.fft.irfft2(spectrum, s=grid.shape, norm="forward")
        expected = np.cos(grid.kx[column] * grid.x[None, :] + grid.ky[row] * grid.y[:, None])
        assert np.max(np.abs(wave - expected)) < 1e-13


@pytest.mark.parametrize(
    ("n", "count"),
    [(1, 0), (2, 0), (3, 8), (4, 8), (64, 63**2 - 1), ((48, 80), 47 * 79 - 1), (31, 31**2 - 1)],
)
def test_active_waves(n, count):
    """
    All but k = 0 and, where n is even, the Nyquist row and column; the half plane shows mx > 0 once
    and mx = 0 twice.
    """
    grid = Grid.of(n, 1.0)
    active = grid.active
    assert 2 * np.count_nonzero(active[:, 1:]) + np.count_nonzero(active[:, 0]) == count


@pytest.mark.parametrize(
    "n", [0, -1, 1.5, "64", True, None, (64,), (64, 64, 64), (64, 0), 10**9, float("nan")]
)
def test_bad_counts_are_refused(n):
    with pytest.raises(fo.ParameterError, match="n must be"):
        Grid.of(n, 100.0)


@pytest.mark.parametrize(
    "size",
    [0, -1.0, float("nan"), float("inf"), "5", True, None, 1e308, 1e-308, (1.0,), (1.0, -1.0)],
)
def test_bad_sizes_are_refused(size):
    with pytest.raises(fo.ParameterError, match="size must be"):
        Grid.of(8, size)


def test_numpy_scalars_are_numbers():
    assert Grid.of(np.int64(8), np.float32(2.0)) == Grid.of(8, 2.0)
