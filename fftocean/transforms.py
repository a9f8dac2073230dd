"""
Inverse FFTs of rows by MKL, FFTW or SciPy.

For each row of a buffer they compute  result[j] = sum over m of source[m] e^{+2 pi i m j / n},
without 1/n, on one thread.
"""

import contextlib
import ctypes
import importlib
import importlib.machinery
import importlib.metadata
import importlib.util
import math
import os
import sys
import threading
import weakref
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol

import numpy as np

from fftocean import forks, wisdom
from fftocean.arrays import CACHE_LINE, COMPLEX_OF, Complex
from fftocean.errors import ParameterError

PLANNING = {"estimate": "FFTW_ESTIMATE", "measure": "FFTW_MEASURE", "patient": "FFTW_PATIENT"}
"""Planning efforts, by the names of pyFFTW."""

FLAGS = {"estimate": 64, "measure": 0, "patient": 32}
"""The same in C."""

# FFTW's planner is shared by all plans. A plan can be collected while its thread makes another, so
# the lock can be taken twice.
_planner = threading.RLock()
_importing = threading.Lock()


class _Planner:
    """The current lock of the planner, for forks to take."""

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        return _planner.acquire(blocking, timeout)

    def release(self) -> None:
        _planner.release()


forks.guard(_Planner())


def _renew_locks() -> None:
    """Replace the locks in a forked child, where the threads that held them do not exist."""
    global _planner, _importing
    _planner, _importing = threading.RLock(), threading.Lock()


forks.in_child(_renew_locks)


class InverseRows(Protocol):
    """
    A plan for one shape and precision: fill `source`, call, read `result`.

    `source` keeps its values.
    """

    source: Complex  # (count, n), C-contiguous
    result: Complex  # the same
    backend: str

    def __call__(self) -> None:
        """Transform each row."""


def inverse_rows(
    shape: tuple[int, int], dtype: str, *, backend: str = "auto", planning: str = "estimate"
) -> InverseRows:
    """
    Plan inverse transforms of the rows of a buffer.

    Args:
        shape: (count, n) of the buffer.
        dtype: "float32" or "float64", of its real and imaginary parts.
        backend: "mkl", "pyfftw", "scipy", or "auto" for the first of them that is installed.
        planning: planning effort of FFTW. "estimate" gives the same bytes in every run; "measure"
            and "patient" time several algorithms, keep the fastest in the user's cache, and give
            the same bytes as long as it is there.

    Raises:
        ParameterError: an unknown backend, precision or effort, or a backend that is not installed.
    """
    name = chosen_backend(dtype, backend, planning)
    transform = BACKENDS[name](shape, dtype, planning)
    assert transform is not None  # it is installed
    return transform


def chosen_backend(dtype: str, backend: str, planning: str) -> str:
    """
    Return the name of the backend to use; arguments and errors are those of `inverse_rows`.
    """
    if not isinstance(dtype, str) or dtype not in COMPLEX_OF:
        raise ParameterError(f"dtype must be 'float32' or 'float64', got {dtype!r}")
    if not isinstance(planning, str) or planning not in PLANNING:
        raise ParameterError(f"planning must be one of {', '.join(PLANNING)}, got {planning!r}")
    if not isinstance(backend, str) or backend not in ("auto", *BACKENDS):
        raise ParameterError(f"backend must be one of auto, {', '.join(BACKENDS)}, got {backend!r}")
    for name in BACKENDS if backend == "auto" else (backend,):
        if loaded(name) is not None:
            return name
    raise ParameterError(
        f"backend {backend!r} must be installed (pip install {backend}), and is not; "
        "'scipy' always is"
    )


