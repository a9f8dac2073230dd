"""
Which law a cost follows: its exponent with the standard error, what it costs to call at all, and
where two costs cross.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """y = factor x^exponent."""

    factor: float
    exponent: float
    error: float  # standard error of the exponent
    points: int

    def __call__(self, x: RealLike) -> Real:
        return np.asarray(self.factor * np.asarray(x, dtype=np.float64) ** self.exponent)


@dataclass(frozen=True, slots=True)
class Cost:
    """
    y = overhead + factor law(N): what a call costs before it does anything, and what each unit of
    work adds.
    """

    overhead: float
    factor: float
    law: Callable[[Real], Real]
    residual: float  # root mean square of the relative errors
    points: int

    def __call__(self, work: RealLike) -> Real:
        return np.asarray(
            self.overhead + self.factor * self.law(np.asarray(work, dtype=np.float64))
        )


@dataclass(frozen=True, slots=True)
class Crossing:
    """
    Where one cost undercuts another for good: between two measured sizes, and at a point between
    them.
    """

    below: float  # the largest size at which it is still the dearer one
    above: float  # the next: from here on it is the cheaper one
    at: float  # by a straight line between the logarithms


def n_log_n(count: Real) -> Real:
    """N log2 N: the work of a fast Fourier transform of N points."""
    return np.asarray(count * np.log2(count))


def square(count: Real) -> Real:
    """N^2: the work of summing N waves at N points."""
    return np.asarray(count * count)


def power_law(x: RealLike, y: RealLike) -> PowerLaw:
    """
    Fit y = factor x^exponent by least squares of the logarithms.

    Raises:
        ValueError: fewer than three points, or one that is not positive.
    """
    u, v = (np.log(_positive(values)) for values in (x, y))
    if u.size != v.size or u.size < 3 or np.ptp(u) == 0.0:
        raise ValueError(f"a power law needs at least three points of different x, got {u.size}")
    apart = u - u.mean()
    exponent = float(apart @ v / (apart @ apart))
    rest = v - v.mean() - exponent * apart
    error = math.sqrt(float(rest @ rest) / (u.size - 2) / float(apart @ apart))
    return PowerLaw(math.exp(float(v.mean() - exponent * u.mean())), exponent, error, int(u.size))


def cost(work: RealLike, y: RealLike, law: Callable[[Real], Real]) -> Cost:
    """
    Fit y = overhead + factor law(work), both at least 0, by least squares of the relative errors.

    Raises:
        ValueError: fewer than three points, or one that is not positive.
    """
    x, values = law(_positive(work)), _positive(y)
    if x.size != values.size or x.size < 3:
        raise ValueError(f"a cost needs at least three points, got {x.size}")
    columns = np.stack([1.0 / values, x / values], axis=1)
    overhead, factor = _not_negative(columns)
    residual = math.sqrt(float(np.mean((columns @ [overhead, factor] - 1.0) ** 2)))
    return Cost(overhead, factor, law, residual, int(x.size))


def crossover(sizes: RealLike, challenger: RealLike, champion: RealLike) -> Crossing | None:
    """
    Find from which size on the challenger costs less than the champion, at every larger size
    measured; None if it never does.

    Where it is the cheaper one from the first size on, `below` and `at` are that size.

    Args:
        sizes: in rising order.
        challenger, champion: what each costs at these sizes, > 0.
    """
    n = np.asarray(sizes, dtype=np.float64)
    lead = np.log(
        _positive(champion) / _positive(challenger)
    )  # > 0 where the challenger costs less
    if n.ndim != 1 or n.size != lead.size or np.any(np.diff(n) <= 0.0):
        raise ValueError("sizes must rise, one for each cost")
    if n.size == 0 or lead[-1] <= 0.0:
        return None
    behind = np.flatnonzero(lead <= 0.0)
    if behind.size == 0:
        return Crossing(float(n[0]), float(n[0]), float(n[0]))
    i = int(behind[-1])
    share = float(lead[i] / (lead[i] - lead[i + 1]))
    return Crossing(float(n[i]), float(n[i + 1]), float(n[i] * (n[i + 1] / n[i]) ** share))


def _positive(values: RealLike) -> Real:
    array = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if not np.all((array > 0.0) & np.isfinite(array)):
        raise ValueError(f"only what is positive and finite has a logarithm, got {array!r:.80}")
    return array


def _not_negative(columns: Real) -> tuple[float, float]:
    """
    The (a, b) >= 0 for which columns @ (a, b) comes nearest to 1: of the two unknowns, one may have
    to be 0.
    """
    ones = np.ones(columns.shape[0])
    a, b = (float(v) for v in np.linalg.lstsq(columns, ones, rcond=None)[0])
    if a >= 0.0 and b >= 0.0:
        return a, b
    alone = [float(column @ ones / (column @ column)) for column in columns.T]
    errors = [float(np.sum((alone[i] * columns[:, i] - 1.0) ** 2)) for i in (0, 1)]
    return (alone[0], 0.0) if errors[0] < errors[1] else (0.0, alone[1])
