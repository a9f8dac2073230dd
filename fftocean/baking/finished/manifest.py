"""
The manifest: what a finished bake says of itself, written last, with a check over every one of its
own bytes.
"""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.folder.identity import checked, read_checked
from fftocean.baking.folder.layout import MANIFEST_FILE
from fftocean.baking.folder.plan import Order
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.export import profiles, rules
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea
from fftocean.statistics import Statistics


def compose(
    order: Order,
    scene: Scene,
    rows: Sequence[Mapping[str, Any]],
    *,
    statistics: Statistics,
    blend: Mapping[str, Any],
    containers: Mapping[str, Any],
    pictures: Mapping[str, Any],
) -> dict[str, Any]:
    """
    Return the manifest of a bake as plain data.

    Args:
        order: what was asked.
        scene: the water.
        rows: one a frame, in order, as the workers gave them.
        statistics: of the realised sea and of the specified one.
        blend: what linear blending between two frames loses.
        containers: the files that hold several frames, and those beside them, by map.
        pictures: what there is to look at, by name.
    """
    job = scene.job
    shape = scene.ocean.grid.shape
    entries = {}
    for name in job.maps:
        m = MAPS[name]
        ranges = merged([row["files"][name]["range"] for row in rows])
        meaning = profiles.meaning(scene.profile, m.kind, m.names)
        low, high = order.ranges.get(name, (None, None))
        entries[name] = {
            "channels": {
                letter: "1" if c is None else meaning[c]
                for letter, c in scene.form.letters(len(meaning)).items()
            },
            "unit": profiles.unit_in(scene.profile, m.kind, m.unit),
            "caption": m.caption,
            "kind": m.kind,
            "format": scene.form.name,
            "stored": scene.form.stored,
            "range": [min(low for low, _ in ranges), max(high for _, high in ranges)],
            "channel_ranges": ranges,
            **({} if low is None else {"scaled": {"low": low, "high": high}}),
            "world": rules.world(scene.profile, m.kind),
            "shape": [*shape, len(m.names)],
            "levels": scene.levels,
        }
    manifest = {
        **order.header,
        "ocean": _tile(scene.ocean),
        **({"measured": notes} if (notes := job.measured_notes()) else {}),
        "statistics": statistics.as_plain(),
        "conventions": {**rules.conventions(scene.profile), "lookup": _LOOKUP[job.lookup]},
        "sampling": {**rules.sampling(scene.profile), "values": _numbers(order, scene, rows)},
        "blend": dict(blend),
        "extremes": {
            "unit": {"max_height": "m", "max_horizontal": "m", "min_jacobian": "1", "folded": "1"},
            **extremes_over(rows),
        },
        "maps": entries,
        **({"containers": dict(containers)} if containers else {}),
        **pictures,
        "frames": list(rows),
    }
    return checked(manifest)


def _numbers(order: Order, scene: Scene, rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The numbers that the sampling rules name."""
    grid, count = scene.ocean.grid, len(rows)
    return rules.numbers(
        scene.profile,
        (grid.lx, grid.ly),
        (grid.nx, grid.ny),
        count,
        played(order, scene, count),
        rows[0]["t"],
    )


def played(order: Order, scene: Scene, count: int) -> float:
    """How long the frames that are there take to play through [s]."""
    loop: float = scene.job.settings["ocean.loop"]
    return loop if count == scene.job.frames else loop * order.step * count / scene.job.frames


_LOOKUP = {
    "lagrangian": "lagrangian: a map is indexed by the undisplaced position",
    "eulerian": "eulerian: a map is indexed by the place in the world; what is displaced by it is a height field",
}


def merged(ranges: Sequence[Sequence[Sequence[float]]]) -> list[list[float]]:
    """The least and greatest of each channel over many frames."""
    return [
        [min(frame[c][0] for frame in ranges), max(frame[c][1] for frame in ranges)]
        for c in range(len(ranges[0]))
    ]


def extremes_over(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """
    The extremes of the whole sequence; `largest_choppiness` is that at which nothing folds, None
    where any is.
    """
    limits = [c for row in rows if (c := row["extremes"]["largest_choppiness"]) is not None]
    return {
        "folded": sum(row["extremes"]["folded"] for row in rows) / len(rows),
        "largest_choppiness": min(limits, default=None),
        "min_jacobian": min(row["extremes"]["min_jacobian"] for row in rows),
        "max_height": max(row["extremes"]["max_height"] for row in rows),
        "max_horizontal": max(row["extremes"]["max_horizontal"] for row in rows),
    }


def _tile(ocean: Ocean) -> dict[str, Any]:
    """The tile in numbers."""
    grid = ocean.grid
    return {
        "n": [grid.nx, grid.ny],
        "size": [grid.lx, grid.ly],
        "depth": ocean.depth if math.isfinite(ocean.depth) else str(ocean.depth),
        "surface_tension": ocean.amplitudes.surface_tension,
        "stated_by": {} if ocean.sea is None else _stated(ocean.sea),
        "loop": ocean.loop,
        "choppiness": ocean.choppiness,
        "fft": ocean.backend,
    }


def _stated(sea: Sea) -> dict[str, str]:
    """By which spectrum or spreading depth and surface tension are stated, where one does."""
    parts = {"depth": sea.depth_from, "surface_tension": sea.surface_tension_from}
    return {name: part for name, part in parts.items() if part is not None}


def read_manifest(folder: Path) -> dict[str, Any]:
    """
    Read the manifest of a finished bake.

    Raises:
        OutputError: it cannot be read.
        IntegrityError: there is none, or it is not, to the byte, what a bake wrote.
    """
    return read_checked(folder / MANIFEST_FILE)
