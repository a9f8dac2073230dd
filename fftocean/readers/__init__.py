"""Measured and modelled wave spectra, out of the files in which they come, into one layout and on into a `Sea`."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import files, layout, ndbc, netcdf, swan
from fftocean.readers.realise import Realised, sea_from_spectrum

if TYPE_CHECKING:
    from xarray import Dataset

__all__ = ["Realised", "open", "sea_from_spectrum"]

BINS = Count("", 8, 720)


def open(path: str | os.PathLike[str], *, site: int = 0, bins: int = 72) -> "Dataset":
    """
    Read the wave spectra of one place from a file of any known format, recognised by what is in it, plain or gzip.

    Known are: NDBC realtime sets (`41010.data_spec` with its four files of directions beside it) and historical S(f) text, SWAN 2-D
    ASCII, and netCDF as WAVEWATCH III, ERA5 (2-D wave spectra) and the wavespectra package write it.

    Args:
        path: the file.
        site: which place, from 0, where the file holds several; a grid is counted row by row.
        bins: directions round the compass, for buoys, which report Fourier moments and not directions.

    Returns:
        An xarray.Dataset with `efth` (time, freq, dir) [m2/Hz/degree], `freq` [Hz] ascending and `dir` [degrees] where waves come
        FROM, clockwise from north; without directions `ef` (time, freq) [m2/Hz]. `dpt` (time) is the depth [m] where it is known.
        Missing values are NaN and counted in the attributes. `layout.py` has it in full.

    Raises:
        ReaderError: whatever is wrong with the file: the message names it, the line or variable, and the value.
        ParameterError: `site` or `bins` out of range.
    """
    bins = BINS.check_whole("bins", bins)
    if not isinstance(path, (str, os.PathLike)):
        raise ReaderError(f"the spectrum must be the name of a file, got {path!r:.60} ({type(path).__name__})")
    path = Path(os.fsdecode(path))
    files.require_file(path)
    magic = files.head(path, 4096)
    if netcdf.recognises(magic):
        return layout.announce(netcdf.read(path, site=site))
    first_line = magic.split(b"\n", 1)[0].decode("utf-8", "replace").strip()
    if swan.recognises(first_line):
        return _ended(path, swan.read(path, site=site))
    if ndbc.recognises(first_line):
        Count("", 0, 0).check_whole("site", site)
        return _ended(path, ndbc.read(path, bins=bins))
    for _ in files.lines(path):  # cut, binary, or one endless line? Then say so
        break
    raise ReaderError(f"{path.name} must be NDBC, SWAN or netCDF wave spectra, got {first_line!r:.40} first")


def _ended(path: Path, made: "Dataset") -> "Dataset":
    """Say in the attributes which of the text files that were read lack their final newline."""
    if cut := [other.name for other in ndbc.files_of(path) if not files.has_final_newline(other)]:
        made.attrs["unterminated"] = f"{', '.join(cut)}: the last line has no end, and was taken as whole"
    return made
