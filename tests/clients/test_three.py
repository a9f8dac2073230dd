"""
three.js in a browser: its loaders and a shader read every kind of file by the sidecar's formulas;
its materials light a normal map.
"""

import numpy as np
import pytest
from lookups import MAPS, baked, look_up, on_screen, require_equal, texture
from water import OBLONG, SQUARE, N, Text, half_step, truth
from web import floats

pytestmark = pytest.mark.client

FORMATS = {"exr": MAPS, "exr-float": MAPS, "exr-atlas": MAPS, "bin": MAPS, "ktx2": MAPS}
FRAMES = (0, 3)
# docs/engines.md: materials compute tangent space from uv, so raw data, whose v points down, want
# -1
NORMAL_SCALE_Y = {"bin": -1, "exr": 1}


@pytest.fixture(scope="module")
def found(browser):
    """Return the lookups of one page, and its other answers."""
    return look_up(browser, "three", "three.html", FORMATS, FRAMES)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize(("format_", "name"), [(f, m) for f, maps in FORMATS.items() for m in maps])
def test_the_formulas_of_the_sidecar_find_the_water(found, format_, name, frame):
    """
    At every sample, the same some tiles away, and between samples, the channels give what the
    formulas say they give.
    """
    require_equal(found[0][format_, name, frame])


def test_the_axes_lie_on_the_screen_as_the_manifest_says(browser, found):
    """
    A right-handed frame with Y up: the engine's own camera puts the axes where "east" and "north"
    are.
    """
    said = Text.of(browser.site.folders["bakes"] / "three-bin-sea", "height")
    assert said.handed == "right"
    on_screen(found[1], said)


@pytest.fixture(scope="module")
def lit(browser):
    """
    Render still tiles in three's own materials: {(format, sea, material): (rows, columns, 4), row 0
    south}, and the sea's job.
    """
    textures, pictures, keys, jobs = {}, [], [], {}
    for format_ in NORMAL_SCALE_Y:
        for sea, wind, size in (
            ("flat", 0.0, SQUARE),
            ("sea", 7.0, SQUARE),
            ("oblong", 7.0, OBLONG),
        ):
            keys_of = {"ocean__size": size, "sea__wind__speed": wind}
            jobs[sea], folder = baked(
                browser, "three", format_, ["normal"], sea + "-lit", **keys_of
            )
            textures[f"{format_} {sea}"] = texture(folder, format_, "normal", 0)
            said = Text.of(folder, "normal")
            for material in ("MeshNormalMaterial", "MeshStandardMaterial"):
                tile = {
                    "material": material,
                    "size": size,
                    "count": N,
                    "tangents": sea == "oblong",
                    "sampling": said.sampling,
                }
                pictures.append(
                    {**tile, "texture": f"{format_} {sea}", "normalScaleY": NORMAL_SCALE_Y[format_]}
                )
                keys.append((format_, sea, material))
                if sea == "flat":
                    pictures.append(tile)
                    keys.append((format_, "no map", material))
                if sea == "oblong":
                    pictures.append({**pictures[-1], "tangents": False})
                    keys.append((format_, "oblong, no tangents", material))
    value, _ = browser.run("three.html", {"textures": textures, "pictures": pictures})
    assert value["error"] == 0
    return {
        key: floats(seen, N[1], N[0], 4) for key, seen in zip(keys, value["pictures"], strict=True)
    }, jobs


@pytest.mark.parametrize("format_", NORMAL_SCALE_Y)
def test_a_flat_sea_is_exactly_up_in_stock_materials(lit, format_):
    """
    MeshNormalMaterial shows (n + 1) / 2 of the eye: up is (0.5, 0.5, 1); and MeshStandardMaterial
    lights it as if it had no map.
    """
    seen, _ = lit
    assert np.array_equal(
        seen[format_, "flat", "MeshNormalMaterial"][..., :3],
        np.broadcast_to([0.5, 0.5, 1.0], (N[1], N[0], 3)),
    )
    light = seen[format_, "no map", "MeshStandardMaterial"]
    assert light[..., :3].min() > 0.5
    assert (
        np.abs(seen[format_, "flat", "MeshStandardMaterial"] - light).max() <= 1e-6
    )  # single precision


@pytest.mark.parametrize("format_", NORMAL_SCALE_Y)
@pytest.mark.parametrize("sea", ["sea", "oblong"])
def test_a_stock_material_shows_the_normals_of_the_sea(lit, format_, sea):
    """
    Seen from above with north up, the eye's axes are ours: x, y and z of the normals, to the
    rounding of a half (n + 1) / 2 in each.
    """
    seen, jobs = lit
    water = truth(jobs[sea])
    normals = np.stack([water[f"normal_{axis}"][0] for axis in "xyz"], axis=-1)
    apart = np.abs(2.0 * seen[format_, sea, "MeshNormalMaterial"][..., :3] - 1.0 - normals)
    assert apart.max() <= np.sqrt(3) * half_step(0.75)
    assert np.abs(normals[..., :2]).max() > 0.2
    if (
        sea == "oblong"
    ):  # docs/engines.md: without tangents, three.js scales one component by the ratio of the sides
        without = 2.0 * seen[format_, "oblong, no tangents", "MeshNormalMaterial"][..., :3] - 1.0
        slope, steep = without[..., 0] / without[..., 2], normals[..., 0] / normals[..., 2]
        assert np.abs(slope - OBLONG[1] / OBLONG[0] * steep).max() <= 4 * half_step(0.75)
