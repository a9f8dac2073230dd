"""
Each engine's frame, rebuilt here from what the engine says of itself, not from the profile: its
axes, its unit, where its loader puts row 0 of a picture, and where green points. A file is read the
way a shader reads it, and the water must be ours.
"""

import dataclasses
from typing import NamedTuple

import numpy as np
import pytest

import fftocean as fo
from fftocean.errors import ParameterError
from fftocean.export import rules
from fftocean.export.engines import profile_for
from fftocean.export.profiles import CHANNELS, PROFILES, arrange, meaning, restore, unit_in

pytestmark = pytest.mark.nojit
NX, NY, LX, LY = 48, 64, 60.0, 100.0


class Engine(NamedTuple):
    """An engine by its own documents."""

    world: tuple  # its X, Y, Z as (our axis, sign)
    flat: tuple  # which two of X, Y, Z are horizontal; the other is up
    per_metre: float
    row0_v: int  # where the loader puts row 0 of a picture
    green_up: bool  # a normal map's green points up the picture, toward row 0
    packed: bool = True  # its materials read normals as n = 2 c - 1


EAST, NORTH, SOUTH, UP = (0, 1), (1, 1), (1, -1), (2, 1)
ENGINES = {
    "canonical": Engine((EAST, NORTH, UP), (0, 1), 1.0, 1, True, packed=False),
    "blender": Engine((EAST, NORTH, UP), (0, 1), 1.0, 1, True),  # image rows count from the bottom
    "unity": Engine(
        (EAST, UP, NORTH), (0, 2), 1.0, 1, True
    ),  # textures begin at the bottom; left-handed
    "unreal": Engine(
        (EAST, SOUTH, UP), (0, 1), 100.0, 0, False
    ),  # left-handed, cm, DirectX: v down, green down
    "godot": Engine((EAST, UP, SOUTH), (0, 2), 1.0, 0, True),
    "bevy": Engine((EAST, UP, SOUTH), (0, 2), 1.0, 0, True),
    "gltf": Engine((EAST, UP, SOUTH), (0, 2), 1.0, 0, True),  # v = 0 is the top of the picture
    "three": Engine((EAST, UP, SOUTH), (0, 2), 1.0, 0, True),  # raw data: first byte at v = 0
    "three-exr": Engine(
        (EAST, UP, SOUTH), (0, 2), 1.0, 1, True
    ),  # EXRLoader fills the texture from its end
    "babylon": Engine((EAST, UP, NORTH), (0, 2), 1.0, 0, True),
    "houdini": Engine((EAST, UP, SOUTH), (0, 2), 1.0, 1, True),
}
LEFT_HANDED = {"unity", "unreal", "babylon"}
everywhere = pytest.mark.parametrize("name", ENGINES)


def texels(name, rows, columns):
    """Return u and v of each texel's centre as the engine's loader places them."""
    c, r = np.meshgrid(np.arange(columns), np.arange(rows))
    v = (r + 0.5) / rows
    return (c + 0.5) / columns, v if ENGINES[name].row0_v == 0 else 1.0 - v


def ground(name, rows=NY, columns=NX, size=(LX, LY)):
    """
    Return the place of each texel on the still water, (rows, columns, 3) in the engine's axes and
    unit: u and v times the size, less the half texel between a sample and the middle of its texel,
        eastward and northward.
    """
    engine = ENGINES[name]
    u, v = texels(name, rows, columns)
    out = np.zeros((rows, columns, 3))
    first, second = engine.flat
    out[..., first] = (u - 0.5 / columns) * size[0]
    out[..., second] = (v - engine.world[second][1] * 0.5 / rows) * size[1]
    return out * engine.per_metre


def to_world(name, ours):
    """Return points in the engine's axes and unit."""
    engine = ENGINES[name]
    return (
        np.stack([sign * ours[..., axis] for axis, sign in engine.world], axis=-1)
        * engine.per_metre
    )


def differences(field, axis, step):
    """Return central differences of the eighth order around a periodic array."""
    parts = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))
    return sum(w * (np.roll(field, -k, axis) - np.roll(field, k, axis)) for k, w in parts) / step


