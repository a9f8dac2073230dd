"""
CSV files of Sofar's Spotter buoys: one record a line, one column for each number of the spectrum.

The reader uses `Epoch Time` [s since 1970], `Latitude`, `Longitude`, and by frequency `f_i` and
`df_i` [Hz], `varianceDensity_i` [m2/Hz], and the moments `a1_i b1_i a2_i b2_i` of the directions
TO, counter-clockwise from east; without those `direction_i` (FROM, clockwise from north) and
`directionalSpread_i` [degrees]. A line has its own `Significant Wave Height`, the sum of densities
times df.

Source: Sofar Ocean, Spotter Technical Reference Manual, "Directional wave spectra".
"""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Complex, Real
from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bands, bounded_reads, dataset_layout, moments
from fftocean.readers.reader import Head, Reader

if TYPE_CHECKING:
    from xarray import Dataset

_MISSING: Final = ("", "-", "nan", "NaN", "NAN", "null", "None")
_BY_FREQUENCY: Final = (
    "f",
    "df",
    "varianceDensity",
    "a1",
    "b1",
    "a2",
    "b2",
    "direction",
    "directionalSpread",
)
_ONCE: Final = {
    "time": "Epoch Time",
    "lat": "Latitude",
    "lon": "Longitude",
    "hs": "Significant Wave Height",
}
_LATEST: Final = 7.2581184e9  # the year 2200 [s since 1970]
_APART: Final = 1.0  # largest difference of `direction` from that of the moments [degrees]


def recognises(head: Head) -> bool:
    """Return True if the first line names a Spotter's columns."""
    first = head.first_line
    return (
        "Epoch Time" in first
        and "," in first
        and re.search(r"\bvarianceDensity_0\b|\bf_0\b", first) is not None
    )


def read(path: Path, *, bins: int) -> "Dataset":
    """
    Read all records.

    Args:
        path: the file.
        bins: directions round the compass into which the moments are unfolded.

    Raises:
        ReaderError: columns that are missing, lines without their numbers, frequencies that change,
            or directions that do not agree with the moments.
    """
    columns, records = _records(path, bins)
    f = records["f"]
    if not np.all(f == f[0]):
        line = int(np.flatnonzero(np.any(f != f[0], axis=1))[0]) + 2
        raise ReaderError(
            f"{path.name}: line {line} must have the frequencies of line 2, got others"
        )
    time = records["time"][:, 0]
    wrong = ~((time > 0.0) & (time < _LATEST))
    if np.any(wrong):
        raise ReaderError(
            f"{path.name}: Epoch Time must be seconds since 1970, got {time[wrong][0]}"
        )
    which, repeated = dataset_layout.in_order(np.rint(time))
    records = {name: values[which] for name, values in records.items()}
    frequency, order = dataset_layout.frequencies(f"{path.name}: f", f[0])
    density, counts = dataset_layout.densities(
        f"{path.name}: varianceDensity", records["varianceDensity"][:, order], "m2/Hz"
    )
    notes: dict[str, Any] = {**counts, "repeated_times": repeated, "sites": 1}
    edges = None
    width = np.gradient(frequency)
    if "df" in columns:
        width = records["df"][0, order]
        if not np.all(records["df"] == records["df"][0]):
            raise ReaderError(f"{path.name}: df must be the same in all lines, got others")
        edges = bands.of_widths(f"{path.name}: df", frequency, width)
    if "hs" in columns:
        notes |= dataset_layout.compare_heights(
            path.name, np.nansum(density * width, axis=1), records["hs"][:, 0], 5e-4
        )
    c1, c2 = _moments(path.name, columns, records)
    direction = None
    if c1 is not None and c2 is not None:
        density, done = moments.unfold(density, c1[:, order], c2[:, order], bins)
        direction = moments.compass(bins)
        notes |= done
    return dataset_layout.dataset(
        source=path.name,
        source_format="Sofar Spotter CSV",
        frequency=frequency,
        density=density,
        direction=direction,
        time=np.rint(records["time"][:, 0]).astype("int64").astype("datetime64[s]"),
        position={
            key: float(records[key][0, 0])
            for key in ("lon", "lat")
            if key in columns and np.isfinite(records[key][0, 0])
        },
        bands=edges,
        notes=notes,
    )


