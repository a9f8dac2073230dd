"""Promises of bakes: slices of frames, and contents that are verified before they are used."""

import contextlib
import dataclasses
import os
import queue
import signal
import threading
from pathlib import Path
from types import SimpleNamespace

import builders
import numpy as np
import pytest
from builders import tree

import fftocean as fo
from fftocean.baking import bake as baker
from fftocean.baking import repair as mending
from fftocean.baking import survey
from fftocean.baking.finished import check, containers, manifest
from fftocean.baking.folder import layout
from fftocean.baking.folder.journal import Journal, Recorded, RunLog
from fftocean.baking.folder.lock import locked
from fftocean.baking.folder.plan import Plan, Task, frames_of
from fftocean.baking.folder.rows import PackedRows
from fftocean.baking.folder.sealed import read_sealed, sealed
from fftocean.baking.scene import scene as scenes
from fftocean.baking.workers import local
from fftocean.baking.workers.cluster import Cluster
from fftocean.baking.workers.local import ATTEMPTS, Serial, _remaining, _Worker
from fftocean.errors import FolderInUseError, IntegrityError, JobError, OutputError
from fftocean.files import as_json

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")


def job(**changes):
    small = {"ocean.n": 8, "bake.frames": 4, "bake.maps": ["height"], "bake.pictures": []}
    return builders.job(small, **changes)


def plan_of(folder, token, frames=None, **changes):
    """Return a plan as a bake makes it, with a header that is not looked at."""
    sea_job = job(**changes)
    chosen = frames_of(frames, sea_job.frames)
    return Plan(sea_job, 1, {}, chosen, str(folder), token)


def row(frame, **more):
    return {"frame": frame, "t": 0.1 * frame, **more}


@pytest.mark.parametrize("text", ["7:2:-1", "::-1", "5:5", "9:3", "0:8:0", "2", "1:2:3:4", "a:b"])
def test_slices_that_go_backward_or_nowhere_are_refused(text):
    with pytest.raises(JobError, match="frames must"):
        frames_of(text, 8)


@pytest.mark.parametrize("text", ["0:8", "2:7:2", ":3", "5:", "-3:", "1:100:3", "7:8"])
def test_slices_are_those_of_a_list(text):
    chosen = frames_of(text, 8)
    assert tuple(chosen) == tuple(eval(f"list(range(8))[{text}]"))
    assert len(set(chosen)) == len(chosen)


def test_a_changed_value_of_a_sealed_file_is_found(tmp_path):
    """The file stays JSON as a bake writes it: only the checksum tells."""
    path = tmp_path / "manifest.json"
    path.write_bytes(as_json(sealed({"frames": 12})))
    assert read_sealed(path) == {"frames": 12}
    path.write_bytes(path.read_bytes().replace(b"12", b"13"))
    with pytest.raises(IntegrityError, match="was changed after it was written"):
        read_sealed(path)


def test_parts_are_verified_before_they_are_put_into_a_container(tmp_path, monkeypatch):
    """One bit of the second part: the first is given, the second named."""
    rows = [
        {"frame": 3, "files": {"height": {"sha256": containers.digest(b"one")}}},
        {"frame": 4, "files": {"height": {"sha256": containers.digest(b"two")}}},
    ]
    monkeypatch.setattr(
        containers.layout, "frame_file", lambda _form, name, frame, _place: f"{name}.{frame}"
    )

    class Scene:
        form = None

    (tmp_path / "height.3").write_bytes(b"one")
    (tmp_path / "height.4").write_bytes(b"two")
    assert list(containers._parts(tmp_path, Scene, "height", rows)) == [b"one", b"two"]
    (tmp_path / "height.4").write_bytes(b"twn")
    parts = containers._parts(tmp_path, Scene, "height", rows)
    assert next(parts) == b"one"
    with pytest.raises(IntegrityError, match=r"height\.4 was changed after it was written"):
        next(parts)
    (tmp_path / "height.4").unlink()
    with pytest.raises(IntegrityError, match=r"height\.4"):
        list(containers._parts(tmp_path, Scene, "height", rows))


