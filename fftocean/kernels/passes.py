"""
The loops on either side of the row FFTs of a synthesis.

First pass, for each column kx: advance the waves, derive along y; (transform along y;) write tiles
of 8 x 8. Second pass, for each row y: derive along x, pack two real fields into one complex row;
(transform along x;) split them. Tiles make both the writing and the reading of the array between
the passes contiguous. Compilers vectorise loops over contiguous reals in at most five arrays. So
complex rows are given as their interleaved real and imaginary parts, 2 n long, and half-spectra in
the first pass as two arrays of parts; what is left of vectors is in `vectors`.
"""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled
from fftocean.kernels.vectors import (
    LANES,
    TILE,
    prefetch,
    reverse,
    scale,
    scale_reversed,
    split,
    transpose,
)

SIZE = TILE * LANES  # reals in a tile

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
def mirror(row: Real, half: int) -> None:
    """
    Write the numbers at ky < 0 from those at ky > 0, where waves at ky and -ky have the same.

    Args:
        row: numbers in the order of transforms, ky from 0 up and then the negative ones.
        half: how many are there, those at ky >= 0; at -ky there is neither 0 nor, of an even
            number, Nyquist's.
    """
    missing = row.size - half
    whole = missing - missing % LANES
    for i in range(0, whole, LANES):
        reverse(row, missing - i - LANES + 1, row, half + i)
    for i in range(whole, missing):
        row[half + i] = row[missing - i]


@compiled
def unfold(half: Real, out: Real) -> None:
    """Write a row of all ky from the numbers at ky >= 0; see `mirror`."""
    for j in range(half.size):
        out[j] = half[j]
    mirror(out, half.size)


@compiled
def phases(kind: int, moment: float, count: float, frequency: Real, out: Real) -> None:
    """
    Write the phases at one time, in cycles, by one of the three loops above.

    Args:
        kind: 0 for `phases_at`, 1 for `phases_in_loop`, 2 for `phases_in_fine_loop`.
        moment: the time or, in a loop, the step.
        count: number of steps in a loop.
        frequency: in cycles per unit of time or, in a loop, per period.
    """
    if kind == 0:
        phases_at(frequency, moment, out)
    elif kind == 1:
        phases_in_loop(frequency, moment, count, out)
    else:
        phases_in_fine_loop(frequency, int(moment), int(count), out)


@compiled
def phasors(cycles: Real, cosine: Real, sine: Real) -> None:
    """
    Write cosine and sine of phases in cycles, |cycles| <= 1/2; their rows may be longer.

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
def scaled(source: Real, factor: Real, out: Real) -> None:
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
def tile(
    results: Real,
    first: int,
    width: int,
    spectra: int,
    ny: int,
    place: int,
    tiles: int,
    out: Real,
    streamed: bool,
) -> None:
    """
    Write eight columns of the results of a first pass into the array between the passes.

    Args:
        results: transformed columns, one spectrum after the other, `width` columns each; complex
            numbers as pairs of reals, in rows of the same length.
        first: the first of the eight columns.
        spectra, ny: number of spectra, and of samples in a column.
        place, tiles: number of the tile in its row of tiles, and of tiles in a row.
        out: tiles[y // 8, place, spectrum, y % 8, column], all complex; see `pack`.
        streamed: whether they are written past the caches.
    """
    stride = results.size // (spectra * width)
    whole = ny // TILE
    for row in range(whole):
        o = (row * tiles + place) * spectra * SIZE
        for s in range(spectra):
            at = (s * width + first) * stride + LANES * row
            transpose(results, at, stride, out, o + s * SIZE, streamed)
    for y in range(whole * TILE, ny):
        o = (whole * tiles + place) * spectra * SIZE + LANES * (y - whole * TILE)
        for s in range(spectra):
            for b in range(TILE):
                at = (s * width + first + b) * stride + 2 * y
                out[o + s * SIZE + 2 * b] = results[at]
                out[o + s * SIZE + 2 * b + 1] = results[at + 1]


@compiled
def pack(
    between: Real,
    start: int,
    spectra: int,
    plus: int,
    minus: int,
    factors: Real,
    mirrored: Real,
    out: Real,
    o: int,
    nx: int,
) -> None:
    """
    Write a packed row, whose transform has one real field as real part, one as imaginary part.

    out[k] = factors X at k >= 0, and conj(mirrored Y) at -k. X and Y are the half-spectra `plus`
    and `minus`, the Hermitian halves of real rows. `factors` has each number twice, for real and
    imaginary part; `mirrored` too, from the highest k down to 0, the second of each with a minus
    for the conjugate.

    Args:
        between: the tiles that `tile` writes.
        start: place of the row in the first tile of its row of tiles.
        spectra: number of half-spectra.
        out, o: the packed rows, and the place of this one; the complex number after it is changed.
        nx: samples in a row.
    """
    columns = factors.size // 2
    whole = columns // TILE
    # The same row eight further on is read next; it is too far for the processor to foresee.
    ahead = (columns + TILE - 1) // TILE * spectra * SIZE
    end = o + 2 * nx + 2 - mirrored.size
    # First, since -0 is the place after the last, and that may be the next row's.
    for j in range(whole):
        i = mirrored.size - LANES * (j + 1)  # where the mirrored tile begins
        at = start + (j * spectra + minus) * SIZE
        scale_reversed(mirrored, i, between, at, out, end + i)
        if minus != plus:
            prefetch(between, at + ahead)
    for k in range(max(whole * TILE, 1), columns):
        at = start + (whole * spectra + minus) * SIZE + 2 * (k - whole * TILE)
        i = mirrored.size - 2 * k - 2
        out[end + i] = mirrored[i] * between[at]
        out[end + i + 1] = mirrored[i + 1] * between[at + 1]
    for j in range(whole):
        at = start + (j * spectra + plus) * SIZE
        scale(factors, LANES * j, between, at, out, o + LANES * j)
        prefetch(between, at + ahead)
    for k in range(whole * TILE, columns):
        at = start + (whole * spectra + plus) * SIZE + 2 * (k - whole * TILE)
        out[o + 2 * k] = factors[2 * k] * between[at]
        out[o + 2 * k + 1] = factors[2 * k + 1] * between[at + 1]


@compiled
def split_row(
    packed: Real,
    p: int,
    undo: float,
    real: Real,
    imag: Real,
    stream_real: bool,
    stream_imag: bool,
) -> None:
    """Write the two real fields of a packed row, the second times `undo`."""
    nx = real.size
    whole = nx - nx % LANES
    for x in range(0, whole, LANES):
        split(packed, p + 2 * x, undo, real, x, imag, x, stream_real, stream_imag)
    for x in range(whole, nx):
        real[x] = packed[p + 2 * x]
        imag[x] = packed[p + 2 * x + 1] * undo


@compiled
def real_part(packed: Real, p: int, real: Real) -> None:
    """Write the real part of a packed row."""
    for x in range(real.size):
        real[x] = packed[p + 2 * x]


@compiled
def imaginary_part(packed: Real, p: int, undo: float, imag: Real) -> None:
    """Write the imaginary part of a packed row times `undo`, as `split_row` does."""
    for x in range(imag.size):
        imag[x] = packed[p + 2 * x + 1] * undo
