"""
Files that are complete or absent, and canonical JSON.

A file is written under a temporary name, flushed to the disk, then renamed.
"""

import contextlib
import errno
import fnmatch
import hashlib
import json
import os
import stat
import sys
import time
from collections.abc import Iterable, Iterator
from io import BufferedReader
from pathlib import Path
from typing import Any

from fftocean.errors import JobError, OutputError, described

MAX_JSON = 4 * 2**20  # bytes: several times the description of the largest job file
GATHERED = 2**16  # bytes that are written at a time, of a file that is made in small parts
MAX_FILE = 2**37  # bytes: a container of a long sequence
PATIENCE = 2.0 if sys.platform == "win32" else 0.0  # [s], for others to close a file
AS_BYTES = getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)
"""
Flags of `os.open` for the bytes of a file itself: on Windows, without changed line ends; elsewhere,
not those of a link's target.
"""


def path_of(name: str, value: Any) -> Path:
    """
    Return a string or path as a path.

    Raises:
        JobError: the value is neither.
    """
    if not isinstance(value, (str, os.PathLike)):
        raise JobError(
            f"{name} must be a path, such as 'sea' or Path('sea'), got {described(value)}"
        )
    return Path(value)


def write_whole(path: Path, data: bytes | memoryview) -> str:
    """
    Write a file so that it is either complete or absent; return its SHA-256.

    Raises:
        OutputError: the file could not be written; no temporary file is left.
    """
    return write_parts(path, (data,))


def write_parts(path: Path, parts: Iterable[bytes | memoryview]) -> str:
    """
    Write a file that is made part by part, so that it is either complete or absent; return its
    SHA-256.

    Raises:
        OutputError: the file could not be written; no temporary file is left, nor if making a part
            raises.
    """
    sha256 = hashlib.sha256()
    temporary = path.with_name(
        f".{path.name}.{os.getpid()}-{os.urandom(4).hex()}.tmp"
    )  # two hosts may have one process number
    try:
        try:  # begins before the file exists: a signal may arrive between any two lines
            descriptor = os.open(
                temporary,
                os.O_WRONLY | os.O_CREAT | os.O_EXCL | AS_BYTES,
                0o666,
            )
            with os.fdopen(descriptor, "wb", buffering=0) as file:
                for part in parts:
                    sha256.update(part)
                    view = memoryview(part).cast("B")
                    while view:
                        view = view[file.write(view) :]
                os.fsync(file.fileno())
            _rename(temporary, path)
        except BaseException:
            with contextlib.suppress(OSError):
                temporary.unlink()
            raise
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}") from error
    return sha256.hexdigest()


def gathered(parts: Iterable[bytes]) -> Iterator[bytes]:
    """Yield the bytes of small parts in larger ones, each for one call of the system."""
    whole = bytearray()
    for part in parts:
        whole += part
        if len(whole) >= GATHERED:
            yield bytes(whole)
            whole.clear()
    if whole:
        yield bytes(whole)


def _rename(temporary: Path, path: Path) -> None:
    """
    Give a file its name, in place of another.

    On Windows that fails while a program, such as a virus scanner, has either of them open.
    """
    end = time.monotonic() + PATIENCE
    while True:
        try:
            temporary.replace(path)
        except PermissionError:
            if time.monotonic() >= end:
                raise
            time.sleep(0.02)
        else:
            return


def digest(data: bytes | memoryview) -> str:
    """Return the SHA-256 of some bytes."""
    return hashlib.sha256(data).hexdigest()


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, read in parts; links are followed."""
    sha256 = hashlib.sha256()
    with path.open("rb") as file:
        while part := file.read(2**20):
            sha256.update(part)
    return sha256.hexdigest()


def remove_temporary_files(folder: Path) -> None:
    """
    Remove the temporary files that a stopped process left in a folder; do nothing through a link.

    Raises:
        OutputError: one cannot be removed.
    """
    if not folder.is_symlink():
        for temporary in [*temporary_files(folder)]:
            remove(temporary)


def temporary_files(folder: Path) -> Iterator[Path]:
    """Yield the temporary files in a folder, in no order."""
    yield from entries_like(folder, ".*.[0-9]*.tmp")


@contextlib.contextmanager
def opened(path: Path, most: int = MAX_FILE) -> Iterator[BufferedReader | None]:
    """
    Open a file to read its bytes; None if there is none, or a link, a folder or a device.

    Raises:
        OutputError: the file exists and cannot be read, or is larger than `most` bytes.
    """
    try:
        # does not wait for a pipe
        descriptor = os.open(path, os.O_RDONLY | AS_BYTES | getattr(os, "O_NONBLOCK", 0))
    except OSError as error:
        if error.errno in (errno.ENOENT, errno.ENOTDIR, errno.ELOOP, errno.ENXIO) or path.is_dir():
            yield None  # Windows opens no folder
            return
        raise OutputError(f"{path} cannot be read: {error.strerror or error}") from None
    try:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode):
            yield None
            return
        if found.st_size > most:
            raise OutputError(f"{path} must have at most {most} bytes, and has {found.st_size}")
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            yield file
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path} cannot be read: {error.strerror or error}") from None
    finally:
        os.close(descriptor)


def read_whole(path: Path, most: int = MAX_FILE) -> bytes | None:
    """
    Return the bytes of a file; None if there is none, or a link, a folder or a device.

    Raises:
        OutputError: the file exists and cannot be read, or is larger than `most` bytes.
    """
    with opened(path, most) as file:
        return None if file is None else file.read()


def digest_whole(path: Path, most: int = MAX_FILE) -> str | None:
    """
    Return the SHA-256 of a file, read in parts; None where `read_whole` returns None.

    Raises:
        OutputError: the file exists and cannot be read, or is larger than `most` bytes.
    """
    with opened(path, most) as file:
        return None if file is None else hashlib.file_digest(file, "sha256").hexdigest()


def entries_like(folder: Path, pattern: str) -> Iterator[Path]:
    """
    Yield the entries of a folder whose names have a pattern as in a shell, in no order.

    Their names are not held, however many there are. There are none where the folder is missing or
    may not be read.
    """
    with (
        contextlib.suppress(FileNotFoundError, NotADirectoryError, PermissionError),
        os.scandir(folder) as entries,
    ):
        for entry in entries:
            if fnmatch.fnmatch(entry.name, pattern):
                yield folder / entry.name


def make_folder(path: Path) -> None:
    """
    Make a folder if it does not exist; refuse a link, which would lead the files elsewhere.

    Raises:
        OutputError: the folder cannot be made, or its name is that of something else.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"{path} could not be made a folder: {error.strerror or error}"
        ) from error
    if path.is_symlink():
        raise OutputError(f"{path} must be a folder, and is a link to {path.resolve()}")


def make_parents(folder: Path, file: str) -> Path:
    """
    Make the folders between a folder and a file in it; return the file's path. Links are refused.

    Raises:
        OutputError: one cannot be made, or its name is that of something else.
    """
    *names, last = file.split("/")
    for name in names:
        folder = folder / name
        make_folder(folder)
    return folder / last


def remove(path: Path) -> None:
    """
    Remove a file if it exists; of a link, the link itself.

    Raises:
        OutputError: it exists and cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{path} could not be removed: {error.strerror or error}") from error


def as_json(tree: Any) -> bytes:
    """
    Return readable JSON, the same bytes for the same tree, without NaN and Infinity.
    """
    return (json.dumps(tree, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()


def read_json(path: Path) -> Any:
    """
    Read a JSON file.

    Raises:
        OutputError: the file does not exist, is no JSON, or is larger than `MAX_JSON` bytes.
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
