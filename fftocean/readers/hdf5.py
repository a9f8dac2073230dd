"""What to check in an HDF5 file before the HDF5 library sees it, which believes what a file says, to the last byte of memory."""

import importlib
import mmap
import struct
from typing import IO, Any

import numpy as np

from fftocean.errors import ReaderError
from fftocean.readers import layout

MAGIC = b"\x89HDF\r\n\x1a\n"
MOST = 10**7  # entries along one dimension
_HEAP = b"GCOL\x01\0\0\0"


def require_sound(name: str, opened: Any) -> None:
    """
    Refuse what the library would hang on, or fill the memory with.

    Args:
        name: what to call the file in errors.
        opened: its path, or a seekable stream of it, which is left at its start.

    Raises:
        ReaderError: a heap that does not add up, or a variable, or a piece of one, of absurd size.
    """
    if hasattr(opened, "getvalue"):
        require_sound_heaps(name, opened.getvalue())
    else:
        with opened.open("rb") as file:
            _map_and_check(name, file)
    _require_sane_sizes(name, opened)
    if hasattr(opened, "seek"):
        opened.seek(0)


def _map_and_check(name: str, file: IO[bytes]) -> None:
    with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        require_sound_heaps(name, data)


def require_sound_heaps(name: str, data: bytes | mmap.mmap) -> None:
    """
    Walk the global heaps, where references between dimensions and variables are kept, as the library will.

    It takes the objects' sizes on trust: with one wrong bit in one of them it walks for ever (HDF5 2.0), and cannot be stopped.

    Raises:
        ReaderError: objects that do not fill their heap.

    Source: HDF5 File Format Specification 3.0, section III.E, "Disk Format: Level 1E - Global Heap".
    """
    if (data[9:11] if data[8] >= 2 else data[13:15]) != b"\x08\x08":
        return  # lengths that are not of 8 bytes: nobody has written such a file since the 32-bit days
    at = data.find(_HEAP)
    while at >= 0:
        (size,) = struct.unpack("<Q", data[at + 8 : at + 16].ljust(8, b"\0"))
        end, here = at + size, at + 16
        sound = size >= 16 and end <= len(data)
        while sound and here + 16 <= end:
            index, size = struct.unpack("<H6xQ", data[here : here + 16])
            step = size if index == 0 else 16 + (size + 7) // 8 * 8  # object 0 is what is free, header and all
            sound = 16 <= step <= end - here
            here += step
        if not sound:
            raise ReaderError(f"{name} must be sound HDF5, but its heap at byte {at} does not add up")
        at = data.find(_HEAP, at + 16)


def _require_sane_sizes(name: str, opened: Any) -> None:
    """A few bytes of HDF5 can declare any size, and indexes are read as soon as a file is opened: look before anything is allocated."""
    h5py: Any = importlib.import_module("h5py")
    with h5py.File(opened, "r") as file:
        file.attrs.get("_nc3_strict")  # where this fails, h5netcdf would leave a half-open file behind, and complaints on stderr
        for key, variable in file.items():
            if isinstance(variable, h5py.Dataset):
                if max(variable.shape or (0,), default=0) > MOST:
                    raise ReaderError(f"{name}: variable {key} must be at most {MOST} long, got shape {variable.shape}")
                if np.prod(variable.chunks or (1,), dtype=np.float64) > layout.MAX_VALUES:
                    raise ReaderError(
                        f"{name}: variable {key} must have chunks of at most {layout.MAX_VALUES} values, got {variable.chunks}"
                    )
