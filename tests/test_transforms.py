"""Every backend computes the same unscaled inverse transform, as accurately as an FFT can."""

import itertools
import json
import math
import subprocess
import sys

import numpy as np
import pytest

import fftocean as fo
from fftocean import transforms, wisdom
from fftocean.kernels import native
from fftocean.transforms import inverse_rows


def by_long_double(rows):
    """The sum itself in extended precision: no FFT."""
    n = rows.shape[1]
    j, m = np.arange(n, dtype=np.longdouble)[:, None], np.arange(n)[None, :]
    two_pi = np.longdouble("6.283185307179586476925286766559")
    return rows.astype(np.clongdouble) @ np.exp(1j * two_pi * ((j * m) % n) / n)


def noise(shape, dtype):
    rng = np.random.default_rng(sum(shape))
    return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)).astype(
        np.complex64 if dtype == "float32" else np.complex128
    )


BACKENDS = [name for name in transforms.BACKENDS if transforms.library(name)]  # MKL is an extra


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("n", [1, 2, 8, 9, 31, 48, 80, 97, 256, 1009, 1024])
def test_accuracy(n, dtype, backend):
    """
    Relative L2 <= 1.5 eps sqrt(log2 n) (Higham 2002, ch. 24, random errors, with a margin of 1.5),
    plus the storing: eps/2.
    """
    transform = inverse_rows((3, n), dtype, backend=backend)
    rows = noise((3, n), dtype)
    truth = by_long_double(rows)
    transform.source[:] = rows
    transform()
    assert np.array_equal(transform.source, rows)  # left as it is
    eps = np.finfo(dtype).eps
    hard = (
        3.0 if n in (97, 1009) else 1.0
    )  # large primes go through Rader's or Bluestein's algorithm: three transforms in one
    error = float(np.linalg.norm(transform.result - truth) / np.linalg.norm(truth))
    assert error <= eps * (0.5 + 1.5 * hard * math.sqrt(math.log2(n)))
    assert transform.result.dtype == rows.dtype
    assert transform.backend == backend


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("n", [1, 8, 31, 256])
def test_plans_that_compiled_code_calls(n, dtype, backend):
    """The same transform of one row, by the address of a function; tolerance as above."""
    plan = transforms.row_plan(n, dtype, backend, "estimate")
    if plan is None:
        assert backend == "scipy" or transforms.loaded(backend) is not None
        return
    rows = noise((1, n), dtype)
    source, result = (transforms.aligned((1, n), dtype) for _ in range(2))
    source[:] = rows
    native.execute(plan.function, plan.plan, source.ctypes.data, result.ctypes.data)
    exact = by_long_double(rows)
    error = np.linalg.norm((result - exact).astype(complex)) / np.linalg.norm(exact.astype(complex))
    eps = np.finfo(dtype).eps
    assert error <= 1.5 * eps * math.sqrt(math.log2(n)) + 0.5 * eps


@pytest.mark.parametrize("backend", BACKENDS)
def test_each_row_is_transformed_on_its_own(backend):
    """
    The same row gives the same bits wherever it stands in the buffer, and whatever stands beside
    it.
    """
    rows = noise((16, 60), "float32")
    transform = inverse_rows((16, 60), "float32", backend=backend)
    transform.source[:] = rows
    transform()
    first = transform.result.copy()
    transform.source[:] = rows[::-1]
    transform()
    assert np.array_equal(transform.result[::-1], first)


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


@pytest.mark.parametrize("backend", BACKENDS)
def test_buffers_start_on_cache_lines(backend):
    """The same bits in every run need the same alignment."""
    for shape in ((3, 7), (16, 60), (1, 1)):
        transform = inverse_rows(shape, "float32", backend=backend)
        assert transform.source.ctypes.data % 64 == transform.result.ctypes.data % 64 == 0
        assert transform.source.flags.c_contiguous
        assert transform.result.flags.c_contiguous


