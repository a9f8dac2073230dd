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


def test_means_on_loop():
    """The fixed point of the recurrence, by many turns of the loop instead of a closed form."""
    eigenvalue = RNG.uniform(0.3, 1.3, size=(3, 8)).astype(np.float32)
    threshold, gain, decay = 0.7, 0.2, 0.8
    states = []
    for row in eigenvalue:
        f = 0.0
        for i in range(8 * 40):
            f = decay * f + gain * max(threshold - float(row[i % 8]), 0.0)
            states.append(f)
    last = np.array(states).reshape(3, 40, 8)[:, -1]  # 0.8^320 = 1e-31 of the start is left
    covered, mean = foam.means_on_loop(eigenvalue, threshold, gain, decay, 2)
    assert mean == pytest.approx(np.mean(last), rel=1e-12)
    assert covered == pytest.approx(np.mean(-np.expm1(-last[:, ::2])), rel=1e-12)


def test_means_on_loop_of_still_water():
    assert foam.means_on_loop(np.ones((2, 4), np.float32), 0.7, 1.0, 0.5, 1) == (0.0, 0.0)
