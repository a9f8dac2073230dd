"""Names of files and folders in the folder of a bake."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from fftocean.export.formats import FORMATS, Format
from fftocean.export.recipes import FRAME_SUFFIX, PAGES
from fftocean.files import entries_like
from fftocean.job.parameters import MAPS

JOB_FILE, MANIFEST_FILE, WORK_FOLDER = "job.json", "manifest.json", ".work"
SHEET, ANIMATION, TILING, SPECTRUM = "preview.png", "preview.webp", "tiling.png", "spectrum.png"
PREVIEWS = {
    "preview": SHEET,
    "animation": ANIMATION,
    "tiling": TILING,
    "spectrum": SPECTRUM,
}  # by their keys in the manifest
PREVIEW_FILES = tuple(PREVIEWS.values())
CASCADE_FILE, CASCADE_JOB = "cascade.json", "cascade-job.json"
"""List of a cascade's tiles, written last, and job of the cascade, written first."""
JOURNAL, FOAM_STARTS = f"{WORK_FOLDER}/journal", f"{WORK_FOLDER}/foam.npy"
SIDECARS = (
    ".json",
    *(f".exr{page.suffix}" for page in PAGES.values()),
)  # of a map, beside its container or its folder


def frame_file(form: Format, name: str, frame: int, place: int) -> str:
    """
    Return the file of a map of one frame: its own, or the part from which a container is made.

    Args:
        form: the format.
        name: of the map.
        frame: number in the loop.
        place: position in the sequence that is baked.
    """
    if form.scope == "sequence":
        return f"{WORK_FOLDER}/{name}/{frame:04d}.part"
    return form.file.format(stem=name, frame=place if form.numbered == "place" else frame)


def container(form: Format, name: str) -> str:
    """Return the file or folder that holds all frames of a map."""
    return form.file.format(stem=name, frame=0)


def foam_file(first: int) -> str:
    """Return the file of the foam response of the span that begins at a frame, while baking."""
    return f"{WORK_FOLDER}/foam/{first:04d}.npy"


def tile_folder(index: int) -> str:
    """Return the folder of a cascade's tile."""
    return f"tile{index}"


def is_cascade(folder: Path) -> bool:
    """Return whether a folder holds the job or the list of a cascade."""
    return any(os.path.lexists(folder / name) for name in (CASCADE_FILE, CASCADE_JOB))


def tile_folders(folder: Path) -> list[str]:
    """Return the names of the folders in a cascade's folder that hold a bake, in order."""
    found = [
        path
        for path in folder.glob("tile[0-9]*")
        if path.name[4:].isdigit() and path.is_dir() and not path.is_symlink()
    ]
    marked = [
        path
        for path in found
        if any(os.path.lexists(path / name) for name in (JOB_FILE, MANIFEST_FILE))
    ]
    return sorted((path.name for path in marked), key=lambda name: int(name[4:]))


def folders_of(folder: Path) -> Iterator[Path]:
    """
    Yield every existing folder of a bake, the outermost first, links excepted.

    Nothing is done through a link.
    """
    yield folder
    for inner in (
        folder / WORK_FOLDER,
        *(folder / name for name in MAPS),
        *(folder / f"{name}.zarr" for name in MAPS),
    ):
        if inner.is_dir() and not inner.is_symlink():
            yield from _folders_in(inner)


def _folders_in(folder: Path) -> Iterator[Path]:
    """Yield a folder and all that are in it; of its files, any number, the names are not held."""
    yield folder
    inner: list[str] = []
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        inner = [entry.name for entry in entries if entry.is_dir(follow_symlinks=False)]
    for name in inner:
        yield from _folders_in(folder / name)


def _files_in(folder: Path) -> Iterator[Path]:
    """Yield what is in a folder and is no folder, such as a link to one, in no order."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_dir(follow_symlinks=False):
                yield folder / entry.name


def bake_files(folder: Path) -> Iterator[Path]:
    """
    Yield every file in a folder that is named like one of a bake, of whatever job: frames, in no
    order, containers, sidecars, previews.
    """
    suffixes = tuple({form.suffix for form in FORMATS.values()})
    for preview in PREVIEW_FILES:
        if os.path.lexists(folder / preview):
            yield folder / preview
    for name in MAPS:
        for suffix in sorted({*suffixes, *SIDECARS}):
            path = folder / f"{name}{suffix}"
            if path.is_symlink() or path.is_file():
                yield path
            elif path.is_dir():
                for inner in _folders_in(path):
                    yield from _files_in(inner)
        inner = folder / name
        if inner.is_dir() and not inner.is_symlink():
            found = entries_like(inner, "[0-9]*")
            yield from (path for path in found if os.path.normcase(path.name).endswith(suffixes))


def frame_settings(folder: Path) -> Iterator[Path]:
    """
    Yield every file of an engine's settings beside a frame's image, a bake's or the engine's own,
    in no order.
    """
    for name in MAPS:
        inner = folder / name
        if inner.is_dir() and not inner.is_symlink():
            yield from entries_like(inner, f"[0-9]*.exr{FRAME_SUFFIX}")
