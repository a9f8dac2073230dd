"""
The recipe of docs/cascades.md, executed line by line on baked files, against a sum of all waves one
by one.
"""

import functools
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.baking.cascade import bake_tiles
from fftocean.export import formats

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
PAGE = Path(__file__).resolve().parents[1] / "docs" / "cascades.md"
TILES = [
    (64, 96.0),
    (60, 30.0),
    # 1.5 m and 0.5 m between samples: places 1.5 m apart are samples of both; 96 is no
    # multiple of 30
]
LOOP, FRAMES = 12.0, 72

# An engine by its own documents: its two horizontal axes and up as (our axis, sign), units in a
# metre, v of row 0 by its loader.
ENGINES = {
    "canonical": (((0, 1), (1, 1), (2, 1)), (0, 1, 2), 1.0, 1),
    "unity": (((0, 1), (2, 1), (1, 1)), (0, 2, 1), 1.0, 1),
    "unreal": (((0, 1), (1, -1), (2, 1)), (0, 1, 2), 100.0, 0),
    "godot": (((0, 1), (2, 1), (1, -1)), (0, 2, 1), 1.0, 0),
}


class Vector:
    """A GLSL vector of arrays."""

    def __init__(self, *parts):
        self.parts = list(parts)

    def __getattr__(self, letters):
        index = {
            **dict(zip("xyzw", range(4), strict=True)),
            **dict(zip("rgba", range(4), strict=True)),
        }
        found = [self.parts[index[letter]] for letter in letters]
        return found[0] if len(found) == 1 else Vector(*found)

    def __add__(self, other):
        return Vector(*(a + b for a, b in zip(self.parts, other.parts, strict=True)))


def length(v):
    return np.sqrt(sum(part * part for part in v.parts))


def normalize(v):
    return Vector(*(part / length(v) for part in v.parts))


