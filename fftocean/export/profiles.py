"""
Conventions of each engine for texture files: axes, row order, unit, green sign, normal encoding.

The library's own convention is x east, y north, z up, right-handed, in metres, with arrays that
begin in the south-west. An engine has its own axes, and puts a file's row 0 at v = 0 or v = 1 of a
texture. These belong together: mirrored rows without negated displacement along them give round
crests and sharp troughs. This module defines all of them; `rules` writes them as formulas, and
`engines` gives the profile of each engine and format.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import ParameterError
from fftocean.export.registry import by_name

Pixels = npt.NDArray[np.float32]
"""(rows, columns, channels) float32, C-contiguous, as a file holds it."""

Kind = Literal["scalar", "height", "vector", "normal", "derivative", "covariance", "stretch"]
"""Change of a map's channels with the axes; `KINDS` has one row for each."""

Normals = Literal["signed", "packed"]
"""
Encoding of a unit normal n in a normal map.

signed: c = n, -1 to 1.  packed: c = (n + 1) / 2, 0 to 1: the stock materials of engines compute
n = 2 c - 1. Zero is stored as 1/2, which halves and floats hold exactly.
"""

AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True, slots=True)
class Profile:
    """Conventions of the files that one engine reads in one way."""

    name: str
    axes: tuple[str, str, str]  # R, G and B of a vector map: sign and axis of the library
    first_row: Literal["north", "south"]  # edge of the sea that is row 0 of the file
    first_v: Literal[0, 1]  # texture coordinate of row 0 of the file
    unit: Literal["m", "cm"]
    green: Literal[1, -1]  # of a normal map: toward row 0, or away from it
    normals: Normals
    caption: str
    loaded: bool = True  # True: the engine's own loader; False: the user's code uploads bytes
    gutter: int = 1  # texels repeated around each frame of an atlas; 0: the engine cuts the atlas
    note: str = ""  # way of the files into the engine

    @property
    def scale(self) -> int:
        """Number of the engine's units in a metre."""
        return 100 if self.unit == "cm" else 1

    @property
    def north(self) -> int:
        """Sign of north along the engine's second horizontal axis."""
        return -1 if "-y" in self.axes else 1

    @property
    def v_north(self) -> int:
        """Sign of north along v."""
        return 1 if (self.first_row == "north") == (self.first_v == 1) else -1

    @property
    def green_north(self) -> int:
        """Sign of north in the green channel of a normal map."""
        return self.green * (1 if self.first_row == "north" else -1)

    @property
    def horizontal(self) -> tuple[str, str]:
        """Names of the engine's two horizontal axes, eastward first."""
        one, two = (c for c, axis in zip("XYZ", self.axes, strict=True) if axis[1] != "z")
        return one, two

    @property
    def up(self) -> str:
        """Name of the engine's vertical axis."""
        return "XYZ"[self.axes.index("+z")]

    @property
    def compass(self) -> dict[str, str]:
        """Direction of each of the engine's axes."""
        words = {"+x": "east", "+y": "north", "-y": "south", "+z": "up"}
        return {c: words[axis] for c, axis in zip("XYZ", self.axes, strict=True)}

    @property
    def handed(self) -> Literal["left", "right"]:
        """Handedness of the engine's axes."""
        return "left" if round(np.linalg.det(self._matrix())) < 0 else "right"

    def _matrix(self) -> npt.NDArray[np.float64]:
        """Return the engine's axes in library axes, one a row."""
        return np.array(
            [[float(f"{a[0]}1") * (AXES[a[1]] == i) for i in range(3)] for a in self.axes]
        )


PROFILES: dict[str, Profile] = by_name((
    #        name         R, G, B              row 0   at v  unit green normals
    Profile("canonical", ("+x", "+y", "+z"), "north", 1, "m", +1, "signed",
            "our own axes, as an image viewer shows them"),
    Profile("blender",   ("+x", "+y", "+z"), "north", 1, "m", +1, "packed",
            "Blender: z up; RGB to XYZ"),
    Profile("unity",     ("+x", "+z", "+y"), "north", 1, "m", +1, "packed",
            "Unity: y up, left-handed, z north", gutter=0),
    Profile("unreal",    ("+x", "-y", "+z"), "north", 0, "cm", -1, "packed",
            "Unreal: z up, left-handed, y south, centimetres"),
    Profile("godot",     ("+x", "+z", "-y"), "north", 0, "m", +1, "packed",
            "Godot: y up, z south", gutter=0),
    Profile("bevy",      ("+x", "+z", "-y"), "north", 0, "m", +1, "packed",
            "Bevy: y up, z south"),
    Profile("gltf",      ("+x", "+z", "-y"), "north", 0, "m", +1, "packed",
            "glTF: y up, z south"),
    Profile("three",     ("+x", "+z", "-y"), "north", 0, "m", +1, "packed",
            "three.js, raw half or KTX2: y up, z south"),
    Profile("three-exr", ("+x", "+z", "-y"), "south", 1, "m", +1, "packed",
            "three.js by its EXRLoader, which turns the rows over"),
    Profile("babylon",   ("+x", "+z", "+y"), "south", 0, "m", +1, "packed",
            "Babylon.js, raw: y up, left-handed, z north"),
    Profile("houdini",   ("+x", "+z", "-y"), "south", 1, "m", +1, "packed",
            "Houdini, USD: y up, z south"),
))  # fmt: skip


