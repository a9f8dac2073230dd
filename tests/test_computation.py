"""Precision, library, planning and threads of a computation: defaults and refusals."""

import pytest

from fftocean.computation import BACKENDS, Computation
from fftocean.errors import ParameterError
from fftocean.transforms import BACKENDS as LIBRARIES
from fftocean.transforms import PLANNING


def test_the_defaults_are_quick_to_set_up():
    """Single precision, on one thread, without minutes of planning."""
    made = Computation()
    assert (made.dtype, made.backend, made.planning, made.threads) == (
        "float32",
        "auto",
        "estimate",
        1,
    )
    assert set(BACKENDS) == {"auto", *LIBRARIES, "gpu", "gpu-or-cpu"}


def test_every_backend_and_planning_is_taken():
    for backend in BACKENDS:
        for planning in PLANNING:
            made = Computation("float64", backend, planning, 3)
            assert (made.backend, made.planning, made.threads) == (backend, planning, 3)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"backend": "cuda"}, "backend must be one of auto, .*gpu, gpu-or-cpu, got 'cuda'"),
        ({"backend": None}, "backend must be one of"),
        ({"backend": ["auto"]}, "backend must be one of"),
        ({"planning": "exhaustive"}, "planning must be one of .*got 'exhaustive'"),
        ({"planning": 1}, "planning must be one of"),
        ({"threads": 0}, "threads must be"),
        ({"threads": 1.5}, "threads must be"),
        ({"dtype": "float16"}, "dtype must be"),
    ],
)
def test_other_values_are_refused(changes, message):
    with pytest.raises(ParameterError, match=message):
        Computation(**changes)
