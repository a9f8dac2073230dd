"""
Rows of a manifest, one for each frame, packed: some hundred bytes each instead of 1,500.

A bake of many small frames has more rows than pixels. Rows are deflated together, block by block,
but for those used last.
"""

import json
import threading
import zlib
from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, overload

Row = dict[str, Any]
"""What is recorded of one frame, as plain data."""

BLOCK = 64  # rows in a block: more take less memory each, and longer to reach
OPEN = 8  # blocks that are held unpacked: workers write as many parts of the loop at a time


class PackedRows(Mapping[int, Row]):
    """
    Rows by their places, which need not adjoin; in the order of the places.

    Threads can share it. A row that is returned must not be changed.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._places: dict[int, int] = {}  # of each block, a bit for each row that it has
        self._packed: dict[int, bytes] = {}
        # those used last, the last one at the end; of them, those that `_packed` lacks
        self._open: OrderedDict[int, dict[int, Row]] = OrderedDict()
        self._changed: set[int] = set()

    @classmethod
    def of(cls, rows: Iterable[Row]) -> "PackedRows":
        """Return rows at the places from 0 on."""
        packed = cls()
        for place, row in enumerate(rows):
            packed.put(place, row)
        return packed

    def put(self, place: int, row: Row) -> None:
        """Set the row at a place."""
        number, inside = divmod(place, BLOCK)
        with self._lock:
            self._block(number)[place] = row
            self._changed.add(number)
            self._places[number] = self._places.get(number, 0) | 1 << inside

    def __getitem__(self, place: int) -> Row:
        if place not in self:
            raise KeyError(place)
        with self._lock:
            return self._block(place // BLOCK)[place]

    def __contains__(self, place: object) -> bool:
        if not isinstance(place, int):
            return False
        number, inside = divmod(place, BLOCK)
        return bool(self._places.get(number, 0) >> inside & 1)

    def __iter__(self) -> Iterator[int]:
        for number in sorted(self._places):
            places = self._places[number]
            yield from (number * BLOCK + i for i in range(BLOCK) if places >> i & 1)

    def __len__(self) -> int:
        return sum(places.bit_count() for places in self._places.values())

    def _block(self, number: int) -> dict[int, Row]:
        """Return a block that may be changed until the lock is released."""
        if number in self._open:
            self._open.move_to_end(number)
            return self._open[number]
        while len(self._open) >= OPEN:
            oldest, rows = self._open.popitem(last=False)
            if oldest in self._changed:
                text = json.dumps([*rows.items()], separators=(",", ":"), allow_nan=False)
                self._packed[oldest] = zlib.compress(text.encode())
                self._changed.discard(oldest)
        packed = self._packed.get(number)
        block = {} if packed is None else dict(json.loads(zlib.decompress(packed)))
        self._open[number] = block
        return block


def unpacked(manifest: Mapping[str, Any]) -> dict[str, Any]:
    """Return a manifest with its rows, which may be a `RowList`, as plain data."""
    return {**manifest, "frames": list(manifest["frames"])}


class RowList(Sequence[Row]):
    """Rows of all frames as a sequence that equals the list of them."""

    def __init__(self, rows: PackedRows) -> None:
        self._rows, self._count = rows, len(rows)

    @overload
    def __getitem__(self, index: int) -> Row: ...
    @overload
    def __getitem__(self, index: slice) -> list[Row]: ...
    def __getitem__(self, index: int | slice) -> Row | list[Row]:
        if isinstance(index, slice):
            return [self._rows[place] for place in range(self._count)[index]]
        return self._rows[range(self._count)[index]]

    def __len__(self) -> int:
        return self._count

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, (list, RowList)):
            return NotImplemented
        return len(self) == len(other) and all(
            mine == theirs for mine, theirs in zip(self, other, strict=True)
        )

    __hash__ = None  # type: ignore[assignment]
