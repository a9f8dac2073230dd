"""Numbers and directions as text."""

POINTS = (
    *("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE"),
    *("S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"),
)
"""The points of the compass, clockwise from north."""


def compass_point(direction: float) -> str:
    """
    Return the compass point nearest a direction, counter-clockwise from east [degrees].
    """
    return POINTS[round(((90.0 - direction) % 360.0) / 22.5) % 16]


def three_digits(value: float) -> str:
    """
    Return a number with three significant digits, trailing zeros too.

    An exponent appears only where the zeros could not be counted at a glance.
    """
    if not 1e-4 <= abs(value) < 1e6:
        return f"{value:.3g}"
    return f"{value:.0f}" if abs(value) >= 999.5 else f"{value:#.3g}".rstrip(".")


def degrees(value: float, digits: int = 1) -> str:
    """Return an angle [degrees] with a true minus sign, and without a negative zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}°".replace("-", "−")


def percent(share: float) -> str:
    """Return a share as a percentage; below 0.005 % it is 0."""
    if share < 5e-5:
        return "0 %"
    return f"{100.0 * share:.2g} %" if share < 0.99 else f"{100.0 * share:.0f} %"
