"""
CRC-32C, the checksum of Zarr chunks, in NumPy.

A cyclic redundancy check is the remainder of a polynomial over GF(2), and so linear: the data are
cut into lanes, whose remainders are computed side by side, and each remainder is multiplied by
x^(8n) for the n bytes that follow its lane. Leading zeros change nothing.
"""

import functools

import numpy as np
import numpy.typing as npt

Words = npt.NDArray[np.uint32]

POLYNOMIAL = 0x82F63B78  # Castagnoli, with its bits reversed
LANES = 2048


def checksum(data: bytes | memoryview) -> int:
    """
    Return the CRC-32C of at least four bytes.

    Source: Castagnoli, Braeuer & Herrmann, IEEE Trans. Communications 41 (1993); RFC 3720, appendix
    B.4, has the test vectors. Pinned by tests/export/test_crc32c.py, against the bitwise
    definition, the vectors and another library.
    """
    columns = -(-len(data) // (4 * LANES))
    padded = np.zeros(4 * LANES * columns, dtype=np.uint8)
    start = len(padded) - len(data)
    padded[start:] = np.frombuffer(data, dtype=np.uint8)
    padded[start : start + 4] ^= 0xFF  # the register begins with all bits set
    steps = np.ascontiguousarray(padded.view("<u4").reshape(LANES, columns).T)
    low, high = _tables()
    lanes = np.zeros(LANES, dtype=np.uint32)
    for words in steps:
        lanes ^= words
        lanes = low[lanes & 0xFFFF] ^ high[lanes >> 16]
    following = 4 * columns
    while len(lanes) > 1:
        lanes = _moved(_past(following), lanes[0::2]) ^ lanes[1::2]
        following *= 2
    return int(lanes[0]) ^ 0xFFFFFFFF


@functools.cache
def _tables() -> tuple[Words, Words]:
    """
    Return the images, four bytes on, of the register's two low bytes, and of its two high ones.
    """
    half = np.arange(2**16, dtype=np.uint32)
    return _moved(_past(4), half), _moved(_past(4), half << np.uint32(16))


@functools.lru_cache(maxsize=256)
def _past(count: int) -> Words:
    """Return the image of each of the register's 32 bits, `count` bytes on: times x^(8 count)."""
    if count == 0:
        return np.array([1 << i for i in range(32)], dtype=np.uint32)
    if count % 2 == 0:
        root = _past(count // 2)
        return _moved(root, root)
    moved = _past(count - 1)
    for _ in range(8):
        moved = (moved >> np.uint32(1)) ^ (moved & np.uint32(1)) * np.uint32(POLYNOMIAL)
    return moved


def _moved(bits: Words, registers: Words) -> Words:
    """Return registers after the linear map that takes bit i to `bits[i]`."""
    out = np.zeros_like(registers)
    for i, image in enumerate(bits):
        out ^= ((registers >> np.uint32(i)) & np.uint32(1)) * image
    return out
