"""Pierson-Moskowitz sampling: a few frequencies of the fully developed sea (VRX)."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real
from fftocean.constants import GRAVITY
from fftocean.gerstner.checks import FACTOR, FREQUENCY_RATIO
from fftocean.gerstner.headings import directed_waves
from fftocean.gerstner.vrx import check_family, shared_steepness, steps
from fftocean.gerstner.waves import Waves

ALPHA = 8.1e-3
"""
The Phillips constant of Pierson & Moskowitz (1964), as the VRX wave generation note has it [-].
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class PMS:
    """
    Pierson-Moskowitz sampling: a few frequencies of the fully developed sea, each with the energy
    of its share of the axis.

    omega_i = s^n omega_p with n = i - (N-1)/2, A_i = gain sqrt(2 S(omega_i) Delta_i), direction_i =
    direction + n angle. Delta_i is half the distance between the neighbours, omega_i (s - 1/s)/2;
    the first and the last reach, on both sides, half way to their one neighbour: Delta_0 = omega_0
    (s - 1), Delta_{N-1} = omega_{N-1} (1 - 1/s). One wave alone has the middle rule. q_i is min(1,
    steepness / (A_i k_i N)): with steepness <= 1 no crest folds, wherever the waves meet. All
    phases are 0.

    `angle` is in radians, as in the note; `direction` in degrees, like every direction here
    (`direction_of` makes one of the note's vector).

    Source: VRX wave generation note, 2.2, for any N; its printed Delta_1 is wrong unless s = 2.
    Pinned by tests/gerstner/test_few_waves.py.

    Raises:
        ParameterError: a value out of its range, or frequencies spread beyond a factor 1e6 from the
            peak.
    """

    number: int = 3  # N
    period: float  # of the spectral peak [s]
    scale: float = 1.5  # s, of one frequency to the next [-]
    gain: float = 1.0  # on every amplitude; the energy goes with its square [-]
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
        FREQUENCY_RATIO.check("scale", self.scale)
        FACTOR.check("gain", self.gain)
        _ = self.waves  # which refuses waves out of range

    @property
    def peak(self) -> float:
        """omega_p [rad/s]."""
        return 2.0 * math.pi / self.period

    @property
    def omega(self) -> Real:
        """omega_i, ascending [rad/s]."""
        return self.peak * self.scale ** steps(self.number)

    @property
    def spacing(self) -> Real:
        """Delta_i, the width of the frequency axis that each wave represents [rad/s]."""
        s, omega = self.scale, self.omega
        delta = omega * (0.5 * (s - 1.0 / s))
        if self.number > 1:
            delta[0], delta[-1] = omega[0] * (s - 1.0), omega[-1] * (1.0 - 1.0 / s)
        return delta

    @property
    def energy_kept(self) -> float:
        """
        sum A^2/2 over gain^2 m0, with m0 = alpha g^2 / (5 omega_p^4) [-].

        0.88 for three waves a factor 1.5 apart, 1.22 at 2, 0.39 at 1.1; toward 1 for many waves,
        close together, that reach far.
        """
        return float(np.sum(self._variances)) / (ALPHA * self.gravity**2 / (5.0 * self.peak**4))

    @property
    def _variances(self) -> Real:
        """S(omega_i) Delta_i [m^2]; S = alpha g^2 omega^-5 exp(-5/4 (omega_p/omega)^4)."""
        density: Real = (
            ALPHA * self.gravity**2 * self.omega**-5 * np.exp(-1.25 * (self.peak / self.omega) ** 4)
        )
        return density * self.spacing

    @property
    def waves(self) -> Waves:
        """The waves, the longest first."""
        amplitude = self.gain * np.sqrt(2.0 * self._variances)
        k = self.omega**2 / self.gravity
        heading = math.radians(self.direction) + steps(self.number) * self.angle
        return directed_waves(
            k,
            heading,
            amplitude,
            self.omega,
            shared_steepness(self.steepness, amplitude * k),
            self.tau,
        )
