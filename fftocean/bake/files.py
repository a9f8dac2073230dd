"""Files that are whole or not there: encoded in memory, written beside their name, flushed to the disk, then renamed."""

import contextlib
import hashlib
import json
import os
from pathlib import Path
from typing import Any

from fftocean.errors import OutputError

MAX_JSON = 4 * 2**20  # what a job of the largest file can come to, several times over


def write_whole(path: Path, data: bytes | memoryview) -> str:
    """
    Write a file so that it is either whole or absent, and return its SHA-256.

    Raises:
        OutputError: the file could not be written; nothing is left behind.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        try:  # from before it is there: a signal may come between any two lines
            descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0), 0o666)
            with open(descriptor, "wb", buffering=0) as file:  # noqa: PTH123 - a descriptor, not a path
                view = memoryview(data)
                while view:
                    view = view[file.write(view) :]
                os.fsync(file.fileno())
            temporary.replace(path)
        except BaseException:
            with contextlib.suppress(OSError):
                temporary.unlink()
            raise
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}") from error
    return hashlib.sha256(data).hexdigest()


def make_folder(path: Path) -> None:
    """
    Make a folder where there is none; refuse a link in its place, which would lead the files elsewhere.

    Raises:
        OutputError: it cannot be made, or something else has its name.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{path} could not be made a folder: {error.strerror or error}") from error
    if path.is_symlink():
        raise OutputError(f"{path} must be a folder of its own, and is a link to {path.resolve()}")


def remove(path: Path) -> None:
    """
    Remove a file, or a link and not what it leads to, where there is one.

    Raises:
        OutputError: it is there and cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{path} could not be removed: {error.strerror or error}") from error


def as_json(tree: Any) -> bytes:
    """Readable JSON, the same bytes for the same tree; no NaN and no Infinity, which are not JSON."""
    return (json.dumps(tree, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()


def read_json(path: Path) -> Any:
    """
    Read a JSON file.

    Raises:
        OutputError: it is there and cannot be read as JSON, or is larger than any of ours.
    """
    if not path.is_file():
        raise OutputError(f"{path} must be a file, and is not")
    try:
        with path.open("rb") as file:
            data = file.read(MAX_JSON + 1)
        if len(data) > MAX_JSON:
            raise ValueError(f"more than {MAX_JSON} bytes")
        return json.loads(data)
    except (OSError, ValueError, RecursionError) as error:
        raise OutputError(f"{path} cannot be read: {error!s:.120}") from None
