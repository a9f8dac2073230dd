"""
Cost of the FFT and of the direct sum: the size at which they cross, and the laws of their growth.

Both are compiled and compute the same eight linear fields of the same sea on one thread; the direct
sum in float64, the FFT in float32 and in float64. With N = n x n points and as many waves, one
should grow as N^2, the other as N log N. Every size is measured; where all points would take too
long (--limit), the direct sum computes some of them, each of which costs the same, and the table
has their number.

Exponents are fitted by least squares of the logarithms; their "quartiles" are one standard error to
either side.

    python benchmarks/direct_sum.py [--n 4 8 16 32] [--seconds 1] [--json FILE] [--plot FILE]
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import script

from fftocean.bench.charts import COLOURS, Line, curves, plain, sheet
from fftocean.bench.contenders import DirectSum, Fast, require_same_water
from fftocean.bench.fits import PowerLaw, cost, crossover, n_log_n, power_law, square
from fftocean.bench.quick import WITHIN, ocean
from fftocean.bench.results import Entry, Pair, Reading, Result, race
from fftocean.fields import EIGHT
from fftocean.plots.theme import BLUE, FAINT

ASKS = "From which n on is the FFT faster than the direct sum, and by which laws do the two grow?"
FFT, SUM = "FFT", "direct sum"
DTYPES = ("float32", "float64")
FFT_FROM, SUM_FROM = 96, 16  # the n from which a law is fitted: below, the overhead dominates


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(
        parser,
        3,
        4,
        5,
        6,
        7,
        8,
        9,
        10,
        12,
        14,
        16,
        20,
        24,
        32,
        48,
        64,
        96,
        128,
        192,
        256,
        384,
        512,
        1024,
    )
    parser.add_argument(
        "--seconds", type=float, default=2.0, help="per n, at least three rounds (default: 2)"
    )
    parser.add_argument(
        "--limit",
        type=float,
        default=3e8,
        help="waves x points of one call of the direct sum (default: 3e8, 128 x 128 whole)",
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Measure every size, and draw conclusions from all."""
    readings: list[Reading] = []
    for n in sorted(set(options.n)):
        say(f"{n} x {n}")
        readings += at_one_size(n, options.seconds, options.limit)
    return readings + conclusions(readings)


def at_one_size(n: int, seconds: float, limit: float) -> list[Reading]:
    """Time both alternately at one size."""
    oceans = {dtype: ocean(n, dtype=dtype) for dtype in DTYPES}
    waves = max(1, oceans["float32"].modes().kx.size)
    points = n * n if waves * n * n <= limit else max(1, int(min(limit, 2e7) / waves))
    slow = DirectSum(oceans["float64"], points)
    # both round in float64; phases of 1e3 rad cost three digits
    require_same_water(oceans["float64"], {SUM: slow}, within=1e-10)
    require_same_water(oceans["float32"], {SUM: slow}, within=WITHIN)
    summed = Entry(SUM, slow, {"n": n, "waves": waves, "points": points})
    fast = [Entry(FFT, Fast(oceans[dtype], EIGHT), {"n": n, "dtype": dtype}) for dtype in DTYPES]
    readings = race(
        [*fast, summed],
        [Pair(f"{SUM} / {FFT}", summed, one) for one in fast],
        clock="cpu",
        seconds=seconds,
    )
    return [r.scaled(1.0 / slow.share) if SUM in r.what else r for r in readings]


def conclusions(readings: Sequence[Reading]) -> list[Reading]:
    """Return the size at which both cross, and their laws."""
    sums = by_size(readings, SUM)
    found = []
    for dtype in DTYPES:
        ratios = by_size(readings, f"{SUM} / {FFT}", dtype)
        sizes = [float(r.at["n"]) for r in ratios]
        if cross := crossover(sizes, np.ones(len(ratios)), [r.median for r in ratios]):
            found.append(
                Reading(
                    "crossover",
                    "n",
                    cross.at,
                    cross.below,
                    cross.above,
                    len(ratios),
                    "cpu",
                    {"dtype": dtype},
                )
            )
    for label, rows, start in (
        (SUM, sums, SUM_FROM),
        *((FFT, by_size(readings, FFT, dtype), FFT_FROM) for dtype in DTYPES),
    ):
        rows = [r for r in rows if int(r.at["n"]) >= start]
        if len(rows) < 3:
            continue
        at = {
            "from_n": start,
            **({"dtype": str(rows[0].at["dtype"])} if "dtype" in rows[0].at else {}),
        }
        count = np.array([float(r.at["n"]) ** 2 for r in rows])
        times = np.array([r.median for r in rows])
        found.append(exponent(f"exponent of N, {label}", power_law(count, times), at))
        if label == FFT:
            found.append(
                exponent(
                    "exponent of N, FFT, the logarithm divided out",
                    power_law(count, times / np.log2(count)),
                    at,
                )
            )
        for name, law in (("N^2", square), ("N log N", n_log_n)):
            fit = cost(count, times, law)
            found.append(
                Reading.single(f"misfit of {name}, {label}", "%", 100.0 * fit.residual, at)
            )
    return found


