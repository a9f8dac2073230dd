"""
Bakes: complete files or none, the manifest last, nothing outside the folder, the same bytes again.
"""

import dataclasses
import errno
import functools
import hashlib
import inspect
import io
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import builders
import numpy as np
import pytest
from builders import environment, tree
from PIL import Image

import fftocean as fo
from fftocean import files
from fftocean.baking import bake as baker
from fftocean.baking.previews import sheets as preview
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import OutputError
from fftocean.export import exr
from fftocean.statistics import SeaState

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")


def job(**changes):
    """A small job of the default sea; keys with __ for the dot."""
    return builders.job(
        {
            "ocean.n": 8,
            "bake.frames": 2,
            "bake.maps": ["height", "normal"],
            **{k.replace("__", "."): v for k, v in changes.items()},
        }
    )


@pytest.fixture
def quick(monkeypatch):
    """
    No picture and no integrals over the sea, which take most of the time of a small bake; they have
    their own tests.
    """
    monkeypatch.setattr(baker, "measure", lambda _: some_statistics())
    monkeypatch.setattr(
        preview, "contact_sheet", lambda *_, **__: b"\x89PNG a picture of the sea" * 40
    )
    monkeypatch.setattr(preview, "animation", lambda *_, **__: b"RIFF a film of the sea" * 40)


@functools.cache
def some_statistics():
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    return dataclasses.replace(
        still, specified=SeaState(m0=0.1, hs=1.26, tp=5.0, mean_direction=0.0, spread=30.0)
    )


def made(folder):
    """The same without the journal and whatever else a bake that is under way keeps to itself."""
    return {name: data for name, data in tree(folder).items() if not name.startswith(".work/")}


def strict(data):
    """JSON as the standard has it: NaN and Infinity are not in it."""

    def refuse(word):
        raise AssertionError(f"{word} is not JSON")

    return json.loads(data, parse_constant=refuse)


# What is written


SMALL_PICTURE = {"WIDTH": 320, "VIEW_HEIGHT": 115, "THUMBNAIL": 40}


@pytest.fixture
def small_picture(monkeypatch):
    """A contact sheet of a sixteenth of the pixels."""
    for name, value in SMALL_PICTURE.items():
        monkeypatch.setattr(preview, name, value)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """
    One bake with nothing left out: four maps of a tile that is not square, its picture (but small)
    and its statistics.
    """
    folder = tmp_path_factory.mktemp("whole") / "out"
    settings = {
        "ocean__n": (12, 7),
        "ocean__size": (60.0, 35.0),
        "bake__frames": 3,
        "bake__maps": ["displacement", "normal", "jacobian", "height"],
    }
    sea_job = job(**settings, sea__depth=5.0, ocean__choppiness=1.3)
    with pytest.MonkeyPatch.context() as patch:
        for name, value in SMALL_PICTURE.items():
            patch.setattr(preview, name, value)
        return sea_job, folder, fo.bake(sea_job, folder)


def test_the_manifest_is_strict_json_and_what_bake_returns(whole):
    _, folder, manifest = whole
    assert strict((folder / "manifest.json").read_bytes()) == manifest
    assert manifest["tool"] == "fftocean"
    assert manifest["version"] == fo.__version__


def test_the_folder_holds_what_the_manifest_lists_and_no_more(whole):
    _, folder, manifest = whole
    listed = {f["path"] for row in manifest["frames"] for f in row["files"].values()}
    assert set(tree(folder)) == listed | {
        "manifest.json",
        "job.json",
        "preview.png",
        "preview.webp",
    }
    assert listed == {
        f"{name}/{j:04d}.exr" for name in manifest["maps"] for j in range(3)
    }  # three frames: the fourth is the first


def test_checksums_are_those_of_the_files(whole):
    _, folder, manifest = whole
    for entry in (
        manifest["preview"],
        *(f for row in manifest["frames"] for f in row["files"].values()),
    ):
        assert hashlib.sha256((folder / entry["path"]).read_bytes()).hexdigest() == entry["sha256"]


def test_maps_are_the_fields_of_the_ocean(whole):
    """
    To the half: each channel of each map against the ocean's own frame at that moment, displacement
    times choppiness.
    """
    sea_job, folder, manifest = whole
    ocean = sea_job.ocean()
    for j, row in enumerate(manifest["frames"]):
        frame = ocean.loop_frame(j, 3, ("height", "displace_x", "displace_y", "normal", "jacobian"))
        assert (row["frame"], row["t"]) == (j, 16.0 * j / 3)
        expected = {
            "height": [frame.height] * 3,
            "displacement": [
                frame.displace_x * np.float32(1.3),
                frame.displace_y * np.float32(1.3),
                frame.height,
            ],
            "normal": [frame.normal[..., i] for i in range(3)],
            "jacobian": [frame.jacobian] * 3,
        }
        for name, channels in expected.items():
            got = exr.decode((folder / row["files"][name]["path"]).read_bytes())
            for ours, theirs in zip(channels, got, strict=True):
                assert ours.shape == theirs.shape == (7, 12)
                assert np.array_equal(ours.astype(np.float16), theirs)


