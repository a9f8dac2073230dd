"""`fftocean plot`: plot a specified sea and its realisation on the tile."""

import argparse
from pathlib import Path

from fftocean.cli.arguments import path
from fftocean.cli.command import Command
from fftocean.cli.console import plain
from fftocean.cli.job_flags import add_job_flags, job_of


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean plot`."""
    add_job_flags(parser)
    parser.add_argument(
        "-o",
        "--output",
        type=path,
        default=Path("sea.png"),
        metavar="FILE",
        help="plot to write, .png, .svg or .pdf (default: sea.png)",
    )


def run(options: argparse.Namespace) -> int:
    """Write the plot of a job."""
    from fftocean import plots

    saved = plots.save(plots.plot_job(job_of(options).ocean()), options.output)
    print(f"plot: {plain(saved)}")
    return 0


COMMAND = Command(
    name="plot",
    arguments="[JOB.toml] [-o FILE]",
    summary="plot the specified sea and its realisation on the tile",
    examples=("fftocean plot", "fftocean plot gale.toml -o gale.png"),
    run=run,
    add_flags=add_flags,
)
