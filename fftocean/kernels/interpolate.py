"""
Periodic interpolation of several fields at once, linear and cubic.

Texel i of n is at u = i, and u + n is the same place as u. `texels` is (ny, nx, channels),
C-contiguous, any number of channels: the values of one texel share cache lines. All sums are in
double precision, whatever the type of the texels.
"""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled


@compiled
def bilinear(texels: Real, u: Real, v: Real, out: Real) -> None:
    """
    Add the bilinear interpolant at (u[p], v[p]) to out[p]; NaN where u or v is not finite.

    u and v are (points,) in texels, any number of periods away; out is (points, channels).
    """
    ny, nx, channels = texels.shape
    for p in range(u.size):
        if not (np.isfinite(u[p]) and np.isfinite(v[p])):
            out[p, :] = np.nan
            continue
        i, f = _texel(u[p], nx)
        j, g = _texel(v[p], ny)
        left, right, below, above = (
            np.uint64(i),
            np.uint64(_after(i, nx)),
            np.uint64(j),
            np.uint64(_after(j, ny)),
        )
        for c in range(channels):
            low = texels[below, left, c] * (1.0 - f) + texels[below, right, c] * f
            high = texels[above, left, c] * (1.0 - f) + texels[above, right, c] * f
            out[p, c] += low * (1.0 - g) + high * g


@compiled
def bicubic(texels: Real, u: Real, v: Real, spline: bool, out: Real) -> None:
    """
    Add the bicubic interpolant at (u[p], v[p]) to out[p]; NaN where u or v is not finite.

    With `spline`, texels are the coefficients of a cubic B-spline, which is smooth to the second
    derivative (see `spline_response`); without, they are the values themselves, and the curve is
    Catmull & Rom's (1974), smooth to the first.
    """
    ny, nx, channels = texels.shape
    for p in range(u.size):
        if not (np.isfinite(u[p]) and np.isfinite(v[p])):
            out[p, :] = np.nan
            continue
        i, f = _texel(u[p], nx)
        j, g = _texel(v[p], ny)
        a, b = (
            (spline_weights(f), spline_weights(g))
            if spline
            else (catmull_rom_weights(f), catmull_rom_weights(g))
        )
        i0, i1, i2 = np.uint64(_wrapped(i - 1, nx)), np.uint64(i), np.uint64(_after(i, nx))
        i3 = np.uint64(_after(_after(i, nx), nx))
        row = _wrapped(j - 1, ny)
        for weight in b:
            r = np.uint64(row)
            for c in range(channels):
                along = (
                    texels[r, i0, c] * a[0]
                    + texels[r, i1, c] * a[1]
                    + texels[r, i2, c] * a[2]
                    + texels[r, i3, c] * a[3]
                )
                out[p, c] += weight * along
            row = _after(row, ny)


@compiled
def bilinear_gradient(
    texels: Real, first: int, nx: int, ny: int, u: float, v: float
) -> tuple[float, ...]:
    """
    Return (a, b, c, da/du, da/dv, db/du, db/dv) of the bilinear interpolant at (u, v).

    a, b and c are the first three channels. `texels` is flat, four channels to a texel; those of
    the tile lie row by row from texel `first` on, framed as by `frame_texels`. (u, v) is finite,
    and fits into an integer.
    """
    i, f = _near_texel(u, nx)
    j, g = _near_texel(v, ny)
    low = first + (j + 1) * (nx + FRAME) + i + 1
    high = low + nx + FRAME
    a, a_u, b, b_u, c = _linear_row(texels, low, low + 1, f)
    a_high, a_u_high, b_high, b_u_high, c_high = _linear_row(texels, high, high + 1, f)
    a_v, b_v = a_high - a, b_high - b
    return (
        a + g * a_v,
        b + g * b_v,
        c + g * (c_high - c),
        a_u + g * (a_u_high - a_u),
        a_v,
        b_u + g * (b_u_high - b_u),
        b_v,
    )


@compiled
def _linear_row(texels: Real, i: int, right: int, f: float) -> tuple[float, ...]:
    """Return (a, da/du, b, db/du, c) between two texels."""
    a, b, c = _three(texels, i)
    p, q, r = _three(texels, right)
    return a + f * (p - a), p - a, b + f * (q - b), q - b, c + f * (r - c)


