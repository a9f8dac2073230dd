"""
Bakes played in headless Chromium: the textures hold what was baked.
"""

import base64
import json

import builders
import numpy as np
import pytest
from web import floats

import fftocean as fo
from fftocean.baking.cascade import bake_tiles
from fftocean.view.playback import open_bake

pytestmark = [
    pytest.mark.client,
    pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning"),
]

COUNT, TICKS = 4, 2**20
TILES = [(32, 60.0), (16, 9.0)]
RECIPE = {
    "ocean.n": (24, 18),  # textures need no power of two
    "ocean.size": (60.0, 45.0),
    "ocean.choppiness": 0.9,
    "bake.frames": COUNT,
    "bake.maps": ("displacement", "derivative", "stretch"),
    "bake.format": "exr",
    "bake.pictures": [],
}
HALF = 2.0**-11  # relative error of a half float


def served(browser, name, playback):
    """Write the messages of a bake to the server of the tests; return their address."""
    folder = browser.site.folders["bakes"] / name
    folder.mkdir()
    document = playback.manifest()
    (folder / "manifest.json").write_text(json.dumps(document))
    for tile in range(len(document["tiles"])):
        for j in range(len(playback)):
            (folder / f"{tile}_{j}.bin").write_bytes(playback.frame(tile, j))
    return f"{browser.site.address}/bakes/{name}"


def played(browser, folder, frames, **more):
    """Return what the page holds at the middle of some frames."""
    ticks = [int((j + more.pop("share", 0.5)) * TICKS / COUNT) % TICKS for j in frames]
    value, _ = browser.run("playback.html", {"folder": folder, "ticks": ticks, **more})
    assert value["error"] == 0
    return value


def texels(tile):
    """Return the three maps of a tile as read back, (3, ny, nx, 4)."""
    return np.stack([floats(m["texels"], m["height"], m["width"], 4) for m in tile])


@pytest.fixture(scope="module")
def single(browser, tmp_path_factory):
    """A bake of one tile: the bake as arrays, and its address."""
    folder = tmp_path_factory.mktemp("bake") / "sea"
    fo.bake(builders.job(RECIPE), folder, executor="serial")
    return fo.load(folder), served(browser, "played-single", open_bake(folder))


def test_texels_are_the_bake_s(browser, single):
    """Displacement, slopes and stretches come back with the bits that were baked."""
    bake, address = single
    value = played(browser, address, range(COUNT))
    assert [one["frame"] for one in value["seen"]] == list(range(COUNT))
    for j, one in enumerate(value["seen"]):
        displacement, slopes, moments = texels(one["tiles"][0])
        assert np.array_equal(displacement[..., :3], bake["displacement"][j])
        assert np.array_equal(displacement[..., 3], bake["stretch"][j, ..., 1])
        assert np.array_equal(slopes[..., :2], bake["derivative"][j, ..., :2])
        assert np.array_equal(slopes[..., 2], bake["stretch"][j, ..., 0])
        assert np.array_equal(slopes[..., 3], bake["stretch"][j, ..., 2])
        sx, sy = slopes[..., 0], slopes[..., 1]
        right = np.stack([sx * sx, sy * sy, sx * sy, 0.0 * sx], axis=-1)
        assert np.all(np.abs(moments - right) <= HALF * np.abs(right) + 2.0**-25)
    assert np.std(bake["displacement"][..., 2]) > 0.05


def test_each_frame_is_asked_for_once(browser, single):
    value = played(browser, single[1], [0, 1, 2, 3, 0, 1, 2, 3])
    assert sorted(map(tuple, value["asked"])) == [(0, j) for j in range(COUNT)]
    assert value["changes"] == COUNT


def test_the_loop_closes_and_its_picture_is_the_same(browser, single):
    """Frame F is frame 0, to the pixel; another frame is another picture."""
    value = played(browser, single[1], [0, 2, COUNT], share=0.0, picture=True)
    first, other, last = value["seen"]
    assert first["frame"] == last["frame"] == 0
    assert first["tiles"] == last["tiles"]
    assert first["picture"] == last["picture"]
    assert first["picture"] != other["picture"]
    pixels = np.frombuffer(base64.b64decode(first["picture"]), np.uint8)
    assert len(np.unique(pixels)) > 20


def test_blending_is_linear_between_frames_and_exact_at_them(browser, single):
    bake, address = single
    at = played(browser, address, [1], share=0.0, blend=True)["seen"][0]
    assert np.array_equal(texels(at["tiles"][0])[0, ..., :3], bake["displacement"][1])
    between = played(browser, address, [3], share=0.25, blend=True)["seen"][0]
    found = texels(between["tiles"][0])
    before, after = bake["displacement"][3], bake["displacement"][0]  # the loop closes
    right = before + 0.25 * (after - before)
    assert np.all(np.abs(found[0, ..., :3] - right) <= 2.0 * HALF * np.abs(right) + 1e-6)
    sx = bake["derivative"][3, ..., 0] * 0.75 + bake["derivative"][0, ..., 0] * 0.25
    np.testing.assert_allclose(found[2, ..., 0], sx * sx, rtol=6.0 * HALF, atol=1e-6)


def test_levels_are_means(browser, single):
    """A level of a quarter of the texels has their means, as far as the rows divide evenly."""
    bake, address = single
    one = played(browser, address, [2], level=1)["seen"][0]
    found = texels(one["tiles"][0])[0, ..., 2]
    height = bake["displacement"][2, ..., 2]
    right = height.reshape(9, 2, 12, 2).mean(axis=(1, 3))
    np.testing.assert_allclose(found, right, atol=2.0 * HALF * np.abs(height).max())


def test_a_cascade_has_textures_for_each_tile(browser, tmp_path):
    recipe = {**RECIPE, "ocean.n": 32, "ocean.size": 60.0, "bake.maps": ("height",)}
    bake_tiles(builders.job(recipe), TILES, tmp_path / "sea", executor="serial")
    bake = fo.load(tmp_path / "sea")
    address = served(browser, "played-tiles", open_bake(tmp_path / "sea"))
    value = played(browser, address, [1], picture=True)
    one = value["seen"][0]
    assert len(one["tiles"]) == 2
    for tile, (n, _), own in zip(one["tiles"], TILES, bake.tiles, strict=True):
        found = texels(tile)
        assert found.shape == (3, n, n, 4)
        assert np.array_equal(found[0, ..., 2], own["height"][1, ..., 0])
