"""What follows from a frame point by point: normals, Jacobian, and how far the water is squeezed. Nothing by finite differences."""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels import surface
from fftocean.ocean import Frame


def normals(frame: Frame) -> Real:
    """
    Return the unit normals of the displaced surface, (ny, nx, 3), z up.

    n ~ (1 + c Dxx, c Dxy, sx) x (c Dxy, 1 + c Dyy, sy); its z component has the sign of the Jacobian.

    Raises:
        FieldError: the frame lacks slopes or stretches.

    Pinned by tests/test_products.py: the closed form on one wave, and the surface's own tangents.
    """
    out = np.empty((*frame.grid.shape, 3), dtype=frame.slope_x.dtype)
    surface.normals(frame.slope_x, frame.slope_y, frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, frame.choppiness, out)
    return out


def jacobian(frame: Frame) -> Real:
    """
    Return (1 + c Dxx)(1 + c Dyy) - (c Dxy)^2, (ny, nx): area of displaced over still surface; below 0 it is folded.

    Raises:
        FieldError: the frame lacks stretches.
    """
    out = np.empty(frame.grid.shape, dtype=frame.stretch_xx.dtype)
    surface.jacobian(frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, frame.choppiness, out)
    return out


def minimum_eigenvalue(frame: Frame) -> Real:
    """
    Return the smaller eigenvalue of the deformation [[1 + c Dxx, c Dxy], [c Dxy, 1 + c Dyy]], (ny, nx).

    It passes through 0 where a crest folds, earlier than the Jacobian of a surface stretched along the crest (Tessendorf 2001).

    Raises:
        FieldError: the frame lacks stretches.
    """
    out = np.empty(frame.grid.shape, dtype=frame.stretch_xx.dtype)
    surface.minimum_eigenvalue(frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, frame.choppiness, out)
    return out
