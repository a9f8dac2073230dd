"""Executors: the same bytes from one process, several, or a cluster, even when workers die."""

import contextlib
import os
import pickle
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import builders
import pytest
from builders import environment, tree

import fftocean as fo
from fftocean.baking.folder.lock import locked
from fftocean.baking.folder.plan import Plan, Task, frames_of, tasks_of
from fftocean.baking.scene import scene as scenes
from fftocean.baking.workers import choice, cluster, local
from fftocean.baking.workers.choice import check_executor, choose_executor
from fftocean.baking.workers.local import ATTEMPTS, Processes
from fftocean.errors import FolderInUseError, JobError, OutputError
from fftocean.host import cores

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
PATIENCE = 600.0
"""Seconds that a test waits for what must happen, however busy the machine is."""


def job(**changes):
    """
    A small job that needs all that a worker may need: foam from a survey, and several spans of it.
    """
    small = {
        "ocean.n": 16,
        "bake.frames": 20,
        "bake.maps": ["height", "foam"],
        "bake.pictures": ["tiling"],
    }
    return builders.job(small, **changes)


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """
    The bytes of a bake by this process alone, in a format that has to know its ranges beforehand.
    """
    folder = tmp_path_factory.mktemp("serial") / "out"
    fo.bake(job(bake__format="png16"), folder, executor="serial")
    return tree(folder)


def test_processes_write_the_same_bytes(expected, tmp_path):
    events = []
    fo.bake(
        job(bake__format="png16"),
        tmp_path / "out",
        executor="processes",
        workers=2,
        listen=events.append,
    )
    assert tree(tmp_path / "out") == expected
    assert (events[0]["executor"], events[0]["workers"]) == ("processes", 2)
    assert sorted(e["frame"] for e in events if e["event"] == "frame") == list(range(20))


