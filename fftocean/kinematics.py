"""Kinematics and dynamic pressure below the surface, by linear wave theory with stretching."""

import math
import weakref
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean import mean_motion
from fftocean.amplitudes import Modes
from fftocean.arrays import Real, RealLike, brief_repr
from fftocean.bound_waves import ELEVATION, POTENTIAL
from fftocean.cascade import Cascade
from fftocean.constants import WATER_DENSITY
from fftocean.errors import ParameterError
from fftocean.gerstner.waves import Waves
from fftocean.kernels import bound
from fftocean.kernels.rings import POINTS
from fftocean.limits import ORDER, THREADS, TIME
from fftocean.ocean import Ocean
from fftocean.points import as_coordinates, group_by_time
from fftocean.wave_list import WaveList, list_waves, oceans_of
from fftocean.wave_rings import WaveRings

STRETCHINGS = ("none", "vertical", "extrapolation", "wheeler")


@dataclass(frozen=True, slots=True, eq=False)
class Kinematics:
    """
    The water at points below the surface. Arrays have their shape; vectors one more axis of three.

    Outside the water, above the surface or below the bed, all values are 0 but `heights`. Where a
    coordinate or time is not finite, all values are NaN. float64, SI.
    """

    velocities: Real  # (..., 3) [m/s]
    accelerations: Real  # (..., 3) [m/s^2]: linear, the rate of change at a fixed point
    pressures: Real  # dynamic pressure, that of the waves without -rho g z [Pa]
    heights: Real  # of the linear surface above (x, y) [m]
    wet: npt.NDArray[np.bool_]  # True in the water

    __repr__ = brief_repr


