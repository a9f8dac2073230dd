"""Laws fitted to costs, and the size at which two costs cross."""

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
    y = overhead + factor law(N): a constant cost of each call, and the cost of its work.
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
    The size from which one cost stays below another, between two measured sizes.
    """

    below: float  # the largest size at which it still costs more
    above: float  # the next size: from here on it costs less
    at: float  # by linear interpolation of the logarithms


def n_log_n(count: Real) -> Real:
    """Return N log2 N: the work of a fast Fourier transform of N points."""
    return np.asarray(count * np.log2(count))


def square(count: Real) -> Real:
    """Return N^2: the work of summing N waves at N points."""
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
    centred = u - u.mean()
    exponent = float(centred @ v / (centred @ centred))
    rest = v - v.mean() - exponent * centred
    error = math.sqrt(float(rest @ rest) / (u.size - 2) / float(centred @ centred))
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
    Return the size from which the challenger costs less than the champion; None if there is none.

    It costs less at every larger size measured. If it costs less at all sizes, `below` and `at` are
    the first.

    Args:
        sizes: ascending.
        challenger, champion: costs at these sizes, > 0.

    Raises:
        ValueError: sizes that do not ascend, or a cost that is not positive.
    """
    n = np.asarray(sizes, dtype=np.float64)
    # > 0 where the challenger costs less
    lead = np.log(_positive(champion) / _positive(challenger))
    if n.ndim != 1 or n.size != lead.size or np.any(np.diff(n) <= 0.0):
        raise ValueError("sizes must be ascending, one for each cost")
    if n.size == 0 or lead[-1] <= 0.0:
        return None
    behind = np.flatnonzero(lead <= 0.0)
    if behind.size == 0:
        return Crossing(float(n[0]), float(n[0]), float(n[0]))
    i = int(behind[-1])
    share = float(lead[i] / (lead[i] - lead[i + 1]))
    return Crossing(float(n[i]), float(n[i + 1]), float(n[i] * (n[i + 1] / n[i]) ** share))


def _positive(values: RealLike) -> Real:
    """Return an array, every entry of which is positive and finite."""
    array = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if not np.all((array > 0.0) & np.isfinite(array)):
        raise ValueError(f"values must be positive and finite, got {array!r:.80}")
    return array


def _not_negative(columns: Real) -> tuple[float, float]:
    """
    Return the (a, b) >= 0 for which columns @ (a, b) is closest to 1, by least squares.

    If the unconstrained solution has a negative entry, one of the two is 0.
    """
    ones = np.ones(columns.shape[0])
    a, b = (float(v) for v in np.linalg.lstsq(columns, ones, rcond=None)[0])
    if a >= 0.0 and b >= 0.0:
        return a, b
    alone = [float(column @ ones / (column @ column)) for column in columns.T]
    errors = [float(np.sum((alone[i] * columns[:, i] - 1.0) ** 2)) for i in (0, 1)]
    return (alone[0], 0.0) if errors[0] < errors[1] else (0.0, alone[1])