def test_ranges_hold_for_every_stored_pixel_of_the_sequence(whole):
    """One pair a map for all frames and channels, attained at both ends."""
    _, folder, manifest = whole
    for name, entry in manifest["maps"].items():
        stored = [
            np.stack(exr.decode((folder / row["files"][name]["path"]).read_bytes()))
            for row in manifest["frames"]
        ]
        assert entry["range"] == [float(np.min(stored)), float(np.max(stored))]
        assert set(entry["channels"]) == set("RGB")
        assert (entry["format"], entry["stored"]) == ("exr", "float16")


def test_extremes_bound_the_water(whole):
    """Of the unrounded frames: for culling, and to know whether the surface folds."""
    sea_job, _, manifest = whole
    ocean, most = sea_job.ocean(), manifest["extremes"]
    frames = [
        ocean.loop_frame(j, 3, ("height", "displace_x", "displace_y", "jacobian")) for j in range(3)
    ]
    assert most["max_height"] == max(float(np.abs(f.height).max()) for f in frames)
    lowest = min(float(f.jacobian.min()) for f in frames)
    assert most["min_jacobian"] == pytest.approx(lowest, abs=1e-6)  # which is rounded to float32
    across = max(
        float(np.hypot(f.displace_x.astype(float), f.displace_y.astype(float)).max()) * 1.3
        for f in frames
    )
    assert most["max_horizontal"] == pytest.approx(across, rel=1e-6)  # float32


def test_the_last_frame_leads_to_the_first(whole):
    """Frame F is frame 0, to the bit, and is not stored."""
    sea_job, folder, manifest = whole
    after = sea_job.ocean().loop_frame(3, 3, ("height",)).height
    first, _, _ = exr.decode(
        (folder / manifest["frames"][0]["files"]["height"]["path"]).read_bytes()
    )
    assert np.array_equal(after.astype(np.float16), first)
    assert manifest["frames"][-1]["t"] < manifest["ocean"]["loop"]


def test_the_manifest_has_the_specified_and_the_realised_statistics(whole):
    sea_job, _, manifest = whole
    assert manifest["job"] == sea_job.describe()
    assert manifest["units"]["sea.wind.speed"] == "m/s"
    assert manifest["ocean"]["n"] == [12, 7]
    assert manifest["ocean"]["size"] == [60.0, 35.0]
    assert manifest["ocean"]["depth"] == 5.0
    measured = fo.measure(sea_job.ocean())
    assert manifest["statistics"]["hs"] == measured.hs
    assert manifest["statistics"]["ordered"]["hs"] == measured.specified.hs
    assert manifest["statistics"]["loop"]["period"] == 16.0


