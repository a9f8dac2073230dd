"""
Journal of a bake: one line for each finished step, flushed to the disk, with a checksum of its own.

A `RunLog` reports the same steps to the caller.
"""

import contextlib
import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from fftocean.errors import OutputError
from fftocean.files import AS_BYTES, digest, read_whole, write_whole

MAX_BYTES = 2**33  # a million frames of all maps, each about two thousand

Entry = dict[str, Any]
"""One finished step: {"foam": ...}, {"range": ...}, {"ranges": ...} or {"row": ...}."""

Progress = Callable[[int, int], None]
"""Called with (frames done, frames in all)."""

Listen = Callable[[dict[str, Any]], None]
"""Called with each event as plain data: {"event": "start" | "survey" | "frame" | "done", ...}."""


class Journal:
    """
    A journal that is open for writing: one process writes it, line by line.

    A line is `<check> <entry as JSON>`; the check is the beginning of the entry's SHA-256. Lines
    that are cut or changed, and those of another bake, are ignored. The result that a line records
    is on the disk before the line is.
    """

    def __init__(self, path: Path, identity: str, entries: list[Entry]) -> None:
        """Write a journal of the bake with an identity that begins with known entries."""
        self.path = path
        # the first line's key is part of the format of the journal
        lines = [_line({"claim": identity}), *map(_line, entries)]
        write_whole(path, b"".join(lines))  # without lines that were cut or changed
        try:
            self._descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | AS_BYTES)
        except OSError as error:
            raise OutputError(f"{path} could not be written: {error.strerror or error}") from error

    def add(self, entry: Entry) -> None:
        """
        Write a line and flush it to the disk.

        Raises:
            OutputError: the line could not be written; readers ignore it, whole or not.
        """
        view = memoryview(_line(entry))
        try:
            while view:
                view = view[os.write(self._descriptor, view) :]
            os.fsync(self._descriptor)
        except OSError as error:
            raise OutputError(
                f"{self.path} could not be written: {error.strerror or error}"
            ) from error

    def __enter__(self) -> "Journal":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with contextlib.suppress(OSError):
            os.close(self._descriptor)


class RunLog:
    """Entries of earlier runs, the journal of this one, and its listeners."""

    def __init__(
        self,
        folder: Path,
        journal: Journal,
        known: Sequence[Entry],
        progress: Progress | None = None,
        listen: Listen | None = None,
    ) -> None:
        self.folder = folder
        self._journal, self._known = journal, known
        self._progress, self._listen = progress, listen

    def recorded(self, kind: str) -> list[Any]:
        """Return the values of all entries of one kind that earlier runs recorded, in order."""
        return [entry[kind] for entry in self._known if kind in entry]

    def is_unchanged(self, path: str, sha256: str) -> bool:
        """Return whether a file of the folder exists and has a checksum."""
        data = read_whole(self.folder / path)
        return data is not None and digest(data) == sha256

    def add(self, entry: Entry) -> None:
        """Record in the journal what is finished and on the disk."""
        self._journal.add(entry)

    def progress(self, done: int, total: int) -> None:
        """Report the number of frames done."""
        if self._progress:
            self._progress(done, total)

    def report(self, event: str, **details: Any) -> None:
        """Report an event to the listener."""
        if self._listen:
            self._listen({"event": event, **details})


def entries_of(path: Path, identity: str) -> list[Entry]:
    """
    Return every entry of a bake's journal whose line is whole, in order.

    There are none where the file does not exist, or is the journal of another bake.

    Raises:
        OutputError: the file exists and cannot be read.
    """
    data = read_whole(path, MAX_BYTES)
    first, *lines = (data or b"").splitlines(keepends=True) or [b""]
    if _entry(first) != {"claim": identity}:
        return []
    return [entry for line in lines if (entry := _entry(line)) is not None]


def _line(entry: Mapping[str, Any]) -> bytes:
    """Return the line of an entry."""
    text = json.dumps(entry, separators=(",", ":"), ensure_ascii=True, allow_nan=False).encode()
    return _check(text) + b" " + text + b"\n"


def _entry(line: bytes) -> Entry | None:
    """Return the entry of a line, or None where the line is cut or changed."""
    check, _, text = line.rstrip(b"\n").partition(b" ")
    if not line.endswith(b"\n") or check != _check(text):
        return None
    try:
        entry = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return entry if isinstance(entry, dict) else None


def _check(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()
