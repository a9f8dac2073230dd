"""
The Godot 4 project: its scripts parsed and linted; reader, bakes, buoy and shaders in Godot 4.6,
the web build, which has no compute shaders; and what it would give to the kernels.
"""

import base64
import json
import re
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from lookups import baked
from pck import pack
from test_three_project import expected_at, pixels_of, samples
from water import FRAMES, LOOP, N, half_step, truth

import fftocean as fo
from fftocean.example_projects import project_files
from fftocean.runtime.folder import read_package

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests" / "runtime"))
from kernel_layout import Foam, Layout, tables  # noqa: E402

PROJECT = ROOT / "examples" / "godot4"
HERE = Path(__file__).resolve().parent / "godot_project"
SCRIPTS = sorted(PROJECT.glob("*.gd"))
MODES = [(1, 0, 0.30, 0.2), (2, -1, 0.18, 1.1), (-1, 2, 0.12, 2.5), (5, 3, 0.05, 0.7)]
SEA = {"n": (32, 16), "size": (50.0, 20.0), "depth": 12.0, "loop": 20.0}
FOAM_CELL, FOAM_SIDE = 0.4, 512


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_a_script_parses_and_is_clean(script):
    """gdtoolkit's parser and linter find nothing."""
    linter = pytest.importorskip("gdtoolkit.linter")
    code = script.read_text(encoding="utf-8")
    found = linter.lint_code(code, linter.DEFAULT_CONFIG)
    assert not found, found


def test_scenes_and_scripts_name_files_of_their_own_folder():
    """
    Resources are named relative to their scene or script, so that the folder can lie anywhere in a
    project; and no class has a global name, so that two bakes can lie in one project.
    """
    names = set(project_files("godot4"))
    for file in [*PROJECT.glob("*.tscn"), *SCRIPTS, *PROJECT.glob("*.gdshader*")]:
        text = file.read_text(encoding="utf-8")
        found = re.findall(r'(?:path=|preload\(|#include )"([^"]+)"', text)
        assert set(found) <= names, file.name
        assert "class_name" not in text


def probe(include, body, output):
    """
    Return a canvas shader that writes the bits of four numbers of an include's functions at places.
    """
    return f"""shader_type canvas_item;
render_mode unshaded, blend_disabled;
#include "{include}"
uniform sampler2D places : filter_nearest;
void fragment() {{
	ivec2 pixel = ivec2(floor(UV * vec2(float(textureSize(places, 0).x), 8.0)));
	vec2 rest = texelFetch(places, ivec2(pixel.x, 0), 0).xy;
	vec2 slope;
	vec3 stretch;
	{body}
	vec4 seen = {output};
	uint bits = floatBitsToUint(seen[pixel.y / 2]);
	uint part = pixel.y % 2 == 0 ? bits & 65535u : bits >> 16u;
	COLOR = vec4(float(part & 255u) / 255.0, float(part >> 8u) / 255.0, 0.0, 1.0);
}}
"""


def seen_in(text, count):
    """Return the four numbers of each place that a probe wrote."""
    pixels = np.frombuffer(base64.b64decode(text), np.uint8).reshape(8, count, 4).astype(np.uint32)
    halves = pixels[..., 0] | pixels[..., 1] << 8
    bits = halves[0::2] | halves[1::2] << 16
    return bits.astype("<u4").view("<f4").astype(float).T


BAKE = "res://bake/sea_bake_maps.gdshaderinc"
LIVE = "res://live/sea_strongest_maps.gdshaderinc"
MAPS = "res://live/sea_water_maps.gdshaderinc"
OUTPUTS = ("vec4(moved, slope.x)", "vec4(slope.y, stretch)")
BODIES = {
    BAKE: "vec3 moved = summed_displacement(rest, 0.0); summed_slopes(rest, 0.0, slope, stretch);",
    LIVE: "vec3 moved = summed(rest, 0.0, slope, stretch);",
    MAPS: "vec3 moved = summed_displacement(rest, 0.0); float variance; "
    "summed_slopes(rest, slope, stretch, variance);",
}


def probes(include):
    """Return both probes of an include's sums."""
    return {str(i): probe(include, BODIES[include], output) for i, output in enumerate(OUTPUTS)}


def fields_of(frame, choppiness):
    """Return the fields of a frame by the names of `truth`."""
    found = {axis: choppiness * getattr(frame, f"displace_{axis}") for axis in "xy"}
    found |= {f"slope_{axis}": getattr(frame, f"slope_{axis}") for axis in "xy"}
    pairs = ("xx", "xy", "yy")
    found |= {f"stretch_{pair}": choppiness * getattr(frame, f"stretch_{pair}") for pair in pairs}
    return {**found, "z": frame.height}


