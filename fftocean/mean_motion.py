"""Mean level of a choppy surface, and mean drift of the water, of second order in the steepness."""

import math

import numpy as np

from fftocean.arrays import Real
from fftocean.fields import potential_factor
from fftocean.wave_list import WaveList

_BLOCK = 2**20  # waves times levels at a time


def set_down(waves: WaveList) -> float:
    """
    Return the mean height of the displaced surface over places in the world [m].

    Horizontal displacement brings water together at crests and apart in troughs, where there is
    then more of the surface. With the height h and the displacement D, both by rest position, the
    mean over the world is that of h (1 + div D): with the phases of the waves independent, or in
    the mean over time,

        -1/2 sum of a^2 k c / tanh kh,     c being the choppiness,

    which is at most 0. Heights above the still-water level are h minus this mean.

    Pinned by tests/test_query.py, against quadrature of the direct sum.
    """
    k2 = waves.kx**2 + waves.ky**2
    return -0.5 * waves.choppiness * float(np.sum(waves.amplitude * waves.potential * k2))


def stokes_drift(waves: WaveList, z: Real) -> Real:
    """
    Return the Stokes drift along x and y at levels z, (levels, 2) [m/s].

    Each wave carries the water along its own direction by a^2 omega k cosh 2k(z + h) /
    (2 sinh^2 kh), in deep water a^2 omega k e^{2kz}.

    Args:
        waves: the waves.
        z: levels, (levels,) [m]; above 0 the drift is that at 0, below the bed it is 0, and where z
            is not a number it is NaN.
    """
    out = np.empty((z.size, 2))
    k = np.hypot(waves.kx, waves.ky)
    strength = waves.amplitude**2 * waves.omega * np.stack([waves.kx, waves.ky])
    block = max(1, _BLOCK // max(1, k.size))  # levels at a time
    for first in range(0, z.size, block):
        part = slice(first, first + block)
        out[part] = _drift_profile(k, np.minimum(z[part], 0.0), waves.depth) @ strength.T
    out[z < -waves.depth] = 0.0
    out[np.isnan(z)] = np.nan
    return out


def missing_drift(waves: WaveList) -> Real:
    """
    Return the velocity to add to that of the queried surface, for tracers to drift as Stokes'
    particles at z = 0 do, (2,) [m/s].

    The water of a query at the place x is that of the rest position x - c D, with the velocity u
    of the linear waves. A tracer swings by xi, the integral of u over time, and meets the mean of
    ((xi - c D) . grad) u: with each wave's velocity u and displacement d = c k potential that is
    (u/omega - d) u k/2. At choppiness 1 tracers stay with their particle, which comes back, and all
    of the Stokes drift is missing; at 0 half of it in deep water, that of the vertical motion.
    """
    k = np.hypot(waves.kx, waves.ky)
    along = waves.amplitude * k * potential_factor(k, waves.depth)  # u/omega [m]
    there = 0.5 * waves.omega * along * (along - waves.choppiness * k * waves.potential)
    met: Real = np.array([np.sum(there * waves.kx), np.sum(there * waves.ky)])
    missing: Real = stokes_drift(waves, np.zeros(1))[0] - met
    return missing


def _drift_profile(k: Real, z: Real, depth: float) -> Real:
    """
    Return cosh 2k(z + h) / (2 sinh^2 kh) for levels and waves, (levels, waves), z <= 0 [-].

    It is written with exponents that are never positive, so that nothing overflows.
    """
    z = np.maximum(z, -depth)[:, None]
    down: Real = np.exp(2.0 * k * z)
    if math.isinf(depth):
        return down
    up = np.exp(-2.0 * k * (z + 2.0 * depth))
    profile: Real = (down + up) / np.expm1(-2.0 * k * depth) ** 2
    return profile
