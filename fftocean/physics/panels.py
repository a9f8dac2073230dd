"""
Panels of frequency and direction on which a wave system is smooth, for Gauss quadrature.

A rule of fixed step does not see a feature that is narrower than the step. Here the step follows
the system: panels end at every frequency and direction that a model names in its `breaks`, narrow
by halves toward each of them, toward the peak and toward the system's own direction as far as the
values change there, and are bisected until eight Gauss points resolve each of them.
"""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.physics.spreading import Blend, LongCrested, Spreading, wrapped

if TYPE_CHECKING:
    from fftocean.physics.sea import WaveSystem

Index = npt.NDArray[np.intp]
Sampled = Callable[[Real], Real]
"""From points (m,) to values >= 0 of several curves, (curves, m)."""


@cache
def gauss_rule(order: int) -> tuple[Real, Real]:
    """Return Gauss-Legendre points and weights on [-1, 1]."""
    points, weights = np.polynomial.legendre.leggauss(order)
    points.setflags(write=False)
    weights.setflags(write=False)
    return points, weights


_NODES, _WEIGHTS = gauss_rule(8)
_HIGHEST = np.array([np.polynomial.legendre.Legendre.basis(n)(_NODES) * (n + 0.5) for n in (6, 7)])
_TOLERANCE = (
    1e-6  # of a curve's integral: what a panel's two highest Legendre coefficients may come to
)
_CHANGE = 0.1  # of a curve's maximum: what makes a feature
_HALVINGS = 15
_BISECTIONS = 24


class Panels(NamedTuple):
    """Ascending edges, and the edges among them at which a value jumps."""

    edges: Real
    jumps: Real


def gauss(low: Real, high: Real, order: int = 8) -> tuple[Real, Real]:
    """Return Gauss-Legendre points and weights on intervals, each (intervals, order)."""
    x, w = gauss_rule(order)
    half = 0.5 * (high - low)
    return low[:, None] + half[:, None] * (1.0 + x), half[:, None] * w


def split(low: Real, high: Real, edges: Real) -> tuple[Index, Real, Real]:
    """
    Cut intervals at those of some ascending edges that lie within; return the index of the
    interval, low and high of each piece.
    """
    first, last = np.searchsorted(edges, low, "right"), np.searchsorted(edges, high, "left")
    pieces = np.maximum(last - first, 0) + 1
    whole = np.repeat(np.arange(low.size), pieces)
    number = np.arange(whole.size) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    at = first[whole] + number
    padded = np.concatenate([edges, [np.inf]])
    return (
        whole,
        np.where(number == 0, low[whole], padded[at - 1]),
        np.where(number == pieces[whole] - 1, high[whole], padded[at]),
    )


def parts_of(system: "WaveSystem") -> "list[tuple[float, WaveSystem]]":
    """
    Return the systems that make up one, each with its share: a blend with a long-crested part is
    taken apart.
    """
    spreading = system.spreading
    if isinstance(spreading, Blend) and _long_crested_within(spreading):
        shares = ((1.0 - spreading.weight, spreading.first), (spreading.weight, spreading.second))
        return [
            (a * b, part)
            for a, model in shares
            if a
            for b, part in parts_of(replace(system, spreading=model))
        ]
    return [(1.0, system)]


def _long_crested_within(spreading: Spreading) -> bool:
    if isinstance(spreading, Blend):
        return _long_crested_within(spreading.first) or _long_crested_within(spreading.second)
    return isinstance(spreading, LongCrested)


def frequency_panels(system: "WaveSystem") -> Panels:
    """
    Return panels of omega [rad/s], from 0 to 1e12 peaks, on which S is smooth, and D where the
    spreading is a table.
    """
    spectrum, peak = system.spectrum, float(system.spectrum.peak)
    breaks = {
        float(b)
        for b in (
            *getattr(spectrum, "breaks", ()),
            *getattr(system.spreading, "frequency_breaks", ()),
        )
    }
    breaks = {b for b in breaks if 0.0 < b < 1e12 * peak}

    def sampled(omega: Real) -> Real:
        return np.atleast_2d(np.asarray(spectrum(omega), dtype=np.float64))

    octaves = peak * 2.0 ** np.arange(-6.0, 4.0)
    edges = np.concatenate(
        [[0.0], octaves, octaves[-1] * 4.0 ** np.arange(1.0, 19.0), list(breaks)]
    )
    features = sorted({peak, *breaks})
    edges = np.concatenate(
        [
            edges,
            *(
                _graded(sampled, f, (f, f), np.max(sampled(np.array(features)), axis=1))
                for f in features
            ),
        ]
    )
    edges = _bisected(sampled, _apart(edges, 1e-9))
    jumps = _jumps(sampled, np.array(features), 1e-9 * np.array(features))
    return Panels(edges, jumps)


