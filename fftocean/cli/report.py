"""`fftocean report`: write a sea and its bake as one page."""

import argparse
from pathlib import Path

from fftocean.cli.arguments import path
from fftocean.cli.command import Command
from fftocean.cli.console import plain, size_in_words
from fftocean.cli.job_flags import add_job_flags, job_of


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean report`."""
    parser.add_argument(
        "-o",
        "--output",
        type=path,
        default=Path("report.html"),
        metavar="FILE",
        help="page to write (default: report.html)",
    )
    add_job_flags(parser)


def run(options: argparse.Namespace) -> int:
    """Write the report of a job or of a bake."""
    from fftocean.report import write_report

    job = job_of(options)
    folder = options.job if options.job is not None and options.job.is_dir() else None
    size = write_report(job, options.output, folder=folder)
    print(f"report: {plain(options.output)}, {size_in_words(size)}")
    return 0


COMMAND = Command(
    name="report",
    arguments="[JOB.toml | DIR] [-o FILE]",
    summary="write one page about a sea: words, spectra, statistics, images, files",
    examples=("fftocean report gale.toml -o gale.html", "fftocean report sea -o sea.html"),
    run=run,
    add_flags=add_flags,
)
