"""
Forks beside other threads: they wait for what was begun, at most for so long, and the child
computes on.
"""

import os
import signal
import subprocess
import sys
import threading

import pytest

from fftocean import forks

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this platform"),
    pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning"),
]


def forked(child):
    """
    The exit code of a child that does something, and is killed by the system's own clock if it
    hangs.
    """
    pid = os.fork()
    if pid == 0:
        signal.alarm(60)
        code = 99
        try:
            code = child()
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def test_a_fork_waits_for_work_that_was_begun():
    begun, left, timer = threading.Event(), [], threading.Event()

    def work():
        with forks.no_fork(), forks.no_fork():  # a block within a block does not wait for itself
            begun.set()
            timer.wait(0.3)
            left.append(True)

    worker = threading.Thread(target=work)
    worker.start()
    begun.wait()
    assert forked(lambda: 0 if left else 1) == 0
    worker.join()

    def again():
        with forks.no_fork():
            return 7

    assert forked(again) == 7
    with forks.no_fork():  # nor does a fork wait for the thread that forks
        assert forked(again) == 7


def test_a_fork_does_not_wait_for_ever(monkeypatch):
    monkeypatch.setattr(forks, "PATIENCE", 0.2)
    begun, end = threading.Event(), threading.Event()

    def work():
        with forks.no_fork():
            begun.set()
            end.wait(60)

    worker = threading.Thread(target=work)
    worker.start()
    begun.wait()
    assert forked(lambda: 3) == 3
    assert not end.is_set()
    end.set()
    worker.join()
    with forks.no_fork():  # the parent's own work goes on
        pass


def test_a_guarded_lock_is_free_in_the_child_and_in_the_parent(monkeypatch):
    lock = threading.Lock()
    monkeypatch.setattr(forks, "_guarded", [lock])
    begun = threading.Event()

    def work():
        with lock:
            begun.set()
            threading.Event().wait(0.3)

    worker = threading.Thread(target=work)
    worker.start()
    begun.wait()
    assert forked(lambda: 0 if lock.acquire(blocking=False) else 1) == 0
    assert not lock.locked()
    worker.join()


SCRIPT = """
import os, signal, sys, threading, time, warnings
import fftocean as fo
warnings.simplefilter("ignore")
sea = fo.Sea(fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=6.0)))
fo.Ocean(sea, n=8, size=60.0).frame(0.0)
going = True

def make():
    i = 0
    while going:
        i += 1
        dtype = ("float32", "float64")[i % 2]
        ocean = fo.Ocean(sea, n=12 + 2 * (i % 7), size=60.0, seed=i, threads=1 + i % 2, dtype=dtype)
        ocean.frame(0.0)

threads = [threading.Thread(target=make) for _ in range(2)]
for thread in threads:
    thread.start()
codes = []
for i in range(20):
    time.sleep(0.002)
    pid = os.fork()
    if pid == 0:
        signal.alarm(60)
        frame = fo.Ocean(sea, n=16, size=60.0, seed=i, threads=2).frame(1.0)
        os._exit(0 if abs(frame.height).max() > 0.0 else 1)
    codes.append(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))
    if codes[-1]:
        break
going = False
for thread in threads:
    thread.join()
print(codes)
"""


def test_a_child_makes_oceans_though_other_threads_were_making_some():
    """
    Two of eleven such forks hung while plans were made and destroyed; each child ends itself by an
    alarm, and the script by a limit.
    """
    ran = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=300, check=False
    )
    assert ran.stdout.strip() == str([0] * 20), ran.stderr[-2000:]


def test_locks_are_renewed_in_the_child_only(monkeypatch):
    """A lock that the parent holds while it forks is free in the child, and still held here."""
    holder = {"lock": threading.Lock()}
    monkeypatch.setattr(forks, "_renewals", [])
    forks.in_child(lambda: holder.update(lock=threading.Lock()))
    held = holder["lock"]
    with held:
        assert forked(lambda: 0 if holder["lock"].acquire(timeout=1.0) else 1) == 0
        assert holder["lock"] is held


def test_a_child_is_not_the_process_that_made_an_object():
    process = forks.Process()
    assert process.is_current
    pid = os.fork()
    if not pid:
        os._exit(17 if process.is_current else 0)
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 0
