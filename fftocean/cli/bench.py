"""`fftocean bench`: measure the cost of a frame on this machine."""

import argparse
import sys
from pathlib import Path

from fftocean.cli.arguments import path
from fftocean.cli.command import Command
from fftocean.cli.console import console_for


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean bench`."""
    parser.add_argument(
        "--seconds",
        type=float,
        default=120.0,
        metavar="S",
        help="approximate time to take [s] (default: 120)",
    )
    parser.add_argument(
        "--n",
        type=int,
        nargs="+",
        metavar="N",
        help="samples a side to measure (default: 128 256 512 1024)",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=path,
        default=Path("bench.png"),
        metavar="FILE",
        help="plot to write (default: bench.png)",
    )
    parser.add_argument(
        "--no-plot", "--no-picture", dest="no_plot", action="store_true", help="write no plot"
    )
    parser.add_argument("--json", type=path, metavar="FILE", help="write the measurements as JSON")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def run(options: argparse.Namespace) -> int:
    """Measure, and print the table of the measurements."""
    from fftocean.bench import main as bench

    status = console_for(stderr=True)
    shown = status.is_terminal and sys.stderr.isatty() and not options.quiet
    code: int = bench(
        console_for(),
        seconds=options.seconds,
        sizes=options.n or None,
        picture=None if options.no_plot else options.output,
        json=options.json,
        status=status if shown else None,
    )
    return code


COMMAND = Command(
    name="bench",
    arguments="[-o FILE]",
    summary="measure the cost of a frame here, beside a textbook FFT and the direct sum "
    "(two minutes)",
    examples=(
        "fftocean bench",
        "fftocean bench --seconds 30 --n 256 512 -o here.png --json here.json",
    ),
    run=run,
    add_flags=add_flags,
)
