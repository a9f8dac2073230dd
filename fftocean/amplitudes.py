"""h0(k): the variance of each wavenumber cell times chance, frozen."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from fftocean import noise
from fftocean.arrays import Complex, Integer, Real
from fftocean.errors import ParameterError
from fftocean.grid import Grid
from fftocean.limits import ANGLE, DEPTH, LENGTH, LOOP, SEED
from fftocean.physics import dispersion, moments
from fftocean.physics.sea import Sea, WaveSystem

Draw = Literal["gaussian", "fixed"]


class Modes(NamedTuple):
    """Every wave of a tile, in float64: height = sum of amplitude cos(kx x + ky y - omega t - phase)."""

    kx: Real  # [rad/m]
    ky: Real  # [rad/m]
    amplitude: Real  # [m], >= 0
    phase: Real  # [rad]
    omega: Real  # [rad/s]; on a loop, a whole number of turns in its period


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
    omega: Real = field(init=False)  # as the dispersion relation has it, before any loop [rad/s]
    cycles: Integer | None = field(init=False)  # whole turns in a loop

    def __post_init__(self) -> None:
        omega = dispersion.angular_frequency(self.grid.k, self.depth, self.surface_tension)
        cycles = None if self.loop is None else dispersion.loop_cycles(omega, LOOP.check("loop", self.loop))
        object.__setattr__(self, "omega", omega)
        object.__setattr__(self, "cycles", cycles)
        for array in (self.forward, self.backward, self.variance_forward, self.variance_backward, omega, cycles):
            if array is not None:
                array.setflags(write=False)

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


def seed_amplitudes(sea: Sea, grid: Grid, *, seed: int = 0, loop: float | None = None, draw: Draw = "gaussian") -> Amplitudes:
    """
    Realise a sea on a grid:  h0 = 1/2 (xi_r + i xi_i) sqrt(E_k).

    Args:
        sea: what was ordered.
        grid: the tile.
        seed: which of all the seas that it could be.
        loop: period after which the tile repeats [s].
        draw: "gaussian" for unit normals xi, as in a real sea, whose wave heights vary from draw to draw; "fixed" for random
            phases alone, |h0| = sqrt(E_k/2), so that the sum of a^2/2 over the waves is the same in every draw.

    Raises:
        ParameterError: a value out of range, or a sea whose density is not finite and >= 0.

    Source: Tessendorf 2001, with the factor of DESIGN: E[a^2/2] = 2 E|h0|^2 = E_k.
    """
    seed = SEED.check_whole("seed", seed)
    if draw not in ("gaussian", "fixed"):
        raise ParameterError(f"amplitudes must be 'gaussian' or 'fixed', got {draw!r}")
    rows, columns = np.nonzero(grid.active)
    mx, my = grid.mx[columns], grid.my[rows]

    def realise(mx: Integer, my: Integer) -> tuple[Real, Complex]:
        variance = cell_variance(sea, mx, my, grid.dkx, grid.dky)
        chance = noise.complex_normals(seed, mx, my) if draw == "gaussian" else np.sqrt(2.0) * noise.unit_phasors(seed, mx, my)
        return variance, 0.5 * np.sqrt(variance) * chance

    ahead, h0 = realise(mx, my)
    astern, h0_opposite = realise(-mx, -my)
    forward, backward = (np.zeros(grid.half_shape, np.complex128, order="F") for _ in range(2))
    variance_forward, variance_backward = np.zeros(grid.half_shape), np.zeros(grid.half_shape)
    forward[rows, columns], backward[rows, columns] = h0, np.conj(h0_opposite)
    variance_forward[rows, columns], variance_backward[rows, columns] = ahead, astern
    return Amplitudes(grid, sea.depth, sea.surface_tension, loop, forward, backward, variance_forward, variance_backward, draw)


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