def test_the_fastest_that_is_installed_is_chosen(monkeypatch):
    installed = [name for name in transforms.BACKENDS if transforms.library(name)]
    assert inverse_rows((8, 8), "float32").backend == installed[0]
    monkeypatch.setattr(transforms, "_mkl", lambda: None)
    assert inverse_rows((8, 8), "float32").backend == "pyfftw"
    with pytest.raises(fo.ParameterError, match="'mkl' must be installed"):
        inverse_rows((8, 8), "float32", backend="mkl")


def test_without_pyfftw(monkeypatch):
    """The fallback is chosen by itself; asking for what is not there says so."""
    monkeypatch.setattr(transforms, "_mkl", lambda: None)
    monkeypatch.setitem(sys.modules, "pyfftw", None)
    assert transforms.inverse_rows((8, 8), "float32").backend == "scipy"
    with pytest.raises(fo.ParameterError, match="installed"):
        inverse_rows((8, 8), "float32", backend="pyfftw")


def test_libraries_say_which_they_are():
    assert transforms.library("pyfftw").startswith("FFTW 3.")
    assert transforms.library("scipy").startswith("pocketfft (scipy 1.")


@pytest.mark.parametrize(
    "contents",
    [b"", b"{}", b"not json", b'{"key": {}, "sha256": "", "wisdom": []}', b"\xff\xfe", b"[1]"],
)
def test_wisdom_is_kept_and_a_bent_file_is_done_without(tmp_path, monkeypatch, contents):
    """
    The first plan leaves a file and the second uses it; what is no wisdom is replaced, with a note.
    """
    monkeypatch.setenv("FFTOCEAN_CACHE", str(tmp_path))
    rows = noise((4, 24), "float32")

    def result():
        transform = inverse_rows((4, 24), "float32", backend="pyfftw", planning="measure")
        transform.source[:] = rows
        transform()
        return transform.result.copy()

    first = result()
    (file,) = (tmp_path / "wisdom").iterdir()
    good = file.read_bytes()
    assert np.array_equal(result(), first)
    assert file.read_bytes() == good
    file.write_bytes(contents)
    with pytest.warns(fo.errors.CacheWarning, match="ignored"):
        again = result()
    assert np.linalg.norm(again - first) < 1e-6 * np.linalg.norm(first)
    assert len(file.read_bytes()) > 100
    assert [path.name for path in (tmp_path / "wisdom").iterdir()] == [file.name]


def test_wisdom_of_another_library_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setenv("FFTOCEAN_CACHE", str(tmp_path))
    inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure")
    (file,) = (tmp_path / "wisdom").iterdir()
    tree = json.loads(file.read_text())
    tree["key"]["library"] = "FFTW 4"
    file.write_text(json.dumps(tree))
    with pytest.warns(fo.errors.CacheWarning, match="another machine's"):
        inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure")


