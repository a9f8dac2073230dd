"""Conversion of single to half precision, rounded to nearest, ties to even (IEEE 754)."""

import numpy as np
import numpy.typing as npt

from fftocean.kernels.compiler import compiled


@compiled
def pack(bits: npt.NDArray[np.uint32], out: npt.NDArray[np.uint16]) -> None:
    """
    Write the half nearest to each float, ties to even.

    The bits are those of `floats.astype(np.float16)`, several times faster. From 65520 on the
    result is infinity, as IEEE 754 rounds; a NaN becomes the quiet NaN 7e00 with its sign. There is
    no branch, and all numbers are 32 bits wide, so that the loop is vectorised.

    Args:
        bits: `floats.view(np.uint32)` of C-contiguous float32, one axis.
        out: as many uint16; `.view(np.float16)` reads them.

    Source: IEEE 754-2008, 3.6 (encodings) and 4.3.1 (rounding).
    Pinned by tests/kernels/test_half.py, against C's own packing.
    """
    one, low_mantissa = np.uint32(1), np.uint32(0x7FFFFF)
    # The smallest normal half; the difference of the two exponents' biases.
    least, rebias = np.uint32(113 << 23), np.uint32(112 << 23)
    for i in range(out.shape[0]):
        word = bits[i]
        size = word & np.uint32(0x7FFFFFFF)
        exponent = size >> np.uint32(23)
        # normal halves, exponent 113 (2^-14) and up: 13 bits fall off; a carry runs on into the
        # exponent, as it should
        normal = (
            max(size, least) - rebias + np.uint32(0xFFF) + ((size >> np.uint32(13)) & one)
        ) >> np.uint32(13)
        # subnormal halves: the mantissa with its leading bit, in units of 2^-24; 14 to 24 bits fall
        # off, and all of them below
        drop = min(
            max(np.uint32(126) - min(exponent, np.uint32(112)), np.uint32(14)), np.uint32(25)
        )
        mantissa = (size & low_mantissa) | np.uint32(0x800000)
        tiny = (mantissa + (one << (drop - one)) - one + ((mantissa >> drop) & one)) >> drop
        half = normal if exponent > np.uint32(112) else tiny
        half = np.uint32(0x7C00) if size >= np.uint32(0x477FF000) else half
        half = np.uint32(0x7E00) if size > np.uint32(0x7F800000) else half
        out[i] = np.uint16(((word >> np.uint32(16)) & np.uint32(0x8000)) | half)
