"""
Spectra of TRIAXYS buoys: DIRSPEC and NONDIRSPEC files.

The first hold a table by frequency and direction, the second two columns. A header of `KEY = VALUE`
lines gives counts, first frequency and spacings. Directions are where waves come FROM, clockwise
from north; the file does not tell true from magnetic north, which depends on the set-up of the
buoy. The table's last column, 360 degrees, repeats its first.

Source: AXYS Technologies, TRIAXYS Directional Wave Buoy User's Manual, "Output file formats".
"""

import re
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bounded_reads, dataset_layout
from fftocean.readers.reader import Head, Reader

if TYPE_CHECKING:
    from xarray import Dataset

_MOST: Final = 100_000  # frequencies or directions
_POSITION: Final = re.compile(r"(\d{2})(\d{2}\.\d+)([NS])\s*(\d{2,3})(\d{2}\.\d+)([EW])")
_REPEATED: Final = 1e-5  # largest difference of the columns of 0 and 360 degrees / largest density


def recognises(head: Head) -> bool:
    """Return True if the first line is that of a TRIAXYS report."""
    return re.match(r"TRIAXYS BUOY (DATA )?REPORT", head.first_line) is not None


def read(path: Path) -> "Dataset":
    """
    Read one spectrum.

    Raises:
        ReaderError: a report of another type, keys that are missing, or counts that do not agree.
    """
    rows = bounded_reads.lines(path)
    where, title = next(rows)
    keys: dict[str, tuple[str, str]] = {}
    table: list[list[float]] = []
    nf = 0
    for where, line in rows:
        if "=" in line and not table:
            key, _, value = line.partition("=")
            keys[" ".join(key.split()).upper()] = (where, value.strip())
        else:
            nf = nf or _count(path.name, keys, "NUMBER OF FREQUENCIES")
            table.append(
                [bounded_reads.number(where, token) for token in line.replace(",", " ").split()]
            )
            if len(table) > nf:
                raise ReaderError(f"{where} must be the end, after {nf} rows, got more")
            if len(table) * len(table[0]) > dataset_layout.MAX_VALUES:
                raise ReaderError(
                    f"{where} must have at most {dataset_layout.MAX_VALUES} values, got more"
                )
            if len(table[-1]) != len(table[0]):
                raise ReaderError(
                    f"{where} must hold {len(table[0])} numbers, got {len(table[-1])}"
                )
    kind = _value(path.name, keys, "TYPE")[1].upper()
    if kind not in ("DIRECTIONAL SPECTRUM", "NON-DIRECTIONAL SPECTRUM"):
        raise ReaderError(
            f"{path.name} must be a DIRECTIONAL or NON-DIRECTIONAL SPECTRUM, got TYPE {kind!r:.40}"
        )
    nf = nf or _count(path.name, keys, "NUMBER OF FREQUENCIES")
    if len(table) != nf:
        raise ReaderError(f"{path.name} must hold {nf} rows, got {len(table)}: is it cut?")
    spacing = _number(path.name, keys, "FREQUENCY SPACING (HZ)")
    first = _number(path.name, keys, "INITIAL FREQUENCY (HZ)")
    f = np.round(first + spacing * np.arange(nf), 9)
    values = np.array(table)
    direction = None
    if kind.startswith("NON"):
        values = _column(path.name, values, f, spacing)
    else:
        values, direction = _directed(path.name, keys, values)
    kept, notes = dataset_layout.above_zero(f)
    frequency, order = dataset_layout.frequencies(f"{path.name}: the frequencies", f[kept])
    values = values[np.newaxis, kept][:, order]
    unit = "m2/Hz" if direction is None else "m2/Hz/degree"
    density, counts = dataset_layout.densities(path.name, values, unit)
    if direction is not None:
        direction, d_order = dataset_layout.directions(f"{path.name}: the directions", direction)
        density = density[:, :, d_order]
        notes = {**notes, "direction_reference": "true or magnetic north, as the buoy was set up"}
    return dataset_layout.dataset(
        source=path.name,
        source_format=f"TRIAXYS {'NONDIRSPEC' if direction is None else 'DIRSPEC'}",
        frequency=frequency,
        density=density,
        direction=direction,
        time=np.array([_time(*_value(path.name, keys, "DATE"))], dtype="datetime64[s]"),
        position=_position(title),
        bands=np.stack([frequency - 0.5 * spacing, frequency + 0.5 * spacing], axis=1),
        notes={**counts, **notes, "sites": 1},
    )