@pytest.mark.process
def test_another_process_writes_the_same_bytes(whole, tmp_path):
    """
    The whole folder, picture and manifest too: no clock, no process number, no order of hashing
    gets in.
    """
    sea_job, folder, _ = whole
    text = (
        "sea.depth = 5.0\n[sea.wind]\nspeed = 7.0\nfetch = 35e3\ndirection = 25.0\n[ocean]\nn "
        "= [12, 7]\nsize = [60, 35]\nseed = 1\n"
    )
    text += (
        "loop = 16\nchoppiness = 1.3\n[bake]\nframes = 3\nmaps = ['displacement', 'normal', "
        "'jacobian', 'height']\n"
    )
    (tmp_path / "job.toml").write_text(text)
    assert fo.Job.read(tmp_path / "job.toml").settings == sea_job.settings
    program = (
        "import sys; from fftocean import cli; from fftocean.baking.previews import sheets as "
        "preview; "
    )
    program += (
        f"vars(preview).update({SMALL_PICTURE}); sys.exit(cli.main(['bake', 'job.toml', '-o', "
        f"'again']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment(PYTHONHASHSEED="7"),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    assert tree(tmp_path / "again") == tree(folder)


@pytest.mark.usefixtures("small_picture")
def test_previews_are_made_on_request_and_listed(tmp_path, monkeypatch):
    """Each opens as what its name says; nothing is drawn that nobody asked for."""
    monkeypatch.setattr(baker, "measure", lambda _: some_statistics())
    names = {
        "sheet": ("preview", "preview.png"),
        "animation": ("animation", "preview.webp"),
        "tiling": ("tiling", "tiling.png"),
    }
    manifest = fo.bake(job(bake__pictures=list(names)), tmp_path / "all")
    for key, name in names.values():
        data = (tmp_path / "all" / name).read_bytes()
        assert manifest[key] == {
            "path": name,
            "bytes": len(data),
            "sha256": hashlib.sha256(data).hexdigest(),
        }
        with Image.open(io.BytesIO(data)) as picture:
            assert picture.format == {".png": "PNG", ".webp": "WEBP"}[Path(name).suffix]
    manifest = fo.bake(job(bake__pictures=["tiling"]), tmp_path / "one")
    assert set(tree(tmp_path / "one")) & {name for _, name in names.values()} == {"tiling.png"}
    assert "preview" not in manifest


# Several jobs


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "changes",
    [
        {"bake__frames": 1},
        {"bake__maps": ["jacobian"]},
        {"bake__maps": ["normal", "height", "displacement", "jacobian"]},
        {"ocean__n": 1},
        {"ocean__n": 2},
        {"ocean__n": 31},
        {"ocean__n": (48, 80)},
        {"ocean__n": (1, 9)},
        {"ocean__size": (10.0, 300.0)},
        {"ocean__choppiness": 0.0},
        {"ocean__amplitudes": "fixed"},
        {"sea__depth": 0.5},
        {"ocean__loop": 0.5, "bake__frames": 7},
    ],
    ids=str,
)
def test_jobs_of_all_kinds_bake(changes, tmp_path):
    sea_job = job(**changes)
    shape = sea_job.ocean().grid.shape
    manifest = fo.bake(sea_job, tmp_path / "out")
    assert list(manifest["maps"]) == list(sea_job.maps)
    assert len(manifest["frames"]) == sea_job.frames
    for row in manifest["frames"]:
        assert list(row["files"]) == list(sea_job.maps)
        for entry in row["files"].values():
            for channel in exr.decode((tmp_path / "out" / entry["path"]).read_bytes()):
                assert np.all(np.isfinite(channel))
                assert channel.shape == shape
    strict((tmp_path / "out" / "manifest.json").read_bytes())


@pytest.mark.usefixtures("quick")
def test_the_order_and_choice_of_maps_does_not_change_a_map(tmp_path):
    fo.bake(job(bake__maps=["height", "displacement", "normal", "jacobian"]), tmp_path / "all")
    fo.bake(job(bake__maps=["jacobian", "displacement"]), tmp_path / "some")
    everything, some = tree(tmp_path / "all"), tree(tmp_path / "some")
    pictures = [name for name in some if name.endswith(".exr")]
    assert len(pictures) == 4
    for name in pictures:
        assert some[name] == everything[name]


@pytest.mark.usefixtures("quick")
def test_without_choppiness_nothing_moves_sideways(tmp_path):
    manifest = fo.bake(
        job(ocean__choppiness=0.0, bake__maps=["displacement", "jacobian"]), tmp_path / "out"
    )
    red, green, blue = exr.decode((tmp_path / "out/displacement/0000.exr").read_bytes())
    assert not red.any()
    assert not green.any()
    assert blue.any()
    assert manifest["maps"]["jacobian"]["range"] == [1.0, 1.0]
    assert manifest["extremes"]["max_horizontal"] == 0.0


@pytest.mark.usefixtures("small_picture")
def test_a_flat_sea_bakes_flat(tmp_path):
    """With its statistics and its picture: nothing divides by the energy that is not there."""
    with pytest.warns(fo.SeaWarning, match="exactly flat"):
        manifest = fo.bake(
            job(sea__wind__speed=0.0, bake__maps=list(MAPS), ocean__n=5), tmp_path / "out"
        )
    ranges = {name: entry["range"] for name, entry in manifest["maps"].items()}
    assert ranges == {
        **{name: [0.0, 0.0] for name in MAPS},
        "normal": [0.0, 1.0],
        "jacobian": [1.0, 1.0],
    }
    x, y, z = exr.decode((tmp_path / "out/normal/0001.exr").read_bytes())
    assert not x.any()
    assert not y.any()
    assert np.all(z == 1.0)
    strict((tmp_path / "out/manifest.json").read_bytes())


@pytest.mark.usefixtures("quick")
def test_progress_counts_frames(tmp_path):
    calls = []
    fo.bake(
        job(bake__frames=3),
        tmp_path / "out",
        progress=lambda done, total: calls.append((done, total)),
    )
    assert calls == [(1, 3), (2, 3), (3, 3)]


# The same folder again


