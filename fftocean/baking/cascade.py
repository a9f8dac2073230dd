"""Bake of a cascade: each tile in a folder of its own, and the list of them, written last."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from fftocean.baking.bake import bake_packed
from fftocean.baking.cascade_setup import TileSet, outside, prepare, tile_in_words
from fftocean.baking.estimate import Estimate, estimate
from fftocean.baking.folder import engine_files, layout, listing
from fftocean.baking.folder.journal import Listen, Progress
from fftocean.baking.folder.layout import CASCADE_FILE, CASCADE_JOB, MANIFEST_FILE
from fftocean.baking.folder.lock import locked, require_free
from fftocean.baking.folder.ownership import files_of_bake
from fftocean.baking.folder.sealed import sealed
from fftocean.baking.workers.choice import check_executor
from fftocean.cascade import Tile
from fftocean.files import (
    as_json,
    digest_whole,
    make_folder,
    path_of,
    remove,
    remove_temporary_files,
    write_whole,
)
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
    progress: Progress | None = None,
    listen: Listen | None = None,
) -> dict[str, Any]:
    """
    Bake a job as a cascade: one sea on several tiles, whose bands of wavenumbers adjoin.

    Each tile is a bake in `tile0`, `tile1`, ..., from the largest to the smallest. The list of
    them, `cascade.json`, is written last; a folder without it is no finished cascade. The same call
    resumes a bake that was stopped, and ends with the same bytes.

    Args:
        job: sea, and maps to write; the tiles replace its `ocean.n` and `ocean.size`.
        tiles: (n, size) of each, as `Cascade` takes them.
        folder: the folder to write to.
        overwrite: replace a folder that holds another job, whose files are removed first.
        frames, downsample, executor, workers: as `bake` takes them.
        progress: called with (frames of tiles done, all of them).
        listen: called with events as by `bake`, with the number of the "tile".

    Returns:
        The list of tiles as plain data.

    Raises:
        JobError: tiles that cannot share a sea, or a map that does not add up over tiles.
        OutputError, FolderInUseError: as `bake`.
    """
    executor = check_executor(executor, workers)
    folder = path_of("folder", folder)
    require_free(folder)
    tile_set = prepare(job, tiles, frames=frames, downsample=downsample)
    make_folder(folder)
    with locked(folder):
        if overwrite:
            _remove_earlier(folder)
        listing.require_same_cascade(folder, tile_set.header)
        remove(folder / CASCADE_FILE)  # from here on the folder is no finished cascade
        remove_temporary_files(folder)
        write_whole(folder / CASCADE_JOB, as_json(sealed(tile_set.header)))
        rows, manifests = [], []
        for index, (tile, scene) in enumerate(
            zip(tile_set.tile_jobs, tile_set.scenes, strict=True)
        ):
            place = folder / tile.path
            manifest = bake_packed(
                tile.job,
                place,
                overwrite=overwrite,
                frames=frames,
                downsample=downsample,
                executor=executor,
                workers=workers,
                progress=_progress(progress, index, len(tile_set.tile_jobs)),
                listen=_listen(listen, index, len(tile_set.tile_jobs)),
                scene=scene,
            )
            rows.append(tile.row(digest_whole(place / MANIFEST_FILE), manifest))
            manifests.append(manifest)
        listed = tile_set.listed(
            rows,
            manifests,
            tile_set.write_previews(folder),
            engine_files.write_player(folder, tile_set.header["job"], CASCADE_FILE),
        )
        write_whole(folder / CASCADE_FILE, as_json(listed))
    if listen:
        listen(
            {
                "event": "done",
                "manifest": str(folder / CASCADE_FILE),
                "tiles": len(rows),
                "frames": len(tile_set.chosen),
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
    tile_set = prepare(job, tiles, frames=frames, downsample=downsample)
    return estimate_prepared(
        tile_set, frames=frames, downsample=downsample, executor=executor, workers=workers
    )


def estimate_prepared(
    tile_set: TileSet,
    *,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
) -> Estimate:
    """Estimate the bake of tiles that are set up already."""
    parts = [
        estimate(
            tile.job,
            frames=frames,
            downsample=downsample,
            executor=executor,
            workers=workers,
            scene=scene,
        )
        for tile, scene in zip(tile_set.tile_jobs, tile_set.scenes, strict=True)
    ]
    previews = sum(name in listing.SUMMED for name in tile_set.job.pictures)
    most = max(parts, key=lambda part: part.workers)
    return replace(
        most,
        files=sum(part.files for part in parts)
        + previews
        + len(engine_files.names_for(tile_set.header["job"]))
        + 2,
        bytes=sum(part.bytes for part in parts) + 700_000 * previews,
        seconds=sum(part.seconds for part in parts),
        memory=(sum if most.executor == "serial" else max)(
            part.memory for part in parts
        ),  # one process holds all tiles
        video=sum(part.video for part in parts),
    )


def summary(listed: Mapping[str, Any]) -> list[str]:
    """Return a summary of a baked cascade, line by line."""
    s = listed["statistics"]
    lines = [
        f"Hs {s['ordered']['hs']:.3g} m specified, {s['hs']:.3g} m realised by all tiles; "
        f"Tp {s['ordered']['tp']:.3g} s"
    ]
    lines.append(f"energy outside the bands: {outside(s)}")
    for tile in listed["tiles"]:
        (nx, ny), (lx, ly), band = tile["n"], tile["size"], tile["band"]
        lines.append(f"{tile['path']}: {tile_in_words(nx, ny, lx, ly, band)}")
    return lines


def _remove_earlier(folder: Path) -> None:
    """Remove the bake of one tile or of a cascade from a folder."""
    if layout.is_cascade(folder):
        listing.remove_cascade(folder)
    if (folder / layout.JOB_FILE).is_file() or (folder / MANIFEST_FILE).is_file():
        for path in {*layout.bake_files(folder), *files_of_bake(folder)}:
            remove(path)
        remove(folder / MANIFEST_FILE)
        remove(folder / layout.JOB_FILE)


def _progress(report: Progress | None, index: int, tiles: int) -> Progress | None:
    """Return a progress callback for one tile that reports the progress of all tiles."""
    return (
        None if report is None else lambda done, total: report(index * total + done, tiles * total)
    )


def _listen(report: Listen | None, index: int, tiles: int) -> Listen | None:
    """Return a listener for one tile that adds its number to each event."""
    if report is None:
        return None

    def listen(event: dict[str, Any]) -> None:
        report(
            {
                **event,
                "event": "tile" if event["event"] == "done" else event["event"],
                "tile": index,
                "tiles": tiles,
            }
        )

    return listen
