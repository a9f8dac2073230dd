"""A sea over several tiles, each with its own size and band of wavenumbers."""

import math
import struct
import warnings
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from fftocean.amplitudes import Draw, Modes, seed_amplitudes
from fftocean.cells import WHOLE, Band, parts_of_sea
from fftocean.computation import Computation
from fftocean.errors import ParameterError, SeaWarning, described
from fftocean.fields import EIGHT, POINTWISE
from fftocean.fixed_values import Rarity
from fftocean.grid import Grid
from fftocean.host import require_memory
from fftocean.limits import BAND_EDGE, LOOP, SEED
from fftocean.noise import philox
from fftocean.ocean import (
    BOUND,
    Frame,
    Ocean,
    bound_by_order,
    check_fields,
    from_amplitudes,
    longest_period,
    memory_needed,
)
from fftocean.physics.plausibility import require_plausible
from fftocean.physics.sea import Sea

Tile = tuple[int | tuple[int, int], float | tuple[float, float]]
"""n, or (nx, ny), and size, or (lx, ly) [m]."""


class Cascade:
    """
    Several periodic tiles that add up to one sea: long waves on a large tile, ripples on small
    ones.

    The water at parameters (x0, y0) is the sum over the tiles: height = sum of heights, and the
    surface is at (x0, y0) + choppiness sum of displacements. Each wavenumber |k| belongs to one
    tile, so no wave is missing and none is counted twice; a cell that is cut by the edge of a band
    is shared between two tiles by energy. An automatic edge is the geometric mean of the largest
    |k| of the large tile and the smallest of the small one: then there are as many samples to the
    shortest wave of the one as waves across the other, within a factor 3.

    The largest tile has `seed` itself, so it shows the waves of the `Ocean` of its n, size and
    seed. Each of the others has a seed of its own, made of `seed` and its size
    (`cascade.oceans[i].seed`). So its waves depend neither on other tiles, nor on n, nor on the
    bands.

    Args:
        sea: the specified sea state.
        tiles: (n, size) of each, as in `Ocean`, from the largest to the smallest. If no size is a
            multiple of another, the sum repeats only after a very long distance.
        bands: (lowest, highest) |k| of each tile [rad/m], each starting where the one before ends;
            None for automatic ones.
        seed: random seed.
        loop: period after which all tiles repeat [s], or one for each; None for water that never
            repeats.
        choppiness, dtype, amplitudes, backend, planning, threads: as in `Ocean`.
        order, bound: as in `Ocean`. Only the largest tile has waves of second order, of pairs of
            its own waves: a sum over waves of two tiles belongs to no tile's grid.

    Threads can share a cascade as they can share an `Ocean`.

    Raises:
        ParameterError: a value out of range, tiles out of order, bands that leave wavenumbers out
            or are beyond their tile, or a sea whose troughs would bare the bed.
    """

    def __init__(
        self,
        sea: Sea,
        tiles: Iterable[Tile],
        *,
        bands: Sequence[Band] | None = None,
        seed: int = 0,
        loop: float | Sequence[float] | None = None,
        choppiness: float = 1.0,
        dtype: str = "float32",
        amplitudes: Draw = "gaussian",
        backend: str = "auto",
        planning: str = "estimate",
        threads: int = 1,
        order: int = 1,
        bound: int = BOUND,
    ) -> None:
        if not isinstance(sea, Sea):
            raise ParameterError(f"sea must be a Sea, got {described(sea)}")
        grids = _grids(tiles)
        shared = band_edges(grids) if bands is None else _checked_bands(bands, grids)
        loops = _loops(loop, len(grids))
        seed = SEED.check("seed", seed)
        computation = Computation(dtype, backend, planning, threads)
        require_memory(
            f"a cascade of {len(grids)} tiles",
            sum(memory_needed(grid, computation.dtype) for grid in grids),
        )
        _warn_of_short_loops(sea, shared, loops)
        oceans: list[Ocean] = []
        parts = parts_of_sea(sea)
        for grid, own, band, period in zip(
            grids, tile_seeds(seed, grids), shared, loops, strict=True
        ):
            waves = seed_amplitudes(
                sea, grid, seed=own, loop=period, draw=amplitudes, band=band, parts=parts
            )
            second = bound_by_order(
                order if not oceans else 1, bound, waves, choppiness, computation
            )
            oceans.append(from_amplitudes(sea, own, waves, choppiness, computation, second))
        require_plausible(sea, stacklevel=2)
        self._set_up(sea, seed, tuple(oceans))

    def _set_up(self, sea: Sea | None, seed: int | None, oceans: tuple[Ocean, ...]) -> None:
        self.sea, self.seed, self.oceans = sea, seed, oceans
        self._recipe = (sea, seed, oceans)

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute once, as in an ocean."""
        if hasattr(self, "_recipe"):
            raise AttributeError(f"a cascade is frozen: make another with the {name} that you want")
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle and copy the tiles."""
        return from_oceans, self._recipe

    def __len__(self) -> int:
        """Number of tiles."""
        return len(self.oceans)

    @property
    def bands(self) -> tuple[Band, ...]:
        """Lowest and highest wavenumber |k| of each tile [rad/m]."""
        return tuple(ocean.amplitudes.band for ocean in self.oceans)

    @property
    def choppiness(self) -> float:
        """Factor on the horizontal displacement [-]."""
        return self.oceans[0].choppiness

    @property
    def depth(self) -> float:
        """Still-water depth [m]."""
        return self.oceans[0].depth

    @property
    def dtype(self) -> str:
        """Precision of the fields: "float32" or "float64"."""
        return self.oceans[0].dtype

    @property
    def loops(self) -> tuple[float | None, ...]:
        """Period of each tile [s], or None."""
        return tuple(ocean.loop for ocean in self.oceans)

    @property
    def loop(self) -> float | None:
        """Period that all tiles have in common [s], or None."""
        return self.loops[0] if len(set(self.loops)) == 1 else None

    @property
    def rarity(self) -> Rarity | None:
        """Rarity of the values that `fo.constrained` made the sum of tiles have, or None."""
        return self.oceans[0].rarity

    @property
    def variance(self) -> float:
        """m0 of all tiles together, the mean over seeds [m^2]."""
        return sum(ocean.amplitudes.variance for ocean in self.oceans)

    @property
    def order(self) -> int:
        """1 for linear waves, 2 if the largest tile has waves of second order."""
        return self.oceans[0].order

    @property
    def bound(self) -> int:
        """Largest number of waves whose pairs have bound waves; 0 at order 1."""
        return self.oceans[0].bound

    def linear(self) -> "Cascade":
        """Return the cascade of the same waves without second order; this one if it has none."""
        if self.order == 1:
            return self
        return from_oceans(self.sea, self.seed, tuple(ocean.linear() for ocean in self.oceans))

    def modes(self) -> Modes:
        """Return every wave of every tile, as `Ocean.modes`, the largest tile's first."""
        each = [ocean.modes() for ocean in self.oceans]
        return Modes(*(np.concatenate(column) for column in zip(*each, strict=True)))

    def frame(self, t: float, fields: Sequence[str] = EIGHT) -> tuple[Frame, ...]:
        """
        Return each tile's frame at time t [s], the largest's first; arguments as in `Ocean.frame`.

        Linear fields add up over tiles: heights, displacements, slopes, stretches and velocities.
        Normals and Jacobians do not, nor does foam: a `Window` makes them from the sums.

        Raises:
            ParameterError: a field that does not add up, and as `Ocean.frame`.
        """
        fields = _summable(fields)
        return tuple(ocean.frame(t, fields) for ocean in self.oceans)

    def loop_frame(self, j: int, count: int, fields: Sequence[str] = EIGHT) -> tuple[Frame, ...]:
        """
        Return each tile's j-th of `count` equally spaced frames of the common loop.

        Raises:
            ParameterError: the tiles have no period in common, a field that does not add up, and as
                `Ocean.loop_frame`.
        """
        fields = _summable(fields)
        if self.loop is None:
            raise ParameterError(f"loop_frame needs one period for all tiles, got {self.loops}")
        return tuple(ocean.loop_frame(j, count, fields) for ocean in self.oceans)

    def __repr__(self) -> str:
        shown = 3  # tiles
        tiles = ", ".join(
            f"{o.grid.nx} x {o.grid.ny} over {o.grid.lx:g} x {o.grid.ly:g} m "
            f"for {low:.3g} to {high:.3g} rad/m"
            for o, (low, high) in zip(self.oceans[:shown], self.bands, strict=False)
        )
        tiles += f", {len(self) - shown} more" if len(self) > shown else ""
        loop = self.loops if self.loop is None else self.loop
        return f"Cascade({tiles}; depth={self.depth:g}, loop={loop}, dtype={self.dtype!r})"