@pytest.mark.usefixtures("quick")
def test_the_same_job_again_gives_the_same_bytes(tmp_path):
    fo.bake(job(), tmp_path / "out")
    before = tree(tmp_path / "out")
    (tmp_path / "out/height/0000.exr").write_bytes(b"spoilt")
    (tmp_path / "out/normal/0001.exr").unlink()
    fo.bake(job(), tmp_path / "out")
    assert tree(tmp_path / "out") == before


@pytest.mark.usefixtures("quick")
def test_another_job_s_folder_is_refused_and_left_alone(tmp_path):
    fo.bake(job(), tmp_path / "out")
    before = tree(tmp_path / "out")
    with pytest.raises(
        OutputError,
        match=r"another job \(ocean\.n: 8 there, 9 here; ocean\.seed: 1 there, 2 "
        r"here\).*--overwrite",
    ) as caught:
        fo.bake(job(ocean__n=9, ocean__seed=2), tmp_path / "out")
    assert caught.value.exit_code == 4
    assert tree(tmp_path / "out") == before
    swell = {
        "sea": {"systems": [{"spectrum": {"kind": "jonswap", "hs": 1.0, "tp": 8.0}}]},
        "ocean": {"n": 8},
    }
    with pytest.raises(OutputError, match=r"sea\.systems: \[\] there"):
        fo.bake(fo.Job.from_tree(swell), tmp_path / "out")
    assert tree(tmp_path / "out") == before


@pytest.mark.usefixtures("quick")
def test_overwrite_leaves_nothing_of_the_other_job(tmp_path):
    fo.bake(job(bake__frames=4, bake__maps=list(MAPS)), tmp_path / "out")
    (tmp_path / "out/height/notes.txt").write_text("mine")
    fo.bake(job(bake__frames=2), tmp_path / "out", overwrite=True)
    fo.bake(job(bake__frames=2), tmp_path / "fresh")
    left = tree(tmp_path / "out")
    assert left.pop("height/notes.txt") == b"mine"  # not ours to remove
    assert left == tree(tmp_path / "fresh")


@pytest.mark.usefixtures("quick")
def test_a_folder_whose_frames_are_being_removed_is_no_finished_bake(tmp_path, monkeypatch):
    """Stopped between any two removals of an overwrite: the manifest is already gone."""
    fo.bake(job(), tmp_path / "out")
    removed = []
    real = Path.unlink

    def unlink(self, missing_ok=False):
        if removed:
            raise KeyboardInterrupt
        removed.append(self.name)
        real(self, missing_ok=missing_ok)

    monkeypatch.setattr(Path, "unlink", unlink)
    with pytest.raises(KeyboardInterrupt):
        fo.bake(job(bake__frames=1), tmp_path / "out", overwrite=True)
    assert removed == ["manifest.json"]


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("name", ["manifest.json", "preview.png"])
def test_files_of_someone_else_are_not_replaced(tmp_path, name):
    """
    A web application's folder has a manifest.json too: nor are they with `overwrite`, which asks
    for a bake's files alone.
    """
    (tmp_path / name).write_text('{"name": "my application"}')
    before = tree(tmp_path)
    with pytest.raises(
        OutputError,
        match=rf"contains {name}, named like a file of a bake, but "
        rf"no job\.json",
    ):
        fo.bake(job(), tmp_path)
    assert tree(tmp_path) == before
    with pytest.raises(
        OutputError,
        match=rf"holds {name}, which is not listed in a job.json or manifest.json of a bake there",
    ):
        fo.bake(job(), tmp_path, overwrite=True)
    assert tree(tmp_path) == before


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "left", [("manifest.json", "job.json"), ("manifest.json",), ("job.json",)], ids=str
)
@pytest.mark.parametrize("form", ["exr", "ktx2", "exr-atlas", "zarr"])
def test_overwrite_removes_what_the_manifest_or_the_job_lists(tmp_path, form, left):
    """
    Either is enough: whatever the bake wrote goes, for any format, and the bytes are those of a
    fresh folder.
    """
    engine = "unity" if form == "exr-atlas" else "canonical"
    other = job(
        bake__format=form,
        bake__engine=engine,
        bake__maps=["displacement", "jacobian"],
        bake__pictures=["tiling", "sheet"],
    )
    fo.bake(other, tmp_path / "out", executor="serial")
    (tmp_path / "out/notes.txt").write_text("mine")
    for name in {"manifest.json", "job.json"} - set(left):
        (tmp_path / "out" / name).unlink()
    fo.bake(job(), tmp_path / "out", overwrite=True, executor="serial")
    fo.bake(job(), tmp_path / "fresh", executor="serial")
    found = tree(tmp_path / "out")
    assert found.pop("notes.txt") == b"mine"
    assert found == tree(tmp_path / "fresh")


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "name", ["height/9999.exr", "jacobian/0000.exr", "spectrum.png", "height.ktx2", "foam/0001.npz"]
)
def test_overwrite_leaves_what_no_bake_lists(tmp_path, name):
    """
    A frame beyond the job's, another map, another format, a picture that it has not: somebody's
    own, and nothing is touched.
    """
    fo.bake(job(), tmp_path / "out", executor="serial")
    path = tmp_path / "out" / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(b"mine")
    before = tree(tmp_path / "out")
    with pytest.raises(OutputError, match=rf"holds {name}, which is not listed"):
        fo.bake(job(bake__frames=1), tmp_path / "out", overwrite=True, executor="serial")
    assert tree(tmp_path / "out") == before
    path.unlink()
    fo.bake(job(bake__frames=1), tmp_path / "out", overwrite=True, executor="serial")