def steps(name):
    """
    Return the ground's step from one column, and from one row of the file, to the next, in the
    engine's axes.
    """
    at = ground(name)
    return at[0, 1] - at[0, 0], at[1, 0] - at[0, 0]


def gradient(name, field):
    """
    Return d field / d (first and second horizontal axis of the engine) from the file's pixels.
    """
    (first, second), (along, down) = ENGINES[name].flat, steps(name)
    return differences(field, 1, along[first]), differences(field, 0, down[second])


@pytest.fixture(scope="module")
def frame():
    """
    Return a few long waves in all directions, steep enough to show every sign: float64, smooth on
    the grid.
    """
    modes = [
        (1, 0, 0.6, 0.3),
        (0, 1, 0.7, 1.1),
        (-1, 2, 0.4, 2.0),
        (2, 1, 0.3, 4.0),
        (-2, -1, 0.2, 0.9),
    ]
    ocean = fo.Ocean.from_modes(
        modes, n=(NX, NY), size=(LX, LY), loop=60.0, dtype="float64", choppiness=0.9
    )
    return ocean.frame(1.7)


def displacement(frame):
    return np.stack(
        [frame.choppiness * frame.displace_x, frame.choppiness * frame.displace_y, frame.height],
        axis=-1,
    )


def test_the_two_tables_name_the_same_engines():
    assert list(PROFILES) == list(ENGINES)
    assert all(name == profile.name for name, profile in PROFILES.items())


@everywhere
def test_every_texel_is_the_water_that_is_there(frame, name):
    """
    Ground plus displacement, read from the file in the engine, is the engine's name for the point
    where ours is: place, axes, unit.
    """
    profile = PROFILES[name]
    pixels = arrange(profile, "vector", displacement(frame))
    assert pixels.dtype == np.float32
    assert pixels.flags.c_contiguous
    y, x = np.meshgrid(np.arange(NY) * LY / NY, np.arange(NX) * LX / NX, indexing="ij")
    still = to_world(name, np.stack([x, y, np.zeros_like(x)], axis=-1))
    tile = np.array([LX, LY]) * ENGINES[name].per_metre
    at = ground(name)
    horizontal = list(ENGINES[name].flat)
    for j, i in ((0, 0), (1, 0), (0, 1), (17, 40), (NY - 1, NX - 1)):
        apart = (
            at[..., horizontal] - still[j, i, horizontal]
        ) / tile  # in tiles: a whole number where the texel is the sample
        r, c = np.unravel_index(
            np.argmin(np.sum(np.abs(apart - np.round(apart)), axis=-1)), apart.shape[:2]
        )
        assert np.max(np.abs(apart[r, c] - np.round(apart[r, c]))) < 1e-12
        expected = to_world(name, displacement(frame)[j, i])
        assert np.max(np.abs(pixels[r, c] - expected)) <= 1e-7 * np.max(
            np.abs(expected)
        )  # float32: 6e-8


@everywhere
@pytest.mark.parametrize("mode", [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1)])
def test_the_crest_is_sharper_than_the_trough(name, mode):
    """
    A Gerstner wave with a k = 1/2 stands above still water on (pi - 2 a k) / (pi + 2 a k) = 0.517
    of what lies below it.
    """
    n, size = 96, 2 * np.pi * np.hypot(*mode)  # k = 1
    ocean = fo.Ocean.from_modes([(*mode, 0.5, 0.4)], n=n, size=size, loop=60.0, dtype="float64")
    pixels = arrange(PROFILES[name], "vector", displacement(ocean.frame(0.0))).astype(float)
    first, second = ENGINES[name].flat
    up = 3 - first - second
    at = ground(name, n, n, (size, size))
    along, down = at[0, 1, first] - at[0, 0, first], at[1, 0, second] - at[0, 0, second]
    xx, xy = differences(pixels[..., first], 1, along), differences(pixels[..., first], 0, down)
    yx, yy = differences(pixels[..., second], 1, along), differences(pixels[..., second], 0, down)
    area = (1 + xx) * (1 + yy) - xy * yx
    above = pixels[..., up] > 0
    # the edge of the crest is found to a texel in 96 at each side, where the area is 1: 2 in 96 of
    # a wave
    assert np.sum(area[above]) / np.sum(area[~above]) == pytest.approx(
        (np.pi - 1) / (np.pi + 1), rel=0.09
    )
    assert np.min(area[above]) == pytest.approx(0.5, abs=2e-3)  # 1 - a k at the crest itself


