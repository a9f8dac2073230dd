"""Progress of a command: a bar for people, lines of JSON for programs."""

import contextlib
import json
import sys
from collections.abc import Callable, Iterator
from typing import Any

from fftocean.cli.console import console_for
from fftocean.errors import FFTOceanError

Event = dict[str, Any]
ShowProgress = Callable[[int, int, str], None]
"""Called with (done, total, description)."""


@contextlib.contextmanager
def progress_bar(title: str, unit: str, *, shown: bool) -> Iterator[ShowProgress]:
    """Show a progress bar with its remaining time on a terminal, and nothing elsewhere."""
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    console = console_for(stderr=True)
    # colours may be forced on a file, a bar may not
    shown = shown and console.is_terminal and sys.stderr.isatty()
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn(unit),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, disable=not shown, transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total, description: bar.update(
            task, completed=done, total=total, description=description
        )


@contextlib.contextmanager
def json_events(wanted: bool) -> Iterator[Callable[[Event], None] | None]:
    """
    Give a function that prints an event as a line of JSON, or None if no JSON is wanted.

    An error within the block is the last event.
    """
    if not wanted:
        yield None
        return
    try:
        yield print_event
    except FFTOceanError as error:
        _print_error(str(error), error.exit_code)
        raise
    except KeyboardInterrupt:
        _print_error("interrupted", 130)
        raise
    except SystemExit as leaving:
        _print_error("terminated", leaving.code)
        raise


def print_event(event: Event) -> None:
    """Print an event as one line of JSON."""
    print(json.dumps(event, ensure_ascii=True, allow_nan=False), flush=True)


def _print_error(message: str, exit_code: Any) -> None:
    print_event({"event": "error", "message": message, "exit_code": exit_code})
