"""
Things that only a fresh process shows: what it takes to start, and how much memory it comes to.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fftocean

CACHES = (
    "NUMBA_CACHE_DIR",
    "XDG_CACHE_HOME",
    "LOCALAPPDATA",
)  # where kernels and wisdom may be kept from one process to the next
PACKAGE_HOME = str(Path(fftocean.__file__).resolve().parents[1])


@dataclass(frozen=True, slots=True)
class Run:
    """
    One process: how long it lived and how much of the processor it used [s], and what it printed
    last, as JSON.
    """

    wall: float
    cpu: float
    said: Any


def python(*arguments: str, cache: Path | None = None) -> Run:
    """
    Run the interpreter anew, with the package that this process uses.

    Args:
        arguments: of the interpreter, such as "-c" and a program.
        cache: a folder for all that is kept between processes; None for the user's own.

    Raises:
        RuntimeError: the process failed; what it said is in the message.
    """
    paths = [PACKAGE_HOME, *filter(None, [os.environ.get("PYTHONPATH")])]
    kept = {} if cache is None else {name: str(cache) for name in CACHES}
    start, used = time.perf_counter(), children_cpu()
    done = subprocess.run(
        [sys.executable, *arguments],
        env={**os.environ, **kept, "PYTHONPATH": os.pathsep.join(paths)},
        capture_output=True,
        text=True,
        check=False,
    )
    wall, cpu = time.perf_counter() - start, children_cpu() - used
    if done.returncode:
        raise RuntimeError(
            f"python {' '.join(arguments):.80} failed with {done.returncode}: {done.stderr.strip()[-800:]}"
        )
    return Run(wall, cpu, last_json(done.stdout))


def children_cpu() -> float:
    """Processor time of all processes that this one has started and seen end [s]."""
    times = os.times()
    return times.children_user + times.children_system


def last_json(text: str) -> Any:
    """The last line of a text, where it is JSON; else None."""
    lines: Sequence[str] = text.strip().splitlines()
    try:
        return json.loads(lines[-1]) if lines else None
    except ValueError:
        return None
