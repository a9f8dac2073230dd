"""
The loops on either side of the row FFTs of a synthesis.

First pass, for each block of columns kx: advance the waves, derive along y; (transform along y;)
transpose. Second pass, for each block of rows y: derive along x, pack two real fields into one
complex row; (transform along x;) split them. The data of a block stay in cache. Compilers vectorise
loops over contiguous reals in at most five arrays. So complex rows are given as their interleaved
real and imaginary parts, 2 n long, and half-spectra in the first pass as two arrays of parts.
"""

import numpy as np

from fftocean.arrays import Complex, Real
from fftocean.kernels.compiler import compiled

# 1.5 * 2^52: adding and subtracting it rounds a double to a whole number, in two instructions
ROUND = 6755399441055744.0
SPLIT = 134217729.0  # 2^27 + 1 splits a double in two halves of 26 bits  (Veltkamp 1968)


@compiled
def phases_at(frequency: Real, t: float, out: Real) -> None:
    """
    Write out = frac(frequency t), the phases at time t in cycles, in [-1/2, 1/2].

    They are as exact as the frequency, at any t. The leading 26 bits of frequency and time have an
    exact product, from which whole cycles are subtracted without loss; the rest is smaller by 2^26.
    """
    scaled = t * SPLIT
    t_coarse = scaled - (scaled - t)
    t_fine = t - t_coarse
    for b in range(out.shape[0]):
        f, phase = frequency[b], out[b]
        for j in range(phase.size):
            wide = f[j] * SPLIT
            coarse = wide - (wide - f[j])
            whole = coarse * t_coarse
            rest = (whole - ((whole + ROUND) - ROUND)) + (coarse * t_fine + (f[j] - coarse) * t)
            phase[j] = rest - ((rest + ROUND) - ROUND)


@compiled
def phases_in_loop(cycles: Real, step: float, count: float, out: Real) -> None:
    """
    Write out = (cycles step mod count) / count, the phases at one of `count` moments of a loop.

    They are in cycles, in [-1/2, 1/2]. All inputs are whole numbers, held in doubles, and the
    arithmetic is exact up to the last division: cycles below 2^50 and count up to 2^26 have
    products and quotients below 2^52.
    """
    part = 1.0 / count
    for b in range(out.shape[0]):
        whole, phase = cycles[b], out[b]
        for j in range(phase.size):
            within = whole[j] - ((whole[j] * part + ROUND) - ROUND) * count
            moved = within * step
            phase[j] = (moved - ((moved * part + ROUND) - ROUND) * count) * part


@compiled
def phases_in_fine_loop(cycles: Real, step: int, count: int, out: Real) -> None:
    """
    Write the same as `phases_in_loop`, for cycles below 2^63 and count up to 2^32.

    It takes integers of 64 bits and several times as long: (cycles mod count) step is below 2^64.
    """
    n, j = np.uint64(count), np.uint64(step)
    half, part = n // np.uint64(2), 1.0 / np.float64(count)
    for b in range(out.shape[0]):
        whole, phase = cycles[b], out[b]
        for i in range(phase.size):
            moved = (np.uint64(whole[i]) % n) * j % n
            phase[i] = -(np.float64(n - moved) * part) if moved > half else np.float64(moved) * part


@compiled
def phasors(cycles: Real, cosine: Real, sine: Real) -> None:
    """
    Write cosine and sine of phases in cycles, |cycles| <= 1/2.

    By Taylor series of half the angle, which is then doubled: no branch, no table. Half the angle
    is at most pi/2, where the first term left out is 1e-18 of the sine and 2e-17 of the cosine.
    """
    for b in range(cycles.shape[0]):
        phase, c, s = cycles[b], cosine[b], sine[b]
        for j in range(phase.size):
            x = np.pi * phase[j]
            y = x * x
            sin = 1.0 - y * (1 / 342) * (1.0 - y * (1 / 420))
            sin = 1.0 - y * (1 / 156) * (1.0 - y * (1 / 210) * (1.0 - y * (1 / 272) * sin))
            sin = x * (
                1.0
                - y
                * (1 / 6)
                * (
                    1.0
                    - y
                    * (1 / 20)
                    * (1.0 - y * (1 / 42) * (1.0 - y * (1 / 72) * (1.0 - y * (1 / 110) * sin)))
                )
            )
            cos = 1.0 - y * (1 / 306) * (1.0 - y * (1 / 380))
            cos = 1.0 - y * (1 / 132) * (1.0 - y * (1 / 182) * (1.0 - y * (1 / 240) * cos))
            cos = 1.0 - y * (1 / 2) * (
                1.0
                - y
                * (1 / 12)
                * (1.0 - y * (1 / 30) * (1.0 - y * (1 / 56) * (1.0 - y * (1 / 90) * cos)))
            )
            c[j] = 1.0 - 2.0 * sin * sin
            s[j] = 2.0 * sin * cos


