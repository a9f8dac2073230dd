"""
From a frame to the pictures that are written: which field goes into which channel, in what unit,
and what smaller levels hold.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from fftocean import mips
from fftocean.arrays import Real
from fftocean.errors import ParameterError
from fftocean.export.profiles import Kind
from fftocean.frame import BY_PLACE, NOT_BY_PLACE, EulerianFrame, Frame
from fftocean.ocean import Ocean

GEOMETRY = ("slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy")


@dataclass(frozen=True, slots=True)
class Moment:
    """What there is of the water at one moment."""

    frame: Frame | EulerianFrame
    foam: Real | None  # coverage, (ny, nx), 0..1
    unresolved: Real | None  # slope covariance of the waves too short for the tile, (3,)


@dataclass(frozen=True, slots=True)
class Map:
    """
    A picture of the sea, in our own frame: row 0 south, x east, y north, z up, SI.

    `channels` and `levels` take a frame that has the fields `needed`; where foam is shown, its
    coverage, (ny, nx) in 0..1; and, where slope covariance is, that of the waves too short for the
    tile, from `unresolved`. A frame of `Eulerian` has no displacement and no stretch: a map that
    shows them has fields of its own for it, `by_place`, and draws them as 0.
    """

    needs: tuple[str, ...]  # fields of a frame
    kind: Kind  # how the channels turn with an engine's axes
    names: tuple[str, ...]  # of the channels
    unit: str
    caption: str
    draw: Callable[[Moment], Iterable[Real]]  # the channels, each (ny, nx)
    needs_levels: tuple[str, ...] = ()  # further fields, for levels
    draw_levels: Callable[[Moment], list[Real]] | None = None  # where they are more than box means
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
        """Return the picture, (ny, nx, channels), float32, C-contiguous."""
        return _stacked(self.draw(Moment(frame, foam, unresolved)))

    def levels(
        self, frame: Frame | EulerianFrame, foam: Real | None = None, unresolved: Real | None = None
    ) -> list[Real]:
        """
        Return the picture and its smaller levels down to one texel, each (rows, columns, channels),
        float32, C-contiguous.
        """
        moment = Moment(frame, foam, unresolved)
        levels = (
            self.draw_levels(moment)
            if self.draw_levels
            else mips.chain(_stacked(self.draw(moment)))
        )
        return [np.ascontiguousarray(level, dtype=np.float32) for level in levels]


def _foam(moment: Moment) -> Real:
    assert moment.foam is not None  # whoever asks for the map brings the foam
    return moment.foam


def _unresolved(moment: Moment) -> list[Real]:
    """Three channels of one value each."""
    values = np.zeros(3) if moment.unresolved is None else moment.unresolved
    return [np.full(moment.frame.grid.shape, value) for value in values]


MAPS: dict[str, Map] = {
    "height": Map(
        ("height",), "height", ("height",), "m", "height of the water",
        lambda m: (m.frame.height,),
    ),
    "displacement": Map(
        ("displace_x", "displace_y", "height"), "vector", ("x, choppiness applied", "y, choppiness applied", "height"), "m",
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
        ("d height/dx", "d height/dy", "d displacement x/dx, choppiness applied", "d displacement y/dy, choppiness applied"), "1",
        "slopes and stretches, which add up over tiles; without the shear the normal is about "
        "(-slope_x/(1 + stretch_xx), -slope_y/(1 + stretch_yy), 1)",
        lambda m: (m.frame.slope_x, m.frame.slope_y, *_stretched(m.frame)),
        by_place=("slope_x", "slope_y"),
    ),
    "stretch": Map(
        ("stretch_xx", "stretch_xy", "stretch_yy"), "stretch",
        ("d displacement x/dx", "d displacement x/dy = d displacement y/dx", "d displacement y/dy"), "1",
        "gradient of the horizontal displacement, choppiness applied: sums over tiles give Jacobian, normal and foam",
        lambda m: _gradient(m.frame),
    ),
    "jacobian": Map(
        ("jacobian",), "scalar", ("jacobian",), "1", "area of displaced over still water: below 1 it is squeezed, below 0 folded",
        lambda m: (m.frame.jacobian,), adds=False,
    ),
    "foam": Map(
        (), "scalar", ("coverage",), "1", "part of the water that is covered with foam, 0 to 1",
        lambda m: (_foam(m),), adds=False,
    ),
    "velocity": Map(
        ("velocity_x", "velocity_y", "velocity_z"), "vector", ("x, choppiness applied", "y, choppiness applied", "z"), "m/s",
        "velocity of the water at the surface",
        lambda m: (m.frame.velocity_x * m.frame.choppiness, m.frame.velocity_y * m.frame.choppiness, m.frame.velocity_z),
    ),
    "slope_covariance": Map(
        (), "covariance", ("slope_x slope_x", "slope_x slope_y", "slope_y slope_y"), "1",
        "covariance, within a texel, of the derivative map's two slopes; level 0 holds the waves too short for the tile",
        _unresolved,
        ("slope_x", "slope_y"), lambda m: mips.slope_covariances(m.frame.slope_x, m.frame.slope_y, m.unresolved),
    ),
}  # fmt: skip
"""
Every map that can be baked. By lookup:

