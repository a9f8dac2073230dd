"""
Turning a job into a folder that can be trusted: claim it, survey the loop, write the frames, and
the manifest last of all.

Each thing that is finished is on the disk before the journal says so, and only what the journal
says and the disk bears out is taken over by the next run. So a bake can be stopped at any moment,
and goes on with the same command to the same bytes.
"""

import math
from collections.abc import Mapping, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from fftocean import blend_loss as blend
from fftocean import foam
from fftocean.baking.finished.containers import assemble, intact, unpack
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import compose, read_manifest
from fftocean.baking.folder import layout
from fftocean.baking.folder.identity import (
    claim,
    discard_work,
    header_of,
    require_claimable,
    require_replaceable,
)
from fftocean.baking.folder.journal import Journal, entries_of
from fftocean.baking.folder.listing import leave_cascade
from fftocean.baking.folder.lock import locked, require_free
from fftocean.baking.folder.plan import Entry, Order, frames_of, tasks_of
from fftocean.baking.folder.run_log import Ledger, Listen, Progress
from fftocean.baking.previews import previews as pictures
from fftocean.baking.scene import maps
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene, leave, seat
from fftocean.baking.survey import recalled, survey, wanting
from fftocean.baking.workers.choice import check_executor, crew_of
from fftocean.baking.workers.local import Crew
from fftocean.errors import IntegrityError, JobError, OutputError, ParameterError, described
from fftocean.export import engines, formats
from fftocean.export.profiles import Profile
from fftocean.files import as_json, make_folder, path_of, sweep, write_whole
from fftocean.host import available_memory, cores
from fftocean.job.job import Job
from fftocean.ocean import memory_needed
from fftocean.statistics import measure

SMALL = 2e7
"""
Samples of a bake, all frames and maps, that one process has written before others would have
started.
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
    Bake a job: a file a map and frame, or a container a map, something to look at, and a manifest
    that is written last.

    A folder without `manifest.json` is not a finished bake. The same bake into its folder again
    goes on where it was stopped: frames that are there, and are what they were when they were
    written, are kept; the bytes are those of a bake that was never stopped.

    Args:
        job: what to bake.
        folder: where to; made if it is not there.
        overwrite: bake over another job's folder; what its job or manifest lists is removed first.
        frames: a part of the loop, `start:stop:step` as Python slices; None is all of it.
        downsample: how many times fewer samples a side: the same waves, but for those too short
            (see `Job.downsampled`).
        executor: "serial", "processes", "dask" for a cluster of this machine's own, "tcp://..." for
            a scheduler's, or "auto": processes, unless the bake is so small that one would be done
            before others had started.
        workers: how many; None is one for each processor that this process may use.
        progress: called with (frames done, frames in all).
        listen: called with what happens, as plain data: {"event": "start" | "survey" | "frame" |
            "done", ...}.
        scene: the job's water, where it is set up already, as `scene_for` does.

    Returns:
        The manifest, as plain data.

    Raises:
        OutputError: a file cannot be written, or the folder holds another job.
        FolderInUseError: another process bakes into the folder.
        JobError: the job asks for more than can be.
    """
    if not isinstance(job, Job):
        raise JobError(
            f"a job must be a Job, such as Job.default() or Job.read('sea.toml'), got {described(job)}"
        )
    executor = check_executor(executor, workers)
    folder = path_of("folder", folder)
    require_free(folder)
    chosen = frames_of(frames, job.frames)
    scene = scene or scene_for(job, downsample, len(chosen))
    header = header_of(job, frames=chosen, downsample=downsample, backend=scene.ocean.backend)
    make_folder(folder)
    with locked(folder) as hold:
        order = Order(job, downsample, header, chosen, str(folder), hold.token)
        seat(order.claim, scene)
        try:
            leave_cascade(folder, overwrite=overwrite)
            known = _known(folder, order, scene, overwrite)
            make_folder(folder / layout.WORK_FOLDER)
            with Journal(folder / layout.JOURNAL, order.claim, known) as journal:
                claim(folder, header, overwrite=overwrite)
                ledger = Ledger(folder, journal, known, progress, listen)
                rows, containers = _kept(order, scene, ledger)
                todo = [j for j in chosen if j not in rows]
                crew = crew_of(*crew_for(executor, workers, scene, len(todo)), hold.descriptor)
                ledger.say(
                    "start",
                    folder=str(folder),
                    frames=len(chosen),
                    kept=len(rows),
                    executor=crew.name,
                    workers=crew.workers,
                )
                if rows:
                    ledger.progress(len(rows), len(chosen))
                order = recalled(order, ledger)
                if todo or wanting(order, scene):
                    with crew:
                        order = survey(crew, order, scene, ledger)
                        _write(crew, order, todo, rows, ledger)
                    _sweep(folder)  # a worker may have died while it wrote
                manifest = _finish(order, scene, [rows[j] for j in chosen], containers, ledger)
            with suppress(OutputError):  # the bake is done; what is left of its work is litter
                discard_work(folder)
        except BaseException:
            _sweep(folder)
            raise
        finally:
            leave()
    if listen:
        listen(
            {"event": "done", "manifest": str(folder / layout.MANIFEST_FILE), "frames": len(chosen)}
        )
    return manifest


