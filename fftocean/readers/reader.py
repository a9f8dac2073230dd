"""Type of a reader of one file format."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fftocean.readers import bounded_reads

if TYPE_CHECKING:
    from xarray import Dataset

HEAD_BYTES = 16384
"""Bytes of a file by which a reader recognises it: the first line of a Spotter has 5 kB."""


@dataclass(frozen=True, slots=True)
class Head:
    """Beginning of a file, unpacked, by which its format is recognised."""

    path: Path
    data: bytes

    @classmethod
    def of(cls, path: Path) -> "Head":
        """Return the head of a file, plain or gzip."""
        return cls(path, bounded_reads.head(path, HEAD_BYTES))

    @property
    def lines(self) -> list[str]:
        """First lines, stripped; the last one may be cut."""
        return [line.strip() for line in self.data.decode("utf-8", "replace").split("\n")]

    @property
    def first_line(self) -> str:
        """First line, stripped; empty if there is none."""
        return self.lines[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class Reader:
    """
    A file format that can be read.

    Every field but `files` is required: without one the import raises TypeError or ValueError.
    """

    name: str  # of the format, as in lists and errors
    extensions: tuple[str, ...]  # usual endings of names; never used to recognise a file
    description: str  # one sentence for the list of formats
    sniff: Callable[[Head], bool]  # return True if a file with this head is in the format
    read: Callable[[Path, int, int], "Dataset"]  # (path, site, bins) -> dataset in `dataset_layout`
    files: Callable[[Path], list[Path]] = lambda path: [path]  # all files that are read with a file

    def __post_init__(self) -> None:
        if not self.name.strip() or not self.description.strip().endswith("."):
            raise ValueError(
                f"a reader must have a name and a sentence that describes it, got {self!r}"
            )
        if not self.extensions or not all(e.startswith(".") for e in self.extensions):
            raise ValueError(
                f"the extensions of {self.name} must begin with a dot, got {self.extensions!r}"
            )
        if not callable(self.sniff) or not callable(self.read):
            raise TypeError(f"sniff and read of {self.name} must be functions, got {self!r}")
