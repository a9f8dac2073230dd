"""Axes of periods and of numbers written in full."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis


def mark_periods(ax: "Axes", low: float, high: float) -> None:
    """Mark the periods [s] along the top of an axis of frequencies."""
    top = ax.secondary_xaxis("top")
    longest = max(len(f"{period:g}") for period in round_periods(low, high, 0.055 * (high - low)))
    periods = round_periods(low, high, (0.055 + 0.014 * max(longest - 3, 0)) * (high - low))
    top.set_xticks(
        [2.0 * math.pi / period for period in periods], [f"{period:g}" for period in periods]
    )
    top.set_xlabel("period [s]")


def round_periods(
    low: float, high: float, gap: float, position: Callable[[float], float] = float
) -> list[float]:
    """
    Return round periods, the longest first [s]; the roundest are preferred.

    Args:
        low, high: the range of their frequencies [rad/s].
        gap: the least distance between the positions of two of them.
        position: the position on the axis of a frequency [rad/s].
    """
    first, last = (2.0 * math.pi / omega for omega in (high, max(low, 1e-3 * high)))
    kept: list[float] = []
    for mantissas in ((1.0, 2.0, 5.0), (3.0, 4.0, 8.0), (6.0, 1.5, 2.5, 7.0), (1.2, 9.0, 3.5, 4.5)):
        for exponent in range(math.floor(math.log10(first)), math.floor(math.log10(last)) + 1):
            for mantissa in mantissas:
                period = float(f"{mantissa}e{exponent}")
                is_clear = all(
                    abs(position(2.0 * math.pi / period) - position(2.0 * math.pi / other)) >= gap
                    for other in kept
                )
                if first <= period <= last and is_clear:
                    kept.append(period)
    return sorted(kept, reverse=True)


def spell_out_ticks(axis: "Axis", largest: float) -> None:
    """
    Write very small and very large numbers in full at each tick.

    An exponent above the axis is easily overlooked.
    """
    if not 1e-3 <= largest < 1e5:
        from matplotlib.ticker import MaxNLocator

        axis.set_major_locator(MaxNLocator(4))
        axis.set_major_formatter("{x:.3g}")
