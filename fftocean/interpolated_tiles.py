"""Interpolation of the frames of one or more tiles at points."""

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.fields import GEOMETRY, potential_factor
from fftocean.forks import Process
from fftocean.kernels import interpolate
from fftocean.kernels import query as kernels
from fftocean.ocean import Ocean
from fftocean.point_results import FAR, PointFunction, PointResults, write_normals

MOTION = ("displace_x", "displace_y", "height")
VELOCITY = ("velocity_x", "velocity_y", "velocity_z")


class InterpolatedTiles:
    """A source whose frames are interpolated; it keeps those of the last time."""

    block = 8192  # points that a thread takes at a time: some milliseconds

    def __init__(
        self, oceans: tuple[Ocean, ...], *, spline: bool, shortest: float, threads: int
    ) -> None:
        used = [
            ocean
            for ocean in oceans
            if np.any(
                _kept(ocean, shortest)
                & ((ocean.amplitudes.forward != 0) | (ocean.amplitudes.backward != 0))
            )
        ]
        self._kind = kernels.SPLINE if spline else kernels.BILINEAR
        self._spline, self._shortest, self._threads = spline, shortest, threads
        self._plain = used
        self._oceans = (
            [self._filtered(ocean) for ocean in used] if spline or shortest > 0.0 else used
        )
        self._accelerated: list[Ocean] | None = None
        self._choppiness = oceans[0].choppiness
        grids = [ocean.grid for ocean in used]
        self._sizes = np.array([(grid.lx, grid.ly) for grid in grids]).reshape(-1, 2)
        frame = interpolate.FRAME
        starts = np.cumsum([0, *((grid.nx + frame) * (grid.ny + frame) for grid in grids)])
        self._layout = np.array(
            [(start, grid.nx, grid.ny) for start, grid in zip(starts, grids, strict=False)],
            dtype=np.int64,
        ).reshape(-1, 3)
        self._rates = self._layout[:, 1:] / self._sizes
        self._texels, self._dtype = int(starts[-1]), oceans[0].dtype
        self.limit = 1e-9 * float(np.max(self._sizes, initial=0.0))
        self._reach = (
            FAR
            * self._choppiness
            * math.sqrt(sum(_mean_square_displacement(ocean) for ocean in used))
        )
        self._lock, self._process = threading.Lock(), Process()
        self._last = _TexelGroups(math.nan)

    def _filtered(self, ocean: Ocean, rate: int = 0) -> Ocean:
        """
        Return an ocean without short waves, whose texels are spline coefficients.

        Args:
            ocean: the tile.
            rate: time derivatives, 0 or 2.
        """
        a, grid = ocean.amplitudes, ocean.grid
        gain = 1.0 * _kept(ocean, self._shortest)
        if self._spline:
            gain = gain / interpolate.spline_response(grid.mx / grid.nx)[None, :]
            gain = gain / interpolate.spline_response(grid.my / grid.ny)[:, None]
        factor = gain if rate == 0 else -(a.running_omega**2) * gain
        forward, backward = (np.asfortranarray(h * factor) for h in (a.forward, a.backward))
        energies = a.variance_forward * factor**2, a.variance_backward * factor**2
        changed = replace(
            a,
            forward=forward,
            backward=backward,
            variance_forward=energies[0],
            variance_backward=energies[1],
        )
        return ocean.spectrally_scaled(
            changed, gain, rate, planning="estimate", threads=self._threads
        )

    def growth(self, _t: float) -> float:
        """Return the factor on all waves at a time: 1."""
        return 1.0

    def at(self, t: float, fields: tuple[str, ...]) -> PointFunction:
        """Return the function that finds the water at time t [s]."""
        if not self._process.is_current:
            self._lock, self._process = threading.Lock(), Process()
        groups = [
            "motion",
            *(group for group, names in _GROUPS.items() if set(names) & set(fields)),
        ]
        with self._lock:
            if self._last.t != t:
                self._last = _TexelGroups(t)
            texels = self._last
            self._render(texels, [group for group in groups if group not in texels.groups])
        sizes, layout, c = self._sizes, self._layout, self._choppiness
        tiles = texels.tiles

        def find(x: Real, y: Real, out: PointResults) -> None:
            kernels.follow(
                self._spline,
                tiles,
                self._rates,
                x,
                y,
                c,
                self.limit,
                _workspace(len(sizes)),
                out.found(),
            )
            hard = np.flatnonzero(out.residuals > self.limit)
            if hard.size:
                part = self._search(tiles, x[hard], y[hard])
                for mine, found in zip(out.found(), part.found(), strict=True):
                    mine[hard] = found
            sums = {group: np.zeros((x.size, len(_CHANNELS[group]))) for group in groups[1:]}
            for total in sums.values():
                # Without this a sea without waves would be calm at points that are not finite.
                total[np.isnan(out.offsets[:, 0])] = np.nan
            if sums:
                u, v = np.empty((2, x.size))
                for i, ((lx, ly), (_, nx, ny)) in enumerate(zip(sizes, layout, strict=True)):
                    kernels.texel_coordinates(x, y, out.offsets, lx, ly, nx, ny, u, v)
                    for group, total in sums.items():
                        channels = texels.groups[group][i]
                        if self._spline:
                            interpolate.bicubic(channels, u, v, True, total)
                        else:
                            interpolate.bilinear(channels, u, v, total)
            if "geometry" in sums:
                write_normals(sums["geometry"], c, out.arrays["normals"])
            for group in ("velocity", "acceleration"):
                of_water, of_surface = _GROUPS[group]
                if of_water in fields:
                    out.arrays[of_water][:] = sums[group]
                if of_surface in fields:
                    out.arrays[of_surface][:] = sums[group] * (c, c, 1.0)

        return find

    def warm_up(self, t: float) -> None:
        """Load the loops that only a folded surface needs."""
        self.at(t, ())
        self._search(self._last.tiles, np.zeros(1), np.zeros(1))

    def _search(self, tiles: tuple[Any, ...], x: Real, y: Real) -> PointResults:
        """Return the water at points that plain Newton steps do not find."""
        out = PointResults.empty(x.size, ())
        search = kernels.Search(self._choppiness, self.limit, self.limit, self._reach)
        origin = np.empty(self._sizes.shape)
        kernels.invert(self._kind, tiles, x, y, tuple(search), origin, out.found())
        return out

    def _render(self, texels: "_TexelGroups", missing: Sequence[str]) -> None:
        """Compute the missing groups of texels."""
        names = _CHANNELS if self._choppiness > 0.0 else _CHANNELS | {"motion": MOTION[2:]}
        ours = tuple(name for group in missing if group != "acceleration" for name in names[group])
        frames = [ocean.frame(texels.t, ours) for ocean in self._oceans] if ours else []
        for group in missing:
            if group == "motion":
                flat = np.zeros(4 * self._texels, dtype=self._dtype)
                for frame, (start, nx, ny) in zip(frames, self._layout, strict=True):
                    shape = (ny + interpolate.FRAME, nx + interpolate.FRAME, 4)
                    tile = flat[4 * start :][: math.prod(shape)].reshape(shape)
                    for name in names[group]:
                        tile[1:-2, 1:-2, MOTION.index(name)] = frame[name]
                    interpolate.frame_texels(tile)
                texels.groups[group] = [flat]
                texels.tiles = tuple(
                    kernels.Tiles(self._sizes, self._layout, flat, _NO_FIRST, _NO_WAVES)
                )
            elif group == "acceleration":
                if self._accelerated is None:
                    self._accelerated = [self._filtered(ocean, rate=2) for ocean in self._plain]
                texels.groups[group] = [
                    _side_by_side(ocean.frame(texels.t, MOTION), MOTION)
                    for ocean in self._accelerated
                ]
            else:
                texels.groups[group] = [_side_by_side(frame, names[group]) for frame in frames]


