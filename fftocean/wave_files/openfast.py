"""
Waves as the input files of OpenFAST's module SeaState.

Formats: "Input Files" of the SeaState pages in OpenFAST's documentation (openfast.readthedocs.io),
WaveMod 6, full kinematics at the points of the wave grid, and WaveMod 7, wave components.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fftocean.arrays import Complex, Real
from fftocean.cascade import Cascade
from fftocean.constants import WATER_DENSITY
from fftocean.errors import ParameterError, described
from fftocean.files import path_of, write_parts
from fftocean.limits import LARGEST_FINITE, LOOP, SMALLEST_POSITIVE, Count, Quantity
from fftocean.ocean import Ocean
from fftocean.wave_list import WaveList, list_waves, require_linear

_WIDTH = Quantity("m", SMALLEST_POSITIVE, LARGEST_FINITE)
_POINTS = Count("", 2, 1000)
_STEP = Quantity("s", SMALLEST_POSITIVE, LARGEST_FINITE)
_MOST_NUMBERS = 2**32
"""Numbers in all files together, at most: 60 GB."""
VOLUME_FILES = (".Vxi", ".Vyi", ".Vzi", ".Axi", ".Ayi", ".Azi", ".DynP")
"""Velocity, acceleration and dynamic pressure; the heights are in .Elev."""
_ROWS, _COLUMNS = 256, 64  # times and points at a time


@dataclass(frozen=True, slots=True)
class SeaStateGrid:
    """
    The wave grid of SeaState, centred at the origin, from the still-water level down.

    `nx` and `ny` count the points from the origin to the edge, with both: 2 nx - 1 in all. The
    levels are z = z_depth (cos(n pi / (2 (nz - 1))) - 1), n = 0 .. nz - 1.

    Args:
        x_half_width, y_half_width: X_HalfWidth and Y_HalfWidth [m].
        z_depth: Z_Depth [m].
        nx, ny, nz: NX, NY and NZ.

    Raises:
        ParameterError: a width that is not above 0, or fewer than two points.
    """

    x_half_width: float
    y_half_width: float
    z_depth: float
    nx: int
    ny: int
    nz: int

    def __post_init__(self) -> None:
        for name in ("x_half_width", "y_half_width", "z_depth"):
            object.__setattr__(self, name, _WIDTH.check(name, getattr(self, name)))
        for name in ("nx", "ny", "nz"):
            object.__setattr__(self, name, _POINTS.check(name, getattr(self, name)))

    @property
    def x(self) -> Real:
        """Positions along x [m], (2 nx - 1,)."""
        return _symmetric(self.x_half_width, self.nx)

    @property
    def y(self) -> Real:
        """Positions along y [m], (2 ny - 1,)."""
        return _symmetric(self.y_half_width, self.ny)

    @property
    def z(self) -> Real:
        """Levels from the lowest, -z_depth, to 0 [m], (nz,)."""
        angle = np.arange(self.nz - 1, -1, -1) * (0.5 * np.pi / (self.nz - 1))
        levels: Real = self.z_depth * (np.cos(angle) - 1.0)
        return levels


def _symmetric(half_width: float, n: int) -> Real:
    """Return 2 n - 1 positions from -half_width to half_width, 0 in their middle."""
    positions: Real = np.arange(1 - n, n) * (half_width / (n - 1))
    return positions


def openfast(
    source: Ocean | Cascade | Any,
    grid: SeaStateGrid | None,
    path: str | Path,
    *,
    tmax: float | None = None,
    dt: float | None = None,
    wave_mod: int = 6,
) -> dict[str, str]:
    """
    Write waves as input files of OpenFAST's module SeaState.

    WaveMod 6: velocities [m/s], accelerations [m/s^2], dynamic pressure [Pa] and height [m], by
    linear theory below z = 0, at the points of the wave grid: eight files `path` + ".Vxi", ...,
    ".DynP", ".Elev" without heads. Rows are times from 0 in steps of `dt`, tmax / dt of them;
    columns are points, x fastest, then y, then z, from the lowest corner. WvKinFile is `path`.

    WaveMod 7: the waves themselves, `path` + ".Comp": angular frequency [rad/s], height from trough
    to crest [m], heading [degrees], phase [degrees]. SeaState takes one heading a frequency,
    multiples of 2 pi / WaveTMax, and computes the wavenumbers itself: a sea of one direction on a
    loop, and WaveTMax = the loop.

    Args:
        source: an `Ocean` or a `Cascade`; for WaveMod 7 an `Ocean` that loops.
        grid: the wave grid as SeaState's input file has it; None with WaveMod 7.
        path: root name of the files, without an extension.
        tmax: WaveTMax [s]; None for the loop of the ocean.
        dt: WaveDT [s], which is the time step of OpenFAST; tmax must be a whole multiple.
        wave_mod: 6 or 7.

    Returns:
        The SHA-256 of each file, by its name.

    Raises:
        ParameterError: a value out of range; a grid deeper than the water; for WaveMod 7 a sea
            without a loop, or two waves of one frequency.
        OutputError: a file could not be written.

    Pinned by tests/wave_files/test_openfast.py against `fftocean.kinematics`, which shares no code
    with this.
    """
    root = path_of("path", path)
    require_linear(source, "an OpenFAST file")
    if wave_mod == 7:
        if grid is not None or dt is not None or tmax is not None:
            raise ParameterError(
                "WaveMod 7 takes neither grid, tmax nor dt: WaveTMax is the ocean's loop"
            )
        name = f"{root.name}.Comp"
        return {name: write_parts(root.with_name(name), [_components(source)])}
    if wave_mod != 6 or isinstance(wave_mod, bool):
        raise ParameterError(f"wave_mod must be 6 or 7, got {wave_mod!r:.40}")
    if not isinstance(source, Ocean | Cascade):
        raise ParameterError(f"source must be an Ocean or a Cascade, got {described(source)}")
    if not isinstance(grid, SeaStateGrid):
        raise ParameterError(f"grid must be a SeaStateGrid, got {described(grid)}")
    waves = list_waves(source)
    if grid.z_depth > waves.depth:
        raise ParameterError(
            f"z_depth must be at most the depth of the water, {waves.depth:g} m, got "
            f"{grid.z_depth:g} m"
        )
    times = _times(waves, tmax, dt)
    x, y, z = grid.x, grid.y, grid.z
    columns = x.size * y.size * (len(VOLUME_FILES) * z.size + 1)
    if columns * times.size > _MOST_NUMBERS:
        raise ParameterError(
            f"files of OpenFAST must have at most {_MOST_NUMBERS} numbers together, and "
            f"{times.size} times at {x.size} x {y.size} x {z.size} points have "
            f"{columns * times.size}"
        )
    plane = np.stack(np.meshgrid(x, y, indexing="xy"), axis=-1).reshape(-1, 2)
    written = {}
    for quantity in (*VOLUME_FILES, ".Elev"):
        name = root.name + quantity
        levels = np.zeros(1) if quantity == ".Elev" else z
        rows = _rows(_factors(waves, quantity, plane, levels), waves, times)
        written[name] = write_parts(root.with_name(name), rows)
    return written


def _times(waves: WaveList, tmax: float | None, dt: float | None) -> Real:
    """Return the times of the rows [s]."""
    loops = set(waves.loops)
    if tmax is None:
        if None in loops or len(loops) != 1:
            raise ParameterError("tmax must be given where the sea has no common loop")
        (tmax,) = loops
    tmax = LOOP.check("tmax", tmax)
    if dt is None:
        raise ParameterError("dt must be given: WaveDT, the time step of OpenFAST [s]")
    dt = _STEP.check("dt", dt)
    count = round(tmax / dt)
    if count < 1 or abs(count * dt - tmax) > 1e-6 * dt:
        raise ParameterError(
            f"tmax must be a whole multiple of dt, got {tmax:g} s and {dt:g} s; "
            f"{max(count, 1) * dt:g} s is the nearest"
        )
    times: Real = np.arange(count) * dt
    return times


def _factors(waves: WaveList, quantity: str, plane: Real, levels: Real) -> Iterator[Complex]:
    """
    Yield (waves, points) for some points at a time: the quantity is the real part of the sum over
    the waves of that times e^{-i (omega t + phase)}.

    Source: Dean & Dalrymple, Water Wave Mechanics (1991), ch. 3.
    """
    k = np.hypot(waves.kx, waves.ky)
    omega, a = waves.omega, waves.amplitude
    along = {"x": waves.kx / k, "y": waves.ky / k}
    for z in levels:
        bed = np.exp(-2.0 * k * (z + waves.depth)) if math.isfinite(waves.depth) else 0.0
        whole = -np.expm1(-2.0 * k * waves.depth) if math.isfinite(waves.depth) else 1.0
        cosh = np.exp(k * z) * (1.0 + bed) / whole  # cosh k(z + h) / sinh kh
        sinh = np.exp(k * z) * (1.0 - bed) / whole
        factor = {
            "Vxi": a * omega * cosh * along["x"],
            "Vyi": a * omega * cosh * along["y"],
            "Vzi": -1j * a * omega * sinh,
            "Axi": -1j * a * omega**2 * cosh * along["x"],
            "Ayi": -1j * a * omega**2 * cosh * along["y"],
            "Azi": -a * omega**2 * sinh,
            "DynP": WATER_DENSITY * a * omega**2 / k * cosh,
            "Elev": a,
        }[quantity[1:]]
        for start in range(0, len(plane), _COLUMNS):
            x, y = plane[start : start + _COLUMNS].T
            yield factor[:, None] * np.exp(1j * (np.outer(waves.kx, x) + np.outer(waves.ky, y)))


def _rows(factors: Iterator[Complex], waves: WaveList, times: Real) -> Iterator[bytes]:
    """Yield the text of some rows at a time: the sum over the waves, at each time and point."""
    blocks = list(factors)
    for start in range(0, times.size, _ROWS):
        moments = times[start : start + _ROWS]
        turning = np.exp(-1j * np.stack([waves.phases(float(t)) for t in moments]))
        # the real part of a complex product, as two real ones
        values = np.concatenate(
            [turning.real @ block.real - turning.imag @ block.imag for block in blocks], axis=1
        )
        lines = (" ".join(f"{v:.7e}" for v in row) for row in values.tolist())
        yield ("\n".join(lines) + "\n").encode()


def _components(source: Any) -> bytes:
    """Return the text of a .Comp file."""
    if not isinstance(source, Ocean) or source.loop is None:
        raise ParameterError(
            "WaveMod 7 needs an Ocean that loops: its frequencies must be multiples of "
            f"2 pi / WaveTMax; got {described(source)}"
            + (" without a loop" if isinstance(source, Ocean) else "")
        )
    waves = list_waves(source)
    cycles = np.rint(waves.omega * (source.loop / (2.0 * np.pi))).astype(np.int64)
    found, first, count = np.unique(cycles, return_index=True, return_counts=True)
    if np.any(count > 1):
        shared = int(found[np.argmax(count > 1)])
        here = cycles == shared
        headings = np.rad2deg(np.arctan2(waves.ky[here], waves.kx[here]))
        raise ParameterError(
            "WaveMod 7 takes one wave a frequency, and "
            f"{int(np.count_nonzero(here))} waves have {shared} cycles in the loop, heading "
            f"{', '.join(f'{h:.1f}' for h in headings[:3])} degrees: use WaveMod 6, or one "
            "direction (fo.LongCrested) and a longer loop"
        )
    lines = [
        "! waves of a sea: omega [rad/s], height [m], heading [degrees], phase [degrees]",
        f"! WaveTMax {source.loop!r} s",
    ]
    for i in first:
        phase = math.remainder(math.degrees(waves.phase[i]), 360.0)
        heading = math.degrees(math.atan2(waves.ky[i], waves.kx[i]))
        omega = 2.0 * math.pi * int(cycles[i]) / source.loop
        lines.append(f"{omega:.12e} {2.0 * waves.amplitude[i]:.9e} {heading:.9e} {phase:.9e}")
    return ("\n".join(lines) + "\n").encode()
