"""Random numbers over whole grids: no two waves share any, and tails have their closed forms."""

import math

import numpy as np
import pytest

from fftocean import noise

pytestmark = pytest.mark.nojit


def test_no_two_wavenumbers_of_the_largest_grid_share_a_counter(monkeypatch):
    """
    Philox maps its counters one to one, so two waves share a draw only if they share a counter.
    Those of all 4096 x 4096 waves are recorded: mx and my modulo 2^32, two words that nothing else
    enters, under a key that is the seed.
    """
    seen = []

    def record(counter, key):
        seen.append((*counter, key))
        return counter

    monkeypatch.setattr(noise, "philox", record)
    side, seed = np.arange(-2048, 2048), 0x1234567890ABCDEF
    for rows in np.split(side, 16):
        seen.clear()
        noise._uniforms(seed, side[None, :], rows[:, None])
        x, y, z, w = (np.concatenate([block[i] for block in seen]) for i in range(4))
        assert {block[4] for block in seen} == {(0x90ABCDEF, 0x12345678)}
        assert np.array_equal(x.view(np.int64), np.tile(side % 2**32, rows.size))
        assert np.array_equal(y.view(np.int64), np.repeat(rows % 2**32, side.size))
        assert not np.any(z | w)


def test_powers_of_two_and_their_neighbours_have_draws_of_their_own():
    """106 bits of each: two alike by chance would happen once in 10^25 seeds."""
    near = np.array([s * 2**i + d for i in range(31) for s in (-1, 1) for d in (-1, 0, 1)])
    near = np.unique(near)
    mx, my = (a.ravel() for a in np.meshgrid(near, near))
    for seed in (0, 1, 2**32, 2**63):
        draws = np.column_stack(noise._uniforms(seed, mx, my))
        assert np.unique(draws, axis=0).shape[0] == near.size**2


def test_tails_of_the_distribution():
    """
    |xi|^2/2 exceeds t with probability e^-t; either part exceeds x with erfc(x/sqrt 2)/2. Of four
    million draws the counts are Poisson's: five of their roots.
    """
    side = np.arange(-1000, 1000)
    xi = noise.complex_normals(11, side[None, :], side[:, None]).ravel()
    for t in (0.01, 0.5, 1.0, 4.0, 8.0, 11.0):
        expected = xi.size * math.exp(-t)
        assert abs(np.sum(np.abs(xi) ** 2 > 2.0 * t) - expected) < 5.0 * math.sqrt(expected)
    for part in (xi.real, -xi.real, xi.imag, -xi.imag):
        for x in (0.5, 2.0, 3.0, 4.0):
            expected = xi.size * 0.5 * math.erfc(x / math.sqrt(2.0))
            assert abs(np.sum(part > x) - expected) < 5.0 * math.sqrt(expected)


def test_the_logarithm_never_meets_zero(monkeypatch):
    """
    Whatever the four words are, the first number is at least 2^-53: its least is that of words 0,
    where adding nothing would make it 0.
    """
    for words in ((0, 0, 0, 0), (0, 2**11 - 1, 5, 5), (2**32 - 1,) * 4):
        monkeypatch.setattr(
            noise,
            "philox",
            lambda counter, _, words=words: tuple(np.full_like(counter[0], w) for w in words),
        )
        first, second = noise._uniforms(1, np.arange(3), np.arange(3))
        assert np.all((first >= 2.0**-53) & (first <= 1.0))
        assert np.all((second >= 0.0) & (second < 1.0))