def exponent(what: str, law: PowerLaw, at: dict[str, str | int]) -> Reading:
    """Return the reading of a fitted exponent."""
    return Reading(
        what,
        "1",
        law.exponent,
        law.exponent - law.error,
        law.exponent + law.error,
        law.points,
        "",
        at,
    )


def by_size(readings: Sequence[Reading], what: str, dtype: str | None = None) -> list[Reading]:
    """Return the readings of one name, by ascending n."""
    return sorted(
        (r for r in readings if r.what == what and dtype in (None, r.at.get("dtype"))),
        key=lambda r: r.at["n"],
    )


def draw(result: Result, path: Path) -> None:
    """Draw both costs with their fitted laws, and the ratio in words."""
    sums, fft = by_size(result.readings, SUM), by_size(result.readings, FFT, "float32")
    sizes = [int(r.at["n"]) for r in sums]
    ticks = [n for n in sizes if n & (n - 1) == 0] or sizes
    colour = COLOURS["direct"]
    with sheet(path, ASKS, result, width=9.0, height=6.6) as figure:
        ax = figure.subplots()
        lines = [
            Line(
                "direct sum",
                sizes,
                [r.median for r in sums],
                colour,
                [r.low for r in sums],
                [r.high for r in sums],
                style="none",
            ),
            Line(
                "FFT",
                sizes,
                [r.median for r in fft],
                BLUE,
                [r.low for r in fft],
                [r.high for r in fft],
                style="none",
            ),
        ]
        dense = np.geomspace(sizes[0], sizes[-1], 200)
        for rows, law, paint in ((sums, square, colour), (fft, n_log_n, BLUE)):
            if len(rows) >= 3:
                fit = cost([float(r.at["n"]) ** 2 for r in rows], [r.median for r in rows], law)
                ax.plot(dense, fit(dense**2), color=paint, linewidth=1.2, zorder=1)
        part = [r for r in sums if r.at["points"] != int(r.at["n"]) ** 2]
        ax.plot(
            [r.at["n"] for r in part],
            [r.median for r in part],
            "o",
            color="white",
            markersize=2.5,
            zorder=5,
        )
        curves(
            ax,
            lines,
            xlabel="samples a side, n",
            ylabel="eight fields of n x n points, one thread [ms]",
            sizes=ticks,
        )
        words = []
        for what, name in (
            ("exponent of N, direct sum", "direct sum"),
            ("exponent of N, FFT", "FFT"),
        ):
            for r in result.all(what)[:1]:
                words.append(f"{name}: N to the power of {r.median:.3f} ± {r.high - r.median:.3f}")
        for r in result.all("crossover", dtype="float32"):
            level = float(
                np.exp(
                    np.interp(np.log(r.median), np.log(sizes), np.log([row.median for row in fft]))
                )
            )
            ax.plot(
                [r.median],
                [level],
                "o",
                markersize=13,
                markerfacecolor="none",
                markeredgecolor=FAINT,
                markeredgewidth=1.5,
            )
            words.append(
                f"they cross at n = {r.median:.1f}: slower at {r.low:g}, faster at {r.high:g}"
            )
        for r in result.all(f"{SUM} / {FFT}", dtype="float32", n=128):
            words.append(f"at 128 x 128 the sum takes {plain(r.median)} times as long")
        ax.text(
            0.03,
            0.97,
            "\n".join(words),
            transform=ax.transAxes,
            va="top",
            fontsize=9.5,
            linespacing=1.6,
        )
        hollow = "hollow: computed from some of the points; " if part else ""
        ax.set_title(
            f"{hollow}lines: overhead + N², overhead + N log N, with N = n x n", fontsize=9.5
        )


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "direct_sum", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
