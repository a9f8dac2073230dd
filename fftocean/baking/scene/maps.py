"""
Maps of a frame: fields, channels, units and mip levels of each.

A map is one row of `MAPS`, with its functions. Its name stands in `job.parameters.MAPS` too, which
the command line reads without loading this module; an import fails where the two differ.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import get_args

import numpy as np

from fftocean import mips
from fftocean.arrays import Real
from fftocean.errors import ParameterError
from fftocean.export.profiles import CHANNELS, Kind
from fftocean.fields import GEOMETRY
from fftocean.frame import BY_PLACE, NOT_BY_PLACE, EulerianFrame, Frame
from fftocean.job import parameters
from fftocean.ocean import Ocean


@dataclass(frozen=True, slots=True)
class Surface:
    """Input of a map's functions: the surface at one time."""

    frame: Frame | EulerianFrame
    foam: Real | None  # coverage, (ny, nx), 0..1
    unresolved: Real | None  # slope covariance of the waves too short for the tile, (3,)


@dataclass(frozen=True, slots=True)
class Map:
    """
    A quantity on the grid, before an engine's conventions: row 0 south, x east, y north, z up, SI.

    `channels` and `levels` take a frame that has the fields `needed`; for foam, its coverage,
    (ny, nx) in 0..1; and for the slope covariance, that of the waves too short for the tile, from
    `unresolved`. A frame of `Eulerian` has no displacement and no stretch: a map of those names the
    fields that it needs instead, `by_place`, and sets the others to 0.
    """

    needs: tuple[str, ...]  # fields of a frame
    kind: Kind  # how the channels turn with an engine's axes
    names: tuple[str, ...]  # of the channels
    unit: str
    caption: str
    compute: Callable[[Surface], Iterable[Real]]  # the channels, each (ny, nx)
    needs_levels: tuple[str, ...] = ()  # further fields, for mip levels
    compute_levels: Callable[[Surface], list[Real]] | None = (
        None  # where they are more than box means
    )
    by_place: tuple[str, ...] | None = (
        None  # the fields needed of an `EulerianFrame`, where they are others
    )
    # over the tiles of a cascade: linear in the waves, or a covariance of independent ones
    adds: bool = True

    def needed(self, *, mips: bool, eulerian: bool) -> tuple[str, ...]:
        """Return the fields to ask of a frame for the map, with its levels or without."""
        if eulerian and self.by_place is not None:
            return self.by_place
        return (*self.needs, *(self.needs_levels if mips else ()))

    def channels(
        self, frame: Frame | EulerianFrame, foam: Real | None = None, unresolved: Real | None = None
    ) -> Real:
        """Return the map, (ny, nx, channels), float32, C-contiguous."""
        return _stacked(self.compute(Surface(frame, foam, unresolved)))

    def levels(
        self, frame: Frame | EulerianFrame, foam: Real | None = None, unresolved: Real | None = None
    ) -> list[Real]:
        """
        Return the mip levels of the map, from the whole down to one texel, each (rows, columns,
        channels), float32, C-contiguous.
        """
        surface = Surface(frame, foam, unresolved)
        levels = (
            self.compute_levels(surface)
            if self.compute_levels
            else mips.chain(_stacked(self.compute(surface)))
        )
        return [np.ascontiguousarray(level, dtype=np.float32) for level in levels]


def _foam(surface: Surface) -> Real:
    assert surface.foam is not None  # given by every caller that bakes the map
    return surface.foam


def _unresolved(surface: Surface) -> list[Real]:
    """Return three channels of one value each."""
    values = np.zeros(3) if surface.unresolved is None else surface.unresolved
    return [np.full(surface.frame.grid.shape, value) for value in values]


