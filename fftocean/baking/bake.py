"""
Bake of a job into a folder: survey of the loop, frames, and last of all the manifest.

Each result is on the disk before the journal records it, and the next run takes over only what the
journal records and the disk still holds unchanged. So a bake can be stopped at any moment, and the
same command resumes it and ends with the same bytes.
"""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from fftocean import blend_loss as blend
from fftocean import foam
from fftocean.baking.finished.containers import assemble, intact, unpack
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import compose, read_manifest
from fftocean.baking.folder import engine_files, layout
from fftocean.baking.folder.identity import header_of
from fftocean.baking.folder.journal import (
    Entry,
    Journal,
    Listen,
    Progress,
    Recorded,
    RunLog,
    entries_of,
)
from fftocean.baking.folder.listing import replace_cascade
from fftocean.baking.folder.lock import locked, require_free
from fftocean.baking.folder.ownership import (
    mark,
    remove_workspace,
    require_replaceable,
    require_same_bake,
)
from fftocean.baking.folder.plan import Plan, frames_of, tasks_of
from fftocean.baking.folder.rows import PackedRows, RowList, unpacked
from fftocean.baking.folder.sealed import write_sealed
from fftocean.baking.previews import previews
from fftocean.baking.scene import maps
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene, clear_scene, set_scene
from fftocean.baking.survey import needs_ranges, survey, with_recorded_ranges
from fftocean.baking.workers.choice import check_executor, choose_executor
from fftocean.baking.workers.local import Executor
from fftocean.errors import IntegrityError, JobError, OutputError, ParameterError, described
from fftocean.export import engines, formats
from fftocean.export.profiles import Profile
from fftocean.files import make_folder, path_of, remove_temporary_files
from fftocean.host import available_memory, cores
from fftocean.job.job import Job
from fftocean.ocean import memory_needed
from fftocean.statistics import measure

SERIAL_SAMPLES = 2e7
"""
Samples of all frames and maps that one process writes in the time in which others would start.
"""


def bake(
    job: Job,
    folder: str | Path = "out",
    *,
    overwrite: bool = False,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
    progress: Progress | None = None,
    listen: Listen | None = None,
    scene: Scene | None = None,
) -> dict[str, Any]:
    """
    Bake a job into a folder: maps, previews, and a manifest that is written last.

    Each map is written as one file per frame, or as one container, as the job's format has it. A
    folder without `manifest.json` is not a finished bake. The same call resumes a bake that was
    stopped: frames that exist and are unchanged are kept, and the bytes are those of a bake that
    was never stopped.

    Args:
        job: sea, tile, and maps to write.
        folder: the folder to write to; made if it does not exist.
        overwrite: replace a folder that holds another job; the files that its job or manifest lists
            are removed first.
        frames: part of the loop, `start:stop:step` as in Python slices; None is all of it.
        downsample: bake 1/downsample of the samples a side; waves too short for that grid are
            dropped (see `Job.downsampled`).
        executor: "serial", "processes", "dask" for a cluster on this machine, "tcp://..." for that
            of a scheduler, or "auto": processes, unless one process finishes before others start.
        workers: number of workers; None is one for each processor that this process may use.
        progress: called with (frames done, frames in all).
        listen: called with each event as plain data: {"event": "start" | "survey" | "frame" |
            "done", ...}.
        scene: the job's scene, if `scene_for` has set it up already.

    Returns:
        The manifest as plain data.

    Raises:
        OutputError: a file cannot be written, or the folder holds another job.
        FolderInUseError: another process bakes into the folder.
        JobError: the job asks for something that cannot be baked.
    """
    manifest = bake_packed(
        job,
        folder,
        overwrite=overwrite,
        frames=frames,
        downsample=downsample,
        executor=executor,
        workers=workers,
        progress=progress,
        listen=listen,
        scene=scene,
    )
    return unpacked(manifest)


