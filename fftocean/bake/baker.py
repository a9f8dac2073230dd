"""Turning a job into a folder: frame by frame, the manifest last."""

import os
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

import fftocean
from fftocean.bake import preview
from fftocean.bake.files import as_json, make_folder, read_json, remove, write_whole
from fftocean.bake.job import Job, finite_or_word
from fftocean.bake.maps import MAPS
from fftocean.bake.parameters import PARAMETERS
from fftocean.errors import JobError, OutputError
from fftocean.export import exr
from fftocean.ocean import Ocean
from fftocean.statistics import Statistics, measure

JOB_FILE, MANIFEST_FILE, PREVIEW_FILE = "job.json", "manifest.json", "preview.png"
Progress = Callable[[int, int], None]


def bake(job: Job, folder: str | Path = "out", *, overwrite: bool = False, progress: Progress | None = None) -> dict[str, Any]:
    """
    Bake a job: one EXR file a map and frame, a contact sheet, and a manifest that is written last.

    A folder without `manifest.json` is not a finished bake. Baking the same job into its folder again gives the same bytes.

    Args:
        job: what to bake.
        folder: where to; made if it is not there.
        overwrite: bake over another job's folder, whose frames are removed first.
        progress: called with (frames done, frames in all).

    Returns:
        The manifest, as plain data.

    Raises:
        OutputError: a file cannot be written, or the folder holds another job.
        JobError: the job asks for more than can be.
    """
    if not isinstance(job, Job):
        raise JobError(f"a job must be a Job, such as Job.default() or Job.read('sea.toml'), got {job!r:.60}")
    folder = Path(folder)
    ocean = job.ocean()
    make_folder(folder)
    _claim(folder, job, overwrite)
    for name in job.maps:
        make_folder(folder / name)
    needs = tuple(
        dict.fromkeys([*(need for name in job.maps for need in MAPS[name].needs), "height", "displace_x", "displace_y", "jacobian"])
    )
    ranges: dict[str, list[float]] = {name: [np.inf, -np.inf] for name in job.maps}
    extremes = {"min_jacobian": np.inf, "max_height": 0.0, "max_horizontal": 0.0}
    rows = []
    frame = None
    for j in range(job.frames):
        frame = ocean.loop_frame(j, job.frames, needs, out=frame)
        row: dict[str, Any] = {"frame": j, "t": frame.t, "files": {}}
        for name in job.maps:
            channels = MAPS[name].channels(frame)
            file = f"{name}/{j:04d}.exr"
            try:
                data = exr.encode_half(*channels)
            except OutputError as error:
                raise OutputError(f"{folder / file} could not be encoded: {error}") from None
            row["files"][name] = {"path": file, "sha256": write_whole(folder / file, data)}
            ranges[name] = [  # of what is stored: a half may lie beyond the value that it was rounded from
                min(ranges[name][0], *(float(np.float16(c.min())) for c in channels)),
                max(ranges[name][1], *(float(np.float16(c.max())) for c in channels)),
            ]
        rows.append(row)
        horizontal = frame.choppiness * float(np.max(np.hypot(frame.displace_x, frame.displace_y)))
        extremes["min_jacobian"] = min(extremes["min_jacobian"], float(frame.jacobian.min()))
        extremes["max_height"] = max(extremes["max_height"], float(np.max(np.abs(frame.height))))
        extremes["max_horizontal"] = max(extremes["max_horizontal"], horizontal)
        if progress:
            progress(j + 1, job.frames)
    statistics = measure(ocean)
    picture = preview.contact_sheet(ocean, job.frames, _caption(statistics, job))
    manifest = {
        **_header(job),
        "ocean": _tile(ocean),
        "statistics": asdict(statistics),  # ordered beside delivered
        "conventions": {
            "axes": "x east, y north, z up, right-handed",
            "rows": "row 0 of a picture is the north edge",
            "columns": "column 0 is the west edge",
            "normal_green": "up (toward row 0)",
            "samples": "texel (i, j) is the value at x = i lx/nx; sample textures at u = i/nx + 1/(2 nx)",
            "lookup": "lagrangian: a map is indexed by the undisplaced position",
        },
        "extremes": {"unit": {"max_height": "m", "max_horizontal": "m", "min_jacobian": "1"}, **extremes},
        "maps": {name: {**MAPS[name].describe(), "format": "exr half zip", "range": ranges[name]} for name in job.maps},
        "preview": {"path": PREVIEW_FILE, "sha256": write_whole(folder / PREVIEW_FILE, picture)},
        "frames": rows,
    }
    write_whole(folder / MANIFEST_FILE, as_json(manifest))
    return manifest


