"""
Forks while other threads compute.

A forked child has only the thread that forked. The work of other threads is left unfinished: a plan
half made, a lock that is never released. So a fork waits until no thread makes an ocean or computes
a frame, and takes the locks of the libraries that plan and compile; then the child can make oceans
and frames of its own. It waits for `PATIENCE` seconds at most, so a fork never hangs; a child
forked after a longer wait can hang. So can one forked during an import in another thread, which
Python itself does not survive: import the package and make a first ocean before.
"""

import contextlib
import os
import threading
import time
from collections.abc import Callable, Iterator
from typing import Protocol

PATIENCE = 30.0
"""The longest that a fork waits for the work of other threads [s]."""


class Lock(Protocol):
    """A lock that can be waited for."""

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take the lock, or return False after `timeout` seconds."""

    def release(self) -> None:
        """Release the lock."""


class _Gate:
    """Number of threads at work, and a flag that makes others wait."""

    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.working = 0
        self.closed = False
        self.own = threading.local()  # depth of the blocks of the thread itself


_gate = _Gate()
_guarded: list[Lock] = []
_taken: list[Lock] = []
_renewals: list[Callable[[], None]] = []


def guard(lock: Lock) -> None:
    """Make each fork take a lock of a library, so that it is free in the child."""
    _guarded.append(lock)


def in_child(renew: Callable[[], None]) -> None:
    """Call a function in each forked child, to replace locks whose threads do not exist there."""
    _renewals.append(renew)


class Process:
    """
    The process that made an object.

    A forked child inherits the object without the threads behind it, so it makes those anew.
    """

    __slots__ = ("_number",)

    def __init__(self) -> None:
        self._number = os.getpid()

    @property
    def is_current(self) -> bool:
        """True in the process that made the object; False in its forked children."""
        return self._number == os.getpid()


@contextlib.contextmanager
def no_fork() -> Iterator[None]:
    """
    Make forks of other threads wait while the block runs; blocks can be nested.
    """
    gate = _gate
    depth = getattr(gate.own, "depth", 0)
    if not depth:
        with gate.changed:
            while gate.closed:
                gate.changed.wait()
            gate.working += 1
    gate.own.depth = depth + 1
    try:
        yield
    finally:
        gate.own.depth = depth
        if not depth:
            with gate.changed:
                gate.working -= 1
                gate.changed.notify_all()


def _before() -> None:
    gate, until = _gate, time.monotonic() + PATIENCE
    own = 1 if getattr(gate.own, "depth", 0) else 0
    with gate.changed:
        gate.closed = True
        gate.changed.wait_for(lambda: gate.working <= own, PATIENCE)
    for lock in _guarded:
        if lock.acquire(timeout=max(until - time.monotonic(), 0.1)):
            _taken.append(lock)


def _in_parent() -> None:
    while _taken:
        _taken.pop().release()
    with _gate.changed:
        _gate.closed = False
        _gate.changed.notify_all()


def _in_child() -> None:
    global _gate
    while _taken:
        _taken.pop().release()
    _gate = _Gate()  # the child has no other thread
    for renew in _renewals:
        renew()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_before, after_in_parent=_in_parent, after_in_child=_in_child)
