"""
Resampling from rest positions to world positions, by quintic B-splines.

Positions (u, v) count samples of a periodic grid along x and y. Spline coefficients are
interleaved, (my, mx, fields).
"""

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled

Flags = npt.NDArray[np.bool_]


@compiled
def weights(f: float, w: Real) -> None:
    """
    Write the weights of six samples: the quintic B-spline at f + 2, f + 1, ..., f - 3.

    f is the position between the third and the fourth, 0 <= f <= 1.
    """
    g = 1.0 - f
    f2 = f * f
    w[0] = g * g * g * g * g * (1 / 120)
    w[1] = (26.0 + f * (-50.0 + f * (20.0 + f * (20.0 + f * (-20.0 + f * 5.0))))) * (1 / 120)
    w[2] = (66.0 + f2 * (-60.0 + f2 * (30.0 - f * 10.0))) * (1 / 120)
    w[3] = (26.0 + f * (50.0 + f * (20.0 + f * (-20.0 + f * (-20.0 + f * 10.0))))) * (1 / 120)
    w[4] = (1.0 + f * (5.0 + f * (10.0 + f * (10.0 + f * (5.0 - f * 5.0))))) * (1 / 120)
    w[5] = f * f2 * f2 * (1 / 120)


@compiled
def rates(f: float, w: Real) -> None:
    """Write the derivatives of `weights` with respect to f."""
    g = 1.0 - f
    f2 = f * f
    w[0] = g * g * g * g * (-1 / 24)
    w[1] = (-50.0 + f * (40.0 + f * (60.0 + f * (-80.0 + f * 25.0)))) * (1 / 120)
    w[2] = f * (-120.0 + f2 * (120.0 - f * 50.0)) * (1 / 120)
    w[3] = (50.0 + f * (40.0 + f * (-60.0 + f * (-80.0 + f * 50.0)))) * (1 / 120)
    w[4] = (5.0 + f * (20.0 + f * (30.0 + f * (20.0 - f * 25.0)))) * (1 / 120)
    w[5] = f2 * f2 * (1 / 24)


@compiled
def sample(coefficients: Real, u: Real, v: Real, out: Real) -> None:
    """Write the spline of each field at (u[p], v[p]) to out[p], summed in double precision."""
    rows, columns, fields = coefficients.shape
    wu, wv, total = np.empty(6), np.empty(6), np.empty(fields)
    for p in range(u.size):
        i, j = int(np.floor(u[p])), int(np.floor(v[p]))
        weights(u[p] - i, wu)
        weights(v[p] - j, wv)
        total[:] = 0.0
        jj, first = (j - 2) % rows, (i - 2) % columns
        for b in range(6):
            ii = first
            for a in range(6):
                w = wv[b] * wu[a]
                for field in range(fields):
                    total[field] += w * coefficients[jj, ii, field]
                ii = ii + 1 if ii + 1 < columns else 0
            jj = jj + 1 if jj + 1 < rows else 0
        for field in range(fields):
            out[p, field] = total[field]


@compiled
def invert(
    shift: Real, x: Real, y: Real, steps: int, tolerance: float, u: Real, v: Real, residual: Real
) -> None:
    """
    Solve (u, v) + shift(u, v) = (x, y) by Newton's method, from the given (u, v).

    The derivatives are those of the spline. `shift` are coefficients (my, mx, 2) in samples; x, y,
    u, v and residual are (points,). A step is at most one sample long. The best of all positions
    tried is kept, with its residual in samples.
    """
    rows, columns = shift.shape[0], shift.shape[1]
    wu, wv, du, dv = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    for p in range(x.size):
        up, vp, best, best_u, best_v = u[p], v[p], np.inf, u[p], v[p]
        for _ in range(steps + 1):
            i, j = int(np.floor(up)), int(np.floor(vp))
            weights(up - i, wu)
            weights(vp - j, wv)
            rates(up - i, du)
            rates(vp - j, dv)
            sx = sy = xx = xy = yx = yy = 0.0
            jj, first = (j - 2) % rows, (i - 2) % columns
            for b in range(6):
                x0 = x1 = y0 = y1 = 0.0
                ii = first
                for a in range(6):
                    along_x, along_y = shift[jj, ii, 0], shift[jj, ii, 1]
                    x0 += wu[a] * along_x
                    x1 += du[a] * along_x
                    y0 += wu[a] * along_y
                    y1 += du[a] * along_y
                    ii = ii + 1 if ii + 1 < columns else 0
                jj = jj + 1 if jj + 1 < rows else 0
                sx += wv[b] * x0
                sy += wv[b] * y0
                xx += wv[b] * x1
                yx += wv[b] * y1
                xy += dv[b] * x0
                yy += dv[b] * y0
            ex, ey = x[p] - up - sx, y[p] - vp - sy
            off = np.hypot(ex, ey)
            if off < best:
                best, best_u, best_v = off, up, vp
            if not off > tolerance:
                break
            determinant = (1.0 + xx) * (1.0 + yy) - xy * yx
            if determinant == 0.0:
                break
            step_u = ((1.0 + yy) * ex - xy * ey) / determinant
            step_v = ((1.0 + xx) * ey - yx * ex) / determinant
            length = np.hypot(step_u, step_v)
            shorten = 1.0 / max(1.0, length)
            up += step_u * shorten
            vp += step_v * shorten
        u[p], v[p], residual[p] = best_u, best_v, best


