"""
Variance of a sea in the cells of a tile's wavenumber plane.

The wave (mx, my) of a tile stands for the rectangle of wavenumbers half a step around it. In polar
coordinates its variance is

    E_k = integral of S(omega(k)) (d omega/dk) D(omega(k), theta) dk d theta,

and there the features of a sea lie along the axes: those of S at some k, those of D at some theta,
however narrow. A cell that is small beside the panels of `physics.panels` in which it lies is
integrated by 1 to 4 x 4 Gauss points. Any other is covered by rays from k = 0: Gauss points in
theta, between its corners and the edges of the direction panels, and on each ray Gauss points in k
between the points where the ray enters, crosses the edges of the frequency panels, and leaves.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Integer, Real
from fftocean.errors import ParameterError
from fftocean.grid import Grid
from fftocean.physics import dispersion
from fftocean.physics.panels import (
    direction_panels,
    energetic_frequencies,
    frequency_panels,
    gauss,
    gauss_rule,
    parts_of,
    split,
)
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spreading import LongCrested

Index = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

Band = tuple[float, float]
"""Wavenumbers from the first up to, but without, the second [rad/m]."""

WHOLE: Band = (0.0, math.inf)
"""All that a tile can hold."""

QUADRANTS = ((1, 1), (1, -1), (-1, -1), (-1, 1))
"""Signs of (mx, my)."""

TOLERANCE = 1e-3
"""Of a sea's variance: by how much the cells and the continuous integral may differ."""

_POINTS = (1, 2, 3, 4, 6)  # Gauss points a side ...
# ... that give 1e-3 to 1e-4 of a bell's top in cells up to so many quarters of a panel
_ACROSS = (0.16, 0.8, 1.6, 2.6, 4.5)
_TAIL = 0.22  # the scale on which k^-4 changes, as a share of k: 1/sqrt(20)
_BLOCK = 2**15  # evaluations of a density at a time: what stays in cache
_CELLS = 256  # cells covered by rays at a time
_RAYS = 2**13  # rays at a time
_SHORT = 0.35  # of a panel: a piece for which 4 points do, to 1e-6


