"""
Folder of a package: complete or not there, whatever stops an export; nothing foreign is replaced.
"""

import errno
import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import builders_of_packages as build
import pytest

import fftocean as fo
from fftocean.baking.folder import lock
from fftocean.baking.folder.lock import locked
from fftocean.errors import FolderInUseError, IntegrityError, OutputError
from fftocean.runtime import folder as folder_module

FILES = {"README.md", "check.json", "sea.json", "tile0.waves"}


def ocean(amplitude=0.1):
    """Return an ocean of two waves, which is soon exported."""
    waves = [(1, 0, amplitude, 0.0), (-1, 2, 0.05, 1.0)]
    return fo.Ocean.from_modes(waves, n=8, size=50.0, loop=20.0)


class Stopped(BaseException):
    """A stop that nothing catches."""


def stop_at(monkeypatch, name, place, n):
    """Stop after the n-th call of a function."""
    real, calls = getattr(place, name), []

    def counted(*arguments, **keywords):
        found = real(*arguments, **keywords)
        calls.append(arguments)
        if len(calls) == n:
            raise Stopped
        return found

    monkeypatch.setattr(place, name, counted)


def test_the_document_lists_every_file_with_its_checksum(tmp_path):
    document = fo.export_sea(ocean(), tmp_path, job="[ocean]\nn = 8\n", textures=True)
    found = build.tree(tmp_path)
    assert json.loads(found["sea.json"]) == document
    assert found["sea.json"] == build.seal(document)
    assert {row["name"] for row in document["files"]} | {"sea.json"} == set(found)
    assert document["job"] == "[ocean]\nn = 8\n"
    assert fo.check(tmp_path) == ()


def test_the_same_export_gives_the_same_bytes_and_writes_nothing_twice(tmp_path):
    fo.export_sea(ocean(), tmp_path)
    before = build.tree(tmp_path)
    times = {name: (tmp_path / name).stat().st_mtime_ns for name in before if name != "sea.json"}
    fo.export_sea(ocean(), tmp_path)
    assert build.tree(tmp_path) == before
    assert times == {name: (tmp_path / name).stat().st_mtime_ns for name in times}


def test_stopped_after_any_write_it_goes_on_to_the_same_bytes(tmp_path, monkeypatch):
    """After the n-th flush to the disk, for every n; a flush comes before a name in the folder."""
    fo.export_sea(ocean(), tmp_path / "calm")
    expected = build.tree(tmp_path / "calm")
    for n in range(1, 20):
        out = tmp_path / f"out{n}"
        with monkeypatch.context() as patch:
            stop_at(patch, "fsync", os, n)
            try:
                fo.export_sea(ocean(), out)
                break
            except Stopped:
                pass
        assert "sea.json" not in build.tree(out)
        with pytest.raises(IntegrityError, match=r"sea\.json does not exist"):
            fo.load_sea(out)
        fo.export_sea(ocean(), out)
        assert build.tree(out) == expected
    assert n == 6  # a mark, three files, and the document


