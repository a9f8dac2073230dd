"""Precision, FFT library or graphics processor, and threads of a computation."""

from dataclasses import dataclass

from fftocean.arrays import precision_of
from fftocean.errors import ParameterError
from fftocean.limits import THREADS
from fftocean.transforms import BACKENDS as LIBRARIES
from fftocean.transforms import PLANNING

BACKENDS = ("auto", *LIBRARIES, "gpu", "gpu-or-cpu")
"""
FFT libraries, "auto" for the first of them that is installed; and graphics processors.

"gpu-or-cpu" is "auto" where "gpu" cannot compute.
"""


@dataclass(frozen=True, slots=True)
class Computation:
    """
    The way an ocean computes its frames; the waves do not depend on it.

    `inverse_rows` checks what is installed.

    Raises:
        ParameterError: an unknown dtype, backend or planning effort, or a number of threads out
            of range.
    """

    dtype: str = "float32"  # of the fields: "float32" or "float64"
    backend: str = "auto"  # one of `BACKENDS`
    planning: str = "estimate"  # "estimate", "measure" or "patient"
    threads: int = 1  # that share the work on one frame

    def __post_init__(self) -> None:
        object.__setattr__(self, "dtype", precision_of(self.dtype))
        if not isinstance(self.backend, str) or self.backend not in BACKENDS:
            raise ParameterError(
                f"backend must be one of {', '.join(BACKENDS)}, got {self.backend!r:.80}"
            )
        if not isinstance(self.planning, str) or self.planning not in PLANNING:
            raise ParameterError(
                f"planning must be one of {', '.join(PLANNING)}, got {self.planning!r:.80}"
            )
        object.__setattr__(self, "threads", THREADS.check("threads", self.threads))
