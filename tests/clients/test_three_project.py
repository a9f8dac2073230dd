"""
The three.js project in a browser: the waves of a package as the library has them, bakes in every
format, damaged files, and a picture.
"""

import contextlib
import shutil
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from lookups import baked
from water import FRAMES, LOOP, N, half_step, job, truth
from web import floats

import fftocean as fo
from fftocean.baking.cascade import bake_tiles
from fftocean.example_projects import project_files

pytestmark = pytest.mark.client

PARTS = (
    "build/three.module.js",
    "build/three.core.js",
    "examples/jsm/controls/OrbitControls.js",
    "examples/jsm/loaders/EXRLoader.js",
    "examples/jsm/libs/fflate.module.js",
    "examples/jsm/libs/ktx-parse.module.js",
)
"""Files of three.js that the project loads, as `npm install three` puts them."""
NAMES = ("displace_x", "displace_y", "height", "stretch_xy")
NAMES += ("slope_x", "slope_y", "stretch_xx", "stretch_yy")
FORMATS = ("bin", "ktx2", "exr", "exr-float", "exr-atlas")
MAPS = ("displacement", "derivative", "stretch", "foam")
OBLONG = {"n": (64, 32), "size": (80.0, 30.0)}
BASE64 = """const base64 = (floats) => {
  const bytes = new Uint8Array(floats.buffer, floats.byteOffset, floats.byteLength);
  let text = '';
  for (let i = 0; i < bytes.length; i += 4096)
    text += String.fromCharCode(...bytes.subarray(i, i + 4096));
  return btoa(text);
};"""


def with_three(folder, npm):
    """Put three.js into a folder, as npm does."""
    for part in PARTS:
        place = folder / "node_modules" / "three" / part
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(npm / "three" / part, place)


@contextlib.contextmanager
def opened(browser, folder, *, width=320, height=200):
    """Open the page of a folder, stopped; give it and what it says in place of a sea."""
    url = f"{browser.site.address}/bakes/{folder.name}/index.html?still"
    with browser.page(url, width=width, height=height) as page:
        said = page.until(
            "globalThis.page ? 'ready' : (text => text.startsWith('Loading') ? '' : text)"
            "(document.getElementById('message').textContent)"
        )
        yield page, said


def packed(browser, npm, name, water):
    """Export a package with the project beside it; return the folder and the document."""
    folder = browser.site.folders["bakes"] / f"three-project-{name}"
    document = fo.export_sea(water, folder, engine="three")
    with_three(folder, npm)
    return folder, document


@pytest.fixture(scope="module")
def seas():
    """Return an oblong ocean and a cascade, in double precision."""
    sea = fo.Sea.from_wind(speed=9.0, fetch=60e3, direction=30.0, depth=20.0)
    options = {"seed": 5, "loop": 32.0, "dtype": "float64"}
    return {
        "ocean": fo.Ocean(sea, **OBLONG, **options),
        "cascade": fo.Cascade(sea, [(64, 200.0), (32, 31.0)], **options),
    }


