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
    """Turn knots into m/s: `knots(25)` is the start of a strong breeze's upper half, 12.86."""
    return _ANY.check("knots", value) * NAUTICAL_MILE / 3600.0


def nautical_miles(value: float) -> float:
    """Turn nautical miles into m."""
    return _ANY.check("nautical_miles", value) * NAUTICAL_MILE


def feet(value: float) -> float:
    """Turn feet into m."""
    return _ANY.check("feet", value) * FOOT
