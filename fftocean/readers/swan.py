"""
Spectrum files of SWAN: ASCII, one block of integers and a factor for each time and place.

Source: SWAN User Manual, appendix "Spectrum files, input and output" (format version 1).
"""

import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bounded_reads, dataset_layout
from fftocean.readers.reader import Reader

if TYPE_CHECKING:
    from xarray import Dataset

_ENERGY: Final = (
    1025.0 * 9.81
)  # default rho g of SWAN, which converts variance to energy [kg/m^2/s^2]
_MOST: Final = 10**6  # places, frequencies, directions


def recognises(first_line: str) -> bool:
    """Return True if a text file with this first line is SWAN's."""
    return re.match(r"SWAN\s+1\b", first_line) is not None


class _Lines:
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
        rows = bounded_reads.count(self.where, self.next(f"the number of {wanted}"), _MOST)
        return np.array([self._row(wanted, columns) for _ in range(rows)])

    def _row(self, wanted: str, columns: int) -> list[float]:
        tokens = self.next(wanted).split()
        if len(tokens) < columns:
            raise ReaderError(
                f"{self.where} must hold {columns} numbers for {wanted}, "
                f"got {' '.join(tokens)!r:.40}"
            )
        return [bounded_reads.number(self.where, token) for token in tokens[:columns]]


