"""
What FFTW has found out by measuring, kept in the user's cache: one small file for each library, processor and shape.

A file that is cut, bent, or another machine's is left alone with a note; so is a folder that cannot be written. The first process
that has measured a shape decides: others plan by what it found, and so get the same bits.
"""

import base64
import contextlib
import hashlib
import json
import os
import platform
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from fftocean.errors import CacheWarning

MAX_BYTES = 2**20  # what FFTW knows of a hundred shapes is 30 kB


def folder() -> Path:
    """The user's cache: FFTOCEAN_CACHE, or where the system keeps such things."""
    if chosen := os.environ.get("FFTOCEAN_CACHE"):
        return Path(chosen)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or tempfile.gettempdir()) / "fftocean"
    if sys.platform == "darwin":
        return Path("~/Library/Caches/fftocean").expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "fftocean"


def planned(pyfftw: ModuleType, plan: Callable[[], Any], shape: tuple[int, int], dtype: str, planning: str) -> Any:
    """
    Call `plan` with what is known of it, or find it out and keep it. The caller holds FFTW's planner.

    Args:
        pyfftw: the library.
        plan: makes a plan, in whatever way FFTW now thinks is the fastest.
        shape, dtype, planning: what it is for.
    """
    key = {
        "library": f"{pyfftw.fftw_version} {pyfftw.__version__}",
        "processor": _processor(),
        "transform": f"{shape[0]} x {shape[1]} {dtype} {planning}",
    }
    name = hashlib.sha256(json.dumps(key).encode()).hexdigest()[:24]
    with contextlib.suppress(OSError, RuntimeError):  # RuntimeError: no home
        path = folder() / "wisdom" / f"{name}.json"
        if path.is_file():
            if _learned(pyfftw, path, key):
                return plan()
            with contextlib.suppress(OSError):
                path.unlink()
    made = plan()
    with contextlib.suppress(OSError, RuntimeError):
        if not _kept(pyfftw, path, key) and _learned(pyfftw, path, key):
            made = plan()  # as the one who was first
    return made


def _learned(pyfftw: ModuleType, path: Path, key: dict[str, str]) -> bool:
    """Read a file into FFTW, and say whether it was what it should be."""
    try:
        with path.open("rb") as file:
            tree = json.loads(file.read(MAX_BYTES))
        wise = tuple(base64.b64decode(part, validate=True) for part in tree["wisdom"])
        if tree["key"] != key or tree["sha256"] != _digest(wise) or len(wise) != 3:
            raise ValueError("it is cut, bent, or another machine's")
        pyfftw.forget_wisdom()  # what this process has measured so far would else decide
        if not any(pyfftw.import_wisdom(wise)):
            raise ValueError("FFTW does not know it")
    except (ValueError, KeyError, TypeError) as error:
        warnings.warn(f"{path} is no wisdom of this FFTW and is ignored: {error}", CacheWarning, stacklevel=2)
        return False
    return True


def _kept(pyfftw: ModuleType, path: Path, key: dict[str, str]) -> bool:
    """Write what FFTW knows, whole or not at all; False where another process was first."""
    wise = pyfftw.export_wisdom()
    tree = {"key": key, "sha256": _digest(wise), "wisdom": [base64.b64encode(part).decode() for part in wise]}
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent)
    try:
        with open(handle, "w", encoding="utf-8") as file:  # noqa: PTH123 - a descriptor, not a path
            file.write(json.dumps(tree))
        try:
            Path(path).hardlink_to(temporary)  # refuses where there is one
        except FileExistsError:
            return False
    finally:
        Path(temporary).unlink()
    return True


def _digest(wise: tuple[bytes, ...]) -> str:
    return hashlib.sha256(b"\0".join(wise)).hexdigest()


def _processor() -> str:
    """The processor's model: what is fast on one may be slow on another."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
