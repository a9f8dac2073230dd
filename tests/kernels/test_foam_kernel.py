"""Foam's compiled loops against their NumPy twins."""

import numpy as np
import pytest

from fftocean.kernels import foam

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(5)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_advance(dtype):
    window = (0.7 + 0.3 * RNG.standard_normal((4, 6, 5))).astype(dtype)
    cubic, weights, start = (
        RNG.standard_normal((3, 4)),
        RNG.uniform(size=3),
        RNG.uniform(size=(6, 5)),
    )
    state = start.copy()
    foam.advance(*window, cubic, weights, 0.6, 0.9, state)
    eigenvalue = np.einsum("um,mji->uji", cubic, window.astype(float))
    twin = 0.9 * start + np.einsum("u,uji->ji", weights, np.maximum(0.6 - eigenvalue, 0.0))
    assert np.max(np.abs(state - twin)) < 1e-14  # a dozen roundings of values near 1


def test_coverage():
    state = np.array([[0.0, 1e-9, 0.5], [1.0, 40.0, 1e300]])
    out = np.empty(state.shape, dtype=np.float32)
    foam.coverage(state, out)
    assert np.allclose(out, 1.0 - np.exp(-state.astype(np.longdouble)), rtol=1e-7, atol=0.0)
    assert out[0, 0] == 0.0
    assert out[1, 2] == 1.0
