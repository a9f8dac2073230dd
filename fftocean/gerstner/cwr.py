"""Constant wavelength-amplitude ratio: waves of one shape (VRX)."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.gerstner.checks import AMPLITUDE
from fftocean.gerstner.headings import directed_waves
from fftocean.gerstner.vrx import check_family, shared_steepness, steps
from fftocean.gerstner.waves import Waves


@dataclass(frozen=True, slots=True, kw_only=True)
class CWR:
    """
    Waves of one shape, each s times as long and as high as the one before.

    With n = i - (N-1)/2: A_i = amplitude s^n, k_i = k/s^n, omega_i = sqrt(g k_i), direction_i =
    direction + n angle, and q_i = min(1, steepness / (A_i k_i N)), the same for all since A_i k_i
    is. `period` and `amplitude` are those of the median wave, for an even number the geometric mean
    of the middle two. `angle` is in radians and `direction` in degrees, as in `PMS`.

    Source: VRX wave generation note, 2.3, after Finch, GPU Gems (2004), chapter 1. The note prints
    n = i - N/2, which is centred in neither case; its text says median.
    Pinned by tests/gerstner/test_few_waves.py.

    Raises:
        ParameterError: a value out of its range, or waves spread beyond a factor 1e6 from the
            median.
    """

    number: int = 3  # N
    period: float  # median [s]
    amplitude: float  # median [m]
    scale: float = 2.0  # s, of one wavelength to the next [-]
    direction: float = 0.0  # toward which the middle wave goes, counter-clockwise from +x [degrees]
    angle: float = 0.4  # from one wave's direction to the next [rad]
    steepness: float = 1.0  # q: 0 is sines, 1 is as sharp as can be without folding [-]
    tau: float = 0.0  # time constant of the start [s]; 0 is none
    gravity: float = GRAVITY  # [m/s^2]

    def __post_init__(self) -> None:
        check_family(
            self.number,
            self.period,
            self.scale,
            self.direction,
            self.angle,
            self.steepness,
            self.tau,
            self.gravity,
        )
        AMPLITUDE.check("amplitude", self.amplitude)
        _ = self.waves  # which refuses waves out of range

    @property
    def waves(self) -> Waves:
        """The waves, the shortest first."""
        n = steps(self.number)
        amplitude = self.amplitude * self.scale**n
        k = (2.0 * math.pi / self.period) ** 2 / self.gravity / self.scale**n
        heading = math.radians(self.direction) + n * self.angle
        sharpness = shared_steepness(self.steepness, amplitude * k)
        return directed_waves(k, heading, amplitude, np.sqrt(self.gravity * k), sharpness, self.tau)
