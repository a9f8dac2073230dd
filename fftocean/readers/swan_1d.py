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
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.limits import Count
from fftocean.readers import bounded_reads, dataset_layout, moments, swan
from fftocean.readers.reader import Head, Reader

if TYPE_CHECKING:
    from xarray import Dataset

_DENSITIES: Final = {
    ("VaDens", "m2/Hz"): 1.0,
    ("EnDens", "J/m2/Hz"): 1.0 / swan._ENERGY,
}
_KINDS: Final = ("VaDens", "EnDens", "NDIR", "CDIR", "DSPRDEGR")


def recognises(head: Head) -> bool:
    """Return True if a SWAN file names its quantities without directions before them."""
    if not swan.recognises(head.first_line):
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
    lines = swan._Lines(path)
    lines.next("SWAN")
    dated, axes, places = _header(lines)
    site = Count("", 0, len(places) - 1).check("site", site)
    keyword = lines.next("AFREQ or RFREQ").split()[0]
    if keyword not in ("AFREQ", "RFREQ"):
        raise ReaderError(f"{lines.where} must be AFREQ or RFREQ, got {keyword!r:.40}")
    f = lines.table("frequencies", 1)[:, 0]
    quantities = _quantities(lines)
    time: list[Any] = []
    blocks: list[Real] = []
    while (line := lines.maybe()) is not None:
        if dated:
            time.append(swan._time(lines.where, line))
        elif blocks:
            raise ReaderError(
                f"{lines.where} must be the end of a file without TIME, got {line!r:.40}"
            )
        for place in range(len(places)):
            line = lines.next("LOCATION or NODATA") if dated or place else line
            block = _block(lines, line, f.size, quantities, number=place + 1)
            if place == site:
                blocks.append(block)
        if len(blocks) * f.size * bins > dataset_layout.MAX_VALUES:
            raise ReaderError(
                f"{lines.where} must have at most {dataset_layout.MAX_VALUES} values, got more"
            )
    if not blocks:
        raise ReaderError(
            f"{lines.name} must hold at least one spectrum after its header, got none"
        )
    values = np.array(blocks)  # (time, f, quantity)
    kept, notes = dataset_layout.above_zero(f)
    frequency, order = dataset_layout.frequencies(f"{lines.name}: {keyword}", f[kept])
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
        time=np.array(time, dtype="datetime64[s]") if dated else None,
        position=dict(zip(axes, places[site].tolist(), strict=True)),
        notes={**counts, **notes, "site": site, "sites": len(places)},
    )


def _header(lines: swan._Lines) -> tuple[bool, tuple[str, str], Real]:
    """Return True if the file has times, the names of the coordinates, and the places."""
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
    return dated, ("lon", "lat") if keyword == "LONLAT" else ("x", "y"), lines.table("places", 2)


def _quantities(lines: swan._Lines) -> list[tuple[str, float, float]]:
    """Return name, factor to SI and exception value of each column."""
    keyword = lines.next("QUANT").split()[0]
    if keyword != "QUANT":
        raise ReaderError(f"{lines.where} must be QUANT, got {keyword!r:.40}")
    found = []
    for _ in range(bounded_reads.count(lines.where, lines.next("the number of quantities"), 3)):
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
    lines: swan._Lines,
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
