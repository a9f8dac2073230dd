"""
Bounded reads of files that may be damaged, huge or hostile.

Every failure is a `ReaderError`.
"""

import codecs
import gzip
import io
import os
import re
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final, cast

from fftocean.errors import ReaderError

MAX_BYTES: Final = 256 * 2**20
"""
Most bytes read of a text file or unpacked from a .gz: forty years of one buoy, a nested SWAN
boundary.
"""

MAX_LINE: Final = 2**20
"""Longest line in bytes: 65 000 directions of a SWAN row."""

MAX_MESSAGE: Final = 480
"""Longest error message in characters."""

_GZIP = b"\x1f\x8b"
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")


@contextmanager
def reader_errors(name: str) -> Iterator[None]:
    """
    Turn errors of the operating system and of gzip into a `ReaderError` that names the file.
    """
    try:
        yield
    except (OSError, EOFError, zlib.error) as error:
        raise ReaderError(
            f"{name} cannot be read: {getattr(error, 'strerror', None) or error}"
        ) from error


def require_file(path: Path) -> None:
    """
    Raise if a path is not a regular file with contents.

    Raises:
        ReaderError: nothing is there, or a directory, a device, a pipe, an empty file.
    """
    with reader_errors(path.name or str(path)):
        if "\0" in str(path) or not path.exists():
            raise ReaderError(f"the spectrum must be a file that exists, got {str(path)!r}")
        if not path.is_file():
            raise ReaderError(
                f"the spectrum must be a regular file, got {str(path)!r} "
                f"({'a directory' if path.is_dir() else 'a device'})"
            )
        if path.stat().st_size == 0:
            raise ReaderError(f"{path.name} is empty")


@contextmanager
def opened(path: Path) -> Iterator[IO[bytes]]:
    """
    Open a regular file without blocking.

    A pipe put in its place after a check would block, and is refused too.

    Raises:
        ReaderError: no regular file, or one that cannot be read.
    """
    with reader_errors(path.name):
        descriptor = os.open(
            path,
            os.O_RDONLY
            | getattr(os, "O_NONBLOCK", 0)
            | getattr(os, "O_CLOEXEC", 0)
            | getattr(os, "O_BINARY", 0),
        )
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise ReaderError(f"the spectrum must be a regular file, got {str(path)!r}")
        yield file


@contextmanager
def unpacked(path: Path) -> Iterator[IO[bytes]]:
    """
    Open a file as a stream of bytes, through gzip if its first bytes are those of gzip (whatever
    its name).
    """
    with reader_errors(path.name), opened(path) as raw:
        if raw.read(2) == _GZIP:
            raw.seek(0)
            with gzip.GzipFile(fileobj=raw) as stream:
                yield _after_mark(cast(IO[bytes], stream))
        else:
            raw.seek(0)
            yield _after_mark(raw)


def _after_mark(stream: IO[bytes]) -> IO[bytes]:
    """Return a stream at its first byte, after a byte-order mark if it has one."""
    if stream.read(len(codecs.BOM_UTF8)) != codecs.BOM_UTF8:
        stream.seek(0)
    return stream


def is_packed(path: Path) -> bool:
    """Return True if a file is gzip."""
    with reader_errors(path.name), opened(path) as raw:
        return raw.read(2) == _GZIP


def head(path: Path, count: int = 4096) -> bytes:
    """Return the first `count` bytes, unpacked."""
    with unpacked(path) as stream:
        return stream.read(count)


def contents(path: Path) -> io.BytesIO:
    """
    Return all bytes, unpacked into memory.

    Raises:
        ReaderError: more than `MAX_BYTES`; no more than that is ever unpacked.
    """
    held = io.BytesIO()
    with unpacked(path) as stream:
        # A single call would allocate as much as the file claims.
        while part := stream.read(2**20):
            held.write(part)
            if held.tell() > MAX_BYTES:
                raise ReaderError(
                    f"{path.name} must unpack to at most {MAX_BYTES >> 20} MiB, got more"
                )
    held.seek(0)
    return held


def lines(path: Path, *, blank: bool = False) -> Iterator[tuple[str, str]]:
    """
    Yield the lines of a text file, each after its place in words (`buoy.txt: line 3`), for errors.

    The last line need not end with a newline. If it does not, the file may have been cut within its
    last number; this is an error if that number has fewer decimals than the one before it.

    Raises:
        ReaderError: a line longer than `MAX_LINE`, more than `MAX_BYTES` in all, text that is not
            UTF-8, an empty line before the last, or a last number that was cut.
    """
    read, number, empty = 0, 0, ""
    with unpacked(path) as stream:
        while raw := stream.readline(MAX_LINE + 1):
            number += 1
            read += len(raw)
            where = f"{path.name}: line {number}"
            if len(raw) > MAX_LINE:
                raise ReaderError(f"{where} must be at most {MAX_LINE} bytes long, got more")
            if read > MAX_BYTES:
                raise ReaderError(
                    f"{where}: a text file must be at most {MAX_BYTES >> 20} MiB, got more"
                )
            try:
                text = raw.decode("utf-8").strip()
            except UnicodeDecodeError as error:
                raise ReaderError(
                    f"{where} must be UTF-8 text, got the byte {raw[error.start]:#04x} at "
                    f"{error.start}"
                ) from error
            if empty and not blank:
                raise ReaderError(f"{empty} is empty")
            if not raw.endswith(b"\n"):
                _require_whole_number(where, text)
            if text:
                yield where, text
            else:
                empty = where


def _require_whole_number(where: str, line: str) -> None:
    """Raise if the last number of a line has fewer decimals than the one before it."""
    decimals = [re.fullmatch(r"[+-]?[0-9]*(?:\.([0-9]*))?", token) for token in line.split()[-2:]]
    if len(decimals) == 2 and all(decimals):
        before, last = (len(match[1] or "") for match in decimals if match)
        if last < before:
            raise ReaderError(
                f"{where} has no end, and its last number {line.split()[-1]!r:.40} has fewer "
                "decimals than the one before it: "
                "the file is cut short (if it is whole, end it with a newline)"
            )


def has_final_newline(path: Path) -> bool:
    """
    Return True if a text file ends with a newline, or is packed: then checksums show that it is
    whole.
    """
    if is_packed(path):
        return True
    with reader_errors(path.name), opened(path) as file:
        file.seek(-1, io.SEEK_END)
        return file.read(1) == b"\n"


def printable(text: str) -> str:
    """
    Return an error message that is safe to show in a terminal.

    A damaged file may hold any names. Control characters, which could steer the terminal, become
    escapes, and the message is cut to `MAX_MESSAGE`.
    """
    shown = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
    return shown if len(shown) <= MAX_MESSAGE else shown[: MAX_MESSAGE - 4] + " ..."


def number(where: str, token: str) -> float:
    """
    Return a plain decimal number.

    (`float` itself also accepts `nan`, `1_0` and digits of every script.)

    Raises:
        ReaderError: anything else, naming the place.
    """
    if not _NUMBER.fullmatch(token):
        raise ReaderError(f"{where} must hold a number here, got {token!r:.40}")
    return float(token)


def count(where: str, line: str, most: int) -> int:
    """Return the whole number at the start of a line, from 1 to `most`."""
    token = line.split()[0]
    if not re.fullmatch(r"[0-9]{1,9}", token) or not 1 <= int(token) <= most:
        raise ReaderError(
            f"{where} must begin with a whole number between 1 and {most}, got {token!r:.40}"
        )
    return int(token)
