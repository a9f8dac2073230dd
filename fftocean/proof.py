"""
Prove that a tile is the sea that was ordered: each check against something that shares no code with what it checks.

The same checks that a user runs with `fftocean verify` stand in the test suite.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fftocean import gerstner
from fftocean.arrays import Integer
from fftocean.fields import FIELDS
from fftocean.ocean import Ocean
from fftocean.statistics import Statistics, measure

_POINTS = 256  # at which the direct sum is taken: a grid of them where the tile is larger


@dataclass(frozen=True, slots=True)
class Check:
    """One line of the proof: what was compared, how far apart they may be and why, and how far apart they are."""

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
    Check an ocean: every field against the direct sum, Parseval, the seam, the loop, and its energy.

    Args:
        ocean: any ocean, of any precision.
        t: a time at which to look [s].

    Returns:
        The checks in order; the ocean is proven if all `.passed`.
    """
    return [*_fields(ocean, t), *_seam(ocean, t), *_loop(ocean), *_parseval(ocean, t), *_energy(ocean, measure(ocean))]


def _fields(ocean: Ocean, t: float) -> Iterator[Check]:
    """FFT against the sum of waves, at points spread over the tile."""
    frame = ocean.frame(t, fields=(*FIELDS, "normal", "jacobian"))
    ix, iy = _points(ocean)
    truth = gerstner.surface(ocean, ocean.grid.x[ix], ocean.grid.y[iy], t)
    omega = float(np.max(ocean.modes().omega, initial=0.0))
    single = ocean.dtype == "float32"
    bound = 1e-6 if single else 1e-12 + 2.0 * np.finfo(np.float64).eps * omega * abs(t)
    reason = "8 eps of float32" if single else "4500 eps, and the rounding of omega t"
    for name in (*FIELDS, "normal", "jacobian"):
        exact = getattr(truth, name)
        scale = float(np.max(np.abs(frame[name]), initial=0.0)) or 1.0
        yield Check(name, "direct sum", float(np.max(np.abs(frame[name][iy, ix] - exact))) / scale, bound, reason)


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
    frame = ocean.frame(t, fields=("height", "displace_x", "displace_y"))
    scale = float(np.max(np.abs(frame.height))) or 1.0
    bound = 1e-6 if ocean.dtype == "float32" else 1e-11 + 4.0 * np.finfo(np.float64).eps * max(grid.nx, grid.ny)
    rows = np.unique(np.linspace(0, grid.ny - 1, min(64, grid.ny)).astype(int))
    columns = np.unique(np.linspace(0, grid.nx - 1, min(64, grid.nx)).astype(int))
    east = gerstner.surface(ocean, grid.lx, grid.y[rows], t).height - frame.height[rows, 0]
    north = gerstner.surface(ocean, grid.x[columns], grid.ly, t).height - frame.height[0, columns]
    worst = max(float(np.max(np.abs(east))), float(np.max(np.abs(north)))) / scale
    yield Check("seam", "direct sum at x + L, y + L", worst, bound, "as the fields, and the rounding of k L")


def _loop(ocean: Ocean) -> Iterator[Check]:
    """The loop's last frame leads to its first: to the bit on the clock of whole turns, to rounding for the sum of waves."""
    if ocean.loop is None:
        return
    first, again = ocean.loop_frame(5, 48), ocean.loop_frame(5 + 48 * 10**9, 48)
    differing = sum(int(np.count_nonzero(first[name] != again[name])) for name in first.fields)
    yield Check("loop, frame j + F", "frame j", float(differing), 0.0, "equal bits")
    start, end = ocean.frame(0.0), ocean.frame(ocean.loop)
    differing = sum(int(np.count_nonzero(start[name] != end[name])) for name in start.fields)
    yield Check("loop, t = T", "t = 0", float(differing), 0.0, "equal bits")
    ix, iy = _points(ocean)
    x, y = ocean.grid.x[ix[:32]], ocean.grid.y[iy[:32]]
    apart = gerstner.surface(ocean, x, y, 0.0).height - gerstner.surface(ocean, x, y, ocean.loop).height
    scale = float(np.max(np.abs(start.height))) or 1.0
    omega = float(np.max(ocean.modes().omega, initial=0.0))
    bound = 1e-12 + 4.0 * np.finfo(np.float64).eps * omega * ocean.loop
    yield Check("loop of the waves", "direct sum at t = 0 and T", float(np.max(np.abs(apart))) / scale, bound, "the rounding of omega T")


def _parseval(ocean: Ocean, t: float) -> Iterator[Check]:
    """The variance of the height in space against the energies of the waves that make it, beats and all."""
    height = ocean.frame(t, fields=("height",)).height.astype(np.float64)
    waves = ocean.modes()
    mx, my = np.rint(waves.kx / ocean.grid.dkx).astype(int), np.rint(waves.ky / ocean.grid.dky).astype(int)
    half = 0.5 * waves.amplitude * np.exp(-1j * (waves.omega * t + waves.phase))
    flip = (mx < 0) | ((mx == 0) & (my < 0))
    key = np.where(flip, -mx, mx) * (2 * ocean.grid.ny + 1) + np.where(flip, -my, my)
    order, places = np.unique(key, return_inverse=True)
    summed = np.zeros(order.size, dtype=np.complex128)
    np.add.at(summed, places, np.where(flip, np.conj(half), half))
    expected = 2.0 * float(np.sum(np.abs(summed) ** 2))
    omega = float(np.max(waves.omega, initial=0.0))
    bound = 1e-6 if ocean.dtype == "float32" else 1e-12 + 4.0 * np.finfo(np.float64).eps * omega * abs(t)
    yield Check(
        "Parseval",
        "energies of the waves",
        abs(float(np.mean(height**2)) - expected) / (expected or 1.0),
        bound,
        "a mean of squares, at the fields' precision",
    )
    yield Check("mean level", "0", abs(float(np.mean(height))) / (math.sqrt(expected) or 1.0), bound, "k = 0 carries nothing")


def _energy(ocean: Ocean, statistics: Statistics) -> Iterator[Check]:
    """The sea's energy: what the tile holds and what it cannot add up; what this draw delivers is a likely draw."""
    delivered = 0.5 * float(np.sum(ocean.modes().amplitude ** 2))
    bound = 2e-6 if ocean.dtype == "float32" else 1e-11
    yield Check("m0 of the frame", "sum of a^2/2", _relative(statistics.m0, delivered), bound, "forward FFT of what came out")
    if statistics.ordered is None or statistics.ordered.m0 == 0.0:
        return
    total = statistics.resolved + statistics.energy_below + statistics.energy_above
    yield Check(
        "energy held + lost",
        "m0 ordered, by quadrature",
        _relative(total, statistics.ordered.m0),
        2e-3,
        "a few cells near the peak by the midpoint rule",
    )
    if statistics.resolved > 0.0:
        bound = 5.0 * statistics.sampling_error or 1e-9
        reason = "5 standard deviations of one draw" if statistics.sampling_error else "fixed amplitudes"
        yield Check("m0 of this draw", "m0 held on average", _relative(delivered, statistics.resolved), bound, reason)


def _relative(value: float, truth: float) -> float:
    return abs(value - truth) / truth if truth else abs(value)
