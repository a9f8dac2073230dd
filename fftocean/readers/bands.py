"""Frequency bands of measured spectra."""

from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real, RealLike
from fftocean.errors import ReaderError

_ROUNDING: Final = 0.02
"""
How far a band may miss its frequency, as a share of its width. Files write edges, widths and
frequencies with few decimals.
"""

_OVERLAP: Final = 0.25
"""
How far bands may overlap, as a share of their width. Where only widths are known they are put
evenly about their frequencies; those of a geometric series with a ratio of 1.1 then overlap by 5 %.
"""

_MOST_CORRECTION: Final = 0.25  # largest relative change of a density to match Tm01 and Tm02


class Lines(NamedTuple):
    """A spectrum that is piecewise linear in frequency."""

    frequency: Real  # of the nodes, ascending [Hz]
    density: Real  # at the nodes [m2/Hz]
    factor: float  # m0 of the bands / m0 of the lines through the unchanged densities [-]
    moments: tuple[float, float, float]  # m0, m1, m2 of the bands' own sum [m2 Hz^n]
    matched: int  # the highest of these moments that the lines have, as all below it


def between_neighbours(frequency: Real) -> Real:
    """
    Return bands that reach half way to the neighbours, (f, 2) [Hz]; the outermost are symmetric.

    Buoys and the wavespectra package (`hs(tail=False)`) sum their spectra over these bands. A first
    edge below 0 Hz is kept, so that the width of its band is the one in these sums.
    """
    middle = 0.5 * (frequency[1:] + frequency[:-1])
    first, last = 2.0 * frequency[0] - middle[0], 2.0 * frequency[-1] - middle[-1]
    return np.stack([np.append(first, middle), np.append(middle, last)], axis=1)


def of_widths(where: str, frequency: Real, width: RealLike) -> Real:
    """
    Return bands of the widths that a file states, evenly about their frequencies, (f, 2) [Hz].

    Raises:
        ReaderError: as `checked`.
    """
    half = 0.5 * np.asarray(width, dtype=np.float64)
    return checked(where, frequency, np.stack([frequency - half, frequency + half], axis=-1))


def checked(where: str, frequency: Real, edges: RealLike) -> Real:
    """
    Check the bands that a file states.

    Args:
        where: what to call them in errors.
        frequency: (f,) ascending [Hz].
        edges: (f, 2) the lower and upper edge of each band [Hz], in either order.

    Returns:
        (f, 2) [Hz], lower edges first.

    Raises:
        ReaderError: edges that are not finite, a band without width, one that does not hold its
            frequency, or bands that overlap.
    """
    bands = np.array(edges, dtype=np.float64)
    if bands.shape != (frequency.size, 2):
        raise ReaderError(
            f"{where} must hold two edges for each of {frequency.size} frequencies, "
            f"got shape {bands.shape}"
        )
    if not np.all(np.isfinite(bands)):
        raise ReaderError(f"{where} must be finite, got {bands[~np.isfinite(bands)][0]} Hz")
    bands = np.sort(bands, axis=1)
    width = bands[:, 1] - bands[:, 0]
    slack = _ROUNDING * width
    for i in range(frequency.size):
        low, high, f = bands[i, 0], bands[i, 1], frequency[i]
        if not width[i] > 0.0 or high <= 0.0:
            raise ReaderError(
                f"{where}: the band at {f:g} Hz must have a width above 0, "
                f"got {low:g} to {high:g} Hz"
            )
        if not low - slack[i] <= f <= high + slack[i]:
            raise ReaderError(
                f"{where}: the band at {f:g} Hz must hold its frequency, got {low:g} to {high:g} Hz"
            )
        if i and low < bands[i - 1, 1] - _OVERLAP * (width[i] + width[i - 1]):
            raise ReaderError(
                f"{where}: the band at {f:g} Hz must begin where the one below it ends, "
                f"at {bands[i - 1, 1]:g} Hz, got {low:g} Hz"
            )
    return bands


def remaining(frequency: Real, edges: Real | None, kept: npt.NDArray[np.bool_]) -> Real:
    """
    Return the bands of the remaining frequencies; the two beside a gap meet in its middle.

    Args:
        frequency: (f,) all of them [Hz].
        edges: (f, 2) the file's own bands [Hz]; None where it has none.
        kept: (f,) which frequencies were measured.
    """
    rest = frequency[kept]
    if rest.size < 2:
        return np.zeros((rest.size, 2))
    if edges is None:
        return between_neighbours(rest)
    bands = edges[kept].copy()
    gap = np.flatnonzero(np.diff(np.flatnonzero(kept)) > 1)
    bands[gap, 1] = bands[gap + 1, 0] = 0.5 * (rest[gap] + rest[gap + 1])
    return bands


