"""
Atlas of frames in one OpenEXR image, with a gutter of repeated texels around each frame.

Near a frame's edge a bilinear sampler reads the texel beyond it. In an atlas that texel belongs to
another frame; the gutter repeats the texel of the frame's opposite edge there, so that the frame
wraps. An engine that cuts the atlas into the layers of an array needs no gutter.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError, ParameterError
from fftocean.export import bare, exr
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

LARGEST_SIDE = 16384  # of a texture on current graphics cards


def tiles(frames: int, rows: int, columns: int, gutter: int = 0) -> tuple[int, int]:
    """
    Return the numbers of frames across and down, as square as possible, without an empty cell.

    An engine would play an empty cell as a frame.

    Raises:
        ParameterError: no such arrangement fits in a texture.
    """
    high, wide = rows + 2 * gutter, columns + 2 * gutter
    fitting = [
        (across, frames // across)
        for across in range(1, frames + 1)
        if frames % across == 0
        and across * wide <= LARGEST_SIDE
        and frames // across * high <= LARGEST_SIDE
    ]
    if not fitting:
        raise ParameterError(
            f"{frames} frames of {wide} x {high} do not fill an atlas of at most "
            f"{LARGEST_SIDE} x {LARGEST_SIDE}: "
            "choose a number of frames with more divisors, fewer or smaller frames, or another "
            "format"
        )
    return min(fitting, key=lambda found: (max(found[0] * wide, found[1] * high), found))


def _tiles(layout: Layout) -> tuple[int, int]:
    return tiles(layout.frames, layout.rows, layout.columns, layout.gutter)


def _require(layout: Layout) -> None:
    _tiles(layout)


def _join(payloads: Iterable[bytes], layout: Layout) -> bytes:
    across, down = _tiles(layout)
    rows, columns, channels = layout.frame
    g = layout.gutter
    high, wide = rows + 2 * g, columns + 2 * g
    image = np.empty((down, high, across, wide, channels), dtype=np.float16)
    for i, payload in enumerate_payloads(payloads, layout.frames, 2 * rows * columns * channels):
        frame = np.frombuffer(payload, dtype="<f2").reshape(rows, columns, channels)
        around = np.pad(frame, ((g, g), (g, g), (0, 0)), mode="wrap")
        image[i // across, :, i % across] = around
    return exr.encode(image.reshape(down * high, across * wide, channels), periodic=False)


def _split(data: bytes | memoryview, layout: Layout) -> list[bytes]:
    across, down = _tiles(layout)
    rows, columns, channels = layout.frame
    g = layout.gutter
    high, wide = rows + 2 * g, columns + 2 * g
    pixels = exr.read(bytes(data), (down * high, across * wide))
    if pixels.dtype != np.float16:
        raise IntegrityError(f"format exr-atlas must hold float16, got {pixels.dtype}")
    whole = select_channels(pixels, (down * high, across * wide, channels))
    cells = whole.reshape(down, high, across, wide, channels)
    parts = []
    for i in range(layout.frames):
        cell = cells[i // across, :, i % across]
        frame = cell[g : g + rows, g : g + columns]
        if not np.array_equal(np.pad(frame, ((g, g), (g, g), (0, 0)), mode="wrap"), cell):
            raise IntegrityError(f"frame {i} of an atlas must be repeated around its edges")
        parts.append(frame.astype("<f2").tobytes())
    return parts


def _facts(layout: Layout) -> Mapping[str, Any]:
    across, down = _tiles(layout)
    return {
        "tiles": [across, down],
        "gutter": layout.gutter,
        "order": "frames from left to right, then down",
    }


def _encode(pixels: Real, _scale: Scale, _levels: Sequence[Real]) -> bytes:
    return as_half(pixels).astype("<f2", copy=False).tobytes()


def _decode(
    data: bytes, shape: tuple[int, int, int] | None, _scale: Scale, _levels: int
) -> list[npt.NDArray[Any]]:
    rows, columns, count = require_shape(shape, "exr-atlas")
    require_size(data, 2 * rows * columns * count, "exr-atlas")
    words = np.frombuffer(data, dtype="<f2").reshape(rows, columns, count)
    return [require_finite(words.astype(np.float16))]


EXR_ATLAS = Format(
    name="exr-atlas",
    caption="one OpenEXR of all frames",
    file="{stem}.exr",
    numbered="frame",
    stored="float16",
    channels=(1, 3, 4),
    least=3,
    sidecar="{stem}.json",
    sidecar_bytes=bare.sidecar,
    most_levels=one_level,
    encode=_encode,
    decode=_decode,
    container=Container(join=_join, split=_split, facts=_facts, separable=False, require=_require),
)