@everywhere
def test_normals_are_those_of_the_displaced_surface(frame, name):
    """
    Green and red laid along the engine's axes, blue up: the cross product of the surface's tangents
    by differences, to 2e-6.
    """
    engine = ENGINES[name]
    pixels = arrange(PROFILES[name], "normal", fo.normals(frame)).astype(float)
    pixels = 2 * pixels - 1 if engine.packed else pixels
    surface = arrange(PROFILES[name], "vector", displacement(frame)).astype(float)
    first, second = engine.flat
    up = 3 - first - second
    along, down = steps(name)
    toward_row0 = -np.sign(down[second])  # along the engine's second axis
    normal = np.zeros_like(pixels)
    normal[..., first] = pixels[..., 0]
    normal[..., second] = pixels[..., 1] * toward_row0 * (1 if engine.green_up else -1)
    normal[..., up] = pixels[..., 2]
    east = along / along[first] + differences(surface, 1, along[first])
    across = down / down[second] + differences(surface, 0, down[second])
    expected = np.cross(east, across)
    expected *= np.sign(expected[..., up : up + 1]) / np.linalg.norm(
        expected, axis=-1, keepdims=True
    )  # upward, in either handedness
    assert (
        np.max(np.abs(normal - expected)) < 2e-6
    )  # the differences' own: 1e-7 of float32 over a step of 1/2 m, times 3


@everywhere
def test_slopes_and_stretches_are_along_the_engines_axes(frame, name):
    profile, (first, second) = PROFILES[name], ENGINES[name].flat
    c = frame.choppiness
    ours = np.stack(
        [frame.slope_x, frame.slope_y, c * frame.stretch_xx, c * frame.stretch_yy], axis=-1
    )
    pixels = arrange(profile, "derivative", ours).astype(float)
    surface = arrange(profile, "vector", displacement(frame)).astype(float)
    for got, expected in (
        (pixels[..., :2], gradient(name, surface[..., 3 - first - second])),
        (pixels[..., 2], gradient(name, surface[..., first])[0]),
        (pixels[..., 3], gradient(name, surface[..., second])[1]),
    ):
        assert (
            np.max(np.abs(got - np.stack(expected, axis=-1) if got.ndim == 3 else got - expected))
            < 2e-6
        )


@everywhere
def test_stretch_is_the_gradient_of_the_displacement_map(frame, name):
    """
    Along the engine's own two axes, from the displacement file's pixels: shear included, and the
    same either way round.
    """
    profile, (first, second) = PROFILES[name], ENGINES[name].flat
    ours = frame.choppiness * np.stack(
        [frame.stretch_xx, frame.stretch_xy, frame.stretch_yy], axis=-1
    )
    pixels = arrange(profile, "stretch", ours).astype(float)
    surface = arrange(profile, "vector", displacement(frame)).astype(float)
    (xx, xy), (yx, yy) = gradient(name, surface[..., first]), gradient(name, surface[..., second])
    for channel, expected in ((0, xx), (1, xy), (1, yx), (2, yy)):
        assert np.max(np.abs(pixels[..., channel] - expected)) < 2e-6
    assert np.std(pixels[..., 1]) > 0.01


@everywhere
def test_covariance_is_of_the_slopes_as_they_stand_in_the_file(frame, name):
    ours = np.stack([frame.slope_x**2, frame.slope_x * frame.slope_y, frame.slope_y**2], axis=-1)
    zero = np.zeros_like(frame.slope_x)
    slopes = arrange(
        PROFILES[name], "derivative", np.stack([frame.slope_x, frame.slope_y, zero, zero], axis=-1)
    ).astype(float)
    pixels = arrange(PROFILES[name], "covariance", ours)
    for channel, (a, b) in enumerate(((0, 0), (0, 1), (1, 1))):
        assert np.max(np.abs(pixels[..., channel] - slopes[..., a] * slopes[..., b])) < 1e-7


