"""
FFTW wisdom, the result of its measurements, in the user's cache.

There is one small file for each library, processor and shape. A file that is damaged, or comes from
another machine, is replaced, with a warning; if the folder cannot be written, nothing is kept. The
first process to measure a shape decides: others plan by its result, and so get the same bits.
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

MAX_BYTES = 2**20  # the wisdom of a hundred shapes is 30 kB


def folder() -> Path:
    """Return the user's cache: FFTOCEAN_CACHE, or the usual folder of the system."""
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
    Return a plan made with the wisdom in the cache, or measure, and keep the result there.

    The caller holds the lock of FFTW's planner, whose wisdom is empty.

    Args:
        pyfftw: the library.
        plan: makes a plan by the wisdom that FFTW has.
        shape: (count, n) of the rows to transform.
        dtype: "float32" or "float64".
        planning: planning effort.
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
    except RuntimeError:  # a user without a home folder
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
                made = plan()  # as the first process
    return made


@contextlib.contextmanager
def set_aside(pyfftw: ModuleType) -> Iterator[None]:
    """
    Empty FFTW's wisdom while the block runs, and restore it afterwards.

    Other code in the process can have measured, too.
    """
    known = pyfftw.export_wisdom()
    pyfftw.forget_wisdom()
    try:
        yield
    finally:
        pyfftw.import_wisdom(known)


def _learned(pyfftw: ModuleType, path: Path, key: dict[str, str], dtype: str) -> bool:
    """Read a file into FFTW; return False, with a warning, if it is not valid."""
    try:
        with path.open("rb") as file:
            tree = json.loads(file.read(MAX_BYTES))
        wise = tuple(base64.b64decode(part, validate=True) for part in tree["wisdom"])
        if tree["key"] != key or tree["sha256"] != _digest(wise) or len(wise) != 3:
            raise ValueError("it is damaged, or another machine's")
        if not pyfftw.import_wisdom(wise)[("float64", "float32").index(dtype)]:
            raise ValueError("FFTW does not know it")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        warnings.warn(
            f"{path} is not FFTW wisdom for this build and is ignored: {error}",
            CacheWarning,
            stacklevel=2,
        )
        return False
    return True


def _kept(pyfftw: ModuleType, path: Path, key: dict[str, str]) -> bool:
    """Write FFTW's wisdom, whole or not at all; return False if another process was first."""
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
            path.hardlink_to(temporary)  # fails if the file exists
        except FileExistsError:
            return False
        except OSError:  # a file system without links
            Path(temporary).replace(path)
    finally:
        Path(temporary).unlink(missing_ok=True)
    return True


def _digest(wise: tuple[bytes, ...]) -> str:
    return hashlib.sha256(b"\0".join(wise)).hexdigest()
