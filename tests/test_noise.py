"""Random numbers as a function of (seed, mx, my), and their distribution."""

import cmath
import math

import numpy as np
import pytest

from fftocean import noise

pytestmark = pytest.mark.nojit


@pytest.mark.parametrize(
    ("counter", "key", "answer"),
    [
        ((0, 0, 0, 0), (0, 0), (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
        ((0xFFFFFFFF,) * 4, (0xFFFFFFFF,) * 2, (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
        (
            (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
            (0xA4093822, 0x299F31D0),
            (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1),
        ),
    ],
)
def test_philox_known_answers(counter, key, answer):
    """The generator's authors publish these three for philox4x32-10 (Random123, kat_vectors)."""
    words = noise.philox(tuple(np.array([c], dtype=np.uint64) for c in counter), key)
    assert tuple(int(w[0]) for w in words) == answer


def philox_in_integers(counter, key):
    """Philox 4x32-10 as Salmon et al. (2011) write it, in Python's integers."""
    a, b, c, d = counter
    low, high = key
    for _ in range(10):
        first, second = 0xD2511F53 * a, 0xCD9E8D57 * c
        a, b, c, d = (
            (second >> 32) ^ b ^ low,
            second % 2**32,
            (first >> 32) ^ d ^ high,
            first % 2**32,
        )
        low, high = (low + 0x9E3779B9) % 2**32, (high + 0xBB67AE85) % 2**32
    return a, b, c, d


@pytest.mark.parametrize("seed", [0, 7, 2**32, 2**64 - 1])
@pytest.mark.parametrize("wave", [(1, 0), (0, 1), (-3, 5), (70_000, -70_001)])
def test_a_seed_is_the_same_sea_for_ever(seed, wave):
    """
    Box & Muller's pair of 53 bits each, of the four words in order: a unit of the last place in
    each of four functions, and in the angle up to 2 pi.
    """
    words = philox_in_integers((wave[0] % 2**32, wave[1] % 2**32, 0, 0), (seed % 2**32, seed >> 32))
    first, second = (words[i] << 32 | words[i + 1] for i in (0, 2))
    radius, cycles = ((first >> 11) + 1) / 2**53, (second >> 11) / 2**53
    phasor = cmath.exp(2j * math.pi * cycles)
    mx, my = (np.array([m]) for m in wave)
    assert noise.unit_phasors(seed, mx, my)[0] == pytest.approx(phasor, abs=1e-14)
    expected = math.sqrt(-2.0 * math.log(radius)) * phasor
    assert noise.complex_normals(seed, mx, my)[0] == pytest.approx(expected, rel=1e-14)


@pytest.fixture(scope="module")
def waves():
    mx, my = np.meshgrid(np.arange(-200, 200), np.arange(-200, 200))
    return mx.ravel(), my.ravel()


def test_normals_are_normal(waves):
    """
    Kolmogorov-Smirnov on 160,000 draws of each part: p below 1e-4 would happen once in ten thousand
    seeds, and the seed is fixed.
    """
    from scipy.stats import kstest  # which is slow to import

    xi = noise.complex_normals(7, *waves)
    for part in (xi.real, xi.imag):
        assert kstest(part, "norm").pvalue > 1e-4
    # |xi|^2/2 is exponential with mean 1: standard error 1/sqrt(160000) = 0.0025, four of them
    assert np.mean(np.abs(xi) ** 2) / 2 == pytest.approx(1.0, abs=0.01)
    assert abs(np.mean(xi.real * xi.imag)) < 0.01


def test_neighbours_and_opposites_are_independent(waves):
    """
    Correlation of xi(k) with xi(-k), xi(k + dk), and the next seed: standard error 0.0025 each,
    four of them.
    """
    mx, my = waves
    xi = noise.complex_normals(7, mx, my)
    for other in (
        noise.complex_normals(7, -mx, -my),
        noise.complex_normals(7, mx + 1, my),
        noise.complex_normals(8, mx, my),
    ):
        off_origin = (mx != 0) | (my != 0)
        assert abs(np.mean(xi[off_origin] * np.conj(other[off_origin]))) / 2 < 0.01
        assert abs(np.mean(xi[off_origin] * other[off_origin])) / 2 < 0.01


def test_draw_order_does_not_matter(waves):
    mx, my = waves
    xi = noise.complex_normals(7, mx, my)
    order = np.random.default_rng(1).permutation(mx.size)
    assert np.array_equal(noise.complex_normals(7, mx[order], my[order]), xi[order])
    assert np.array_equal(
        noise.complex_normals(7, mx[12345:12346], my[12345:12346]), xi[12345:12346]
    )


def test_high_seeds_differ():
    """All 64 bits of the seed count."""
    one = np.array([3]), np.array([-5])
    draws = {
        complex(noise.complex_normals(seed, *one)[0])
        for seed in (0, 1, 2**31, 2**32, 2**63, 2**64 - 1)
    }
    assert len(draws) == 6


def test_phasors_have_unit_modulus_and_the_normals_phase(waves):
    xi, unit = noise.complex_normals(7, *waves), noise.unit_phasors(7, *waves)
    assert np.max(np.abs(np.abs(unit) - 1.0)) < 1e-15
    assert np.max(np.abs(xi / np.abs(xi) - unit)) < 1e-14  # a few roundings


def test_no_two_wavenumbers_share_a_draw(waves):
    """
    Philox is a bijection of counters, and a wave's (mx, my) is its counter: 106 bits of 160,000
    waves, all different.
    """
    first, second = noise._uniforms(7, *waves)
    assert np.unique(np.column_stack([first, second]), axis=0).shape[0] == waves[0].size
    assert (
        np.unique(first).size == waves[0].size
    )  # 53 bits: two alike would happen once in 10^6 seeds
    edge = np.array([-32768, -32767, -1, 0, 1, 32767, 32768])
    mx, my = (a.ravel() for a in np.meshgrid(edge, edge))
    assert np.unique(np.column_stack(noise._uniforms(0, mx, my)), axis=0).shape[0] == edge.size**2


@pytest.mark.parametrize("word", [0, 0xFFFFFFFF])
def test_the_rarest_words_give_finite_waves(word, monkeypatch):
    """
    The logarithm is that of a number in (0, 1]: 2^-53 at least, which makes 8.6; 1 at most, which
    makes 0.
    """
    monkeypatch.setattr(noise, "philox", lambda counter, _: (np.full_like(counter[0], word),) * 4)
    xi = noise.complex_normals(3, np.arange(4), np.arange(4))
    assert np.abs(xi) == pytest.approx(
        np.sqrt(2.0 * 53.0 * np.log(2.0)) if word == 0 else 0.0, rel=1e-12
    )
    assert np.all(np.isfinite(noise.unit_phasors(3, np.arange(4), np.arange(4))))


def test_blocks_of_waves_have_the_same_bits(waves, monkeypatch):
    whole = noise.complex_normals(7, *waves)
    monkeypatch.setattr(noise, "_BLOCK", 1000)
    assert np.array_equal(noise.complex_normals(7, *waves), whole)
    assert noise.complex_normals(7, np.zeros((2, 1), int), np.arange(3)).shape == (2, 3)