NOT_OURS = [
    '{"job": 5}',
    '{"job": [1]}',
    '{"job": null}',
    "{}",
    "[]",
    "5",
    "",
    "{",
    "[" * 100_000,
    "\xff",
    "1" * 5000,
]


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "text", [*NOT_OURS, " " * (4 * 2**20 + 1)], ids=lambda text: repr(text[:12])
)
def test_a_job_file_that_is_none_of_ours_is_refused(tmp_path, text):
    (tmp_path / "job.json").write_text(text, encoding="latin-1")
    with pytest.raises(OutputError, match=r"another job|cannot be read"):
        fo.bake(job(), tmp_path)
    assert list(tree(tmp_path)) == ["job.json"]


@pytest.mark.usefixtures("quick")
def test_a_job_file_that_is_no_file_is_refused(tmp_path):
    """
    A folder, an endless device, a pipe without a writer, a link to nowhere: none is waited for.
    """
    for i, plant in enumerate(
        (
            lambda p: p.mkdir(),
            lambda p: p.symlink_to("/dev/zero"),
            lambda p: os.mkfifo(p),
            lambda p: p.symlink_to("nowhere"),
        )
    ):
        folder = tmp_path / str(i)
        folder.mkdir()
        plant(folder / "job.json")
        with pytest.raises(OutputError, match=r"job\.json must be a file"):
            fo.bake(job(), folder)


# What is in the way


@pytest.fixture
def outside(tmp_path):
    """A folder that no bake may touch, with the names that a bake uses."""
    folder = tmp_path / "outside"
    folder.mkdir()
    for name in (
        "0000.exr",
        "0001.exr",
        "job.json",
        "manifest.json",
        "preview.png",
        ".0000.exr.1.tmp",
    ):
        (folder / name).write_text("precious")
    return folder


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("again", [False, True])
@pytest.mark.parametrize("name", ["height", "normal", "jacobian"])
def test_a_link_in_a_map_folder_s_place_leads_nowhere(tmp_path, outside, name, again, overwrite):
    """
    The job has height and normal, and will not write through a link; jacobian is not its own, and
    nothing there is removed.
    """
    out = tmp_path / "out"
    if again:
        fo.bake(job(), out)
        shutil.rmtree(out / name, ignore_errors=True)
    out.mkdir(exist_ok=True)
    (out / name).symlink_to(outside, target_is_directory=True)
    before = tree(outside)
    if name == "jacobian":
        fo.bake(job(), out, overwrite=overwrite)
    else:
        with pytest.raises(OutputError, match=rf"{name} must be a folder, and is a link"):
            fo.bake(job(), out, overwrite=overwrite)
        assert not (out / "manifest.json").exists()
    assert tree(outside) == before


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("overwrite", [False, True])
def test_a_link_at_a_file_s_name_is_replaced_and_not_followed(tmp_path, outside, overwrite):
    out = tmp_path / "out"
    fo.bake(job(), out)
    expected, before = tree(out), tree(outside)
    for name, target in (
        ("height/0000.exr", "0000.exr"),
        ("manifest.json", "manifest.json"),
        ("preview.png", "preview.png"),
    ):
        (out / name).unlink()
        (out / name).symlink_to(outside / target)
    (out / "normal/0001.exr").unlink()
    (out / "normal/0001.exr").symlink_to(outside / "not there")
    fo.bake(job(), out, overwrite=overwrite)
    assert tree(outside) == before
    assert tree(out) == expected
    assert not any(p.is_symlink() for p in out.rglob("*"))


