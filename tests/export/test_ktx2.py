"""
KTX 2.0 against a reader written from the Khronos specifications: header, index, descriptor,
key/values, padding, texels.
"""

import math
import struct
from fractions import Fraction

import numpy as np
import pytest

from fftocean.errors import IntegrityError
from fftocean.export.formats import assemble, encode, payloads
from fftocean.export.profiles import PROFILES


def by_the_specification(data):
    """
    Return the images of a KTX 2.0 file after asserting every rule of KTX 2.0 (sections 3 to 5) and
    KDF 1.4 (chapter 5) for an uncompressed array.
    """
    u32 = lambda at: struct.unpack_from("<I", data, at)[0]  # noqa: E731
    u64 = lambda at: struct.unpack_from("<Q", data, at)[0]  # noqa: E731
    assert data[:12] == bytes(
        [0xAB, 0x4B, 0x54, 0x58, 0x20, 0x32, 0x30, 0xBB, 0x0D, 0x0A, 0x1A, 0x0A]
    )
    vk_format, type_size, width, height, depth, layers, faces, levels, scheme = (
        u32(12 + 4 * i) for i in range(9)
    )
    assert vk_format == 97  # VK_FORMAT_R16G16B16A16_SFLOAT
    assert type_size == 2
    assert width > 0
    assert height > 0
    assert depth == 0
    assert layers > 0  # a 2-D array
    assert faces == 1
    assert 1 <= levels <= 1 + math.floor(math.log2(max(width, height)))
    assert scheme == 0
    dfd, dfd_size, kvd, kvd_size = (u32(48 + 4 * i) for i in range(4))
    assert (u64(64), u64(72)) == (0, 0)  # no supercompression, no global data
    index = [(u64(80 + 24 * p), u64(88 + 24 * p), u64(96 + 24 * p)) for p in range(levels)]
    # data format descriptor
    assert dfd == 80 + 24 * levels
    assert u32(dfd) == dfd_size
    vendor_type, version, block = struct.unpack_from("<IHH", data, dfd + 4)
    assert (vendor_type, version, block) == (0, 2, dfd_size - 4)
    model, primaries, transfer, flags = data[dfd + 12 : dfd + 16]
    assert (model, transfer, flags) == (1, 1, 0)  # RGBSDA, linear, straight alpha
    assert primaries == 0  # unspecified: this is no colour
    assert data[dfd + 16 : dfd + 20] == bytes(4)  # a texel block of 1 x 1 x 1 x 1
    assert data[dfd + 20 : dfd + 28] == bytes([8, 0, 0, 0, 0, 0, 0, 0])
    samples = (block - 24) // 16
    assert block == 24 + 16 * samples == 88
    for s, channel in enumerate((0, 1, 2, 15)):
        offset, length, kind, *position = struct.unpack_from("<HBB4B", data, dfd + 28 + 16 * s)
        lower, upper = struct.unpack_from("<ff", data, dfd + 36 + 16 * s)
        assert (offset, length + 1, kind & 0xF, position) == (16 * s, 16, channel, [0, 0, 0, 0])
        assert kind >> 4 == 0b1100  # float, signed; not linear-in-spite-of-transfer, not exponent
        assert (lower, upper) == (-1.0, 1.0)
    # key/value data
    assert kvd == dfd + dfd_size
    assert kvd % 4 == 0
    values, at = {}, kvd
    while at < kvd + kvd_size:
        size = u32(at)
        key, _, value = data[at + 4 : at + 4 + size].partition(b"\0")
        assert not any(data[at + 4 + size : at + 4 + size + -size % 4])
        values[key.decode()] = value
        at += 4 + size + -size % 4
    assert at == kvd + kvd_size
    assert list(values) == sorted(values)
    assert values["KTXorientation"] in (b"rd\0", b"ru\0")
    assert values["KTXwriter"].startswith(b"fftocean ")
    assert values["KTXwriter"].endswith(b"\0")
    # levels: the smallest first, each on a multiple of lcm(8, 4), zeros between, the largest to the
    # end
    end, images = at, []
    for p in reversed(range(levels)):
        offset, length, plain = index[p]
        w, h = max(1, width >> p), max(1, height >> p)
        assert offset % 8 == 0
        assert 0 <= offset - end < 8
        assert not any(data[end:offset])
        assert length == plain == layers * h * w * 8
        images.insert(
            0,
            np.frombuffer(data, dtype="<f2", count=length // 2, offset=offset).reshape(
                layers, h, w, 4
            ),
        )
        end = offset + length
    assert end == len(data)
    return images, values


