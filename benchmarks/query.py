"""
Points a second of `fo.Query`, compared with SciPy: map_coordinates of each tile, and a fixed point.

Points on a cascade of three tiles at choppiness 1, float32, at one time whose frame is there
already: random ones over 4 km, and a grid over 500 m. SciPy's side gets the frames for nothing, and
stops when its largest residual is below 1e-3 m, which takes it some ten rounds; ours stops at 1e-9
of the largest tile, 5e-7 m. A twentieth of the points is enough for it. Both must find the same
heights before they are timed. Then single calls of a few points, at the same time again and at a
new one, which includes the frame of every tile.

    python benchmarks/query.py [--points 1000000] [--seconds 60] [--json FILE] [--plot FILE]
"""

import argparse
import itertools
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import script
from scipy import ndimage

import fftocean as fo
from fftocean import host, limits
from fftocean.bench.charts import bars, sheet
from fftocean.bench.results import Entry, Pair, Reading, Result, race
from fftocean.errors import ParameterError
from fftocean.plots.theme import BLUE

ASKS = "How many points a second does a query take?"
TILES = [(512, 500.0), (512, 71.0), (256, 9.3)]
ALL = ("heights", "normals", "velocities", "accelerations")
ORDERS = {"bilinear": 1, "bicubic": 3}  # of SciPy's splines
RATE = "points a second"
RANDOM, GRID = "random over 4 km", "a grid over 500 m"
MOMENT = 3.7  # [s]
STEP = 0.02  # from one new time to the next [s]
ENOUGH = 20  # SciPy is slow, and its time goes with the points: it gets one in so many


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    parser.add_argument("--points", type=int, default=1_000_000, help="default: a million")
    parser.add_argument("--n", type=int, default=512, help="of the largest tile (default: 512)")
    parser.add_argument("--seconds", type=float, default=60.0, help="in all (default: 60)")


