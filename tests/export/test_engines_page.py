"""Tables and rules of docs/engines.md, compared with the table of engines."""

import re
from pathlib import Path

import pytest

from fftocean.export import rules
from fftocean.export.engines import CELLS, TABLE, Refusal
from fftocean.export.formats import FORMATS

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "engines.md").read_text(encoding="utf-8")


def table(heading):
    """
    Return the rows of the table that begins with a heading, without the line below the heading.
    """
    lines = PAGE[PAGE.index(f"| {heading} |") :].split("\n\n")[0].splitlines()
    return [
        [cell.strip() for cell in line.strip("|").split("|")] for line in [lines[0], *lines[2:]]
    ]


def usable(engine, loaded):
    return [
        cell
        for (name, _), cell in TABLE.items()
        if name == engine and not isinstance(cell, Refusal) and cell.loaded == loaded
    ]


def test_the_table_of_engines_is_the_profiles():
    told = {}
    for engines, *facts in table("engine")[1:]:
        shown, _, files = re.sub(r"\(.*?\)", "", engines).strip().partition(", ")
        if files in ("raw", "images"):
            told[shown, files == "images"] = facts
        else:
            told |= dict.fromkeys(
                [(name.strip(), True) for name in f"{shown}, {files}".strip(", ").split(",")], facts
            )
    assert {name for name, _ in told} == CELLS.keys() - {"three-exr"}
    for (name, loaded), facts in told.items():
        for profile in usable(name, loaded):
            axes = ", ".join(
                {"+x": "x", "+y": "y", "-y": "-y", "+z": "up"}[axis] for axis in profile.axes
            )
            green = "toward row 0" if profile.green > 0 else "away from row 0"
            assert facts == [
                axes,
                profile.first_row,
                str(profile.first_v),
                profile.unit,
                green,
                profile.normals,
            ], name


def test_every_cell_of_engine_and_format_is_on_the_page():
    heading, *rows = table("engine, format")
    assert [name.strip("`") for name in heading[1:]] == list(FORMATS)
    assert [row[0] for row in rows] == list(CELLS)
    for engine, *cells in rows:
        for name, said in zip(FORMATS, cells, strict=True):
            cell = TABLE[engine, name]
            assert said == (
                f"no: {cell.instead}"
                if isinstance(cell, Refusal)
                else "loader"
                if cell.loaded
                else "bytes"
            )


def test_every_format_is_on_the_page():
    assert {row[0].strip("`") for row in table("`--format`")[1:]} == FORMATS.keys()


def test_the_rules_on_the_page_are_those_that_are_tested():
    """Those of `rules`, which tests/export/test_matrix.py evaluates against the water."""
    for engine, *said in table("engine, v")[1:]:
        for loaded, formula in zip((True, False), said, strict=True):
            assert {rules.sampling(cell)["v"] for cell in usable(engine, loaded)} == {
                formula.strip("`")
            }
    for cell in TABLE.values():
        if not isinstance(cell, Refusal):
            rule = rules.sampling(cell)
            assert f"    u = {rule['u']}\n" in PAGE
            assert f"    frame = {rule['frame']}\n" in PAGE


def test_the_example_of_a_meaning_of_channels_is_the_sidecars():
    for name, formula in rules.world(TABLE["godot", "exr-atlas"], "normal").items():
        assert f"`{name} = {formula}`" in PAGE.replace("\n", " ")


@pytest.mark.parametrize(
    "words",
    ["Offset -1", "Start** 1", "frame rate of the scene F / loop", "Clamp", "bounds", "extremes"],
)
def test_what_was_forgotten_once_is_there(words):
    assert words in PAGE
