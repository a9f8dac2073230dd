"""Run-time package of a sea: a document, and files of waves."""

import json
from dataclasses import dataclass
from typing import Any

from fftocean.arrays import brief_repr
from fftocean.cascade import Cascade
from fftocean.engine_projects import engine_of
from fftocean.errors import ParameterError, described
from fftocean.files import digest
from fftocean.foam import Foam
from fftocean.limits import DIRECTION, WIND_SPEED, Count
from fftocean.ocean import Ocean
from fftocean.runtime import document, layout, planes
from fftocean.runtime.engines import kernels_of, require_engine_sides
from fftocean.runtime.records import records_of
from fftocean.runtime.reference import reference_of
from fftocean.runtime.source import Source
from fftocean.runtime.textures import encode, textures_ending, twiddle

QUALITIES = ("exact", "moving")
POINTS = 64
"""Points of a tile at which `check.json` has the fields."""


@dataclass(frozen=True, slots=True, eq=False)
class SeaPackage:
    """A sea for programs that run it; docs/runtime.md has every byte."""

    document: dict[str, Any]  # the contents of sea.json
    files: dict[str, bytes]  # the other files by name, in the order of document["files"]

    __repr__ = brief_repr


def pack(
    source: Ocean | Cascade | Source,
    *,
    textures: bool | str = False,
    engine: str | None = None,
    reference: bool | int = True,
    job: str | None = None,
    quality: str = "exact",
    ticks: int | None = None,
    foam: Foam | None = None,
    wind: tuple[float, float] | None = None,
) -> SeaPackage:
    """
    Pack the waves of a sea for programs that run it.

    Args:
        source: an ocean or a cascade that loops, or a `Source` of given amplitudes.
        textures: add the waves as textures of float32, ready for a graphics processor: "bin",
            "ktx2" or "exr"; True is "bin".
        engine: add the kernels of an engine of `runtime.engines`, and the textures that it needs.
        reference: add `check.json`, fields at some points by which a program can check itself,
            and measure the bounds of the fields; a number is that of the points a tile.
        job: the job of the sea as TOML text.
        quality: "exact", or "moving" for a sea that is being changed: without whatever takes
            time, that is `check.json`, checksums, and integrals over the specified sea.
        ticks: moments of the loop, a power of two; None for the most that keep phases exact.
        foam: parameters of foam; None for those that cover what whitecaps do in the wind, or the
            defaults of `Foam` where the wind is not known.
        wind: speed [m/s] and direction [degrees] of the wind, where it is known.

    Raises:
        ParameterError: waves that a package cannot hold; the message has the rule.
    """
    source = Source.of(source)
    if quality not in QUALITIES:
        raise ParameterError(f"quality must be 'exact' or 'moving', got {quality!r:.40}")
    row = engine_of(engine)
    ending = textures_ending(textures) or (row.textures if row else None)
    if foam is not None and not isinstance(foam, Foam):
        raise ParameterError(f"foam must be a Foam, got {described(foam)}")
    if job is not None and (not isinstance(job, str) or len(job) > layout.MOST_JOB):
        raise ParameterError(
            f"job must be TOML text of at most {layout.MOST_JOB} characters, got {described(job)}"
        )
    points = _points(reference)
    measured = quality == "exact" and points > 0
    wind = _checked_wind(wind)
    whole = []
    for i, tile in enumerate(source.tiles):
        layout.require_sides(tile.grid, f"tile {i}")
        if row:
            require_engine_sides(row, tile.grid, f"tile {i}")
        whole.append(planes.planes_of(tile, f"tile {i}"))
    most = max(plane.most_cycles for plane in whole)
    ticks = layout.ticks_for(most) if ticks is None else layout.require_ticks(ticks, most)
    records = [records_of(plane) for plane in whole]
    contents = document.compose(
        source,
        whole,
        records,
        ticks=ticks,
        quality=quality,
        measured=measured,
        foam=foam,
        wind=wind,
        job=job,
    )
    contents["files"] = []
    package = SeaPackage(contents, {})
    for i, (tile, plane, waves) in enumerate(zip(source.tiles, whole, records, strict=True)):
        name = layout.waves_file(i)
        add_file(package, name, waves.tobytes(), RECORD_TEXT, [len(waves)], "wave")
        if ending:
            arrays = planes.textures_of(plane, tile.grid, tile.depth)
            for name, array in zip(layout.texture_files(i, ending), arrays, strict=True):
                data, dtype = encode(array, ending)
                add_file(package, name, data, dtype, list(array.shape), "row, column, channel")
    if ending or row:
        table = twiddle(max(max(tile.grid.shape) for tile in source.tiles))
        add_file(package, layout.TWIDDLE, table.tobytes(), "float32", list(table.shape), "i, part")
    for name, data in (kernels_of(row) if row else {}).items():
        add_file(package, name, data, "text", [], "")
    if measured:
        data = json.dumps(reference_of(source, ticks, points), separators=(",", ":")).encode()
        add_file(package, layout.REFERENCE, data, "json", [], "")
    return package


def _points(reference: Any) -> int:
    """Return the number of points a tile at which a package has the fields."""
    if isinstance(reference, bool):
        return POINTS if reference else 0
    return Count("", 0, layout.MOST_POINTS).check("reference", reference)


def _checked_wind(wind: Any) -> tuple[float, float] | None:
    """Return speed [m/s] and direction [degrees] of a wind, or None."""
    if wind is None:
        return None
    if not isinstance(wind, (tuple, list)) or len(wind) != 2:
        raise ParameterError(f"wind must be (speed, direction), got {described(wind)}")
    return WIND_SPEED.check("wind[0]", wind[0]), DIRECTION.check("wind[1]", wind[1])


def add_file(
    package: SeaPackage, name: str, data: bytes, dtype: str, shape: list[int], order: str
) -> None:
    """
    Add a file to a package that is being made.

    Args:
        package: the package.
        name: of the file, without folders.
        data: its bytes.
        dtype, shape: of the array that it holds.
        order: names of the array's axes, the slowest first.
    """
    package.files[name] = data
    package.document["files"].append(
        {
            "name": name,
            "bytes": len(data),
            "sha256": digest(data) if package.document["quality"] == "exact" else None,
            "dtype": dtype,
            "shape": shape,
            "order": order,
        }
    )


RECORD_TEXT = "int16 mx, int16 my, uint16 cycles, float32 re, float32 im"
"""The fields of a record, as the document names them."""
