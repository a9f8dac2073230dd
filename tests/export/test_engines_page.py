"""The page for users says what the profiles do: its table is read as a machine would, and so are its formats."""

import re
from pathlib import Path

from fftocean.export.formats import FORMATS
from fftocean.export.profiles import PROFILES

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "engines.md").read_text(encoding="utf-8")
NAMES = {"three, raw": "three", "three, pictures": "three-exr", "babylon, raw": "babylon"}


def table(heading):
    """The rows of the table that begins with a heading, without its two first lines."""
    lines = PAGE[PAGE.index(f"| {heading} |") :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_table_of_engines_is_the_profiles():
    told = {}
    for engines, axes, row0, at_v, unit, green in table("engine"):
        shown = re.sub(r"\(.*?\)", "", engines).strip()
        for name in [NAMES[shown]] if shown in NAMES else [part.strip() for part in shown.split(",")]:
            told[name] = (axes, row0, at_v, unit, green)
    assert told.keys() == PROFILES.keys()
    for name, profile in PROFILES.items():
        axes = ", ".join({"+x": "x", "+y": "y", "-y": "-y", "+z": "up"}[axis] for axis in profile.axes)
        green = "toward row 0" if profile.green > 0 else "away from row 0"
        assert told[name] == (axes, profile.first_row, str(profile.first_v), profile.unit, green), name


def test_every_format_is_on_the_page():
    assert {row[0].strip("`") for row in table("`--format`")} == FORMATS.keys()


def test_the_signs_of_the_second_axis_are_the_profiles():
    """Where the page says which engines add half a texel to v, and which take it away."""
    engines = {"Blender": "blender", "Unity": "unity", "Babylon": "babylon", "Unreal": "unreal", "Godot": "godot", "Bevy": "bevy"}
    engines |= {"glTF": "gltf", "three": "three", "Houdini": "houdini"}
    for sign, where in re.findall(r"v = Z / size_y ([+-]) 0\.5 / rows +where .*?: (.*)", PAGE):
        for engine in where.split(", "):
            assert PROFILES[engines.pop(engine)].north == (1 if sign == "+" else -1)
    assert not engines
