"""
Bakes of cascades: tiles that are the cascade's own, in a folder with every guarantee of a bake.
"""

import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import warnings

import builders
import numpy as np
import pytest
from builders import tree

import fftocean as fo
from fftocean import statistics
from fftocean.baking import cascade_setup as water
from fftocean.baking import repair as mending
from fftocean.baking.cascade import bake_tiles, estimate_tiles
from fftocean.baking.folder import layout
from fftocean.baking.folder.lock import locked
from fftocean.baking.folder.sealed import sealed
from fftocean.baking.previews import sheets as preview
from fftocean.baking.scene.maps import MAPS
from fftocean.cli import main
from fftocean.files import as_json
from fftocean.grid import Grid
from fftocean.ocean import memory_needed

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
TILES = [(32, 200.0), (32, 29.0), (16, 4.1)]
SMALL = [(16, 100.0), (16, 15.0)]
JOB = builders.job(
    {
        "bake.frames": 3,
        "bake.maps": ["height", "stretch"],
        "bake.format": "exr-float",
        "bake.pictures": [],
    }
)


def told(folder):
    """Return the kind and path of each problem that `check` finds."""
    return {(f.kind, f.path) for f in fo.check(folder)}


def bake(folder, job=JOB, tiles=SMALL, **options):
    return bake_tiles(job, tiles, folder, **{"executor": "serial", **options})


