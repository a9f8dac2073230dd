"""Files that play a bake in its engine: whole, checked, repaired, and never a user's own."""

import json
import re

import builders
import pytest

import fftocean as fo
from fftocean.baking.cascade import bake_tiles, estimate_tiles
from fftocean.baking.estimate import estimate
from fftocean.baking.folder import engine_files
from fftocean.baking.repair import repair
from fftocean.errors import OutputError
from fftocean.example_projects import project_files
from fftocean.export.engines import TABLE, Refusal

SMALL = {"ocean.n": 16, "bake.frames": 2, "bake.pictures": [], "bake.maps": ["displacement"]}
SCENE = ("sea_bake.tscn", "sea_bake.gd", "sea_bake.gdshader", "sea_bake_maps.gdshaderinc")
SCENE += ("sea_light.gdshaderinc", "sea_mesh.gd", "sea_buoy.gd", "sea_camera.gd")


def job(engine, form="bin", **changes):
    changes = {key.replace("__", "."): value for key, value in changes.items()}
    return builders.job({**SMALL, "bake.engine": engine, "bake.format": form, **changes})


def bake(asked, folder, **options):
    return fo.bake(asked, folder, executor="serial", **options)


def listed(document):
    return [entry["path"] for entry in document.get("engine_files", [])]


@pytest.mark.parametrize(
    ("engine", "form", "files"),
    [
        ("godot", "bin", SCENE),
        ("godot", "exr", SCENE),
        ("godot", "npz", ()),
        ("unity", "bin", ("FFToceanBakeImport.cs",)),
        ("unreal", "exr", ("fftocean_bake_import.py",)),
        ("unreal", "bin", ()),
        ("blender", "exr", ()),
        ("canonical", "bin", ()),
    ],
)
def test_a_bake_has_the_files_of_its_engine(engine, form, files, tmp_path):
    """Those of `examples/`, byte for byte, listed in the manifest, unchanged."""
    manifest = bake(job(engine, form), tmp_path)
    assert listed(manifest) == list(files)
    here = {path.name for path in tmp_path.iterdir()} & engine_files.NAMES
    assert here == set(files)
    if files:
        sources = project_files(engine_files.PLAYERS[engine].project)
        for name in files:
            assert (tmp_path / name).read_bytes() == sources[name].read_bytes()
    assert fo.check(tmp_path) == ()


def test_a_page_is_told_its_document(tmp_path):
    bake(job("three"), tmp_path / "one")
    asked = job("three", bake__maps=["displacement", "derivative", "stretch"])
    bake_tiles(asked, [(16, 100.0), (16, 15.0)], tmp_path / "two", executor="serial")
    for folder, document in (("one", "manifest.json"), ("two", "cascade.json")):
        page = (tmp_path / folder / "index.html").read_text(encoding="utf-8")
        assert re.findall(r'data-sea="([^"]+)"', page) == [document]


def test_every_player_has_its_files_and_can_read_its_formats():
    for engine, player in engine_files.PLAYERS.items():
        assert set(player.files) <= set(project_files(player.project)), engine
        for form in player.formats:
            assert not isinstance(TABLE[engine, form], Refusal), (engine, form)


def test_a_bake_can_leave_them_out(tmp_path):
    manifest = bake(job("three", bake__engine_files=False), tmp_path)
    assert listed(manifest) == []
    assert not (tmp_path / "index.html").exists()
    assert fo.check(tmp_path) == ()


def test_a_map_that_gives_no_place_has_no_player(tmp_path):
    """A page cannot show the water of a bake of foam alone."""
    assert listed(bake(job("three", bake__maps=["jacobian"]), tmp_path)) == []


def test_a_cascade_has_one_set_of_files(tmp_path):
    """Beside the list of the tiles, not in each of them; and check, repair and resume know them."""
    asked = job("godot", bake__maps=["displacement", "derivative", "stretch"])
    tiles = [(16, 100.0), (16, 15.0)]
    before = bake_tiles(asked, tiles, tmp_path, executor="serial")
    assert listed(before) == list(SCENE)
    assert not [path for path in tmp_path.glob("tile*/*") if path.name in engine_files.NAMES]
    assert fo.check(tmp_path) == ()
    (tmp_path / "sea_mesh.gd").write_text("changed")
    (tmp_path / "sea_bake.gd").unlink()
    found = {finding.path: finding.kind for finding in fo.check(tmp_path)}
    assert found == {"sea_mesh.gd": "cut", "sea_bake.gd": "missing"}
    assert repair(tmp_path, executor="serial") == before
    assert fo.check(tmp_path) == ()
    held = sum(
        json.loads((tmp_path / tile / "manifest.json").read_text())["video_memory"]["bytes"]
        for tile in ("tile0", "tile1")
    )
    assert before["video_memory"]["bytes"] == held
    assert estimate_tiles(asked, tiles).video == held


