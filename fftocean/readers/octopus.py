"""
Octopus files: forecasts at one place as tables of energy by direction and frequency.

Seven lines of header, then for each time: names and values of bulk parameters, a line of
frequencies, one line for each direction FROM with the energy [m2] of each bin, and two lines of
sums, `fSpec` [m2] and `den` [m2/Hz]. The bands are those of `den`: from half way to half way
between neighbours, and not beyond the outermost frequencies.

Source: the sample file of the wavespectra package (MIT); the spectra must reproduce the sums in the
file.
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
from fftocean.readers.reader import Head, Reader

if TYPE_CHECKING:
    from xarray import Dataset

_MOST: Final = 10_000  # frequencies, directions; times
_LAST: Final = ("fspec", "den")


def recognises(head: Head) -> bool:
    """Return True if the second and third line are those of an Octopus file."""
    lines = head.lines
    return len(lines) > 3 and lines[1].startswith("nfreqs,") and lines[2].startswith("ndir,")


class _Rows:
    """Iterator over the lines of the file as cells, without empty lines."""

    def __init__(self, path: Path) -> None:
        self.name = path.name
        self.where = path.name
        self._lines: Iterator[tuple[str, str]] = bounded_reads.lines(path, blank=True)

    def maybe(self) -> list[str] | None:
        for where, line in self._lines:
            self.where = where
            return [cell.strip() for cell in line.rstrip(",").split(",")]
        return None

    def next(self, wanted: str) -> list[str]:
        cells = self.maybe()
        if cells is None:
            raise ReaderError(f"{self.name} ends where {wanted} must follow: the file is cut short")
        return cells

    def keyed(self, key: str, wanted: str) -> list[str]:
        """Return the cells after a line's first one, which must be `key`."""
        cells = self.next(wanted)
        if cells[0].lower() != key.lower():
            raise ReaderError(f"{self.where} must begin with {key}, got {cells[0]!r:.40}")
        if len(cells) < 2:
            raise ReaderError(f"{self.where} must hold a value after {key}")
        return cells[1:]

    def number(self, key: str) -> float:
        cells = self.keyed(key, key)
        return bounded_reads.number(self.where, cells[0])

    def count(self, key: str) -> int:
        cells = self.keyed(key, key)
        return bounded_reads.count(self.where, cells[0] or "nothing", _MOST)

    def numbers(self, cells: list[str], count: int) -> list[float]:
        """Return the first `count` cells as numbers, ignoring sums after them."""
        if len(cells) < count:
            raise ReaderError(f"{self.where} must hold {count} numbers, got {len(cells)}")
        return [bounded_reads.number(self.where, cell) for cell in cells[:count]]


