"""JSON files that carry the SHA-256 of their own contents."""

import hashlib
import json
from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO

from fftocean.baking.folder.rows import BLOCK, PackedRows, RowList
from fftocean.errors import IntegrityError, OutputError
from fftocean.files import as_json, digest, gathered, opened, write_parts

CHECK = "check"
"""The key that holds the SHA-256 of all the others."""

MAX_BYTES = 2**33  # a million frames of all maps

ROWS = "frames"
"""The key whose list has an entry for each frame of a bake: read and written entry by entry."""

_HEAD, _FOOT = f'  "{ROWS}": [\n'.encode(), (b"  ]\n", b"  ],\n")  # lines around the entries
_LAST = (b"    }\n", b"    },\n")  # last line of an entry
_END = b"}\n"


def sealed(tree: Mapping[str, Any]) -> dict[str, Any]:
    """Return a tree with the SHA-256 of all of it under `CHECK`, by which any change is seen."""
    return {**tree, CHECK: digest(as_json(tree))}


def write_sealed(path: Path, tree: Mapping[str, Any]) -> dict[str, Any]:
    """
    Write the JSON of a tree with its SHA-256; return the tree with it.

    The bytes are those of `as_json(sealed(tree))`, whether the entry `ROWS` is a list or a
    `RowList`, which is written row by row.

    Raises:
        OutputError: the file could not be written.
    """
    sha256 = hashlib.sha256()

    def parts() -> Iterator[bytes]:
        for part in _body(tree):
            sha256.update(part)
            yield part
        sha256.update(b"\n" + _END)
        yield b",\n" + _check(sha256.hexdigest()) + _END

    write_parts(path, gathered(parts()))
    return {**tree, CHECK: sha256.hexdigest()}


def read_sealed(path: Path, most: int = MAX_BYTES) -> dict[str, Any]:
    """
    Read a file that holds the JSON of a `sealed` tree; return the tree without its checksum.

    The entry `ROWS`, if it is a list of objects, is a `RowList`.

    Raises:
        OutputError: the file cannot be read, or is larger than `most` bytes.
        IntegrityError: the file does not exist, or one of its bytes was changed.
    """
    with opened(path, most) as file:
        if file is None:
            raise IntegrityError(f"{path} does not exist")
        try:
            tree, same = _read(file)
        except (ValueError, RecursionError):
            raise IntegrityError(
                f"{path} is not JSON as a bake writes it: it was cut or changed"
            ) from None
    if not same:
        raise IntegrityError(f"{path} was changed after it was written")
    return tree


def is_sealed(path: Path) -> bool:
    """Return whether a file holds the JSON of a `sealed` tree, unchanged."""
    try:
        read_sealed(path)
    except (IntegrityError, OutputError):
        return False
    return True


def _body(tree: Mapping[str, Any]) -> Iterator[bytes]:
    """Yield the JSON of a tree in parts, without its last brace and the line feed before that."""
    before = b"{\n"
    for key, value in tree.items():
        rows = value if isinstance(value, RowList) and len(value) else None
        # an object of this key alone: "{\n  key: value\n}\n"
        entry = as_json({key: [] if isinstance(value, RowList) else value})[2:-3]
        yield before + (entry if rows is None else entry.removesuffix(b"]"))
        before = b",\n"
        if rows is not None:
            for place in range(0, len(rows), BLOCK):
                text = as_json(rows[place : place + BLOCK])  # "[\n  {...},\n  {...}\n]\n"
                yield (b"," if place else b"") + text[1:-3].replace(b"\n", b"\n  ")
            yield b"\n  ]"


def _check(sha256: str) -> bytes:
    return f'  "{CHECK}": "{sha256}"\n'.encode()


def _read(file: BinaryIO) -> tuple[dict[str, Any], bool]:
    """
    Return the tree in a file without its checksum, and whether that is right.

    Raises:
        ValueError: it is not JSON, or has no entry of `ROWS` as a bake writes it.
    """
    sha256, rows, rest = hashlib.sha256(), PackedRows(), bytearray()
    last: deque[bytes] = deque()  # the checksum is in the last lines, and not of them
    lines = iter(file)
    for line in lines:
        rest += line
        last.append(line)
        if len(last) > 3:
            sha256.update(last.popleft())
        if line == _HEAD and not rows:
            sha256.update(b"".join(last))
            last.clear()
            line = _read_rows(lines, rows, sha256)
            rest += line
            last.append(line)
    tree = json.loads(rest)
    if not isinstance(tree, dict) or len(last) != 3 or last[2] != _END:
        return {}, False
    tree.pop(CHECK, None)
    if rows:
        tree[ROWS] = RowList(rows)
    sha256.update(last[0].removesuffix(b",\n").removesuffix(b"\n") + b"\n" + _END)
    return tree, last[1] == _check(sha256.hexdigest())


def _read_rows(lines: Iterator[bytes], rows: PackedRows, sha256: Any) -> bytes:
    """
    Read the entries of a list, to its last line, which is returned and not added to the checksum.

    Raises:
        ValueError: the list does not end, or an entry is no object.
    """
    text = bytearray()
    for line in lines:
        if line in _FOOT and not text:
            return line
        text += line
        if line in _LAST:
            row = json.loads(text.rstrip(b",\n"))
            if not isinstance(row, dict):
                raise ValueError("an entry is no object")
            rows.put(len(rows), row)
            sha256.update(text)
            text.clear()
    raise ValueError("the list does not end")
