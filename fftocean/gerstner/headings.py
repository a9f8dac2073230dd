"""Waves given by wavenumber and direction of travel."""

import math

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.gerstner.checks import as_array
from fftocean.gerstner.waves import Waves


def direction_of(dx: float, dy: float) -> float:
    """
    Return the direction of a vector of any length [degrees, counter-clockwise from +x].

    Raises:
        ParameterError: a vector without a direction.
    """
    if not (math.isfinite(dx) and math.isfinite(dy) and (dx or dy)):
        raise ParameterError(f"a direction must be a finite vector that is not 0, got ({dx}, {dy})")
    return math.degrees(math.atan2(dy, dx))


def directed_waves(
    k: Real,
    heading: RealLike,
    amplitude: RealLike,
    omega: Real,
    sharpness: RealLike,
    tau: float,
    phase: RealLike = 0.0,
) -> Waves:
    """Return waves of wavenumber k that travel toward `heading` [rad]."""
    kx, ky = k * np.cos(heading), k * np.sin(heading)
    return Waves(
        kx=kx,
        ky=ky,
        amplitude=as_array(amplitude),
        phase=as_array(phase),
        omega=omega,
        sharpness=as_array(sharpness),
        tau=tau,
    )