def at(
    source: Ocean | Cascade | Waves | Modes | Any,
    x: RealLike,
    y: RealLike,
    z: RealLike,
    t: RealLike,
    *,
    stretching: str = "none",
    shortest: float = 0.0,
    depth: float | None = None,
    threads: int = 1,
    order: int | None = None,
) -> Kinematics:
    """
    Return velocity, acceleration and dynamic pressure of the water at points (x, y, z) and times t.

    With f = k.x - omega t - phase, each wave of amplitude a has, h being the depth,

        velocity along k   a omega cosh k(z + h)/sinh kh cos f
        velocity upward    a omega sinh k(z + h)/sinh kh sin f
        dynamic pressure   rho a omega^2/k cosh k(z + h)/sinh kh cos f    = -rho d potential/dt

    and heights are the sum of a cos f at (x, y) itself: this theory refers to fixed points, without
    choppiness. `Query` has the displaced surface; the two differ by the square of the steepness.
    All waves are summed at each point, to rounding; none is left out. Those of one wavenumber share
    their profile, and those of a tile its tables of cosines (`kernels.rings`).

    The theory ends at z = 0. Stretching extends it to the crests above:

        none            water fills all below z = 0, and nothing above
        vertical        above z = 0 all values are those at z = 0
        extrapolation   above z = 0 every profile goes on along its tangent at z = 0
        wheeler         the profile between bed and z = 0 is stretched to that between bed and
                        surface: it is evaluated at h (z - height)/(h + height), in deep water
                        z - height

    The pressure at the surface should be rho g height, which with the hydrostatic part is that of
    the air. It is so everywhere with Wheeler's stretching, and in the crests with vertical: in the
    troughs, where the surface lies below z = 0, vertical and extrapolation leave linear theory as
    it is, and the pressure differs by the square of the steepness; so does that of extrapolation
    in the crests. (Exactly so for waves that obey the dispersion relation without surface tension;
    on a loop, omega is rounded, and the pressure is that of the rounded waves.) Velocities at
    crests rise from Wheeler's over vertical to extrapolation.

    Args:
        source: an `Ocean`; a `Cascade`; `Modes`, as `ocean.modes()`; or a few-wave model, read as
            deep water linear waves.
        x, y, z: points [m], z up from the mean level; any shapes that broadcast.
        t: times [s]; they broadcast with the points.
        stretching: "none", "vertical", "extrapolation" or "wheeler".
        shortest: wavelength below which waves are left out [m].
        depth: still-water depth of `Modes` [m], None is deep water; the other sources have their
            own.
        threads: number of threads that share the points.
        order: 1 or 2; None for that of the source. An ocean of order 2 adds, below the surface, the
            potential of its waves of second order: to velocities, to accelerations (which remain
            those at a fixed point), and to the pressure, which then has -rho u^2/2 too.
            The expansion is about z = 0: "none" and "extrapolation" keep it in order.

    Raises:
        ParameterError: order 2 of a source of order 1; a source without waves, or one that starts
            from rest; an unknown stretching; values that are not numbers; shapes that do not
            broadcast.

    Source: Dean & Dalrymple, Water Wave Mechanics (1991), ch. 3 and 4; Wheeler 1970 (Journal of
    Petroleum Technology 22); extrapolation: Forristall 1981 (J. Waterway, Port, Coastal and Ocean
    Div. 107), DNV-RP-C205, 3.3.3.
    Pinned by tests/test_kinematics.py: Laplace, Euler and Bernoulli, the two boundary conditions,
    Stokes drift.
    """
    if stretching not in STRETCHINGS:
        raise ParameterError(
            f"stretching must be one of {', '.join(STRETCHINGS)}, got {stretching!r}"
        )
    rings = _rings_of(source, depth, shortest)
    waves = rings.waves
    _require_steady(waves)
    if order is not None:
        if ORDER.check("order", order) == 2 and waves.bound is None:
            raise ParameterError(
                "order 2 needs an ocean or a cascade that has it: Ocean(..., order=2), "
                f"got {source!r:.80}"
            )
        waves = waves if order == 2 else replace(waves, bound=None)
    points = [
        as_coordinates(name, values) for name, values in (("x", x), ("y", y), ("z", z), ("t", t))
    ]
    try:
        shape = np.broadcast_shapes(*(v.shape for v in points))
    except ValueError:
        raise ParameterError(
            f"x, y, z and t must broadcast, got shapes {', '.join(str(v.shape) for v in points)}"
        ) from None
    flat_x, flat_y, flat_z = (
        np.ascontiguousarray(np.broadcast_to(v, shape)).reshape(-1) for v in points[:3]
    )
    out = np.full((flat_x.size, 8), np.nan)  # velocity, acceleration, potential rate, height
    tasks: list[tuple[Callable[[Real, Real, Real], Real], npt.NDArray[np.intp]]] = []
    for moment, here in group_by_time(points[3], shape):
        if math.isfinite(moment):
            work = _at_moment(rings, waves, TIME.check("t", moment), stretching)
            chosen = np.arange(flat_x.size)[here]
            tasks += [
                (work, chosen[start : start + POINTS]) for start in range(0, chosen.size, POINTS)
            ]

    def do(task: tuple[Callable[[Real, Real, Real], Real], npt.NDArray[np.intp]]) -> None:
        work, here = task
        out[here] = work(flat_x[here], flat_y[here], flat_z[here])

    if THREADS.check("threads", threads) > 1 and len(tasks) > 1:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(do, tasks))
    else:
        for task in tasks:
            do(task)
    known = np.isfinite(out[:, 7]) & np.isfinite(flat_z)
    top = np.zeros_like(flat_z) if stretching == "none" else out[:, 7]
    wet = known & (flat_z <= top) & (flat_z >= -waves.depth)
    out[known & ~wet, :7] = 0.0
    out[~known] = np.nan
    return Kinematics(
        velocities=out[:, :3].reshape((*shape, 3)),
        accelerations=out[:, 3:6].reshape((*shape, 3)),
        pressures=WATER_DENSITY * out[:, 6].reshape(shape),
        heights=out[:, 7].reshape(shape),
        wet=wet.reshape(shape),
    )


_KEPT = 2**18  # waves up to which a source's rings are kept for its next call
_rings: "weakref.WeakKeyDictionary[Any, tuple[float, WaveRings]]" = weakref.WeakKeyDictionary()


def _rings_of(source: Any, depth: float | None, shortest: float) -> WaveRings:
    """
    Return the waves of a source by rings.

    Oceans and cascades are frozen, and grouping their waves takes longer than summing them at some
    points, so that those of the last `shortest` are kept as long as the source is.
    """
    if not oceans_of(source):
        return WaveRings(list_waves(source, depth=depth, shortest=shortest))
    kept = _rings.get(source)
    if kept is None or kept[0] != shortest or depth is not None:
        kept = shortest, WaveRings(list_waves(source, depth=depth, shortest=shortest))
        if kept[1].waves.omega.size <= _KEPT:
            _rings[source] = kept
    return kept[1]