@cache
def library(backend: str) -> str | None:
    """
    Return the library of a backend with its version; None if it is not installed.

    For example "FFTW 3.3.5 (pyfftw 0.15.1)".
    """
    if backend == "mkl":
        return f"MKL {importlib.metadata.version('mkl')}" if _mkl() else None
    if backend == "pyfftw":
        pyfftw = _pyfftw()
        return (
            f"FFTW {str(pyfftw.fftw_version).removeprefix('fftw-')} (pyfftw {pyfftw.__version__})"
            if pyfftw
            else None
        )
    return f"pocketfft (scipy {importlib.metadata.version('scipy')})"


def aligned(shape: tuple[int, int], dtype: str) -> Complex:
    """Return zeros that start on a cache line, since the bits of a plan depend on alignment."""
    return aligned_numbers(shape, COMPLEX_OF[dtype])


def aligned_numbers(shape: tuple[int, ...], kind: Any) -> np.ndarray[Any, np.dtype[Any]]:
    """Return zeros of any type that start on a cache line."""
    return _aligned(np.zeros, shape, kind)


def aligned_empty(shape: tuple[int, ...], kind: Any) -> np.ndarray[Any, np.dtype[Any]]:
    """Return an array of any type that starts on a cache line, with whatever the memory holds."""
    return _aligned(np.empty, shape, kind)


def _aligned(
    make: Callable[..., np.ndarray[Any, np.dtype[np.uint8]]], shape: tuple[int, ...], kind: Any
) -> np.ndarray[Any, np.dtype[Any]]:
    """Return an array on a cache line, in memory that is made by a function of NumPy."""
    kind = np.dtype(kind)
    size = math.prod(shape) * kind.itemsize
    raw = make(size + CACHE_LINE, dtype=np.uint8)
    start = -raw.ctypes.data % CACHE_LINE
    numbers: np.ndarray[Any, np.dtype[Any]] = raw[start : start + size].view(kind)
    return numbers.reshape(shape)


class _FFTW:
    """FFTW through pyFFTW, out of place; for rows in cache an estimated plan is the fastest."""

    backend = "pyfftw"

    def __init__(
        self, pyfftw: ModuleType, shape: tuple[int, int], dtype: str, planning: str
    ) -> None:
        self.source, self.result = aligned(shape, dtype), aligned(shape, dtype)

        def plan() -> Any:
            flag = PLANNING[planning]
            return pyfftw.FFTW(
                self.source,
                self.result,
                axes=(1,),
                direction="FFTW_BACKWARD",
                flags=(flag,),
                threads=1,
            )

        # An estimate, too, uses earlier measurements, and would differ from run to run.
        with _planner, wisdom.set_aside(pyfftw):
            self._plan = (
                plan()
                if planning == "estimate"
                else wisdom.planned(pyfftw, plan, shape, dtype, planning)
            )
        self.source[:] = 0.0  # measuring overwrites it

    def __call__(self) -> None:
        self._plan.execute()

    def __del__(self) -> None:
        # At the end of the interpreter there can be no lock. pyfftw takes a lock of its own to
        # destroy a plan, which must be free when a process forks.
        if _planner is not None and hasattr(self, "_plan"):
            with _planner:
                del self._plan


class RowPlan:
    """
    A plan for one row that compiled code calls by address, as `kernels.native.execute` does.

    Source and result must start on a cache line. A thread needs a plan of its own.

    Args:
        library: FFTW, or MKL with FFTW's names.
        n: length of the row.
        dtype: "float32" or "float64".
        flag: planning effort of FFTW, as its header has it.
    """

    def __init__(self, library: ctypes.CDLL, n: int, dtype: str, flag: int) -> None:
        prefix = "fftwf" if dtype == "float32" else "fftw"
        plan_row = getattr(library, f"{prefix}_plan_dft_1d")
        plan_row.restype = ctypes.c_void_p
        rows = [aligned((1, n), dtype) for _ in range(2)]
        with contextlib.suppress(AttributeError):
            getattr(library, f"{prefix}_plan_with_nthreads")(1)
        addresses = (ctypes.c_void_p(row.ctypes.data) for row in rows)
        self.plan: int = plan_row(n, *addresses, 1, ctypes.c_uint(flag)) or 0
        if not self.plan:
            raise MemoryError(f"the FFT library could not plan a transform of {n}")
        execute = getattr(library, f"{prefix}_execute_dft")
        self.function = ctypes.cast(execute, ctypes.c_void_p).value or 0
        destroy = getattr(library, f"{prefix}_destroy_plan")
        finalizer = weakref.finalize(self, _destroy, destroy, ctypes.c_void_p(self.plan))
        finalizer.atexit = False  # daemon threads can still use the plan then


