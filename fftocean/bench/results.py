"""Results of benchmarks: the question, the machine, the settings and every reading."""

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from fftocean.bench import machine
from fftocean.bench.timing import Clock, Summary, alternate, summary
from fftocean.errors import ReaderError
from fftocean.files import as_json, write_whole

SCHEMA = 1
UNITS = ("s", "ms", "ns", "MiB", "x", "%", "1/s", "m", "1", "n")
CLOCKS = ("cpu", "wall", "")
BUSY = "wall time / CPU time"
Condition = str | int | float | bool


@dataclass(frozen=True, slots=True)
class Reading:
    """
    One measured quantity: its median with quartiles, the clock, and the conditions.
    """

    what: str
    unit: str
    median: float
    low: float
    high: float
    count: int
    clock: str = ""  # "cpu", "wall", or "" for quantities that are not times
    at: Mapping[str, Condition] = field(
        default_factory=dict
    )  # n, backend, dtype, threads, fields, ...

    def __post_init__(self) -> None:
        numbers = (self.low, self.median, self.high)
        if not all(math.isfinite(v) for v in numbers) or not self.low <= self.median <= self.high:
            raise ReaderError(
                f"{self.what}: low <= median <= high must hold, finite, got {numbers}"
            )
        if self.count < 1 or self.unit not in UNITS or self.clock not in CLOCKS:
            raise ReaderError(
                f"{self.what}: count, unit or clock is unknown, got {self.count}, "
                f"{self.unit!r}, {self.clock!r}"
            )

    @classmethod
    def of(
        cls,
        what: str,
        unit: str,
        s: Summary,
        at: Mapping[str, Condition],
        *,
        scale: float = 1.0,
        clock: str = "",
    ) -> "Reading":
        """Return a reading from a summary, each of its numbers times `scale`."""
        return cls(what, unit, scale * s.median, scale * s.low, scale * s.high, s.count, clock, at)

    @classmethod
    def single(
        cls, what: str, unit: str, value: float, at: Mapping[str, Condition], *, clock: str = ""
    ) -> "Reading":
        """Return a reading without spread: counted, computed, or measured once."""
        return cls(what, unit, float(value), float(value), float(value), 1, clock, at)

    def scaled(self, factor: float) -> "Reading":
        """Return the reading times a factor, which extends the cost of a part to the whole."""
        return replace(
            self, median=factor * self.median, low=factor * self.low, high=factor * self.high
        )

    def plain(self) -> dict[str, Any]:
        """Return the values as they are stored in JSON."""
        spread = {"median": self.median, "quartiles": [self.low, self.high], "count": self.count}
        return {"what": self.what, **self.at, "unit": self.unit, **spread, "clock": self.clock}


@dataclass(frozen=True, slots=True)
class Result:
    """The answer to one question."""

    question: str  # the name of the script
    asks: str  # the question in words
    readings: tuple[Reading, ...]
    settings: Mapping[str, Any]
    machine: Mapping[str, Any]
    before: Mapping[str, Any]  # the time and load before; `after` likewise
    after: Mapping[str, Any]

    def find(self, what: str, *, clock: str | None = None, **at: Condition) -> Reading:
        """
        Return the one reading of that name under these conditions.

        Raises:
            LookupError: there is none, or more than one.
        """
        found = self.all(what, clock=clock, **at)
        if len(found) != 1:
            raise LookupError(f"{self.question} holds {len(found)} readings of {what!r} at {at}")
        return found[0]

    def all(self, what: str, *, clock: str | None = None, **at: Condition) -> list[Reading]:
        """Return all readings of that name, by that clock if given, under these conditions."""
        named = (r for r in self.readings if r.what == what and clock in (None, r.clock))
        return [r for r in named if all(r.at.get(key) == value for key, value in at.items())]

    def plain(self) -> dict[str, Any]:
        """Return the values as they are stored in JSON."""
        return {
            "schema": SCHEMA,
            "question": self.question,
            "asks": self.asks,
            "machine": dict(self.machine),
            "before": dict(self.before),
            "after": dict(self.after),
            "settings": dict(self.settings),
            "readings": [r.plain() for r in self.readings],
        }

    def write(self, path: Path) -> None:
        """
        Write the JSON, whole or not at all.

        Raises:
            OutputError: it could not be written.
        """
        write_whole(path, as_json(self.plain()))


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """A contender: its name, its function, and its conditions."""

    what: str
    run: Callable[[], object]
    at: Mapping[str, Condition]


