"""
Worker process: tasks arrive through a pipe, and entries of finished steps leave through another.

The process is started with `python -c` and not by `multiprocessing`, so that it imports nothing of
the caller's program, which needs no `if __name__ == "__main__"`, and inherits no thread. It ends
with the process that started it.
"""

import contextlib
import os
import pickle
import queue
import signal
import sys
import threading
import traceback
import warnings
from typing import IO, Any

BOOT = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); from "
    "fftocean.baking.workers.process import serve; serve()"
)
"""Program of the process; the first message is its module search path."""


def serve() -> None:
    """
    Carry out each (plan, task) received; answer ("entry", entry) for each finished step, then
    ("done", None) or ("failed", error).
    """
    signal.signal(
        signal.SIGINT, signal.SIG_IGN
    )  # Ctrl-C reaches the whole group; the process with the lock decides
    _die_with_parent()
    incoming, outgoing = sys.stdin.buffer, os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # printed text must not mix with the answers
    warnings.simplefilter("ignore")  # the process that started this one has given them
    inbox: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(incoming, inbox), daemon=True).start()
    from fftocean.baking.scene.scene import work

    while True:
        plan, task = inbox.get()
        try:
            for entry in work(plan, task):
                _answer(outgoing, "entry", entry)
        except Exception as error:
            error.add_note("".join(traceback.format_exception(error)))
            _answer(outgoing, "failed", error)
        else:
            _answer(outgoing, "done", None)


def _receive(incoming: IO[bytes], inbox: "queue.SimpleQueue[Any]") -> None:
    """
    Put messages into the inbox; end the process at once when the pipe is closed, whatever it does.
    """
    with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError):
        while True:
            inbox.put(pickle.load(incoming))
    os._exit(0)


def _answer(outgoing: IO[bytes], kind: str, value: Any) -> None:
    """Send an answer; end the process if nobody can receive it."""
    try:
        pickle.dump((kind, value), outgoing)
        outgoing.flush()
    except OSError:
        os._exit(0)


def _die_with_parent() -> None:
    """On Linux, let this process be killed with its parent, so that it writes nothing later."""
    if sys.platform == "linux":
        import ctypes

        parent = os.getppid()
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
        if os.getppid() != parent:
            os._exit(0)
