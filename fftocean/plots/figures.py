"""Figures as matplotlib objects and as files."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from fftocean.errors import ParameterError
from fftocean.files import write_whole
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea
from fftocean.plots.theme import BLUE, DPI, WIDTH, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure, FigureBase, SubFigure

Subject = TypeVar("Subject", Sea, Ocean)

SUFFIXES = (".png", ".svg", ".pdf")


def save(figure: "Figure", path: str | Path) -> Path:
    """
    Write a figure so that the file is either whole or absent; the same figure gives the same bytes.

    Args:
        figure: a figure that a function of `fftocean.plots` returned.
        path: the file; its suffix, .png, .svg or .pdf, sets the format.

    Raises:
        ParameterError: another suffix, or not a figure.
        OutputError: the file could not be written; nothing is left behind.
    """
    path = Path(path)
    write_whole(path, encoded(figure, path.suffix))
    return path


def encoded(figure: "Figure", suffix: str) -> bytes:
    """
    Return a figure as the bytes of a file; the same figure gives the same bytes.

    Raises:
        ParameterError: a suffix that is not .png, .svg or .pdf, or not a figure.
    """
    kind = suffix.lower()
    if kind not in SUFFIXES:
        names = f"{', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        raise ParameterError(f"the name of a plot must end in {names}, got {suffix!r:.80}")
    with style():
        from matplotlib.figure import Figure

        if not isinstance(figure, Figure):
            raise ParameterError(f"figure must be a matplotlib Figure, got {figure!r:.80}")
        stream = io.BytesIO()
        undated: dict[str, Any] = {
            ".png": {"Software": None},
            ".svg": {"Date": None},
            ".pdf": {"CreationDate": None},
        }[kind]
        figure.savefig(stream, format=kind[1:], metadata=undated)
    return stream.getvalue()


def new_figure(
    draw: "Callable[[FigureBase, Subject], None]",
    subject: Subject,
    kind: type,
    *,
    height: float,
    width: float = WIDTH,
) -> "Figure":
    """
    Return a new figure with a subject drawn on it, in the plots' own style.

    Args:
        draw: draws the subject on the figure.
        subject: a sea or an ocean.
        kind: the type that the subject must have.
        height, width: of the figure [in].

    Raises:
        ParameterError: the subject has another type, or matplotlib is not installed.
    """
    if not isinstance(subject, kind):
        name, article = kind.__name__, "an" if kind is Ocean else "a"
        raise ParameterError(f"{name.lower()} must be {article} {name}, got {subject!r:.80}")
    with style():
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        draw(figure, subject)
    return figure


def panels(figure: "FigureBase", rows: int, columns: int, **spacing: Any) -> "list[SubFigure]":
    """Divide a figure into panels, and return them row by row."""
    return list(np.ravel(np.asarray(figure.subfigures(rows, columns, **spacing), dtype=object)))


def write_message(figure: "FigureBase", title: str, words: str) -> None:
    """Draw a flat line with words over it, in place of a plot of nothing."""
    figure.suptitle(title, x=0.01, ha="left")
    ax = figure.subplots()
    ax.set(xticks=[], yticks=[])
    for spine in ax.spines.values():
        spine.set_visible(False)
    ax.axhline(0.0, color=BLUE, linewidth=2.0)
    ax.set(xlim=(0.0, 1.0), ylim=(-1.0, 1.0))
    ax.text(0.5, 0.1, words, ha="center", va="bottom", fontsize=11)
