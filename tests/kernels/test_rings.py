"""Sums by rings, against NumPy's sums wave by wave, hyperbolic functions and exponentials."""

import math

import numpy as np
import pytest

from fftocean.kernels import rings

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(8)
POINTS = 7


def waves():
    """Two rings: k = 5 with quartets (3, 4) and (4, 3), and k = 1 with the single wave (1, 0)."""
    kx = np.array([3.0, -3.0, 3.0, -3.0, 4.0, -4.0, 1.0])
    ky = np.array([4.0, 4.0, -4.0, -4.0, 3.0, -3.0, 0.0])
    amplitude, phase = RNG.uniform(0.1, 1.0, 7), RNG.uniform(0.0, 6.0, 7)
    return kx, ky, amplitude, phase, np.where(np.hypot(kx, ky) > 2.0, 2.2, 0.9)


def by_rings(kx, ky, amplitude, phase):
    """Return the fields of `Quartets`, by hand, and the columns and rows."""
    quartet = np.array([0, 0, 0, 0, 1, 1, 2])
    sums = np.zeros((3, 8))
    signs = np.where(kx < 0, -1.0, 1.0), np.where(ky < 0, -1.0, 1.0)
    rings.add_waves(quartet, *signs, amplitude, phase, sums)
    made = rings.Quartets(
        np.array([0, 2, 3]),
        np.array([5.0, 1.0]),
        np.array([2.2, 0.9]),
        np.array([0, 1, 2]),
        np.array([0, 1, 2]),
        sums,
    )
    return made, np.array([3.0, 4.0, 1.0]), np.array([4.0, 3.0, 0.0])


def tables(columns, rows, x, y, size=math.inf):
    found = []
    for numbers, along in ((columns, x), (rows, y)):
        cosine, sine = np.empty((2, numbers.size, along.size))
        rings.tabulate(along, size, numbers, np.empty((numbers.size + 1, along.size)), cosine, sine)
        found += [cosine, sine]
    return rings.Tables(*found)


@pytest.mark.parametrize("depth", [3.0, math.inf])
def test_sums_wave_by_wave(depth):
    """
    The linear profiles with NumPy's hyperbolic functions, or exponentials; above z = 0 along their
    tangents. To 1e-13 of some ten waves of amplitude 1.
    """
    kx, ky, a, phase, omega = waves()
    k = np.hypot(kx, ky)
    x, y = RNG.uniform(-5, 5, (2, POINTS))
    z = np.array([0.4, 0.0, -0.1, -0.5, -1.0, -2.0, -3.0])
    made, columns, rows = by_rings(kx, ky, a, phase)
    table = tables(columns, rows, x, y)
    f = np.outer(x, kx) + np.outer(y, ky) - phase
    heights = np.zeros(POINTS)
    rings.sum_heights(tuple(made), tuple(table), heights)
    assert np.max(np.abs(heights - np.sum(a * np.cos(f), axis=1))) < 1e-13
    level, rise = np.minimum(z, 0.0), np.maximum(z, 0.0)
    buffer, out = np.empty(11 * POINTS), np.zeros(7 * POINTS)
    bits = buffer[10 * POINTS :].view(np.int64)
    rings.sum_below(tuple(made), tuple(table), columns, rows, depth, level, rise, buffer, bits, out)
    if math.isinf(depth):
        along = up = np.exp(np.outer(level, k)) + np.outer(rise, k)
    else:
        deep, whole = np.outer(level + depth, k), np.sinh(k * depth)
        along = np.cosh(deep) / whole + np.outer(rise, k)
        up = np.sinh(deep) / whole + np.outer(rise, k / np.tanh(k * depth))
    along, up = a * omega * along / k, a * omega * up
    c, s = np.cos(f), np.sin(f)
    expected = [
        along * kx * c,
        along * ky * c,
        up * s,
        along * omega * kx * s,
        along * omega * ky * s,
        -up * omega * c,
        along * omega * c,
    ]
    for row, terms in zip(out.reshape(7, POINTS), expected, strict=True):
        assert np.max(np.abs(row - np.sum(terms, axis=1))) < 1e-13


def test_decay_is_the_exponential():
    """To two roundings of NumPy's exponential; below e^-700 nothing is left."""
    z = np.concatenate([-np.geomspace(1e-9, 690.0, 300), [0.0, -1e4, -np.inf, np.nan]])
    power, out = np.empty((2, z.size))
    rings.decay(1.0, z, power, power.view(np.int64), out)
    assert np.allclose(out[:301], np.exp(z[:301]), rtol=4.5e-16, atol=0.0)
    assert np.all(out[301:303] < 1e-300)
    assert np.isnan(out[303])


@pytest.mark.parametrize("size", [10.0, math.inf])
def test_tables_repeat_with_the_tile(size):
    """Cosine and sine of k x, within the first period if there is one; NaN stays with its point."""
    x = np.array([0.3, -7.0, 1e6 + 0.25, np.nan, np.inf])
    numbers = 2.0 * np.pi / 10.0 * np.array([1.0, 5.0])
    cosine, sine = np.empty((2, 2, 5))
    rings.tabulate(x, size, numbers, np.empty((3, 5)), cosine, sine)
    near = np.mod(x[:3], 10.0)
    assert np.allclose(cosine[:, :3], np.cos(np.outer(numbers, near)), atol=1e-9, rtol=0.0)
    assert np.allclose(sine[:, :3], np.sin(np.outer(numbers, near)), atol=1e-9, rtol=0.0)
    assert np.all(np.isnan(cosine[:, 3:]))
    assert np.all(np.isnan(sine[:, 3:]))
