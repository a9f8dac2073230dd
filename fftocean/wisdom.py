"""
What FFTW has found out by measuring, kept in the user's cache: one small file for each library,
processor and shape.

A file that is cut, bent, or another machine's is replaced, with a note; a folder that cannot be
written is done without. The first process that has measured a shape decides: others plan by what it
found, and so get the same bits.
"""

import base64
import contextlib
import hashlib
import json
import os
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from fftocean.errors import CacheWarning
from fftocean.host import processor

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


def planned(
    pyfftw: ModuleType, plan: Callable[[], Any], shape: tuple[int, int], dtype: str, planning: str
) -> Any:
    """
    Call `plan` with what is known of it, or find it out and keep it. The caller holds FFTW's
    planner, which knows nothing else.

    Args:
        pyfftw: the library.
        plan: makes a plan, in whatever way FFTW now thinks is the fastest.
        shape, dtype, planning: what it is for.
    """
    key = {
        "library": f"{pyfftw.fftw_version} {pyfftw.__version__}",
        "processor": processor(),  # what is fast on one may be slow on another
        "transform": f"{shape[0]} x {shape[1]} {dtype} {planning}",
    }
    try:
        path = (
            folder()
            / "wisdom"
            / f"{hashlib.sha256(json.dumps(key).encode()).hexdigest()[:24]}.json"
        )
    except RuntimeError:  # a user without a home
        return plan()
    with contextlib.suppress(OSError):
        if path.is_file():
            if _learned(pyfftw, path, key, dtype):
                return plan()
            path.unlink()
    made = plan()
    with contextlib.suppress(OSError):
        if not _kept(pyfftw, path, key) and path.is_file():
            pyfftw.forget_wisdom()
            if _learned(pyfftw, path, key, dtype):
                made = plan()  # as the one who was first
    return made


@contextlib.contextmanager
def set_aside(pyfftw: ModuleType) -> Iterator[None]:
    """
    Plan without what this process, or whoever else uses FFTW in it, has measured so far; afterwards
    it is known again.
    """
    known = pyfftw.export_wisdom()
    pyfftw.forget_wisdom()
    try:
        yield
    finally:
        pyfftw.import_wisdom(known)


def _learned(pyfftw: ModuleType, path: Path, key: dict[str, str], dtype: str) -> bool:
    """Read a file into FFTW, and say whether it was what it should be."""
    try:
        with path.open("rb") as file:
            tree = json.loads(file.read(MAX_BYTES))
        wise = tuple(base64.b64decode(part, validate=True) for part in tree["wisdom"])
        if tree["key"] != key or tree["sha256"] != _digest(wise) or len(wise) != 3:
            raise ValueError("it is cut, bent, or another machine's")
        if not pyfftw.import_wisdom(wise)[("float64", "float32").index(dtype)]:
            raise ValueError("FFTW does not know it")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        warnings.warn(
            f"{path} is no wisdom of this FFTW and is ignored: {error}", CacheWarning, stacklevel=2
        )
        return False
    return True


def _kept(pyfftw: ModuleType, path: Path, key: dict[str, str]) -> bool:
    """Write what FFTW knows, whole or not at all; False where another process was first."""
    wise = pyfftw.export_wisdom()
    tree = {
        "key": key,
        "sha256": _digest(wise),
        "wisdom": [base64.b64encode(part).decode() for part in wise],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent)
    try:
        with open(handle, "w", encoding="utf-8") as file:  # noqa: PTH123 - a descriptor, not a path
            file.write(json.dumps(tree))
        try:
            path.hardlink_to(temporary)  # refuses where there is one
        except FileExistsError:
            return False
        except OSError:  # a file system without links
            Path(temporary).replace(path)
    finally:
        Path(temporary).unlink(missing_ok=True)
    return True


def _digest(wise: tuple[bytes, ...]) -> str:
    return hashlib.sha256(b"\0".join(wise)).hexdigest()
