"""Bake of a cascade: each tile in a folder of its own, and the list of them, written last."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from fftocean.baking.bake import bake
from fftocean.baking.cascade_setup import Water, outside, prepare, tile_in_words
from fftocean.baking.estimate import Estimate, estimate
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.identity import checked
from fftocean.baking.folder.layout import CASCADE_FILE, CASCADE_JOB, MANIFEST_FILE
from fftocean.baking.folder.lock import locked, require_free
from fftocean.baking.workers.choice import check_executor
from fftocean.cascade import Tile
from fftocean.files import as_json, make_folder, path_of, read_whole, remove, sweep, write_whole
from fftocean.job.job import Job


def bake_tiles(
    job: Job,
    tiles: Iterable[Tile],
    folder: str | Path = "out",
    *,
    overwrite: bool = False,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    listen: Callable[[dict[str, Any]], None] | None = None,
) -> dict[str, Any]:
    """
    Bake a job as a cascade: one sea on several tiles, whose bands of wavenumbers adjoin.

    Each tile is a bake in `tile0`, `tile1`, ..., from the largest to the smallest. The list of
    them, `cascade.json`, is written last; a folder without it is no finished cascade. The same
    command goes on where it was stopped, to the same bytes.

    Args:
        job: what to bake; its `ocean.n` and `ocean.size` are those of the tiles instead.
        tiles: (n, size) of each, as `Cascade` takes them.
        folder: where to.
        overwrite: bake over another job's folder, whose files are removed first.
        frames, downsample, executor, workers: as `bake` takes them.
        progress: called with (frames of tiles done, all of them).
        listen: called with what happens, as `bake` does, with the number of the "tile".

    Returns:
        The list, as plain data.

    Raises:
        JobError: tiles that cannot share a sea, or a map that does not add up over tiles.
        OutputError, FolderInUseError: as `bake`.
    """
    executor = check_executor(executor, workers)
    folder = path_of("folder", folder)
    require_free(folder)
    water = prepare(job, tiles, frames=frames, downsample=downsample)
    make_folder(folder)
    with locked(folder):
        if overwrite:
            _clear(folder)
        listing.require_claimable(folder, water.header)
        remove(folder / CASCADE_FILE)  # from here on the folder is no finished cascade
        sweep(folder)
        write_whole(folder / CASCADE_JOB, as_json(checked(water.header)))
        rows, manifests = [], []
        for index, (share, scene) in enumerate(zip(water.shares, water.scenes, strict=True)):
            place = folder / share.path
            manifest = bake(
                share.job,
                place,
                overwrite=overwrite,
                frames=frames,
                downsample=downsample,
                executor=executor,
                workers=workers,
                progress=_progress(progress, index, len(water.shares)),
                listen=_listen(listen, index, len(water.shares)),
                scene=scene,
            )
            rows.append(share.row(read_whole(place / MANIFEST_FILE) or b"", manifest))
            manifests.append(manifest)
        listed = water.listed(rows, manifests, water.draw(folder))
        write_whole(folder / CASCADE_FILE, as_json(listed))
    if listen:
        listen(
            {
                "event": "done",
                "manifest": str(folder / CASCADE_FILE),
                "tiles": len(rows),
                "frames": len(water.chosen),
            }
        )
    return listed


def estimate_tiles(
    job: Job,
    tiles: Iterable[Tile],
    *,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
) -> Estimate:
    """
    Estimate the bake of a cascade; the arguments are those of `bake_tiles`.

    Raises:
        JobError: as `bake_tiles`.
        OutputError: a value that the format cannot hold.
    """
    water = prepare(job, tiles, frames=frames, downsample=downsample)
    return water_estimate(
        water, frames=frames, downsample=downsample, executor=executor, workers=workers
    )


def water_estimate(
    water: Water,
    *,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
) -> Estimate:
    """Estimate the bake of tiles that are set up already."""
    parts = [
        estimate(
            share.job,
            frames=frames,
            downsample=downsample,
            executor=executor,
            workers=workers,
            scene=scene,
        )
        for share, scene in zip(water.shares, water.scenes, strict=True)
    ]
    drawn = sum(name in listing.SUMMED for name in water.job.pictures)
    most = max(parts, key=lambda part: part.workers)
    return replace(
        most,
        files=sum(part.files for part in parts) + drawn + 2,
        bytes=sum(part.bytes for part in parts) + 700_000 * drawn,
        seconds=sum(part.seconds for part in parts),
        memory=(sum if most.executor == "serial" else max)(
            part.memory for part in parts
        ),  # one process holds all tiles
    )


def summary(listed: Mapping[str, Any]) -> list[str]:
    """Return what a finished cascade's bake says of itself, line by line."""
    s = listed["statistics"]
    lines = [
        f"Hs {s['ordered']['hs']:.3g} m specified, {s['hs']:.3g} m realised by all tiles; Tp {s['ordered']['tp']:.3g} s"
    ]
    lines.append(f"energy outside the bands: {outside(s)}")
    for tile in listed["tiles"]:
        (nx, ny), (lx, ly), band = tile["n"], tile["size"], tile["band"]
        lines.append(f"{tile['path']}: {tile_in_words(nx, ny, lx, ly, band)}")
    return lines


def _clear(folder: Path) -> None:
    """Remove the bake of a tile or of a cascade, so far as it is marked as one."""
    if layout.is_cascade(folder):
        listing.discard(folder)
    if (folder / layout.JOB_FILE).is_file() or (folder / MANIFEST_FILE).is_file():
        for path in layout.leftovers(folder):
            remove(path)
        remove(folder / MANIFEST_FILE)
        remove(folder / layout.JOB_FILE)


def _progress(
    tell: Callable[[int, int], None] | None, index: int, tiles: int
) -> Callable[[int, int], None] | None:
    """Return a listener for one tile that tells how far all tiles are."""
    return None if tell is None else lambda done, total: tell(index * total + done, tiles * total)


def _listen(
    tell: Callable[[dict[str, Any]], None] | None, index: int, tiles: int
) -> Callable[[dict[str, Any]], None] | None:
    """Return a listener for one tile that names it; the tile's end is not that of the bake."""
    if tell is None:
        return None

    def listen(event: dict[str, Any]) -> None:
        tell(
            {
                **event,
                "event": "tile" if event["event"] == "done" else event["event"],
                "tile": index,
                "tiles": tiles,
            }
        )

    return listen