MAPS: dict[str, Map] = {
    "height": Map(
        ("height",), "height", ("height",), "m", "height of the water",
        lambda m: (m.frame.height,),
    ),
    "displacement": Map(
        ("displace_x", "displace_y", "height"), "vector",
        ("x, choppiness applied", "y, choppiness applied", "height"), "m",
        "from where the water is at rest to where it is",
        lambda m: (*_moved(m.frame), m.frame.height),
        by_place=("height",),
    ),
    "normal": Map(
        ("normal",), "normal", ("x", "y", "z"), "1",
        "unit normal of the displaced surface, signed; of smaller levels, that of the mean slope",
        lambda m: np.moveaxis(m.frame.normal, -1, 0),
        GEOMETRY, lambda m: mips.normals(m.frame.normal, _geometry(m.frame), m.frame.choppiness),
        by_place=("normal", "slope_x", "slope_y"), adds=False,
    ),
    "derivative": Map(
        ("slope_x", "slope_y", "stretch_xx", "stretch_yy"), "derivative",
        ("d height/dx", "d height/dy",
         "d displacement x/dx, choppiness applied", "d displacement y/dy, choppiness applied"), "1",
        "slopes and stretches, which add up over tiles; without the shear the normal is about "
        "(-slope_x/(1 + stretch_xx), -slope_y/(1 + stretch_yy), 1)",
        lambda m: (m.frame.slope_x, m.frame.slope_y, *_stretched(m.frame)),
        by_place=("slope_x", "slope_y"),
    ),
    "stretch": Map(
        ("stretch_xx", "stretch_xy", "stretch_yy"), "stretch",
        ("d displacement x/dx", "d displacement x/dy = d displacement y/dx",
         "d displacement y/dy"), "1",
        "gradient of the horizontal displacement, choppiness applied: sums over tiles "
        "give Jacobian, normal and foam",
        lambda m: _gradient(m.frame),
    ),
    "jacobian": Map(
        ("jacobian",), "scalar", ("jacobian",), "1",
        "area of displaced over still water: below 1 it is squeezed, below 0 folded",
        lambda m: (m.frame.jacobian,), adds=False,
    ),
    "foam": Map(
        (), "scalar", ("coverage",), "1", "part of the water that is covered with foam, 0 to 1",
        lambda m: (_foam(m),), adds=False,
    ),
    "velocity": Map(
        ("velocity_x", "velocity_y", "velocity_z"), "vector",
        ("x", "y", "z"), "m/s",
        "velocity of the water at the surface, whatever the choppiness: what moves foam, particles "
        "and hulls",
        lambda m: (m.frame.velocity_x, m.frame.velocity_y, m.frame.velocity_z),
    ),
    "surface_velocity": Map(
        ("velocity_x", "velocity_y", "velocity_z"), "vector",
        ("x, choppiness applied", "y, choppiness applied", "z"), "m/s",
        "rate of change of the displacement map: velocity of the drawn surface, for motion blur",
        lambda m: (*_surface_velocity(m.frame), m.frame.velocity_z),
    ),
    "slope_covariance": Map(
        (), "covariance", ("slope_x slope_x", "slope_x slope_y", "slope_y slope_y"), "1",
        "covariance, within a texel, of the derivative map's two slopes; level 0 holds "
        "the waves too short for the tile",
        _unresolved,
        ("slope_x", "slope_y"),
        lambda m: mips.slope_covariances(m.frame.slope_x, m.frame.slope_y, m.unresolved),
    ),
}  # fmt: skip
"""
Every map that can be baked. By lookup:

"lagrangian": texel (i, j) describes the water whose REST position is x, y; its displacement leads
to its position now. "eulerian": texel (i, j) describes the water that is NOW at x, y, and the
surface is a height field over x and y: displacement is (0, 0, height) and the stretches of the
derivative map are 0, so that these maps displace and light the same surface, and the slopes are its
dz/dx and dz/dy. Normals are those of the surface; jacobian, foam and velocities those of the water
at that place. A height field has no stretch map.

Of a cascade, only maps that add up over tiles can be baked (`adds`), and only by rest position: see
`cascade_setup`.
"""


