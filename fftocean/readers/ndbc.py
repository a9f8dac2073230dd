"""
Text files of the US National Data Buoy Center (NDBC).

Realtime (the last 45 days): a set of five files, `.data_spec` with S(f) and
`.swdir .swdir2 .swr1 .swr2` with the mean directions a1, a2 and the coherences r1, r2 of
    D = (1/pi) (1/2 + r1 cos(theta - a1) + r2 cos 2(theta - a2)),
directions FROM, clockwise from north. That truncated series becomes negative, so the two
moments are unfolded by maximum entropy instead (`maximum_entropy.py`).
Historical (the yearly archive): S(f) alone.

Source: NDBC, Measurement Descriptions and Units; Earle, NDBC Technical Document 96-01 (1996).
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Complex, Integer, Real
from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bounded_reads, dataset_layout, near_misses
from fftocean.readers.moments import compass, unfold
from fftocean.readers.reader import Reader

if TYPE_CHECKING:
    from xarray import Dataset


@dataclass(frozen=True, slots=True)
class _Column:
    """
    Column of one file of a set: its name in the header, range, and the numbers for "missing".
    """

    word: str
    unit: str
    high: float
    fills: tuple[float, ...]


# 99 is a valid direction, but no coherence; a density of exactly 99 is a fill value, not a storm.
_KINDS: Final = {
    ".data_spec": _Column("spec_1", "m2/Hz", 360.0 * dataset_layout.LARGEST, (99.0, 999.0, 9999.0)),
    ".swdir": _Column("alpha1_1", "degrees", 360.0, (999.0, 9999.0)),
    ".swdir2": _Column("alpha2_1", "degrees", 360.0, (999.0, 9999.0)),
    ".swr1": _Column(
        "r1_1", "", 1.1, (99.0, 999.0, 9999.0)
    ),  # noise exceeds 1; `maximum_entropy` reduces it
    ".swr2": _Column("r2_1", "", 1.1, (99.0, 999.0, 9999.0)),
}
_DATE: Final = re.compile(r"#?\s*(YY|YYYY|yr)\s+MM\s+DD\s+hh(\s+mm)?\s+(.*)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class _Table:
    """Records of one file by time."""

    name: str
    frequency: Real  # (f,) as in the file [Hz]
    time: Integer  # (t,) ascending, seconds since 1970
    values: Real  # (t, f), NaN where missing
    repeated: int  # number of records left out because of a repeated time


def recognises(first_line: str) -> bool:
    """Return True if a text file with this first line is NDBC's."""
    return _DATE.match(first_line) is not None


def read(path: Path, *, bins: int) -> "Dataset":
    """
    Read a realtime set, named by any one of its files, or a historical S(f) file.

    Args:
        path: the file; the other four of a set lie beside it, plain or as .gz.
        bins: directions round the compass into which the moments are unfolded.

    Raises:
        ReaderError: a file of another kind, a set with a file missing, or broken lines.
    """
    path = _set_of(path)
    _, header = next(bounded_reads.lines(path))
    realtime = any(column.word in header for column in _KINDS.values())
    if not realtime:
        return _read_historical(path)
    stem = path.name.removesuffix(".gz").rpartition(".")[0] or path.name
    spectrum = _table(
        path, _KINDS[".data_spec"], hint=f"; open {stem}.data_spec, the others are found beside it"
    )
    beside = {suffix: _sibling(path, stem + suffix) for suffix in list(_KINDS)[1:]}
    there = [suffix for suffix, other in beside.items() if other]
    if not there:
        return _undirected(spectrum, "NDBC realtime text, without directions")
    if len(there) < len(beside):
        absent = ", ".join(stem + suffix for suffix in beside if suffix not in there)
        raise ReaderError(
            f"{path.name} must have all four files of directions beside it, "
            f"or none; missing: {absent}"
        )
    moments = [_table(other, _KINDS[suffix]) for suffix, other in beside.items() if other]
    return _directed(spectrum, moments, bins)


def set_of(name: str) -> str | None:
    """
    Return the name of the `.data_spec` of a set from the name of any of its files, else None.
    """
    stem, dot, suffix = name.removesuffix(".gz").rpartition(".")
    return f"{stem}.data_spec" if stem and dot + suffix in _KINDS else None