def test_check_and_repair_know_them(tmp_path):
    before = bake(job("three"), tmp_path)
    (tmp_path / "water.js").write_bytes((tmp_path / "water.js").read_bytes() + b"\n")
    (tmp_path / "sky.js").unlink()
    found = {finding.path: finding.kind for finding in fo.check(tmp_path)}
    assert found == {"water.js": "changed", "sky.js": "missing"}
    assert repair(tmp_path, executor="serial") == before
    assert fo.check(tmp_path) == ()


def test_a_manifest_that_lists_others_is_found(tmp_path):
    """A path in the manifest does not make check read outside the folder."""
    from fftocean.baking.folder.sealed import sealed
    from fftocean.files import as_json

    manifest = bake(job("three"), tmp_path)
    manifest["engine_files"][0]["path"] = "../index.html"
    (tmp_path / "manifest.json").write_bytes(as_json(sealed(manifest)))
    assert [finding.kind for finding in fo.check(tmp_path)] == ["manifest"]


def test_the_same_bake_again_writes_the_same_files(tmp_path):
    first = bake(job("three"), tmp_path)
    data = {path.name: path.read_bytes() for path in tmp_path.glob("*") if path.is_file()}
    assert bake(job("three"), tmp_path) == first
    assert {p.name: p.read_bytes() for p in tmp_path.glob("*") if p.is_file()} == data


def test_another_bake_removes_them(tmp_path):
    """With `overwrite`, those of the earlier bake go, whatever its engine."""
    bake(job("three"), tmp_path)
    bake(job("godot"), tmp_path, overwrite=True)
    assert {path.name for path in tmp_path.iterdir()} & engine_files.NAMES == set(SCENE)
    asked = job("three", bake__maps=["displacement", "derivative", "stretch"])
    tiles = [(16, 100.0), (16, 15.0)]
    bake_tiles(asked, tiles, tmp_path, executor="serial", overwrite=True)
    page = set(engine_files.PLAYERS["three"].files)
    assert {path.name for path in tmp_path.iterdir()} & engine_files.NAMES == page
    bake(job("canonical"), tmp_path, overwrite=True)
    assert not {path.name for path in tmp_path.iterdir()} & engine_files.NAMES
    assert fo.check(tmp_path) == ()


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_file_of_the_user_is_never_replaced(overwrite, tmp_path):
    """Nor does it hinder a bake that has no file of that name."""
    (tmp_path / "index.html").write_text("my own page")
    with pytest.raises(OutputError, match=r"index\.html"):
        bake(job("three"), tmp_path, overwrite=overwrite)
    asked = job("three", bake__maps=["displacement", "derivative", "stretch"])
    with pytest.raises(OutputError, match=r"index\.html"):
        bake_tiles(asked, [(16, 9.0)], tmp_path, executor="serial", overwrite=overwrite)
    bake(job("godot"), tmp_path, overwrite=overwrite)
    assert fo.check(tmp_path) == ()
    repair(tmp_path, executor="serial")
    assert (tmp_path / "index.html").read_text() == "my own page"


def test_a_bake_without_its_manifest_has_no_finished_files(tmp_path, monkeypatch):
    """A bake that is stopped before they are written has no manifest, and resumes."""
    from fftocean.baking import bake as module

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(module.engine_files, "write_player", stopped)
    with pytest.raises(KeyboardInterrupt):
        bake(job("three"), tmp_path)
    assert not (tmp_path / "manifest.json").exists()
    monkeypatch.undo()
    bake(job("three"), tmp_path)
    assert fo.check(tmp_path) == ()


