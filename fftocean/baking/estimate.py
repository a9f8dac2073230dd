"""Estimate of a bake's files, bytes, memory and time, from two frames rendered in memory."""

import time
from dataclasses import dataclass

import numpy as np

from fftocean.baking.bake import choose_workers, scene_for
from fftocean.baking.folder import engine_files
from fftocean.baking.folder.plan import frames_of
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.baking.scene.video_memory import texels, video_memory
from fftocean.export import formats, recipes
from fftocean.export.profiles import range_of_normals
from fftocean.job.job import Job
from fftocean.ocean import memory_needed


@dataclass(frozen=True, slots=True)
class Estimate:
    """Expected cost of a bake."""

    frames: int
    files: int  # in all
    bytes: int  # approximate
    seconds: float  # approximate, on this machine
    memory: float  # of each process [bytes]
    container: float  # of this process in addition, to assemble the largest container [bytes]
    video: float  # of the maps of all frames in an engine [bytes]
    executor: str
    workers: int


def estimate(
    job: Job,
    *,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
    scene: Scene | None = None,
) -> Estimate:
    """
    Estimate a bake; the arguments are those of `bake`.

    Raises:
        JobError: the job asks for something that cannot be baked.
        OutputError: a value that the format cannot hold.
    """
    chosen = frames_of(frames, job.frames)
    scene = scene or scene_for(job, downsample, len(chosen))
    name, count = choose_workers(executor, workers, scene, len(chosen))
    sizes = [_bytes_of(scene, j) for j in chosen[:1]]  # which also compiles the kernels
    start = time.perf_counter()
    sizes += [_bytes_of(scene, j) for j in chosen[-1:]]
    each = time.perf_counter() - start
    rounds = (
        len(chosen)
        + (0.5 * scene.job.frames if scene.form.scaled else 0.0)
        + (scene.job.frames if "foam" in scene.job.maps else 0.0)
    )
    containers = len(scene.job.maps) * (len(chosen) if scene.form.scope == "frame" else 2)
    if scene.form.scope == "frame" and recipes.files_beside_frames(scene.profile, ["0.exr"]):
        containers *= 2
    return Estimate(
        frames=len(chosen),
        files=containers
        + len(scene.job.pictures)
        + len(engine_files.names_for(job.describe()))
        + 2,
        bytes=round(float(np.mean(sizes)) * len(chosen))
        + 700_000 * len(scene.job.pictures)
        + 1200 * len(chosen),
        seconds=3.0 + each * rounds / count + (1.5 if name != "serial" else 0.0),
        memory=memory_needed(scene.ocean.grid, scene.ocean.dtype) + tables_of(scene),
        container=_container(scene, len(chosen)),
        video=video_memory(scene, len(chosen)),
        executor=name,
        workers=count,
    )


def tables_of(scene: Scene) -> float:
    """Return the memory of the tables of second-order waves [bytes]."""
    bound = scene.ocean.bound_waves
    return 0.0 if bound is None else float(bound.nbytes)


def _container(scene: Scene, frames: int) -> float:
    """Return the bytes to hold the largest map's sequence twice, as parts and as a container."""
    if scene.form.scope == "frame":
        return 0.0
    return 2.0 * max(texels(scene, frames, len(MAPS[name].names)) for name in scene.job.maps)


def _bytes_of(scene: Scene, j: int) -> int:
    """Return the bytes of a frame's maps; foam counts as none, as it depends on the whole loop."""
    foam = np.zeros(scene.ocean.grid.shape) if "foam" in scene.job.maps else None
    total = 0
    for name, levels in scene.maps(scene.frame(j), foam):
        low, high = (
            (min(float(p.min()) for p in levels), max(float(p.max()) for p in levels))
            if scene.form.scaled
            else (None, None)
        )
        if MAPS[name].kind == "normal":
            low, high = range_of_normals(scene.profile)
        stored = scene.stored(levels)
        total += len(formats.encode(scene.form.name, stored[0], lo=low, hi=high, levels=stored[1:]))
    return total
