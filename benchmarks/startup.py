"""
Time until the first frame.

In fresh processes: `import fftocean`, `fftocean --help`, the first full frame after an installation
(nothing compiled, no cache), and in every later process. Each is the elapsed time of a whole
process; "above Python" is that minus the median of a process that does nothing, "above NumPy" of
one that imports NumPy. CPU time is given beside it: on a busy machine it is closer to the time on
an idle one.

    python benchmarks/startup.py [--runs 7] [--n 256] [--json FILE] [--plot FILE]
"""

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

import fresh
import numpy as np
import script

from fftocean.bench.charts import bars, duration, sheet
from fftocean.bench.contenders import FULL
from fftocean.bench.results import Reading, Result
from fftocean.bench.timing import summary
from fftocean.plots.theme import BLUE

ASKS = "How long until the first frame?"
FIRST = f"""
import json, time
start = time.perf_counter()
import warnings
import fftocean as fo
warnings.simplefilter("ignore", fo.SeaWarning)
ocean = fo.Ocean(fo.Sea.from_wind(speed=10.0, fetch=100e3), n={{n}}, size=300.0, seed=7)
ocean.frame(0.0, {FULL!r})
print(json.dumps(time.perf_counter() - start))
"""
LATER = "first frame in later processes, above NumPy"
PROGRAMS = {
    "nothing": ("-c", "pass"),
    "import numpy": ("-c", "import numpy"),
    "import fftocean": ("-c", "import fftocean"),
    "fftocean --help": ("-m", "fftocean", "--help"),
}


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    parser.add_argument("--runs", type=int, default=9, help="processes of each kind (default: 9)")
    parser.add_argument(
        "--cold", type=int, default=2, help="processes with an empty cache (default: 2)"
    )
    parser.add_argument(
        "--n", type=int, default=256, help="samples a side of the first frame (default: 256)"
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Time imports alternately, then the first frame with an empty and a filled cache."""
    lives: dict[str, list[fresh.Run]] = {name: [] for name in PROGRAMS}
    say("import and help")
    for i in range(options.runs + 1):
        for name, program in PROGRAMS.items():
            run = fresh.python(*program)
            if i:  # the first of each reads its files from the disk
                lives[name].append(run)
    idle, numpy = lives.pop("nothing"), lives.pop("import numpy")
    readings = both("a process that does nothing", idle)
    for name, runs in lives.items():
        readings += both(name, runs)
        readings += both(f"{name}, above Python", runs, less=idle)
    program = ("-c", FIRST.format(n=options.n))
    with tempfile.TemporaryDirectory() as folder:
        first = []
        for i in range(options.cold):
            say(f"first frame with an empty cache, {i + 1} of {options.cold}")
            cache = Path(folder, str(i))
            cache.mkdir()
            first.append(fresh.python(*program, cache=cache))
        say("first frame in later processes")
        later = [fresh.python(*program, cache=cache) for _ in range(options.runs)]
    readings += both("first frame after installation", first, n=options.n)
    readings += both("first frame in later processes", later, n=options.n)
    return readings + both(LATER, later, less=numpy, n=options.n)


def both(
    what: str, runs: Sequence[fresh.Run], *, less: Sequence[fresh.Run] = (), **at: int
) -> list[Reading]:
    """Return a reading by each clock, above the median of other runs if given."""
    readings = []
    for clock in ("wall", "cpu"):
        base = float(np.median([getattr(run, clock) for run in less])) if less else 0.0
        readings.append(
            Reading.of(
                what, "s", summary([getattr(run, clock) - base for run in runs]), at, clock=clock
            )
        )
    return readings


def draw(result: Result, path: Path) -> None:
    """Draw all starts on one scale."""
    n = result.settings["n"]
    with sheet(path, ASKS, result, width=9.0, height=3.6) as figure:
        ax = figure.subplots()
        rows = []
        for name, what, colour in (
            ("import fftocean", "import fftocean, above Python", "#7fb8d8"),
            ("fftocean --help", "fftocean --help", "#7fb8d8"),
            (f"first frame of {n} x {n}, later processes", "first frame in later processes", BLUE),
            ("the very first, which compiles", "first frame after installation", "#56707a"),
        ):
            value = result.find(what, clock="wall").median
            rows.append((name, value, duration(1e3 * value), colour))
        bars(ax, rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "startup", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
