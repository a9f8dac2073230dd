"""16-bit PNG against a reader written from the standard, and against Pillow."""

import io
import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from fftocean.errors import IntegrityError
from fftocean.export import png

SHAPES = [(1, 1, 1), (1, 7, 3), (7, 1, 1), (31, 17, 3), (64, 48, 1)]


def by_the_standard(data):
    """
    Return the pixels of any PNG without interlacing and palette, every filter, byte by byte:
    ISO/IEC 15948, 5.3, 9.2 and 9.4.
    """
    assert data[:8] == bytes([137, 80, 78, 71, 13, 10, 26, 10])
    at, packed, header = 8, b"", None
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        name, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(
            name + content
        )
        header = struct.unpack(">IIBBBBB", content) if name == b"IHDR" else header
        packed += content if name == b"IDAT" else b""
        at += 12 + size
    assert name == b"IEND"
    width, height, depth, colour, compression, method, interlace = header
    assert (compression, method, interlace) == (0, 0, 0)
    samples = {0: 1, 2: 3}[colour]
    step = samples * depth // 8
    raw, above, rows = zlib.decompress(packed), [0] * (width * step), []
    for line in range(height):
        kind, *values = raw[line * (1 + width * step) :][: 1 + width * step]
        for i, value in enumerate(values):
            a, b = (values[i - step] if i >= step else 0), above[i]
            c = above[i - step] if i >= step else 0
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            values[i] = (value + [0, a, b, (a + b) // 2, nearest][kind]) % 256
        above = values
        rows.append(values)
    return (
        np.array(rows, dtype=np.uint8)
        .reshape(height, -1)
        .view(">u2")
        .reshape(height, width, samples)
    )


def words(shape, seed=0):
    return np.random.default_rng(seed).integers(0, 2**16, shape, dtype=np.uint16)


@pytest.mark.parametrize("shape", SHAPES)
def test_by_the_standard(shape):
    pixels = words(shape)
    data = png.encode(pixels)
    assert np.array_equal(by_the_standard(data), pixels)
    assert np.array_equal(png.read(data, shape), pixels)


def test_pillow_opens_them():
    """Gray in full; of RGB it keeps the upper bytes, which is why the writer is our own."""
    gray, colour = words((20, 30, 1)), words((20, 30, 3))
    picture = Image.open(io.BytesIO(png.encode(gray)))
    assert picture.mode.startswith("I")
    assert np.array_equal(np.asarray(picture, dtype=np.int64), gray[..., 0])
    picture = Image.open(io.BytesIO(png.encode(colour)))
    picture.load()  # asks every checksum
    assert picture.size == (30, 20)
    assert np.array_equal(np.asarray(picture), colour >> 8)


def test_smooth_water_packs():
    y, x = np.mgrid[:64, :64] / 64.0
    pixels = np.rint(32768 + 20000 * np.sin(6.28 * x) * np.cos(6.28 * y)).astype(np.uint16)[
        ..., None
    ]
    assert len(png.encode(pixels)) < 0.9 * pixels.nbytes
    assert len(png.encode(0 * pixels)) < 0.05 * pixels.nbytes


def test_not_ours():
    """Other depths, other chunks, more pixels than the header says."""
    stream = io.BytesIO()
    Image.fromarray(np.zeros((4, 4, 3), dtype=np.uint8)).save(stream, format="PNG")
    with pytest.raises(
        IntegrityError, match="must be 16 bit gray or RGB, not interlaced, got 8 bit, colour type 2"
    ):
        png.read(stream.getvalue())
    data = png.encode(words((4, 4, 1)))
    with pytest.raises(IntegrityError, match="chunks IHDR, IDAT, IEND"):
        png.read(data[:-12] + png._chunk(b"tEXt", b"a\0b") + data[-12:])
    with pytest.raises(IntegrityError, match=r"must have shape \(5, 4, 1\), got \(4, 4, 1\)"):
        png.read(data, (5, 4, 1))
    head, body = (
        png._chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 16, 0, 0, 0, 0)),
        png._chunk(b"IDAT", zlib.compress(bytes(10_000_000))),
    )
    with pytest.raises(IntegrityError):  # and only as much is unpacked as can be right
        png.read(png.SIGNATURE + head + body + png._chunk(b"IEND", b""))


def test_a_stream_without_its_end_is_refused():
    """All rows are there; the checksum of the stream is not, though that of the chunk is right."""

    def chunk(name, content):
        checksum = struct.pack(">I", zlib.crc32(name + content))
        return struct.pack(">I", len(content)) + name + content + checksum

    header = struct.pack(">IIBBBBB", 4, 3, 16, 0, 0, 0, 0)
    packed = zlib.compress(b"".join(b"\2" + bytes(8) for _ in range(3)))
    for stream, whole in ((packed, True), (packed[:-4], False), (packed[:-1], False)):
        parts = [chunk(b"IHDR", header), chunk(b"IDAT", stream), chunk(b"IEND", b"")]
        data = bytes([137, 80, 78, 71, 13, 10, 26, 10]) + b"".join(parts)
        if whole:
            assert not np.any(png.read(data, (3, 4, 1)))
        else:
            with pytest.raises(IntegrityError, match="and nothing after them"):
                png.read(data, (3, 4, 1))


def test_any_flipped_bit_is_found():
    """Also one in a checksum itself, or in the header, of which the pixels do not tell."""
    data = png.encode(words((3, 5, 1)))
    for at in range(len(data)):
        bent = bytearray(data)
        bent[at] ^= 1 << at % 8
        with pytest.raises(IntegrityError):
            png.read(bytes(bent))
