"""Tables of fixed values in a job: [[ocean.crest]] and [[ocean.fix]]."""

from collections.abc import Mapping, Sequence
from typing import Any

from fftocean.errors import JobError, ParameterError, suggestion
from fftocean.fixed_values import Crest, Fix

CREST, FIX = "ocean.crest", "ocean.fix"
MOST = 64
"""Tables of each kind: the cost grows with the square of the values."""

_CREST_KEYS = ("height", "x", "y", "t")
_FIX_KEYS = ("field", "x", "y", "t", "value")


def crests_of(value: Any, source: str) -> tuple[Crest, ...]:
    """
    Return the crests of the tables [[ocean.crest]].

    Raises:
        JobError: not tables, an unknown or missing key, or a value out of range.
    """
    tables = _tables(CREST, value, _CREST_KEYS, ("height",), source)
    return tuple(_made(f"{CREST}[{i}]", Crest, table, source) for i, table in enumerate(tables))


def fixes_of(value: Any, source: str) -> tuple[Fix, ...]:
    """
    Return the values of the tables [[ocean.fix]].

    Raises:
        JobError: as `crests_of`.
    """
    tables = _tables(FIX, value, _FIX_KEYS, ("field", "value"), source)
    start = {"x": 0.0, "y": 0.0, "t": 0.0}
    return tuple(
        _made(f"{FIX}[{i}]", Fix, {**start, **table}, source) for i, table in enumerate(tables)
    )


def described(crests: Sequence[Crest], fixes: Sequence[Fix]) -> dict[str, list[dict[str, Any]]]:
    """Return the tables, by their keys; keys without tables are left out."""
    tables = {
        CREST: [{key: getattr(crest, key) for key in _CREST_KEYS} for crest in crests],
        FIX: [{key: getattr(fix, key) for key in _FIX_KEYS} for fix in fixes],
    }
    return {key: rows for key, rows in tables.items() if rows}


def _tables(
    key: str, value: Any, keys: Sequence[str], needed: Sequence[str], source: str
) -> list[Mapping[str, Any]]:
    """Return a list of tables with known keys, of which some must be there."""
    if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
        raise JobError(f"{source}: {key} must be tables, written [[{key}]], got {value!r:.60}")
    if len(value) > MOST:
        raise JobError(f"{source}: {key} must be at most {MOST} tables, got {len(value)}")
    for i, table in enumerate(value):
        for name in table:
            if name not in keys:
                raise JobError(
                    f"{source}: {key}[{i}] must have the keys {', '.join(keys)}, "
                    f"got {name!r:.60}{suggestion(name, keys)}"
                )
        for name in needed:
            if name not in table:
                raise JobError(f"{source}: {key}[{i}].{name} must be given")
    return value


def _made(key: str, kind: Any, table: Mapping[str, Any], source: str) -> Any:
    """Return the value of a table."""
    try:
        return kind(**table)
    except ParameterError as error:
        raise JobError(f"{source}: {key}.{error}") from None
