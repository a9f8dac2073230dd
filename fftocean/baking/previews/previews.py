"""Previews of a bake: images of its ocean, written beside the maps."""

import importlib.util
from pathlib import Path
from typing import Any

from fftocean.baking.folder import layout
from fftocean.baking.previews import sheets, whitecaps
from fftocean.baking.scene.scene import Scene
from fftocean.cascade import Cascade
from fftocean.errors import JobError, how_to_install
from fftocean.files import write_whole
from fftocean.foam import Foam
from fftocean.job.job import Job
from fftocean.ocean import Ocean
from fftocean.statistics import Statistics


def write_previews(folder: Path, scene: Scene, statistics: Statistics) -> dict[str, dict[str, Any]]:
    """
    Write the previews that the job asks for; return their entries of the manifest.

    Raises:
        OutputError: one cannot be written.
    """
    frames, images = scene.job.frames, {}
    foam = foam_of(scene.job, scene.ocean)
    if "sheet" in scene.job.pictures:
        text = caption(scene.job, statistics)
        images["preview"] = (
            layout.SHEET,
            sheets.contact_sheet(scene.ocean, frames, text, **foam),
        )
    if "animation" in scene.job.pictures:
        images["animation"] = (layout.ANIMATION, sheets.animation(scene.ocean, frames, **foam))
    if "tiling" in scene.job.pictures:
        images["tiling"] = (layout.TILING, sheets.tiling(scene.ocean, frames))
    if "spectrum" in scene.job.pictures:
        images["spectrum"] = (layout.SPECTRUM, _spectrum(scene))
    return {
        key: {"path": name, "bytes": len(data), "sha256": write_whole(folder / name, data)}
        for key, (name, data) in images.items()
    }


def require_drawable(job: Job) -> None:
    """
    Raise if a package that a preview of the job needs is not installed.

    Raises:
        JobError: the job has the preview "spectrum", and matplotlib is not installed.
    """
    if "spectrum" in job.pictures and importlib.util.find_spec("matplotlib") is None:
        raise JobError(
            f"{job.source}: bake.pictures 'spectrum' needs matplotlib: {how_to_install('plot')}"
        )


def foam_of(job: Job, water: Ocean | Cascade) -> dict[str, Any]:
    """
    Return the foam of a job's previews, as arguments of `sheets.contact_sheet`.

    A job that bakes foam shows that foam; another shows the whitecap cover at its wind speed.
    """
    if "foam" in job.maps or not job.wind:
        return {"foam": job.foam_on(water)}
    return {
        "foam": Foam(**job.foam),
        "cover": whitecaps.whitecap_cover(job.settings["sea.wind.speed"]),
    }


def caption(job: Job, statistics: Statistics, tiles: str | None = None) -> str:
    """
    Return one line for the contact sheet: wind, wave height, period, tile and loop.

    Args:
        job: the baked job.
        statistics: of its ocean, or of all tiles together.
        tiles: the tiles of a cascade in words; None describes the job's own tile.
    """
    specified, g = statistics.specified, job.settings
    assert specified is not None  # a job has a sea
    speed = g["sea.wind.speed"]
    wind = f"wind {speed:g} m/s (Beaufort {beaufort_of(speed)})   " if job.wind else ""
    size = g["ocean.size"]
    width = "x".join(f"{v:g}" for v in size) if isinstance(size, tuple) else f"{size:g}"
    sea = f"Hs {specified.hs:.2f} m specified, {statistics.hs:.2f} m realised"
    tile = tiles or f"tile {width} m"
    return f"{wind}{sea}   Tp {specified.tp:.1f} s   {tile}   loop {g['ocean.loop']:g} s"


def beaufort_of(wind: float) -> int:
    """Return the Beaufort number of a wind speed [m/s], by the scale's lower bounds (WMO-No. 8)."""
    starts = (0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7)
    return sum(wind >= start for start in starts)


def _spectrum(scene: Scene) -> bytes:
    """Return the plot of the specified and the realised spectrum as a PNG."""
    from fftocean.plots import encoded, plot_job

    return encoded(plot_job(scene.ocean), ".png")