@pytest.mark.parametrize(
    ("form", "maps", "texel"),
    [
        ("bin", ["height"], 8),  # files of four channels
        ("bin", ["displacement", "foam"], 16),
        ("exr", ["height", "derivative"], 16),  # loaders make four channels of three
        ("exr-float", ["displacement"], 16),
        ("npz", ["height", "displacement"], 20),  # float32, 1 and 3, held as 4
    ],
)
def test_video_memory_is_that_of_all_frames_without_compression(form, maps, texel, tmp_path):
    asked = job("three", form, bake__maps=maps)
    held = bake(asked, tmp_path)["video_memory"]
    assert held["bytes"] == 2 * 16 * 16 * texel == estimate(asked).video
    assert held["bytes_a_frame"] == 16 * 16 * texel
    # 16, 8, 4, 2 and 1 texels a side
    assert held["bytes_with_all_levels"] == 2 * (256 + 64 + 16 + 4 + 1) * texel


def test_video_memory_has_the_mip_levels_that_the_files_have(tmp_path):
    held = bake(job("three", "ktx2", bake__mips=True), tmp_path)["video_memory"]
    assert held["bytes"] == held["bytes_with_all_levels"] == 2 * 341 * 8


def test_an_estimate_counts_them(tmp_path):
    asked = job("godot")
    bake(asked, tmp_path)
    assert estimate(asked).files == sum(path.is_file() for path in tmp_path.rglob("*"))


def test_the_players_are_of_known_engines():
    odd = {"nowhere": engine_files.PLAYERS["three"]}
    with pytest.raises(ImportError, match="nowhere"):
        engine_files.players_of(odd)


def test_godot_imports_every_frame_as_data(tmp_path):
    """
    An `.import` beside each EXR, which Godot may add lines to; a changed one is found and restored.
    """
    asked = job("godot", "exr")
    before = bake(asked, tmp_path)
    beside = sorted(path.name for path in (tmp_path / "displacement").glob("*.import"))
    assert beside == ["0000.exr.import", "0001.exr.import"]
    path = tmp_path / "displacement" / beside[0]
    text = path.read_text()
    assert "compress/mode=3" in text
    assert "detect_3d/compress_to=0" in text
    assert fo.check(tmp_path) == ()
    assert estimate(asked).files == sum(one.is_file() for one in tmp_path.rglob("*"))
    path.write_text(text + 'path="res://.godot/imported/0000.exr-1.ctex"\n')
    assert fo.check(tmp_path) == ()
    path.write_text(text.replace("compress/mode=3", "compress/mode=2"))
    (tmp_path / "displacement" / beside[1]).unlink()
    found = {finding.path: finding.kind for finding in fo.check(tmp_path)}
    assert found == {
        "displacement/0000.exr.import": "changed",
        "displacement/0001.exr.import": "missing",
    }
    assert repair(tmp_path, executor="serial") == before
    bake(job("canonical"), tmp_path, overwrite=True)
    assert not list(tmp_path.rglob("*.import"))


def test_settings_that_godot_made_itself_are_the_users(tmp_path):
    """Godot writes an `.import` beside every image: beside other engines' images it is no extra."""
    bake(job("canonical", "exr"), tmp_path)
    own = tmp_path / "displacement" / "0000.exr.import"
    own.write_text("Godot's own")
    assert fo.check(tmp_path) == ()
    repair(tmp_path, executor="serial")
    bake(job("blender", "exr"), tmp_path, overwrite=True)
    assert own.read_text() == "Godot's own"


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_link_to_nowhere_is_a_file_of_somebody(overwrite, tmp_path):
    """Such a link is neither replaced nor written through."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "index.html").symlink_to(tmp_path / "nowhere")
    with pytest.raises(OutputError, match=r"(contains|holds) index\.html"):
        bake(job("three"), tmp_path / "out", overwrite=overwrite)
    assert (tmp_path / "out" / "index.html").is_symlink()
    assert not (tmp_path / "nowhere").exists()
    found = engine_files.existing(tmp_path / "out", ["index.html", "sky.js"])
    assert found == [tmp_path / "out" / "index.html"]


@pytest.mark.parametrize(
    ("engine", "form", "changes", "words"),
    [
        ("three", "bin", {}, "to play it with three: `npm install three`"),
        ("three", "npz", {}, "no files to play it with three: they read exr, "),
        ("three", "bin", {"bake__maps": ["foam"]}, "with three: they need one of displacement"),
        ("three", "bin", {"bake__engine_files": False}, "bake.engine_files is false"),
        ("houdini", "exr", {}, "no files to play it with houdini: docs/engines.md"),
    ],
)
def test_a_bake_says_what_plays_it(engine, form, changes, words):
    assert words in engine_files.in_words(job(engine, form, **changes).describe())
