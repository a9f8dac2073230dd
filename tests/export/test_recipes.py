"""Text beside an atlas for one engine, compared with the atlas and its map."""

import configparser
import json
import re

import numpy as np
import pytest

from fftocean.baking.scene.maps import MAPS
from fftocean.export.engines import CELLS, profile_for
from fftocean.export.formats import assemble, encode
from fftocean.export.profiles import arrange, meaning, unit_in
from fftocean.export.recipes import PAGES, Page, pages_of

FRAMES, ROWS, COLUMNS = 6, 4, 8  # an atlas of 2 cells across and 3 down


def files(engine, name="foam", **more):
    """Return an atlas of one map of still water."""
    m, profile = MAPS[name], profile_for(engine, "exr-atlas")
    parts = [
        encode(
            "exr-atlas",
            arrange(profile, m.kind, np.zeros((ROWS, COLUMNS, len(m.names)), np.float32)),
        )
    ] * FRAMES
    return assemble(
        "exr-atlas", parts, stem=name, shape=(FRAMES, ROWS, COLUMNS, len(m.names)),
        profile=profile, kind=m.kind, names=meaning(profile, m.kind, m.names),
        unit=unit_in(profile, m.kind, m.unit), size=(40.0, 20.0), loop=12.0, start=1.5,
        bounds={"horizontal": 0.75, "vertical": 1.25}, **more,
    )  # fmt: skip


def page(engine, name, **more):
    """Return the page of steps, and the sidecar."""
    made = files(engine, name, **more)
    return bytes(made[f"{name}.exr.{engine}.txt"]).decode(), json.loads(bytes(made[f"{name}.json"]))


@pytest.mark.parametrize("engine", CELLS)
def test_each_engine_gets_its_own_and_no_other(engine):
    more = {
        "godot": "foam.exr.import",
        "unity": "foam.exr.unity.txt",
        "unreal": "foam.exr.unreal.txt",
    }
    assert set(files(engine)) == {"foam.exr", "foam.json"} | (
        {more[engine]} if engine in more else set()
    )


def test_godot_imports_an_array_of_halves_without_mipmaps():
    """Godot's ConfigFile reads sections and key=value."""
    parser = configparser.ConfigParser(interpolation=None)
    parser.read_string(bytes(files("godot")["foam.exr.import"]).decode())
    assert dict(parser["remap"]) == {
        "importer": '"2d_array_texture"',
        "type": '"CompressedTexture2DArray"',
    }
    params = parser["params"]
    assert (params["slices/horizontal"], params["slices/vertical"]) == ("2", "3")
    assert params["compress/mode"] == "3"  # VRAM Uncompressed
    assert params["mipmaps/generate"] == "false"


@pytest.mark.parametrize("engine", ["unity", "unreal"])
@pytest.mark.parametrize("name", MAPS)
def test_a_page_says_of_its_map_what_the_sidecar_says(engine, name):
    """
    Its formulas and numbers are those of the sidecar, which tests/export/test_matrix.py evaluates
    against the water.
    """
    text, side = page(engine, name)
    assert "{" not in text
    rule, channels = text.split("Sample with")[1].split("The channels give")
    formulas = dict(re.findall(r"^    (\w+) = (.+)$", rule, re.MULTILINE))
    (numbers,) = re.findall(r"^where (.+)$", rule, re.MULTILINE)
    values = {key: float(value) for key, value in re.findall(r"(\w+) = ([-+.e\d]+)", numbers)}
    assert {**formulas, "values": values} == side["sampling"]
    assert dict(re.findall(r"^    (\w+) = (.+)$", channels, re.MULTILINE)) == side["world"]
    assert ", ".join(f"{letter}: {words}" for letter, words in side["channels"].items()) in text
    speeds = {"velocity": "m/s", "surface_velocity": "m/s"}
    unit = {"height": "m", "displacement": "m", **speeds}.get(name, "")
    unit = unit.replace("m", "cm", 1) if engine == "unreal" else unit
    assert re.search(rf"^Unit +{unit or r'none .a pure number.'}; linear$", text, re.MULTILINE)
    assert ("cm" in re.sub(r"place at rest and sizes in cm|by 75 cm|by 125 cm", "", text)) == (
        unit[:1] == "c"
    )
    assert "Lookup      lagrangian" in text
    assert "starts at 1.5 s, plays for 12 s, 0.5 frames a second" in text
    bounds = (
        "75 cm along the horizontal axes, by 125 cm"
        if engine == "unreal"
        else "0.75 m along the horizontal axes, by 1.25 m"
    )
    assert f"by {bounds} up and down" in text
    assert ("packed: n = 2 c - 1" in text) == (name == "normal")
    assert re.search(r"sRGB +off", text)
    if engine == "unity":
        alpha = "A" in side["channels"]
        assert re.search(rf"Alpha Source +{'Input Texture Alpha' if alpha else 'None'}\n", text)
        assert f"TextureImporterAlphaSource.{'FromInput' if alpha else 'None'};" in text
        assert re.search(r"Alpha Is Transparency +off", text)
        assert "2D Array, Columns 2, Rows 3 (cells of frames)" in text
        assert "flipbookColumns = 2;" in text
        assert "flipbookRows = 3;" in text
        assert "RGBA Half" in text
        assert not re.search(r"[/+] *columns|[/+] *rows", text)  # those words are Unity's for cells
    else:
        assert "HDR (RGBA16F" in text
        assert "2 cells across and 3 down" in text


def test_a_part_of_the_loop_is_said_to_be_one():
    assert (
        "a part of the loop: the last frame does not lead on"
        in page("unreal", "foam", closes=False)[0]
    )
    assert "Lookup      eulerian" in page("unreal", "foam", lookup="eulerian")[0]


@pytest.mark.parametrize(
    ("name", "suffix", "message"),
    [
        ("godott", ".txt", "pages must be for profiles, got .*godott"),
        ("bevy", "", "each page must have a suffix of its own"),
        ("bevy", ".unity.txt", "each page must have a suffix of its own"),
    ],
)
def test_a_page_of_no_profile_or_without_its_own_suffix_is_an_error_at_import(
    name, suffix, message
):
    assert pages_of(PAGES) == PAGES
    with pytest.raises(ImportError, match=message):
        pages_of({**PAGES, name: Page(suffix, PAGES["godot"].text)})


def test_a_page_without_a_part_cannot_be_made():
    with pytest.raises(TypeError, match="text"):
        Page(".txt")
