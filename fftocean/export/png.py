"""
PNG with 16 bits a channel, gray or RGB, which Pillow and imageio cannot write.

Each row holds its differences from the row above (filter 2), which are small on a smooth sea; one
IDAT chunk holds them all.
"""

import struct
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError
from fftocean.export import quantised
from fftocean.export.form import Format, Scale, one_level

SIGNATURE = b"\x89PNG\r\n\x1a\n"
COLOUR = {1: 0, 3: 2}  # channels -> PNG's colour type: gray, RGB
UP = 2  # PNG's filter: minus the row above, byte by byte


def encode(pixels: npt.NDArray[np.uint16]) -> bytes:
    """
    Encode (rows, columns, 1 or 3) of uint16 as a PNG file, row 0 on top.

    Source: ISO/IEC 15948 (PNG), 11.2 and 9.2.
    Pinned by tests/export/test_png.py, against a reader written from that text, and Pillow.
    """
    rows, columns, channels = pixels.shape
    lines = np.ascontiguousarray(pixels.astype(">u2")).view(np.uint8).reshape(rows, -1)
    filtered = np.empty((rows, 1 + lines.shape[1]), dtype=np.uint8)
    filtered[:, 0] = UP
    filtered[0, 1:] = lines[0]
    np.subtract(lines[1:], lines[:-1], out=filtered[1:, 1:])  # modulo 256, as PNG defines it
    header = struct.pack(">IIBBBBB", columns, rows, 16, COLOUR[channels], 0, 0, 0)
    packer = zlib.compressobj(
        1, zlib.DEFLATED, 15, 9, zlib.Z_RLE
    )  # noise has no repeated strings: Huffman coding alone is faster, and smaller
    packed = packer.compress(filtered.tobytes()) + packer.flush()
    return SIGNATURE + _chunk(b"IHDR", header) + _chunk(b"IDAT", packed) + _chunk(b"IEND", b"")


def read(data: bytes, shape: tuple[int, int, int] | None = None) -> npt.NDArray[np.uint16]:
    """
    Return the (rows, columns, channels) uint16 of a file of `encode`.

    Args:
        data: the file.
        shape: required shape, checked before anything is unpacked.

    Raises:
        IntegrityError: the file is cut or damaged, of another shape, or from another program.
    """
    try:
        chunks = _chunks(data)
        if [name for name, _ in chunks] != [b"IHDR", b"IDAT", b"IEND"]:
            raise IntegrityError(
                "a PNG file of a bake must have chunks IHDR, IDAT, IEND, "
                f"got {b', '.join(n for n, _ in chunks)!r:.100}"
            )
        columns, rows, depth, colour, *rest = struct.unpack(">IIBBBBB", chunks[0][1])
        found = (rows, columns, {kind: count for count, kind in COLOUR.items()}.get(colour, 0))
        if depth != 16 or any(rest) or not found[2]:
            raise IntegrityError(
                "a PNG file of a bake must be 16 bit gray or RGB, not interlaced, "
                f"got {depth} bit, colour type {colour}"
            )
        if shape is not None and found != tuple(shape):
            raise IntegrityError(f"a PNG image must have shape {tuple(shape)}, got {found}")
        width = 2 * columns * found[2]
        unpacker = zlib.decompressobj()
        filtered = np.frombuffer(
            unpacker.decompress(chunks[1][1], rows * (1 + width) + 1), dtype=np.uint8
        ).reshape(rows, 1 + width)
        if not unpacker.eof or np.any(filtered[:, 0] != UP):
            raise IntegrityError(
                "a PNG file of a bake must hold differences from the row above "
                "and nothing after them"
            )
        lines: npt.NDArray[Any] = np.add.accumulate(filtered[:, 1:], axis=0, dtype=np.uint8)
        return np.ascontiguousarray(lines).view(">u2").reshape(found).astype(np.uint16)
    except (struct.error, zlib.error, ValueError) as error:
        raise IntegrityError(f"a PNG image cannot be read: {error}") from None


def _chunk(name: bytes, content: bytes) -> bytes:
    """Return the bytes of a chunk: length, name, content, and the checksum of name and content."""
    return (
        struct.pack(">I", len(content))
        + name
        + content
        + struct.pack(">I", zlib.crc32(content, zlib.crc32(name)))
    )


def _chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    """Return name and content of every chunk of a file after verifying its checksum."""
    if data[:8] != SIGNATURE:
        raise IntegrityError("a PNG file must begin with PNG's signature")
    at, found = 8, []
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        content = data[at + 8 : at + 8 + size]
        if _chunk(name, content) != data[at : at + 12 + size]:
            raise IntegrityError(f"chunk {name!r} of a PNG file is cut or damaged")
        found.append((name, content))
        at += 12 + size
    return found


def _encode_frame(pixels: Real, scale: Scale, _levels: Sequence[Real]) -> bytes:
    return encode(quantised.to_steps(pixels, scale.lo, scale.hi))


def _decode_frame(
    data: bytes, shape: tuple[int, int, int] | None, scale: Scale, _levels: int
) -> list[npt.NDArray[Any]]:
    return [quantised.from_steps(read(data, shape), scale.lo, scale.hi)]


PNG16 = Format(
    name="png16",
    caption="PNG, 16 bit, scaled",
    file="{stem}/{frame:04d}.png",
    numbered="frame",
    stored="uint16",
    channels=(1, 3),
    least=1,
    sidecar="{stem}.json",
    sidecar_bytes=quantised.sidecar,
    most_levels=one_level,
    encode=_encode_frame,
    decode=_decode_frame,
    container=None,
)
