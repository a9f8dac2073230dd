"""Results at points, as they are found."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.kernels import surface

FAR = 4.0
"""Root mean squares of the displacement that hardly any water exceeds."""


@dataclass(frozen=True, slots=True, eq=False)
class PointResults:
    """The results at a number of points, written to as they are found; float64, SI."""

    fields: tuple[str, ...]
    offsets: Real  # (points, 2): from the point to its parameters [m]
    residuals: Real  # distance of the water found from the point [m]
    jacobians: Real  # the least met on the way [-]
    arrays: dict[str, Real]  # heights always, the others as asked for

    @classmethod
    def empty(cls, points: int, fields: tuple[str, ...]) -> "PointResults":
        """Return results that are still to be written."""
        arrays: dict[str, Real] = {
            name: np.empty((points,) if name == "heights" else (points, 3))
            for name in dict.fromkeys(("heights", *fields))
        }
        return cls(fields, np.empty((points, 2)), np.empty(points), np.empty(points), arrays)

    def part(self, part: slice) -> "PointResults":
        """Return the results of some of the points, as views."""
        arrays = {name: array[part] for name, array in self.arrays.items()}
        return PointResults(
            self.fields, self.offsets[part], self.residuals[part], self.jacobians[part], arrays
        )

    def put(self, here: npt.NDArray[np.intp], found: "PointResults") -> None:
        """Write the results of some of the points."""
        for mine, other in zip(self._all(), found._all(), strict=True):
            mine[here] = other

    def blank(self, here: "slice | npt.NDArray[np.intp]") -> None:
        """Write NaN for some of the points."""
        for array in self._all():
            array[here] = np.nan

    def found(self) -> tuple[Real, Real, Real, Real]:
        """Return the arrays of `kernels.query.Found`."""
        return self.offsets, self.arrays["heights"], self.residuals, self.jacobians

    def _all(self) -> tuple[Real, ...]:
        return self.offsets, self.residuals, self.jacobians, *self.arrays.values()


PointFunction = Callable[[Real, Real, PointResults], None]
"""Writes the results at some points (x, y) at one time."""


def write_normals(geometry: Real, choppiness: float, out: Real) -> None:
    """Write normals, (points, 3), from columns of `fields.GEOMETRY`; NaN where those are NaN."""
    sx, sy, xx, xy, yy = (np.ascontiguousarray(column)[None, :] for column in geometry.T)
    surface.normals(sx, sy, xx, xy, yy, choppiness, out[None])
    out[np.isnan(sx[0])] = np.nan  # the kernel returns up
