"""
Time to seed the waves of a sea.

An ocean of one tile and a cascade of three are made of a sea that a wind raised in water of finite
depth: the variance of every wavenumber cell, the random numbers, the tables and plans of the
transforms. All that is made once a process (imports, compiled kernels, plans) has been made before.
The sizes alternate; times are CPU time of one process.

    python benchmarks/seeding.py [--n 512 2048] [--tile 256] [--runs 9] [--json FILE] [--plot FILE]
"""

import argparse
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import script

from fftocean.bench.charts import BLUE, bars, duration, sheet
from fftocean.bench.results import BUSY, Reading, Result
from fftocean.bench.timing import alternate, summary
from fftocean.cascade import Cascade
from fftocean.errors import SeaWarning
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea

ASKS = "How long does it take to seed a sea?"
OCEAN, CASCADE = "ocean", "cascade of three tiles"


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 512, 2048)
    parser.add_argument(
        "--tile", type=int, default=256, help="samples a side of a cascade's tiles (default: 256)"
    )
    parser.add_argument("--runs", type=int, default=9, help="of each size (default: 9)")


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Seed each size in turn."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)
        sea = Sea.from_wind(speed=14.0, fetch=200e3, depth=40.0)
        tiles = [(options.tile, size) for size in (500.0, 71.0, 9.3)]
        contenders: dict[str, Callable[[], object]] = {
            CASCADE: partial(Cascade, sea, tiles=tiles, seed=7, loop=40.0)
        }
        for n in options.n:
            contenders[str(n)] = partial(Ocean, sea, n=n, size=500.0, seed=7)
        say("one of each, which compiles and plans")
        for make in contenders.values():
            make()
        say(f"{options.runs} of each")
        rounds = alternate(contenders, seconds=0.0, least=options.runs)
    readings = []
    for name, what, n in [
        (CASCADE, CASCADE, options.tile),
        *((str(n), OCEAN, n) for n in options.n),
    ]:
        took = summary(rounds.of(name, "cpu"))
        readings.append(Reading.of(what, "ms", took, {"n": n}, scale=1e3, clock="cpu"))
    busy = summary(rounds.wall[CASCADE] / rounds.cpu[CASCADE])
    return [*readings, Reading.of(BUSY, "x", busy, {"n": options.tile})]


def draw(result: Result, path: Path) -> None:
    """Draw the times, one bar a size."""
    with sheet(path, ASKS, result, width=9.0, height=2.6) as figure:
        rows = []
        for reading in result.readings:
            if reading.what in (OCEAN, CASCADE):
                n = reading.at["n"]
                name = f"{reading.what}, {n} x {n}"
                rows.append((name, reading.median, duration(reading.median), BLUE))
        bars(figure.subplots(), rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "seeding", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