def require_registered(table: Mapping[str, Map], names: Iterable[str]) -> None:
    """
    Raise if a table of maps and the names that a job may give differ, or a row is incomplete.

    Raises:
        ImportError: a name has no row, a row no name, or a map has no channel, no caption, channels
            of a number that its kind does not have, or levels without their fields.
    """
    rows, names = set(table), set(names)
    if rows != names:
        raise ImportError(
            f"job.parameters.MAPS and scene.maps.MAPS must have the same names, and differ in "
            f"{', '.join(sorted(rows ^ names))}"
        )
    for name, row in table.items():
        if row.kind not in get_args(Kind):
            raise ImportError(f"the map {name!r} has no known kind, got {row.kind!r}")
        if not row.names or len(row.names) != CHANNELS.get(row.kind, len(row.names)):
            raise ImportError(
                f"the map {name!r} of kind {row.kind} must have "
                f"{CHANNELS.get(row.kind, 'some')} channels, got {len(row.names)}"
            )
        if not row.caption or not callable(row.compute):
            raise ImportError(f"the map {name!r} must have a caption and a function for channels")
        if row.needs_levels and row.compute_levels is None:
            raise ImportError(f"the map {name!r} has fields for mip levels and no function of them")


require_registered(MAPS, parameters.MAPS)


def needed(names: Iterable[str], *, mips: bool = False, eulerian: bool = False) -> tuple[str, ...]:
    """
    Return the fields to ask of a frame for some maps, with their levels or without.

    Raises:
        ParameterError: a map that an eulerian frame does not have.
    """
    fields: dict[str, None] = {}
    for name in names:
        for need in MAPS[name].needed(mips=mips, eulerian=eulerian):
            if eulerian and need not in BY_PLACE:
                raise ParameterError(
                    f"the map {name!r} cannot be baked with the lookup 'eulerian', as it "
                    f"shows {need}: {NOT_BY_PLACE}"
                )
            fields[need] = None
    return tuple(fields)


def unresolved(ocean: Ocean) -> Real:
    """
    Return the slope covariance of the waves too short for the tile, (3,): `mips.unresolved_slopes`.
    """
    return mips.unresolved_slopes(ocean)


def _moved(frame: Frame | EulerianFrame) -> tuple[Real, Real]:
    """Return the horizontal displacement, choppiness applied; 0 for an eulerian frame."""
    if isinstance(frame, EulerianFrame):
        nothing = np.zeros_like(frame.height)
        return nothing, nothing
    return frame.displace_x * frame.choppiness, frame.displace_y * frame.choppiness


def _surface_velocity(frame: Frame | EulerianFrame) -> tuple[Real, Real]:
    """Return the horizontal velocity of the displaced surface: choppiness applied."""
    return frame.velocity_x * frame.choppiness, frame.velocity_y * frame.choppiness


def _stretched(frame: Frame | EulerianFrame) -> tuple[Real, Real]:
    """Return the stretch along x and along y, choppiness applied; 0 for an eulerian frame."""
    if isinstance(frame, EulerianFrame):
        nothing = np.zeros_like(frame.slope_x)
        return nothing, nothing
    return frame.stretch_xx * frame.choppiness, frame.stretch_yy * frame.choppiness


def _gradient(frame: Frame | EulerianFrame) -> tuple[Real, Real, Real]:
    """Return the gradient of the horizontal displacement, choppiness applied: xx, xy, yy."""
    c = frame.choppiness
    return frame["stretch_xx"] * c, frame["stretch_xy"] * c, frame["stretch_yy"] * c


def _geometry(frame: Frame | EulerianFrame) -> tuple[Real, Real, Real, Real, Real]:
    """Return slopes and stretches of the surface; of an eulerian frame, those of a height field."""
    if isinstance(frame, EulerianFrame):
        nothing = np.zeros_like(frame.slope_x)
        return frame.slope_x, frame.slope_y, nothing, nothing, nothing
    return frame.slope_x, frame.slope_y, frame.stretch_xx, frame.stretch_xy, frame.stretch_yy


def _stacked(channels: Iterable[Real]) -> Real:
    """Return channels side by side, float32; those of one such array without a copy."""
    if isinstance(channels, np.ndarray) and channels.dtype == np.float32:
        together = np.moveaxis(channels, 0, -1)
        if together.flags.c_contiguous:
            return together
    return np.stack([channel.astype(np.float32, copy=False) for channel in channels], axis=-1)
