"""What stands beside an atlas for one engine: parsed as far as it is a file format, and true to the atlas it is about."""

import configparser
import re

import numpy as np
import pytest

from fftocean.export.formats import assemble, encode
from fftocean.export.profiles import PROFILES

FRAMES, ROWS, COLUMNS = 6, 4, 8  # an atlas of 2 columns and 3 rows


def files(name):
    parts = [encode("exr-atlas", np.zeros((ROWS, COLUMNS, 3), np.float32))] * FRAMES
    return assemble("exr-atlas", parts, stem="foam", shape=(FRAMES, ROWS, COLUMNS, 3), profile=PROFILES[name], size=(40.0, 20.0), loop=12.0)


@pytest.mark.parametrize("name", PROFILES)
def test_each_engine_gets_its_own_and_no_other(name):
    more = {"godot": "foam.exr.import", "unity": "foam.exr.unity.txt", "unreal": "foam.exr.unreal.txt"}
    assert set(files(name)) == {"foam.exr", "foam.json"} | ({more[name]} if name in more else set())


def test_godot_imports_an_array_of_halves_without_mipmaps():
    """As Godot's own ConfigFile reads it: sections and key=value."""
    parser = configparser.ConfigParser(interpolation=None)
    parser.read_string(bytes(files("godot")["foam.exr.import"]).decode())
    assert dict(parser["remap"]) == {"importer": '"2d_array_texture"', "type": '"CompressedTexture2DArray"'}
    params = parser["params"]
    assert (params["slices/horizontal"], params["slices/vertical"]) == ("2", "3")
    assert params["compress/mode"] == "3"  # VRAM Uncompressed
    assert params["mipmaps/generate"] == "false"


@pytest.mark.parametrize("name", ["unity", "unreal"])
def test_a_page_of_steps_is_about_this_atlas(name):
    text = bytes(files(name)[f"foam.exr.{name}.txt"]).decode()
    assert "{" not in text
    assert re.search(r"sRGB +off", text)
    assert "frame = mod((time - start) / loop * frames, frames)" in text
    if name == "unity":
        assert "2D Array, Columns 2, Rows 3" in text
        assert "flipbookColumns = 2;" in text
        assert "flipbookRows = 3;" in text
        assert "RGBA Half" in text
    else:
        assert "HDR (RGBA16F" in text
        assert "2 cells across and 3 down" in text
