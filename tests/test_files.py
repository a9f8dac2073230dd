"""Whole files on systems where an open file keeps its name, and a folder cannot be opened."""

import hashlib
import os
from pathlib import Path

import pytest

from fftocean import files
from fftocean.errors import OutputError


def held(monkeypatch, times):
    """Let a file be open elsewhere for some attempts to rename it; return those that failed."""
    real, failed = Path.replace, []

    def replace(path, target):
        if len(failed) < times:
            failed.append(path)
            raise PermissionError(13, "Permission denied")
        return real(path, target)

    monkeypatch.setattr(Path, "replace", replace)
    return failed


def test_a_file_that_is_open_for_a_moment_is_waited_for(tmp_path, monkeypatch):
    """As on Windows, where a virus scanner opens what was just written."""
    monkeypatch.setattr(files, "PATIENCE", 60.0)
    failed = held(monkeypatch, 3)
    files.write_whole(tmp_path / "a", b"one\n")
    assert len(failed) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_bytes() == b"one\n"


def test_one_that_stays_open_is_an_error(tmp_path, monkeypatch):
    """Nothing temporary is left, and what was there is unchanged."""
    (tmp_path / "a").write_bytes(b"before")
    monkeypatch.setattr(files, "PATIENCE", 0.05)
    held(monkeypatch, 10**9)
    with pytest.raises(OutputError, match="a could not be written: Permission denied"):
        files.write_whole(tmp_path / "a", b"one\n")
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_bytes() == b"before"


def test_a_folder_is_no_file(tmp_path, monkeypatch):
    """Windows refuses to open one, as it does a file without the right to read it."""
    assert files.read_whole(tmp_path) is None

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    (tmp_path / "a").write_bytes(b"one")
    monkeypatch.setattr(os, "open", refuse)
    assert files.read_whole(tmp_path) is None
    with pytest.raises(OutputError, match="a cannot be read: Permission denied"):
        files.read_whole(tmp_path / "a")


def test_a_write_that_takes_a_part_goes_on(tmp_path, monkeypatch):
    """As a pipe does, a network drive, or a write of more than 2 GiB on Linux."""
    real, taken = os.fdopen, []

    class Slow:
        def __init__(self, file):
            self.file = file

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.file.close()

        def fileno(self):
            return self.file.fileno()

        def write(self, data):
            taken.append(len(data))
            return self.file.write(data[:3])

    monkeypatch.setattr(files.os, "fdopen", lambda *a, **k: Slow(real(*a, **k)))
    sha256 = files.write_parts(tmp_path / "a", [b"0123456789", memoryview(b"ab"), b""])
    monkeypatch.undo()
    assert (tmp_path / "a").read_bytes() == b"0123456789ab"
    assert sha256 == hashlib.sha256(b"0123456789ab").hexdigest()
    assert taken == [10, 7, 4, 1, 2]


@pytest.mark.parametrize("read", [files.read_whole, files.digest_whole])
def test_a_file_that_is_too_large_is_not_read(read, tmp_path):
    """Not a byte of it, however large: a sparse file of a terabyte takes no room."""
    path = tmp_path / "a"
    path.write_bytes(b"123")
    assert read(path, 3) is not None
    with pytest.raises(OutputError, match="a must have at most 2 bytes, and has 3"):
        read(path, 2)
    with path.open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(OutputError, match=f"and has {2**40}"):
        read(path)


def test_a_temporary_file_is_made_anew(tmp_path, monkeypatch):
    """Never one that is there: another process may be writing it."""
    monkeypatch.setattr(files.os, "urandom", bytes)
    other = tmp_path / f".a.{os.getpid()}-00000000.tmp"
    other.write_bytes(b"somebody's")
    with pytest.raises(OutputError, match="a could not be written: File exists"):
        files.write_whole(tmp_path / "a", b"ours")
    assert not (tmp_path / "a").exists()
