"""The worker thread: one function after the other, results and errors to who waits, and its end."""

import asyncio
import threading

import pytest

from fftocean.view.worker import Worker


def test_results_and_errors_go_to_who_waits():
    """In the order in which they were asked for, and in another thread than the one that asks."""
    done = []

    def add(i):
        done.append(i)
        return i, threading.get_ident()

    def fail():
        raise KeyError("no such sea")

    async def ask(worker):
        first, other = await asyncio.gather(*(worker.run(lambda i=i: add(i)) for i in (1, 2)))
        with pytest.raises(KeyError, match="no such sea"):
            await worker.run(fail)
        return first, other, await worker.run(lambda: add(3))

    worker = Worker()
    results = asyncio.run(ask(worker))
    assert [i for i, _ in results] == done == [1, 2, 3]
    assert threading.get_ident() not in {thread for _, thread in results}
    assert worker.stop(60.0)


def test_a_worker_at_work_has_not_ended():
    """Nobody waits for it; its end comes after the function that runs."""
    begun, go = threading.Event(), threading.Event()

    async def ask(worker):
        task = asyncio.create_task(worker.run(lambda: begun.set() or go.wait(60.0)))
        while not begun.is_set():
            await asyncio.sleep(0.001)
        assert not worker.stop()
        go.set()
        assert await task
        assert worker.stop(60.0)

    asyncio.run(ask(Worker()))


def test_one_that_waits_no_more_is_left_out():
    """A cancelled future gets no result, and the next function runs all the same."""
    begun, go = threading.Event(), threading.Event()

    async def ask(worker):
        task = asyncio.create_task(worker.run(lambda: begun.set() or go.wait(60.0)))
        while not begun.is_set():
            await asyncio.sleep(0.001)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        go.set()
        assert await worker.run(lambda: 5) == 5
        assert worker.stop(60.0)

    asyncio.run(ask(Worker()))
