"""Small tables and images by which notebooks show values."""

import base64
import io
from collections.abc import Iterable, Sequence
from html import escape

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real

SIDE = 240
"""Largest number of pixels a side of an image."""
_LOW, _MIDDLE, _HIGH = np.array([8, 29, 58]), np.array([38, 110, 148]), np.array([236, 246, 246])


def table(caption: str, rows: Iterable[Sequence[str]], *, heads: Sequence[str] = ()) -> str:
    """
    Return a table in HTML; texts are escaped.

    Args:
        caption: the line above it.
        rows: cells of each row, the first of which is its name.
        heads: names of the columns, if they need any.
    """
    head = "".join(f"<th>{escape(name)}</th>" for name in heads)
    lines = [f"<tr>{head}</tr>"] if head else []
    for name, *cells in rows:
        values = "".join(f"<td>{escape(cell)}</td>" for cell in cells)
        lines.append(f'<tr><th style="text-align:left">{escape(name)}</th>{values}</tr>')
    return f"<table><caption>{escape(caption)}</caption>{''.join(lines)}</table>"


def line(text: str) -> str:
    """Return a line of text in HTML, escaped."""
    return f"<p>{escape(text)}</p>"


def image(height: Real, alternative: str) -> str:
    """
    Return an image of a height field in HTML, north up: dark troughs, light crests.

    Args:
        height: (ny, nx) [m], any number of samples; a part of them is shown.
        alternative: text for those who cannot see it.
    """
    from PIL import Image

    pixels = Image.fromarray(_colours(height))
    file = io.BytesIO()
    pixels.save(file, "png", optimize=True)
    data = base64.b64encode(file.getvalue()).decode()
    return f'<img alt="{escape(alternative)}" src="data:image/png;base64,{data}">'


def _colours(height: Real) -> npt.NDArray[np.uint8]:
    """Return the colours of an image, (rows, columns, 3), row 0 in the north."""
    step = max(1, -(-max(height.shape) // SIDE))
    shown = np.asarray(height, np.float64)[::-step, ::step]
    spread = float(np.max(np.abs(shown))) or 1.0
    level = np.clip(shown / spread, -1.0, 1.0)[..., None]
    rising = _MIDDLE + level * (_HIGH - _MIDDLE)
    falling = _MIDDLE + level * (_MIDDLE - _LOW)
    colours: npt.NDArray[np.uint8] = np.where(level > 0.0, rising, falling).astype(np.uint8)
    return colours


def curve(x: Real, y: Real, label: str) -> str:
    """
    Return a small curve as SVG.

    Args:
        x, y: (n,) finite, y >= 0.
        label: the line below it.
    """
    width, height = 240.0, 80.0
    across = (x - x[0]) / (x[-1] - x[0]) * width
    up = height - 4.0 - y / (float(np.max(y)) or 1.0) * (height - 8.0)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up, strict=True))
    return (
        f'<figure style="margin:0"><svg viewBox="0 0 {width:g} {height:g}" width="{width:g}" '
        f'role="img" aria-label="{escape(label)}">'
        f'<polyline points="{points}" fill="none" stroke="#266e94" stroke-width="1.5"/></svg>'
        f"<figcaption>{escape(label)}</figcaption></figure>"
    )
