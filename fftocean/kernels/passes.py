"""
The two passes of a block-wise inverse transform, on either side of the row FFTs.

First pass, per block of columns kx: turn the waves, derive along y; (transform along y;) store transposed. Second pass, per block
of rows y: derive along x, pack two real fields into one complex row; (transform along x;) split them. Whatever a block touches
stays in cache. Complex rows come as their interleaved real parts, 2 n long: loops over plain reals are what compilers vectorise.
"""

import numpy as np

from fftocean.arrays import Complex, Integer, Real
from fftocean.kernels.compiler import compiled

ROUND = 6755399441055744.0  # 1.5 * 2^52: adding and subtracting it rounds a double to a whole number, in two instructions


@compiled
def turns_at(coarse: Real, fine: Real, t_coarse: float, t_fine: float, out: Real) -> None:
    """
    out = frac((coarse + fine) (t_coarse + t_fine)): turns made at time t, in [-1/2, 1/2], at any t as exact as the frequency.

    `coarse` and `t_coarse` hold the leading 26 bits of frequency and time, so the two large products are exact, and whole
    turns can be dropped from them without loss.
    """
    t = t_coarse + t_fine
    for b in range(out.shape[0]):
        frequency, rest, turns = coarse[b], fine[b], out[b]
        for j in range(turns.size):
            first = frequency[j] * t_coarse
            second = frequency[j] * t_fine
            whole = (first - ((first + ROUND) - ROUND)) + (second - ((second + ROUND) - ROUND)) + rest[j] * t
            turns[j] = whole - ((whole + ROUND) - ROUND)


@compiled
def turns_in_loop(cycles: Real, step: float, count: float, out: Real) -> None:
    """
    out = (cycles step mod count) / count: turns made at the step-th of `count` moments of a loop, in [-1/2, 1/2].

    All of them are whole numbers far below 2^53, held in doubles: the arithmetic is exact.
    """
    for b in range(out.shape[0]):
        whole, turns = cycles[b], out[b]
        for j in range(turns.size):
            within = whole[j] - ((whole[j] / count + ROUND) - ROUND) * count
            moved = within * step
            turns[j] = (moved - ((moved / count + ROUND) - ROUND) * count) / count


@compiled
def phasors(turns: Real, cosine: Real, sine: Real) -> None:
    """
    cosine, sine = cos and sin of 2 pi turns, |turns| <= 1/2: Taylor series of half the angle, then doubled; no branch, no table.

    Half the angle is at most pi/2, where the first term left out is 1e-18 of the sine and 8e-20 of the cosine.
    """
    for b in range(turns.shape[0]):
        turn, c, s = turns[b], cosine[b], sine[b]
        for j in range(turn.size):
            x = np.pi * turn[j]
            y = x * x
            sin = 1.0 - y * (1 / 342) * (1.0 - y * (1 / 420))
            sin = 1.0 - y * (1 / 156) * (1.0 - y * (1 / 210) * (1.0 - y * (1 / 272) * sin))
            sin = x * (1.0 - y * (1 / 6) * (1.0 - y * (1 / 20) * (1.0 - y * (1 / 42) * (1.0 - y * (1 / 72) * (1.0 - y * (1 / 110) * sin)))))
            cos = 1.0 - y * (1 / 306) * (1.0 - y * (1 / 380) * (1.0 - y * (1 / 462)))
            cos = 1.0 - y * (1 / 132) * (1.0 - y * (1 / 182) * (1.0 - y * (1 / 240) * cos))
            cos = 1.0 - y * (1 / 2) * (1.0 - y * (1 / 12) * (1.0 - y * (1 / 30) * (1.0 - y * (1 / 56) * (1.0 - y * (1 / 90) * cos))))
            c[j] = 1.0 - 2.0 * sin * sin
            s[j] = 2.0 * sin * cos


@compiled
def heights(forward: Real, backward: Real, cosine: Real, sine: Real, out: Real) -> None:
    """out = forward e^{-i f} + backward e^{+i f}, rounded to the precision of `out` only here."""
    for b in range(cosine.shape[0]):
        p, m, c, s, h = forward[b], backward[b], cosine[b], sine[b], out[b]
        for j in range(c.size):
            h[2 * j] = (p[2 * j] + m[2 * j]) * c[j] + (p[2 * j + 1] - m[2 * j + 1]) * s[j]
            h[2 * j + 1] = (p[2 * j + 1] + m[2 * j + 1]) * c[j] - (p[2 * j] - m[2 * j]) * s[j]


