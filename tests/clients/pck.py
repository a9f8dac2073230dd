"""Godot's .pck container, format 2: a header, a directory and the files, as Godot 4 reads it."""

import hashlib
import struct

ALIGNMENT = 32


def pack(files):
    """Return a .pck that holds files, {path below res://: bytes}."""
    up = lambda n: -(-n // ALIGNMENT) * ALIGNMENT  # noqa: E731
    paths = {name: ("res://" + name).encode() for name in sorted(files)}
    paths = {name: path + bytes(-len(path) % 4) for name, path in paths.items()}
    # magic, format, engine's major, minor, patch; flags and base of the files, 0: offsets count
    # from the start; 16 words reserved
    header = struct.pack("<4sIIIIIQ64xI", b"GDPC", 2, 4, 4, 0, 0, 0, len(files))
    at = up(len(header) + sum(4 + len(path) + 8 + 8 + 16 + 4 for path in paths.values()))
    directory, bodies = b"", b""
    for name, path in paths.items():
        data = bytes(files[name])
        directory += (
            struct.pack("<I", len(path))
            + path
            + struct.pack("<QQ16sI", at + len(bodies), len(data), hashlib.md5(data).digest(), 0)
        )
        bodies += data + bytes(up(len(data)) - len(data))
    return (header + directory).ljust(at, b"\0") + bodies