def _header(job: Job) -> dict[str, Any]:
    """What says which bake this is."""
    units = {p.key: p.unit for p in PARAMETERS if p.unit}
    return {"tool": "fftocean", "version": fftocean.__version__, "job": job.describe(), "units": units}


def _claim(folder: Path, job: Job, overwrite: bool) -> None:
    """
    Mark the folder as this job's, before the first frame; refuse another job's, naming the keys that differ.

    The manifest goes first of all: from then on the folder is no finished bake, whatever happens.
    """
    header, path = _header(job), folder / JOB_FILE
    if not overwrite:
        _require_same_job(folder, header["job"])
    remove(folder / MANIFEST_FILE)
    rooms = [folder / name for name in MAPS if not (folder / name).is_symlink()]  # nothing is removed through a link
    for room in (folder, *rooms):
        for torn in room.glob(".*.[0-9]*.tmp"):  # of a process that was killed while it wrote
            remove(torn)
    for room in rooms if overwrite else ():
        for stale in room.glob("[0-9]*.exr"):
            remove(stale)
    write_whole(path, as_json(header))


def _require_same_job(folder: Path, new: dict[str, Any]) -> None:
    """
    Refuse a folder that holds anything but a bake of this job.

    Raises:
        OutputError: another job is marked there, or none and yet files that this one would replace.
    """
    if not os.path.lexists(folder / JOB_FILE):
        for name in (MANIFEST_FILE, PREVIEW_FILE):
            if os.path.lexists(folder / name):
                raise OutputError(f"{folder} holds a {name} and is no bake, for want of {JOB_FILE}; choose another folder, or --overwrite")
        return
    before = read_json(folder / JOB_FILE)
    old = before.get("job") if isinstance(before, dict) else None
    old = old if isinstance(old, dict) else {}
    differing = sorted(key for key in {*old, *new} if old.get(key) != new.get(key))
    if differing:
        changes = "; ".join(f"{key}: {old.get(key, 'not set')} there, {new.get(key, 'not set')} here" for key in differing[:6])
        raise OutputError(f"{folder} holds the bake of another job ({changes:.400}); choose another folder, or --overwrite")


def _tile(ocean: Ocean) -> dict[str, Any]:
    """The tile in numbers."""
    grid = ocean.grid
    return {
        "n": [grid.nx, grid.ny],
        "size": [grid.lx, grid.ly],
        "depth": finite_or_word(ocean.depth),
        "loop": ocean.loop,
        "choppiness": ocean.choppiness,
        "fft": ocean.backend,
    }


def _caption(statistics: Statistics, job: Job) -> str:
    """One line for the contact sheet."""
    ordered = statistics.ordered
    assert ordered is not None  # a job has a sea
    g = job.settings
    size = "x".join(f"{v:g}" for v in g["ocean.size"]) if isinstance(g["ocean.size"], tuple) else f"{g['ocean.size']:g}"
    sea = f"Hs {ordered.hs:.2f} m ordered, {statistics.hs:.2f} m delivered   Tp {ordered.tp:.1f} s"
    return f"{sea}   tile {size} m   loop {g['ocean.loop']:g} s"