def _summable(fields: Sequence[str]) -> tuple[str, ...]:
    """Return the names of fields, all of which add up over tiles."""
    names = check_fields(fields)
    for name in names:
        if name in POINTWISE:
            raise ParameterError(
                f"a field of a cascade must add up over its tiles, got {name!r}, "
                f"which is formed of the sums: fo.Window(cascade).frame(t, fields=({name!r},)); "
                f"that of one tile alone is cascade.oceans[i].frame(t, ({name!r},))"
            )
    return names


def from_oceans(sea: Sea | None, seed: int | None, oceans: tuple[Ocean, ...]) -> Cascade:
    """Return the cascade of given tiles, the largest first, without seeding them again."""
    cascade = Cascade.__new__(Cascade)
    cascade._set_up(sea, seed, oceans)
    return cascade


def reach_of(grid: Grid) -> tuple[float, float]:
    """
    Return the lowest and highest |k| at which a tile has waves of every direction [rad/m].

    They lie outside its missing cell at k = 0, and within its rectangle of wavenumbers.
    """
    reach_x, reach_y = grid.reach
    return 0.5 * math.hypot(grid.dkx, grid.dky), min(
        (reach_x + 0.5) * grid.dkx, (reach_y + 0.5) * grid.dky
    )


def band_edges(grids: Sequence[Grid]) -> tuple[Band, ...]:
    """
    Return the band of each tile: from 0 to inf, cut at the geometric mean of what two can hold.

    Raises:
        ParameterError: between two tiles lie wavenumbers that neither can hold.
    """
    cuts = []
    for i, (large, small) in enumerate(pairwise(grids)):
        finest, coarsest = reach_of(large)[1], reach_of(small)[0]
        if not coarsest <= finest:
            raise ParameterError(
                f"tiles must overlap in wavenumbers: tile {i} holds every wave up to "
                f"{finest:.4g} rad/m, tile {i + 1} only from {coarsest:.4g} on; "
                f"give tile {i} more samples or tile {i + 1} a larger size"
            )
        cuts.append(math.sqrt(coarsest * finest))
    for i, (low, high) in enumerate(pairwise(cuts)):
        if not low < high:
            raise ParameterError(
                f"tile {i + 1} must be finer than tile {i} and coarser than tile {i + 2}: "
                "nothing is left for it to hold"
            )
    return tuple(pairwise([WHOLE[0], *cuts, WHOLE[1]]))