def row_plan(n: int, dtype: str, backend: str, planning: str) -> RowPlan | None:
    """
    Plan inverse transforms of one row for compiled code.

    Args:
        n: length of the row.
        dtype, planning: as in `inverse_rows`, which checks them.
        backend: "mkl", "pyfftw" or "scipy", which is installed.

    Returns:
        None where the library has no functions in C, or hides them.
    """
    library = {"mkl": _mkl, "pyfftw": _fftw}.get(backend, lambda: None)()
    if library is None:
        return None
    pyfftw = _pyfftw() if backend == "pyfftw" else None
    with _planner:
        if pyfftw is None:
            return RowPlan(library, n, dtype, FLAGS["estimate"])

        def plan() -> RowPlan:
            return RowPlan(library, n, dtype, FLAGS[planning])

        with wisdom.set_aside(pyfftw):
            if planning == "estimate":
                return plan()
            made: RowPlan = wisdom.planned(pyfftw, plan, (1, n), dtype, planning)
            return made


@cache
def _fftw() -> ctypes.CDLL | None:
    """
    Return the FFTW that pyfftw uses, or None.

    Names are looked up in the libraries that its extension module depends on, where the system
    allows that.
    """
    pyfftw = _pyfftw()
    if pyfftw is None:
        return None
    try:
        fftw = ctypes.CDLL(importlib.import_module("pyfftw.pyfftw").__file__)
        for prefix in ("fftwf", "fftw"):
            for name in ("plan_dft_1d", "execute_dft", "destroy_plan"):
                getattr(fftw, f"{prefix}_{name}")
            # Other code in the process can have asked for more threads, or plan through pyfftw
            # meanwhile.
            with contextlib.suppress(AttributeError):
                getattr(fftw, f"{prefix}_make_planner_thread_safe")()
    except (OSError, AttributeError, TypeError):
        return None
    return fftw


class _MKL:
    """MKL through its FFTW3 interface, which ignores the planning effort."""

    backend = "mkl"

    def __init__(self, mkl: ctypes.CDLL, shape: tuple[int, int], dtype: str) -> None:
        self.source, self.result = aligned(shape, dtype), aligned(shape, dtype)
        count, n = shape
        prefix = "fftwf" if dtype == "float32" else "fftw"
        length = ctypes.byref(ctypes.c_int(n))
        many = getattr(mkl, f"{prefix}_plan_many_dft")
        many.restype = ctypes.c_void_p
        source, result = (
            ctypes.c_void_p(self.source.ctypes.data),
            ctypes.c_void_p(self.result.ctypes.data),
        )
        with _planner:
            getattr(mkl, f"{prefix}_plan_with_nthreads")(1)
            flag = ctypes.c_uint(FLAGS["estimate"])
            plan = many(1, length, count, source, None, 1, n, result, None, 1, n, 1, flag)
        if not plan:
            raise MemoryError(f"MKL could not plan {count} transforms of {n}")
        self._execute, self._plan = getattr(mkl, f"{prefix}_execute"), ctypes.c_void_p(plan)
        destroy = getattr(mkl, f"{prefix}_destroy_plan")
        finalizer = weakref.finalize(self, _destroy, destroy, self._plan)
        finalizer.atexit = False  # daemon threads can still use the plan then

    def __call__(self) -> None:
        self._execute(self._plan)


