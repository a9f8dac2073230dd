"""
Files that are whole or not there: encoded in memory, written beside their name, flushed to the
disk, then renamed.
"""

import contextlib
import errno
import hashlib
import json
import os
import stat
from pathlib import Path
from typing import Any

from fftocean.errors import JobError, OutputError, described

MAX_JSON = 4 * 2**20  # what a job of the largest file can come to, several times over
MAX_FILE = 2**37  # bytes: a container of a long sequence


def path_of(name: str, value: Any) -> Path:
    """
    Return what names a file or folder as a path.

    Raises:
        JobError: it is no path.
    """
    if not isinstance(value, (str, os.PathLike)):
        raise JobError(
            f"{name} must be a path, such as 'sea' or Path('sea'), got {described(value)}"
        )
    return Path(value)


def write_whole(path: Path, data: bytes | memoryview) -> str:
    """
    Write a file so that it is either whole or absent, and return its SHA-256.

    Raises:
        OutputError: the file could not be written; nothing is left behind.
    """
    temporary = path.with_name(
        f".{path.name}.{os.getpid()}-{os.urandom(4).hex()}.tmp"
    )  # two hosts may have one process number
    try:
        try:  # from before it is there: a signal may come between any two lines
            descriptor = os.open(
                temporary,
                os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0),
                0o666,
            )
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
    return digest(data)


def digest(data: bytes | memoryview) -> str:
    """The SHA-256 of some bytes."""
    return hashlib.sha256(data).hexdigest()


def sweep(folder: Path) -> None:
    """
    Remove the temporary files of whoever was stopped while writing into a folder; not through a
    link.

    Raises:
        OutputError: one is there and cannot be removed.
    """
    if not folder.is_symlink():
        for torn in folder.glob(".*.[0-9]*.tmp"):
            remove(torn)


def read_whole(path: Path, most: int = MAX_FILE) -> bytes | None:
    """
    Read a file of ours; None where there is no file of that name: a link, a folder or a device is
    none.

    Raises:
        OutputError: it is there and cannot be read, or is larger than `most` bytes.
    """
    try:
        descriptor = os.open(
            path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        )  # nor wait for a pipe
    except OSError as error:
        if error.errno in (errno.ENOENT, errno.ENOTDIR, errno.ELOOP, errno.ENXIO):
            return None
        raise OutputError(f"{path} cannot be read: {error.strerror or error}") from None
    try:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode):
            return None
        if found.st_size > most:
            raise OutputError(f"{path} must have at most {most} bytes, and has {found.st_size}")
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            return file.read(found.st_size)
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path} cannot be read: {error.strerror or error}") from None
    finally:
        os.close(descriptor)


def make_folder(path: Path) -> None:
    """
    Make a folder where there is none; refuse a link in its place, which would lead the files
    elsewhere.

    Raises:
        OutputError: it cannot be made, or something else has its name.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"{path} could not be made a folder: {error.strerror or error}"
        ) from error
    if path.is_symlink():
        raise OutputError(f"{path} must be a folder of its own, and is a link to {path.resolve()}")


def make_rooms(folder: Path, file: str) -> Path:
    """
    Make the folders between a folder and a file in it, and return the file's path; no link on the
    way is followed.

    Raises:
        OutputError: one cannot be made, or something else has its name.
    """
    *names, last = file.split("/")
    for name in names:
        folder = folder / name
        make_folder(folder)
    return folder / last


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
    """
    Readable JSON, the same bytes for the same tree; no NaN and no Infinity, which are not JSON.
    """
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
