"""Check of a run-time package: unchanged files, waves that a sea can have, and the right fields."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fftocean import gerstner
from fftocean.baking.finished.check import Finding
from fftocean.baking.folder.lock import LOCK_FILE, require_free
from fftocean.baking.folder.sealed import read_sealed
from fftocean.engine_projects import TEXTURES
from fftocean.errors import FFTOceanError, IntegrityError, OutputError
from fftocean.fields import EIGHT
from fftocean.files import digest, path_of, read_whole
from fftocean.ocean import Ocean
from fftocean.runtime import layout
from fftocean.runtime.contents import Contents
from fftocean.runtime.decode import ocean_of
from fftocean.runtime.folder import MARK, is_package
from fftocean.runtime.package import SeaPackage
from fftocean.runtime.planes import amplitude_planes
from fftocean.runtime.textures import decode
from fftocean.wave_list import oceans_of

__all__ = ["check_package", "is_package"]

TOLERANCE = 1e-6
"""
Largest error of a field at a point, relative to the largest of the tile's values: the amplitudes
are rounded to float32, each by up to 6e-8.
"""
_MOST_MOMENTS = 64
_OWN = re.compile(r"tile\d+[._].*|twiddle\.bin|\..*\.[0-9].*\.tmp|" + re.escape(MARK))
"""Names that only a package has, also where a project is beside it."""


def check_package(folder: str | Path) -> tuple[Finding, ...]:
    """
    Check that the files of a run-time package are unchanged, and that its waves give its fields.

    Args:
        folder: the folder of a package.

    Returns:
        The problems found; () if there are none.

    Raises:
        FolderInUseError: another process writes to the folder.
        OutputError: the folder does not exist, or a file exists and cannot be read.
    """
    folder = path_of("folder", folder)
    require_free(folder)
    if not folder.is_dir():
        reason = "is not a folder" if folder.exists() else "does not exist"
        raise OutputError(f"{folder} must be the folder of a run-time package, and {reason}")
    try:
        document = read_sealed(folder / layout.DOCUMENT, layout.MOST_DOCUMENT)
        contents = Contents.of(document)
    except IntegrityError as error:
        if (folder / layout.DOCUMENT).is_file():
            return (Finding("manifest", layout.DOCUMENT, str(error)),)
        why = "it does not exist: the export was stopped; run the same command again"
        return (Finding("unfinished", layout.DOCUMENT, why),)
    files, found = _files(folder, contents)
    found += _extra(folder, contents)
    if any(finding.path in _waves(contents) for finding in found):
        return tuple(found)
    try:
        water = ocean_of(SeaPackage(document, files), dtype="float64")
    except FFTOceanError as error:
        return (*found, Finding("values", layout.DOCUMENT, str(error)))
    oceans = oceans_of(water)
    found += _twiddle(files, contents)
    for i, ocean in enumerate(oceans):
        found += _textures(ocean, i, files)
    if layout.REFERENCE in files:
        found += _reference(files[layout.REFERENCE], oceans, contents)
    return tuple(found)


def _waves(contents: Contents) -> list[str]:
    """Return the names of the files of all tiles' waves."""
    return [layout.waves_file(i) for i in range(len(contents.tiles))]


def _files(folder: Path, contents: Contents) -> tuple[dict[str, bytes], list[Finding]]:
    """Return the unchanged files, and the problems of the others."""
    files: dict[str, bytes] = {}
    found = []
    names = {file.sha256: file.name for file in contents.files}
    for file in contents.files:
        path = folder / file.name
        if path.is_file() and path.stat().st_size > layout.MOST_BYTES:
            found.append(Finding("changed", file.name, f"it has more than {file.bytes} bytes"))
            continue
        data = None if path.is_symlink() else read_whole(path, layout.MOST_BYTES)
        if data is None:
            found.append(Finding("missing", file.name, "it does not exist"))
        elif (sha256 := digest(data)) == file.sha256:
            files[file.name] = data
        elif sha256 in names:
            found.append(Finding("swapped", file.name, f"it holds {names[sha256]}"))
        elif len(data) < file.bytes:
            found.append(Finding("cut", file.name, f"it has {len(data)} of {file.bytes} bytes"))
        else:
            found.append(Finding("changed", file.name, "its SHA-256 is not the listed one"))
    return files, found


