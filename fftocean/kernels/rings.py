"""
Sums of waves at points below the surface, ring by ring.

A ring has the waves of one wavenumber k and one frequency. Profiles over the depth depend on k
alone, so that they are computed once a ring. Of a tile the waves (+-kx, +-ky) share the products

    cc = cos kx x cos ky y,   ss = sin sin,   sc = sin kx x cos ky y,   cs = cos kx x sin ky y,

kx and ky being positive here: with h = amplitude e^{-i phase} and the signs p and q of its
components, a wave is h ((cc - p q ss) + i (p sc + q cs)). So of the four waves the sums of h, p h,
q h and p q h are all that is needed: a quartet. Cosines and sines come from tables of columns kx
and rows ky. Loops run over the points, in at most five arrays, so that compilers vectorise them.
"""

from typing import Any, NamedTuple

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels import passes
from fftocean.kernels.compiler import compiled
from fftocean.kernels.query import reduced

POINTS = 64
"""Points that are summed at a time: their tables stay in the cache."""

OUTPUTS = 7
"""Velocity and acceleration, x, y and z of each, and -d potential/dt."""

_LOG2E, _LN2_HIGH, _LN2_LOW = 1.4426950408889634, 0.6931471803691238, 1.9082149292705877e-10
_LEAST = -700.0  # e^-700 is 1e-304, which is no motion


class Quartets(NamedTuple):
    """The waves of one tile, by rings."""

    first: Integer  # (rings + 1,): number of the first quartet of each
    k: Real  # (rings,) [rad/m]
    omega: Real  # (rings,) [rad/s]
    column: Integer  # (quartets,): number of kx in the tables
    row: Integer  # and of ky
    sums: Real  # (quartets, 8): real parts of the sums of h, p h, q h, p q h, then imaginary ones


class Tables(NamedTuple):
    """Cosines and sines of columns and rows at `POINTS` points."""

    cos_x: Real  # (columns, points)
    sin_x: Real
    cos_y: Real  # (rows, points)
    sin_y: Real


@compiled
def add_waves(
    quartet: Integer, sign_x: Real, sign_y: Real, amplitude: Real, phase: Real, sums: Real
) -> None:
    """Add waves to the sums of their quartets, of `Quartets`."""
    for m in range(quartet.size):
        to, p, q = sums[quartet[m]], sign_x[m], sign_y[m]
        real, imag = amplitude[m] * np.cos(phase[m]), -amplitude[m] * np.sin(phase[m])
        to[0] += real
        to[1] += p * real
        to[2] += q * real
        to[3] += p * q * real
        to[4] += imag
        to[5] += p * imag
        to[6] += q * imag
        to[7] += p * q * imag


@compiled
def tabulate(x: Real, size: float, numbers: Real, cycles: Real, cosine: Real, sine: Real) -> None:
    """
    Write cosines and sines of numbers[c] x[p], (columns, points); NaN where x is not finite.

    Args:
        x: coordinates, (points,) [m].
        size: of the tile along x [m], inf if nothing repeats.
        numbers: wavenumbers, (columns,) [rad/m].
        cycles: a buffer, (columns + 1, points).
        cosine, sine: (columns, points).
    """
    columns = numbers.size
    for p in range(x.size):
        cycles[columns, p] = reduced(x[p], size) if np.isfinite(x[p]) else np.nan
    for c in range(columns):
        passes.phases_at(cycles[columns:], numbers[c] / (2.0 * np.pi), cycles[c : c + 1])
    passes.phasors(cycles[:columns], cosine, sine)


@compiled
def sum_heights(waves: tuple[Any, ...], tables: tuple[Any, ...], out: Real) -> None:
    """Add the height of all waves to (points,)."""
    w, table, points = Quartets(*waves), Tables(*tables), np.uint64(out.size)
    for n in range(w.column.size):
        cx, sx = table.cos_x[w.column[n]], table.sin_x[w.column[n]]
        cy, sy = table.cos_y[w.row[n]], table.sin_y[w.row[n]]
        s = w.sums[n]
        s0, s3, s5, s6 = s[0], s[3], s[5], s[6]
        for p in range(points):
            out[p] += cx[p] * (s0 * cy[p] - s6 * sy[p]) - sx[p] * (s5 * cy[p] + s3 * sy[p])


