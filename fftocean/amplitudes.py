"""Random amplitudes h0(k) of a tile, from the variance of each wavenumber cell."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean import noise
from fftocean.arrays import Complex, Integer, Real, brief_repr
from fftocean.cells import QUADRANTS, WHOLE, Band, Cells, Part
from fftocean.errors import ParameterError
from fftocean.fixed_values import Fix, Rarity
from fftocean.grid import Grid
from fftocean.limits import ANGLE, DEPTH, LENGTH, LOOP, SEED
from fftocean.physics import dispersion
from fftocean.physics.sea import Sea

Draw = Literal["gaussian", "fixed"]


class Modes(NamedTuple):
    """
    Every wave of a tile, in float64: height = sum of amplitude cos(kx x + ky y - omega t - phase).
    """

    kx: Real  # [rad/m]
    ky: Real  # [rad/m]
    amplitude: Real  # [m], >= 0
    phase: Real  # [rad]
    omega: Real  # [rad/s]; on a loop, a whole number of cycles in its period

    def __repr__(self) -> str:
        return brief_repr(self)


_BLOCK = 2**16  # cells of a quadrant at a time


@dataclass(frozen=True, slots=True)
class Amplitudes:
    """
    The waves of a tile at t = 0, on the half plane of wavenumbers (see `Grid`).

    h(k, t) = forward e^{-i omega t} + backward e^{+i omega t}, with forward = h0(k) and backward =
    conj(h0(-k)).
    """

    grid: Grid
    depth: float  # [m]
    surface_tension: float  # [N/m]
    loop: float | None  # period after which all repeats [s]
    forward: Complex  # (ny, nx // 2 + 1), complex128 [m]
    backward: Complex  # the same
    variance_forward: Real  # E_k, the expected a^2/2 of the wave at +k [m^2]
    variance_backward: Real  # of the wave at -k [m^2]
    draw: Literal["gaussian", "fixed", "given", "constrained"]
    band: Band = (
        WHOLE  # the wavenumbers |k| that the tile was to hold, of those that it can [rad/m]
    )
    # values that these waves were made to have, and the rarity of those of all tiles together
    fixed: tuple[Fix, ...] = ()
    rarity: Rarity | None = None
    cycles: Integer | None = field(init=False)  # whole cycles in a loop

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        cycles = (
            None
            if self.loop is None
            else dispersion.loop_cycles(self.omega, LOOP.check("loop", self.loop))
        )
        object.__setattr__(self, "cycles", cycles)
        self.freeze()

    def freeze(self) -> None:
        """Make the arrays read-only; needed again after unpickling, which drops the flag."""
        for array in (
            self.forward,
            self.backward,
            self.variance_forward,
            self.variance_backward,
            self.cycles,
        ):
            if array is not None:
                array.setflags(write=False)

    @property
    def squares(self) -> Real:
        """
        The sum |forward|^2 + |backward|^2 [m^2], (ny, nx // 2 + 1): half the a^2/2 of an entry's
        two waves, +k and -k together.
        """
        total: Real = np.abs(self.forward) ** 2 + np.abs(self.backward) ** 2
        return total

    @property
    def omega(self) -> Real:
        """
        The frequencies of the dispersion relation, before any loop [rad/s]; computed on demand.
        """
        return dispersion.angular_frequency(self.grid.k, self.depth, self.surface_tension)

    @property
    def running_omega(self) -> Real:
        """The frequencies of the waves as they run: omega, or 2 pi cycles / loop  [rad/s]."""
        if self.cycles is None:
            return self.omega
        assert self.loop is not None  # cycles are those of a loop
        return self.cycles * (2.0 * np.pi / self.loop)

    @property
    def variance(self) -> float:
        """m0 of the tile, averaged over seeds: the sum of E_k [m^2]."""
        half = float(np.sum(self.variance_forward))
        # the column mx = 0 holds both k and -k
        return half + float(np.sum(self.variance_backward[:, 1:]))

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
    sea: Sea,
    grid: Grid,
    *,
    seed: int = 0,
    loop: float | None = None,
    draw: Draw = "gaussian",
    band: Band = WHOLE,
    parts: Sequence[Part] | None = None,
) -> Amplitudes:
    """
    Realise a sea on a grid:  h0 = 1/2 (xi_r + i xi_i) sqrt(E_k).

    Args:
        sea: the sea to realise.
        grid: the tile.
        seed: random seed; each seed is another realisation of the sea.
        loop: period after which the tile repeats [s].
        draw: "gaussian" for unit normals xi, as in a real sea, whose wave heights vary from seed to
            seed; "fixed" for random phases alone, |h0| = sqrt(E_k/2), so that the sum of a^2/2 over
            the waves is the same for every seed.
        band: the wavenumbers to hold. A wave whose cell lies within is the same to the bit whatever
            the band; one whose cell is cut by an edge keeps its phase, and carries the energy of
            its part (see `share_below`).
        parts: the `cells.parts_of_sea`, to share them among tiles.

    Raises:
        ParameterError: a value out of range, a sea whose density is not finite and >= 0, or waves
            that do not hold the variance that the sea has at their wavenumbers.

    Source: Tessendorf 2001, with a factor such that E[a^2/2] = 2 E|h0|^2 = E_k.
    """
    seed = SEED.check("seed", seed)
    if draw not in ("gaussian", "fixed"):
        raise ParameterError(f"amplitudes must be 'gaussian' or 'fixed', got {draw!r}")

    cells = Cells(sea, grid.dkx, grid.dky, parts)
    forward, backward = (np.zeros(grid.half_shape, np.complex128, order="F") for _ in range(2))
    variance_forward, variance_backward = np.zeros(grid.half_shape), np.zeros(grid.half_shape)
    reach_x, reach_y = grid.reach
    # columns: what is made on the way is several times as much as what is kept
    at_a_time = max(1, _BLOCK // (reach_y + 1))
    for first in range(0, reach_x + 1, at_a_time):
        ax, ay = (
            a.ravel()
            for a in np.meshgrid(
                grid.mx[first : min(first + at_a_time, reach_x + 1)], np.arange(reach_y + 1)
            )
        )
        nearest, farthest = cells.distances(ax, ay)
        touched = (farthest > band[0]) & (nearest < band[1]) & ((ax > 0) | (ay > 0))
        ax, ay = ax[touched], ay[touched]
        variances = cells.variances(ax, ay)
        if band != WHOLE:
            waves = [
                np.concatenate([s * a for s in signs])
                for signs, a in zip(zip(*QUADRANTS, strict=True), (ax, ay), strict=True)
            ]
            low, high = (cells.share_below(edge, *waves) for edge in band)
            variances *= np.maximum(high - low, 0.0).reshape(variances.shape)
        for (sx, sy), variance in zip(QUADRANTS, variances, strict=True):
            mx, my = sx * ax, sy * ay
            random = (
                noise.complex_normals(seed, mx, my)
                if draw == "gaussian"
                else np.sqrt(2.0) * noise.unit_phasors(seed, mx, my)
            )
            h0 = 0.5 * np.sqrt(variance) * random
            if sx > 0:
                variance_forward[my, mx], forward[my, mx] = variance, h0
            else:
                variance_backward[-my, -mx], backward[-my, -mx] = variance, np.conj(h0)
    made = Amplitudes(
        grid,
        sea.depth,
        sea.surface_tension,
        loop,
        forward,
        backward,
        variance_forward,
        variance_backward,
        draw,
        band,
    )
    cells.require_energy(made.variance, grid, band)
    return made


def place_modes(
    waves: Iterable[tuple[int, int, float, float]],
    grid: Grid,
    *,
    depth: float,
    surface_tension: float = 0.0,
    loop: float | None = None,
) -> Amplitudes:
    """
    Return the sea of given waves (mx, my, amplitude [m], phase [rad]): height = sum a cos(k.x -
    omega t - phase).

    Waves on the same (mx, my) add up.

    Raises:
        ParameterError: a wave the grid cannot hold (k = 0, or at or beyond the Nyquist index), or a
            value out of range.
    """
    DEPTH.check("depth", depth)
    reach_x, reach_y = grid.reach
    forward, backward = (np.zeros(grid.half_shape, np.complex128, order="F") for _ in range(2))
    for wave in waves:
        try:
            mx, my, amplitude, phase = wave
        except (TypeError, ValueError) as error:
            raise ParameterError(
                f"a wave must be (mx, my, amplitude, phase), got {wave!r}"
            ) from error
        if not (
            mx == int(mx)
            and my == int(my)
            and (mx or my)
            and abs(mx) <= reach_x
            and abs(my) <= reach_y
        ):
            raise ParameterError(
                f"a wave on this grid must have whole |mx| <= {reach_x} and |my| <= {reach_y}, "
                f"not both 0, got ({mx}, {my})"
            )
        mx, my = int(mx), int(my)
        h0 = 0.5 * LENGTH.check("amplitude", amplitude) * np.exp(-1j * ANGLE.check("phase", phase))
        if mx >= 0:
            forward[my, mx] += h0
        if mx <= 0:
            backward[-my, -mx] += np.conj(h0)
    energy, energy_opposite = 2.0 * np.abs(forward) ** 2, 2.0 * np.abs(backward) ** 2
    return Amplitudes(
        grid, depth, surface_tension, loop, forward, backward, energy, energy_opposite, "given"
    )


def with_cycles(amplitudes: Amplitudes, cycles: Integer) -> Amplitudes:
    """
    Return the same waves with stored cycles in a loop, instead of those that this machine rounds.

    Args:
        amplitudes: waves that loop.
        cycles: whole cycles of each entry, (ny, nx // 2 + 1).
    """
    same = replace(amplitudes)
    object.__setattr__(same, "cycles", cycles)
    same.freeze()
    return same


def cell_variance(sea: Sea, mx: Integer, my: Integer, dkx: float, dky: float) -> Real:
    """
    Return E_k, the sea's variance in the cells around the wavenumbers (mx dkx, my dky).

    E_k = integral over the cell of S(omega) D(omega, theta) (d omega/dk)/k dkx dky; see `cells`.

    Args:
        sea: the sea.
        mx, my: integer wavenumbers, (m,), never both 0.
        dkx, dky: cell sizes [rad/m].

    Returns:
        (m,) [m^2].

    Raises:
        ParameterError: the sea's density is negative or not finite somewhere.
    """
    quadrant = np.where(mx >= 0, np.where(my >= 0, 0, 1), np.where(my >= 0, 3, 2))
    variance: Real = Cells(sea, dkx, dky).variances(np.abs(mx), np.abs(my))[
        quadrant, np.arange(mx.size)
    ]
    return variance


def share_below(edge: float, sea: Sea, mx: Integer, my: Integer, dkx: float, dky: float) -> Real:
    """
    Return the share of the variance in the cells around (mx dkx, my dky) that lies below |k| =
    edge; see `Cells.share_below`.
    """
    return Cells(sea, dkx, dky).share_below(edge, mx, my)


def refined(
    amplitudes: Amplitudes,
    fine: Grid,
    kept: npt.NDArray[np.bool_],
    response: Callable[[Real], Real],
) -> Amplitudes:
    """
    Return waves on a finer grid of the same tile, divided by the response of a spline.

    Args:
        amplitudes: the waves.
        fine: the finer grid.
        kept: the waves to keep, (ny, nx // 2 + 1).
        response: of the spline along one axis to a wave, by its cycles per fine sample.
    """
    grid = amplitudes.grid
    rows, columns = np.nonzero(kept)
    fine_rows = grid.my[rows]  # negative ones count from the end there, too
    divisor = response(grid.mx[columns] / fine.nx) * response(grid.my[rows] / fine.ny)

    def spread(values: npt.NDArray[Any], by: Real) -> npt.NDArray[Any]:
        wide = np.zeros(fine.half_shape, dtype=values.dtype, order="F")
        wide[fine_rows, columns] = values[rows, columns] / by
        return wide

    return replace(
        amplitudes,
        grid=fine,
        forward=spread(amplitudes.forward, divisor),
        backward=spread(amplitudes.backward, divisor),
        variance_forward=spread(amplitudes.variance_forward, divisor**2),
        variance_backward=spread(amplitudes.variance_backward, divisor**2),
    )


def refined_gain(
    grid: Grid, fine: Grid, kept: npt.NDArray[np.bool_], response: Callable[[Real], Real]
) -> Real:
    """
    Return the factor that `refined` gives to each cell of the finer grid, (ny, nx // 2 + 1).
    """
    rows, columns = np.nonzero(kept)
    gain = np.zeros(fine.half_shape)
    gain[grid.my[rows], columns] = 1.0 / (
        response(grid.mx[columns] / fine.nx) * response(grid.my[rows] / fine.ny)
    )
    return gain
