"""
A buoy tells two Fourier moments of each frequency's directions; this is the least presuming way
round the compass that has them.
"""

from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Complex, Real

LIMIT: Final = 0.99
"""
The most coherent a moment may be. 1 is a single direction without width, which no bin could show;
noise and two-decimal rounding also produce moments that no distribution has (beyond 1). Both are
drawn in to this limit, and counted.
"""

# by which, times l, the moments may be missed, so that there is a least point even where no bins
# have them
_SLACK: Final = 1e-8
_ENOUGH: Final = 1e-10  # on the moments; a buoy gives two decimals
_STEPS: Final = 100  # a dozen do, but for moments near `LIMIT`


class Unfolded(NamedTuple):
    """What `maximum_entropy` gives back."""

    share: Real  # (..., bins): of the energy, in each bin; sums to 1
    limited: npt.NDArray[np.bool_]  # (...): where the moments had to be drawn in to be possible


def maximum_entropy(c1: Complex, c2: Complex, bins: int) -> Unfolded:
    """
    Share out a frequency's energy among directions by the maximum entropy method.

    Of all ways p_j with sum p_j e^{i n theta_j} = c_n, n = 1, 2, the one of most entropy, -sum p_j
    ln p_j, is
        p_j ~ exp(l1 cos theta_j + l2 sin theta_j + l3 cos 2 theta_j + l4 sin 2 theta_j):
    positive, and with both moments (to 1e-8 of the largest l). The l are where the convex function
    ln sum_j exp(l.g_j) - l.m is least; Newton's method with halved steps cannot miss it.

    A cut Fourier series has negative lobes instead. The entropy of Burg (Lygre & Krogstad 1986),
    which has a closed form, makes two peaks out of the one of a cos^2s sea, narrow or wide, and
    moves 12 to 60 % of its energy; this one moves 3 % at s = 2 and 0.3 % at s = 9. (Simanesew,
    Krogstad, Trulsen & Nieto Borge 2018 map where either splits a peak.)

    Args:
        c1, c2: r1 e^{i a1} and r2 e^{2 i a2}, any one shape; NaN where not measured.
        bins: directions round the compass; bin j is at 2 pi j/bins.

    Returns:
        Shape of `c1` + (bins,). Without c1 the shares are all equal, without c2 those of c1 alone:
        the least that can be said.

    Source: Kobune & Hashimoto, Proc. 5th OMAE (1986) 80.
    Pinned by tests/readers/test_maximum_entropy.py: the moments; von Mises, its closed form without
    c2; an optimiser that shares nothing.
    """
    shape = np.shape(c1)
    c1, c2 = (np.array(c, dtype=np.complex128).ravel() for c in (c1, c2))
    known1 = ~np.isnan(c1)
    known2 = known1 & ~np.isnan(c2)
    c1, drawn_in = _within(np.where(known1, c1, np.complex128(0.0)))
    # Two moments are possible together where c2 lies within 1 - |c1|^2 of c1^2 (a Toeplitz matrix
    # that is positive).
    room = 1.0 - np.abs(c1) ** 2
    kappa, drawn_in_2 = _within(np.where(known2, c2 - c1**2, 0.0) / room)
    c2 = c1**2 + kappa * room

    theta = 2.0 * np.pi / bins * np.arange(bins)
    waves = np.stack([f(n * theta) for n in (1, 2) for f in (np.cos, np.sin)])  # (4, bins)
    moments = np.stack([c1.real, c1.imag, c2.real, c2.imag], axis=1)
    free = np.stack([known1, known1, known2, known2], axis=1)
    share = _most_entropy(moments, free, waves)
    return Unfolded(share.reshape(*shape, bins), (drawn_in | drawn_in_2).reshape(shape))


def _within(c: npt.NDArray[Any]) -> tuple[Complex, npt.NDArray[np.bool_]]:
    """Coefficients with their modulus held at `LIMIT`, and where it was."""
    modulus = np.abs(c)
    over = modulus > LIMIT
    return np.where(over, c * (LIMIT / np.where(over, modulus, 1.0)), c), over


