"""
Checks of the header of a netCDF 3 file.

They come before any variable is read, because the netCDF 3 reader trusts the header.
"""

import io
import struct
from typing import IO, Final

from fftocean.errors import ReaderError

MOST_BYTES: Final = 2**30
"""Size of a file, all of which is read into memory."""

MOST_ITEMS: Final = 500
"""Dimensions, variables, or attributes of one variable."""

_DIMENSIONS, _VARIABLES, _ATTRIBUTES = 10, 11, 12
_SIZES: Final = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8}
_STREAMING: Final = 0xFFFFFFFF


def require_sound(name: str, stream: IO[bytes]) -> None:
    """
    Raise if the header of a file does not fit its size.

    Args:
        name: what to call the file in errors.
        stream: a seekable stream of it, which is left at its start.

    Raises:
        ReaderError: a header that is cut, too many variables, or variables that lie outside the
            file or together are larger than it.

    Source: The NetCDF Classic Format Specification.
    """
    size = stream.seek(0, io.SEEK_END)
    if size > MOST_BYTES:
        raise ReaderError(
            f"{name} must be at most {MOST_BYTES >> 20} MiB, "
            f"got {size} bytes (cut out one place with xarray)"
        )
    stream.seek(3)
    header = _Header(name, stream)
    wide = stream.read(1) == b"\x02"
    records = header.whole()
    lengths = []
    for _ in range(header.items(_DIMENSIONS)):
        header.text()
        lengths.append(header.whole())
    header.attributes()
    total = 0
    for _ in range(header.items(_VARIABLES)):
        where = f"{name}: variable {header.text()}"
        axes = [header.whole() for _ in range(header.whole_up_to(MOST_ITEMS, where))]
        if any(axis >= len(lengths) for axis in axes):
            raise ReaderError(
                f"{where} must have dimensions that the file has, "
                f"got number {max(axes)} of {len(lengths)}"
            )
        header.attributes()
        bytes_each = header.bytes_of_type(where)
        header.whole()  # its stored size, which is computed here instead
        begin = header.whole() if not wide else header.whole() << 32 | header.whole()
        shape = [lengths[axis] for axis in axes]
        if shape and shape[0] == 0:
            shape[0] = 0 if records == _STREAMING else records
        for length in shape:
            bytes_each *= length
        total += bytes_each
        if begin + (bytes_each if axes and lengths[axes[0]] else 0) > size or total > size:
            raise ReaderError(
                f"{where} must lie in the file, got {shape} values from byte {begin} on in "
                f"{size} bytes: the file is cut short"
            )
    stream.seek(0)


class _Header:
    """Sequential reader of a header's numbers and names: big-endian, padded to 4 bytes."""

    def __init__(self, name: str, stream: IO[bytes]) -> None:
        self.name = name
        self._stream = stream

    def _read(self, count: int) -> bytes:
        data = self._stream.read(count)
        if len(data) < count:
            raise ReaderError(f"{self.name} cannot be read as netCDF: its header is cut short")
        return data

    def whole(self) -> int:
        """Return a 4-byte integer."""
        return int(struct.unpack(">I", self._read(4))[0])

    def whole_up_to(self, most: int, where: str) -> int:
        """Return a count."""
        count = self.whole()
        if count > most:
            raise ReaderError(
                f"{where} must have at most {most} dimensions, variables or attributes, got {count}"
            )
        return count

    def items(self, tag: int) -> int:
        """Return the number of items of a list."""
        found, count = self.whole(), self.whole_up_to(MOST_ITEMS, self.name)
        if found not in (0, tag) or (found == 0 and count):
            raise ReaderError(
                f"{self.name} cannot be read as netCDF: a list of its header has the tag "
                f"{found}, not {tag}"
            )
        return count

    def text(self) -> str:
        """Return a name."""
        length = self.whole()
        if length > 4096:
            raise ReaderError(
                f"{self.name} cannot be read as netCDF: a name must be at most 4096 bytes long, "
                f"got {length}"
            )
        return self._read(length + -length % 4)[:length].decode("utf-8", "replace")

    def bytes_of_type(self, where: str) -> int:
        """Return the size of one value of a type."""
        code = self.whole()
        if code not in _SIZES:
            raise ReaderError(f"{where} must be of a type between 1 and 6, got {code}")
        return _SIZES[code]

    def attributes(self) -> None:
        """Skip a list of attributes."""
        for _ in range(self.items(_ATTRIBUTES)):
            where = f"{self.name}: attribute {self.text()}"
            length = self.bytes_of_type(where) * self.whole()
            if length > 2**22:
                raise ReaderError(f"{where} must be at most 4 MiB, got {length} bytes")
            self._read(length + -length % 4)
