"""TOML text of a job, from which the same job is read back."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from fftocean.job.fixed_tables import described
from fftocean.job.job import Job
from fftocean.job.parameters import PARAMETERS, WIND

NUMBERS_A_LINE = 8  # of a long array: the lines of a job file are limited


def job_text(
    job: Job, *, comments: Sequence[str] = (), files: Mapping[str, str] | None = None
) -> str:
    """
    Return the TOML text of a job.

    Keys with their default value are left out, except those of the wind and the tile.

    Args:
        job: any job.
        comments: lines at the top.
        files: other names for measured files, by the names that the job has for them.
    """
    lines = [f"# {_one_line(text)}" for text in comments]
    table = ""
    for parameter in PARAMETERS:
        value = job.settings[parameter.key]
        shown = job.wind if parameter in WIND else parameter.key.startswith("ocean.")
        if not shown and value == parameter.default:
            continue
        if parameter in WIND and not job.wind:
            continue
        head, _, name = parameter.key.rpartition(".")
        if head != table:
            lines += ["", f"[{head}]"] if lines else [f"[{head}]"]
            table = head
        unit = f"  # [{parameter.unit}]" if parameter.unit else ""
        lines.append(f"{name} = {toml_value(value)}{unit}")
    for system in job.systems:
        lines += ["", "[[sea.systems]]"]
        for name, value in _renamed(system, files or {}).items():
            lines.append(f"{_key(name)} = {toml_value(value)}")
    for key, tables in described(job.crests, job.fixes).items():
        for row in tables:
            lines += ["", f"[[{key}]]", *(f"{name} = {toml_value(row[name])}" for name in row)]
    return "\n".join(lines) + "\n"


def _renamed(system: Mapping[str, Any], files: Mapping[str, str]) -> dict[str, Any]:
    """Return the table of a wave system with another name for its measured file."""
    table = dict(system)
    measured = table.get("measured")
    if isinstance(measured, Mapping) and measured.get("file") in files:
        table["measured"] = {**measured, "file": files[measured["file"]]}
    return table


def toml_value(value: Any) -> str:
    """Return a value as TOML; tables are written within braces."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isfinite(value):
            return repr(value)
        return "nan" if math.isnan(value) else ("inf" if value > 0.0 else "-inf")
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(k)} = {toml_value(v)}" for k, v in value.items())
        return "{ " + inner + " }" if inner else "{}"
    items = [toml_value(v) for v in value]
    if len(items) <= NUMBERS_A_LINE:
        return f"[{', '.join(items)}]"
    rows = [items[i : i + NUMBERS_A_LINE] for i in range(0, len(items), NUMBERS_A_LINE)]
    return "[\n" + "".join(f"  {', '.join(row)},\n" for row in rows) + "]"


def _key(name: str) -> str:
    """Return a key, in quotes where it needs them."""
    bare = name and all(c.isascii() and (c.isalnum() or c in "-_") for c in name)
    return name if bare else _text(name)


def _text(value: str) -> str:
    """Return a string in quotes, with escapes for quotes and all that is not printable."""
    escaped = []
    for c in value:
        if c in '"\\':
            escaped.append("\\" + c)
        elif c.isprintable():
            escaped.append(c)
        else:
            escaped.append(f"\\u{ord(c):04x}" if ord(c) < 0x10000 else f"\\U{ord(c):08x}")
    return '"' + "".join(escaped) + '"'


def _one_line(text: str) -> str:
    """Return text without line breaks and control characters, which would end a comment."""
    return "".join(c if c.isprintable() else " " for c in text)
