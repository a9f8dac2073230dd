"""
How the kernels are compiled: once, cached on disk where that can be, and never failing for the sake
of a cache.
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

from fftocean import forks

forks.guard(
    global_compiler_lock._lock
)  # a child would wait for ever for what another thread was compiling

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """
    Compile a kernel at its first call, without the GIL. Of fast-math it may only fuse
    multiply-adds, where the processor has them.

    The machine code is kept where numba would keep it: beside the source or, where that is
    read-only, in the user's own cache; where there is neither, the kernel is compiled anew in each
    process. What is found there is used only if it is what was written.
    """
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
    kernel = nb.njit(**options)(function)
    if hasattr(
        kernel, "enable_caching"
    ):  # numba may be switched off, which leaves the plain function
        with contextlib.suppress(RuntimeError, OSError):  # no place for a cache
            kernel._cache = _Cache(function)
    return kernel  # type: ignore[no-any-return]


class _Cache(FunctionCache):
    """numba's cache of one function, whose faults cost the time to compile and nothing else."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        file = self._cache_file
        self._cache_file = _Files(file._cache_path, self._impl.filename_base, file._source_stamp)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # whatever a bent or foreign file makes of itself: as if there were none
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        with contextlib.suppress(
            Exception
        ):  # a full or read-only disk, another process: the code is here and works
            super().save_overload(sig, data)


class _Files(IndexDataCacheFile):
    """
    Index and data files that end with the SHA-256 of what comes before: a bit flipped in machine
    code would crash, not raise.
    """

    def _load_index(self) -> Any:
        return super()._load_index() if _is_whole(self._index_path) else {}

    def _load_data(self, name: str) -> Any:
        if not _is_whole(self._data_path(name)):
            raise OSError(
                f"{name} is not what was written"
            )  # numba takes this for a file that is gone
        return super()._load_data(name)

    @contextlib.contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[io.BytesIO]:
        data = io.BytesIO()
        yield data
        with super()._open_for_write(filepath) as file:
            file.write(
                data.getvalue() + hashlib.sha256(data.getvalue()).digest()
            )  # a pickle ends where it ends: the rest is not read


def _is_whole(path: str) -> bool:
    """Whether a file ends with its own checksum."""
    try:
        data = Path(path).read_bytes()
    except OSError:
        return False
    return len(data) > 32 and hashlib.sha256(data[:-32]).digest() == data[-32:]
