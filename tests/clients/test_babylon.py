"""
Babylon.js in a browser: its loaders and a shader read every kind of file by the sidecar's formulas;
its material lights a normal map.
"""

import numpy as np
import pytest
from lookups import MAPS, baked, look_up, on_screen, require_equal, texture
from water import SQUARE, N, Text, half_step, truth
from web import floats

pytestmark = pytest.mark.client

FORMATS = {"exr": MAPS, "exr-float": MAPS, "exr-atlas": MAPS, "bin": MAPS}
FRAMES = (0, 3)
# docs/engines.md: a left-handed scene turns the tangent over, and the bitangent where green is
# toward larger v
SETTINGS = {
    "bin": {"invertNormalMapX": True, "invertNormalMapY": False},
    "exr": {"invertNormalMapX": True, "invertNormalMapY": True},
}
SUNS = [
    (sign * (axis == 0), sign * (axis == 1), sign * (axis == 2))
    for axis in range(3)
    for sign in (1, -1)
]


@pytest.fixture(scope="module")
def found(browser):
    """Return the lookups of one page, and its other answers."""
    return look_up(browser, "babylon", "babylon.html", FORMATS, FRAMES)


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
    A left-handed frame with Y up: the engine's own camera puts the axes where "east" and "north"
    are.
    """
    said = Text.of(browser.site.folders["bakes"] / "babylon-bin-sea", "height")
    assert said.handed == "left"
    on_screen(found[1], said)


@pytest.fixture(scope="module")
def normals(browser):
    """
    Return the normals that StandardMaterial lights by, along X, Y and Z, {(format, sea): (rows,
    columns, 3)}, row 0 south; and the sea.

    A white surface without highlights shows max(0, n . s) of a sun s: six suns, along the axes both
    ways, give n.
    """
    textures, pictures, jobs = {}, [], {}
    for format_, settings in SETTINGS.items():
        for sea, wind in (("flat", 0.0), ("sea", 7.0)):
            jobs[sea], folder = baked(
                browser,
                "babylon",
                format_,
                ["normal"],
                sea + "-lit",
                ocean__size=SQUARE,
                sea__wind__speed=wind,
            )
            textures[f"{format_} {sea}"] = texture(folder, format_, "normal", 0, layer=0)
            said = Text.of(folder, "normal")
            tile = {
                "texture": f"{format_} {sea}",
                "size": SQUARE,
                "count": N,
                "sampling": said.sampling,
            }
            pictures += [{**tile, "light": sun, "settings": settings} for sun in SUNS]
    value, _ = browser.run("babylon.html", {"textures": textures, "pictures": pictures})
    assert value["error"] == 0
    lit = np.stack([floats(seen, N[1], N[0], 4)[..., 0] for seen in value["pictures"]]).reshape(
        -1, 3, 2, N[1], N[0]
    )
    return dict(
        zip(
            [(f, s) for f in SETTINGS for s in ("flat", "sea")],
            np.moveaxis(lit[:, :, 0] - lit[:, :, 1], 1, -1),
            strict=True,
        )
    ), jobs["sea"]


@pytest.mark.parametrize("format_", SETTINGS)
def test_a_flat_sea_is_exactly_up_in_a_stock_material(normals, format_):
    """The material turns (0.5, 0.5, 1) into (0, 1, 0), in single precision."""
    found, _ = normals
    assert np.abs(found[format_, "flat"] - [0.0, 1.0, 0.0]).max() <= 1e-6


@pytest.mark.parametrize("format_", SETTINGS)
def test_a_stock_material_lights_the_sea_by_its_normals(normals, format_):
    """
    X is east, Y up and Z north: lit by the sea's own normals, to the rounding of a half (n + 1) / 2
    in each.
    """
    found, job = normals
    water = truth(job)
    apart = np.abs(
        found[format_, "sea"] - np.stack([water[f"normal_{axis}"][0] for axis in "xzy"], axis=-1)
    )
    assert apart.max() <= np.sqrt(3) * half_step(0.75)
