"""Survey of the whole loop before its first frame: periodic foam and ranges of scaled maps."""

import io
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace

import numpy as np

from fftocean import foam
from fftocean.baking.folder import layout
from fftocean.baking.folder.journal import Entry, RunLog
from fftocean.baking.folder.plan import Plan, Task, TaskKind, tasks_of
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.baking.workers.local import Executor
from fftocean.export.profiles import range_of_normals
from fftocean.files import write_whole


def with_recorded_ranges(plan: Plan, log: RunLog) -> Plan:
    """Return the plan with the ranges that an earlier run recorded."""
    found = log.recorded.of("ranges")
    return _with_ranges(plan, found[-1]) if found else plan


def needs_ranges(plan: Plan, scene: Scene) -> bool:
    """Return whether the ranges of scaled maps are not known yet."""
    return scene.form.scaled and not plan.ranges


def survey(executor: Executor, plan: Plan, scene: Scene, log: RunLog) -> Plan:
    """
    Return the plan with all that its frames need.

    Results of an earlier run are taken over where their files are unchanged.
    """
    if "foam" in scene.job.maps:
        _foam(executor, plan, scene, log)
    return (
        _with_ranges(plan, _ranges(executor, plan, scene, log))
        if needs_ranges(plan, scene)
        else plan
    )


def _with_ranges(plan: Plan, ranges: Mapping[str, Sequence[float]]) -> Plan:
    return replace(plan, ranges={name: (low, high) for name, (low, high) in ranges.items()})


def _foam(executor: Executor, plan: Plan, scene: Scene, log: RunLog) -> None:
    """
    Write the foam at the start of each span of the loop, such that it repeats with the loop.

    The response of each span is computed first: it is a task of its own.
    """
    spans = foam.spans_of(scene.job.frames)
    made = {
        part["first"]: part
        for part in log.recorded.of("foam")
        if log.is_unchanged(layout.foam_file(part["first"]), part["sha256"])
    }
    tasks = [Task("foam", tuple(range(first, stop))) for first, stop in spans if first not in made]
    for entry in _surveyed(executor, plan, tasks, log, "foam", len(spans), len(made)):
        made[entry["foam"]["first"]] = entry["foam"]
    parts = [
        np.load(log.folder / layout.foam_file(first), allow_pickle=False) for first, _ in spans
    ]
    stream = io.BytesIO()
    np.save(stream, scene.foam.starts(parts, scene.ocean, scene.job.frames), allow_pickle=False)
    write_whole(log.folder / layout.FOAM_STARTS, stream.getbuffer())


def _ranges(executor: Executor, plan: Plan, scene: Scene, log: RunLog) -> dict[str, list[float]]:
    """
    Return the least and greatest value of each map over the whole loop, whichever of its frames are
    baked; a normal's are fixed.
    """
    count, names = scene.job.frames, scene.job.maps
    seen = log.recorded.of_frames("range")
    found: dict[str, list[float]] = {}
    for part in seen.values():
        _widen(found, part["maps"])
    measured = [name for name in names if MAPS[name].kind != "normal"]
    if measured:
        tasks = tasks_of("range", [j for j in range(count) if j not in seen], foam.SPAN)
        for entry in _surveyed(executor, plan, tasks, log, "range", count, len(seen)):
            _widen(found, entry["range"]["maps"])
    ranges = {name: found[name] for name in measured}
    ranges |= {
        name: list(range_of_normals(scene.profile)) for name in names if name not in measured
    }
    log.add({"ranges": ranges})
    return ranges


def _widen(ranges: dict[str, list[float]], maps: Mapping[str, Sequence[float]]) -> None:
    """Let the range of each map hold one more range."""
    for name, (low, high) in maps.items():
        least, most = ranges.get(name, (low, high))
        ranges[name] = [min(least, low), max(most, high)]


def _surveyed(
    executor: Executor,
    plan: Plan,
    tasks: Sequence[Task],
    log: RunLog,
    kind: TaskKind,
    total: int,
    done: int,
) -> Iterator[Entry]:
    """Run tasks; add each result to the journal."""
    with closing(executor.run(plan, tasks)) as entries:
        for entry in entries:
            log.add(entry)
            done += 1
            log.report("survey", what=kind, done=min(done, total), total=total)
            yield entry
