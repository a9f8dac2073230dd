"""
Named kinds of spectra and spreadings, with the keys from which each is made.

A family registers its kind in its own file, and job files can then name it. A kind that is
incomplete (a key that the constructor does not take, a parameter that no key gives, two ways with
the same keys, a name twice) raises `TypeError` when its file is imported.
"""

import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, Protocol, TypeVar

from fftocean.errors import ParameterError
from fftocean.limits import check_bool

M = TypeVar("M")
WATER = ("depth", "surface_tension")
"""The properties of the sea's water that a constructor may take."""


class Key(Protocol):
    """The rule of one key: a `Quantity`, a `Count`, or one of the classes below."""

    def check(self, name: str, value: Any, /) -> Any:
        """Return the value as the constructor takes it, or raise `ParameterError`."""


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several words."""

    words: tuple[str, ...]

    def check(self, name: str, value: Any) -> str:
        """Return the word, in lower case."""
        word = value.strip().casefold() if isinstance(value, str) else value
        if word not in self.words:
            raise ParameterError(
                f"{name} must be one of {', '.join(self.words)}, got {value!r:.60}"
            )
        return str(word)


@dataclass(frozen=True, slots=True)
class Switch:
    """True or false."""

    def check(self, name: str, value: Any) -> bool:
        """Return the truth value."""
        return check_bool(name, value)


@dataclass(frozen=True, slots=True)
class Numbers:
    """A list or table of numbers, which the model checks."""

    def check(self, _name: str, value: Any, /) -> Any:
        """Return the value as it is."""
        return value


@dataclass(frozen=True, slots=True)
class Part:
    """Another model, given by a table of its own: a "spectrum" or a "spreading"."""

    role: str

    def check(self, _name: str, value: Any, /) -> Any:
        """Return a model that has already been made."""
        return value


@dataclass(frozen=True, slots=True, init=False)
class Way(Generic[M]):
    """
    One set of keys and the constructor that takes them.

    A key is optional where the constructor's parameter of that name has a default.

    Args:
        make: the constructor; its parameters have the names of the keys.
        water: of `WATER`, what it takes from the sea.
        keys: each key with its rule.
    """

    make: Callable[..., M]
    water: tuple[str, ...]
    keys: Mapping[str, Key]
    required: frozenset[str] = field(repr=False)

    def __init__(self, make: Callable[..., M], /, *, water: tuple[str, ...] = (), **keys: Key):
        parameters = inspect.signature(make).parameters
        required = {n for n, p in parameters.items() if p.default is inspect.Parameter.empty}
        unknown = {*keys, *water} - set(parameters)
        if unknown or required - {*keys, *water} or not set(water) <= set(WATER) - set(keys):
            raise TypeError(
                f"{make.__qualname__} must take the keys {sorted({*keys, *water})} of its kind and "
                f"need no others, got the parameters {list(parameters)}"
            )
        object.__setattr__(self, "make", make)
        object.__setattr__(self, "water", water)
        object.__setattr__(self, "keys", keys)
        object.__setattr__(self, "required", frozenset(required - set(water)))

    def fits(self, names: set[str]) -> bool:
        """Return True if the model can be made of just these keys."""
        return self.required <= names <= set(self.keys)

    def __str__(self) -> str:
        """Return the keys as messages show them, the optional ones in brackets."""
        shown = (name if name in self.required else f"[{name}]" for name in self.keys)
        return "{" + ", ".join(shown) + "}"


@dataclass(frozen=True, slots=True, init=False)
class Kind(Generic[M]):
    """
    A family by its name in job files.

    Args:
        name: words in lower case with hyphens.
        model: the class of what is made.
        ways: the sets of keys from which it can be made.
    """

    name: str
    model: type
    ways: tuple[Way[M], ...]

    def __init__(self, name: str, model: type, /, *ways: Way[M]):
        if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", name):
            raise TypeError(f"the name of a kind must be lower-case words, got {name!r}")
        if not ways:
            raise TypeError(f"the kind {name!r} must have a way to be made")
        for i, one in enumerate(ways):
            for other in ways[:i]:
                if one.required <= set(other.keys) and other.required <= set(one.keys):
                    raise TypeError(f"the kind {name!r} must tell {one} from {other}")
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "model", model)
        object.__setattr__(self, "ways", ways)


class Registry(Mapping[str, Kind[M]]):
    """The kinds of one role, "spectrum" or "spreading", by name."""

    def __init__(self, role: str) -> None:
        self.role = role
        self._kinds: dict[str, Kind[M]] = {}

    def add(self, name: str, model: type, /, *ways: Way[M]) -> None:
        """
        Register a kind; the arguments are those of `Kind`.

        Raises:
            TypeError: an incomplete kind, or a name that is taken.
        """
        if name in self._kinds:
            raise TypeError(f"the {self.role} {name!r} must be registered once")
        self._kinds[name] = Kind(name, model, *ways)

    def __getitem__(self, name: str) -> Kind[M]:
        return self._kinds[name]

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._kinds))

    def __len__(self) -> int:
        return len(self._kinds)