def test_any_byte_of_a_sealed_file_counts(tmp_path):
    """Even one that JSON does not look at: a space, an order of keys, an end of a line."""
    path = tmp_path / "manifest.json"
    data = as_json(sealed({"frames": 12, "maps": ["height"]}))
    for changed in (
        data.replace(b": 12", b":  12"),
        data + b"\n",
        data.replace(b"\n", b"\r\n"),
        data.replace(b'"frames"', b'"fr\\u0061mes"'),
        data[:-1],
    ):
        assert changed != data
        path.write_bytes(changed)
        with pytest.raises(IntegrityError, match="was changed after it was written"):
            read_sealed(path)
    path.write_bytes(data)
    assert read_sealed(path) == {"frames": 12, "maps": ["height"]}


@pytest.mark.parametrize(
    ("text", "frames"), [(None, range(8)), ("1:8:3", (1, 4, 7)), ("5:6", (5,)), ("2::2", (2, 4, 6))]
)
def test_places_are_counted_in_the_sequence(text, frames):
    """The n-th frame that is baked stands at place n, whatever its number in the loop."""
    plan = plan_of("out", "token", text, bake__frames=8)
    assert tuple(plan.frames) == tuple(frames)
    assert [plan.place(j) for j in frames] == list(range(len(plan.frames)))


def test_a_part_of_the_loop_plays_through_in_its_time():
    """Each frame stands for as long as the step to the next."""
    scene = SimpleNamespace(job=job(bake__frames=8, ocean__loop=16.0))
    for text, seconds in ((None, 16.0), ("0:8:2", 16.0), ("0:4", 8.0), ("1:8:3", 18.0)):
        plan = plan_of("out", "token", text, bake__frames=8)
        assert manifest.played(plan, scene, len(plan.frames)) == pytest.approx(seconds)


def test_folders_of_a_bake_are_not_found_through_links(tmp_path):
    """Nor are those inside them: what is removed and swept up lies in the folder itself."""
    (tmp_path / "other" / "inner").mkdir(parents=True)
    folder = tmp_path / "out"
    (folder / ".work" / "foam").mkdir(parents=True)
    (folder / ".work" / "link").symlink_to(tmp_path / "other")
    (folder / "height").symlink_to(tmp_path / "other")
    (folder / "normal").mkdir()
    (folder / "jacobian.zarr").symlink_to(tmp_path / "other")
    (folder / "somebody").mkdir()
    found = [path.relative_to(folder).as_posix() for path in layout.folders_of(folder)]
    assert found[0] == "."
    assert sorted(found[1:]) == [".work", ".work/foam", "normal"]
    # the link is named like a container, and what it leads to is not looked at
    assert list(layout.bake_files(folder)) == [folder / "jacobian.zarr"]


def test_an_empty_file_is_cut():
    """A file of no byte exists; one that does not is missing."""
    entry = {"bytes": 3, "sha256": containers.digest(b"abc")}
    known = {containers.digest(b"xyz"): "height of frame 3"}
    found = {
        data: check._fault(data, entry, lambda: known)
        for data in (None, b"", b"ab", b"abc", b"xyz", b"abd")
    }
    kinds = {data: fault and fault[0] for data, fault in found.items()}
    assert kinds == {
        None: "missing",
        b"": "cut",
        b"ab": "cut",
        b"abc": None,
        b"xyz": "swapped",
        b"abd": "changed",
    }
    assert found[b"xyz"][1] == "it holds height of frame 3"


