"""
Spectrum files of SWAN: ASCII, one block of integers and a factor for each time and place.

Source: SWAN User Manual, appendix "Spectrum files, input and output" (format version 1).
"""

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.readers import bounded_reads, dataset_layout
from fftocean.readers.reader import Reader
from fftocean.readers.swan_lines import (
    ENERGY,
    MOST,
    Lines,
    number_of_quantities,
    read_blocks,
    read_header,
    recognises,
    site_of,
)

if TYPE_CHECKING:
    from xarray import Dataset


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
    lines = Lines(path)
    header = read_header(lines)
    site = site_of(header, site)
    frequency, f_order = dataset_layout.frequencies(header.frequency_name, header.frequency)
    keyword = lines.next("NDIR or CDIR").split()[0]
    if keyword not in ("NDIR", "CDIR"):
        one = " (a 1-D file: it has no directions to read)" if keyword == "QUANT" else ""
        raise ReaderError(f"{lines.where} must be NDIR or CDIR, got {keyword!r:.40}{one}")
    bearings = lines.table("directions", 1)[:, 0]
    if keyword == "CDIR":
        bearings = 270.0 - bearings  # toward, counter-clockwise from x, assumed to point east
        bearings = np.where(np.abs(bearings) > 360.0, np.mod(bearings, 360.0), bearings)
    direction, d_order = dataset_layout.directions(f"{lines.name}: {keyword}", bearings)
    if frequency.size * direction.size > MOST:
        raise ReaderError(
            f"{lines.name} must have at most {MOST} frequencies times directions, "
            f"got {frequency.size} by {direction.size}"
        )
    per_degree, fill = _quantity(lines)

    shape = (frequency.size, direction.size)
    blocks, time = read_blocks(
        lines,
        header,
        site,
        lambda line, place: _block(lines, line, shape, fill, wanted=place == site),
        first_words="FACTOR, ZERO or NODATA",
        values=frequency.size * direction.size,
    )
    values = blocks[:, f_order][:, :, d_order] * per_degree
    density, counts = dataset_layout.densities(lines.name, values, "m2/Hz/degree")
    return dataset_layout.dataset(
        source=lines.name,
        source_format="SWAN 2-D ASCII",
        frequency=frequency,
        density=density,
        direction=direction,
        time=time,
        position=dict(zip(header.axes, header.places[site].tolist(), strict=True)),
        notes={**counts, "site": site, "sites": len(header.places)},
    )


def _quantity(lines: Lines) -> tuple[float, float]:
    """Return the factor from the file's unit to m2/Hz/degree, and the number for "missing"."""
    if number_of_quantities(lines, 3) != 1:
        raise ReaderError(f"{lines.where}: a 2-D file must hold 1 quantity, got more")
    quantity = lines.next("VaDens or EnDens").split()[0]
    unit = lines.next("the unit").split()[0]
    known = {("VaDens", "m2/Hz/degr"): 1.0, ("EnDens", "J/m2/Hz/degr"): 1.0 / ENERGY}
    if (quantity, unit) not in known:
        raise ReaderError(
            f"{lines.where}: the quantity must be VaDens in m2/Hz/degr or EnDens in "
            f"J/m2/Hz/degr, got {quantity} in {unit}"
        )
    return known[quantity, unit], bounded_reads.number(
        lines.where, lines.next("the exception value").split()[0]
    )


def _block(
    lines: Lines, keyword: str, shape: tuple[int, int], fill: float, *, wanted: bool
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


READER: Final = Reader(
    name="SWAN 2-D ASCII",
    extensions=(".spec", ".sp2", ".spc"),
    description="Spectra by frequency and direction, of one or more places.",
    sniff=lambda head: recognises(head.first_line),
    read=lambda path, site, bins: read(path, site=site),  # noqa: ARG005
)
