"""Frequencies at which a sea is drawn."""

import numpy as np

from fftocean.arrays import Real
from fftocean.physics import moments
from fftocean.physics.sea import Sea

NEGLIGIBLE = 1e-24
"""The variance [m^2] below which a sea counts as flat: waves of a picometre."""


def is_flat(sea: Sea) -> bool:
    """Return whether the variance of a sea is negligible."""
    omega = _spectral_grid(sea)
    return float(np.trapezoid(sea(omega), omega)) < NEGLIGIBLE


def energetic_band(sea: Sea, faintest: float = 5e-3) -> tuple[float, float]:
    """
    Return the frequencies between which some system's spectrum exceeds `faintest` of its maximum.

    Both are widened by a margin [rad/s].
    """
    omega = _spectral_grid(sea)
    ends = []
    for system in sea.systems:
        s = system.spectrum(omega)
        if (top := float(np.max(s))) > 0.0:
            ends += [float(omega[i]) for i in np.flatnonzero(s >= faintest * top)[[0, -1]]]
    return 0.8 * min(ends), 1.08 * max(ends)


def drawn_frequencies(sea: Sea, low: float, high: float) -> Real:
    """
    Return frequencies at which to draw a sea [rad/s].

    They are evenly spaced, denser around each peak, and include every corner of the spectra.
    """
    omega = np.union1d(np.linspace(low, high, 600), _spectral_grid(sea))
    within: Real = omega[(omega >= low) & (omega <= high)]
    return within


def _spectral_grid(sea: Sea) -> Real:
    """Return frequencies dense enough to integrate a sea's spectrum [rad/s]."""
    return moments.spectral_grid([s.spectrum.peak for s in sea.systems], sea.breaks)
