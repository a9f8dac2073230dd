"""Energy in arcs about k = 0, from cumulative distributions over direction."""

import math

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels.compiler import compiled


@compiled
def sums(
    first: Integer,
    low: Real,
    high: Real,
    energy: Real,
    row: Integer,
    along: Real,
    direction: float,
    theta: Real,
    cubic: Real,
    out: Real,
) -> None:
    """
    Add to out[q, c] the energy of the arcs of cell c, reflected into quadrant q.

    An arc from `low` to `high` holds its `energy` times the share of directions that it spans:
    C(high) - C(low). From theta[i] to theta[i + 1] C is a cubic in u, which goes from 0 to 1, with
    the coefficients cubic[row, i] of u^0 to u^3; between rows it is linear.

    Args:
        first: index of the first arc of each cell, and the number of arcs, (cells + 1,).
        low, high: directions of each arc in the first quadrant, (arcs,) [rad].
        energy: of a whole circle, (arcs,) [m^2].
        row, along: the row below each arc, and its place from there to the next, 0 to 1, (arcs,).
        direction: the direction that theta = 0 stands for [rad].
        theta: ascending from -pi to pi, (intervals + 1,) [rad].
        cubic: (rows, intervals, 4).
        out: (4, cells) [m^2], the quadrants with the signs (+, +), (+, -), (-, -), (-, +).
    """
    turn, last = 2.0 * np.pi, theta.size - 2
    begin, end, part = np.empty(2), np.empty(2), np.empty(2)
    for c in range(first.size - 1):
        for arc in range(first[c], first[c + 1]):
            if energy[arc] == 0.0:
                continue
            width = high[arc] - low[arc]
            r, w = row[arc], along[arc]
            for q in range(4):
                if q == 0:
                    start = low[arc]
                elif q == 1:
                    start = -high[arc]
                elif q == 2:
                    start = low[arc] - np.pi
                else:
                    start = np.pi - high[arc]
                start -= direction
                start -= turn * math.floor((start + np.pi) / turn)
                # an arc across theta = pi is two
                begin[0], end[0] = start, min(start + width, np.pi)
                begin[1], end[1] = -np.pi, start + width - turn
                share = 0.0
                for piece in range(2 if end[1] > begin[1] else 1):
                    for side in range(2):
                        at = begin[piece] if side == 0 else end[piece]
                        i = min(max(np.searchsorted(theta, at) - 1, 0), last)
                        u = (at - theta[i]) / (theta[i + 1] - theta[i])
                        a, b = cubic[r, i], cubic[r + 1, i]
                        below = a[0] + u * (a[1] + u * (a[2] + u * a[3]))
                        above = b[0] + u * (b[1] + u * (b[2] + u * b[3]))
                        part[side] = (1.0 - w) * below + w * above
                    share += part[1] - part[0]
                if share > 0.0:
                    out[q, c] += energy[arc] * share
