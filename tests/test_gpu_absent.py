"""Graphics processors that are missing or of no use, and tiles that they do not take."""

import sys
import types

import pytest

import fftocean as fo
from fftocean.gpu import device as devices

GALE = fo.Sea.from_wind(speed=14.0, fetch=200e3)
TILE = {"n": 16, "size": 100.0}


class Adapter:
    """An adapter of `wgpu` by its report alone."""

    def __init__(self, backend_type):
        self.info = {
            "device": "a card",
            "vendor": "",
            "description": "a driver",
            "backend_type": backend_type,
            "adapter_type": "DiscreteGPU",
        }


def with_adapters(monkeypatch, request, others=()):
    """Let `wgpu` answer a request by a function, and list others."""
    gpu = types.SimpleNamespace(
        request_adapter_sync=lambda **_: request(), enumerate_adapters_sync=lambda: list(others)
    )
    monkeypatch.setattr(devices, "_current", None)
    monkeypatch.setitem(sys.modules, "wgpu", types.SimpleNamespace(gpu=gpu))


def fails():
    raise RuntimeError("the driver is out of order")


def without_package(monkeypatch):
    monkeypatch.setattr(devices, "_current", None)
    monkeypatch.setitem(sys.modules, "wgpu", None)


ABSENT = {
    "no package": (without_package, r"needs the package wgpu, .*pip install '\.\[gpu\]'"),
    "no adapter": (lambda patch: with_adapters(patch, lambda: None), "and wgpu finds none; a soft"),
    "a request that fails": (
        lambda patch: with_adapters(patch, fails),
        "asking for one fails: the driver is out of order",
    ),
    "OpenGL alone": (
        lambda patch: with_adapters(patch, lambda: Adapter("OpenGL"), [Adapter("OpenGL")]),
        "Vulkan, Metal or Direct3D 12, and wgpu finds none",
    ),
}


@pytest.mark.parametrize("case", ABSENT)
def test_an_absent_adapter_is_an_error_or_the_cpu_as_asked(monkeypatch, case):
    absent, message = ABSENT[case]
    absent(monkeypatch)
    with pytest.raises(fo.ParameterError, match=message):
        fo.Ocean(GALE, backend="gpu", **TILE)
    with pytest.raises(fo.ParameterError, match=message):
        fo.gpu.adapter()
    with pytest.raises(fo.ParameterError, match=message):
        fo.Cascade(GALE, [(64, 400.0), (32, 57.0)], backend="gpu")
    ocean = fo.Ocean(GALE, backend="gpu-or-cpu", **TILE)
    own = fo.Ocean(GALE, **TILE)
    assert ocean.backend == own.backend != "gpu"
    assert (ocean.frame(1.0).height == own.frame(1.0).height).all()


def test_opengl_is_passed_over(monkeypatch):
    vulkan = Adapter("Vulkan")
    with_adapters(monkeypatch, lambda: Adapter("OpenGL"), [Adapter("OpenGL"), vulkan])
    assert devices._request() is vulkan


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"n": 300}, r"powers of two from 2 to 4096 samples a side, got nx = 300"),
        ({"n": (16, 48)}, r"got ny = 48; 'gpu-or-cpu' computes others on the CPU"),
        ({"n": (8192, 4)}, r"got nx = 8192"),
        ({"dtype": "float64"}, r"computes fields in float32, got dtype='float64'"),
    ],
)
def test_what_the_kernels_do_not_take(change, message):
    """The rule is named; the CPU computes it if that is allowed."""
    with pytest.raises(fo.ParameterError, match=message):
        fo.Ocean(GALE, backend="gpu", **{**TILE, **change})
    given = {"backend": "gpu-or-cpu", **TILE, **change}
    assert fo.Ocean(GALE, **given).backend != "gpu"


@pytest.mark.parametrize("name", ["vulkan", "GPU", 3, None])
def test_an_unknown_backend(name):
    with pytest.raises(
        fo.ParameterError,
        match=r"backend must be one of auto, mkl, pyfftw, scipy, gpu, gpu-or-cpu, got",
    ):
        fo.Ocean(GALE, backend=name, **TILE)


def test_an_unknown_planning_effort():
    with pytest.raises(fo.ParameterError, match="planning must be one of estimate"):
        fo.Ocean(GALE, backend="gpu-or-cpu", planning="hasty", **TILE)
