"""Where each thing stands in a bake's folder, and which names there are ours."""

import os
from collections.abc import Iterator
from pathlib import Path

from fftocean.baking.scene.maps import MAPS
from fftocean.export.formats import FORMATS, Format
from fftocean.export.recipes import PAGES

JOB_FILE, MANIFEST_FILE, WORK_FOLDER = "job.json", "manifest.json", ".work"
SHEET, ANIMATION, TILING, SPECTRUM = "preview.png", "preview.webp", "tiling.png", "spectrum.png"
DRAWN = {
    "preview": SHEET,
    "animation": ANIMATION,
    "tiling": TILING,
    "spectrum": SPECTRUM,
}  # by their keys in the manifest
PICTURES = tuple(DRAWN.values())
CASCADE_FILE, CASCADE_JOB = "cascade.json", "cascade-job.json"
"""
Of the folder around the tiles of a cascade: its list, written last, and its job, written first.
"""
JOURNAL, FOAM_STARTS = f"{WORK_FOLDER}/journal", f"{WORK_FOLDER}/foam.npy"
SIDECARS = (
    ".json",
    *(f".exr{page.suffix}" for page in PAGES.values()),
)  # of a map, beside its container or its folder


def frame_file(form: Format, name: str, frame: int, place: int) -> str:
    """
    Return where a map of a frame is written: its own file, or the part that will stand in a
    container.

    Args:
        form: the format.
        name: of the map.
        frame: of the loop.
        place: in the sequence.
    """
    if form.scope == "sequence":
        return f"{WORK_FOLDER}/{name}/{frame:04d}.part"
    return form.file.format(stem=name, frame=place if form.numbered == "place" else frame)


def container(form: Format, name: str) -> str:
    """Where the container of a map stands."""
    return form.file.format(stem=name, frame=0)


def foam_file(first: int) -> str:
    """Where the foam that is made in the span from frame `first` on is kept meanwhile."""
    return f"{WORK_FOLDER}/foam/{first:04d}.npy"


def tile_folder(index: int) -> str:
    """Return the name of the folder of a cascade's tile."""
    return f"tile{index}"


def is_cascade(folder: Path) -> bool:
    """Return whether a folder is marked as that of a cascade."""
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


def rooms(folder: Path) -> Iterator[Path]:
    """
    Every folder of a bake that is there and is no link, the outermost first: nothing is done
    through a link.
    """
    yield folder
    for room in (
        folder / WORK_FOLDER,
        *(folder / name for name in MAPS),
        *(folder / f"{name}.zarr" for name in MAPS),
    ):
        if room.is_dir() and not room.is_symlink():
            yield room
            for path, folders, _ in os.walk(room, followlinks=False):
                yield from (
                    Path(path) / name for name in folders if not (Path(path) / name).is_symlink()
                )


def leftovers(folder: Path) -> Iterator[Path]:
    """
    Every file in a folder that has a name of ours, of any job: frames, containers, what stands
    beside them, pictures.
    """
    suffixes = {form.suffix for form in FORMATS.values()}
    for picture in PICTURES:
        if os.path.lexists(folder / picture):
            yield folder / picture
    for name in MAPS:
        for suffix in sorted({*suffixes, *SIDECARS}):
            path = folder / f"{name}{suffix}"
            if path.is_symlink() or path.is_file():
                yield path
            elif path.is_dir():
                yield from (p for p in sorted(path.rglob("*")) if p.is_symlink() or not p.is_dir())
        room = folder / name
        if room.is_dir() and not room.is_symlink():
            for suffix in sorted(suffixes):
                yield from sorted(room.glob(f"[0-9]*{suffix}"))
