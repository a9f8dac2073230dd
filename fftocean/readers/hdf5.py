"""
Checks of an HDF5 file before the HDF5 library reads data from it.

The library trusts the file: it opens other files that the data refer to, allocates any size, loads
filters, and unpacks chunks of any size. These checks read only the headers of all objects.
"""

import importlib
import io
import mmap
import struct
from collections.abc import Iterator
from typing import IO, Any, Final

import numpy as np

from fftocean.errors import ReaderError

MAGIC: Final = b"\x89HDF\r\n\x1a\n"
MOST: Final = 10**7
"""Entries along one dimension."""

MOST_OBJECTS: Final = 500
"""Variables and groups in a file; opening each takes 2 ms."""

MOST_ATTRIBUTES: Final = 200
"""Attributes of one object."""

MOST_ATTRIBUTE_BYTES: Final = 2**22
"""Size of one attribute."""

MOST_FILE_BYTES: Final = 2**33
"""Size of a file: a copy of all of one place and month is far smaller."""

MOST_CHUNK_BYTES: Final = 2**27
"""Size of a chunk, unpacked: half a second."""

MOST_AXIS_BYTES: Final = 2**28
"""Size of all one-dimensional variables together, which may be read when the file is opened."""

MOST_RATIO: Final = 1100
"""Bytes unpacked from each byte of the file; deflate reaches 1032."""

_FILTERS: Final = {
    1: "deflate",
    2: "shuffle",
    3: "fletcher32",
    4: "szip",
    5: "n-bit",
    6: "scale-offset",
}
_HEAP: Final = b"GCOL\x01\0\0\0"


def require_sound(name: str, stream: IO[bytes]) -> list[str]:
    """
    Raise if a file refers to other files, or would make the library hang or exhaust memory.

    Args:
        name: what to call the file in errors.
        stream: a seekable stream of it, which is left at its start.

    Returns:
        The names of variables of the root group that are not numbers, which need not be read.

    Raises:
        ReaderError: data, links or filters that lie outside the file; a heap with wrong sizes;
            too many objects; or a variable, a chunk or an attribute of absurd size.
    """
    size = stream.seek(0, io.SEEK_END)
    if size > MOST_FILE_BYTES:
        raise ReaderError(
            f"{name} must be at most {MOST_FILE_BYTES >> 30} GiB, "
            f"got {size} bytes (cut out one place with xarray)"
        )
    if isinstance(stream, io.BytesIO):
        longest = require_sound_heaps(name, stream.getvalue())
    else:
        with mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
            longest = require_sound_heaps(name, data)
    stream.seek(0)
    unread = _require_sound_objects(name, stream, size, longest)
    stream.seek(0)
    return unread


def require_sound_heaps(name: str, data: bytes | mmap.mmap) -> int:
    """
    Walk the global heaps, which hold the references between dimensions and variables, as the
    library does.

    The library trusts the sizes of objects: one wrong bit in a size makes it loop for ever (HDF5
    2.0), and it cannot be interrupted.

    Returns:
        The size of the largest object in a heap [bytes].

    Raises:
        ReaderError: objects that do not fill their heap.

    Source: HDF5 File Format Specification 3.0, section III.E, "Disk Format: Level 1E - Global
    Heap".
    """
    if (data[9:11] if data[8] >= 2 else data[13:15]) != b"\x08\x08":
        return len(data)  # lengths of other than 8 bytes, as on 32-bit systems
    longest = 0
    at = data.find(_HEAP)
    while at >= 0:
        (size,) = struct.unpack("<Q", data[at + 8 : at + 16].ljust(8, b"\0"))
        end, here = at + size, at + 16
        sound = size >= 16 and end <= len(data)
        while sound and here + 16 <= end:
            index, size = struct.unpack("<H6xQ", data[here : here + 16])
            step = (
                size if index == 0 else 16 + (size + 7) // 8 * 8
            )  # object 0 is the free space, its header included
            sound = 16 <= step <= end - here
            longest = max(longest, size if index else 0)
            here += step
        if not sound:
            raise ReaderError(
                f"{name} must be intact HDF5, but its heap at byte {at} has wrong sizes"
            )
        at = data.find(_HEAP, at + 16)
    return longest


def _require_sound_objects(name: str, stream: IO[bytes], size: int, longest: int) -> list[str]:
    """Check every object of the file; return the variables of the root that are not numbers."""
    h5py: Any = importlib.import_module("h5py")
    unread, axes = [], 0
    with h5py.File(stream, "r") as file:
        # Where this fails, h5netcdf would leave a half-open file behind, and complaints on stderr.
        file.attrs.get("_nc3_strict")
        _require_sane_attributes(h5py, f"{name}: the file", file.id, size, longest)
        for path, item in _objects(h5py, name, file.id):
            where = f"{name}: variable {path}"
            _require_sane_attributes(h5py, where, item, size, longest)
            if isinstance(item, h5py.h5d.DatasetID):
                axes += _require_sane_variable(h5py, where, item, size)
                if "/" not in path and not _is_numeric(h5py, item):
                    unread.append(path)
            if axes > MOST_AXIS_BYTES:
                raise ReaderError(
                    f"{name} must hold at most {MOST_AXIS_BYTES >> 20} MiB of axes, "
                    f"got more by variable {path}"
                )
    return unread