def all_at(fields, j, i):
    """Return X, Y, Z, slopes along X and Z, stretches XX, ZZ and XZ at samples."""
    first = expected_at(fields, j, i)
    return np.column_stack([first, fields["stretch_yy"][j, i], -fields["stretch_xy"][j, i]])


@pytest.fixture(scope="module")
def godot(browser, tmp_path_factory):
    """Run a bake, a package and the layout of the kernels' buffers once; return all answers."""
    site = browser.site.folders["bakes"]
    asked, folder = baked(
        browser, "godot", "bin", ("displacement", "derivative", "stretch"), "project"
    )
    ocean = fo.Ocean.from_modes(MODES, dtype="float64", **SEA)
    package = tmp_path_factory.mktemp("package") / "sea"
    document = fo.export_sea(ocean, package, engine="godot")
    files = {file.name: file.read_bytes() for file in HERE.iterdir()}
    for name, place in (("bake", folder), ("live", package)):
        files |= {
            f"{name}/{file.relative_to(place).as_posix()}": file.read_bytes()
            for file in place.rglob("*")
            if file.is_file() and file.suffix not in (".png", ".webp", ".import")
        }
    size = asked.settings["ocean.size"]
    rests, j, i = samples(N, size)
    places = np.column_stack([rests, np.zeros((len(rests), 2))])
    maps = np.moveaxis(np.random.default_rng(4).normal(size=(3, N[1], N[0], 4)), 0, 0)
    maps = maps.astype("<f4")
    tile = [1 / size[0], 1 / size[1], 0.5 / N[0], 0.5 / N[1]]
    names = ("displacement_0", "slopes_0", "moments_0")
    code = {
        f"maps {key}": {
            "code": text,
            "maps": {
                name: base64.b64encode(values.tobytes()).decode()
                for name, values in zip(names, maps, strict=True)
            },
            "size": N,
            "tile": tile,
            "places": places.ravel().tolist(),
        }
        for key, text in probes(MAPS).items()
    }
    scene = {"points": rests[:40].tolist(), "places": places.ravel().tolist()}
    ask = {
        "scenes": {
            "bake": {
                **scene,
                "path": "res://bake/sea_bake.tscn",
                "time": 1.5 * LOOP / FRAMES,
                "probes": probes(BAKE),
                "picture": [160, 100],
            },
            "live": {
                **scene,
                "path": "res://live/sea.tscn",
                "time": SEA["loop"] / 4,
                "probes": probes(LIVE),
                "picture": [1, 1],
            },
        },
        "textures": code,
        "compute": {"tick": 12345, "seconds": 0.02, "about": [31.0, -12.3]},
    }
    files["ask.json"] = json.dumps(ask).encode()
    (site / "godot-project.pck").write_bytes(pack(files))
    value, _ = browser.run("godot.html", {"pack": "/bakes/godot-project.pck"})
    assert not [line for line in value["errors"] if "SHADER ERROR" in line], value["errors"]
    return {
        "answers": value["answers"],
        "places": (rests, j, i),
        "baked": truth(asked),
        "ocean": ocean,
        "document": document,
        "package": package,
        "maps": maps,
    }


@pytest.mark.client
def test_a_bake_plays_in_its_scene(godot):
    """
    Half-way between two frames, at every sample and the same some tiles away: the sums of the
    scene's own shader, and `rest_at` for things that float, to the rounding of a half.
    """
    rests, j, i = godot["places"]
    water = godot["baked"]
    middle = {key: 0.5 * (values[1] + values[2]) for key, values in water.items()}
    shear = {"stretch_xy": np.zeros(middle["z"].shape)}
    expected = all_at({**shear, **middle}, j, i)
    answers = godot["answers"]
    found = np.column_stack([seen_in(answers[f"bake {key}"], len(rests)) for key in "01"])
    allowed = half_step(np.abs(expected).max(axis=0)) + 1e-3 * np.ptp(expected, axis=0)
    assert np.all(np.abs(found - expected)[:, :7] <= allowed[:7])
    assert np.ptp(found[:, 7]) > 0.01  # the shear: compared in the test of the maps below
    rests_found = np.array(answers["bake rests"])
    assert np.all(np.abs(rests_found - expected[:40, :3]) <= allowed[:3])


@pytest.mark.client
def test_the_scene_shows_sky_water_and_a_buoy(godot):
    """A sky brighter than the water, waves, and yellow paint in the middle."""
    seen = pixels_of(base64.b64decode(godot["answers"]["bake picture"]))
    sky, water = seen[:10], seen[70:]
    assert sky.mean() > water.mean() + 40
    assert water.std() > 5
    red, green, blue = np.moveaxis(seen[20:85, 60:100], -1, 0)
    assert np.count_nonzero((red > 90) & (green > 70) & (blue < 0.5 * green)) > 3


