"""
KTX 2.0: the frames of a loop as one texture array of half-float RGBA, with optional mip levels.

The file holds the levels from the smallest to the largest, and in each level all frames; a frame's
own bytes are its levels, largest first. `encode_float` writes one picture of single precision.
"""

import struct
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

import numpy as np

import fftocean
from fftocean.arrays import Real
from fftocean.errors import IntegrityError
from fftocean.export import bare
from fftocean.export.bare import TEXEL, level_sizes
from fftocean.export.form import Container, Format, Layout, enumerate_payloads

IDENTIFIER = b"\xabKTX 20\xbb\r\n\x1a\n"
RGBA16F = 97  # VK_FORMAT_R16G16B16A16_SFLOAT
FLOATS = {2: 103, 4: 109}  # by channels: VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT
# format, type size, width, height, depth, layers, faces, levels, scheme; where DFD, key/values,
# global data are
HEADER = "<9I4I2Q"


def pack(
    frames: Iterable[tuple[int, bytes]],
    count: int,
    rows: int,
    columns: int,
    levels: int,
    *,
    loop: float,
    row0_on_top: bool,
) -> memoryview:
    """
    Return one file with the frames of a loop.

    Args:
        frames: number and bytes of each frame: its levels, largest first, each (rows, columns, 4)
            little-endian halves.
        count, rows, columns, levels: their numbers.
        loop: duration of all frames [s].
        row0_on_top: True if a viewer should show row 0 on top.

    Source: the KTX File Format Specification 2.0.4, and the Khronos Data Format Specification 1.4
    for the descriptor. Pinned by tests/export/test_ktx2.py, against a reader written from those
    specifications.
    """
    descriptor, values = _descriptor(), _key_values(count, loop, row0_on_top)
    first = 12 + struct.calcsize(HEADER) + 24 * levels
    sizes = [r * c * TEXEL for r, c in level_sizes(rows, columns, levels)]
    at = first + len(descriptor) + len(values)
    offsets = [0] * levels
    for level in reversed(
        range(levels)
    ):  # smallest first, so that a streaming reader can show something early
        offsets[level] = at = -(-at // TEXEL) * TEXEL
        at += count * sizes[level]
    out = bytearray(at)
    places = (first, len(descriptor), first + len(descriptor), len(values), 0, 0)
    out[:12] = IDENTIFIER
    struct.pack_into(HEADER, out, 12, RGBA16F, 2, columns, rows, 0, count, 1, levels, 0, *places)
    for level, (offset, size) in enumerate(zip(offsets, sizes, strict=True)):
        struct.pack_into(
            "<3Q", out, first - 24 * (levels - level), offset, count * size, count * size
        )
    out[first : first + len(descriptor) + len(values)] = descriptor + values
    for i, frame in frames:
        start = 0
        for offset, size in zip(offsets, sizes, strict=True):
            out[offset + i * size : offset + (i + 1) * size] = frame[start : start + size]
            start += size
    return memoryview(out)


def unpack(
    data: bytes | memoryview, count: int, rows: int, columns: int, levels: int
) -> list[bytes]:
    """
    Return the bytes of each frame, its levels largest first, from a file of `pack`.

    Raises:
        IntegrityError: the file is cut or damaged, or holds another texture.
    """
    data = memoryview(data)
    try:
        found = struct.unpack_from(HEADER, data, 12)
        if data[:12] != IDENTIFIER or found[:9] != (
            RGBA16F,
            2,
            columns,
            rows,
            0,
            count,
            1,
            levels,
            0,
        ):
            raise IntegrityError(
                f"a KTX2 file must hold {count} layers of {columns} x {rows} halves, "
                f"{levels} levels, got {found[:9]}"
            )
        first = 12 + struct.calcsize(HEADER)
        index = [struct.unpack_from("<3Q", data, first + 24 * level) for level in range(levels)]
        sizes = [r * c * TEXEL for r, c in level_sizes(rows, columns, levels)]
        end = max(offset + length for offset, length, _ in index)
        lengths_right = all(
            length == plain == count * size
            for (_, length, plain), size in zip(index, sizes, strict=True)
        )
        overlap = any(
            low[0] + low[1] > high[0] for low, high in zip(index[1:], index[:-1], strict=True)
        )
        if end != len(data) or not lengths_right or overlap or index[-1][0] < first + 24 * levels:
            raise IntegrityError(
                f"a KTX2 file of {levels} levels must end with them, at byte {end}, "
                f"got {len(data)} bytes"
            )
        if bytes(data[found[9] : found[9] + found[10]]) != _descriptor():
            raise IntegrityError(
                "a KTX2 file of a bake must describe its texels as four half floats"
            )
    except struct.error as error:
        raise IntegrityError(f"a KTX2 file is cut: {error}") from None
    return [
        b"".join(
            data[offset + i * size : offset + (i + 1) * size]
            for (offset, _, _), size in zip(index, sizes, strict=True)
        )
        for i in range(count)
    ]


def encode_float(pixels: Real) -> bytes:
    """
    Return one 2-D picture of single precision, row 0 first, without mip levels.

    Args:
        pixels: (rows, columns, 2 or 4) float32.

    Pinned by tests/export/test_ktx2_float.py, against a reader written from the specifications.
    """
    return _float_head(pixels.shape) + np.ascontiguousarray(pixels, "<f4").tobytes()


def decode_float(data: bytes, shape: tuple[int, ...]) -> Real:
    """
    Return the pixels of a file of `encode_float`.

    Raises:
        IntegrityError: the file is cut or damaged, or holds another texture.
    """
    head, size = _float_head(shape), 4 * int(np.prod(shape))
    written_by = head.index(b"KTXwriter")
    if len(data) != len(head) + size or data[:written_by] != head[:written_by]:
        raise IntegrityError(
            f"a KTX2 file must hold one picture of {shape[1]} x {shape[0]} texels of {shape[2]} "
            f"floats, in {len(head) + size} bytes"
        )
    return np.frombuffer(data, "<f4", offset=len(head)).reshape(shape)


def _float_head(shape: tuple[int, ...]) -> bytes:
    """Return all of a file of `encode_float` before the texels."""
    rows, columns, channels = shape
    texel = 4 * channels
    descriptor = _descriptor(channels, 32)
    values = _entries((b"KTXorientation", b"rd\0"), _WRITER)
    first = 12 + struct.calcsize(HEADER) + 24
    places = (first, len(descriptor), first + len(descriptor), len(values), 0, 0)
    head = IDENTIFIER
    head += struct.pack(HEADER, FLOATS[channels], 4, columns, rows, 0, 0, 1, 1, 0, *places)
    at = -(-(first + len(descriptor) + len(values)) // texel) * texel
    size = rows * columns * texel
    head += struct.pack("<3Q", at, size, size) + descriptor + values
    return head + bytes(at - len(head))


def _descriptor(channels: int = 4, bits: int = 16) -> bytes:
    """Return the description of a texel: signed floats, R, G (, B, A), linear."""
    model, primaries, linear, straight_alpha = (
        1,
        0,
        1,
        0,
    )  # RGBSDA; unspecified, because the data are not colour
    block = struct.pack(
        "<2I4B4B8B",
        0,
        (24 + 16 * channels) << 16 | 2,
        model,
        primaries,
        linear,
        straight_alpha,
        0,
        0,
        0,
        0,
        channels * bits // 8,
        *[0] * 7,
    )
    for i, channel in enumerate((0, 1, 2, 15)[:channels]):  # R, G, B, A
        lower, upper = (
            0xBF800000,
            0x3F800000,
        )  # -1.0 and 1.0: the values that a viewer shows as black and as full intensity
        block += struct.pack(
            "<HBB4BII", bits * i, bits - 1, 0xC0 | channel, 0, 0, 0, 0, lower, upper
        )  # 0xC0: float, signed
    return struct.pack("<I", 4 + len(block)) + block


def _key_values(count: int, loop: float, row0_on_top: bool) -> bytes:
    """Return duration of a frame, orientation and writer, in the order of the keys."""
    exact = Fraction(loop).limit_denominator(1000)
    # Frame time, its unit as 1 / timescale, and the number of repetitions (0: endless).
    animation = struct.pack("<3I", exact.numerator, exact.denominator * count, 0)
    orientation = b"rd\0" if row0_on_top else b"ru\0"
    return _entries((b"KTXanimData", animation), (b"KTXorientation", orientation), _WRITER)


_WRITER = (b"KTXwriter", f"fftocean {fftocean.__version__}".encode() + b"\0")


def _entries(*entries: tuple[bytes, bytes]) -> bytes:
    """Return keys and values, each padded to a multiple of 4 bytes."""
    out = b""
    for key, value in entries:
        entry = key + b"\0" + value
        out += struct.pack("<I", len(entry)) + entry + bytes(-len(entry) % 4)
    return out


def _join(payloads: Iterable[bytes], layout: Layout) -> memoryview:
    rows, columns, levels = layout.rows, layout.columns, layout.levels
    return pack(
        enumerate_payloads(payloads, layout.frames, bare.frame_bytes(layout)),
        layout.frames,
        rows,
        columns,
        levels,
        loop=layout.loop,
        row0_on_top=layout.row0_on_top,
    )


def _split(data: bytes | memoryview, layout: Layout) -> list[bytes]:
    return unpack(data, layout.frames, layout.rows, layout.columns, layout.levels)


def _facts(layout: Layout) -> Mapping[str, Any]:
    return bare.facts(layout)


KTX2 = Format(
    name="ktx2",
    caption="KTX 2.0 array of half RGBA",
    file="{stem}.ktx2",
    numbered="frame",
    stored="float16",
    channels=(1, 3, 4),
    least=4,
    sidecar="{stem}.json",
    sidecar_bytes=bare.sidecar,
    most_levels=int.bit_length,
    encode=bare.encode_rgba,
    decode=bare.decoder("ktx2"),
    container=Container(
        join=_join, split=_split, facts=_facts, separable=True, require=bare.any_layout
    ),
)
