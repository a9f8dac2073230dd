"""Frames whose fields stay in the memory of the graphics processor."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from fftocean.errors import DeviceError, FieldError
from fftocean.forks import Process, no_fork
from fftocean.frame import Frame
from fftocean.gpu import readback
from fftocean.gpu.device import errors
from fftocean.grid import Grid


class DeviceFrame:
    """
    The water at one time, as buffers of `wgpu`, one a field.

    Each is float32, row by row from the south-west, (ny, nx) as in a `Frame`; "normal" is (ny, nx,
    3), without padding. They may be bound as storage, vertex or copy sources, belong to the frame
    alone, and are released with it.
    """

    __slots__ = ("_buffers", "_process", "choppiness", "device", "grid", "t")

    def __init__(
        self, t: float, grid: Grid, choppiness: float, device: Any, buffers: Mapping[str, Any]
    ) -> None:
        self.t = t  # [s]
        self.grid = grid
        self.choppiness = choppiness
        self.device = device  # the wgpu.GPUDevice of the buffers
        self._buffers, self._process = dict(buffers), Process()

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the fields."""
        return tuple(self._buffers)

    def __getitem__(self, name: str) -> Any:
        """
        Return the wgpu.GPUBuffer of a field.

        Raises:
            FieldError: it was not asked for.
        """
        try:
            return self._buffers[name]
        except KeyError:
            raise FieldError(
                f"this frame has {', '.join(self._buffers)}; "
                f"for {name} ask device_frame(t, fields=({name!r}, ...))"
            ) from None

    def read(self, fields: Iterable[str] | None = None) -> Frame:
        """
        Return the same frame with its fields in NumPy arrays.

        Args:
            fields: names; None for all.

        Raises:
            FieldError: one that was not asked for.
            DeviceError: the device was lost, or is that of the process before a fork.
        """
        names = self.fields if fields is None else tuple(fields)
        shape = self.grid.shape
        arrays = {
            name: np.empty((*shape, 3) if name == "normal" else shape, np.float32) for name in names
        }
        buffers = {name: self[name] for name in names}
        if not self._process.is_current:
            raise DeviceError(
                "a frame on the device cannot be read in a forked child; compute its own"
            )
        try:
            with no_fork():
                readback.read(self.device, buffers, arrays)
        except errors() as error:
            raise DeviceError(
                f"the device of {self!r} was lost; compute the frame again"
            ) from error
        return Frame(self.t, self.grid, self.choppiness, arrays)

    def __repr__(self) -> str:
        size = f"{self.grid.nx} x {self.grid.ny}"
        return f"DeviceFrame(t={self.t}, {size}, {', '.join(self._buffers)})"
