"""
Whole planes of wavenumbers, as a program that evolves the waves has them in memory.

Entry [iy, ix] of a plane has the integer wavenumbers mx = ix up to nx/2, and ix - nx beyond; my
likewise. An `Amplitudes` holds the half plane mx >= 0 of both h0(k) and h0(-k).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Integer, Real
from fftocean.errors import ParameterError
from fftocean.fields import potential_factor
from fftocean.grid import Grid
from fftocean.ocean import Ocean

Plane = npt.NDArray[np.complex64]


@dataclass(frozen=True, slots=True, eq=False)
class Planes:
    """The waves of a tile in the precision of a package."""

    h0: Plane  # (ny, nx): h0(k) [m]; 0 where there is no wave
    cycles: Integer  # (ny, nx): whole cycles in a loop, of every entry

    @property
    def most_cycles(self) -> int:
        """Cycles of the fastest wave; 0 without waves."""
        return int(np.max(self.cycles, where=self.h0 != 0.0, initial=0))


def planes_of(amplitudes: Amplitudes, name: str = "the tile") -> Planes:
    """
    Return the whole planes of a tile's waves, in single precision.

    Raises:
        ParameterError: the tile does not loop, a wave at k = 0 or on the Nyquist row or column,
            or one too large for single precision.
    """
    grid, cycles = amplitudes.grid, amplitudes.cycles
    if cycles is None:
        raise ParameterError(
            f"waves must repeat to be written as planes, and those of {name} do not: "
            "give the ocean a loop, such as loop=64.0"
        )
    with np.errstate(over="ignore"):
        forward = np.ascontiguousarray(amplitudes.forward, dtype=np.complex64)
        backward = np.ascontiguousarray(amplitudes.backward, dtype=np.complex64)
    held = ~grid.active
    if np.any(forward[held]) or np.any(backward[held]):
        raise ParameterError(
            f"k = 0 and the Nyquist row and column must have no waves, and those of {name} have"
        )
    if not (np.all(np.isfinite(forward)) and np.all(np.isfinite(backward))):
        raise ParameterError(f"waves must be finite in single precision, and those of {name} not")
    return Planes(_whole(grid, forward, np.conj(backward)), _whole(grid, cycles, cycles))


def _whole(grid: Grid, ahead: npt.NDArray[Any], behind: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the plane whose entries at k are `ahead`, and at -k are `behind`, for mx >= 0."""
    whole = np.zeros(grid.shape, ahead.dtype)
    columns = grid.nx // 2 + 1
    whole[:, :columns] = ahead
    opposite = -np.arange(grid.ny) % grid.ny
    whole[:, columns:] = behind[opposite, 1 : grid.nx - columns + 1][:, ::-1]
    return whole


def half_of(grid: Grid, whole: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Return the entries of a plane at k and at -k, on the half plane mx >= 0."""
    columns = np.arange(grid.nx // 2 + 1)
    opposite = -np.arange(grid.ny) % grid.ny
    return whole[:, : columns.size], whole[opposite[:, None], -columns % grid.nx]


def amplitude_planes(ocean: Ocean) -> tuple[Real, Real]:
    """
    Return the waves of an ocean as two textures.

    Returns:
        h0: (ny, nx, 4) float32: h0(k) and conj(h0(-k)), real and imaginary parts [m].
        wave: (ny, nx, 2) float32: cycles in a loop, 0 where neither k nor -k has a wave; and
            1/(k tanh(k depth)) [m], 0 at k = 0.

    Raises:
        ParameterError: as `planes_of`.
    """
    a = ocean.amplitudes
    return textures_of(planes_of(a), a.grid, a.depth)


def textures_of(planes: Planes, grid: Grid, depth: float) -> tuple[Real, Real]:
    """Return the two textures of a tile; see `amplitude_planes`."""
    back_y, back_x = (-np.arange(n) % n for n in grid.shape)
    opposite = np.conj(planes.h0[back_y[:, None], back_x])
    h0 = np.stack(
        [planes.h0.real, planes.h0.imag, opposite.real, opposite.imag], axis=-1, dtype=np.float32
    )
    h0 += np.float32(0.0)  # no zero with a minus sign, which the conjugate of an absent wave has
    some = (planes.h0 != 0.0) | (opposite != 0.0)
    factor = potential_factor(grid.k, depth)
    wave = np.stack(
        [np.where(some, planes.cycles, 0), _whole(grid, factor, factor)],
        axis=-1,
        dtype=np.float32,
        casting="same_kind",
    )
    return h0, wave


def waves_from_planes(
    h0: Plane,
    grid: Grid,
    *,
    loop: float,
    depth: float,
    surface_tension: float = 0.0,
    band: tuple[float, float] = (0.0, float("inf")),
) -> Amplitudes:
    """
    Return the waves of a plane of h0(k), (ny, nx) [m].

    Their cycles follow from the dispersion relation.
    """
    ahead, behind = half_of(grid, np.asarray(h0, dtype=np.complex128))
    forward, backward = (np.array(part, order="F") for part in (ahead, np.conj(behind)))
    for part in (forward, backward):
        part[~grid.active] = 0.0
    energy, opposite = 2.0 * np.abs(forward) ** 2, 2.0 * np.abs(backward) ** 2
    return Amplitudes(
        grid, depth, surface_tension, loop, forward, backward, energy, opposite, "given", band
    )