@dataclass(frozen=True, slots=True)
class KindRow:
    """
    Behaviour of one kind of map.

    Attributes:
        channels: number of channels; None is any number.
        scaled: True if values are lengths, in the profile's unit.
        signs: function from profile and number of channels to the factor on each channel.
        world: function from a profile to formulas of the values along the engine's axes in terms of
            the file's channels R, G, B, A.
    """

    channels: int | None
    scaled: bool
    signs: Callable[[Profile, int], tuple[int, ...]]
    world: Callable[[Profile], dict[str, str]]


def _normal_world(profile: Profile) -> dict[str, str]:
    """Return the components of a unit normal along the engine's axes."""
    value = "(2 * {} - 1)" if profile.normals == "packed" else "{}"
    one, two = profile.horizontal
    minus = "-" if profile.north * profile.green_north < 0 else ""
    red, green, blue = (value.format(letter) for letter in "RGB")
    return {f"normal_{one}": red, f"normal_{two}": minus + green, f"normal_{profile.up}": blue}


def _derivative_world(profile: Profile) -> dict[str, str]:
    """Return slopes, stretches, and their normal (without shear, not of length 1)."""
    one, two = profile.horizontal
    return {
        f"slope_{one}": "R",
        f"slope_{two}": "G",
        f"stretch_{one}": "B",
        f"stretch_{two}": "A",
        f"normal_{one}": "-R / (1 + B)",
        f"normal_{two}": "-G / (1 + A)",
        f"normal_{profile.up}": "1",
    }


def _pairs(name: str) -> Callable[[Profile], dict[str, str]]:
    """Return the three entries of a symmetric matrix over the horizontal axes."""

    def world(profile: Profile) -> dict[str, str]:
        one, two = profile.horizontal
        pairs = (one + one, one + two, two + two)
        return {f"{name}_{pair}": c for pair, c in zip(pairs, "RGB", strict=True)}

    return world


# Slopes have no unit: centimetres per centimetre. A mirrored axis negates quantities that are odd
# in it: the slope along it and the mixed entries, not the stretch along it, mirrored twice.
KINDS: dict[str, KindRow] = {
    "scalar": KindRow(None, False, lambda _, n: (1,) * n, lambda _: {"value": "R"}),
    "height": KindRow(None, True, lambda _, n: (1,) * n, lambda p: {p.up: "R"}),
    "vector": KindRow(
        3, True,
        lambda p, _: tuple(1 if axis[0] == "+" else -1 for axis in p.axes),
        lambda _: dict(zip("XYZ", "RGB", strict=True)),
    ),
    "normal": KindRow(3, False, lambda p, _: (1, p.green_north, 1), _normal_world),
    "derivative": KindRow(4, False, lambda p, _: (1, p.north, 1, 1), _derivative_world),
    "covariance": KindRow(3, False, lambda p, _: (1, p.north, 1), _pairs("slope_covariance")),
    "stretch": KindRow(3, False, lambda p, _: (1, p.north, 1), _pairs("stretch")),
}  # fmt: skip

if set(KINDS) != set(get_args(Kind)):
    raise ImportError(f"KINDS must have a row for each Kind, got {', '.join(KINDS)}")

CHANNELS: dict[str, int] = {name: row.channels for name, row in KINDS.items() if row.channels}
"""Number of channels of a kind; scalars and heights may have any number."""


def recorded(profile: Profile, conventions: Any) -> Profile:
    """
    Return a profile with the row order and normal encoding that a manifest states.

    Bakes of version 0.1 do not name the encoding of normals, which were signed then.
    """
    first_row: Literal["north", "south"] = (
        "south" if "the south edge" in conventions["rows"] else "north"
    )
    packed = str(conventions.get("normals", "signed")).startswith("packed")
    return replace(profile, first_row=first_row, normals="packed" if packed else "signed")


