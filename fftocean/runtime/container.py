"""
Container of a run-time package: one run of bytes for a socket or a page.

"FFTO", then three unsigned integers of 32 bits, little-endian: the version 1, the length H of the
document, and 0; then H bytes of JSON, padded with spaces to a multiple of 16; then the files in the
order of the document, each padded with zeros to a multiple of 16.
"""

import json
import struct

from fftocean.runtime.layout import VERSION
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