def straight_lines(frequency: Real, density: Real, edges: Real) -> Lines:
    """
    Return a piecewise linear spectrum with the moments of the sum over bands.

    The nodes are the frequencies and the two outermost edges; the first and last density extend to
    those. Each density is multiplied by the width of its band over the integral of its hat
    function: then m0 is exact, and the factor is 1 where bands reach half way to the neighbours. A
    hat function is wider than its band, so m1 and m2 still differ; a factor quadratic in frequency
    corrects them, by some 0.5 % where bands are 10 % wide. A spectrum of too few bands for that
    keeps its m0, and its m1 if a linear factor suffices: a single band misses Tm01 and Tm02 by at
    most a sixth of the squared ratio of step to frequency.

    Args:
        frequency: (f,) ascending [Hz], at least 2.
        density: (f,) >= 0, finite [m2/Hz].
        edges: (f, 2) the bands [Hz].

    Pinned by tests/readers/test_bands.py: the moments, integrated by quadrature of the lines.
    """
    width = edges[:, 1] - edges[:, 0]
    power = frequency[:, None] ** np.arange(3)
    want = np.sum((density * width)[:, None] * power, axis=0)
    low = max(edges[0, 0], 0.5 * frequency[0])  # stays above 0 Hz
    outer = [low] if low < frequency[0] * (1.0 - 1e-6) else []
    inner = [edges[-1, 1]] if edges[-1, 1] > frequency[-1] * (1.0 + 1e-6) else []
    nodes = np.concatenate([outer, frequency, inner])
    place = np.clip(
        np.arange(nodes.size) - len(outer), 0, frequency.size - 1
    )  # index of the density at each node
    weights = np.zeros((frequency.size, 3))
    np.add.at(weights, place, _node_weights(nodes))
    whole = float(np.sum(density * weights[:, 0]))
    if not (whole > 0.0 and want[0] > 0.0):
        return Lines(
            nodes, np.zeros(nodes.size), 1.0, (float(want[0]), float(want[1]), float(want[2])), 2
        )
    matched, values = _with_moments(frequency, density * (width / weights[:, 0]), weights, want)
    return Lines(
        nodes,
        values[place],
        float(want[0]) / whole,
        (float(want[0]), float(want[1]), float(want[2])),
        matched,
    )


def _node_weights(x: Real) -> Real:
    """Return the integrals of x^n, n = 0, 1, 2, times each node's hat function, (nodes, 3)."""
    a, b = x[:-1], x[1:]
    h = b - a
    falling = np.stack(
        [h / 2.0, h * (2.0 * a + b) / 6.0, h * (3.0 * a**2 + 2.0 * a * b + b**2) / 12.0], axis=1
    )
    rising = np.stack(
        [h / 2.0, h * (a + 2.0 * b) / 6.0, h * (a**2 + 2.0 * a * b + 3.0 * b**2) / 12.0], axis=1
    )
    total = np.zeros((x.size, 3))
    total[:-1] += falling
    total[1:] += rising
    return total


def _with_moments(frequency: Real, values: Real, weights: Real, want: Real) -> tuple[int, Real]:
    """
    Return the highest moment matched and the densities times a polynomial of frequency that does.

    Beyond twice the standard deviation from the mean frequency the polynomial is constant.
    """
    mean = want[1] / want[0]
    spread = np.sqrt(max(want[2] / want[0] - mean**2, 0.0))
    t = np.clip((frequency - mean) / max(spread, 1e-6 * mean), -2.0, 2.0)
    some = values > 0.0
    for degree in range(min(2, int(np.count_nonzero(some)) - 1), 0, -1):
        basis = t[:, None] ** np.arange(degree + 1)
        matrix = np.sum(
            (values[:, None] * weights[:, : degree + 1])[:, :, None] * basis[:, None, :], axis=0
        )
        scale = want[: degree + 1, None]
        try:
            coefficients = np.linalg.solve(matrix / scale, np.ones(degree + 1))
        except np.linalg.LinAlgError:
            continue
        factor = np.sum(basis * coefficients, axis=1)
        if np.all(np.abs(factor[some] - 1.0) <= _MOST_CORRECTION):
            changed = np.where(some, values * factor, 0.0)
            got = np.sum(changed[:, None] * weights[:, : degree + 1], axis=0)
            if np.all(np.abs(got - want[: degree + 1]) <= 1e-10 * want[: degree + 1]):
                return degree, changed
    return 0, values
