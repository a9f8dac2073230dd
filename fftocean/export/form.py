"""
One file format as one object: what it can hold, where its files stand, and its functions.

Each format's own module makes its object, and `formats.FORMATS` lists them. A part that is left
out is an error at import.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError, OutputError, ParameterError
from fftocean.export.quantised import Limit

HALF_MAX = 65504.0


@dataclass(frozen=True, slots=True)
class Scale:
    """Range of the values, for formats that store steps of it."""

    lo: Limit = None
    hi: Limit = None


@dataclass(frozen=True, slots=True)
class Layout:
    """Shape of a map in a container."""

    frames: int
    rows: int
    columns: int
    channels: int
    levels: int = 1
    gutter: int = 0  # of an atlas
    loop: float = 1.0  # what the frames take to play through [s]
    row0_on_top: bool = True

    @property
    def frame(self) -> tuple[int, int, int]:
        """(rows, columns, channels) of a frame."""
        return self.rows, self.columns, self.channels


@dataclass(frozen=True, slots=True, kw_only=True)
class Container:
    """
    One file for all frames of a map.

    Attributes:
        join: the file's bytes, of each frame's payload in order.
        split: each frame's payload, of the file's bytes.
        facts: what its sidecar says beyond what every sidecar does.
        separable: whether a damaged file leaves the payloads of other frames as they were.
        require: refuses a layout that the container cannot have, with a ParameterError.
    """

    join: Callable[[Iterable[bytes], Layout], bytes | memoryview]
    split: Callable[[bytes | memoryview, Layout], list[bytes]]
    facts: Callable[[Layout], Mapping[str, Any]]
    separable: bool
    require: Callable[[Layout], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """
    One file format.

    Attributes:
        name: as in a job file.
        caption: in words.
        file: path of its files, with {stem} and {frame}; a format with a container has no {frame}.
        numbered: what {frame} counts: frames of the loop, or places of the sequence that is baked.
        stored: type of its numbers; uint16 holds (v - lo) / (hi - lo) in 65535 steps.
        channels: how many a map may have.
        least: how many channels its files have at least.
        sidecar: path of the text beside it, with {stem}; "" is none.
        sidecar_bytes: that text, of the facts and the layout.
        most_levels: how many mip levels it can hold, of the larger side of a map.
        encode: bytes of a frame, or of its part in a container: (pixels, scale, smaller levels).
        decode: its mip levels, largest first: (bytes, shape or None, scale, number of levels).
        container: for a format with one file for all frames.
    """

    name: str
    caption: str
    file: str
    numbered: Literal["frame", "place"]
    stored: Literal["float16", "float32", "uint16"]
    channels: tuple[int, ...]
    least: int
    sidecar: str
    sidecar_bytes: Callable[[Mapping[str, Any], Layout], bytes]
    most_levels: Callable[[int], int]
    encode: Callable[[Real, Scale, Sequence[Real]], bytes]
    decode: Callable[[bytes, tuple[int, int, int] | None, Scale, int], list[npt.NDArray[Any]]]
    container: Container | None

    def __post_init__(self) -> None:
        if (self.container is None) != ("{frame" in self.file):
            raise ImportError(f"format {self.name} must have either {{frame}} or a container")
        if "{stem}" not in self.file or (self.sidecar and "{stem}" not in self.sidecar):
            raise ImportError(f"files of format {self.name} must be named after {{stem}}")

    @property
    def scope(self) -> Literal["frame", "sequence"]:
        """Scope of a file: one frame, or all frames of a map."""
        return "frame" if self.container is None else "sequence"

    @property
    def scaled(self) -> bool:
        """True if one lo and hi for the whole sequence must be known beforehand."""
        return self.stored == "uint16"

    @property
    def suffix(self) -> str:
        """End of the name of its file, or of the folder that is named after the map."""
        first = self.file.split("/")[0].removeprefix("{stem}")
        return first or self.file[self.file.rindex(".") :]

    def letters(self, count: int) -> dict[str, int | None]:
        """Return which of a map's channels stands in each of the file's; None is a 1."""
        if self.least == 1:
            return {letter: c for c, letter in enumerate("RGBA"[:count] if count > 1 else "Y")}
        held = {x: c if count > 1 else 0 for c, x in enumerate("RGBA"[: max(count, 3)])}
        return {**held, **({"A": None} if self.least == 4 and count < 4 else {})}


def one_level(_side: int) -> int:
    """Return the number of mip levels of a format that has none but the map itself."""
    return 1


def require_shape(shape: tuple[int, int, int] | None, name: str) -> tuple[int, int, int]:
    """
    Return a shape that must be given, since the format does not say it itself.

    Raises:
        ParameterError: it is not given.
    """
    if shape is None:
        raise ParameterError(f"format {name} does not say what shape its frames have: give it")
    return shape


def finite(pixels: Real, dtype: type[np.floating[Any]]) -> npt.NDArray[Any]:
    """
    Return pixels in a type, C-contiguous, every one finite in it.

    Raises:
        OutputError: one is not.
    """
    with np.errstate(over="ignore"):
        out = np.ascontiguousarray(pixels, dtype=dtype)
    if not np.all(np.isfinite(out)):
        row, column, channel = (int(i) for i in np.argwhere(~np.isfinite(out))[0])
        found = f"{pixels[row, column, channel]} at row {row}, column {column}, channel {channel}"
        raise OutputError(f"values must be finite as {np.dtype(dtype)}, got {found}")
    return out


def halves(pixels: Real) -> npt.NDArray[np.float16]:
    """
    Return pixels rounded to half, every one within its range; halves as they are.

    Raises:
        OutputError: one is too large or no number.
    """
    if pixels.dtype != np.float16:
        extreme = float(np.max(np.abs(pixels), initial=0.0))
        if not extreme <= HALF_MAX:
            raise OutputError(
                f"values must stay within +-{HALF_MAX:g} to be half floats, got {extreme:g}"
            )
    return finite(pixels, np.float16)


def require_finite(pixels: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """
    Return pixels that were stored, after a check that they are finite, as they were then.

    Raises:
        IntegrityError: one is not.
    """
    if not np.all(np.isfinite(pixels)):
        raise IntegrityError("a frame must hold finite values only")
    return pixels


def counted(pixels: npt.NDArray[Any], shape: tuple[int, int, int] | None) -> npt.NDArray[Any]:
    """
    Return pixels of a file with the channels that the map has: of three that are one, the one.

    Raises:
        IntegrityError: the file holds a map of another shape.
    """
    if shape is None or pixels.shape == tuple(shape):
        return pixels
    alike = pixels.shape[2] == 3 and shape[2] == 1 and bool(np.all(pixels == pixels[..., :1]))
    if pixels.shape[:2] != tuple(shape[:2]) or not alike:
        raise IntegrityError(
            f"a picture must hold a map of shape {tuple(shape)}, got {pixels.shape}"
        )
    return np.ascontiguousarray(pixels[..., :1])


def require_size(data: bytes | memoryview, size: int, name: str) -> None:
    """Refuse a file of another length, which is all that a bare format can tell."""
    if len(data) != size:
        raise IntegrityError(f"a {name} file of this shape must have {size} bytes, got {len(data)}")


def numbered(payloads: Iterable[bytes], count: int, size: int) -> Iterable[tuple[int, bytes]]:
    """
    Yield payloads with their numbers.

    Raises:
        ValueError: they are not `count`, or one has not `size` bytes.
    """
    i = -1
    for i, payload in enumerate(payloads):
        if i >= count or len(payload) != size:
            raise ValueError(f"frame {i} of {count} must have {size} bytes, got {len(payload)}")
        yield i, payload
    if i + 1 != count:
        raise ValueError(f"{count} frames are needed, got {i + 1}")
