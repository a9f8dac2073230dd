"""
What a bake has done so far: a line for each thing that is finished, flushed to the disk, each with
a check of its own.
"""

import contextlib
import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from fftocean.errors import OutputError
from fftocean.files import read_whole, write_whole

MAX_BYTES = 2**33  # a million frames of all maps, each about two thousand
Entry = dict[str, Any]


class Journal:
    """
    A journal that is open for writing: one process writes it, line by line.

    A line is `<check> <entry as JSON>`; the check is the beginning of the entry's SHA-256. A line
    that is cut, bent or of another claim is as if it had never been written. What a line says was
    on the disk before the line was.
    """

    def __init__(self, path: Path, claim: str, entries: list[Entry]) -> None:
        """Write a new journal of what is known; `claim` says whose it is. Use as a context."""
        self.path = path
        lines = [_line({"claim": claim}), *map(_line, entries)]
        write_whole(path, b"".join(lines))  # without what was cut or bent
        try:
            self._descriptor = os.open(
                path, os.O_WRONLY | os.O_APPEND | getattr(os, "O_NOFOLLOW", 0)
            )
        except OSError as error:
            raise OutputError(f"{path} could not be written: {error.strerror or error}") from error

    def add(self, entry: Entry) -> None:
        """
        Write a line and flush it to the disk.

        Raises:
            OutputError: that failed; the line does not count, whole or not.
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


def entries_of(path: Path, claim: str) -> list[Entry]:
    """
    Return every entry of a journal whose line is whole, in order; none where there is no journal,
    or that of another claim.

    Raises:
        OutputError: it is there and cannot be read.
    """
    data = read_whole(path, MAX_BYTES)
    first, *lines = (data or b"").splitlines(keepends=True) or [b""]
    if _entry(first) != {"claim": claim}:
        return []
    return [entry for line in lines if (entry := _entry(line)) is not None]


def _line(entry: Mapping[str, Any]) -> bytes:
    """An entry as it stands in the journal."""
    text = json.dumps(entry, separators=(",", ":"), ensure_ascii=True, allow_nan=False).encode()
    return _check(text) + b" " + text + b"\n"


def _entry(line: bytes) -> Entry | None:
    """The entry of a line, if all of it is there and as it was written."""
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
