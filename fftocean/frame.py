"""Frames: the water at one moment, by the undisplaced position of the water or by place."""

from collections.abc import Mapping
from typing import TypeVar

from fftocean.arrays import Real
from fftocean.errors import FieldError
from fftocean.grid import Grid

Own = TypeVar("Own", bound="_Arrays")


class _Arrays:
    """
    The moment, the grid and the named arrays that all frames have, and the fields that mean the
    same in all of them.
    """

    __slots__ = ("_arrays", "choppiness", "grid", "t")

    def __init__(self, t: float, grid: Grid, choppiness: float, arrays: Mapping[str, Real]) -> None:
        self.t = t  # [s]
        self.grid = grid
        self.choppiness = choppiness
        self._arrays = dict(arrays)

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the arrays that are here."""
        return tuple(self._arrays)

    def __getitem__(self, name: str) -> Real:
        """
        Return a field by name.

        Raises:
            FieldError: it was not asked for.
        """
        try:
            return self._arrays[name]
        except KeyError:
            raise FieldError(self._missing(name)) from None

    def _missing(self, name: str) -> str:
        """The reason why a field is not here, and the way to it."""
        made = {
            "normal": ", or take fo.normals(frame)",
            "jacobian": ", or take fo.jacobian(frame)",
        }.get(name, "")
        return f"this frame has {', '.join(self._arrays)}; for {name} ask frame(t, fields=({name!r}, ...)){made}"

    def _become(self: Own, other: Own) -> None:
        """Take over another frame's moment and arrays."""
        self.t, self.grid, self.choppiness, self._arrays = (
            other.t,
            other.grid,
            other.choppiness,
            other._arrays,
        )

    def __repr__(self) -> str:
        return f"{type(self).__name__}(t={self.t}, {self.grid.nx} x {self.grid.ny}, {', '.join(self._arrays)})"

    @property
    def height(self) -> Real:
        """Vertical displacement [m]."""
        return self["height"]

    @property
    def slope_x(self) -> Real:
        """d height / dx [-]."""
        return self["slope_x"]

    @property
    def slope_y(self) -> Real:
        """d height / dy [-]."""
        return self["slope_y"]

    @property
    def velocity_x(self) -> Real:
        """d displace_x / dt of the surface particle, choppiness not applied [m/s]."""
        return self["velocity_x"]

    @property
    def velocity_y(self) -> Real:
        """d displace_y / dt of the surface particle, choppiness not applied [m/s]."""
        return self["velocity_y"]

    @property
    def velocity_z(self) -> Real:
        """d height / dt of the surface particle [m/s]."""
        return self["velocity_z"]

    @property
    def normal(self) -> Real:
        """Unit normal of the displaced surface, (ny, nx, 3) [-]."""
        return self["normal"]

    @property
    def jacobian(self) -> Real:
        """
        Area of displaced over still surface [-], of the water that the sample is about; below 0 it
        is folded.
        """
        return self["jacobian"]


class Frame(_Arrays):
    """
    The water at one moment: named arrays, (ny, nx), indexed [iy, ix]; x east, y north, z up; SI.

    Sample [iy, ix] is the water that is at rest at x, y. Only the fields that were asked for are
    there; the others raise `FieldError`. Displacements, stretches and horizontal velocities are
    those of linear wave theory: the surface is at (x + c displace_x, y + c displace_y, height),
    where c is `choppiness`, and moves with (c velocity_x, c velocity_y, velocity_z).
    """

    __slots__ = ()

    @property
    def displace_x(self) -> Real:
        """Horizontal displacement along x, choppiness not applied [m]."""
        return self["displace_x"]

    @property
    def displace_y(self) -> Real:
        """Horizontal displacement along y, choppiness not applied [m]."""
        return self["displace_y"]

    @property
    def stretch_xx(self) -> Real:
        """d displace_x / dx [-]."""
        return self["stretch_xx"]

    @property
    def stretch_xy(self) -> Real:
        """d displace_x / dy = d displace_y / dx [-]."""
        return self["stretch_xy"]

    @property
    def stretch_yy(self) -> Real:
        """d displace_y / dy [-]."""
        return self["stretch_yy"]


BY_PLACE = (
    "height",
    "slope_x",
    "slope_y",
    "velocity_x",
    "velocity_y",
    "velocity_z",
    "normal",
    "jacobian",
)
"""The fields of an `EulerianFrame`."""

NOT_BY_PLACE = "a height field over places has no displacement, nor the stretch of one"


def _absent(name: str) -> property:
    """Return a property that raises the `FieldError` of a field which is never here."""
    return property(lambda frame: frame[name], doc=f"{name}: absent, raises `FieldError`.")


class EulerianFrame(_Arrays):
    """
    The water at places: named arrays, (ny, nx), indexed [iy, ix]; sample [iy, ix] is the water that
    is now at x, y.

    The surface is at (x, y, height): height, slope_x, slope_y and normal are those of a height
    field over world x and y; SI. jacobian and velocity_* are those of the water that is there now;
    horizontal velocities are before `choppiness`, as ever. There are no displacements and no
    stretches, and nothing that is made of them.
    """

    __slots__ = ()

    displace_x, displace_y = _absent("displace_x"), _absent("displace_y")
    stretch_xx, stretch_xy, stretch_yy = (
        _absent("stretch_xx"),
        _absent("stretch_xy"),
        _absent("stretch_yy"),
    )

    def _missing(self, name: str) -> str:
        if name in BY_PLACE:
            return super()._missing(name).partition(", or take")[0]
        return f"an eulerian frame has no {name}: {NOT_BY_PLACE}; the frame of the Ocean has them"