@compiled
def _three(texels: Real, i: int) -> tuple[float, float, float]:
    """
    Return the first three channels of a texel.

    Unsigned indices, here and above, need no check for negative ones.
    """
    k = np.uint64(4 * i)
    return float(texels[k]), float(texels[k + _ONE]), float(texels[k + _TWO])


_ONE, _TWO = np.uint64(1), np.uint64(2)


@compiled
def spline_gradient(
    texels: Real, first: int, nx: int, ny: int, u: float, v: float
) -> tuple[float, ...]:
    """Return the same of the cubic B-spline whose coefficients the texels are."""
    i, f = _near_texel(u, nx)
    j, g = _near_texel(v, ny)
    w, d = spline_weights(f), spline_slopes(f)
    w0, w1, w2, w3 = spline_weights(g)
    d0, d1, d2, d3 = spline_slopes(g)
    width = nx + FRAME
    corner = first + j * width + i
    a0, p0, b0, q0, c0 = _cubic_row(texels, corner, w, d)
    a1, p1, b1, q1, c1 = _cubic_row(texels, corner + width, w, d)
    a2, p2, b2, q2, c2 = _cubic_row(texels, corner + 2 * width, w, d)
    a3, p3, b3, q3, c3 = _cubic_row(texels, corner + 3 * width, w, d)
    return (
        w0 * a0 + w1 * a1 + w2 * a2 + w3 * a3,
        w0 * b0 + w1 * b1 + w2 * b2 + w3 * b3,
        w0 * c0 + w1 * c1 + w2 * c2 + w3 * c3,
        w0 * p0 + w1 * p1 + w2 * p2 + w3 * p3,
        d0 * a0 + d1 * a1 + d2 * a2 + d3 * a3,
        w0 * q0 + w1 * q1 + w2 * q2 + w3 * q3,
        d0 * b0 + d1 * b1 + d2 * b2 + d3 * b3,
    )


@compiled
def _cubic_row(
    texels: Real,
    i: int,
    w: tuple[float, float, float, float],
    d: tuple[float, float, float, float],
) -> tuple[float, ...]:
    """
    Return (a, da/du, b, db/du, c) along four texels from i on, by the weights of values and slopes.
    """
    a0, b0, c0 = _three(texels, i)
    a1, b1, c1 = _three(texels, i + 1)
    a2, b2, c2 = _three(texels, i + 2)
    a3, b3, c3 = _three(texels, i + 3)
    return (
        w[0] * a0 + w[1] * a1 + w[2] * a2 + w[3] * a3,
        d[0] * a0 + d[1] * a1 + d[2] * a2 + d[3] * a3,
        w[0] * b0 + w[1] * b1 + w[2] * b2 + w[3] * b3,
        d[0] * b0 + d[1] * b1 + d[2] * b2 + d[3] * b3,
        w[0] * c0 + w[1] * c1 + w[2] * c2 + w[3] * c3,
    )


FRAME = 3
"""Texels by which a tile is wider and higher with its frame."""


def frame_texels(framed: Real) -> None:
    """
    Repeat texels around a tile, in place, so that no interpolation has to go round.

    Args:
        framed: (ny + FRAME, nx + FRAME, channels), the tile from [1, 1] on: one texel is repeated
            before it, two behind, along either axis.
    """
    for to, source in ((0, -3), (-2, 1), (-1, 2)):  # in turn: a tile can be one texel wide
        framed[1:-2, to] = framed[1:-2, source]
    for to, source in ((0, -3), (-2, 1), (-1, 2)):
        framed[to] = framed[source]


BLOCK = 128
"""Points that are interpolated at a time."""

ROWS = 23
U, V, DISPLACE_X, DISPLACE_Y, HEIGHT, XX, XY, YX, YY = (row * BLOCK for row in range(9))
"""Starts of the rows of a workspace: texel coordinates, then the sums of the interpolants."""

# Then fractions of a texel along u and v, and the three channels of the four texels around.
_F, _G = 9 * BLOCK, 10 * BLOCK
_A, _B, _C, _A_RIGHT, _B_RIGHT, _C_RIGHT = (row * BLOCK for row in range(11, 17))
_A_UP, _B_UP, _C_UP, _A_ACROSS, _B_ACROSS, _C_ACROSS = (row * BLOCK for row in range(17, 23))
# Or sums along v of four texels side by side, and of their slopes.
_ACROSS, _SLOPES, _SIXTEEN = 9 * BLOCK, 9 * BLOCK + 16, np.uint64(16)


