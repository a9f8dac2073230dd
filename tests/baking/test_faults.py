"""
Faults around a bake: it is killed, the disk is full, the folder is read-only or in use, or an input
has changed.

Never a false "complete", never a byte outside the folder; and the same command afterwards gives
what an undisturbed bake gives. `hammer.py`, beside this file, does the same by the hundred.
"""

import contextlib
import dataclasses
import errno
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time

import builders
import pytest
from builders import environment, tree

import fftocean as fo
from fftocean import files
from fftocean.baking import bake as baker
from fftocean.baking.finished.check import check
from fftocean.baking.folder.journal import entries_of
from fftocean.baking.previews import sheets as preview
from fftocean.errors import FolderInUseError, OutputError
from fftocean.statistics import SeaState

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
SPECTRA = builders.SPECTRA


def job(**changes):
    small = {
        "ocean.n": 16,
        "bake.frames": 6,
        "bake.maps": ["height", "normal"],
        "bake.pictures": ["tiling"],
    }
    return builders.job(small, **changes)


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """No picture, and no integrals over the sea."""
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    specified = SeaState(m0=0.1, hs=1.26, tp=5.0, mean_direction=0.0, spread=30.0)
    monkeypatch.setattr(baker, "measure", lambda _: dataclasses.replace(still, specified=specified))
    monkeypatch.setattr(preview, "tiling", lambda *_: b"picture")


def frames_written(sea_job, folder, **how):
    """Bake, and tell which frames were written for it."""
    again = []
    fo.bake(
        sea_job,
        folder,
        listen=lambda e: again.append(e["frame"]) if e["event"] == "frame" else None,
        **how,
    )
    return sorted(again)


# Stopped, and gone on with


class Stopped(BaseException):
    """A stop that nothing catches, as far as that can be had within a process."""


FORMATS = {
    "exr": ["height", "normal"],
    "png16": ["height", "normal"],  # ranges first
    "r16": ["height", "foam"],  # foam, then ranges
    "ktx2": ["displacement", "foam"],  # parts, then a container
    "zarr": ["height"],
}


@pytest.mark.parametrize("name", FORMATS)
def test_stopped_after_any_write_it_goes_on_to_the_same_bytes(name, tmp_path, monkeypatch):
    """
    After the n-th flush to the disk, for every n: what is finished is kept and not written again;
    the end is that of a calm bake.

    A flush follows every write, and no line of the journal or name in the folder comes without one.
    """
    sea_job = job(ocean__n=8, bake__format=name, bake__maps=FORMATS[name], bake__frames=2)
    fo.bake(sea_job, tmp_path / "calm")
    expected = tree(tmp_path / "calm")
    real, out, n = os.fsync, tmp_path / "out", 0
    while n < 200:
        n += 1
        calls = []

        def fsync(descriptor, calls=calls, n=n):
            real(descriptor)
            calls.append(descriptor)
            if len(calls) == n:
                raise Stopped

        with monkeypatch.context() as patch:
            patch.setattr(os, "fsync", fsync)
            try:
                fo.bake(sea_job, out)
                break
            except Stopped:
                pass
        left = tree(out)
        assert "manifest.json" not in left
        kept = [
            entry["row"]["frame"]
            for entry in entries_of(out / ".work/journal", identity(sea_job))
            if "row" in entry
        ]
        assert frames_written(sea_job, out) == sorted(set(range(2)) - set(kept))
        assert tree(out) == expected
        shutil.rmtree(out)
    assert n >= 8
    assert tree(out) == expected


def identity(sea_job):
    """Return the SHA-256 of the header of a job's bake."""
    from fftocean.baking.folder.identity import header_of
    from fftocean.baking.folder.plan import identity_of

    return identity_of(
        header_of(
            sea_job, frames=range(sea_job.frames), downsample=1, backend=sea_job.ocean().backend
        )
    )