def tile_jobs(tiles: Iterable[Tile], seed: int) -> list[tuple[Grid, int, Band]]:
    """
    Return the grid, the seed and the automatic band of each tile of a cascade: an `Ocean` of these
    is the tile.

    Raises:
        ParameterError: as `Cascade`.
    """
    grids = _grids(tiles)
    return list(zip(grids, tile_seeds(seed, grids), band_edges(grids), strict=True))


def tile_seeds(seed: int, grids: Sequence[Grid]) -> list[int]:
    """Return the seed of each tile; the largest has that of the cascade."""
    return [seed, *(tile_seed(seed, grid.lx, grid.ly) for grid in grids[1:])]


def tile_seed(seed: int, lx: float, ly: float) -> int:
    """
    Return the seed of a smaller tile: a hash of the cascade's seed and the tile's size.

    The hash is one block of the generator that realises the waves.
    """
    counter = tuple(
        np.array(word, dtype=np.uint64) for word in struct.unpack("<4I", struct.pack("<2d", lx, ly))
    )
    first, second, *_ = philox(
        (counter[0], counter[1], counter[2], counter[3]), (seed & 0xFFFFFFFF, seed >> 32)
    )
    return int(first) << 32 | int(second)


def _grids(tiles: Iterable[Tile]) -> list[Grid]:
    """Check the list of tiles."""
    try:
        pairs = [(n, size) for n, size in tiles]
    except (TypeError, ValueError) as error:
        raise ParameterError(f"tiles must be a list of (n, size), got {tiles!r:.80}") from error
    if not pairs:
        raise ParameterError("tiles must be at least one (n, size), got none")
    grids = [Grid.of(n, size) for n, size in pairs]
    for i, (large, small) in enumerate(pairwise(grids)):
        if not (small.lx < large.lx and small.ly < large.ly):
            raise ParameterError(
                f"tiles must go from the largest to the smallest, "
                f"got {large.lx:g} x {large.ly:g} m before {small.lx:g} x {small.ly:g} m"
            )
        for along, ratio in (("x", large.lx / small.lx), ("y", large.ly / small.ly)):
            if abs(ratio - round(ratio)) < 1e-9 * ratio:
                warnings.warn(
                    f"tile {i} is exactly {round(ratio)} times as wide as tile {i + 1} along "
                    f"{along}: together they repeat no later than the larger one alone; "
                    "choose sizes whose ratio is not whole",
                    SeaWarning,
                    stacklevel=3,
                )
                break
    return grids