def test_a_program_without_a_guard_may_bake_with_processes(expected, tmp_path):
    """No `if __name__ == "__main__"`: a worker imports nothing of the program that started it."""
    program = (
        "import fftocean as fo\njob = fo.Job.default().replaced({'ocean.n': 16, "
        "'bake.frames': 20, 'bake.maps': ['height', 'foam'], "
    )
    program += (
        "'bake.pictures': ['tiling'], 'bake.format': 'png16'})\nfo.bake(job, 'out', "
        "executor='processes', workers=2)\n"
    )
    (tmp_path / "program.py").write_text(program)
    done = subprocess.run(
        [sys.executable, "program.py"],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert tree(tmp_path / "out") == expected


def test_a_worker_that_is_killed_is_replaced(expected, tmp_path, monkeypatch):
    """
    kill -9, each of the first two workers once, in the middle of its work: the bake goes on, to the
    same bytes.
    """
    killed, started = [], []
    real = local._Worker.__init__
    monkeypatch.setattr(
        local._Worker, "__init__", lambda self, *a: real(self, *a) or started.append(self)
    )

    def listen(event):
        if event["event"] == "frame" and len(killed) < 2 and event["done"] in (3, 9):
            killed.append(started[len(killed)].process)
            killed[-1].kill()
            torn = (
                tmp_path / f"out/height/.0003.png.{killed[-1].pid}-0a.tmp"
            )  # what it may leave, and here always leaves
            torn.write_bytes(b"half")

    fo.bake(
        job(bake__format="png16"), tmp_path / "out", executor="processes", workers=2, listen=listen
    )
    assert tree(tmp_path / "out") == expected
    assert len(killed) == 2
    assert len(started) == 4


DOOMED = (
    "import os, pickle, sys; pickle.load(sys.stdin.buffer); pickle.load(sys.stdin.buffer); "
    "os._exit(3)"
)


def test_work_that_kills_its_workers_is_given_up(tmp_path, monkeypatch):
    """Not begun for ever: an error that names the frames, and the exit code."""
    monkeypatch.setattr(local.worker_process, "BOOT", DOOMED)
    with pytest.raises(
        OutputError,
        match=rf"frame 0 to 15 could not be baked: {ATTEMPTS} workers died while baking it, "
        rf"the last with exit code 3",
    ):
        fo.bake(job(bake__maps=["foam"]), tmp_path / "out", executor="processes", workers=1)
    assert not (tmp_path / "out/manifest.json").exists()
    assert not (tmp_path / "out/.lock").exists()


def test_an_error_of_a_worker_is_that_of_the_bake(tmp_path):
    """Its kind, its words and its exit code; no worker is left."""
    tide = {"kind": "tabulated", "frequency": [5e-6, 1e-5, 2e-5], "density": [0.0, 7e7, 0.0]}
    film = {
        "sea": {"depth": 160.0, "systems": [{"spectrum": tide}]},
        "ocean": {"n": 8, "size": 4e6},
        "bake": {"frames": 4, "maps": ["displacement"]},
    }
    with pytest.raises(
        OutputError, match=r"displacement/000\d\.exr could not be encoded: values must stay within"
    ) as caught:
        fo.bake(fo.Job.from_tree(film), tmp_path / "out", executor="processes", workers=2)
    assert caught.value.exit_code == 4
    assert not list(tmp_path.rglob("*.tmp"))


def wait_for(condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def children(pid):
    """The processes that a process has started."""
    return [int(p.parent.name) for p in Path("/proc").glob("[0-9]*/stat") if _parent(p) == pid]


def _parent(path):
    try:
        return int(path.read_text().rpartition(")")[2].split()[1])
    except (OSError, IndexError, ValueError):
        return -1


def alive(pid):
    """Return True if a process exists and is not a zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in ("Z", "X")
    except OSError:
        return False


@pytest.mark.skipif(
    not Path("/proc/self/stat").exists(), reason="looks at processes as Linux shows them"
)
@pytest.mark.parametrize(
    "number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL], ids=lambda n: n.name
)
def test_workers_end_with_the_bake(tmp_path, number):
    """
    However it ends, and at once: else they would go on writing into a folder that is nobody's.
    """
    program = (
        "import signal, sys; from fftocean.cli import main; signal.signal(signal.SIGINT, "
        "signal.default_int_handler); "
    )
    program += (
        "sys.exit(main(['bake', '-o', 'out', '--n', '64', '--frames', '50000', '--maps', "
        "'height', '--executor', 'processes', "
    )
    program += "'--workers', '2']))"
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment(),
        stderr=subprocess.PIPE,
        text=True,
    )
    wait_for(
        lambda: len(list(tmp_path.glob("out/height/*.exr"))) >= 4 or process.poll() is not None
    )
    wait_for(lambda: len(children(process.pid)) == 2 or process.poll() is not None)
    workers = children(process.pid)
    assert len(workers) == 2
    for pid in workers:  # they hold the folder with it
        assert str(tmp_path / "out/.lock") in {
            os.path.realpath(link) for link in Path(f"/proc/{pid}/fd").iterdir()
        }
    process.send_signal(number)
    _, err = process.communicate(timeout=PATIENCE)
    assert (
        process.returncode == {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}[number]
    )
    wait_for(lambda: not [pid for pid in workers if alive(pid)])
    written = set(tmp_path.rglob("*"))
    time.sleep(0.3)  # a worker that went on would write some frames
    assert set(tmp_path.rglob("*")) == written
    if number != signal.SIGKILL:
        assert not list(tmp_path.rglob("*.tmp"))
        assert "of 50000 frames are finished; run the same command again to resume" in err


def test_a_worker_ends_when_its_bake_is_gone():
    """
    A worker that the system does not end stops at the end of its input, in the middle of a task.
    """
    process = subprocess.Popen(
        [sys.executable, "-P", "-c", local.worker_process.BOOT],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=environment(),
    )
    pickle.dump(sys.path, process.stdin)
    process.stdin.flush()
    out, _ = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out) == (0, b"")


# Dask


def test_a_cluster_of_one_s_own_writes_the_same_bytes(expected, tmp_path):
    """With a worker killed in mid-bake, which loses what it was doing."""
    pytest.importorskip("distributed")
    killed = []

    def listen(event):
        if event["event"] == "frame" and event["done"] >= 3 and not killed:
            killed.extend([pid for pid in children(os.getpid()) if b"spawn_main" in line(pid)][:1])
            for pid in killed:
                os.kill(pid, signal.SIGKILL)

    fo.bake(job(bake__format="png16"), tmp_path / "out", executor="dask", workers=2, listen=listen)
    assert len(killed) == 1
    assert tree(tmp_path / "out") == expected


def test_a_cluster_takes_no_port_that_another_may_have(tmp_path, monkeypatch):
    """
    Dask serves HTTP on port 8787 of all interfaces, with or without a dashboard: here on any port
    of this machine alone.
    """
    distributed = pytest.importorskip("distributed")
    real, bound = distributed.Scheduler.start_http_server, []

    def start(self, *arguments, **more):
        real(self, *arguments, **more)
        bound.append((self.http_server.address, self.http_server.port))

    monkeypatch.setattr(distributed.Scheduler, "start_http_server", start)
    with socket.socket() as taken:  # whether by us or by somebody else
        with contextlib.suppress(OSError):
            taken.bind(("", 8787))
            taken.listen()
        fo.bake(job(bake__frames=2), tmp_path / "out", executor="dask", workers=1)
    [(address, port)] = bound
    assert address == "127.0.0.1"
    assert port != 8787


def test_a_script_without_a_guard_is_told_so_by_dask(tmp_path):
    """One line says what to do; a worker that imports the script does not bake, too."""
    pytest.importorskip("distributed")
    program = (
        "import fftocean as fo\njob = fo.Job.default().replaced({'ocean.n': 16, "
        "'bake.frames': 4, 'bake.pictures': []})\n"
    )
    program += "fo.bake(job, 'out', executor='dask', workers=1)\n"
    (tmp_path / "program.py").write_text(program)
    done = subprocess.run(
        [sys.executable, "program.py"],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert done.returncode == 1
    *_, last = done.stderr.strip().splitlines()
    assert last.startswith(
        "fftocean.errors.JobError: the workers of a local Dask cluster did not start: each worker"
    )
    assert "if __name__ == '__main__':" in last
    assert done.stderr.count("Traceback") == 1
    assert not (tmp_path / "out/manifest.json").exists()
    (tmp_path / "program.py").write_text(
        program.replace("fo.bake", "if __name__ == '__main__': fo.bake")
    )
    done = subprocess.run(
        [sys.executable, "program.py"],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/manifest.json").exists()


def line(pid):
    """Return the command line of a process."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


def test_a_scheduler_s_workers_write_the_same_bytes(expected, tmp_path, monkeypatch):
    """
    By its address; they live in another folder, so that what is relative here must be absolute
    there.
    """
    distributed = pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    with distributed.LocalCluster(
        n_workers=1,
        threads_per_worker=2,
        processes=False,
        dashboard_address=None,
        scheduler_kwargs=cluster.NO_DASHBOARD,
        protocol="tcp://",
        host="127.0.0.1",
        silence_logs=50,
    ) as running:
        manifest = fo.bake(job(bake__format="png16"), "out", executor=running.scheduler_address)
        assert manifest["maps"]["height"]["format"] == "png16"
        assert running.workers  # not ours to stop
    assert tree(tmp_path / "out") == expected


def test_a_scheduler_that_is_not_there_is_an_output_error(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "PATIENCE", 0.3)
    with pytest.raises(OutputError, match=r"tcp://127\.0\.0\.1:9 could not be reached"):
        fo.bake(job(), tmp_path / "out", executor="tcp://127.0.0.1:9")
    assert not (tmp_path / "out/.lock").exists()


def test_without_dask_its_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster.util, "find_spec", lambda _: None)
    for name in ("dask", "tcp://127.0.0.1:1"):
        with pytest.raises(
            JobError, match=r"distributed: in a checkout of fftocean, pip install '\.\[dist\]'"
        ):
            fo.bake(job(), tmp_path / "out", executor=name)
    assert not (tmp_path / "out").exists()


# What a worker is asked, and what it refuses


def plan_of(folder, token, **changes):
    """Return a plan as a bake makes it."""
    from fftocean.baking.folder.identity import header_of

    sea_job = job(bake__maps=["height"], **changes)
    header = header_of(
        sea_job, frames=range(sea_job.frames), downsample=1, backend=sea_job.ocean().backend
    )
    return Plan(sea_job, 1, header, tuple(range(sea_job.frames)), str(folder), token)


def test_a_task_may_be_done_again_by_anybody(tmp_path):
    """The same entries, the same files; a plan arrives as it was sent."""
    with locked(tmp_path) as hold:
        plan = plan_of(tmp_path, hold.token)
        first = list(scenes.work(plan, Task("frame", (3, 4))))
        before = tree(tmp_path)
        scenes.clear_scene()
        assert list(scenes.work(pickle.loads(pickle.dumps(plan)), Task("frame", (3, 4)))) == first
        assert tree(tmp_path) == before
        threads = [
            threading.Thread(target=lambda: list(scenes.work(plan, Task("frame", (3, 4)))))
            for _ in range(3)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert tree(tmp_path) == before
    scenes.clear_scene()


def test_threads_do_not_share_a_scene(tmp_path):
    """A scene reuses its frame: two threads with one would write each other's pictures."""
    with locked(tmp_path) as hold:
        plan, seen = plan_of(tmp_path, hold.token), []
        threads = [
            threading.Thread(target=lambda: seen.append(scenes.scene_of(plan))) for _ in range(2)
        ]
        for thread in threads:
            thread.start()
            thread.join()
        assert seen[0] is not seen[1]
        assert scenes.scene_of(plan) is scenes.scene_of(plan)
    scenes.clear_scene()


def test_a_worker_of_a_bake_that_was_given_up_writes_no_more(tmp_path):
    with locked(tmp_path) as hold:
        plan = plan_of(tmp_path, hold.token)
    with pytest.raises(FolderInUseError, match="not held by this bake any more"):
        list(scenes.work(plan, Task("frame", (0,))))
    with locked(tmp_path), pytest.raises(FolderInUseError, match="not held by this bake any more"):
        list(scenes.work(plan, Task("frame", (0,))))
    assert not tree(tmp_path)
    scenes.clear_scene()


def test_a_worker_with_other_libraries_refuses(tmp_path, monkeypatch):
    """Its files would have other bytes; the message names the library."""
    with locked(tmp_path) as hold:
        plan = plan_of(tmp_path, hold.token)
        scenes.clear_scene()
        monkeypatch.setattr("fftocean.baking.folder.identity.library", lambda _: "FFTW 9.9")
        with pytest.raises(
            OutputError,
            match=r"a worker would not write the same bytes \(made_with\.fft: .* there, FFTW "
            r"9\.9 here\)",
        ):
            list(scenes.work(plan, Task("frame", (0,))))
    scenes.clear_scene()


# Shares


@pytest.mark.parametrize(
    ("chosen", "size", "shares"),
    [
        (range(5), 2, [(0, 1), (2, 3), (4,)]),
        (range(14, 35), 16, [(14, 15), tuple(range(16, 32)), (32, 33, 34)]),
        ([1, 30, 31, 33], 16, [(1,), (30, 31), (33,)]),
        ([], 16, []),
    ],
)
def test_tasks_stay_within_a_span(chosen, size, shares):
    """And hold each frame once."""
    assert [task.frames for task in tasks_of("frame", list(chosen), size)] == shares


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        (None, range(100)),
        ("0:64:2", range(0, 64, 2)),
        ("90:", range(90, 100)),
        (":3", range(3)),
        ("::50", [0, 50]),
        ("-2:", [98, 99]),
        ("99:100", [99]),
        (" 0 : 4 ", range(4)),
        ("95:1000", range(95, 100)),
    ],
)
def test_a_part_of_the_loop_is_a_slice(text, frames):
    assert tuple(frames_of(text, 100)) == tuple(frames)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "5",
        "a:b",
        "1:2:3:4",
        "0:0",
        "100:",
        "5:2",
        "::-1",
        "::0",
        "1.5:3",
        "0x1:3",
        ":" * 9,
        "9" * 5000 + ":",
    ],
)
def test_what_is_no_part_of_the_loop_is_refused(text):
    with pytest.raises(JobError, match=r"frames must .*got"):
        frames_of(text, 100)