def bake_packed(
    job: Job,
    folder: str | Path = "out",
    *,
    overwrite: bool = False,
    frames: str | None = None,
    downsample: int = 1,
    executor: str = "auto",
    workers: int | None = None,
    progress: Progress | None = None,
    listen: Listen | None = None,
    scene: Scene | None = None,
) -> dict[str, Any]:
    """
    Bake as `bake` does; return the manifest with its rows packed, as a `RowList`.

    The rows of many small frames take more memory as plain data than all else together.
    """
    if not isinstance(job, Job):
        raise JobError(
            f"a job must be a Job, such as Job.default() or Job.read('sea.toml'), got "
            f"{described(job)}"
        )
    executor = check_executor(executor, workers)
    folder = path_of("folder", folder)
    require_free(folder)
    chosen = frames_of(frames, job.frames)
    scene = scene or scene_for(job, downsample, len(chosen))
    header = header_of(job, frames=chosen, downsample=downsample, backend=scene.ocean.backend)
    make_folder(folder)
    with locked(folder) as lock:
        plan = Plan(job, downsample, header, chosen, str(folder), lock.token)
        set_scene(plan.identity, scene)
        try:
            if layout.is_cascade(folder):
                replace_cascade(folder, overwrite=overwrite)
            recorded = Recorded(_earlier_entries(folder, plan, scene, overwrite))
            make_folder(folder / layout.WORK_FOLDER)
            with Journal(folder / layout.JOURNAL, plan.identity, recorded.entries()) as journal:
                mark(folder, header, overwrite=overwrite)
                log = RunLog(folder, journal, recorded, progress, listen)
                rows, containers = _kept_frames(plan, scene, log)
                todo = [j for j in chosen if plan.place(j) not in rows] if rows else chosen
                name, count = choose_workers(executor, workers, scene, len(todo))
                chosen_executor = choose_executor(name, count, lock.descriptor)
                log.report(
                    "start",
                    folder=str(folder),
                    frames=len(chosen),
                    kept=len(rows),
                    executor=chosen_executor.name,
                    workers=chosen_executor.workers,
                )
                if rows:
                    log.progress(len(rows), len(chosen))
                plan = with_recorded_ranges(plan, log)
                if todo or needs_ranges(plan, scene):
                    with chosen_executor:
                        plan = survey(chosen_executor, plan, scene, log)
                        _write(chosen_executor, plan, todo, rows, log)
                    _remove_temporary_files(folder)  # a worker may have died while it wrote
                manifest = _finish(plan, scene, RowList(rows), containers, log)
            with suppress(OutputError):  # the bake is finished without that
                remove_workspace(folder)
        except BaseException:
            _remove_temporary_files(folder)
            raise
        finally:
            clear_scene()
    if listen:
        listen(
            {"event": "done", "manifest": str(folder / layout.MANIFEST_FILE), "frames": len(chosen)}
        )
    return manifest


def _remove_temporary_files(folder: Path) -> None:
    """Remove the temporary files of all processes that were stopped."""
    for inner in layout.folders_of(folder):
        remove_temporary_files(inner)


def scene_for(job: Job, downsample: int, frames: int) -> Scene:
    """
    Return the scene of a job whose maps, format and previews are possible; write nothing.

    Args:
        job: the job, before downsampling.
        downsample: factor by which the samples a side are fewer.
        frames: number of frames that the files will hold.

    Raises:
        JobError: the job asks for something that cannot be baked.
    """
    previews.require_drawable(job)
    try:
        maps.needed(job.maps, mips=job.mips, eulerian=job.lookup == "eulerian")
    except ParameterError as error:
        raise JobError(f"{job.source}: {error}") from None
    require_usable(job)
    scene = Scene(job.downsampled(downsample))
    for name in scene.job.maps:
        shape = (frames, *scene.ocean.grid.shape, len(MAPS[name].names))
        try:
            formats.require(scene.form.name, shape, scene.levels, gutter=scene.profile.gutter)
        except ParameterError as error:
            raise JobError(
                f"{job.source}: bake.format {scene.form.name!r} cannot hold the map "
                f"{name!r}: {error}"
            ) from None
    return scene


def require_usable(job: Job) -> Profile:
    """
    Return the conventions of a job's files.

    Raises:
        JobError: the engine cannot use the format; the message names one that it can.
    """
    try:
        return engines.profile_for(job.engine, job.format, job.normals)
    except ParameterError as error:
        raise JobError(f"{job.source}: bake.engine and bake.format: {error}") from None


