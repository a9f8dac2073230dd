"""Height, normal, velocity and acceleration of the water surface at points of the world."""

import math
import statistics
import time
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean import mean_motion, query_budget
from fftocean.amplitudes import Modes
from fftocean.arrays import Real, RealLike, shortened
from fftocean.cascade import Cascade
from fftocean.errors import FieldError, ParameterError, SeaWarning, described
from fftocean.forks import Process
from fftocean.gerstner.waves import Waves
from fftocean.interpolated_tiles import InterpolatedTiles
from fftocean.limits import THREADS, TIME, Count, Quantity
from fftocean.ocean import Ocean, check_fields
from fftocean.point_results import PointResults
from fftocean.points import as_coordinates, group_by_time
from fftocean.query_budget import BudgetReport
from fftocean.summed_waves import SummedWaves
from fftocean.wave_list import list_waves, oceans_of

MODES = ("bilinear", "bicubic", "exact")
WANTED = ("heights", "normals", "velocities", "accelerations")
KNOWN = (*WANTED, "surface_velocities", "surface_accelerations")
LEVELS = ("still", "frame")
WAVELENGTH = Quantity("m", 0.0, math.inf)
BUDGET = Quantity("ms", 1e-3, 1e6)
POINTS = Count("", 1, 10**8)


class Answer:
    """
    The water surface at points. Arrays have their shape; vectors one more axis of three, x, y, z.

    Fields that were not asked for raise `FieldError`. Where a coordinate or a time is not finite,
    all values are NaN. float64, SI.
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
        """Parameters of the water found: its position at rest, and in a `Frame` [m]."""
        self.y0 = y0
        self.residual = residual
        """Horizontal distance of the water found from the point asked for [m]."""
        self.folded = folded
        """
        True where the search met water that lies upside down, in a fold at the point or beside it:
        the answer is one of several. Also True where it ended with a residual above 1e-9 of the
        largest tile's size (of the longest wave, without tiles): there is no answer. Every breaking
        crest is found; where far more is folded (three times the choppiness at which waves break)
        the search can reach an outer sheet without meeting the fold.
        """
        self._arrays = dict(arrays)

    def __getitem__(self, name: str) -> Real:
        """
        Return a field by name.

        Raises:
            FieldError: it was not asked for.
        """
        try:
            return self._arrays[name]
        except KeyError:
            raise FieldError(
                f"this answer has {', '.join(self._arrays)}; "
                f"for {name} ask at(x, y, t, fields=({name!r}, ...))"
            ) from None

    def __repr__(self) -> str:
        return f"Answer({self.x0.shape}, {', '.join(self._arrays)})"

    @property
    def heights(self) -> Real:
        """Height above the still-water level or the frame's zero (`level`) [m], shaped like x."""
        return self["heights"]

    @property
    def normals(self) -> Real:
        """Unit normal of the surface, (..., 3) [-]."""
        return self["normals"]

    @property
    def velocities(self) -> Real:
        """Velocity of the water that is at the surface there, (..., 3) [m/s]."""
        return self["velocities"]

    @property
    def accelerations(self) -> Real:
        """Acceleration of that water, (..., 3) [m/s^2]."""
        return self["accelerations"]

    @property
    def surface_velocities(self) -> Real:
        """Velocity of the displaced surface's own point: horizontally choppiness times the water's,
        (..., 3) [m/s]."""
        return self["surface_velocities"]

    @property
    def surface_accelerations(self) -> Real:
        """Acceleration of that point, (..., 3) [m/s^2]."""
        return self["surface_accelerations"]


