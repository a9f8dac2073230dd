"""
Yearly archive of NDBC with directions: five files of one buoy and year.

`41010w2019.txt` holds S(f), `...d...` alpha1, `...i...` alpha2 [degrees], `...j...` r1 and
`...k...` r2 in hundredths; all have the date and one column for each frequency. Any one of them
names the set.

Source: NDBC, Measurement Descriptions and Units, "Raw Spectral Wave Data" ("R1 and R2 are scaled by
100").
"""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import ndbc
from fftocean.readers.reader import Head, Reader

if TYPE_CHECKING:
    from xarray import Dataset

_NAME: Final = re.compile(
    r"([0-9a-z]{5})([wdijk])([0-9]{4}[^.]*(?:\.txt)?(?:\.gz)?)", re.IGNORECASE
)
_HUNDREDTHS: Final = ndbc._Column("r x 100", "hundredths", 110.0, (999.0, 9999.0))
_COLUMNS: Final = {
    "w": ndbc._KINDS[".data_spec"],
    "d": ndbc._KINDS[".swdir"],
    "i": ndbc._KINDS[".swdir2"],
    "j": _HUNDREDTHS,
    "k": _HUNDREDTHS,
}


def recognises(head: Head) -> bool:
    """Return True if header and name of a file are those of a set."""
    header = ndbc._DATE.match(head.first_line)
    numbers = header is not None and re.match(r"[0-9.]", header[3]) is not None
    return numbers and _NAME.fullmatch(head.path.name) is not None


def read(path: Path, *, bins: int) -> "Dataset":
    """
    Read a set, named by any one of its files.

    Args:
        path: the file; the others lie beside it, plain or as .gz.
        bins: directions round the compass into which the moments are unfolded.

    Returns:
        Spectra with directions; S(f) alone if only the `w` file exists.

    Raises:
        ReaderError: files of the set that are missing, by name, or broken lines.
    """
    names, found = _set(path)
    absent = [names[kind] for kind, other in found.items() if other is None]
    if found["w"] is not None and len(absent) == 4:
        return ndbc._undirected(ndbc._table(found["w"], _COLUMNS["w"]), "NDBC historical text")
    if absent:
        raise ReaderError(
            f"{path.name} must have the other files of its set beside it "
            f"(w: S(f); d, i: directions; j, k: r1, r2), missing: {', '.join(absent)}"
        )
    spectrum, *moments = (
        ndbc._table(other, _COLUMNS[kind]) for kind, other in found.items() if other is not None
    )
    for table in moments[2:]:
        largest = float(np.max(table.values, initial=0.0, where=~np.isnan(table.values)))
        if 0.0 < largest <= 1.0:  # no sea is that broad at all frequencies
            raise ReaderError(f"{table.name} must hold r in hundredths, got none above {largest:g}")
        table.values[:] *= 0.01
    return ndbc._directed(spectrum, moments, bins, "NDBC historical text with directions")


def _set(path: Path) -> tuple[dict[str, str], dict[str, Path | None]]:
    """Return names and paths of the five files of a set by kind."""
    match = _NAME.fullmatch(path.name)
    if not match:
        raise ReaderError(f"{path.name} must be named like 41010w2019.txt")
    names = {kind: f"{match[1]}{_like(match[2], kind)}{match[3]}" for kind in _COLUMNS}
    own = match[2].lower()
    return names, {kind: path if kind == own else _beside(path, names[kind]) for kind in names}


def files_of(path: Path) -> list[Path]:
    """Return a file and the others of its set that exist beside it."""
    return [other for other in _set(path)[1].values() if other is not None]


def set_of(name: str) -> str | None:
    """Return the name of the `w` file of a set from the name of any of its files, else None."""
    match = _NAME.fullmatch(name)
    return match and f"{match[1]}w{match[3].removesuffix('.gz')}".lower()


def _like(letter: str, kind: str) -> str:
    return kind.upper() if letter.isupper() else kind


def _beside(path: Path, name: str) -> Path | None:
    """Return the file of that name beside `path`, plain or packed."""
    plain = name.removesuffix(".gz")
    return next(
        (p for p in (path.with_name(plain), path.with_name(plain + ".gz")) if p.is_file()), None
    )


def _read(path: Path, site: int, bins: int) -> "Dataset":
    Count("", 0, 0).check("site", site)
    return read(path, bins=bins)


READER: Final = Reader(
    name="NDBC archive with directions",
    extensions=(".txt",),
    description="A year of a buoy: 41010w2019.txt with the d, i, j and k files.",
    sniff=recognises,
    read=_read,
    files=files_of,
)
