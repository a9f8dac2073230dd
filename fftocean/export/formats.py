"""
Registry of file formats.

`encode`, `decode`, `assemble` and `payloads` write and read all of them. No value is clipped: one
that a format cannot hold is an error that names it. The same pixels always give the same bytes. A
format is one object in a module of its own; a new format is that object and its name in `FORMATS`.
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError, ParameterError
from fftocean.export import quantised, recipes, rules
from fftocean.export.atlas import EXR_ATLAS, tiles
from fftocean.export.bare import BIN, R16
from fftocean.export.exr import EXR, EXR_FLOAT
from fftocean.export.form import Format, Layout, Scale
from fftocean.export.ktx2 import KTX2
from fftocean.export.npz import NPZ
from fftocean.export.png import PNG16
from fftocean.export.profiles import PROFILES, Kind, Profile
from fftocean.export.quantised import Limit
from fftocean.export.registry import by_name
from fftocean.export.zarr3 import ZARR

FORMATS: dict[str, Format] = by_name(
    (EXR, EXR_FLOAT, PNG16, R16, NPZ, BIN, KTX2, EXR_ATLAS, ZARR),
)

__all__ = [
    "FORMATS", "Format", "assemble", "atlas", "decode", "decode_levels", "encode", "payloads",
    "require",
]  # fmt: skip

atlas = tiles

SCHEMA = 1
"""Version of the sidecars; readers refuse other versions."""


def require(
    name: str, shape: tuple[int, int, int, int], levels: int = 1, *, gutter: int = 0
) -> None:
    """
    Raise if a format cannot hold a map, before anything is baked.

    Args:
        name: name of the format.
        shape: (frames, rows, columns, channels) of the map.
        levels: number of mip levels.
        gutter: gutter of an atlas.

    Raises:
        ParameterError: the format does not exist, or cannot hold such a map.
    """
    if name not in FORMATS:
        raise ParameterError(f"format must be one of {', '.join(FORMATS)}, got {name!r:.40}")
    frames, rows, columns, channels = shape
    if min(shape) < 1:
        raise ParameterError(
            f"a map must have at least one frame, row, column and channel, got {shape}"
        )
    form = FORMATS[name]
    if channels not in form.channels:
        allowed = " or ".join(map(str, form.channels))
        others = ", ".join(one.name for one in FORMATS.values() if channels in one.channels)
        raise ParameterError(
            f"format {name} holds maps of {allowed} channels, got {channels}"
            + (f"; choose one of {others}" if others else "")
        )
    most = form.most_levels(max(rows, columns))
    if not 1 <= levels <= most:
        raise ParameterError(
            f"format {name} holds 1 to {most} mip levels of {rows} rows of {columns}, got {levels}"
        )
    if form.container is not None:
        form.container.require(Layout(frames, rows, columns, channels, levels, gutter))


def encode(
    name: str, pixels: Real, *, lo: Limit = None, hi: Limit = None, levels: Sequence[Real] = ()
) -> bytes:
    """
    Encode one frame: its whole file, or its part in a container.

    Args:
        name: name of the format.
        pixels: (rows, columns, channels) as `profiles.arrange` gives them, or rounded to half.
        lo, hi: range of the whole sequence, for a scaled format.
        levels: smaller mip levels, for a format that has them.

    Raises:
        OutputError: a value that the format cannot hold: not finite, too large, out of the range.
        ParameterError: a number of channels or levels that the format does not have.
    """
    if pixels.ndim != 3:
        raise ParameterError(f"pixels must be (rows, columns, channels), got shape {pixels.shape}")
    rows, columns, channels = pixels.shape
    require(name, (1, rows, columns, channels), 1 + len(levels))
    return FORMATS[name].encode(pixels, Scale(lo, hi), levels)


def decode(
    name: str,
    data: bytes | memoryview | None,
    *,
    shape: tuple[int, int, int] | None = None,
    lo: Limit = None,
    hi: Limit = None,
    levels: int = 1,
) -> npt.NDArray[Any]:
    """
    Return one frame's pixels from the bytes of `encode`: float16 as stored, else float32.

    Args:
        name: name of the format.
        data: the frame's file or part; None if it is missing.
        shape: (rows, columns, channels); required for a format that does not store it.
        lo, hi: range passed to `encode`.
        levels: number of mip levels encoded; `decode_levels` returns all.

    Raises:
        IntegrityError: it is missing, cut or damaged, as far as the format can detect, or of
            another shape.
        ParameterError: the format does not exist, or needs the shape.
    """
    return decode_levels(name, data, shape=shape, lo=lo, hi=hi, levels=levels)[0]


def decode_levels(
    name: str,
    data: bytes | memoryview | None,
    *,
    shape: tuple[int, int, int] | None = None,
    lo: Limit = None,
    hi: Limit = None,
    levels: int = 1,
) -> list[npt.NDArray[Any]]:
    """Return every mip level, largest first, with the arguments of `decode`."""
    if shape is not None or name not in FORMATS:
        require(name, (1, *(shape or (1, 1, 1))), levels)
    if data is None:
        raise IntegrityError("a frame is missing")
    return FORMATS[name].decode(bytes(data), shape, Scale(lo, hi), levels)


def assemble(
    name: str,
    payloads: Iterable[bytes],
    *,
    stem: str,
    shape: tuple[int, int, int, int],
    profile: Profile | None = None,
    kind: Kind = "scalar",
    names: Sequence[str] = (),
    unit: str = "1",
    size: tuple[float, float] = (1.0, 1.0),
    loop: float = 1.0,
    start: float = 0.0,
    closes: bool = True,
    lookup: str = "lagrangian",
    bounds: Mapping[str, float] | None = None,
    lo: Limit = None,
    hi: Limit = None,
    levels: int = 1,
) -> dict[str, bytes | memoryview]:
    """
    Return the containers and sidecars of a map by relative path.

    Files of single frames are whole after `encode`.

    Args:
        name: name of the format.
        payloads: results of `encode` for all frames in order; unused if each is a file of its own.
        stem: the map's name.
        shape: (frames, rows, columns, channels) of the map.
        profile: conventions that the pixels have.
        kind: kind of map, which determines how the channels change with the axes.
        names: contents of each channel, in words.
        unit: unit of its values.
        size: size of the tile along x and y [m].
        loop: duration of all frames [s].
        start: time of the first frame [s].
        closes: True if the first frame follows the last.
        lookup: "lagrangian" or "eulerian".
        bounds: largest "horizontal" and "vertical" displacement [m], for culling.
        lo, hi: range, for a scaled format.
        levels: number of mip levels.

    Raises:
        ParameterError: the format cannot hold it.
        ValueError: the number or length of the payloads does not match the shape.
    """
    profile = profile or PROFILES["canonical"]
    require(name, shape, levels, gutter=profile.gutter)
    form = FORMATS[name]
    container = form.container
    layout = Layout(*shape, levels, profile.gutter, loop, profile.first_row == "north")
    frames, rows, columns, channels = shape
    words = [*names, *("" for _ in range(channels - len(names)))]
    facts: dict[str, Any] = {
        "schema": SCHEMA,
        "file": form.file.replace("{stem}", stem),
        "format": form.caption,
        "kind": kind,
        "frames": frames,
        "rows": rows,
        "columns": columns,
        "loop": loop,
        "start": start,
        "closes": closes,
        "seconds_per_frame": loop / frames,
        "frames_per_second": frames / loop,
        "lookup": lookup,
        "channels": {
            letter: "1" if c is None else words[c] for letter, c in form.letters(channels).items()
        },
        "unit": unit,
        "size": [side * profile.scale for side in size],
        "size_unit": profile.unit,
        "time_unit": "s",
        # Of a height at X and Z: row = origin + sign Z / size rows, modulo rows.
        "row_origin": -1 if profile.first_row == "north" else 0,
        "row_sign": rules.row_sign(profile),
    }
    if bounds is not None:
        facts["bounds"] = {side: profile.scale * value for side, value in bounds.items()}
        facts["bounds"]["unit"] = profile.unit
    container_facts = {} if container is None else dict(container.facts(layout))
    values = rules.numbers(profile, size, (columns, rows), frames, loop, start)
    rule = rules.sampling(profile)
    if "tiles" in container_facts:
        rule |= rules.atlas(profile)
        across, down = container_facts["tiles"]
        values |= {"tiles_across": across, "tiles_down": down, "gutter": profile.gutter}
    facts["sampling"] = {**rule, "values": values}
    facts["world"] = rules.world(profile, kind)
    facts["conventions"] = rules.conventions(profile)
    if form.scaled:
        low, high = quantised.limits(lo, hi, channels)
        facts |= {"lo": low.tolist(), "hi": high.tolist(), "value": quantised.VALUE}
    facts |= container_facts
    files: dict[str, bytes | memoryview] = {}
    if container is not None:
        file = form.file.format(stem=stem)
        files[file] = container.join(payloads, layout)
        facts["sha256"] = hashlib.sha256(files[file]).hexdigest()
        if "tiles" in container_facts:
            files |= recipes.files_beside(profile, file, facts)
    if form.sidecar:
        files[form.sidecar.format(stem=stem)] = form.sidecar_bytes(facts, layout)
    return files


def payloads(
    name: str,
    data: bytes | memoryview | None,
    *,
    shape: tuple[int, int, int, int],
    levels: int = 1,
    gutter: int = PROFILES["canonical"].gutter,
) -> list[bytes]:
    """
    Return the payloads of all frames from the container of `assemble`.

    Args:
        name: name of a format with one file for the sequence.
        data: that file; None if it is missing.
        shape: required (frames, rows, columns, channels).
        levels: number of mip levels.
        gutter: gutter of the atlas' profile.

    Raises:
        IntegrityError: the file is missing, cut or damaged, as far as the format can detect, or of
            another shape.
        ParameterError: the format has one file a frame.
    """
    require(name, shape, levels, gutter=gutter)
    container = FORMATS[name].container
    if container is None:
        raise ParameterError(f"format {name} has one file a frame and no container")
    if data is None:
        raise IntegrityError("the file of all frames is missing")
    return container.split(data, Layout(*shape, levels, gutter))
