"""Directional spectrum of a sea in cells of frequency and direction."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fftocean.arrays import Real
from fftocean.cells import Part, parts_of_sea
from fftocean.physics.panels import gauss, split
from fftocean.physics.sea import Sea

_MIDPOINTS = 3  # in frequency, of each cell


class PolarSpectrum(NamedTuple):
    """Variance density in cells of frequency and direction."""

    frequency: Real  # edges of the cells, (rings + 1,) [Hz]
    theta: Real  # edges of the cells, (sectors + 1,), counter-clockwise from +x [rad]
    density: Real  # (rings, sectors) [m^2/Hz/degree]


def polar_spectrum(
    sea: Sea,
    highest: float,
    rings: int = 160,
    sectors: int = 240,
    parts: Sequence[Part] | None = None,
) -> PolarSpectrum:
    """
    Average a sea's spectrum over cells of frequency and direction.

    Spreading is integrated over each cell, so that a swell narrower than a cell keeps its energy.

    Args:
        sea: the specified sea.
        highest: the frequency at the outer edge [Hz].
        rings, sectors: the number of cells in frequency and in direction.
        parts: the `cells.parts_of_sea`, if they are known.

    Pinned by tests/test_polar_spectrum.py, against the integral of S.
    """
    frequency = np.linspace(0.0, highest, rings + 1)
    theta = np.linspace(0.0, 2.0 * math.pi, sectors + 1)
    count = rings * _MIDPOINTS
    omega = (np.arange(count) + 0.5) * (2.0 * math.pi * highest / count)
    density = np.zeros((count, sectors))
    for part in parts_of_sea(sea) if parts is None else parts:
        spectrum = part.share * part.system.spectrum(omega)
        if part.long_crested:
            density[:, int(part.direction / (2.0 * math.pi) * sectors) % sectors] += spectrum
            continue
        sector, low, high = split(theta[:-1], theta[1:], part.theta)
        around, weight = gauss(low, high, 4)
        from_mean = around.ravel() - part.direction
        spread = part.system.spreading(omega[:, None], from_mean, part.system.spectrum.peak)
        spread = (spread * weight.ravel()).reshape(count, *weight.shape)
        pieces = spectrum[:, None] * np.sum(spread, axis=2)
        density += np.add.reduceat(pieces, np.searchsorted(sector, np.arange(sectors)), axis=1)
    # per rad/s and cell to per Hz and degree
    density *= 2.0 * math.pi * math.pi / 180.0 / (2.0 * math.pi / sectors)
    return PolarSpectrum(frequency, theta, density.reshape(rings, _MIDPOINTS, sectors).mean(axis=1))
