"""Pipelines of the kernels in `ocean.wgsl`, and the dispatches of a frame."""

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from fftocean.gpu.device import Device
from fftocean.shader_files import shader

_TRANSFORM = ((0, 0), (0, 3), (1, 0), (1, 1), (1, 2), (1, 3))
_POINTWISE = ((1, 0), (1, 12), (1, 15), (1, 16), (1, 17), (1, 18))
BINDINGS: dict[str, tuple[tuple[int, int], ...]] = {
    "advance": ((1, 0), (1, 1), (1, 4), (1, 5), (1, 6)),
    "begin": (*_TRANSFORM, (1, 5), (1, 6), (1, 7), (1, 9)),
    "proceed": (*_TRANSFORM, (1, 8), (1, 9)),
    "finish": (*_TRANSFORM, (1, 8), (1, 10), (1, 11)),
    "normal": (*_POINTWISE, (1, 13), (1, 14)),
    "jacobian": _POINTWISE,
}
"""
Group and number of the bindings of each kernel.

All have the first of their group, used or not: without it lavapipe of Mesa 22.3 crashes.
"""
_UNIFORM = {(0, 0), (1, 0), (1, 1), (1, 2), (1, 3), (1, 12)}
_WRITTEN = {(1, 6), (1, 9), (1, 10), (1, 11), (1, 18)}

Part = tuple[Any, int, int]
"""A buffer, the first byte that is bound, and the number of bytes."""

Buffers = Mapping[tuple[int, int], Any]
"""Buffers, or parts of them, by group and binding."""


@cache
def source() -> str:
    """Return the text of the shader module: the run-time kernels, and those of an ocean."""
    own = (Path(__file__).resolve().parent / "ocean.wgsl").read_text(encoding="utf-8")
    return shader("fftocean.wgsl").decode() + own


def _pipeline(device: Device, kernel: str) -> tuple[Any, tuple[Any, ...]]:
    """Return the pipeline of a kernel and the layouts of its groups, made once a device."""
    if kernel not in device.pipelines:
        wgpu = import_module("wgpu")
        if "module" not in device.pipelines:
            device.pipelines["module"] = device.handle.create_shader_module(code=source())
        layouts = tuple(
            device.handle.create_bind_group_layout(
                entries=[
                    {
                        "binding": at[1],
                        "visibility": wgpu.ShaderStage.COMPUTE,
                        "buffer": {"type": _kind(at)},
                    }
                    for at in BINDINGS[kernel]
                    if at[0] == group
                ]
            )
            for group in (0, 1)
        )
        pipeline = device.handle.create_compute_pipeline(
            layout=device.handle.create_pipeline_layout(bind_group_layouts=layouts),
            compute={"module": device.pipelines["module"], "entry_point": kernel},
        )
        device.pipelines[kernel] = pipeline, layouts
    made: tuple[Any, tuple[Any, ...]] = device.pipelines[kernel]
    return made


def _kind(at: tuple[int, int]) -> str:
    if at in _UNIFORM:
        return "uniform"
    return "storage" if at in _WRITTEN else "read-only-storage"


class Kept:
    """Groups of bindings that are made once, of buffers that live as long as this."""

    def __init__(self) -> None:
        self.buffers: set[int] = set()  # their `id`
        self.groups: dict[tuple[Any, ...], Any] = {}


class Dispatches:
    """
    Kernels in the order in which they are given; each sees what those before it wrote.

    Args:
        device: it runs them.
        kept: bindings of earlier dispatches.
    """

    def __init__(self, device: Device, kept: Kept) -> None:
        self._device, self._kept = device, kept
        self._encoder = device.handle.create_command_encoder()
        self._pass = self._encoder.begin_compute_pass()

    def add(self, kernel: str, groups: int, buffers: Buffers) -> None:
        """Run a kernel with some buffers, of which it may need only a few."""
        pipeline, layouts = _pipeline(self._device, kernel)
        self._pass.set_pipeline(pipeline)
        for group, layout in enumerate(layouts):
            parts = {at[1]: _part(buffers[at]) for at in BINDINGS[kernel] if at[0] == group}
            self._pass.set_bind_group(group, self._bound(kernel, layout, group, parts))
        self._pass.dispatch_workgroups(groups)

    def _bound(self, kernel: str, layout: Any, group: int, parts: Mapping[int, Part]) -> Any:
        """Return a group of bindings: an earlier one, if all its buffers are kept."""
        key = (kernel, group, *((id(part[0]), *part[1:]) for part in parts.values()))
        if (found := self._kept.groups.get(key)) is not None:
            return found
        entries = [
            {"binding": at, "resource": {"buffer": buffer, "offset": offset, "size": size}}
            for at, (buffer, offset, size) in parts.items()
        ]
        made = self._device.handle.create_bind_group(layout=layout, entries=entries)
        if all(id(part[0]) in self._kept.buffers for part in parts.values()):
            self._kept.groups[key] = made
        return made

    def submit(self) -> None:
        """Start all of them."""
        self._pass.end()
        self._device.handle.queue.submit([self._encoder.finish()])


def _part(buffer: Any) -> Part:
    """Return a buffer with its first byte and size."""
    return buffer if isinstance(buffer, tuple) else (buffer, 0, buffer.size)
