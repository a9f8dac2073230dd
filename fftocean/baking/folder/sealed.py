"""JSON files that carry the SHA-256 of their own contents."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fftocean.errors import IntegrityError, OutputError
from fftocean.files import as_json, digest, read_whole

CHECK = "check"
"""The key that holds the SHA-256 of all the others."""

MAX_BYTES = 2**33  # a million frames of all maps


def sealed(tree: Mapping[str, Any]) -> dict[str, Any]:
    """Return a tree with the SHA-256 of all of it under `CHECK`, by which any change is seen."""
    return {**tree, CHECK: digest(as_json(tree))}


def read_sealed(path: Path, most: int = MAX_BYTES) -> dict[str, Any]:
    """
    Read a file that holds the JSON of a `sealed` tree; return the tree without its checksum.

    Raises:
        OutputError: the file cannot be read, or is larger than `most` bytes.
        IntegrityError: the file does not exist, or one of its bytes was changed.
    """
    data = read_whole(path, most)
    if data is None:
        raise IntegrityError(f"{path} does not exist")
    try:
        tree = json.loads(data)
        same = isinstance(tree, dict) and as_json(tree) == data
    except (ValueError, RecursionError):
        raise IntegrityError(
            f"{path} is not JSON as a bake writes it: it was cut or changed"
        ) from None
    if not same or tree.pop(CHECK, None) != digest(as_json(tree)):
        raise IntegrityError(f"{path} was changed after it was written")
    return tree  # type: ignore[no-any-return]


def is_sealed(path: Path) -> bool:
    """Return whether a file holds the JSON of a `sealed` tree, unchanged."""
    try:
        read_sealed(path)
    except (IntegrityError, OutputError):
        return False
    return True
