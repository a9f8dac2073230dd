"""Gerstner waves of Bailey's slides."""

from dataclasses import dataclass

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.gerstner.checks import AMPLITUDE, WAVENUMBER, Column, set_columns, set_gravity
from fftocean.gerstner.headings import directed_waves
from fftocean.gerstner.waves import Waves
from fftocean.limits import ANGLE


@dataclass(frozen=True, slots=True, kw_only=True)
class SlideWaves:
    """
    Deep-water waves by amplitude, wavenumber and angle.

    x' = x - sum A cos(gamma) sin(theta), y' = sum A cos(theta), z' = z - sum A sin(gamma)
    sin(theta), y up, with theta = k cos(gamma) x + k sin(gamma) z - omega t - phi and omega =
    sqrt(g k).

    Each of the four is one number for all waves or a list of one for each.

    Source: Mike Bailey's Gerstner wave slides (2021); the equations, with z for the second y in
    theta, not the shader. Pinned by tests/gerstner/test_few_waves.py.

    Raises:
        ParameterError: a value out of its range, or lists of different lengths.
    """

    A: Column  # amplitude [m]
    k: Column  # wavenumber, the slides' "wave density" [rad/m]
    gamma: Column = 0.0  # propagation angle, from x toward z (our y) [rad]
    phi: Column = 0.0  # phase [rad]
    gravity: float = GRAVITY  # [m/s^2]; the slides' shader has G = 1

    def __post_init__(self) -> None:
        set_columns(
            self,
            {
                "A": (self.A, AMPLITUDE),
                "k": (self.k, WAVENUMBER),
                "gamma": (self.gamma, ANGLE),
                "phi": (self.phi, ANGLE),
            },
        )
        set_gravity(self, self.gravity)

    @property
    def waves(self) -> Waves:
        """The waves, in the order given."""
        k = np.asarray(self.k)
        return directed_waves(
            k, np.asarray(self.gamma), self.A, np.sqrt(self.gravity * k), 1.0, 0.0, phase=self.phi
        )
