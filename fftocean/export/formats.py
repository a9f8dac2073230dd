"""
Every file format: pixels in, bytes out, and back; what each can hold, and whether a frame is a file or a part of one.

Nothing is clipped, ever: a value that a format cannot hold is an error that names it. The same pixels are always the same bytes.
"""

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError, OutputError, ParameterError
from fftocean.export import exr, ktx2, npz, png, quantised, recipes, zarr3
from fftocean.export.profiles import PROFILES, Profile
from fftocean.export.quantised import Limit

LARGEST_SIDE = 16384  # of a texture, on today's graphics cards


@dataclass(frozen=True, slots=True)
class Format:
    """What one format can hold, and where its files stand."""

    name: str
    scope: Literal["frame", "sequence"]  # a file a frame, or one file for all of them
    file: str  # its path, of {stem} and {frame}
    stored: Literal["float16", "float32", "uint16"]
    channels: tuple[int, ...]  # how many a map may have
    least: int  # how many channels its files have at least
    raw: bool  # uploaded as it is: no loader of pictures will turn its rows
    caption: str

    @property
    def scaled(self) -> bool:
        """Whether it holds (v - lo) / (hi - lo), so that one lo and hi for the whole sequence must be known before."""
        return self.stored == "uint16"

    @property
    def suffix(self) -> str:
        """The end of its file's name."""
        return ".zarr" if self.name == "zarr" else self.file[self.file.rindex(".") :]

    def letters(self, count: int) -> dict[str, int | None]:
        """Which of a map's channels stands in each of the file's; None is a 1. One channel stands in R, G and B alike."""
        if self.least == 1:
            return {letter: c for c, letter in enumerate("RGBA"[:count] if count > 1 else "Y")}
        held = {letter: c if count > 1 else 0 for c, letter in enumerate("RGBA"[: max(count, 3)])}
        return {**held, **({"A": None} if self.least == 4 and count < 4 else {})}


FORMATS: dict[str, Format] = {
    format_.name: format_
    for format_ in (
        #      name         scope       file                          stored     channels   least raw
        Format("exr",       "frame",    "{stem}/{frame:04d}.exr",     "float16", (1, 3, 4), 3, False, "OpenEXR, half, ZIP"),
        Format("exr-float", "frame",    "{stem}/{frame:04d}.exr",     "float32", (1, 3, 4), 3, False, "OpenEXR, single precision, ZIP"),
        Format("png16",     "frame",    "{stem}/{frame:04d}.png",     "uint16",  (1, 3),    1, False, "PNG, 16 bit, scaled"),
        Format("r16",       "frame",    "{stem}/{frame:04d}.r16",     "uint16",  (1,),      1, True,  "bare 16 bit, scaled"),
        Format("npz",       "frame",    "{stem}/{frame:04d}.npz",     "float32", (1, 3, 4), 1, True,  "NumPy, single precision"),
        Format("bin",       "sequence", "{stem}.bin",                 "float16", (1, 3, 4), 4, True,  "bare half RGBA and JSON"),
        Format("ktx2",      "sequence", "{stem}.ktx2",                "float16", (1, 3, 4), 4, True,  "KTX 2.0 array of half RGBA"),
        Format("exr-atlas", "sequence", "{stem}.exr",                 "float16", (1, 3, 4), 3, False, "one OpenEXR of all frames"),
        Format("zarr",      "frame",    "{stem}.zarr/" + zarr3.CHUNK, "float32", (1, 3, 4), 1, True,  "Zarr 3, a chunk a frame"),
    )
}  # fmt: skip


def require(name: str, shape: tuple[int, int, int, int], levels: int = 1) -> None:
    """
    Refuse what a format cannot hold, before anything is baked.

    Args:
        name: of the format.
        shape: (frames, rows, columns, channels) of the map.
        levels: of mipmaps.

    Raises:
        ParameterError: there is no such format, or it cannot hold such a map.
    """
    if name not in FORMATS:
        raise ParameterError(f"format must be one of {', '.join(FORMATS)}, got {name!r:.40}")
    frames, rows, columns, channels = shape
    if min(shape) < 1:
        raise ParameterError(f"a map must have at least one frame, row, column and channel, got {shape}")
    allowed = FORMATS[name].channels
    if channels not in allowed:
        raise ParameterError(f"format {name} holds maps of {' or '.join(map(str, allowed))} channels, got {channels}")
    most = max(rows, columns).bit_length() if name == "ktx2" else 1
    if not 1 <= levels <= most:
        raise ParameterError(f"format {name} holds 1 to {most} mip levels of {rows} rows of {columns}, got {levels}")
    if name == "exr-atlas":
        atlas(frames, rows, columns)


