"""
Datawell .spt files.

A file holds one spectrum of a Waverider: twelve lines about the buoy, then one per frequency. The
twelve lines: transmission, Hs [cm], Tz [s], largest density [m2/Hz], two temperatures, battery,
three offsets, orientation, inclination. Each line after them: frequency [Hz], density over the
largest, direction FROM and spread [degrees], skewness and kurtosis of the directions. The time is
in the file's name (`place}2024-09-09T01h15Z.spt`).

Source: Datawell Technical Note "File formats" (2013); Datawell Waves5 Reference Manual (2023),
section 14.2.
"""

import re
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bounded_reads, dataset_layout, moments
from fftocean.readers.reader import Head, Reader

if TYPE_CHECKING:
    from xarray import Dataset

_HEADER: Final = 12
_NAME: Final = re.compile(r".*?(\d{4})-?(\d{2})-?(\d{2})T(\d{2})[h:]?(\d{2})Z?.*")


def recognises(head: Head) -> bool:
    """Return whether a file has twelve lines of one number, then numbers between commas."""
    lines = [line for line in head.lines if line]
    number = r"[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?"
    return (
        len(lines) > _HEADER
        and all(re.fullmatch(number, line) for line in lines[:_HEADER])
        and re.match(rf"{number}(\s*,\s*{number}){{3,}}", lines[_HEADER]) is not None
    )


def read(path: Path, *, bins: int) -> "Dataset":
    """
    Read one spectrum.

    Args:
        path: the file.
        bins: directions round the compass into which the moments are unfolded.

    Raises:
        ReaderError: a line without its numbers, or a number out of range.
    """
    rows = bounded_reads.lines(path)
    header: list[float] = []
    table: list[list[float]] = []
    for where, line in rows:
        if len(header) < _HEADER:
            header.append(bounded_reads.number(where, line))
            continue
        tokens = [token.strip() for token in line.split(",")]
        if len(tokens) != 6:
            raise ReaderError(f"{where} must hold 6 numbers between commas, got {line!r:.40}")
        numbers = [bounded_reads.number(where, token) for token in tokens]
        if not -360.0 <= numbers[2] <= 720.0:
            raise ReaderError(
                f"{where}: the direction must be between -360 and 720 degrees, got {tokens[2]}"
            )
        if not 0.0 <= numbers[3] <= 180.0:
            raise ReaderError(
                f"{where}: the spread must be between 0 and 180 degrees, got {tokens[3]}"
            )
        table.append(numbers)
        if len(table) > dataset_layout.MAX_VALUES // bins:
            raise ReaderError(
                f"{where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
    if len(table) < 2:
        raise ReaderError(f"{path.name} must hold at least 2 frequencies, got {len(table)}")
    hs, largest = header[1] / 100.0, header[3]
    if not 0.0 <= largest <= dataset_layout.LARGEST * 360.0:
        raise ReaderError(
            f"{path.name}: line 4 must be a density of at least 0 m2/Hz, got {largest:g}"
        )
    kept, notes = dataset_layout.above_zero([row[0] for row in table])
    f, s, mean, spread, skewness, kurtosis = np.array(table)[kept].T
    frequency, order = dataset_layout.frequencies(f"{path.name}: the frequencies", f)
    density, counts = dataset_layout.densities(path.name, largest * s[np.newaxis, order], "m2/Hz")
    c1, c2 = moments.from_centred(
        *(column[np.newaxis, order] for column in (mean, spread, skewness, kurtosis))
    )
    unfolded, done = moments.unfold(density, c1, c2, bins)
    m0 = np.nansum(density * np.gradient(frequency), axis=1)
    return dataset_layout.dataset(
        source=path.name,
        source_format="Datawell .spt",
        frequency=frequency,
        density=unfolded,
        direction=moments.compass(bins),
        time=_time(path.name),
        notes={
            **counts,
            **notes,
            **done,
            **dataset_layout.compare_heights(path.name, m0, np.array([hs]), 0.005),
            "stated_hs": hs,
            "direction_reference": "true or magnetic north, as the receiver was set up",
            "sites": 1,
        },
    )


def _time(name: str) -> np.ndarray | None:
    """Return the time in the file's name, or None."""
    if match := _NAME.fullmatch(name):
        year, month, day, hour, minute = (int(part) for part in match.groups())
        try:
            return np.array([datetime(year, month, day, hour, minute)], dtype="datetime64[s]")
        except ValueError:
            return None
    return None


def _read(path: Path, site: int, bins: int) -> "Dataset":
    Count("", 0, 0).check("site", site)
    return read(path, bins=bins)


READER: Final = Reader(
    name="Datawell .spt",
    extensions=(".spt",),
    description="One spectrum of a Datawell Waverider, with four moments of the directions.",
    sniff=recognises,
    read=_read,
)
