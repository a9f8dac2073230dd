"""Check and repair: every damage is named and nothing else, and repaired to the same bytes."""

import dataclasses
import hashlib
import json
import os
import random
import shutil
from pathlib import Path

import builders
import numpy as np
import pytest
from builders import tree

import fftocean as fo
from fftocean.baking import bake as baker
from fftocean.baking.finished.check import Finding, check
from fftocean.baking.previews import sheets as preview
from fftocean.baking.repair import repair
from fftocean.baking.scene import maps
from fftocean.errors import FolderInUseError, IntegrityError, OutputError
from fftocean.export.formats import FORMATS
from fftocean.export.profiles import PROFILES
from fftocean.statistics import SeaState

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")

HELD = {"r16": ["height", "jacobian", "foam"], "png16": ["height", "displacement", "normal"]}


def job(**changes):
    small = {
        "ocean.n": 16,
        "bake.frames": 12,
        "bake.maps": ["height", "displacement", "normal"],
        "bake.pictures": ["tiling"],
    }
    return builders.job(small, **changes)


def told(findings):
    """Return the kind, path and frame of each problem."""
    return {(f.kind, f.path, f.frame) for f in findings}


@pytest.fixture(scope="module", autouse=True)
def quick():
    """
    No integrals over the sea and no picture, which take most of the time of a small bake; they have
    their own tests.
    """
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    specified = SeaState(m0=0.1, hs=1.26, tp=5.0, mean_direction=0.0, spread=30.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(baker, "measure", lambda _: dataclasses.replace(still, specified=specified))
        patch.setattr(preview, "tiling", lambda *_: b"\x89PNG a picture of the sea" * 40)
        yield


@pytest.fixture(scope="module")
def baked(tmp_path_factory):
    """A bake in every format, each made once."""
    made = {}

    def bake(name):
        if name not in made:
            made[name] = tmp_path_factory.mktemp(name) / "out"
            fo.bake(
                job(
                    bake__format=name,
                    bake__maps=HELD.get(name, ["height", "displacement", "normal", "foam"]),
                ),
                made[name],
            )
        return made[name]

    return bake


@pytest.fixture
def exr(baked, tmp_path):
    """A bake to be damaged."""
    return Path(shutil.copytree(baked("exr"), tmp_path / "out"))


@pytest.mark.parametrize("name", FORMATS)
def test_a_bake_as_it_was_written_is_well(baked, name):
    assert check(baked(name)) == ()


@pytest.mark.parametrize("engine", PROFILES)
def test_a_bake_for_any_engine_is_well(engine, tmp_path):
    """
    Its crests are sharper than its troughs and its normals are of length 1, in the engine's own
    frame and unit.
    """
    maps = [
        "displacement",
        "normal",
        "derivative",
        "velocity",
        "surface_velocity",
        "slope_covariance",
        "foam",
        "jacobian",
    ]
    fo.bake(
        job(
            bake__engine=engine,
            bake__maps=maps,
            ocean__n=(16, 12),
            bake__format="npz",
            ocean__choppiness=1.5,
        ),
        tmp_path,
    )
    assert check(tmp_path) == ()


@pytest.mark.parametrize(
    "changes",
    [
        {
            "bake__lookup": "eulerian",
            "bake__maps": ["height", "displacement", "normal", "foam", "jacobian"],
        },
        {
            "bake__format": "ktx2",
            "bake__mips": True,
            "bake__maps": ["height", "normal", "slope_covariance"],
            "ocean__n": (16, 7),
        },
        {
            "sea__wind__speed": 0.0,
            "bake__maps": ["height", "displacement", "normal", "jacobian", "foam"],
        },
        {"sea__wind__speed": 0.0, "bake__maps": ["height"], "bake__format": "png16"},
        {"ocean__n": 1, "bake__maps": ["height", "displacement", "normal", "foam"]},
        {"ocean__n": (2, 31), "bake__frames": 1},
        {"ocean__choppiness": 0.0},
        {"ocean__choppiness": 6.0, "bake__maps": ["displacement", "normal", "jacobian", "foam"]},
        {
            "ocean__n": 32,
            "ocean__size": 400.0,
            "sea__wind__speed": 25.0,
            "bake__maps": ["height", "jacobian", "foam"],
        },
    ],
    ids=str,
)
def test_honest_seas_of_all_kinds_are_well(changes, tmp_path):
    fo.bake(job(**changes), tmp_path)
    assert check(tmp_path) == ()


@pytest.mark.parametrize("frames", ["3:9", "0:12:2", "::5", "7:8"])
def test_a_part_of_a_loop_is_well(frames, tmp_path):
    fo.bake(job(bake__format="zarr"), tmp_path, frames=frames, downsample=2)
    assert check(tmp_path) == ()


@pytest.mark.parametrize("name", FORMATS)
def test_any_flipped_bit_is_named(baked, name, tmp_path):
    """
    In any file of the folder: frames, containers, sidecars, pictures, the job and the manifest.
    """
    folder = Path(shutil.copytree(baked(name), tmp_path / "out"))
    chance = random.Random(name)
    for path, data in chance.sample(sorted(tree(folder).items()), 8):
        bit = chance.randrange(8 * len(data))
        bent = bytearray(data)
        bent[bit // 8] ^= 1 << bit % 8
        (folder / path).write_bytes(bent)
        found = check(folder)
        assert path in {f.path for f in found}, (path, bit)
        assert {f.kind for f in found} <= {"changed", "manifest", "job", "values"}
        (folder / path).write_bytes(data)
    assert check(folder) == ()


@pytest.mark.parametrize("name", FORMATS)
def test_cuts_deletions_and_swaps_are_named(baked, name, tmp_path):
    folder = Path(shutil.copytree(baked(name), tmp_path / "out"))
    chance = random.Random(name)
    whole = tree(folder)
    frames = [path for path in whole if path not in ("job.json", "manifest.json", "tiling.png")]
    for path in chance.sample(frames, min(3, len(frames))):
        (folder / path).write_bytes(whole[path][: chance.randrange(len(whole[path]))])
        assert {(f.kind, f.path) for f in check(folder)} == {("cut", path)}
        (folder / path).unlink()
        assert {(f.kind, f.path) for f in check(folder)} == {("missing", path)}
        (folder / path).write_bytes(whole[path])
    if FORMATS[name].scope == "frame":
        one, other = (FORMATS[name].file.format(stem="height", frame=j) for j in (2, 7))
        (folder / one).write_bytes(whole[other])
        (folder / other).write_bytes(whole[one])
        found = check(folder)
        assert told(found) == {("swapped", one, 2), ("swapped", other, 7)}
        assert [f.detail for f in found] == [
            "it holds height of frame 7",
            "it holds height of frame 2",
        ]


def test_a_flipped_bit_in_a_container_is_named_with_its_frame(baked, tmp_path):
    """And frames that change places within it, with whose bytes they hold."""
    for name in ("bin", "ktx2"):
        folder = Path(shutil.copytree(baked(name), tmp_path / name))
        path = folder / f"displacement{FORMATS[name].suffix}"
        data = bytearray(path.read_bytes())
        size = 16 * 16 * 8
        start = len(data) - 12 * size  # the frames stand at the end of both, the largest level only
        bent = data.copy()
        bent[start + 5 * size + 77] ^= 4
        path.write_bytes(bent)
        assert told(check(folder)) == {("changed", path.name, 5)}
        bent = data.copy()
        bent[start : start + size], bent[start + size : start + 2 * size] = (
            data[start + size : start + 2 * size],
            data[start : start + size],
        )
        path.write_bytes(bent)
        found = check(folder)
        assert told(found) == {("swapped", path.name, 0), ("swapped", path.name, 1)}
        assert found[0].detail == "it holds displacement of frame 1"


def test_a_frame_of_another_map_is_reported(exr):
    (exr / "height/0003.exr").write_bytes((exr / "displacement/0004.exr").read_bytes())
    (found,) = check(exr)
    assert found == Finding(
        "swapped", "height/0003.exr", "it holds displacement of frame 4", "height", 3
    )
    assert str(found) == "swapped: height/0003.exr, frame 3: it holds displacement of frame 4"


def test_bytes_at_the_end_are_reported(exr):
    with (exr / "height/0003.exr").open("ab") as file:
        file.write(b"\0")
    (found,) = check(exr)
    assert (found.kind, found.frame) == ("changed", 3)
    assert "1 more than were written" in found.detail


@pytest.mark.parametrize(
    "path",
    [
        "height/0012.exr",
        "normal/0099.exr",
        "jacobian/0000.exr",
        "foam.bin",
        "height.json",
        "height/.0003.exr.77-0a.tmp",
        "preview.png",
    ],
)
def test_files_that_would_be_taken_for_ours_are_named(exr, path):
    (exr / path).parent.mkdir(exist_ok=True)
    (exr / path).write_bytes(b"left from another bake")
    assert told(check(exr)) == {("extra", path, None)}


def test_files_of_others_are_not_ours_to_judge(exr):
    """An engine's own, beside each of ours; notes."""
    for path in (
        "notes.txt",
        "height/0000.exr.import",
        "height/0000.exr.meta",
        "height/readme.md",
        "heights/0000.exr",
    ):
        (exr / path).parent.mkdir(exist_ok=True)
        (exr / path).write_text("mine")
    assert check(exr) == ()


def test_a_link_is_no_file_of_a_bake(exr, tmp_path):
    """Even one that leads to the right bytes: they may change without the folder."""
    shutil.copy(exr / "height/0001.exr", tmp_path / "elsewhere.exr")
    (exr / "height/0001.exr").unlink()
    (exr / "height/0001.exr").symlink_to(tmp_path / "elsewhere.exr")
    shutil.move(exr / "normal", tmp_path / "normal")
    (exr / "normal").symlink_to(tmp_path / "normal", target_is_directory=True)
    assert told(check(exr)) == {
        ("missing", "height/0001.exr", 1),
        *(("missing", f"normal/{j:04d}.exr", j) for j in range(12)),
    }


def test_godot_may_add_to_its_import_file(tmp_path):
    """Keys may be added and reordered; those that the bake wrote must keep their values."""
    fo.bake(job(bake__format="exr-atlas", bake__engine="godot", bake__maps=["height"]), tmp_path)
    path = tmp_path / "height.exr.import"
    written = path.read_text()
    path.write_text('[remap]\n\nuid="uid://abc"\n' + written.replace("\n", "\r\n") + "\n[deps]\n")
    assert check(tmp_path) == ()
    path.write_text(written.replace("compress/mode=3", "compress/mode=2"))
    assert told(check(tmp_path)) == {("changed", "height.exr.import", None)}
    path.unlink()
    assert told(check(tmp_path)) == {("missing", "height.exr.import", None)}


# A folder that is no finished bake


def test_an_unfinished_bake_is_said_to_be_one(exr, tmp_path):
    (exr / "manifest.json").unlink()
    assert told(check(exr)) == {("unfinished", "manifest.json", None)}
    (tmp_path / "empty").mkdir()
    (found,) = check(tmp_path / "empty")
    assert "this is no bake" in found.detail


@pytest.mark.parametrize("name", ["none", "file"])
def test_what_is_no_folder_is_an_output_error(tmp_path, name):
    (tmp_path / "file").write_text("")
    with pytest.raises(
        OutputError, match=r"must be the folder of a bake, and (does not exist|is not a folder)"
    ):
        check(tmp_path / name)


def test_a_folder_in_use_is_left_alone(exr):
    from fftocean.baking.folder.lock import locked

    with locked(exr), pytest.raises(FolderInUseError):
        check(exr)


# A manifest that says what no bake says: its checksum is right, its contents are not


def forge(folder, change):
    """Change a manifest, and put the check right again, as a forger would."""
    manifest = json.loads((folder / "manifest.json").read_text())
    manifest.pop("check")
    change(manifest)
    text = lambda tree: json.dumps(tree, indent=2, ensure_ascii=False) + "\n"  # noqa: E731
    manifest["check"] = hashlib.sha256(text(manifest).encode()).hexdigest()
    (folder / "manifest.json").write_text(text(manifest))


def put(*keys, value):
    def change(manifest):
        at = manifest
        for key in keys[:-1]:
            at = at[key]
        at[keys[-1]] = value

    return change


@pytest.mark.parametrize(
    "change",
    [
        put("frames", 0, "files", "height", "path", value="../../outside"),
        put("frames", 0, "files", "height", "path", value="/etc/passwd"),
        put("frames", 0, "files", "height", "path", value="height/0001.exr"),
        put("frames", 3, "frame", value=4),
        put("frames", 3, "t", value=0.0),
        put("frames", 3, "files", value={}),
        put("frames", 3, "files", "height", "bytes", value="many"),
        put("frames", 3, "files", "height", "range", value=[]),
        put("frames", value=[]),
        put("frames", value=5),
        put("maps", value={}),
        put("maps", "height", "range", value=[-9.0, 9.0]),
        put("maps", "height", "shape", value=[1, 1, 1]),
        put("extremes", "max_height", value=0.0),
        put("job", value=5),
        put("job", "ocean.n", value=10**9),
        put("job", "bake.frames", value=5),
        put("job", "bake.format", value="../x"),
        put("subset", value="0:2"),
        put("downsample", value=3),
        put("tiling", value={"path": "../../outside", "bytes": 1, "sha256": ""}),
        put("tiling", value={"path": "../../outside"}),
        put("tiling", value=5),
        put(
            "containers",
            value={"height": [{"path": "height/../../outside", "bytes": 1, "sha256": ""}]},
        ),
        put("containers", value={"height": [{"path": "secret.txt", "bytes": 1, "sha256": ""}]}),
    ],
    ids=range(25),
)
def test_a_manifest_that_no_bake_wrote_is_named_and_leads_nowhere(
    exr, change, tmp_path, monkeypatch
):
    """Not a byte outside the folder is read, nor does anything but a finding come of it."""
    (tmp_path / "outside").write_text("x")
    forge(exr, change)
    opened = []
    real = os.open
    monkeypatch.setattr(
        os, "open", lambda path, *a, **k: opened.append(Path(path)) or real(path, *a, **k)
    )
    assert "manifest.json" in {f.path for f in check(exr)} or {"job"} == {
        f.kind for f in check(exr)
    }
    assert all(".." not in path.parts and exr in path.parents for path in opened)


def exchange(manifest):
    """Let two rows change their numbers and times, as if each were the other's frame."""
    one, other = manifest["frames"][3], manifest["frames"][7]
    for key in ("frame", "t"):
        one[key], other[key] = other[key], one[key]


@pytest.mark.parametrize(
    "change",
    [
        exchange,
        lambda manifest: manifest["frames"].pop(),
        lambda manifest: manifest["frames"].pop(4),
        lambda manifest: manifest["frames"].append(manifest["frames"][-1]),
        lambda manifest: manifest["frames"].reverse(),
    ],
)
def test_a_manifest_of_other_frames_than_its_job_s_is_refused(baked, change, tmp_path):
    """A container has one path for all frames, so that no path tells them apart."""
    folder = Path(shutil.copytree(baked("npz"), tmp_path / "out"))
    forge(folder, change)
    (found,) = check(folder)
    assert (found.kind, found.path) == ("manifest", "manifest.json")
    assert "its frames are not those of its job" in found.detail
    with pytest.raises(IntegrityError, match="its frames are not those of its job"):
        fo.load(folder)


def test_a_whole_manifest_of_another_bake_is_reported(exr, tmp_path):
    """Each file on its own is whole."""
    fo.bake(
        job(ocean__seed=9, bake__maps=["height", "displacement", "normal", "foam"]),
        tmp_path / "other",
    )
    shutil.copy(tmp_path / "other/manifest.json", exr / "manifest.json")
    kinds = {f.kind for f in check(exr)}
    assert {"job", "changed"} <= kinds


# Water that is none: bakes whose every checksum is right


def crooked(monkeypatch, name, bend):
    """Bake with a map that is bent before it is written."""
    real = maps.MAPS[name]

    def compute(surface):
        return bend(surface.frame.t, [np.array(channel) for channel in real.compute(surface)])

    monkeypatch.setitem(maps.MAPS, name, dataclasses.replace(real, compute=compute))


@pytest.fixture
def bake_bent(tmp_path, monkeypatch):
    def bake(name, bend, **changes):
        crooked(monkeypatch, name, bend)
        fo.bake(job(bake__maps=[name], bake__format="npz", **changes), tmp_path)
        return check(tmp_path)

    return bake


@pytest.mark.parametrize(("axis", "edge"), [(0, "north"), (1, "east")])
def test_a_seam_is_named(bake_bent, axis, edge):
    """A ramp across the tile: no longer periodic along one axis."""

    def ramp(_, channels):
        shape = [1, 1]
        shape[axis] = channels[0].shape[axis]
        return [
            c + np.linspace(0.0, 3.0, shape[axis], dtype=np.float32).reshape(shape)
            for c in channels
        ]

    (found,) = bake_bent("height", ramp)
    assert found.kind == "seam"
    assert f"across the {edge} edge" in found.detail


def test_a_loop_that_does_not_close_is_named(bake_bent):
    """The tide rises all through it."""
    (found,) = bake_bent(
        "height", lambda t, channels: [c + np.float32(0.4 * t) for c in channels], bake__frames=24
    )
    assert (found.kind, found.map) == ("loop", "height")


def test_foam_that_starts_on_clean_water_is_named(bake_bent):
    """As foam does that is not the loop's own: the last frame's is gone in the first."""
    (found,) = bake_bent(
        "foam", lambda t, channels: [c * 0.0 + np.float32(min(t, 8.0) / 10.0) for c in channels]
    )
    assert found.kind == "loop"
    assert "foam of the last frame is gone" in found.detail


@pytest.mark.parametrize("channel", [0, 1])
def test_rows_mirrored_without_their_displacement_are_named(bake_bent, channel):
    """The classic: crests grow round and troughs sharp. One axis turned is enough."""
    found = bake_bent(
        "displacement",
        lambda _, channels: [-4.0 * c if i == channel else c for i, c in enumerate(channels)],
    )
    assert [f.kind for f in found] == ["crest"]


def test_normals_of_another_length_are_named(bake_bent):
    found = bake_bent("normal", lambda _, channels: [c * np.float32(0.99) for c in channels])
    assert {f.kind for f in found} == {"normal"}
    assert len(found) == 12


def test_a_range_that_was_not_kept_is_named(exr):
    """The frames are whole and other than the manifest says, in range."""

    def widen(manifest):
        for row in manifest["frames"]:
            row["files"]["height"]["range"] = [[-50.0, 50.0]]
        manifest["maps"]["height"] |= {"range": [-50.0, 50.0], "channel_ranges": [[-50.0, 50.0]]}

    forge(exr, widen)
    found = check(exr)
    assert {f.kind for f in found} == {"range"}
    assert len(found) == 12


# Mending


@pytest.mark.parametrize("name", ["exr", "png16", "zarr", "bin", "ktx2", "exr-atlas"])
def test_repair_writes_the_bad_frames_again_and_no_others(baked, name, tmp_path):
    folder = Path(shutil.copytree(baked(name), tmp_path / "out"))
    expected, again = tree(folder), []
    if FORMATS[name].scope == "frame":
        bad = [FORMATS[name].file.format(stem="height", frame=j) for j in (1, 4)] + [
            FORMATS[name].file.format(stem="displacement", frame=4)
        ]
        (folder / bad[0]).unlink()
        (folder / bad[1]).write_bytes(b"")
        (folder / bad[2]).write_bytes(expected[bad[0]])
        frames = [1, 4]
    else:
        path = folder / f"height{FORMATS[name].suffix}"
        data = bytearray(path.read_bytes())
        data[-16 * 16 * 8 - 5] ^= 1  # in the last frame but one
        path.write_bytes(data)
        frames = list(range(12)) if name == "exr-atlas" else [10]
    repair(folder, listen=lambda e: again.append(e["frame"]) if e["event"] == "frame" else None)
    assert tree(folder) == expected
    assert sorted(again) == frames
    assert check(folder) == ()


@pytest.mark.parametrize("path", ["manifest.json", "job.json", "tiling.png"])
@pytest.mark.parametrize("how", ["bent", "gone"])
def test_repair_repairs_what_stands_beside_the_frames(exr, path, how):
    expected = tree(exr)
    data = bytearray(expected[path])
    data[len(data) // 2] ^= 1
    (exr / path).write_bytes(data) if how == "bent" else (exr / path).unlink()
    repair(exr)
    assert tree(exr) == expected


def test_repair_removes_what_would_be_taken_for_a_frame(exr):
    expected = tree(exr)
    for path in ("height/0012.exr", "height/.0003.exr.77-0a.tmp"):
        (exr / path).write_bytes(b"left over")
    (exr / "notes.txt").write_text("mine")
    repair(exr)
    assert tree(exr) == {**expected, "notes.txt": b"mine"}


def test_repair_of_a_part_and_of_less_samples(tmp_path):
    """The subset and the factor are read from the folder."""
    fo.bake(job(), tmp_path, frames="0:9:2", downsample=2)
    expected = tree(tmp_path)
    (tmp_path / "normal/0004.exr").unlink()
    repair(tmp_path)
    assert tree(tmp_path) == expected


def test_repair_that_would_give_other_bytes_is_refused(exr, monkeypatch):
    """Another FFT library than it was baked with: the key is named, and what is there stays."""
    (exr / "height/0003.exr").unlink()
    before = tree(exr)
    monkeypatch.setattr("fftocean.baking.folder.identity.library", lambda _: "FFTW 9.9")
    with pytest.raises(OutputError, match=r"made_with\.fft"):
        repair(exr)
    assert tree(exr) == before


def test_repair_without_any_word_of_the_job_is_refused(exr):
    (exr / "manifest.json").unlink()
    (exr / "job.json").write_bytes(
        (exr / "job.json").read_bytes().replace(b'"ocean.seed": 1', b'"ocean.seed": 2')
    )
    with pytest.raises(
        IntegrityError,
        match=r"cannot be repaired: neither manifest\.json nor job\.json",
    ):
        repair(exr)
