"""
Registry of file formats, and the functions by which all of them are written and read.

Nothing is clipped, ever: a value that a format cannot hold is an error that names it. The same
pixels are always the same bytes. What a format is and does stands in its own module, as one
object; a new format is that object and its name in `FORMATS`.
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
from fftocean.export.zarr3 import ZARR

FORMATS: dict[str, Format] = {
    one.name: one for one in (EXR, EXR_FLOAT, PNG16, R16, NPZ, BIN, KTX2, EXR_ATLAS, ZARR)
}

__all__ = [
    "FORMATS", "Format", "assemble", "atlas", "decode", "decode_levels", "encode", "payloads",
    "require",
]  # fmt: skip

atlas = tiles

SCHEMA = 1
"""Version of the sidecars: what a reader of another one must not guess at."""


def require(
    name: str, shape: tuple[int, int, int, int], levels: int = 1, *, gutter: int = 0
) -> None:
    """
    Refuse what a format cannot hold, before anything is baked.

    Args:
        name: of the format.
        shape: (frames, rows, columns, channels) of the map.
        levels: of mipmaps.
        gutter: of the atlas, where there is one.

    Raises:
        ParameterError: there is no such format, or it cannot hold such a map.
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
    Encode one frame: its whole file, or the part of it in a container.

    Args:
        name: of the format.
        pixels: (rows, columns, channels) as `profiles.arrange` gives them, or rounded to half.
        lo, hi: the range of the whole sequence, for a format that is scaled.
        levels: the mip levels below this one, for a format that has them.

    Raises:
        OutputError: a value that the format cannot hold: not finite, too large, out of the range.
        ParameterError: channels or levels that the format has not.
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
    Return one frame's pixels out of what `encode` made of it: float16 as stored, else float32.

    Args:
        name: of the format.
        data: the frame's file or part; None is a missing one.
        shape: (rows, columns, channels); needed for a format that does not say so itself.
        lo, hi: as it was encoded with.
        levels: of mipmaps that it was encoded with; `decode_levels` returns all.

    Raises:
        IntegrityError: it is missing, cut or damaged, as far as the format can tell, or of
            another shape.
        ParameterError: there is no such format, or the shape is needed.
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
    """Return every mip level, the largest first; else as `decode`."""
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
    Return every file of a map but those that `encode` made whole, by relative path.

    These are containers, and the text beside files and containers.

    Args:
        name: of the format.
        payloads: of all frames in order, from `encode`; not used where each is a file of its own.
        stem: the map's name.
        shape: (frames, rows, columns, channels) of the map.
        profile: conventions that the pixels have.
        kind: how the channels change with the axes.
        names: what each channel holds, in words.
        unit: of its values.
        size: of the tile, along x and y [m].
        loop: what the frames take to play through [s].
        start: time of the first frame [s].
        closes: whether the last frame leads to the first.
        lookup: "lagrangian" or "eulerian".
        bounds: largest "horizontal" and "vertical" displacement [m], for culling.
        lo, hi: the range, for a format that is scaled.
        levels: of mipmaps.

    Raises:
        ParameterError: the format cannot hold it.
        ValueError: the payloads are not as many, or not as long, as the shape says.
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
        # of a height at X and Z: row = origin + sign Z / size rows, modulo rows
        "row_origin": -1 if profile.first_row == "north" else 0,
        "row_sign": rules.row_sign(profile),
    }
    if bounds is not None:
        facts["bounds"] = {side: profile.scale * value for side, value in bounds.items()}
        facts["bounds"]["unit"] = profile.unit
    special = {} if container is None else dict(container.facts(layout))
    values = rules.numbers(profile, size, (columns, rows), frames, loop, start)
    rule = rules.sampling(profile)
    if "tiles" in special:
        rule |= rules.atlas(profile)
        across, down = special["tiles"]
        values |= {"tiles_across": across, "tiles_down": down, "gutter": profile.gutter}
    facts["sampling"] = {**rule, "values": values}
    facts["world"] = rules.world(profile, kind)
    facts["conventions"] = rules.conventions(profile)
    if form.scaled:
        low, high = quantised.limits(lo, hi, channels)
        facts |= {"lo": low.tolist(), "hi": high.tolist(), "value": quantised.VALUE}
    facts |= special
    files: dict[str, bytes | memoryview] = {}
    if container is not None:
        file = form.file.format(stem=stem)
        files[file] = container.join(payloads, layout)
        facts["sha256"] = hashlib.sha256(files[file]).hexdigest()
        if "tiles" in special:
            files |= recipes.beside(profile, file, facts)
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
    Return what each frame's `encode` made, out of the container that `assemble` put it in.

    Args:
        name: of a format with one file for the sequence.
        data: that file; None is a missing one.
        shape: (frames, rows, columns, channels) that it must have.
        levels: of mipmaps.
        gutter: of the profile that the atlas was made for.

    Raises:
        IntegrityError: the file is missing, cut or damaged, as far as the format can tell, or of
            another shape.
        ParameterError: the format has a file a frame.
    """
    require(name, shape, levels, gutter=gutter)
    container = FORMATS[name].container
    if container is None:
        raise ParameterError(f"format {name} has a file a frame, and no container")
    if data is None:
        raise IntegrityError("the file of all frames is missing")
    return container.split(data, Layout(*shape, levels, gutter))
