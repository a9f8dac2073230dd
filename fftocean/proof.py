"""
Prove that a tile is the sea that was ordered: each check against something that shares no code with
what it checks.

The same checks that a user runs with `fftocean verify` stand in the test suite.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fftocean import gerstner
from fftocean.arrays import Integer, Real
from fftocean.errors import ParameterError, described
from fftocean.fields import EIGHT, FIELDS
from fftocean.gerstner import Surface
from fftocean.ocean import Frame, Ocean
from fftocean.statistics import Statistics, measure

_POINTS = 256  # at which the direct sum is taken: a grid of them where the tile is larger
_FRAMES = 48  # of the loop that is looked at


@dataclass(frozen=True, slots=True)
class Check:
    """
    One line of the proof: what was compared, how far apart they may be and why, and how far apart
    they are.
    """

    name: str
    against: str
    figure: float
    bound: float
    reason: str

    @property
    def passed(self) -> bool:
        """Whether the figure is within the bound (NaN is not)."""
        return self.figure <= self.bound


def verify(ocean: Ocean, t: float = 3.7) -> list[Check]:
    """
    Check an ocean: every field against the direct sum, Parseval, the seam, the loop, and its
    energy.

    Args:
        ocean: any ocean, of any precision.
        t: a time at which to look [s].

    Returns:
        The checks in order; the ocean is proven if all `.passed`.

    Raises:
        ParameterError: not an ocean.
    """
    if not isinstance(ocean, Ocean):
        raise ParameterError(
            f"ocean must be an Ocean, such as each of cascade.oceans, got {described(ocean)}"
        )
    return [
        *_fields(ocean, t),
        *_seam(ocean, t),
        *_loop(ocean),
        *_parseval(ocean, t),
        *_energy(ocean, measure(ocean)),
    ]


def _allowed(ocean: Ocean, t: float) -> float:
    """
    How far a field may be from the direct sum, over the largest value of its kind: some roundings,
    and in the sum that of omega t.
    """
    omega = float(np.max(ocean.modes().omega, initial=0.0))
    roundings = 1e-6 if ocean.dtype == "float32" else 1e-12
    return roundings + 2.0 * np.finfo(np.float64).eps * omega * abs(t)


def _least(ocean: Ocean) -> float:
    """The least value that the ocean's type holds with all its digits: waves below it are none."""
    kind = np.finfo(ocean.dtype)
    return float(kind.tiny) / float(kind.eps)


def _fields(ocean: Ocean, t: float) -> Iterator[Check]:
    """FFT against the sum of waves, at points spread over the tile."""
    frame = ocean.frame(t, fields=(*FIELDS, "normal", "jacobian"))
    ix, iy = _points(ocean)
    truth = gerstner.surface(ocean, ocean.grid.x[ix], ocean.grid.y[iy], t)
    reason = (
        "8 eps of float32" if ocean.dtype == "float32" else "4500 eps"
    ) + ", and the rounding of omega t"
    for name in (*FIELDS, "jacobian"):
        yield Check(
            name, "direct sum", _apart(ocean, frame, truth, name), _allowed(ocean, t), reason
        )
    area = _area(truth, ocean.choppiness)
    turned = float(
        np.max(np.linalg.norm(frame.normal[iy, ix] - truth.normal, axis=-1) * area)
    ) / float(np.max(area))
    yield Check(
        "normal",
        "direct sum, times area",
        turned,
        _allowed(ocean, t),
        "as above; where a fold has no area, a rounding turns it",
    )


def _apart(ocean: Ocean, frame: Frame, truth: Surface, name: str) -> float:
    """
    The largest difference of a field from the direct sum at `_points`, over the largest value of
    its kind.

    A kind is all displacements, all slopes, ...: waves that run along y have slopes along x of
    nothing but roundings.
    """
    ix, iy = _points(ocean)
    kind = [f for f in frame.fields if f.partition("_")[0] == name.partition("_")[0]]
    largest = float(
        np.max([[np.max(np.abs(frame[f])), np.max(np.abs(getattr(truth, f)))] for f in kind])
    )
    return float(np.max(np.abs(frame[name][iy, ix] - getattr(truth, name)))) / max(
        largest, _least(ocean)
    )


