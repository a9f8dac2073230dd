"""Files without a header: half RGBA of all frames (`bin`), and 16-bit heights of one (`r16`)."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError, ParameterError
from fftocean.export import quantised
from fftocean.export.form import (
    Container,
    Format,
    Layout,
    Scale,
    as_half,
    enumerate_payloads,
    one_level,
    require_finite,
    require_shape,
    require_size,
    select_channels,
)
from fftocean.files import as_json

TEXEL = 8  # bytes of four halves; levels of a KTX2 file begin at multiples of it


def level_sizes(rows: int, columns: int, levels: int) -> list[tuple[int, int]]:
    """Return (rows, columns) of each mip level, largest first: halved, rounded down, at least 1."""
    return [(max(1, rows >> level), max(1, columns >> level)) for level in range(levels)]


def frame_bytes(layout: Layout) -> int:
    """Return the bytes of a frame of half RGBA with its levels."""
    sizes = level_sizes(layout.rows, layout.columns, layout.levels)
    return sum(TEXEL * rows * columns for rows, columns in sizes)


def encode_rgba(pixels: Real, _scale: Scale, levels: Sequence[Real]) -> bytes:
    """
    Return a frame as half RGBA, its smaller levels behind it.

    Raises:
        ParameterError: a level has the wrong size.
    """
    sizes = level_sizes(pixels.shape[0], pixels.shape[1], 1 + len(levels))
    for level, size in zip(levels, sizes[1:], strict=True):
        if level.shape != (*size, pixels.shape[2]):
            wanted = (*size, pixels.shape[2])
            raise ParameterError(f"a mip level must have shape {wanted}, got {level.shape}")
    return b"".join(_rgba(as_half(part)).tobytes() for part in (pixels, *levels))


def _rgba(pixels: npt.NDArray[np.float16]) -> npt.NDArray[np.float16]:
    """Return one or three channels as four: one channel is repeated in R, G and B, and A is 1."""
    out = np.ones((*pixels.shape[:2], 4), dtype="<f2")
    out[..., : max(3, pixels.shape[2])] = pixels
    return out


def decoder(
    name: str,
) -> Callable[[bytes, tuple[int, int, int] | None, Scale, int], list[npt.NDArray[Any]]]:
    """Return the inverse of `encode_rgba`, with a format's name in its messages."""

    def decode(
        data: bytes, shape: tuple[int, int, int] | None, _scale: Scale, levels: int
    ) -> list[npt.NDArray[Any]]:
        rows, columns, count = require_shape(shape, name)
        sizes = level_sizes(rows, columns, levels)
        require_size(data, sum(TEXEL * r * c for r, c in sizes), name)
        found, at = [], 0
        for r, c in sizes:
            words = np.frombuffer(data, dtype="<f2", count=4 * r * c, offset=at)
            texels = words.reshape(r, c, 4).astype(np.float16)
            if count < 4 and np.any(texels[..., 3] != 1.0):
                raise IntegrityError(
                    f"format {name} must have a 1 in A where a map has {count} channels"
                )
            held = texels if count == 4 else texels[..., :3]
            found.append(require_finite(select_channels(held, (r, c, count))))
            at += TEXEL * r * c
        return found

    return decode


def facts(layout: Layout) -> Mapping[str, Any]:
    """Return the facts about the bytes of a container of half RGBA, for its sidecar."""
    return {
        "dtype": "float16, little-endian",
        "shape": [layout.frames, layout.rows, layout.columns, 4],
        "levels": layout.levels,
    }


def sidecar(found: Mapping[str, Any], _layout: Layout) -> bytes:
    """Return the sidecar of a container."""
    return as_json(found)


def any_layout(_layout: Layout) -> None:
    """Accept any layout."""


def _join(payloads: Iterable[bytes], layout: Layout) -> memoryview:
    size = frame_bytes(layout)
    whole = memoryview(bytearray(layout.frames * size))
    for i, payload in enumerate_payloads(payloads, layout.frames, size):
        whole[i * size : (i + 1) * size] = payload
    return whole


def _split(data: bytes | memoryview, layout: Layout) -> list[bytes]:
    size = frame_bytes(layout)
    require_size(data, layout.frames * size, "bin")
    return [bytes(data[i * size : (i + 1) * size]) for i in range(layout.frames)]


BIN = Format(
    name="bin",
    caption="bare half RGBA and JSON",
    file="{stem}.bin",
    numbered="frame",
    stored="float16",
    channels=(1, 3, 4),
    least=4,
    sidecar="{stem}.json",
    sidecar_bytes=sidecar,
    most_levels=one_level,
    encode=encode_rgba,
    decode=decoder("bin"),
    container=Container(join=_join, split=_split, facts=facts, separable=True, require=any_layout),
)


def _encode_words(pixels: Real, scale: Scale, _levels: Sequence[Real]) -> bytes:
    return quantised.to_steps(pixels, scale.lo, scale.hi).astype("<u2").tobytes()


def _decode_words(
    data: bytes, shape: tuple[int, int, int] | None, scale: Scale, _levels: int
) -> list[npt.NDArray[Any]]:
    rows, columns, count = require_shape(shape, "r16")
    require_size(data, 2 * rows * columns * count, "r16")
    words = np.frombuffer(data, dtype="<u2").reshape(rows, columns, count)
    return [quantised.from_steps(words, scale.lo, scale.hi)]


R16 = Format(
    name="r16",
    caption="bare 16 bit, scaled",
    file="{stem}/{frame:04d}.r16",
    numbered="frame",
    stored="uint16",
    channels=(1,),
    least=1,
    sidecar="{stem}.json",
    sidecar_bytes=quantised.sidecar,
    most_levels=one_level,
    encode=_encode_words,
    decode=_decode_words,
    container=None,
)
