"""Labels beside curves that overlap neither each other nor what is drawn."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fftocean.arrays import Real
from fftocean.plots.theme import LABEL_BOX, WIDTH

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ATTEMPTS = 12  # to raise the upper limit of the axes until every label is below it
_FONT_SIZE = 9.5  # [points]


class Label(NamedTuple):
    """Words in a curve's colour, and the point of the curve that they describe."""

    text: str
    colour: str
    anchor: tuple[float, float]


class _Box(NamedTuple):
    """The extent of a label in the units of the axes."""

    left: float
    middle: float
    half_height: float
    right: float


def stack_labels(ax: "Axes", labels: Sequence[tuple[str, str]]) -> None:
    """
    Write labels above one another in the lower right corner, which a rising curve leaves empty.

    Args:
        ax: the axes.
        labels: text and colour, from the top down.
    """
    from matplotlib.transforms import offset_copy

    for i, (text, colour) in enumerate(reversed(labels)):
        corner = offset_copy(
            ax.transAxes, fig=ax.get_figure(root=True), x=-4.0, y=10.0 + 13.0 * i, units="points"
        )
        ax.text(
            1.0, 0.0, text, transform=corner, color=colour, ha="right", va="center", fontsize=9.0
        )


def write_labels(
    ax: "Axes", labels: Sequence[Label], curve: tuple[Real, Real], *, height: float
) -> None:
    """
    Write each label right of its anchor, above the curves and clear of other labels.

    A thin line connects it with the anchor.

    Args:
        ax: with its limits set; the upper one is raised until all labels are under it.
        labels: in any order.
        curve: x and the highest y of all that is drawn.
        height: the approximate height of the axes [in].
    """
    for _ in range(_ATTEMPTS):
        boxes = _boxes(ax, labels, curve, height)
        top = ax.get_ylim()[1]
        if all(box.middle + box.half_height <= top for box in boxes):
            break
        ax.set_ylim(top=1.06 * top)
    line = {
        "arrowstyle": "-",
        "linewidth": 0.7,
        "relpos": (0.0, 0.5),
        "shrinkA": 0.0,
        "shrinkB": 1.0,
    }
    for (text, colour, anchor), box in zip(_from_below(labels), boxes, strict=True):
        look: dict[str, Any] = {
            "color": colour,
            "fontsize": _FONT_SIZE,
            "va": "center",
            "bbox": LABEL_BOX,
            "arrowprops": {**line, "color": colour},
        }
        ax.annotate(text, anchor, xytext=(box.left, box.middle), **look)


def right_flank(x: Real, y: Real, level: float) -> tuple[float, float]:
    """
    Return the last point of a curve that reaches `level` of its maximum: on its right flank.
    """
    i = int(np.flatnonzero(y >= level * np.max(y))[-1])
    return float(x[i]), float(y[i])


def _boxes(
    ax: "Axes", labels: Sequence[Label], curve: tuple[Real, Real], height: float
) -> list[_Box]:
    """Return the box of each label, from below."""
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    points_x, points_y = (WIDTH - 0.9) * 72.0 / (right - left), height * 72.0 / (top - bottom)
    placed: list[_Box] = []
    for text, _, (x, y) in _from_below(labels):
        lines = text.split("\n")
        width = 0.56 * _FONT_SIZE * max(map(len, lines)) / points_x
        half = 0.7 * _FONT_SIZE * len(lines) / points_y
        start = max(min(x + 10.0 / points_x, right - width), left)
        beside = (curve[0] >= start - 4.0 / points_x) & (curve[0] <= start + width)
        level = max(y, float(np.max(curve[1][beside], initial=0.0)) + half)
        for other in sorted(placed, key=lambda box: box.middle):
            near = abs(level - other.middle) < half + other.half_height
            if near and start < other.right and other.left < start + width:
                level = other.middle + other.half_height + half
        placed.append(_Box(start, level, half, start + width))
    return placed


def _from_below(labels: Sequence[Label]) -> list[Label]:
    """Return labels in the sequence in which they are placed."""
    return sorted(labels, key=lambda label: label.anchor[1])
