"""Pointwise geometry of the displaced surface: normals, Jacobians and folds."""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled


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
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    nothing = xx.dtype.type(0)
    n = out.shape[1]
    # Rows of x, y and z in one array: compilers vectorise a loop that writes to one.
    unit = np.empty(3 * n, xx.dtype)
    second, third = np.uint64(n), np.uint64(2 * n)  # unsigned: no check for negative indices
    for j in range(out.shape[0]):
        sx, sy, dxx, dxy, dyy = slope_x[j], slope_y[j], xx[j], xy[j], yy[j]
        for i in range(n):
            a = one + choppiness * dxx[i]
            b = choppiness * dxy[i]
            d = one + choppiness * dyy[i]
            x = b * sy[i] - sx[i] * d
            y = b * sx[i] - sy[i] * a
            z = a * d - b * b
            square = x * x + y * y + z * z
            per_length = one / np.sqrt(square) if square > nothing else nothing
            k = np.uint64(i)
            unit[k] = x * per_length
            unit[second + k] = y * per_length
            unit[third + k] = z * per_length if per_length > nothing else one
        normal = out[j].reshape(3 * n)
        for i in range(n):
            k = np.uint64(i)
            normal[3 * i] = unit[k]
            normal[3 * i + 1] = unit[second + k]
            normal[3 * i + 2] = unit[third + k]


@compiled
def jacobian(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """
    Write the Jacobian (1 + c Dxx)(1 + c Dyy) - (c Dxy)^2.

    It is the area of the displaced surface over that at rest; below 0 the water is folded.
    """
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    for j in range(out.shape[0]):
        dxx, dxy, dyy, o = xx[j], xy[j], yy[j], out[j]
        for i in range(o.size):
            b = choppiness * dxy[i]
            o[i] = (one + choppiness * dxx[i]) * (one + choppiness * dyy[i]) - b * b


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
