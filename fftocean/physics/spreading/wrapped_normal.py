"""Wrapped normal spreading."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.limits import Quantity, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped

SPREAD = Quantity("degrees", 0.1, 180.0)


@dataclass(frozen=True, slots=True)
class WrappedNormal:
    """
    A normal distribution wound round the compass: the sum of exp(-(theta + 2 pi j)^2 / (2 sigma^2))
    over the turns j.

    Its circular spread (Kuik et al. 1988), which `moments.mean_direction_and_spread` measures, is
    sqrt(2 (1 - exp(-sigma^2/2))): a little less than sigma. Source: Mardia, Statistics of
    Directional Data (1972); Briggs et al. 1995 for waves.

    Args:
        spread: sigma, the standard deviation before winding [degrees].

    Raises:
        ParameterError: a spread out of its range.
    """

    spread: float

    def __post_init__(self) -> None:
        keep_checked(self, spread=SPREAD)

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `theta`, [1/rad]."""
        _, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        sigma = math.radians(self.spread)
        # what is left out lies beyond 8.5 sigma: under 1e-16
        turns = math.ceil((8.5 * sigma + np.pi) / (2.0 * np.pi) - 0.5)
        total = np.zeros_like(theta)
        for j in range(-turns, turns + 1):
            total += np.exp(-0.5 * np.square((theta + 2.0 * np.pi * j) / sigma))
        return total / (sigma * math.sqrt(2.0 * np.pi))


SPREADINGS.add("wrapped-normal", WrappedNormal, Way(WrappedNormal, spread=SPREAD))