def _area(truth: Surface, choppiness: float) -> Real:
    """
    Area of the displaced surface over that of the still: the length of its tangents' cross product.
    """
    c, s = choppiness, truth
    along_x = np.stack([1.0 + c * s.stretch_xx, c * s.stretch_xy, s.slope_x], axis=-1)
    along_y = np.stack([c * s.stretch_xy, 1.0 + c * s.stretch_yy, s.slope_y], axis=-1)
    return np.asarray(np.linalg.norm(np.cross(along_x, along_y), axis=-1))


def _points(ocean: Ocean) -> tuple[Integer, Integer]:
    """Sample indices (ix, iy) spread over the tile, corners included."""
    grid = ocean.grid
    side = math.isqrt(_POINTS)
    ix = np.unique(np.linspace(0, grid.nx - 1, min(side, grid.nx)).astype(int))
    iy = np.unique(np.linspace(0, grid.ny - 1, min(side, grid.ny)).astype(int))
    columns, rows = np.meshgrid(ix, iy)
    return columns.ravel(), rows.ravel()


def _seam(ocean: Ocean, t: float) -> Iterator[Check]:
    """The exact surface one tile further east and north against the edges of the frame."""
    grid = ocean.grid
    frame = ocean.frame(t, fields=("height",))
    rows = np.unique(np.linspace(0, grid.ny - 1, min(64, grid.ny)).astype(int))
    columns = np.unique(np.linspace(0, grid.nx - 1, min(64, grid.nx)).astype(int))
    east = gerstner.surface(ocean, grid.lx, grid.y[rows], t).height - frame.height[rows, 0]
    north = gerstner.surface(ocean, grid.x[columns], grid.ly, t).height - frame.height[0, columns]
    worst = float(np.max(np.abs(np.concatenate([east, north])))) / max(
        float(np.max(np.abs(frame.height))), _least(ocean)
    )
    bound = _allowed(ocean, t) + 1e-11 + 4.0 * np.finfo(np.float64).eps * max(grid.nx, grid.ny)
    yield Check(
        "seam", "direct sum at x + L, y + L", worst, bound, "as the fields, and the rounding of k L"
    )


def _loop(ocean: Ocean) -> Iterator[Check]:
    """
    The loop's last frame leads to its first: to the bit on the clock of whole turns, to rounding
    for the sum of waves.
    """
    if ocean.loop is None:
        return
    first, again = ocean.loop_frame(5, _FRAMES), ocean.loop_frame(5 + _FRAMES * 10**9, _FRAMES)
    differing = sum(int(np.count_nonzero(first[name] != again[name])) for name in first.fields)
    yield Check("loop, frame j + F", "frame j", float(differing), 0.0, "equal bits")
    t = ocean.loop * 5 / _FRAMES
    ix, iy = _points(ocean)
    truth = gerstner.surface(ocean, ocean.grid.x[ix], ocean.grid.y[iy], t)
    apart = float(np.max([_apart(ocean, first, truth, name) for name in EIGHT]))
    yield Check(
        "loop, frame j",
        "direct sum at t = j T/F",
        apart,
        _allowed(ocean, t),
        "the worst of the eight fields, as above",
    )
    start, end = ocean.frame(0.0), ocean.frame(ocean.loop)
    differing = sum(int(np.count_nonzero(start[name] != end[name])) for name in start.fields)
    yield Check("loop, t = T", "t = 0", float(differing), 0.0, "equal bits")
    x, y = ocean.grid.x[ix[:32]], ocean.grid.y[iy[:32]]
    change = (
        gerstner.surface(ocean, x, y, 0.0).height - gerstner.surface(ocean, x, y, ocean.loop).height
    )
    scale = max(float(np.max(np.abs(start.height))), _least(ocean))
    omega = float(np.max(ocean.modes().omega, initial=0.0))
    bound = 1e-12 + 4.0 * np.finfo(np.float64).eps * omega * ocean.loop
    yield Check(
        "loop of the waves",
        "direct sum at t = 0 and T",
        float(np.max(np.abs(change))) / scale,
        bound,
        "the rounding of omega T",
    )


