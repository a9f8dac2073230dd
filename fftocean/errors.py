"""
What can go wrong, in one tree.

    FFTOceanError
      ParameterError (ValueError)      a value that no sea can have                       exit 2
        JobError                       a job file or a flag that cannot be carried out    exit 2
        ReaderError                    an input file that is not what it should be        exit 3
      FieldError (AttributeError)      a field that was not computed for this frame
      OutputError (OSError)            a file that could not be written, whole            exit 4
        FolderInUseError               another process is writing there                   exit 6
      IntegrityError                   a result that is not what it claims to be          exit 5

A message names the thing, the rule, and what came: `fetch must be between 1 and 5e+07 m, got -3.0`.
"""


class FFTOceanError(Exception):
    """Everything this package raises on purpose."""

    exit_code = 2


class ParameterError(FFTOceanError, ValueError):
    """A value that no sea can have."""


class JobError(ParameterError):
    """A job file or a flag that cannot be carried out."""


class ReaderError(ParameterError):
    """An input file that is not what it should be."""

    exit_code = 3


class FieldError(FFTOceanError, AttributeError):
    """A field that was not computed for this frame."""


class OutputError(FFTOceanError, OSError):
    """A file that could not be written, whole."""

    exit_code = 4


class FolderInUseError(OutputError):
    """Another process is writing there."""

    exit_code = 6


class IntegrityError(FFTOceanError):
    """A result that is not what it claims to be."""

    exit_code = 5


class SeaWarning(UserWarning):
    """The sea can be had, but perhaps it is not what was meant."""


class CacheWarning(UserWarning):
    """Something in the user's cache is of no use, and is done without."""


def described(value: object) -> str:
    """
    Return what a wrong argument is, for a message: its type, and its value where that is short.
    """
    if isinstance(value, type):
        return f"the class {value.__name__}"
    kind = type(value).__name__
    text = " ".join(repr(value).split())  # on one line, as an array is not
    if text.startswith((f"{kind}(", f"<{kind}")):
        return text if len(text) <= 60 else f"{text[:57]}..."
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({kind})"


def how_to_install(extra: str) -> str:
    """Return how to install an optional part of the package, which comes from a checkout."""
    return f"in a checkout of fftocean, pip install '.[{extra}]'"