def _set_of(path: Path) -> Path:
    """
    Return the `.data_spec` beside a file of directions or coherences, else the file itself.
    """
    name = path.name.removesuffix(".gz")
    stem, _, suffix = name.rpartition(".")
    if f".{suffix}" not in list(_KINDS)[1:] or not stem:
        return path
    found = _sibling(path, stem + ".data_spec")
    if found is None:
        raise ReaderError(
            f"{path.name} must have {stem}.data_spec beside it, "
            "which holds the densities; it is missing"
        )
    return found


def files_of(path: Path) -> list[Path]:
    """Return a file and the others of its set that exist beside it."""
    if set_of(path.name) is None:
        return [path]
    first = _set_of(path)
    stem = first.name.removesuffix(".gz").rpartition(".")[0]
    others = [_sibling(first, stem + suffix) for suffix in _KINDS]
    return [other for other in others if other]


def _sibling(path: Path, name: str) -> Path | None:
    return next(
        (p for p in (path.with_name(name), path.with_name(name + ".gz")) if p.is_file()), None
    )


def _read_historical(path: Path) -> "Dataset":
    if re.match(r"[0-9a-z]{5}[dijk][0-9]", path.name.lower()):
        raise ReaderError(
            f"{path.name} must hold densities S(f) (44004w2000.txt); by its name it holds "
            "directions or coherences"
        )
    return _undirected(_table(path, _KINDS[".data_spec"]), "NDBC historical text")


def _undirected(table: _Table, source_format: str) -> "Dataset":
    where = f"{table.name}: the header"
    frequency, order = dataset_layout.frequencies(where, table.frequency)
    density, counts = dataset_layout.densities(table.name, table.values[:, order], "m2/Hz")
    return dataset_layout.dataset(
        source=table.name,
        source_format=source_format,
        frequency=frequency,
        density=density,
        time=_datetimes(table.time),
        notes={**counts, "repeated_times": table.repeated, "sites": 1},
    )


def _directed(
    spectrum: _Table, moments: list[_Table], bins: int, source_format: str = "NDBC realtime text"
) -> "Dataset":
    frequency, order = dataset_layout.frequencies(
        f"{spectrum.name}: the frequencies", spectrum.frequency
    )
    for table in moments:
        if not np.array_equal(table.frequency, spectrum.frequency):
            raise ReaderError(
                f"{table.name} must have the frequencies of {spectrum.name}, got others"
            )
    time = spectrum.time
    for table in moments:
        time = np.intersect1d(time, table.time)
    if not time.size:
        raise ReaderError(
            f"{spectrum.name} and the files beside it must have records of the same times, got none"
        )
    s, a1, a2, r1, r2 = (
        table.values[np.searchsorted(table.time, time)][:, order] for table in (spectrum, *moments)
    )
    if s.size * bins > dataset_layout.MAX_VALUES:
        raise ReaderError(
            f"{spectrum.name} must have at most {dataset_layout.MAX_VALUES} values, "
            f"got {s.shape} by {bins} bins (ask for fewer bins)"
        )
    s, counts = dataset_layout.densities(spectrum.name, s, "m2/Hz")
    c1, c2 = _moment(r1, a1, 1), _moment(r2, a2, 2)
    density, done = unfold(s, c1, c2, bins)
    return dataset_layout.dataset(
        source=spectrum.name,
        source_format=source_format,
        frequency=frequency,
        density=density,
        direction=compass(bins),
        time=_datetimes(time),
        notes={
            **counts,
            "masked_moments": sum(
                int(np.count_nonzero(np.isnan(values))) for values in (a1, a2, r1, r2)
            ),
            **done,
            "repeated_times": spectrum.repeated,
            "unpaired_times": spectrum.time.size - time.size,
            "sites": 1,
        },
    )


def _moment(r: Real, a: Real, n: int) -> Complex:
    """Return c_n = r_n e^{i n a_n} for a_n in degrees."""
    return np.asarray(r * np.exp(1j * n * np.radians(a)), dtype=np.complex128)


def _datetimes(seconds: Integer) -> Any:
    return seconds.astype("datetime64[s]")


