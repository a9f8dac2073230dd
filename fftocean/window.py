"""The sum of a cascade's tiles on a grid of the world, with pointwise fields of the sum."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fftocean.amplitudes import refined, refined_gain
from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError
from fftocean.fields import EIGHT, FIELDS, POINTWISE
from fftocean.frame import Frame
from fftocean.grid import Grid
from fftocean.host import require_memory
from fftocean.kernels import interpolate, surface
from fftocean.limits import FRAMES, Quantity
from fftocean.ocean import Ocean, check_fields, memory_needed

PLACE = Quantity("m", -1e9, 1e9)
WAVELENGTH = Quantity("m", 0.0, math.inf)
OVERSAMPLED = 2
"""Samples of the splines to one of a tile that has waves of fewer than eight samples, a side."""

_MADE_OF: dict[str, tuple[str, ...]] = {**{name: (name,) for name in FIELDS}, **POINTWISE}


class Window:
    """
    A rectangle of the world in which all tiles of a cascade are added up.

    `frame` and `loop_frame` are those of `Ocean`. Sample [iy, ix] is the water whose rest position
    is (x + ix size_x/nx, y + iy size_y/ny). Heights, displacements, slopes, stretches and
    velocities are sums over the tiles; "normal" and "jacobian" are computed from the sums, as are
    `fo.normals(frame)`, `fo.jacobian(frame)` and the foam of `fo.Foam().loop(window, count)`: they
    do not add up over tiles. A window repeats in space only where its sides are whole multiples of
    the sizes of all tiles.

    Between the samples of a tile its fields are cubic splines on a grid that is fine enough: they
    miss at most 0.6 % of a wave of two samples, 0.04 % of one of four (Unser 1999, the error kernel
    sqrt(2 zeta(8)) (k h/2 pi)^4).

    Args:
        source: a `Cascade`, or an `Ocean`.
        n: samples a side, or (nx, ny); None is as many as the largest tile has.
        size: of the window [m], or (size_x, size_y); None is the largest tile's.
        x, y: its south-west corner in the world [m].
        shortest: waves shorter than this are left out [m]. 0 keeps all: values at points are right,
            and an image of them is aliased where its samples are farther apart than half the
            shortest wave.

    Raises:
        ParameterError: a source without tiles, a value out of range, or more memory than there is.

    Pinned by tests/test_window.py: the sum of all waves of all tiles, one by one.
    """

    def __init__(
        self,
        source: Cascade | Ocean,
        *,
        n: int | tuple[int, int] | None = None,
        size: float | tuple[float, float] | None = None,
        x: float = 0.0,
        y: float = 0.0,
        shortest: float = 0.0,
    ) -> None:
        if not isinstance(source, (Cascade, Ocean)):
            raise ParameterError(f"source must be a Cascade or an Ocean, got {source!r:.80}")
        self.oceans = source.oceans if isinstance(source, Cascade) else (source,)
        largest = self.oceans[0].grid
        self.grid = Grid.of(
            (largest.nx, largest.ny) if n is None else n,
            (largest.lx, largest.ly) if size is None else size,
        )
        self.x, self.y = PLACE.check("x", x), PLACE.check("y", y)
        self.shortest = WAVELENGTH.check("shortest", shortest)
        self.sea, self.seed = source.sea, source.seed
        self.choppiness, self.depth, self.dtype, self.loop = (
            source.choppiness,
            source.depth,
            source.dtype,
            source.loop,
        )
        fine = [_spline_grid(ocean) for ocean in self.oceans]
        needed = 128.0 * self.grid.nx * self.grid.ny  # positions, sums and a frame
        needed += sum(memory_needed(grid, self.dtype) for grid in fine)
        require_memory(f"a window of n = {self.grid.nx} x {self.grid.ny}", needed)
        self._splines = [
            _spline_ocean(ocean, grid, self.shortest)
            for ocean, grid in zip(self.oceans, fine, strict=True)
        ]
        self._recipe = {
            "n": (self.grid.nx, self.grid.ny),
            "size": (self.grid.lx, self.grid.ly),
            "x": x,
            "y": y,
            "shortest": shortest,
        }
        self.source = source

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle and copy the arguments."""
        return _rebuilt, (self.source, self._recipe)

    def __repr__(self) -> str:
        g = self.grid
        return (
            f"Window({g.nx} x {g.ny}, {g.lx:g} x {g.ly:g} m from ({self.x:g}, {self.y:g}), "
            f"{len(self.oceans)} tiles)"
        )

    def frame(self, t: float, fields: Sequence[str] = EIGHT, *, out: Frame | None = None) -> Frame:
        """
        Return the summed water at time t; fields and errors as in `Ocean.frame`.

        Args:
            t: any time [s].
            fields: which arrays to compute.
            out: an earlier frame, which becomes the new one and is returned.

        Raises:
            ParameterError: as `Ocean.frame`.
        """
        fields, needs = _needed(fields)
        return self._summed(
            [ocean.frame(t, needs) for ocean in self._splines], float(t), fields, needs, out
        )

    def loop_frame(
        self, j: int, count: int, fields: Sequence[str] = EIGHT, *, out: Frame | None = None
    ) -> Frame:
        """
        Return the j-th of `count` equally spaced frames of the common loop.

        Raises:
            ParameterError: the tiles have no period in common, and as `Ocean.loop_frame`.
        """
        if self.loop is None:
            raise ParameterError(
                "loop_frame needs one period for all tiles: Cascade(..., loop=16.0)"
            )
        fields, needs = _needed(fields)
        frames = [ocean.loop_frame(j, count, needs) for ocean in self._splines]
        return self._summed(
            frames,
            self.loop * (int(j) % FRAMES.check("count", count)) / count,
            fields,
            needs,
            out,
        )

    def _summed(
        self,
        frames: list[Frame],
        t: float,
        fields: tuple[str, ...],
        needs: tuple[str, ...],
        out: Frame | None,
    ) -> Frame:
        """
        Sum the splines of the tiles at the samples of the window, and compute pointwise fields.
        """
        grid = self.grid
        total = np.zeros((grid.nx * grid.ny, len(needs)))
        for frame in frames:
            u, v = self._texels(frame.grid)
            interpolate.bicubic(
                np.stack([frame[name] for name in needs], axis=-1), u, v, True, total
            )
        sums = {
            name: np.ascontiguousarray(total[:, i], dtype=self.dtype).reshape(grid.shape)
            for i, name in enumerate(needs)
        }
        arrays = {name: sums[name] if name in sums else self._made(name, sums) for name in fields}
        if out is None:
            return Frame(t, grid, self.choppiness, arrays)
        if not isinstance(out, Frame):
            raise ParameterError(f"out must be a frame, got {out!r:.80}")
        out._become(Frame(t, grid, self.choppiness, arrays))
        return out

    def _texels(self, fine: Grid) -> tuple[Real, Real]:
        """Return the samples of the window in texels of a tile, reduced in double precision."""
        u = np.fmod((self.x + self.grid.x) / fine.lx, 1.0) * fine.nx
        v = np.fmod((self.y + self.grid.y) / fine.ly, 1.0) * fine.ny
        return np.tile(u, self.grid.ny), np.repeat(v, self.grid.nx)

    def _made(self, name: str, sums: dict[str, Real]) -> Real:
        """Return a normal or a Jacobian from summed slopes and stretches."""
        c = np.dtype(self.dtype).type(self.choppiness)
        parts = [sums[part] for part in _MADE_OF[name]]
        normal = name == "normal"
        out = np.empty((*self.grid.shape, 3) if normal else self.grid.shape, dtype=self.dtype)
        kernel: Callable[..., None] = surface.normals if normal else surface.jacobian
        kernel(*parts, c, out)
        return out


