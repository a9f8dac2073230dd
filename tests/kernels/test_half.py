"""
Single precision to half: every bit as C itself packs it, at every tie, and far faster than numpy's
cast.
"""

import struct

import numpy as np
import pytest

from fftocean.kernels import half

pytestmark = pytest.mark.nojit


def packed(floats):
    out = np.empty(floats.size, dtype=np.uint16)
    half.pack(np.ascontiguousarray(floats, dtype=np.float32).reshape(-1).view(np.uint32), out)
    return out


def by_c(floats):
    """
    The bits that C's packing gives; it refuses what rounds to infinity, which must be infinity
    here.
    """
    found = []
    for value in floats.reshape(-1).tolist():
        try:
            found.append(struct.unpack("<H", struct.pack("<e", value))[0])
        except OverflowError:
            found.append(0xFC00 if value < 0 else 0x7C00)
    return np.array(found, dtype=np.uint16)


FINITE = np.arange(0x7C00, dtype=np.uint16).view(np.float16).astype(np.float32)
EDGES = np.array(
    [
        0,
        2.0**-24,
        2.0**-25,
        2.0**-26,
        1e-45,
        2.0**-14,
        2.0**-14 - 2.0**-25,
        65504,
        65519.996,
        65520,
        1e30,
        np.inf,
    ],
    np.float32,
)


def around(floats):
    """Each value, and the floats right below and above it: ties are decided there."""
    return np.concatenate(
        [
            np.nextafter(floats, np.float32(-np.inf)),
            floats,
            np.nextafter(floats, np.float32(np.inf)),
        ]
    )


def test_every_half_is_itself():
    assert np.array_equal(packed(FINITE), np.arange(0x7C00))
    assert np.array_equal(packed(-FINITE), np.arange(0x8000, 0xFC00))


def test_every_tie_goes_to_the_even_neighbour():
    """
    The middle of any two halves is a float: it takes the even one; one float less and one more take
    the nearer.
    """
    middles = 0.5 * (FINITE[:-1] + FINITE[1:])
    lower = np.arange(len(middles))
    assert np.array_equal(packed(middles), lower + lower % 2)
    assert np.array_equal(packed(np.nextafter(middles, np.float32(0.0))), lower)
    assert np.array_equal(packed(np.nextafter(middles, np.float32(np.inf))), lower + 1)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_edges_and_random_bits_as_c_packs_them(sign):
    random = np.random.default_rng(3).integers(0, 2**32, 4000, dtype=np.uint32).view(np.float32)
    values = np.float32(sign) * np.concatenate(
        [around(EDGES[1:-1]), EDGES, random[np.isfinite(random)]]
    )
    assert np.array_equal(packed(values), by_c(values))


def test_nothing_but_a_nan_becomes_one():
    nans = np.array([0x7F800001, 0x7FC00000, 0xFF800001, 0xFFFFFFFF], dtype=np.uint32).view(
        np.float32
    )
    assert np.array_equal(packed(nans), [0x7E00, 0x7E00, 0xFE00, 0xFE00])
    assert np.array_equal(
        packed(np.array([np.inf, -np.inf, 1e30, -65520.0])), [0x7C00, 0xFC00, 0x7C00, 0xFC00]
    )


def test_numpy_agrees():
    """The other cast in the house, over the sizes of a sea."""
    sizes = (10.0 ** np.arange(-8, 4)).astype(np.float32)[:, None]
    values = np.random.default_rng(0).standard_normal((12, 1000)).astype(np.float32) * sizes
    assert np.array_equal(packed(values), values.astype(np.float16).view(np.uint16).reshape(-1))
