"""The choice of samples and tiles for queries that have a budget of milliseconds a call."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fftocean.amplitudes import refined
from fftocean.arrays import Real
from fftocean.cascade import Cascade, from_oceans
from fftocean.ocean import Ocean
from fftocean.wave_list import WaveList, list_waves, oceans_of

FEWEST = 16  # samples a side that a tile has at least
RESOLVED = 4  # samples of a wave that is interpolated well


@dataclass(frozen=True, slots=True)
class BudgetReport:
    """The tiles that a query has within its budget, and the waves that they leave out."""

    budget: float  # of a call at a new time [ms]
    points: int  # of that call
    milliseconds: float  # the median that was measured of such a call
    samples: tuple[tuple[int, int], ...]  # (nx, ny) of the tiles that are left
    sizes: tuple[tuple[float, float], ...]  # (lx, ly) of these [m]
    tiles_left_out: int
    variance_left_out: float  # share of the variance of the waves asked for [-]
    significant_wave_height: float  # of the waves that are left [m]
    significant_wave_height_asked: float  # of the waves asked for [m]
    shortest: float  # wave that is left [m]; inf without waves

    @property
    def fits(self) -> bool:
        """True if a call took no longer than the budget."""
        return self.milliseconds <= self.budget

    @property
    def is_whole(self) -> bool:
        """True if every wave asked for is there."""
        return self.variance_left_out == 0.0

    def __str__(self) -> str:
        """Return the report in words."""
        tiles = ", ".join(
            f"{nx} x {ny} over {lx:g} x {ly:g} m"
            for (nx, ny), (lx, ly) in zip(self.samples, self.sizes, strict=True)
        )
        waves = (
            "with every wave"
            if self.is_whole
            else f"without waves shorter than {self.shortest:.3g} m, "
            f"{100.0 * self.variance_left_out:.2g} % of the variance: "
            f"Hs {self.significant_wave_height:.3g} m of {self.significant_wave_height_asked:.3g} m"
        )
        return (
            f"{self.points} points in {self.milliseconds:.3g} ms of {self.budget:g} ms: "
            f"{tiles}, {waves}"
        )


def within(
    source: Ocean | Cascade,
    *,
    budget: float,
    points: int,
    shortest: float,
    measure: Callable[[Ocean | Cascade], float],
) -> tuple[Ocean | Cascade, BudgetReport]:
    """
    Return the source with as many of its waves as a call can have, and the report.

    Step by step a tile has its samples halved, down to `FEWEST` a side, or the smallest one is left
    out: the step that costs the least variance for each sample that it saves. Waves with fewer than
    `RESOLVED` samples count as lost in this comparison, since interpolation blurs them. Waves that
    are left are those of the source; the largest tile stays. Costs fall along this way, so that
    bisection finds the place with few measurements.

    Args:
        source: the tiles.
        budget: of a call at a new time [ms].
        points: of that call.
        shortest: wave that is asked for [m].
        measure: returns the milliseconds of such a call to a source.
    """
    stages = _stages(oceans_of(source), shortest)
    known: dict[int, tuple[Ocean | Cascade, float]] = {}

    def cost(stage: int) -> float:
        if stage not in known:
            changed = _changed(source, stages[stage])
            known[stage] = changed, measure(changed)
        return known[stage][1]

    low, high = 0, len(stages) - 1  # the first that fits is from low to high, if any does
    if cost(0) <= budget:
        high = 0
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if cost(middle) <= budget else (middle + 1, high)
    milliseconds = cost(low)
    chosen = known[low][0]
    return chosen, _report(source, chosen, shortest, budget, points, milliseconds)


def _stages(oceans: Sequence[Ocean], shortest: float) -> list[tuple[tuple[int, int], ...]]:
    """
    Return the samples (nx, ny) of the tiles that are left, stage by stage, all first.

    Each stage takes the step that costs the least variance for each sample that it saves.
    """
    left = [(ocean.grid.nx, ocean.grid.ny) for ocean in oceans]
    stages = [tuple(left)]
    tails = [_Tail(ocean, shortest) for ocean in oceans]
    while True:
        steps: list[tuple[float, int, int, tuple[int, int] | None]] = []
        for i, (now, tail) in enumerate(zip(left, tails, strict=False)):
            lost = tail.without(now)
            fewer = _halved(now)
            if fewer != now:
                saved = math.prod(now) - math.prod(fewer)
                steps.append(((tail.without(fewer) - lost) / saved, -saved, i, fewer))
            if i == len(left) - 1 and i > 0:
                saved = math.prod(now)
                steps.append(((tail.total - lost) / saved, -saved, i, None))
        if not steps:
            return stages
        *_, tile, fewer_or_none = min(steps, key=lambda step: step[:3])
        if fewer_or_none is None:
            left.pop()
        else:
            left[tile] = fewer_or_none
        stages.append(tuple(left))


class _Tail:
    """The variance of the waves of a tile that have too few samples to be interpolated well."""

    def __init__(self, ocean: Ocean, shortest: float) -> None:
        grid = ocean.grid
        kept = grid.k * shortest <= 2.0 * np.pi
        doubled = np.where(grid.mx > 0, 2.0, 1.0)  # of the half plane
        self._variance = np.where(kept, ocean.amplitudes.squares * doubled, 0.0)
        self._mx, self._my = np.abs(grid.mx)[None, :], np.abs(grid.my)[:, None]
        self.total = float(np.sum(self._variance))

    def without(self, samples: tuple[int, int]) -> float:
        """Return the variance of waves with fewer than `RESOLVED` samples [m^2]."""
        nx, ny = samples
        few = (self._mx * RESOLVED > nx) | (self._my * RESOLVED > ny)
        return float(np.sum(self._variance[few]))


def _halved(samples: tuple[int, int]) -> tuple[int, int]:
    """Return half the samples a side, where they are no fewer than `FEWEST`."""
    nx, ny = (n // 2 if n // 2 >= FEWEST else n for n in samples)
    return nx, ny


def _changed(source: Ocean | Cascade, samples: tuple[tuple[int, int], ...]) -> Ocean | Cascade:
    """Return the source with fewer samples and tiles."""
    oceans = oceans_of(source)
    if samples == tuple((ocean.grid.nx, ocean.grid.ny) for ocean in oceans):
        return source
    tiles = tuple(_coarser(ocean, *n) for ocean, n in zip(oceans, samples, strict=False))
    if isinstance(source, Ocean):
        return tiles[0]
    return from_oceans(source.sea, source.seed, tiles)


def _coarser(ocean: Ocean, nx: int, ny: int) -> Ocean:
    """Return the waves of an ocean that fewer samples hold."""
    grid = ocean.grid
    if (nx, ny) == (grid.nx, grid.ny):
        return ocean
    coarse = replace(grid, nx=nx, ny=ny)
    reach_x, reach_y = coarse.reach
    kept = (np.abs(grid.mx)[None, :] <= reach_x) & (np.abs(grid.my)[:, None] <= reach_y)
    return ocean.with_amplitudes(refined(ocean.amplitudes, coarse, kept, _plain))


def _plain(cycles: Real) -> Real:
    return np.ones_like(cycles, dtype=np.float64)


def _report(
    source: Ocean | Cascade,
    chosen: Ocean | Cascade,
    shortest: float,
    budget: float,
    points: int,
    milliseconds: float,
) -> BudgetReport:
    whole, left = (list_waves(waves, shortest=shortest) for waves in (source, chosen))
    grids = [ocean.grid for ocean in oceans_of(chosen)]
    asked, there = _variance(whole), _variance(left)
    same = left.omega.size == whole.omega.size
    return BudgetReport(
        budget=budget,
        points=points,
        milliseconds=milliseconds,
        samples=tuple((grid.nx, grid.ny) for grid in grids),
        sizes=tuple((grid.lx, grid.ly) for grid in grids),
        tiles_left_out=len(oceans_of(source)) - len(grids),
        variance_left_out=0.0 if same or asked == 0.0 else 1.0 - there / asked,
        significant_wave_height=4.0 * there**0.5,
        significant_wave_height_asked=4.0 * asked**0.5,
        shortest=float(2.0 * np.pi / np.max(np.hypot(left.kx, left.ky), initial=0.0))
        if left.omega.size
        else np.inf,
    )


def _variance(waves: WaveList) -> float:
    """Return the variance of linear waves [m^2]."""
    return 0.5 * float(np.sum(waves.amplitude**2))