@compiled
def sum_below(
    waves: tuple[Any, ...],
    tables: tuple[Any, ...],
    kx: Real,
    ky: Real,
    depth: float,
    level: Real,
    rise: Real,
    buffer: Real,
    bits: Integer,
    out: Real,
) -> None:
    """
    Add the motion of the water of all waves.

    A wave moves the water by cosh k(z + h)/sinh kh along and sinh k(z + h)/sinh kh up. Both are
    written with exponents that are never positive, so that nothing overflows; deep water is their
    limit, e^{kz}. Above a level they can go on along their tangent at z = 0, where the derivative
    is k along, and k coth kh up.

    Args:
        waves: the fields of `Quartets`.
        tables: the fields of `Tables`.
        kx, ky: of the columns and rows [rad/m].
        depth: still-water depth h [m].
        level: z at which the profiles are evaluated, (points,), from -h to 0 [m].
        rise: what to go on by along the tangent at 0, (points,) [m].
        buffer: (11 points,).
        bits: the last `points` numbers of the buffer, seen as integers.
        out: (7 points,): rows of velocity and acceleration, x, y and z of each, and
            -d potential/dt; added to.
    """
    w, table, points = Quartets(*waves), Tables(*tables), np.uint64(level.size)
    two, three, four = np.uint64(2) * points, np.uint64(3) * points, np.uint64(4) * points
    five, six, seven = np.uint64(5) * points, np.uint64(6) * points, np.uint64(7) * points
    eight, nine, ten = np.uint64(8) * points, np.uint64(9) * points, np.uint64(10) * points
    sums, along, up = buffer[:six], buffer[six:seven], buffer[seven:eight]
    mirrored, below, power = buffer[eight:nine], buffer[nine:ten], buffer[ten:]
    for p in range(points):
        mirrored[p] = -(level[p] + 2.0 * depth)
    for r in range(w.k.size):
        k, omega = w.k[r], w.omega[r]
        sums[:] = 0.0
        for n in range(w.first[r], w.first[r + 1]):
            cx, sx = table.cos_x[w.column[n]], table.sin_x[w.column[n]]
            cy, sy = table.cos_y[w.row[n]], table.sin_y[w.row[n]]
            s, x, y = w.sums[n], kx[w.column[n]], ky[w.row[n]]
            a0, ax, ay, axy, b0, bx, by, bxy = s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7]
            for p in range(points):
                cc, ss, sc, cs = cx[p] * cy[p], sx[p] * sy[p], sx[p] * cy[p], cx[p] * sy[p]
                sums[p] += a0 * cc - axy * ss - bx * sc - by * cs
                sums[points + p] += b0 * cc - bxy * ss + ax * sc + ay * cs
                sums[two + p] += x * (ax * cc - ay * ss - b0 * sc - bxy * cs)
                sums[three + p] += y * (ay * cc - ax * ss - bxy * sc - b0 * cs)
                sums[four + p] += x * (bx * cc - by * ss + a0 * sc + axy * cs)
                sums[five + p] += y * (by * cc - bx * ss + axy * sc + a0 * cs)
        decay(k, level, power, bits, along)
        coth = 1.0
        if depth < np.inf:
            decay(k, mirrored, power, bits, below)
            part = -1.0 / np.expm1(-2.0 * k * depth)
            coth = (1.0 + np.exp(-2.0 * k * depth)) * part
            for p in range(points):
                whole = along[p]
                along[p] = (whole + below[p]) * part
                up[p] = (whole - below[p]) * part
        else:
            up[:] = along
        for p in range(points):
            along[p] = (along[p] + k * rise[p]) * (omega / k)
            up[p] = (up[p] + k * coth * rise[p]) * omega
        for p in range(points):
            out[p] += along[p] * sums[two + p]
            out[points + p] += along[p] * sums[three + p]
            out[two + p] += up[p] * sums[points + p]
            out[three + p] += omega * along[p] * sums[four + p]
            out[four + p] += omega * along[p] * sums[five + p]
            out[five + p] -= omega * up[p] * sums[p]
            out[six + p] += omega * along[p] * sums[p]


@compiled
def decay(k: float, z: Real, power: Real, bits: Integer, out: Real) -> None:
    """
    Write out = e^{k z} for z <= 0, (points,), to rounding; NaN where z is.

    k z = n ln 2 + r: a Taylor series of r, |r| < 0.35, whose first term left out is 4e-18, times
    the power 2^n, made from its bits: `passes.ROUND` added to a number leaves n in the lowest ones.

    Args:
        k: wavenumber [rad/m].
        z: levels [m].
        power: a buffer, (points,).
        bits: the same buffer, seen as integers of 64 bits.
        out: (points,).
    """
    for p in range(z.size):
        v = k * z[p]
        v = _LEAST if v < _LEAST else v
        power[p] = v * _LOG2E + passes.ROUND
        whole = power[p] - passes.ROUND
        out[p] = (v - whole * _LN2_HIGH) - whole * _LN2_LOW
    for p in range(z.size):
        bits[p] = (bits[p] + 1023) << 52
    for p in range(z.size):
        r = out[p]
        s = 1.0 + r * (1 / 11) * (1.0 + r * (1 / 12) * (1.0 + r * (1 / 13)))
        s = 1.0 + r * (1 / 8) * (1.0 + r * (1 / 9) * (1.0 + r * (1 / 10) * s))
        s = 1.0 + r * (1 / 5) * (1.0 + r * (1 / 6) * (1.0 + r * (1 / 7) * s))
        s = 1.0 + r * (1.0 + r * (1 / 2) * (1.0 + r * (1 / 3) * (1.0 + r * (1 / 4) * s)))
        out[p] = s * power[p]
