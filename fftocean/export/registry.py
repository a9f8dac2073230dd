"""Registries of named objects."""

from collections.abc import Iterable
from typing import Protocol, TypeVar


class Named(Protocol):
    """An object with a name."""

    @property
    def name(self) -> str:
        """Name in the registry."""


T = TypeVar("T", bound=Named)


def by_name(objects: Iterable[T]) -> dict[str, T]:
    """
    Return objects by name.

    Raises:
        ImportError: two have the same name; one of them would be lost.
    """
    found: dict[str, T] = {}
    for one in objects:
        if one.name in found:
            raise ImportError(f"names must differ, got {one.name!r} twice")
        found[one.name] = one
    return found