def _destroy(destroy: Callable[[ctypes.c_void_p], None], plan: ctypes.c_void_p) -> None:
    """Destroy a plan of MKL while no thread makes one."""
    with _planner:
        destroy(plan)


class _SciPy:
    """SciPy's pocketfft, which is always installed."""

    backend = "scipy"

    def __init__(self, shape: tuple[int, int], dtype: str) -> None:
        self.source, self.result = aligned(shape, dtype), aligned(shape, dtype)

    def __call__(self) -> None:
        from scipy import fft

        self.result[:] = fft.ifft(self.source, axis=1, norm="forward", workers=1)


def _with_mkl(shape: tuple[int, int], dtype: str, _: str) -> InverseRows | None:
    mkl = _mkl()
    return _MKL(mkl, shape, dtype) if mkl else None


def _with_pyfftw(shape: tuple[int, int], dtype: str, planning: str) -> InverseRows | None:
    pyfftw = _pyfftw()
    return _FFTW(pyfftw, shape, dtype, planning) if pyfftw else None


def _with_scipy(shape: tuple[int, int], dtype: str, _: str) -> InverseRows | None:
    return _SciPy(shape, dtype)


BACKENDS: dict[str, Callable[[tuple[int, int], str, str], InverseRows | None]] = {
    "mkl": _with_mkl,
    "pyfftw": _with_pyfftw,
    "scipy": _with_scipy,
}
"""The backends, fastest first; each returns a plan, or None if it is not installed."""


@cache
def _mkl() -> ctypes.CDLL | None:
    """
    Load the library of the wheel `mkl`; None without it.

    It runs on one thread, unless other code in the process has set it up before.
    """
    try:
        files = importlib.metadata.files("mkl") or []
    except importlib.metadata.PackageNotFoundError:
        return None
    for file in files:
        if file.name.startswith(("libmkl_rt.", "mkl_rt.")) and not file.name.endswith(
            (".a", ".lib")
        ):
            try:
                mkl = ctypes.CDLL(str(file.locate()))
            except OSError:
                continue  # for another machine, or a library that it needs is missing
            mkl.MKL_Set_Threading_Layer(1)  # sequential; no effect once this MKL has computed
            return mkl
    return None


def _pyfftw() -> ModuleType | None:
    """
    Import pyfftw; None without it.

    It would import dask.array (6 s) for an interface that is not used here, so that is hidden
    meanwhile.
    """
    with _importing:  # no thread must see a module that another has half imported
        hide = "pyfftw" not in sys.modules and "dask.array" not in sys.modules
        if hide:
            sys.modules["dask.array"] = None  # type: ignore[assignment]
        _bind_fftw()
        try:
            return importlib.import_module("pyfftw")
        except ImportError:
            return None
        finally:
            if hide:
                sys.modules.pop("dask.array", None)


def _bind_fftw() -> None:
    """
    Load pyfftw's library so that FFTW finds its own functions first.

    MKL gives functions of the same names to the whole process. FFTW, loaded after MKL has computed,
    would call those with plans of its own.
    """
    if not hasattr(os, "RTLD_DEEPBIND"):
        return  # names are those of a library there
    spec = importlib.util.find_spec("pyfftw")
    for folder in (spec and spec.submodule_search_locations) or ():
        for suffix in importlib.machinery.EXTENSION_SUFFIXES:
            with contextlib.suppress(OSError):  # no such file: as it is without this
                ctypes.CDLL(str(Path(folder, f"pyfftw{suffix}")), os.RTLD_NOW | os.RTLD_DEEPBIND)


def loaded(backend: str) -> Any:
    """
    Return the library behind a backend, or None where it is not installed.

    It is a `ctypes.CDLL` for "mkl", and a module for "pyfftw" and "scipy".
    """
    if backend == "mkl":
        return _mkl()
    return _pyfftw() if backend == "pyfftw" else importlib.import_module("scipy.fft")
