"""
The only inverse FFT: plans, buffers and backends.

All compute, in place and for each row of a buffer,  out[j] = sum over m of rows[m] e^{+2 pi i m j / n},  without 1/n.
"""

import importlib
import sys
import threading
from types import ModuleType
from typing import Any, Protocol

import numpy as np

from fftocean.arrays import COMPLEX_OF, Complex
from fftocean.errors import ParameterError

PLANNING = {"estimate": "FFTW_ESTIMATE", "measure": "FFTW_MEASURE", "patient": "FFTW_PATIENT"}
_planner = threading.Lock()  # FFTW's planner is shared by all plans and is not safe to enter twice


class InverseRows(Protocol):
    """A plan for one shape and precision: fill `rows`, call, read `rows`."""

    rows: Complex  # (count, n), C-contiguous
    backend: str

    def __call__(self) -> None:
        """Transform each row, in place."""


def inverse_rows(shape: tuple[int, int], dtype: str, *, backend: str = "auto", planning: str = "estimate") -> InverseRows:
    """
    Plan inverse transforms of the rows of a buffer.

    Args:
        shape: (count, n) of the buffer.
        dtype: "float32" or "float64", of its real and imaginary parts.
        backend: "pyfftw", "scipy", or "auto" for the first of them that is installed.
        planning: FFTW's effort. "estimate" gives the same bytes in every run; "measure" and "patient" are faster and do not.

    Raises:
        ParameterError: an unknown backend, precision or effort, or a backend that is not installed.
    """
    if dtype not in COMPLEX_OF:
        raise ParameterError(f"dtype must be 'float32' or 'float64', got {dtype!r}")
    if planning not in PLANNING:
        raise ParameterError(f"planning must be one of {', '.join(PLANNING)}, got {planning!r}")
    if backend == "auto":
        backend = "pyfftw" if _pyfftw() else "scipy"
    if backend == "pyfftw":
        if (pyfftw := _pyfftw()) is None:
            raise ParameterError("backend 'pyfftw' must be installed (pip install pyfftw), and is not; 'scipy' always is")
        return _FFTW(pyfftw, shape, dtype, planning)
    if backend == "scipy":
        return _SciPy(shape, dtype)
    raise ParameterError(f"backend must be 'auto', 'pyfftw' or 'scipy', got {backend!r}")


def _pyfftw() -> ModuleType | None:
    """pyfftw if it is there; dask, which it would import for an interface that is not used here (6 s), is kept out meanwhile."""
    if "pyfftw" in sys.modules:
        return sys.modules["pyfftw"]
    hide = "dask" not in sys.modules
    if hide:
        sys.modules["dask"] = None  # type: ignore[assignment]
    try:
        return importlib.import_module("pyfftw")
    except ImportError:
        return None
    finally:
        if hide:
            del sys.modules["dask"]


class _FFTW:
    """A single-threaded FFTW plan and its buffer."""

    backend = "pyfftw"

    def __init__(self, pyfftw: ModuleType, shape: tuple[int, int], dtype: str, planning: str) -> None:
        self.rows: Complex = pyfftw.zeros_aligned(shape, dtype=COMPLEX_OF[dtype])
        with _planner:
            self._plan: Any = pyfftw.FFTW(
                self.rows, self.rows, axes=(1,), direction="FFTW_BACKWARD", flags=(PLANNING[planning],), threads=1
            )
        self.rows[:] = 0.0  # measuring scribbles over it

    def __call__(self) -> None:
        self._plan.execute()


class _SciPy:
    """SciPy's pocketfft, always there."""

    backend = "scipy"

    def __init__(self, shape: tuple[int, int], dtype: str) -> None:
        self.rows: Complex = np.zeros(shape, dtype=COMPLEX_OF[dtype])

    def __call__(self) -> None:
        from scipy import fft

        self.rows[:] = fft.ifft(self.rows, axis=1, norm="forward", overwrite_x=True)