def _parseval(ocean: Ocean, t: float) -> Iterator[Check]:
    """
    The variance of the height in space against the energies of the waves that make it, beats and
    all.
    """
    height = ocean.frame(t, fields=("height",)).height.astype(np.float64)
    waves = ocean.modes()
    mx, my = (
        np.rint(waves.kx / ocean.grid.dkx).astype(int),
        np.rint(waves.ky / ocean.grid.dky).astype(int),
    )
    half = 0.5 * waves.amplitude * np.exp(-1j * (waves.omega * t + waves.phase))
    flip = (mx < 0) | ((mx == 0) & (my < 0))
    key = np.where(flip, -mx, mx) * (2 * ocean.grid.ny + 1) + np.where(flip, -my, my)
    order, places = np.unique(key, return_inverse=True)
    summed = np.zeros(order.size, dtype=np.complex128)
    np.add.at(summed, places, np.where(flip, np.conj(half), half))
    expected = 2.0 * float(np.sum(np.abs(summed) ** 2))
    bound = 2.0 * _allowed(ocean, t)  # a square doubles a relative error
    figure = _relative(float(np.mean(height**2)), expected, _least(ocean) ** 2)
    yield Check(
        "Parseval",
        "energies of the waves",
        figure,
        bound,
        "a mean of squares, at the fields' precision",
    )
    level = abs(float(np.mean(height))) / max(float(np.max(np.abs(height))), _least(ocean))
    yield Check("mean level", "0", level, _allowed(ocean, t), "k = 0 carries nothing")


def _energy(ocean: Ocean, statistics: Statistics) -> Iterator[Check]:
    """
    The sea's energy: what the tile holds and what it cannot add up; what this draw delivers is a
    likely draw.
    """
    delivered = 0.5 * float(np.sum(ocean.modes().amplitude ** 2))
    bound = 2e-6 if ocean.dtype == "float32" else 1e-11
    figure = _relative(statistics.m0, delivered, _least(ocean) ** 2)
    yield Check("m0 of the frame", "sum of a^2/2", figure, bound, "forward FFT of what came out")
    if ocean.sea is None or statistics.ordered is None or statistics.ordered.m0 == 0.0:
        return
    total = statistics.resolved + statistics.energy_below + statistics.energy_above
    yield Check(
        "energy held + lost",
        "m0 ordered, by quadrature",
        _relative(total, statistics.ordered.m0),
        1e-3,
        "the sum over cells against integrals along rays",
    )
    if statistics.resolved > 0.0:
        bound, reason = _likely(ocean)
        yield Check(
            "m0 of this draw",
            "m0 held on average",
            _relative(delivered, statistics.resolved),
            bound,
            reason,
        )


def _likely(ocean: Ocean) -> tuple[float, str]:
    """
    How far one draw's m0 may be from the mean, relative.

    Gaussian waves have exponential energies, of mean E each. Their sum passes its mean by sqrt(2 u
    sum E^2) + u max(E) with a probability of at most e^-u (Laurent & Massart 2000, lemma 1); u = 8.
    """
    a = ocean.amplitudes
    if a.draw != "gaussian":
        return 1e-9, "fixed amplitudes"
    energy = (
        np.concatenate([a.variance_forward.ravel(), a.variance_backward[:, 1:].ravel()])
        / a.variance
    )
    return 4.0 * math.sqrt(float(np.sum(energy**2))) + 8.0 * float(
        np.max(energy)
    ), "at most 1 draw in 3000 is further off"


def _relative(value: float, truth: float, least: float = 0.0) -> float:
    """
    The difference over the truth, or over the least that counts; the value itself where both are
    nothing.
    """
    return abs(value - truth) / (max(truth, least) or 1.0)