def _checked_bands(bands: Sequence[Band], grids: Sequence[Grid]) -> tuple[Band, ...]:
    """
    Return given bands, each of which starts where the last ended.

    Raises:
        ParameterError: bands that leave a gap, or reach beyond the waves of their tile.
    """
    try:
        pairs = [(low, high) for low, high in bands]
    except (TypeError, ValueError) as error:
        raise ParameterError(
            f"bands must be a list of (lowest, highest) wavenumber, got {bands!r:.80}"
        ) from error
    if len(pairs) != len(grids):
        raise ParameterError(
            f"bands must be one for each of the {len(grids)} tiles, got {len(pairs)}"
        )
    checked = [
        (BAND_EDGE.check("a band's lowest |k|", low), BAND_EDGE.check("a band's highest |k|", high))
        for low, high in pairs
    ]
    for i, (low, high) in enumerate(checked):
        coarsest, finest = reach_of(grids[i])
        if not low < high:
            raise ParameterError(f"bands must rise, got {low:g} to {high:g} rad/m for tile {i}")
        if i > 0 and low != checked[i - 1][1]:
            raise ParameterError(
                f"bands must adjoin: tile {i - 1} ends at {checked[i - 1][1]!r} rad/m, "
                f"tile {i} starts at {low!r}"
            )
        if i > 0 and low < coarsest:
            raise ParameterError(
                f"the band of tile {i} must start at {coarsest:.4g} rad/m, its longest waves, "
                f"or above, got {low:g}"
            )
        if i < len(grids) - 1 and high > finest:
            raise ParameterError(
                f"the band of tile {i} must end at {finest:.4g} rad/m, its shortest waves, "
                f"or below, got {high:g}"
            )
    return tuple(checked)


def _loops(loop: float | Sequence[float] | None, count: int) -> list[float | None]:
    """Return one period for each tile."""
    if not isinstance(loop, (tuple, list)):
        return [None if loop is None else LOOP.check("loop", loop)] * count
    if len(loop) != count:
        raise ParameterError(
            f"loop must be one period, or one for each of the {count} tiles, got {len(loop)}"
        )
    return [None if period is None else LOOP.check("loop", period) for period in loop]


def _warn_of_short_loops(sea: Sea, bands: Sequence[Band], loops: Sequence[float | None]) -> None:
    """
    Warn of loops shorter than four periods of the most energetic waves of a band.

    These are at the peak of the sea, or the longest in the band if they are shorter.
    """
    tp = None if all(loop is None for loop in loops) else sea.tp
    for i, (band, loop) in enumerate(zip(bands, loops, strict=True)):
        if loop is not None and loop < 4.0 * (period := longest_period(sea, band, tp)):
            warnings.warn(
                f"a loop of {loop:g} s is less than four periods of the long waves of tile {i} "
                f"({4.0 * period:.1f} s): they run visibly too fast or too slow",
                SeaWarning,
                stacklevel=3,
            )
