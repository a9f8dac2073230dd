"""All plots of an ocean on one sheet."""

import math
from textwrap import wrap
from typing import TYPE_CHECKING

from fftocean.ocean import Ocean
from fftocean.plots.directions import draw_directions
from fftocean.plots.dispersion import draw_dispersion
from fftocean.plots.figures import new_figure, panels, write_message
from fftocean.plots.realised import draw_realised
from fftocean.plots.spectrum import draw_spectrum
from fftocean.plots.theme import WIDTH

if TYPE_CHECKING:
    from matplotlib.figure import Figure, FigureBase


def plot_job(ocean: Ocean) -> "Figure":
    """
    Draw the four plots of an ocean on one sheet.

    Raises:
        ParameterError: not an ocean, or matplotlib is not installed.
    """
    return new_figure(_draw_job, ocean, Ocean, width=2.0 * WIDTH, height=11.0)


def _draw_job(figure: "FigureBase", ocean: Ocean) -> None:
    """Draw the title and the four plots."""
    grid = ocean.grid
    depth = f"{ocean.depth:g} m deep" if math.isfinite(ocean.depth) else "deep water"
    loop = f"repeats every {ocean.loop:g} s" if ocean.loop is not None else "never repeats in time"
    title = f"A tile of {grid.lx:g} × {grid.ly:g} m, {grid.nx} × {grid.ny} samples, {depth}; {loop}"
    if ocean.rarity is not None:
        what, _, how_rare = str(ocean.rarity).partition(": ")
        title += "\n".join(["", *wrap(f"with {what}", width=130), *wrap(how_rare, width=130)])
    figure.suptitle(title, fontsize=14)
    upper, lower = panels(figure, 2, 1, height_ratios=(1.0, 1.15), hspace=0.03)
    spectrum, directions = panels(upper, 1, 2, wspace=0.03)
    realised, relation = panels(lower, 1, 2, wspace=0.03)
    if ocean.sea is None:
        for part, name in ((spectrum, "Spectrum"), (directions, "Directions")):
            title = f"{name}: none was specified"
            write_message(part, title, "This ocean was made of given waves.")
    else:
        draw_spectrum(spectrum, ocean.sea)
        draw_directions(directions, ocean.sea)
    draw_realised(realised, ocean)
    draw_dispersion(relation, ocean)