class Query:
    """
    Heights, normals, velocities and accelerations of the water surface at any points (x, y) and
    times.

    Horizontal displacement moves the water away from its parameters: the water at a point x has the
    parameters x0 with x0 + choppiness D(x0) = x, where D is the displacement of all tiles together.
    Newton's method with the exact Jacobian finds them.

    Modes. "bilinear" and "bicubic" interpolate the frames of the tiles, periodically; texel i is at
    x = i L/n. Bicubic is the cubic spline through them: smooth to the second derivative, and
    several times as accurate where waves are well resolved. "exact" sums all waves at every point:
    for few points, or few waves. The interpolant or sum itself is inverted: residuals are those of
    the surface that is returned.

    Velocities and accelerations are those of the water, by linear theory, whatever the choppiness,
    which is a factor on the shape of the surface. The drawn surface itself moves with
    "surface_velocities".

    Heights are those above the still-water level. The displaced surface of a frame lies lower in
    the mean over the world, since horizontal displacement widens troughs: by `set_down`, which
    `level="still"` takes away (see `mean_motion.set_down`).

    Args:
        source: an `Ocean`, a `Cascade`, a model of `fo.gerstner` or its `Waves`, or `Modes`
            (`ocean.modes()`).
        mode: "bilinear", "bicubic" or "exact"; None is bicubic for tiles, and exact for lists of
            waves, which have no other mode.
        shortest: wavelength below which waves are left out, of heights and displacements alike [m]:
            a hull does not feel ripples.
        depth: still-water depth of `Modes` [m], None is deep water; the other sources have their
            own.
        choppiness: of `Modes` [-], None is 1; the other sources have their own.
        threads: number of threads that share the points of a call, and the work on frames. The
            result does not depend on it.
        level: where heights are counted from: "still", the still-water level, or "frame", the zero
            of frames and maps, to lie on a mesh that is drawn from these.
        drift: add to the velocities of the water what tracers that follow them lack of the Stokes
            drift at the surface: things that float then drift as on water.
        budget: milliseconds that a call at a new time may take on this machine, with `points`
            points and the fields that `at` has by default: of processor time by one thread, else of
            elapsed time. None leaves nothing out. Calls are timed when the query is made, for a
            second or so. Where they take longer, tiles have fewer samples, or the smallest are left
            out, with the waves that matter least (`query_budget.within`). `query.budget_report`
            says what is left, and a warning what is missing. A copy or a pickle keeps the choice.
        points: number of points of the call that fits the budget.

    The frames of the last t are kept, so that many calls at one time cost one synthesis. Threads
    can share a query; they work on points at the same time, without the GIL.

    Raises:
        ParameterError: a source without waves, an unknown mode, interpolation of waves that have no
            tile, a budget for sums of waves, or a value out of range.

    Warns:
        SeaWarning: waves that the budget leaves out, or a budget that no tiles fit.

    Method: Newton's iteration on the summed displacement with its exact Jacobian (`kernels.query`).
    Source: splines: Unser 1999.
    Pinned by tests/test_query.py: an independent inversion of `gerstner.surface`; differences in
    time and space; folds; quadrature of the mean level; tracers beside the Stokes drift.
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
        level: str = "still",
        drift: bool = False,
        budget: float | None = None,
        points: int = 200,
    ) -> None:
        tiles = oceans_of(source)
        mode = mode or ("bicubic" if tiles else "exact")
        if not isinstance(mode, str) or mode not in MODES:
            raise ParameterError(f"mode must be one of {', '.join(MODES)}, got {mode!r}")
        if mode != "exact" and not tiles:
            raise ParameterError(
                f"mode must be 'exact' for waves that have no tile to interpolate, got {mode!r}"
            )
        if not isinstance(level, str) or level not in LEVELS:
            raise ParameterError(f"level must be one of {', '.join(LEVELS)}, got {level!r}")
        if not isinstance(drift, bool):
            raise ParameterError(f"drift must be True or False, got {described(drift)}")
        shortest = WAVELENGTH.check("shortest", shortest)
        threads = THREADS.check("threads", threads)
        report = None
        if budget is not None:
            if mode == "exact":
                raise ParameterError(
                    "a budget needs tiles to leave out, mode 'bilinear' or 'bicubic', "
                    f"got mode {mode!r}"
                )
            source, report = _within(
                source,
                BUDGET.check("budget", budget),
                POINTS.check("points", points),
                {
                    "mode": mode,
                    "shortest": shortest,
                    "threads": threads,
                    "level": level,
                    "drift": drift,
                },
            )
        self._set_up(source, mode, shortest, depth, choppiness, threads, level, drift, report)

    def _set_up(
        self,
        source: Any,
        mode: str,
        shortest: float,
        depth: float | None,
        choppiness: float | None,
        threads: int,
        level: str,
        drift: bool,
        report: BudgetReport | None,
    ) -> None:
        self.source, self.mode, self.level = source, mode, level
        self.shortest, self.threads = shortest, threads
        self.budget_report = report
        """What a budget left of the tiles of the source, a `BudgetReport`; None without a budget.
        `query.source` has these tiles alone."""
        self._water: SummedWaves | InterpolatedTiles
        waves = list_waves(source, depth=depth, choppiness=choppiness, shortest=self.shortest)
        self.set_down = mean_motion.set_down(waves)
        """Mean height of the displaced surface over the world, in frames [m]; at most 0."""
        self.drift = np.append(mean_motion.missing_drift(waves), 0.0) if drift else np.zeros(3)
        """Velocity that is added to that of the waves' water, (3,) [m/s]."""
        if mode == "exact":
            self._water = SummedWaves(waves)
        else:
            self._water = InterpolatedTiles(
                oceans_of(source),
                spline=mode == "bicubic",
                shortest=self.shortest,
                threads=self.threads,
            )
        self._start()
        self.drift.setflags(write=False)
        self._recipe = (
            *(source, mode, self.shortest, depth, choppiness),
            *(self.threads, level, drift, report),
        )

    def _start(self) -> None:
        self._pool = (
            ThreadPoolExecutor(self.threads, thread_name_prefix="fftocean")
            if self.threads > 1
            else None
        )
        self._process = Process()

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute once, as in an ocean."""
        if hasattr(self, "_recipe") and not name.startswith("_"):
            raise AttributeError(f"a query is frozen: make another with the {name} that you want")
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle and copy the arguments."""
        return _rebuilt, self._recipe

    def __repr__(self) -> str:
        report = "" if self.budget_report is None else f"budget: {self.budget_report}; "
        return shortened(
            f"Query(mode={self.mode!r}, shortest={self.shortest:g}, threads={self.threads}, "
            f"level={self.level!r}, {report}{self.source!r})"
        )

    def warm_up(self, points: int = 200, fields: Sequence[str] = WANTED) -> None:
        """
        Do once what a first call does and later ones need not: load or compile all loops, plan the
        transforms, start the threads, and make a frame.

        The first step of a control loop is then like any other.

        Args:
            points: number of points of the calls to come.
            fields: that will be asked for, as in `at`.

        Raises:
            ParameterError: an unknown field, or a number out of range.
        """
        count = POINTS.check("points", points)
        x, y = _random_points(self._water.limit, count)
        self.at(x, y, 0.0, fields)
        self._water.warm_up(0.0)

    def at(self, x: RealLike, y: RealLike, t: RealLike, fields: Sequence[str] = WANTED) -> Answer:
        """
        Return the water at points (x, y) at times t.

        Args:
            x, y: points of the world [m]; any shapes that broadcast, any distance away.
            t: times [s]; one for all points is fastest, since each different one takes a synthesis.
            fields: "heights", "normals", "velocities", "accelerations", "surface_velocities",
                "surface_accelerations"; no other is computed.

        Returns:
            Arrays of the shape that x, y and t broadcast to, float64. Where one of the three is not
            finite, they are NaN.

        Raises:
            ParameterError: values that are not numbers, shapes that do not broadcast, a time beyond
                +-1e12 s, or an unknown field.
        """
        fields = check_fields(fields, KNOWN)
        if not self._process.is_current:  # a forked child has none of its parent's threads
            self._start()
        xs, ys, ts = (
            as_coordinates(name, values) for name, values in (("x", x), ("y", y), ("t", t))
        )
        try:
            shape = np.broadcast_shapes(xs.shape, ys.shape, ts.shape)
        except ValueError:
            raise ParameterError(
                f"x, y and t must broadcast, got shapes {xs.shape}, {ys.shape} and {ts.shape}"
            ) from None
        flat_x, flat_y = (
            np.ascontiguousarray(np.broadcast_to(v, shape)).reshape(-1) for v in (xs, ys)
        )
        found = PointResults.empty(flat_x.size, fields)
        for moment, here in group_by_time(ts, shape):
            if not math.isfinite(moment):
                found.blank(here)
            elif isinstance(here, slice):
                self._find(flat_x, flat_y, TIME.check("t", moment), found)
            else:
                part = PointResults.empty(here.size, fields)
                self._find(flat_x[here], flat_y[here], TIME.check("t", moment), part)
                found.put(here, part)
        x0, y0 = flat_x + found.offsets[:, 0], flat_y + found.offsets[:, 1]
        with np.errstate(invalid="ignore"):  # NaN is not folded
            folded = (found.jacobians <= 0.0) | (found.residuals > self._water.limit)
            asked = (
                np.isfinite(flat_x)
                & np.isfinite(flat_y)
                & np.isfinite(np.broadcast_to(ts, shape).reshape(-1))
            )
            folded |= np.isnan(found.residuals) & asked  # a finite point without an answer
        arrays = {
            name: array.reshape((*shape, *array.shape[1:]))
            for name, array in found.arrays.items()
            if name in fields
        }
        return Answer(
            x0.reshape(shape),
            y0.reshape(shape),
            found.residuals.reshape(shape),
            folded.reshape(shape),
            arrays,
        )

    def _find(self, x: Real, y: Real, t: float, out: PointResults) -> None:
        """Find the water at all points at one time, block by block."""
        if x.size == 0:
            return
        self._find_waves(x, y, t, out)
        growth = self._water.growth(t) ** 2
        if self.level == "still":
            out.arrays["heights"] -= growth * self.set_down
        if "velocities" in out.fields:
            out.arrays["velocities"] += growth * self.drift

    def _find_waves(self, x: Real, y: Real, t: float, out: PointResults) -> None:
        find = self._water.at(t, out.fields)
        block = self._water.block
        if x.size <= block:
            find(x, y, out)
            return
        parts = [slice(start, min(start + block, x.size)) for start in range(0, x.size, block)]
        if self._pool is None:
            for part in parts:
                find(x[part], y[part], out.part(part))
        else:
            list(self._pool.map(lambda part: find(x[part], y[part], out.part(part)), parts))