class Cells:
    """
    The cells of one tile, dkx by dky [rad/m] each, and a sea's variance in them.

    What a cell holds depends on the sea and the cell alone: a finer grid of the same size has the
    same waves to the bit.
    """

    def __init__(
        self, sea: Sea, dkx: float, dky: float, parts: "Sequence[Part] | None" = None
    ) -> None:
        self.sea, self.dkx, self.dky = sea, dkx, dky
        self.parts = list(parts_of_sea(sea) if parts is None else parts)
        self._toward_axes = _toward_axes(dkx, dky)

    def variances(self, ax: Integer, ay: Integer) -> Real:
        """
        Return E_k at (sx ax, sy ay) for the signs of `QUADRANTS`, (4, m) [m^2]; they share their
        frequencies.

        Args:
            ax, ay: integer wavenumbers >= 0, (m,), never both 0.

        Raises:
            ParameterError: the sea's density is negative or not finite somewhere.
        """
        total = np.zeros((4, ax.size))
        for start in range(0, ax.size, _BLOCK // 4):
            block = slice(start, start + _BLOCK // 4)
            for part in self.parts:
                total[:, block] += part.share * self._variances_of(part, ax[block], ay[block])
        if not np.all((total >= 0.0) & (total < np.inf)):
            raise ParameterError(
                "the sea's spectrum must be finite and at least 0 at every wavenumber of the tile, "
                f"got {total[~((total >= 0.0) & (total < np.inf))][0]} m^2 in a cell"
            )
        return total

    def share_below(self, edge: float, mx: Integer, my: Integer) -> Real:
        """
        Return the share of the variance in the cells (mx, my) that lies below |k| = edge, (m,),
        from 0 to 1.

        A band holds the share below its upper edge less that below its lower one: bands that adjoin
        share out a cell without remainder. Where a sea has no energy in a cell, the whole cell
        belongs to the side on which its centre lies.
        """
        nearest, farthest = self.distances(mx, my)
        share = (farthest <= edge).astype(np.float64)
        cut = np.flatnonzero((nearest < edge) & (edge < farthest))
        x, y = mx[cut], my[cut]
        below, above = np.zeros(cut.size), np.zeros(cut.size)
        for part in self.parts:
            on_both_sides = self._by_rays(part, x, y, [(0.0, edge), (edge, math.inf)])
            below += part.share * on_both_sides[0]
            above += part.share * on_both_sides[1]
        total = below + above
        at_centre = np.hypot(x * self.dkx, y * self.dky) < edge
        share[cut] = np.divide(
            below, total, out=at_centre.astype(np.float64), where=(total > 0.0) & (total < np.inf)
        )
        return share

    def inside(self, half_x: float, half_y: float, band: Band = WHOLE) -> float:
        """
        Return the sea's variance with |kx| < half_x, |ky| < half_y and |k| in a band [m^2]: one
        integral, without cells.

        Along each ray from k = 0 the energy is summed up to the edge of the rectangle.
        """
        if not (half_x > 0.0 and half_y > 0.0 and band[0] < band[1]):
            return 0.0
        if math.hypot(half_x, half_y) <= band[0]:
            return 0.0
        total = 0.0
        for part, theta, weight, edge in self.rays(half_x, half_y, band):
            last = np.maximum(np.minimum(np.minimum(edge, band[1]), part.k[-1]), band[0])
            total += part.share * float(
                np.sum(part.along_rays(theta, weight, np.full(theta.size, band[0]), last))
            )
        return total

    def _inside(self, half_x: float, half_y: float, band: Band) -> float:
        """
        Return the same as `inside` of spreadings with integral 1: what a circle within the
        rectangle holds is an integral over k alone.
        """
        edge = min(half_x, half_y)
        if not band[0] < edge:
            return self.inside(half_x, half_y, band)
        circle = sum(part.share * part.between(band[0], min(edge, band[1])) for part in self.parts)
        return circle + self.inside(half_x, half_y, (edge, band[1]))

    def rays(
        self, half_x: float, half_y: float, band: Band = WHOLE
    ) -> Iterator[tuple["Part", Real, Real, Real]]:
        """
        Yield rays from k = 0 that cover the plane, on which integrals up to a rectangle's edge, or
        from there on, are smooth in theta.

        Yields:
            Each part of the sea with the directions [rad] and weights of its rays, and |k| where
            each leaves the rectangle [rad/m].
        """
        corner = math.atan2(half_y, half_x)
        corners = np.array([0.0, corner, 0.5 * np.pi, np.pi - corner])
        circles = np.array(
            [a for edge in band if 0.0 < edge < math.inf for a in _crossings(half_x, half_y, edge)]
        )
        # k = half_x / cos(theta) turns fast beside the axes of a long rectangle
        both_sides = np.array([-1.0, 1.0])[:, None] * 2.0 ** np.arange(-2.0, 40.0)
        axes = ((0.0, corner), (0.5 * np.pi, 0.5 * np.pi - corner))
        near = np.concatenate([axis + angle * both_sides for axis, angle in axes], axis=None)
        near = near[(np.abs(near) < 0.5 * np.pi) | (np.abs(near - 0.5 * np.pi) < 0.5 * np.pi)]
        edges = np.remainder(
            np.concatenate([corners, corners + np.pi, circles, near, near + np.pi]), 2.0 * np.pi
        )
        edges = np.unique(np.concatenate([edges, [0.0, 2.0 * np.pi]]))
        for part in self.parts:
            if part.long_crested:
                theta, weight = np.array([part.direction]), np.array([1.0])
            else:
                _, low, high = split(edges[:-1], edges[1:], part.theta)
                theta, weight = (a.ravel() for a in gauss(low, high))
            # along an axis the other edge is never met
            with np.errstate(divide="ignore", over="ignore"):
                yield (
                    part,
                    theta,
                    weight,
                    np.minimum(half_x / np.abs(np.cos(theta)), half_y / np.abs(np.sin(theta))),
                )

    @property
    def specified(self) -> float:
        """The sea's variance by the sum over its frequency panels [m^2]."""
        return sum(part.share * part.variance for part in self.parts)

    def require_energy(self, held: float, grid: Grid, band: Band) -> None:
        """
        Refuse a tile whose cells hold another variance than the sea has there.

        Raises:
            ParameterError: they differ by more than `TOLERANCE` of the sea's variance, or a
                spreading does not integrate to 1.
        """
        for part in self.parts:
            if abs(part.unity - 1.0) > TOLERANCE:
                raise ParameterError(
                    f"the spreading must integrate to 1 round the circle, within {TOLERANCE:g}, "
                    f"got {part.unity:.6g} for {part.system.spreading!r:.60}: name narrow features "
                    "and jumps in its `breaks`, or wrap it in CustomSpreading"
                )
        reach_x, reach_y = grid.reach
        within = self._inside((reach_x + 0.5) * grid.dkx, (reach_y + 0.5) * grid.dky, band)
        within -= self._inside(0.5 * grid.dkx, 0.5 * grid.dky, band)
        scale = sum(part.share * part.mainly for part in self.parts)
        if not abs(held - within) <= TOLERANCE * scale:
            raise ParameterError(
                "the waves of a tile must hold the sea's variance at their wavenumbers, "
                f"{within:.6g} m^2 of {self.specified:.6g} m^2, within {TOLERANCE:g}, "
                f"got {held:.6g} m^2: name narrow features and jumps of the spectrum and the "
                "spreading in their `breaks`"
            )

    def distances(self, mx: Integer, my: Integer) -> tuple[Real, Real]:
        """Return |k| of the nearest and of the farthest point of each cell [rad/m]."""
        ax, ay = np.abs(mx), np.abs(my)
        nearest = np.hypot(
            np.maximum(ax - 0.5, 0.0) * self.dkx, np.maximum(ay - 0.5, 0.0) * self.dky
        )
        return nearest, np.hypot((ax + 0.5) * self.dkx, (ay + 0.5) * self.dky)

    def _variances_of(self, part: "Part", ax: Integer, ay: Integer) -> Real:
        """Return the variances of one part, (4, m)."""
        out = np.zeros((4, ax.size))
        kx, ky = ax * self.dkx, ay * self.dky
        k, theta = np.hypot(kx, ky), np.arctan2(ky, kx)
        theta = np.stack([theta, -theta, theta - np.pi, np.pi - theta])
        nearest, farthest = self.distances(ax, ay)
        if part.long_crested:
            rays = self._on_ray(part.direction, kx, ky)
        else:
            # half the angle in which a cell is seen, or more
            half = np.minimum(
                (0.5 * self.dkx * ky + 0.5 * self.dky * kx) / (k * nearest), 0.5 * np.pi
            )
            radial, rough = part.radially(nearest, farthest)
            angular, broken = part.angularly(theta, half)
            rays = rough | broken | (np.maximum(radial, angular) > _ACROSS[-1])
            across = np.maximum(radial, np.max(np.where(rays, 0.0, angular), axis=0))
            levels = np.where(
                np.all(rays, axis=0), len(_POINTS), np.searchsorted(_ACROSS[:-1], across)
            )
            for level, p in enumerate(_POINTS):
                cells = np.flatnonzero(levels == level)
                at_a_time = max(1, _BLOCK // (4 * p * p))
                for start in range(0, cells.size, at_a_time):
                    some = cells[start : start + at_a_time]
                    if p == 1:
                        out[:, some] = part.density(k[some], theta[:, some]) / k[some]
                    else:
                        out[:, some] = self._by_points(part, kx[some], ky[some], p)
            out *= self.dkx * self.dky
        quadrant, cell = np.nonzero(rays)
        signs = np.array(QUADRANTS)[quadrant]
        out[quadrant, cell] = self._by_rays(part, signs[:, 0] * ax[cell], signs[:, 1] * ay[cell])[0]
        return out

    def _by_points(self, part: "Part", kx: Real, ky: Real, p: int) -> Real:
        """Return the mean density over cells by p x p Gauss points, (4, m)."""
        x, w = gauss_rule(p)
        weight = (0.25 * w[:, None] * w).ravel()
        kx = kx[:, None] + 0.5 * self.dkx * np.repeat(x, p)
        ky = ky[:, None] + 0.5 * self.dky * np.tile(x, p)
        k, theta = np.hypot(kx, ky), np.arctan2(ky, kx)
        theta = np.stack([theta, -theta, theta - np.pi, np.pi - theta])
        mean: Real = np.sum(part.density(k, theta) / k * weight, axis=-1)
        return mean

    def _on_ray(self, direction: float, kx: Real, ky: Real) -> Flags:
        """Return the cells of each quadrant that a ray from k = 0 meets, (4, m)."""
        signs = np.array(QUADRANTS, dtype=np.float64)
        cosine, sine = math.cos(direction), math.sin(direction)
        along = signs[:, :1] * kx * cosine + signs[:, 1:] * ky * sine
        beside = signs[:, 1:] * ky * cosine - signs[:, :1] * kx * sine
        reach = 0.5 * (self.dkx * abs(sine) + self.dky * abs(cosine)) * (1.0 + 1e-9)
        met: Flags = (np.abs(beside) <= reach) & (along > -max(self.dkx, self.dky))
        return met

    def _by_rays(
        self, part: "Part", mx: Integer, my: Integer, bands: Sequence[Band] = (WHOLE,)
    ) -> Real:
        """Return the variance of one part in the cells (mx, my) within bands, (bands, m)."""
        out = np.zeros((len(bands), mx.size))
        for start in range(0, mx.size, _CELLS):
            some = slice(start, start + _CELLS)
            axes = ((mx, self.dkx), (my, self.dky))
            low_x, high_x, low_y, high_y = (
                (m[some] + s) * dk for m, dk in axes for s in (-0.5, 0.5)
            )
            cell, theta, weight = self._rays(part, (low_x, high_x, low_y, high_y), bands)
            c, s = np.cos(theta), np.sin(theta)
            with np.errstate(divide="ignore", over="ignore"):
                ends = low_x[cell] / c, high_x[cell] / c, low_y[cell] / s, high_y[cell] / s
            enter = np.maximum(np.minimum(ends[0], ends[1]), np.minimum(ends[2], ends[3]))
            leave = np.minimum(np.maximum(ends[0], ends[1]), np.maximum(ends[2], ends[3]))
            for band, held in zip(bands, out, strict=True):
                first = np.maximum(enter, band[0])
                last = np.minimum(np.minimum(leave, band[1]), part.k[-1])
                chosen = np.flatnonzero(last > first)
                energy = part.along_rays(theta[chosen], weight[chosen], first[chosen], last[chosen])
                held[some] = np.bincount(cell[chosen], energy, low_x.size)
        return out

    def _rays(
        self, part: "Part", sides: tuple[Real, Real, Real, Real], bands: Sequence[Band]
    ) -> tuple[Index, Real, Real]:
        """Return rays from k = 0 that cover cells: the cell, direction and weight of each."""
        low_x, high_x, low_y, high_y = sides
        heading = np.arctan2(low_y + high_y, low_x + high_x)

        def turned(x: Real, y: Real) -> Real:
            return np.remainder(np.arctan2(y, x) - heading + np.pi, 2.0 * np.pi) - np.pi

        corners = np.sort([turned(x, y) for x in (low_x, high_x) for y in (low_y, high_y)], axis=0)
        if part.long_crested:
            from_heading = np.remainder(part.direction - heading + np.pi, 2.0 * np.pi) - np.pi
            cell = np.flatnonzero((corners[0] <= from_heading) & (from_heading <= corners[3]))
            return cell, np.full(cell.size, part.direction), np.ones(cell.size)
        nearest = np.hypot(
            *(
                np.maximum(np.maximum(low, -high), 0.0)
                for low, high in ((low_x, high_x), (low_y, high_y))
            )
        )
        farthest = np.hypot(np.maximum(-low_x, high_x), np.maximum(-low_y, high_y))
        breaks = [*corners]
        rings = part.rings(0.15 * min(self.dkx, self.dky))
        for edge in sorted({*rings, *(edge for band in bands for edge in band)}):
            met = (nearest < edge) & (edge < farthest)
            if np.any(met):  # where the circle |k| = edge meets the lines through the sides
                across = [np.sqrt(np.maximum(edge**2 - side**2, 0.0)) for side in sides]
                points = [
                    (x, sign * y)
                    for x, y in zip(sides[:2], across[:2], strict=True)
                    for sign in (-1.0, 1.0)
                ]
                points += [
                    (sign * x, y)
                    for x, y in zip(across[2:], sides[2:], strict=True)
                    for sign in (-1.0, 1.0)
                ]
                breaks += [np.where(met, turned(x, y), corners[0]) for x, y in points]
        ends: Real = np.sort(np.clip(breaks, corners[0], corners[3]), axis=0) + heading
        low, high = ends[:-1].T.ravel(), ends[1:].T.ravel()
        cell = np.repeat(np.arange(heading.size), ends.shape[0] - 1)
        wide = np.flatnonzero(high > low)
        edges = np.union1d(part.theta, self._toward_axes)
        piece, low, high = split(low[wide], high[wide], edges)
        cell = cell[wide][piece]
        short = high - low <= _SHORT * _length_around(edges, low, high)
        found = []
        for order, these in ((4, short), (8, ~short)):
            theta, weight = gauss(low[these], high[these], order)
            found.append((np.repeat(cell[these], order), theta.ravel(), weight.ravel()))
        cell, theta, weight = (np.concatenate(column) for column in zip(*found, strict=True))
        return cell, theta, weight


@dataclass(slots=True, init=False)
class Part:
    """One wave system, or a share of one, with the panels on which it is smooth."""

    share: float
    system: WaveSystem
    depth: float
    tension: float
    direction: float  # [rad]
    long_crested: bool
    knows_waves: bool  # the spectrum need not invert the dispersion relation
    energy: Real  # of each frequency panel [m^2]
    variance: float  # [m^2]
    mainly: float  # of that, up to a thousand peaks: finite whatever the tail [m^2]
    unity: float  # integral of D over theta where it is farthest from 1
    k: Real  # edges of the frequency panels [rad/m]
    k_jumps: Real
    theta: Real  # edges of the direction panels, over five turns [rad]
    theta_jumps: Real

    def __init__(self, share: float, system: WaveSystem, sea: Sea) -> None:
        self.share, self.system, self.depth, self.tension = (
            share,
            system,
            sea.depth,
            sea.surface_tension,
        )
        self.direction = math.radians(system.direction % 360.0)
        self.long_crested = isinstance(system.spreading, LongCrested)
        spectrum = system.spectrum
        water = getattr(spectrum, "depth", None), getattr(spectrum, "surface_tension", 0.0)
        self.knows_waves = hasattr(spectrum, "at_waves") and water == (
            sea.depth,
            sea.surface_tension,
        )
        omega = frequency_panels(system)
        self.k = dispersion.wavenumber(omega.edges, self.depth, self.tension)
        self.k_jumps = dispersion.wavenumber(omega.jumps, self.depth, self.tension)
        some, energy = energetic_frequencies(system, omega.edges)
        self.energy, self.variance = energy, float(np.sum(energy))
        self.mainly = float(np.sum(energy[omega.edges[1:] <= 1e3 * float(system.spectrum.peak)]))
        self.theta = self.theta_jumps = np.zeros(0)
        self.unity = 1.0
        if not self.long_crested:
            panels = direction_panels(system, some)
            turns = 2.0 * np.pi * np.arange(-2.0, 3.0)[:, None] + self.direction
            self.theta = np.unique(panels.edges[:-1] + turns)
            self.theta_jumps = np.unique(panels.jumps + turns)
            points, weights = gauss(panels.edges[:-1], panels.edges[1:])
            density = system.spreading(some[:, None], points.ravel(), float(system.spectrum.peak))
            unity = np.sum(
                np.broadcast_to(density, (some.size, points.size)) * weights.ravel(), axis=1
            )
            self.unity = (
                float(unity[np.argmax(np.abs(unity - 1.0))]) if self.variance > 0.0 else 1.0
            )

    def spectrum_at(self, k: Real) -> tuple[Real, Real]:
        """Return omega and S at k > 0."""
        omega = dispersion.angular_frequency(k, self.depth, self.tension)
        if self.knows_waves:
            return omega, self.system.spectrum.at_waves(omega, k)  # type: ignore[attr-defined]
        return omega, self.system.spectrum(omega)

    def radial(self, k: Real) -> tuple[Real, Real]:
        """Return omega and S d omega/dk at k > 0."""
        omega, s = self.spectrum_at(k)
        slope = omega / k * dispersion.group_to_phase_speed(k, self.depth, self.tension)
        return omega, s * slope

    def density(self, k: Real, theta: Real) -> Real:
        """
        Return S D d omega/dk [m^3], D not for a long-crested part, k (...,) and theta (..., ...).
        """
        omega, s = self.radial(k)
        if self.long_crested:
            return s
        return s * self.system.spreading(
            omega, theta - self.direction, float(self.system.spectrum.peak)
        )

    def between(self, low: float, high: float) -> float:
        """Return the variance between two wavenumbers, in all directions [m^2]."""
        last = min(high, float(self.k[-1]))
        if not low < last:
            return 0.0
        _, first, end = split(np.array([low]), np.array([last]), self.k)
        k, weight = gauss(first, end)
        return float(np.sum(self.radial(k)[1] * weight))

    def along_rays(self, theta: Real, weight: Real, first: Real, last: Real) -> Real:
        """
        Return the variance along rays, from `first` to `last` [rad/m] on each, times its weight,
        (rays,).
        """
        out = np.zeros(theta.size)
        for start in range(0, theta.size, _RAYS):
            some = slice(start, start + _RAYS)
            ray, low, high = split(first[some], last[some], self.k)
            panel = np.clip(
                np.searchsorted(self.k, 0.5 * (low + high)) - 1, 0, self.energy.size - 1
            )
            short = high - low <= _SHORT * (self.k[panel + 1] - self.k[panel])
            for order, these in ((4, short), (8, ~short)):
                pieces = np.flatnonzero(these & (self.energy[panel] > 0.0))
                for first_piece in range(0, pieces.size, _BLOCK // order):
                    piece = pieces[first_piece : first_piece + _BLOCK // order]
                    k, w = gauss(low[piece], high[piece], order)
                    density = self.density(k, theta[some][ray[piece], None])
                    np.add.at(out[some], ray[piece], np.sum(density * w, axis=1))
        out *= weight
        return out

    def rings(self, narrow: float) -> list[float]:
        """
        Return the edges of the frequency panels narrower than `narrow`, and the jumps: the energy
        of a cell bends where they cross its sides.
        """
        narrow_panels = np.flatnonzero(np.diff(self.k) < narrow)
        narrow_panels = narrow_panels[self.energy[narrow_panels] > 1e-6 * self.variance]
        ends = [self.k[narrow_panels], self.k[narrow_panels + 1], self.k_jumps]
        edges: list[float] = np.unique(np.concatenate(ends)).tolist()
        return edges

    def radially(self, nearest: Real, farthest: Real) -> tuple[Real, Flags]:
        """
        Return the size of cells relative to their frequency panels, in quarters of a panel, and a
        flag for cells that more than two panels cover.
        """
        return _beside(self.k, self.k_jumps, nearest, farthest, _TAIL * nearest)

    def angularly(self, theta: Real, half: Real) -> tuple[Real, Flags]:
        """
        Return the same for direction panels, of angles `half` (m,) to both sides of theta (4, m);
        a size of 0 for cells so narrow that one Gauss point does in any panel.
        """
        size, rough = np.zeros(theta.shape), np.zeros(theta.shape, np.bool_)
        narrowest = 0.25 * float(np.min(np.diff(self.theta), initial=np.inf))
        some = np.flatnonzero(
            2.0 * half > (0.0 if self.theta_jumps.size else _ACROSS[0] * narrowest)
        )
        low, high = theta[:, some] - half[some], theta[:, some] + half[some]
        size[:, some], rough[:, some] = _beside(self.theta, self.theta_jumps, low, high, np.inf)
        return size, rough


def parts_of_sea(sea: Sea) -> list[Part]:
    """Return the parts of a sea, which the cells of all tiles can share."""
    return [Part(share, part, sea) for system in sea.systems for share, part in parts_of(system)]


def _beside(
    edges: Real, jumps: Real, low: Real, high: Real, most: Real | float
) -> tuple[Real, Flags]:
    lengths = np.concatenate([[np.inf], np.diff(edges), [np.inf]])
    first, last = np.searchsorted(edges, low, "right"), np.searchsorted(edges, high, "right")
    scale = np.minimum(0.25 * np.minimum(lengths[first], lengths[last]), most)
    rough: Flags = last > first + 1
    for jump in jumps:
        rough |= (low < jump) & (jump < high)
    return (high - low) / scale, rough


def _length_around(edges: Real, low: Real, high: Real) -> Real:
    """
    Return the lengths of the intervals between edges that contain some shorter ones; inf outside.
    """
    lengths: Real = np.concatenate([[np.inf], np.diff(edges), [np.inf]])[
        np.searchsorted(edges, 0.5 * (low + high))
    ]
    return lengths


def _crossings(half_x: float, half_y: float, edge: float) -> list[float]:
    """Return the directions in which the circle |k| = edge leaves a rectangle [rad]."""
    found = [math.acos(half_x / edge)] if half_x < edge else []
    found += [math.asin(half_y / edge)] if half_y < edge else []
    return [sign * angle + turn for angle in found for sign in (-1.0, 1.0) for turn in (0.0, np.pi)]


def _toward_axes(dkx: float, dky: float) -> Real:
    """
    Return directions that narrow by halves toward the axis along which a long cell stretches; none
    for cells up to twice as long as wide.
    """
    ratio = max(dkx, dky) / min(dkx, dky)
    if ratio <= 2.0:
        return np.zeros(0)
    steps = 0.25 * np.pi * 0.5 ** np.arange(math.ceil(math.log2(ratio)) + 3)
    axes = np.pi * np.arange(-2.0, 3.0) + (0.0 if dkx > dky else 0.5 * np.pi)
    return np.unique(
        np.concatenate([axes, (axes[:, None] + steps).ravel(), (axes[:, None] - steps).ravel()])
    )
