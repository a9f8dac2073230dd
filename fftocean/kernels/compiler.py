"""
Compilation of the kernels, with a cache on disk.

A fault of the cache costs the time to compile, and is never an error.
"""

import contextlib
import hashlib
import io
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import numba as nb
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.compiler_lock import global_compiler_lock
from numba.core.runtime.nrt import rtsys

from fftocean import forks

# Else a child would wait for ever for a kernel that another thread was compiling.
forks.guard(global_compiler_lock._lock)

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """
    Compile a kernel at its first call; it runs without the GIL.

    Of fast-math only fused multiply-adds are allowed, if the processor has them. The machine code
    is kept where numba would keep it: beside the source or, if that is read-only, in the user's
    cache; without either, each process compiles anew. A file there is used only if its checksum is
    right.
    """
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
    kernel = nb.njit(**options)(function)
    # With numba switched off this is the plain function.
    if hasattr(kernel, "enable_caching"):
        with contextlib.suppress(RuntimeError, OSError):  # no place for a cache
            kernel._cache = _Cache(function)
    return kernel  # type: ignore[no-any-return]


class _Cache(FunctionCache):
    """The cache of one function, whose faults are not errors."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        file = self._cache_file
        self._cache_file = _Files(file._cache_path, self._impl.filename_base, file._source_stamp)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        # Numba's own first loads all that can be compiled, which takes longer than anything else
        # before the first frame. Machine code needs the symbols of numba's run-time library alone;
        # a compilation loads the rest itself.
        try:
            rtsys.initialize(target_context)
            with self._guard_against_spurious_io_errors():
                return self._load_overload(sig, target_context)
        except Exception:  # of a damaged or foreign file: as if there were none
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        # A full or read-only disk, or another process: the code is in memory and works.
        with contextlib.suppress(Exception):
            super().save_overload(sig, data)


class _Files(IndexDataCacheFile):
    """
    Index and data files that end with the SHA-256 of their contents.

    A flipped bit in machine code would crash, not raise.
    """

    def _load_index(self) -> Any:
        return super()._load_index() if _is_whole(self._index_path) else {}

    def _load_data(self, name: str) -> Any:
        if not _is_whole(self._data_path(name)):
            raise OSError(f"{name} is damaged")  # numba takes this for a missing file
        return super()._load_data(name)

    @contextlib.contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[io.BytesIO]:
        data = io.BytesIO()
        yield data
        with super()._open_for_write(filepath) as file:
            # A pickle is read up to its own end, so the digest is ignored.
            file.write(data.getvalue() + hashlib.sha256(data.getvalue()).digest())


def _is_whole(path: str) -> bool:
    """Return True if a file ends with the checksum of its contents."""
    try:
        data = Path(path).read_bytes()
    except OSError:
        return False
    return len(data) > 32 and hashlib.sha256(data[:-32]).digest() == data[-32:]
