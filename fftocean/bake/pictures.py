"""What there is to look at beside the maps: drawn, written, and listed for the manifest."""

import importlib.util
from pathlib import Path
from typing import Any

from fftocean.bake import layout, preview
from fftocean.bake.files import write_whole
from fftocean.bake.frames import Scene
from fftocean.bake.job import Job
from fftocean.errors import JobError
from fftocean.statistics import Statistics


def draw(folder: Path, scene: Scene, statistics: Statistics) -> dict[str, dict[str, Any]]:
    """
    Draw the pictures that the job asks for.

    Raises:
        OutputError: one cannot be written.
    """
    frames, drawn = scene.job.frames, {}
    if "sheet" in scene.job.pictures:
        drawn["preview"] = (layout.SHEET, preview.contact_sheet(scene.ocean, frames, _caption(statistics, scene)))
    if "animation" in scene.job.pictures:
        drawn["animation"] = (layout.ANIMATION, preview.animation(scene.ocean, frames))
    if "tiling" in scene.job.pictures:
        drawn["tiling"] = (layout.TILING, preview.tiling(scene.ocean, frames))
    if "spectrum" in scene.job.pictures:
        drawn["spectrum"] = (layout.SPECTRUM, _spectrum(scene))
    return {key: {"path": name, "bytes": len(data), "sha256": write_whole(folder / name, data)} for key, (name, data) in drawn.items()}


def require_drawable(job: Job) -> None:
    """
    Refuse, before anything is done, a picture for which something is not installed.

    Raises:
        JobError: the spectrum is asked for, and matplotlib is not there.
    """
    if "spectrum" in job.pictures and importlib.util.find_spec("matplotlib") is None:
        raise JobError(f"{job.source}: bake.pictures 'spectrum' needs matplotlib: pip install fftocean[plot]")


def _spectrum(scene: Scene) -> bytes:
    """The sea that was ordered and what the tile delivers of it; the room that draws such things lies above this one."""
    from fftocean.plots import encoded, plot_job

    return encoded(plot_job(scene.ocean), ".png")


def _caption(statistics: Statistics, scene: Scene) -> str:
    """One line for the contact sheet."""
    ordered, g = statistics.ordered, scene.job.settings
    assert ordered is not None  # a job has a sea
    size = "x".join(f"{v:g}" for v in g["ocean.size"]) if isinstance(g["ocean.size"], tuple) else f"{g['ocean.size']:g}"
    sea = f"Hs {ordered.hs:.2f} m ordered, {statistics.hs:.2f} m delivered   Tp {ordered.tp:.1f} s"
    return f"{sea}   tile {size} m   loop {g['ocean.loop']:g} s"