def test_only_scaled_formats_are_surveyed_for_ranges(tmp_path, monkeypatch):
    """And for foam those jobs alone that bake it: a survey computes the whole loop."""
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    monkeypatch.setattr(baker, "measure", lambda _: still)
    for form, maps, expected in (
        ("exr", ["height"], set()),
        ("npz", ["height"], set()),
        ("r16", ["height"], {"range"}),
        ("exr", ["foam"], {"foam"}),
    ):
        events = []
        sea_job = job(bake__format=form, bake__maps=maps)
        folder = tmp_path / f"{form}-{maps[0]}"
        fo.bake(sea_job, folder, executor="serial", listen=events.append)
        assert {e["what"] for e in events if e["event"] == "survey"} == expected
    scene = SimpleNamespace(form=SimpleNamespace(scaled=True))
    plan = plan_of("out", "token")
    assert survey.needs_ranges(plan, scene)
    assert not survey.needs_ranges(dataclasses.replace(plan, ranges={"height": (0.0, 1.0)}), scene)


def test_foam_of_an_earlier_run_is_verified(tmp_path):
    """A span whose file is as the journal says is taken over; another one is computed again."""
    asked, spans = [], survey.foam.spans_of(40)
    assert len(spans) > 1

    class Executor:
        def run(self, _plan, tasks):
            for task in tasks:
                asked.append(task.frames[0])
                file = layout.foam_file(task.frames[0])
                (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
                np.save(tmp_path / file, np.full((2, 2), float(task.frames[0])))
                sha256 = containers.digest((tmp_path / file).read_bytes())
                yield {"foam": {"first": task.frames[0], "path": file, "sha256": sha256}}

    def starts(parts, _ocean, _count):
        return np.array(parts)

    scene = SimpleNamespace(
        job=SimpleNamespace(frames=40), ocean=None, foam=SimpleNamespace(starts=starts)
    )
    firsts = [first for first, _ in spans]
    known = []
    for spoilt, expected in ((None, firsts), (None, []), (firsts[1], [firsts[1]])):
        asked.clear()
        if spoilt is not None:
            (tmp_path / layout.foam_file(spoilt)).write_bytes(b"spoilt")
        (tmp_path / ".work").mkdir(exist_ok=True)
        with Journal(tmp_path / ".work" / "journal", "i" * 64, []) as journal:
            log = RunLog(tmp_path, journal, Recorded(known))
            survey._foam(Executor(), plan_of(tmp_path, "token"), scene, log)
        assert asked == expected
        known = [
            {
                "foam": {
                    "first": first,
                    "sha256": containers.digest((tmp_path / layout.foam_file(first)).read_bytes()),
                }
            }
            for first in firsts
        ]
        made = np.load(tmp_path / layout.FOAM_STARTS)
        assert [float(part[0, 0]) for part in made] == [float(first) for first in firsts]


def test_a_frame_that_is_reported_twice_counts_once(tmp_path):
    """A cluster may carry out a task again: the first row stays, and the journal has it once."""

    class Executor(Serial):
        def run(self, _plan, _tasks):
            for j in (0, 1, 0, 2, 3, 1):
                yield {"row": row(j, files={"attempt": j})}

    calls, rows = [], PackedRows()
    (tmp_path / ".work").mkdir()
    path = tmp_path / layout.JOURNAL
    with Journal(path, "i" * 64, []) as journal:
        log = RunLog(tmp_path, journal, Recorded(), progress=lambda *at: calls.append(at))
        baker._write(Executor(), plan_of(tmp_path, "token"), range(4), rows, log)
    assert calls == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert path.read_bytes().count(b'"row"') == 4
    assert sorted(rows) == [0, 1, 2, 3]


def test_rows_of_another_header_are_not_taken_over(tmp_path, monkeypatch):
    """
    A sound manifest beside the job of another bake, as a bake leaves it that was stopped after it
    wrote the job and before it removed the manifest.
    """
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    monkeypatch.setattr(baker, "measure", lambda _: still)
    out = tmp_path / "out"
    fo.bake(job(), out, executor="serial")
    fo.bake(job(ocean__seed=9), tmp_path / "other", executor="serial")
    (out / "job.json").write_bytes((tmp_path / "other" / "job.json").read_bytes())
    fo.bake(job(ocean__seed=9), out, executor="serial")
    assert tree(out) == tree(tmp_path / "other")


def test_a_repair_that_gives_another_manifest_is_an_error(tmp_path, monkeypatch):
    """The bytes of the first bake are promised, or nothing."""
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    monkeypatch.setattr(baker, "measure", lambda _: still)
    fo.bake(job(), tmp_path, executor="serial")
    assert mending.repair(tmp_path, executor="serial")
    real = mending.bake_packed

    def other(*arguments, **options):
        return {**real(*arguments, **options), "downsample": 2}

    monkeypatch.setattr(mending, "bake_packed", other)
    with pytest.raises(IntegrityError, match="differs from the first bake: downsample: 1 there"):
        mending.repair(tmp_path, executor="serial")


def test_a_thread_of_a_bake_that_was_given_up_writes_no_more(tmp_path):
    """A thread that encodes asks for the lock itself, just before it writes."""
    with locked(tmp_path) as hold:
        plan = plan_of(tmp_path, hold.token)
        scene = scenes.Scene(plan.job)
        ((name, levels),) = scene.maps(scene.frame(0), None)
        written = scenes._write_map(plan, scene, tmp_path, name, 0, levels)
        assert (tmp_path / written["path"]).is_file()
        (tmp_path / written["path"]).unlink()
    with pytest.raises(FolderInUseError, match="not held by this bake any more"):
        scenes._write_map(plan, scene, tmp_path, name, 0, levels)
    assert not tree(tmp_path)


def test_no_thread_writes_after_the_end(tmp_path, monkeypatch):
    """A bake that is given up waits for the file that is being written, and begins no other."""
    begun, go, done = threading.Event(), threading.Event(), []

    def slowly(_plan, _scene, _folder, name, j, _levels):
        begun.set()
        assert go.wait(600.0)
        done.append((name, j))
        return {}

    monkeypatch.setattr(scenes, "_write_map", slowly)
    with locked(tmp_path) as hold:
        plan = plan_of(tmp_path, hold.token, bake__maps=["height", "normal"])
        scene = scenes.Scene(plan.job)
        frames = scenes._write_frames(plan, scene, tmp_path, plan.frames, 1)
        threading.Thread(target=lambda: begun.wait(600.0) and go.set()).start()
        with contextlib.closing(frames):
            next(frames)
        count = len(done)
        assert not [t for t in threading.enumerate() if t.name.startswith("fftocean-writer")]
        assert len(done) == count < 8


def test_the_rest_of_a_dead_worker_s_task():
    """Frames that are finished are not given out again; a task that finishes none is the cause."""
    assert 2 <= ATTEMPTS <= 5  # one accident is survived, and a cause does not return for hours
    task = Task("frame", (4, 5, 6, 7))
    assert _remaining(task, 1, {4, 6}, -9) == [(Task("frame", (5, 7)), 1)]
    assert _remaining(task, ATTEMPTS, {4}, -9) == [(Task("frame", (5, 6, 7)), 1)]
    assert _remaining(task, 1, set(), -9) == [(task, 2)]
    assert _remaining(task, 1, {4, 5, 6, 7}, 0) == []
    foam = Task("foam", (0, 1, 2))
    assert _remaining(foam, 1, {-1}, 1) == [(foam, 2)]
    with pytest.raises(OutputError, match=r"frame 4 to 7 could not be baked: .* exit code -9; few"):
        _remaining(task, ATTEMPTS, set(), -9)


@pytest.fixture
def started(monkeypatch):
    """Return the keywords with which a worker would be started, which none is."""
    seen = []

    def start(_command, **keywords):
        seen.append(keywords)
        raise OSError(12, "Cannot allocate memory")

    monkeypatch.setattr(local.subprocess, "Popen", start)
    with pytest.raises(OutputError, match="a worker could not be started: Cannot allocate memory"):
        _Worker(17, queue.SimpleQueue())
    return seen[0]


def test_a_worker_has_one_thread(started):
    """Of each library that has threads, as there is a worker for each processor."""
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    assert {started["env"][name] for name in names} == {"1"}
    assert {**started["env"], **os.environ} == {**dict.fromkeys(names, "1"), **os.environ}


@pytest.mark.skipif(os.name != "posix", reason="Windows inherits no descriptors")
def test_a_worker_holds_the_lock_too(started):
    """So a worker that outlives its bake keeps the folder until it has ended."""
    assert started["pass_fds"] == (17,)


@pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")
@pytest.mark.process
def test_a_worker_is_not_interrupted_by_itself(tmp_path):
    """Ctrl-C reaches every process of the group; the one with the lock decides."""
    answers = queue.SimpleQueue()
    with locked(tmp_path) as hold:
        worker = _Worker(hold.descriptor, answers)
        try:
            for _ in range(2):  # it has begun when it has answered once
                worker.send(("no plan", None))
                sender, answer = answers.get(timeout=600.0)
                assert sender is worker
                assert answer is not None
                assert answer[0] == "failed"
                worker.process.send_signal(signal.SIGINT)
        finally:
            worker.stop()


def test_a_cluster_gives_each_entry_once(monkeypatch):
    """
    A worker reports a frame when it is finished, and again with its task; it is told the folder by
    its whole name, as it has another current one.
    """
    pytest.importorskip("distributed")
    told = []

    class Future:
        def __init__(self, entries):
            self.entries = entries

        def add_done_callback(self, call):
            call(self)

        def result(self):
            return self.entries

    class Client:
        def subscribe_topic(self, _topic, handler):
            self.handler = handler

        def submit(self, _function, plan, task, _topic, **_options):
            told.append(plan.folder)
            entries = [{"row": row(j)} for j in task.frames]
            for entry in (*entries, entries[0]):
                self.handler((0.0, {"entry": entry}))
            return Future(entries)

        def cancel(self, _futures):
            pass

        def unsubscribe_topic(self, _topic):
            pass

    cluster = Cluster(None, 2)
    monkeypatch.setattr(cluster, "_client", Client())
    tasks = [Task("frame", (0, 1)), Task("frame", (2, 3))]
    entries = list(cluster.run(plan_of("out", "token"), tasks))
    assert sorted(entry["row"]["frame"] for entry in entries) == [0, 1, 2, 3]
    assert set(told) == {str(Path.cwd() / "out")}


def test_only_unchanged_parts_of_a_container_are_taken_out_of_it(tmp_path, monkeypatch):
    """The others are baked again; so are all, where the container is too damaged to be divided."""
    scene = SimpleNamespace(
        job=SimpleNamespace(maps=("height",)), form=containers.formats.FORMATS["bin"]
    )
    parts = [b"first", b"second", b"third"]
    rows = [
        {"frame": 2 * i, "files": {"height": {"sha256": containers.digest(part)}}}
        for i, part in enumerate(parts)
    ]
    (tmp_path / "height.bin").write_bytes(b"whole")
    found = [parts[0], b"sEcond", parts[2]]
    monkeypatch.setattr(containers, "payloads_in", lambda *_: found)
    containers.unpack(tmp_path, scene, {"frames": rows})
    assert tree(tmp_path) == {
        "height.bin": b"whole",
        ".work/height/0000.part": b"first",
        ".work/height/0004.part": b"third",
    }

    def damaged(*_):
        raise IntegrityError("damaged")

    monkeypatch.setattr(containers, "payloads_in", damaged)
    containers.unpack(tmp_path / "none", scene, {"frames": rows})
    containers.unpack(tmp_path, scene, {"frames": rows})
    assert len(tree(tmp_path)) == 3