def _directed(name: str, keys: dict[str, tuple[str, str]], values: Real) -> tuple[Real, Real]:
    """Return the table without its repeated last column, and the directions."""
    count = _count(name, keys, "NUMBER OF DIRECTIONS")
    step = _number(name, keys, "DIRECTION SPACING (DEG)")
    where, text = _value(name, keys, "COLUMNS")
    match = re.match(r"(\S+)\s+TO\s+(\S+)\s+DEG", text, re.IGNORECASE)
    if not match:
        raise ReaderError(f"{where}: COLUMNS must be like 0.00 TO 360.00 DEG, got {text!r:.40}")
    start, end = (bounded_reads.number(where, match[i]) for i in (1, 2))
    if count < 5 or abs(start + step * (count - 1) - end) > 1e-3 * max(abs(step), 1e-6):
        raise ReaderError(
            f"{where}: COLUMNS must be {count} directions {step:g} degrees apart, got {text!r:.40}"
        )
    if values.shape[1] != count:
        raise ReaderError(
            f"{name} must hold {count} columns, its NUMBER OF DIRECTIONS, got {values.shape[1]}"
        )
    direction = start + step * np.arange(count)
    if abs(abs(direction[-1] - direction[0]) - 360.0) < 1e-3:
        if np.max(np.abs(values[:, 0] - values[:, -1])) > _REPEATED * np.max(
            np.abs(values), initial=1e-6
        ):
            raise ReaderError(
                f"{name}: columns {direction[0]:g} and {direction[-1]:g} degrees must be equal"
            )
        values, direction = values[:, :-1], direction[:-1]
    return values, direction


def _column(name: str, values: Real, f: Real, spacing: float) -> Real:
    """Return the densities of a table of frequency and density."""
    if values.shape[1] != 2:
        raise ReaderError(
            f"{name} must hold 2 columns, frequency and density, got {values.shape[1]}"
        )
    apart = np.abs(values[:, 0] - f)
    if np.max(apart) > 0.1 * abs(spacing):
        i = int(np.argmax(apart > 0.1 * abs(spacing)))
        raise ReaderError(f"{name}: row {i + 1} must be at {f[i]:g} Hz, got {values[i, 0]:g}")
    return values[:, 1]


def _value(name: str, keys: dict[str, tuple[str, str]], key: str) -> tuple[str, str]:
    if key not in keys:
        raise ReaderError(
            f"{name} must state {key} in its header, got {', '.join(keys) or 'nothing'!s:.200}"
        )
    return keys[key]


def _number(name: str, keys: dict[str, tuple[str, str]], key: str) -> float:
    where, text = _value(name, keys, key)
    return bounded_reads.number(f"{where}: {key}", text)


def _count(name: str, keys: dict[str, tuple[str, str]], key: str) -> int:
    where, text = _value(name, keys, key)
    if not text:
        raise ReaderError(f"{where}: {key} must be a whole number, got nothing")
    return bounded_reads.count(f"{where}: {key}", text, _MOST)


def _time(where: str, text: str) -> datetime:
    stripped = re.sub(r"\(.*?\)|UTC|GMT|Z$", "", text).strip()
    for form in ("%Y-%m-%d %H:%M", "%Y-%m-%d %H:%M:%S"):
        try:
            return datetime.strptime(stripped, form)
        except ValueError:
            continue
    raise ReaderError(f"{where}: DATE must be like 2018-01-31 21:00(UTC), got {text!r:.40}")


def _position(title: str) -> dict[str, Any]:
    """Return the position that a first line may hold, as `4857.6668S16631.6837W`."""
    if not (match := _POSITION.search(title)):
        return {}
    lat = int(match[1]) + float(match[2]) / 60.0
    lon = int(match[4]) + float(match[5]) / 60.0
    return {"lon": -lon if match[6] == "W" else lon, "lat": -lat if match[3] == "S" else lat}


def _read(path: Path, site: int, bins: int) -> "Dataset":  # noqa: ARG001
    Count("", 0, 0).check("site", site)
    return read(path)


READER: Final = Reader(
    name="TRIAXYS DIRSPEC and NONDIRSPEC",
    extensions=(".DIRSPEC", ".NONDIRSPEC"),
    description="One spectrum of a TRIAXYS buoy, by frequency and direction or by frequency alone.",
    sniff=recognises,
    read=_read,
)
