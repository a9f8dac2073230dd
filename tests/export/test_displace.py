"""The Blender example reads bakes for Blender, and refuses every other before Blender is needed."""

import importlib.util
import json
import re
import shutil
import sys
from pathlib import Path
from unittest.mock import MagicMock

import builders
import pytest

import fftocean as fo
from fftocean.baking import bake as baker

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "blender" / "displace.py"
SMALL = {
    "ocean.n": 8,
    "ocean.size": 20.0,
    "bake.frames": 4,
    "bake.engine": "blender",
    "bake.maps": ["displacement"],
    "bake.pictures": [],
    "bake.format": "exr",
}
pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Avoid integrals over the sea."""
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    monkeypatch.setattr(baker, "measure", lambda _: still)


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("displace", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)  # without bpy: it is needed only to build the scene
    return module


@pytest.mark.parametrize("form", ["exr", "exr-float"])
@pytest.mark.parametrize("lookup", ["lagrangian", "eulerian"])
def test_a_bake_for_blender_is_understood(script, tmp_path, form, lookup):
    manifest = fo.bake(
        builders.job({**SMALL, "bake.format": form, "bake.lookup": lookup}), tmp_path
    )
    assert script.read_bake(tmp_path) == json.loads(json.dumps(manifest))


@pytest.mark.parametrize(
    ("changes", "frames", "why"),
    [
        (
            {"bake.format": "png16"},
            None,
            "format exr or exr-float, got png16: bake with --format exr",
        ),
        ({"bake.format": "npz"}, None, "must be sampled at .*: bake with --engine blender"),
        ({}, "0:2", "must hold the whole loop, got frames 0:2:1 of 4"),
        ({}, "0:4:2", "must hold the whole loop, got frames 0:3:2 of 4"),
        (
            {"bake.maps": ["height"]},
            None,
            "must have displacement maps, got height: bake with --maps displacement",
        ),
        ({"bake.engine": "unity"}, None, "not in Blender's axes"),
        ({"bake.engine": "unreal"}, None, "not in Blender's axes"),
    ],
)
def test_a_bake_that_it_would_show_wrongly_is_refused(script, tmp_path, changes, frames, why):
    fo.bake(builders.job({**SMALL, **changes}), tmp_path, frames=frames)
    with pytest.raises(SystemExit, match=why):
        script.read_bake(tmp_path)


def test_what_is_no_bake_or_another_tools_is_refused(script, tmp_path):
    with pytest.raises(SystemExit, match=r"must be a finished bake with its manifest\.json"):
        script.read_bake(tmp_path)
    fo.bake(builders.job(SMALL), tmp_path / "sea")
    text = json.loads((tmp_path / "sea/manifest.json").read_text())
    for key, value, why in (
        ("tool", "another", "must be of fftocean, got 'another'"),
        ("conventions", {}, "has no 'axes'"),
        ("frames", text["frames"][:3], "must hold the whole loop"),
        ("frames", text["frames"][::-1], "frames 0 to 3 in order"),
    ):
        shutil.rmtree(tmp_path / "bent", ignore_errors=True)
        (tmp_path / "bent").mkdir()
        (tmp_path / "bent/manifest.json").write_text(json.dumps({**text, key: value}))
        with pytest.raises(SystemExit, match=why):
            script.read_bake(tmp_path / "bent")


def test_the_image_sequence_is_set_as_the_page_says(script, monkeypatch):
    """
    The numbers of docs/engines.md for Blender's image user are those that the example sets; Blender
    itself is not asked here.
    """
    monkeypatch.setitem(sys.modules, "bpy", MagicMock())
    page = (SCRIPT.parents[2] / "docs" / "engines.md").read_text(encoding="utf-8")
    user = script.sequence_texture([Path(f"{j:04d}.exr") for j in range(6)]).image_user
    (start,) = re.findall(r"\*\*Start\*\* (\d+)", page)
    (offset,) = re.findall(r"\*\*Offset (-?\d+)\*\*", page)
    assert (user.frame_start, user.frame_offset, user.frame_duration) == (
        int(start),
        int(offset),
        6,
    )
    assert user.use_cyclic is True
    assert user.use_auto_refresh is True
