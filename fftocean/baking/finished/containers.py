"""Containers, which hold all frames of a map, and sidecars: their assembly and separation."""

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import played
from fftocean.baking.folder import layout
from fftocean.baking.folder.plan import Plan
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.errors import FFTOceanError, IntegrityError
from fftocean.export import formats, profiles, recipes
from fftocean.files import digest, make_parents, read_whole, write_whole

INSEPARABLE = tuple(
    form.name
    for form in formats.FORMATS.values()
    if form.container and not form.container.separable
)
"""
Containers whose frames cannot be separated once they are damaged: they are compressed across all
frames.
"""

REWRITTEN = (".import",)
"""Sidecars that engines rewrite; lines that they add are no fault."""


def assemble(
    folder: Path, plan: Plan, scene: Scene, rows: Sequence[Mapping[str, Any]]
) -> dict[str, list[dict[str, Any]]]:
    """
    Write the containers and sidecars of each map; return their entries by map.

    Raises:
        OutputError: a file cannot be written.
        IntegrityError: a part was changed after it was written.
    """
    loop = played(plan, scene, len(rows))
    bounds = _bounds(scene, rows)
    written: dict[str, list[dict[str, Any]]] = {}
    for name in scene.job.maps:
        m = MAPS[name]
        low, high = plan.ranges.get(name, (None, None))
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
            == (plan.step if len(rows) > 1 else scene.job.frames),
            lookup=scene.job.lookup,
            bounds=bounds,
            lo=low,
            hi=high,
            levels=scene.levels,
        )
        if scene.form.scope == "frame":
            images = [row["files"][name]["path"] for row in rows]
            files |= recipes.files_beside_frames(scene.profile, images)
        entries = [
            {
                "path": path,
                "bytes": len(data),
                "sha256": write_whole(make_parents(folder, path), data),
            }
            for path, data in sorted(files.items())
        ]
        if entries:
            written[name] = entries
    return written


def _bounds(scene: Scene, rows: Sequence[Mapping[str, Any]]) -> dict[str, float] | None:
    """
    Return bounds of the displacement, for culling [m]; None for a tile that holds a band of waves.

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
    """Yield each frame's payload, read back and compared with its checksum."""
    for place, row in enumerate(rows):
        file = layout.frame_file(scene.form, name, row["frame"], place)
        data = read_whole(folder / file)
        if data is None or digest(data) != row["files"][name]["sha256"]:
            raise IntegrityError(f"{folder / file} was changed after it was written; bake again")
        yield data


def intact(contents: Contents) -> bool:
    """
    Return whether every container and sidecar of a finished bake exists and is unchanged.
    """
    return all(
        (data := contents.read(entry["path"])) is not None
        and (digest(data) == entry["sha256"] or has_written_lines(contents, entry["path"], data))
        for entries in contents.manifest.get("containers", {}).values()
        for entry in entries
    )


def has_written_lines(contents: Contents, path: str, data: bytes) -> bool:
    """
    Return whether a file is a sidecar that an engine may rewrite, and still has all its lines.
    """
    if not path.endswith(REWRITTEN):
        return False
    written = recipes.GODOT_FRAME
    if contents.form.scope == "sequence":
        tiles = formats.atlas(len(contents.frames), *contents.shape, contents.profile.gutter)
        written = recipes.godot_import(*tiles)
    return set(written.split(b"\n")) <= set(data.replace(b"\r\n", b"\n").split(b"\n"))


def unpack(folder: Path, scene: Scene, manifest: Mapping[str, Any]) -> None:
    """
    Write the unchanged parts of a finished bake's containers back to the files that they had while
    it was baked.
    """
    for name in scene.job.maps if scene.form.name not in INSEPARABLE else ():
        data = read_whole(folder / layout.container(scene.form, name))
        if data is None:
            continue
        with contextlib.suppress(FFTOceanError):  # damaged, so that its parts cannot be separated
            parts = payloads_in(scene, name, data, len(manifest["frames"]))
            for place, (row, part) in enumerate(zip(manifest["frames"], parts, strict=True)):
                if digest(part) == row["files"][name]["sha256"]:
                    write_whole(
                        make_parents(
                            folder, layout.frame_file(scene.form, name, row["frame"], place)
                        ),
                        part,
                    )


def payloads_in(scene: Scene, name: str, data: bytes, count: int) -> list[bytes]:
    """
    Return each frame's payload out of a container.

    Raises:
        IntegrityError: the container is damaged.
    """
    shape = (count, *scene.ocean.grid.shape, len(MAPS[name].names))
    return formats.payloads(
        scene.form.name, data, shape=shape, levels=scene.levels, gutter=scene.profile.gutter
    )
