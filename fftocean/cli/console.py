"""Text on the terminal: plain lines, sizes, tables."""

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

NO_TERMINAL_WIDTH = 140
"""Columns of a table that is written to a file or a pipe."""


def console_for(*, stderr: bool = False) -> "Console":
    """Return a console that fits its terminal, or is as wide as tables need without one."""
    from rich.console import Console

    console = Console(stderr=stderr, highlight=False)
    if console.is_terminal:
        return console
    return Console(stderr=stderr, highlight=False, width=NO_TERMINAL_WIDTH)


def key_value_table(title: str) -> "Table":
    """Return an empty table of names and values under a title; nothing in it is markup."""
    from rich.table import Table
    from rich.text import Text

    return Table(
        title=Text(title), title_justify="left", show_header=False, box=None, pad_edge=False
    )


def plain(text: object) -> str:
    """
    Return text on one line, with escapes for all that a terminal would obey or could not show.

    Names of files may hold anything.
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def note(message: object) -> None:
    """Print a note on stderr."""
    print(f"note: {plain(message)}", file=sys.stderr)


def size_in_words(size: float) -> str:
    """Return a number of bytes in MiB, or in GiB from 1000 MiB on."""
    number = size / 2**20
    return f"{number / 1024:.3g} GiB" if number >= 1000.0 else f"{number:.3g} MiB"


def value_in_words(value: Any) -> str:
    """Return a value of a job as a job file has it, without quotes or brackets."""
    if isinstance(value, list):
        return ", ".join(value_in_words(v) for v in value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def shortened(value: Any, length: int = 110) -> str:
    """Return a value on one line of at most `length` characters."""
    text = str(value)
    return text if len(text) <= length else text[: length - 3] + "..."
