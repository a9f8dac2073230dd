"""
Cost of second-order waves in a full frame, by the number of waves whose pairs are summed.

Frames of the eight fields of one sea, n x n over 500 m, linear and with bound waves, alternate on
one thread in single precision. The time that second order adds is taken round by round, like the
ratio of the two frames; the tables of all pairs are made once an ocean.

    python benchmarks/second_order.py [--n 256] [--waves 500 1000] [--seconds 20] [--json FILE]
"""

import argparse
import math
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

import script

from fftocean.bench.charts import BLUE, bars, plain, sheet
from fftocean.bench.results import BUSY, Reading, Result
from fftocean.bench.timing import alternate, summary
from fftocean.errors import SeaWarning
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import JONSWAP
from fftocean.physics.spreading import CosinePower

ASKS = "What do second-order waves cost?"
FRAME, ADDED, RATIO = "frame", "second order adds", "frame / linear frame"
TABLES, MEMORY = "tables of all pairs, once an ocean", "memory of the tables"


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 256, 512)
    parser.add_argument(
        "--waves",
        type=int,
        nargs="+",
        default=[500, 1000, 2000],
        metavar="M",
        help="waves whose pairs are summed (default: 500 1000 2000)",
    )
    parser.add_argument("--seconds", type=float, default=20.0, help="for each n (default: 20)")
    parser.add_argument("--backend", default="auto")


def sea() -> Sea:
    """Return a wind sea of 3 m and 8 s, spread over 30 degrees."""
    spreading = CosinePower(s=2.0 / math.radians(30.0) ** 2 - 1.0)
    return Sea(
        WaveSystem(spectrum=JONSWAP.from_sea_state(hs=3.0, tp=8.0, gamma=3.3), spreading=spreading)
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run one race for each n, of the linear frame and those of second order."""
    readings = []
    for n in options.n:
        say(f"{n} x {n}: oceans are made")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SeaWarning)
            linear = Ocean(
                sea(), n=n, size=500.0, seed=7, backend=options.backend, planning="measure"
            )
        at = {"n": n, "waves": 0}
        oceans = {0: linear}
        for waves in options.waves:
            start = time.process_time()
            made = linear.with_amplitudes(linear.amplitudes, order=2, bound=waves)
            spent = time.process_time() - start
            oceans[waves] = made
            assert made.bound_waves is not None  # of order 2
            each = {**at, "waves": waves}
            readings += [
                Reading.single(TABLES, "s", spent, each, clock="cpu"),
                Reading.single(MEMORY, "MiB", made.bound_waves.nbytes / 2**20, each),
            ]
        say(f"{n} x {n}: frames alternate")
        contenders = {str(waves): frames(ocean) for waves, ocean in oceans.items()}
        rounds = alternate(contenders, seconds=options.seconds)
        for waves in oceans:
            each = {**at, "waves": waves}
            took = rounds.of(str(waves), "cpu")
            readings.append(Reading.of(FRAME, "ms", summary(took), each, scale=1e3, clock="cpu"))
            if waves:
                plainly = rounds.of("0", "cpu")
                added = summary(took - plainly)
                ratio = rounds.ratio(str(waves), "0", "cpu")
                readings += [
                    Reading.of(ADDED, "ms", added, each, scale=1e3, clock="cpu"),
                    Reading.of(RATIO, "x", ratio, each, clock="cpu"),
                ]
        busy = summary(rounds.wall["0"] / rounds.cpu["0"])
        readings.append(Reading.of(BUSY, "x", busy, at))
    return readings


def frames(ocean: Ocean) -> Callable[[], object]:
    """Return a function that computes the next frame of an ocean, into the same arrays."""
    frame, t = ocean.frame(0.0), 0.0

    def run() -> object:
        nonlocal t
        t += 1.0 / 30.0
        return ocean.frame(t, out=frame)

    return run


def draw(result: Result, path: Path) -> None:
    """Draw the time of each frame, and what second order adds to it."""
    sizes, waves = result.settings["n"], sorted({0, *result.settings["waves"]})
    height = 1.6 + 0.36 * len(sizes) * len(waves)
    with sheet(path, ASKS, result, width=9.0, height=height) as figure:
        rows = []
        for n in sizes:
            for m in waves:
                took = result.find(FRAME, n=n, waves=m).median
                words = f"{plain(round(took, 2))} ms"
                if m:
                    added = result.find(ADDED, n=n, waves=m).median
                    words += f", {plain(round(added, 2))} ms of it second order"
                name = f"{n} x {n}, {m} waves" if m else f"{n} x {n}, linear"
                rows.append((name, took, words, BLUE if m else "#7fb8d8"))
        bars(figure.subplots(), rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "second_order", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
