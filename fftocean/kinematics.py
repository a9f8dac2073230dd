"""
Below the surface: how the water moves, and what it presses with, by linear wave theory and the ways
to stretch it to the crests.
"""

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import Modes
from fftocean.arrays import Real, RealLike, brief_repr
from fftocean.cascade import Cascade
from fftocean.constants import WATER_DENSITY
from fftocean.errors import ParameterError
from fftocean.gerstner.waves import Waves
from fftocean.kernels import query as kernels
from fftocean.limits import THREADS, TIME
from fftocean.ocean import Ocean
from fftocean.trains import Trains, coordinates, moments_of, trains_of

STRETCHINGS = ("none", "vertical", "wheeler")


@dataclass(frozen=True, slots=True, eq=False)
class Kinematics:
    """
    The water at points below the surface. Every array has their shape; vectors have one more axis,
    of three: x, y, z.

    Out of the water, above the surface or below the bed, all is 0 but `heights`. Where a coordinate
    or time was not finite, all is NaN.
    """

    velocities: Real  # (..., 3) [m/s]
    accelerations: (
        Real  # (..., 3) [m/s^2]; the rate of change at a fixed point, as linear theory has it
    )
    pressures: Real  # dynamic pressure: what the waves add to -rho g z [Pa]
    heights: Real  # of the linear surface above (x, y) [m]
    wet: npt.NDArray[np.bool_]  # whether there is water

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
) -> Kinematics:
    """
    Return velocity, acceleration and dynamic pressure of the water at points (x, y, z) and times t.

    With f = k.x - omega t - phase, each wave of amplitude a has, h being the depth,

        velocity along k   a omega cosh k(z + h)/sinh kh cos f
        velocity upward    a omega sinh k(z + h)/sinh kh sin f
        dynamic pressure   rho a omega^2/k cosh k(z + h)/sinh kh cos f    = -rho d potential/dt

    and heights are the sum of a cos f at (x, y) itself: theory with respect to fixed points, in
    which choppiness has no part. `Query` has the displaced surface; the two differ by the square of
    the steepness. All waves are summed at each point.

    Stretching says what becomes of the theory, which ends at z = 0, in the crests above:

        none        nothing: water fills all below z = 0, and nothing above
        vertical    above z = 0 all is as at z = 0
        wheeler     the column from the bed to the surface takes the place of that from the bed to z
        = 0: the profile is read at
                    h (z - height)/(h + height), in deep water z - height

    With Wheeler's stretching the pressure at the surface itself is rho g height, as it should be;
    with vertical, in the crests. (Exactly so for waves that obey the dispersion relation without
    surface tension; on a loop, omega is rounded, and the pressure is that of the waves as they
    run.)

    Args:
        source: an `Ocean`; a `Cascade`; `Modes`, as `ocean.modes()`; or a few-wave model, read as
            deep water linear waves.
        x, y, z: where [m], z up from the mean level; any shapes that broadcast.
        t: when [s]; broadcasts with them.
        stretching: "none", "vertical" or "wheeler".
        shortest: waves shorter than this are left out [m].
        depth: still-water depth of `Modes` [m], None is deep water; the other sources have their
            own.
        threads: how many share the points.

    Raises:
        ParameterError: a source without waves, or one that starts from rest; an unknown stretching;
            what is not a number; shapes that do not broadcast.

    Source: Dean & Dalrymple, Water Wave Mechanics (1991), ch. 3 and 4; Wheeler 1970 (Journal of
    Petroleum Technology 22).
    Pinned by tests/test_kinematics.py: Laplace, Euler and Bernoulli, the two boundary conditions,
    Stokes drift.
    """
    if stretching not in STRETCHINGS:
        raise ParameterError(
            f"stretching must be one of {', '.join(STRETCHINGS)}, got {stretching!r}"
        )
    trains = trains_of(source, depth=depth, shortest=shortest)
    if trains.model is not None and trains.model.tau > 0.0:
        raise ParameterError(
            f"waves that start from rest do not obey linear theory: tau must be 0, got {trains.model.tau}"
        )
    points = [
        coordinates(name, values) for name, values in (("x", x), ("y", y), ("z", z), ("t", t))
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
    for moment, here in moments_of(points[3], shape):
        if math.isfinite(moment):
            work = _at_moment(trains, TIME.check("t", moment), stretching)
            chosen = np.arange(flat_x.size)[here]
            tasks += [
                (work, chosen[start : start + _BLOCK]) for start in range(0, chosen.size, _BLOCK)
            ]

    def do(task: tuple[Callable[[Real, Real, Real], Real], npt.NDArray[np.intp]]) -> None:
        work, here = task
        out[here] = work(flat_x[here], flat_y[here], flat_z[here])

    if THREADS.check_whole("threads", threads) > 1 and len(tasks) > 1:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(do, tasks))
    else:
        for task in tasks:
            do(task)
    known = np.isfinite(out[:, 7]) & np.isfinite(flat_z)
    top = np.zeros_like(flat_z) if stretching == "none" else out[:, 7]
    wet = known & (flat_z <= top) & (flat_z >= -trains.depth)
    out[known & ~wet, :7] = 0.0
    out[~known] = np.nan
    return Kinematics(
        velocities=out[:, :3].reshape((*shape, 3)),
        accelerations=out[:, 3:6].reshape((*shape, 3)),
        pressures=WATER_DENSITY * out[:, 6].reshape(shape),
        heights=out[:, 7].reshape(shape),
        wet=wet.reshape(shape),
    )


_BLOCK = 256  # points at a time


def _at_moment(trains: Trains, t: float, stretching: str) -> Callable[[Real, Real, Real], Real]:
    """What answers for some points at one moment: (points, 8)."""
    waves = np.stack([trains.kx, trains.ky, trains.amplitude, trains.push, trains.turned(t)])

    def work(x: Real, y: Real, z: Real) -> Real:
        out = np.empty((x.size, 8))
        origin, height, moved = (
            np.empty(trains.sizes.shape),
            np.empty(x.size),
            np.empty((x.size, 7)),
        )
        kernels.sum_heights(trains.sizes, trains.first, waves, x, y, origin, height)
        level = np.clip(_read_at(z, height, trains.depth, stretching), -trains.depth, 0.0)
        kernels.sum_below(
            trains.sizes,
            trains.first,
            waves,
            trains.omega,
            trains.depth,
            x,
            y,
            level,
            origin,
            moved,
        )
        out[:, :7], out[:, 7] = moved, height
        return out

    return work


def _read_at(z: Real, height: Real, depth: float, stretching: str) -> Real:
    """The level whose linear profile holds at z."""
    if stretching != "wheeler":
        return z
    if math.isinf(depth):
        return z - height
    column = depth + height
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # a trough that bares the bed has no water to read
        return np.where(column > 0.0, depth * (z - height) / column, -depth)
