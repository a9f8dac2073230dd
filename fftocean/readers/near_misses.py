"""Files often mistaken for wave spectra."""

import re
from collections.abc import Callable
from typing import Final

from fftocean.readers.reader import Head


def hint(head: Head) -> str | None:
    """Return the nature of a file and the one to open instead, or None if it is unknown."""
    return next((text for matches, text in _KNOWN if matches(head)), None)


def _begins(*magic: bytes) -> Callable[[Head], bool]:
    return lambda head: head.data.startswith(magic)


def _first(pattern: str) -> Callable[[Head], bool]:
    return lambda head: re.search(pattern, head.first_line) is not None


def _within(pattern: str) -> Callable[[Head], bool]:
    return lambda head: re.search(pattern, "\n".join(head.lines[:40])) is not None


_DATE: Final = r"^#?\s*(YY|YYYY|yr)\s+MM\s+DD\s+hh"
_KNOWN: Final[tuple[tuple[Callable[[Head], bool], str], ...]] = (
    (
        _first(_DATE + r"(\s+mm)?\s+WVHT\s+SwH"),
        "is NDBC's summary of waves (`.spec`: heights, periods and directions), which holds no "
        "spectra; "
        "the spectra are in `.data_spec` (with `.swdir .swdir2 .swr1 .swr2`), or in the archive's "
        "`...w....txt`",
    ),
    (
        _first(_DATE + r".*\b(WDIR|WD|WSPD|WVHT|PRES|BAR|ATMP|WTMP)\b"),
        "is NDBC's standard meteorological file, which holds no spectra; "
        "the spectra are in `.data_spec` (with `.swdir .swdir2 .swr1 .swr2`), or in the archive's "
        "`...w....txt`",
    ),
    (
        _begins(b"GRIB"),
        "is GRIB; convert it to netCDF (`grib_to_netcdf`, or cfgrib with xarray) and open that",
    ),
    (_begins(b"PK\x03\x04"), "is a zip archive; unpack it and open the file inside"),
    (
        _begins(b"\x28\xb5\x2f\xfd", b"BZh", b"\xfd7zXZ"),
        "is packed in a way that is not read; unpack it (gzip is read as it is)",
    ),
    (_begins(b"MATLAB 5.0"), "is a MATLAB file; save the spectra as netCDF and open that"),
    (
        _begins(b"%PDF", b"\x89PNG", b"\xff\xd8\xff"),
        "is a document or an image; the numbers are needed",
    ),
    (
        _within(r"(?i)^\s*<(!doctype html|html|\?xml)"),
        "is a web page; save the data file that it links to",
    ),
    (
        _within(r'"(frequencyData|varianceDensity)"'),
        "is a Spotter's JSON; export the records as CSV",
    ),
    (_begins(b"{", b"["), "is JSON, which is not read"),
    (
        _first(r"^\$PNOR|^\$P[A-Z]{3}"),
        "is NMEA telegrams; export the spectra as netCDF or SWAN text",
    ),
    (
        _within(r"(?m)^%\s+Run:.*Table:"),
        "is a table of SWAN (TABLE), which holds no spectra; write them with SPECOUT",
    ),
    (
        _first(r"Epoch Time.*Significant Wave Height"),
        "is a Spotter's CSV without spectra; export it with the spectral data",
    ),
)