_SINE = tuple(np.float32(1 / (m * (m + 1))) for m in (2, 4, 6, 8, 10, 12))
_COSINE = tuple(np.float32(1 / (m * (m + 1))) for m in (1, 3, 5, 7, 9, 11))


@compiled
def phasors_single(cycles: Real, cosine: Real, sine: Real) -> None:
    """
    Write the same in single precision, to which the angle, within half a cycle, is rounded first.

    The first term left out is 7e-10 of the sine and 6e-9 of the cosine.
    """
    one, two = np.float32(1), np.float32(2)
    for b in range(cycles.shape[0]):
        phase, c, s = cycles[b], cosine[b], sine[b]
        for j in range(phase.size):
            x = np.float32(np.pi * phase[j])
            y = x * x
            sin = one - y * _SINE[3] * (one - y * _SINE[4] * (one - y * _SINE[5]))
            sin = x * (one - y * _SINE[0] * (one - y * _SINE[1] * (one - y * _SINE[2] * sin)))
            cos = one - y * _COSINE[3] * (one - y * _COSINE[4] * (one - y * _COSINE[5]))
            cos = one - y * _COSINE[0] * (one - y * _COSINE[1] * (one - y * _COSINE[2] * cos))
            c[j] = one - two * sin * sin
            s[j] = two * sin * cos


@compiled
def heights(waves: Real, cosine: Real, sine: Real, real: Real, imag: Real) -> None:
    """
    Write the height spectrum, real + i imag = forward e^{-i f} + backward e^{+i f}.

    `waves` holds, for each column, the real part of forward + backward, the imaginary of their
    difference and of their sum, and the real part of their difference, each `cosine.shape[1]` long.
    """
    n = cosine.shape[1]
    for b in range(cosine.shape[0]):
        w, c, s = waves[b], cosine[b], sine[b]
        sum_r, difference_i, sum_i, difference_r = w[:n], w[n : 2 * n], w[2 * n : 3 * n], w[3 * n :]
        h_r, h_i = real[b], imag[b]
        for j in range(n):
            h_r[j] = sum_r[j] * c[j] + difference_i[j] * s[j]
        for j in range(n):
            h_i[j] = sum_i[j] * c[j] - difference_r[j] * s[j]


@compiled
def height_rates(
    waves: Real, cosine: Real, sine: Real, omega: Real, real: Real, imag: Real
) -> None:
    """
    Write the time derivative of `heights`.

    real + i imag = -i omega (forward e^{-i f} - backward e^{+i f}).
    """
    n = cosine.shape[1]
    for b in range(cosine.shape[0]):
        w, c, s, o = waves[b], cosine[b], sine[b], omega[b]
        sum_r, difference_i, sum_i, difference_r = w[:n], w[n : 2 * n], w[2 * n : 3 * n], w[3 * n :]
        h_r, h_i = real[b], imag[b]
        for j in range(n):
            h_r[j] = o[j] * (difference_i[j] * c[j] - sum_r[j] * s[j])
        for j in range(n):
            h_i[j] = -o[j] * (difference_r[j] * c[j] + sum_i[j] * s[j])


@compiled
def scale(source: Real, factor: Real, out: Real) -> None:
    """Write out = factor source."""
    for b in range(factor.shape[0]):
        h, p, o = source[b], factor[b], out[b]
        for j in range(p.size):
            o[j] = p[j] * h[j]


