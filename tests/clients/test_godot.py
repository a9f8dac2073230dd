"""
Godot 4.6, its web build in a browser: the GDScript reader, a Texture2DArray in a shader, and a
normal map in its stock material.
"""

import base64
import json
import re
from pathlib import Path

import numpy as np
import pytest
from heights import heights_bake, questions
from lookups import Lookup, baked, on_screen, require_equal
from pck import pack
from water import FRAMES, LOOP, OBLONG, SQUARE, N, Text, between, half_step, places, steepest, truth

pytestmark = pytest.mark.client

HERE = Path(__file__).resolve().parent
READER = HERE.parents[1] / "examples" / "readers" / "sea_heights.gd"
MAPS = ("displacement", "derivative", "normal")
FRAME = 3


def shader(said, meaning):
    """
    Return a canvas shader for the bits of up to four formulas of a map, looked up by the sidecar's,
    as bytes of an image.
    """
    real = lambda text: re.sub(r"(?<![\w.])(\d+)(?![\w.])", r"\1.0", text)  # noqa: E731
    numbers = "".join(
        f"const float {name} = {float(number)!r};\n"
        for name, number in said.sampling["values"].items()
    )
    given = [real(text) for text in meaning] + ["0.0"] * (4 - len(meaning))
    return f"""shader_type canvas_item;
render_mode unshaded, blend_disabled;
uniform sampler2DArray map : repeat_enable, filter_linear;
uniform sampler2D places : filter_nearest;
{numbers}
vec4 means(vec4 texel) {{
	float R = texel.r; float G = texel.g; float B = texel.b; float A = texel.a;
	return vec4({", ".join(given)});
}}
void fragment() {{
	ivec2 pixel = ivec2(floor(UV * vec2(vec2(float(textureSize(places, 0).x), 8.0))));
	vec4 place = texelFetch(places, ivec2(pixel.x, 0), 0);
	float X = place.x; float Y = place.y; float Z = place.z; float time = place.w;
	float u = {real(said.sampling["u"])};
	float v = {real(said.sampling["v"])};
	float frame = {real(said.sampling["frame"])};
	vec4 seen = means(textureLod(map, vec3(u, v, floor(frame + 0.5)), 0.0));
	uint bits = floatBitsToUint(seen[pixel.y / 2]);
	uint part = pixel.y % 2 == 0 ? bits & 65535u : bits >> 16u;
	COLOR = vec4(float(part & 255u) / 255.0, float(part >> 8u) / 255.0, 0.0, 1.0);
}}
"""


@pytest.fixture(scope="module")
def godot(browser):
    """
    Run the project once on all bakes; return its answers, its errors, and the expected values.
    """
    site = browser.site.folders["bakes"]
    said, heights = heights_bake("godot", site / "godot-heights")
    points, expected, tolerance = questions(said, heights)
    asked, folder = baked(browser, "godot", "bin", MAPS, "sea")
    files = {
        name: (HERE / "godot" / name).read_bytes()
        for name in ("project.godot", "main.tscn", "main.gd")
    }
    files["sea_heights.gd"] = READER.read_bytes()
    files |= {
        f"sea/{file}": (site / "godot-heights" / file).read_bytes()
        for file in ("height.json", "height.bin")
    }
    files["sea/other.json"] = json.dumps(
        {**json.loads(files["sea/height.json"]), "lookup": "lagrangian"}
    ).encode()
    files |= {
        f"sea/{m}.{end}": (folder / f"{m}.{end}").read_bytes()
        for m in MAPS
        for end in ("json", "bin")
    }
    for sea, wind in (("flat", 0.0), ("sea", 7.0)):
        steep, one = baked(
            browser,
            "godot",
            "bin",
            ["normal"],
            sea + "-lit",
            ocean__size=SQUARE,
            sea__wind__speed=wind,
        )
        files |= {
            f"sea/normal_{sea}.{end}": (one / f"normal.{end}").read_bytes()
            for end in ("json", "bin")
        }
    x, y, exact = places()
    water, shaders, lookups = truth(asked), {}, {}
    for name in MAPS:
        text = Text.of(folder, name)
        keys = sorted(
            key for key in text.meaning if name != "derivative" or not key.startswith("normal")
        )
        shaders[name] = shader(text, [text.meaning[key] for key in keys])
        fields = np.stack([text.expected(water, key) for key in keys], axis=-1)
        packed = name == "normal" and "packed" in text.conventions["normals"]
        rounding = half_step(0.5) if packed else 0.5 * half_step(np.abs(fields).max())
        # weights of a filter: fractions of 8 bits or more along each axis; at samples, single
        # precision of u some tiles away
        allowed = rounding + np.where(exact, 1e-4, 2 / 256)[:, None] * steepest(fields)
        lookups[name] = keys, between(fields[FRAME], x, y, OBLONG), allowed
    rows = np.concatenate(
        [text.world(x, y), np.full((x.size, 1), FRAME * LOOP / FRAMES + 2 * LOOP)], axis=1
    )
    ask = {"points": points.tolist(), "places": rows.ravel().tolist(), "maps": shaders}
    files["ask.json"] = json.dumps(ask).encode()
    (site / "godot.pck").write_bytes(pack(files))
    value, _ = browser.run("godot.html", {"pack": "/bakes/godot.pck"})
    waves = truth(steep)
    normals = np.stack([waves[f"normal_{axis}"][0] for axis in "xyz"], axis=-1)
    return (
        value["answers"],
        value["errors"],
        {"normals": normals, "heights": (expected, tolerance), "lookups": lookups, "said": text},
    )