@pytest.fixture(scope="module", autouse=True)
def remembered():
    """
    Integrals over the sea take most of the time of a small bake: each is made once. One picture for
    all, too.
    """
    with pytest.MonkeyPatch.context() as patch:
        for name in ("outside_band", "specified"):
            integrate, known = getattr(statistics, name), {}

            def look_up(*arguments, integrate=integrate, known=known):
                key = repr(arguments)
                if key not in known:
                    known[key] = integrate(*arguments)
                return known[key]

            patch.setattr(statistics, name, look_up)
        draw, drawn = preview.contact_sheet, {}

        def look_at(sea, frames, caption, **how):
            key = repr((sea, frames, caption, how))
            if key not in drawn:
                drawn[key] = draw(sea, frames, caption, **how)
            return drawn[key]

        patch.setattr(preview, "contact_sheet", look_at)
        yield


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A small cascade with a picture, and its bytes."""
    folder = tmp_path_factory.mktemp("made") / "sea"
    bake(folder, JOB.replaced({"bake.pictures": ["sheet", "tiling"]}))
    return folder, tree(folder)


@pytest.fixture
def copy(made, tmp_path):
    """The same in a folder that may be damaged."""
    shutil.copytree(made[0], tmp_path / "sea")
    return tmp_path / "sea"


# The tiles


def test_each_tile_is_the_cascade_s_own(tmp_path):
    """The files hold the values of `Cascade`, to the bit: the same seeds, the same bands."""
    listed = bake(tmp_path / "sea", tiles=TILES)
    cascade = fo.Cascade(
        JOB.sea(), TILES, seed=JOB.settings["ocean.seed"], loop=JOB.settings["ocean.loop"]
    )
    assert [tuple(map(float, tile["band"])) for tile in listed["tiles"]] == list(cascade.bands)
    baked = fo.load(tmp_path / "sea")
    assert len(baked) == 3
    for tile, ocean in zip(baked.tiles, cascade.oceans, strict=True):
        for j in range(3):
            assert np.array_equal(tile.maps["height"][j][..., 0], ocean.loop_frame(j, 3).height)
    shown = json.loads((tmp_path / "sea" / "cascade.json").read_text())
    assert shown["check"]
    assert shown == listed
    assert fo.check(tmp_path / "sea") == ()
    energy = sum(tile["m0"] for tile in listed["tiles"])
    assert energy == pytest.approx(cascade.variance, rel=1e-12)
    measured = fo.measure(cascade)
    assert listed["statistics"]["hs"] == pytest.approx(measured.hs, rel=1e-6)
    assert listed["statistics"]["energy_above"] == pytest.approx(measured.energy_above, rel=1e-6)


def test_loaded_tiles_add_up_to_the_sea(made):
    """At samples of both tiles: the sum of all waves, one by one; 2e-6 of float32."""
    baked = fo.load(made[0], maps=["height"], frames=[1, 2])
    assert baked.frames == (1, 2)
    cascade = fo.Cascade(
        JOB.sea(), SMALL, seed=JOB.settings["ocean.seed"], loop=JOB.settings["ocean.loop"]
    )
    x, y = 75.0 * np.arange(-3, 4), 150.0 * np.arange(7) - 225.0  # multiples of 100/16 and of 15/16
    w = cascade.modes()
    truth = (
        np.cos(np.outer(x, w.kx) + np.outer(y, w.ky) - w.omega * baked.times[1] - w.phase)
        @ w.amplitude
    )
    assert np.allclose(baked.summed("height", x, y, place=1)[:, 0], truth, atol=3e-6)
    with pytest.raises(fo.JobError, match="maps loaded"):
        baked.summed("stretch", x, y)
    with pytest.raises(fo.JobError, match="place"):
        baked.summed("height", x, y, place=2)


def test_bounds_add_up_and_hold(tmp_path):
    """
    No water goes higher or farther than the sums of the tiles' own extremes; the least Jacobian is
    that of the sum.
    """
    listed = bake(tmp_path / "sea", tiles=TILES)
    cascade = fo.Cascade(JOB.sea(), TILES, seed=1, loop=16.0)
    extremes = listed["extremes"]
    manifests = [
        json.loads((tmp_path / "sea" / t["path"] / "manifest.json").read_text())
        for t in listed["tiles"]
    ]
    window = fo.Window(cascade, n=64)
    for j in range(3):
        f = window.loop_frame(j, 3, ("height", "displace_x", "displace_y", "jacobian"))
        assert np.abs(f.height).max() <= extremes["max_height"]
        assert np.hypot(f.displace_x, f.displace_y).max() <= extremes["max_horizontal"]
    assert extremes["max_height"] == pytest.approx(
        sum(m["extremes"]["max_height"] for m in manifests), rel=1e-12
    )
    assert extremes["min_jacobian"] == fo.measure(cascade).folding.min_jacobian
    assert extremes["min_jacobian"] < min(m["extremes"]["min_jacobian"] for m in manifests)


# What cannot be had


@pytest.mark.parametrize("name", [name for name, m in MAPS.items() if not m.adds])
def test_what_does_not_add_up_is_refused_before_anything_is_written(tmp_path, name):
    with pytest.raises(
        fo.JobError,
        match=f"'{name}' cannot be baked for tiles: it is not linear.*bake (derivative and "
        f")?stretch",
    ):
        bake(tmp_path / "sea", JOB.replaced({"bake.maps": ["height", name]}))
    assert not (tmp_path / "sea").exists()
    assert water.INSTEAD[name]


def test_other_refusals(tmp_path):
    cases = [
        (
            JOB.replaced({"bake.lookup": "eulerian"}),
            SMALL,
            "'eulerian' cannot be baked for tiles.*fo.Query",
        ),
        (JOB.replaced({"ocean.band_low": 0.1}), SMALL, "ocean.band_low must be left out"),
        (JOB, [(16, 100.0), (16, 1.0)], "must overlap"),
        (JOB, 5, "a list of"),
        (JOB.replaced({"bake.format": "r16"}), SMALL, "cannot hold the map 'stretch'"),
        ("job", SMALL, "must be a Job"),
    ]
    for job, tiles, says in cases:
        with pytest.raises(fo.JobError, match=says):
            bake(tmp_path / "sea", job, tiles)
        assert not (tmp_path / "sea").exists()


def test_maps_that_are_not_named_are_the_ingredients(tmp_path):
    job = builders.job({"bake.frames": 1, "bake.pictures": []})
    with pytest.warns(fo.SeaWarning, match="displacement, derivative, stretch in place of"):
        listed = bake(tmp_path / "sea", job)
    assert [tile["maps"] for tile in listed["tiles"]] == 2 * [
        ["derivative", "displacement", "stretch"]
    ]


def test_which_maps_add_up():
    """
    By their definition: a map adds up if doubling the waves doubles it (or quadruples a
    covariance), on two seas of one tile.
    """
    one = fo.Ocean.from_modes(
        [(1, 0, 0.3, 0.1), (1, 2, 0.2, 1.0)], n=8, size=20.0, loop=8.0, dtype="float64"
    )
    two = fo.Ocean.from_modes(
        [(1, 0, 0.6, 0.1), (1, 2, 0.4, 1.0)], n=8, size=20.0, loop=8.0, dtype="float64"
    )
    for name, m in MAPS.items():
        needs = m.needs or ("height",)
        foams = [next(fo.Foam(threshold=0.97).loop(ocean, 1)) for ocean in (one, two)]
        a, b = (
            m.channels(ocean.frame(1.0, needs), foam)
            for ocean, foam in zip((one, two), foams, strict=True)
        )
        assert np.allclose(b, 2.0 * a, atol=1e-6) == m.adds, name


# Stopped and gone on with


KILLED = """
import os, signal, sys, warnings
warnings.simplefilter("ignore")
from fftocean.baking import cascade as tiles
from fftocean.job.job import Job
folder, at, *maps = sys.argv[1:]
def listen(event):
    if f"{event['event']}:{event.get('tile')}:{event.get('frame', '')}" == at:
        os.kill(os.getpid(), signal.SIGKILL)
