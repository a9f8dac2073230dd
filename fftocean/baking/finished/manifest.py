"""Manifest of a finished bake: written last, with a checksum over all of its own bytes."""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.folder.layout import MANIFEST_FILE
from fftocean.baking.folder.plan import Plan
from fftocean.baking.folder.sealed import read_sealed
from fftocean.baking.scene import video_memory
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.export import profiles, rules
from fftocean.ocean import Ocean
from fftocean.physics.plausibility import plausibility
from fftocean.physics.sea import Sea
from fftocean.statistics import Statistics


def compose(
    plan: Plan,
    scene: Scene,
    rows: Sequence[Mapping[str, Any]],
    *,
    statistics: Statistics,
    blend: Mapping[str, Any],
    containers: Mapping[str, Any],
    pictures: Mapping[str, Any],
    engine_files: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any]:
    """
    Return the manifest of a bake as plain data, with its rows as they are given.

    Args:
        plan: the plan of the bake.
        scene: its scene.
        rows: one a frame, in order, as the workers returned them.
        statistics: specified and realised.
        blend: loss by linear blending between two frames.
        containers: files that hold several frames, and their sidecars, by map.
        pictures: entries of the previews, by name.
        engine_files: entries of the files that play it in its engine.
    """
    job = scene.job
    shape = scene.ocean.grid.shape
    entries = {}
    for name in job.maps:
        m = MAPS[name]
        ranges = merged(row["files"][name]["range"] for row in rows)
        meaning = profiles.meaning(scene.profile, m.kind, m.names)
        low, high = plan.ranges.get(name, (None, None))
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
    return {
        **plan.header,
        "ocean": _tile(scene.ocean),
        **({"measured": notes} if (notes := job.measured_notes()) else {}),
        "statistics": statistics.as_plain(),  # specified and realised
        **({} if (rarity := scene.ocean.rarity) is None else {"constrained": rarity.as_plain()}),
        **(
            {}
            if scene.ocean.sea is None
            else {"plausibility": plausibility(scene.ocean.sea).as_plain()}
        ),
        **({"foam": job.describe_foam(scene.ocean)} if "foam" in job.maps else {}),
        "conventions": {**rules.conventions(scene.profile), "lookup": _LOOKUP[job.lookup]},
        "sampling": {**rules.sampling(scene.profile), "values": _numbers(plan, scene, rows)},
        "blend": dict(blend),
        "extremes": {
            "unit": {"max_height": "m", "max_horizontal": "m", "min_jacobian": "1", "folded": "1"},
            **extremes_over(rows),
        },
        "maps": entries,
        "video_memory": video_memory.described(scene, len(rows)),
        **({"containers": dict(containers)} if containers else {}),
        **pictures,
        **({"engine_files": list(engine_files)} if engine_files else {}),
        "frames": rows,
    }


def _numbers(plan: Plan, scene: Scene, rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Return the numbers that the sampling rules name."""
    grid, count = scene.ocean.grid, len(rows)
    return rules.numbers(
        scene.profile,
        (grid.lx, grid.ly),
        (grid.nx, grid.ny),
        count,
        played(plan, scene, count),
        rows[0]["t"],
    )


def played(plan: Plan, scene: Scene, count: int) -> float:
    """Return the time in which the baked frames play through [s]."""
    loop: float = scene.job.settings["ocean.loop"]
    return loop if count == scene.job.frames else loop * plan.step * count / scene.job.frames


_LOOKUP = {
    "lagrangian": "lagrangian: a map is indexed by the undisplaced position",
    "eulerian": "eulerian: a map is indexed by the place in the world; "
    "what is displaced by it is a height field",
}


def merged(ranges: Iterable[Sequence[Sequence[float]]]) -> list[list[float]]:
    """Return the least and greatest value of each channel over many frames, one at least."""
    whole: list[list[float]] = []
    for frame in ranges:
        pairs = zip(whole or frame, frame, strict=True)
        whole = [[min(a[0], b[0]), max(a[1], b[1])] for a, b in pairs]
    return whole


def extremes_over(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """
    Return the extremes of the whole sequence.

    `largest_choppiness` is the largest without folds, or None where no choppiness has folds.
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
    """Return the numbers of the tile."""
    grid = ocean.grid
    return {
        "n": [grid.nx, grid.ny],
        "size": [grid.lx, grid.ly],
        "depth": ocean.depth if math.isfinite(ocean.depth) else str(ocean.depth),
        "surface_tension": ocean.amplitudes.surface_tension,
        "stated_by": {} if ocean.sea is None else _stated(ocean.sea),
        "loop": ocean.loop,
        "choppiness": ocean.choppiness,
        **({"order": 2, "bound": ocean.bound} if ocean.order > 1 else {}),
        "fft": ocean.backend,
    }


def _stated(sea: Sea) -> dict[str, str]:
    """Return the spectrum or spreading that sets depth and surface tension, where one does."""
    parts = {"depth": sea.depth_from, "surface_tension": sea.surface_tension_from}
    return {name: part for name, part in parts.items() if part is not None}


def read_manifest(folder: Path) -> dict[str, Any]:
    """
    Read the manifest of a finished bake; its frames are a `RowList`.

    Raises:
        OutputError: the file cannot be read.
        IntegrityError: the file does not exist, or one of its bytes was changed.
    """
    return read_sealed(folder / MANIFEST_FILE)
