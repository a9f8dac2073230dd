"""
Periodic interpolation of fields that lie side by side: texel i of n stands at u = i, and u + n is u
again.

`texels` is (ny, nx, channels), C-contiguous, any number of channels: what belongs to one point
shares cache lines. All sums are in double precision, whatever the texels are.
"""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled


@compiled
def bilinear(texels: Real, u: Real, v: Real, out: Real) -> None:
    """
    out[p] += the texels around (u[p], v[p]), linear in between; NaN where u or v is not finite.

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
    out[p] += the bicubic through or along the 4 x 4 texels around (u[p], v[p]); NaN where u or v is
    not finite.

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
    Return the first three channels (a, b, c) at (u, v), and da/du, da/dv, db/du, db/dv of the
    interpolant itself.

    `texels` is flat, four channels to a texel: the tile's lie row by row from texel `first` on. (u,
    v) is finite, and not too far away for an integer.
    """
    i, f = _near_texel(u, nx)
    j, g = _near_texel(v, ny)
    right = _after(i, nx)
    low, high = first + j * nx, first + _after(j, ny) * nx
    a, a_u, b, b_u, c = _linear_row(texels, low + i, low + right, f)
    a_high, a_u_high, b_high, b_u_high, c_high = _linear_row(texels, high + i, high + right, f)
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
    """(a, da/du, b, db/du, c) between two texels."""
    a, b, c = _three(texels, i)
    p, q, r = _three(texels, right)
    return a + f * (p - a), p - a, b + f * (q - b), q - b, c + f * (r - c)


@compiled
def _three(texels: Real, i: int) -> tuple[float, float, float]:
    """
    The first three channels of a texel. Unsigned indices, here as above, spare the question whether
    they count from the end.
    """
    k = np.uint64(4 * i)
    return float(texels[k]), float(texels[k + _ONE]), float(texels[k + _TWO])


_ONE, _TWO = np.uint64(1), np.uint64(2)


@compiled
def spline_gradient(
    texels: Real, first: int, nx: int, ny: int, u: float, v: float
) -> tuple[float, ...]:
    """The same, of the cubic B-spline whose coefficients the texels are."""
    i, f = _near_texel(u, nx)
    j, g = _near_texel(v, ny)
    w, d = spline_weights(f), spline_slopes(f)
    w0, w1, w2, w3 = spline_weights(g)
    d0, d1, d2, d3 = spline_slopes(g)
    i0, i2 = _wrapped(i - 1, nx), _after(i, nx)
    i3, r2 = _after(i2, nx), _after(j, ny)
    r0, r1, r3 = first + _wrapped(j - 1, ny) * nx, first + j * nx, first + _after(r2, ny) * nx
    r2 = first + r2 * nx
    a0, p0, b0, q0, c0 = _cubic_row(texels, r0 + i0, r0 + i, r0 + i2, r0 + i3, w, d)
    a1, p1, b1, q1, c1 = _cubic_row(texels, r1 + i0, r1 + i, r1 + i2, r1 + i3, w, d)
    a2, p2, b2, q2, c2 = _cubic_row(texels, r2 + i0, r2 + i, r2 + i2, r2 + i3, w, d)
    a3, p3, b3, q3, c3 = _cubic_row(texels, r3 + i0, r3 + i, r3 + i2, r3 + i3, w, d)
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
    j: int,
    k: int,
    m: int,
    w: tuple[float, float, float, float],
    d: tuple[float, float, float, float],
) -> tuple[float, ...]:
    """
    (a, da/du, b, db/du, c) along four texels of one row, with the weights of values and slopes.
    """
    a0, b0, c0 = _three(texels, i)
    a1, b1, c1 = _three(texels, j)
    a2, b2, c2 = _three(texels, k)
    a3, b3, c3 = _three(texels, m)
    return (
        w[0] * a0 + w[1] * a1 + w[2] * a2 + w[3] * a3,
        d[0] * a0 + d[1] * a1 + d[2] * a2 + d[3] * a3,
        w[0] * b0 + w[1] * b1 + w[2] * b2 + w[3] * b3,
        d[0] * b0 + d[1] * b1 + d[2] * b2 + d[3] * b3,
        w[0] * c0 + w[1] * c1 + w[2] * c2 + w[3] * c3,
    )


