"""Dispersion relation measured in an ocean's frames."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.ocean import Ocean
from fftocean.physics import dispersion
from fftocean.realised_spectrum import mean_frequency

_PERIODS = 24.0  # mean periods in the window of an ocean without a loop
_MOST_FRAMES = 256
_MOST_WAVES = 2**15  # 128 MiB


class MeasuredDispersion(NamedTuple):
    """Energy of the height by wavenumber and frequency, computed from frames."""

    k: Real  # edges of the cells in wavenumber, (p + 1,) [rad/m]
    omega: Real  # edges of the cells in frequency, (q + 1,) [rad/s]
    energy: Real  # (q, p) [m^2]
    on_curve: float  # share of the energy within `tolerance` of omega(k) [-]
    tolerance: float  # half a step of a loop, or two steps of the window [rad/s]
    frames: int  # number of frames transformed
    k_max: float  # the largest wavenumber [rad/m]


class _Sampling(NamedTuple):
    """Times at which frames are computed."""

    frames: int
    period: float  # [s]
    is_loop: bool  # `period` is the whole loop; else a window


def measured_dispersion(ocean: Ocean) -> MeasuredDispersion:
    """
    Transform the height in space and time, without use of the dispersion relation.

    A loop that is not too long is taken whole: then each frequency of the loop is one of the
    transform, and no energy leaks. Otherwise two dozen periods are taken with a Hann window, which
    spreads each frequency over two steps to either side.

    Args:
        ocean: any ocean that is not flat.

    Returns:
        `MeasuredDispersion`; waves shorter than those which hold 97 % of the energy are left out,
        and all but the strongest 2^15.

    Pinned by tests/test_measured_dispersion.py, against the list of waves.
    """
    a, grid = ocean.amplitudes, ocean.grid
    k_max = _energetic_wavenumber(ocean)
    omega_max = float(dispersion.angular_frequency(k_max, a.depth, a.surface_tension))
    used = np.flatnonzero(
        grid.active & ((grid.mx[None, :] > 0) | (grid.my[:, None] > 0)) & (grid.k <= k_max)
    )
    used = used[np.argsort(a.squares.flat[used])[-_MOST_WAVES:]]
    k = grid.k.flat[used]
    sampling = _sampling(ocean, omega_max)
    count = sampling.frames
    series = _height_series(ocean, sampling, used)
    # (frequency, wave): waves along +k turn backward, so both signs of the frequency are kept
    energy = 2.0 * np.abs(np.fft.fft(series, axis=0) / count) ** 2
    step = 2.0 * math.pi / sampling.period
    omega = np.abs(np.fft.fftfreq(count, 1.0 / count)) * step
    expected = dispersion.angular_frequency(k, a.depth, a.surface_tension)
    # a wave half way between two frequencies of a loop has either of them
    tolerance = (0.5 + 1e-9 if sampling.is_loop else 2.0) * step
    near = np.abs(omega[:, None] - expected[None, :]) <= tolerance
    width = max(min(grid.dkx, grid.dky), k_max / 100.0)
    k_edges = width * (np.arange(math.ceil(k_max / width - 0.5) + 2) - 0.5)
    omega_edges = step * (np.arange(count // 2 + 2) - 0.5)
    cells, _, _ = np.histogram2d(
        np.repeat(omega, k.size),
        np.tile(k, count),
        bins=(omega_edges, k_edges),
        weights=energy.ravel(),
    )
    return MeasuredDispersion(
        k=k_edges,
        omega=omega_edges,
        energy=cells,
        on_curve=float(np.sum(energy[near]) / np.sum(energy)),
        tolerance=tolerance,
        frames=count,
        k_max=k_max,
    )


def _sampling(ocean: Ocean, omega_max: float) -> _Sampling:
    """Choose times that resolve frequencies up to `omega_max` [rad/s]."""
    period, is_loop = ocean.loop or 0.0, True
    if not 0.0 < period * omega_max / math.pi < _MOST_FRAMES - 4:
        period, is_loop = _PERIODS * 2.0 * math.pi / mean_frequency(ocean), False
    count = 2 * math.ceil(omega_max * period / (2.0 * math.pi)) + 4
    if count > _MOST_FRAMES:
        count, period = _MOST_FRAMES, (_MOST_FRAMES - 4) * math.pi / omega_max
    return _Sampling(count, period, is_loop)


def _height_series(
    ocean: Ocean, sampling: _Sampling, used: npt.NDArray[np.intp]
) -> npt.NDArray[np.complex128]:
    """
    Return the Fourier coefficients of the height at each time, (count, used.size) [m].

    Args:
        ocean: the ocean.
        sampling: the times.
        used: flat indices of the coefficients to keep.
    """
    count, period, is_loop = sampling
    series = np.empty((count, used.size), np.complex128)
    frame, fields = None, ("height",)
    for j in range(count):
        if is_loop:
            frame = ocean.loop_frame(j, count, fields, out=frame)
        else:
            frame = ocean.frame(j * period / count, fields, out=frame)
        series[j] = np.fft.rfft2(frame.height.astype(np.float64)).flat[used] / frame.height.size
    if not is_loop:
        window = np.sin(np.arange(count) * (math.pi / count)) ** 2
        series *= (window / math.sqrt(np.mean(window**2)))[:, None]
    return series


def _energetic_wavenumber(ocean: Ocean) -> float:
    """
    Return the wavenumber below which 97 % of the energy lies, and four cells at least [rad/m].
    """
    m = ocean.modes()
    k, energy = np.hypot(m.kx, m.ky), m.amplitude**2
    ascending = np.argsort(k)
    running = np.cumsum(energy[ascending])
    enough = float(k[ascending][np.searchsorted(running, 0.97 * running[-1])])
    return max(1.05 * enough, 4.0 * min(ocean.grid.dkx, ocean.grid.dky))