def atlas(frames: int, rows: int, columns: int) -> tuple[int, int]:
    """
    Return (columns, rows) of frames in an atlas: as square as it can be with no tile left empty, which an engine would play as a frame.

    Raises:
        ParameterError: there is no such arrangement within a texture's size.
    """
    fitting = [
        (across, frames // across)
        for across in range(1, frames + 1)
        if frames % across == 0 and across * columns <= LARGEST_SIDE and frames // across * rows <= LARGEST_SIDE
    ]
    if not fitting:
        raise ParameterError(
            f"{frames} frames of {columns} x {rows} do not fill an atlas of at most {LARGEST_SIDE} x {LARGEST_SIDE}: "
            "choose a number of frames with more divisors, fewer or smaller frames, or another format"
        )
    return min(fitting, key=lambda tiles: (max(tiles[0] * columns, tiles[1] * rows), tiles))


def encode(name: str, pixels: Real, *, lo: Limit = None, hi: Limit = None, levels: Sequence[Real] = ()) -> bytes:
    """
    Encode one frame: its whole file, or, where a format has one file for the sequence, what `assemble` will put there.

    Args:
        name: of the format.
        pixels: (rows, columns, channels) as `profiles.arrange` gives them, or already rounded to half.
        lo, hi: the range of the whole sequence, for a format that is scaled.
        levels: the mip levels below this one, for a format that has them.

    Raises:
        OutputError: a value that the format cannot hold: not finite, too large for a half, outside the range.
        ParameterError: channels or levels that the format has not.
    """
    require(name, (1, *_rows_columns_channels(pixels)), 1 + len(levels))
    if FORMATS[name].scaled:
        words = quantised.to_steps(pixels, lo, hi)
        return png.encode(words) if name == "png16" else words.astype("<u2").tobytes()
    if FORMATS[name].stored == "float32":
        floats = _finite(pixels, np.float32)
        if name == "npz":
            return npz.encode(floats)
        return exr.encode(floats) if name == "exr-float" else zarr3.encode_chunk(floats)
    halves = _halves(pixels)
    if name == "exr":
        return exr.encode(halves)
    if name == "exr-atlas":
        return halves.astype("<f2", copy=False).tobytes()
    sizes = ktx2.level_sizes(pixels.shape[0], pixels.shape[1], 1 + len(levels))
    for level, size in zip(levels, sizes[1:], strict=True):
        if level.shape != (*size, pixels.shape[2]):
            raise ParameterError(f"a mip level must have shape {(*size, pixels.shape[2])}, got {level.shape}")
    return b"".join(_rgba(part).tobytes() for part in (halves, *map(_halves, levels)))


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
        shape: (rows, columns, channels) that it must have; needed for a format that does not say so itself.
        lo, hi: as it was encoded with.
        levels: of mipmaps that it was encoded with; the largest is returned, `decode_levels` returns all.

    Raises:
        IntegrityError: it is missing, cut or bent, as far as the format can tell, or of another shape.
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
    """As `decode`, with every mip level, the largest first."""
    if shape is not None or name not in FORMATS:
        require(name, (1, *(shape or (1, 1, 1))), levels)
    if data is None:
        raise IntegrityError("a frame is missing")
    data = bytes(data)
    if name in ("exr", "exr-float"):
        pixels = exr.read(data, None if shape is None else shape[:2])
        if pixels.dtype != FORMATS[name].stored:
            raise IntegrityError(f"format {name} must hold {FORMATS[name].stored}, got {pixels.dtype}")
        return [_finite_again(_counted(pixels, shape))]
    if name == "png16":
        return [quantised.from_steps(png.read(data, shape), lo, hi)]
    if name == "npz":
        return [_finite_again(npz.read(data, shape))]
    if shape is None:
        raise ParameterError(f"format {name} does not say what shape its frames have: give it")
    if name == "zarr":
        return [_finite_again(zarr3.decode_chunk(data, shape))]
    rows, columns, count = shape
    if name in ("r16", "exr-atlas"):
        _require_size(data, 2 * rows * columns * count, name)
        words = np.frombuffer(data, dtype="<u2").reshape(shape)
        return [quantised.from_steps(words, lo, hi) if name == "r16" else _finite_again(words.view("<f2").astype(np.float16))]
    sizes = ktx2.level_sizes(rows, columns, levels)
    _require_size(data, sum(ktx2.TEXEL * r * c for r, c in sizes), name)
    found, at = [], 0
    for r, c in sizes:
        texels = np.frombuffer(data, dtype="<f2", count=4 * r * c, offset=at).reshape(r, c, 4).astype(np.float16)
        if count < 4 and np.any(texels[..., 3] != 1.0):
            raise IntegrityError(f"format {name} must have a 1 in A where a map has {count} channels")
        found.append(_finite_again(_counted(texels if count == 4 else texels[..., :3], (r, c, count))))
        at += ktx2.TEXEL * r * c
    return found


def assemble(
    name: str,
    payloads: Iterable[bytes],
    *,
    stem: str,
    shape: tuple[int, int, int, int],
    profile: Profile | None = None,
    names: Sequence[str] = (),
    unit: str = "1",
    size: tuple[float, float] = (1.0, 1.0),
    loop: float = 1.0,
    lo: Limit = None,
    hi: Limit = None,
    levels: int = 1,
) -> dict[str, bytes | memoryview]:
    """
    Return every file of a map but those that `encode` made whole: containers, and what belongs beside them, by relative path.

    Args:
        name: of the format.
        payloads: of all frames in order, from `encode`; may come one by one. Not looked at where each is a file of its own.
        stem: the map's name.
        shape: (frames, rows, columns, channels) of the map.
        profile: whose frame the pixels are in.
        names: what each channel holds, in words.
        unit: of its values.
        size: of the tile, along x and y [m].
        loop: what the frames take to play through [s].
        lo, hi: the range, for a format that is scaled.
        levels: of mipmaps.

    Raises:
        ParameterError: the format cannot hold it.
        ValueError: the payloads are not as many, or not as long, as the shape says.
    """
    require(name, shape, levels)
    profile = profile or PROFILES["canonical"]
    frames, rows, columns, channels = shape
    format_ = FORMATS[name]
    file = format_.file.format(stem=stem, frame=0)
    words = [*names, *("" for _ in range(channels - len(names)))]
    facts: dict[str, Any] = {
        "file": format_.file.replace("{stem}", stem),
        "format": format_.caption,
        "frames": frames,
        "rows": rows,
        "columns": columns,
        "loop": loop,
        "seconds_per_frame": loop / frames,
        "channels": {letter: "1" if c is None else words[c] for letter, c in format_.letters(channels).items()},
        "unit": unit,
        "size": [side * profile.scale for side in size],
        "size_unit": profile.unit,
        # of a height at X and Z: row = origin + sign Z / size rows, modulo rows; column = X / size columns
        "row_origin": -1 if profile.first_row == "north" else 0,
        "row_sign": profile.north * (-1 if profile.first_row == "north" else 1),
        "conventions": profile.describe(raw=format_.raw),
    }
    if name == "zarr":
        return {f"{stem}.zarr/zarr.json": zarr3.metadata(shape, {**facts, "file": f"{stem}.zarr"})}
    if format_.scaled:
        low, high = quantised.limits(lo, hi, channels)
        scaling = {"lo": low.tolist(), "hi": high.tolist(), "value": "lo + stored / 65535 * (hi - lo)"}
        return {f"{stem}.json": _json({**facts, "dtype": "uint16", **scaling})}
    if format_.scope == "frame":
        return {}
    if name == "exr-atlas":
        across, down = atlas(frames, rows, columns)
        picture = np.empty((down, rows, across, columns, channels), dtype=np.float16)
        for i, payload in _counting(payloads, frames, 2 * rows * columns * channels):
            picture[i // across, :, i % across] = np.frombuffer(payload, dtype="<f2").reshape(rows, columns, channels)
        data = exr.encode(picture.reshape(down * rows, across * columns, channels), periodic=False)
        tiles = {"tiles": [across, down], "order": "frames from left to right, then down"}
        sidecar = _json({**facts, **tiles, "sha256": hashlib.sha256(data).hexdigest()})
        return {file: data, f"{stem}.json": sidecar, **recipes.beside(profile, file, columns=across, rows=down, loop=loop)}
    if name == "ktx2":
        size_of_one = sum(ktx2.TEXEL * r * c for r, c in ktx2.level_sizes(rows, columns, levels))
        numbered = _counting(payloads, frames, size_of_one)
        whole = ktx2.pack(numbered, frames, rows, columns, levels, loop=loop, row0_on_top=profile.first_row == "north")
    else:
        size_of_one = ktx2.TEXEL * rows * columns
        whole = memoryview(bytearray(frames * size_of_one))
        for i, payload in _counting(payloads, frames, size_of_one):
            whole[i * size_of_one : (i + 1) * size_of_one] = payload
    layout = {"dtype": "float16, little-endian", "shape": [frames, rows, columns, 4], "levels": levels}
    return {file: whole, f"{stem}.json": _json({**facts, **layout, "sha256": hashlib.sha256(whole).hexdigest()})}


def payloads(name: str, data: bytes | memoryview | None, *, shape: tuple[int, int, int, int], levels: int = 1) -> list[bytes]:
    """
    Return what each frame's `encode` made, out of the container that `assemble` put it in.

    Args:
        name: of a format with one file for the sequence.
        data: that file; None is a missing one.
        shape: (frames, rows, columns, channels) that it must have.
        levels: of mipmaps.

    Raises:
        IntegrityError: the file is missing, cut or bent, as far as the format can tell, or of another shape.
        ParameterError: the format has a file a frame.
    """
    require(name, shape, levels)
    if FORMATS[name].scope != "sequence":
        raise ParameterError(f"format {name} has a file a frame, and no container")
    if data is None:
        raise IntegrityError("the file of all frames is missing")
    frames, rows, columns, channels = shape
    if name == "ktx2":
        return ktx2.unpack(data, frames, rows, columns, levels)
    if name == "bin":
        one = ktx2.TEXEL * rows * columns
        _require_size(data, frames * one, name)
        return [bytes(data[i * one : (i + 1) * one]) for i in range(frames)]
    across, down = atlas(frames, rows, columns)
    pixels = exr.read(bytes(data), (down * rows, across * columns))
    if pixels.dtype != np.float16:
        raise IntegrityError(f"format {name} must hold float16, got {pixels.dtype}")
    picture = _counted(pixels, (down * rows, across * columns, channels)).reshape(down, rows, across, columns, channels)
    return [picture[i // across, :, i % across].astype("<f2").tobytes() for i in range(frames)]


def _rows_columns_channels(pixels: Real) -> tuple[int, int, int]:
    """An array's shape, found to be one of pixels."""
    if pixels.ndim != 3:
        raise ParameterError(f"pixels must be (rows, columns, channels), got shape {pixels.shape}")
    rows, columns, channels = pixels.shape
    return rows, columns, channels


def _finite(pixels: Real, dtype: type[np.floating[Any]]) -> npt.NDArray[Any]:
    """Pixels in a type, every one finite in it."""
    with np.errstate(over="ignore"):
        out = np.ascontiguousarray(pixels, dtype=dtype)
    if not np.all(np.isfinite(out)):
        raise OutputError(f"values must be finite as {np.dtype(dtype)}, got {_first_bad(pixels, out)}")
    return out


def _halves(pixels: Real) -> npt.NDArray[np.float16]:
    """Pixels rounded to half, every one within its range; halves as they are."""
    if pixels.dtype != np.float16:
        extreme = float(np.max(np.abs(pixels), initial=0.0))
        if not extreme <= exr.HALF_MAX:
            raise OutputError(f"values must stay within +-{exr.HALF_MAX:g} to be half floats, got {extreme:g}")
    return _finite(pixels, np.float16)


def _first_bad(pixels: Real, out: Real) -> str:
    """The first value that is not finite once it is stored, and where it is."""
    row, column, channel = (int(i) for i in np.argwhere(~np.isfinite(out))[0])
    return f"{pixels[row, column, channel]} at row {row}, column {column}, channel {channel}"


def _finite_again(pixels: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Pixels that were stored, found to be finite, as they were then."""
    if not np.all(np.isfinite(pixels)):
        raise IntegrityError("a frame must hold finite values only")
    return pixels


def _rgba(halves: npt.NDArray[np.float16]) -> npt.NDArray[np.float16]:
    """One or three channels as four: one stands in R, G and B alike, and A is 1."""
    out = np.ones((*halves.shape[:2], 4), dtype="<f2")
    out[..., : max(3, halves.shape[2])] = halves
    return out


def _counted(pixels: npt.NDArray[Any], shape: tuple[int, int, int] | None) -> npt.NDArray[Any]:
    """Pixels of a file with the channels that the map has: of three that are one, the one."""
    if shape is None or pixels.shape == tuple(shape):
        return pixels
    alike = pixels.shape[2] == 3 and shape[2] == 1 and bool(np.all(pixels == pixels[..., :1]))
    if pixels.shape[:2] != tuple(shape[:2]) or not alike:
        raise IntegrityError(f"a picture must hold a map of shape {tuple(shape)}, got {pixels.shape}")
    return np.ascontiguousarray(pixels[..., :1])


def _require_size(data: bytes | memoryview, size: int, name: str) -> None:
    """Refuse a file of another length, which is all that a bare format can tell."""
    if len(data) != size:
        raise IntegrityError(f"a {name} file of this shape must have {size} bytes, got {len(data)}")


def _counting(payloads: Iterable[bytes], count: int, size: int) -> Iterable[tuple[int, bytes]]:
    """The payloads with their numbers, found to be as many and as long as they must be."""
    i = -1
    for i, payload in enumerate(payloads):
        if i >= count or len(payload) != size:
            raise ValueError(f"frame {i} of {count} must have {size} bytes, got {len(payload)}")
        yield i, payload
    if i + 1 != count:
        raise ValueError(f"{count} frames are needed, got {i + 1}")


def _json(tree: dict[str, Any]) -> bytes:
    """Readable JSON, the same bytes for the same tree."""
    return (json.dumps(tree, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
