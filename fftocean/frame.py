"""Frames: the fields of the water at one time, by rest position or by world position."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from fftocean.arrays import Real
from fftocean.errors import FieldError
from fftocean.fields import FIELDS
from fftocean.grid import Grid

Own = TypeVar("Own", bound="_Arrays")

Layout = tuple[tuple[int, int], str]
"""
Shape and precision of arrays that can be written to, each C-contiguous and with memory of its own.
"""


class _FieldProperty(property):
    """A field as an attribute, with the caption and unit of its row of `FIELDS`."""

    def __init__(self, name: str) -> None:
        field = FIELDS[name]
        caption, unit = field.caption, "-" if field.unit == "1" else field.unit
        if not caption.startswith("d "):  # a derivative, whose d stays small
            caption = caption[0].upper() + caption[1:]
        super().__init__(lambda frame: frame[name])
        self.__doc__ = f"{caption} [{unit}]."

    if TYPE_CHECKING:  # a plain property would make every field of type Any

        def __get__(  # type: ignore[override]
            self, frame: Any, owner: type | None = None
        ) -> Real: ...


class _Arrays:
    """Time, grid and named arrays, with the fields that mean the same in all frames."""

    __slots__ = ("_arrays", "_layout", "choppiness", "grid", "t")

    def __init__(self, t: float, grid: Grid, choppiness: float, arrays: Mapping[str, Real]) -> None:
        self.t = t  # [s]
        self.grid = grid
        self.choppiness = choppiness
        self._arrays = dict(arrays)
        self._layout: Layout | None = None

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the arrays in this frame."""
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
        """Return the message for a field that is not in this frame."""
        made = {
            "normal": ", or take fo.normals(frame)",
            "jacobian": ", or take fo.jacobian(frame)",
        }.get(name, "")
        return (
            f"this frame has {', '.join(self._arrays)}; "
            f"for {name} ask frame(t, fields=({name!r}, ...)){made}"
        )

    def _become(self: Own, other: Own) -> None:
        """Take over the time and arrays of another frame."""
        self.t, self.grid, self.choppiness = other.t, other.grid, other.choppiness
        self._arrays, self._layout = other._arrays, other._layout

    def _repr_html_(self) -> str:
        """Return the fields and an image of the height for notebooks."""
        from fftocean import notebook_html

        rows = [
            ("samples", f"{self.grid.nx} x {self.grid.ny}"),
            ("fields", ", ".join(self._arrays)),
        ]
        shown = notebook_html.table(f"{type(self).__name__} at t = {self.t:g} s", rows)
        if "height" not in self._arrays:
            return shown
        return shown + notebook_html.image(self._arrays["height"], "height, north up")

    def __repr__(self) -> str:
        size = f"{self.grid.nx} x {self.grid.ny}"
        return f"{type(self).__name__}(t={self.t}, {size}, {', '.join(self._arrays)})"

    height = _FieldProperty("height")
    slope_x = _FieldProperty("slope_x")
    slope_y = _FieldProperty("slope_y")
    velocity_x = _FieldProperty("velocity_x")
    velocity_y = _FieldProperty("velocity_y")
    velocity_z = _FieldProperty("velocity_z")

    @property
    def normal(self) -> Real:
        """Unit normal of the displaced surface, (ny, nx, 3) [-]."""
        return self["normal"]

    @property
    def jacobian(self) -> Real:
        """Area of the displaced surface over that at rest [-]; below 0 the water is folded."""
        return self["jacobian"]


class Frame(_Arrays):
    """
    The water at one time: named arrays, (ny, nx), indexed [iy, ix]; x east, y north, z up; SI.

    Sample [iy, ix] is the water whose rest position is (x, y) of the grid. Fields that were not
    asked for raise `FieldError`. Displacements, stretches and horizontal velocities are
    those of linear wave theory: the surface is at (x + c displace_x, y + c displace_y, height),
    where c is `choppiness`, and itself moves with (c velocity_x, c velocity_y, velocity_z), while
    velocity_* is that of the water there, whatever c.
    """

    __slots__ = ()

    displace_x = _FieldProperty("displace_x")
    displace_y = _FieldProperty("displace_y")
    stretch_xx = _FieldProperty("stretch_xx")
    stretch_xy = _FieldProperty("stretch_xy")
    stretch_yy = _FieldProperty("stretch_yy")


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
    """Return a property that raises the `FieldError` of a field which this frame never has."""
    return property(lambda frame: frame[name], doc=f"{name}: absent, raises `FieldError`.")


class EulerianFrame(_Arrays):
    """
    The water by world position: named arrays, (ny, nx), indexed [iy, ix]; SI.

    Sample [iy, ix] is the water that is at (x, y) of the grid at time t. The surface is at (x, y,
    height): height, slope_x, slope_y and normal are those of a height field over world x and y.
    jacobian and velocity_* belong to the water at that position; the velocities are those of the
    water, before `choppiness`. There are no displacements and no stretches.
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
