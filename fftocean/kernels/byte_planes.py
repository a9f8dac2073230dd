"""Bytes of 16-bit words, sorted and differenced as OpenEXR's ZIP compression stores them."""

import numpy as np
import numpy.typing as npt

from fftocean.kernels.compiler import compiled

MORE = np.uint16(128 + 256)
"""Added to a difference of bytes: 128, and 256 so that it is positive."""


@compiled
def differences(
    words: npt.NDArray[np.uint16],
    order: npt.NDArray[np.int64],
    most: int,
    out: npt.NDArray[np.uint8],
) -> None:
    """
    Write the bytes of an image, block of rows by block, ready for deflate.

    A block's words go row by row, in a row channel by channel. Of these, all low bytes come first,
    then all high bytes, and each byte but the first is replaced by its difference from the one
    before, plus 128 modulo 256.

    Args:
        words: (rows, columns, channels, words of a sample), lowest word first.
        order: the channel in each place, where one may come several times.
        most: rows of a block; the last block may have fewer.
        out: the blocks one after the other, 2 * rows * columns * order.size * words of a sample.

    Source: OpenEXR, internal_zip.c (reorder, then predictor).
    Pinned by tests/export/test_exr.py, against OpenEXR's own reader.
    """
    rows, columns, count, length = words.shape
    stretch = columns * length
    line = np.empty(stretch + 1, np.uint16)  # the words of one channel of a row, after the last one
    shift, mask = np.uint16(8), np.uint16(255)
    start = 0
    for top in range(0, rows, most):
        height = min(most, rows - top)
        size = height * order.size * stretch
        place = start
        for j in range(top, top + height):
            row = words[j].reshape(columns * count * length)
            for c in order:
                line[0] = line[stretch]
                _gather(row, count, length, c, line[1:])
                _low(line, out[place : place + stretch])
                _high(line, out[place + size : place + size + stretch])
                place += stretch
        # a block's first byte stands as it is; its first high byte follows its last low one
        first, last = words[top, 0, order[0], 0], line[stretch]
        out[start] = np.uint8(first & mask)
        out[start + size] = np.uint8(((first >> shift) + MORE - (last & mask)) & mask)
        start += 2 * size


@compiled
def _gather(
    row: npt.NDArray[np.uint16], count: int, length: int, c: int, line: npt.NDArray[np.uint16]
) -> None:
    """Write one channel of a row of interleaved channels."""
    if length == 1:
        step, first = np.uint64(count), np.uint64(c)  # unsigned: no check for negative indices
        for i in range(line.size):
            line[i] = row[np.uint64(i) * step + first]
    else:
        for i in range(line.size // length):
            for k in range(length):
                line[i * length + k] = row[(i * count + c) * length + k]


@compiled
def _low(line: npt.NDArray[np.uint16], out: npt.NDArray[np.uint8]) -> None:
    """Write the differences of low bytes, plus 128, from one word to the next."""
    one, mask = np.uint64(1), np.uint16(255)
    for i in range(out.size):
        k = np.uint64(i)
        out[k] = np.uint8(((line[k + one] & mask) + MORE - (line[k] & mask)) & mask)


@compiled
def _high(line: npt.NDArray[np.uint16], out: npt.NDArray[np.uint8]) -> None:
    """Write the differences of high bytes, plus 128, from one word to the next."""
    one, shift, mask = np.uint64(1), np.uint16(8), np.uint16(255)
    for i in range(out.size):
        k = np.uint64(i)
        out[k] = np.uint8(((line[k + one] >> shift) + MORE - (line[k] >> shift)) & mask)
