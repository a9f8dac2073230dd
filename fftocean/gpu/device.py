"""The graphics adapter and its device, by `wgpu`: one for each process."""

import threading
from dataclasses import dataclass
from importlib import import_module, metadata
from typing import Any

from fftocean import forks
from fftocean.errors import ParameterError, how_to_install

_LIMITS = ("max-storage-buffer-binding-size", "max-buffer-size")
"""Limits of which the device gets all that the adapter has, not just what WebGPU promises."""


@dataclass(frozen=True, slots=True)
class Adapter:
    """A graphics processor, or a program that stands in for one."""

    name: str
    interface: str  # "Vulkan", "Metal" or "D3D12"
    driver: str
    is_software: bool  # it computes on the processor
    wgpu: str  # version

    def __str__(self) -> str:
        """Return the adapter in words."""
        by = ", in software on the processor" if self.is_software else ""
        return f"{self.name} by {self.interface}, driver {self.driver}{by}; wgpu {self.wgpu}"


class Device:
    """A device of `wgpu` with its adapter, and what has been compiled for it."""

    def __init__(self, adapter: Any) -> None:
        self.adapter = _report(adapter)
        self.handle = adapter.request_device_sync(
            required_limits={name: adapter.limits[name] for name in _LIMITS}
        )
        self.pipelines: dict[str, Any] = {}  # by kernel; see `gpu.kernels`
        self.lock = threading.RLock()  # frames of several oceans take turns


_current: Device | None = None
_inherited: list[Device] = []  # of the parent process: never used, and never released here
_making = threading.Lock()


def device() -> Device:
    """
    Return the device of this process, made at the first call.

    Raises:
        ParameterError: `wgpu` is not installed, or there is no adapter.
    """
    global _current
    with forks.no_fork(), _making:
        if _current is None:
            _current = Device(_request())
        return _current


def forget(lost: Device) -> None:
    """Let the next call of `device` make another one, unless one has been made already."""
    global _current
    with _making:
        if _current is lost:
            _current = None


def adapter() -> Adapter:
    """
    Return the adapter that computes the frames of `Ocean(..., backend="gpu")`.

    It is the one that `wgpu` prefers for speed; WGPUPY_WGPU_ADAPTER_NAME names another.

    Raises:
        ParameterError: `wgpu` is not installed, or there is no adapter.
    """
    return device().adapter


def errors() -> tuple[type[Exception], ...]:
    """Return the exceptions of a device that is lost, or has too little memory."""
    return (import_module("wgpu").GPUError, RuntimeError)


def _request() -> Any:
    """Return the adapter of `wgpu`."""
    try:
        wgpu = import_module("wgpu")
    except ImportError:
        raise ParameterError(
            "backend 'gpu' needs the package wgpu, which is not installed: "
            f"{how_to_install('gpu')}; 'gpu-or-cpu' computes without it"
        ) from None
    try:
        # its OpenGL cannot write all shaders
        found = [
            one
            for one in (
                wgpu.gpu.request_adapter_sync(power_preference="high-performance"),
                *wgpu.gpu.enumerate_adapters_sync(),
            )
            if one is not None and one.info["backend_type"] != "OpenGL"
        ]
    except Exception as error:  # of the driver: whatever it may be
        raise ParameterError(_no_adapter(f"asking for one fails: {error}")) from error
    if not found:
        raise ParameterError(_no_adapter("wgpu finds none"))
    return found[0]


def _no_adapter(reason: str) -> str:
    return (
        f"backend 'gpu' needs a graphics adapter with Vulkan, Metal or Direct3D 12, and {reason}; "
        "a software one such as lavapipe will do, and 'gpu-or-cpu' computes without one"
    )


def _report(adapter: Any) -> Adapter:
    info = adapter.info
    return Adapter(
        name=info["device"] or info["vendor"] or "unnamed",
        interface=info["backend_type"],
        driver=info["description"] or "unnamed",
        is_software=info["adapter_type"] == "CPU",
        wgpu=metadata.version("wgpu"),
    )


def _renew() -> None:
    """
    Set aside the device in a forked child, where its driver's threads do not exist.

    The child's own device needs an instance of `wgpu` of its own.
    """
    global _current, _making
    _making = threading.Lock()
    if _current is not None:
        _inherited.append(_current)
        _current = None
        helpers: Any = import_module("wgpu.backends.wgpu_native._helpers")
        helpers._the_instance = None


forks.in_child(_renew)