def test_the_reader_finds_the_water_and_refuses_what_it_does_not_understand(godot):
    """
    Heights at samples, between them, outside the tile and the loop; and a sidecar of another lookup
    gives none.
    """
    answers, errors, must = godot
    expected, tolerance = must["heights"]
    found = np.array(answers["heights"])
    print(
        f"Godot {answers['version']}: largest {np.abs(found - expected).max():.3g} m, "
        f"allowed {tolerance:.3g} m"
    )
    assert np.abs(found - expected).max() <= tolerance
    assert answers["refused"] == ["lookup must be eulerian, got lagrangian", True]
    assert any("lookup must be eulerian" in error for error in errors)


@pytest.mark.parametrize("name", MAPS)
def test_a_texture_array_in_a_shader_is_the_water(godot, name):
    """
    At every sample, the same some tiles away, and between samples, the channels give what the
    formulas say they give.
    """
    answers, _, must = godot
    keys, expected, tolerance = must["lookups"][name]
    pixels = (
        np.frombuffer(base64.b64decode(answers[name]), np.uint8)
        .reshape(8, len(expected), 4)
        .astype(np.uint32)
    )
    halves = pixels[..., 0] | pixels[..., 1] << 8
    bits = halves[0::2] | halves[1::2] << 16
    seen = bits.astype("<u4").view("<f4").astype(float).T[:, : len(keys)]
    require_equal(Lookup(keys, seen, expected, tolerance))


def test_a_stock_material_lights_the_sea_by_its_normals(godot):
    """
    A flat sea looks as if it had no normal map, to one step of 8 bits; a steep one is as bright as
    its normals face the sun.

    The sun stands along (0.334, 0.717, 0.611), main.gd's rotation in radians. Highlights and 8 bits
    leave a correlation above 0.99; with one sign of the normals turned it would be about 0.
    """
    answers, _, must = godot
    pictures = {
        key[4:]: np.frombuffer(base64.b64decode(answers[key]), np.uint8).reshape(64, 64, 4)
        for key in answers
        if key.startswith("lit ")
    }
    still = pictures[""].astype(int)
    assert still[..., :3].min() > 20
    assert np.abs(pictures["normal_flat"].astype(int) - still).max() <= 1
    # the mesh's own uv: 0 to 1 from west to east, and from north to south
    v, u = (np.mgrid[0:64, 0:64].reshape(2, -1) + 0.5) / 64
    x, y = (u - 0.5 / N[0]) * SQUARE[0], -(v + 0.5 / N[1]) * SQUARE[1]
    normals = between(must["normals"], x, y, SQUARE)
    facing = normals / np.linalg.norm(normals, axis=-1, keepdims=True) @ [0.334, -0.611, 0.717]
    seen = pictures["normal_sea"][..., 0].ravel() / 255.0
    linear = np.where(seen <= 0.04045, seen / 12.92, ((seen + 0.055) / 1.055) ** 2.4)
    assert np.corrcoef(linear, facing)[0, 1] > 0.99
    for turned in ([-1, 1, 1], [1, -1, 1]):
        assert (
            np.corrcoef(linear, normals * turned @ [0.334, -0.611, 0.717])[0, 1] < 0.5
        )  # what must fail would fail


def test_the_axes_lie_on_the_screen_as_the_manifest_says(godot):
    """
    A right-handed frame with Y up: the engine's own camera puts the axes where "east" and "north"
    are.
    """
    answers, _, must = godot
    assert must["said"].handed == "right"
    on_screen(answers, must["said"])
