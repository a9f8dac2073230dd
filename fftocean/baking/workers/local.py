"""
Who does the work: this process, several on this machine, or a Dask cluster. All do the same tasks,
and the bytes are the same.

A crew takes an order and tasks, and yields what is finished as it is finished, in any order; one
that fails raises, and what it was doing stops.
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

from fftocean.baking.folder.plan import Entry, Order, Task
from fftocean.baking.workers import process as worker
from fftocean.errors import OutputError

ATTEMPTS = 3
"""How often a task is begun before its dying workers are taken for its fault."""

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)
"""The environment of a worker: the parallelism is in their number."""


class Crew(Protocol):
    """Some workers, ready."""

    name: str
    workers: int

    def run(self, order: Order, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """Do all tasks, and yield every entry at least once."""

    def __enter__(self) -> "Crew":
        """Start them."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop them: when it returns, nothing is written any more."""


class Serial:
    """This process alone."""

    name, workers = "serial", 1

    def run(self, order: Order, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """One task after the other."""
        from fftocean.baking.scene.scene import work

        for task in tasks:
            yield from work(order, task)

    def __enter__(self) -> "Serial":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """There is nobody to stop."""


class Processes:
    """
    Processes on this machine, each with one thread for FFT, encoder and kernels.

    One that dies is replaced, and what it had not finished is given to another.
    """

    name = "processes"

    def __init__(self, workers: int, lock: int) -> None:
        self.workers = workers
        self._lock = lock
        self._answers: queue.SimpleQueue[tuple[_Hand, tuple[str, Any] | None]] = queue.SimpleQueue()
        self._hands: list[_Hand] = []

    def run(self, order: Order, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """Each free worker takes the next task."""
        todo = [(task, 1) for task in reversed(tasks)]
        busy: dict[
            _Hand, tuple[Task, int, set[int]]
        ] = {}  # what a worker is at, for the how-manieth time, and what of it is finished
        idle = list(self._hands)
        while todo or busy:
            while todo and (idle or len(self._hands) < min(self.workers, len(tasks))):
                hand = idle.pop() if idle else self._hire()
                busy[hand] = (*todo.pop(), set())
                hand.send((order, busy[hand][0]))
            hand, answer = self._next()
            if hand not in self._hands:
                continue
            if answer is None:
                self._hands.remove(hand)
                idle = [other for other in idle if other is not hand]
                code = hand.dismiss()
                if hand in busy:
                    task, attempt, done = busy.pop(hand)
                    todo += _again(task, attempt, done, code)
                continue
            word, value = answer
            if word == "failed":
                raise value
            if word == "done":
                del busy[hand]
                idle.append(hand)
            else:
                yield value
                busy[hand][2].add(_frame_in(value))

    def _hire(self) -> "_Hand":
        hand = _Hand(self._lock, self._answers)
        self._hands.append(hand)
        return hand

    def _next(self) -> "tuple[_Hand, tuple[str, Any] | None]":
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
        for hand in self._hands:
            hand.process.kill()
        while self._hands:
            self._hands.pop().dismiss()


def _again(task: Task, attempt: int, done: set[int], code: int) -> list[tuple[Task, int]]:
    """What a worker that died has left to do."""
    rest = (
        task
        if task.kind == "foam"
        else Task(task.kind, tuple(frame for frame in task.frames if frame not in done))
    )
    if not rest.frames:
        return []
    if len(rest.frames) < len(task.frames):
        attempt = 0  # it got on, so it is not this task that kills
    if attempt >= ATTEMPTS:
        frames = f"frame {rest.frames[0]}" + (
            f" to {rest.frames[-1]}" if len(rest.frames) > 1 else ""
        )
        hint = "; fewer --workers need less memory" if code == -9 else ""
        raise OutputError(
            f"{frames} could not be baked: {ATTEMPTS} workers died of it, the last with exit code {code}{hint}"
        )
    return [(rest, attempt + 1)]


def _frame_in(entry: Entry) -> int:
    """The frame that an entry is about; -1 for a span of foam."""
    return next((int(value["frame"]) for value in entry.values() if "frame" in value), -1)


class _Hand:
    """One worker process, and the thread that hears it."""

    def __init__(
        self, lock: int, answers: "queue.SimpleQueue[tuple[_Hand, tuple[str, Any] | None]]"
    ) -> None:
        kept = {"pass_fds": (lock,)} if os.name == "posix" else {}
        command = [sys.executable, "-P", "-c", worker.BOOT]
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
        self._ears = threading.Thread(target=self._hear, args=(answers,), daemon=True)
        self._ears.start()
        self.send(sys.path)

    def send(self, message: Any) -> None:
        """Give it something; where it is dead, its end is heard."""
        with contextlib.suppress(OSError):
            pickle.dump(message, self.process.stdin)
            self.process.stdin.flush()

    def _hear(self, answers: "queue.SimpleQueue[tuple[_Hand, tuple[str, Any] | None]]") -> None:
        with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError, ValueError):
            while True:
                answers.put((self, pickle.load(self.process.stdout)))
        answers.put((self, None))

    def dismiss(self) -> int:
        """End it, and return its exit code; afterwards it writes no more."""
        if self.process.poll() is None:
            self.process.kill()
        code: int = self.process.wait()
        self._ears.join()
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        self.process.stdout.close()
        return code
