"""
CPU time of time series at probes, and the direct sum's beside it.

Ten probes over three hours at 5 Hz, on a tile of 256 x 256 over 400 m: on a loop of ten minutes,
whose steps are those of a Fourier transform, and without one. The direct sum adds all waves with
NumPy at each time; some times of it are measured, and scaled to all. The largest difference of the
heights at these times is a reading, too.

    python benchmarks/series.py [--n 256] [--hours 3] [--probes 10] [--seconds 20] [--json FILE]
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import script

import fftocean as fo
from fftocean.bench.charts import BLUE, bars, plain, sheet
from fftocean.bench.results import Entry, Reading, Result, race
from fftocean.probe_series import UNITS

ASKS = "How long do time series at probes take?"
SERIES, DIRECT, ERROR = "series", "direct sum", "largest error / largest height"
RATE = 5.0  # times a second
LOOP = 600.0  # [s]
FIELDS = {"height": "height", "all": f"all {len(UNITS)} fields"}


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 256)
    parser.add_argument("--hours", type=float, default=3.0)
    parser.add_argument("--probes", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=20.0, help="for each sea (default: 20)")


def direct_sum(ocean: fo.Ocean, x: np.ndarray, y: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return heights (times, probes), all waves at each time."""
    waves = ocean.modes()
    along = np.outer(waves.kx, x) + np.outer(waves.ky, y) - waves.phase[:, None]
    return np.stack(
        [waves.amplitude @ np.cos(along - (waves.omega * moment)[:, None]) for moment in t]
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run one race for each sea."""
    rng, readings = np.random.default_rng(0), []
    x, y = rng.uniform(-1000.0, 1000.0, (2, options.probes))
    t = np.arange(max(2, round(options.hours * 3600.0 * RATE))) / RATE
    some = rng.choice(t.size, min(4, t.size), replace=False)
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3)
    for n in options.n:
        for loop in (LOOP, None):
            say(f"{n} x {n}, {'on a loop' if loop else 'without a loop'}")
            ocean = fo.Ocean(sea, n=n, size=400.0, seed=3, loop=loop)
            at = {"n": n, "loop": loop is not None}
            sets = {"height": ("height",), "all": tuple(UNITS)}
            entries = [
                Entry(
                    SERIES,
                    lambda fields=fields, ocean=ocean: fo.series(ocean, x, y, t, fields),
                    {**at, "fields": name},
                )
                for name, fields in sets.items()
            ]
            slow = Entry(
                DIRECT,
                lambda ocean=ocean: direct_sum(ocean, x, y, t[some]),
                {**at, "fields": "height"},
            )
            found = race([*entries, slow], clock="cpu", seconds=options.seconds)
            readings += [r.scaled(t.size / some.size) if r.what == DIRECT else r for r in found]
            true = direct_sum(ocean, x, y, t[some])
            apart = np.max(np.abs(fo.series(ocean, x, y, t)["height"][some] - true))
            readings.append(Reading.single(ERROR, "1", float(apart / np.max(np.abs(true))), at))
    return readings


def draw(result: Result, path: Path) -> None:
    """Draw the seconds of each sea and set of fields."""
    with sheet(
        path, ASKS, result, width=9.0, height=2.0 + 0.36 * len(result.all(SERIES))
    ) as figure:
        rows = []
        for r in result.all(SERIES):
            water = "a loop" if r.at["loop"] else "no loop"
            name = f"{r.at['n']} x {r.at['n']}, {water}, {FIELDS[str(r.at['fields'])]}"
            rows.append((name, r.median / 1e3, f"{plain(round(r.median / 1e3, 3))} s", BLUE))
        bars(figure.subplots(), rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "series", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
