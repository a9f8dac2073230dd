"""Long-crested waves: a single direction."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped

LONG_CRESTED_WIDTH = math.radians(0.1)
"""
Standard deviation of the bell that stands for a single direction where a density is asked for
[rad].
"""


@dataclass(frozen=True, slots=True)
class LongCrested:
    """
    All energy in the system's own direction: crests without end, as in a wave flume.

    Tiles take the direction exactly. A tile holds discrete wavenumbers (2 pi mx/lx, 2 pi my/ly),
    and each stands for the rectangular cell around it; the ray from k = 0 along the direction runs
    through a chain of cells, and each gets the energy of the wavenumbers |k| between which the ray
    lies within it. Nothing is lost. Along an axis of the tile, or any direction whose ray meets the
    wavenumbers themselves, the waves are exactly parallel; else they lie up to half a cell beside
    the ray, and `fo.measure` says their realised spread (a few degrees where the longest waves are
    a tenth of the tile).

    As a density, for pictures and sums over directions, it is a normal bell 0.1 degrees wide.
    """

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `theta`, [1/rad]: the bell."""
        _, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        bell: Real = np.exp(-0.5 * np.square(theta / LONG_CRESTED_WIDTH))
        return bell / (LONG_CRESTED_WIDTH * math.sqrt(2.0 * np.pi))


SPREADINGS.add("long-crested", LongCrested, Way(LongCrested))
