"""Command line of a benchmark: flags, progress, table, JSON file and chart."""

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from fftocean.bench import machine
from fftocean.bench.charts import plain
from fftocean.bench.results import Reading, Result, answer
from fftocean.errors import FFTOceanError

Say = Callable[[str], None]

PLACES = ("json", "plot", "folder", "blender", "earlier", "source", "compiler")
"""Flags for files and programs of this machine, which are no settings of a result."""


def run(
    question: str,
    asks: str,
    description: str,
    *,
    flags: Callable[[argparse.ArgumentParser], None],
    measure: Callable[[argparse.Namespace, Say], Sequence[Reading]],
    draw: Callable[[Result, Path], None],
    arguments: Sequence[str] | None = None,
) -> int:
    """Ask one question from the command line; return the exit code."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    flags(parser)
    parser.add_argument(
        "--json",
        type=Path,
        metavar="FILE",
        help="write every reading, with quartiles and the machine",
    )
    parser.add_argument(
        "--plot",
        type=Path,
        metavar="FILE",
        help="chart to write: .png, .svg or .pdf (needs matplotlib)",
    )
    options = parser.parse_args(arguments)
    console, start = Console(stderr=True, highlight=False), time.perf_counter()

    def say(step: str) -> None:
        console.print(
            f"{time.perf_counter() - start:5.0f} s  {question}: {step}",
            markup=False,
            soft_wrap=True,
        )

    before = machine.moment()
    settings = {key: value for key, value in vars(options).items() if key not in PLACES}
    try:
        result = answer(question, asks, measure(options, say), settings, before)
        Console(width=150 if not sys.stdout.isatty() else None, highlight=False).print(
            table(result)
        )
        if options.json:
            result.write(options.json)
        if options.plot:
            draw(result, options.plot)
    except FFTOceanError as error:
        console.print(f"{question}: {error}", markup=False, soft_wrap=True)
        return error.exit_code
    say("done")
    return 0


def table(result: Result) -> Table:
    """Return every reading of a result as a row of a table."""
    rows = Table(
        title=result.asks,
        title_justify="left",
        box=None,
        pad_edge=False,
        caption=machine.one_line(dict(result.machine)),
    )
    for heading, justify in (
        ("what", "left"),
        ("at", "left"),
        ("median", "right"),
        ("quartiles", "right"),
        ("of", "right"),
        ("clock", "left"),
    ):
        rows.add_column(heading, justify=justify)
    for r in result.readings:
        at = " ".join(f"{key}={value}" for key, value in r.at.items())
        rows.add_row(
            r.what,
            at,
            f"{plain(r.median)} {r.unit}",
            f"{plain(r.low)} .. {plain(r.high)}",
            str(r.count),
            r.clock,
        )
    return rows


def sizes(parser: argparse.ArgumentParser, *default: int) -> None:
    """Add the flag for samples a side."""
    words = " ".join(map(str, default))
    parser.add_argument(
        "--n",
        type=int,
        nargs="+",
        default=list(default),
        metavar="N",
        help=f"samples a side (default: {words})",
    )
