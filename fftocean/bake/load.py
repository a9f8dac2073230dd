"""A bake back as arrays: every format, every engine's conventions, one frame of reference: ours."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fftocean.arrays import Real, require_memory, shortened
from fftocean.bake.contents import Contents
from fftocean.bake.files import digest, path_of
from fftocean.bake.manifest import read_manifest
from fftocean.bake.maps import MAPS
from fftocean.errors import IntegrityError, JobError


@dataclass(frozen=True, slots=True, eq=False)
class Bake:
    """What was baked: `bake["height"]` is (frames, ny, nx, channels), float32, row 0 south, x east, y north, z up, SI."""

    maps: Mapping[str, Real]
    times: Real  # of the frames, (frames,) [s]
    frames: tuple[int, ...]  # which of the loop's they are
    manifest: Mapping[str, Any]

    def __repr__(self) -> str:
        shapes = ", ".join(f"{name} {' x '.join(map(str, array.shape))}" for name, array in self.maps.items())
        return shortened(f"Bake({len(self.frames)} frames of {shapes})")

    def __getitem__(self, name: str) -> Real:
        """
        Return a map by name.

        Raises:
            JobError: it is not among those loaded.
        """
        if name not in self.maps:
            raise JobError(f"maps loaded are {', '.join(self.maps)}, got {name!r:.60}")
        return self.maps[name]


def load(folder: str | Path, *, maps: Iterable[str] | None = None, frames: Iterable[int] | None = None, verify: bool = True) -> Bake:
    """
    Read a finished bake.

    Args:
        folder: that `bake` wrote.
        maps: which; None is all of them.
        frames: which, by their numbers in the loop; None is all of them.
        verify: whether every file read must have the checksum that the manifest has for it.

    Returns:
        The maps as they were before they were turned into the engine's frame, as exactly as the format holds them.

    Raises:
        IntegrityError: the bake is not finished, or a file is missing or not what was written; `check` names all of them.
        OutputError: a file is there and cannot be read.
        JobError: a map or a frame that was not baked.
    """
    folder = path_of("folder", folder)
    contents = Contents.of(folder, read_manifest(folder))
    wanted = (maps,) if isinstance(maps, str) else tuple(contents.job.maps if maps is None else maps)
    for name in wanted:
        if name not in contents.job.maps:
            raise JobError(f"maps must be some of {', '.join(contents.job.maps)}, which were baked, got {name!r:.60}")
    places = contents.chosen(None if frames is None else list(frames))
    channels = sum(len(MAPS[name].names) for name in wanted)
    require_memory(f"{folder}", 4.0 * len(places) * contents.shape[0] * contents.shape[1] * channels)
    loaded = {name: _stack(contents, name, places, verify) for name in wanted}
    rows = contents.manifest["frames"]
    times = np.array([rows[place]["t"] for place in places])
    return Bake(loaded, times, tuple(contents.frames[place] for place in places), contents.manifest)


def _stack(contents: Contents, name: str, places: list[int], verify: bool) -> Real:
    """The frames of a map at some places, one above the other."""
    out = np.empty((len(places), *contents.shape, len(MAPS[name].names)), dtype=np.float32)
    i = 0
    try:
        for i, data in enumerate(contents.data(name, places)):
            if data is None:
                raise IntegrityError("it is missing")
            if verify and digest(data) != contents.entry(name, places[i])["sha256"]:
                raise IntegrityError("it is not what was written")
            out[i] = contents.restored(name, contents.pixels(name, data))
    except IntegrityError as error:
        path, frame = contents.folder / contents.path(name, places[i]), contents.frames[places[i]]
        raise IntegrityError(f"{path}, frame {frame}: {error}; `fftocean check` names all that is wrong") from None
    return out