def recipe():
    """
    The page's GLSL block as Python, by its syntax alone: types, semicolons, braces and comments.
    """
    (block,) = re.findall(r"```glsl\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    lines = []
    for line in block.splitlines():
        line = line.split("//")[0].rstrip().rstrip(";")
        line = re.sub(r"^(\s*)(?:float|vec[234]) (?=\w+ =)", r"\1", line)
        line = re.sub(
            r"for \(int (\w+) = 0; \1 < (\w+); \1\+\+\) \{", r"for \1 in range(\2):", line
        )
        lines.append("" if line.strip() == "}" else line)
    return compile("\n".join(lines), "recipe", "exec")


@functools.cache
def files_of(folder, tile, name, j):
    """A frame of a map as the file has it."""
    data = (folder / f"tile{tile}" / name / f"{j:04d}.exr").read_bytes()
    n, channels = TILES[tile][0], {"displacement": 3, "derivative": 4, "stretch": 3}[name]
    return formats.decode("exr-float", data, shape=(n, n, channels)).astype(float)


def sampler(row0_v):
    """`texture` of an engine: bilinear and repeated, row 0 at the v where its loader puts it."""

    def texture(picture, uv):
        rows, columns, channels = picture.shape
        column, row = uv.x * columns - 0.5, (uv.y if row0_v == 0 else 1.0 - uv.y) * rows - 0.5
        i, j = (
            np.floor(column + 1e-9).astype(int),
            np.floor(row + 1e-9).astype(int),
        )  # exact at a texel's middle, whatever the last bit
        f, g = np.clip(column - i, 0.0, 1.0)[:, None], np.clip(row - j, 0.0, 1.0)[:, None]
        texel = lambda b, a: picture[b % rows, a % columns]  # noqa: E731
        low = texel(j, i) * (1 - f) + texel(j, i + 1) * f
        high = texel(j + 1, i) * (1 - f) + texel(j + 1, i + 1) * f
        mixed = low * (1 - g) + high * g
        return Vector(*(mixed[:, c] for c in range(channels)))

    return texture


@pytest.fixture(scope="module")
def baked(tmp_path_factory):
    """The sea in four engines' frames, and its cascade in double precision."""
    made = {}
    job = fo.Job.default().replaced(
        {
            "ocean.loop": LOOP,
            "ocean.choppiness": 1.2,
            "ocean.seed": 5,
            "bake.frames": FRAMES,
            "bake.format": "exr-float",
            "bake.foam.threshold": 0.72,  # much foam, so that its error is seen
            "bake.pictures": [],
            "sea.wind.speed": 9.0,
            "sea.wind.direction": 40.0,
        }
    )
    for engine in ENGINES:
        made[engine] = tmp_path_factory.mktemp(engine) / "sea"
        some = None if engine == "godot" else "7:8"
        bake_tiles(
            job.replaced({"bake.engine": engine}),
            TILES,
            made[engine],
            frames=some,
            executor="serial",
        )
    cascade = fo.Cascade(job.sea(), TILES, seed=5, loop=LOOP, choppiness=1.2, dtype="float64")
    return made, cascade


def summed(cascade, x, y, t):
    """
    Displacement, slopes, stretches of the summed water, our axes, choppiness applied: every wave of
    every tile, deep water.
    """
    w = cascade.modes()
    k, c = np.hypot(w.kx, w.ky), cascade.choppiness
    phase = np.outer(x, w.kx) + np.outer(y, w.ky) - w.omega * t - w.phase
    wave, turned = np.cos(phase), np.sin(phase)
    along, across = w.kx / k, w.ky / k
    displacement = [
        -c * turned @ (w.amplitude * along),
        -c * turned @ (w.amplitude * across),
        wave @ w.amplitude,
    ]
    slopes = [-turned @ (w.amplitude * w.kx), -turned @ (w.amplitude * w.ky)]
    stretch = [
        -c * wave @ (w.amplitude * part) for part in (w.kx * along, w.kx * across, w.ky * across)
    ]
    return np.array(displacement), np.array(slopes), np.array(stretch)


def run(folder, engine, j, x, y, **known):
    """Run the recipe at undisplaced places of ours, and return its names."""
    world, (first, second, _), unit, row0_v = ENGINES[engine]
    ours = (x, y)
    p = [world[axis][1] * ours[world[axis][0]] * unit for axis in (first, second)]
    listed = json.loads((folder / "cascade.json").read_text())

    def place(p, i):
        """A sample's texel lies half a texel east of its place, and half a texel north of it."""
        n, size = listed["tiles"][i]["n"], listed["tiles"][i]["size"]
        north = world[second][1]  # of the second axis
        v = p[1] / unit / size[1] + north * 0.5 / n[1]  # grows along the second axis
        points_up = (
            row0_v == 1
        )  # row 0 is north in all four: v grows northward where row 0 is at v = 1
        return Vector(p[0] / unit / size[0] + 0.5 / n[0], v if points_up == (north > 0) else -v)

    names = {
        "p": p,
        "place": place,
        "TILES": len(listed["tiles"]),
        "texture": sampler(row0_v),
        "normalize": normalize,
        "length": length,
        "vec2": Vector,
        "vec3": Vector,
        "exp": np.exp,
        "max": np.maximum,
        "foam": 0.0,
        "dt": LOOP / FRAMES,
        **listed["foam"],
        **known,
    }
    for name in ("displacement", "derivative", "stretch"):
        names[name] = [files_of(folder, i, name, j) for i in range(len(TILES))]
    exec(recipe(), names)
    return names


def places():
    rng = np.random.default_rng(3)
    return 1.5 * rng.integers(-200, 200, 150), 1.5 * rng.integers(-200, 200, 150)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_recipe_is_the_summed_water(baked, engine):
    """
    In each engine's own axes and unit; float32 files of some metres and slopes of a tenth: 2e-6.
    """
    folders, cascade = baked
    world, (first, second, up), unit, _ = ENGINES[engine]
    x, y = places()
    got = run(folders[engine], engine, 7, x, y)
    displacement, slopes, stretch = summed(cascade, x, y, LOOP * 7 / FRAMES)
    for c, (axis, sign) in enumerate(world):
        assert np.allclose(got["D"].parts[c], sign * unit * displacement[axis], atol=3e-6 * unit), (
            engine
        )
    along, across = (
        np.array(part)
        for part in (
            (1 + stretch[0], stretch[1], slopes[0]),
            (stretch[1], 1 + stretch[2], slopes[1]),
        )
    )
    normal = np.cross(along.T, across.T)
    assert np.allclose(got["jacobian"], normal[:, 2], atol=3e-6)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    for part, axis in zip(got["normal"].parts, (first, second, up), strict=True):
        ours, sign = world[axis]
        assert np.allclose(part, sign * normal[:, ours], atol=3e-6), engine
    deformation = np.moveaxis(
        np.array([[1 + stretch[0], stretch[1]], [stretch[1], 1 + stretch[2]]]), -1, 0
    )
    assert np.allclose(got["eigenvalue"], np.linalg.eigvalsh(deformation)[:, 0], atol=3e-6)
    assert np.std(stretch[1]) > 0.02  # with a shear that would be missed


def test_the_recipe_s_normal_is_that_of_a_query(baked):
    """`fo.Query` finds the water at the displaced places; its normal there is the recipe's."""
    folders, cascade = baked
    x, y = places()
    got = run(folders["canonical"], "canonical", 7, x, y)
    found = fo.Query(cascade, mode="exact", level="frame").at(
        x + got["D"].x, y + got["D"].y, LOOP * 7 / FRAMES, fields=("heights", "normals")
    )
    calm = ~found.folded & (np.hypot(found.x0 - x, found.y0 - y) < 1e-3)
    assert np.mean(calm) > 0.9
    assert np.allclose(np.stack(got["normal"].parts, -1)[calm], found.normals[calm], atol=2e-4)
    assert np.allclose(got["D"].z[calm], found.heights[calm], atol=2e-4)


def test_the_recipe_s_foam_is_that_of_the_sum(baked):
    """
    Two turns of the loop from clean water, against `fo.Foam` on the summed water.

    Steps of a sixth of a second miss crests in between: 5 % of the mean. The foam that the tiles
    would have on their own is less than half of it.
    """
    folders, cascade = baked
    x, y = (part[:40] for part in places())
    foam, seen = 0.0, []
    for j in range(3 * FRAMES):
        got = run(folders["godot"], "godot", j % FRAMES, x, y, foam=foam)
        foam = got["foam"]
        if j >= 2 * FRAMES:
            seen.append(got["coverage"])
    settings = json.loads((folders["godot"] / "cascade.json").read_text())["foam"]
    truth = exact_foam(cascade, x, y, settings)
    assert np.mean(truth) > 0.02
    assert np.mean(seen) == pytest.approx(np.mean(truth), rel=0.05)
    foam = fo.Foam(**{name: settings[name] for name in ("tau", "threshold", "strength")})
    alone = [np.mean([cover.mean() for cover in foam.loop(ocean, 24)]) for ocean in cascade.oceans]
    assert sum(alone) < 0.5 * np.mean(truth)


def exact_foam(cascade, x, y, settings):
    """
    Coverage over the loop, (times, places): the integral over all the past, 600 rectangles a loop.
    """
    dense = 600
    times = np.arange(dense) * (LOOP / dense)
    eigenvalues = []
    for t in times:
        xx, xy, yy = summed(cascade, x, y, t)[2]
        eigenvalues.append(1 + 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy))
    source = settings["strength"] * np.maximum(settings["threshold"] - np.array(eigenvalues), 0.0)
    memory = np.exp(-times / settings["tau"]) / (1.0 - math.exp(-LOOP / settings["tau"]))
    made = np.fft.ifft(np.fft.fft(source, axis=0) * np.fft.fft(memory)[:, None], axis=0).real * (
        LOOP / dense
    )
    return 1.0 - np.exp(-made)