@compiled
def derive(
    real: Real, imag: Real, power: Real, first: float, second: float, columns: int, out: Real
) -> None:
    """Write out = power (first real + i second imag), row by row, parts interleaved."""
    for b in range(columns):
        x, y, o = real[b], imag[b], out[b]
        for j in range(power.size):
            o[2 * j] = first * power[j] * x[j]
            o[2 * j + 1] = second * power[j] * y[j]


@compiled
def mix(
    real: Real,
    imag: Real,
    power: Real,
    other_real: Real,
    other_imag: Real,
    other: Real,
    first: float,
    second: float,
    columns: int,
    out: Real,
) -> None:
    """
    Write the sum of two sources with a power of ky each, parts interleaved.

    out = first (power real + other other_real) + i second (power imag + other other_imag).
    """
    for b in range(columns):
        x, y, u, v, o = real[b], imag[b], other_real[b], other_imag[b], out[b]
        for j in range(power.size):
            o[2 * j] = first * (power[j] * x[j] + other[j] * u[j])
            o[2 * j + 1] = second * (power[j] * y[j] + other[j] * v[j])


@compiled
def transpose(
    block: Real | Complex, spectrum: int, first: int, columns: int, out: Real | Complex
) -> None:
    """
    Write out[y, spectrum, first + b] = block[b, y] for b < columns, eight columns at a time.

    Complex numbers of single precision are given as reals of 8 bytes: they are moved, not computed.
    """
    whole = columns - columns % 8
    for b in range(0, whole, 8):
        c0, c1, c2, c3, c4, c5, c6, c7 = (
            block[b], block[b + 1], block[b + 2], block[b + 3],
            block[b + 4], block[b + 5], block[b + 6], block[b + 7],
        )  # fmt: skip
        for y in range(block.shape[1]):
            o = out[y, spectrum, first + b : first + b + 8]
            o[0], o[1], o[2], o[3] = c0[y], c1[y], c2[y], c3[y]
            o[4], o[5], o[6], o[7] = c4[y], c5[y], c6[y], c7[y]
    for b in range(whole, columns):
        c = block[b]
        for y in range(block.shape[1]):
            out[y, spectrum, first + b] = c[y]


@compiled
def pack(
    intermediate: Real,
    first: int,
    rows: int,
    plus: int,
    minus: int,
    factors: Real,
    mirrored: Real,
    out: Real,
) -> None:
    """
    Write packed rows, whose transforms have one real field as real part, one as imaginary part.

    out[r, k] = factors X at k >= 0, and conj(mirrored Y) at -k. X and Y are the half-spectra `plus`
    and `minus` of row first + r, the Hermitian halves of real rows. `factors` has each number
    twice, for real and imaginary part; `mirrored` too, from the highest k down to the first above
    0, the second of each with a minus for the conjugate.
    """
    high = mirrored.size // 2  # the highest k
    for r in range(rows):
        x, y, o = intermediate[first + r, plus], intermediate[first + r, minus], out[r]
        for i in range(factors.size):
            o[i] = factors[i] * x[i]
        m = o[o.size - mirrored.size :]
        for i in range(high):
            k = np.uint64(2 * (high - i))  # unsigned: no check for a negative index
            m[2 * i] = mirrored[2 * i] * y[k]
            m[2 * i + 1] = mirrored[2 * i + 1] * y[k + np.uint64(1)]


@compiled
def split(packed: Real, undo: float, real: Real, imag: Real) -> None:
    """
    Write the two real fields of packed rows, the second times `undo`; each is (rows, nx).
    """
    for r in range(real.shape[0]):
        o, a, b = packed[r], real[r], imag[r]
        for i in range(a.size):
            a[i] = o[2 * i]
            b[i] = o[2 * i + 1] * undo


@compiled
def real_parts(packed: Real, real: Real) -> None:
    """Write the real parts of packed rows, whose imaginary parts hold no field."""
    for r in range(real.shape[0]):
        o, a = packed[r], real[r]
        for i in range(a.size):
            a[i] = o[2 * i]
