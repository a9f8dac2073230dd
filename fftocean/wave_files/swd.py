"""
Waves as a file of DNV's spectral_wave_data (SWD), version 100.

Format and theory: the pages "SWD format", "Shape class 4", "5" and "6" of the documentation of
spectral_wave_data (github.com/SpectralWaveData). There, the height is the real part of a sum of
h(t) e^{-i k.x}; here, of amplitude e^{-i (k.x - omega t - phase)}: the same, with

    h = amplitude e^{i (omega t + phase)}      c = i omega h / (k tanh k depth)

for the potential at z = 0: its rate of change upward is that of the height, also where a loop has
rounded omega.
"""

import json
import math
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fftocean.amplitudes import Modes
from fftocean.arrays import Complex, Integer
from fftocean.bound_waves import ELEVATION, POTENTIAL
from fftocean.cascade import Cascade
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, described
from fftocean.fields import potential_factor
from fftocean.files import path_of, write_parts
from fftocean.limits import FRAMES, LARGEST_FINITE, SMALLEST_POSITIVE, Quantity
from fftocean.ocean import Ocean
from fftocean.wave_list import WaveList, list_waves, require_linear

MAGIC, VERSION = 37.0221, 100
AIRY, DEEP, FINITE = 6, 4, 5
"""Shape classes: a list of Airy waves; short-crested tiles in deep water and in that of a depth."""
SAME_DATE = "2000-01-01 00:00:00"
_STEP = Quantity("s", SMALLEST_POSITIVE, LARGEST_FINITE)
_MOST_BYTES = 2**36
_HEADER = struct.Struct("<fiii30s20si")