@compiled
def bilinear_gradients(
    texels: Real, first: int, nx: int, ny: int, per_x: float, per_y: float, count: int, rows: Real
) -> None:
    """
    Add the results of `bilinear_gradient` for `count` points at once.

    First all texels are fetched, then all sums are computed: the processor waits for many fetches
    at a time, and sums several points at a time.

    Args:
        texels, first, nx, ny: as in `bilinear_gradient`.
        per_x, per_y: texels to the metre.
        count: number of points, at most `BLOCK`.
        rows: a workspace, (ROWS * BLOCK,): `U` and `V` are read, the seven sums from `DISPLACE_X`
            to `YY` are added to, with derivatives by the metre (`XY` is d displace_x / dy). It is
            flat, so that a compiler sees that its rows do not overlap.
    """
    for p in range(count):
        i, f = _near_texel(rows[U + p], nx)
        j, g = _near_texel(rows[V + p], ny)
        low = first + (j + 1) * (nx + FRAME) + i + 1
        high = low + nx + FRAME
        rows[_F + p], rows[_G + p] = f, g
        rows[_A + p], rows[_B + p], rows[_C + p] = _three(texels, low)
        rows[_A_RIGHT + p], rows[_B_RIGHT + p], rows[_C_RIGHT + p] = _three(texels, low + 1)
        rows[_A_UP + p], rows[_B_UP + p], rows[_C_UP + p] = _three(texels, high)
        rows[_A_ACROSS + p], rows[_B_ACROSS + p], rows[_C_ACROSS + p] = _three(texels, high + 1)
    for p in range(count):
        f, g = rows[_F + p], rows[_G + p]
        a, b, c = rows[_A + p], rows[_B + p], rows[_C + p]
        a_low, b_low = rows[_A_RIGHT + p] - a, rows[_B_RIGHT + p] - b
        c += f * (rows[_C_RIGHT + p] - c)
        a_up, b_up, c_up = rows[_A_UP + p], rows[_B_UP + p], rows[_C_UP + p]
        a_high, b_high = rows[_A_ACROSS + p] - a_up, rows[_B_ACROSS + p] - b_up
        c_up += f * (rows[_C_ACROSS + p] - c_up)
        a, b, a_up, b_up = a + f * a_low, b + f * b_low, a_up + f * a_high, b_up + f * b_high
        rows[DISPLACE_X + p] += a + g * (a_up - a)
        rows[DISPLACE_Y + p] += b + g * (b_up - b)
        rows[HEIGHT + p] += c + g * (c_up - c)
        rows[XX + p] += per_x * (a_low + g * (a_high - a_low))
        rows[XY + p] += per_y * (a_up - a)
        rows[YX + p] += per_x * (b_low + g * (b_high - b_low))
        rows[YY + p] += per_y * (b_up - b)