def _earlier_entries(folder: Path, plan: Plan, scene: Scene, overwrite: bool) -> Iterable[Entry]:
    """
    Return the entries of earlier runs: those of the journal, or the rows of a manifest.

    Raises:
        OutputError: the folder holds another bake, and `overwrite` is False.
    """
    if overwrite:
        require_replaceable(folder, plan.header)
        remove_workspace(folder)
        return []
    require_same_bake(folder, plan.header)
    try:
        manifest = read_manifest(folder)
        contents = Contents.of(folder, manifest)
    except IntegrityError:
        return entries_of(folder / layout.JOURNAL, plan.identity)
    if any(manifest.get(key) != value for key, value in plan.header.items()):
        return []
    scaled = {
        name: [m["scaled"]["low"], m["scaled"]["high"]]
        for name, m in manifest["maps"].items()
        if "scaled" in m
    }
    known: list[Entry] = [{"ranges": scaled}] if scaled else []
    if scene.form.scope == "sequence":
        if intact(contents):
            known.append({"containers": manifest["containers"]})
        else:
            unpack(folder, scene, manifest)
    return itertools.chain(known, ({"row": row} for row in manifest["frames"]))


def _kept_frames(plan: Plan, scene: Scene, log: RunLog) -> tuple[PackedRows, dict[str, Any]]:
    """
    Return the rows of earlier runs with unchanged files, by place, and the finished containers.
    """
    containers: dict[str, Any] = next(iter(log.recorded.of("containers")), {})

    def is_intact(row: Mapping[str, Any], place: int) -> bool:
        files = [
            (layout.frame_file(scene.form, name, row["frame"], place), row["files"][name])
            for name in scene.job.maps
        ]
        return all(log.is_unchanged(path, entry["sha256"]) for path, entry in files)

    rows = PackedRows()
    for frame, row in log.recorded.of_frames("row").items():
        place = plan.place(frame)
        if frame in plan.frames and (containers or is_intact(row, place)):
            rows.put(place, row)
    return rows, containers


def choose_workers(executor: str, workers: int | None, scene: Scene, todo: int) -> tuple[str, int]:
    """
    Return an executor's name and the number of workers: at most one a frame, and as many as fit
    into memory.
    """
    grid = scene.ocean.grid
    most = available_memory() / memory_needed(grid, scene.ocean.dtype)
    count = max(1, min(workers or cores(), todo, int(min(most, 1024))))
    if executor == "auto":
        samples = float(grid.nx * grid.ny) * todo * len(scene.job.maps)
        executor = "processes" if count > 1 and samples > SERIAL_SAMPLES else "serial"
    return executor, 1 if executor == "serial" else count


def _write(
    executor: Executor,
    plan: Plan,
    todo: Sequence[int],
    rows: PackedRows,
    log: RunLog,
) -> None:
    """Write frames; add each to the journal and, by its place, to `rows`."""
    total = len(plan.frames)
    if "foam" in plan.job.maps:
        size = foam.SPAN
    elif executor.name == "serial":
        size = plan.job.frames  # one task: at the end of each, all threads must finish
    else:
        size = max(1, min(foam.SPAN, math.ceil(len(todo) / (4 * executor.workers))))
    with closing(executor.run(plan, tasks_of("frame", todo, size))) as entries:
        for entry in entries:
            row = entry["row"]
            place = plan.place(row["frame"])
            if place in rows:
                continue  # its task was carried out twice
            log.add(entry)
            rows.put(place, row)
            log.progress(len(rows), total)
            log.report("frame", frame=row["frame"], t=row["t"], done=len(rows), frames=total)


def _finish(
    plan: Plan,
    scene: Scene,
    rows: RowList,
    containers: dict[str, Any],
    log: RunLog,
) -> dict[str, Any]:
    """Write containers, previews, files for the engine, and the manifest; return the manifest."""
    containers = containers or assemble(log.folder, plan, scene, rows)
    statistics = measure(scene.ocean)
    manifest = compose(
        plan,
        scene,
        rows,
        statistics=statistics,
        blend=blend.describe(scene.ocean, max(1, round(scene.job.frames / plan.step))),
        containers=containers,
        pictures=previews.write_previews(log.folder, scene, statistics),
        engine_files=engine_files.write_player(
            log.folder, plan.header["job"], layout.MANIFEST_FILE
        ),
    )
    return write_sealed(log.folder / layout.MANIFEST_FILE, manifest)