def loop(frames, rows, columns, channels, levels, **more):
    rng = np.random.default_rng(7)
    chains = [
        [
            rng.standard_normal((max(1, rows >> p), max(1, columns >> p), channels)).astype(
                np.float32
            )
            for p in range(levels)
        ]
        for _ in range(frames)
    ]
    parts = [encode("ktx2", chain[0], levels=chain[1:]) for chain in chains]
    files = assemble(
        "ktx2", parts, stem="m", shape=(frames, rows, columns, channels), levels=levels, **more
    )
    return chains, parts, bytes(files["m.ktx2"])


@pytest.mark.parametrize(
    ("frames", "rows", "columns", "channels", "levels"),
    [
        (1, 1, 1, 1, 1),
        (3, 8, 8, 3, 1),
        (2, 16, 4, 3, 5),
        (5, 13, 7, 4, 3),
        (4, 9, 9, 1, 2),
        (1, 5, 3, 4, 3),
    ],
)
def test_by_the_specification(frames, rows, columns, channels, levels):
    chains, parts, data = loop(frames, rows, columns, channels, levels)
    images, _ = by_the_specification(data)
    for i, chain in enumerate(chains):
        for level, image in zip(chain, images, strict=True):
            halves = level.astype(np.float16)
            assert np.array_equal(
                image[i, ..., :channels] if channels > 1 else image[i, ..., :1], halves
            )
            if channels < 4:
                assert np.all(image[i, ..., 3] == 1.0)
            if channels == 1:
                assert np.array_equal(image[i, ..., 1], image[i, ..., 0])
    assert payloads("ktx2", data, shape=(frames, rows, columns, channels), levels=levels) == parts


@pytest.mark.parametrize(("seconds", "frames"), [(16.0, 240), (12.5, 50), (7.3, 11)])
def test_it_says_how_long_a_frame_lasts(seconds, frames):
    _, values = by_the_specification(loop(frames, 2, 2, 1, 1, loop=seconds)[2])
    duration, timescale, repeats = struct.unpack("<3I", values["KTXanimData"])
    assert Fraction(duration, timescale) * frames == Fraction(str(seconds))
    assert repeats == 0  # for ever


def test_it_says_which_way_is_up():
    assert (
        by_the_specification(loop(1, 2, 2, 1, 1, profile=PROFILES["three"])[2])[1]["KTXorientation"]
        == b"rd\0"
    )
    assert (
        by_the_specification(loop(1, 2, 2, 1, 1, profile=PROFILES["babylon"])[2])[1][
            "KTXorientation"
        ]
        == b"ru\0"
    )


@pytest.mark.parametrize("at", [0, 12, 20, 24, 32, 40, 44, 48, 80, 88, 96, 104 + 12, 104 + 28])
def test_a_bent_header_is_refused(at):
    data = bytearray(loop(2, 4, 4, 3, 1)[2])
    data[at] ^= 1
    with pytest.raises(IntegrityError):
        payloads("ktx2", bytes(data), shape=(2, 4, 4, 3))


def test_levels_that_overlap_are_refused():
    data = bytearray(loop(1, 4, 4, 3, 3)[2])
    index = [struct.unpack_from("<3Q", data, 80 + 24 * p) for p in range(3)]
    struct.pack_into("<Q", data, 80 + 24 * 2, index[1][0])  # the smallest where the next one is
    with pytest.raises(IntegrityError, match="must end with them"):
        payloads("ktx2", bytes(data), shape=(1, 4, 4, 3), levels=3)
