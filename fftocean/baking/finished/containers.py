"""
Frames into containers, and back out of them: for the formats in which a file holds a whole
sequence, and for what stands beside them.
"""

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import played
from fftocean.baking.folder import layout
from fftocean.baking.folder.plan import Order
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.errors import FFTOceanError, IntegrityError
from fftocean.export import formats, profiles, recipes
from fftocean.files import digest, make_rooms, read_whole, write_whole

INSEPARABLE = tuple(
    form.name
    for form in formats.FORMATS.values()
    if form.container and not form.container.separable
)
"""
Containers whose frames cannot be told apart once they are bent: their rows are compressed across
all frames.
"""

FREE = (".import",)
"""Sidecars that engines rewrite: what they become is not ours to judge."""


def assemble(
    folder: Path, order: Order, scene: Scene, rows: Sequence[Mapping[str, Any]]
) -> dict[str, list[dict[str, Any]]]:
    """
    Write each map's container, or what stands beside its files; return them by map, with sizes and
    checksums.

    Raises:
        OutputError: a file cannot be written.
        IntegrityError: a part is not any more what it was when it was written.
    """
    loop = played(order, scene, len(rows))
    bounds = _bounds(scene, rows)
    written: dict[str, list[dict[str, Any]]] = {}
    for name in scene.job.maps:
        m = MAPS[name]
        low, high = order.ranges.get(name, (None, None))
        files = formats.assemble(
            scene.form.name,
            _parts(folder, scene, name, rows) if scene.form.scope == "sequence" else (),
            stem=name,
            shape=(len(rows), *scene.ocean.grid.shape, len(m.names)),
            profile=scene.profile,
            kind=m.kind,
            names=profiles.meaning(scene.profile, m.kind, m.names),
            unit=profiles.unit_in(scene.profile, m.kind, m.unit),
            size=(scene.ocean.grid.lx, scene.ocean.grid.ly),
            loop=loop,
            start=rows[0]["t"],
            closes=rows[0]["frame"] + scene.job.frames - rows[-1]["frame"]
            == (order.step if len(rows) > 1 else scene.job.frames),
            lookup=scene.job.lookup,
            bounds=bounds,
            lo=low,
            hi=high,
            levels=scene.levels,
        )
        entries = [
            {
                "path": path,
                "bytes": len(data),
                "sha256": write_whole(make_rooms(folder, path), data),
            }
            for path, data in sorted(files.items())
        ]
        if entries:
            written[name] = entries
    return written


def _bounds(scene: Scene, rows: Sequence[Mapping[str, Any]]) -> dict[str, float] | None:
    """
    Return how far the water goes, for culling [m]; None for a tile that holds a band of the waves.

    The other tiles move the same mesh: `cascade.json` has the sums of all bounds.
    """
    settings = scene.job.settings
    if settings["ocean.band_low"] > 0.0 or math.isfinite(settings["ocean.band_high"]):
        return None
    return {
        "horizontal": max(row["extremes"]["max_horizontal"] for row in rows),
        "vertical": max(row["extremes"]["max_height"] for row in rows),
    }


def _parts(
    folder: Path, scene: Scene, name: str, rows: Sequence[Mapping[str, Any]]
) -> Iterator[bytes]:
    """Each frame's payload, read back and held against what was written."""
    for place, row in enumerate(rows):
        file = layout.frame_file(scene.form, name, row["frame"], place)
        data = read_whole(folder / file)
        if data is None or digest(data) != row["files"][name]["sha256"]:
            raise IntegrityError(f"{folder / file} is not what was written there; bake again")
        yield data


def intact(contents: Contents) -> bool:
    """
    Whether every container of a finished bake, and what stands beside it, is there and is what it
    was.
    """
    return all(
        (data := contents.read(entry["path"])) is not None
        and (digest(data) == entry["sha256"] or still_says(contents, entry["path"], data))
        for entries in contents.manifest.get("containers", {}).values()
        for entry in entries
    )


def still_says(contents: Contents, path: str, data: bytes) -> bool:
    """
    Whether a file is a sidecar that an engine may rewrite, and still says all that it was written
    with.
    """
    if not path.endswith(FREE):
        return False
    across, down = formats.atlas(len(contents.frames), *contents.shape, contents.profile.gutter)
    written = recipes.godot_import(across, down)
    return set(written.split(b"\n")) <= set(data.replace(b"\r\n", b"\n").split(b"\n"))


def unpack(folder: Path, scene: Scene, manifest: Mapping[str, Any]) -> None:
    """
    Put the parts of a finished bake's containers back where they were before, those that are still
    what they were.
    """
    for name in scene.job.maps if scene.form.name not in INSEPARABLE else ():
        data = read_whole(folder / layout.container(scene.form, name))
        if data is None:
            continue
        with contextlib.suppress(
            FFTOceanError
        ):  # cut or bent, so that no part can be told from the others
            parts = payloads_in(scene, name, data, len(manifest["frames"]))
            for place, (row, part) in enumerate(zip(manifest["frames"], parts, strict=True)):
                if digest(part) == row["files"][name]["sha256"]:
                    write_whole(
                        make_rooms(
                            folder, layout.frame_file(scene.form, name, row["frame"], place)
                        ),
                        part,
                    )


def payloads_in(scene: Scene, name: str, data: bytes, count: int) -> list[bytes]:
    """
    Return each frame's payload out of a container.

    Raises:
        IntegrityError: it is cut or bent.
    """
    shape = (count, *scene.ocean.grid.shape, len(MAPS[name].names))
    return formats.payloads(
        scene.form.name, data, shape=shape, levels=scene.levels, gutter=scene.profile.gutter
    )
