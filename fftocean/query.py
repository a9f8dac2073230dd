"""
The water at points of the world: where each point's water comes from, how high it is there, how
steep, and how it moves.
"""

import math
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import Modes
from fftocean.arrays import Real, RealLike, shortened
from fftocean.cascade import Cascade
from fftocean.errors import FieldError, ParameterError
from fftocean.fields import GEOMETRY, potential_factor
from fftocean.gerstner.waves import Waves
from fftocean.kernels import interpolate, surface
from fftocean.kernels import query as kernels
from fftocean.limits import THREADS, TIME, Quantity
from fftocean.ocean import Ocean, check_fields
from fftocean.trains import Trains, coordinates, moments_of, oceans_of, trains_of

KINDS = {"bilinear": kernels.BILINEAR, "bicubic": kernels.SPLINE, "exact": kernels.WAVES}
WANTED = ("heights", "normals", "velocities", "accelerations")
WAVELENGTH = Quantity("m", 0.0, math.inf)

MOTION = ("displace_x", "displace_y", "height")
VELOCITY = ("velocity_x", "velocity_y", "velocity_z")


class Answer:
    """
    The water at the points that were asked for. Every array has their shape; vectors have one more
    axis, of three: x, y, z.

    Only what was asked for is there; the rest raises `FieldError`. Where a coordinate or a time was
    not finite, all is NaN.
    """

    __slots__ = ("_arrays", "folded", "residual", "x0", "y0")

    def __init__(
        self,
        x0: Real,
        y0: Real,
        residual: Real,
        folded: npt.NDArray[np.bool_],
        arrays: Mapping[str, Real],
    ) -> None:
        self.x0 = x0
        """
        The parameters of the water found: where it would be at rest, and where the fields of a
        `Frame` have it [m].
        """
        self.y0 = y0
        self.residual = residual
        """How far from the point asked for the water found is, horizontally [m]."""
        self.folded = folded
        """
        True where the search met water that lies upside down, which is that of a fold at this point
        or beside it: the answer is one of several. Or it ended with a residual above 1e-9 of the
        largest tile's size (of the longest wave, without tiles): there is none. Complete for
        breaking crests; where far more is folded (three times the choppiness at which waves break)
        an outer sheet may be reached without meeting the fold.
        """
        self._arrays = dict(arrays)

    def __getitem__(self, name: str) -> Real:
        """
        Return what was asked for by name.

        Raises:
            FieldError: it was not asked for.
        """
        try:
            return self._arrays[name]
        except KeyError:
            raise FieldError(
                f"this answer has {', '.join(self._arrays)}; for {name} ask at(x, y, t, fields=({name!r}, ...))"
            ) from None

    def __repr__(self) -> str:
        return f"Answer({self.x0.shape}, {', '.join(self._arrays)})"

    @property
    def heights(self) -> Real:
        """Height of the water above its mean level [m]."""
        return self["heights"]

    @property
    def normals(self) -> Real:
        """Unit normal of the surface, (..., 3) [-]."""
        return self["normals"]

    @property
    def velocities(self) -> Real:
        """Velocity of the water particle that is at the surface there, (..., 3) [m/s]."""
        return self["velocities"]

    @property
    def accelerations(self) -> Real:
        """Its acceleration, (..., 3) [m/s^2]."""
        return self["accelerations"]