def energetic_frequencies(system: "WaveSystem", edges: Real, count: int = 16) -> tuple[Real, Real]:
    """
    Return frequencies [rad/s] that represent a system, the peak first, and the energy of the
    panels, (panels,) [m^2].
    """
    omega, weight = gauss(edges[:-1], edges[1:])
    energy = np.asarray(system.spectrum(omega)) * weight
    total = np.sum(energy, axis=1)
    strong = omega[energy > 1e-4 * np.max(energy, initial=0.0)]
    some = strong[:: max(1, strong.size // count)]
    return np.concatenate([[float(system.spectrum.peak)], some]), total


def direction_panels(system: "WaveSystem", omega: Real) -> Panels:
    """
    Return panels of theta from -pi to pi, relative to the system's direction, on which D is smooth
    at frequencies `omega`.
    """
    spreading, peak = system.spreading, float(system.spectrum.peak)
    breaks = wrapped(np.fromiter(getattr(spreading, "breaks", ()), dtype=np.float64))

    def sampled(theta: Real) -> Real:
        density = np.asarray(spreading(omega[:, None], theta[None, :], peak), dtype=np.float64)
        whole: Real = np.broadcast_to(density, (omega.size, theta.size))
        return whole

    quarters = 0.25 * np.pi * np.arange(-4.0, 5.0)
    features = np.unique(
        np.concatenate([[-0.5 * np.pi, 0.0, 0.5 * np.pi], breaks[np.abs(breaks) < np.pi]])
    )
    top = np.max(sampled(np.concatenate([features, quarters])), axis=1)
    # up to the next feature on each side: a table names many
    gaps = np.minimum(
        np.diff(features, prepend=features[-1] - 2.0 * np.pi, append=features[0] + 2.0 * np.pi),
        0.25 * np.pi,
    )
    graded = [
        _graded(sampled, f, reach, top)
        for f, reach in zip(features, itertools.pairwise(gaps), strict=True)
    ]
    edges = np.concatenate([quarters, features, *graded])
    edges = _bisected(sampled, _apart(edges[np.abs(edges) <= np.pi], 1e-12))
    jumps = _jumps(sampled, features, np.full(features.size, 1e-9))
    return Panels(edges, jumps)


def _apart(edges: Iterable[float], least: float) -> Real:
    """Return the edges, ascending, without those that differ from another by rounding only."""
    ascending = np.unique(np.fromiter(edges, dtype=np.float64))
    kept: Real = ascending[
        np.concatenate([[True], np.diff(ascending) > least * np.abs(ascending[1:])])
    ]
    return kept


def _graded(sampled: Sampled, feature: float, reach: tuple[float, float], top: Real) -> Real:
    """
    Return edges at `reach` (before, after) halved on both sides of a feature, down to where the
    values no longer change.
    """
    found = []
    scale = np.where(top > 0.0, top, 1.0)[:, None]
    for side, most in zip((-1.0, 1.0), reach, strict=True):
        steps = most * 0.5 ** np.arange(1, _HALVINGS + 1)
        values = sampled(feature + side * np.append(steps, 0.25 * steps[-1]))
        changed = np.any(
            np.abs(values[:, :-1] - values[:, -1:]) > _CHANGE * np.maximum(scale, values[:, -1:]),
            axis=0,
        )
        depth = int(np.max(np.flatnonzero(changed), initial=-1)) + 2
        found.append(feature + side * steps[:depth] if np.any(changed) else np.zeros(0))
    return np.concatenate(found)


def _bisected(sampled: Sampled, edges: Real) -> Real:
    """
    Return the edges, with more in between until eight points resolve every curve in every panel.
    """
    low, high = edges[:-1], edges[1:]
    done = [edges]
    total: Real | float = 0.0
    for _ in range(_BISECTIONS):
        points, weights = gauss(low, high)
        values = sampled(points.ravel()).reshape(-1, *points.shape)
        parts = np.sum(values * weights, axis=2)
        total = np.maximum(total, np.sum(parts, axis=1))
        rest = np.sum(np.abs(np.einsum("cpn,hn,n->hcp", values, _HIGHEST, _WEIGHTS)), axis=0) * (
            high - low
        )
        rough = np.any(rest > _TOLERANCE * np.asarray(total)[:, None], axis=0) & (
            high - low > 1e-12 * np.abs(high)
        )
        if not np.any(rough) or np.count_nonzero(rough) > 4096:
            break
        low, high = low[rough], high[rough]
        middle = 0.5 * (low + high)
        done.append(middle)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return np.unique(np.concatenate(done))


def _jumps(sampled: Sampled, at: Real, step: Real) -> Real:
    """Return the points among some at which a curve jumps."""
    before, after = sampled(at - step), sampled(at + step)
    top = np.max(np.maximum(before, after), axis=1, keepdims=True)
    jumping: Real = at[np.any(np.abs(after - before) > 1e-3 * top, axis=0) & (at != 0.0)]
    return jumping