@pytest.mark.usefixtures("quick")
def test_a_link_at_a_temporary_name_is_not_followed(tmp_path, outside):
    out = tmp_path / "out"
    (out / "height").mkdir(parents=True)
    for folder, name in ((out / "height", "0000.exr"), (out, "job.json"), (out, "manifest.json")):
        (folder / f".{name}.{os.getpid()}.tmp").symlink_to(outside / "0000.exr")
    before = tree(outside)
    fo.bake(job(), out)
    assert tree(outside) == before
    assert not list(out.rglob("*.tmp"))


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("pid", [1, os.getpid()])
def test_what_a_killed_process_left_is_swept_up(tmp_path, pid):
    """
    Half-written temporary files, even of this process's number, as it may be in a container; the
    bytes are those of a calm run.
    """
    fo.bake(job(), tmp_path / "undisturbed")
    out = tmp_path / "out"
    fo.bake(job(), out)
    for name in (
        "height/.0001.exr",
        "normal/.0000.exr",
        ".job.json",
        ".manifest.json",
        ".preview.png",
    ):
        out.joinpath(f"{name}.{pid}.tmp").write_bytes(b"half")
    (out / "manifest.json").unlink()
    (out / "normal/0001.exr").unlink()
    fo.bake(job(), out)
    assert tree(out) == tree(tmp_path / "undisturbed")


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize(
    ("name", "kind"),
    [
        (".", "file"),
        ("height", "file"),
        ("height/0000.exr", "folder"),
        ("manifest.json", "folder"),
        ("preview.png", "folder"),
        ("job.json", "folder"),
    ],
)
def test_something_else_in_the_place_is_an_output_error(tmp_path, name, kind, overwrite):
    """Exit 4, the file named, no manifest, no temporary file."""
    out = tmp_path / "out"
    if name == ".":
        out.write_text("a file")
    else:
        fo.bake(job(), out)
        place = out / name
        shutil.rmtree(place) if place.is_dir() else place.unlink()
        place.mkdir() if kind == "folder" else place.write_text("a file")
    with pytest.raises(OutputError) as caught:
        fo.bake(job(), out, overwrite=overwrite)
    assert caught.value.exit_code == 4
    assert str(out / name) in str(caught.value) or (name == "." and str(out) in str(caught.value))
    assert not (out / "manifest.json").is_file() or name == "job.json"  # there nothing was begun
    assert not list(tmp_path.rglob("*.tmp"))


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "folder", ["/dev/full", "/dev/null/x", "x" * 300, "y/" * 3000, "/proc/nothing/here"]
)
def test_a_folder_that_cannot_be_is_an_output_error(folder):
    with pytest.raises(OutputError, match="could not be made a folder"):
        fo.bake(job(), folder)


@pytest.mark.usefixtures("quick")
def test_a_read_only_folder_is_an_output_error(tmp_path):
    fo.bake(
        job(), tmp_path / "before"
    )  # whatever has to be loaded is loaded, before we become somebody who may not
    (tmp_path / "closed").mkdir(mode=0o555)
    root = os.geteuid() == 0  # who may write anywhere
    if root:
        tmp_path.chmod(0o755)
        os.seteuid(65534)
    try:
        with pytest.raises(OutputError, match=r"could not be (written|made)"):
            fo.bake(job(), tmp_path / "closed")
    finally:
        if root:
            os.seteuid(0)
    tmp_path = tmp_path / "closed"
    assert not tree(tmp_path)


