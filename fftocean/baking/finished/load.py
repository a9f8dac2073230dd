"""Bakes as arrays, whatever their format and engine, in the conventions of the package."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fftocean.arrays import Real, RealLike, shortened
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.rows import unpacked
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import IntegrityError, JobError
from fftocean.files import digest, path_of
from fftocean.host import require_memory
from fftocean.kernels import interpolate


@dataclass(frozen=True, slots=True, eq=False)
class Bake:
    """
    Maps of a bake: `bake["height"]` is (frames, ny, nx, channels), float32, row 0 south, x east, y
    north, z up, SI.

    Args:
        maps: arrays by the name of their map, each (frames, ny, nx, channels), in SI units.
        times: times of the frames, (frames,) [s].
        frames: their numbers in the loop.
        manifest: manifest of the bake, as `manifest.json` has it.
    """

    maps: Mapping[str, Real]
    times: Real
    frames: tuple[int, ...]
    manifest: Mapping[str, Any]

    def __repr__(self) -> str:
        shapes = ", ".join(
            f"{name} {' x '.join(map(str, array.shape))}" for name, array in self.maps.items()
        )
        return shortened(f"Bake({len(self.frames)} frames of {shapes})")

    def __getitem__(self, name: str) -> Real:
        """
        Return a map by name.

        Raises:
            JobError: the map is not among those loaded.
        """
        if name not in self.maps:
            raise JobError(f"maps loaded are {', '.join(self.maps)}, got {name!r:.60}")
        return self.maps[name]


@dataclass(frozen=True, slots=True, eq=False)
class BakedCascade:
    """
    Tiles of a baked cascade, the largest first; each is a `Bake`.

    Args:
        tiles: bakes of the tiles, the largest first.
        manifest: the list of the tiles, as `cascade.json` has it.
    """

    tiles: tuple[Bake, ...]
    manifest: Mapping[str, Any]

    def __repr__(self) -> str:
        return shortened(f"BakedCascade({', '.join(map(repr, self.tiles))})")

    def __len__(self) -> int:
        """Return the number of tiles."""
        return len(self.tiles)

    def __getitem__(self, index: int) -> Bake:
        """Return a tile."""
        return self.tiles[index]

    @property
    def times(self) -> Real:
        """Times of the frames, (frames,) [s]."""
        return self.tiles[0].times

    @property
    def frames(self) -> tuple[int, ...]:
        """Numbers of the frames in the loop."""
        return self.tiles[0].frames

    def summed(self, name: str, x: RealLike, y: RealLike, place: int = 0) -> Real:
        """
        Return a map at points of the world, added up over the tiles, as a shader does: bilinear.

        Args:
            name: of a map that was loaded.
            x, y: undisplaced positions [m], of shapes that broadcast.
            place: of the frame in `frames`.

        Returns:
            (..., channels), float64.

        Raises:
            JobError: the map is not among those loaded, or there is no such frame.
        """
        if not -len(self.frames) <= place < len(self.frames):
            raise JobError(
                f"place must be one of the {len(self.frames)} frames loaded, got {place!r:.40}"
            )
        xs, ys = np.broadcast_arrays(
            np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
        )
        total = np.zeros((xs.size, self.tiles[0][name].shape[-1]))
        for tile in self.tiles:
            (nx, ny), (lx, ly) = tile.manifest["ocean"]["n"], tile.manifest["ocean"]["size"]
            u, v = np.mod(xs.ravel() / lx, 1.0) * nx, np.mod(ys.ravel() / ly, 1.0) * ny
            interpolate.bilinear(np.ascontiguousarray(tile[name][place]), u, v, total)
        return total.reshape(*xs.shape, -1)


def load(
    folder: str | Path,
    *,
    maps: Iterable[str] | None = None,
    frames: Iterable[int] | None = None,
    verify: bool = True,
) -> Bake | BakedCascade:
    """
    Load the maps of a finished bake.

    Args:
        folder: the folder of a bake, or the one around the tiles of a cascade.
        maps: names of maps; None is all of them.
        frames: numbers of frames in the loop; None is all of them.
        verify: compare the checksum of every file that is read with the manifest's.

    Returns:
        A `Bake`, or a `BakedCascade` for a cascade: maps in the conventions of the package,
        whatever the engine, as precisely as the format stores them.

    Raises:
        IntegrityError: the bake is not finished, or a file is missing or was changed; `check` names
            all problems.
        OutputError: a file exists and cannot be read.
        JobError: a map or a frame was not baked.
    """
    folder = path_of("folder", folder)
    if layout.is_cascade(folder):
        return _tiles(folder, maps, frames, verify)
    return _bake(folder, maps, frames, verify)


def _tiles(
    folder: Path, maps: Iterable[str] | None, frames: Iterable[int] | None, verify: bool
) -> BakedCascade:
    """Read the tiles of a cascade, whose manifests must be those that its list names."""
    listed = listing.read_listing(folder)
    names = maps if maps is None or isinstance(maps, str) else tuple(maps)
    chosen = None if frames is None else tuple(frames)
    tiles = [_bake(tile, names, chosen, verify) for tile in listing.listed_tiles(folder, listed)]
    return BakedCascade(tuple(tiles), listed)


def _bake(
    folder: Path, maps: Iterable[str] | None, frames: Iterable[int] | None, verify: bool
) -> Bake:
    """Read the bake of one tile."""
    contents = Contents.of(folder, read_manifest(folder))
    wanted = (
        (maps,) if isinstance(maps, str) else tuple(contents.job.maps if maps is None else maps)
    )
    for name in wanted:
        if name not in contents.job.maps:
            raise JobError(
                f"maps must be some of {', '.join(contents.job.maps)}, which were baked, "
                f"got {name!r:.60}"
            )
    places = contents.chosen(None if frames is None else list(frames))
    channels = sum(len(MAPS[name].names) for name in wanted)
    require_memory(
        f"{folder}", 4.0 * len(places) * contents.shape[0] * contents.shape[1] * channels
    )
    loaded = {name: read_frames(contents, name, places, verify) for name in wanted}
    rows = contents.manifest["frames"]
    times = np.array([rows[place]["t"] for place in places])
    frames = tuple(contents.frames[place] for place in places)
    return Bake(loaded, times, frames, unpacked(contents.manifest))


def read_frames(contents: Contents, name: str, places: Sequence[int], verify: bool = True) -> Real:
    """
    Return the frames of a map at some places of the sequence, as one array.

    Raises:
        IntegrityError: a file is missing, damaged or, with `verify`, not the one that was written;
            the message names the file and the frame.
    """
    out = np.empty((len(places), *contents.shape, len(MAPS[name].names)), dtype=np.float32)
    i = 0
    try:
        for i, data in enumerate(contents.data(name, places)):
            if data is None:
                raise IntegrityError("the file is missing")
            if verify and digest(data) != contents.entry(name, places[i])["sha256"]:
                raise IntegrityError("the file was changed after it was written")
            out[i] = contents.restored(name, contents.pixels(name, data))
    except IntegrityError as error:
        path, frame = contents.folder / contents.path(name, places[i]), contents.frames[places[i]]
        raise IntegrityError(
            f"{path}, frame {frame}: {error}; `fftocean check` names all problems"
        ) from None
    return out
