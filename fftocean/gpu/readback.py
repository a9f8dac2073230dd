"""Copies from the memory of a device to arrays."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import numpy as np

from fftocean.arrays import Real

_AT_ONCE = 2**28
"""Bytes that are on their way at the same time, at most; a larger array goes alone."""


def read(device: Any, buffers: Mapping[str, Any], arrays: Mapping[str, Real]) -> None:
    """
    Copy buffers to contiguous arrays of their size; waits for what is computed into them.

    Args:
        device: of `wgpu`.
        buffers: by name.
        arrays: the same names.
    """
    waiting = list(arrays)
    while waiting:
        names = [waiting.pop(0)]
        total = buffers[names[0]].size
        while waiting and total + buffers[waiting[0]].size <= _AT_ONCE:
            total += buffers[waiting[0]].size
            names.append(waiting.pop(0))
        _read_together(device, total, [(buffers[name], arrays[name]) for name in names])


def _read_together(device: Any, total: int, pairs: list[tuple[Any, Real]]) -> None:
    wgpu = import_module("wgpu")
    staging = device.create_buffer(
        size=total, usage=wgpu.BufferUsage.COPY_DST | wgpu.BufferUsage.MAP_READ
    )
    encoder = device.create_command_encoder()
    at = 0
    for buffer, _ in pairs:
        encoder.copy_buffer_to_buffer(buffer, 0, staging, at, buffer.size)
        at += buffer.size
    device.queue.submit([encoder.finish()])
    staging.map_sync(wgpu.MapMode.READ)
    at = 0
    for buffer, array in pairs:
        data = staging.read_mapped(at, buffer.size, copy=False)
        np.copyto(array, np.frombuffer(data, array.dtype).reshape(array.shape))
        at += buffer.size
    staging.unmap()
