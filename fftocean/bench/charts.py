"""Charts of costs."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from fftocean import plots
from fftocean.arrays import RealLike
from fftocean.bench import machine
from fftocean.bench.results import Result
from fftocean.plots import SUFFIXES as SUFFIXES
from fftocean.plots.theme import BLUE as BLUE
from fftocean.plots.theme import DPI, INK, SYSTEMS, VERMILION
from fftocean.plots.theme import FAINT as FAINT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GREEN, PURPLE, BROWN, SLATE = SYSTEMS[1:]
COLOURS: Mapping[str, str] = {
    "fft": BLUE,
    "textbook": VERMILION,
    "careful": BROWN,
    "direct": PURPLE,
    "floor": SLATE,
    "other": GREEN,
}


@dataclass(frozen=True, slots=True)
class Line:
    """One curve of costs, and the label at its end."""

    label: str
    x: RealLike
    y: RealLike
    colour: str
    low: RealLike | None = None  # quartiles, drawn as a band
    high: RealLike | None = None
    style: str = "-"
    marker: str = "o"
    width: float = 2.0


@contextmanager
def sheet(
    path: Path, title: str, result: Result, *, width: float = 9.0, height: float = 5.2
) -> Iterator["Figure"]:
    """
    Yield an empty figure; on leaving, write it with its title, and the machine at its foot.

    Raises:
        ParameterError: matplotlib is not installed, or the name's suffix is none of .png, .svg,
            .pdf.
        OutputError: the file could not be written.
    """
    with plots.style():
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        figure.suptitle(title, x=0.01, ha="left")
        yield figure
        figure.supxlabel(foot(result), x=0.01, ha="left", fontsize=7.5, color=FAINT)
    plots.save(figure, path)


def foot(result: Result) -> str:
    """Return the machine and the time, as the small print of a chart."""
    load = result.before.get("load")
    busy = "" if load is None else f"; load {load:g} at the start"
    return (
        f"{machine.one_line(dict(result.machine))}\n"
        f"{result.before['utc']} UTC{busy}; medians of alternating runs"
    )


def curves(
    ax: "Axes", lines: Sequence[Line], *, xlabel: str, ylabel: str, sizes: Sequence[float] = ()
) -> None:
    """
    Draw curves on logarithmic axes, each labelled at its right end without overlaps.
    """
    ax.set(xscale="log", yscale="log", xlabel=xlabel, ylabel=ylabel)
    for line in lines:
        x, y = np.asarray(line.x, dtype=float), np.asarray(line.y, dtype=float)
        ax.plot(
            x,
            y,
            linestyle=line.style,
            color=line.colour,
            marker=line.marker,
            markersize=4.5,
            linewidth=line.width,
        )
        if line.low is not None and line.high is not None:
            ax.fill_between(
                x,
                np.asarray(line.low),
                np.asarray(line.high),
                color=line.colour,
                alpha=0.18,
                linewidth=0.0,
            )
    ax.minorticks_off()
    if sizes:
        ax.set_xticks(list(sizes), [f"{size:g}" for size in sizes])
    ax.grid(True, axis="y", color="#e9e9e9", linewidth=0.8)
    ax.set_axisbelow(True)
    ax.yaxis.set_major_formatter(lambda value, _: plain(value))
    _name_at_ends(ax, lines)


def bars(ax: "Axes", rows: Sequence[tuple[str, float, str, str]], *, xlabel: str = "") -> None:
    """Draw horizontal bars, the first on top: (name, value, words beside it, colour)."""
    for i, (_, value, words, colour) in enumerate(rows):
        ax.barh(-i, value, color=colour, height=0.62)
        ax.text(value, -i, f"  {words}", va="center", ha="left", fontsize=9.5, color=INK)
    ax.set_yticks([-i for i in range(len(rows))], [name for name, *_ in rows])
    ax.tick_params(axis="y", length=0)
    ax.set(
        xlabel=xlabel,
        xlim=(0.0, 1.6 * max(value for _, value, *_ in rows)),
        xticks=[] if not xlabel else ax.get_xticks(),
    )
    for side in ("left", *(() if xlabel else ("bottom",))):
        ax.spines[side].set_visible(False)


def plain(value: float) -> str:
    """
    Return a number as text, such as 0.5, 20 or 3,000.

    Powers of ten appear only where the zeros could not be counted at a glance.
    """
    if value == 0.0:
        return "0"
    if not 1e-4 <= abs(value) < 1e7:
        return f"{value:.0e}"
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def duration(milliseconds: float) -> str:
    """Return a time in a suitable unit."""
    for unit, length, limit in (
        ("µs", 1e-3, 1.0),
        ("ms", 1.0, 1e3),
        ("s", 1e3, 120e3),
        ("min", 60e3, 7200e3),
        ("h", 3600e3, 172800e3),
    ):
        if milliseconds < 0.9995 * limit:  # 0.9996 ms are 1.00 ms, not 1,000 µs
            return f"{_two(milliseconds / length)} {unit}"
    return f"{_two(milliseconds / 86400e3)} days"


def _two(value: float) -> str:
    """Return a number with two digits at least."""
    return (
        f"{value:,.0f}"
        if value >= 99.5
        else f"{value:#.3g}".rstrip(".")
        if value < 9.995
        else f"{value:.1f}"
    )


def _name_at_ends(ax: "Axes", lines: Sequence[Line]) -> None:
    """
    Write each line's name right of its last point, shifted until no names overlap.
    """
    named = sorted(
        (line for line in lines if line.label), key=lambda line: float(np.asarray(line.y)[-1])
    )
    if not named:
        return
    cast("Figure", ax.figure).draw_without_rendering()  # sets the limits of the axes
    to_pixels, height = ax.transData, 11.5 * DPI / 72.0
    positions: list[list[Any]] = []
    for line in named:
        x, y = to_pixels.transform((float(np.asarray(line.x)[-1]), float(np.asarray(line.y)[-1])))
        positions.append([line, x, y])
    for _ in range(50):  # neighbours move by half their overlap
        for lower, upper in pairwise(positions):
            if (overlap := height - (upper[2] - lower[2])) > 0.0:
                lower[2] -= 0.5 * overlap
                upper[2] += 0.5 * overlap
    for line, _, y in positions:
        last = (float(np.asarray(line.x)[-1]), float(np.asarray(line.y)[-1]))
        offset = (y - to_pixels.transform(last)[1]) * 72.0 / DPI
        ax.annotate(
            line.label,
            last,
            xytext=(8.0, offset),
            textcoords="offset points",
            color=line.colour,
            va="center",
            fontsize=9.5,
            annotation_clip=False,
        )