def _at_moment(
    rings: WaveRings, waves: WaveList, t: float, stretching: str
) -> Callable[[Real, Real, Real], Real]:
    """Return the function of points at one time, to velocity ... height, (points, 8)."""
    now = rings.at(t)
    second = None if waves.bound is None else _SecondOrder(waves, t)

    def work(x: Real, y: Real, z: Real) -> Real:
        here = now.near(x, y)
        out, height = np.empty((x.size, 8)), here.heights()
        height[~(np.isfinite(x) & np.isfinite(y))] = np.nan  # also without waves
        if second is not None:
            height += second.heights(x, y)
        level = np.clip(_read_at(z, height, waves.depth, stretching), -waves.depth, 0.0)
        rise = np.maximum(z, 0.0) if stretching == "extrapolation" else np.zeros(z.size)
        moved = here.below(level, rise)
        if second is not None:
            second.add(x, y, level, moved)
        out[:, :7], out[:, 7] = moved, height
        return out

    return work


class _SecondOrder:
    """Elevation and potential of the waves of second order at one time."""

    def __init__(self, waves: WaveList, t: float) -> None:
        assert waves.bound is not None  # asked by the caller
        elevation = waves.bound.cells(ELEVATION, t, beyond=True)
        kept = np.hypot(elevation.kx, elevation.ky) * waves.shortest <= 2.0 * np.pi
        potential = waves.bound.cells(POTENTIAL, t, (0, 1), beyond=True)
        self._elevation, self._potential = elevation.kept(kept), potential.kept(kept)
        self._size, self._depth = waves.sizes[0], waves.depth

    def heights(self, x: Real, y: Real) -> Real:
        """Return the elevation at points [m]."""
        out = np.empty((x.size, 1))
        cells = self._elevation
        bound.sum_cells(cells.kx, cells.ky, cells.parts(), *self._within(x, y), out)
        return out[:, 0]

    def add(self, x: Real, y: Real, z: Real, moved: Real) -> None:
        """Add to velocity, acceleration and -d potential/dt - |velocity|^2/2, (points, 7)."""
        out, cells = np.empty((x.size, 7)), self._potential
        place = (*self._within(x, y), z)
        bound.sum_below(cells.kx, cells.ky, cells.parts(), self._depth, *place, out)
        out[:, 6] -= 0.5 * np.sum(moved[:, :3] ** 2, axis=1)
        moved += out

    def _within(self, x: Real, y: Real) -> tuple[Real, Real]:
        """Return the points within the tile."""
        return np.remainder(x, self._size[0]), np.remainder(y, self._size[1])


def _read_at(z: Real, height: Real, depth: float, stretching: str) -> Real:
    """Return the level at which the linear profile is evaluated for z [m]."""
    if stretching != "wheeler":
        return z
    if math.isinf(depth):
        return z - height
    column = depth + height
    # A trough that bares the bed has no water above it.
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(column > 0.0, depth * (z - height) / column, -depth)


def stokes_drift(
    source: Ocean | Cascade | Waves | Modes | Any,
    z: RealLike = 0.0,
    *,
    shortest: float = 0.0,
    depth: float | None = None,
) -> Real:
    """
    Return the Stokes drift at levels z: the mean velocity of the water particles there, to the
    second power of the steepness.

    Each wave of amplitude a carries the water along its own direction, h being the depth, by

        a^2 omega k cosh 2k(z + h) / (2 sinh^2 kh),     in deep water a^2 omega k e^{2kz},

    and those of all waves add up in the mean over place and time. This is the drift of the waves
    that the source has, of this seed; waves too short for its tiles, or below `shortest`, carry a
    large part of the drift at the surface itself. The mean flow at fixed points is 0 in this
    theory: a current, or the return flow of a closed basin, is to be added.

    Args:
        source: as in `at`.
        z: levels [m], any shape, up from the still water. Above 0 the drift is that at 0, below
            the bed it is 0.
        shortest: wavelength below which waves are left out [m].
        depth: of `Modes` [m], as in `at`.

    Returns:
        (..., 3): x, y and z of the drift, the last always 0 [m/s]; NaN where z is not a number.

    Raises:
        ParameterError: as `at`.

    Source: Stokes 1847; finite depth: Dean & Dalrymple (1991), sec. 10.2.
    Pinned by tests/test_kinematics.py: the closed form on one wave, and particles that follow
    `at` through the water.
    """
    waves = list_waves(source, depth=depth, shortest=shortest)
    _require_steady(waves)
    levels = as_coordinates("z", z)
    out = np.zeros((*levels.shape, 3))
    out[..., :2] = mean_motion.stokes_drift(waves, levels.reshape(-1)).reshape((*levels.shape, 2))
    out[np.isnan(levels)] = np.nan
    return out


def _require_steady(waves: WaveList) -> None:
    """Raise if a model starts from rest."""
    if waves.model is not None and waves.model.tau > 0.0:
        raise ParameterError(
            "waves that start from rest do not obey linear theory: "
            f"tau must be 0, got {waves.model.tau}"
        )
