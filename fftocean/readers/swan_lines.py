"""
Header and blocks that the 1-D and 2-D spectrum files of SWAN share.

Source: SWAN User Manual, appendix "Spectrum files, input and output" (format version 1).
"""

import re
from collections.abc import Callable, Iterator
from datetime import datetime
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bounded_reads, dataset_layout

ENERGY: Final = 1025.0 * 9.81
"""Default rho g of SWAN, which converts variance to energy [kg/m^2/s^2]."""

MOST: Final = 10**6
"""Largest number of places, of frequencies, and of frequencies times directions."""


def recognises(first_line: str) -> bool:
    """Return True if a text file with this first line is SWAN's."""
    return re.match(r"SWAN\s+1\b", first_line) is not None


class Lines:
    """
    Iterator over the file's lines without comments; `next` raises at the end of the file.
    """

    def __init__(self, path: Path) -> None:
        self.name = path.name
        self._lines: Iterator[tuple[str, str]] = bounded_reads.lines(path)
        self.where = path.name

    def next(self, wanted: str) -> str:
        line = self.maybe()
        if line is None:
            raise ReaderError(
                f"{self.name} ends after {self.where.rpartition(': ')[2]}, "
                f"where {wanted} must follow: the file is cut short"
            )
        return line

    def maybe(self) -> str | None:
        for where, line in self._lines:
            self.where = where
            if not line.startswith("$"):
                return line
        return None

    def table(self, wanted: str, columns: int) -> Real:
        """
        Return the first `columns` numbers of each line of a table, whose first line is a count.

        Other words may follow: a place can have a name.
        """
        rows = bounded_reads.count(self.where, self.next(f"the number of {wanted}"), MOST)
        return np.array([self._row(wanted, columns) for _ in range(rows)])

    def _row(self, wanted: str, columns: int) -> list[float]:
        tokens = self.next(wanted).split()
        if len(tokens) < columns:
            raise ReaderError(
                f"{self.where} must hold {columns} numbers for {wanted}, "
                f"got {' '.join(tokens)!r:.40}"
            )
        return [bounded_reads.number(self.where, token) for token in tokens[:columns]]


class Header(NamedTuple):
    """Times, places and frequencies of a file."""

    dated: bool  # a time precedes each block
    axes: tuple[str, str]  # names of the coordinates of a place
    places: Real  # (place, 2)
    frequency_name: str  # for messages
    frequency: Real  # [Hz], as listed


def read_header(lines: Lines) -> Header:
    """
    Read a file as far as its frequencies.

    Raises:
        ReaderError: another version or time code, or a keyword that is missing.
    """
    first = lines.next("SWAN")
    if not recognises(first):
        raise ReaderError(f"{lines.where} must be 'SWAN   1', got {first!r:.40}")
    keyword = lines.next("TIME or LONLAT").split()[0]
    dated = keyword == "TIME"
    if dated:
        code = bounded_reads.count(lines.where, lines.next("the time coding option"), 6)
        if code != 1:
            raise ReaderError(
                f"{lines.where}: the time coding must be 1 (20161011.000000), got {code}"
            )
        keyword = lines.next("LONLAT or LOCATIONS").split()[0]
    if keyword not in ("LONLAT", "LOCATIONS"):
        raise ReaderError(f"{lines.where} must be LONLAT or LOCATIONS, got {keyword!r:.40}")
    places = lines.table("places", 2)
    axes = ("lon", "lat") if keyword == "LONLAT" else ("x", "y")
    keyword = lines.next("AFREQ or RFREQ").split()[0]
    if keyword not in ("AFREQ", "RFREQ"):
        raise ReaderError(f"{lines.where} must be AFREQ or RFREQ, got {keyword!r:.40}")
    frequency = lines.table("frequencies", 1)[:, 0]
    return Header(dated, axes, places, f"{lines.name}: {keyword}", frequency)


def site_of(header: Header, site: int) -> int:
    """
    Return the index of a place.

    Raises:
        ParameterError: the file has no such place.
    """
    return Count("", 0, len(header.places) - 1).check("site", site)


def number_of_quantities(lines: Lines, most: int) -> int:
    """Read the line QUANT and the number that follows it."""
    keyword = lines.next("QUANT").split()[0]
    if keyword != "QUANT":
        raise ReaderError(f"{lines.where} must be QUANT, got {keyword!r:.40}")
    return bounded_reads.count(lines.where, lines.next("the number of quantities"), most)


def read_blocks(
    lines: Lines,
    header: Header,
    site: int,
    read_block: Callable[[str, int], Real],
    *,
    first_words: str,
    values: int,
) -> tuple[Real, "np.ndarray[tuple[int], np.dtype[np.datetime64]] | None"]:
    """
    Read the rest of a file; return the blocks of one place, and their times if the file has any.

    Args:
        lines: of the file, after its header.
        header: of the file.
        site: index of the place.
        read_block: reads the block of a place, whose first line is given; returns an array.
        first_words: the words that a block may begin with, for messages.
        values: number of values that one block gives to the dataset.

    Raises:
        ReaderError: no block, a block without its time, or too many values.
    """
    time: list[datetime] = []
    blocks: list[Real] = []
    while (line := lines.maybe()) is not None:
        if header.dated:
            time.append(_time(lines.where, line))
        elif blocks:
            raise ReaderError(
                f"{lines.where} must be the end of a file without TIME, got {line!r:.40}"
            )
        for place in range(len(header.places)):
            first = lines.next(first_words) if header.dated or place else line
            block = read_block(first, place)
            if place == site:
                blocks.append(block)
        if len(blocks) * values > dataset_layout.MAX_VALUES:
            raise ReaderError(
                f"{lines.where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
    if not blocks:
        raise ReaderError(
            f"{lines.name} must hold at least one spectrum after its header, got none"
        )
    return np.array(blocks), np.array(time, dtype="datetime64[s]") if header.dated else None


def _time(where: str, line: str) -> datetime:
    """Return the time at the head of a block."""
    token = line.split()[0]
    if not re.fullmatch(r"[0-9]{8}\.[0-9]{6}", token):
        raise ReaderError(f"{where} must begin with a time like 20161011.000000, got {token!r:.40}")
    try:
        time = datetime.strptime(token, "%Y%m%d.%H%M%S")
    except ValueError as error:
        raise ReaderError(
            f"{where} must begin with a time like 20161011.000000, got {token} ({error})"
        ) from error
    if not 1900 <= time.year < 2200:
        raise ReaderError(f"{where} must begin with a time between 1900 and 2200, got {token}")
    return time
