"""
The page of `examples/webgpu` in headless Chromium's WebGPU, on a software Vulkan (SwiftShader).

A canvas of WebGPU brings that Chromium's graphics process down; the page's stills, which are drawn
to a texture and shown as an image, do not.
"""

import io
import json
import warnings

import numpy as np
import pytest
from conftest import find_chromium
from PIL import Image
from web import Browser, Site, floats

import fftocean as fo
from fftocean.fields import EIGHT

pytestmark = pytest.mark.client

FIELDS = 5e-7  # relative L2 error; see tests/runtime/test_shaders_on_gpu.py
LOOP, WIND = 64.0, (11.0, 30.0)
TILES = [(64, 420.0), ((64, 32), (61.0, 40.0)), (64, 8.3)]

SEND = """(async () => {
  const { sea } = await globalThis.ready;
  const found = [];
  for (const tick of TICKS) {
    for (const fields of await sea.fields(tick)) {
      for (const name of NAMES) {
        const bytes = new Uint8Array(fields[name].buffer);
        let text = '';
        for (let i = 0; i < bytes.length; i += 8192) {
          text += String.fromCharCode(...bytes.subarray(i, i + 8192));
        }
        found.push(btoa(text));
      }
    }
  }
  return found;
})()"""

HEIGHTS = """(async () => {
  const { sea } = await globalThis.ready, { STORAGE, COPY_SRC, COPY_DST } = GPUBufferUsage;
  const places = new Float32Array(PLACES), points = places.length / 2;
  const make = (size) => sea.device.createBuffer({ size, usage: STORAGE | COPY_SRC | COPY_DST });
  const given = make(places.byteLength), answers = make(32 * points);
  sea.device.queue.writeBuffer(given, 0, places);
  sea.set({ tick: 54321, points });
  const others = { 7: { buffer: answers }, 8: { buffer: given } };
  const numbers = await sea.read(7, (pass) => {
    sea.frame(pass);
    sea.dispatch(pass, 'heights', [Math.ceil(points / 64)], others);
  }, answers);
  return Array.from(numbers);
})()"""

PLATFORM = """(async () => {
  const { Sea } = await import('./sea.js'), { selfCheck } = await import('./check.js');
  const changed = (text) => text.replace(/fn phasor\\([^]*?\\n}/,
    'fn phasor(t: f32) -> vec2f { return vec2f(cos(6.2831853 * t), sin(6.2831853 * t)); }');
  return selfCheck(await Sea.load('.', { foam: { side: 16, cell: 1 }, changed }));
})()"""


@pytest.fixture(scope="module")
def water():
    """Return a small cascade."""
    wind = fo.Sea.from_wind(speed=WIND[0], fetch=150e3, direction=WIND[1])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        return fo.Cascade(wind, TILES, seed=7, loop=LOOP, dtype="float64")


