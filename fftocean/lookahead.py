"""Frames computed on a thread of their own while the consumer uses the one before."""

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

from fftocean.forks import Process
from fftocean.frame import Frame
from fftocean.limits import AHEAD

Task = Callable[..., Frame]
"""Computes one frame; takes an earlier frame to overwrite, or None, as `out`."""


def run_in_order(tasks: Iterator[Task], ahead: int, reuse: bool) -> Iterator[Frame]:
    """
    Yield the frames of some tasks, in their order.

    Args:
        tasks: one for each frame; an endless iterator is fine.
        ahead: number of frames to compute before they are asked for; 0 starts no thread.
        reuse: overwrite the frames that the consumer has finished with.

    Raises:
        ParameterError: `ahead` out of range, at once; the errors of a task, and of the iterator
            itself, when the frame in question is due.
    """
    ahead = AHEAD.check("ahead", ahead)
    return _one_by_one(tasks, reuse) if ahead == 0 else _ahead(tasks, ahead, reuse)


def _one_by_one(tasks: Iterator[Task], reuse: bool) -> Iterator[Frame]:
    frame = None
    for task in tasks:
        frame = task(out=frame if reuse else None)
        yield frame


def _ahead(tasks: Iterator[Task], ahead: int, reuse: bool) -> Iterator[Frame]:
    finished: list[Frame] = []  # frames that the consumer no longer needs
    pending: deque[tuple[Task, Future[Frame] | None]] = deque()
    failure: BaseException | None = None
    process = Process()

    def next_frame() -> Frame:
        task, future = pending.popleft()
        # Not started, or started by a thread of the parent process, which a forked child lacks.
        if future is None or not process.is_current:
            return task()
        return future.result()

    def start(task: Task) -> Future[Frame] | None:
        if not process.is_current:
            return None
        try:
            return worker.submit(task, out=finished.pop() if finished else None)
        except RuntimeError:  # the interpreter is shutting down and starts nothing new
            return None

    with ThreadPoolExecutor(1, thread_name_prefix="fftocean-ahead") as worker:
        try:
            while failure is None:
                try:
                    task = next(tasks)
                except StopIteration:
                    break
                except Exception as error:  # of the iterator: raised after the frames before it
                    failure = error
                    break
                pending.append((task, start(task)))
                if len(pending) > ahead:
                    yield (frame := next_frame())
                    if reuse:
                        finished.append(frame)
            while pending:
                yield next_frame()
        finally:  # the consumer may stop early
            for _, future in pending:
                if future is not None:
                    future.cancel()
            if not process.is_current:
                worker.shutdown(wait=False)
    if failure is not None:
        raise failure
