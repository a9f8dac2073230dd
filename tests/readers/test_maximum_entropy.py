"""Positive directional distributions with two given moments."""

import numpy as np
import pytest
from scipy import optimize, special

from fftocean.readers.maximum_entropy import LIMIT, maximum_entropy

BINS = 72
THETA = 2.0 * np.pi / BINS * np.arange(BINS)


def moments_of(share):
    theta = 2.0 * np.pi / share.shape[-1] * np.arange(share.shape[-1])
    return share @ np.exp(1j * theta), share @ np.exp(2j * theta)


def possible_moments(count, most):
    """
    Return moments that some distribution has: |c1| <= most, c2 within most (1 - |c1|^2) of c1^2.
    """
    rng = np.random.default_rng(3)
    c1, kappa = (
        most * rng.uniform(0.0, 1.0, count) ** 0.5 * np.exp(2j * np.pi * rng.uniform(size=count))
        for _ in range(2)
    )
    return c1, c1**2 + kappa * (1.0 - np.abs(c1) ** 2)


@pytest.mark.parametrize("bins", [36, 72, 360])
def test_it_is_positive_and_has_the_moments(bins):
    """
    To 1e-5 where a buoy gives 1e-2: what the solver gives away to stay finite, 1e-8 times a
    multiplier of up to 1e3.
    """
    c1, c2 = possible_moments(2000, 0.9)
    share, limited = maximum_entropy(c1, c2, bins)
    assert np.all(share >= 0.0)
    assert np.sum(share, axis=-1) == pytest.approx(np.ones(2000), rel=1e-13)
    got1, got2 = moments_of(share)
    assert np.max(np.abs(got1 - c1)) < 1e-5
    assert np.max(np.abs(got2 - c2)) < 1e-5
    assert not np.any(limited)


def test_it_is_the_one_of_most_entropy():
    """
    Against a general optimiser of the entropy itself under the moments as constraints, which knows
    nothing of exponentials.
    """
    bins = 16
    c1, c2 = np.array(0.55 * np.exp(0.3j)), np.array(0.25 * np.exp(1.4j))
    share, _ = maximum_entropy(c1, c2, bins)
    theta = 2.0 * np.pi / bins * np.arange(bins)
    rows = np.stack(
        [np.ones(bins), np.cos(theta), np.sin(theta), np.cos(2.0 * theta), np.sin(2.0 * theta)]
    )
    want = optimize.minimize(
        lambda p: np.sum(p * np.log(p)),
        np.full(bins, 1.0 / bins),
        jac=lambda p: np.log(p) + 1.0,
        bounds=[(1e-9, 1.0)] * bins,
        constraints={
            "type": "eq",
            "fun": lambda p: rows @ p - [1.0, c1.real, c1.imag, c2.real, c2.imag],
            "jac": lambda _p: rows,
        },
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert want.success
    assert share == pytest.approx(want.x, abs=1e-6)  # SLSQP ends at 1e-7 of the entropy's flat top


def test_without_the_second_moment_it_is_von_mises():
    """
    exp(kappa cos(theta - a)) with I1(kappa)/I0(kappa) = r1: the closed form of most entropy for one
    moment.
    """
    kappa, a = 2.5, 1.1
    r1 = special.i1(kappa) / special.i0(kappa)
    share, _ = maximum_entropy(np.array(r1 * np.exp(1j * a)), np.array(np.nan + 0j), BINS)
    want = np.exp(kappa * np.cos(THETA - a))
    assert share == pytest.approx(want / want.sum(), rel=1e-6)


def test_without_the_first_moment_nothing_can_be_said():
    share, limited = maximum_entropy(
        np.array([np.nan + 0j, np.nan + 0j]), np.array([0.5 + 0j, np.nan + 0j]), BINS
    )
    assert np.array_equal(share, np.full((2, BINS), 1.0 / BINS))
    assert not np.any(limited)


def test_no_moment_at_all_is_all_round():
    share, _ = maximum_entropy(np.array(0j), np.array(0j), BINS)
    assert share == pytest.approx(np.full(BINS, 1.0 / BINS), rel=1e-12)


@pytest.mark.parametrize("s", [2.0, 5.0, 15.0, 50.0])
def test_one_peak_stays_one_peak(s):
    """
    A cos^2s sea, told by two moments: r1 = s/(s+1), r2 = s(s-1)/((s+1)(s+2)).

    It comes back with one peak where it was. At s = 2 the sum of |difference| is 5 %, at 5 it is
    1.5 %, above less. (With Burg's entropy it is 35 % to 100 %, in two peaks.)
    """
    r1, r2, a = s / (s + 1.0), s * (s - 1.0) / ((s + 1.0) * (s + 2.0)), THETA[50]
    share, _ = maximum_entropy(np.array(r1 * np.exp(1j * a)), np.array(r2 * np.exp(2j * a)), BINS)
    want = np.abs(np.cos(0.5 * (THETA - a))) ** (2.0 * s)
    assert np.sum(np.abs(share - want / want.sum())) < 0.06
    peaks = (share > np.roll(share, 1)) & (share > np.roll(share, -1)) & (share > 1e-6)
    assert np.flatnonzero(peaks).tolist() == [50]


@pytest.mark.parametrize(
    ("c1", "c2"),
    [(1.0, 1.0), (1.1, 0.5), (0.9, -0.9), (0.0, 1.0), (0.3, 0.95j), (-1.0, 1.0), (1e-9, 1.1)],
)
def test_moments_that_nothing_has_are_limited_and_marked(c1, c2):
    share, limited = maximum_entropy(np.array(complex(c1)), np.array(complex(c2)), BINS)
    assert bool(limited)
    assert np.all(share >= 0.0)
    assert np.sum(share) == pytest.approx(1.0, rel=1e-12)
    got, _ = moments_of(share)
    want = c1 if abs(c1) <= LIMIT else c1 * LIMIT / abs(c1)
    assert got == pytest.approx(
        want, abs=5e-3
    )  # the first moment, which has the direction, stays; bins of 5 degrees miss LIMIT by that


@pytest.mark.parametrize("bins", [36, 72])
def test_a_record_unfolds_alone_as_among_others(bins):
    """
    Equal bytes, whatever else is unfolded at the same time and whichever problems are done first.
    """
    c1, c2 = possible_moments(60, 0.98)
    c2[::7] = np.nan
    together = maximum_entropy(c1, c2, bins).share
    for count in (1, 3, 13):
        for start in range(0, 60, 11):
            part = slice(start, start + count)
            assert np.array_equal(maximum_entropy(c1[part], c2[part], bins).share, together[part])