def _extra(folder: Path, contents: Contents) -> Iterator[Finding]:
    """Yield files and folders that are not of the package."""
    listed = {file.name for file in contents.files} | {layout.DOCUMENT}
    for path in sorted(folder.iterdir()):
        if path.name in listed or path.name == LOCK_FILE:
            continue
        if contents.project is not None and not _OWN.fullmatch(path.name):
            continue  # of the project, or made by its engine: the user's
        if path.name == MARK:
            why = "left over: run the same command again"
        elif path.match(".*.[0-9]*.tmp"):
            why = "left-over temporary file"
        else:
            why = f"it is not listed in {layout.DOCUMENT}"
        yield Finding("extra", path.name, why)


def _textures(ocean: Ocean, index: int, files: Mapping[str, bytes]) -> Iterator[Finding]:
    """Yield textures that are not those of the waves."""
    for ending in TEXTURES:
        names = layout.texture_files(index, ending)
        if not set(names) & files.keys():
            continue
        for name, array in zip(names, amplitude_planes(ocean), strict=True):
            if name in files and not _same_texture(files[name], ending, array):
                yield Finding("values", name, f"it does not hold {layout.waves_file(index)}")


def _same_texture(data: bytes, ending: str, array: np.ndarray[Any, Any]) -> bool:
    """Return whether bytes are those of a texture, to the last digit but one."""
    try:
        found = decode(data, ending, array.shape)
    except IntegrityError:
        return False
    return bool(np.all(np.abs(found - array) <= 4e-7 * np.abs(array)))


def _twiddle(files: Mapping[str, bytes], contents: Contents) -> Iterator[Finding]:
    """Yield a table of the transform that is none."""
    if layout.TWIDDLE not in files:
        return
    n = max(max(tile.grid.shape) for tile in contents.tiles)
    turns = np.exp(2j * np.pi * np.arange(n) / n)
    found = np.frombuffer(files[layout.TWIDDLE], np.uint8)
    right = found.size == 8 * n
    if right:
        pairs = found.view("<f4").reshape(n, 2)
        right = bool(np.max(np.abs(pairs[:, 0] + 1j * pairs[:, 1] - turns)) <= 1e-7)
    if not right:
        why = f"it does not hold cosine and sine of 2 pi i/{n}"
        yield Finding("values", layout.TWIDDLE, why)


def _reference(data: bytes, oceans: Sequence[Ocean], contents: Contents) -> Iterator[Finding]:
    """Yield fields of `check.json` that the waves do not give."""
    try:
        tree = json.loads(data)
        for i, (ocean, tile) in enumerate(zip(oceans, tree["tiles"], strict=True)):
            worst, name = _worst(ocean, tile, tree["moments"], contents)
            if not worst <= TOLERANCE:
                yield Finding(
                    "values",
                    layout.REFERENCE,
                    f"{name} of tile {i} is off by {worst:.1e} of its largest value, "
                    f"at most {TOLERANCE:.0e}",
                )
    except (KeyError, TypeError, ValueError, IndexError, RecursionError, OverflowError) as error:
        yield Finding("values", layout.REFERENCE, f"it holds no fields of the tiles: {error!s:.80}")


def _worst(
    ocean: Ocean, tile: Mapping[str, Any], moments: Sequence[int], contents: Contents
) -> tuple[float, str]:
    """Return the largest relative error of any field of a tile, and the name of that field."""
    grid = ocean.grid
    columns, rows = (np.array(tile[name], dtype=np.int64) for name in ("columns", "rows"))
    if (
        columns.shape != rows.shape
        or columns.size > layout.MOST_POINTS
        or len(moments) > _MOST_MOMENTS
    ):
        raise ValueError("columns and rows must be lists of one length")
    assert ocean.loop is not None  # a package has one
    sums = [
        gerstner.surface(ocean, grid.x[columns], grid.y[rows], ocean.loop * (tick / contents.ticks))
        for tick in moments
    ]
    errors = {}
    for name in EIGHT:
        expected = np.array([getattr(s, name) for s in sums])
        given = np.array(tile["fields"][name], dtype=np.float64).reshape(expected.shape)
        largest = float(np.max(np.abs(expected), initial=0.0))
        error = float(np.max(np.abs(given - expected), initial=0.0))
        errors[name] = error / largest if largest > 0.0 else error
    worst = max(errors, key=lambda name: errors[name] if errors[name] == errors[name] else np.inf)
    return errors[worst], worst
