"""Dry run of a bake: its refusals and its estimate, without a file written."""

from collections.abc import Iterable
from pathlib import Path

from fftocean.baking.bake import scene_for
from fftocean.baking.cascade import estimate_prepared
from fftocean.baking.cascade_setup import prepare
from fftocean.baking.estimate import Estimate, estimate
from fftocean.baking.folder.identity import header_of
from fftocean.baking.folder.listing import require_same_cascade
from fftocean.baking.folder.ownership import require_possible, require_writable
from fftocean.baking.folder.plan import frames_of
from fftocean.baking.workers.choice import check_executor
from fftocean.cascade import Tile
from fftocean.job.job import Job


def dry_run(
    job: Job,
    folder: Path,
    *,
    tiles: Iterable[Tile] | None = None,
    overwrite: bool = False,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
) -> Estimate:
    """
    Return what a bake would come to; raise what it would raise before its first frame.

    Args:
        job: what to bake.
        folder: the folder of the bake, which may be absent.
        tiles: (samples a side, width [m]) of each tile of a cascade, or None.
        overwrite, frames, downsample, executor, workers: as `bake` takes them.

    Raises:
        JobError: the job asks for something impossible.
        OutputError: a folder that the bake could not write to, or a value out of its format.
    """
    executor = check_executor(executor, workers)
    if tiles:
        tile_set = prepare(job, tiles, frames=frames, downsample=downsample)
        require_writable(folder)
        if not overwrite:
            require_same_cascade(folder, tile_set.header)
        return estimate_prepared(
            tile_set, frames=frames, downsample=downsample, executor=executor, workers=workers
        )
    chosen = frames_of(frames, job.frames)
    scene = scene_for(job, downsample, len(chosen))
    header = header_of(job, frames=chosen, downsample=downsample, backend=scene.ocean.backend)
    require_possible(folder, header, overwrite=overwrite)
    return estimate(
        job,
        frames=frames,
        downsample=downsample,
        executor=executor,
        workers=workers,
        scene=scene,
    )
