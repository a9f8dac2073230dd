"""Reference of job files: every key, and every kind of spectrum and spreading, as rows of text."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fftocean.fields import FIELDS
from fftocean.job.fixed_tables import CREST, FIX
from fftocean.job.parameters import PARAMETERS, Parameter
from fftocean.limits import LENGTH, Count, Quantity
from fftocean.physics import presets  # noqa: F401  registers the spectra of its numbers
from fftocean.physics.kinds import Choice, Kind, Numbers, Part, Switch
from fftocean.physics.spectra import SPECTRA
from fftocean.physics.spreading import SPREADINGS


@dataclass(frozen=True, slots=True)
class Row:
    """One key of a job file."""

    key: str
    values: str  # the permitted ones, with their unit
    default: str  # "" where one must be given
    help: str
    flag: str = ""  # the command line's, if there is one

    def matches(self, pattern: str) -> bool:
        """Return True if a text occurs in the key or its help, whatever the case."""
        wanted = pattern.casefold()
        return wanted in self.key.casefold() or wanted in self.help.casefold()


SYSTEM_ROWS = (
    Row(
        "sea.systems[].spectrum",
        "a table { kind = ... }",
        "",
        "spectrum of a wave system; its kinds are below",
    ),
    Row(
        "sea.systems[].spreading",
        "a table { kind = ... }",
        "{ kind = 'blend' }",
        "spreading over direction; its kinds are below",
    ),
    Row(
        "sea.systems[].direction",
        "a number of degrees",
        "0",
        "direction toward which the waves travel, counter-clockwise from +x (east)",
    ),
    Row(
        "sea.systems[].measured",
        "a table { file = ..., time = 0, site = 0, tail = 5.0 }, time also as a date",
        "",
        "measured spectrum instead of a formula: a file of any format that fftocean reads; tail is "
        "the exponent of a tail beyond its last frequency, none by default",
    ),
)


PLACE_ROWS = (
    ("x", "m", "place along x"),
    ("y", "m", "place along y"),
    ("t", "s", "time; the crest or value comes back with every loop"),
)
FIXED_ROWS = (
    Row(
        f"{CREST}[].height",
        f"{LENGTH.rule}, not 0",
        "",
        "height of a crest that the water is made to have, below 0 a trough; "
        "fftocean info says how rare it is",
    ),
    *(Row(f"{CREST}[].{k}", f"a number of {unit}", "0", text) for k, unit, text in PLACE_ROWS),
    Row(
        f"{FIX}[].field",
        f"one of {', '.join(FIELDS)}",
        "",
        "field of which the water is made to have one value",
    ),
    *(Row(f"{FIX}[].{k}", f"a number of {unit}", "0", text) for k, unit, text in PLACE_ROWS),
    Row(f"{FIX}[].value", "a number, in the unit of the field", "", "that value"),
)


def key_rows() -> tuple[Row, ...]:
    """Return one row for each key of a job file, in the order of the table of parameters."""
    return (*(_row(parameter) for parameter in PARAMETERS), *SYSTEM_ROWS, *FIXED_ROWS)


def _row(parameter: Parameter) -> Row:
    """Return the row of a parameter."""
    return Row(
        parameter.key,
        parameter.rule,
        default_text(parameter.default),
        parameter.help,
        f"--{parameter.flag}" if parameter.flag else "",
    )


def default_text(value: Any) -> str:
    """Return a default as it is written in TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return "inf" if math.isinf(value) else f"{value:g}"
    if isinstance(value, tuple):
        return "[" + ", ".join(default_text(item) for item in value) + "]"
    return f"'{value}'" if isinstance(value, str) else str(value)


@dataclass(frozen=True, slots=True)
class KindRow:
    """One kind of spectrum or spreading."""

    role: str  # "spectrum" or "spreading"
    name: str
    summary: str  # first sentence of its class
    ways: tuple[str, ...]  # sets of keys of which it can be made; optional keys in brackets
    keys: tuple[tuple[str, str], ...]  # each key, and its permitted values

    def matches(self, pattern: str) -> bool:
        """Return True if a text occurs in name, summary or keys, whatever the case."""
        text = " ".join((self.role, self.name, self.summary, *(key for key, _ in self.keys)))
        return pattern.casefold() in text.casefold()


def kind_rows() -> tuple[KindRow, ...]:
    """Return one row for each kind of spectrum, then of spreading."""
    registries: tuple[Mapping[str, Kind[Any]], ...] = (
        SPECTRA,
        SPREADINGS,
    )
    return tuple(
        _kind_row(role, kind)
        for role, registry in zip(("spectrum", "spreading"), registries, strict=True)
        for kind in registry.values()
    )


def _kind_row(role: str, kind: Kind[Any]) -> KindRow:
    """Return the row of a kind."""
    rules: dict[str, str] = {}
    for way in kind.ways:
        for name, rule in way.keys.items():
            rules.setdefault(name, _values(rule))
    summary = (kind.model.__doc__ or "").strip().partition("\n\n")[0]
    return KindRow(
        role,
        kind.name,
        " ".join(summary.split()),
        tuple(str(way) for way in kind.ways),
        tuple(rules.items()),
    )


def _values(rule: Any) -> str:
    """Return the permitted values of a kind's key, in words."""
    if isinstance(rule, Quantity):
        return ("a whole number " if isinstance(rule, Count) else "") + rule.rule
    if isinstance(rule, Choice):
        return f"one of {', '.join(rule.words)}"
    if isinstance(rule, Part):
        return f"another {rule.role}, as a table"
    if isinstance(rule, Switch):
        return "true or false"
    return "a list or table of numbers" if isinstance(rule, Numbers) else str(rule)