def _rebuilt(source: Cascade | Ocean, recipe: dict[str, Any]) -> Window:
    """Return a window from its arguments."""
    return Window(source, **recipe)


def _needed(fields: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the fields asked for, and the linear ones that they are computed from."""
    fields = check_fields(fields, tuple(_MADE_OF))
    return fields, tuple(dict.fromkeys(part for name in fields for part in _MADE_OF[name]))


def _spline_grid(ocean: Ocean) -> Grid:
    """
    Return the grid for the splines of a tile.

    It is that of the tile if all waves have eight samples, else one `OVERSAMPLED` times as fine.
    """
    a, grid = ocean.amplitudes, ocean.grid
    rows, columns = np.nonzero(a.squares > 0.0)
    short = bool(
        np.any(8 * grid.mx[columns] > grid.nx) or np.any(8 * np.abs(grid.my[rows]) > grid.ny)
    )
    factor = OVERSAMPLED if short else 1
    return replace(grid, nx=factor * grid.nx, ny=factor * grid.ny)


def _spline_ocean(ocean: Ocean, fine: Grid, shortest: float) -> Ocean:
    """
    Return the ocean whose frames are cubic spline coefficients of the fields of another.

    They are on the grid `fine`, without waves shorter than `shortest` [m].
    """
    a, grid = ocean.amplitudes, ocean.grid
    kept = grid.active & (grid.k * shortest <= 2.0 * np.pi)
    response = interpolate.spline_response
    return ocean.spectrally_scaled(
        refined(a, fine, kept, response), refined_gain(grid, fine, kept, response)
    )