"lagrangian": texel (i, j) is about the water that is AT REST at x, y; displacement tells where it
is now. "eulerian": about the water that is NOW at x, y, and the surface is a plain height field
over x and y: displacement is (0, 0, height) and the stretches of the derivative map are 0, so that
what is displaced and lit by these maps is the same surface, and the slopes are dz/dx and dz/dy of
it. Normals are the surface's own, jacobian, foam and velocity those of the water that is there. A
height field has no stretch map.

Of a cascade, only maps that add up over tiles can be baked (`adds`), and only by the undisplaced
position: see `tiles`.
"""


def needed(names: Iterable[str], *, mips: bool = False, eulerian: bool = False) -> tuple[str, ...]:
    """
    Return the fields to ask of a frame for some maps, with their levels or without.

    Raises:
        ParameterError: a map that an eulerian frame cannot show.
    """
    fields: dict[str, None] = {}
    for name in names:
        for need in MAPS[name].needed(mips=mips, eulerian=eulerian):
            if eulerian and need not in BY_PLACE:
                raise ParameterError(
                    f"the map {name!r} cannot be baked with the lookup 'eulerian', as it shows {need}: {NOT_BY_PLACE}"
                )
            fields[need] = None
    return tuple(fields)


def unresolved(ocean: Ocean) -> Real:
    """
    Return the slope covariance of the waves too short for the tile, (3,): `mips.unresolved_slopes`.
    """
    return mips.unresolved_slopes(ocean)


def _moved(frame: Frame | EulerianFrame) -> tuple[Real, Real]:
    """The horizontal displacement, choppiness applied; 0 by place."""
    if isinstance(frame, EulerianFrame):
        nothing = np.zeros_like(frame.height)
        return nothing, nothing
    return frame.displace_x * frame.choppiness, frame.displace_y * frame.choppiness


def _stretched(frame: Frame | EulerianFrame) -> tuple[Real, Real]:
    """The stretch along x and along y, choppiness applied; 0 by place."""
    if isinstance(frame, EulerianFrame):
        nothing = np.zeros_like(frame.slope_x)
        return nothing, nothing
    return frame.stretch_xx * frame.choppiness, frame.stretch_yy * frame.choppiness


def _gradient(frame: Frame | EulerianFrame) -> tuple[Real, Real, Real]:
    """The gradient of the horizontal displacement, choppiness applied: xx, xy, yy."""
    c = frame.choppiness
    return frame["stretch_xx"] * c, frame["stretch_xy"] * c, frame["stretch_yy"] * c


def _geometry(frame: Frame | EulerianFrame) -> tuple[Real, Real, Real, Real, Real]:
    """The slopes and stretches of the surface; by place, those of a height field."""
    if isinstance(frame, EulerianFrame):
        nothing = np.zeros_like(frame.slope_x)
        return frame.slope_x, frame.slope_y, nothing, nothing, nothing
    return frame.slope_x, frame.slope_y, frame.stretch_xx, frame.stretch_xy, frame.stretch_yy


def _stacked(channels: Iterable[Real]) -> Real:
    """Channels side by side, float32."""
    return np.stack([channel.astype(np.float32, copy=False) for channel in channels], axis=-1)
