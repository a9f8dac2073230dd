"""
1-D spectrum files of SWAN: density, mean direction and spread of each frequency.

The header is that of a 2-D file without directions; QUANT announces VaDens (m2/Hz) or EnDens
(J/m2/Hz), and perhaps NDIR (nautical, FROM) or CDIR (Cartesian, TO) and DSPRDEGR, each with its
exception value. Each time and place is a line `LOCATION n` and a row for each frequency, or
`NODATA`.

Source: SWAN User Manual, appendix "Spectrum files, input and output"; SWAN Technical Documentation
on DSPR: spread^2 = integral of (2 sin(theta/2))^2 D = 2 (1 - r1), with r1 the first moment.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.readers import bounded_reads, dataset_layout, moments
from fftocean.readers.reader import Head, Reader
from fftocean.readers.swan_lines import (
    ENERGY,
    Lines,
    number_of_quantities,
    read_blocks,
    read_header,
    site_of,
)
from fftocean.readers.swan_lines import recognises as begins_as_swan

if TYPE_CHECKING:
    from xarray import Dataset

_DENSITIES: Final = {
    ("VaDens", "m2/Hz"): 1.0,
    ("EnDens", "J/m2/Hz"): 1.0 / ENERGY,
}
_KINDS: Final = ("VaDens", "EnDens", "NDIR", "CDIR", "DSPRDEGR")


def recognises(head: Head) -> bool:
    """Return True if a SWAN file names its quantities without directions before them."""
    if not begins_as_swan(head.first_line):
        return False
    axes = 0
    for _, line in bounded_reads.lines(head.path):
        word = line.split()[0]
        axes += word in ("AFREQ", "RFREQ")
        if word in ("QUANT", "NDIR", "CDIR"):
            return bool(word == "QUANT" and axes)
    return False


def read(path: Path, *, site: int, bins: int) -> "Dataset":
    """
    Read the spectra of one place.

    Args:
        path: the file.
        site: index of the place, from 0.
        bins: directions round the compass into which mean direction and spread are unfolded.

    Raises:
        ReaderError: another version, quantities or units, counts that do not agree, a file that is
            cut.
        ParameterError: `site` is not in the file.
    """
    lines = Lines(path)
    header = read_header(lines)
    site, f = site_of(header, site), header.frequency
    quantities = _quantities(lines)
    values, time = read_blocks(  # (time, f, quantity)
        lines,
        header,
        site,
        lambda line, place: _block(lines, line, f.size, quantities, number=place + 1),
        first_words="LOCATION or NODATA",
        values=f.size * bins,
    )
    kept, notes = dataset_layout.above_zero(f)
    frequency, order = dataset_layout.frequencies(header.frequency_name, f[kept])
    values = values[:, kept][:, order]
    columns = {name: values[:, :, i] for i, (name, _, _) in enumerate(quantities)}
    name, scale = next(
        (name, scale) for name, scale, _ in quantities if name in ("VaDens", "EnDens")
    )
    density, counts = dataset_layout.densities(lines.name, columns[name] * scale, "m2/Hz")
    direction = None
    mean = columns.get("NDIR", 270.0 - columns["CDIR"] if "CDIR" in columns else None)
    if mean is not None and "DSPRDEGR" in columns:
        c1 = moments.from_spread(mean, columns["DSPRDEGR"])
        density, done = moments.unfold(density, c1, np.full_like(c1, np.nan), bins)
        direction = moments.compass(bins)
        notes |= done
    return dataset_layout.dataset(
        source=lines.name,
        source_format="SWAN 1-D ASCII",
        frequency=frequency,
        density=density,
        direction=direction,
        time=time,
        position=dict(zip(header.axes, header.places[site].tolist(), strict=True)),
        notes={**counts, **notes, "site": site, "sites": len(header.places)},
    )


def _quantities(lines: Lines) -> list[tuple[str, float, float]]:
    """Return name, factor to SI and exception value of each column."""
    found = []
    for _ in range(number_of_quantities(lines, 3)):
        name = lines.next("a quantity").split()[0]
        if name not in _KINDS:
            raise ReaderError(f"{lines.where} must be one of {', '.join(_KINDS)}, got {name!r:.40}")
        unit = lines.next("the unit").split()[0]
        if name in ("VaDens", "EnDens"):
            if (name, unit) not in _DENSITIES:
                raise ReaderError(
                    f"{lines.where}: VaDens must be in m2/Hz, EnDens in J/m2/Hz, got {unit}"
                )
            scale = _DENSITIES[name, unit]
        elif unit not in ("degr", "degrees", "deg"):
            raise ReaderError(f"{lines.where}: the unit of {name} must be degr, got {unit!r:.40}")
        else:
            scale = 1.0
        found.append(
            (
                name,
                scale,
                bounded_reads.number(lines.where, lines.next("the exception value").split()[0]),
            )
        )
    names = [name for name, _, _ in found]
    if (
        len(set(names)) != len(names)
        or sum(n in ("VaDens", "EnDens") for n in names) != 1
        or {"NDIR", "CDIR"} <= set(names)
    ):
        raise ReaderError(f"{lines.where}: there must be one density and one direction at most")
    return found


def _block(
    lines: Lines,
    line: str,
    rows: int,
    quantities: list[tuple[str, float, float]],
    *,
    number: int,
) -> Real:
    """Return one spectrum (f, quantity); NaN where it is missing."""
    words = line.split()
    if words[0] == "NODATA":
        return np.full((rows, len(quantities)), np.nan)
    if words[0] == "ZERO":
        return np.array(
            [[0.0 if name.endswith("Dens") else np.nan for name, _, _ in quantities]] * rows
        )
    if words[0] != "LOCATION" or (len(words) > 1 and words[1] != str(number)):
        raise ReaderError(f"{lines.where} must be LOCATION {number} or NODATA, got {line!r:.40}")
    block = np.empty((rows, len(quantities)))
    for row in block:
        tokens = lines.next("a row of a frequency").split()
        if len(tokens) != len(quantities):
            raise ReaderError(
                f"{lines.where} must hold {len(quantities)} numbers, got {len(tokens)}"
            )
        row[:] = [
            _value(lines.where, token, *quantity)
            for token, quantity in zip(tokens, quantities, strict=True)
        ]
    return block


def _value(where: str, token: str, name: str, scale: float, fill: float) -> float:  # noqa: ARG001
    value = bounded_reads.number(where, token)
    if value == fill:
        return float("nan")
    low, high = {"NDIR": (-360.0, 720.0), "CDIR": (-360.0, 720.0), "DSPRDEGR": (0.0, 180.0)}.get(
        name, (0.0, np.inf)
    )
    if not low <= value <= high:
        raise ReaderError(f"{where}: {name} must be between {low:g} and {high:g}, got {token}")
    return value


READER: Final = Reader(
    name="SWAN 1-D ASCII",
    extensions=(".sp1", ".spc", ".spec"),
    description="Spectra by frequency with mean direction and spread, of one or more places.",
    sniff=recognises,
    read=lambda path, site, bins: read(path, site=site, bins=bins),
)
