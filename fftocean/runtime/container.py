"""
Container of a run-time package: one run of bytes for a socket or a page.

"FFTO", then three unsigned integers of 32 bits, little-endian: the version 1, the length H of the
document, and 0; then H bytes of JSON, padded with spaces to a multiple of 16; then the files in the
order of the document, each padded with zeros to a multiple of 16.
"""

import json
import struct
from typing import Any

from fftocean.errors import IntegrityError
from fftocean.files import digest
from fftocean.runtime.contents import Contents, File
from fftocean.runtime.layout import DOCUMENT, MOST_DOCUMENT, VERSION
from fftocean.runtime.package import SeaPackage

MAGIC = b"FFTO"
ALIGNMENT = 16
_HEAD = struct.Struct("<4sIII")


def to_bytes(package: SeaPackage) -> bytes:
    """Return a package as one run of bytes."""
    document = json.dumps(
        package.document, ensure_ascii=False, allow_nan=False, separators=(",", ":")
    ).encode()
    document += b" " * (-len(document) % ALIGNMENT)
    parts = [_HEAD.pack(MAGIC, VERSION, len(document), 0), document]
    for data in package.files.values():
        parts += [data, bytes(-len(data) % ALIGNMENT)]
    return b"".join(parts)


def from_bytes(data: bytes | bytearray | memoryview) -> SeaPackage:
    """
    Return the package of a container.

    Raises:
        IntegrityError: the bytes are no container, or were cut or changed.
    """
    data = bytes(data)
    if len(data) < _HEAD.size or data[:4] != MAGIC:
        raise IntegrityError(f"a container must begin with {MAGIC!r}, got {data[:16]!r}")
    _, version, length, zero = _HEAD.unpack_from(data)
    if (version, zero) != (VERSION, 0):
        raise IntegrityError(
            f"a container must have version {VERSION} and 0 at its fourth number, "
            f"got {version} and {zero}"
        )
    if length % ALIGNMENT or length > MOST_DOCUMENT or _HEAD.size + length > len(data):
        raise IntegrityError(
            f"the document of a container must be a multiple of {ALIGNMENT} bytes, at most "
            f"{MOST_DOCUMENT}, and within it, got {length} of {len(data)}"
        )
    document = parsed(data[_HEAD.size : _HEAD.size + length])
    contents = Contents.of(document)
    at, files = _HEAD.size + length, {}
    for file in contents.files:
        files[file.name] = data[at : at + file.bytes]
        require_same(files[file.name], file)
        at += file.bytes
        padding = -at % ALIGNMENT
        if any(data[at : at + padding]):
            raise IntegrityError(f"{file.name} must be followed by zeros in a container")
        at += padding
    if at != len(data):
        raise IntegrityError(f"the container must have {at} bytes, and has {len(data)}")
    return SeaPackage(document, files)


def parsed(data: bytes) -> Any:
    """
    Return parsed JSON.

    Raises:
        IntegrityError: it is none.
    """
    try:
        return json.loads(data, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise IntegrityError(f"{DOCUMENT} is not JSON: {error!s:.80}") from None


def _refuse(constant: str) -> Any:
    raise ValueError(f"{constant} is no number in JSON")


def require_same(data: bytes, file: File) -> None:
    """
    Raise if the bytes of a file are not those that the document lists.

    Raises:
        IntegrityError: another length, or another SHA-256.
    """
    if len(data) != file.bytes:
        raise IntegrityError(f"{file.name} must have {file.bytes} bytes, and has {len(data)}")
    if file.sha256 is not None and digest(data) != file.sha256:
        raise IntegrityError(f"{file.name} was changed after it was written")
