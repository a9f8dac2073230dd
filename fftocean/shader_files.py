"""Compute shaders as files, below all modules that run or export them."""

from pathlib import Path

_FOLDER = Path(__file__).resolve().parent / "runtime" / "shaders"


def shader(name: str) -> bytes:
    """Return the contents of a shader of docs/kernels.md, by the name of its file."""
    return (_FOLDER / name).read_bytes()