def _objects(h5py: Any, name: str, root: Any) -> Iterator[tuple[str, Any]]:
    """
    Yield all objects of a file by its links; raise if a link leads out of the file or nowhere.

    No object is opened by a path, because the library would follow links along it.
    """
    pending, seen, count = [("", root)], {h5py.h5o.get_info(root).addr}, 0
    while pending:
        folder, group = pending.pop()
        for key in _names(group):
            count += 1
            path = folder + key.decode("utf-8", "replace")
            if count > MOST_OBJECTS:
                raise ReaderError(
                    f"{name} must hold at most {MOST_OBJECTS} variables and groups, "
                    "got more (cut it with xarray)"
                )
            kind = group.links.get_info(key).type
            if kind != h5py.h5l.TYPE_HARD:
                words = {
                    h5py.h5l.TYPE_SOFT: "a soft link",
                    h5py.h5l.TYPE_EXTERNAL: "a link to another file",
                }
                raise ReaderError(
                    f"{name}: variable {path} must lie in the file itself, "
                    f"got {words.get(kind, 'a user-defined link')}"
                )
            item = h5py.h5o.open(group, key)
            address = h5py.h5o.get_info(item).addr
            if address in seen:
                continue
            seen.add(address)
            yield path, item
            if isinstance(item, h5py.h5g.GroupID):
                pending.append((path + "/", item))


def _names(group: Any) -> list[bytes]:
    """Return the names of a group's links; raise if there are too many."""
    found: list[bytes] = []

    def note(key: bytes) -> bool | None:
        found.append(key)
        return True if len(found) > MOST_OBJECTS else None  # any value but None ends the visit

    group.links.iterate(note)
    return found


def _require_sane_variable(h5py: Any, where: str, item: Any, size: int) -> int:
    """
    Check location and size of the data of a variable; return the bytes of an axis.
    """
    plan = item.get_create_plist()
    if plan.get_external_count():
        raise ReaderError(
            f"{where} must lie in the file itself, got data in another file (HDF5 external storage)"
        )
    layout = plan.get_layout()
    if (
        layout == h5py.h5d.VIRTUAL
    ):  # checked before the shape, for which the library may open the other files
        raise ReaderError(
            f"{where} must lie in the file itself, got data in other files (HDF5 virtual dataset)"
        )
    shape = item.shape
    if max(shape or (0,), default=0) > MOST:
        raise ReaderError(f"{where} must be at most {MOST} long, got shape {shape}")
    width = item.get_type().get_size()
    if layout == h5py.h5d.CHUNKED:
        for i in range(plan.get_nfilters()):
            code = plan.get_filter(i)[0]
            if code not in _FILTERS:
                raise ReaderError(
                    f"{where} must be compressed by a filter of HDF5's own "
                    f"({', '.join(_FILTERS.values())}), "
                    f"got filter {code} (convert it with nccopy -d 1)"
                )
        chunk = plan.get_chunk()
        if np.prod(chunk, dtype=np.float64) * width > MOST_CHUNK_BYTES:
            raise ReaderError(
                f"{where} must have chunks of at most {MOST_CHUNK_BYTES >> 20} MiB, "
                f"got {chunk} of {width} bytes each"
            )
    declared = float(np.prod(shape or (0,), dtype=np.float64)) * width
    if len(shape or ()) != 1:
        return 0
    if declared > 2**20 + MOST_RATIO * size:
        raise ReaderError(
            f"{where} must not be larger than its file can hold, "
            f"got {shape} of {width} bytes each in {size} bytes"
        )
    return int(declared)


def _is_numeric(h5py: Any, item: Any) -> bool:
    """Return True if a variable holds plain integers or floating-point numbers."""
    return item.get_type().get_class() in (h5py.h5t.INTEGER, h5py.h5t.FLOAT)


def _require_sane_attributes(
    h5py: Any, where: str, item: Any, file_size: int, longest: int
) -> None:
    """
    Check the number and sizes of an object's attributes.

    Values of variable length lie in heaps, and one of them may be referred to many times.
    """
    count = h5py.h5a.get_num_attrs(item)
    if count > MOST_ATTRIBUTES:
        raise ReaderError(f"{where} must have at most {MOST_ATTRIBUTES} attributes, got {count}")
    for i in range(count):
        attribute = h5py.h5a.open(item, index=i)
        kind = attribute.get_type()
        size, most = attribute.get_storage_size(), MOST_ATTRIBUTE_BYTES
        if kind.get_class() == h5py.h5t.VLEN or (
            kind.get_class() == h5py.h5t.STRING and kind.is_variable_str()
        ):
            size, most = size // 16 * longest, most + file_size
        if size > most:
            shown = attribute.name.decode("utf-8", "replace")
            raise ReaderError(
                f"{where}: attribute {shown} must be at most {most >> 10} KiB, got {size} bytes"
            )