def _moments(
    name: str, columns: dict[str, list[int]], records: dict[str, Real]
) -> tuple[Complex, Complex] | tuple[None, None]:
    """Return both moments of the directions FROM, clockwise from north, from either form."""
    has = {word for word in _BY_FREQUENCY if word in columns}
    if {"a1", "b1"} <= has:
        toward = records["a1"] + 1j * records["b1"]
        c1 = np.asarray(
            np.exp(1.5j * np.pi) * np.conj(toward), dtype=np.complex128
        )  # from = 270 - toward
        c2: Complex = np.full_like(c1, np.nan)
        if {"a2", "b2"} <= has:
            c2 = np.asarray(-np.conj(records["a2"] + 1j * records["b2"]), dtype=np.complex128)
        if "direction" in has:
            said = np.degrees(np.angle(c1 * np.exp(-1j * np.radians(records["direction"]))))
            wrong = (np.abs(said) > _APART) & (np.abs(c1) > 0.05)
            if np.any(wrong):
                i, j = np.argwhere(wrong)[0]
                raise ReaderError(
                    f"{name}: direction_{j} of record {i} must be 270 - atan2(b1, a1) degrees, "
                    f"got {records['direction'][i, j]:g} against "
                    f"{np.degrees(np.angle(c1[i, j])) % 360.0:.6g}"
                )
        return c1, c2
    if {"direction", "directionalSpread"} <= has:
        first = moments.from_spread(records["direction"], records["directionalSpread"])
        return first, np.full_like(first, np.nan)
    return None, None


def _records(path: Path, bins: int) -> tuple[dict[str, list[int]], dict[str, Real]]:
    """Return the column numbers by name, and the values of each by record."""
    rows = bounded_reads.lines(path)
    where, header = next(rows)
    names = [re.sub(r"\(.*", "", name).strip().lstrip("\ufeff") for name in header.split(",")]
    columns = _columns(where, names)
    count = len(columns["f"])
    records: list[list[float]] = []
    wanted = [i for indices in columns.values() for i in indices]
    for where, line in rows:
        cells = [cell.strip() for cell in line.split(",")]
        if len(cells) != len(names):
            raise ReaderError(
                f"{where} must hold {len(names)} cells, as line 1 does, got {len(cells)}"
            )
        records.append(
            [
                np.nan
                if cells[i] in _MISSING
                else bounded_reads.number(f"{where}, column {names[i]},", cells[i])
                for i in wanted
            ]
        )
        if len(records) * count * bins > dataset_layout.MAX_VALUES:
            raise ReaderError(
                f"{where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
    if not records:
        raise ReaderError(f"{path.name} must hold at least one record after its header, got none")
    table, made, at = np.array(records), {}, 0
    for name, indices in columns.items():
        made[name] = table[:, at : at + len(indices)]
        at += len(indices)
    return columns, made


def _columns(where: str, names: list[str]) -> dict[str, list[int]]:
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ReaderError(f"{where} must name each column once, got {twice!r:.40} twice")
    place = {name: i for i, name in enumerate(names)}
    columns = {key: [place[word]] for key, word in _ONCE.items() if word in place}
    for word in _BY_FREQUENCY:
        indices: list[int] = []
        while f"{word}_{len(indices)}" in place:
            indices.append(place[f"{word}_{len(indices)}"])
        if indices:
            columns[word] = indices
    for key, word in (
        ("time", "Epoch Time"),
        ("f", "f_0"),
        ("varianceDensity", "varianceDensity_0"),
    ):
        if key not in columns:
            raise ReaderError(f"{where} must name a column {word}, got {', '.join(names)!r:.60}")
    for word in _BY_FREQUENCY:
        if word in columns and len(columns[word]) != len(columns["f"]):
            raise ReaderError(
                f"{where} must name as many {word}_i as f_i, got {len(columns[word])}"
            )
    return columns


def _read(path: Path, site: int, bins: int) -> "Dataset":
    Count("", 0, 0).check("site", site)
    return read(path, bins=bins)


READER: Final = Reader(
    name="Sofar Spotter CSV",
    extensions=(".csv",),
    description="Records of a Spotter buoy, with moments of the directions.",
    sniff=recognises,
    read=_read,
)
