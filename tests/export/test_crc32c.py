"""The checksum against its definition bit by bit, the vectors of RFC 3720, and another library."""

import google_crc32c
import numpy as np
import pytest

from fftocean.export.crc32c import LANES, checksum


def by_definition(data):
    register = 0xFFFFFFFF
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = (register >> 1) ^ (0x82F63B78 if register & 1 else 0)
    return register ^ 0xFFFFFFFF


@pytest.mark.parametrize(
    ("data", "crc"),
    [
        (bytes(32), 0x8A9136AA),
        (b"\xff" * 32, 0x62A8AB43),
        (bytes(range(32)), 0x46DD794E),
        (bytes(range(31, -1, -1)), 0x113FDB5C),
        (b"123456789", 0xE3069283),
    ],
    ids=["zeros", "ones", "rising", "falling", "digits"],
)
def test_the_vectors_of_rfc_3720(data, crc):
    assert checksum(data) == crc


@pytest.mark.parametrize("size", [4, 5, 63, 4 * LANES - 1, 4 * LANES, 4 * LANES + 1])
def test_the_definition(size):
    data = np.random.default_rng(size).bytes(size)
    assert checksum(data) == checksum(memoryview(data)) == by_definition(data)


@pytest.mark.parametrize("size", [100_000, 1_000_003])
def test_another_library(size):
    data = np.random.default_rng(size).bytes(size)
    assert checksum(data) == google_crc32c.value(data)


def test_any_bit_counts():
    data = bytearray(50_000)
    plain = checksum(bytes(data))
    for at in (0, 3, 25_000, 49_999):
        data[at] ^= 0x10
        assert checksum(bytes(data)) != plain
        data[at] ^= 0x10
