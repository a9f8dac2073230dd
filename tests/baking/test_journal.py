"""The journal: damaged lines are ignored, and each line is flushed to the disk."""

import errno
import hashlib
import os
import random

import pytest

from fftocean import files
from fftocean.baking.folder import journal
from fftocean.baking.folder.journal import Journal, entries_of
from fftocean.errors import OutputError

IDENTITY = "c" * 64
ENTRIES = [
    {
        "row": {
            "frame": j,
            "t": 0.1 * j,
            "files": {"height": {"path": f"height/{j:04d}.exr", "sha256": "ab" * 32}},
        }
    }
    for j in range(5)
]


@pytest.fixture
def path(tmp_path):
    with Journal(tmp_path / "journal", IDENTITY, []) as book:
        for entry in ENTRIES:
            book.add(entry)
    return tmp_path / "journal"


def test_what_was_written_is_read(path):
    assert [*entries_of(path, IDENTITY)] == ENTRIES
    assert path.read_bytes().count(b"\n") == 6


def test_no_journal_is_an_empty_one(tmp_path, path):
    assert [*entries_of(tmp_path / "none", IDENTITY)] == []
    assert [*entries_of(path, "d" * 64)] == []  # of another job
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to(path)
    os.mkfifo(tmp_path / "pipe")
    for name in ("folder", "link", "pipe"):
        assert [*entries_of(tmp_path / name, IDENTITY)] == []


def test_a_journal_cut_anywhere_has_the_lines_before(path):
    """
    Every length that a machine that stops may leave: a line counts when its end is there, and not
    before.
    """
    data = path.read_bytes()
    ends = [i + 1 for i, byte in enumerate(data) if byte == ord("\n")]
    for length in range(len(data) + 1):
        path.write_bytes(data[:length])
        whole = sum(end <= length for end in ends) - 1
        assert [*entries_of(path, IDENTITY)] == ENTRIES[: max(whole, 0)]


def test_any_flipped_bit_costs_its_line_and_no_other(path):
    """
    In the first line, which says whose journal it is, it costs them all. A line feed made or unmade
    costs two at most.
    """
    data = path.read_bytes()
    first = data.index(b"\n") + 1
    chance = random.Random(5)
    for bit in chance.sample(range(8 * len(data)), 600):
        bent = bytearray(data)
        bent[bit // 8] ^= 1 << bit % 8
        path.write_bytes(bent)
        read = [*entries_of(path, IDENTITY)]
        if bit // 8 < first - 1:
            assert read == []
        else:
            assert all(entry in ENTRIES for entry in read)
            assert len(ENTRIES) - 2 <= len(read) < len(ENTRIES) or bit // 8 == first - 1


def test_a_journal_goes_on_without_what_was_damaged(path):
    """Written anew with what is known, so that a half line at the end does not spoil the next."""
    path.write_bytes(path.read_bytes()[:-20])
    with Journal(path, IDENTITY, entries_of(path, IDENTITY)) as book:
        book.add({"row": {"frame": 9}})
    assert [*entries_of(path, IDENTITY)] == [*ENTRIES[:-1], {"row": {"frame": 9}}]


@pytest.mark.parametrize(
    "text", [b"", b"\n", b"\xff\n", b"[1]\n", b"0123456789abcdef {}\n", b"{" * 5000 + b"\n"]
)
def test_a_file_that_is_no_journal_is_an_empty_one(path, text):
    path.write_bytes(text)
    assert [*entries_of(path, IDENTITY)] == []


@pytest.mark.parametrize("text", [b"[1]", b'"row"', b"5", b"null", b"{", b"[" * 5000])
def test_a_line_that_is_no_table_is_left_out(path, text):
    """Though its checksum is right: the lines around it count."""
    first, *lines = path.read_bytes().splitlines(keepends=True)
    line = hashlib.sha256(text).hexdigest()[:16].encode() + b" " + text + b"\n"
    path.write_bytes(b"".join([first, lines[0], line, *lines[1:]]))
    assert list(entries_of(path, IDENTITY)) == ENTRIES
    path.write_bytes(b"".join([line, *lines]))
    assert list(entries_of(path, IDENTITY)) == []


def test_numbers_come_back_as_they_were(tmp_path):
    """To the bit: what is resumed must give the same manifest."""
    values = [0.1, 1e-308, 5e-324, 1.7976931348623157e308, -0.0, 2**53 + 1, 16.0 / 3.0]
    with Journal(tmp_path / "journal", IDENTITY, []) as book:
        book.add({"range": values})
        with pytest.raises(ValueError, match="JSON"):
            book.add({"range": [float("nan")]})
    (entry,) = entries_of(tmp_path / "journal", IDENTITY)
    assert [value.hex() if isinstance(value, float) else value for value in entry["range"]] == [
        value.hex() if isinstance(value, float) else value for value in values
    ]


@pytest.mark.parametrize(("call", "error"), [("write", errno.ENOSPC), ("fsync", errno.EIO)])
def test_a_line_that_is_not_on_the_disk_is_an_output_error(path, monkeypatch, call, error):
    real = getattr(os, call)
    with Journal(path, IDENTITY, []) as book:
        calls = []

        def fail(*arguments):
            calls.append(arguments)
            if call == "write" and len(calls) == 1:
                return real(
                    arguments[0], bytes(arguments[1])[:10]
                )  # half a line, as a disk that fills up takes
            raise OSError(error, os.strerror(error))

        monkeypatch.setattr(journal.os, call, fail)
        with pytest.raises(
            OutputError, match=rf"journal could not be written: {os.strerror(error)}"
        ):
            book.add(ENTRIES[0])
        monkeypatch.undo()
    assert [*entries_of(path, IDENTITY)] == ([] if call == "write" else [ENTRIES[0]])


def test_a_line_is_flushed_before_it_counts(path, monkeypatch):
    calls = []
    real = os.fsync
    monkeypatch.setattr(
        journal.os, "fsync", lambda descriptor: calls.append(descriptor) or real(descriptor)
    )
    with Journal(path, IDENTITY, []) as book:
        calls.clear()
        book.add(ENTRIES[0])
        assert len(calls) == 1


def test_a_journal_has_no_changed_line_ends(tmp_path, monkeypatch):
    """
    On a system with text files, as Windows: a descriptor that is opened without O_BINARY gets two
    bytes for each end of a line.
    """
    flag, real_open, real_write, text = 1 << 29, os.open, os.write, set()

    def opening(path, flags, mode=0o777, **more):
        descriptor = real_open(path, flags & ~flag, mode, **more)
        text.discard(descriptor)
        if not flags & flag:
            text.add(descriptor)
        return descriptor

    def writing(descriptor, data):
        data = bytes(data)
        real_write(descriptor, data.replace(b"\n", b"\r\n") if descriptor in text else data)
        return len(data)

    monkeypatch.setattr(journal, "AS_BYTES", files.AS_BYTES | flag)
    monkeypatch.setattr(os, "open", opening)
    monkeypatch.setattr(os, "write", writing)
    with Journal(tmp_path / "journal", IDENTITY, []) as book:
        for entry in ENTRIES:
            book.add(entry)
    assert [*entries_of(tmp_path / "journal", IDENTITY)] == ENTRIES
    assert b"\r" not in (tmp_path / "journal").read_bytes()
