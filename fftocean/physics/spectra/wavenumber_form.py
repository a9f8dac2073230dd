"""Conversion of spectra that are written in wavenumber."""

from collections.abc import Callable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.dispersion import group_velocity, wavenumber
from fftocean.physics.spectra.wind import STILL_AIR


def per_frequency(
    density: Callable[[Real], Real],
    omega: RealLike,
    peak: float,
    depth: float,
    surface_tension: float,
) -> Real:
    """
    Return S(omega) = F(k) dk/d omega; omega is at least a ten-thousandth of the peak, where both
    spectra of this form are 0, and at most 1e20 rad/s.
    """
    k = wavenumber(
        np.clip(np.asarray(omega, dtype=np.float64), 1e-4 * peak, 1e20), depth, surface_tension
    )
    return density(k) / group_velocity(k, depth, surface_tension)


def scale_wind(speed: float) -> float:
    """
    Return the wind [m/s] that sets the scale of a spectrum; any value will do in still air, where
    there is no energy to scale.
    """
    return speed if speed >= STILL_AIR else 1.0
