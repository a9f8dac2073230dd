"""Pointwise geometry of the displaced surface: what slopes and stretches say about its normal and its folding."""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled


@compiled
def normals(slope_x: Real, slope_y: Real, xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """
    out = the unit vector along (1 + c Dxx, c Dxy, sx) x (c Dxy, 1 + c Dyy, sy), the cross product of the surface's two tangents.

    Its z component has the sign of the Jacobian: where the surface is folded over, the normal points down. Where both tangents
    vanish together there is no normal, and up is returned.
    """
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            a = one + choppiness * xx[j, i]
            b = choppiness * xy[j, i]
            d = one + choppiness * yy[j, i]
            x = b * slope_y[j, i] - slope_x[j, i] * d
            y = slope_x[j, i] * b - a * slope_y[j, i]
            z = a * d - b * b
            square = x * x + y * y + z * z
            if square > 0:
                per_length = one / np.sqrt(square)
                out[j, i, 0] = x * per_length
                out[j, i, 1] = y * per_length
                out[j, i, 2] = z * per_length
            else:
                out[j, i, 0] = 0
                out[j, i, 1] = 0
                out[j, i, 2] = 1


@compiled
def jacobian(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """out = (1 + c Dxx)(1 + c Dyy) - (c Dxy)^2: the area of displaced water surface over still; below 0 it is folded."""
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            a = one + choppiness * xx[j, i]
            b = choppiness * xy[j, i]
            d = one + choppiness * yy[j, i]
            out[j, i] = a * d - b * b


@compiled
def minimum_eigenvalue(xx: Real, xy: Real, yy: Real, choppiness: float, out: Real) -> None:
    """out = the smaller eigenvalue of [[1 + c Dxx, c Dxy], [c Dxy, 1 + c Dyy]]: the stretch along the most squeezed direction."""
    one = xx.dtype.type(1)  # in the fields' own precision, as choppiness must be
    half = xx.dtype.type(0.5)
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            a = one + choppiness * xx[j, i]
            b = choppiness * xy[j, i]
            d = one + choppiness * yy[j, i]
            out[j, i] = half * (a + d) - np.hypot(half * (a - d), b)