def read(path: Path) -> "Dataset":
    """
    Read all times.

    Raises:
        ReaderError: a header, counts or axes that break the format, a table that is cut.
    """
    rows = _Rows(path)
    title = ",".join(rows.next("a title"))
    nf, nd, times = rows.count("nfreqs"), rows.count("ndir"), rows.count("nrecs")
    lat, lon, depth = (rows.number(key) for key in ("Latitude", "Longitude", "Depth"))
    if nf * nd * times > dataset_layout.MAX_VALUES:
        raise ReaderError(
            f"{path.name} must have at most {dataset_layout.MAX_VALUES} values, got more"
        )
    seconds: list[np.datetime64] = []
    tables: list[Real] = []
    heights: list[float] = []
    frequency: Real = np.empty(0)
    direction: Real = np.empty(0)
    for record in range(times):
        moment, height = _bulk(rows)
        f = np.array(rows.numbers(rows.keyed("freq", "the frequencies"), nf))
        d, table = _table(rows, nf, nd)
        for _ in _LAST:
            cells = rows.next("the sums fSpec and den")
            if cells[0].lower() not in _LAST:
                raise ReaderError(
                    f"{rows.where} must begin with fSpec or den, got {cells[0]!r:.40}"
                )
        if record and not (np.array_equal(f, frequency) and np.array_equal(d, direction)):
            raise ReaderError(f"{rows.where}: record {record + 1} must have the axes of the first")
        frequency, direction = f, d
        seconds.append(moment)
        tables.append(table)
        heights.append(height)
    if (extra := rows.maybe()) is not None:
        raise ReaderError(
            f"{rows.where} must be the end, after {times} records, got {extra[0]!r:.40}"
        )
    which, repeated = dataset_layout.in_order(np.array(seconds))
    energy, hs = np.array(tables)[which], np.array(heights)[which]
    frequency, f_order = dataset_layout.frequencies(f"{path.name}: freq", frequency)
    bearing, d_order = dataset_layout.directions(f"{path.name}: the directions", direction)
    energy = energy[:, f_order][:, :, d_order]
    edges = np.concatenate([frequency[:1], 0.5 * (frequency[1:] + frequency[:-1]), frequency[-1:]])
    step = _step(path.name, bearing)
    density, counts = dataset_layout.densities(
        path.name, energy / (np.diff(edges)[:, np.newaxis] * step), "m2/Hz/degree"
    )
    m0 = np.sum(energy, axis=(1, 2))
    return dataset_layout.dataset(
        source=path.name,
        source_format="Octopus",
        frequency=frequency,
        density=density,
        direction=bearing,
        time=np.array(seconds)[which],
        depth=np.full(which.size, depth if 0.0 < depth < 1e5 else np.nan),
        position={"lon": lon, "lat": lat},
        bands=np.stack([edges[:-1], edges[1:]], axis=1),
        notes={
            **counts,
            **dataset_layout.compare_heights(path.name, m0, hs, 0.01),
            "title": title[:200],
            "repeated_times": repeated,
            "sites": 1,
        },
    )


def _bulk(rows: _Rows) -> tuple[np.datetime64, float]:
    """Return the time and the significant wave height of a record."""
    names = [name.lower() for name in rows.next("a record")]
    if names[:2] != ["ccyymm", "ddhhmm"]:
        raise ReaderError(
            f"{rows.where} must begin with CCYYMM,DDHHmm, got {','.join(names)!r:.40}"
        )
    cells = [cell.lstrip("'") for cell in rows.next("the values of a record")]
    if len(cells) != len(names):
        raise ReaderError(f"{rows.where} must hold {len(names)} values, got {len(cells)}")
    text = "".join(cells[:2])
    if not re.fullmatch(r"[0-9]{12}", text[:12]) or len(text) not in (12, 14):
        raise ReaderError(
            f"{rows.where} must begin with a time like 201803,110000, got {text!r:.40}"
        )
    try:
        time = datetime.strptime(text[:12], "%Y%m%d%H%M")
    except ValueError as error:
        raise ReaderError(
            f"{rows.where} must begin with a time like 201803,110000 ({error})"
        ) from error
    if not 1900 <= time.year < 2200:
        raise ReaderError(f"{rows.where} must begin with a time between 1900 and 2200, got {text}")
    hs = np.nan
    if "hsig" in names:
        hs = bounded_reads.number(rows.where, cells[names.index("hsig")])
    return np.datetime64(time, "s"), float(hs)


def _table(rows: _Rows, nf: int, nd: int) -> tuple[Real, Real]:
    """Return the directions and the energies (f, d) of one record."""
    d, table = np.empty(nd), np.empty((nf, nd))
    for j in range(nd):
        cells = rows.next("the energies of a direction")
        d[j], *table[:, j] = rows.numbers(cells, nf + 1)
    return d, table


def _step(name: str, bearing: Real) -> float:
    """Return the width of the directions; raise unless they are equal and complete."""
    steps = np.diff(bearing, append=bearing[0] + 360.0)
    if np.ptp(steps) > 1e-3 * 360.0 / bearing.size:
        raise ReaderError(
            f"{name}: the directions must be equally spaced all round, got {bearing[0]:g} ..."
        )
    return 360.0 / bearing.size


def _read(path: Path, site: int, bins: int) -> "Dataset":  # noqa: ARG001
    Count("", 0, 0).check("site", site)
    return read(path)


READER: Final = Reader(
    name="Octopus",
    extensions=(".oct",),
    description="Forecasts at one place, by frequency and direction.",
    sniff=recognises,
    read=_read,
)