class Pair(NamedTuple):
    """Two entries of a race whose ratio, slow over fast, is a reading of its own."""

    what: str
    slow: Entry
    fast: Entry


def race(
    entries: Sequence[Entry],
    pairs: Sequence[Pair] = (),
    *,
    clock: Clock,
    seconds: float,
    tick: Callable[[], object] | None = None,
) -> list[Reading]:
    """
    Time contenders alternately.

    Args:
        entries: the contenders.
        pairs: whose ratios are taken round by round, under the conditions of the fast one.
        clock: "cpu" or "wall".
        seconds: the approximate duration [s].
        tick: called after each round.

    Returns:
        A reading of each entry [ms], of each pair, and of wall time over CPU time.
    """
    names = {entry: str(i) for i, entry in enumerate(entries)}
    rounds = alternate({names[entry]: entry.run for entry in entries}, seconds=seconds, tick=tick)
    readings = [
        Reading.of(e.what, "ms", rounds.seconds(names[e], clock), e.at, scale=1e3, clock=clock)
        for e in entries
    ]
    for pair in pairs:
        ratio = rounds.ratio(names[pair.slow], names[pair.fast], clock)
        readings.append(Reading.of(pair.what, "x", ratio, pair.fast.at, clock=clock))
    if clock == "cpu":  # 1 if no other process used the core
        first = names[entries[0]]
        readings.append(
            Reading.of(BUSY, "x", summary(rounds.wall[first] / rounds.cpu[first]), entries[0].at)
        )
    return readings


def answer(
    question: str,
    asks: str,
    readings: Iterable[Reading],
    settings: Mapping[str, Any],
    before: Mapping[str, Any],
) -> Result:
    """Return readings together with a description of the machine."""
    return Result(
        question,
        asks,
        tuple(readings),
        dict(settings),
        machine.describe(),
        before,
        machine.moment(),
    )


def read(path: Path) -> Result:
    """
    Read a result from a file.

    Raises:
        ReaderError: the file does not exist, or is not a result.
    """
    try:
        tree = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ReaderError(f"{path} must be a result of a benchmark: {error!s:.120}") from None
    return parse(tree, str(path))


def parse(tree: Any, source: str = "result") -> Result:
    """
    Return a result from plain data, every part of which is checked.

    Raises:
        ReaderError: a part is missing, unknown, or of another type.
    """
    if not isinstance(tree, dict) or tree.get("schema") != SCHEMA:
        raise ReaderError(f"{source} must be a result of schema {SCHEMA}")
    kinds: dict[str, type] = {
        "question": str,
        "asks": str,
        "machine": dict,
        "before": dict,
        "after": dict,
        "settings": dict,
        "readings": list,
    }
    for key, kind in kinds.items():
        if not isinstance(tree.get(key), kind):
            raise ReaderError(
                f"{source}: {key} must be a {kind.__name__}, got {tree.get(key)!r:.40}"
            )
    if extra := sorted(tree.keys() - kinds.keys() - {"schema"}):
        raise ReaderError(f"{source}: unknown keys {', '.join(extra)}")
    readings = tuple(
        _reading(row, f"{source}: readings[{i}]") for i, row in enumerate(tree["readings"])
    )
    return Result(readings=readings, **{key: tree[key] for key in kinds if key != "readings"})


def _reading(row: Any, source: str) -> Reading:
    """Return a reading from a row of JSON, every value of which is checked."""
    try:
        rest = dict(row)
        what, unit, median, count, clock = (
            rest.pop(key) for key in ("what", "unit", "median", "count", "clock")
        )
        low, high = rest.pop("quartiles")
        words, numbers = (what, unit, clock), (median, low, high)
        whole = all(isinstance(word, str) for word in words) and all(_is_number(v) for v in numbers)
        if (
            not whole
            or type(count) is not int
            or not all(isinstance(v, str | int | float) for v in rest.values())
        ):
            raise TypeError("a value of another type")
        return Reading(what, unit, float(median), float(low), float(high), count, clock, rest)
    except (KeyError, TypeError, ValueError) as error:  # a ReaderError is a ValueError
        raise ReaderError(f"{source} is no reading: {error!s:.120}") from None


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