@pytest.mark.client
def test_the_strongest_waves_are_those_of_the_package(godot):
    """
    A sea of fewer waves than are summed is exact: the shader's sums and `rest_at` at samples, and
    heights at points of the world as `fo.Query` finds them.
    """
    rests, j, i = godot["places"]
    ocean, answers = godot["ocean"], godot["answers"]
    expected = all_at(fields_of(ocean.loop_frame(1, 4), ocean.choppiness), j, i)
    found = np.column_stack([seen_in(answers[f"live {key}"], len(rests)) for key in "01"])
    # single precision of a phase some tiles away
    assert np.abs(found - expected).max() <= 2e-4 * np.abs(expected).max()
    assert np.abs(np.array(answers["live rests"]) - expected[:40, :3]).max() <= 1e-6
    query = fo.Query(ocean, mode="exact", level="frame").at(
        rests[:40, 0], -rests[:40, 1], SEA["loop"] / 4
    )
    assert np.abs(np.array(answers["live heights"]) - query.heights).max() <= 5e-3


@pytest.mark.client
def test_maps_of_the_kernels_are_turned_into_godots_axes(godot):
    """x east, y north, row 0 south become X, Y up and Z south: any numbers, at every sample."""
    rests, j, i = godot["places"]
    place, slopes, _ = godot["maps"].astype(float)
    names = {"x": place[..., 0], "y": place[..., 1], "z": place[..., 2]}
    names |= {"slope_x": slopes[..., 0], "slope_y": slopes[..., 1], "stretch_xy": place[..., 3]}
    expected = all_at({**names, "stretch_xx": slopes[..., 2], "stretch_yy": slopes[..., 3]}, j, i)
    found = [seen_in(godot["answers"][f"maps {key}"], len(rests)) for key in "01"]
    # single precision of u some tiles away: 1e-4 of a texel
    assert np.abs(np.column_stack(found) - expected).max() <= 1e-3


@pytest.mark.client
def test_the_kernels_would_get_the_bytes_that_their_page_asks_for(godot):
    """
    The uniform block, the tables of waves, the bindings and the numbers of groups of
    sea_compute.gd, by the layout that the tests of the kernels run.
    """
    answers, document = godot["answers"], godot["document"]
    assert answers["compute error"] == ""
    package = read_package(godot["package"])
    h0, wave = tables(package)
    assert base64.b64decode(answers["h0"]) == h0.astype("<f4").tobytes()
    found = np.frombuffer(base64.b64decode(answers["wave"]), "<f4").reshape(-1, 2)
    there = wave[:, 0] > 0  # elsewhere there is no wave, and its factor is of no account
    assert np.array_equal(found[:, 0], wave[:, 0])
    assert np.allclose(found[there], wave[there], rtol=1e-6)
    layout = Layout(document, [], FOAM_SIDE)
    corner = [int(np.floor(a / FOAM_CELL)) - FOAM_SIDE // 2 for a in (31.0, -12.3)]
    foam = Foam(
        side=FOAM_SIDE,
        cell=FOAM_CELL,
        decay=document["foam"]["decay"],
        threshold=document["foam"]["threshold"],
        strength=document["foam"]["strength"],
        seconds=0.02,
        corner=tuple(corner),
        corner_place=tuple((c + 0.5) * FOAM_CELL for c in corner),
    )
    block = layout.block(12345, foam=foam)
    seen = base64.b64decode(answers["block"])
    assert len(seen) == len(block)
    for at in range(0, len(block), 4):
        whole = struct.unpack_from("<I", seen, at) == struct.unpack_from("<I", block, at)
        real = np.isclose(*(struct.unpack_from("<f", b, at)[0] for b in (seen, block)), rtol=1e-6)
        assert whole or real, f"byte {at}"
    assert answers["groups"][0] == layout.groups()[0]
    assert answers["groups"][1] == max(FOAM_SIDE, *document["tiles"][0]["n"])


def test_bindings_are_those_of_the_kernels():
    """A set of uniforms must hold what the shader declares, no more and no less."""
    text = (PROJECT / "sea_compute.gd").read_text(encoding="utf-8")
    rows = dict(re.findall(r'^\t"(\w+)": \[([\d, ]+)\]', text, re.MULTILINE))
    assert len(rows) == 6
    for kernel, numbers in rows.items():
        source = ROOT / "fftocean" / "runtime" / "shaders" / f"fftocean_{kernel}.glsl"
        code = source.read_text(encoding="utf-8")
        declared = sorted(map(int, re.findall(r"binding = (\d+)", code)))
        assert declared == sorted(map(int, numbers.split(","))), kernel
        assert (PROJECT / f"fftocean_{kernel}.glsl.import").is_file()
