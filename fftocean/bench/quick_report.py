"""Report of the quick benchmark: a table, sentences, a chart."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fftocean.bench import machine
from fftocean.bench.charts import BLUE, COLOURS, FAINT, Line, bars, curves, duration, plain, sheet
from fftocean.bench.results import BUSY, Reading, Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import RenderableType

PALE = "#7fb8d8"
OTHERS = {"careful": "careful SciPy", "textbook": "textbook NumPy"}


def title(result: Result) -> str:
    """Return the result in one line."""
    n = _main_size(result)
    gain = result.find("textbook / full frame", n=n).median
    return (
        f"A frame of {n} x {n} takes {duration(_full(result, n).median)} here: "
        f"{gain:.1f} times as fast as the textbook"
    )


def sentences(result: Result) -> list[str]:
    """Return the result in sentences."""
    n = _main_size(result)
    full = _full(result, n)
    gains = {name: result.find(f"{name} / full frame", n=n).median for name in OTHERS}
    height = result.find("height only / full frame", n=n).median
    said = [
        f"A frame of {n} x {n} takes {duration(full.median)} here on one thread, "
        f"{plain(1e3 / full.median)} a second: "
        "height, horizontal displacements, unit normals and Jacobian.",
        f"That is {gains['textbook']:.1f} times as fast as NumPy as in textbooks, and "
        f"{gains['careful']:.1f} times as fast as carefully optimised NumPy and SciPy. "
        f"The height alone costs {100 * height:.0f} % of it.",
    ]
    said += [
        f"Two threads make it {two.median:.2f} times as fast."
        for two in result.all("one thread / two", n=n)
    ]
    last = max(result.all("direct sum / FFT"), key=lambda r: r.at["n"])
    m = int(last.at["n"])
    slow = result.find("eight fields, direct sum", n=m)
    part = (
        ""
        if slow.at["points"] == m * m
        else f" (computed from {slow.at['points']} of its {m * m} points)"
    )
    said.append(
        f"Summed wave by wave, {m} x {m} takes {duration(slow.median)}{part}: "
        f"{plain(last.median)} times as long as by FFT."
    )
    for cross in result.all("crossover"):
        where = "at every n tried" if cross.low == cross.high else f"from n = {cross.high:g} on"
        said.append(
            f"The FFT is faster {where}; fewer waves than that are better summed one by one."
        )
    if not result.all("crossover"):
        said.append(f"Up to n = {m} the direct sum is never slower.")
    if (busy := float(np.median([r.median for r in result.all(BUSY)]))) > 1.1:
        said.append(
            f"The machine was busy: a second of work took {busy:.1f} s. Ratios are reliable; "
            "two threads gain more on an idle machine."
        )
    return said


def table(result: Result) -> "RenderableType":
    """Return the result as a table for a terminal."""
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    rows = Table(title=Text(result.asks), title_justify="left", box=None, pad_edge=False)
    for heading in (
        "samples",
        "full frame",
        "frames/s",
        "two threads",
        "height only",
        "careful SciPy",
        "textbook NumPy",
        "direct sum",
    ):
        rows.add_column(heading, justify="left" if heading == "samples" else "right")
    for n in result.settings["sizes"]:
        full = _full(result, n).median
        cells = [f"{n} x {n}", duration(full), plain(1e3 / full)]
        two = result.all("one thread / two", n=n)
        cells.append(
            f"{duration(_on_two_threads(result, n))}  {1.0 / two[0].median:.2f} x"
            if two
            else "one core only"
        )
        cells.append(duration(result.find("height only", n=n).median))
        for name in OTHERS:
            ratio = result.find(f"{name} / full frame", n=n).median
            cells.append(f"{duration(result.find(name, n=n).median)}  {ratio:5.1f} x")
        slow, measured = direct_sum(result, n)
        cells.append(f"{'' if measured else '~ '}{duration(slow)}  {plain(slow / full):>9} x")
        rows.add_row(*cells)
    foot = (
        "one thread, CPU time, medians of alternating runs; "
        "x: multiples of the full frame; ~: extrapolated"
    )
    small = f"\n{foot}\n{machine.one_line(dict(result.machine))}"
    return Group(rows, Text("\n" + "\n".join(sentences(result))), Text(small, style="dim"))


def draw(result: Result, path: Path) -> None:
    """
    Draw the result.

    Raises:
        ParameterError: matplotlib is not installed, or the name's suffix is none of .png, .svg,
            .pdf.
        OutputError: the file could not be written.
    """
    with sheet(path, title(result), result, width=12.0, height=5.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
        _draw_costs(left, result)
        _draw_one_frame(right, result)


def direct_sum(result: Result, n: int) -> tuple[float, bool]:
    """
    Return the time of the direct sum for n x n [ms], and whether it was measured at all points.

    Otherwise it is extrapolated, by points or as n^4.
    """
    sums = result.all("eight fields, direct sum")
    for row in sums:
        if row.at["n"] == n:
            return row.median, row.at["points"] == n * n
    largest = max(sums, key=lambda r: r.at["n"])
    return largest.median * (n / float(largest.at["n"])) ** 4, False


def _draw_costs(ax: "Axes", result: Result) -> None:
    """Draw the cost of a frame at each size, by every method."""
    sizes = result.settings["sizes"]
    lines = []
    for what, label, colour in (
        *((name, label, COLOURS[name]) for name, label in OTHERS.items()),
        ("full frame", "fftocean", BLUE),
    ):
        rows = [result.find(what, n=n, clock="cpu") for n in sizes]
        low, high = [r.low for r in rows], [r.high for r in rows]
        lines.append(
            Line(
                label,
                sizes,
                [r.median for r in rows],
                colour,
                low,
                high,
                width=2.6 if colour == BLUE else 2.0,
            )
        )
    if result.all("one thread / two"):
        lines.append(
            Line(
                "two threads", sizes, [_on_two_threads(result, n) for n in sizes], BLUE, style="--"
            )
        )
    fft = _by_size(result, "eight fields, FFT")
    for rows, label, style, colour in (
        (_by_size(result, "eight fields, direct sum"), "direct sum", "-", COLOURS["direct"]),
        (fft, "", ":", BLUE),
    ):
        x, y = [r.at["n"] for r in rows], [r.median for r in rows]
        lines.append(Line(label, x, y, colour, style=style, marker="o" if label else ""))
    tried = {int(r.at["n"]) for r in fft} | set(sizes)
    ticks = sorted(n for n in tried if n & (n - 1) == 0) or sorted(tried)
    curves(ax, lines, xlabel="samples a side, n", ylabel="one frame [ms]", sizes=ticks)
    start = (float(fft[0].at["n"]), fft[0].median)
    ax.annotate(
        "by FFT", start, xytext=(2, 6), textcoords="offset points", fontsize=8.5, color=BLUE
    )
    level, edge = 1e3 / 60.0, ax.get_xlim()[0]
    ax.axhline(level, color=FAINT, linewidth=0.8, linestyle=(0, (4, 3)))
    ax.annotate(
        "60 frames a second",
        (edge, level),
        xytext=(4, 3),
        textcoords="offset points",
        fontsize=8.5,
        color=FAINT,
    )
    for cross in result.all("crossover"):
        n, sums = cross.median, COLOURS["direct"]
        height = float(
            np.interp(
                math.log(n), [math.log(float(r.at["n"])) for r in fft], [r.median for r in fft]
            )
        )
        ax.plot(
            [n],
            [height],
            "o",
            markersize=11,
            markerfacecolor="none",
            markeredgecolor=sums,
            markeredgewidth=1.6,
        )
        words = f"they cross\nat n = {n:.0f}"
        ax.annotate(
            words,
            (n, height),
            xytext=(9, -28),
            textcoords="offset points",
            fontsize=9.0,
            color=sums,
        )
    ax.set_title("Cost of a frame, by size")


def _draw_one_frame(ax: "Axes", result: Result) -> None:
    """Draw the cost of one frame, by every method that fits on one scale."""
    n = _main_size(result)
    full, height = _full(result, n).median, result.find("height only", n=n).median
    rows = [
        ("fftocean", full, duration(full), BLUE),
        ("its height only", height, duration(height), PALE),
    ]
    for two in result.all("one thread / two", n=n):
        both = _on_two_threads(result, n)
        rows.append(
            ("on two threads", both, f"{duration(both)}, {two.median:.2f} times as fast", PALE)
        )
    for name, label in OTHERS.items():
        other, ratio = (
            result.find(name, n=n).median,
            result.find(f"{name} / full frame", n=n).median,
        )
        rows.append((label, other, f"{duration(other)}, {ratio:.1f} times as long", COLOURS[name]))
    bars(ax, rows)
    ax.set_title(f"One frame of {n} x {n}")
    slow, measured = direct_sum(result, n)
    taken = f"{'' if measured else 'about '}{duration(slow)}"
    ratio_text = plain(slow / full)
    words = f"The direct sum is not drawn: it takes {taken},\n{ratio_text} times the first bar."
    ax.text(
        0.0, -0.02, words, transform=ax.transAxes, fontsize=9.0, color=COLOURS["direct"], va="top"
    )


def _full(result: Result, n: int) -> Reading:
    """Return the reading of a full frame on one thread."""
    return result.find("full frame", n=n, threads=1, clock="cpu")


def _on_two_threads(result: Result, n: int) -> float:
    """
    Return the time of a full frame on two threads [ms].

    It is the CPU time of one thread, divided by the gain of two in elapsed time.
    """
    return _full(result, n).median / result.find("one thread / two", n=n).median


def _by_size(result: Result, what: str) -> list[Reading]:
    """Return the readings of one name, by ascending n."""
    return sorted(result.all(what), key=lambda r: r.at["n"])


def _main_size(result: Result) -> int:
    """Return the size that the sentences describe: 512 if measured, else the largest."""
    sizes: list[int] = result.settings["sizes"]
    return 512 if 512 in sizes else max(sizes)
