"""
Sums over pairs of waves, which make second-order spectra.

Waves are sorted by their integer wavenumbers (mx, my), so that they form runs: waves of one mx
whose my follow one another. All pairs of two runs add to cells in one column of the result, and
those of one wave with a run to cells in a row: the inner loop has neither a condition nor a list of
places.
"""

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels.compiler import compiled


@compiled
def add_pairs(
    blocks: Integer,
    first: int,
    last: int,
    table: Real,
    outer_y: Integer,
    outer_real: Real,
    outer_imag: Real,
    inner_real: Real,
    inner_imag: Real,
    real: Real,
    imag: Real,
) -> None:
    """
    Add table u_o v_i to the cells of all pairs (o, i) of the blocks `first` ... `last` - 1.

    A block is (first outer wave, outer waves, first inner wave, inner waves, column, y, entry in
    `table`): wave o and the n-th inner wave add to [column, y + outer_y[o] + n], with the entry
    o inner waves + n. Blocks of different columns share no cell of the result.
    """
    for b in range(first, last):
        o_first, o_count, i_first, count = blocks[b, 0], blocks[b, 1], blocks[b, 2], blocks[b, 3]
        column, y_first, entry = blocks[b, 4], blocks[b, 5], blocks[b, 6]
        v_r, v_i = inner_real[i_first : i_first + count], inner_imag[i_first : i_first + count]
        column_r, column_i = real[column], imag[column]
        for o in range(o_first, o_first + o_count):
            c = table[entry : entry + count]
            entry += count
            y = y_first + outer_y[o]
            out_r, out_i = column_r[y : y + count], column_i[y : y + count]
            u_r, u_i = outer_real[o], outer_imag[o]
            for n in range(count):
                out_r[n] += c[n] * (u_r * v_r[n] - u_i * v_i[n])
            for n in range(count):
                out_i[n] += c[n] * (u_r * v_i[n] + u_i * v_r[n])


@compiled
def add_folded(
    sums: Real,
    sums_imag: Real,
    first: int,
    gain: Real,
    own: bool,
    scale: float,
    real: Real,
    imag: Real,
) -> None:
    """
    Add scale gain (G(k) + conj G(-k)) to the columns first, first + 1, ... of a half plane.

    The sums G have k = 0 at the middle of both axes, the result at [0, 0] of the whole half plane,
    with negative ky at the end. Sums beyond the half plane are left out, as is k = 0. `gain` is
    (columns, ny), and counts only if `own` is True.
    """
    middle_x, middle_y = sums.shape[0] // 2, sums.shape[1] // 2
    ny = real.shape[1]
    reach = min((ny - 1) // 2, middle_y)
    for b in range(min(real.shape[0], middle_x + 1 - first)):
        x = first + b
        plus_r, plus_i = sums[middle_x + x], sums_imag[middle_x + x]
        minus_r, minus_i = sums[middle_x - x], sums_imag[middle_x - x]
        out_r, out_i = real[b], imag[b]
        for y in range(-reach, reach + 1):
            if x == 0 and y == 0:
                continue
            row = y if y >= 0 else y + ny
            factor = scale * gain[x, row] if own else scale
            out_r[row] += factor * (plus_r[middle_y + y] + minus_r[middle_y - y])
            out_i[row] += factor * (plus_i[middle_y + y] - minus_i[middle_y - y])


@compiled
def turn(cosine: Real, sine: Real, real: Real, imag: Real, out_real: Real, out_imag: Real) -> None:
    """Write out = (real + i imag) (cosine - i sine)."""
    for i in range(real.size):
        out_real[i] = real[i] * cosine[i] + imag[i] * sine[i]
    for i in range(real.size):
        out_imag[i] = imag[i] * cosine[i] - real[i] * sine[i]


@compiled
def sum_cells(kx: Real, ky: Real, spectra: Real, x: Real, y: Real, out: Real) -> None:
    """
    Write out[p, f] = sum over the cells of Re (spectra[f, cell] e^{i k.x}).

    `spectra` is (fields, 2, cells), real and imaginary parts; `out` (points, fields).
    """
    fields, cells = spectra.shape[0], kx.size
    for p in range(x.size):
        total = np.zeros(fields)
        for m in range(cells):
            angle = kx[m] * x[p] + ky[m] * y[p]
            c, s = np.cos(angle), np.sin(angle)
            for f in range(fields):
                total[f] += spectra[f, 0, m] * c - spectra[f, 1, m] * s
        out[p] = total


@compiled
def sum_below(
    kx: Real,
    ky: Real,
    potential: Real,
    depth: float,
    x: Real,
    y: Real,
    z: Real,
    out: Real,
) -> None:
    """
    Write velocity, acceleration and rate of a potential below the surface, (points, 7).

    Args:
        kx, ky: of each cell [rad/m].
        potential: at the mean level, and its rate, (2, 2, cells), real and imaginary parts.
        depth: still-water depth [m], inf is deep.
        x, y, z: points; z up to a few heights above the mean level, -depth and above [m].
        out: velocity (3), acceleration (3), -d potential/dt.
    """
    for p in range(x.size):
        u = v = w = au = av = aw = rate = 0.0
        for m in range(kx.size):
            k = np.hypot(kx[m], ky[m])
            if np.isinf(depth):
                level = np.exp(k * z[p])
                slope = level
            else:
                # cosh k(z + h)/cosh kh and sinh k(z + h)/cosh kh, without large numbers
                down, up = np.exp(-2.0 * k * (z[p] + depth)), np.exp(k * z[p])
                bed = 1.0 + np.exp(-2.0 * k * depth)
                level, slope = up * (1.0 + down) / bed, up * (1.0 - down) / bed
            angle = kx[m] * x[p] + ky[m] * y[p]
            c, s = np.cos(angle), np.sin(angle)
            even = potential[0, 0, m] * c - potential[0, 1, m] * s
            odd = -potential[0, 0, m] * s - potential[0, 1, m] * c
            u += kx[m] * odd * level
            v += ky[m] * odd * level
            w += k * even * slope
            even = potential[1, 0, m] * c - potential[1, 1, m] * s
            odd = -potential[1, 0, m] * s - potential[1, 1, m] * c
            au += kx[m] * odd * level
            av += ky[m] * odd * level
            aw += k * even * slope
            rate -= even * level
        out[p, 0], out[p, 1], out[p, 2] = u, v, w
        out[p, 3], out[p, 4], out[p, 5] = au, av, aw
        out[p, 6] = rate