def read(path: Path, *, site: int) -> "Dataset":
    """
    Read the 2-D spectra of one place.

    Args:
        path: the file.
        site: index of the place, from 0.

    Raises:
        ReaderError: a 1-D file, another version, units or time code, counts that do not agree, a
            file that is cut.
        ParameterError: `site` is not in the file.
    """
    lines = _Lines(path)
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
    site = Count("", 0, len(places) - 1).check("site", site)
    axes = ("lon", "lat") if keyword == "LONLAT" else ("x", "y")

    keyword = lines.next("AFREQ or RFREQ").split()[0]
    if keyword not in ("AFREQ", "RFREQ"):
        raise ReaderError(f"{lines.where} must be AFREQ or RFREQ, got {keyword!r:.40}")
    frequency, f_order = dataset_layout.frequencies(
        f"{lines.name}: {keyword}", lines.table("frequencies", 1)
    )
    keyword = lines.next("NDIR or CDIR").split()[0]
    if keyword not in ("NDIR", "CDIR"):
        one = " (a 1-D file: it has no directions to read)" if keyword == "QUANT" else ""
        raise ReaderError(f"{lines.where} must be NDIR or CDIR, got {keyword!r:.40}{one}")
    bearings = lines.table("directions", 1)[:, 0]
    if keyword == "CDIR":
        bearings = 270.0 - bearings  # toward, counter-clockwise from x, assumed to point east
        bearings = np.where(np.abs(bearings) > 360.0, np.mod(bearings, 360.0), bearings)
    direction, d_order = dataset_layout.directions(f"{lines.name}: {keyword}", bearings)
    if frequency.size * direction.size > _MOST:
        raise ReaderError(
            f"{lines.name} must have at most {_MOST} frequencies times directions, "
            f"got {frequency.size} by {direction.size}"
        )
    per_degree, fill = _quantity(lines)

    time: list[datetime] = []
    blocks: list[Real] = []
    shape = (frequency.size, direction.size)
    while (line := lines.maybe()) is not None:
        if dated:
            time.append(_time(lines.where, line))
        elif blocks:
            raise ReaderError(
                f"{lines.where} must be the end of a file without TIME, got {line!r:.40}"
            )
        for place in range(len(places)):
            keyword = lines.next("FACTOR, ZERO or NODATA") if dated or place else line
            block = _block(lines, keyword, shape, fill, wanted=place == site)
            if place == site:
                blocks.append(block)
        if len(blocks) * shape[0] * shape[1] > dataset_layout.MAX_VALUES:
            raise ReaderError(
                f"{lines.where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
    if not blocks:
        raise ReaderError(
            f"{lines.name} must hold at least one spectrum after its header, got none"
        )
    values = np.array(blocks)[:, f_order][:, :, d_order] * per_degree
    density, counts = dataset_layout.densities(lines.name, values, "m2/Hz/degree")
    return dataset_layout.dataset(
        source=lines.name,
        source_format="SWAN 2-D ASCII",
        frequency=frequency,
        density=density,
        direction=direction,
        time=np.array(time, dtype="datetime64[s]") if dated else None,
        position=dict(zip(axes, places[site].tolist(), strict=True)),
        notes={**counts, "site": site, "sites": len(places)},
    )


def _quantity(lines: _Lines) -> tuple[float, float]:
    """Return the factor from the file's unit to m2/Hz/degree, and the number for "missing"."""
    keyword = lines.next("QUANT").split()[0]
    if keyword != "QUANT":
        raise ReaderError(f"{lines.where} must be QUANT, got {keyword!r:.40}")
    if bounded_reads.count(lines.where, lines.next("the number of quantities"), 3) != 1:
        raise ReaderError(f"{lines.where}: a 2-D file must hold 1 quantity, got more")
    quantity = lines.next("VaDens or EnDens").split()[0]
    unit = lines.next("the unit").split()[0]
    known = {("VaDens", "m2/Hz/degr"): 1.0, ("EnDens", "J/m2/Hz/degr"): 1.0 / _ENERGY}
    if (quantity, unit) not in known:
        raise ReaderError(
            f"{lines.where}: the quantity must be VaDens in m2/Hz/degr or EnDens in "
            f"J/m2/Hz/degr, got {quantity} in {unit}"
        )
    return known[quantity, unit], bounded_reads.number(
        lines.where, lines.next("the exception value").split()[0]
    )


def _block(
    lines: _Lines, keyword: str, shape: tuple[int, int], fill: float, *, wanted: bool
) -> Real:
    """
    Return one spectrum, (f, d), in the file's unit; skip that of another place.
    """
    word = keyword.split()[0]
    if word in ("ZERO", "NODATA"):
        return np.full(shape if wanted else (0, 0), 0.0 if word == "ZERO" else np.nan)
    if word != "FACTOR":
        raise ReaderError(f"{lines.where} must be FACTOR, ZERO or NODATA, got {keyword!r:.40}")
    factor = bounded_reads.number(lines.where, lines.next("the factor"))
    if not factor >= 0.0:
        raise ReaderError(f"{lines.where}: the factor must be at least 0, got {factor}")
    block = np.empty(shape)
    for row in block:
        tokens = lines.next("a row of densities").split()
        while len(tokens) < row.size:  # a long row may continue in the next line
            tokens += lines.next("the rest of a row").split()
        if len(tokens) > row.size:
            raise ReaderError(
                f"{lines.where} must hold {row.size} densities, one a direction, got {len(tokens)}"
            )
        if wanted:
            row[:] = [_density(lines.where, token, fill) for token in tokens]
    if factor == 0.0 and wanted and np.any(block > 0.0):
        raise ReaderError(
            f"{lines.where}: the factor must be above 0 for densities that are not 0, "
            "got 0 (SWAN writes ZERO for a flat sea)"
        )
    return block * factor


def _density(where: str, token: str, fill: float) -> float:
    value = bounded_reads.number(where, token)
    if value == fill:
        return float("nan")
    if value < 0.0:
        raise ReaderError(
            f"{where}: a density must be at least 0 (or {fill:g}, missing), got {token}"
        )
    return value


def _time(where: str, line: str) -> datetime:
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


READER: Final = Reader(
    name="SWAN 2-D ASCII",
    extensions=(".spec", ".sp2", ".spc"),
    description="Spectra by frequency and direction, of one or more places.",
    sniff=lambda head: recognises(head.first_line),
    read=lambda path, site, bins: read(path, site=site),  # noqa: ARG005
)
