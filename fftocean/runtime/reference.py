"""
Fields of the waves at some points of each tile, by which a program can check itself.

They are the direct sum of all waves in float64, which shares no code with any transform.
"""

from typing import Any

import numpy as np

from fftocean import gerstner
from fftocean.fields import EIGHT
from fftocean.grid import Grid
from fftocean.runtime.source import Source
from fftocean.wave_list import oceans_of

DIGITS = 9
"""Significant digits, of which float32 has 7."""


def reference_of(source: Source, ticks: int, points: int) -> dict[str, Any]:
    """
    Return the eight fields of each tile at three moments of the loop: first, middle and last.

    Args:
        source: the waves.
        ticks: moments of the loop.
        points: number of points of a tile; all, where it has fewer.
    """
    moments = sorted({0, ticks * 2 // 5, ticks - 1})
    tiles = []
    for ocean in oceans_of(source.water()):
        grid = ocean.grid
        columns, rows = points_of(grid, points)
        fields: dict[str, list[list[float]]] = {name: [] for name in EIGHT}
        for tick in moments:
            t = source.loop * (tick / ticks)
            surface = gerstner.surface(ocean, grid.x[columns], grid.y[rows], t)
            for name, values in fields.items():
                values.append([float(f"{v:.{DIGITS}g}") for v in getattr(surface, name)])
        tiles.append({"columns": columns.tolist(), "rows": rows.tolist(), "fields": fields})
    return {
        "about": "fields of each tile at [moment][point], before choppiness; point p is the texel "
        "(columns[p], rows[p]); direct sums in float64",
        "ticks": ticks,
        "moments": moments,
        "tiles": tiles,
    }


def points_of(grid: Grid, points: int) -> tuple[Any, Any]:
    """Return the columns and rows of some samples, spread evenly; each occurs once."""
    total = grid.nx * grid.ny
    count = min(points, total)
    # Multiples of an odd number near the golden section of a power of two visit every sample.
    step = int(0.6180339887 * total) | 1
    index = np.arange(count) * step % total
    return index % grid.nx, index // grid.nx