@pytest.mark.parametrize("name", ["ocean", "cascade"])
def test_the_fields_are_those_of_the_library(browser, npm, seas, name):
    """
    Each field of each tile at several ticks, rel. L2: 5e-7, as single precision gives it; and
    heights at points of the world, by all waves, as `fo.Query` finds them.
    """
    water = seas[name]
    folder, document = packed(browser, npm, name, water)
    ticks = document["ticks"]
    moments = [0, 1, ticks // 3, ticks - 1]
    tiles = getattr(water, "oceans", (water,))
    points = np.random.default_rng(3).uniform(-300.0, 300.0, (40, 2))
    with opened(browser, folder) as (page, said):
        assert said == "ready"
        found = page.evaluate(
            "(() => {" + BASE64 + f"const {{ simulation }} = page.sea, names = {list(NAMES)};"
            f"return {moments}.map((tick) => {{ simulation.update(tick);"
            "  return simulation.tiles.map((_, i) => { const fields = simulation.fields(i);"
            "    return names.map((name) => base64(fields[name])); }); }); })()"
        )
        heights = page.evaluate(
            "(() => { const Sum = page.sea.waves.constructor;"
            "const waves = new Sum(page.sea.package, Infinity);"
            f"return [waves.neglected, {points.tolist()}.map(([x, y]) => "
            f"waves.at(x, y, {moments[2]}).height)]; }})()"
        )
        assert page.evaluate("page.renderer.getContext().getError()") == 0
    worst = 0.0
    for tick, by_tile in zip(moments, found, strict=True):
        for tile, by_name in zip(tiles, by_tile, strict=True):
            frame = tile.loop_frame(tick, ticks, NAMES)
            for field, text in zip(NAMES, by_name, strict=True):
                expected = getattr(frame, field)
                seen = floats(text, *expected.shape)
                worst = max(worst, np.linalg.norm(seen - expected) / np.linalg.norm(expected))
    print(f"{name}: rel. L2 up to {worst:.3g}")
    assert worst <= 5e-7
    query = fo.Query(water, mode="exact", level="frame").at(
        *points.T, water.loop * moments[2] / ticks
    )
    assert heights[0] == 0.0
    steady = ~query.folded
    # eight steps of the simple iteration leave the gradient of the displacement to the eighth power
    assert np.abs(np.array(heights[1]) - query.heights)[steady].max() <= 2e-3


PROBE = """(async () => {
  %(base64)s
  const { THREE, sea, renderer } = page, { sums } = await import('./water.js');
  const { Passes, floatTarget, numbers, pass } = await import('./passes.js');
  const rests = %(rests)s, count = rests.length;
  const code = sums(sea.tiles).replaceAll('texture(', 'unfiltered(');
  const names = Object.keys(page.water.step.uniforms);
  const probe = pass(`vec4 unfiltered(sampler2D map, vec2 at) { return textureLod(map, at, 0.0); }
    ${code}
    uniform sampler2D rests;
    layout(location = 0) out vec4 first; layout(location = 1) out vec4 second;
    void main() {
      vec2 rest = texelFetch(rests, ivec2(gl_FragCoord.xy), 0).xy, slope;
      vec3 stretch, variance; float foam;
      summed(rest, slope, stretch, variance, foam);
      first = vec4(displaced(rest, 0.0), foam);
      second = vec4(slope, stretch.xz);
    }`, ['rests']);
  const { uniforms } = page.water.step;
  for (const name of names) if (!(name in probe.uniforms)) probe.uniforms[name] = uniforms[name];
  sea.update(%(time)r);
  const target = floatTarget(count, 1, 2);
  const places = numbers(Float32Array.from(rests.flat()), count, 1, THREE.RGFormat);
  new Passes(renderer).run(probe, { rests: places }, target);
  return [0, 1].map((which) => {
    const out = new Float32Array(4 * count);
    renderer.readRenderTargetPixels(target, 0, 0, count, 1, out, undefined, which);
    return base64(out);
  });
})()"""


def probed(page, rests, time):
    """Return the water's own sums at places at rest (X, Z): (places, 8)."""
    found = page.evaluate(PROBE % {"base64": BASE64, "rests": rests.tolist(), "time": time})
    return np.concatenate([floats(text, len(rests), 4) for text in found], axis=1)


def samples(n, size):
    """Return X and Z of all samples of a tile, some of them tiles away, and their indices."""
    j, i = (a.ravel() for a in np.mgrid[0 : n[1], 0 : n[0]])
    x, y = i * size[0] / n[0], j * size[1] / n[1]
    return np.stack([x + 3 * size[0] * (i % 2), -(y - 2 * size[1] * (j % 2))], axis=1), j, i


def expected_at(fields, j, i):
    """Return what the sums must be at samples: X, Y, Z, then slopes along X and Z, stretches."""
    at = {name: values[j, i] for name, values in fields.items()}
    return np.stack(
        [at["x"], at["z"], -at["y"], at["slope_x"], -at["slope_y"], at["stretch_xx"]], axis=1
    )


def test_the_water_lies_where_the_library_has_it(browser, npm, seas):
    """The sums of the water's shader at every sample of a live tile, to the rounding of a half."""
    water = seas["ocean"]
    folder, _ = packed(browser, npm, "ocean", water)
    rests, j, i = samples(OBLONG["n"], OBLONG["size"])
    with opened(browser, folder) as (page, said):
        assert said == "ready"
        found = probed(page, rests, 0.25 * water.loop)
    frame, c = water.loop_frame(1, 4), water.choppiness
    fields = {"x": c * frame.displace_x, "y": c * frame.displace_y, "z": frame.height}
    fields |= {f"slope_{axis}": getattr(frame, f"slope_{axis}") for axis in "xy"}
    expected = expected_at({**fields, "stretch_xx": c * frame.stretch_xx}, j, i)
    allowed = half_step(np.abs(expected).max(axis=0)) + 1e-3 * np.ptp(expected, axis=0)
    assert np.all(np.abs(found[:, [0, 1, 2, 4, 5, 6]] - expected) <= allowed)
    shear = -c * frame.stretch_xy[j, i]
    assert np.abs(found[:, 7] - shear).max() <= 1e-3 * np.ptp(shear) + half_step(shear).max()


@pytest.mark.parametrize("format_", FORMATS)
def test_a_bake_plays_at_once(browser, npm, format_):
    """
    The folder of a bake is served as it is, with three.js beside it: the maps of each frame and
    between frames, and the places for things that float, are those of the library.
    """
    asked, folder = baked(browser, "three", format_, MAPS, "project")
    with_three(folder, npm)
    water, size = truth(asked), asked.settings["ocean.size"]
    rests, j, i = samples(N, size)
    with opened(browser, folder) as (page, said):
        assert said == "ready"
        seen = {share: probed(page, rests, share * LOOP / FRAMES) for share in (1.0, 2.5)}
        floating = page.evaluate(
            f"(page.sea.update({LOOP / FRAMES!r}), {rests[:50].tolist()}.map(([X, Z]) => "
            "page.sea.playback.atRest(X, Z)))"
        )
        about = page.evaluate("document.getElementById('about').textContent")
        assert page.evaluate("page.renderer.getContext().getError()") == 0
    assert "4 frames" in about
    for share, found in seen.items():
        first, part = int(share), share % 1
        fields = {
            key: (1 - part) * values[first] + part * values[(first + 1) % FRAMES]
            for key, values in water.items()
        }
        expected = expected_at(fields, j, i)
        # a half is rounded in the file, and again in the map that the water reads
        allowed = 1.5 * half_step(np.abs(expected).max(axis=0)) + 1e-3 * np.ptp(expected, axis=0)
        assert np.all(np.abs(found[:, [0, 1, 2, 4, 5, 6]] - expected) <= allowed)
        if share == 1.0:
            places = expected[:50, :3]
            assert np.all(np.abs(np.array(floating) - places) <= allowed[:3])
    foam = fo.load(folder).maps["foam"][1][..., 0][j, i]
    assert np.abs(seen[1.0][:, 3] - foam).max() <= 2e-3
    assert foam.max() > 0.1


@pytest.mark.parametrize(
    ("format_", "maps"),
    [("bin", ["displacement", "normal"]), ("exr", ["normal", "height"]), ("bin", ["displacement"])],
)
def test_a_bake_without_slopes_is_lit_by_what_it_has(browser, npm, format_, maps):
    """By its normals, which are those of the displaced surface; else by differences over texels."""
    label = "-".join(maps)
    asked, folder = baked(browser, "three", format_, maps, label)
    with_three(folder, npm)
    water, size = truth(asked), asked.settings["ocean.size"]
    rests, j, i = samples(N, size)
    with opened(browser, folder) as (page, said):
        assert said == "ready"
        found = probed(page, rests, LOOP / FRAMES)
    fields = {key: values[1] for key, values in water.items()}
    if "normal" in maps:
        slopes = [-fields[f"normal_{axis}"] / fields["normal_z"] for axis in "xy"]
        stretch = np.zeros_like(slopes[0])
    else:
        steps = [side / count for side, count in zip(size, N, strict=True)]
        slopes = [
            central(fields["z"], axis, step) for axis, step in zip((1, 0), steps, strict=True)
        ]
        stretch = central(fields["x"], 1, steps[0])
    expected = np.stack([slopes[0][j, i], -slopes[1][j, i], stretch[j, i]], axis=1)
    steep = np.abs(expected).max()
    assert np.abs(found[:, 4:7] - expected).max() <= 0.01 * steep
    assert steep > 0.1


def central(field, axis, step):
    """Return the central difference along an axis of a periodic field."""
    return (np.roll(field, -1, axis) - np.roll(field, 1, axis)) / (2.0 * step)


def test_a_bake_of_several_tiles_is_summed(browser, npm):
    """The sums of the water are those that `fo.load(...).summed` makes of the same files."""
    folder = browser.site.folders["bakes"] / "three-project-tiles"
    tiles = [(32, 80.0), (32, 13.0)]
    asked = job(bake__engine="three", bake__format="bin", bake__maps=list(MAPS[:3]))
    bake_tiles(asked.replaced({"ocean.loop": 40.0}), tiles, folder, executor="serial")
    with_three(folder, npm)
    places = np.random.default_rng(2).integers(-200, 200, (60, 2)) * (80.0 / 32)
    with opened(browser, folder) as (page, said):
        assert said == "ready"
        found = probed(page, np.stack([places[:, 0], -places[:, 1]], axis=1), 10.0)
    loaded = fo.load(folder)
    expected = loaded.summed("displacement", *places.T, 1)
    apart = found[:, [0, 2, 1]] * [1, -1, 1] - expected
    # places are samples of the first tile, and lie between those of the second
    assert np.abs(apart).max() <= 0.02 * np.abs(expected).max()


def test_a_changed_package_is_refused(browser, npm, seas):
    """The message names the file and the rule."""
    folder, _ = packed(browser, npm, "changed", seas["ocean"])
    data = bytearray((folder / "tile0.waves").read_bytes())
    data[20] ^= 1
    (folder / "tile0.waves").write_bytes(data)
    with opened(browser, folder) as (_, said):
        assert said == "tile0.waves: its SHA-256 is not the listed one"


def pixels_of(png):
    """Return the pixels of an 8-bit PNG without interlace, (rows, columns, 3)."""
    at, parts, width, height, channels = 8, b"", 0, 0, 3
    while at < len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        body = png[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack_from(">IIBB", body)
            channels = {2: 3, 6: 4}[colour]
        parts += body if kind == b"IDAT" else b""
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(parts), np.uint8).reshape(height, 1 + channels * width)
    out = np.zeros((height, width, channels), np.int64)
    for r, (kind, line) in enumerate(zip(rows[:, 0], rows[:, 1:], strict=True)):
        one, above = line.reshape(width, channels).astype(np.int64), out[r - 1] * (r > 0)
        for x in range(width):
            left = out[r, x - 1] if x else np.zeros(channels, np.int64)
            corner = above[x - 1] if x else np.zeros(channels, np.int64)
            guess = left + above[x] - corner
            near = [abs(guess - left), abs(guess - above[x]), abs(guess - corner)]
            paeth = np.where(
                (near[0] <= near[1]) & (near[0] <= near[2]),
                left,
                np.where(near[1] <= near[2], above[x], corner),
            )
            add = (0, left, above[x], (left + above[x]) // 2, paeth)[kind]
            out[r, x] = (one[x] + add) & 255
    return out[..., :3]


def test_the_picture_has_sky_water_and_a_buoy(browser, npm, seas):
    """A bright sky above darker water, and yellow paint in the middle."""
    folder, _ = packed(browser, npm, "cascade", seas["cascade"])
    with opened(browser, folder, width=240, height=160) as (page, said):
        assert said == "ready"
        assert page.evaluate("page.still(7.0, { sun: 30 })") == 0
        page.evaluate("document.getElementById('panel').hidden = true")
        seen = pixels_of(page.screenshot())
    sky, water = seen[:20], seen[110:]
    assert sky.mean() > water.mean() + 40
    assert water.std() > 8  # waves
    assert np.all(sky[..., 2] >= sky[..., 0] - 10)
    red, green, blue = np.moveaxis(seen[40:140, 90:150], -1, 0)
    assert np.count_nonzero((red > 90) & (green > 70) & (blue < 0.5 * green)) > 10


def test_the_project_names_no_network_host():
    """Its files load from their own folder alone."""
    for name, file in project_files("threejs").items():
        if Path(name).suffix in (".js", ".html"):
            assert "://" not in file.read_text(encoding="utf-8")
