"""
Executors on this machine: this process alone, or several worker processes.

An executor carries out the tasks of a plan, and yields an entry for each finished step, in any
order. All executors write the same bytes. A failure is raised, and stops the other tasks.
"""

import contextlib
import os
import pickle
import queue
import subprocess
import sys
import threading
from collections.abc import Generator, Sequence
from types import TracebackType
from typing import Any, Protocol

from fftocean.baking.folder.journal import Entry
from fftocean.baking.folder.plan import Plan, Task
from fftocean.baking.workers import process as worker_process
from fftocean.errors import OutputError
from fftocean.host import cores

ATTEMPTS = 3
"""How often a task is begun; if all of its workers die, the task is taken for the cause."""

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)
"""Environment of a worker: one thread each, as there is a worker for each processor."""


class Executor(Protocol):
    """Workers that carry out tasks."""

    name: str
    workers: int

    def run(self, plan: Plan, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """Carry out all tasks, and yield every entry at least once."""

    def __enter__(self) -> "Executor":
        """Start the workers."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop the workers; once this returns, none of them writes."""


class Serial:
    """This process alone: one thread computes, the others encode and write."""

    name, workers = "serial", 1

    def run(self, plan: Plan, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """Carry out one task after the other."""
        from fftocean.baking.scene.scene import work

        for task in tasks:
            yield from work(plan, task, threads=cores())

    def __enter__(self) -> "Serial":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Do nothing: there is no worker to stop."""


class Processes:
    """
    Processes on this machine, each with one thread for FFT, encoder and kernels.

    A worker that dies is replaced, and its unfinished frames are given to another.
    """

    name = "processes"

    def __init__(self, workers: int, lock: int) -> None:
        self.workers = workers
        self._lock = lock
        self._answers: queue.SimpleQueue[tuple[_Worker, tuple[str, Any] | None]] = (
            queue.SimpleQueue()
        )
        self._workers: list[_Worker] = []

    def run(self, plan: Plan, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """Give each idle worker the next task; yield entries as they come."""
        todo = [(task, 1) for task in reversed(tasks)]
        # of each busy worker: its task, the attempt, and the frames that are finished
        busy: dict[_Worker, tuple[Task, int, set[int]]] = {}
        idle = list(self._workers)
        while todo or busy:
            while todo and (idle or len(self._workers) < min(self.workers, len(tasks))):
                worker = idle.pop() if idle else self._start()
                busy[worker] = (*todo.pop(), set())
                worker.send((plan, busy[worker][0]))
            worker, answer = self._next()
            if worker not in self._workers:
                continue
            if answer is None:
                self._workers.remove(worker)
                idle = [other for other in idle if other is not worker]
                code = worker.stop()
                if worker in busy:
                    task, attempt, done = busy.pop(worker)
                    todo += _remaining(task, attempt, done, code)
                continue
            kind, value = answer
            if kind == "failed":
                raise value
            if kind == "done":
                del busy[worker]
                idle.append(worker)
            else:
                yield value
                busy[worker][2].add(_frame_in(value))

    def _start(self) -> "_Worker":
        worker = _Worker(self._lock, self._answers)
        self._workers.append(worker)
        return worker

    def _next(self) -> "tuple[_Worker, tuple[str, Any] | None]":
        while True:  # in short waits: on Windows, Ctrl-C interrupts none
            with contextlib.suppress(queue.Empty):
                return self._answers.get(timeout=0.5)

    def __enter__(self) -> "Processes":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for worker in self._workers:
            worker.process.kill()
        while self._workers:
            self._workers.pop().stop()


def _remaining(task: Task, attempt: int, done: set[int], code: int) -> list[tuple[Task, int]]:
    """Return the unfinished part of a dead worker's task, with the number of its next attempt."""
    rest = (
        task
        if task.kind == "foam"
        else Task(task.kind, tuple(frame for frame in task.frames if frame not in done))
    )
    if not rest.frames:
        return []
    if len(rest.frames) < len(task.frames):
        attempt = 0  # frames were finished, so the task is not the cause
    if attempt >= ATTEMPTS:
        frames = f"frame {rest.frames[0]}" + (
            f" to {rest.frames[-1]}" if len(rest.frames) > 1 else ""
        )
        hint = "; fewer --workers need less memory" if code == -9 else ""
        raise OutputError(
            f"{frames} could not be baked: {ATTEMPTS} workers died while baking it, "
            f"the last with exit code {code}{hint}"
        )
    return [(rest, attempt + 1)]


def _frame_in(entry: Entry) -> int:
    """Return the frame of an entry; -1 for a span of foam."""
    return next((int(value["frame"]) for value in entry.values() if "frame" in value), -1)


class _Worker:
    """A worker process, and the thread that reads its answers."""

    def __init__(
        self, lock: int, answers: "queue.SimpleQueue[tuple[_Worker, tuple[str, Any] | None]]"
    ) -> None:
        kept = {"pass_fds": (lock,)} if os.name == "posix" else {}
        command = [sys.executable, "-P", "-c", worker_process.BOOT]
        try:
            self.process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env={**os.environ, **ONE_THREAD},
                **kept,  # type: ignore[call-overload]
            )
        except OSError as error:
            raise OutputError(
                f"a worker could not be started: {error.strerror or error}"
            ) from error
        self._reader = threading.Thread(target=self._read_loop, args=(answers,), daemon=True)
        self._reader.start()
        self.send(sys.path)

    def send(self, message: Any) -> None:
        """Send a message; a dead worker ignores it, and its end is read as an answer."""
        with contextlib.suppress(OSError):
            pickle.dump(message, self.process.stdin)
            self.process.stdin.flush()

    def _read_loop(
        self, answers: "queue.SimpleQueue[tuple[_Worker, tuple[str, Any] | None]]"
    ) -> None:
        with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError, ValueError):
            while True:
                answers.put((self, pickle.load(self.process.stdout)))
        answers.put((self, None))

    def stop(self) -> int:
        """End the process, and return its exit code; it writes nothing afterwards."""
        if self.process.poll() is None:
            self.process.kill()
        code: int = self.process.wait()
        self._reader.join()
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        self.process.stdout.close()
        return code