def _sweep(folder: Path) -> None:
    """Remove the temporary files of all who are stopped."""
    for room in layout.rooms(folder):
        sweep(room)


def scene_for(job: Job, downsample: int, frames: int) -> Scene:
    """
    Set up a job's water, and find out before anything is written whether its format can hold so
    many frames of its maps.

    Raises:
        JobError: the job asks for more than can be.
    """
    pictures.require_drawable(job)
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
                f"{job.source}: bake.format {scene.form.name!r} cannot hold the map {name!r}: {error}"
            ) from None
    return scene


def require_usable(job: Job) -> Profile:
    """
    Return the conventions of a job's files; nothing is written before.

    Raises:
        JobError: the engine cannot use the format; the message names the format to choose.
    """
    try:
        return engines.profile_for(job.engine, job.format, job.normals)
    except ParameterError as error:
        raise JobError(f"{job.source}: bake.engine and bake.format: {error}") from None


def _known(folder: Path, order: Order, scene: Scene, overwrite: bool) -> list[Entry]:
    """
    What an earlier run says that it has finished: a manifest's rows, or a journal's lines.

    Raises:
        OutputError: the folder holds another bake, and is not to be overwritten.
    """
    if overwrite:
        require_replaceable(folder)
        discard_work(folder)
        return []
    require_claimable(folder, order.header)
    try:
        manifest = read_manifest(folder)
        contents = Contents.of(folder, manifest)
    except IntegrityError:
        return entries_of(folder / layout.JOURNAL, order.claim)
    if any(manifest.get(key) != value for key, value in order.header.items()):
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
    return [*known, *({"row": row} for row in manifest["frames"])]


def _kept(
    order: Order, scene: Scene, ledger: Ledger
) -> tuple[dict[int, dict[str, Any]], dict[str, Any]]:
    """
    The frames of earlier runs that the disk bears out, by their number, and the containers that
    they stand in already.
    """
    containers: dict[str, Any] = next(iter(ledger.claimed("containers")), {})
    places = {j: place for place, j in enumerate(order.frames)}

    def borne_out(row: Mapping[str, Any]) -> bool:
        files = [
            (
                layout.frame_file(scene.form, name, row["frame"], places[row["frame"]]),
                row["files"][name],
            )
            for name in scene.job.maps
        ]
        return all(ledger.holds(path, entry["sha256"]) for path, entry in files)

    rows = {row["frame"]: row for row in ledger.claimed("row") if row["frame"] in places}
    return {j: row for j, row in rows.items() if containers or borne_out(row)}, containers


def crew_for(executor: str, workers: int | None, scene: Scene, todo: int) -> tuple[str, int]:
    """Who does it, and how many: no more workers than frames, nor than there is memory for."""
    grid = scene.ocean.grid
    most = available_memory() / memory_needed(grid, scene.ocean.dtype)
    hands = max(1, min(workers or cores(), todo, int(min(most, 1024))))
    if executor == "auto":
        samples = float(grid.nx * grid.ny) * todo * len(scene.job.maps)
        executor = "processes" if hands > 1 and samples > SMALL else "serial"
    return executor, 1 if executor == "serial" else hands


def _write(
    crew: Crew, order: Order, todo: Sequence[int], rows: dict[int, dict[str, Any]], ledger: Ledger
) -> None:
    """Have frames written; each that is finished goes into the journal, and into `rows`."""
    total = len(order.frames)
    size = (
        foam.SPAN
        if "foam" in order.job.maps
        else max(1, min(foam.SPAN, math.ceil(len(todo) / (4 * crew.workers))))
    )
    with closing(crew.run(order, tasks_of("frame", todo, size))) as entries:
        for entry in entries:
            row = entry["row"]
            if row["frame"] in rows:
                continue  # of a task that was done twice
            ledger.add(entry)
            rows[row["frame"]] = row
            ledger.progress(len(rows), total)
            ledger.say("frame", frame=row["frame"], t=row["t"], done=len(rows), frames=total)


def _finish(
    order: Order,
    scene: Scene,
    rows: list[dict[str, Any]],
    containers: dict[str, Any],
    ledger: Ledger,
) -> dict[str, Any]:
    """Containers, pictures, and the manifest."""
    containers = containers or assemble(ledger.folder, order, scene, rows)
    statistics = measure(scene.ocean)
    manifest = compose(
        order,
        scene,
        rows,
        statistics=statistics,
        blend=blend.describe(scene.ocean, max(1, round(scene.job.frames / order.step))),
        containers=containers,
        pictures=pictures.draw(ledger.folder, scene, statistics),
    )
    write_whole(ledger.folder / layout.MANIFEST_FILE, as_json(manifest))
    return manifest
