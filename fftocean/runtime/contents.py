"""Contents of a run-time package as its document describes them, checked entry by entry."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from fftocean.cells import Band
from fftocean.errors import IntegrityError, ParameterError
from fftocean.grid import Grid
from fftocean.limits import (
    BAND_EDGE,
    BAND_START,
    CHOPPINESS,
    DEPTH,
    LOOP,
    SEED,
    SIZE,
    SURFACE_TENSION,
    Count,
    Quantity,
)
from fftocean.runtime import layout

Checked = TypeVar("Checked")

_SIDE = Count("", layout.SIDES[0], layout.SIDES[-1])
_LIFT = Quantity("", 2.0**-40, 2.0**40)
_CYCLES = Count("", 0, layout.MOST_CYCLES)
_WAVES = Count("", 0, layout.SIDES[-1] ** 2)
_BYTES = Count("", 0, layout.MOST_BYTES)


@dataclass(frozen=True, slots=True)
class Tile:
    """A tile of a package."""

    grid: Grid
    band: Band  # [rad/m]
    seed: int | None
    waves: int  # number of records
    most_cycles: int  # of a wave in a loop; 0 without waves


@dataclass(frozen=True, slots=True)
class File:
    """A file of a package."""

    name: str
    bytes: int
    sha256: str | None  # None in a package that is sent, not stored


@dataclass(frozen=True, slots=True)
class Contents:
    """All of a document that the waves depend on."""

    loop: float  # [s]
    ticks: int
    choppiness: float
    depth: float  # [m]
    surface_tension: float  # [N/m]
    tiles: tuple[Tile, ...]
    files: tuple[File, ...]
    project: tuple[str, ...] | None = None  # files of an engine's project, which may be edited

    @classmethod
    def of(cls, document: Any, source: str = layout.DOCUMENT) -> "Contents":
        """
        Return the contents that a document describes.

        Args:
            document: parsed JSON, from anywhere.
            source: name of the document, for messages.

        Raises:
            IntegrityError: no package has this document; the message names the entry.
        """
        try:
            return _contents(_Entries(document, ""))
        except ParameterError as error:
            raise IntegrityError(f"{source} does not describe a sea: {error!s:.300}") from None


class _Entries:
    """The entries of a JSON object, each of which is checked when it is taken."""

    def __init__(self, tree: Any, path: str) -> None:
        if not isinstance(tree, Mapping):
            raise ParameterError(f"{path or 'the document'} must be an object, got {tree!r:.60}")
        self._tree, self._path = tree, path

    def name(self, key: str) -> str:
        """Return the full name of an entry."""
        return f"{self._path}.{key}" if self._path else key

    def get(self, key: str) -> Any:
        """Return an entry as it is."""
        if key not in self._tree:
            raise ParameterError(f"{self.name(key)} is missing")
        return self._tree[key]

    def take(self, key: str, check: Callable[[str, Any], Checked]) -> Checked:
        """Return a checked entry."""
        return check(self.name(key), self.get(key))

    def optional(self, key: str, check: Callable[[str, Any], Checked]) -> Checked | None:
        """Return a checked entry, or None for null."""
        return None if self.get(key) is None else self.take(key, check)

    def items(self, key: str, low: int, high: int) -> list[Any]:
        """Return the items of a list of some length."""
        value = self.get(key)
        if not isinstance(value, list) or not low <= len(value) <= high:
            length = len(value) if isinstance(value, list) else f"{value!r:.60}"
            raise ParameterError(
                f"{self.name(key)} must be a list of {low} to {high} items, got {length}"
            )
        return value

    def pair(self, key: str, check: Callable[[str, Any], Checked]) -> tuple[Checked, Checked]:
        """Return two checked numbers."""
        name = self.name(key)
        one, two = self.items(key, 2, 2)
        return check(f"{name}[0]", one), check(f"{name}[1]", two)

    def table(self, key: str) -> "_Entries | None":
        """Return an object that may be missing."""
        return _Entries(self._tree[key], self.name(key)) if key in self._tree else None

    def tables(self, key: str, low: int, high: int) -> list["_Entries"]:
        """Return the objects of a list."""
        items = self.items(key, low, high)
        return [_Entries(item, f"{self.name(key)}[{i}]") for i, item in enumerate(items)]


def _contents(document: _Entries) -> Contents:
    for key, expected in (("format", layout.FORMAT), ("version", layout.VERSION)):
        found = document.get(key)
        if found != expected or isinstance(found, bool):
            raise ParameterError(f"{key} must be {expected!r}, got {found!r:.60}")
    tiles = tuple(_tile(entries) for entries in document.tables("tiles", 1, layout.MOST_TILES))
    most = max(tile.most_cycles for tile in tiles)
    files = tuple(_file(entries) for entries in document.tables("files", 1, 1000))
    _require_names(files, tiles)
    depth = document.optional("depth", DEPTH.check)
    return Contents(
        loop=document.take("loop", LOOP.check),
        ticks=layout.require_ticks(document.get("ticks"), most),
        choppiness=document.take("choppiness", CHOPPINESS.check),
        depth=math.inf if depth is None else depth,
        surface_tension=document.take("surface_tension", SURFACE_TENSION.check),
        tiles=tiles,
        files=files,
        project=_project(document),
    )


def _tile(entries: _Entries) -> Tile:
    nx, ny = entries.pair("n", _SIDE.check)
    grid = Grid(nx, ny, *entries.pair("size", SIZE.check))
    layout.require_sides(grid, entries.name("n"))
    low, high = entries.pair("band", lambda _, edge: edge)
    band = (
        BAND_START.check(f"{entries.name('band')}[0]", low),
        math.inf if high is None else BAND_EDGE.check(f"{entries.name('band')}[1]", high),
    )
    if not band[0] < band[1]:
        raise ParameterError(f"{entries.name('band')} must rise, got {band[0]:g} to {band[1]:g}")
    waves, most = entries.take("waves", _WAVES.check), entries.take("most_cycles", _CYCLES.check)
    if waves > nx * ny or (most > 0) != (waves > 0):
        raise ParameterError(
            f"{entries.name('waves')} must fit the tile and its most_cycles, "
            f"got {waves} waves of up to {most} cycles on {nx} x {ny}"
        )
    lift = entries.take("mixed", _LIFT.check)
    if math.frexp(lift)[0] != 0.5:
        raise ParameterError(f"{entries.name('mixed')} must be a power of two, got {lift!r}")
    return Tile(grid, band, entries.optional("seed", SEED.check), waves, most)


def _file(entries: _Entries) -> File:
    name, sha256 = entries.get("name"), entries.get("sha256")
    if not layout.is_file_name(name) or name == layout.DOCUMENT:
        raise ParameterError(
            f"{entries.name('name')} must be a plain file name without folders, got {name!r:.60}"
        )
    if sha256 is not None and not layout.is_digest(sha256):
        raise ParameterError(
            f"{entries.name('sha256')} must be 64 hexadecimal digits, got {sha256!r:.80}"
        )
    return File(name, entries.take("bytes", _BYTES.check), sha256)


def _project(document: _Entries) -> tuple[str, ...] | None:
    """Return the names of the files of an engine's project; None without one."""
    project = document.table("project")
    if project is None:
        return None
    names = [entries.get("name") for entries in project.tables("files", 0, 10_000)]
    for i, name in enumerate(names):
        if not layout.is_project_name(name) or name == layout.DOCUMENT:
            raise ParameterError(
                f"project.files[{i}].name must be that of a file in the folder or below it, "
                f"got {name!r:.60}"
            )
    return tuple(names)


def _require_names(files: tuple[File, ...], tiles: tuple[Tile, ...]) -> None:
    """Raise if a file is listed twice, those of the waves are not listed, or all are too large."""
    names = [file.name.lower() for file in files]  # as some systems compare them
    for name in names:
        if names.count(name) > 1:
            raise ParameterError(f"files must have names of their own, got {name!r} twice")
    if sum(file.bytes for file in files) > layout.MOST_BYTES:
        raise ParameterError(f"files must have at most {layout.MOST_BYTES} bytes together")
    sizes = {file.name: file.bytes for file in files}
    for i, tile in enumerate(tiles):
        name, expected = layout.waves_file(i), tile.waves * layout.RECORD.itemsize
        if name not in sizes:
            raise ParameterError(f"files must list {name}, the waves of tile {i}")
        if sizes[name] != expected:
            raise ParameterError(
                f"{name} must have {expected} bytes for {tile.waves} waves, got {sizes[name]}"
            )
