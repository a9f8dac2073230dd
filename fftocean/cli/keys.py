"""`fftocean keys`: list the keys of job files."""

import argparse
from typing import TYPE_CHECKING

from fftocean.cli.command import Command
from fftocean.cli.console import console_for
from fftocean.errors import JobError, suggestion

if TYPE_CHECKING:
    from rich.console import Console

    from fftocean.job.reference import KindRow, Row


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the argument of `fftocean keys`."""
    parser.add_argument(
        "pattern",
        nargs="?",
        default="",
        metavar="PATTERN",
        help="show only keys and kinds in which this text occurs, such as wind, foam or jonswap",
    )


def run(options: argparse.Namespace) -> int:
    """Print the keys, and the kinds of spectra and spreadings, that contain a text."""
    from fftocean.job.reference import key_rows, kind_rows

    keys = [row for row in key_rows() if row.matches(options.pattern)]
    kinds = [row for row in kind_rows() if row.matches(options.pattern)]
    if not keys and not kinds:
        names = {part for row in key_rows() for part in row.key.split(".")}
        names |= {row.name for row in kind_rows()}
        raise JobError(
            f"no key and no kind contains {options.pattern!r:.60}; `fftocean keys` lists them all"
            f"{suggestion(options.pattern, names)}"
        )
    console = console_for()
    for row in keys:
        _print_key(console, row)
    for kind in kinds:
        _print_kind(console, kind)
    return 0


def _print_key(console: "Console", row: "Row") -> None:
    """Print one key: its name and default, its meaning, its values."""
    from rich.padding import Padding
    from rich.text import Text

    default = f" = {row.default}" if row.default else ""
    flag = f"   {row.flag}" if row.flag else ""
    console.print(Text.assemble((row.key, "bold"), default, (flag, "cyan")))
    console.print(Padding(Text(f"{row.help}: {row.values}"), (0, 0, 0, 4)))


def _print_kind(console: "Console", kind: "KindRow") -> None:
    """Print one kind: its name, its meaning, the sets of keys, the values of each."""
    from rich.padding import Padding
    from rich.text import Text

    console.print(Text.assemble(f"{kind.role} ", (kind.name, "bold")))
    lines = [kind.summary, *kind.ways, *(f"{key}: {values}" for key, values in kind.keys)]
    for line in lines:
        console.print(Padding(Text(line), (0, 0, 0, 4)))


COMMAND = Command(
    name="keys",
    arguments="[PATTERN]",
    summary="list the keys of job files: meaning, unit, values, default",
    examples=("fftocean keys", "fftocean keys foam", "fftocean keys jonswap"),
    run=run,
    add_flags=add_flags,
)
