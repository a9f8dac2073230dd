"""
Frames computed by a graphics processor; docs/gpu.md describes it.

`Ocean(..., backend="gpu")` uses it; `adapter` tells what computes, and `DeviceFrame` holds fields
in the memory of the device.
"""

from fftocean.gpu.device import Adapter, adapter
from fftocean.gpu.device_frame import DeviceFrame

__all__ = ["Adapter", "DeviceFrame", "adapter"]
