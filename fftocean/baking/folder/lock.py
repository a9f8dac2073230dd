"""Lock on a bake's folder, which the operating system releases when its process ends."""

import contextlib
import errno
import json
import os
import socket
import stat
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from fftocean.errors import FolderInUseError, OutputError
from fftocean.files import AS_BYTES

fcntl: ModuleType | None
msvcrt: ModuleType | None
try:
    import fcntl
except ImportError:  # no POSIX
    fcntl = None
try:
    import msvcrt
except ImportError:  # no Windows
    msvcrt = None

LOCK_FILE = ".lock"
PATIENCE = 1.0  # [s]: workers of a bake that was just killed need a moment to end
_LOCK_OFFSET = 1 << 30  # byte that Windows locks: beyond the text, which others may then read
_BUSY = (errno.EAGAIN, errno.EACCES, errno.EWOULDBLOCK, errno.EDEADLK)


@dataclass(frozen=True, slots=True)
class FolderLock:
    """
    A lock that is held: workers on this machine inherit its descriptor, all others get its token.
    """

    descriptor: int
    token: str


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[FolderLock]:
    """
    Lock a folder for this process.

    The lock is released with the last process that has the descriptor, however that process ends: a
    stale lock file never blocks.

    Raises:
        FolderInUseError: another process held the lock for `PATIENCE`; the message names its
            number and host.
        OutputError: the lock file cannot be written.
    """
    path = folder / LOCK_FILE
    descriptor = _acquire(path, time.monotonic() + PATIENCE)
    try:
        yield FolderLock(descriptor, _write_owner(descriptor, path))
    finally:
        try:
            if os.name == "posix":
                # before the release: nobody can lock a file that has no name any more
                _unlink(path)
        finally:
            os.close(descriptor)
        if os.name != "posix":  # Windows removes no open file
            _unlink(path)


def _unlink(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.unlink()


def require_free(folder: Path) -> None:
    """
    Raise if a folder is in use now; it may be locked later all the same.

    Raises:
        FolderInUseError: another process holds the lock.
    """
    path = folder / LOCK_FILE
    try:
        is_file = stat.S_ISREG(path.stat(follow_symlinks=False).st_mode)
    except OSError:  # an impossible folder is refused when it is made
        is_file = False
    if is_file:
        os.close(_acquire(path, time.monotonic() + PATIENCE))


def _acquire(path: Path, deadline: float) -> int:
    """
    Return a locked descriptor of the lock file.

    It is that of the file under that name now, and not of one that was removed meanwhile.
    """
    while True:
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | AS_BYTES, 0o666)
        except OSError as error:
            raise OutputError(f"{path} could not be written: {error.strerror or error}") from error
        try:
            if _try_lock(descriptor):
                if _still_named(path, descriptor):
                    return descriptor
            elif time.monotonic() >= deadline:
                raise FolderInUseError(
                    f"{path.parent} is in use by another bake{_owner_in_words(path)}; "
                    "wait for it, or choose another folder"
                )
            else:
                time.sleep(0.02)
        except OSError as error:
            os.close(descriptor)
            if isinstance(error, OutputError):
                raise
            raise OutputError(f"{path} could not be locked: {error.strerror or error}") from error
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _try_lock(descriptor: int) -> bool:
    """Lock the file if it is free; return whether this process holds the lock."""
    try:
        if fcntl is not None:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        elif msvcrt is not None:
            os.lseek(descriptor, _LOCK_OFFSET, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        else:
            raise OSError(errno.ENOTSUP, "this system has no file locks")
    except OSError as error:
        if error.errno in _BUSY:
            return False
        raise
    return True


def _still_named(path: Path, descriptor: int) -> bool:
    """
    Return whether the path still names the locked file: its last owner may have removed it in
    between.
    """
    try:
        return os.path.samestat(path.stat(follow_symlinks=False), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _write_owner(descriptor: int, path: Path) -> str:
    """Write process number, host and a new token into the lock file; return the token."""
    token = os.urandom(8).hex()
    try:
        os.ftruncate(descriptor, 0)
        os.lseek(descriptor, 0, os.SEEK_SET)
        data = json.dumps(
            {"pid": os.getpid(), "host": socket.gethostname(), "token": token}
        ).encode()
        if os.write(descriptor, data) < len(data):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}") from error
    return token


def require_held(folder: Path, token: str) -> None:
    """
    Raise if the bake with a token does not hold its folder any more.

    Workers on other machines call this: the operating system does not stop them with the bake.

    Raises:
        FolderInUseError: the lock file does not exist, or has another token.
    """
    if _read_owner(folder / LOCK_FILE).get("token") != token:
        raise FolderInUseError(
            f"{folder} is not held by this bake any more, "
            f"or is not the same folder on {socket.gethostname()}"
        )


def _read_owner(path: Path) -> dict[str, Any]:
    """Return the contents of a lock file; {} where it cannot be read."""
    try:
        with path.open("rb") as file:
            owner = json.loads(file.read(4096))
    except (OSError, ValueError):
        return {}
    return owner if isinstance(owner, dict) else {}


def _owner_in_words(path: Path) -> str:
    """Return the owner of a lock in words, for a message."""
    owner = _read_owner(path)
    return (
        f", process {owner['pid']!s:.20} on {owner['host']!s:.80}"
        if {"pid", "host"} <= set(owner)
        else ""
    )
