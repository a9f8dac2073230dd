"""h0(k): the variance of each wavenumber cell times chance, frozen."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean import noise
from fftocean.arrays import Complex, Integer, Real, brief_repr
from fftocean.errors import ParameterError
from fftocean.grid import Grid
from fftocean.limits import ANGLE, DEPTH, LENGTH, LOOP, SEED
from fftocean.physics import dispersion, moments
from fftocean.physics.sea import Sea, WaveSystem

Draw = Literal["gaussian", "fixed"]

Band = tuple[float, float]
"""Wavenumbers from the first up to, but without, the second [rad/m]."""

WHOLE: Band = (0.0, math.inf)
"""All that a tile can hold."""


class Modes(NamedTuple):
    """Every wave of a tile, in float64: height = sum of amplitude cos(kx x + ky y - omega t - phase)."""

    kx: Real  # [rad/m]
    ky: Real  # [rad/m]
    amplitude: Real  # [m], >= 0
    phase: Real  # [rad]
    omega: Real  # [rad/s]; on a loop, a whole number of turns in its period

    def __repr__(self) -> str:
        return brief_repr(self)


@dataclass(frozen=True, slots=True)
class Amplitudes:
    """
    The waves of a tile at t = 0, on the half plane of wavenumbers (see `Grid`).

    h(k, t) = forward e^{-i omega t} + backward e^{+i omega t}, with forward = h0(k) and backward = conj(h0(-k)).
    """

    grid: Grid
    depth: float  # [m]
    surface_tension: float  # [N/m]
    loop: float | None  # period after which all repeats [s]
    forward: Complex  # (ny, nx // 2 + 1), complex128 [m]
    backward: Complex  # the same
    variance_forward: Real  # E_k, the expected a^2/2 of the wave at +k [m^2]
    variance_backward: Real  # of the wave at -k [m^2]
    draw: Literal["gaussian", "fixed", "given"]
    band: Band = WHOLE  # the wavenumbers |k| that the tile was to hold, of those that it can [rad/m]
    cycles: Integer | None = field(init=False)  # whole turns in a loop

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        cycles = None if self.loop is None else dispersion.loop_cycles(self.omega, LOOP.check("loop", self.loop))
        object.__setattr__(self, "cycles", cycles)
        self.freeze()

    def freeze(self) -> None:
        """Forbid changes of the arrays; once more after they were unpickled, which forgets it."""
        for array in (self.forward, self.backward, self.variance_forward, self.variance_backward, self.cycles):
            if array is not None:
                array.setflags(write=False)

    @property
    def squares(self) -> Real:
        """|forward|^2 + |backward|^2: half the a^2/2 of an entry's two waves, +k and -k together, (ny, nx // 2 + 1) [m^2]."""
        total: Real = np.abs(self.forward) ** 2 + np.abs(self.backward) ** 2
        return total

    @property
    def omega(self) -> Real:
        """The frequencies of the dispersion relation, before any loop [rad/s]; computed when asked for."""
        return dispersion.angular_frequency(self.grid.k, self.depth, self.surface_tension)

    @property
    def running_omega(self) -> Real:
        """The frequencies at which the waves do run: omega, or 2 pi cycles / loop  [rad/s]."""
        return self.omega if self.cycles is None else self.cycles * (2.0 * np.pi / self.loop)  # type: ignore[operator]

    @property
    def variance(self) -> float:
        """m0 that the tile holds on average over seeds: the sum of E_k [m^2]."""
        half = float(np.sum(self.variance_forward))
        return half + float(np.sum(self.variance_backward[:, 1:]))  # the column mx = 0 holds both k and -k

    def modes(self) -> Modes:
        """Return every wave that carries energy."""
        kx, ky = np.broadcast_arrays(self.grid.kx[None, :], self.grid.ky[:, None])
        omega = self.running_omega
        here, there = self.forward != 0.0, self.backward != 0.0
        there[:, 0] = False  # those are the conjugates of the same column's forward waves
        h0 = np.concatenate([self.forward[here], np.conj(self.backward[there])])
        return Modes(
            kx=np.concatenate([kx[here], -kx[there]]),
            ky=np.concatenate([ky[here], -ky[there]]),
            amplitude=2.0 * np.abs(h0),
            phase=-np.angle(h0),
            omega=np.concatenate([omega[here], omega[there]]),
        )


