"""
Messages of the socket: text from the page, checked in full before anything is done.

The page sends one JSON table with one key:

    {"set": {"wind_speed": 12}}       values of sent parameters
    {"verify": {"tick": 12345}}       ask for the fields of every tile at a tick
    {"job": "[sea.wind]..."}          a job file, as the base of the sea
    {"file": {"name": ..., "base64": ...}}   a job file or a measured spectrum
    {"copy": "job"}                   the job file of the sea; "command": the command that bakes it
    {"frame": {"tile": 0, "frame": 3}}       a frame of the bake that is played

The server sends text, `state`, `refused`, `copied` and `bake`, and binary messages:
containers of seas (FFTO), reference fields (FFTR) and frames of a bake (FFTB).
"""

import base64
import binascii
import json
import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NoReturn

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError
from fftocean.frame import Frame
from fftocean.limits import Count
from fftocean.view.parameters import BY_NAME, SENT

MOST_TEXT: Final = 64 * 1024  # bytes of a message
MOST_DEPTH: Final = 8  # tables within one another
TICK: Final = Count("", 0, 2**32 - 1)
TILE: Final = Count("", 0, 63)
FRAME: Final = Count("", 0, 10**6 - 1)
SEA: Final = Count("", 0, 2**53)

REFERENCE_FIELDS: Final = (
    "displace_x",
    "displace_y",
    "height",
    "stretch_xy",
    "slope_x",
    "slope_y",
    "stretch_xx",
    "stretch_yy",
)
"""Fields of a reference answer, in order."""


class Refusal(ParameterError):
    """A message that is not carried out: the reason, and the parameter in question."""

    def __init__(self, message: str, name: str | None = None) -> None:
        super().__init__(message)
        self.name = name


@dataclass(frozen=True, slots=True)
class SetValues:
    """Other values of parameters, each in its final type."""

    changes: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Verify:
    """Request for the fields at a tick of a sea; None is the newest exact one."""

    tick: int
    sea: int | None


@dataclass(frozen=True, slots=True)
class JobFile:
    """Text of a job file."""

    text: str


@dataclass(frozen=True, slots=True)
class DroppedFile:
    """Name and bytes of a file."""

    name: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Copy:
    """Request for text: "job" or "command"."""

    what: str


@dataclass(frozen=True, slots=True)
class BakedFrame:
    """Request for a frame of a bake."""

    tile: int
    frame: int


Message = SetValues | Verify | JobFile | DroppedFile | Copy | BakedFrame


def parsed(data: str | bytes) -> Message:
    """
    Return the message that the page sent.

    Raises:
        Refusal: it is not exactly one of the messages; the reason names rule and value.
    """
    if not isinstance(data, str):
        raise Refusal(f"a message must be text, got {len(data)} bytes of binary data")
    if len(data) > MOST_TEXT:
        raise Refusal(f"a message must have at most {MOST_TEXT} bytes, got {len(data)}")
    tree = _json(data)
    if not isinstance(tree, dict) or len(tree) != 1:
        raise Refusal(f"a message must be a table with one key, got {_short(tree)}")
    ((kind, content),) = tree.items()
    if kind not in _KINDS:
        raise Refusal(f"a message must be one of {', '.join(_KINDS)}, got {kind!r:.40}")
    try:
        return _KINDS[kind](content)
    except Refusal:
        raise
    except ParameterError as error:
        raise Refusal(str(error)) from None


def understood(data: str | bytes) -> Message | Refusal:
    """Return the message that the page sent, or the reason why it is none."""
    try:
        return parsed(data)
    except Refusal as refusal:
        return refusal


def _json(text: str) -> Any:
    """Return parsed JSON without NaN, infinities, repeated keys or deep nesting."""
    try:
        tree = json.loads(text, parse_constant=_no_number, object_pairs_hook=_once)
    except Refusal:
        raise
    except RecursionError:
        raise Refusal(f"a message must have at most {MOST_DEPTH} tables within another") from None
    except ValueError as error:
        raise Refusal(f"a message must be JSON: {error!s:.80}") from None
    _require_shallow(tree, MOST_DEPTH)
    return tree


def _no_number(word: str) -> NoReturn:
    raise Refusal(f"a number must be finite, got {word}")


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return the table of some pairs, no key of which is repeated."""
    table = dict(pairs)
    if len(table) != len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise Refusal(f"a key must be given once, got {twice!r:.40} twice")
    return table


def _require_shallow(tree: Any, depth: int) -> None:
    """Raise for tables and lists that are nested more deeply than `depth`."""
    if isinstance(tree, (dict, list)):
        if depth == 0:
            raise Refusal(f"a message must have at most {MOST_DEPTH} tables within another")
        for value in tree.values() if isinstance(tree, dict) else tree:
            _require_shallow(value, depth - 1)


def _short(value: Any) -> str:
    """Return a value as a message shows it."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _table(kind: str, content: Any, required: set[str], optional: frozenset[str]) -> dict[str, Any]:
    """Return the content of a message, which is a table of certain keys."""
    if not isinstance(content, dict) or not required <= set(content) <= required | optional:
        keys = ", ".join(sorted(required | optional))
        raise Refusal(f"{kind} must be a table of {keys}, got {_short(content)}")
    return content


