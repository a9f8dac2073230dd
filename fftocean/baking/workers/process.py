"""
A worker process: tasks come in at one end of a pipe, what is finished goes out at the other.

It is started with `python -c` and not by `multiprocessing`, so that it imports nothing of the
caller's program, which needs no `if __name__ == "__main__"`, and inherits no thread. It ends with
whoever started it.
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

BOOT = "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); from fftocean.baking.workers.process import serve; serve()"
"""What the process is started with; the first thing it is sent is its search path."""


def serve() -> None:
    """
    Take (order, task)s; answer ("entry", entry) for each thing that is finished, then ("done",
    None) or ("failed", error).
    """
    signal.signal(
        signal.SIGINT, signal.SIG_IGN
    )  # Ctrl-C reaches the whole group; the one that holds the lock decides
    _die_with_parent()
    incoming, outgoing = sys.stdin.buffer, os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(
        sys.stderr.fileno(), sys.stdout.fileno()
    )  # whatever prints must not get between the answers
    warnings.simplefilter("ignore")  # they were said once, by the one that started us
    inbox: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(incoming, inbox), daemon=True).start()
    from fftocean.baking.scene.scene import work

    while True:
        order, task = inbox.get()
        try:
            for entry in work(order, task):
                _answer(outgoing, "entry", entry)
        except Exception as error:
            error.add_note("".join(traceback.format_exception(error)))
            _answer(outgoing, "failed", error)
        else:
            _answer(outgoing, "done", None)


def _listen(incoming: IO[bytes], inbox: "queue.SimpleQueue[Any]") -> None:
    """
    Pass on what comes in; where nothing can come any more, end at once, in the middle of whatever
    is being done.
    """
    with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError):
        while True:
            inbox.put(pickle.load(incoming))
    os._exit(0)


def _answer(outgoing: IO[bytes], word: str, value: Any) -> None:
    try:
        pickle.dump((word, value), outgoing)
        outgoing.flush()
    except OSError:  # nobody is left to hear it
        os._exit(0)


def _die_with_parent() -> None:
    """
    On Linux: be killed in the instant in which the parent is, so that nothing is written after it.
    """
    if sys.platform == "linux":
        import ctypes

        parent = os.getppid()
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
        if os.getppid() != parent:
            os._exit(0)
