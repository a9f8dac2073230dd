"""
Transfer files of WAVEWATCH III's point output (ww3_outp, type 1): spectra as formatted text.

    'WAVEWATCH III SPECTRA'     25    24     1 'title'    counts: frequencies, directions, points
    frequencies [Hz]; directions [radians] TO, clockwise from north
    19680606 000000
    'name      '  lat lon depth U10 direction, current direction
    densities [m2/Hz/rad], the frequency fastest

Numbers have fixed columns and may touch (`33.62-118.32`); exponents beyond 99 have no letter
(`0.123-100`).

Source: WAVEWATCH III manual, "Point output post-processor"; program ww3_outp, formats 901 to 946.
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

_MOST: Final = 10_000  # frequencies, directions, points
_TITLE: Final = re.compile(
    r"'WAVEWATCH III SPECTRA'\s*(\d{1,6})\s+(\d{1,6})\s+(\d{1,6})\b.*", re.IGNORECASE
)
_TIME: Final = re.compile(r"(\d{8})\s+(\d{1,6})")
_POINT: Final = re.compile(r"'([^']*)'(.*)")
_PLAIN: Final = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
_NUMBER: Final = re.compile(r"[+-]?\d?\.\d+[+-]\d{3}(?![\d.])|" + _PLAIN.pattern)


def recognises(head: Head) -> bool:
    """Return True if the first line is that of a transfer file."""
    return head.first_line.upper().startswith("'WAVEWATCH III SPECTRA'")


class _Lines:
    """Iterator over the lines of the file, with the place of the last one."""

    def __init__(self, path: Path) -> None:
        self.name = path.name
        self.where = path.name
        self._lines: Iterator[tuple[str, str]] = bounded_reads.lines(path)

    def maybe(self) -> str | None:
        for where, line in self._lines:
            self.where = where
            return line
        return None

    def next(self, wanted: str) -> str:
        line = self.maybe()
        if line is None:
            raise ReaderError(f"{self.name} ends where {wanted} must follow: the file is cut short")
        return line

    def numbers(self, count: int, wanted: str) -> Real:
        """Return the next `count` numbers, over as many lines as they take."""
        found: list[float] = []
        while len(found) < count:
            found += self.split(self.next(wanted))
        if len(found) > count:
            raise ReaderError(f"{self.where}: there must be {count} {wanted}, got {len(found)}")
        return np.array(found)

    def split(self, line: str, number: re.Pattern[str] = _NUMBER) -> list[float]:
        """Return the numbers of a line, which may touch."""
        rest = number.sub("", line)
        if rest.strip():
            raise ReaderError(f"{self.where} must hold numbers only, got {rest.split()[0]!r:.40}")
        return [_value(match[0]) for match in number.finditer(line)]


def _value(token: str) -> float:
    """Return a number as Fortran writes it."""
    token = re.sub("[dD]", "e", token)
    if "e" not in token.lower() and (match := re.fullmatch(r"(.+)([+-]\d{3})", token)):
        token = f"{match[1]}e{match[2]}"
    return float(token)


def read(path: Path, *, site: int) -> "Dataset":
    """
    Read the spectra of one point.

    Args:
        path: the file.
        site: index of the point, from 0.

    Raises:
        ReaderError: counts that do not agree, a point that is not the same at all times, a file
            that is cut.
        ParameterError: `site` is not in the file.
    """
    lines = _Lines(path)
    match = _TITLE.fullmatch(lines.next("a title"))
    if not match:
        raise ReaderError(f"{lines.where} must be 'WAVEWATCH III SPECTRA' and three counts")
    nf, nd, points = (int(text) for text in match.groups())
    if not (2 <= nf <= _MOST and 4 <= nd <= _MOST and 1 <= points <= _MOST):
        raise ReaderError(
            f"{lines.where} must count 2 to {_MOST} frequencies, 4 to {_MOST} directions and 1 to "
            f"{_MOST} points, got {nf}, {nd} and {points}"
        )
    site = Count("", 0, points - 1).check("site", site)
    frequency, f_order = dataset_layout.frequencies(
        f"{path.name}: the frequencies", lines.numbers(nf, "frequencies")
    )
    toward = lines.numbers(nd, "directions")
    if np.max(np.abs(toward)) > 2.0 * np.pi + 0.01:
        raise ReaderError(f"{path.name}: the directions must be in radians, got {np.max(toward):g}")
    bearing: Real = np.mod(np.degrees(toward), 360.0) + 180.0
    if nd > 36 or np.ptp(np.diff(np.sort(np.mod(bearing, 360.0)))) > 0.0:
        bearing = _even(bearing)
    direction, d_order = dataset_layout.directions(f"{path.name}: the directions", bearing)
    time: list[np.datetime64] = []
    tables: list[Real] = []
    depths: list[float] = []
    place: tuple[str, float, float] | None = None
    line = lines.maybe()
    while line is not None:
        moment = _time(lines.where, line)
        for point in range(points):
            line = lines.next("the name of a point")
            if point and _TIME.fullmatch(line) and _time(lines.where, line) == moment:
                line = lines.next("the name of a point")  # a time before each point
            name, numbers = _point(lines, line)
            block = lines.numbers(nf * nd, "densities")
            if point != site:
                continue
            here = (name, numbers[0], numbers[1])
            if place is not None and here[0] != place[0]:
                raise ReaderError(
                    f"{lines.where}: point {site} must be {place[0]!r} at all times, got {name!r}"
                )
            place = place or here
            time.append(moment)
            depths.append(numbers[2])
            tables.append(block.reshape(nd, nf).T)
        if len(tables) * nf * nd > dataset_layout.MAX_VALUES:
            raise ReaderError(
                f"{lines.where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
        line = lines.maybe()
    if place is None:
        raise ReaderError(f"{path.name} must hold at least one time after its header, got none")
    which, repeated = dataset_layout.in_order(np.array(time))
    values = np.array(tables)[which][:, f_order][:, :, d_order] * (np.pi / 180.0)
    density, counts = dataset_layout.densities(path.name, values, "m2/Hz/degree")
    depth = np.array(depths)[which]
    return dataset_layout.dataset(
        source=path.name,
        source_format="WAVEWATCH III transfer file",
        frequency=frequency,
        density=density,
        direction=direction,
        time=np.array(time)[which],
        depth=np.where((depth > 0.0) & (depth < 1e5), depth, np.nan),
        position={"lon": place[2], "lat": place[1]},
        notes={
            **counts,
            "site": site,
            "sites": points,
            "station": place[0],
            "repeated_times": repeated,
        },
    )


def _even(bearing: Real) -> Real:
    """Return equally spaced directions if they agree with these, given to three digits."""
    step = 360.0 / bearing.size
    start = bearing[0]
    turn = 1.0 if np.mod(bearing[1] - start, 360.0) < 180.0 else -1.0
    even = start + turn * step * np.arange(bearing.size)
    off = np.mod(bearing - even + 180.0, 360.0) - 180.0
    # 0.628E+01 is good to 0.005 rad = 0.29 degrees, the first one too.
    return even + np.mean(off) if np.max(np.abs(off - np.mean(off))) < 0.6 else bearing


def _time(where: str, line: str) -> np.datetime64:
    match = _TIME.fullmatch(line)
    if match:
        try:
            time = datetime.strptime(match[1] + match[2].zfill(6), "%Y%m%d%H%M%S")
        except ValueError:
            match = None
    if not match or not 1900 <= time.year < 2200:
        raise ReaderError(f"{where} must be a time like 20220912 060000, got {line!r:.40}")
    return np.datetime64(time, "s")


def _point(lines: _Lines, line: str) -> tuple[str, list[float]]:
    """Return a point's name, and its numbers: latitude, longitude, depth, and others."""
    match = _POINT.fullmatch(line)
    if not match:
        raise ReaderError(
            f"{lines.where} must be a point ('name' lat lon depth ...), got {line!r:.40}"
        )
    numbers = lines.split(match[2], _PLAIN)
    if len(numbers) < 3:
        raise ReaderError(f"{lines.where} must hold latitude, longitude and depth of a point")
    return match[1].strip(), numbers


READER: Final = Reader(
    name="WAVEWATCH III transfer file",
    extensions=(".spec", ".spc"),
    description="Point output of ww3_outp as text: 2-D spectra of one or more points.",
    sniff=recognises,
    read=lambda path, site, bins: read(path, site=site),  # noqa: ARG005
)
