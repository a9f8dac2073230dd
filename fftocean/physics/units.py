"""Conversion of nautical units to SI; the rest of the package has metres and seconds only."""

from typing import Final

from fftocean.limits import Quantity

NAUTICAL_MILE: Final = 1852.0
"""[m], exactly (Monaco 1929)."""

KNOT: Final = NAUTICAL_MILE / 3600.0
"""[m/s], exactly: a nautical mile an hour."""

FOOT: Final = 0.3048
"""[m], exactly (international yard and pound agreement 1959)."""

_ANY = Quantity("", -1e9, 1e9)


def knots(value: float) -> float:
    """
    Return a speed in knots as [m/s]: `knots(25)`, in a strong breeze's upper half, is 12.86.

    Raises:
        ParameterError: not a number, or one beyond 1e9.
    """
    return _ANY.check("knots", value) * NAUTICAL_MILE / 3600.0


def nautical_miles(value: float) -> float:
    """
    Return a length in nautical miles as [m].

    Raises:
        ParameterError: not a number, or one beyond 1e9.
    """
    return _ANY.check("nautical_miles", value) * NAUTICAL_MILE


def feet(value: float) -> float:
    """
    Return a length in feet as [m].

    Raises:
        ParameterError: not a number, or one beyond 1e9.
    """
    return _ANY.check("feet", value) * FOOT