class Query:
    """
    Heights, normals, velocities and accelerations of the water surface at any points (x, y) and
    times.

    Horizontal displacement moves the water away from its parameters: the water at a point x is that
    of the parameters x0 with x0 + choppiness D(x0) = x, where D is the displacement of all tiles
    together. It is found by Newton's method with the exact Jacobian.

    Modes. "bilinear" and "bicubic" interpolate the frames of the tiles, periodically; texel i is at
    x = i L/n. Bicubic is the cubic spline through them: smooth to the second derivative, and
    several times as accurate where waves are well resolved. "exact" sums all waves at every point:
    for few points, or few waves. What is inverted is what is interpolated or summed: residuals are
    those of the surface that is returned.

    Args:
        source: an `Ocean`, a `Cascade`, a model of `fo.gerstner` or its `Waves`, or `Modes`
            (`ocean.modes()`).
        mode: "bilinear", "bicubic" or "exact"; None is bicubic for tiles and exact for lists of
            waves, which know no other.
        shortest: waves shorter than this are left out, heights and displacements alike [m]: a hull
            does not feel ripples.
        depth: still-water depth of `Modes` [m], None is deep water; the other sources have their
            own.
        choppiness: of `Modes` [-], None is 1; the other sources have their own.
        threads: how many share the points of one call, and the work on frames. The result does not
            depend on it.

    The frames of the last t are kept, so that many calls at one time cost one synthesis. Threads
    may share a query; the work on points runs side by side, without the GIL.

    Raises:
        ParameterError: a source without waves, an unknown mode, interpolation of waves that have no
            tile, or a value out of range.

    Method: Newton's iteration on the summed displacement with its exact Jacobian (`kernels.query`).
    Source: splines: Unser 1999.
    Pinned by tests/test_query.py: an independent inversion of `gerstner.surface`; differences in
    time and space; folds.
    """

    def __init__(
        self,
        source: Ocean | Cascade | Waves | Modes | Any,
        *,
        mode: str | None = None,
        shortest: float = 0.0,
        depth: float | None = None,
        choppiness: float | None = None,
        threads: int = 1,
    ) -> None:
        tiles = oceans_of(source)
        mode = mode or ("bicubic" if tiles else "exact")
        if not isinstance(mode, str) or mode not in KINDS:
            raise ParameterError(f"mode must be one of {', '.join(KINDS)}, got {mode!r}")
        if mode != "exact" and not tiles:
            raise ParameterError(
                f"mode must be 'exact' for waves that have no tile to interpolate, got {mode!r}"
            )
        self.source, self.mode = source, mode
        self.shortest = WAVELENGTH.check("shortest", shortest)
        self.threads = THREADS.check_whole("threads", threads)
        self._water: _Summed | _Interpolated
        if mode == "exact":
            self._water = _Summed(
                trains_of(source, depth=depth, choppiness=choppiness, shortest=self.shortest)
            )
        elif depth is not None or choppiness is not None:
            raise ParameterError(
                "depth and choppiness go with Modes only: an ocean, a cascade and a few-wave model have their own"
            )
        else:
            self._water = _Interpolated(tiles, mode == "bicubic", self.shortest, self.threads)
        self._start()
        self._recipe = (source, mode, self.shortest, depth, choppiness, self.threads)

    def _start(self) -> None:
        self._pool = (
            ThreadPoolExecutor(self.threads, thread_name_prefix="fftocean")
            if self.threads > 1
            else None
        )
        self._pid = os.getpid()

    def __setattr__(self, name: str, value: Any) -> None:
        """Set up once, as an ocean is."""
        if hasattr(self, "_recipe") and not name.startswith("_"):
            raise AttributeError(f"a query is frozen: make another with the {name} that you want")
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle and copy as what it is made of."""
        return _rebuilt, self._recipe

    def __repr__(self) -> str:
        return shortened(
            f"Query(mode={self.mode!r}, shortest={self.shortest:g}, threads={self.threads}, {self.source!r})"
        )

    def at(self, x: RealLike, y: RealLike, t: RealLike, fields: Sequence[str] = WANTED) -> Answer:
        """
        Return the water at points (x, y) at times t.

        Args:
            x, y: where, in the world [m]; any shapes that broadcast, any distance away.
            t: when [s]; one time for all is fastest: each different one takes a synthesis of its
                own.
            fields: what to find: "heights", "normals", "velocities", "accelerations". Only what is
                asked is computed.

        Returns:
            Arrays of the shape that x, y and t broadcast to, float64. Where one of the three is not
            finite, they are NaN.

        Raises:
            ParameterError: what is not a number, shapes that do not broadcast, a time beyond +-1e12
                s, or an unknown field.
        """
        fields = check_fields(fields, WANTED)
        if self._pid != os.getpid():  # a forked child has no threads of its parent's
            self._start()
        xs, ys, ts = (coordinates(name, values) for name, values in (("x", x), ("y", y), ("t", t)))
        try:
            shape = np.broadcast_shapes(xs.shape, ys.shape, ts.shape)
        except ValueError:
            raise ParameterError(
                f"x, y and t must broadcast, got shapes {xs.shape}, {ys.shape} and {ts.shape}"
            ) from None
        flat_x, flat_y = (
            np.ascontiguousarray(np.broadcast_to(v, shape)).reshape(-1) for v in (xs, ys)
        )
        out = _Found.room(flat_x.size, fields)
        for moment, here in moments_of(ts, shape):
            if not math.isfinite(moment):
                out.blank(here)
            elif isinstance(here, slice):
                self._find(flat_x, flat_y, TIME.check("t", moment), out)
            else:
                part = _Found.room(here.size, fields)
                self._find(flat_x[here], flat_y[here], TIME.check("t", moment), part)
                out.put(here, part)
        x0, y0 = flat_x + out.offsets[:, 0], flat_y + out.offsets[:, 1]
        with np.errstate(invalid="ignore"):  # NaN is not folded
            folded = (out.jacobians <= 0.0) | (out.residuals > self._water.limit)
            asked = (
                np.isfinite(flat_x)
                & np.isfinite(flat_y)
                & np.isfinite(np.broadcast_to(ts, shape).reshape(-1))
            )
            folded |= np.isnan(out.residuals) & asked  # nothing was found where something was asked
        arrays = {
            name: array.reshape((*shape, *array.shape[1:]))
            for name, array in out.arrays.items()
            if name in fields
        }
        return Answer(
            x0.reshape(shape),
            y0.reshape(shape),
            out.residuals.reshape(shape),
            folded.reshape(shape),
            arrays,
        )

    def _find(self, x: Real, y: Real, t: float, out: "_Found") -> None:
        """Answer for all points at one moment, block by block."""
        work = self._water.at(t, out.fields)
        block = self._water.block
        blocks = [slice(start, min(start + block, x.size)) for start in range(0, x.size, block)]
        if self._pool is None or len(blocks) == 1:
            for part in blocks:
                work(x[part], y[part], out.part(part))
        else:
            list(self._pool.map(lambda part: work(x[part], y[part], out.part(part)), blocks))


def _rebuilt(
    source: Any,
    mode: str,
    shortest: float,
    depth: float | None,
    choppiness: float | None,
    threads: int,
) -> Query:
    """A query from its arguments in order."""
    return Query(
        source, mode=mode, shortest=shortest, depth=depth, choppiness=choppiness, threads=threads
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Found:
    """Room for what is found at a number of points."""

    fields: tuple[str, ...]
    offsets: Real  # (points, 2): from the point to its parameters [m]
    residuals: Real
    jacobians: Real
    arrays: dict[str, Real]  # heights always, the rest as asked

    @classmethod
    def room(cls, points: int, fields: tuple[str, ...]) -> "_Found":
        arrays: dict[str, Real] = {
            name: np.empty((points,) if name == "heights" else (points, 3))
            for name in dict.fromkeys(("heights", *fields))
        }
        return cls(fields, np.empty((points, 2)), np.empty(points), np.empty(points), arrays)

    def part(self, part: slice) -> "_Found":
        """A part of the room, as views."""
        arrays = {name: array[part] for name, array in self.arrays.items()}
        return _Found(
            self.fields, self.offsets[part], self.residuals[part], self.jacobians[part], arrays
        )

    def put(self, here: npt.NDArray[np.intp], found: "_Found") -> None:
        """Take over what was found for some of the points."""
        for mine, other in zip(self._all(), found._all(), strict=True):
            mine[here] = other

    def blank(self, here: "slice | npt.NDArray[np.intp]") -> None:
        """Nothing can be found for some of the points."""
        for array in self._all():
            array[here] = np.nan

    def _all(self) -> tuple[Real, ...]:
        return self.offsets, self.residuals, self.jacobians, *self.arrays.values()


Work = Callable[[Real, Real, _Found], None]
"""Answers for some points at one moment."""


class _Summed:
    """Waves to be summed at every point."""

    block = 16  # points that one thread takes at a time: each may cost as much as a frame

    def __init__(self, trains: Trains) -> None:
        self._trains = trains
        longest = 2.0 * np.pi / np.min(np.hypot(trains.kx, trains.ky), initial=np.inf) or 1.0
        sizes = np.where(np.isfinite(trains.sizes), trains.sizes, longest)
        self.limit = 1e-9 * float(np.max(sizes, initial=0.0))
        self._reach = (
            _FAR
            * trains.choppiness
            * math.sqrt(0.5 * float(np.sum(trains.push**2 * (trains.kx**2 + trains.ky**2))))
        )

    def at(self, t: float, fields: tuple[str, ...]) -> Work:
        trains = self._trains
        waves = np.stack([trains.kx, trains.ky, trains.amplitude, trains.push, trains.turned(t)])
        grow, rate, curve = _growth(trains, t)
        c = trains.choppiness

        def work(x: Real, y: Real, out: _Found) -> None:
            origin = np.empty(trains.sizes.shape)
            table = (trains.sizes, _NO_LAYOUT, _NO_TEXELS, trains.first, waves)
            heights = out.arrays["heights"]
            room = (origin, out.offsets, heights, out.residuals, out.jacobians)
            kernels.invert(
                kernels.WAVES,
                *table,
                x,
                y,
                c * grow,
                1e-4 * self.limit,
                self.limit,
                self._reach,
                *room,
            )
            heights *= grow
            if not set(fields) - {"heights"}:
                return
            sums = np.empty((x.size, 14))
            kernels.sum_waves(
                trains.sizes, trains.first, waves, trains.omega, x, y, out.offsets, origin, sums
            )
            place, velocity, acceleration = sums[:, 5:8], sums[:, 8:11], sums[:, 11:14]
            if "normals" in fields:
                _normals(grow * sums[:, :5], c, out.arrays["normals"])
            if "velocities" in fields:
                out.arrays["velocities"][:] = (grow * velocity + rate * place) * (c, c, 1.0)
            if "accelerations" in fields:
                out.arrays["accelerations"][:] = (
                    grow * acceleration + 2.0 * rate * velocity + curve * place
                ) * (c, c, 1.0)

        return work


class _Interpolated:
    """Frames to be interpolated: texels of all tiles, and those of the last moment asked for."""

    block = 8192  # points that one thread takes at a time: some milliseconds

    def __init__(
        self, oceans: tuple[Ocean, ...], spline: bool, shortest: float, threads: int
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
            [self._filtered(ocean, 1.0) for ocean in used] if spline or shortest > 0.0 else used
        )
        self._accelerated: list[Ocean] | None = None
        self._choppiness = oceans[0].choppiness
        grids = [ocean.grid for ocean in used]
        self._sizes = np.array([(grid.lx, grid.ly) for grid in grids]).reshape(-1, 2)
        starts = np.cumsum([0, *(grid.nx * grid.ny for grid in grids)])
        self._layout = np.array(
            [(start, grid.nx, grid.ny) for start, grid in zip(starts, grids, strict=False)],
            dtype=np.int64,
        ).reshape(-1, 3)
        self._rates = self._layout[:, 1:] / self._sizes
        self._texels, self._dtype = int(starts[-1]), oceans[0].dtype
        self.limit = 1e-9 * float(np.max(self._sizes, initial=0.0))
        self._reach = (
            _FAR
            * self._choppiness
            * math.sqrt(sum(_mean_square_displacement(ocean) for ocean in used))
        )
        self._lock, self._pid = threading.Lock(), os.getpid()
        self._still = _Still(math.nan)

    def _filtered(self, ocean: Ocean, gain: "float | Real") -> Ocean:
        """
        An ocean whose frames are to be interpolated: without short waves, with spline coefficients
        for texels, and with a gain.
        """
        a, grid = ocean.amplitudes, ocean.grid
        factor = gain * _kept(ocean, self._shortest)
        if self._spline:
            factor = factor / interpolate.spline_response(grid.mx / grid.nx)[None, :]
            factor = factor / interpolate.spline_response(grid.my / grid.ny)[:, None]
        forward, backward = (np.asfortranarray(h * factor) for h in (a.forward, a.backward))
        energies = a.variance_forward * factor**2, a.variance_backward * factor**2
        changed = replace(
            a,
            forward=forward,
            backward=backward,
            variance_forward=energies[0],
            variance_backward=energies[1],
        )
        return ocean.with_amplitudes(changed, planning="estimate", threads=self._threads)

    def at(self, t: float, fields: tuple[str, ...]) -> Work:
        if self._pid != os.getpid():
            self._lock, self._pid = threading.Lock(), os.getpid()
        groups = ["motion", *(group for group, name in _GROUPS.items() if name in fields)]
        with self._lock:
            if self._still.t != t:
                self._still = _Still(t)
            still = self._still
            self._render(still, [group for group in groups if group not in still.groups])
        sizes, layout, c = self._sizes, self._layout, self._choppiness
        motion = still.groups["motion"][0]

        def work(x: Real, y: Real, out: _Found) -> None:
            heights = out.arrays["heights"]
            room = (*_desk(len(sizes)), out.offsets, heights, out.residuals, out.jacobians)
            kernels.follow(
                self._spline, sizes, self._rates, layout, motion, x, y, c, self.limit, *room
            )
            hard = np.flatnonzero(out.residuals > self.limit)
            if hard.size:
                left = _Found.room(hard.size, ())
                table = (sizes, layout, motion, _NO_FIRST, _NO_WAVES)
                patient = (
                    np.empty(sizes.shape),
                    left.offsets,
                    left.arrays["heights"],
                    left.residuals,
                    left.jacobians,
                )
                kernels.invert(
                    self._kind,
                    *table,
                    x[hard],
                    y[hard],
                    c,
                    self.limit,
                    self.limit,
                    self._reach,
                    *patient,
                )
                for mine, found in ((out.offsets, left.offsets), (heights, left.arrays["heights"])):
                    mine[hard] = found
                out.residuals[hard], out.jacobians[hard] = left.residuals, left.jacobians
            sums = {group: np.zeros((x.size, len(_CHANNELS[group]))) for group in groups[1:]}
            for total in sums.values():
                total[np.isnan(out.offsets[:, 0])] = (
                    np.nan
                )  # else a sea without waves would be calm there
            if sums:
                u, v = np.empty((2, x.size))
                for i, ((lx, ly), (_, nx, ny)) in enumerate(zip(sizes, layout, strict=True)):
                    kernels.texel_coordinates(x, y, out.offsets, lx, ly, nx, ny, u, v)
                    for group, total in sums.items():
                        texels = still.groups[group][i]
                        if self._spline:
                            interpolate.bicubic(texels, u, v, True, total)
                        else:
                            interpolate.bilinear(texels, u, v, total)
            if "geometry" in sums:
                _normals(sums["geometry"], c, out.arrays["normals"])
            for group, name in (("velocity", "velocities"), ("acceleration", "accelerations")):
                if group in sums:
                    out.arrays[name][:] = sums[group] * (c, c, 1.0)

        return work

    def _render(self, still: "_Still", missing: Sequence[str]) -> None:
        """Add to a still what it lacks: the fields of each group side by side."""
        names = _CHANNELS if self._choppiness > 0.0 else _CHANNELS | {"motion": MOTION[2:]}
        ours = tuple(name for group in missing if group != "acceleration" for name in names[group])
        frames = [ocean.frame(still.t, ours) for ocean in self._oceans] if ours else []
        for group in missing:
            if group == "motion":
                flat = np.zeros(4 * self._texels, dtype=self._dtype)
                for frame, (start, nx, ny) in zip(frames, self._layout, strict=True):
                    tile = flat[4 * start : 4 * (start + nx * ny)].reshape(ny, nx, 4)
                    for name in names[group]:
                        tile[:, :, MOTION.index(name)] = frame[name]
                still.groups[group] = [flat]
            elif group == "acceleration":
                if self._accelerated is None:
                    self._accelerated = [
                        self._filtered(ocean, -(ocean.amplitudes.running_omega**2))
                        for ocean in self._plain
                    ]
                still.groups[group] = [
                    _side_by_side(ocean.frame(still.t, MOTION), MOTION)
                    for ocean in self._accelerated
                ]
            else:
                still.groups[group] = [_side_by_side(frame, names[group]) for frame in frames]


@dataclass(frozen=True, slots=True, eq=False)
class _Still:
    """
    The texels of one moment, group by group: of each tile (ny, nx, channels); of all tiles, flat,
    for what is inverted.
    """

    t: float
    groups: dict[str, list[Real]] = field(default_factory=dict)


def _desk(tiles: int) -> tuple[npt.NDArray[Any], ...]:
    """What one thread needs to work on a block of points."""
    block = interpolate.BLOCK
    return (
        np.empty((tiles, 2, block)),
        np.empty((2, block)),
        np.empty(interpolate.ROWS * block),
        np.empty(block, np.int64),
    )


_GROUPS = {"geometry": "normals", "velocity": "velocities", "acceleration": "accelerations"}
_CHANNELS = {
    "motion": MOTION,
    "geometry": GEOMETRY,
    "velocity": VELOCITY,
    "acceleration": MOTION,
}  # the last of another ocean
_NO_LAYOUT, _NO_TEXELS, _NO_FIRST, _NO_WAVES = (
    np.zeros((0, 3), np.int64),
    np.zeros(0),
    np.zeros(0, np.int64),
    np.zeros((5, 0)),
)


def _side_by_side(frame: Any, names: Sequence[str]) -> Real:
    """Fields of a frame as channels, (ny, nx, channels)."""
    return np.stack([frame[name] for name in names], axis=-1)


def _normals(geometry: Real, choppiness: float, out: Real) -> None:
    """Normals from columns of `GEOMETRY`; NaN from NaN."""
    sx, sy, xx, xy, yy = (np.ascontiguousarray(column)[None, :] for column in geometry.T)
    surface.normals(sx, sy, xx, xy, yy, choppiness, out[None])
    out[np.isnan(sx[0])] = np.nan  # the kernel has up for what is no number


def _kept(ocean: Ocean, shortest: float) -> npt.NDArray[np.bool_]:
    """Which waves of the half plane are at least so long."""
    kept: npt.NDArray[np.bool_] = ocean.grid.k * shortest <= 2.0 * np.pi
    return kept


_FAR = 4.0  # root mean squares of the displacement: hardly any water is displaced further


def _mean_square_displacement(ocean: Ocean) -> float:
    """
    Of an ocean's water, before choppiness [m^2]: twice the half plane, which counts the waves with
    mx = 0 double.
    """
    a = ocean.amplitudes
    along = potential_factor(ocean.grid.k, a.depth) * ocean.grid.k
    return float(2.0 * np.sum(a.squares * along**2))


def _growth(trains: Trains, t: float) -> tuple[float, float, float]:
    """
    The factor on all waves of a model that starts from rest, and its first and second derivatives
    in time.
    """
    if trains.model is None or trains.model.tau == 0.0:
        return 1.0, 0.0, 0.0
    grow, rate = (float(v) for v in trains.model.ramp(t))
    return grow, rate, -rate / trains.model.tau
