"""Video memory of a bake's maps, as an engine holds them without compression."""

from typing import Any

import numpy as np

from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene


def texels(scene: Scene, frames: int, channels: int, levels: int | None = None) -> float:
    """
    Return the bytes of some frames of a map, uncompressed.

    Args:
        scene: the scene of the bake.
        frames: number of frames.
        channels: channels of a texel.
        levels: mip levels; None is as many as the files have.
    """
    each = np.dtype(scene.form.stored).itemsize * channels
    nx, ny = scene.ocean.grid.nx, scene.ocean.grid.ny
    count = scene.levels if levels is None else levels
    sides = ((max(1, nx >> level), max(1, ny >> level)) for level in range(count))
    return float(frames * each * sum(x * y for x, y in sides))


def video_memory(scene: Scene, frames: int, levels: int | None = None) -> float:
    """
    Return the bytes that the maps of some frames take as textures, in the layout of their engine.

    No graphics processor has texels of three channels, and loaders make four of the three equal
    ones of a map of one channel; so do files that always have four. The arguments are those of
    `texels`.
    """
    least = scene.form.least
    channels = [len(MAPS[name].names) for name in scene.job.maps]
    return sum(
        texels(scene, frames, {3: 4}.get(n, n) if least == 1 else 4, levels) for n in channels
    )


def described(scene: Scene, frames: int) -> dict[str, Any]:
    """Return the entry of a manifest: bytes of all maps in an engine, and with all mip levels."""
    most = max(scene.ocean.grid.nx, scene.ocean.grid.ny).bit_length()
    return {
        "bytes": round(video_memory(scene, frames)),
        "bytes_a_frame": round(video_memory(scene, 1)),
        "levels": scene.levels,
        "bytes_with_all_levels": round(video_memory(scene, frames, most)),
        "texels": f"{scene.form.stored}, {4 if scene.form.least > 1 else 'up to 4'} channels, "
        "uncompressed",
    }
