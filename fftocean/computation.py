"""Precision, FFT library and threads of a computation."""

from dataclasses import dataclass

from fftocean.arrays import precision_of
from fftocean.limits import THREADS


@dataclass(frozen=True, slots=True)
class Computation:
    """
    The way an ocean computes its frames; the waves do not depend on it.

    `inverse_rows` checks backend and planning, since it knows what is installed.

    Raises:
        ParameterError: an unknown dtype, or a number of threads out of range.
    """

    dtype: str = "float32"  # of the fields: "float32" or "float64"
    backend: str = "auto"  # "mkl", "pyfftw", "scipy", or "auto" for the first that is installed
    planning: str = "estimate"  # "estimate", "measure" or "patient"
    threads: int = 1  # that share the work on one frame

    def __post_init__(self) -> None:
        object.__setattr__(self, "dtype", precision_of(self.dtype))
        object.__setattr__(self, "threads", THREADS.check("threads", self.threads))
