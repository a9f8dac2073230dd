"""JSON text of sidecars: readable, and the same bytes for the same content."""

import json
from collections.abc import Mapping
from typing import Any


def as_json(tree: Mapping[str, Any]) -> bytes:
    """Return indented JSON in UTF-8, with a final newline; no NaN and no infinity."""
    return (json.dumps(tree, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
