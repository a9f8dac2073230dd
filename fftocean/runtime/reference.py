"""
Fields of the waves at some points of each tile, by which a program can check itself.

They are the sum of all waves in float64, which shares no code with any transform. Points are
samples and moments are ticks, so that every phase is a whole number of parts of a turn: its phasor
is looked up. `check` compares them with `gerstner.surface`, which computes each angle.
"""

import math
from typing import Any

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.fields import EIGHT
from fftocean.grid import Grid
from fftocean.kernels import direct_sum
from fftocean.ocean import Ocean
from fftocean.runtime.source import Source
from fftocean.wave_list import oceans_of

DIGITS = 9
"""Significant digits, of which float32 has 7."""
ROWS = (
    *("height", "slope_x", "slope_y", "displace_x", "displace_y"),
    *("stretch_xx", "stretch_xy", "stretch_yy"),
)
"""The fields in the order of `direct_sum.eight_fields`."""


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
        columns, rows = points_of(ocean.grid, points)
        sums = fields_at(ocean, columns, rows, moments, ticks)
        fields = {
            name: [[float(f"{v:.{DIGITS}g}") for v in values] for values in sums[:, i]]
            for name, i in ((name, ROWS.index(name)) for name in EIGHT)
        }
        tiles.append({"columns": columns.tolist(), "rows": rows.tolist(), "fields": fields})
    return {
        "about": "fields of each tile at [moment][point], before choppiness; point p is the texel "
        "(columns[p], rows[p]); direct sums in float64",
        "ticks": ticks,
        "moments": moments,
        "tiles": tiles,
    }


def fields_at(
    ocean: Ocean, columns: Integer, rows: Integer, moments: list[int], ticks: int
) -> Real:
    """
    Return the fields of an ocean that loops, (moments, 8, points) in the order of `ROWS`.

    Args:
        ocean: the waves.
        columns, rows: samples of its grid.
        moments: ticks of the loop, whole numbers.
        ticks: moments of the loop.

    Pinned by tests/runtime/test_reference.py, against `gerstner.surface`.
    """
    grid, modes = ocean.grid, ocean.modes()
    assert ocean.loop is not None  # a package has one
    mx, my = (np.rint(k / dk) for k, dk in ((modes.kx, grid.dkx), (modes.ky, grid.dky)))
    cycles = np.rint(modes.omega * (ocean.loop / (2.0 * np.pi))).astype(np.int64)
    k = np.hypot(modes.kx, modes.ky)
    depth = 1.0 if math.isinf(ocean.depth) else np.tanh(k * ocean.depth)
    table = np.empty((k.size, 3 + 2 * len(moments)))
    table[:, 0], table[:, 1], table[:, 2] = modes.kx, modes.ky, 1.0 / (k * depth)
    turns = np.array([(cycles * tick) % ticks for tick in moments]) * (2.0 * np.pi / ticks)
    angle = turns + modes.phase
    table[:, 3::2] = (modes.amplitude * np.cos(angle)).T
    table[:, 4::2] = -(modes.amplitude * np.sin(angle)).T
    out = np.zeros((len(moments), 8, len(columns)))
    direct_sum.eight_fields(
        mx.astype(np.int64) % grid.nx,
        my.astype(np.int64) % grid.ny,
        table,
        _phasors(grid.nx, columns),
        _phasors(grid.ny, rows),
        out,
    )
    return out


def _phasors(n: int, places: Integer) -> Real:
    """Return real and imaginary parts of e^(2 pi i m p/n): (m from 0 to n - 1, 2, places p)."""
    angle = (np.arange(n)[:, None] * places % n) * (2.0 * np.pi / n)
    return np.ascontiguousarray(np.stack([np.cos(angle), np.sin(angle)], axis=1))


def points_of(grid: Grid, points: int) -> tuple[Any, Any]:
    """Return the columns and rows of some samples, spread evenly; each occurs once."""
    total = grid.nx * grid.ny
    count = min(points, total)
    # Multiples of an odd number near the golden section of a power of two visit every sample.
    step = int(0.6180339887 * total) | 1
    index = np.arange(count) * step % total
    return index % grid.nx, index // grid.nx