def _rebuilt(*recipe: Any) -> Query:
    """Return a query from the arguments of `Query._set_up`."""
    query = Query.__new__(Query)
    query._set_up(*recipe)
    return query


def _within(
    source: Any, budget: float, points: int, arguments: Mapping[str, Any]
) -> tuple[Ocean | Cascade, BudgetReport]:
    """Return what of a source fits a budget of milliseconds, and the report; warn of the rest."""
    chosen, report = query_budget.within(
        source,
        budget=budget,
        points=points,
        shortest=arguments["shortest"],
        measure=lambda tiles: milliseconds_of_a_call(Query(tiles, **arguments), points),
    )
    if not report.fits:
        warnings.warn(
            f"a call takes longer than the budget even with the fewest waves: {report}",
            SeaWarning,
            stacklevel=3,
        )
    elif not report.is_whole:
        warnings.warn(f"waves were left out to fit the budget: {report}", SeaWarning, stacklevel=3)
    return chosen, report


CALLS, STEP = 9, 0.02  # calls that are timed, and the seconds from one to the next


def milliseconds_of_a_call(query: Query, points: int) -> float:
    """Return the median time of a call at a new time, with the default fields, warmed up [ms]."""
    query.warm_up(points)
    x, y = _random_points(query._water.limit, points)
    # Processor time does not depend on what else the machine does; of several threads it is a sum.
    clock = time.thread_time if query.threads == 1 else time.perf_counter
    times = []
    for call in range(1, CALLS + 1):
        start = clock()
        query.at(x, y, STEP * call)
        times.append(clock() - start)
    return 1e3 * statistics.median(times)


def _random_points(limit: float, count: int) -> tuple[Real, Real]:
    """Return points over the largest tile, or the longest wave: 1e9 times the limit [m]."""
    x, y = np.random.default_rng(0).uniform(0.0, 1e9 * limit, (2, count))
    return x, y
