"""Every backend computes the same unscaled inverse transform, as accurately as an FFT can."""

import math
import sys

import numpy as np
import pytest

import fftocean as fo
from fftocean import transforms
from fftocean.transforms import inverse_rows


def by_long_double(rows):
    """The sum itself in extended precision: no FFT."""
    n = rows.shape[1]
    j, m = np.arange(n, dtype=np.longdouble)[:, None], np.arange(n)[None, :]
    two_pi = np.longdouble("6.283185307179586476925286766559")
    return rows.astype(np.clongdouble) @ np.exp(1j * two_pi * ((j * m) % n) / n)


def noise(shape, dtype):
    rng = np.random.default_rng(sum(shape))
    return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)).astype(np.complex64 if dtype == "float32" else np.complex128)


@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("n", [1, 2, 8, 9, 31, 48, 80, 97, 256, 1009, 1024])
def test_accuracy(n, dtype, backend):
    """Relative L2 <= 1.5 eps sqrt(log2 n) (Higham 2002, ch. 24, random errors, with a margin of 1.5), plus the storing: eps/2."""
    transform = inverse_rows((3, n), dtype, backend=backend)
    rows = noise((3, n), dtype)
    truth = by_long_double(rows)
    transform.rows[:] = rows
    transform()
    eps = np.finfo(dtype).eps
    hard = 3.0 if n in (97, 1009) else 1.0  # large primes go through Rader's or Bluestein's algorithm: three transforms in one
    error = float(np.linalg.norm(transform.rows - truth) / np.linalg.norm(truth))
    assert error <= eps * (0.5 + 1.5 * hard * math.sqrt(math.log2(n)))
    assert transform.rows.dtype == rows.dtype
    assert transform.backend == backend


@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
def test_each_row_is_transformed_on_its_own(backend):
    """The same row gives the same bits wherever it stands in the buffer, and whatever stands beside it."""
    rows = noise((16, 60), "float32")
    transform = inverse_rows((16, 60), "float32", backend=backend)
    transform.rows[:] = rows
    transform()
    first = transform.rows.copy()
    transform.rows[:] = rows[::-1]
    transform()
    assert np.array_equal(transform.rows[::-1], first)


@pytest.mark.parametrize(
    ("arguments", "rule"),
    [
        ({"dtype": "float16"}, "dtype must be"),
        ({"dtype": "float32", "backend": "cufft"}, "backend must be"),
        ({"dtype": "float32", "planning": "lucky"}, "planning must be"),
    ],
)
def test_unknown_choices_are_refused(arguments, rule):
    with pytest.raises(fo.ParameterError, match=rule):
        inverse_rows((8, 8), **arguments)


def test_without_pyfftw(monkeypatch):
    """The fallback is chosen by itself; asking for what is not there says so."""
    monkeypatch.setitem(sys.modules, "pyfftw", None)
    assert transforms.inverse_rows((8, 8), "float32").backend == "scipy"
    with pytest.raises(fo.ParameterError, match="installed"):
        inverse_rows((8, 8), "float32", backend="pyfftw")


def test_pyfftw_is_imported_without_dask(monkeypatch):
    """dask, if it is not there yet, is neither imported on the way nor left blocked behind."""
    monkeypatch.delitem(sys.modules, "dask", raising=False)
    monkeypatch.delitem(sys.modules, "pyfftw", raising=False)
    seen = []
    real = transforms.importlib.import_module
    monkeypatch.setattr(transforms.importlib, "import_module", lambda _: seen.append("dask" in sys.modules) or real("numpy"))
    transforms._pyfftw()
    assert seen == [True]
    assert "dask" not in sys.modules