@compiled
def rates(forward: Real, backward: Real, cosine: Real, sine: Real, omega: Real, out: Real) -> None:
    """out = -i omega (forward e^{-i f} - backward e^{+i f}): the time derivative of `heights`."""
    for b in range(cosine.shape[0]):
        p, m, c, s, w, h = forward[b], backward[b], cosine[b], sine[b], omega[b], out[b]
        for j in range(c.size):
            h[2 * j] = w[j] * ((p[2 * j + 1] - m[2 * j + 1]) * c[j] - (p[2 * j] + m[2 * j]) * s[j])
            h[2 * j + 1] = -w[j] * ((p[2 * j] - m[2 * j]) * c[j] + (p[2 * j + 1] + m[2 * j + 1]) * s[j])


@compiled
def scale(spectrum: Real, factor: Real, out: Real) -> None:
    """out = factor spectrum."""
    for b in range(factor.shape[0]):
        h, p, o = spectrum[b], factor[b], out[b]
        for j in range(p.size):
            o[2 * j] = p[j] * h[2 * j]
            o[2 * j + 1] = p[j] * h[2 * j + 1]


@compiled
def derive(spectrum: Real, power: Real, real: float, imag: float, blocks: int, out: Real) -> None:
    """out = (real + i imag) power spectrum, row by row: with ky^b and i^b, the derivative d^b/dy^b."""
    for b in range(blocks):
        h, o = spectrum[b], out[b]
        for j in range(power.size):
            o[2 * j] = power[j] * (real * h[2 * j] - imag * h[2 * j + 1])
            o[2 * j + 1] = power[j] * (real * h[2 * j + 1] + imag * h[2 * j])


@compiled
def transpose(block: Complex, first: int, columns: int, out: Complex) -> None:
    """out[y, s, first + b] = block[s, b, y] for b < columns, in tiles that fit the cache's ways."""
    for s in range(block.shape[0]):
        for start in range(0, block.shape[2], 8):
            for y in range(start, min(start + 8, block.shape[2])):
                for b in range(columns):
                    out[y, s, first + b] = block[s, b, y]


@compiled
def pack(columns: Real, first: int, rows: int, sources: Integer, powers: Real, units: Real, out: Real) -> None:
    """
    out[r, p] = A + i B, a complex row whose transform has the real field of A as real part and that of B as imaginary part.

    A and B are units[k, p] powers[k, p, kx] columns[first + r, sources[k, p], kx], k = 0 and 1: derivatives along x of what the
    first pass left. Both are the Hermitian halves of real rows; the negative kx follow by symmetry.
    """
    nx = out.shape[2] // 2
    half = powers.shape[2]
    for r in range(rows):
        for p in range(out.shape[1]):
            a, b, o = columns[first + r, sources[0, p]], columns[first + r, sources[1, p]], out[r, p]
            ka, kb = powers[0, p], powers[1, p]
            ra, ia, rb, ib = units[0, p, 0], units[0, p, 1], units[1, p, 0], units[1, p, 1]
            for i in range(half):
                ar, ai = ka[i] * (ra * a[2 * i] - ia * a[2 * i + 1]), ka[i] * (ra * a[2 * i + 1] + ia * a[2 * i])
                br, bi = kb[i] * (rb * b[2 * i] - ib * b[2 * i + 1]), kb[i] * (rb * b[2 * i + 1] + ib * b[2 * i])
                o[2 * i] = ar - bi
                o[2 * i + 1] = ai + br
                if 0 < i < nx - i:
                    o[2 * (nx - i)] = ar + bi
                    o[2 * (nx - i) + 1] = br - ai


@compiled
def split(packed: Real, pair: int, rows: int, weight: float, real: Real, imag: Real) -> None:
    """real, imag / weight = the two real fields of one packed pair; each is (rows, nx)."""
    undo = 1 / weight
    for r in range(rows):
        o, a, b = packed[r, pair], real[r], imag[r]
        for i in range(a.size):
            a[i] = o[2 * i]
            b[i] = o[2 * i + 1] * undo


@compiled
def split_one(packed: Real, pair: int, rows: int, real: Real) -> None:
    """real = the first real field of a packed pair whose second is nothing."""
    for r in range(rows):
        o, a = packed[r, pair], real[r]
        for i in range(a.size):
            a[i] = o[2 * i]
