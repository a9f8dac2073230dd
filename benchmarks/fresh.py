"""Fresh processes: their time and their last line of output."""

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

# variables with the folders of compiled kernels and FFT plans
CACHES = ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA")
PACKAGE_HOME = str(Path(fftocean.__file__).resolve().parents[1])


@dataclass(frozen=True, slots=True)
class Run:
    """
    One process: elapsed and CPU time [s], and its last line of output, read as JSON.
    """

    wall: float
    cpu: float
    said: Any


def python(*arguments: str, cache: Path | None = None) -> Run:
    """
    Run a new interpreter with the package that this process uses.

    Args:
        arguments: of the interpreter, such as "-c" and a program.
        cache: a folder for all caches; None for the user's own.

    Raises:
        RuntimeError: the process failed; the message has its output.
    """
    paths = [PACKAGE_HOME, *filter(None, [os.environ.get("PYTHONPATH")])]
    kept = {} if cache is None else {name: str(cache) for name in CACHES}
    # modules are compiled once, as those of an installation are
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    start, used = time.perf_counter(), children_cpu()
    done = subprocess.run(
        [sys.executable, *arguments],
        env={**environment, **kept, "PYTHONPATH": os.pathsep.join(paths)},
        capture_output=True,
        text=True,
        check=False,
    )
    wall, cpu = time.perf_counter() - start, children_cpu() - used
    if done.returncode:
        raise RuntimeError(
            f"python {' '.join(arguments):.80} failed with {done.returncode}: "
            f"{done.stderr.strip()[-800:]}"
        )
    return Run(wall, cpu, last_json(done.stdout))


def children_cpu() -> float:
    """Return the CPU time of all child processes that have ended [s]."""
    times = os.times()
    return times.children_user + times.children_system


def last_json(text: str) -> Any:
    """Return the last line of a text, read as JSON; None if it is not JSON."""
    lines: Sequence[str] = text.strip().splitlines()
    try:
        return json.loads(lines[-1]) if lines else None
    except ValueError:
        return None
