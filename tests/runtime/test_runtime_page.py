"""docs/runtime.md: its reader runs, and its tables name every key."""

import json
import re

import builders_of_packages as build
import numpy as np
import pytest
from builders import ROOT

import fftocean as fo
from fftocean.fields import EIGHT

PAGE = (ROOT / "docs" / "runtime.md").read_text(encoding="utf-8")


def reader():
    """Return the program of the page that reads a package."""
    programs = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (found,) = [text for text in programs if "import json" in text]
    return found


@pytest.fixture
def scope(tmp_path, monkeypatch):
    """Run the reader beside a package; return its names."""
    fo.export_sea(build.cascade("float64"), tmp_path / "sea")
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(reader(), "docs/runtime.md", "exec"), names)
    return names


def test_the_reader_of_the_page_makes_the_fields_of_the_ocean(scope):
    """To the rounding of h0 to float32, 3e-8 in the mean square."""
    assert tuple(scope["FIELDS"]) == EIGHT
    ticks = scope["document"]["ticks"]
    for tick in (0, 1, 700_001, ticks - 1):
        for i, ocean in enumerate(build.cascade("float64").oceans):
            frame = ocean.loop_frame(tick, ticks)
            found = scope["fields"](i, tick)
            for name, values in zip(EIGHT, found, strict=True):
                error = np.linalg.norm(values - frame[name]) / np.linalg.norm(frame[name])
                assert error < 6e-8, name


def test_the_reader_gives_the_fields_of_the_reference(scope, tmp_path):
    tree = json.loads((tmp_path / "sea/check.json").read_text())
    for i, tile in enumerate(tree["tiles"]):
        for m, tick in enumerate(tree["moments"]):
            found = dict(zip(EIGHT, scope["fields"](i, tick), strict=True))
            for name, values in tile["fields"].items():
                error = found[name][tile["rows"], tile["columns"]] - values[m]
                assert np.linalg.norm(error) < 1.5e-7 * np.linalg.norm(values[m]), name


def test_the_reader_is_short():
    lines = [line for line in reader().splitlines() if line.strip()]
    assert len(lines) <= 25
    assert max(map(len, lines)) <= 100


def test_the_tables_of_the_page_name_every_key(scope):
    """Every key of the document and of a tile is in the first column of a table."""
    listed = set()
    for row in re.findall(r"^\| (`[^|]*) \|", PAGE, re.MULTILINE):
        listed |= set(re.findall(r"`(\w+)`", row))
    document = scope["document"]
    assert set(document) | set(document["tiles"][0]) <= listed
    for key in ("statistics", "slope_variance", "foam", "wind", "bounds", "spectrum", "files"):
        row = next(line for line in PAGE.splitlines() if line.startswith(f"| `{key}` |"))
        inner = document[key] or {}
        assert set(inner[0] if isinstance(inner, list) else inner) <= set(
            re.findall(r"`(\w+)`", row)
        )