@pytest.fixture(scope="module")
def seas(water, tmp_path_factory):
    """Return a folder of seas with the page beside each: one whole, others damaged."""
    folder = tmp_path_factory.mktemp("seas")
    for name in ("whole", "changed", "foreign"):
        fo.export_sea(water, folder / name, engine="webgpu", wind=WIND)
    waves = bytearray((folder / "changed" / "tile1.waves").read_bytes())
    waves[-1] ^= 1
    (folder / "changed" / "tile1.waves").write_bytes(waves)
    document = json.loads((folder / "foreign" / "sea.json").read_text(encoding="utf-8"))
    document["version"] = 2
    (folder / "foreign" / "sea.json").write_text(json.dumps(document), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def chromium(npm, seas, tmp_path_factory):
    """Start a headless Chromium that has WebGPU, and a server of the seas."""
    log = tmp_path_factory.mktemp("log") / "driver.log"
    with (
        Site({"seas": seas}) as site,
        Browser(find_chromium(), npm, site, log=log, graphics="webgpu") as started,
    ):
        yield started


@pytest.fixture(scope="module")
def page(chromium):
    """Open the page with a still of the sea, and wait until it is drawn."""
    address = f"{chromium.site.address}/seas/whole/index.html?tick=100000&foam=128"
    with chromium.page(address, width=640, height=360) as opened:
        found = opened.evaluate("globalThis.ready.then((r) => r.error ?? r.found)")
        assert not isinstance(found, str), found
        yield opened, found


def test_the_page_checks_itself(page):
    """Beside `check.json`, and it says so."""
    opened, found = page
    assert 1e-9 < found["worst"] <= FIELDS
    text = opened.evaluate("document.getElementById('notes').textContent")
    assert "Self-check passed: eight fields beside Python's, relative error" in text
    assert "3 tiles; loop 64 s" in text


def test_every_field_equals_that_of_python(page, water, seas):
    """Of each tile, on its whole grid, at the first and the last tick and at one between."""
    opened, _ = page
    ticks = json.loads((seas / "whole" / "sea.json").read_text(encoding="utf-8"))["ticks"]
    moments = [0, 12345, ticks - 1]
    script = SEND.replace("TICKS", str(moments)).replace("NAMES", json.dumps(EIGHT))
    sent = opened.evaluate(script)
    for tick in moments:
        for ocean in water.oceans:
            frame = ocean.loop_frame(tick, ticks)
            for name in EIGHT:
                seen = floats(sent.pop(0), *ocean.grid.shape)
                size = np.linalg.norm(frame[name])
                assert np.linalg.norm(seen - frame[name]) <= FIELDS * size, (tick, name)
    assert not sent


def test_heights_at_points_are_those_of_the_library(page, water, seas):
    """Beside the sum of all waves; between samples the kernel interpolates the shortest ones."""
    opened, _ = page
    x, y = np.random.default_rng(4).uniform(-200, 200, (2, 100)).astype(np.float32).astype(float)
    places = json.dumps(np.stack([x, y], axis=-1).ravel().tolist())
    seen = np.reshape(opened.evaluate(HEIGHTS.replace("PLACES", places)), (100, 8))
    ticks = json.loads((seas / "whole" / "sea.json").read_text(encoding="utf-8"))["ticks"]
    answer = fo.Query(water, mode="exact", level="frame").at(x, y, LOOP * 54321 / ticks)
    calm = ~answer.folded & (seen[:, 7] > 0.3)
    assert calm.sum() > 90
    apart = (seen[:, 2] - answer.heights)[calm]
    assert np.sqrt(np.mean(apart**2)) <= 0.005 * np.std(answer.heights)
    assert seen[calm, 3].max() <= 1e-3


def test_the_picture_shows_sky_water_glitter_and_foam(page):
    """Statistics of a picture that was looked at: a broken one is blank, black, or noise."""
    opened, _ = page
    opened.evaluate("document.getElementById('notes').className = 'quiet'")
    picture = np.asarray(Image.open(io.BytesIO(opened.screenshot())).convert("RGB")) / 255.0
    assert picture.shape == (360, 640, 3)
    sky, sea = picture[:100, :320], picture[180:, :320]  # the half away from the sun
    assert sky.mean() > 1.5 * sea.mean()
    assert sea[..., 2].mean() > 1.3 * sea[..., 0].mean()  # the sea is blue
    assert 0.05 < sea.mean() < 0.5
    assert np.std(sea.mean(axis=-1)) > 0.02  # with waves
    glitter = picture[140:, 400:].mean(axis=-1)
    assert np.mean(glitter > 0.9) > 0.02  # the sun's path is white
    assert np.mean(picture[140:].mean(axis=-1) > 0.9) < 0.4
    # the horizon is a straight line, 7 degrees above the middle of a picture that is 49 high
    rows = np.abs(np.diff(picture[100:160, :300].mean(axis=-1), axis=0)).argmax(axis=0) + 100
    expected = 180 * (1 - np.tan(np.radians(7)) / np.tan(0.425))
    assert np.mean(np.abs(rows - expected) <= 1.5) > 0.9  # elsewhere a speck of foam is brighter


def test_sines_of_the_platform_fail_the_self_check(page):
    """Sines that are too coarse: the error is many times the limit."""
    opened, _ = page
    found = opened.evaluate(PLATFORM)
    assert found["worst"] > 10 * FIELDS


@pytest.mark.parametrize(
    ("name", "before", "words"),
    [
        ("changed", "", "tile1.waves is not what sea.json lists: its SHA-256 is"),
        ("foreign", "", "sea.json must be of format fftocean-runtime, version 1; got"),
        (
            "whole",
            "Object.defineProperty(navigator, 'gpu', { value: undefined })",
            "This page needs WebGPU, and this browser has no WebGPU.",
        ),
        (
            "whole",
            "navigator.gpu.requestAdapter = async () => null",
            "This page needs WebGPU, and this browser has WebGPU, but no graphics processor",
        ),
    ],
)
def test_what_is_missing_or_wrong_is_said_on_the_page(chromium, name, before, words):
    address = f"{chromium.site.address}/seas/{name}/index.html?tick=0"
    with chromium.page(address, width=480, height=270, before=before) as opened:
        found = opened.evaluate("globalThis.ready.then((r) => r.error)")
        text = opened.evaluate("document.getElementById('notes').textContent")
        kind = opened.evaluate("document.getElementById('notes').className")
        assert found == text
        assert text.startswith(words)
        assert kind == "wrong"
