"""
Pointwise products of a frame: normals, Jacobian, smallest eigenvalue, folds.

All are closed forms of the frame's slopes and displacement gradient, not finite differences.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError, described
from fftocean.frame import EulerianFrame, Frame
from fftocean.kernels import surface
from fftocean.limits import CHOPPINESS


def normals(frame: Frame | EulerianFrame) -> Real:
    """
    Return the unit normals of the displaced surface [-], (ny, nx, 3), z up.

    n ~ (1 + c Dxx, c Dxy, sx) x (c Dxy, 1 + c Dyy, sy); its z component has the sign of the
    Jacobian. A frame of `Eulerian` is a height field, whose normals are (-sx, -sy, 1) scaled to
    length 1.

    Raises:
        FieldError: the frame lacks slopes or stretches.
        ParameterError: not a frame.

    Pinned by tests/test_products.py: the closed form on one wave, and the surface's own tangents;
    tests/test_eulerian.py.
    """
    _require_frame(frame)
    out = np.empty((*frame.grid.shape, 3), dtype=frame.slope_x.dtype)
    if isinstance(frame, EulerianFrame):
        flat = np.zeros_like(frame.slope_x)
        surface.normals(frame.slope_x, frame.slope_y, flat, flat, flat, frame.choppiness, out)
    else:
        xx, xy, yy = frame.stretch_xx, frame.stretch_xy, frame.stretch_yy
        surface.normals(frame.slope_x, frame.slope_y, xx, xy, yy, frame.choppiness, out)
    return out


def jacobian(frame: Frame | EulerianFrame) -> Real:
    """
    Return the area of the displaced over the still surface [-], (ny, nx); negative in a fold.

    It is (1 + c Dxx)(1 + c Dyy) - (c Dxy)^2. A frame of `Eulerian` has its own, if it was asked
    for: that of the water which is now at each position.

    Raises:
        FieldError: the frame lacks stretches; a frame of `Eulerian`, its Jacobian.
        ParameterError: not a frame.
    """
    _require_frame(frame)
    if isinstance(frame, EulerianFrame):
        return frame.jacobian.copy()
    out = np.empty(frame.grid.shape, dtype=frame.stretch_xx.dtype)
    surface.jacobian(frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, frame.choppiness, out)
    return out


def minimum_eigenvalue(frame: Frame) -> Real:
    """
    Return the smallest eigenvalue of the deformation gradient [-], (ny, nx).

    The deformation gradient is [[1 + c Dxx, c Dxy], [c Dxy, 1 + c Dyy]]. Its smallest eigenvalue is
    1 on still water and passes through 0 where a crest folds (Tessendorf 2001).

    Raises:
        FieldError: the frame lacks stretches, as any of `Eulerian` does.
        ParameterError: not a frame.
    """
    _require_frame(frame)
    out = np.empty(frame.grid.shape, dtype=frame.stretch_xx.dtype)
    surface.minimum_eigenvalue(
        frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, frame.choppiness, out
    )
    return out


@dataclass(frozen=True, slots=True)
class Folding:
    """
    Folds in a set of samples, and the choppiness up to which there are none.

    Args:
        share: share of the samples that are folded: those whose deformation gradient has a negative
            eigenvalue [-].
        min_jacobian: smallest area of displaced over still surface [-].
        largest_choppiness: largest choppiness without a folded sample [-]; inf if no choppiness
            folds one.
        samples: number of samples.
    """

    share: float
    min_jacobian: float
    largest_choppiness: float
    samples: int

    def __str__(self) -> str:
        return folding_sentence(self.share, self.min_jacobian, self.largest_choppiness)

    def __add__(self, other: "Folding") -> "Folding":
        """Return the folds of both sets of samples together."""
        samples = self.samples + other.samples
        return Folding(
            share=(self.share * self.samples + other.share * other.samples) / samples,
            min_jacobian=min(self.min_jacobian, other.min_jacobian),
            largest_choppiness=min(self.largest_choppiness, other.largest_choppiness),
            samples=samples,
        )


def folding_sentence(share: float, min_jacobian: float, largest_choppiness: float | None) -> str:
    """
    Return the folds in words; a `largest_choppiness` of None or inf is water that never folds.
    """
    never = largest_choppiness is None or math.isinf(largest_choppiness)
    up_to = (
        "no choppiness folds it"
        if never
        else f"choppiness up to {_cut(largest_choppiness or 0.0):g} does not fold it"
    )
    folded = (
        f"{100.0 * share:.2g} % of the water is folded"
        if share > 0.0
        else "none of the water is folded"
    )
    return f"{folded}, smallest Jacobian {min_jacobian:.3g}; {up_to}"


def _cut(value: float) -> float:
    """Return a positive number rounded down to three digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2) if value > 0.0 else 1.0
    return math.floor(value / step) * step


def folding(frames: Frame | Iterable[Frame], choppiness: float | None = None) -> Folding:
    """
    Return the folds of one frame, or of several together, such as `ocean.loop_frames(64)`.

    With the eigenvalues a <= b of the displacement gradient [[Dxx, Dxy], [Dxy, Dyy]], those of the
    deformation gradient are 1 + c a and 1 + c b. A sample is folded if 1 + c a < 0, the Jacobian is
    (1 + c a)(1 + c b), and the largest choppiness without a folded sample is -1 / min(a), in closed
    form.

    Args:
        frames: one frame or more, with `stretch_xx`, `stretch_xy` and `stretch_yy`, (ny, nx) each.
        choppiness: a value of c in place of the frames' own [-].

    Raises:
        FieldError: a frame lacks stretches, as any of `Eulerian` does.
        ParameterError: not a frame, no frame at all, or a choppiness out of range.

    Pinned by tests/test_products.py: one wave, and the surface summed wave by wave.
    """
    c = None if choppiness is None else CHOPPINESS.check("choppiness", choppiness)
    if isinstance(frames, (Frame, EulerianFrame)) or not isinstance(frames, Iterable):
        frames = (frames,)
    total: Folding | None = None
    for frame in frames:
        _require_frame(frame)
        stretches = frame.stretch_xx, frame.stretch_xy, frame.stretch_yy
        one = folding_of(*stretches, frame.choppiness if c is None else c)
        total = one if total is None else total + one
    if total is None:
        raise ParameterError("frames must be one frame or more, got none")
    return total


def folding_of(xx: Real, xy: Real, yy: Real, choppiness: float) -> Folding:
    """
    Return the folds of samples from their displacement gradients, (rows, columns) each [-].
    """
    found = np.empty(3)
    surface.folds(xx, xy, yy, choppiness, found)
    folded, min_jacobian, lowest = found.tolist()  # the lowest eigenvalue of the gradients
    largest = -1.0 / lowest if lowest < 0.0 else math.inf
    return Folding(folded / xx.size, min_jacobian, largest, xx.size)


def _require_frame(frame: object) -> None:
    """Raise if the value is not a frame."""
    if not isinstance(frame, (Frame, EulerianFrame)):
        raise ParameterError(
            f"frame must be a Frame, such as ocean.frame(t), got {described(frame)}"
        )
