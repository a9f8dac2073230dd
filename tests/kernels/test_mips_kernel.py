"""Box means against numpy: even sides by plain means, odd ones by the integral of a staircase."""

import numpy as np
import pytest

from fftocean.kernels import mips

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(3)


def test_even_sides():
    texels = RNG.standard_normal((6, 8, 3))
    out = np.empty((3, 4, 3))
    mips.halve(texels, out)
    assert np.allclose(out, texels.reshape(3, 2, 4, 2, 3).mean(axis=(1, 3)), atol=1e-15)


@pytest.mark.parametrize("shape", [(7, 5), (3, 3), (9, 4), (1, 7), (5, 1), (101, 2), (2, 1)])
def test_odd_sides(shape):
    """
    The mean over a box is the difference of the running integral at its ends, which is linear
    between samples; axis by axis.
    """
    texels = RNG.standard_normal((*shape, 2))

    def boxes(values):
        n = values.shape[0]
        running = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
        m = max(1, n // 2)
        ends = np.linspace(0.0, n, m + 1)
        flat = running.reshape(n + 1, -1)
        at = np.stack([np.interp(ends, np.arange(n + 1), column) for column in flat.T], axis=-1)
        return (np.diff(at, axis=0) * m / n).reshape(m, *values.shape[1:])

    exact = boxes(boxes(texels).swapaxes(0, 1)).swapaxes(0, 1)
    out = np.empty(exact.shape)
    mips.halve(texels, out)
    assert np.allclose(out, exact, atol=1e-13)
