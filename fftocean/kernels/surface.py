"""Pointwise geometry of the displaced surface: normals, Jacobians and folds."""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled
from fftocean.kernels.vectors import LANES, interleave


@compiled
def normals(
    slope_x: Real, slope_y: Real, xx: Real, xy: Real, yy: Real, choppiness: float, out: Real
) -> None:
    """
    Write the unit normal, along (1 + c Dxx, c Dxy, sx) x (c Dxy, 1 + c Dyy, sy).

    It is the cross product of the two tangents.
    Its z component has the sign of the Jacobian: where the surface is folded over, the normal
    points down. Where both tangents vanish together there is no normal, and up is returned.
    """
    n = out.shape[1]
    unit = np.empty(3 * n, xx.dtype)
    for j in range(out.shape[0]):
        row = out[j].reshape(3 * n)
        normal_row(slope_x[j], slope_y[j], xx[j], xy[j], yy[j], choppiness, unit, row, False)


@compiled
def normal_row(
    slope_x: Real,
    slope_y: Real,
    xx: Real,
    xy: Real,
    yy: Real,
    choppiness: float,
    unit: Real,
    out: Real,
    streamed: bool,
) -> None:
    """
    Write the normals of one row, 3 n numbers; if `streamed` is true, past the caches.

    `unit` is a buffer of as many: compilers vectorise a loop that writes to one array.
    """
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    nothing = xx.dtype.type(0)
    n = xx.size
    second, third = np.uint64(n), np.uint64(2 * n)  # unsigned: no check for negative indices
    for i in range(n):
        a = one + choppiness * xx[i]
        b = choppiness * xy[i]
        d = one + choppiness * yy[i]
        x = b * slope_y[i] - slope_x[i] * d
        y = b * slope_x[i] - slope_y[i] * a
        z = a * d - b * b
        square = x * x + y * y + z * z
        per_length = one / np.sqrt(square) if square > nothing else nothing
        k = np.uint64(i)
        unit[k] = x * per_length
        unit[second + k] = y * per_length
        unit[third + k] = z * per_length if per_length > nothing else one
    whole = n - n % LANES
    for i in range(0, whole, LANES):
        interleave(unit, i, n, out, 3 * i, streamed)
    for i in range(whole, n):
        k = np.uint64(i)
        out[3 * i] = unit[k]
        out[3 * i + 1] = unit[second + k]
        out[3 * i + 2] = unit[third + k]


@compiled
def jacobian(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """
    Write the Jacobian (1 + c Dxx)(1 + c Dyy) - (c Dxy)^2.

    It is the area of the displaced surface over that at rest; below 0 the water is folded.
    """
    for j in range(out.shape[0]):
        jacobian_row(xx[j], xy[j], yy[j], choppiness, out[j])


@compiled
def jacobian_row(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """Write the Jacobians of one row."""
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    for i in range(out.size):
        b = choppiness * xy[i]
        out[i] = (one + choppiness * xx[i]) * (one + choppiness * yy[i]) - b * b


@compiled
def minimum_eigenvalue(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """
    Write the smallest eigenvalue of the deformation gradient.

    The gradient is [[1 + c Dxx, c Dxy], [c Dxy, 1 + c Dyy]].
    """
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    half = xx.dtype.type(0.5)
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            a = one + choppiness * xx[j, i]
            b = choppiness * xy[j, i]
            d = one + choppiness * yy[j, i]
            out[j, i] = half * (a + d) - np.hypot(half * (a - d), b)


@compiled
def folds(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """
    Write the number of folded samples, the smallest Jacobian, and the smallest eigenvalue.

    The eigenvalue is that of the displacement gradient; float64. A sample is folded if the smallest
    eigenvalue of the deformation gradient, 1 + c times that, is below 0.
    """
    rows, n = xx.shape
    # of each column, so that there is no sum or minimum along the loop, which is then vectorised
    folded, least, lowest = np.zeros(n), np.full(n, np.inf), np.full(n, np.inf)
    one, two = np.float64(1.0), np.float64(2.0)
    for j in range(rows):
        a, b, d = xx[j], xy[j], yy[j]
        for i in range(n):
            p, q, r = np.float64(a[i]), np.float64(b[i]), np.float64(d[i])
            eigenvalue = (p + r - np.sqrt((p - r) * (p - r) + two * q * (two * q))) / two
            lowest[i] = min(lowest[i], eigenvalue)
            folded[i] += one if one + choppiness * eigenvalue < 0.0 else 0.0
        for i in range(n):
            p, q, r = np.float64(a[i]), np.float64(b[i]), np.float64(d[i])
            area = (one + choppiness * p) * (one + choppiness * r) - (choppiness * q) * (
                choppiness * q
            )
            least[i] = min(least[i], area)
    out[0], out[1], out[2] = folded.sum(), least.min(), lowest.min()
