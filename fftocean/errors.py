"""
Exceptions and warnings of the package, in one tree.

    FFTOceanError
      ParameterError (ValueError)      a parameter out of range                           exit 2
        JobError                       a job file or a flag that cannot be carried out    exit 2
        ReaderError                    an input file that is not what it should be        exit 3
      FieldError (AttributeError)      a field that was not computed for this frame
      DeviceError (RuntimeError)       a graphics processor that was lost                 exit 2
      OutputError (OSError)            a file that could not be written                   exit 4
        FolderInUseError               a folder that another process writes to            exit 6
      IntegrityError                   a file that was changed after it was written       exit 5

A message names parameter, rule and value: `fetch must be between 1 and 5e+07 m, got -3.0`.
"""

from collections.abc import Iterable


class FFTOceanError(Exception):
    """Base class of all exceptions that the package raises on purpose."""

    exit_code = 2

    def __str__(self) -> str:
        r"""
        Return the message on one line, as a value in it may have several: an array, whose lines are
        indented, or a text, whose breaks are written as \n.
        """
        lines = super().__str__().splitlines()
        return "".join(
            f" {line.strip()}" if line[:1].isspace() else f"\\n{line}" if i else line
            for i, line in enumerate(lines)
        ).strip()


class ParameterError(FFTOceanError, ValueError):
    """A parameter out of range."""


class JobError(ParameterError):
    """A job file or a flag that cannot be carried out."""


class ReaderError(ParameterError):
    """An input file that is not what it should be."""

    exit_code = 3


class FieldError(FFTOceanError, AttributeError):
    """A field that was not computed for this frame."""


class DeviceError(FFTOceanError, RuntimeError):
    """A graphics processor that was lost, or has too little memory, also on a second try."""


class OutputError(FFTOceanError, OSError):
    """A file that could not be written completely, or not be read back."""

    exit_code = 4


class FolderInUseError(OutputError):
    """A folder that another process writes to."""

    exit_code = 6


class IntegrityError(FFTOceanError):
    """A file that was changed after it was written, or is not what it should be."""

    exit_code = 5


class SeaWarning(UserWarning):
    """A sea that is possible, but perhaps not the intended one."""


class CacheWarning(UserWarning):
    """A file in the user's cache that cannot be used, and is ignored."""


def described(value: object) -> str:
    """
    Return a wrong argument in words, for a message: its type, and its value if that is short.
    """
    if isinstance(value, type):
        return f"the class {value.__name__}"
    kind = type(value).__name__
    text = " ".join(repr(value).split())  # on one line, as an array is not
    if text.startswith((f"{kind}(", f"<{kind}")):
        return text if len(text) <= 60 else f"{text[:57]}..."
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({kind})"


def suggestion(word: object, names: Iterable[str], cutoff: float = 0.7) -> str:
    """Return "; did you mean godot?" for the name most like a misspelt word; "" if none is."""
    import difflib  # not before a word is wrong

    given = word.strip().casefold() if isinstance(word, str) else ""
    near = difflib.get_close_matches(given, list(names), n=1, cutoff=cutoff)
    return f"; did you mean {near[0]}?" if near else ""


def how_to_install(extra: str) -> str:
    """Return how to install an optional part of the package, which comes from a checkout."""
    return f"in a checkout of fftocean, pip install '.[{extra}]'"
