"""Gerstner waves given by wavelength, steepness and direction."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.gerstner.checks import FACTOR, WAVELENGTH, Column, set_columns, set_gravity
from fftocean.gerstner.headings import directed_waves
from fftocean.gerstner.waves import Waves
from fftocean.limits import DIRECTION


@dataclass(frozen=True, slots=True, kw_only=True)
class SteepnessWaves:
    """
    Waves by wavelength, steepness and direction: A = steepness/k, P = [x + Dx A cos f, A sin f, z +
    Dz A cos f], y up.

    f = k (D.(x, z) - c t), c = sqrt(g/k): a Gerstner wave (q = 1) of phase pi/2. Crests become
    cusps at steepness 1 and fold beyond; where several waves meet it is the sum that counts.

    Each of the three is one number for all waves or a list of one for each.

    Source: CS175 final project (2023), section 2, after Catlike Coding, Waves (2018). Pinned by
    tests/gerstner/test_few_waves.py.

    Raises:
        ParameterError: a value out of its range, or lists of different lengths.
    """

    wavelength: Column  # [m]
    steepness: Column  # k A [-]
    direction: Column = 0.0  # of D, from x toward z (our y) [degrees]
    gravity: float = GRAVITY  # [m/s^2]; the document has 9.8

    def __post_init__(self) -> None:
        columns = {
            "wavelength": (self.wavelength, WAVELENGTH),
            "steepness": (self.steepness, FACTOR),
            "direction": (self.direction, DIRECTION),
        }
        set_columns(self, columns)
        set_gravity(self, self.gravity)
        _ = self.waves  # which refuses waves out of range

    @property
    def waves(self) -> Waves:
        """The waves, in the order given."""
        k = 2.0 * math.pi / np.asarray(self.wavelength)
        amplitude = np.asarray(self.steepness) / k
        return directed_waves(
            k,
            np.radians(self.direction),
            amplitude,
            np.sqrt(self.gravity * k),
            1.0,
            0.0,
            phase=0.5 * math.pi,
        )
