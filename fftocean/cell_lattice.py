"""
Variance of a sea in the cells of several tiles, fast and nearly exact.

`cells` integrates each cell anew for each sea. Here the geometry of the cells is prepared once, and
a sea is sampled on a polar lattice: its energy below a wavenumber k, on a fine logarithmic ladder,
and the share of directions below theta, at some of these k. Both are cumulative, so that a cell's
energy is a sum of differences: a cell is a few rings about k = 0, and each ring holds the energy
between its two wavenumbers times the share of directions that its arc spans. No energy falls
between two samples, however narrow the spectrum is. The directions of the lattice are those on
which the sea's spreading is smooth, so narrow seas have a finer one; the energy of a long-crested
part is followed along its ray from cell to cell.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.cells import QUADRANTS, Band, Part, parts_of_sea
from fftocean.errors import ParameterError
from fftocean.grid import Grid
from fftocean.kernels import arcs
from fftocean.physics import dispersion
from fftocean.physics.panels import gauss, split
from fftocean.physics.sea import Sea

_STEPS = 2048  # of the ladder of wavenumbers
_ROWS = 64  # of these, at which the directions are sampled
_SECTOR = math.radians(5.0)  # the longest step between directions
_PIECES = 2  # of a direction panel, at least
_FEW, _MANY = 3, 24  # rings of a cell, far from k = 0 and near to it
_NEAR = 60.0  # cells to k = 0, times the number of rings
_CHORDS = 8  # of a ring, whose area they give


@dataclass(frozen=True, slots=True)
class TileCells:
    """The cells of a tile that have waves in its band, those of one quadrant."""

    ax: Integer  # >= 0, (cells,)
    ay: Integer  # >= 0, (cells,)
    dkx: float  # [rad/m]
    dky: float  # [rad/m]
    band: Band  # [rad/m]
    first: Integer  # index of the first ring of each cell, and the number of rings, (cells + 1,)
    inner: Real  # edge of each ring [rad/m]
    outer: Real  # edge of each ring [rad/m]
    low: Real  # direction in which its arc begins [rad]
    high: Real  # and ends [rad]
    weight: Real  # the area of the ring within the cell, by that of the arc [-]

    @classmethod
    def of(cls, grid: Grid, band: Band) -> "TileCells":
        """Return the cells of a tile, cut into rings."""
        reach_x, reach_y = grid.reach
        ax, ay = (a.ravel() for a in np.meshgrid(np.arange(reach_x + 1), np.arange(reach_y + 1)))
        # half of a cell that an axis halves
        x = np.maximum(ax - 0.5, 0.0) * grid.dkx, (ax + 0.5) * grid.dkx
        y = np.maximum(ay - 0.5, 0.0) * grid.dky, (ay + 0.5) * grid.dky
        nearest, farthest = np.hypot(x[0], y[0]), np.hypot(x[1], y[1])
        touched = (farthest > band[0]) & (nearest < band[1]) & ((ax > 0) | (ay > 0))
        ax, ay = ax[touched], ay[touched]
        sides = x[0][touched], x[1][touched], y[0][touched], y[1][touched]
        nearest = np.maximum(nearest[touched], band[0])
        farthest = np.minimum(farthest[touched], band[1])
        rings = np.clip(np.ceil(_NEAR / np.hypot(ax, ay)), _FEW, _MANY).astype(np.int64)
        cell = np.repeat(np.arange(ax.size), rings)
        first = np.concatenate([[0], np.cumsum(rings)])
        number = np.arange(cell.size) - first[cell]
        step = ((farthest - nearest) / rings)[cell]
        inner = nearest[cell] + number * step
        outer = inner + step
        around = tuple(side[cell] for side in sides)
        low, high = _arc(0.5 * (inner + outer), around)
        area = np.zeros(cell.size)
        for i in range(_CHORDS):
            k = inner + step * ((i + 0.5) / _CHORDS)
            begin, end = _arc(k, around)
            area += k * (end - begin) * (step / _CHORDS)
        whole = 0.5 * (outer + inner) * (high - low) * step
        weight = np.divide(area, whole, out=np.zeros(cell.size), where=whole > 0.0)
        return cls(
            *(ax, ay, grid.dkx, grid.dky, band),
            *(first, inner, outer, low, high, weight),
        )


def _arc(k: Real, sides: tuple[Real, ...]) -> tuple[Real, Real]:
    """Return the directions between which circles lie in rectangles of the first quadrant."""
    left, right, bottom, top = (np.minimum(side / k, 1.0) for side in sides)
    low = np.maximum(np.arccos(right), np.arcsin(bottom))
    high = np.minimum(np.arccos(left), np.arcsin(top))
    return low, np.maximum(high, low)


class CellLattice:
    """
    The cells of several tiles, prepared for one sea after another.

    Args:
        grids: of the tiles.
        bands: the wavenumbers that each tile is to hold [rad/m].

    Pinned by tests/test_cell_lattice.py, against the integrals of `cells`.
    """

    def __init__(self, grids: Sequence[Grid], bands: Sequence[Band]) -> None:
        self.tiles = [TileCells.of(grid, band) for grid, band in zip(grids, bands, strict=True)]
        lowest = min(float(np.min(tile.inner, initial=np.inf)) for tile in self.tiles)
        highest = max(float(np.max(tile.outer, initial=0.0)) for tile in self.tiles)
        if not lowest < highest:  # tiles without a wave
            lowest, highest = 1.0, 2.0
        self._k = np.geomspace(lowest * (1.0 - 1e-12), highest * (1.0 + 1e-12), _STEPS + 1)
        self._edges = [
            (_place(self._k, tile.inner), _place(self._k, tile.outer)) for tile in self.tiles
        ]
        self._rows = [
            _place(self._k[:: _STEPS // _ROWS], 0.5 * (tile.inner + tile.outer))
            for tile in self.tiles
        ]

    def variances(self, sea: Sea) -> list[Real]:
        """
        Return the sea's variance in the cells of each tile, as `Cells.variances`: (4, cells) [m^2].

        Raises:
            ParameterError: the sea's density is negative or not finite somewhere.
        """
        total: list[Real] = [np.zeros((4, tile.ax.size)) for tile in self.tiles]
        for part in parts_of_sea(sea):
            below = self._below(part)
            if not (np.all(np.diff(below) >= 0.0) and below[-1] < np.inf):
                raise ParameterError(
                    "the sea's spectrum must be finite and at least 0 at every wavenumber of the "
                    f"tiles, got {part.system.spectrum!r:.80}"
                )
            if part.long_crested:
                for tile, out in zip(self.tiles, total, strict=True):
                    _follow(part.direction, tile, self._k, below, out)
                continue
            spread = self._directions(part)
            for tile, edges, (row, along), out in zip(
                self.tiles, self._edges, self._rows, total, strict=True
            ):
                inner, outer = (_between(below, *place) for place in edges)
                energy = tile.weight * (outer - inner)
                rings = tile.first, tile.low, tile.high
                arcs.sums(*rings, energy, row, along, part.direction, *spread, out)
        for tile, out in zip(self.tiles, total, strict=True):
            _join_halves(tile, out)
        return total

    def _below(self, part: Part) -> Real:
        """Return the variance of a part between the lowest wavenumber and each of the others."""
        interval, low, high = split(self._k[:-1], self._k[1:], part.k)
        k, weight = gauss(low, high, 2)
        energy = part.share * np.sum(part.radial(k)[1] * weight, axis=1)
        return np.concatenate([[0.0], np.cumsum(np.bincount(interval, energy, _STEPS))])

    def _directions(self, part: Part) -> tuple[Real, Real]:
        """
        Return directions from -pi to pi relative to a part's own, and the share of energy below
        them at each row: coefficients of cubics, (rows, intervals, 4).
        """
        theta = part.theta - part.direction
        panels = theta[np.abs(theta) < np.pi * (1.0 - 1e-12)]
        panels = np.concatenate([[-np.pi], panels, [np.pi]])
        pieces = np.maximum(np.ceil(np.diff(panels) / _SECTOR), _PIECES).astype(np.int64)
        panel = np.repeat(np.arange(pieces.size), pieces)
        number = np.arange(panel.size) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        theta = np.append(panels[panel] + number * (np.diff(panels) / pieces)[panel], np.pi)
        points, weights = gauss(theta[:-1], theta[1:], 3)
        omega = dispersion.angular_frequency(self._k[:: _STEPS // _ROWS], part.depth, part.tension)
        density = part.system.spreading(
            omega[:, None], points.ravel(), float(part.system.spectrum.peak)
        )
        density = np.broadcast_to(density, (omega.size, points.size))
        density = density.reshape(omega.size, *points.shape)
        # the parabola through the three points, and its integral
        left, middle, right = np.moveaxis(density, 2, 0)
        apart = 0.5 * math.sqrt(0.6)
        slope, bend = (right - left) / (2.0 * apart), (left - 2.0 * middle + right) / (2 * apart**2)
        cubic = np.zeros((omega.size, theta.size - 1, 4))
        np.cumsum(np.sum(density * weights, axis=2)[:, :-1], axis=1, out=cubic[:, 1:, 0])
        step = np.diff(theta)
        cubic[:, :, 1] = step * (middle - 0.5 * slope + 0.25 * bend)
        cubic[:, :, 2] = step * 0.5 * (slope - bend)
        cubic[:, :, 3] = step * bend / 3.0
        return theta, cubic


def _place(ladder: Real, k: Real) -> tuple[Integer, Real]:
    """Return the rung below each wavenumber, and the way from there to the next, 0 to 1."""
    rung = np.clip(np.searchsorted(ladder, k, "right") - 1, 0, ladder.size - 2)
    return rung, (k - ladder[rung]) / (ladder[rung + 1] - ladder[rung])


def _between(values: Real, rung: Integer, along: Real) -> Real:
    """Return values between the rungs of a ladder."""
    return (1.0 - along) * values[rung] + along * values[rung + 1]


def _follow(direction: float, tile: TileCells, ladder: Real, below: Real, out: Real) -> None:
    """Add the energy on a ray from k = 0 to the cells that it crosses, (4, cells)."""
    x, y = math.cos(direction), math.sin(direction)
    reach_x, reach_y = (int(np.max(a, initial=0)) for a in (tile.ax, tile.ay))
    with np.errstate(divide="ignore"):
        crossings = [
            np.divide((np.arange(reach + 1) + 0.5) * dk, abs(component))
            for reach, dk, component in ((reach_x, tile.dkx, x), (reach_y, tile.dky, y))
        ]
    edge = min(float(crossings[0][-1]), float(crossings[1][-1]), tile.band[1])
    k = np.unique(np.clip(np.concatenate(crossings), tile.band[0], edge))
    energy = np.diff(np.interp(k, ladder, below))
    middle = 0.5 * (k[:-1] + k[1:])
    ax, ay = (
        np.rint(middle * abs(component) / dk).astype(np.int64)
        for component, dk in ((x, tile.dkx), (y, tile.dky))
    )
    number = np.full((reach_x + 1, reach_y + 1), -1)
    number[tile.ax, tile.ay] = np.arange(tile.ax.size)
    cell = number[ax, ay]
    quadrant = QUADRANTS.index((1 if x >= 0.0 else -1, 1 if y >= 0.0 else -1))
    np.add.at(out[quadrant], cell[cell >= 0], energy[cell >= 0])


def _join_halves(tile: TileCells, out: Real) -> None:
    """Give both halves of a cell on an axis the variance of the whole."""
    for on_axis, pairs in ((tile.ay == 0, ((0, 1), (2, 3))), (tile.ax == 0, ((0, 3), (1, 2)))):
        for one, other in pairs:
            out[one, on_axis] = out[other, on_axis] = out[one, on_axis] + out[other, on_axis]