def range_of_normals(profile: Profile) -> tuple[float, float]:
    """
    Return the range of normal components that 16-bit steps cover.

    Signed: steps of 1/32767, so that -1, 0 and 1 are steps. Packed: a material computes
    2 k / 65535 - 1 of step k, which is 0 for no integer k: the nearest is 1/65535 = 1.5e-5 off.
    """
    return (0.0, 1.0) if profile.normals == "packed" else (-1.0, 1.0 + 1.0 / 32767.0)


def arrange(profile: Profile, kind: Kind, channels: Real) -> Pixels:
    """
    Return the pixels of an engine's file for a map of the library.

    Args:
        profile: conventions of the file.
        kind: kind of map, which determines how the channels change.
        channels: (ny, nx, c), row 0 south, library axes, metres; float32, or float64 rounded once.

    Returns:
        (rows, columns, c) float32, C-contiguous, in the file's own axes and unit.

    Raises:
        ParameterError: another number of channels than the kind has, or no such kind.

    Pinned by tests/export/test_profiles.py, in each engine's own frame.
    """
    sources, scale = _recipe(profile, kind, _counted(kind, channels))
    out = np.empty(channels.shape, dtype=np.float32)
    rows = channels[::-1] if profile.first_row == "north" else channels
    real = channels.dtype.type
    np.multiply(rows, real(scale), out=out, casting="same_kind")
    for c, (source, sign) in enumerate(sources):
        if (source, sign) != (c, 1):
            np.multiply(rows[..., source], real(sign * scale), out=out[..., c], casting="same_kind")
    if kind == "normal" and profile.normals == "packed":
        out *= np.float32(0.5)
        out += np.float32(0.5)
    return out


def restore(profile: Profile, kind: Kind, pixels: Real) -> Pixels:
    """
    Return the map of the library from the pixels of an engine's file.

    This is the inverse of `arrange`: exact in metres, up to rounding in centimetres, to 2^-24 for
    packed normals.

    Raises:
        ParameterError: another number of channels than the kind has, or no such kind.
    """
    sources, scale = _recipe(profile, kind, _counted(kind, pixels))
    out = np.empty(pixels.shape, dtype=np.float32)
    rows = pixels[::-1] if profile.first_row == "north" else pixels
    if kind == "normal" and profile.normals == "packed":
        rows = rows.astype(np.float32) * np.float32(2.0) - np.float32(1.0)
    np.divide(rows, np.float32(scale), out=out, casting="same_kind")
    for c, (source, sign) in enumerate(sources):
        if (source, sign) != (c, 1):
            factor = np.float32(sign * scale)
            np.divide(rows[..., c], factor, out=out[..., source], casting="same_kind")
    return out


def meaning(profile: Profile, kind: Kind, names: tuple[str, ...]) -> tuple[str, ...]:
    """
    Return the contents of each channel of the file in words, for the manifest.

    Args:
        profile: conventions of the file.
        kind: kind of map, which determines how the channels change.
        names: contents of the library's channels, such as ("x", "y", "height").

    Raises:
        ParameterError: another number of names than the kind has channels, or no such kind.
    """
    sources, _ = _recipe(profile, kind, _count(kind, len(names)))
    if kind == "normal" and profile.normals == "packed":
        return tuple(f"(1 {'+' if sign > 0 else '-'} {names[i]}) / 2" for i, sign in sources)
    return tuple(names[i] if sign > 0 else f"minus ({names[i]})" for i, sign in sources)


def unit_in(profile: Profile, kind: Kind, unit: str) -> str:
    """Return a map's unit in the file: a profile in cm has cm for m, and cm/s for m/s."""
    return f"c{unit}" if _recipe(profile, kind, CHANNELS.get(kind, 1))[1] != 1 else unit


def _recipe(profile: Profile, kind: Kind, count: int) -> tuple[list[tuple[int, int]], int]:
    """Return (library channel, sign) of each channel of the file, and a factor on all."""
    row = KINDS[kind]
    signs = row.signs(profile, count)
    sources = [AXES[a[1]] for a in profile.axes] if kind == "vector" else list(range(count))
    return list(zip(sources, signs, strict=True)), profile.scale if row.scaled else 1


def _counted(kind: Kind, channels: Real) -> int:
    """Return the number of channels of an array; raise unless the kind has it."""
    if channels.ndim != 3:
        raise ParameterError(f"a map must be (rows, columns, channels), got shape {channels.shape}")
    return _count(kind, channels.shape[2])


def _count(kind: Kind, count: int) -> int:
    """Return a number of channels; raise unless the kind has it."""
    if kind not in KINDS:
        raise ParameterError(f"kind must be one of {', '.join(KINDS)}, got {kind!r:.40}")
    if count != CHANNELS.get(kind, count):
        raise ParameterError(f"a {kind} map must have {CHANNELS[kind]} channels, got {count}")
    return count