def seed_amplitudes(
    sea: Sea, grid: Grid, *, seed: int = 0, loop: float | None = None, draw: Draw = "gaussian", band: Band = WHOLE
) -> Amplitudes:
    """
    Realise a sea on a grid:  h0 = 1/2 (xi_r + i xi_i) sqrt(E_k).

    Args:
        sea: what was ordered.
        grid: the tile.
        seed: which of all the seas that it could be.
        loop: period after which the tile repeats [s].
        draw: "gaussian" for unit normals xi, as in a real sea, whose wave heights vary from draw to draw; "fixed" for random
            phases alone, |h0| = sqrt(E_k/2), so that the sum of a^2/2 over the waves is the same in every draw.
        band: the wavenumbers to hold. A wave whose cell lies within is the same to the bit whatever the band; one whose cell is cut
            by an edge keeps its phase, and carries the energy of its part (see `share_below`).

    Raises:
        ParameterError: a value out of range, or a sea whose density is not finite and >= 0.

    Source: Tessendorf 2001, with the factor of DESIGN: E[a^2/2] = 2 E|h0|^2 = E_k.
    """
    seed = SEED.check_whole("seed", seed)
    if draw not in ("gaussian", "fixed"):
        raise ParameterError(f"amplitudes must be 'gaussian' or 'fixed', got {draw!r}")

    def realise(mx: Integer, my: Integer) -> tuple[Real, Complex]:
        variance = cell_variance(sea, mx, my, grid.dkx, grid.dky)
        if band != WHOLE:
            low, high = (share_below(edge, sea, mx, my, grid.dkx, grid.dky) for edge in band)
            variance *= np.maximum(high - low, 0.0)
        chance = noise.complex_normals(seed, mx, my) if draw == "gaussian" else np.sqrt(2.0) * noise.unit_phasors(seed, mx, my)
        return variance, 0.5 * np.sqrt(variance) * chance

    forward, backward = (np.zeros(grid.half_shape, np.complex128, order="F") for _ in range(2))
    variance_forward, variance_backward = np.zeros(grid.half_shape), np.zeros(grid.half_shape)
    at_a_time = max(1, _BLOCK // grid.ny)  # columns: what is made on the way is several times as much as what is kept
    for first in range(0, grid.half_shape[1], at_a_time):
        rows, columns = np.nonzero(grid.active[:, first : first + at_a_time])
        columns += first
        touched = _touched(grid.mx[columns], grid.my[rows], grid, band)
        cells = rows[touched], columns[touched]
        mx, my = grid.mx[cells[1]], grid.my[cells[0]]
        variance_forward[cells], forward[cells] = realise(mx, my)
        variance_backward[cells], h0 = realise(-mx, -my)
        backward[cells] = np.conj(h0)
    return Amplitudes(grid, sea.depth, sea.surface_tension, loop, forward, backward, variance_forward, variance_backward, draw, band)


def place_modes(
    waves: Iterable[tuple[int, int, float, float]], grid: Grid, *, depth: float, surface_tension: float = 0.0, loop: float | None = None
) -> Amplitudes:
    """
    Build a sea of given waves (mx, my, amplitude [m], phase [rad]): height = sum a cos(k.x - omega t - phase).

    Waves on the same (mx, my) add up.

    Raises:
        ParameterError: a wave the grid cannot hold (k = 0, or at or beyond the Nyquist index), or a value out of range.
    """
    DEPTH.check("depth", depth)
    reach_x, reach_y = grid.reach
    forward, backward = (np.zeros(grid.half_shape, np.complex128, order="F") for _ in range(2))
    for wave in waves:
        try:
            mx, my, amplitude, phase = wave
        except (TypeError, ValueError) as error:
            raise ParameterError(f"a wave must be (mx, my, amplitude, phase), got {wave!r}") from error
        if not (mx == int(mx) and my == int(my) and (mx or my) and abs(mx) <= reach_x and abs(my) <= reach_y):
            raise ParameterError(
                f"a wave on this grid must have whole |mx| <= {reach_x} and |my| <= {reach_y}, not both 0, got ({mx}, {my})"
            )
        mx, my = int(mx), int(my)
        h0 = 0.5 * LENGTH.check("amplitude", amplitude) * np.exp(-1j * ANGLE.check("phase", phase))
        if mx >= 0:
            forward[my, mx] += h0
        if mx <= 0:
            backward[-my, -mx] += np.conj(h0)
    energy, energy_opposite = 2.0 * np.abs(forward) ** 2, 2.0 * np.abs(backward) ** 2
    return Amplitudes(grid, depth, surface_tension, loop, forward, backward, energy, energy_opposite, "given")


def cell_variance(sea: Sea, mx: Integer, my: Integer, dkx: float, dky: float) -> Real:
    """
    Return E_k, the sea's variance in the cells around the wavenumbers (mx dkx, my dky).

    E_k = integral over the cell of S(omega) D(omega, theta) (d omega/dk)/k dkx dky, by the midpoint rule in p x p parts; p is
    as large as the sea's narrowest feature asks at that wavenumber, and 1 far out, where the density is smooth across a cell.
    It depends on the sea and on the cell alone, so a finer grid has the same waves to the bit.

    Args:
        sea: what was ordered.
        mx, my: integer wavenumbers, (m,), never both 0.
        dkx, dky: cell sizes [rad/m].

    Returns:
        (m,) [m^2].

    Raises:
        ParameterError: the sea's density is negative or not finite somewhere.
    """
    total = np.zeros(mx.shape)
    distance = np.hypot(mx * dkx, my * dky) / max(dkx, dky)  # in cells from k = 0
    for system in sea.systems:
        parts = _FINENESS / (_narrowness(system) * distance)
        levels = np.clip(np.ceil(np.log2(np.maximum(parts, 1.0))), 0, _MOST_PARTS_LOG2).astype(np.int64)
        for level in np.unique(levels):
            p = 2 ** int(level)
            offsets = (np.arange(p) + 0.5) / p - 0.5
            ox, oy = (o.ravel()[None, :] for o in np.meshgrid(offsets, offsets))
            cells = np.flatnonzero(levels == level)
            for block in np.array_split(cells, max(1, cells.size * p * p // _BLOCK)):
                kx, ky = (mx[block, None] + ox) * dkx, (my[block, None] + oy) * dky
                total[block] += np.mean(wavenumber_density(sea, system, kx, ky), axis=1) * (dkx * dky)
    if not np.all((total >= 0.0) & (total < np.inf)):
        raise ParameterError("the sea's spectrum must be finite and at least 0 at every wavenumber of the tile, and is not")
    return total


def share_below(edge: float, sea: Sea, mx: Integer, my: Integer, dkx: float, dky: float) -> Real:
    """
    Return how much of the variance in the cells around (mx dkx, my dky) lies below |k| = edge, (m,), from 0 to 1.

    A band holds the share below its upper edge less that below its lower one: bands that adjoin share out a cell without remainder.
    A cut cell is integrated in polar coordinates, where the edge is a straight line: between the directions of its corners and of the
    points where the edge enters and leaves it, all is smooth, and 8 x 8 Gauss points are good to round-off on a smooth spectrum.
    Where a spectrum has no energy at these points, the whole cell belongs to the side on which its centre lies.

    Args:
        edge: wavenumber [rad/m], 0 and inf included.
        sea: whose energy to weigh a cell's parts with.
        mx, my: integer wavenumbers, (m,), never both 0.
        dkx, dky: cell sizes [rad/m].

    Pinned by tests/test_cascade.py: a flat spectrum, where shares are areas; shares of all bands add up to 1.
    """
    nearest, farthest = _distances(mx, my, dkx, dky)
    share = (farthest <= edge).astype(np.float64)
    cut = np.flatnonzero((nearest < edge) & (edge < farthest))
    below, above = np.zeros(cut.size), np.zeros(cut.size)
    for start in range(0, cut.size, _CUT_CELLS):
        part = slice(start, start + _CUT_CELLS)
        cells = cut[part]
        centre = np.stack([mx[cells] * dkx, my[cells] * dky])
        theta, weight, first, last = _rays(centre, 0.5 * dkx, 0.5 * dky, edge)
        middle = np.clip(edge, first, last)
        below[part] = _along_rays(sea, theta, weight, first, middle)
        above[part] = _along_rays(sea, theta, weight, middle, last)
    total = below + above
    at_centre = np.hypot(mx[cut] * dkx, my[cut] * dky) < edge
    share[cut] = np.divide(below, total, out=at_centre.astype(np.float64), where=(total > 0.0) & (total < np.inf))
    return share


_CUT_CELLS = 512
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def _distances(mx: Integer, my: Integer, dkx: float, dky: float) -> tuple[Real, Real]:
    """|k| of the nearest and of the farthest point of each cell."""
    ax, ay = np.abs(mx), np.abs(my)
    nearest = np.hypot(np.maximum(ax - 0.5, 0.0) * dkx, np.maximum(ay - 0.5, 0.0) * dky)
    return nearest, np.hypot((ax + 0.5) * dkx, (ay + 0.5) * dky)


def _touched(mx: Integer, my: Integer, grid: Grid, band: Band) -> npt.NDArray[np.bool_]:
    """Which cells have a part in a band."""
    nearest, farthest = _distances(mx, my, grid.dkx, grid.dky)
    touched: npt.NDArray[np.bool_] = (farthest > band[0]) & (nearest < band[1])
    return touched


def _rays(centre: Real, half_x: float, half_y: float, edge: float) -> tuple[Real, Real, Real, Real]:
    """
    Cover cells with rays from k = 0: directions and weights, and from where to where on each the cell lies; each (cells, rays).

    `centre` is (2, cells); a cell does not contain k = 0. Rays stand at Gauss points between the directions in which something breaks.
    """
    heading = np.arctan2(centre[1], centre[0])
    sides = [(centre[0] - half_x, centre[0] + half_x), (centre[1] - half_y, centre[1] + half_y)]
    points = [(x, y) for x in sides[0] for y in sides[1]]
    for axis in (0, 1):  # where the circle |k| = edge meets the lines through the sides
        for side in sides[axis]:
            across = np.sqrt(np.maximum(edge**2 - side**2, 0.0))
            points += [(side, sign * across) if axis == 0 else (sign * across, side) for sign in (-1.0, 1.0)]
    turned = np.stack([np.arctan2(y, x) for x, y in points]) - heading
    turned = np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi
    breaks = np.sort(np.clip(turned, np.min(turned[:4], axis=0), np.max(turned[:4], axis=0)), axis=0).T
    width = 0.5 * np.diff(breaks, axis=1)
    theta = (breaks[:, :-1, None] + width[:, :, None] * (1.0 + _NODES)).reshape(heading.size, -1) + heading[:, None]
    weight = (width[:, :, None] * _WEIGHTS).reshape(theta.shape)
    first, last = np.zeros(theta.shape), np.full(theta.shape, np.inf)
    for (low, high), along in zip(sides, (np.cos(theta), np.sin(theta)), strict=True):
        with np.errstate(divide="ignore"):
            ends = low[:, None] / along, high[:, None] / along
        first, last = np.maximum(first, np.minimum(*ends)), np.minimum(last, np.maximum(*ends))
    return theta, weight, first, np.maximum(first, last)


def _along_rays(sea: Sea, theta: Real, weight: Real, first: Real, last: Real) -> Real:
    """The sea's variance along rays, from `first` to `last` on each, summed cell by cell, (cells,)."""
    half = 0.5 * (last - first)
    k = first[:, :, None] + half[:, :, None] * (1.0 + _NODES)
    kx, ky = k * np.cos(theta)[:, :, None], k * np.sin(theta)[:, :, None]
    density = sum((wavenumber_density(sea, system, kx, ky) for system in sea.systems), np.zeros(k.shape))
    variance: Real = np.einsum("crn,crn,n,cr,cr->c", density, k, _WEIGHTS, half, weight)
    return variance


_FINENESS = 8.0  # midpoints across the narrowest feature: 0.3 standard deviations of a Gaussian apart
_MOST_PARTS_LOG2 = 7  # at most 128 x 128 parts a cell; only the few cells next to k = 0 ever ask for more
_BLOCK = 2**18  # density evaluations at a time: what stays in cache


def wavenumber_density(sea: Sea, system: WaveSystem, kx: Real, ky: Real) -> Real:
    """S(omega) D(omega, theta) (d omega/dk) / k  [m^2 / (rad/m)^2]: the density in the plane of wavenumbers, k > 0."""
    k = np.hypot(kx, ky)
    omega = dispersion.angular_frequency(k, sea.depth, sea.surface_tension)
    d_omega = omega / k * dispersion.group_to_phase_speed(k, sea.depth, sea.surface_tension)
    return system.density(omega, np.arctan2(ky, kx)) * d_omega / k


def _narrowness(system: WaveSystem) -> float:
    """The width of a system's narrowest feature as a fraction of k: what an equally high rectangle would have; inf if it is flat."""
    spectrum, peak = system.spectrum, system.spectrum.peak
    omega = moments.spectral_grid([peak], getattr(spectrum, "breaks", ()))
    s = np.asarray(spectrum(omega))
    if not np.max(s) > 0.0:
        return np.inf
    across = float(np.trapezoid(s, omega) / (np.max(s) * omega[np.argmax(s)]))
    corners = np.asarray(getattr(spectrum, "breaks", ()))
    if corners.size > 1:
        across = min(across, 2.0 * float(np.min(np.diff(corners) / corners[1:])))
    theta = np.linspace(-np.pi, np.pi, 721)
    energetic = omega[s > 1e-3 * np.max(s)][::8]
    along = 1.0 / float(np.max(system.spreading(energetic[:, None], theta[None, :], peak)))
    return min(across, along, 1.0)
