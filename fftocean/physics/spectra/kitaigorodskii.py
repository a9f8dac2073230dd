"""Kitaigorodskii factor, the ratio of a spectrum in finite depth to that in deep water."""

import math

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.dispersion import group_to_phase_speed, wavenumber


def kitaigorodskii(omega: RealLike, depth: float) -> Real:
    """
    Return Phi(omega, h) [-], from omega^2 h / (2g) in shallow water to 1 in deep  (Kitaigorodskii
    et al. 1975).
    """
    # deep in a micrometre; and inf is not a frequency
    omega = np.clip(np.asarray(omega, dtype=np.float64), 0.0, 1e20)
    return kitaigorodskii_at(wavenumber(omega, depth), depth)


def kitaigorodskii_at(k: Real, depth: float) -> Real:
    """Return Phi [-] at wavenumbers [rad/m]."""
    if math.isinf(depth):
        return np.ones_like(k)
    phi: Real = np.tanh(np.minimum(k, 20.0 / depth) * depth) ** 2 / (
        2.0 * group_to_phase_speed(k, depth)
    )
    return phi