def cascade_of(n: int) -> fo.Cascade:
    """Return a fresh breeze on three tiles, the largest of n samples a side."""
    tiles = [(max(4, side * n // 512), size) for side, size in TILES]
    return fo.Cascade(fo.Sea.from_wind(speed=10.0, fetch=100e3), tiles, seed=7, choppiness=1.0)


def with_scipy(
    cascade: fo.Cascade, x: np.ndarray, y: np.ndarray, mode: str, residual: float = 1e-3
) -> Callable[[], np.ndarray]:
    """
    Return a function that iterates x0 <- x - c D(x0), with D by map_coordinates, for heights.

    Cubic splines are filtered beforehand, as in `fo.Query`.
    """
    fields, order = ("displace_x", "displace_y", "height"), ORDERS[mode]
    tiles = []
    for ocean in cascade.oceans:
        frame = ocean.frame(MOMENT, fields)
        arrays = [
            ndimage.spline_filter(frame[f], order, mode="grid-wrap") if order > 1 else frame[f]
            for f in fields
        ]
        tiles.append((ocean.grid, arrays))

    def sample(which: int, x0: np.ndarray, y0: np.ndarray) -> np.ndarray:
        total = np.zeros(x0.shape)
        for grid, arrays in tiles:
            at = [y0 * (grid.ny / grid.ly), x0 * (grid.nx / grid.lx)]
            total += ndimage.map_coordinates(
                arrays[which], at, order=order, mode="grid-wrap", prefilter=False
            )
        return total

    def run() -> np.ndarray:
        x0, y0 = x.copy(), y.copy()
        for _ in range(100):
            dx, dy = cascade.choppiness * sample(0, x0, y0), cascade.choppiness * sample(1, x0, y0)
            apart = max(np.max(np.abs(x0 + dx - x)), np.max(np.abs(y0 + dy - y)))
            if apart < residual:
                break
            x0, y0 = x - dx, y - dy
        return sample(2, x0, y0)

    return run


def require_same_heights(cascade: fo.Cascade, x: np.ndarray, y: np.ndarray, mode: str) -> None:
    """
    Raise unless both sides find the same heights, SciPy's to a residual of 1e-6 m.

    Raises:
        ParameterError: one differs by more than 1e-5 of the significant wave height: frames are
            float32, and heights change by less than the residual.
    """
    found = fo.Query(cascade, mode=mode, level="frame").at(x, y, MOMENT, "heights").heights
    expected = with_scipy(cascade, x, y, mode, residual=1e-6)()
    apart = float(np.max(np.abs(found - expected))) / (4.0 * float(np.std(expected)))
    if not apart <= 1e-5:
        raise ParameterError(f"{mode} heights of fo.Query and of SciPy differ by {apart:.2g} of Hs")


def places(points: int) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield the name and the coordinates of each set of points [m]."""
    x, y = np.random.default_rng(0).uniform(-2000.0, 2000.0, (2, points))
    yield RANDOM, x, y
    side = max(1, int(np.sqrt(points)))
    along = np.arange(side) * (500.0 / side)
    x, y = np.meshgrid(along, np.arange(points // side) * (500.0 / side))
    yield GRID, x.ravel(), y.ravel()


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run the races of each set of points, then those of single calls."""
    # so few that the heights which are compared have no standard deviation are no measurement
    limits.Count("", 5 * ENOUGH, 10**8).check("--points", options.points)
    say("cascade")
    cascade, readings = cascade_of(options.n), []
    for where, x, y in places(options.points):
        say(f"{where}: comparing")
        fewer = slice(0, max(1, x.size // ENOUGH))
        for mode in ORDERS:
            require_same_heights(cascade, x[fewer][:5000], y[fewer][:5000], mode)
        say(where)
        readings += rates(cascade, where, x, y, options.seconds / 8)
        say(f"{where}: beside SciPy")
        readings += beside_scipy(cascade, where, x[fewer], y[fewer], options.seconds / 8)
        if host.cores() > 1:
            say(f"{where}: two threads")
            readings += threads(cascade, where, x, y, options.seconds / 8)
    say("single calls")
    return readings + calls(cascade, options.points, options.seconds / 4)


def rates(
    cascade: fo.Cascade, where: str, x: np.ndarray, y: np.ndarray, seconds: float
) -> list[Reading]:
    """Return points a second of one core, for each mode, heights alone and all quantities."""
    entries = []
    for mode in ORDERS:
        query = fo.Query(cascade, mode=mode, threads=1)
        for fields in ("heights", "all"):
            wanted = ALL if fields == "all" else fields
            entries.append(
                Entry(
                    RATE,
                    lambda q=query, wanted=wanted: q.at(x, y, MOMENT, wanted),
                    {"by": "fftocean", "where": where, "mode": mode, "fields": fields},
                )
            )
    return [in_points(r, x.size) for r in race(entries, clock="cpu", seconds=seconds)]


def in_points(reading: Reading, points: int) -> Reading:
    """Return the time of so many points as points a second; other readings as they are."""
    if reading.what != RATE:
        return reading
    rate = 1e3 * points
    return Reading(
        *(RATE, "1/s", rate / reading.median, rate / reading.high, rate / reading.low),
        *(reading.count, reading.clock, reading.at),
    )


def beside_scipy(
    cascade: fo.Cascade, where: str, x: np.ndarray, y: np.ndarray, seconds: float
) -> list[Reading]:
    """Return points a second of SciPy for heights, and ratios to ours at the same points."""
    readings = []
    for mode in ORDERS:
        query = fo.Query(cascade, mode=mode, threads=1)
        at = {"where": where, "mode": mode, "fields": "heights"}
        ours = Entry(
            "ours", lambda q=query: q.at(x, y, MOMENT, "heights"), {"by": "fftocean", **at}
        )
        theirs = Entry(RATE, with_scipy(cascade, x, y, mode), {"by": "SciPy", **at})
        pair = Pair("SciPy / fftocean", theirs, ours)
        found = race([ours, theirs], [pair], clock="cpu", seconds=seconds / len(ORDERS))
        readings += [in_points(r, x.size) for r in found if r.what in (RATE, pair.what)]
    return readings


def threads(
    cascade: fo.Cascade, where: str, x: np.ndarray, y: np.ndarray, seconds: float
) -> list[Reading]:
    """Return the ratios of the elapsed times of one thread to those of two."""
    readings = []
    for mode in ORDERS:
        at = {"where": where, "mode": mode, "fields": "heights"}
        one, two = (
            Entry(
                "a call",
                partial(fo.Query(cascade, mode=mode, threads=count).at, x, y, MOMENT, "heights"),
                {**at, "threads": count},
            )
            for count in (1, 2)
        )
        pair = Pair("one thread / two", one, two)
        found = race([one, two], [pair], clock="wall", seconds=seconds / len(ORDERS))
        readings += [r for r in found if r.what == pair.what]
    return readings


def calls(cascade: fo.Cascade, points: int, seconds: float) -> list[Reading]:
    """Return the times of single calls, at the same time again and at a new one each."""
    x, y = np.random.default_rng(0).uniform(-2000.0, 2000.0, (2, max(4, min(points, 10_000))))
    steps = itertools.count()
    query, exact = fo.Query(cascade, mode="bicubic"), fo.Query(cascade, mode="exact")
    again, anew = [], []
    for fields in ("heights", "all"):
        wanted = ALL if fields == "all" else fields
        for count in sorted({1, min(100, x.size), x.size}):
            at = {"mode": "bicubic", "fields": fields, "points": count}

            def same(wanted=wanted, count=count) -> object:
                return query.at(x[:count], y[:count], MOMENT, wanted)

            again.append(Entry("a call, the same time again", same, at))
        some = min(100, x.size)

        def new(wanted=wanted, some=some) -> object:
            return query.at(x[:some], y[:some], STEP * next(steps), wanted)

        at = {"mode": "bicubic", "fields": fields, "points": some}
        anew.append(Entry("a call, a new time", new, at))

    def sums() -> object:
        return exact.at(x[:4], y[:4], STEP * next(steps), ALL)

    at = {"mode": "exact", "fields": "all", "points": 4}
    anew.append(Entry("a call, a new time", sums, at))
    found = [*race(again, clock="cpu", seconds=seconds / 2)]
    found += race(anew, clock="cpu", seconds=seconds / 2)
    return [r for r in found if r.what.startswith("a call")]


def draw(result: Result, path: Path) -> None:
    """Draw points a second of one core, for heights, of both sides."""
    with sheet(path, ASKS, result, width=9.0, height=4.4) as figure:
        rows = []
        for where in (RANDOM, GRID):
            for mode in ORDERS:
                for by in ("fftocean", "SciPy"):
                    r = result.find(RATE, by=by, where=where, mode=mode, fields="heights")
                    colour = BLUE if by == "fftocean" else "#56707a"
                    name = f"{by}, {mode}, {where}"
                    rows.append((name, r.median / 1e6, f"{r.median / 1e6:.3g} million", colour))
        ax = figure.subplots()
        bars(ax, rows)
        ax.set_title("Heights of points a second, one core, three tiles")


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "query", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
