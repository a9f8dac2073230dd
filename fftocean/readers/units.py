"""
Units of measurement of wave files in the spellings of UDUNITS and the CF conventions.

A unit is a product of powers of metre, second, kilogram and radian times a number. Juxtaposition,
`.`, `*` and `·` multiply; `/` and `per` divide; both bind alike and from left to right, as in
UDUNITS. Powers are `m2`, `m^2`, `m**2`, `m^{2}`, `m²`. `log10(...)`, `lg(re ...)` and `ln(re ...)`
are logarithms of a unit.

Source: UDUNITS-2 Documentation, "Unit Grammar"; CF conventions, section 3.1.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from fftocean.arrays import Real

LONGEST: Final = 200
"""The longest unit that is parsed, in characters."""

LARGEST_POWER: Final = 9


@dataclass(frozen=True, slots=True)
class Unit:
    """A number times powers of base units, or a logarithm of such a quantity."""

    scale: float = 1.0  # of one unit in SI
    powers: Mapping[str, int] = field(default_factory=dict)  # of m, s, kg, rad; none of them 0
    base: float | None = None  # base of the logarithm; None for plain values
    offset: float = 0.0  # added, in the unit, before the logarithm was taken

    def is_(self, **powers: int) -> bool:
        """Return True if the unit has exactly these powers of base units."""
        return dict(self.powers) == powers

    def linear(self, values: Real) -> Real:
        """Return values in SI, after inverting the logarithm and subtracting its offset."""
        if self.base is not None:
            with np.errstate(under="ignore", over="ignore"):
                values = np.maximum(self.base**values - self.offset, 0.0)
        return values * self.scale

    def times(self, other: "Unit", sign: int = 1) -> "Unit":
        """Return the product with another unit (with its inverse where sign is -1)."""
        powers = dict(self.powers)
        for name, power in other.powers.items():
            powers[name] = powers.get(name, 0) + sign * power
        return Unit(self.scale * other.scale**sign, {n: p for n, p in powers.items() if p})


_RAD: Final = Unit(1.0, {"rad": 1})
_DEGREE: Final = Unit(math.pi / 180.0, {"rad": 1})
_HERTZ: Final = Unit(1.0, {"s": -1})
_METRE: Final = Unit(1.0, {"m": 1})
_SECOND: Final = Unit(1.0, {"s": 1})
_NAMES: Final = {
    **dict.fromkeys(("m", "meter", "metre", "meters", "metres"), _METRE),
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), _SECOND),
    **dict.fromkeys(("Hz", "hz", "HZ", "hertz", "Hertz"), _HERTZ),
    **dict.fromkeys(("rad", "rads", "radian", "radians"), _RAD),
    **dict.fromkeys(
        (
            "deg",
            "degr",
            "degree",
            "degrees",
            "degree_true",
            "degrees_true",
            "degree_T",
            "degrees_T",
            "degT",
            "°",
        ),
        _DEGREE,
    ),
    **dict.fromkeys(("kg", "kilogram", "kilograms"), Unit(1.0, {"kg": 1})),
    **dict.fromkeys(("J", "joule", "joules"), Unit(1.0, {"kg": 1, "m": 2, "s": -2})),
    **dict.fromkeys(("cycle", "cycles"), Unit()),
    **dict.fromkeys(
        ("cm", "centimeter", "centimetre", "centimeters", "centimetres"), Unit(1e-2, {"m": 1})
    ),
    **dict.fromkeys(
        ("mm", "millimeter", "millimetre", "millimeters", "millimetres"), Unit(1e-3, {"m": 1})
    ),
    **dict.fromkeys(
        ("km", "kilometer", "kilometre", "kilometers", "kilometres"), Unit(1e3, {"m": 1})
    ),
    **dict.fromkeys(("ft", "foot", "feet"), Unit(0.3048, {"m": 1})),
    **dict.fromkeys(("mHz", "millihertz"), Unit(1e-3, {"s": -1})),
    **dict.fromkeys(("fathom", "fathoms"), Unit(1.8288, {"m": 1})),
    **dict.fromkeys(("ms", "millisecond", "milliseconds"), Unit(1e-3, {"s": 1})),
    **dict.fromkeys(("min", "minute", "minutes"), Unit(60.0, {"s": 1})),
    **dict.fromkeys(("h", "hr", "hour", "hours"), Unit(3600.0, {"s": 1})),
}
_FOLDED: Final = {
    name.lower(): unit
    for name, unit in _NAMES.items()
    if len(name) > 2 or name in ("m", "s", "Hz")  # `MHz` and `mHz` stay apart
    if name != "mHz"
}

_SUPERSCRIPTS: Final = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_NUMBER: Final = r"(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TOKEN: Final = re.compile(
    rf"\s*(?:(?P<name>[A-Za-z_°]+(?:[+-]?[0-9]+)?(?!\.?[0-9]))|(?P<number>{_NUMBER})"
    r"|(?:\*\*|\^)\s*(?P<power>[+-]?[0-9]+)(?!\.?[0-9])|(?P<op>[*./·×()]))|\s*$"
)
_LOGARITHM: Final = re.compile(
    r"\s*(log10|lg|log|ln|lb|log2)\s*\((?:\s*re:?\s)?(.*)\)\s*", re.IGNORECASE
)
_ADDED: Final = re.compile(rf"(.*?)\+\s*({_NUMBER})\s*")
_BASES: Final = {"log10": 10.0, "lg": 10.0, "log": 10.0, "ln": math.e, "lb": 2.0, "log2": 2.0}


def parse(text: object) -> Unit | None:
    """
    Return the unit that a text spells, or None if it is unknown.

    Pinned by tests/readers/test_units.py.
    """
    if not isinstance(text, str) or len(text) > LONGEST:
        return None
    spelt = re.sub(r"\{([^{}]*)\}", r"\1", text)
    spelt = re.sub(r"[⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺]+", lambda m: "^" + m[0].translate(_SUPERSCRIPTS), spelt)
    if match := _LOGARITHM.fullmatch(spelt):
        inner, offset = match[2], 0.0
        if added := _ADDED.fullmatch(inner):  # WAVEWATCH III: log10(m2 s rad-1 +1E-12)
            inner, offset = added[1], float(added[2])
        unit = _product(inner)
        return unit and Unit(unit.scale, unit.powers, _BASES[match[1].lower()], offset)
    return _product(spelt)


def _product(text: str) -> Unit | None:
    try:
        tokens = list(_tokens(text))
        unit, rest = _expression(tokens, 0)
    except (ValueError, KeyError, OverflowError, ZeroDivisionError):
        return None
    plain = tokens and rest == len(tokens) and 0.0 < unit.scale < math.inf
    return unit if plain else None


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    at = 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        if not match:
            raise ValueError(text[at:])
        at = match.end()
        if match.lastgroup:
            yield match.lastgroup, match[match.lastgroup]


def _expression(tokens: list[tuple[str, str]], at: int) -> tuple[Unit, int]:
    """Read factors from token `at` on, up to a closing bracket or the end."""
    unit, at = _factor(tokens, at)
    while at < len(tokens) and tokens[at] != ("op", ")"):
        sign = 1
        kind, token = tokens[at]
        if token in "/*.·×" or (kind, token.lower()) == ("name", "per"):
            sign = -1 if token in "/perPER" else 1
            at += 1
        factor, at = _factor(tokens, at)
        unit = unit.times(factor, sign)
    return unit, at


def _factor(tokens: list[tuple[str, str]], at: int) -> tuple[Unit, int]:
    if at >= len(tokens):
        raise ValueError("nothing after an operator")
    kind, token = tokens[at]
    power = 1
    if (kind, token) == ("op", "("):
        unit, at = _expression(tokens, at + 1)
        if at >= len(tokens):
            raise ValueError("an open bracket")
    elif kind == "number":
        unit = Unit(float(token))
    elif kind == "name":
        name = token.rstrip("+-0123456789")
        power = int(token.removeprefix(name) or 1)  # m2, rad-1
        unit = _NAMES.get(name) or _FOLDED[name.lower()]
    else:
        raise ValueError(token)
    at += 1
    if at < len(tokens) and tokens[at][0] == "power":
        power *= int(tokens[at][1])
        at += 1
    if abs(power) > LARGEST_POWER:
        raise ValueError("a power out of range")
    return Unit(unit.scale**power, {n: p * power for n, p in unit.powers.items() if power}), at