@compiled
def spline_gradients(
    texels: Real, first: int, nx: int, ny: int, per_x: float, per_y: float, count: int, rows: Real
) -> None:
    """
    Add the results of `spline_gradient` for `count` points; arguments as in `bilinear_gradients`.

    Each point first sums its four rows, whose four texels are 16 numbers side by side, which the
    processor sums several at a time.
    """
    width = nx + FRAME
    for p in range(count):
        i, f = _near_texel(rows[U + p], nx)
        j, g = _near_texel(rows[V + p], ny)
        w0, w1, w2, w3 = spline_weights(g)
        d0, d1, d2, d3 = spline_slopes(g)
        r0 = np.uint64(4 * (first + j * width + i))
        r1 = r0 + np.uint64(4 * width)
        r2 = r1 + np.uint64(4 * width)
        r3 = r2 + np.uint64(4 * width)
        for e in range(_SIXTEEN):
            t0, t1 = float(texels[r0 + e]), float(texels[r1 + e])
            t2, t3 = float(texels[r2 + e]), float(texels[r3 + e])
            rows[_ACROSS + e] = w0 * t0 + w1 * t1 + w2 * t2 + w3 * t3
            rows[_SLOPES + e] = d0 * t0 + d1 * t1 + d2 * t2 + d3 * t3
        w0, w1, w2, w3 = spline_weights(f)
        d0, d1, d2, d3 = spline_slopes(f)
        a0, a1, a2, a3 = rows[_ACROSS], rows[_ACROSS + 4], rows[_ACROSS + 8], rows[_ACROSS + 12]
        b0, b1, b2, b3 = rows[_ACROSS + 1], rows[_ACROSS + 5], rows[_ACROSS + 9], rows[_ACROSS + 13]
        rows[DISPLACE_X + p] += w0 * a0 + w1 * a1 + w2 * a2 + w3 * a3
        rows[DISPLACE_Y + p] += w0 * b0 + w1 * b1 + w2 * b2 + w3 * b3
        rows[XX + p] += per_x * (d0 * a0 + d1 * a1 + d2 * a2 + d3 * a3)
        rows[YX + p] += per_x * (d0 * b0 + d1 * b1 + d2 * b2 + d3 * b3)
        a0, a1, a2, a3 = (
            rows[_ACROSS + 2],
            rows[_ACROSS + 6],
            rows[_ACROSS + 10],
            rows[_ACROSS + 14],
        )
        rows[HEIGHT + p] += w0 * a0 + w1 * a1 + w2 * a2 + w3 * a3
        a0, a1, a2, a3 = rows[_SLOPES], rows[_SLOPES + 4], rows[_SLOPES + 8], rows[_SLOPES + 12]
        b0, b1, b2, b3 = rows[_SLOPES + 1], rows[_SLOPES + 5], rows[_SLOPES + 9], rows[_SLOPES + 13]
        rows[XY + p] += per_y * (w0 * a0 + w1 * a1 + w2 * a2 + w3 * a3)
        rows[YY + p] += per_y * (w0 * b0 + w1 * b1 + w2 * b2 + w3 * b3)


@compiled
def catmull_rom_weights(f: float) -> tuple[float, float, float, float]:
    """Return the weights of four texels at a fraction f beyond the second of them."""
    return (
        ((-0.5 * f + 1.0) * f - 0.5) * f,
        (1.5 * f - 2.5) * f * f + 1.0,
        ((-1.5 * f + 2.0) * f + 0.5) * f,
        (0.5 * f - 0.5) * f * f,
    )


@compiled
def spline_weights(f: float) -> tuple[float, float, float, float]:
    """Return the same for the cubic B-spline."""
    e = 1.0 - f
    return (
        e * e * e / 6.0,
        (0.5 * f - 1.0) * f * f + 2.0 / 3.0,
        (0.5 * e - 1.0) * e * e + 2.0 / 3.0,
        f * f * f / 6.0,
    )


@compiled
def spline_slopes(f: float) -> tuple[float, float, float, float]:
    """Return the derivatives of `spline_weights`."""
    e = 1.0 - f
    return -0.5 * e * e, (1.5 * f - 2.0) * f, (2.0 - 1.5 * e) * e, 0.5 * f * f


def spline_response(cycles: Real) -> Real:
    """
    Return the response of a cubic B-spline to a wave, (2 + cos(2 pi cycles))/3.

    Waves divided by it, along x and y, are the coefficients of the spline that goes through the
    texels of the waves (Unser 1999).

    Args:
        cycles: of the wave from texel to texel.
    """
    response: Real = (2.0 + np.cos(2.0 * np.pi * cycles)) / 3.0
    return response


@compiled
def _texel(u: float, n: int) -> tuple[int, float]:
    """Return the texel at or before u, in [0, n), and the fraction beyond it; u is finite."""
    return _near_texel(u - np.floor(u / n) * n, n)


@compiled
def _near_texel(u: float, n: int) -> tuple[int, float]:
    """Return the same without a division, for a u that an integer can hold."""
    whole = np.floor(u)
    return _wrapped(int(whole), n), u - whole


@compiled
def _wrapped(i: int, n: int) -> int:
    """Return i mod n, without a division if i is next to the tile."""
    if i < 0:
        i += n
    elif i >= n:
        i -= n
    return i if 0 <= i < n else i % n


@compiled
def _after(i: int, n: int) -> int:
    """Return the texel after i, for i in [0, n)."""
    return i + 1 if i + 1 < n else 0
