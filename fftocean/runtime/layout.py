"""Names, types and limits of a run-time package: the waves of a sea, for programs that run it."""

import re
from typing import Any

import numpy as np

from fftocean.errors import ParameterError
from fftocean.grid import Grid

FORMAT, VERSION = "fftocean-runtime", 1
DOCUMENT, REFERENCE, README = "sea.json", "check.json", "README.md"
TWIDDLE = "twiddle.bin"

RECORD = np.dtype([("mx", "<i2"), ("my", "<i2"), ("cycles", "<u2"), ("re", "<f4"), ("im", "<f4")])
"""One wave, 14 bytes: integer wavenumbers, whole cycles in a loop, and h0(k) [m]."""

SIDES = tuple(2**i for i in range(1, 11))
"""Samples a side that the transforms of the readers can have: 2 to 1024."""
MOST_CYCLES = 2**16 - 1
"""Cycles in a loop that a record can hold."""
LEAST_TICKS, MOST_TICKS = 2, 2**20
"""Moments of a loop, at most: at 60 a second, four and a half hours."""
PHASES = 2**32
"""Cycles times ticks stay below this, so that a phase is exact in unsigned integers of 32 bits."""
MOST_TILES = 16
MOST_DOCUMENT = 2**20  # bytes
MOST_JOB = 2**18  # characters: four times those of the longest job file
MOST_POINTS = 4096  # of a tile, at which check.json has the fields
MOST_BYTES = 2**30  # of all files: 16 tiles of 1024 x 1024 waves and their textures have 640 MB

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]*(\.[A-Za-z0-9_-]+)*", re.ASCII)
_DEVICES = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.ASCII | re.IGNORECASE)


def waves_file(index: int) -> str:
    """Return the name of the file of a tile's waves."""
    return f"tile{index}.waves"


def texture_files(index: int, ending: str = "bin") -> tuple[str, str]:
    """Return the names of the files of a tile's two textures in a format."""
    return f"tile{index}_h0.{ending}", f"tile{index}_wave.{ending}"


def is_file_name(name: Any) -> bool:
    """
    Return whether a name is that of a file in the package's own folder, on every system.

    Names with a slash, a backslash, a colon, `..`, a leading dot or a device's name are not.
    """
    return (
        isinstance(name, str)
        and len(name) <= 80
        and _NAME.fullmatch(name) is not None
        and _DEVICES.fullmatch(name) is None
    )


def is_project_name(name: Any) -> bool:
    """Return whether a name with slashes is that of a file in the package's folder or below it."""
    return isinstance(name, str) and len(name) <= 200 and all(map(is_file_name, name.split("/")))


def require_sides(grid: Grid, name: str) -> None:
    """
    Raise if a tile has a number of samples that a radix-2 transform cannot have.

    Raises:
        ParameterError: nx or ny is not a power of two from 2 to 1024.
    """
    for n in (grid.nx, grid.ny):
        if n not in SIDES:
            larger = [side for side in SIDES if side > n]
            advice = f"the next one is {larger[0]}" if larger else f"the largest is {SIDES[-1]}"
            raise ParameterError(
                f"n of {name} must be a power of two between {SIDES[0]} and {SIDES[-1]} in a "
                f"run-time package, got {n}; {advice}"
            )


def ticks_for(most_cycles: int) -> int:
    """
    Return the largest number of ticks a loop, a power of two, that keeps every phase exact.

    Args:
        most_cycles: of any wave in a loop.

    Raises:
        ParameterError: more cycles than a record can hold.
    """
    require_cycles(most_cycles)
    ticks = MOST_TICKS
    while most_cycles * ticks >= PHASES:
        ticks //= 2
    return ticks


def require_ticks(ticks: Any, most_cycles: int) -> int:
    """
    Return a number of ticks that was asked for.

    Raises:
        ParameterError: it is no power of two, too large, or does not keep every phase exact.
    """
    require_cycles(most_cycles)
    if (
        isinstance(ticks, bool)
        or not isinstance(ticks, (int, np.integer))
        or not LEAST_TICKS <= ticks <= MOST_TICKS
        or int(ticks) & (int(ticks) - 1)
    ):
        raise ParameterError(
            f"ticks must be a power of two between {LEAST_TICKS} and {MOST_TICKS}, "
            f"got {ticks!r:.60}"
        )
    if most_cycles * int(ticks) >= PHASES:
        raise ParameterError(
            f"cycles times ticks must stay below 2^32 for exact phases, got {most_cycles} cycles "
            f"of the fastest wave and {ticks} ticks; at most {ticks_for(most_cycles)} fit"
        )
    return int(ticks)


def require_cycles(most_cycles: int) -> None:
    """
    Raise if a wave has more cycles in a loop than a record can hold.

    Raises:
        ParameterError: more than 65,535.
    """
    if most_cycles > MOST_CYCLES:
        raise ParameterError(
            f"the fastest wave must make at most {MOST_CYCLES} cycles in a loop, got "
            f"{most_cycles}; a shorter loop or a coarser tile has fewer"
        )


def is_digest(value: Any) -> bool:
    """Return whether a value is a SHA-256 as the document has it."""
    return isinstance(value, str) and re.fullmatch(r"[0-9a-f]{64}", value) is not None