def test_frames_whose_files_are_not_as_recorded_are_written_again(tmp_path):
    """
    A journal is believed only where the files are what it says; nor is a file without a line
    believed.
    """
    fo.bake(job(), tmp_path / "calm")
    out = tmp_path / "out"
    with pytest.raises(Stopped):
        fo.bake(job(), out, listen=stop_at(4))
    (out / "height/0000.exr").write_bytes(b"spoilt")
    (out / "normal/0001.exr").unlink()
    shutil.copy(tmp_path / "calm/height/0005.exr", out / "height/0005.exr")
    journal = out / ".work/journal"
    lines = journal.read_bytes().splitlines(keepends=True)
    lines[-2] = lines[-2].replace(b'"frame":2', b'"frame":3')
    journal.write_bytes(b"".join(lines)[:-1])  # and the last line is cut by a byte
    assert frames_written(job(), out) == [0, 1, 2, 3, 4, 5]
    assert tree(out) == tree(tmp_path / "calm")


def stop_at(count):
    """A listener that stops a bake when so many frames are finished."""

    def listen(event):
        if event["event"] == "frame" and event["done"] == count:
            raise Stopped

    return listen


def test_a_finished_bake_is_not_written_again(tmp_path):
    fo.bake(job(), tmp_path)
    before = {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*.exr")}
    assert frames_written(job(), tmp_path) == []
    assert {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*.exr")} == before


@pytest.mark.parametrize("name", ["bin", "ktx2", "png16", "zarr"])
def test_a_finished_bake_of_any_format_is_not_written_again(name, tmp_path):
    sea_job = job(bake__format=name, bake__maps=["height"])
    fo.bake(sea_job, tmp_path)
    expected = tree(tmp_path)
    assert frames_written(sea_job, tmp_path) == []
    assert tree(tmp_path) == expected


def test_progress_begins_where_it_was_left(tmp_path):
    with pytest.raises(Stopped):
        fo.bake(job(), tmp_path, listen=stop_at(4))
    calls, events = [], []
    fo.bake(job(), tmp_path, progress=lambda *at: calls.append(at), listen=events.append)
    assert calls == [(4, 6), (5, 6), (6, 6)]
    assert events[0] == {
        "event": "start",
        "folder": str(tmp_path),
        "frames": 6,
        "kept": 4,
        "executor": "serial",
        "workers": 1,
    }
    assert events[-1] == {"event": "done", "manifest": str(tmp_path / "manifest.json"), "frames": 6}


COMMAND = [
    "--n",
    "32",
    "--frames",
    "20",
    "--maps",
    "height,normal",
    "--executor",
    "processes",
    "--workers",
    "2",
    "--quiet",
    "--set",
    "bake.pictures=tiling",
]


def run(folder, *more):
    command = [sys.executable, "-m", "fftocean", "bake", "-o", str(folder), *COMMAND, *more]
    return subprocess.Popen(
        command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def test_killed_at_random_it_goes_on_to_the_same_bytes(tmp_path):
    """kill -9, twice over, with two workers at work; `hammer.py` does it fifty times."""
    start = time.monotonic()
    with run(tmp_path / "calm") as process:
        assert process.wait() == 0, process.stderr.read()
    seconds, chance = time.monotonic() - start, random.Random(3)
    expected, out = tree(tmp_path / "calm"), tmp_path / "out"
    for _ in range(2):
        with run(out) as process:
            time.sleep(chance.uniform(0.3, 0.9) * seconds)
            process.kill()
        left = tree(out) if out.exists() else {}
        assert "manifest.json" not in left or all(
            left.get(name) == data for name, data in expected.items()
        )
    with run(out) as process:
        assert process.wait() == 0, process.stderr.read()
    assert tree(out) == expected


# Two at once


def test_of_two_bakes_into_one_folder_one_leaves_with_6(tmp_path):
    """
    The other goes on undisturbed, and has far to go. Started as commands, interpreter and all.
    """
    first = run(tmp_path / "out", "--n", "64", "--frames", "100000")
    with first:
        deadline = time.monotonic() + 600.0
        while not (tmp_path / "out/.lock").exists() and first.poll() is None:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        with run(tmp_path / "out", "--overwrite") as second:
            _, err = second.communicate(timeout=600)
        assert second.returncode == 6
        assert f"is in use by another bake, process {first.pid} on " in err
        assert first.poll() is None
        first.send_signal(signal.SIGTERM)
        first.communicate(timeout=600)
        assert first.returncode == 143


def test_a_folder_in_use_is_refused_before_anything_is_made(tmp_path):
    from fftocean.baking.folder.lock import locked

    with locked(tmp_path):
        before = tree(tmp_path)
        with pytest.raises(FolderInUseError):
            fo.bake(job(ocean__n=16), tmp_path, overwrite=True)
        assert tree(tmp_path) == before


# Disks


FULL = """
mount -t tmpfs -o size=48k none "$1" || exit 77
"$2" -m fftocean bake -o "$1/out" --n 32 --frames 40 --maps height,normal \\
  --executor "$3" --workers 2
echo "exit $?"
cd "$1/out" && find . -type f && find . -name '*.tmp' | sed 's/^/left /'
"""


@pytest.mark.parametrize("executor", ["serial", "processes"])
def test_a_full_disk_is_an_output_error_and_nothing_is_done(tmp_path, executor):
    """
    A real one of 48 kB, in a name space of its own; where none can be had, `test_bake.py` has the
    n-th write fail.
    """
    command = ["unshare", "-rm", "sh", "-c", FULL, "sh", str(tmp_path), sys.executable, executor]
    if (
        not shutil.which("unshare")
        or (
            done := subprocess.run(
                command, env=environment(), capture_output=True, text=True, timeout=600
            )
        ).returncode
        == 77
    ):
        pytest.skip("no file system can be mounted here")
    assert "exit 4\n" in done.stdout, done.stderr
    assert "could not be written: No space left on device" in done.stderr
    assert f"fftocean: {tmp_path}/out/" in done.stderr
    assert "Traceback" not in done.stderr
    assert "manifest.json" not in done.stdout
    assert ".lock" not in done.stdout
    assert "left " not in done.stdout
    assert "./job.json" in done.stdout


def test_a_worker_s_full_disk_is_that_of_the_bake(tmp_path):
    """
    The kernel's limit on the size of files, which workers inherit: exit 4, the file named, no frame
    marked as done.
    """
    sea_job = job(ocean__n=64, bake__maps=["height"])
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (6000, limits[1]))
        with pytest.raises(
            OutputError, match=r"out/height/000\d\.exr could not be written: File too large"
        ) as caught:
            fo.bake(sea_job, tmp_path / "out", executor="processes", workers=2)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert caught.value.exit_code == 4
    assert [*entries_of(tmp_path / "out/.work/journal", identity(sea_job))] == []
    assert not list(tmp_path.rglob("*.tmp"))
    assert frames_written(sea_job, tmp_path / "out") == list(range(6))


@pytest.mark.parametrize("error", [errno.EIO, errno.ENOSPC])
def test_a_journal_that_cannot_be_written_marks_nothing_as_done(tmp_path, monkeypatch, error):
    """The frame is there, its line is not: it is written again."""
    real, calls = os.fsync, []

    def fsync(descriptor):
        journal = tmp_path / ".work/journal"  # maps are written meanwhile, in other threads
        if journal.exists() and os.path.samestat(os.fstat(descriptor), journal.stat()):
            calls.append(descriptor)
            if len(calls) == 1:
                raise OSError(error, os.strerror(error))
        real(descriptor)

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", fsync)
        with pytest.raises(
            OutputError, match=rf"\.work/journal could not be written: {os.strerror(error)}"
        ):
            fo.bake(job(), tmp_path)
    assert (tmp_path / "normal/0000.exr").exists()
    assert not (tmp_path / "manifest.json").exists()
    fo.bake(job(), tmp_path)
    assert check(tmp_path) == ()


def test_litter_that_cannot_be_removed_does_not_undo_a_bake(tmp_path, monkeypatch):
    """The manifest is there by then; the next bake sweeps."""

    def fail(*_, **__):
        raise OSError(errno.EBUSY, "Device or resource busy")

    with monkeypatch.context() as patch:
        patch.setattr(shutil, "rmtree", fail)
        fo.bake(job(), tmp_path)
    assert (tmp_path / ".work").is_dir()
    assert check(tmp_path) == ()  # of what is done it takes nothing away
    fo.bake(job(), tmp_path)
    assert not (tmp_path / ".work").exists()


# What is planted


@pytest.mark.parametrize("name", ["exr", "zarr", "bin", "png16"])
@pytest.mark.parametrize("overwrite", [False, True])
def test_links_lead_nowhere(tmp_path, name, overwrite):
    """
    In the place of any folder that a bake makes, or of any file: the folder behind it keeps every
    byte, and gets none.
    """
    outside = tmp_path / "outside"
    for path in (
        "0000.exr",
        "height.bin",
        "journal",
        "c/0/0/0/0",
        "zarr.json",
        "0/0/0/0",
        ".0000.exr.1.tmp",
        "0000.part",
        "height.json",
    ):
        (outside / path).parent.mkdir(parents=True, exist_ok=True)
        (outside / path).write_text("precious")
    before = tree(outside)
    sea_job = job(bake__format=name, bake__maps=["height"])
    for place in (
        "height",
        ".work",
        "height.zarr",
        "height.zarr/c",
        ".work/height",
        ".work/journal",
        "height.bin",
        "height.json",
        ".lock",
    ):
        out = tmp_path / "out"
        (out / place).parent.mkdir(parents=True, exist_ok=True)
        (out / place).symlink_to(
            outside / "journal" if place.endswith(("journal", ".lock")) else outside
        )
        with contextlib.suppress(OutputError):  # refused, or replaced
            fo.bake(sea_job, out, overwrite=overwrite)
        assert tree(outside) == before, place
        shutil.rmtree(out)


# What a bake was made of


@pytest.fixture
def measured(tmp_path):
    """A job of a buoy's spectrum, in a folder of its own with the buoy's files."""
    for path in SPECTRA.glob("41010.*"):
        shutil.copy(path, tmp_path)
    text = (
        "[ocean]\nn = 16\nsize = 300\n[bake]\nframes = 3\nmaps = ['height']\npictures = "
        "['tiling']\n"
    )
    (tmp_path / "job.toml").write_text(
        text + "[[sea.systems]]\nmeasured = { file = '41010.data_spec' }\n"
    )
    return tmp_path / "job.toml"


@pytest.mark.parametrize("name", ["41010.data_spec", "41010.swdir"])
def test_a_measured_file_that_changed_is_reported(measured, name):
    """The spectrum, or the directions beside it: its checksum is part of what the bake is."""
    folder = measured.parent / "out"
    fo.bake(fo.Job.read(measured), folder)
    inputs = json.loads((folder / "manifest.json").read_text())["inputs"]
    assert len(inputs) == 5
    assert set(map(len, inputs.values())) == {64}
    assert frames_written(fo.Job.read(measured), folder) == []
    path = measured.parent / name
    path.write_bytes(path.read_bytes() + b"\n")
    with pytest.raises(
        OutputError,
        match=r"another job \(inputs\.41010\.data_spec.*: [0-9a-f]{64} there, [0-9a-f]{64} here\)",
    ):
        fo.bake(fo.Job.read(measured), folder)


def test_a_measured_bake_is_repaired_by_its_job(measured):
    """The folder does not hold the measured file, so it has to be told where that is."""
    from fftocean.baking.repair import repair

    folder = measured.parent / "out"
    fo.bake(fo.Job.read(measured), folder)
    expected = tree(folder)
    (folder / "height/0001.exr").unlink()
    with pytest.raises(fo.ReaderError, match=r"41010\.data_spec"):
        repair(folder)
    repair(folder, fo.Job.read(measured))
    assert tree(folder) == expected
    for path in measured.parent.glob("41010.*"):
        path.unlink()
    assert (
        fo.check(folder) == ()
    )  # what was measured need not be there to look at what was made of it
    assert fo.load(folder).maps["height"].shape[:3] == (3, 16, 16)


@pytest.mark.parametrize(
    ("how", "key"),
    [
        ({"frames": "0:3"}, "subset: all there, 0:3:1 here"),
        ({"frames": "0:4:2"}, "subset: all there, 0:3:2 here"),
        ({"downsample": 2}, "downsample: 1 there, 2 here"),
    ],
)
def test_another_part_or_size_is_another_bake(tmp_path, how, key):
    fo.bake(job(), tmp_path)
    with pytest.raises(OutputError, match=key):
        fo.bake(job(), tmp_path, **how)
    fo.bake(job(), tmp_path, overwrite=True, **how)
    assert check(tmp_path) == ()


@pytest.mark.parametrize("key", ["fft", "arrays", "compiler", "encoder"])
def test_another_library_is_another_bake(tmp_path, key, monkeypatch):
    """Other libraries may give other bits, so the two halves of a bake could differ."""
    fo.bake(job(), tmp_path)
    before = tree(tmp_path)
    name = {"fft": None, "arrays": "numpy", "compiler": "numba", "encoder": "isal"}[key]
    if name is None:
        monkeypatch.setattr("fftocean.baking.folder.identity.library", lambda _: "FFTW 9.9")
    else:
        from fftocean.baking.folder import identity as module

        real = module._version
        monkeypatch.setattr(
            module, "_version", lambda package: "99.9" if package == name else real(package)
        )
    with pytest.raises(OutputError, match=rf"made_with\.{key}: .* there, .*9\.9 here"):
        fo.bake(job(), tmp_path)
    assert tree(tmp_path) == before


def test_nothing_of_another_format_or_part_is_left_by_overwrite(tmp_path):
    """Every format over every other: what is left is what a fresh bake has."""
    for name in ("zarr", "exr-atlas", "bin", "png16", "ktx2", "r16", "exr"):
        sea_job = job(
            bake__format=name,
            bake__maps=["height"],
            bake__engine="godot" if name == "exr-atlas" else "canonical",
        )
        fo.bake(sea_job, tmp_path / "out", overwrite=True)
        fo.bake(sea_job, tmp_path / name)
        assert tree(tmp_path / "out") == tree(tmp_path / name)
        assert check(tmp_path / "out") == ()


def test_a_scaled_map_has_one_range_for_the_whole_loop(tmp_path):
    """Whichever part of it is baked: parts from several bakes fit together."""
    sea_job = job(bake__format="png16", bake__maps=["height", "normal"])
    whole, part = (
        fo.bake(sea_job, tmp_path / "whole"),
        fo.bake(sea_job, tmp_path / "part", frames="4:6"),
    )
    for name in ("height", "normal"):
        assert part["maps"][name]["scaled"] == whole["maps"][name]["scaled"]
    assert whole["maps"]["normal"]["scaled"] == {
        "low": -1.0,
        "high": 1.0 + 1.0 / 32767.0,
    }  # steps of 1/32767, 0 among them
    assert list(whole["maps"]["height"]["scaled"].values()) == whole["maps"]["height"]["range"]
    assert (tmp_path / "part/height/0005.png").read_bytes() == (
        tmp_path / "whole/height/0005.png"
    ).read_bytes()


def test_a_format_that_cannot_hold_a_map_is_refused_before_anything_is_made(tmp_path):
    for changes, words in (
        (
            {"bake__format": "r16", "bake__maps": ["displacement"]},
            "'r16' cannot hold the map 'displacement'",
        ),
        ({"bake__format": "exr", "bake__mips": True}, "holds 1 to 1 mip levels"),
        (
            {"bake__format": "exr-atlas", "bake__frames": 20011, "ocean__n": 64},
            "do not fill an atlas",
        ),
    ):
        with pytest.raises(fo.JobError, match=words):
            fo.bake(job(**changes), tmp_path / "out")
        assert not (tmp_path / "out").exists()


def test_a_read_that_fails_is_an_output_error(tmp_path, monkeypatch):
    """EIO while a finished frame is read back: named, and nothing is taken for well."""
    fo.bake(job(), tmp_path)

    def fail(*_, **__):
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(files.os, "fdopen", fail)
    for attempt in (lambda: fo.bake(job(), tmp_path), lambda: check(tmp_path)):
        with pytest.raises(OutputError, match="cannot be read: Input/output error"):
            attempt()
