"""
What each engine takes a picture of water for: axes, row order, unit and green sign, which are set together or the sea is wrong.

Ours is x east, y north, z up, right-handed, in metres, and our arrays begin in the south-west. An engine names its own axes, and
its loader puts row 0 of a file at v = 0 or at v = 1. Every profile below is so made that in its engine, by its own loader,

    u = X / size + 0.5 / columns,    v = Z / size +- 0.5 / rows,

where X and Z are the engine's own two horizontal axes: u grows toward the east, v grows along the second axis, wherever that points.
Rows mirrored without negating the displacement along them round the crests and sharpen the troughs; this is the one room for both.
"""

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import ParameterError

Pixels = npt.NDArray[np.float32]
"""(rows, columns, channels) float32, C-contiguous, as a file holds it."""

Kind = Literal["scalar", "height", "vector", "normal", "derivative", "stretch", "covariance"]
"""
How the channels of a map change with the frame:

scalar: not at all (Jacobian, foam).  height: a length along up.  vector: a length along each axis (displacement, velocity).
normal: tangent space, whatever the world's axes: R along +u, G toward row 0 or away from it, B up; signed, not packed into 0..1.
derivative: the slopes along the engine's two horizontal axes, then the two stretches.  covariance: of those slopes: xx, xy, yy.
stretch: the gradient of the horizontal displacement along those two axes, symmetric: xx, xy, yy.
"""

CHANNELS: dict[str, int] = {"vector": 3, "normal": 3, "derivative": 4, "stretch": 3, "covariance": 3}
"""How many channels a kind has; scalars and heights come in any number."""

AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True, slots=True)
class Profile:
    """One engine's conventions, as a whole."""

    name: str
    axes: tuple[str, str, str]  # what R, G and B of a vector map hold: a sign and one of our axes
    first_row: Literal["north", "south"]  # of the sea, in the file
    first_v: Literal[0, 1]  # where the engine's own loader of pictures puts that row; bytes uploaded raw begin at v = 0 everywhere
    unit: Literal["m", "cm"]
    green: Literal[1, -1]  # of a normal map: toward row 0, or away from it
    caption: str

    @property
    def scale(self) -> int:
        """The engine's units in a metre."""
        return 100 if self.unit == "cm" else 1

    @property
    def north(self) -> int:
        """The sign with which north enters the engine's second horizontal axis, and v: -1 where they point south."""
        return -1 if "-y" in self.axes else 1

    @property
    def green_north(self) -> int:
        """The sign with which north enters green of a normal map."""
        return self.green * (1 if self.first_row == "north" else -1)

    def describe(self, *, raw: bool = False) -> dict[str, Any]:
        """For the manifest and the sidecars: the frame of the files in words; `raw` where no loader of pictures will turn their rows."""
        one, two = (c for c, axis in zip("XYZ", self.axes, strict=True) if axis[1] != "z")
        first_v = 0 if raw else self.first_v
        two_sign, half_sign = ("", self.north) if first_v == self.first_v else ("-", -self.north)
        compass = {"+x": "east", "+y": "north", "-y": "south", "+z": "up"}
        axes = {c: compass[axis] for c, axis in zip("XYZ", self.axes, strict=True)}
        handed = "left" if round(np.linalg.det(self._matrix())) < 0 else "right"
        green = "up (toward row 0)" if self.green > 0 else "down (away from row 0)"
        placed = "uploaded raw, it is" if raw else "the loader puts it"
        return {
            "profile": self.name,
            "axes": f"{', '.join(f'{c} {points}' for c, points in axes.items())}, {handed}-handed",
            "unit": self.unit,
            "rows": f"row 0 of a file is the {self.first_row} edge; {placed} at v = {first_v}",
            "columns": "column 0 is the west edge, at u = 0",
            "normal_green": f"{green}, which is {'north' if self.green_north > 0 else 'south'}",
            "samples": f"u = {one} / size + 0.5 / columns, v = {two_sign}{two} / size {'+-'[half_sign < 0]} 0.5 / rows, repeated",
        }

    def _matrix(self) -> npt.NDArray[np.float64]:
        """Rows: the engine's axes in ours."""
        return np.array([[float(f"{axis[0]}1") * (AXES[axis[1]] == i) for i in range(3)] for axis in self.axes])


PROFILES: dict[str, Profile] = {
    profile.name: profile
    for profile in (
        #        name         R, G, B              row 0   at v  unit green
        Profile("canonical", ("+x", "+y", "+z"), "north", 1, "m", +1, "our own axes, as an image viewer shows them"),
        Profile("blender",   ("+x", "+y", "+z"), "north", 1, "m", +1, "Blender: z up; RGB to XYZ"),
        Profile("unity",     ("+x", "+z", "+y"), "north", 1, "m", +1, "Unity: y up, left-handed, z north"),
        Profile("unreal",    ("+x", "-y", "+z"), "north", 0, "cm", -1, "Unreal: z up, left-handed, y south, centimetres"),
        Profile("godot",     ("+x", "+z", "-y"), "north", 0, "m", +1, "Godot: y up, z south"),
        Profile("bevy",      ("+x", "+z", "-y"), "north", 0, "m", +1, "Bevy: y up, z south"),
        Profile("gltf",      ("+x", "+z", "-y"), "north", 0, "m", +1, "glTF: y up, z south"),
        Profile("three",     ("+x", "+z", "-y"), "north", 0, "m", +1, "three.js, raw half or KTX2: y up, z south"),
        Profile("three-exr", ("+x", "+z", "-y"), "south", 1, "m", +1, "three.js by its EXRLoader, which turns the rows over"),
        Profile("babylon",   ("+x", "+z", "+y"), "south", 0, "m", +1, "Babylon.js, raw: y up, left-handed, z north; green per material"),
        Profile("houdini",   ("+x", "+z", "-y"), "south", 1, "m", +1, "Houdini, USD: y up, z south"),
    )
}  # fmt: skip


