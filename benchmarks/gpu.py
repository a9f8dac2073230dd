"""
Full frames on a graphics adapter, beside those of the CPU.

A frame is timed in three ways: until the device has finished and four bytes are back (its fields
stay there), with its fields read back into arrays, and the reading alone. The CPU's frame has the
default backend and one thread. All run alternately; times are elapsed times, since the device has
no other. A software adapter computes on the same processor, and says nothing about a graphics card.

    python benchmarks/gpu.py [--n 512 1024 2048 4096] [--seconds S] [--json FILE] [--plot FILE]
"""

import argparse
import warnings
from collections.abc import Sequence
from pathlib import Path

import script

import fftocean as fo
from fftocean.bench.charts import bars, plain, sheet
from fftocean.bench.contenders import FULL
from fftocean.bench.results import Reading, Result
from fftocean.bench.timing import alternate
from fftocean.plots.theme import BLUE

ASKS = "How long does a full frame take on a graphics adapter?"
DEVICE, READ, READING, CPU = (
    "full frame, kept on the device",
    "full frame, read back",
    "reading back alone",
    "full frame on the CPU",
)


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 512, 1024, 2048, 4096)
    parser.add_argument(
        "--seconds", type=float, default=20.0, help="time for each n [s] (default: 20)"
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Race the three ways and the CPU at each n."""
    adapter, readings = fo.gpu.adapter(), []
    say(str(adapter))
    for n in options.n:
        say(f"{n} x {n}")
        at = {"n": n, "adapter": str(adapter), "dtype": "float32", "threads": 1}
        rounds = _race(n, options.seconds)
        for name in (DEVICE, READ, READING, CPU):
            readings.append(
                Reading.of(name, "ms", rounds.seconds(name, "wall"), at, scale=1e3, clock="wall")
            )
        for name in (DEVICE, READ):
            ratio = rounds.ratio(CPU, name, "wall")
            readings.append(Reading.of(f"{CPU} / {name}", "x", ratio, at, clock="wall"))
    return readings


def _race(n, seconds):
    """Return the rounds of one n."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        sea = fo.Sea.from_wind(speed=10.0, fetch=100e3)
        cpu = fo.Ocean(sea, n=n, size=300.0, seed=7)
        gpu = fo.Ocean(sea, n=n, size=300.0, seed=7, backend="gpu")
    held, frame, own = gpu.device_frame(0.0, FULL), gpu.frame(0.0, FULL), cpu.frame(0.0, FULL)
    times = iter(range(1, 10**9))

    def kept():
        kept = gpu.device_frame(0.04 * next(times), FULL)
        kept.device.queue.read_buffer(kept["height"], 0, 4)  # waits for all before it

    return alternate(
        {
            DEVICE: kept,
            READ: lambda: gpu.frame(0.04 * next(times), FULL, out=frame),
            READING: held.read,
            CPU: lambda: cpu.frame(0.04 * next(times), FULL, out=own),
        },
        seconds=seconds,
    )


def draw(result: Result, path: Path) -> None:
    """Draw the times at each n."""
    sizes = result.settings["n"]
    with sheet(path, ASKS, result, width=9.0, height=1.8 + 1.4 * len(sizes)) as figure:
        ax = figure.subplots()
        rows = []
        for n in sorted(sizes, reverse=True):
            for name, colour in zip(
                (DEVICE, READ, READING, CPU), (BLUE, "#56707a", "#7fb8d8", "#9aa5a9"), strict=True
            ):
                value = result.find(name, n=n).median
                rows.append((f"{n} x {n}: {name}", value, f"{plain(round(value, 2))} ms", colour))
        bars(ax, rows)
        ax.set_title(str(result.find(DEVICE, n=sizes[0]).at["adapter"]), fontsize=8)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "gpu", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
