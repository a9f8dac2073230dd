"""Entry point of the command line: exit codes, signals, warnings."""

import contextlib
import io
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NoReturn

from fftocean.cli.console import note, plain
from fftocean.cli.parser import COMMANDS, build_parser
from fftocean.errors import FFTOceanError, OutputError, SeaWarning
from fftocean.job.parameters import spelled

FIRST_STEPS = """\
usage: fftocean COMMAND [options]

try:
  fftocean bake -o sea        bake the default sea (preview: sea/preview.png)
  fftocean view               see a sea live in the browser (extra `view`)
  fftocean info               describe a sea: waves, tile, loop, files, memory, time
  fftocean keys wind          find what a job file can say about the wind
  fftocean bake --help        list every option of a command
  fftocean --help             list all commands
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run one command and return its exit code.

    Args:
        arguments: the words after `fftocean`; None for those of this process.
    """
    try:
        with _sigterm_as_exit(), _any_text(), warnings.catch_warnings():
            warnings.simplefilter("always", SeaWarning)
            warnings.showwarning = _note_printer()
            given = sys.argv[1:] if arguments is None else arguments
            if not given and "_ARGCOMPLETE" not in os.environ:  # which a shell sets that completes
                print(FIRST_STEPS, end="", file=sys.stderr)
                return 2
            if given:  # the name of a command, whatever its case
                given = [spelled(given[0], (c.name for c in COMMANDS)) or given[0], *given[1:]]
            options = build_parser().parse_args(given)
            code: int = options.run(options)
            if sys.stdout:
                sys.stdout.flush()  # a full disk shows here, not after the last line
            return code
    except FFTOceanError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        return _fail("interrupted; a folder without manifest.json is not a finished bake", 130)
    except MemoryError:
        return _fail("not enough memory; a smaller --n needs less", 2)
    except BrokenPipeError:  # the reader of the pipe has gone: there is nobody to tell
        _discard_stdout()
        return 0
    except OSError as error:
        _discard_stdout()
        return _fail(
            f"{error.filename or 'output'}: {error.strerror or error}", OutputError.exit_code
        )


@contextlib.contextmanager
def _sigterm_as_exit() -> Iterator[None]:
    """
    Let SIGTERM exit as Ctrl-C does, through all clean-up, and restore its handler afterwards.

    Python lets only the main thread set handlers; other threads leave the signal alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _exit_on_sigterm)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL if before is None else before)


@contextlib.contextmanager
def _any_text() -> Iterator[None]:
    """
    Let stdout take any text, with escapes for what its encoding lacks, as stderr does.

    A Windows console or pipe often has 256 characters only.
    """
    stream = sys.stdout
    if not isinstance(stream, io.TextIOWrapper) or stream.errors != "strict":
        yield
        return
    stream.reconfigure(errors="backslashreplace")
    try:
        yield
    finally:
        with contextlib.suppress(ValueError, OSError):  # closed, or the disk is full
            stream.reconfigure(errors="strict")


def _exit_on_sigterm(*_: object) -> NoReturn:
    """Exit with the shell's own code for SIGTERM."""
    raise SystemExit(128 + signal.SIGTERM)


def _discard_stdout() -> None:
    """Discard all further output, so that the exit does not fail a second time over it."""
    # a stdout may have no file, or be None
    with contextlib.suppress(OSError, ValueError, AttributeError):
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, sys.stdout.fileno())
        os.close(null)


def _fail(message: str, code: int) -> int:
    """Print an error on stderr and return its exit code."""
    print(f"fftocean: {plain(message)}", file=sys.stderr)
    return code


def _note_printer() -> Callable[..., None]:
    """Return a function that prints warnings as notes, each text once in a command."""
    printed: set[str] = set()

    def show(message: Warning | str, *_: Any, **__: Any) -> None:
        if str(message) not in printed:
            printed.add(str(message))
            note(message)

    return show
