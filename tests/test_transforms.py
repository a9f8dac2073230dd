"""Every backend computes the same unscaled inverse transform, as accurately as an FFT can."""

import math
import sys

import numpy as np
import pytest

import fftocean as fo
from fftocean import transforms
from fftocean.transforms import inverse_transform

SHAPES = [(1, 1), (1, 2), (2, 1), (8, 8), (7, 9), (31, 31), (48, 80), (97, 64), (256, 256)]


def by_long_double(spectrum, shape):
    """The sum itself, row by column, in extended precision: no FFT."""
    ny, nx = shape
    y, ky = np.arange(ny, dtype=np.longdouble)[:, None], np.arange(ny)[None, :]
    x, kx = np.arange(nx, dtype=np.longdouble)[:, None], np.arange(nx // 2 + 1)[None, :]
    two_pi = np.longdouble("6.283185307179586476925286766559")
    along_y = np.exp(1j * two_pi * ((y * ky) % ny) / ny) @ spectrum.astype(np.clongdouble)
    weight = np.where((kx == 0) | (2 * kx == nx), 1, 2)
    return (along_y @ (weight * np.exp(1j * two_pi * ((x * kx) % nx) / nx)).T).real


def hermitian(shape, dtype):
    """A random half plane of a real field."""
    rng = np.random.default_rng(sum(shape))
    return np.fft.rfft2(rng.standard_normal(shape)).astype(np.complex64 if dtype == "float32" else np.complex128)


@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("shape", SHAPES)
def test_accuracy(shape, dtype, backend):
    """Relative L2 <= 1.5 eps sqrt(log2 N) (Higham 2002, ch. 24, random-error model, with a margin of 1.5), plus the storing: eps/2."""
    transform = inverse_transform(shape, dtype, backend=backend)
    spectrum = hermitian(shape, dtype)
    truth = by_long_double(spectrum, shape)
    transform.spectrum[:] = spectrum
    out = transform.empty()
    transform(out)
    eps = np.finfo(dtype).eps
    error = float(np.linalg.norm(out - truth) / np.linalg.norm(truth))
    assert error <= eps * (0.5 + 1.5 * math.sqrt(math.log2(max(shape[0] * shape[1], 1))))
    assert out.dtype == dtype
    assert transform.backend == backend


@pytest.mark.parametrize("backend", ["pyfftw", "scipy"])
def test_unaligned_output_gives_the_same_bits(backend):
    shape = (64, 48)
    transform = inverse_transform(shape, "float32", backend=backend)
    spectrum = hermitian(shape, "float32")
    aligned = transform.empty()
    transform.spectrum[:] = spectrum
    transform(aligned)
    raw = np.empty(shape[0] * shape[1] * 4 + 4, dtype=np.uint8)
    for offset in (0, 4):
        out = raw[offset : offset + shape[0] * shape[1] * 4].view(np.float32).reshape(shape)
        transform.spectrum[:] = spectrum
        transform(out)
        assert np.array_equal(out, aligned)


def test_results_stay_when_the_plan_goes_on():
    """Each output array is the caller's: a later transform does not touch it."""
    transform = inverse_transform((16, 16), "float64")
    first, second = transform.empty(), transform.empty()
    transform.spectrum[:] = hermitian((16, 16), "float64")
    transform(first)
    kept = first.copy()
    transform.spectrum[:] = 0.0
    transform(second)
    assert np.array_equal(first, kept)
    assert not np.any(second)


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
        inverse_transform((8, 8), **arguments)


def test_without_pyfftw(monkeypatch):
    """The fallback is chosen by itself; asking for what is not there says so."""
    monkeypatch.setitem(sys.modules, "pyfftw", None)
    assert transforms.inverse_transform((8, 8), "float32").backend == "scipy"
    with pytest.raises(fo.ParameterError, match="installed"):
        inverse_transform((8, 8), "float32", backend="pyfftw")


def test_pyfftw_is_imported_without_dask(monkeypatch):
    """dask, if it is not there yet, is neither imported on the way nor left blocked behind."""
    sys.modules.pop("dask", None)
    monkeypatch.delitem(sys.modules, "pyfftw", raising=False)
    seen = []
    real = transforms.importlib.import_module
    monkeypatch.setattr(transforms.importlib, "import_module", lambda name: seen.append("dask" in sys.modules) or real("numpy"))
    transforms._pyfftw()
    assert seen == [True]
    assert "dask" not in sys.modules