@pytest.mark.parametrize("name", ["", "threads", "serially", "dusk"])
def test_an_executor_that_there_is_not_is_refused(name, tmp_path):
    with pytest.raises(
        JobError, match="executor must be one of auto, serial, processes, dask, or an address"
    ):
        fo.bake(job(), tmp_path / "out", executor=name)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("workers", [0, -1, 1025, 1.5, "2", True])
def test_workers_that_cannot_be_are_refused(workers):
    with pytest.raises(JobError, match="workers must be a whole number between 1 and 1024"):
        check_executor("processes", workers)


def test_as_many_workers_as_processors_and_memory_allow(monkeypatch):
    assert 1 <= cores() <= (os.cpu_count() or 1)
    from fftocean.baking.bake import choose_workers, scene_for

    scene = scene_for(job(ocean__n=64), 1, 1)
    assert choose_workers("processes", None, scene, 1000) == ("processes", cores())
    assert choose_workers("processes", 8, scene, 3) == ("processes", 3)  # no more than frames
    assert choose_workers("serial", 8, scene, 1000) == ("serial", 1)
    assert choose_workers("auto", 8, scene, 100)[0] == "serial"  # done before another had started
    assert choose_workers("auto", 8, scene, 100_000) == ("processes", 8)
    monkeypatch.setattr(
        "fftocean.baking.bake.available_memory",
        lambda: 2.5 * fo.ocean.memory_needed(scene.ocean.grid, "float32"),
    )
    assert choose_workers("processes", 8, scene, 1000) == ("processes", 2)
    monkeypatch.setattr("fftocean.baking.bake.available_memory", lambda: float("inf"))
    assert choose_workers("processes", 8, scene, 1000) == ("processes", 8)


def test_each_name_is_an_executor():
    assert choose_executor("serial", 3, -1).name == "serial"
    assert isinstance(choose_executor("processes", 3, -1), Processes)
    assert choose_executor("dask", 3, -1).name == "dask"
    assert choose_executor("tcp://127.0.0.1:8786", 3, -1).name == "dask"
    assert set(choice.EXECUTORS) == {"auto", "serial", "processes", "dask"}