def test_a_cache_that_cannot_be_written_stops_nothing(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("FFTOCEAN_CACHE", str(tmp_path / "file" / "below"))
    assert (
        inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure").backend == "pyfftw"
    )


def test_pyfftw_is_imported_without_dask(monkeypatch):
    """
    dask.array, if it is not there yet, is neither imported on the way nor left blocked behind.
    """
    monkeypatch.delitem(sys.modules, "dask.array", raising=False)
    monkeypatch.delitem(sys.modules, "pyfftw", raising=False)
    seen = []
    real = transforms.importlib.import_module
    monkeypatch.setattr(
        transforms.importlib,
        "import_module",
        lambda _: seen.append("dask.array" in sys.modules) or real("numpy"),
    )
    transforms._pyfftw()
    assert seen == [True]
    assert "dask.array" not in sys.modules


def test_an_estimate_is_the_same_whatever_was_measured_before(tmp_path, monkeypatch):
    """
    FFTW would plan by what it knows: a viewer that measures and then bakes would bake other bytes.
    What the user knows is kept.
    """
    import pyfftw

    monkeypatch.setenv("FFTOCEAN_CACHE", str(tmp_path))
    rows = noise((32, 96), "float32")

    def estimated():
        transform = inverse_rows((32, 96), "float32", backend="pyfftw")
        transform.source[:] = rows
        transform()
        return transform.result.copy()

    before = estimated()
    mine, other = (np.zeros((8, 90), np.complex64) for _ in range(2))
    pyfftw.FFTW(mine, other, flags=("FFTW_PATIENT",))
    for planning in ("measure", "patient"):
        inverse_rows((32, 96), "float32", backend="pyfftw", planning=planning)
    assert np.array_equal(estimated(), before)
    pyfftw.FFTW(
        mine, other, flags=("FFTW_PATIENT", "FFTW_WISDOM_ONLY")
    )  # raises where nothing is known


def test_the_first_who_has_measured_decides(tmp_path, monkeypatch):
    """A plan whose wisdom comes second is made anew by the first one's."""
    monkeypatch.setenv("FFTOCEAN_CACHE", str(tmp_path))
    inverse_rows((4, 28), "float32", backend="pyfftw", planning="measure")
    (file,) = (tmp_path / "wisdom").iterdir()
    first, asked = file.read_bytes(), []
    real = wisdom._kept

    def beaten(pyfftw, path, key):
        path.write_bytes(first)
        return real(pyfftw, path, key)

    monkeypatch.setattr(wisdom, "_kept", beaten)
    learned = wisdom._learned
    monkeypatch.setattr(wisdom, "_learned", lambda *a: asked.append(True) or learned(*a))
    file.unlink()
    inverse_rows((4, 28), "float32", backend="pyfftw", planning="measure")
    assert asked == [True]
    assert file.read_bytes() == first


def test_wisdom_with_a_wrong_checksum_or_of_another_processor_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setenv("FFTOCEAN_CACHE", str(tmp_path))
    inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure")
    (file,) = (tmp_path / "wisdom").iterdir()
    tree = json.loads(file.read_text())
    file.write_text(json.dumps({**tree, "sha256": "0" * 64}))
    with pytest.warns(fo.errors.CacheWarning, match="ignored"):
        inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure")
    monkeypatch.setattr(wisdom, "processor", lambda: "another")
    inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure")
    assert len(list((tmp_path / "wisdom").iterdir())) == 2


def test_a_user_without_a_home_measures_every_time(monkeypatch):
    def homeless():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(wisdom, "folder", homeless)
    assert (
        inverse_rows((4, 20), "float32", backend="pyfftw", planning="measure").backend == "pyfftw"
    )


@pytest.mark.process
def test_pyfftw_is_whole_for_the_first_of_several_threads():
    """Eight threads at once in a fresh process: none sees what another has imported half."""
    script = """
import threading, sys
from fftocean import transforms, wisdom
found = []
def ask():
    found.append(hasattr(transforms._pyfftw(), "FFTW"))
threads = [threading.Thread(target=ask) for _ in range(8)]
[t.start() for t in threads]; [t.join() for t in threads]
assert found == [True] * 8 and sys.modules.get("dask.array", 1) is not None, found
"""
    subprocess.run([sys.executable, "-c", script], check=True, timeout=600)


def test_libraries_of_the_same_names_do_not_mix():
    """In each order, in a process of its own: MKL and FFTW name their functions alike."""
    backends = [name for name in transforms.BACKENDS if transforms.library(name)]
    for order in itertools.permutations(backends):
        code = (
            "import fftocean as fo\n"
            "ocean = lambda b, d: fo.Ocean.from_modes([(1, 2, 0.5, 0.1)], n=32, size=9.0, "
            "backend=b, dtype=d)\n"
            f"frames = [ocean(b, d).frame(0.3) for b in {order} for d in ('float64', 'float32')]\n"
            "print(max(abs(f.height - frames[0].height).max() for f in frames))"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        assert done.returncode == 0, (order, done.stderr[-500:])
        assert float(done.stdout) < 1e-6, order
