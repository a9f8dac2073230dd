"""Steps of vectors, compiled and not, against numpy."""

import numpy as np
import pytest

from fftocean.kernels import vectors
from fftocean.kernels.compiler import compiled

pytestmark = pytest.mark.nojit
LANES, TILE = vectors.LANES, vectors.TILE


@compiled
def scale(factors, f, source, s, out, o):
    vectors.scale(factors, f, source, s, out, o)


@compiled
def scale_reversed(factors, f, source, s, out, o):
    vectors.scale_reversed(factors, f, source, s, out, o)


@compiled
def split(pairs, p, factor, first, f, second, s):
    vectors.split(pairs, p, factor, first, f, second, s)


@compiled
def transpose(source, s, stride, out, o):
    vectors.transpose(source, s, stride, out, o)


def numbers(dtype, size):
    return np.random.default_rng(5).standard_normal(size).astype(dtype)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_scale(dtype):
    """At odd places, so that nothing is aligned; the neighbours stay as they are."""
    factors, source = numbers(dtype, 30), numbers(dtype, 40)
    plain, backwards = np.zeros((2, 50), dtype)
    scale(factors, 3, source, 5, plain, 7)
    scale_reversed(factors, 3, source, 5, backwards, 7)
    some, pairs = factors[3 : 3 + LANES], source[5 : 5 + LANES].reshape(-1, 2)
    assert np.array_equal(plain[7 : 7 + LANES], some * pairs.ravel())
    assert np.array_equal(backwards[7 : 7 + LANES], some * pairs[::-1].ravel())
    for out in (plain, backwards):
        out[7 : 7 + LANES] = 0
        assert not np.any(out)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_split(dtype):
    pairs, first, second = numbers(dtype, 60), np.zeros(40, dtype), np.zeros(40, dtype)
    split(pairs, 3, dtype(0.3), first, 1, second, 5)
    halves = pairs[3 : 3 + 2 * LANES].reshape(-1, 2)
    assert np.array_equal(first[1 : 1 + LANES], halves[:, 0])
    assert np.array_equal(second[5 : 5 + LANES], halves[:, 1] * dtype(0.3))
    assert np.count_nonzero(first) == np.count_nonzero(second) == LANES


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_transpose(dtype):
    source, out = numbers(dtype, 400), np.zeros(200, dtype)
    transpose(source, 5, 35, out, 9)
    columns = np.stack([source[5 + 35 * c : 5 + 35 * c + 2 * TILE] for c in range(TILE)])
    expected = columns.reshape(TILE, TILE, 2).transpose(1, 0, 2)
    assert np.array_equal(out[9 : 9 + 2 * TILE**2].reshape(TILE, TILE, 2), expected)
    assert np.count_nonzero(out) == 2 * TILE**2