@compiled
def uncover(
    x: Real, y: Real, z: Real, stride: int, u: Real, v: Real, top: Real, folded: Flags
) -> None:
    """
    Find the rest position of the highest water over every stride-th place of a periodic grid.

    The surface is two triangles to each cell of samples, displaced to (x, y) [samples] at height z,
    each (my, mx). Places lie at whole multiples of `stride`. u, v and top, the height, are (my /
    stride, mx / stride), top at first -inf; folded becomes true where a triangle over the place
    lies upside down.
    """
    rows, columns = x.shape
    tall, wide = top.shape
    cx, cy, cz, cu, cv = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for j in range(rows):
        for i in range(columns):
            for half in range(2):
                for corner in range(3):
                    a = 1 if corner == 1 or (corner == 2 and half == 0) else 0
                    b = 1 if corner == 2 or (corner == 1 and half == 1) else 0
                    jj, ii = j + b, i + a
                    cx[corner], cy[corner], cu[corner], cv[corner] = 0.0, 0.0, float(ii), float(jj)
                    if ii == columns:
                        ii, cx[corner] = 0, float(columns)
                    if jj == rows:
                        jj, cy[corner] = 0, float(rows)
                    cx[corner] += x[jj, ii]
                    cy[corner] += y[jj, ii]
                    cz[corner] = z[jj, ii]
                left, right = (
                    int(np.ceil(min(cx[0], cx[1], cx[2]) / stride)),
                    int(np.floor(max(cx[0], cx[1], cx[2]) / stride)),
                )
                low, high = (
                    int(np.ceil(min(cy[0], cy[1], cy[2]) / stride)),
                    int(np.floor(max(cy[0], cy[1], cy[2]) / stride)),
                )
                if right < left or high < low:
                    continue
                area = (cx[1] - cx[0]) * (cy[2] - cy[0]) - (cx[2] - cx[0]) * (cy[1] - cy[0])
                if area == 0.0:
                    continue
                for q in range(low, min(high, low + tall - 1) + 1):
                    for p in range(left, min(right, left + wide - 1) + 1):
                        px, py = p * stride - cx[0], q * stride - cy[0]
                        b1 = (px * (cy[2] - cy[0]) - (cx[2] - cx[0]) * py) / area
                        b2 = ((cx[1] - cx[0]) * py - px * (cy[1] - cy[0])) / area
                        if b1 < -1e-9 or b2 < -1e-9 or b1 + b2 > 1.0 + 1e-9:
                            continue
                        here = cz[0] + b1 * (cz[1] - cz[0]) + b2 * (cz[2] - cz[0])
                        jq, ip = q % tall, p % wide
                        if area < 0.0:
                            folded[jq, ip] = True
                        if here > top[jq, ip]:
                            top[jq, ip] = here
                            u[jq, ip] = (
                                cu[0]
                                + b1 * (cu[1] - cu[0])
                                + b2 * (cu[2] - cu[0])
                                - (p - ip) * stride
                            )
                            v[jq, ip] = (
                                cv[0]
                                + b1 * (cv[1] - cv[0])
                                + b2 * (cv[2] - cv[0])
                                - (q - jq) * stride
                            )


@compiled
def world_slopes(
    slope_x: Real,
    slope_y: Real,
    xx: Real,
    xy: Real,
    yy: Real,
    choppiness: float,
    steepest: float,
    out_x: Real,
    out_y: Real,
) -> None:
    """
    Write dz/dx and dz/dy of the displaced surface in world coordinates, from its normal.

    All arrays are (rows, columns). Where the surface stands upright or hangs over, at the rim of a
    fold, the slope would be infinite: it is limited to `steepest`.
    """
    for j in range(slope_x.shape[0]):
        for i in range(slope_x.shape[1]):
            a, b, d = (
                1.0 + choppiness * xx[j, i],
                choppiness * xy[j, i],
                1.0 + choppiness * yy[j, i],
            )
            nx, ny, nz = (
                b * slope_y[j, i] - slope_x[j, i] * d,
                slope_x[j, i] * b - a * slope_y[j, i],
                a * d - b * b,
            )
            nz = max(nz, np.hypot(nx, ny) / steepest)
            out_x[j, i] = -nx / nz if nz > 0.0 else 0.0
            out_y[j, i] = -ny / nz if nz > 0.0 else 0.0