@everywhere
def test_a_flat_sea_points_exactly_up(name):
    flat = np.zeros((5, 4, 3), dtype=np.float32)
    assert not arrange(PROFILES[name], "vector", flat).any()
    flat[..., 2] = 1.0
    stored = arrange(PROFILES[name], "normal", flat).astype(
        np.float16
    )  # halves: no rounding either
    decoded = 2 * stored.astype(np.float32) - 1 if ENGINES[name].packed else stored
    assert np.all(decoded == [0.0, 0.0, 1.0])


@everywhere
@pytest.mark.parametrize(
    "kind", ["scalar", "height", "vector", "normal", "derivative", "covariance", "stretch"]
)
def test_there_and_back(name, kind):
    """
    Bits in metres; in centimetres an ulp: one rounding there, one back; packed, c = (1 + n) / 2
    rounds by 2^-25.
    """
    profile, count = PROFILES[name], CHANNELS.get(kind, 1)
    ours = np.random.default_rng(2).uniform(-1, 1, (7, 5, count)).astype(np.float32)
    back = restore(profile, kind, arrange(profile, kind, ours))
    assert back.dtype == np.float32
    assert back.flags.c_contiguous
    if profile.unit == "cm" and kind in ("vector", "height"):
        assert np.all(np.abs(back - ours) <= np.spacing(np.abs(ours)))
        assert unit_in(profile, kind, "m") == "cm"
    elif kind == "normal" and ENGINES[name].packed:
        assert np.max(np.abs(back - ours)) <= 2.0**-24
    else:
        assert back.tobytes() == ours.tobytes()
        assert unit_in(profile, kind, "m") == "m"


def test_other_numbers_and_layouts_are_the_same_map():
    """float64 is rounded once, half is widened, and a view is as good as a copy."""
    rng = np.random.default_rng(4)
    ours = rng.standard_normal((6, 8, 3))
    for profile in PROFILES.values():
        assert np.array_equal(
            arrange(profile, "normal", ours), arrange(profile, "normal", ours.astype(np.float32))
        )
        half = ours.astype(np.float16)
        assert np.array_equal(
            restore(profile, "vector", half), restore(profile, "vector", half.astype(np.float32))
        )
        view = np.asfortranarray(ours)[::2, ::-1]
        assert np.array_equal(
            arrange(profile, "vector", view), arrange(profile, "vector", view.copy())
        )


def test_heights_in_centimetres_are_rounded_once():
    ours = np.random.default_rng(5).standard_normal((9, 9, 1))
    assert np.array_equal(
        arrange(PROFILES["unreal"], "height", ours), (100.0 * ours[::-1]).astype(np.float32)
    )


@everywhere
def test_a_profile_says_what_it_is(name):
    """The words of the manifest against the engine's own facts."""
    engine, said = ENGINES[name], rules.conventions(PROFILES[name])
    words = {EAST: "east", NORTH: "north", SOUTH: "south", UP: "up"}
    assert said["profile"] == name
    assert said["axes"].startswith(
        ", ".join(f"{c} {words[axis]}" for c, axis in zip("XYZ", engine.world, strict=True))
    )
    assert ("left-handed" in said["axes"]) == (name in LEFT_HANDED)
    assert said["unit"] == {1.0: "m", 100.0: "cm"}[engine.per_metre]
    assert said["rows"].endswith(f"the loader puts it at v = {engine.row0_v}")
    assert said["normal_green"].startswith(
        "up (toward row 0)" if engine.green_up else "down (away from row 0)"
    )
    assert said["normals"] == ("packed: n = 2 c - 1" if engine.packed else "signed: n = c")


