"""
Steps of the transforms of a tile: which lines a dispatch transforms, and where its samples are.

A line of more than `MOST` samples takes two steps (Bailey, FFTs in external or hierarchical memory,
1990). With n = n1 n2,

    X[k1 + n1 k2] = sum over j2 of e^{2 pi i j2 k2 / n2} e^{2 pi i j2 k1 / n}
                    sum over j1 of e^{2 pi i j1 k1 / n1} x[n2 j1 + j2].
"""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Integer

MOST = 512
"""Samples of a line that workgroup memory holds, for four lines: 16 KiB."""
PLACES = 2048
"""Samples that a workgroup transforms, of one line or several."""


@dataclass(frozen=True, slots=True)
class Stage:
    """
    Transforms of `lines` lines of one length.

    Sample e of line l is at strides[0] e + strides[1] (l // inner) + strides[2] (l % inner).
    """

    length: int
    lines: int
    inner: int
    read: tuple[int, int, int]
    write: tuple[int, int, int]
    twist: tuple[int, int] = (0, 0)  # 1/n cycles for each line out and in, times the sample
    n: int = 1  # of the whole line, if it is twisted

    @property
    def groups(self) -> int:
        """Number of workgroups."""
        return -(-self.lines * self.length // PLACES)

    def words(self, twiddles: int) -> Integer:
        """
        Return the uniform block, (12,) uint32.

        Args:
            twiddles: length of the table of e^(2 pi i j / twiddles).
        """
        twist = [turns * (twiddles // self.n) for turns in self.twist]
        block = [*self.read, self.length, *self.write, self.lines, self.inner, 0, *twist]
        return np.array(block, np.uint32)


def stages(nx: int, ny: int) -> list[Stage]:
    """
    Return the steps along x, then those along y, of a tile.

    Args:
        nx, ny: samples, powers of two from 2 to MOST^2.
    """
    if nx <= MOST:
        along_x = [Stage(nx, ny, ny, (1, 0, nx), (1, 0, nx))]
    else:
        n1, n2 = _parts(nx)
        along_x = [
            Stage(n1, ny * n2, n2, (n2, nx, 1), (n2, nx, 1), (0, 1), nx),
            Stage(n2, ny * n1, n1, (1, nx, n2), (n1, nx, 1)),
        ]
    if ny <= MOST:
        return [*along_x, Stage(ny, nx, nx, (nx, 0, 1), (nx, 0, 1))]
    n1, n2 = _parts(ny)
    return [
        *along_x,
        Stage(n1, n2 * nx, nx, (n2 * nx, nx, 1), (n2 * nx, nx, 1), (1, 0), ny),
        Stage(n2, n1 * nx, nx, (nx, n2 * nx, 1), (n1 * nx, nx, 1)),
    ]


def _parts(n: int) -> tuple[int, int]:
    """Return two powers of two whose product is n, as equal as can be."""
    second = 1 << ((n.bit_length() - 1) // 2)
    return n // second, second


def twiddles(n: int) -> "np.ndarray[tuple[int, ...], np.dtype[np.float32]]":
    """Return cos and sin of 2 pi i / n, (n, 2) float32."""
    turn = 2.0 * np.pi * np.arange(n) / n
    return np.stack([np.cos(turn), np.sin(turn)], axis=-1).astype(np.float32)
