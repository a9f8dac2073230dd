"""One picture of single precision as KTX 2.0, against a reader written from the specification."""

import struct

import numpy as np
import pytest

from fftocean.errors import IntegrityError
from fftocean.export import ktx2


def by_the_specification(data):
    """Return the picture of a file, (rows, columns, channels), after asserting KTX 2.0's rules."""
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    head = struct.unpack_from("<13I2Q", data, 12)
    vk_format, type_size, width, height, depth, layers, faces, levels, scheme = head[:9]
    channels = {103: 2, 109: 4}[vk_format]  # R32G32_SFLOAT, R32G32B32A32_SFLOAT
    assert (type_size, depth, layers, faces, levels, scheme) == (4, 0, 0, 1, 1, 0)
    dfd, dfd_size, kvd, kvd_size, sgd, sgd_size = head[9:]
    assert (sgd, sgd_size) == (0, 0)
    offset, length, plain = struct.unpack_from("<3Q", data, 80)
    assert length == plain == width * height * channels * 4
    assert offset % (4 * channels) == 0  # lcm of the texel's size and 4
    assert offset + length == len(data)
    # Khronos data format descriptor
    assert (dfd, struct.unpack_from("<I", data, dfd)[0]) == (104, dfd_size)
    assert struct.unpack_from("<IHH", data, dfd + 4) == (0, 2, dfd_size - 4)
    assert dfd_size - 4 == 24 + 16 * channels
    assert list(data[dfd + 12 : dfd + 28]) == [1, 0, 1, 0, 0, 0, 0, 0, 4 * channels, *[0] * 7]
    for s, channel in enumerate((0, 1, 2, 15)[:channels]):
        bits, size, kind, place, low, high = struct.unpack_from("<HBBIff", data, dfd + 28 + 16 * s)
        assert (bits, size + 1, kind) == (32 * s, 32, channel | 0xC0)
        assert (place, low, high) == (0, -1.0, 1.0)
    # keys and values
    at, keys = kvd, []
    assert kvd == dfd + dfd_size
    while at < kvd + kvd_size:
        (size,) = struct.unpack_from("<I", data, at)
        key, _, value = data[at + 4 : at + 4 + size].partition(b"\0")
        assert value.endswith(b"\0")
        keys.append(key)
        at += 4 + size + -size % 4
    assert keys == [b"KTXorientation", b"KTXwriter"]
    assert not any(data[at:offset])
    return np.frombuffer(data, "<f4", offset=offset).reshape(height, width, channels)


@pytest.mark.parametrize("shape", [(4, 8, 4), (5, 3, 2), (1, 1, 2), (1, 1, 4)])
def test_a_picture_is_read_by_the_specification(shape):
    pixels = np.random.default_rng(1).normal(size=shape).astype(np.float32)
    data = ktx2.encode_float(pixels)
    assert np.array_equal(by_the_specification(data), pixels)
    assert np.array_equal(ktx2.decode_float(data, shape), pixels)


@pytest.mark.parametrize("shape", [(4, 8, 2), (8, 4, 4)])
def test_another_picture_is_refused(shape):
    data = ktx2.encode_float(np.zeros((4, 8, 4), np.float32))
    with pytest.raises(IntegrityError, match="must hold one picture of"):
        ktx2.decode_float(data, shape)


def test_a_cut_or_changed_file_is_refused():
    data = ktx2.encode_float(np.zeros((4, 8, 4), np.float32))
    for wrong in (data[:-1], data + b"\0", b"", data[:20] + b"\x07" + data[21:]):
        with pytest.raises(IntegrityError, match="of 4 floats, in"):
            ktx2.decode_float(wrong, (4, 8, 4))
