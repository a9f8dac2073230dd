"""One bake a folder: a lock that the operating system takes back from whoever dies."""

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
PATIENCE = 1.0  # [s]: workers of a bake that was just killed are still on their way out
_FAR = 1 << 30  # where Windows locks a byte: beyond all that is written, which others may then read
_BUSY = (errno.EAGAIN, errno.EACCES, errno.EWOULDBLOCK, errno.EDEADLK)


@dataclass(frozen=True, slots=True)
class Hold:
    """
    A folder that is ours: the descriptor goes to workers on this machine, so that they hold it too;
    the token to all others.
    """

    descriptor: int
    token: str


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[Hold]:
    """
    Hold a folder for this process.

    The lock goes with the last process that has the descriptor, however that one ends: a lock file
    that nobody holds is stale.

    Raises:
        FolderInUseError: another process holds it, and did so for `PATIENCE`; its process number
            and host are named.
        OutputError: the lock file cannot be written.
    """
    path = folder / LOCK_FILE
    descriptor = _acquired(path, time.monotonic() + PATIENCE)
    try:
        yield Hold(descriptor, _signed(descriptor, path))
    finally:
        try:
            if (
                os.name == "posix"
                # while it is still held: nobody can take a file for the lock that has no name any more
            ):
                _forget(path)
        finally:
            os.close(descriptor)
        if os.name != "posix":  # Windows removes no open file
            _forget(path)


def _forget(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.unlink()


def require_free(folder: Path) -> None:
    """
    Refuse a folder that is in use, before anything takes time; what is free now may be taken later.

    Raises:
        FolderInUseError: another process holds it.
    """
    path = folder / LOCK_FILE
    try:
        there = stat.S_ISREG(path.stat(follow_symlinks=False).st_mode)
    except OSError:  # a folder that cannot be is refused where it is made
        there = False
    if there:
        os.close(_acquired(path, time.monotonic() + PATIENCE))


def _acquired(path: Path, deadline: float) -> int:
    """
    A descriptor of the lock file, locked; the file under that name, and not one that was removed
    meanwhile.
    """
    while True:
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), 0o666)
        except OSError as error:
            raise OutputError(f"{path} could not be written: {error.strerror or error}") from error
        try:
            if _seized(descriptor):
                if _still_named(path, descriptor):
                    return descriptor
            elif time.monotonic() >= deadline:
                raise FolderInUseError(
                    f"{path.parent} is in use by another bake{_holder(path)}; wait for it, or choose another folder"
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


def _seized(descriptor: int) -> bool:
    """Whether the lock is ours now."""
    try:
        if fcntl is not None:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        elif msvcrt is not None:
            os.lseek(descriptor, _FAR, os.SEEK_SET)
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
    Whether the name still leads to the file that was locked: its last holder may have removed it in
    between.
    """
    try:
        return os.path.samestat(path.stat(follow_symlinks=False), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _signed(descriptor: int, path: Path) -> str:
    """Say who holds it, and return the token of this hold."""
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
    Refuse to go on for a bake that holds its folder no more: it was stopped, or another one took
    over.

    For workers on other machines, which the operating system does not stop with it.

    Raises:
        FolderInUseError: the lock file is not there, or is that of another hold.
    """
    if _signature(folder / LOCK_FILE).get("token") != token:
        raise FolderInUseError(
            f"{folder} is not held by this bake any more, or is not the same folder on {socket.gethostname()}"
        )


def _signature(path: Path) -> dict[str, Any]:
    """What the holder wrote; nothing where that cannot be read."""
    try:
        with path.open("rb") as file:
            signature = json.loads(file.read(4096))
    except (OSError, ValueError):
        return {}
    return signature if isinstance(signature, dict) else {}


def _holder(path: Path) -> str:
    """Who signed, in words."""
    signature = _signature(path)
    return (
        f", process {signature['pid']!s:.20} on {signature['host']!s:.80}"
        if {"pid", "host"} <= set(signature)
        else ""
    )
