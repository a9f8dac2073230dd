"""Steps of vectors, compiled and not, against numpy."""

import numpy as np
import pytest

from fftocean.kernels import vectors
from fftocean.kernels.compiler import compiled
from fftocean.transforms import aligned_numbers

pytestmark = pytest.mark.nojit
LANES, TILE = vectors.LANES, vectors.TILE


@compiled
def scale(factors, f, source, s, out, o):
    vectors.scale(factors, f, source, s, out, o)


@compiled
def scale_reversed(factors, f, source, s, out, o):
    vectors.scale_reversed(factors, f, source, s, out, o)


@compiled
def split(pairs, p, factor, first, f, second, s, stream_first, stream_second):
    vectors.split(pairs, p, factor, first, f, second, s, stream_first, stream_second)


@compiled
def interleave(source, s, stride, out, o, streamed):
    vectors.interleave(source, s, stride, out, o, streamed)


@compiled
def transpose(source, s, stride, out, o, streamed):
    vectors.transpose(source, s, stride, out, o, streamed)


@compiled
def prefetch(source, s):
    vectors.prefetch(source, s)
    return source[0]


def places(streamed):
    """A cache line for what is streamed, in numbers; else an odd place."""
    return LANES if streamed else 7


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


@pytest.mark.parametrize("streamed", [(False, False), (True, False), (False, True), (True, True)])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_split(dtype, streamed):
    pairs = numbers(dtype, 60)
    first, second = aligned_numbers((64,), dtype), aligned_numbers((64,), dtype)
    f, s = places(streamed[0]), places(streamed[1])
    split(pairs, 3, dtype(0.3), first, f, second, s, *streamed)
    halves = pairs[3 : 3 + 2 * LANES].reshape(-1, 2)
    assert np.array_equal(first[f : f + LANES], halves[:, 0])
    assert np.array_equal(second[s : s + LANES], halves[:, 1] * dtype(0.3))
    assert np.count_nonzero(first) == np.count_nonzero(second) == LANES


@pytest.mark.parametrize("streamed", [False, True])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_interleave(dtype, streamed):
    source, out, o = numbers(dtype, 100), aligned_numbers((96,), dtype), places(streamed)
    interleave(source, 5, 29, out, o, streamed)
    rows = np.stack([source[5 + 29 * r : 5 + 29 * r + LANES] for r in range(3)])
    assert np.array_equal(out[o : o + 3 * LANES], rows.T.ravel())
    assert np.count_nonzero(out) == 3 * LANES


@pytest.mark.parametrize("streamed", [False, True])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_transpose(dtype, streamed):
    source, out, o = numbers(dtype, 400), aligned_numbers((200,), dtype), places(streamed)
    transpose(source, 5, 35, out, o, streamed)
    columns = np.stack([source[5 + 35 * c : 5 + 35 * c + 2 * TILE] for c in range(TILE)])
    expected = columns.reshape(TILE, TILE, 2).transpose(1, 0, 2)
    assert np.array_equal(out[o : o + 2 * TILE**2].reshape(TILE, TILE, 2), expected)
    assert np.count_nonzero(out) == 2 * TILE**2


def test_prefetch_touches_nothing():
    """A place past the end is no fault, nor is one in memory that nobody has."""
    source = numbers(np.float32, 20)
    assert prefetch(source, 10**9) == source[0]
