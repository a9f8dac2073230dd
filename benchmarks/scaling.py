"""
Scaling of a full frame with n, for powers of two, smooth, odd and prime sizes.

All sizes alternate, so that a slow minute affects them all. The work of a transform of N = n x n
points grows as N log2 N: nanoseconds per point and log2 N are constant for a frame that scales as
it should; they rise where the working set leaves a cache, and for sizes with large prime factors.

    python benchmarks/scaling.py [--n 64 100 127] [--seconds 10] [--json FILE] [--plot FILE]
"""

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

import script

from fftocean.bench.charts import Line, curves, sheet
from fftocean.bench.contenders import Fast
from fftocean.bench.fits import power_law
from fftocean.bench.quick import ocean
from fftocean.bench.results import Entry, Reading, Result, race
from fftocean.plots.theme import BLUE, VERMILION

ASKS = "How does a full frame scale with n, and what do odd and prime sizes cost?"
KINDS = {
    "a power of two": (BLUE, "o"),
    "smooth": ("#00805d", "s"),
    "prime, or twice one": (VERMILION, "^"),
    "other": ("#56707a", "D"),
}


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(
        parser,
        64,
        81,
        100,
        127,
        128,
        129,
        180,
        243,
        250,
        251,
        256,
        257,
        300,
        360,
        432,
        500,
        509,
        511,
        512,
        514,
        625,
        720,
        1000,
        1009,
        1024,
    )
    parser.add_argument("--seconds", type=float, default=40.0, help="in all (default: 40)")
    parser.add_argument(
        "--planning",
        default="estimate",
        choices=("estimate", "measure"),
        help="default: estimate, as everywhere",
    )
    parser.add_argument("--backend", default="auto")


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run one race of all sizes."""
    entries = []
    for n in sorted(set(options.n)):
        say(f"{n} x {n} is made")
        own = ocean(n, planning=options.planning, backend=options.backend)
        entries.append(
            Entry(
                "full frame",
                Fast(own),
                {"n": n, "kind": kind(n), "backend": own.backend, "planning": options.planning},
            )
        )
    say("all sizes alternate")
    readings = race(entries, clock="cpu", seconds=options.seconds)
    for r in [r for r in readings if r.what == "full frame"]:
        points = int(r.at["n"]) ** 2
        readings.append(
            Reading(
                f"{r.what}, a point and log2 N",
                "ns",
                *per(r, points * math.log2(points)),
                r.count,
                r.clock,
                r.at,
            )
        )
    powers = [r for r in readings if r.what == "full frame" and r.at["kind"] == "a power of two"]
    if len(powers) >= 3:
        law = power_law([float(r.at["n"]) ** 2 for r in powers], [r.median for r in powers])
        low, high = law.exponent - law.error, law.exponent + law.error
        readings.append(
            Reading("exponent of N, powers of two", "1", law.exponent, low, high, law.points, "cpu")
        )
    return readings


def per(reading: Reading, work: float) -> tuple[float, float, float]:
    """Return the nanoseconds per unit of work: median and quartiles."""
    return 1e6 * reading.median / work, 1e6 * reading.low / work, 1e6 * reading.high / work


def kind(n: int) -> str:
    """Return the class of a size for Fourier transforms."""
    if n & (n - 1) == 0:
        return "a power of two"
    rest = n
    for factor in (2, 3, 5, 7):
        while rest % factor == 0:
            rest //= factor
    if rest == 1:
        return "smooth"
    return "prime, or twice one" if is_prime(n) or (n % 2 == 0 and is_prime(n // 2)) else "other"


def is_prime(n: int) -> bool:
    """Return whether n is prime."""
    return n > 1 and all(n % d for d in range(2, math.isqrt(n) + 1))


def draw(result: Result, path: Path) -> None:
    """Draw milliseconds against n, and nanoseconds per point and log2 N."""
    with sheet(path, ASKS, result, width=12.0, height=5.4) as figure:
        for ax, what, ylabel in (
            (figure.add_subplot(1, 2, 1), "full frame", "one full frame, one thread [ms]"),
            (
                figure.add_subplot(1, 2, 2),
                "full frame, a point and log2 N",
                "per point and log₂ N [ns]",
            ),
        ):
            rows = sorted(result.all(what), key=lambda r: r.at["n"])
            lines = []
            for name, (colour, marker) in KINDS.items():
                of = [r for r in rows if r.at["kind"] == name]
                if of:
                    x, y = [r.at["n"] for r in of], [r.median for r in of]
                    lines.append(
                        Line(
                            "",
                            x,
                            y,
                            colour,
                            style="-" if name == "a power of two" else "none",
                            marker=marker,
                        )
                    )
            ticks = [int(r.at["n"]) for r in rows if r.at["kind"] == "a power of two"] or [
                int(rows[0].at["n"]),
                int(rows[-1].at["n"]),
            ]
            curves(ax, lines, xlabel="samples a side, n", ylabel=ylabel, sizes=ticks)
            if what != "full frame":
                ax.set_yscale("linear")
                ax.set_ylim(0.0, None)
        present = [
            name for name in KINDS if any(r.at["kind"] == name for r in result.all("full frame"))
        ]
        for i, name in enumerate(present):
            colour, marker = KINDS[name]
            figure.axes[0].plot(
                [0.05],
                [0.93 - 0.065 * i],
                marker,
                color=colour,
                transform=figure.axes[0].transAxes,
                markersize=5,
            )
            figure.axes[0].text(
                0.08,
                0.93 - 0.065 * i,
                name,
                color=colour,
                va="center",
                transform=figure.axes[0].transAxes,
            )


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "scaling", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
