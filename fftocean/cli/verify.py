"""`fftocean verify`: check a tile against the direct sum of its waves."""

import argparse

from fftocean.cli.command import Command
from fftocean.cli.console import console_for, plain
from fftocean.cli.job_flags import add_job_flags, job_of

_WIDE = 100
"""Columns from which a table has room for the reasons of its tolerances."""


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean verify`."""
    add_job_flags(parser)
    parser.add_argument(
        "--t",
        type=float,
        default=3.7,
        metavar="T",
        help="time of the frame to verify [s] (default: 3.7)",
    )
    parser.add_argument(
        "--dtype",
        type=str.lower,
        choices=("float32", "float64"),
        help="precision (default: float64; float32 on a graphics processor)",
    )


def run(options: argparse.Namespace) -> int:
    """Print the checks of a job's tile; return 5 if one fails."""
    from rich.table import Table
    from rich.text import Text

    from fftocean.limits import TIME
    from fftocean.proof import verify

    t = TIME.check("t", options.t)
    job = job_of(options)
    on_device = job.settings["ocean.backend"] in ("gpu", "gpu-or-cpu")
    ocean = job.ocean(dtype=options.dtype or ("float32" if on_device else "float64"))
    checks = verify(ocean, t)
    title = f"{plain(job.source)}: {ocean.grid.nx} x {ocean.grid.ny}, {ocean.dtype}, t = {t:g} s"
    table = Table(title=Text(title), title_justify="left")
    console = console_for()
    wide = console.width >= _WIDE
    for heading in ("quantity", "against", "error", "tolerance", *(["reason"] if wide else []), ""):
        number = heading in ("error", "tolerance")
        table.add_column(
            heading, justify="right" if number else "left", no_wrap=number or not heading
        )
    for c in checks:
        verdict = "[green]ok[/]" if c.passed else "[bold red]FAILED[/]"
        reason = [c.reason] if wide else []
        table.add_row(c.name, c.against, f"{c.error:.1e}", f"{c.tolerance:.1e}", *reason, verdict)
    console.print(table)
    failed = [c.name for c in checks if not c.passed]
    passed = f"{len(checks) - len(failed)} of {len(checks)} checks passed"
    print(f"{passed}; failed: {', '.join(failed)}" if failed else passed)
    return 5 if failed else 0


COMMAND = Command(
    name="verify",
    arguments="[JOB.toml]",
    summary="verify the tile: FFT against the direct sum, seam, loop, Parseval, energy",
    examples=("fftocean verify", "fftocean verify gale.toml --n 128"),
    run=run,
    add_flags=add_flags,
)