def _set(content: Any) -> SetValues:
    if not isinstance(content, dict) or not content:
        raise Refusal(
            f'set must be a table of values, such as {{"wind_speed": 12}}, got {_short(content)}'
        )
    changes = {}
    for name, value in content.items():
        row = BY_NAME.get(name)
        if row is None or row.local:
            known = ", ".join(p.name for p in SENT)
            raise Refusal(f"set must name parameters of the sea ({known}), got {name!r:.40}", name)
        try:
            changes[name] = row.check(value)
        except ParameterError as error:
            raise Refusal(str(error), name) from None
    return SetValues(changes)


def _verify(content: Any) -> Verify:
    table = _table("verify", content, {"tick"}, frozenset({"sea"}))
    sea = None if table.get("sea") is None else SEA.check("sea", table["sea"])
    return Verify(TICK.check("tick", table["tick"]), sea)


def _job(content: Any) -> JobFile:
    if not isinstance(content, str):
        raise Refusal(f"job must be the text of a job file, got {_short(content)}")
    return JobFile(content)


def _file(content: Any) -> DroppedFile:
    table = _table("file", content, {"name", "base64"}, frozenset())
    name, text = table["name"], table["base64"]
    if not isinstance(name, str) or not isinstance(text, str):
        raise Refusal("a file must have a name and its bytes as base64, both text")
    try:
        return DroppedFile(name, base64.b64decode(text, validate=True))
    except (binascii.Error, ValueError):
        raise Refusal("the bytes of a file must be base64, and are not") from None


def _copy(content: Any) -> Copy:
    if content not in ("job", "command"):
        raise Refusal(f"copy must be job or command, got {_short(content)}")
    return Copy(content)


def _frame(content: Any) -> BakedFrame:
    table = _table("frame", content, {"tile", "frame"}, frozenset())
    return BakedFrame(TILE.check("tile", table["tile"]), FRAME.check("frame", table["frame"]))


_KINDS: Final[Mapping[str, Callable[[Any], Message]]] = {
    "set": _set,
    "verify": _verify,
    "job": _job,
    "file": _file,
    "copy": _copy,
    "frame": _frame,
}


def refused(message: str, name: str | None = None) -> str:
    """Return the text that says why a message was refused."""
    return json.dumps({"refused": {"message": message, "name": name}})


def copied(what: str, text: str) -> str:
    """Return the answer to a request for text."""
    return json.dumps({"copied": {"what": what, "text": text}})


def state_text(
    values: dict[str, Any], *, source: str, busy: bool, notes: Sequence[str], **more: Any
) -> str:
    """
    Return the text of the state: every value, its source in words, and notes on the sea.

    Args:
        values: of every sent parameter.
        source: the job, file or folder.
        busy: True while a sea is made.
        notes: what the library warns of.
        more: further keys.
    """
    return json.dumps(
        {"state": values, "source": source, "busy": busy, "notes": list(notes), **more},
        allow_nan=False,
    )


def reference(frame: Frame, *, tick: int, ticks: int, tile: int, sea: int) -> bytes:
    """Return the binary answer with the reference fields of a tile, rounded to float32."""
    fields: list[Real] = [getattr(frame, name) for name in REFERENCE_FIELDS]
    ny, nx = fields[0].shape
    header = {
        "tick": tick,
        "ticks": ticks,
        "tile": tile,
        "nx": nx,
        "ny": ny,
        "fields": list(REFERENCE_FIELDS),
        "sea": sea,
    }
    return binary(b"FFTR", header, np.stack(fields).astype("<f4").tobytes())


def binary(kind: bytes, header: dict[str, Any], data: bytes) -> bytes:
    """
    Return a binary message: four letters, version 1, length of the header, 0, header, data.

    The header is JSON, padded with spaces to a multiple of 16 bytes.
    """
    text = json.dumps(header, allow_nan=False).encode()
    text += b" " * (-len(text) % 16)
    return kind + struct.pack("<3I", 1, len(text), 0) + text + data


def as_json(tree: Any) -> bytes:
    """Return compact JSON without NaN and infinities."""
    return json.dumps(tree, allow_nan=False, separators=(",", ":")).encode()
