"""Readers of measured and modelled wave spectra."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import (
    bounded_reads,
    dataset_layout,
    datawell,
    ndbc,
    ndbc_archive,
    near_misses,
    netcdf,
    octopus,
    spotter,
    swan,
    swan_1d,
    triaxys,
    ww3_text,
)
from fftocean.readers.reader import Head, Reader
from fftocean.readers.realise import Realised, sea_from_spectrum
from fftocean.readers.times import nearest_time

if TYPE_CHECKING:
    from xarray import Dataset

__all__ = ["FORMATS", "Reader", "Realised", "nearest_time", "open", "sea_from_spectrum"]

BINS = Count("", 8, 720)

FORMATS: Final[tuple[Reader, ...]] = (
    netcdf.READER,
    swan_1d.READER,
    swan.READER,
    ndbc_archive.READER,
    ndbc.READER,
    ww3_text.READER,
    spotter.READER,
    triaxys.READER,
    datawell.READER,
    octopus.READER,
)
"""The known formats; the first reader whose `sniff` accepts a file reads it."""

MOST_IN_FOLDER: Final = 10_000
"""Largest number of entries of a folder that is searched for a set of files."""


def open(path: str | os.PathLike[str], *, site: int = 0, bins: int = 72) -> "Dataset":
    """
    Read the wave spectra of one place from a file of any known format, plain or gzip.

    The format is recognised by the contents. `FORMATS` lists the known ones; docs/readers.md has an
    example of each. Name files that belong together (the five of an NDBC buoy) by any one of them,
    or by the folder that holds that set and no other.

    Args:
        path: the file.
        site: which place, from 0, where the file holds several; a grid is counted row by row.
        bins: directions round the compass, for buoys, which report Fourier moments and not
            directions.

    Returns:
        An xarray.Dataset with `efth` (time, freq, dir) [m2/Hz/degree], `freq` [Hz] ascending and
        `dir` [degrees] where waves come FROM, clockwise from north; without directions `ef` (time,
        freq) [m2/Hz]. `dpt` (time) is the depth [m] where it is known. Missing values are NaN and
        counted in the attributes. `dataset_layout.py` has it in full.

    Raises:
        ReaderError: the file cannot be read; the message names it, the line or variable, and the
            value.
        ParameterError: `site` or `bins` out of range.
    """
    bins = BINS.check("bins", bins)
    if not isinstance(path, (str, os.PathLike)):
        raise ReaderError(
            f"the spectrum must be the name of a file, got {path!r:.60} ({type(path).__name__})"
        )
    path = Path(os.fsdecode(path))
    with bounded_reads.reader_errors(path.name or str(path)):
        folder = "\0" not in str(path) and path.is_dir()
    if folder:
        path = _only_set(path)
    bounded_reads.require_file(path)
    try:
        return dataset_layout.warn_of_notes(_read(path, site, bins))
    except ReaderError as error:
        text = bounded_reads.printable(str(error))
        if text == str(error):
            raise
        raise ReaderError(text) from error


def _read(path: Path, site: int, bins: int) -> "Dataset":
    """Return the spectra of a file, read by the first reader that accepts it."""
    head = Head.of(path)
    for reader in FORMATS:
        if reader.sniff(head):
            return _note_unterminated(reader.files(path), reader.read(path, site, bins))
    if (hint := near_misses.hint(head)) is not None:
        raise ReaderError(f"{path.name} {hint}")
    for _ in bounded_reads.lines(path):  # raises if it is cut, binary, or one endless line
        break
    known = ", ".join(reader.name for reader in FORMATS)
    raise ReaderError(
        f"{path.name} must be wave spectra in a known format ({known}), got {head.first_line!r:.40}"
    )


def files_of(path: Path) -> list[Path]:
    """
    Return the files that `open` reads for a file: that one, and those beside it that belong to it.

    Raises:
        ReaderError: no regular file, or one that cannot be read.
    """
    bounded_reads.require_file(path)
    head = Head.of(path)
    return next((list(reader.files(path)) for reader in FORMATS if reader.sniff(head)), [path])


def _only_set(folder: Path) -> Path:
    """
    Return one file of the only set of NDBC's files in a folder.

    Raises:
        ReaderError: no set, or several; the message names them.
    """
    with bounded_reads.reader_errors(folder.name):
        names = []
        for entry in folder.iterdir():
            names.append(entry.name)
            if len(names) > MOST_IN_FOLDER:
                raise ReaderError(
                    f"{folder.name} must hold at most {MOST_IN_FOLDER} files, got more"
                )
    sets: dict[str, str] = {}
    for name in sorted(names):
        key = ndbc_archive.set_of(name) or ndbc.set_of(name)
        if key:
            sets.setdefault(key, name)
    if len(sets) != 1:
        held = f"those of {', '.join(sorted(sets))}"[:200] if sets else "none"
        raise ReaderError(
            f"the spectrum must be a regular file, got {str(folder)!r} (a directory); a folder "
            "must hold the files of one NDBC buoy (41010.data_spec and its four, "
            f"or 41010w2019.txt and its four), got {held}"
        )
    return folder / next(iter(sets.values()))


def _note_unterminated(read: list[Path], made: "Dataset") -> "Dataset":
    """Record in the attributes which of the text files read lack their final newline."""
    if "netCDF" in made.attrs["source_format"]:
        return made
    if cut := [other.name for other in read if not bounded_reads.has_final_newline(other)]:
        made.attrs["unterminated"] = (
            f"{', '.join(cut)}: the last line has no end, and was taken as whole"
        )
    return made