def swd(
    source: Ocean | Cascade | Modes | Any,
    path: str | Path,
    *,
    steps: int | None = None,
    dt: float | None = None,
    date: str = SAME_DATE,
    comment: str = "",
) -> str:
    """
    Write waves as a file of spectral_wave_data (SWD), which programs of ship and offshore
    engineering read.

    Without `steps` it is a list of Airy waves (shape 6, 16 bytes a wave), exact at any time; its
    readers compute omega from the dispersion relation of gravity waves. With `steps` it holds the
    amplitudes of one tile at equal steps of time (shape 4 in deep water, else 5), between which
    readers interpolate: for a loop, and for surface tension, whose omega is another. All numbers
    are float32. An ocean of order 2 has its waves of second order in the steps, elevation and
    potential, as far as the grid of the tile holds them.

    Args:
        source: an `Ocean`; a `Cascade` or `Modes` (deep water), as a list of waves alone.
        path: the file, which is replaced if it exists; complete or absent.
        steps: number of steps; None for the list of waves.
        dt: time between steps [s]; None for loop / (steps - 1), so that the last step is the first
            again.
        date: text of at most 20 characters that the file carries; always the same one, unless it
            is given, so that equal waves are equal bytes.
        comment: text that the file carries.

    Returns:
        The SHA-256 of the file.

    Raises:
        ParameterError: a source without waves, one with a loop or surface tension as a list, more
            than one tile in steps, waves that start from rest, or a value out of range.
        OutputError: the file could not be written.

    Pinned by tests/wave_files/test_swd.py: elevation, velocity, acceleration and pressure that an
    independent reader computes, against `fftocean.kinematics`.
    """
    file = path_of("path", path)
    texts = [_text(name, value) for name, value in (("date", date), ("comment", comment))]
    if steps is None:
        require_linear(source, "a list of waves in an SWD file")
    waves = list_waves(source)
    if waves.model is not None and waves.model.tau > 0.0:
        raise ParameterError(
            f"waves of an SWD file must not start from rest: tau must be 0, got {waves.model.tau}"
        )
    if steps is None:
        if dt is not None:
            raise ParameterError(f"dt goes with steps, got dt = {dt!r} and no steps")
        _require_free_waves(waves)
        return write_parts(file, _list_parts(waves, *texts))
    if not isinstance(source, Ocean):
        raise ParameterError(
            f"an SWD file in steps must be of one Ocean, got {described(source)}; without steps it "
            "is a list of waves"
        )
    steps = FRAMES.check("steps", steps)
    if dt is None:
        if source.loop is None or steps < 2:
            raise ParameterError(
                "dt must be given where an ocean does not loop or has one step: the time between "
                "steps [s]"
            )
        dt = source.loop / (steps - 1)
    dt = _STEP.check("dt", dt)
    size = 32 * steps * (source.grid.nx // 2 + 1) * (2 * (source.grid.ny // 2) + 1)
    if size > _MOST_BYTES:
        raise ParameterError(
            f"an SWD file must have at most {_MOST_BYTES} bytes, and {steps} steps of "
            f"{source.grid.nx} x {source.grid.ny} have {size}"
        )
    return write_parts(file, _step_parts(source, steps, dt, *texts))


def _text(name: str, value: Any) -> str:
    """Return a text of a header; its characters are ASCII."""
    most = 20 if name == "date" else 2**16
    if not isinstance(value, str) or not value.isascii() or "\0" in value or len(value) > most:
        raise ParameterError(
            f"{name} must be a text of at most {most} ASCII characters, got {value!r:.60}"
        )
    return value


def _require_free_waves(waves: WaveList) -> None:
    """Raise if the waves have another omega than that which readers compute from k and depth."""
    k = np.hypot(waves.kx, waves.ky)
    free = np.sqrt(GRAVITY / potential_factor(k, waves.depth))
    worst = float(np.max(np.abs(waves.omega / free - 1.0), initial=0.0))
    if worst > 1e-9:
        reason = (
            "a loop rounds it"
            if any(loop is not None for loop in waves.loops)
            else "surface tension raises it"
        )
        raise ParameterError(
            "omega of a list of waves in an SWD file must follow from gravity and depth, and is up "
            f"to {worst:.1e} off: {reason}; give steps"
        )


def _header(shape: int, date: str, comment: str, steps: int, dt: float, order: int) -> bytes:
    """Return the head that all shapes share."""
    from fftocean import __version__

    about = json.dumps({"comment": comment}).encode() + b"\0"
    program = f"fftocean {__version__}".encode()
    return (
        _HEADER.pack(MAGIC, VERSION, shape, 1, program, date.encode(), len(about))
        + about
        + struct.pack("<ffiifi", GRAVITY, 1.0, 0, steps, dt, order)
    )


def _list_parts(waves: WaveList, date: str, comment: str) -> Iterator[bytes]:
    """Yield the head and the waves of a list: amplitude, k, direction, phase of each."""
    yield _header(AIRY, date, comment, 0, -1.0, 1)
    yield struct.pack("<if", waves.kx.size, -1.0 if math.isinf(waves.depth) else waves.depth)
    columns = (
        waves.amplitude,
        np.hypot(waves.kx, waves.ky),
        np.arctan2(waves.ky, waves.kx),
        np.mod(waves.phase, 2.0 * np.pi),
    )
    yield np.stack(columns, axis=1).astype("<f4").tobytes()


def _step_parts(ocean: Ocean, steps: int, dt: float, date: str, comment: str) -> Iterator[bytes]:
    """Yield the head and, at each step, h, dh/dt, c and dc/dt on the half plane of kx >= 0."""
    grid, depth, waves = ocean.grid, ocean.depth, list_waves(ocean)
    shape = DEEP if math.isinf(depth) else FINITE
    yield _header(shape, date, comment, steps, dt, ocean.order)
    half = grid.nx // 2, grid.ny // 2
    yield struct.pack("<iiff", *half, grid.dkx, grid.dky)
    if math.isfinite(depth):
        yield struct.pack("<f", depth)
    mx = np.rint(waves.kx / grid.dkx).astype(np.int64)
    my = np.rint(waves.ky / grid.dky).astype(np.int64)
    to_potential = potential_factor(np.hypot(waves.kx, waves.ky), depth)
    for step in range(steps):
        h: Complex = waves.amplitude * np.exp(1j * waves.phases(step * dt))
        rate: Complex = 1j * waves.omega * h
        linear = (h, rate, to_potential * rate, 1j * waves.omega * to_potential * rate)
        for values, more in zip(linear, _second_order(ocean, step * dt, half), strict=True):
            yield (_half_plane(values, mx, my, half) + more).tobytes()


def _second_order(
    ocean: Ocean, t: float, half: tuple[int, int]
) -> tuple[Complex, Complex, Complex, Complex]:
    """Return h, dh/dt, c and dc/dt of the waves of second order; 0 where there are none."""
    none = np.zeros((half[0] + 1, 2 * half[1] + 1), np.complex64)
    if ocean.bound_waves is None:
        return none, none, none, none
    grid, found = ocean.grid, []
    for kind in (ELEVATION, POTENTIAL):
        kx, ky, values = ocean.bound_waves.cells(kind, t, (0, 1))
        mx = np.rint(kx / grid.dkx).astype(np.int64)
        my = np.rint(ky / grid.dky).astype(np.int64)
        found += [_half_plane(np.conj(value), mx, my, half) for value in values]
    h, h_rate, c, c_rate = found
    return h, h_rate, c, c_rate


def _half_plane(values: Complex, mx: Integer, my: Integer, half: tuple[int, int]) -> Complex:
    """
    Return values of e^{-i k.x} as an array (mx from 0, my from -half) of complex64.

    Re(v e^{-i k.x}) = Re(conj(v) e^{+i k.x}): a wave with mx < 0 is that of -k, conjugate.
    """
    out = np.zeros((half[0] + 1, 2 * half[1] + 1), complex)
    back = mx < 0
    np.add.at(
        out,
        (np.abs(mx), np.where(back, -my, my) + half[1]),
        np.where(back, np.conj(values), values),
    )
    result: Complex = out.astype("<c8")
    return result