@dataclass(slots=True, eq=False)
class _TexelGroups:
    """
    Texels at one time, by group.

    Those of each tile, (ny, nx, channels); for "motion", which is inverted, those of all tiles in
    one flat array.
    """

    t: float  # [s]
    groups: dict[str, list[Real]] = field(default_factory=dict)
    tiles: tuple[Any, ...] = ()  # the fields of `kernels.query.Tiles`, with those of "motion"


def _workspace(tiles: int) -> tuple[npt.NDArray[Any], ...]:
    """Return the fields of `kernels.query.Workspace`, for one thread."""
    block = interpolate.BLOCK
    return (
        np.empty((tiles, 2, block)),
        np.empty((2, block)),
        np.empty(interpolate.ROWS * block),
        np.empty(block, np.int64),
    )


_GROUPS = {
    "geometry": ("normals",),
    "velocity": ("velocities", "surface_velocities"),
    "acceleration": ("accelerations", "surface_accelerations"),
}
"""The fields of an answer that each group of texels gives: of the water, then of the surface."""
_CHANNELS = {
    "motion": MOTION,
    "geometry": GEOMETRY,
    "velocity": VELOCITY,
    "acceleration": MOTION,  # of an ocean whose waves are multiplied by -omega^2
}
_NO_FIRST, _NO_WAVES = np.zeros(0, np.int64), np.zeros((5, 0))


def _side_by_side(frame: Any, names: Sequence[str]) -> Real:
    """Return fields of a frame as channels, (ny, nx, channels)."""
    return np.stack([frame[name] for name in names], axis=-1)


def _kept(ocean: Ocean, shortest: float) -> npt.NDArray[np.bool_]:
    """Return True for the waves of the half plane that are at least `shortest` long."""
    kept: npt.NDArray[np.bool_] = ocean.grid.k * shortest <= 2.0 * np.pi
    return kept


def _mean_square_displacement(ocean: Ocean) -> float:
    """
    Return the mean square of the displacement, before choppiness [m^2].

    Twice the sum over the half plane, which counts the waves with mx = 0 double.
    """
    a = ocean.amplitudes
    along = potential_factor(ocean.grid.k, a.depth) * ocean.grid.k
    return float(2.0 * np.sum(a.squares * along**2))
