"""
What must be known of the whole loop before its first frame can be written: foam that returns to
itself, and ranges of scaled maps.
"""

import io
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace

import numpy as np

from fftocean import foam
from fftocean.baking.folder import layout
from fftocean.baking.folder.plan import Entry, Order, Task, tasks_of
from fftocean.baking.folder.run_log import Ledger
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.baking.workers.local import Crew
from fftocean.export.profiles import range_of_normals
from fftocean.files import write_whole


def recalled(order: Order, ledger: Ledger) -> Order:
    """Return the order with the ranges that an earlier run found."""
    found = ledger.claimed("ranges")
    return _with(order, found[-1]) if found else order


def wanting(order: Order, scene: Scene) -> bool:
    """Whether ranges are still to be found."""
    return scene.form.scaled and not order.ranges


def survey(crew: Crew, order: Order, scene: Scene, ledger: Ledger) -> Order:
    """
    Return the order with all that its frames need. What an earlier run found is taken over where
    the disk bears it out.
    """
    if "foam" in scene.job.maps:
        _foam(crew, order, scene, ledger)
    return _with(order, _ranges(crew, order, scene, ledger)) if wanting(order, scene) else order


def _with(order: Order, ranges: Mapping[str, Sequence[float]]) -> Order:
    return replace(order, ranges={name: (low, high) for name, (low, high) in ranges.items()})


def _foam(crew: Crew, order: Order, scene: Scene, ledger: Ledger) -> None:
    """
    What each span of the loop makes of foam, and from all of them the states that return to
    themselves, in one file.
    """
    spans = foam.spans_of(scene.job.frames)
    made = {
        part["first"]: part
        for part in ledger.claimed("foam")
        if ledger.holds(layout.foam_file(part["first"]), part["sha256"])
    }
    tasks = [Task("foam", tuple(range(first, stop))) for first, stop in spans if first not in made]
    for entry in _surveyed(crew, order, tasks, ledger, "foam", len(spans), len(made)):
        made[entry["foam"]["first"]] = entry["foam"]
    parts = [
        np.load(ledger.folder / layout.foam_file(first), allow_pickle=False) for first, _ in spans
    ]
    stream = io.BytesIO()
    np.save(stream, scene.foam.starts(parts, scene.ocean, scene.job.frames), allow_pickle=False)
    write_whole(ledger.folder / layout.FOAM_STARTS, stream.getbuffer())


def _ranges(crew: Crew, order: Order, scene: Scene, ledger: Ledger) -> dict[str, list[float]]:
    """
    The least and greatest value of each map over the whole loop, whichever of its frames are baked;
    a normal's are fixed.
    """
    seen = {part["frame"]: part["maps"] for part in ledger.claimed("range")}
    count, names = scene.job.frames, scene.job.maps
    measured = [name for name in names if MAPS[name].kind != "normal"]
    if measured:
        tasks = tasks_of("range", [j for j in range(count) if j not in seen], foam.SPAN)
        for entry in _surveyed(crew, order, tasks, ledger, "range", count, len(seen)):
            seen[entry["range"]["frame"]] = entry["range"]["maps"]
    ranges = {
        name: [
            min(maps[name][0] for maps in seen.values()),
            max(maps[name][1] for maps in seen.values()),
        ]
        for name in measured
    }
    ranges |= {
        name: list(range_of_normals(scene.profile)) for name in names if name not in measured
    }
    ledger.add({"ranges": ranges})
    return ranges


def _surveyed(
    crew: Crew,
    order: Order,
    tasks: Sequence[Task],
    ledger: Ledger,
    kind: str,
    total: int,
    done: int,
) -> Iterator[Entry]:
    """Have tasks done; what is found goes into the journal."""
    with closing(crew.run(order, tasks)) as entries:
        for entry in entries:
            ledger.add(entry)
            done += 1
            ledger.say("survey", what=kind, done=min(done, total), total=total)
            yield entry
