"""Depth and surface tension of one water, as the parts of a sea state them."""

import math
import numbers
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from fftocean.errors import ParameterError
from fftocean.limits import Quantity

SAME = 1e-9
"""
The relative difference of two values that are taken for one: it is what a change of units leaves.
"""

DEEPEST = 16  # parts within parts, beyond which nothing is looked for


@dataclass(frozen=True, slots=True)
class Statement:
    """A value that a part of a sea states as an attribute of its own."""

    path: str  # of the part, such as systems[0].spectrum
    kind: str  # the name of its class
    value: float

    def __str__(self) -> str:
        return f"{self.path} ({self.kind})"


def statements(name: str, path: str, part: Any) -> Iterator[Statement]:
    """
    Yield the statements about `name` of a spectrum or spreading, or else of the parts that it is
    made of.

    A part states a value by an attribute of that name that is a number; one that is None states
    nothing. The outermost statement holds: the spectrum in a `TMA` is one of deep water, and the
    `TMA` one of its depth.
    """
    yield from _statements(name, path, part, 0)


def _statements(name: str, path: str, part: Any, depth: int) -> Iterator[Statement]:
    value = getattr(part, name, None)
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        yield Statement(path, type(part).__name__, float(value))
    elif depth < DEEPEST:
        for label, inner in _parts(part):
            yield from _statements(name, f"{path}.{label}", inner, depth + 1)


def _parts(part: Any) -> Iterator[tuple[str, Any]]:
    """
    Yield the callables that an object holds as attributes, alone or in lists, with their labels;
    none of a function or a class.
    """
    if is_dataclass(part) and not isinstance(part, type):
        held: Iterable[tuple[str, Any]] = (
            (f.name, getattr(part, f.name, None)) for f in fields(part)
        )
    else:
        held = getattr(part, "__dict__", {}).items() if not isinstance(part, type) else ()
    for label, value in held:
        if isinstance(value, (list, tuple)) and len(value) <= 64:
            yield from ((f"{label}[{i}]", item) for i, item in enumerate(value) if callable(item))
        elif callable(value):
            yield label, value


def agreed(
    name: str, given: float | None, stated: Sequence[Statement], quantity: Quantity, default: float
) -> float:
    """
    Return the one value that a sea and all its parts have: the one given, else the one stated, else
    the default.

    Raises:
        ParameterError: two of them differ; the message names both.
    """
    value = None if given is None else quantity.check(name, given)
    for statement in stated:
        first = stated[0]
        if value is not None and not _same(value, statement.value):
            raise ParameterError(
                f"{name} of a sea must be that of its spectra and spreadings, "
                f"got {_with_unit(value, quantity)} for the sea and "
                f"{_with_unit(statement.value, quantity)} for {statement}"
            )
        if not _same(first.value, statement.value):
            raise ParameterError(
                f"{name} must be the same in all spectra and spreadings of a sea, got "
                f"{_with_unit(first.value, quantity)} for {first} and "
                f"{_with_unit(statement.value, quantity)} for {statement}"
            )
    if value is not None:
        return value
    return quantity.check(str(stated[0]), stated[0].value) if stated else default


def _same(a: float, b: float) -> bool:
    return math.isclose(a, b, rel_tol=SAME)


def _with_unit(value: float, quantity: Quantity) -> str:
    return f"{value:g} {quantity.unit}".rstrip()