def test_impossible_water_is_refused_before_a_folder_is_made(tmp_path):
    with pytest.raises(fo.JobError, match="GiB"):
        fo.bake(job(ocean__n=65536), tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("quick")
def test_a_frame_that_no_half_can_hold_is_an_output_error_that_names_it(tmp_path):
    """Tides of 90 m in 160 m of water push it 200 km to and fro."""
    tide = {"kind": "tabulated", "frequency": [5e-6, 1e-5, 2e-5], "density": [0.0, 7e7, 0.0]}
    film = fo.Job.from_tree(
        {
            "sea": {"depth": 160.0, "systems": [{"spectrum": tide}]},
            "ocean": {"n": 8, "size": 4e6},
            "bake": {"frames": 1},
        }
    )
    with pytest.raises(
        OutputError, match=r"displacement/0000\.exr could not be encoded: values must stay within"
    ):
        fo.bake(film, tmp_path / "out")
    assert not (tmp_path / "out/manifest.json").exists()


# A disk that fails


class Disk:
    """A disk whose n-th operation of one kind fails, as full, broken or interrupted ones do."""

    def __init__(self, monkeypatch, kind, n, error):
        self.left, self.error = n, error
        real_open, real_fsync, real_replace, real_file, real_mkdir = (
            os.open,
            os.fsync,
            Path.replace,
            os.fdopen,
            Path.mkdir,
        )
        if kind == "open":
            monkeypatch.setattr(
                files.os, "open", lambda *a, **k: self.count() or real_open(*a, **k)
            )
        elif kind == "fsync":
            monkeypatch.setattr(files.os, "fsync", lambda fd: self.count() or real_fsync(fd))
        elif kind == "rename":
            monkeypatch.setattr(
                Path, "replace", lambda path, to: self.count() or real_replace(path, to)
            )
        elif kind == "folder":
            monkeypatch.setattr(
                Path, "mkdir", lambda path, **how: self.count() or real_mkdir(path, **how)
            )
        else:

            def torn(descriptor, mode="r", *a, **k):
                file = real_file(descriptor, mode, *a, **k)
                return Torn(file, self) if mode == "wb" else file

            monkeypatch.setattr(files.os, "fdopen", torn)

    def count(self):
        self.left -= 1
        if self.left == 0:
            raise self.error


class Torn:
    """
    A raw file that takes a third of what it is given each time, as a file may, until its disk
    fails.
    """

    def __init__(self, file, disk):
        self.file, self.disk = file, disk

    def write(self, view):
        part = view[: max(1, len(view) // 3)]
        written = self.file.write(part)
        if len(part) < len(view):
            self.disk.count()
        return written

    def fileno(self):
        return self.file.fileno()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("error", [OutputError("no room"), KeyboardInterrupt()])
def test_what_a_dead_worker_left_half_written_goes_with_the_bake(tmp_path, monkeypatch, error):
    """In every folder of a map, when the bake fails and when it is finished."""
    left = []

    def die(executor, plan, *rest):
        for folder in (tmp_path / "out", tmp_path / "out" / "height"):
            folder.mkdir(exist_ok=True)
            left.append(folder / ".0001.exr.12345.tmp")
            left[-1].write_bytes(b"torn")
        if not fails:
            return write(executor, plan, *rest)
        raise error

    write = baker._write
    monkeypatch.setattr(baker, "_write", die)
    for fails in (True, False):
        if fails:
            with pytest.raises(type(error)):
                fo.bake(job(), tmp_path / "out")
        else:
            fo.bake(job(), tmp_path / "out")
        assert not any(path.exists() for path in left)
    assert len(left) == 4


@pytest.mark.parametrize(
    ("kind", "error"),
    [
        ("open", OSError(errno.ENOSPC, "No space left on device")),
        ("write", OSError(errno.ENOSPC, "No space left on device")),
        ("fsync", OSError(errno.EIO, "Input/output error")),
        ("rename", OSError(errno.EDQUOT, "Disk quota exceeded")),
        ("folder", OSError(errno.EROFS, "Read-only file system")),
        ("write", KeyboardInterrupt()),
        ("fsync", KeyboardInterrupt()),
        ("rename", KeyboardInterrupt()),
    ],
    ids=lambda v: v if isinstance(v, str) else type(v).__name__,
)
def test_a_failure_at_any_operation_is_never_a_finished_bake(tmp_path, kind, error):
    """
    The n-th operation fails, for n = 1, 2, ... until none does: exit 4 with the file's name, no
    manifest, no half file under its name, no temporary file; and the same command afterwards gives
    the bytes of an undisturbed run.
    """
    fo.bake(job(), tmp_path / "undisturbed")
    expected = tree(tmp_path / "undisturbed")
    out = tmp_path / "out"
    step = 9 if kind == "write" else 1  # a dozen writes go into each file
    for n in range(1, 400, step):
        with pytest.MonkeyPatch.context() as patch:
            Disk(patch, kind, n, error)
            try:
                fo.bake(job(), out)
                failed = None
            except (OutputError, KeyboardInterrupt) as caught:
                failed = caught
        left = made(out)
        assert all(expected[name] == data for name, data in left.items())
        assert not [
            path for path in out.rglob("*") if path.suffix == ".tmp" or path.name == ".lock"
        ]
        if failed is None:
            break
        assert "manifest.json" not in left
        if isinstance(error, OSError):
            assert failed.exit_code == 4
            assert str(out) in str(failed)
            assert error.strerror in str(failed)
        if n % (2 * step) == 0:
            shutil.rmtree(
                out, ignore_errors=True
            )  # begin anew at every other failure, go on at the others
    assert n >= {"folder": 3, "write": 20}.get(
        kind, 7
    )  # a job, four frames, a picture and a manifest
    assert left == expected
    fo.bake(job(), out)
    assert tree(out) == expected  # nor is anything of its own left


@pytest.mark.usefixtures("quick")
def test_a_limit_on_the_size_of_files_is_an_output_error(tmp_path):
    """
    The kernel's own refusal, in the middle of a write: SIGXFSZ is ignored by Python, the write says
    EFBIG.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    sea_job = job(ocean__n=64)
    sea_job.ocean()  # whatever is to be compiled and cached is
    try:
        resource.setrlimit(
            resource.RLIMIT_FSIZE, (4000, hard)
        )  # more than the job and the journal take, less than a picture
        with pytest.raises(
            OutputError, match=r"height/0000\.exr could not be written: File too large"
        ):
            fo.bake(sea_job, tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert list(made(tmp_path / "out")) == ["job.json"]


# A process that is stopped


SIGNALS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """
    Exit code, output and folder of a bake of 100 000 frames that got a signal after the third; one
    process for each signal.
    """
    started = []
    for number in SIGNALS:
        place = tmp_path_factory.mktemp("stopped")
        program = (
            "import signal, sys; from fftocean.cli import main; signal.signal(signal.SIGINT, "
            "signal.default_int_handler); "
        )
        program += (
            "sys.exit(main(['bake', '-o', 'out', '--n', '64', '--frames', '100000', '--maps', "
            "'height']))"
        )
        command, pipe = [sys.executable, "-c", program], subprocess.PIPE
        started.append(
            (
                number,
                place / "out",
                subprocess.Popen(
                    command, cwd=place, env=environment(), stdout=pipe, stderr=pipe, text=True
                ),
            )
        )
    results = {}
    deadline = time.monotonic() + 600.0
    for number, folder, process in started:
        while not (folder / "height/0002.exr").exists() and process.poll() is None:
            assert time.monotonic() < deadline
            time.sleep(0.005)
        process.send_signal(number)
        results[number] = (*process.communicate(timeout=600), process.returncode, folder)
    return results


@pytest.mark.parametrize("number", SIGNALS, ids=lambda n: n.name)
@pytest.mark.process
def test_a_stopped_bake_is_not_a_finished_one(stopped, number):
    """
    Ctrl-C is 130, SIGTERM 143, both without a traceback and with their temporary file removed;
    every frame there is whole.
    """
    out, err, code, folder = stopped[number]
    assert code == SIGNALS[number], err
    assert "Traceback" not in err
    assert not out
    left = tree(folder)
    assert {"job.json", "height/0002.exr"} <= set(left)
    assert "manifest.json" not in left
    for name, data in left.items():
        if name.endswith(".exr"):
            exr.decode(data)
    if number != signal.SIGKILL:
        assert not [name for name in left if name.endswith(".tmp")]
        assert ("interrupted" in err) == (number == signal.SIGINT)


# The files themselves


def test_a_written_file_has_the_bytes_and_their_checksum(tmp_path):
    data = bytes(range(256)) * 1000
    for content in (data, b"", b"shorter"):
        assert files.write_whole(tmp_path / "file", content) == hashlib.sha256(content).hexdigest()
        assert tree(tmp_path) == {"file": content}


def test_a_file_is_flushed_before_it_gets_its_name(tmp_path, monkeypatch):
    """Else a crash of the machine could leave an empty file under the final name."""
    calls = []
    real_fsync, real_replace = os.fsync, Path.replace
    monkeypatch.setattr(files.os, "fsync", lambda fd: calls.append("flush") or real_fsync(fd))
    monkeypatch.setattr(
        Path, "replace", lambda path, to: calls.append("rename") or real_replace(path, to)
    )
    files.write_whole(tmp_path / "file", b"data")
    assert calls == ["flush", "rename"]


def test_json_has_no_nan():
    for bad in (float("nan"), float("inf"), -float("inf")):
        with pytest.raises(ValueError, match="JSON"):
            files.as_json({"range": [bad]})
    assert strict(files.as_json({"b": 1, "a": "é", "x": 0.1})) == {"b": 1, "a": "é", "x": 0.1}


@pytest.mark.parametrize("name", ["bake", "check", "load", "repair"])
def test_public_functions_of_baking_show_their_signature_and_docstring(name):
    """Plain functions, whose parameters are all described: `help(fo.bake)` is of use."""
    function = getattr(fo, name)
    assert inspect.isfunction(function)
    assert function.__name__ == name
    described = function.__doc__.partition("Args:")[2].partition("Returns:")[0]
    for parameter in inspect.signature(function).parameters:
        assert re.search(rf"\b{parameter}\b.*:", described), parameter
    assert "Returns:" in function.__doc__
    assert "Raises:" in function.__doc__


def test_numpy_and_struct_agree_on_a_half():
    assert struct.calcsize("e") == np.dtype(np.float16).itemsize == 2