changes = {"bake.frames": 3, "bake.maps": maps, "bake.format": "exr-float", "bake.pictures": []}
job = Job.default().replaced(changes)
tiles.bake_tiles(job, [(16, 100.0), (16, 15.0)], folder, executor="serial", listen=listen)
"""


@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
@pytest.mark.process
def test_killed_anywhere_the_same_command_comes_to_the_same_bytes(tmp_path):
    """Between the tiles, and within the second one; each time it goes on where it was."""
    folder = tmp_path / "sea"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    for at in ("tile:0:", "frame:1:1"):
        command = [sys.executable, "-c", KILLED, folder, at, *JOB.maps]
        done = subprocess.run(command, env=environment, capture_output=True, check=False)
        assert done.returncode == -signal.SIGKILL, done.stderr.decode()
        assert not (folder / "cascade.json").exists()
        assert ("unfinished", "cascade.json") in told(folder)
        with pytest.raises(fo.IntegrityError, match=r"cascade\.json does not exist"):
            fo.load(folder)
    bake(folder)
    bake(tmp_path / "undisturbed")
    assert tree(folder) == tree(tmp_path / "undisturbed")
    assert fo.check(folder) == ()


def test_finished_frames_are_kept(copy):
    """A second run of a finished bake writes no frame again."""
    events = []
    bake(copy, JOB.replaced({"bake.pictures": ["sheet", "tiling"]}), listen=events.append)
    assert [e["kept"] for e in events if e["event"] == "start"] == [3, 3]
    assert not [e for e in events if e["event"] == "frame"]
    assert [(e["event"], e.get("tile")) for e in events if e["event"] in ("tile", "done")] == [
        ("tile", 0),
        ("tile", 1),
        ("done", None),
    ]


def test_progress_counts_all_tiles(tmp_path):
    seen = []
    bake(tmp_path / "sea", progress=lambda done, total: seen.append((done, total)))
    assert seen == [(i, 6) for i in range(1, 7)]


def test_a_changed_job_is_refused_and_changes_nothing(made, copy):
    same = JOB.replaced({"bake.pictures": ["sheet", "tiling"]})
    for job, tiles, says in (
        (same.replaced({"sea.wind.speed": 8.0}), SMALL, "sea.wind.speed: 7.0 there, 8.0 here"),
        (same, [(16, 100.0), (20, 15.0)], "tiles"),
        (same, SMALL[:1], "tiles"),
        (same.replaced({"ocean.seed": 9}), SMALL, "ocean.seed"),
    ):
        with pytest.raises(fo.OutputError, match=f"holds the cascade of another job .*{says}"):
            bake(copy, job, tiles)
        assert tree(copy) == made[1]


def test_one_tile_and_a_cascade_do_not_mix(made, copy, tmp_path):
    with pytest.raises(fo.OutputError, match="holds the tiles of a cascade"):
        fo.bake(JOB.replaced({"ocean.n": 8}), copy, executor="serial")
    assert tree(copy) == made[1]
    fo.bake(JOB.replaced({"ocean.n": 8}), tmp_path / "one", executor="serial")
    before = tree(tmp_path / "one")
    with pytest.raises(fo.OutputError, match="holds the bake of one tile"):
        bake(tmp_path / "one")
    assert tree(tmp_path / "one") == before


def test_overwriting_removes_what_was_baked_and_nothing_else(copy, tmp_path):
    (copy / "notes.txt").write_text("mine")
    (copy / "tile0" / "mine.txt").write_text("mine")
    (copy / "tile7").mkdir()
    (copy / "tile7" / "photo.exr").write_text("mine")
    bake(copy, JOB, SMALL[:1], overwrite=True)
    bake(tmp_path / "fresh", JOB, SMALL[:1])
    ours = tree(tmp_path / "fresh")
    assert {path: data for path, data in tree(copy).items() if data != b"mine"} == ours
    assert {path for path, data in tree(copy).items() if data == b"mine"} == {
        "notes.txt",
        "tile0/mine.txt",
        "tile7/photo.exr",
    }
    fo.bake(JOB.replaced({"ocean.n": 8}), copy, executor="serial", overwrite=True)
    assert not layout.is_cascade(copy)
    assert fo.check(copy) == ()


def test_an_unfinished_cascade_has_no_list(copy):
    """Nor while it is baked again: the list goes before the first tile is touched."""

    def stop(_):
        raise InterruptedError

    same = JOB.replaced({"bake.pictures": ["sheet", "tiling"]})
    with pytest.raises(InterruptedError):
        bake(copy, same, listen=stop)
    assert not (copy / "cascade.json").exists()
    assert ("unfinished", "cascade.json") in told(copy)


def test_one_tile_is_replaced_by_a_cascade_on_request(tmp_path):
    """Nothing of the one tile is left among the tiles."""
    fo.bake(JOB.replaced({"ocean.n": 8}), tmp_path / "sea", executor="serial")
    bake(tmp_path / "sea", overwrite=True)
    bake(tmp_path / "fresh")
    assert tree(tmp_path / "sea") == tree(tmp_path / "fresh")
    assert fo.check(tmp_path / "sea") == ()


def test_a_folder_in_use_is_refused(copy, capsys):
    """Exit code 6 for the cascade, for a bake of one tile into it, and for a check."""
    copy_flags = ["bake", "-o", str(copy), "--quiet", "--frames", "1"]
    with locked(copy):
        assert main([*copy_flags, "--tiles", "16:100,16:15"]) == 6
        assert main(copy_flags) == 6
        assert main(["check", str(copy)]) == 6
    assert "in use" in capsys.readouterr().err


# Checked and mended


def relisted(folder, change):
    """Change the list of a cascade so that its own check still holds."""
    listed = json.loads((folder / "cascade.json").read_text())
    del listed["check"]
    change(listed)
    (folder / "cascade.json").write_bytes(as_json(sealed(listed)))


def flip(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(bytes(data))


DAMAGES = {
    "a frame": (
        lambda d: flip(d / "tile1/height/0001.exr"),
        {("changed", "tile1/height/0001.exr")},
    ),
    "a frame is gone": (
        lambda d: (d / "tile0/stretch/0002.exr").unlink(),
        {("missing", "tile0/stretch/0002.exr")},
    ),
    "the picture": (lambda d: flip(d / "preview.png"), {("changed", "preview.png")}),
    "the picture is gone": (lambda d: (d / "preview.png").unlink(), {("missing", "preview.png")}),
    "a manifest": (
        lambda d: flip(d / "tile1/manifest.json"),
        {("manifest", "tile1/manifest.json")},
    ),
    "a manifest is gone": (
        lambda d: (d / "tile1/manifest.json").unlink(),
        {("unfinished", "tile1/manifest.json")},
    ),
    "a tile is gone": (lambda d: shutil.rmtree(d / "tile0"), {("missing", "tile0/manifest.json")}),
    "the list": (lambda d: flip(d / "cascade.json"), {("manifest", "cascade.json")}),
    "the list is gone": (lambda d: (d / "cascade.json").unlink(), {("unfinished", "cascade.json")}),
    "the job": (lambda d: flip(d / "cascade-job.json"), {("job", "cascade-job.json")}),
    "the job is gone": (
        lambda d: (d / "cascade-job.json").unlink(),
        {("missing", "cascade-job.json")},
    ),
    "a tile's job is gone": (
        lambda d: (d / "tile1/job.json").unlink(),
        {("missing", "tile1/job.json")},
    ),
    "a tile too many": (lambda d: shutil.copytree(d / "tile1", d / "tile2"), {("extra", "tile2")}),
    "a picture too many": (
        lambda d: (d / "tiling.png").write_bytes(b"x"),
        {("extra", "tiling.png")},
    ),
    "a torn file": (
        lambda d: (d / ".cascade.json.12-ab.tmp").write_bytes(b"x"),
        {("extra", ".cascade.json.12-ab.tmp")},
    ),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_every_damage_is_found_and_repaired_to_the_same_bytes(made, copy, name):
    damage, expected = DAMAGES[name]
    damage(copy)
    assert told(copy) == expected
    assert fo.repair(copy, executor="serial")["tiles"]
    assert tree(copy) == made[1]
    assert fo.check(copy) == ()


LIES = {
    "bands that overlap": lambda c: c["tiles"][1].update(band=[0.1, "inf"]),
    "a gap between bands": lambda c: c["tiles"][1].update(band=[99.0, "inf"]),
    "another seed": lambda c: c["tiles"][1].update(seed=3),
    "another size": lambda c: c["tiles"][0].update(size=[100.5, 100.0]),
    "another energy": lambda c: c["tiles"][0].update(m0=1.0),
    "a tile less": lambda c: c["tiles"].pop(),
    "another sea": lambda c: c["job"].update({"sea.wind.speed": 9.0}),
    "bounds too small": lambda c: c["extremes"].update(max_height=0.1),
    "tiles swapped": lambda c: c["tiles"].reverse(),
}


@pytest.mark.parametrize("bands", [[0.2, 0.1], [0.2, 0.3], [0.2, 0.2, 0.9]])
def test_a_list_whose_bands_do_not_adjoin_says_so(copy, bands):
    """From 0 to infinity, each where the one before ends."""

    def change(listed):
        first, second = listed["tiles"]
        first["band"], second["band"] = [0.0, bands[0]], [bands[1], (*bands, "inf")[2]]

    relisted(copy, change)
    details = [finding.detail for finding in fo.check(copy) if finding.path == "cascade.json"]
    assert any("do not adjoin from 0 to inf" in detail for detail in details)


@pytest.mark.parametrize("name", LIES)
def test_a_list_that_contradicts_its_tiles_is_found(copy, name):
    """Though its own checksum is right."""
    relisted(copy, LIES[name])
    assert "cascade.json" in {path for kind, path in told(copy) if kind == "manifest"}


def test_a_tile_of_another_sea_is_found(copy, tmp_path):
    """
    Each tile is a faultless bake, and they are not one sea: another choppiness; another loop; the
    same job with other frames.
    """
    for key, value in (("ocean.choppiness", 0.5), ("ocean.loop", 20.0), ("bake.frames", 4)):
        other = tmp_path / key
        bake(other, JOB.replaced({"bake.pictures": ["sheet", "tiling"], key: value}))
        shutil.rmtree(copy / "tile1")
        shutil.copytree(other / "tile1", copy / "tile1")
        assert fo.check(copy / "tile1") == ()
        assert ("manifest", "tile1/manifest.json") in told(copy)
        with pytest.raises(
            fo.IntegrityError, match=r"is not the manifest that cascade\.json lists"
        ):
            fo.load(copy)
        sha = hashlib.sha256((copy / "tile1/manifest.json").read_bytes()).hexdigest()
        relisted(
            copy, lambda c, sha=sha: c["tiles"][1].update(sha256=sha)
        )  # even where the list names that very manifest
        assert any("its job is not that of tile1" in finding.detail for finding in fo.check(copy))


def test_another_manifest_of_the_same_tile_is_found(copy):
    """Its own checksum is right, and all that the list repeats of it: only its SHA-256 differs."""
    path = copy / "tile1" / "manifest.json"
    manifest = json.loads(path.read_text())
    del manifest["check"]
    manifest["statistics"]["hs"] *= 1.5
    path.write_bytes(as_json(sealed(manifest)))
    assert fo.check(copy / "tile1") == ()
    assert told(copy) == {("manifest", "tile1/manifest.json")}


def test_a_repair_that_gives_another_list_is_an_error(copy, monkeypatch):
    """The bytes of the first bake are promised, or nothing."""
    flip(copy / "tile0/height/0001.exr")
    real = mending.bake_tiles
    monkeypatch.setattr(
        mending, "bake_tiles", lambda *a, **k: {**real(*a, **k), "version": "another"}
    )
    with pytest.raises(fo.IntegrityError, match=r"its cascade\.json differs from the first one"):
        fo.repair(copy, executor="serial")


def test_a_cascade_that_says_nothing_of_itself_is_not_repaired(copy):
    (copy / "cascade.json").unlink()
    flip(copy / "cascade-job.json")
    with pytest.raises(
        fo.IntegrityError, match=r"neither cascade\.json nor cascade-job\.json is readable"
    ):
        fo.repair(copy, executor="serial")


# At the command line


def test_from_the_command_line(tmp_path, capsys):
    folder = str(tmp_path / "sea")
    flags = [
        "bake",
        "-o",
        folder,
        "--frames",
        "1",
        "--maps",
        "height",
        "--executor",
        "serial",
        "--set",
        'bake.pictures=["sheet"]',
    ]
    tiles = ["--tiles", "16:100,16:15"]
    assert main([*flags, *tiles]) == 0
    out = capsys.readouterr().out
    for line in (
        "tile1: 16 x 16 over 15 x 15 m",
        "specified",
        "realised by all tiles",
        "energy outside the bands",
        "preview.png",
    ):
        assert line in out
    assert main([*flags, *tiles]) == 0  # goes on, or finds all done
    assert main(["check", folder]) == 0
    (tmp_path / "sea" / "tile1" / "height" / "0000.exr").unlink()
    assert main(["check", folder, "--quiet"]) == 5
    assert main(["check", folder, "--repair", "--executor", "serial"]) == 0
    capsys.readouterr()
    assert main([*flags, "--tiles", "16:100,16:1"]) == 2
    assert "tiles must overlap in wavenumbers" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        main([*flags, "--tiles", "16x100"])


def test_a_dry_run_says_what_the_run_writes(tmp_path, capsys):
    flags = [
        "bake",
        "-o",
        str(tmp_path / "sea"),
        "--frames",
        "3",
        "--executor",
        "serial",
        "--tiles",
        "16:100,16:15",
        "--json",
        "--set",
        'bake.pictures=["sheet"]',
    ]
    assert main([*flags, "--maps", "height,stretch", "--dry-run"]) == 0
    told_before = json.loads(capsys.readouterr().out)
    assert not (tmp_path / "sea").exists()
    assert main([*flags, "--maps", "height,stretch"]) == 0
    files = tree(tmp_path / "sea")
    assert told_before["files"] == len(files)
    assert told_before["bytes"] < 2**20
    assert main([*flags, "--maps", "height,foam", "--dry-run"]) == 2
    assert estimate_tiles(JOB, SMALL, executor="serial").frames == 3


def test_memory_is_that_of_all_tiles_only_in_one_process():
    """One process holds the tiles side by side; of several, each holds one tile at a time."""
    each = [memory_needed(Grid.of(n, size), "float32") for n, size in TILES]
    assert estimate_tiles(JOB, TILES, executor="serial").memory == sum(each)
    assert estimate_tiles(JOB, TILES, executor="processes", workers=2).memory == max(each)


def test_tiles_are_in_the_order_of_their_numbers(tmp_path):
    """The eleventh after the third; and nothing that is no folder of a tile."""
    for name in ("tile10", "tile2", "tile0", "tile", "tile3b", "tiles"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "job.json").write_text("{}")
    (tmp_path / "tile4").mkdir()
    (tmp_path / "tile5").write_text("a file")
    (tmp_path / "tile6").symlink_to(tmp_path / "tile0")
    (tmp_path / "tile7").mkdir()
    (tmp_path / "tile7" / "manifest.json").write_text("{}")
    assert layout.tile_folders(tmp_path) == ["tile0", "tile2", "tile7", "tile10"]


def test_info_of_tiles(capsys):
    assert main(["info", "--tiles", "16:100,16:15", "--frames", "2"]) == 0
    out = capsys.readouterr().out
    for line in (
        "tile1",
        "16 x 16 over 15 x 15 m",
        "m specified",
        "realised by all tiles",
        "energy outside",
        "choppiness up to",
        "files",
    ):
        assert line in out


def test_a_band_of_one_tile_keeps_its_waves():
    sea = JOB.sea()
    whole = fo.Ocean(sea, n=32, size=200.0, seed=3).amplitudes
    part = fo.Ocean(sea, n=32, size=200.0, seed=3, band=(0.2, 0.4)).amplitudes
    k = part.grid.k
    inside, outside = (k > 0.25) & (k < 0.35), (k < 0.15) | (k > 0.45)
    assert np.array_equal(part.forward[inside], whole.forward[inside])
    assert not np.any(part.forward[outside])
    for bad in ((0.4, 0.2), (1.0,), 3.0, (-1.0, 2.0), (0.2, np.nan)):
        with pytest.raises(fo.ParameterError, match="band"):
            fo.Ocean(sea, n=8, size=10.0, band=bad)


def test_a_part_of_the_loop_at_half_the_samples(tmp_path):
    """`frames` and `downsample` go through to every tile, and are part of what the folder is."""
    folder = tmp_path / "sea"
    listed = bake(folder, frames="0:3:2", downsample=2)
    assert (listed["subset"], listed["downsample"]) == ("0:3:2", 2)
    assert fo.check(folder) == ()
    baked = fo.load(folder)
    assert baked.frames == (0, 2)
    assert baked[1]["height"].shape == (2, 8, 8, 1)
    with pytest.raises(fo.OutputError, match="downsample"):
        bake(folder, frames="0:3:2")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        flip(folder / "tile0/height/0002.exr")
        fo.repair(folder, executor="serial")
    assert fo.check(folder) == ()
