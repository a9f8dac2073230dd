"""Colours, fonts and sizes of the plots."""

from contextlib import AbstractContextManager
from typing import Any

from fftocean.errors import ParameterError, how_to_install

WIDTH = 7.5  # [in]
DPI = 160  # [1/in]: 1200 pixels, whose letters stay 12 high when the sheet of four shrinks to them

INK, FAINT, SHADE = "#222222", "#767676", "#e9e9e9"
BLUE, VERMILION = "#0072b2", "#c75000"
SYSTEMS = (VERMILION, "#00805d", "#aa4499", "#8a6000", "#56707a")
"""
Colours that the colour-blind can tell apart (after Okabe & Ito 2008, darkened to be read as text);
blue is reserved for the sea as a whole.
"""
ENERGY_COLOURS = ("#ffffff", "#d3ecef", "#86c8d6", "#3a8fb7", "#1f5595", "#141c52")
"""White to navy, each step darker than the last: a scale that survives grey printing."""

LABEL_BOX: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.75}
"""The background of labels that lie over curves."""

_STYLE: dict[str, Any] = {
    "font.size": 10.0,
    "text.color": INK,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.titlesize": 12.0,
    "figure.titleweight": "bold",
    "xtick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.color": FAINT,
    "ytick.labelcolor": INK,
    "svg.hashsalt": "fftocean",  # the same bytes each time
    "path.simplify": True,
}


def style() -> AbstractContextManager[None]:
    """
    Return a context manager that sets the plots' style on top of matplotlib's defaults.

    Raises:
        ParameterError: matplotlib is not installed.
    """
    try:
        from matplotlib import style
    except ImportError as error:
        hint = how_to_install("plot")
        raise ParameterError(f"plots need matplotlib: {hint} ({error})") from error
    context: AbstractContextManager[None] = style.context(["default", _STYLE])
    return context


def energy_colormap() -> Any:
    """Return the colour map of energies."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("energy", ENERGY_COLOURS)
