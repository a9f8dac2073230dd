"""
Memory of full frames.

For each n a fresh process computes a frame of 4 x 4, which imports all that is needed, and records
its memory. Then it makes an ocean and three full frames in the same arrays, and records its peak
and its memory after them. Compiled kernels come from the cache, as usual. The figures are the
process's own pages in memory (Linux: VmHWM and VmRSS), above those after the imports.

A sample of a tile takes 83 bytes: 28 in the frame's seven arrays, 20 in the half-spectra between
the two passes, 16 in the amplitudes of double precision, 8 in their variances, 8 in the waves of
single precision that frames are made from, 2 in frequencies, 1 in the factors of potentials. That
is 332 MiB at 2048 x 2048, and loaded kernels come to it; making the ocean takes less.

    python benchmarks/memory.py [--n 256 512] [--json FILE] [--plot FILE]
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import fresh
import script

from fftocean.bench.charts import bars, plain, sheet
from fftocean.bench.contenders import FULL
from fftocean.bench.results import Reading, Result
from fftocean.bench.timing import summary
from fftocean.errors import ParameterError
from fftocean.plots.theme import BLUE

ASKS = "How much memory do full frames take?"
CHILD = """
import json, re, sys, warnings
from pathlib import Path

def held():
    text = Path("/proc/self/status").read_text()
    keys = ("VmRSS", "VmHWM")
    return {key: int(re.search(key + r":\\s+(\\d+) kB", text).group(1)) / 1024 for key in keys}

def forget():  # resets VmHWM
    try:
        Path("/proc/self/clear_refs").write_text("5")
        return True
    except OSError:
        return False

import fftocean as fo
warnings.simplefilter("ignore", fo.SeaWarning)
n, fields, backend = int(sys.argv[1]), sys.argv[2].split(","), sys.argv[3]
sea, make = fo.Sea.from_wind(speed=10.0, fetch=100e3), fo.Ocean
# loads the FFT library, and the compiler for its first kernel
make.from_modes([], n=4, size=1.0, backend=backend).frame(0.0, fields)
base = held()["VmRSS"]
forget()
ocean = make(sea, n=n, size=300.0, seed=7, backend=backend)
made = held()
fresh = forget()
frame = ocean.frame(0.0, fields)
for i in range(1, 4):
    frame = ocean.frame(0.04 * i, fields, out=frame)
after = held()
arrays = sum(frame[name].nbytes for name in fields) / 2**20
making = made["VmHWM"] - base
streaming = after["VmHWM"] - base if fresh else 0.0
print(json.dumps({"imports": base, "making": making, "streaming": streaming,
    "resident": after["VmRSS"] - base, "peak": max(making, after["VmHWM"] - base),
    "arrays": arrays}))
"""
WHAT = {
    "peak": "peak above imports",
    "making": "peak while the ocean is made",
    "streaming": "peak while frames are made",
    "resident": "resident while streaming",
    "arrays": "of it the frame's own arrays",
    "imports": "after the imports",
}


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 256, 512, 1024, 2048)
    parser.add_argument("--runs", type=int, default=3, help="processes for each n (default: 3)")
    parser.add_argument("--backend", default="auto")


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run a few processes for each n, after one that fills the cache."""
    if not Path("/proc/self/status").exists():
        raise ParameterError("memory is measured on Linux only: there is no /proc/self/status here")
    readings = []
    say("filling the cache")
    fresh.python("-c", CHILD, "32", ",".join(FULL), options.backend)
    for n in options.n:
        say(f"{n} x {n}")
        said = [
            fresh.python("-c", CHILD, str(n), ",".join(FULL), options.backend).said
            for _ in range(options.runs)
        ]
        for key, what in WHAT.items():
            readings.append(
                Reading.of(
                    what,
                    "MiB",
                    summary([one[key] for one in said]),
                    {"n": n, "dtype": "float32", "threads": 1},
                )
            )
    return readings


def draw(result: Result, path: Path) -> None:
    """Draw the memory for the ocean, for streaming, and of the frame's own arrays, for each n."""
    sizes = result.settings["n"]
    with sheet(path, ASKS, result, width=9.0, height=1.6 + 1.1 * len(sizes)) as figure:
        ax = figure.subplots()
        rows = []
        for n in sorted(sizes, reverse=True):
            for key, label, colour in (
                ("making", f"{n} x {n}: at most, making the ocean", "#56707a"),
                ("streaming", "at most, making frames", BLUE),
                ("arrays", "of it the frame's own arrays", "#7fb8d8"),
            ):
                value = result.find(WHAT[key], n=n).median
                rows.append((label, value, f"{plain(round(value, 1))} MiB", colour))
        bars(ax, rows)
        ax.set_title("Full frames, float32, one thread: memory above that of the imports")


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "memory", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
