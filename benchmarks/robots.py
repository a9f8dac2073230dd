"""
Time of the water in one step of a robot's simulation.

Each call is at a new time, as in a simulation, so it includes the frame of every tile: heights,
velocities and accelerations at all points, by one thread. "exact" sums waves instead, those longer
than 3 m; "below the surface" is `fo.kinematics` with the same waves. Contenders of a row of tiles
alternate.

    python benchmarks/robots.py [--n 64 128 256] [--points 1 200 1000] [--json FILE] [--plot FILE]
"""

import argparse
import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import script

import fftocean as fo
from fftocean.bench.charts import Line, curves, sheet
from fftocean.bench.results import Entry, Reading, Result, race
from fftocean.plots.theme import BLUE, VERMILION

ASKS = "How many milliseconds of a simulation's step does the water take?"
SIZES = (400.0, 57.0, 8.3)  # of the tiles [m]
FIELDS = ("heights", "velocities", "accelerations")
STEP = 0.02  # of the simulation [s]
SHORTEST = 3.0  # wave that a hull feels, of sums [m]


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 64, 128, 256)
    parser.add_argument("--points", type=int, nargs="+", default=[1, 20, 200, 1000], metavar="P")
    parser.add_argument("--tiles", type=int, nargs="+", default=[1, 2, 3], choices=(1, 2, 3))
    parser.add_argument("--seconds", type=float, default=60.0, help="in all (default: 60)")


def cascade(n: int, tiles: int) -> fo.Cascade:
    """Return a fresh breeze on a number of tiles of n samples a side."""
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
    return fo.Cascade(sea, [(n, size) for size in SIZES[:tiles]], seed=7)


class Steps:
    """One step after another, each at a new time."""

    def __init__(self, query: fo.Query, points: int) -> None:
        self.query = query
        rng = np.random.default_rng(0)
        self.x, self.y = rng.uniform(-6.0, 6.0, (2, points))
        self.times = itertools.count()

    def __call__(self) -> object:
        """Ask for the water of the next step."""
        return self.query.at(self.x, self.y, STEP * next(self.times), FIELDS)


class StepsBelow(Steps):
    """The same at points down to a metre below the surface."""

    def __call__(self) -> object:
        """Ask for the water of the next step."""
        z = np.linspace(-1.0, 0.0, self.x.size)
        t = STEP * next(self.times)
        source = self.query.source
        return fo.kinematics.at(
            source, self.x, self.y, z, t, stretching="wheeler", shortest=SHORTEST
        )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run one race for each cascade."""
    readings: list[Reading] = []
    seas = [(n, tiles) for tiles in sorted(set(options.tiles)) for n in sorted(set(options.n))]
    for n, tiles in seas:
        say(f"{tiles} tiles of {n} x {n}")
        sea = cascade(n, tiles)
        at = {"n": n, "tiles": tiles}
        entries = [
            Entry(mode, Steps(fo.Query(sea, mode=mode), points), {**at, "points": points})
            for mode in ("bicubic", "bilinear")
            for points in sorted(set(options.points))
        ]
        some = min(options.points, key=lambda points: abs(points - 200))
        longer = {**at, "points": some, "shortest": SHORTEST}
        exact = fo.Query(sea, mode="exact", shortest=SHORTEST)
        entries.append(Entry("exact", Steps(exact, some), longer))
        entries.append(Entry("below the surface", StepsBelow(exact, some), longer))
        readings += race(entries, clock="cpu", seconds=options.seconds / len(seas))
    return readings


def draw(result: Result, path: Path) -> None:
    """Draw milliseconds against samples a side, at the largest number of tiles."""
    tiles = max(int(r.at["tiles"]) for r in result.readings)
    counts = sorted({int(r.at["points"]) for r in result.all("bicubic", tiles=tiles)})
    with sheet(path, ASKS, result) as figure:
        lines = []
        for mode, colour in (("bicubic", BLUE), ("bilinear", VERMILION)):
            for points in (counts[0], counts[-1]):
                rows = sorted(
                    result.all(mode, tiles=tiles, points=points), key=lambda r: int(r.at["n"])
                )
                lines.append(
                    Line(
                        f"{mode}, {points} points",
                        [int(r.at["n"]) for r in rows],
                        [r.median for r in rows],
                        colour,
                        style="-" if points == counts[-1] else "--",
                        marker="o",
                    )
                )
        curves(
            figure.add_subplot(),
            lines,
            xlabel=f"samples a side of {tiles} tiles",
            ylabel="a step, one thread [ms]",
            sizes=sorted({int(r.at["n"]) for r in result.readings}),
        )


def markdown(result: Result) -> str:
    """Return the table "tiles, points -> milliseconds a step" of docs/robots.md."""
    counts = sorted({int(r.at["points"]) for r in result.all("bicubic")})
    some = result.all("exact")[0].at["points"]
    heads = [f"{points} point{'s' * (points > 1)}" for points in counts]
    heads += [f"all waves at {some} points", f"the same below, {some} points"]
    lines = ["| tiles | samples a side | " + " | ".join(heads) + " |"]
    lines.append("|---|---|" + "---|" * len(heads))
    for tiles, n in sorted({(int(r.at["tiles"]), int(r.at["n"])) for r in result.all("bicubic")}):
        readings = [result.find("bicubic", tiles=tiles, n=n, points=p) for p in counts]
        readings += [result.find(what, tiles=tiles, n=n) for what in ("exact", "below the surface")]
        cells = " | ".join(f"{float(f'{r.median:.2g}'):g}" for r in readings)
        lines.append(f"| {tiles} | {n} | {cells} |")
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "robots", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
