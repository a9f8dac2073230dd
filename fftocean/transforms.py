"""
The only inverse FFT: plans, buffers and backends.

All compute  out[y, x] = sum over k of spectrum[ky, kx] e^{+i (kx x + ky y)}  from the half plane kx >= 0, without 1/N.
"""

import importlib
import sys
import threading
from types import ModuleType
from typing import Any, Protocol

import numpy as np

from fftocean.arrays import COMPLEX_OF, Complex, Real
from fftocean.errors import ParameterError

PLANNING = {"estimate": "FFTW_ESTIMATE", "measure": "FFTW_MEASURE", "patient": "FFTW_PATIENT"}
_planner = threading.Lock()  # FFTW's planner is shared by all plans and is not safe to enter twice


class InverseTransform(Protocol):
    """A plan for one shape and precision: fill `spectrum`, call, read the result. The call spoils `spectrum`."""

    spectrum: Complex  # (ny, nx // 2 + 1)
    backend: str

    def empty(self) -> Real:
        """A new output array in the alignment the plan likes."""

    def __call__(self, out: Real) -> None:
        """Transform `spectrum` into `out`, (ny, nx), C-contiguous."""


def inverse_transform(shape: tuple[int, int], dtype: str, *, backend: str = "auto", planning: str = "estimate") -> InverseTransform:
    """
    Plan an inverse transform.

    Args:
        shape: (ny, nx) of the output.
        dtype: "float32" or "float64".
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
    """A single-threaded FFTW plan and its buffers."""

    backend = "pyfftw"

    def __init__(self, pyfftw: ModuleType, shape: tuple[int, int], dtype: str, planning: str) -> None:
        self._pyfftw: Any = pyfftw
        self._shape, self._dtype = shape, dtype
        self.spectrum: Complex = self._pyfftw.zeros_aligned((shape[0], shape[1] // 2 + 1), dtype=COMPLEX_OF[dtype])
        self._home = self.empty()
        with _planner:
            self._plan: Any = self._pyfftw.FFTW(
                self.spectrum,
                self._home,
                axes=(0, 1),
                direction="FFTW_BACKWARD",
                flags=(PLANNING[planning], "FFTW_DESTROY_INPUT"),
                threads=1,
            )
        self.spectrum[:] = 0.0  # measuring scribbles over it

    def empty(self) -> Real:
        return self._pyfftw.empty_aligned(self._shape, dtype=self._dtype)  # type: ignore[no-any-return]

    def __call__(self, out: Real) -> None:
        if self._pyfftw.is_byte_aligned(out, self._plan.output_alignment):
            self._plan.update_arrays(self.spectrum, out)
            self._plan.execute()
            self._plan.update_arrays(self.spectrum, self._home)  # do not hold on to the caller's array
        else:
            self._plan.execute()
            out[:] = self._home


class _SciPy:
    """SciPy's pocketfft, always there."""

    backend = "scipy"

    def __init__(self, shape: tuple[int, int], dtype: str) -> None:
        self._shape, self._dtype = shape, dtype
        self.spectrum: Complex = np.zeros((shape[0], shape[1] // 2 + 1), dtype=COMPLEX_OF[dtype])

    def empty(self) -> Real:
        return np.empty(self._shape, dtype=self._dtype)

    def __call__(self, out: Real) -> None:
        from scipy import fft

        out[:] = fft.irfft2(self.spectrum, s=self._shape, norm="forward", overwrite_x=True)
