"""
Zarr version 3: a map as one array (frame, row, column, channel) of float32.

Each frame is one chunk, with its CRC-32C. A missing chunk reads as the fill value: it is NaN,
because 0 would be mistaken for a flat sea.
"""

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError
from fftocean.export.crc32c import checksum
from fftocean.export.form import (
    Format,
    Layout,
    Scale,
    as_finite,
    one_level,
    require_finite,
    require_shape,
)
from fftocean.files import as_json

CHUNK = "c/{frame}/0/0/0"


def encode_chunk(pixels: npt.NDArray[np.float32]) -> bytes:
    """
    Return a frame's chunk: its floats, little-endian, and their checksum.

    Source: the Zarr core protocol 3.1; the codecs bytes 1.0 and crc32c 1.0.
    Pinned by tests/export/test_zarr3.py: the zarr library reads it.
    """
    content = pixels.astype("<f4", copy=False).tobytes()
    return content + struct.pack("<I", checksum(content))


def decode_chunk(data: bytes, shape: tuple[int, int, int]) -> npt.NDArray[np.float32]:
    """
    Return a frame of a given shape from its chunk.

    Raises:
        IntegrityError: the chunk is cut or damaged.
    """
    size = 4 * int(np.prod(shape))
    if len(data) != size + 4:
        raise IntegrityError(
            f"a Zarr chunk of shape {tuple(shape)} must have {size + 4} bytes, got {len(data)}"
        )
    if struct.unpack("<I", data[size:])[0] != checksum(data[:size]):
        raise IntegrityError("a Zarr chunk must match the checksum at its end, and does not")
    return np.frombuffer(data, dtype="<f4", count=size // 4).reshape(shape).astype(np.float32)


def metadata(shape: tuple[int, int, int, int], attributes: Mapping[str, Any]) -> bytes:
    """Return the zarr.json of the array."""
    tree = {
        "zarr_format": 3,
        "node_type": "array",
        "shape": list(shape),
        "data_type": "float32",
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [1, *shape[1:]]}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": "NaN",
        "codecs": [{"name": "bytes", "configuration": {"endian": "little"}}, {"name": "crc32c"}],
        "dimension_names": ["frame", "row", "column", "channel"],
        "attributes": dict(attributes),
    }
    return as_json(tree)


def _encode_frame(pixels: Real, _scale: Scale, _levels: Sequence[Real]) -> bytes:
    return encode_chunk(as_finite(pixels, np.float32))


def _decode_frame(
    data: bytes, shape: tuple[int, int, int] | None, _scale: Scale, _levels: int
) -> list[npt.NDArray[Any]]:
    return [require_finite(decode_chunk(data, require_shape(shape, "zarr")))]


def _sidecar(facts: Mapping[str, Any], layout: Layout) -> bytes:
    named = {**facts, "file": facts["file"].removesuffix("/" + CHUNK)}
    return metadata((layout.frames, *layout.frame), named)


ZARR = Format(
    name="zarr",
    caption="Zarr 3, a chunk a frame",
    file="{stem}.zarr/" + CHUNK,
    numbered="place",
    stored="float32",
    channels=(1, 3, 4),
    least=1,
    sidecar="{stem}.zarr/zarr.json",
    sidecar_bytes=_sidecar,
    most_levels=one_level,
    encode=_encode_frame,
    decode=_decode_frame,
    container=None,
)