def test_an_unfinished_export_is_no_package_and_another_sea_is_refused_there(tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        stop_at(patch, "fsync", os, 3)
        with pytest.raises(Stopped):
            fo.export_sea(ocean(), tmp_path)
    (finding,) = fo.check(tmp_path)
    assert (finding.kind, finding.path) == ("unfinished", "sea.json")
    with pytest.raises(OutputError, match="holds an unfinished export of another sea"):
        fo.export_sea(ocean(0.2), tmp_path)
    fo.export_sea(ocean(0.2), tmp_path, overwrite=True)
    assert set(build.tree(tmp_path)) == FILES
    assert fo.check(tmp_path) == ()


def test_another_sea_is_refused_and_overwritten_on_request(tmp_path):
    fo.export_sea(build.cascade(), tmp_path, textures=True)
    (tmp_path / "notes.txt").write_text("mine")
    before = build.tree(tmp_path)
    with pytest.raises(OutputError, match=r"holds another sea \(sea.json\); choose .*--overwrite"):
        fo.export_sea(ocean(), tmp_path)
    assert build.tree(tmp_path) == before
    fo.export_sea(ocean(), tmp_path, overwrite=True)
    assert set(build.tree(tmp_path)) == FILES | {"notes.txt"}
    (found,) = fo.check(tmp_path)
    assert (found.kind, found.path) == ("extra", "notes.txt")  # kept, and named


@pytest.mark.parametrize(("name", "place"), [("unlink", Path), ("fsync", os)])
def test_an_overwriting_that_was_stopped_is_finished_by_the_same_call(
    name, place, tmp_path, monkeypatch
):
    """At no moment does the folder hold a package that is neither the one nor the other."""
    fo.export_sea(ocean(0.2), tmp_path / "calm")
    expected = build.tree(tmp_path / "calm")
    for n in range(1, 20):
        out = tmp_path / f"out{n}"
        fo.export_sea(ocean(), out, textures=True)
        with monkeypatch.context() as patch:
            stop_at(patch, name, place, n)
            try:
                fo.export_sea(ocean(0.2), out, overwrite=True)
                break
            except Stopped:
                pass
        if build.tree(out) != expected:
            with pytest.raises(IntegrityError):
                fo.load_sea(out)
            fo.export_sea(ocean(0.2), out, overwrite=True)
        assert build.tree(out) == expected
        assert fo.check(out) == ()
    assert n > 4


@pytest.mark.parametrize("name", ["README.md", "tile0.waves", "check.json"])
def test_a_file_that_no_package_lists_is_never_replaced(name, tmp_path):
    (tmp_path / name).write_text("mine")
    for overwrite in (False, True):
        with pytest.raises(OutputError, match=f"holds {name}, which is not listed"):
            fo.export_sea(ocean(), tmp_path, overwrite=overwrite)
        assert build.tree(tmp_path) == {name: b"mine"}


def test_a_changed_document_is_not_overwritten(tmp_path):
    """Files that it lists are not known to be of a package."""
    fo.export_sea(ocean(), tmp_path)
    text = (tmp_path / "sea.json").read_text()
    (tmp_path / "sea.json").write_text(text.replace("README.md", "notes.txt"))
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(OutputError, match="not overwritten: move it away"):
        fo.export_sea(ocean(0.2), tmp_path, overwrite=True)
    assert (tmp_path / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("name", ["job.json", "manifest.json", "cascade.json", "cascade-job.json"])
def test_the_folder_of_a_bake_is_refused(name, tmp_path):
    (tmp_path / name).write_text("{}")
    with pytest.raises(OutputError, match=f"holds a bake \\({name}\\); choose another folder"):
        fo.export_sea(ocean(), tmp_path, overwrite=True)


def test_a_link_in_the_place_of_a_file_leads_nowhere(tmp_path):
    outside = tmp_path / "outside"
    outside.write_text("mine")
    folder = tmp_path / "sea"
    fo.export_sea(ocean(), folder)
    (folder / "tile0.waves").unlink()
    (folder / "tile0.waves").symlink_to(outside)
    with pytest.raises(IntegrityError, match=r"tile0.waves does not exist"):
        fo.load_sea(folder)
    fo.export_sea(ocean(), folder)
    assert outside.read_text() == "mine"
    assert fo.check(folder) == ()
    (tmp_path / "link").symlink_to(folder)
    with pytest.raises(OutputError, match="is a link"):
        fo.export_sea(ocean(), tmp_path / "link")


def test_a_damaged_file_is_written_again_by_the_same_export(tmp_path):
    fo.export_sea(ocean(), tmp_path)
    before = build.tree(tmp_path)
    (tmp_path / "tile0.waves").write_bytes(b"spoilt")
    (tmp_path / "check.json").unlink()
    fo.export_sea(ocean(), tmp_path)
    assert build.tree(tmp_path) == before


def test_a_damaged_file_is_not_loaded(tmp_path):
    """Of the right length, of another one, or absent: each file is compared before it is used."""
    fo.export_sea(ocean(), tmp_path)
    for name in ("tile0.waves", "check.json", "README.md"):
        data = (tmp_path / name).read_bytes()
        bent = bytearray(data)
        bent[len(data) // 2] ^= 1
        for other in (bytes(bent), data + b"\0", data[:-1]):
            (tmp_path / name).write_bytes(other)
            with pytest.raises(IntegrityError, match=name):
                fo.load_sea(tmp_path)
        (tmp_path / name).unlink()
        with pytest.raises(IntegrityError, match=f"{name} does not exist"):
            fo.load_sea(tmp_path)
        (tmp_path / name).write_bytes(data)
    assert fo.load_sea(tmp_path).modes().kx.size == 2


def test_the_mark_is_removed_after_the_document_is_written(tmp_path, monkeypatch):
    """At every moment one of the two is there, so that the files are never nobody's."""
    seen = []
    real = folder_module.write_whole

    def write(path, data):
        sha256 = real(path, data)
        seen.append({".export.json", "sea.json"} & {entry.name for entry in tmp_path.iterdir()})
        return sha256

    monkeypatch.setattr(folder_module, "write_whole", write)
    fo.export_sea(ocean(), tmp_path)
    assert seen[:-1] == [{".export.json"}] * (len(seen) - 1)
    assert seen[-1] == {".export.json", "sea.json"}
    assert not (tmp_path / ".export.json").exists()


def test_the_folder_is_locked_while_it_is_written(tmp_path, monkeypatch):
    refused = []
    real = folder_module.write_whole
    monkeypatch.setattr(lock, "PATIENCE", 0.05)

    def write(path, data):
        with pytest.raises(FolderInUseError) as error, locked(tmp_path):
            pass
        refused.append(error.value.exit_code)
        return real(path, data)

    monkeypatch.setattr(folder_module, "write_whole", write)
    fo.export_sea(ocean(), tmp_path)
    assert set(refused) == {6}
    assert len(refused) >= len(FILES)


def test_the_readme_says_what_is_in_the_folder(tmp_path):
    """Texels and metres in the order x, y; the last tick; only files that are there."""
    waves = [(1, 0, 0.1, 0.0), (-1, 2, 0.05, 1.0)]
    sea = fo.Ocean.from_modes(waves, n=(16, 8), size=(50.0, 30.0), loop=20.0)
    fo.export_sea(sea, tmp_path / "a", ticks=1024)
    text = (tmp_path / "a" / "README.md").read_text()
    assert text.startswith("# A sea that loops after 20 s\n")
    assert "- `tile0.waves`: 16 x 8 texels over 50 x 30 m, 2 waves\n" in text
    assert "moment `tick` from 0 to 1023:" in text
    for words in ("textures", "twiddle", "kernels", "a project for"):
        assert words not in text
    fo.export_sea(sea, tmp_path / "b", textures=True)
    text = (tmp_path / "b" / "README.md").read_text()
    assert "- `tile0_h0.bin` ...: the same waves as textures of float32" in text
    assert "- `twiddle.bin`: cosine and sine of 2 pi i/n, float32" in text


def test_a_folder_in_use_is_refused(tmp_path):
    fo.export_sea(ocean(), tmp_path)
    with locked(tmp_path):
        with pytest.raises(FolderInUseError):
            fo.export_sea(ocean(), tmp_path)
        with pytest.raises(FolderInUseError):
            fo.check(tmp_path)


def test_a_full_disk_is_an_output_error_and_leaves_no_package(tmp_path, monkeypatch):
    calls = []

    def full(descriptor):
        calls.append(descriptor)
        if len(calls) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError, match=r"check.json could not be written: No space left"):
        fo.export_sea(ocean(), tmp_path)
    assert set(build.tree(tmp_path)) == {".export.json", "tile0.waves"}


def test_nothing_is_written_for_a_sea_that_cannot_be_packed(tmp_path):
    with pytest.raises(fo.ParameterError, match="power of two"):
        fo.export_sea(fo.Ocean.from_modes([], n=6, size=50.0, loop=20.0), tmp_path / "sea")
    assert not (tmp_path / "sea").exists()


def test_folders_that_hold_no_package_are_refused(tmp_path):
    with pytest.raises(OutputError, match="and does not exist"):
        fo.load_sea(tmp_path / "nowhere")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="and is not a folder"):
        fo.load_sea(tmp_path / "file")
    with pytest.raises(IntegrityError, match=r"sea\.json does not exist"):
        fo.load_sea(tmp_path)
    with pytest.raises(fo.JobError, match="must be a path"):
        fo.export_sea(ocean(), 7)


def test_a_document_without_checksums_is_refused(tmp_path):
    package = build.changed(["files", 0, "sha256"], None)
    with pytest.raises(IntegrityError, match=r"must list the SHA-256 of tile0\.waves"):
        fo.load_sea(build.put(package, tmp_path))


@pytest.mark.parametrize(
    "text",
    [b"", b"{", b"[]", b"[" * 100_000, b'{"a":' * 10_000, b'{"n": 1e999}', b" " * 2_000_000],
)
def test_a_document_that_is_none_is_refused(text, tmp_path):
    (tmp_path / "sea.json").write_bytes(text)
    with pytest.raises((IntegrityError, OutputError)):
        fo.load_sea(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_a_pipe_is_not_waited_for(tmp_path):
    fo.export_sea(ocean(), tmp_path)
    (tmp_path / "tile0.waves").unlink()
    os.mkfifo(tmp_path / "tile0.waves")
    found = []
    thread = threading.Thread(target=lambda: found.extend(fo.check(tmp_path)), daemon=True)
    thread.start()
    thread.join(60.0)
    assert [(f.kind, f.path) for f in found] == [("missing", "tile0.waves")]


KILLED = """
import os, signal, sys
import fftocean as fo
real, calls = os.fsync, []
def fsync(descriptor):
    real(descriptor)
    calls.append(descriptor)
    if len(calls) == int(sys.argv[2]):
        os.kill(os.getpid(), signal.SIGKILL)
os.fsync = fsync
waves = [(1, 0, 0.1, 0.0), (-1, 2, 0.05, 1.0)]
ocean = fo.Ocean.from_modes(waves, n=8, size=50.0, loop=20.0)
fo.export_sea(ocean, sys.argv[1], engine=sys.argv[3] or None)
"""


@pytest.mark.process
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no such signal here")
@pytest.mark.parametrize(("flushes", "engine"), [(3, ""), (9, "unity")])
def test_killed_it_leaves_no_package_and_goes_on_to_the_same_bytes(flushes, engine, tmp_path):
    """While it writes its waves; and while it writes an engine's project."""
    fo.export_sea(ocean(), tmp_path / "calm", engine=engine or None)
    out = tmp_path / "out"
    done = subprocess.run(
        [sys.executable, "-c", KILLED, str(out), str(flushes), engine],
        env={**os.environ, "PYTHONPATH": str(Path(fo.__file__).parent.parent)},
        timeout=600,
        check=False,
    )
    assert done.returncode == -signal.SIGKILL
    assert any(name.endswith(".tmp") for name in build.tree(out))
    assert [f.kind for f in fo.check(out)] == ["unfinished"]
    fo.export_sea(ocean(), out, engine=engine or None)
    assert build.tree(out) == build.tree(tmp_path / "calm")