@compiled
def bilinear_gradients(
    texels: Real, first: int, nx: int, ny: int, per_x: float, per_y: float, count: int, desk: Real
) -> None:
    """
    Add what `bilinear_gradient` returns for `count` points at once, u a per_x and v a per_y to the
    metre.

    First all texels are fetched, then all is computed: fetches wait side by side, and sums go
    several at a time. `desk` is `ROWS` rows of `BLOCK`, flat, so that a compiler sees that they do
    not overlap: u, v, the seven sums (a, b, c, da/dx, da/dy, db/dx, db/dy), and room to work in.
    """
    for p in range(count):
        i, f = _near_texel(desk[p], nx)
        j, g = _near_texel(desk[BLOCK + p], ny)
        right, low, high = _after(i, nx), first + j * nx, first + _after(j, ny) * nx
        desk[9 * BLOCK + p], desk[10 * BLOCK + p] = f, g
        desk[11 * BLOCK + p], desk[12 * BLOCK + p], desk[13 * BLOCK + p] = _three(texels, low + i)
        desk[14 * BLOCK + p], desk[15 * BLOCK + p], desk[16 * BLOCK + p] = _three(
            texels, low + right
        )
        desk[17 * BLOCK + p], desk[18 * BLOCK + p], desk[19 * BLOCK + p] = _three(texels, high + i)
        desk[20 * BLOCK + p], desk[21 * BLOCK + p], desk[22 * BLOCK + p] = _three(
            texels, high + right
        )
    for p in range(count):
        f, g = desk[9 * BLOCK + p], desk[10 * BLOCK + p]
        a, b, c = desk[11 * BLOCK + p], desk[12 * BLOCK + p], desk[13 * BLOCK + p]
        a_low, b_low = desk[14 * BLOCK + p] - a, desk[15 * BLOCK + p] - b
        c += f * (desk[16 * BLOCK + p] - c)
        a_up, b_up, c_up = desk[17 * BLOCK + p], desk[18 * BLOCK + p], desk[19 * BLOCK + p]
        a_high, b_high = desk[20 * BLOCK + p] - a_up, desk[21 * BLOCK + p] - b_up
        c_up += f * (desk[22 * BLOCK + p] - c_up)
        a, b, a_up, b_up = a + f * a_low, b + f * b_low, a_up + f * a_high, b_up + f * b_high
        desk[2 * BLOCK + p] += a + g * (a_up - a)
        desk[3 * BLOCK + p] += b + g * (b_up - b)
        desk[4 * BLOCK + p] += c + g * (c_up - c)
        desk[5 * BLOCK + p] += per_x * (a_low + g * (a_high - a_low))
        desk[6 * BLOCK + p] += per_y * (a_up - a)
        desk[7 * BLOCK + p] += per_x * (b_low + g * (b_high - b_low))
        desk[8 * BLOCK + p] += per_y * (b_up - b)


BLOCK, ROWS = 128, 23


@compiled
def spline_gradients(
    texels: Real, first: int, nx: int, ny: int, per_x: float, per_y: float, count: int, desk: Real
) -> None:
    """The same for `spline_gradient`, point by point: 16 texels at a time are work enough."""
    for p in range(count):
        a, b, c, a_u, a_v, b_u, b_v = spline_gradient(
            texels, first, nx, ny, desk[p], desk[BLOCK + p]
        )
        desk[2 * BLOCK + p] += a
        desk[3 * BLOCK + p] += b
        desk[4 * BLOCK + p] += c
        desk[5 * BLOCK + p] += per_x * a_u
        desk[6 * BLOCK + p] += per_y * a_v
        desk[7 * BLOCK + p] += per_x * b_u
        desk[8 * BLOCK + p] += per_y * b_v


@compiled
def catmull_rom_weights(f: float) -> tuple[float, float, float, float]:
    """The weights of the four texels around, a fraction f beyond the second of them."""
    return (
        ((-0.5 * f + 1.0) * f - 0.5) * f,
        (1.5 * f - 2.5) * f * f + 1.0,
        ((-1.5 * f + 2.0) * f + 0.5) * f,
        (0.5 * f - 0.5) * f * f,
    )


@compiled
def spline_weights(f: float) -> tuple[float, float, float, float]:
    """The same for the cubic B-spline."""
    e = 1.0 - f
    return (
        e * e * e / 6.0,
        (0.5 * f - 1.0) * f * f + 2.0 / 3.0,
        (0.5 * e - 1.0) * e * e + 2.0 / 3.0,
        f * f * f / 6.0,
    )


@compiled
def spline_slopes(f: float) -> tuple[float, float, float, float]:
    """The derivatives of `spline_weights`."""
    e = 1.0 - f
    return -0.5 * e * e, (1.5 * f - 2.0) * f, (2.0 - 1.5 * e) * e, 0.5 * f * f


def spline_response(turns: Real) -> Real:
    """
    How much a cubic B-spline weakens a wave that makes `turns` turns from texel to texel: (2 +
    cos(2 pi turns))/3.

    Waves divided by it, along x and y, are the coefficients of the spline that goes through the
    waves' own texels (Unser 1999).
    """
    response: Real = (2.0 + np.cos(2.0 * np.pi * turns)) / 3.0
    return response


@compiled
def _texel(u: float, n: int) -> tuple[int, float]:
    """The texel at or before u, in [0, n), and the fraction beyond it; u is finite."""
    return _near_texel(u - np.floor(u / n) * n, n)


@compiled
def _near_texel(u: float, n: int) -> tuple[int, float]:
    """The same without a division, for a u that an integer can hold."""
    whole = np.floor(u)
    return _wrapped(int(whole), n), u - whole


@compiled
def _wrapped(i: int, n: int) -> int:
    """i mod n, without a division where i is next to the tile."""
    if i < 0:
        i += n
    elif i >= n:
        i -= n
    return i if 0 <= i < n else i % n


@compiled
def _after(i: int, n: int) -> int:
    """The texel after i, which is one of the tile's."""
    return i + 1 if i + 1 < n else 0
