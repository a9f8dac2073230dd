"""What a bake will come to, before anything is written: files, bytes, memory and time, from two frames made in memory."""

import time
from dataclasses import dataclass

import numpy as np

from fftocean.bake.baker import crew_for, scene_for
from fftocean.bake.frames import Scene
from fftocean.bake.job import Job
from fftocean.bake.maps import MAPS
from fftocean.bake.order import frames_of
from fftocean.export import formats
from fftocean.export.profiles import range_of_normals
from fftocean.ocean import memory_needed


@dataclass(frozen=True, slots=True)
class Estimate:
    """What to expect."""

    frames: int
    files: int  # all of them
    bytes: int  # about
    seconds: float  # about, on this machine
    memory: float  # of each process [bytes]
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
        JobError: the job asks for more than can be.
        OutputError: a value that the format cannot hold.
    """
    chosen = frames_of(frames, job.frames)
    scene = scene or scene_for(job, downsample, len(chosen))
    name, hands = crew_for(executor, workers, scene, len(chosen))
    sizes = [_bytes_of(scene, j) for j in chosen[:1]]  # and whatever is to be compiled is
    start = time.perf_counter()
    sizes += [_bytes_of(scene, j) for j in chosen[-1:]]
    each = time.perf_counter() - start
    rounds = len(chosen) + (0.5 * scene.job.frames if scene.form.scaled else 0.0) + (scene.job.frames if "foam" in scene.job.maps else 0.0)
    containers = len(scene.job.maps) * (len(chosen) if scene.form.scope == "frame" else 2)
    return Estimate(
        frames=len(chosen),
        files=containers + len(scene.job.pictures) + 2,
        bytes=round(float(np.mean(sizes)) * len(chosen)) + 700_000 * len(scene.job.pictures) + 1200 * len(chosen),
        seconds=3.0 + each * rounds / hands + (1.5 if name != "serial" else 0.0),
        memory=memory_needed(scene.ocean.grid, scene.ocean.dtype),
        executor=name,
        workers=hands,
    )


def _bytes_of(scene: Scene, j: int) -> int:
    """What the maps of a frame come to; without foam, which would take the whole loop to know."""
    foam = np.zeros(scene.ocean.grid.shape) if "foam" in scene.job.maps else None
    total = 0
    for name, levels in scene.pictures(scene.frame(j), foam):
        low, high = (min(float(p.min()) for p in levels), max(float(p.max()) for p in levels)) if scene.form.scaled else (None, None)
        if MAPS[name].kind == "normal":
            low, high = range_of_normals(scene.profile)
        stored = scene.stored(levels)
        total += len(formats.encode(scene.form.name, stored[0], lo=low, hi=high, levels=stored[1:]))
    return total