def _table(path: Path, column: _Column, hint: str = "") -> _Table:
    """Read one file whole."""
    rows = bounded_reads.lines(path)
    where, header = next(rows)
    match = _DATE.match(header)
    if not match:
        raise ReaderError(f"{where} must be a header (#YY  MM DD hh mm ...), got {header!r:.40}")
    date_fields = 5 if match[2] else 4
    realtime = any(c.word in match[3] for c in _KINDS.values())
    if realtime and column.word not in match[3]:
        held = next(c.word for c in _KINDS.values() if c.word in match[3])
        raise ReaderError(f"{where} must name {column.word}, got {held}{hint}")
    skip = date_fields + ("Sep_Freq" in match[3])
    head = None if realtime else [bounded_reads.number(where, token) for token in match[3].split()]
    records: dict[int, Real] = {}
    announced: list[float] = []
    repeated = 0
    for where, line in rows:
        if line.startswith("#"):
            continue
        tokens = line.split()
        seconds = _seconds(where, tokens[:date_fields], date_fields)
        values, f = (tokens[skip:], head) if head is not None else _pairs(where, tokens[skip:])
        if records and f != announced:
            raise ReaderError(f"{where} must have the frequencies of the first record, got others")
        announced = f
        if not f or len(values) != len(f):
            raise ReaderError(
                f"{where} must hold {len(f)} values after the date, got {len(values)}"
            )
        numbers = np.fromiter(_values(where, values, column), dtype=np.float64, count=len(values))
        repeated += seconds in records
        records.setdefault(seconds, numbers)
        if len(records) * len(f) > dataset_layout.MAX_VALUES:
            raise ReaderError(
                f"{where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
    if not records:
        raise ReaderError(f"{path.name} must hold at least one record after its header, got none")
    times = sorted(records)
    return _Table(
        path.name,
        np.array(announced, dtype=np.float64),
        np.array(times, dtype=np.int64),
        np.array([records[t] for t in times]),
        repeated,
    )


def _pairs(where: str, tokens: list[str]) -> tuple[list[str], list[float]]:
    """Return values and frequencies of a realtime record: `0.060 (0.063) 0.218 (0.068) ...`."""
    bracketed = tokens[1::2]
    if len(tokens) % 2 or not all(t.startswith("(") and t.endswith(")") for t in bracketed):
        raise ReaderError(
            f"{where} must hold pairs like 0.060 (0.063) after the date, "
            f"got {' '.join(tokens[-2:])!r:.40} last: is it cut?"
        )
    return tokens[0::2], [bounded_reads.number(where, token[1:-1]) for token in bracketed]


def _values(where: str, tokens: list[str], column: _Column) -> Iterator[float]:
    for token in tokens:
        value = np.nan if token == "MM" else bounded_reads.number(where, token)
        if value in column.fills:
            value = np.nan
        if value < -1e-12 or value > column.high:
            name, unit = column.word.removesuffix("_1"), f" {column.unit}" if column.unit else ""
            raise ReaderError(
                f"{where}: {name} must be between 0 and {column.high:g}{unit}, got {token}"
            )
        yield value


def _seconds(where: str, tokens: list[str], fields: int) -> int:
    """
    Return the seconds since 1970 of a date in integers.

    Two-digit years belong to the 20th century, as in files up to 1998.
    """
    if len(tokens) < fields or not all(re.fullmatch(r"[0-9]{1,4}", t) for t in tokens):
        raise ReaderError(
            f"{where} must begin with a date in {fields} whole numbers, "
            f"got {' '.join(tokens)!r:.40}"
        )
    year, *rest = (int(t) for t in tokens)
    try:
        date = datetime(year + 1900 if year < 100 else year, *rest)  # type: ignore[arg-type]
    except ValueError as error:
        raise ReaderError(
            f"{where} must begin with a date, got {' '.join(tokens)!r} ({error})"
        ) from error
    if not 1900 <= date.year < 2200:
        raise ReaderError(
            f"{where} must begin with a date between 1900 and 2200, got {' '.join(tokens)!r}"
        )
    return int((date - datetime(1970, 1, 1)).total_seconds())


def _read(path: Path, site: int, bins: int) -> "Dataset":
    Count("", 0, 0).check("site", site)
    return read(path, bins=bins)


READER: Final = Reader(
    name="NDBC text",
    extensions=(".data_spec", ".txt"),
    description="The last 45 days of a buoy (.data_spec, with .swdir .swdir2 .swr1 .swr2), "
    "or a year of S(f).",
    sniff=lambda head: recognises(head.first_line) and near_misses.hint(head) is None,
    read=_read,
    files=files_of,
)
