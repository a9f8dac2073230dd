"""
Type of a file format: limits, file names and functions in one object.

The module of each format makes its object, and `formats.FORMATS` lists them. A missing part is an
error at import.
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
    loop: float = 1.0  # duration of all frames [s]
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
        join: function from the frames' payloads, in order, to the file's bytes.
        split: function from the file's bytes to the frames' payloads.
        facts: function that returns entries of its sidecar beyond those of every sidecar.
        separable: True if damage to the file leaves the payloads of other frames intact.
        require: function that raises a ParameterError for a layout that it cannot have.
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
        name: name in a job file.
        caption: description in words.
        file: path of its files, with {stem} and {frame}; a format with a container has no {frame}.
        numbered: meaning of {frame}: number in the loop, or place in the baked sequence.
        stored: type of its numbers; uint16 holds (v - lo) / (hi - lo) in 65535 steps.
        channels: possible numbers of channels of a map.
        least: smallest number of channels of its files.
        sidecar: path of the sidecar, with {stem}; "" for none.
        sidecar_bytes: function from facts and layout to the sidecar.
        most_levels: function from the larger side of a map to the most mip levels.
        encode: function from (pixels, scale, smaller levels) to the bytes of a frame, or of its
            part in a container.
        decode: function from (bytes, shape or None, scale, number of levels) to the mip levels,
            largest first.
        container: container of all frames, or None for one file a frame.
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
        """True if encoding needs one lo and hi for the whole sequence."""
        return self.stored == "uint16"

    @property
    def suffix(self) -> str:
        """Ending of the name of its file, or of the folder named after the map."""
        first = self.file.split("/")[0].removeprefix("{stem}")
        return first or self.file[self.file.rindex(".") :]

    def letters(self, count: int) -> dict[str, int | None]:
        """Return the map's channel in each channel of the file; None is a constant 1."""
        if self.least == 1:
            return {letter: c for c, letter in enumerate("RGBA"[:count] if count > 1 else "Y")}
        held = {x: c if count > 1 else 0 for c, x in enumerate("RGBA"[: max(count, 3)])}
        return {**held, **({"A": None} if self.least == 4 and count < 4 else {})}


def one_level(_side: int) -> int:
    """Return 1, the number of mip levels of a format that holds only the map itself."""
    return 1


def require_shape(shape: tuple[int, int, int] | None, name: str) -> tuple[int, int, int]:
    """
    Return the shape, which a format that does not store it needs.

    Raises:
        ParameterError: it is None.
    """
    if shape is None:
        raise ParameterError(
            f"format {name} does not store the shape of its frames: shape is required"
        )
    return shape


def as_finite(pixels: Real, dtype: type[np.floating[Any]]) -> npt.NDArray[Any]:
    """
    Return pixels converted to a type, C-contiguous.

    Raises:
        OutputError: one is not finite in that type.
    """
    with np.errstate(over="ignore"):
        out = np.ascontiguousarray(pixels, dtype=dtype)
    if not np.all(np.isfinite(out)):
        row, column, channel = (int(i) for i in np.argwhere(~np.isfinite(out))[0])
        found = f"{pixels[row, column, channel]} at row {row}, column {column}, channel {channel}"
        raise OutputError(f"values must be finite as {np.dtype(dtype)}, got {found}")
    return out


def as_half(pixels: Real) -> npt.NDArray[np.float16]:
    """
    Return pixels rounded to half; halves are unchanged.

    Raises:
        OutputError: one is too large or NaN.
    """
    if pixels.dtype != np.float16:
        extreme = float(np.max(np.abs(pixels), initial=0.0))
        if not extreme <= HALF_MAX:
            raise OutputError(
                f"values must stay within +-{HALF_MAX:g} to be half floats, got {extreme:g}"
            )
    return as_finite(pixels, np.float16)


def require_finite(pixels: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """
    Return decoded pixels, which were finite when they were encoded.

    Raises:
        IntegrityError: one is not finite.
    """
    if not np.all(np.isfinite(pixels)):
        raise IntegrityError("a frame must hold finite values only")
    return pixels


def select_channels(
    pixels: npt.NDArray[Any], shape: tuple[int, int, int] | None
) -> npt.NDArray[Any]:
    """
    Return pixels of a file with the channels of the map: one of three equal channels.

    Raises:
        IntegrityError: the file holds a map of another shape.
    """
    if shape is None or pixels.shape == tuple(shape):
        return pixels
    alike = pixels.shape[2] == 3 and shape[2] == 1 and bool(np.all(pixels == pixels[..., :1]))
    if pixels.shape[:2] != tuple(shape[:2]) or not alike:
        raise IntegrityError(
            f"an image must hold a map of shape {tuple(shape)}, got {pixels.shape}"
        )
    return np.ascontiguousarray(pixels[..., :1])


def require_size(data: bytes | memoryview, size: int, name: str) -> None:
    """Raise if a file has another length, the only check of a format without a header."""
    if len(data) != size:
        raise IntegrityError(f"a {name} file of this shape must have {size} bytes, got {len(data)}")


def enumerate_payloads(
    payloads: Iterable[bytes], count: int, size: int
) -> Iterable[tuple[int, bytes]]:
    """
    Yield the number and the bytes of each payload.

    Raises:
        ValueError: their number is not `count`, or the length of one is not `size`.
    """
    i = -1
    for i, payload in enumerate(payloads):
        if i >= count or len(payload) != size:
            raise ValueError(f"frame {i} of {count} must have {size} bytes, got {len(payload)}")
        yield i, payload
    if i + 1 != count:
        raise ValueError(f"{count} frames are needed, got {i + 1}")