def _most_entropy(moments: Real, free: npt.NDArray[np.bool_], waves: Real) -> Real:
    """
    Newton's method on all problems at once; those that are done rest.

    Args:
        moments: (problems, 4).
        free: (problems, 4): which of them are to be met; the multipliers of the others stay 0.
        waves: (4, bins).
    """
    multipliers = np.zeros_like(moments)
    share = np.full((len(moments), waves.shape[1]), 1.0 / waves.shape[1])
    products = (waves[:, None] * waves).reshape(16, -1)
    busy = np.flatnonzero(np.any(free, axis=1))
    for _ in range(_STEPS):
        mean = _weighted(share[busy], waves)
        slope = np.where(free[busy], mean - moments[busy] + _SLACK * multipliers[busy], 0.0)
        undone = np.max(np.abs(slope), axis=1, initial=0.0) > _ENOUGH
        busy, mean, slope = busy[undone], mean[undone], slope[undone]
        if not busy.size:
            break
        curvature = _weighted(share[busy], products).reshape(-1, 4, 4)
        curvature -= mean[:, :, None] * mean[:, None, :]
        both = free[busy][:, :, None] & free[busy][:, None, :]
        curvature = (
            np.where(both, curvature, 0.0)
            + np.eye(4) * np.where(free[busy], _SLACK, 1.0)[:, :, None]
        )
        step = -np.linalg.solve(curvature, slope[:, :, None])[:, :, 0]
        multipliers[busy], share[busy], moving = _downhill(
            multipliers[busy], step, slope, moments[busy], waves
        )
        busy = busy[moving]
    return share


def _weighted(share: Real, functions: Real) -> Real:
    """
    Return sum_j share_j functions_j of each problem, (problems, functions).

    Bin by bin and not by BLAS, whose last bits depend on how many problems there are, and on the
    processor: a record must unfold to the same bytes alone and among others.
    """
    total = np.zeros((len(functions), len(share)))
    for bin_share, values in zip(share.T, functions.T, strict=True):
        total += values[:, None] * bin_share
    return total.T


def _downhill(
    start: Real, step: Real, slope: Real, moments: Real, waves: Real
) -> tuple[Real, Real, npt.NDArray[np.bool_]]:
    """
    Go along `step`, half of it, a quarter, ... until the function falls by a fair part of what its
    slope promises.

    Returns:
        Where that is, the shares there, and whether there is anything more to gain than rounding.
    """
    promised = np.sum(step * slope, axis=1)
    here, share = _height(start, moments, waves)
    end, moving = start.copy(), np.zeros(len(start), dtype=bool)
    short, length = np.flatnonzero(promised < -1e-15 * (1.0 + np.abs(here))), 1.0
    while short.size and length > 1e-9:
        there = start[short] + length * step[short]
        height, shares = _height(there, moments[short], waves)
        good = height <= here[short] + 1e-4 * length * promised[short]
        end[short[good]], share[short[good]], moving[short[good]] = there[good], shares[good], True
        short, length = short[~good], 0.5 * length
    return end, share, moving


def _height(multipliers: Real, moments: Real, waves: Real) -> tuple[Real, Real]:
    """ln sum_j exp(l.g_j) - l.m + slack/2 l.l, and the shares exp(l.g_j) / sum."""
    exponent = multipliers[:, :1] * waves[0]
    for i in range(1, len(waves)):
        exponent += multipliers[:, i : i + 1] * waves[i]
    top = np.max(exponent, axis=1)
    share = np.exp(exponent - top[:, None])
    total = np.sum(share, axis=1)
    height = (
        top + np.log(total) + np.sum(multipliers * (0.5 * _SLACK * multipliers - moments), axis=1)
    )
    return height, share / total[:, None]
