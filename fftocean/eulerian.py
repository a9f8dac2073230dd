"""
Fields resampled to a regular grid of world positions.

A frame gives, for each undisplaced position x0, the displaced position x0 + c D(x0). This module
inverts that map: for each world position x of the grid it finds the x0 whose water is at x, and
takes the fields at x0. The result is the same surface as a plain height field: an `EulerianFrame`.

Between samples the fields are quintic B-splines on a grid twice as fine. Their coefficients need no
linear solve: they are the frame of a sea whose waves are divided by the spline's response to each
wavenumber (Unser 1999), and that sea is an `Ocean`, too. For a wave of wavenumber k sampled h apart
the relative error of the spline is (k h)^6/30240: 5e-4 at the shortest wave of the tile, 8e-6 at
twice its length, about a hundredth of a millimetre for a sea.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import refined, refined_gain
from fftocean.arrays import Real
from fftocean.errors import ParameterError, described
from fftocean.fields import EIGHT, GEOMETRY
from fftocean.frame import BY_PLACE, NOT_BY_PLACE, EulerianFrame, Frame
from fftocean.grid import Grid
from fftocean.host import require_memory
from fftocean.kernels import interpolate, resample, surface
from fftocean.ocean import Ocean, check_fields, memory_needed

EXACT = 5e-6
"""
The standard deviation of the splines' error in height that is allowed [m]; the largest error of a
tile is about 13 times that.
"""
FINEST = 8
"""The largest number of spline samples per sample of the ocean, along each axis."""
STEEPEST = 1e3
"""The largest slope that is returned; only the rim of a fold is steeper."""

DEFAULT = ("height", "slope_x", "slope_y")
"""The fields that are returned by default."""

_MADE_OF = {
    **{name: (name,) for name in BY_PLACE},
    "slope_x": GEOMETRY,
    "slope_y": GEOMETRY,
    "normal": GEOMETRY,
    "jacobian": GEOMETRY[2:],
}


class Eulerian:
    """
    An ocean sampled at fixed world positions.

    `frame` and `loop_frame` are those of `Ocean`, but sample [iy, ix] is the water AT x, y.

    An `EulerianFrame` has height; slope_x and slope_y, dz/dx and dz/dy in world coordinates (cut at
    1000, which only the rim of a fold exceeds); and normal. Of the water that is at x, y it has
    jacobian and velocity_*, before choppiness as in every frame. A height field has neither
    displacement nor displacement gradient: a request for one is an error.

    Of a folded surface the highest sheet is taken; `folded` marks these positions in the last
    frame. The positions of the last frame are kept for `resample`. One thread at a time.

    Raises:
        ParameterError: not an ocean, or more memory than is available.

    Pinned by tests/test_eulerian.py, against the parametric surface summed wave by wave.
    """

    def __init__(self, ocean: Ocean) -> None:
        if not isinstance(ocean, Ocean):
            raise ParameterError(f"ocean must be an Ocean, got {described(ocean)}")
        self.grid = grid = ocean.grid
        self._ocean = ocean
        self._finer = finer_by = _fineness(ocean)
        finer = replace(grid, nx=finer_by * grid.nx, ny=finer_by * grid.ny)
        require_memory(
            f"an eulerian frame of n = {grid.nx} x {grid.ny}",
            2.0 * memory_needed(finer, ocean.dtype),
        )
        self._splines = _spline_ocean(ocean, finer)
        self._cells = np.array([finer.nx / grid.lx, finer.ny / grid.ly])  # [1/m]
        v, u = np.meshgrid(
            finer_by * np.arange(grid.ny), finer_by * np.arange(grid.nx), indexing="ij"
        )
        self._x, self._y = (np.ascontiguousarray(p, dtype=np.float64).ravel() for p in (u, v))
        self._u, self._v, self._residual = self._x.copy(), self._y.copy(), np.zeros(u.size)
        self._folded = np.zeros(grid.shape, dtype=np.bool_)
        self._frame: Frame | None = None

    def __repr__(self) -> str:
        return f"Eulerian({self._ocean!r})"

    def frame(self, t: float, fields: Sequence[str] = DEFAULT) -> EulerianFrame:
        """
        Return the frame at time t [s] by world position, as `Ocean.frame`.

        Raises:
            ParameterError: as `Ocean.frame`, and a field that only a displaced surface has.
        """
        fields, needs = _needed(fields)
        return self._resample(self._splines.frame(t, needs, out=self._reusable(needs)), fields)

    def loop_frame(self, j: int, count: int, fields: Sequence[str] = DEFAULT) -> EulerianFrame:
        """
        Return the j-th of `count` frames of the loop by world position, as `Ocean.loop_frame`.

        Raises:
            ParameterError: as `Ocean.loop_frame`.
        """
        fields, needs = _needed(fields)
        return self._resample(
            self._splines.loop_frame(j, count, needs, out=self._reusable(needs)), fields
        )

    @property
    def folded(self) -> npt.NDArray[np.bool_]:
        """
        Mask of the last frame's positions with several sheets of the surface over them, (ny, nx).
        """
        return self._folded

    @property
    def residual(self) -> float:
        """
        Largest distance of the water taken from its position, in the last frame [m].

        It exceeds 1e-6 m only beside folds.
        """
        return float(np.max(self._residual)) / float(np.min(self._cells))

    @property
    def positions(self) -> tuple[Real, Real]:
        """
        Undisplaced positions x0, y0 of the water at each position, (ny, nx) each [m].
        """
        return (self._u / self._cells[0]).reshape(self.grid.shape), (
            self._v / self._cells[1]
        ).reshape(self.grid.shape)

    def resample(self, field: Real) -> Real:
        """
        Return another field at the last frame's time, such as foam, by world position: (ny, nx), in
        the unit of the field [-, m, m/s, ...].

        The field is interpolated bilinearly between its samples.

        Raises:
            ParameterError: the field has another shape than the tile.
        """
        if field.shape != self.grid.shape:
            raise ParameterError(
                f"field must have the tile's shape {self.grid.shape}, got {field.shape}"
            )
        out = np.zeros((self._u.size, 1))
        interpolate.bilinear(
            np.ascontiguousarray(field)[..., None],
            self._u / self._finer,
            self._v / self._finer,
            out,
        )
        resampled: Real = out.reshape(self.grid.shape).astype(field.dtype)
        return resampled

    def _reusable(self, needs: tuple[str, ...]) -> Frame | None:
        """Return the last frame of splines if its arrays hold all the fields needed."""
        return (
            self._frame
            if self._frame is not None and set(needs) <= set(self._frame.fields)
            else None
        )

    def _resample(self, splines: Frame, fields: tuple[str, ...]) -> EulerianFrame:
        """Find the water at each position, and return the fields there."""
        self._frame = splines
        self._find(splines)
        needs = tuple(dict.fromkeys(need for name in fields for need in _MADE_OF[name]))
        values = self._sampled(splines, needs)
        shape, c = self.grid.shape, splines.choppiness
        if set(GEOMETRY) <= set(needs):
            sx, sy, xx, xy, yy = (values[name] for name in GEOMETRY)
            slopes, normal = np.empty((2, *shape)), np.empty((*shape, 3))
            resample.world_slopes(sx, sy, xx, xy, yy, c, STEEPEST, *slopes)
            surface.normals(sx, sy, xx, xy, yy, c, normal)
            values.update(slope_x=slopes[0], slope_y=slopes[1], normal=normal)
        if "jacobian" in fields:
            xx, xy, yy = (values[name] for name in GEOMETRY[2:])
            jacobian = np.empty(shape)
            surface.jacobian(xx, xy, yy, c, jacobian)
            values["jacobian"] = jacobian
        return EulerianFrame(
            splines.t,
            self.grid,
            c,
            {name: values[name].astype(self._ocean.dtype) for name in fields},
        )

    def _find(self, splines: Frame) -> None:
        """
        Set `_u`, `_v` to the undisplaced positions of the water at each position of the grid.

        They are in samples of the splines.
        """
        fine = splines.grid
        c = splines.choppiness
        shift = np.stack([splines.displace_x, splines.displace_y], axis=-1) * (
            c * self._cells
        ).astype(splines.height.dtype)
        at_nodes = _at_nodes(np.stack([shift[..., 0], shift[..., 1], splines.height]))
        top = np.full(self.grid.shape, -np.inf)
        self._folded = np.zeros(self.grid.shape, dtype=np.bool_)
        self._u[:], self._v[:] = self._x, self._y
        u, v = self._u.reshape(self.grid.shape), self._v.reshape(self.grid.shape)
        along, up = np.arange(fine.nx)[None, :], np.arange(fine.ny)[:, None]
        resample.uncover(
            at_nodes[0] + along, at_nodes[1] + up, at_nodes[2], self._finer, u, v, top, self._folded
        )
        # [samples]: the rounding errors of the fields allow no less
        tolerance = 1e-6 if splines.height.dtype == np.float32 else 1e-12
        resample.invert(shift, self._x, self._y, 8, tolerance, self._u, self._v, self._residual)

    def _sampled(self, splines: Frame, names: tuple[str, ...]) -> dict[str, Real]:
        """Return fields at the positions found, by name, (ny, nx) each, float64."""
        if not names:
            return {}
        out = np.empty((self._u.size, len(names)))
        resample.sample(np.stack([splines[name] for name in names], axis=-1), self._u, self._v, out)
        return {
            name: np.ascontiguousarray(out[:, i]).reshape(self.grid.shape)
            for i, name in enumerate(names)
        }


def _needed(fields: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """
    Return the requested fields, and the fields of the splines from which they are computed.

    The latter include displacement and height, by which the water is found.
    """
    if isinstance(fields, Iterable):
        fields = (fields,) if isinstance(fields, str) else tuple(fields)
    for name in fields if isinstance(fields, tuple) else ():
        if name in EIGHT and name not in BY_PLACE:
            raise ParameterError(f"an eulerian frame cannot have {name}: {NOT_BY_PLACE}")
    fields = check_fields(fields, BY_PLACE)
    made_of = (need for name in fields for need in _MADE_OF[name])
    return fields, tuple(dict.fromkeys(["height", "displace_x", "displace_y", *made_of]))


def _fineness(ocean: Ocean) -> int:
    """
    Return the number of spline samples per sample of the ocean that keeps the error to `EXACT`.

    It is 2 for most seas, and more for storms on few samples. A quintic spline through samples h
    apart has the error (k h)^6 / 30240 of the amplitude for a wave of wavenumber k (the Fourier
    error kernel of the cardinal spline, to leading order), along each axis.
    """
    a, grid = ocean.amplitudes, ocean.grid
    energy = 2.0 * a.squares  # a^2/2 of the two waves of an entry
    finer = 2
    while finer < FINEST:
        error = (grid.kx[None, :] * grid.lx / (grid.nx * finer)) ** 6 + (
            grid.ky[:, None] * grid.ly / (grid.ny * finer)
        ) ** 6
        if float(np.sqrt(np.sum(energy * (error / 30240.0) ** 2))) <= EXACT:
            break
        finer *= 2
    return finer


def _spline_ocean(ocean: Ocean, finer: Grid) -> Ocean:
    """
    Return an ocean whose frames are the quintic spline coefficients of another's fields.
    """
    grid = ocean.grid
    return ocean.spectrally_scaled(
        refined(ocean.amplitudes, finer, grid.active, _response),
        refined_gain(grid, finer, grid.active, _response),
    )


def _response(cycles: Real) -> Real:
    """
    Return the discrete Fourier transform of the quintic B-spline sampled at whole numbers.

    Args:
        cycles: of the wave, per sample.
    """
    angle = 2.0 * math.pi * cycles
    response: Real = (66.0 + 52.0 * np.cos(angle) + 2.0 * np.cos(2.0 * angle)) / 120.0
    return response


def _at_nodes(coefficients: Real) -> Real:
    """
    Return the splines at their nodes, (fields, my, mx).

    Each axis is filtered by (1, 26, 66, 26, 1)/120.
    """
    for axis in (-2, -1):
        total = 66.0 * coefficients
        for step, weight in ((1, 26.0), (2, 1.0)):
            total += weight * (
                np.roll(coefficients, step, axis) + np.roll(coefficients, -step, axis)
            )
        coefficients = total / 120.0
    return coefficients
