"""
Maximum-entropy directional distribution from two Fourier moments.
"""

from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Complex, Real

LIMIT: Final = 0.99
"""
Largest modulus of a moment. A modulus of 1 is a single direction without width, which no bin can
represent; noise and two-decimal rounding also give values above 1, which no distribution has. Both
are reduced to this limit, and counted.
"""

# Regularisation: the moments may be missed by this times l, so that a minimum exists even for
# moments that the bins cannot represent.
_SLACK: Final = 1e-8
_TOLERANCE: Final = 1e-10  # of the moments; a buoy gives two decimals
_STEPS: Final = 100  # a dozen suffice except for moments near `LIMIT`


class DirectionalShares(NamedTuple):
    """Directional distribution of each frequency."""

    share: Real  # (..., bins): share of the energy in each bin; sums to 1
    limited: npt.NDArray[np.bool_]  # (...): where moments were reduced to be possible


def maximum_entropy(c1: Complex, c2: Complex, bins: int) -> DirectionalShares:
    """
    Return the distribution of energy over directions by the maximum entropy method.

    Of all distributions p_j with sum p_j e^{i n theta_j} = c_n, n = 1, 2, the one of largest
    entropy, -sum p_j ln p_j, is
        p_j ~ exp(l1 cos theta_j + l2 sin theta_j + l3 cos 2 theta_j + l4 sin 2 theta_j):
    positive, and with both moments (to 1e-8 of the largest l). The l minimise the convex function
    ln sum_j exp(l.g_j) - l.m; Newton's method with halved steps always converges to it.

    A truncated Fourier series has negative lobes instead. The entropy of Burg (Lygre & Krogstad
    1986), which has a closed form, splits the single peak of a cos^2s sea, narrow or wide, into two
    and moves 12 to 60 % of its energy; this one moves 3 % at s = 2 and 0.3 % at s = 9. (Simanesew,
    Krogstad, Trulsen & Nieto Borge 2018 map where either splits a peak.)

    Args:
        c1, c2: r1 e^{i a1} and r2 e^{2 i a2}, any one shape; NaN where not measured.
        bins: directions round the compass; bin j is at 2 pi j/bins.

    Returns:
        Shape of `c1` + (bins,). Without c1 all shares are equal; without c2 they are those of c1
        alone.

    Source: Kobune & Hashimoto, Proc. 5th OMAE (1986) 80.
    Pinned by tests/readers/test_maximum_entropy.py: the moments; von Mises, its closed form without
    c2; an optimiser that shares nothing.
    """
    shape = np.shape(c1)
    c1, c2 = (np.array(c, dtype=np.complex128).ravel() for c in (c1, c2))
    known1 = ~np.isnan(c1)
    known2 = known1 & ~np.isnan(c2)
    c1, limited_1 = _limit(np.where(known1, c1, np.complex128(0.0)))
    # A distribution with both moments exists if |c2 - c1^2| <= 1 - |c1|^2 (the Toeplitz matrix of
    # the moments is positive).
    radius = 1.0 - np.abs(c1) ** 2
    kappa, limited_2 = _limit(np.where(known2, c2 - c1**2, 0.0) / radius)
    c2 = c1**2 + kappa * radius

    theta = 2.0 * np.pi / bins * np.arange(bins)
    waves = np.stack([f(n * theta) for n in (1, 2) for f in (np.cos, np.sin)])  # (4, bins)
    moments = np.stack([c1.real, c1.imag, c2.real, c2.imag], axis=1)
    free = np.stack([known1, known1, known2, known2], axis=1)
    share = _solve(moments, free, waves)
    return DirectionalShares(share.reshape(*shape, bins), (limited_1 | limited_2).reshape(shape))


def _limit(c: npt.NDArray[Any]) -> tuple[Complex, npt.NDArray[np.bool_]]:
    """Return coefficients of modulus at most `LIMIT`, and where they were reduced."""
    modulus = np.abs(c)
    over = modulus > LIMIT
    return np.where(over, c * (LIMIT / np.where(over, modulus, 1.0)), c), over


def _solve(moments: Real, free: npt.NDArray[np.bool_], waves: Real) -> Real:
    """
    Return the shares, by Newton's method on all unsolved problems at once.

    Args:
        moments: (problems, 4).
        free: (problems, 4): the moments to match; the multipliers of the others stay 0.
        waves: (4, bins).
    """
    multipliers = np.zeros_like(moments)
    share = np.full((len(moments), waves.shape[1]), 1.0 / waves.shape[1])
    products = (waves[:, None] * waves).reshape(16, -1)
    active = np.flatnonzero(np.any(free, axis=1))
    for _ in range(_STEPS):
        mean = _weighted(share[active], waves)
        slope = np.where(free[active], mean - moments[active] + _SLACK * multipliers[active], 0.0)
        undone = np.max(np.abs(slope), axis=1, initial=0.0) > _TOLERANCE
        active, mean, slope = active[undone], mean[undone], slope[undone]
        if not active.size:
            break
        curvature = _weighted(share[active], products).reshape(-1, 4, 4)
        curvature -= mean[:, :, None] * mean[:, None, :]
        both = free[active][:, :, None] & free[active][:, None, :]
        curvature = (
            np.where(both, curvature, 0.0)
            + np.eye(4) * np.where(free[active], _SLACK, 1.0)[:, :, None]
        )
        step = -np.linalg.solve(curvature, slope[:, :, None])[:, :, 0]
        multipliers[active], share[active], moving = _line_search(
            multipliers[active], step, slope, moments[active], waves
        )
        active = active[moving]
    return share


def _weighted(share: Real, functions: Real) -> Real:
    """
    Return sum_j share_j functions_j of each problem, (problems, functions).

    The sum runs bin by bin, not through BLAS, whose last bits depend on the number of problems and
    on the processor: a record must give the same bytes alone and among others.
    """
    total = np.zeros((len(functions), len(share)))
    for bin_share, values in zip(share.T, functions.T, strict=True):
        total += values[:, None] * bin_share
    return total.T


def _line_search(
    start: Real, step: Real, slope: Real, moments: Real, waves: Real
) -> tuple[Real, Real, npt.NDArray[np.bool_]]:
    """
    Return the first of `start + step`, `start + step / 2`, ... with a sufficient decrease (Armijo).

    Returns:
        That point, the shares there, and whether the decrease exceeds rounding.
    """
    expected = np.sum(step * slope, axis=1)
    here, share = _objective(start, moments, waves)
    end, moving = start.copy(), np.zeros(len(start), dtype=bool)
    short, length = np.flatnonzero(expected < -1e-15 * (1.0 + np.abs(here))), 1.0
    while short.size and length > 1e-9:
        there = start[short] + length * step[short]
        value, shares = _objective(there, moments[short], waves)
        good = value <= here[short] + 1e-4 * length * expected[short]
        end[short[good]], share[short[good]], moving[short[good]] = there[good], shares[good], True
        short, length = short[~good], 0.5 * length
    return end, share, moving


def _objective(multipliers: Real, moments: Real, waves: Real) -> tuple[Real, Real]:
    """Return ln sum_j exp(l.g_j) - l.m + slack/2 l.l, and the shares exp(l.g_j) / sum."""
    exponent = multipliers[:, :1] * waves[0]
    for i in range(1, len(waves)):
        exponent += multipliers[:, i : i + 1] * waves[i]
    top = np.max(exponent, axis=1)
    share = np.exp(exponent - top[:, None])
    total = np.sum(share, axis=1)
    value = (
        top + np.log(total) + np.sum(multipliers * (0.5 * _SLACK * multipliers - moments), axis=1)
    )
    return value, share / total[:, None]
