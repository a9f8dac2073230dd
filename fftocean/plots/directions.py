"""Plot of a sea's directional spectrum."""

import math
from typing import TYPE_CHECKING, cast

import numpy as np

from fftocean.physics import moments
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.plots.axes import round_periods
from fftocean.plots.figures import new_figure, write_message
from fftocean.plots.ranges import drawn_frequencies, energetic_band, is_flat
from fftocean.plots.text import compass_point, degrees, three_digits
from fftocean.plots.theme import FAINT, INK, LABEL_BOX, SYSTEMS, energy_colormap
from fftocean.polar_spectrum import polar_spectrum
from fftocean.statistics import specified

if TYPE_CHECKING:
    from matplotlib.figure import Figure, FigureBase
    from matplotlib.projections.polar import PolarAxes

# [degrees]: with a larger spread the mean of all unit vectors is shorter than 0.05, and its
# direction means little
_ALL_ROUND = 79.0


def plot_directions(sea: Sea) -> "Figure":
    """
    Draw the spectrum over frequency and direction, seen from above.

    North is up, and each wave is drawn where it goes TO.

    Raises:
        ParameterError: not a sea, or matplotlib is not installed.
    """
    return new_figure(draw_directions, sea, Sea, height=5.0)


def draw_directions(figure: "FigureBase", sea: Sea) -> None:
    """Draw the directional spectrum of a sea on a figure."""
    if is_flat(sea):
        title = "Directions: the sea is exactly flat"
        write_message(figure, title, "No waves: nothing goes anywhere.")
        return
    from matplotlib.colors import PowerNorm

    state = specified(sea)
    toward = f"toward {compass_point(state.mean_direction)} ({degrees(state.mean_direction, 0)})"
    if state.spread > _ALL_ROUND:
        toward = "all round"
    count = len(sea.systems)
    goes = "the energy goes" if count == 1 else f"{count} wave systems, on average"
    figure.suptitle(
        f"Directions: {goes} {toward}, spread by {state.spread:.0f}°", x=0.01, ha="left"
    )
    low, high = energetic_band(sea, 0.02)
    rim = high / (2.0 * math.pi)  # [Hz]
    frequency, theta, density = polar_spectrum(sea, rim)
    ax = cast("PolarAxes", figure.add_subplot(projection="polar"))
    mesh = ax.pcolormesh(
        theta,
        frequency,
        density,
        cmap=energy_colormap(),
        norm=PowerNorm(0.5, 0.0, float(np.max(density))),
        rasterized=True,
    )
    mesh.set_gid("density")
    ax.set_ylim(0.0, rim)
    ax.grid(color=FAINT, alpha=0.35, linewidth=0.6)
    ax.spines["polar"].set_color(FAINT)
    names = ("E\n0°", "NE", "N  90°", "NW", "W\n180°", "SW", "S  270°", "SE")
    ax.set_xticks(np.arange(8) * math.pi / 4.0, names)
    rings = round_periods(0.14 * high, 0.95 * high, 0.16 * high)
    ax.set_yticks([1.0 / period for period in rings], [f"{period:g} s" for period in rings])
    ax.set_rlabel_position(state.mean_direction + 180.0 + 22.5)
    for text in ax.get_yticklabels():
        text.set(fontsize=8.5, color=INK, ha="center", va="center", bbox=LABEL_BOX)
    for i, system in enumerate(sea.systems):
        if np.any(system.spectrum(drawn_frequencies(sea, low, high)) > 0.0):
            _draw_arrow(ax, system, rim, SYSTEMS[i] if count <= len(SYSTEMS) else None)
    figure.supxlabel(
        "Seen from above; waves go from the centre outward. "
        "Rings: wave period, evenly spaced in frequency.",
        fontsize=8.5,
    )
    bar = figure.colorbar(mesh, ax=ax, shrink=0.75, pad=0.08)
    bar.set_label("variance density [m²/Hz/degree]")
    bar.outline.set_visible(False)


def _draw_arrow(ax: "PolarAxes", system: WaveSystem, rim: float, colour: str | None) -> None:
    """
    Mark the direction of a wave system by an arrow at the rim.

    Args:
        ax: polar axes.
        system: the wave system.
        rim: the largest frequency drawn [Hz].
        colour: the system's own, in which its period and direction are written beside the arrow;
            None for a grey arrow without words.
    """
    theta = math.radians(system.direction % 360.0)
    style = {
        "arrowstyle": "-|>,head_width=0.3,head_length=0.6",
        "color": colour or FAINT,
        "linewidth": 2.0,
        "shrinkA": 0.0,
        "shrinkB": 0.0,
    }
    ax.annotate("", (theta, rim), xytext=(theta, 0.78 * rim), arrowprops=style, gid="direction")
    if colour is None:
        return
    period = three_digits(moments.peak_period(system.spectrum))
    toward = degrees((system.direction + 180.0) % 360.0 - 180.0, 0)
    ax.annotate(
        f"Tp {period} s\ntoward {toward}",
        (theta, 0.74 * rim),
        xytext=(40.0 * math.sin(theta), -20.0 * math.cos(theta)),  # beside the arrow
        textcoords="offset points",
        color=colour,
        fontsize=9.0,
        ha="center",
        va="center",
        bbox=LABEL_BOX,
    )
