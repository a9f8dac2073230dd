"""Where each thing stands in a bake's folder, and which names there are ours."""

import os
from collections.abc import Iterator
from pathlib import Path

from fftocean.bake.maps import MAPS
from fftocean.export.formats import FORMATS, Format

JOB_FILE, MANIFEST_FILE, WORK_FOLDER = "job.json", "manifest.json", ".work"
SHEET, ANIMATION, TILING, SPECTRUM = "preview.png", "preview.webp", "tiling.png", "spectrum.png"
DRAWN = {"preview": SHEET, "animation": ANIMATION, "tiling": TILING, "spectrum": SPECTRUM}  # by their keys in the manifest
PICTURES = tuple(DRAWN.values())
JOURNAL, FOAM_STARTS = f"{WORK_FOLDER}/journal", f"{WORK_FOLDER}/foam.npy"
SIDECARS = (".json", ".exr.import", ".exr.unity.txt", ".exr.unreal.txt")  # of a map, beside its container or its folder


def frame_file(form: Format, name: str, frame: int, place: int) -> str:
    """
    Return where a map of a frame is written: its own file, or the part that will stand in a container.

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


def rooms(folder: Path) -> Iterator[Path]:
    """Every folder of a bake that is there and is no link, the outermost first: nothing is done through a link."""
    yield folder
    for room in (folder / WORK_FOLDER, *(folder / name for name in MAPS), *(folder / f"{name}.zarr" for name in MAPS)):
        if room.is_dir() and not room.is_symlink():
            yield room
            for path, folders, _ in os.walk(room, followlinks=False):
                yield from (Path(path) / name for name in folders if not (Path(path) / name).is_symlink())


def leftovers(folder: Path) -> Iterator[Path]:
    """Every file in a folder that has a name of ours, of any job: frames, containers, what stands beside them, pictures."""
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