def test_three_by_its_own_loader_is_another_file():
    assert profile_for("three", "bin").name == "three"
    assert profile_for("three", "exr").name == "three-exr"
    assert profile_for("babylon", "bin").first_row == "south"
    assert profile_for("babylon", "exr").first_row == "north"


def test_the_encoding_of_normals_is_the_engines_or_the_one_that_is_chosen():
    assert profile_for("three", "bin").normals == "packed"
    assert profile_for("canonical", "bin").normals == "signed"
    assert profile_for("three", "bin", "signed").normals == "signed"
    assert profile_for("canonical", "bin", "packed").normals == "packed"


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (("cryengine", "exr"), r"engine must be one of canonical, blender, .* got 'cryengine'"),
        (("unity", "jpeg"), r"format must be one of exr, .* got 'jpeg'"),
        (
            ("unity", "exr", "octahedral"),
            "normals must be one of engine, signed, packed, got 'octahedral'",
        ),
        (
            ("godot", "png16"),
            "engine godot cannot use format png16: it reads PNG with 8 bits; choose format exr",
        ),
    ],
)
def test_what_no_engine_has_is_refused(asked, message):
    with pytest.raises(ParameterError, match=message):
        profile_for(*asked)


def test_channels_in_words():
    names = ("x, choppiness applied", "y, choppiness applied", "height")
    assert meaning(PROFILES["canonical"], "vector", names) == names
    assert meaning(PROFILES["godot"], "vector", names) == (
        names[0],
        "height",
        "minus (y, choppiness applied)",
    )
    assert meaning(PROFILES["unreal"], "derivative", ("a", "b", "c", "d")) == (
        "a",
        "minus (b)",
        "c",
        "d",
    )
    assert meaning(PROFILES["houdini"], "normal", ("x", "y", "z")) == (
        "(1 + x) / 2",
        "(1 - y) / 2",
        "(1 + z) / 2",
    )
    assert meaning(PROFILES["canonical"], "normal", ("x", "y", "z")) == ("x", "y", "z")
    assert meaning(PROFILES["unreal"], "height", ("height",)) == ("height",)
    assert unit_in(PROFILES["unreal"], "vector", "m/s") == "cm/s"
    assert unit_in(PROFILES["unreal"], "normal", "1") == "1"


@pytest.mark.parametrize("kind", list(CHANNELS))
def test_a_kind_has_its_number_of_channels(kind):
    profile = PROFILES["canonical"]
    with pytest.raises(
        ParameterError, match=f"a {kind} map must have {CHANNELS[kind]} channels, got 2"
    ):
        arrange(profile, kind, np.zeros((2, 2, 2)))
    with pytest.raises(
        ParameterError, match=f"a {kind} map must have {CHANNELS[kind]} channels, got 2"
    ):
        meaning(profile, kind, ("a", "b"))
    with pytest.raises(ParameterError, match=r"\(rows, columns, channels\), got shape \(2, 2\)"):
        restore(profile, kind, np.zeros((2, 2)))
    with pytest.raises(ParameterError, match="kind must be one of scalar"):
        arrange(profile, "colour", np.zeros((2, 2, 3)))


@pytest.mark.parametrize(
    "bent",
    [
        {"axes": ("+x", "+z", "+y")},
        {"first_row": "south"},
        {"unit": "m"},
        {"axes": ("+x", "+y", "+z")},
        {"axes": ("-x", "-y", "+z")},
    ],
)
def test_one_setting_bent_is_seen(frame, bent, monkeypatch):
    """The test above is no formality: every single wrong entry of Unreal's row fails it."""
    monkeypatch.setitem(PROFILES, "unreal", dataclasses.replace(PROFILES["unreal"], **bent))
    with pytest.raises(AssertionError):
        test_every_texel_is_the_water_that_is_there(frame, "unreal")


def test_green_bent_is_seen(frame, monkeypatch):
    monkeypatch.setitem(PROFILES, "houdini", dataclasses.replace(PROFILES["houdini"], green=-1))
    with pytest.raises(AssertionError):
        test_normals_are_those_of_the_displaced_surface(frame, "houdini")
