"""
Journal of a bake: one line for each finished step, flushed to the disk, with a checksum of its own.

A `RunLog` reports the same steps to the caller.
"""

import contextlib
import hashlib
import itertools
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from fftocean.baking.folder.rows import PackedRows
from fftocean.errors import OutputError
from fftocean.files import AS_BYTES, digest, gathered, opened, read_whole, write_parts

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

    def __init__(self, path: Path, identity: str, entries: Iterable[Entry]) -> None:
        """Write a journal of the bake with an identity that begins with known entries."""
        self.path = path
        # the first line's key is part of the format of the journal
        lines = map(_line, itertools.chain([{"claim": identity}], entries))
        write_parts(path, gathered(lines))  # without lines that were cut or changed
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


class Recorded:
    """Results of earlier runs: those of frames are packed, as there may be any number of them."""

    def __init__(self, entries: Iterable[Entry] = ()) -> None:
        self._frames = {kind: PackedRows() for kind in ("row", "range")}  # by frame of the loop
        self._others: list[Entry] = []
        for entry in entries:
            kind = next(iter(entry), "")
            if kind in self._frames:
                self._frames[kind].put(entry[kind]["frame"], entry[kind])
            else:
                self._others.append(entry)

    def of(self, kind: str) -> list[Any]:
        """Return the values of all entries of one kind, not one of frames, in order."""
        return [entry[kind] for entry in self._others if kind in entry]

    def of_frames(self, kind: str) -> PackedRows:
        """Return the values of all entries of one kind, "row" or "range", by frame of the loop."""
        return self._frames[kind]

    def entries(self) -> Iterator[Entry]:
        """Yield all entries."""
        yield from self._others
        for kind, rows in self._frames.items():
            yield from ({kind: row} for row in rows.values())


class RunLog:
    """Entries of earlier runs, the journal of this one, and its listeners."""

    def __init__(
        self,
        folder: Path,
        journal: Journal,
        recorded: Recorded,
        progress: Progress | None = None,
        listen: Listen | None = None,
    ) -> None:
        self.folder = folder
        self._journal, self.recorded = journal, recorded
        self._progress, self._listen = progress, listen

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


def entries_of(path: Path, identity: str) -> Iterator[Entry]:
    """
    Yield every entry of a bake's journal whose line is whole, in order.

    There are none where the file does not exist, or is the journal of another bake.

    Raises:
        OutputError: the file exists and cannot be read.
    """
    with opened(path, MAX_BYTES) as file:
        if file is None or _entry(file.readline()) != {"claim": identity}:
            return
        for line in file:
            if (entry := _entry(line)) is not None:
                yield entry


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