def profile_for(engine: str, *, raw: bool = False) -> Profile:
    """
    Return an engine's profile by its name, for files read by its loader of pictures, or for raw bytes.

    Raises:
        ParameterError: there is no such engine.
    """
    if engine not in PROFILES:
        raise ParameterError(f"engine must be one of {', '.join(PROFILES)}, got {engine!r:.40}")
    return PROFILES["three-exr" if engine == "three" and not raw else engine]  # the only one that wants another order of rows


def arrange(profile: Profile, kind: Kind, channels: Real) -> Pixels:
    """
    Turn a map of ours into what the engine's file holds.

    Args:
        profile: whose file.
        kind: how the channels change.
        channels: (ny, nx, c), row 0 south, our axes, metres; float32, or float64 that is rounded once.

    Returns:
        (rows, columns, c) float32, C-contiguous, in the file's own frame and unit.

    Raises:
        ParameterError: another number of channels than the kind has, or no such kind.

    Pinned by tests/export/test_profiles.py, in each engine's own frame.
    """
    sources, scale = _recipe(profile, kind, _counted(kind, channels))
    out = np.empty(channels.shape, dtype=np.float32)
    rows = channels[::-1] if profile.first_row == "north" else channels
    np.multiply(rows, channels.dtype.type(scale), out=out, casting="same_kind")
    for c, (source, sign) in enumerate(sources):
        if (source, sign) != (c, 1):
            np.multiply(rows[..., source], channels.dtype.type(sign * scale), out=out[..., c], casting="same_kind")
    return out


def restore(profile: Profile, kind: Kind, pixels: Real) -> Pixels:
    """
    Turn what an engine's file holds back into a map of ours: the inverse of `arrange`, to the bit, or to a rounding where it is in cm.

    Raises:
        ParameterError: another number of channels than the kind has, or no such kind.
    """
    sources, scale = _recipe(profile, kind, _counted(kind, pixels))
    out = np.empty(pixels.shape, dtype=np.float32)
    rows = pixels[::-1] if profile.first_row == "north" else pixels
    np.divide(rows, np.float32(scale), out=out, casting="same_kind")
    for c, (source, sign) in enumerate(sources):
        if (source, sign) != (c, 1):
            np.divide(rows[..., c], np.float32(sign * scale), out=out[..., source], casting="same_kind")
    return out


def meaning(profile: Profile, kind: Kind, names: tuple[str, ...]) -> tuple[str, ...]:
    """
    Return in words what each channel of the file holds, for the manifest.

    Args:
        profile: whose file.
        kind: how the channels change.
        names: what our own channels hold, such as ("x", "y", "height").

    Raises:
        ParameterError: another number of names than the kind has channels, or no such kind.
    """
    sources, _ = _recipe(profile, kind, _count(kind, len(names)))
    return tuple(names[source] if sign > 0 else f"minus ({names[source]})" for source, sign in sources)


def unit_in(profile: Profile, kind: Kind, unit: str) -> str:
    """The unit that a map's values have in the file: metres, and metres per second, are centimetres where the profile has those."""
    return f"c{unit}" if _recipe(profile, kind, CHANNELS.get(kind, 1))[1] != 1 else unit


def _recipe(profile: Profile, kind: Kind, count: int) -> tuple[list[tuple[int, int]], int]:
    """For each channel of the file: which of ours it is, and its sign; and the factor on all of them."""
    if kind == "vector":
        return [(AXES[axis[1]], 1 if axis[0] == "+" else -1) for axis in profile.axes], profile.scale
    if kind == "height":
        return [(c, 1) for c in range(count)], profile.scale
    # centimetres per centimetre: slopes have no unit. A mirrored axis turns the slope along it, not a stretch, which is mirrored twice
    signs = {
        "scalar": (1,) * count,
        "normal": (1, profile.green_north, 1),
        "derivative": (1, profile.north, 1, 1),
        "stretch": (1, profile.north, 1),
        "covariance": (1, profile.north, 1),
    }
    return list(enumerate(signs[kind])), 1


def _counted(kind: Kind, channels: Real) -> int:
    """The number of channels of an array, found to be right for the kind."""
    if channels.ndim != 3:
        raise ParameterError(f"a map must be (rows, columns, channels), got shape {channels.shape}")
    return _count(kind, channels.shape[2])


def _count(kind: Kind, count: int) -> int:
    """The number of channels, found to be right for the kind."""
    if kind not in get_args(Kind):
        raise ParameterError(f"kind must be one of {', '.join(get_args(Kind))}, got {kind!r:.40}")
    if count != CHANNELS.get(kind, count):
        raise ParameterError(f"a {kind} map must have {CHANNELS[kind]} channels, got {count}")
    return count
