"""Trochoidal waves over water of any depth."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.gerstner.checks import (
    AMPLITUDE,
    COMPONENT,
    WAVENUMBER,
    Column,
    as_array,
    set_columns,
    set_gravity,
)
from fftocean.gerstner.waves import Waves
from fftocean.limits import ANGLE, DEPTH, LOOP


@dataclass(frozen=True, slots=True, kw_only=True)
class TrochoidalWaves:
    """
    Waves over water of any depth by amplitude and wavevector.

    xi = alpha - sum (kx/k) a/tanh(kh) sin(theta), eta = beta - sum (kz/k) a/tanh(kh) sin(theta),
    zeta = sum a cos(theta), the last of them up, with theta = kx alpha + kz beta - omega t - phi
    and omega^2 = g k tanh(kh). A particle goes round in an ellipse coth(kh) times as wide as it is
    high.

    A finite `loop` makes the surface repeat after that time: every omega becomes the nearest whole
    multiple of 2 pi/loop, which is off by at most pi/loop; waves that would stand still are sped up
    to one cycle a loop.

    Each of kx, kz, a and phi is one number for all waves or a list of one for each.

    Source: Wikipedia, "Trochoidal wave", section "In computer graphics". Pinned by
    tests/gerstner/test_few_waves.py.

    Raises:
        ParameterError: a value out of its range, lists of different lengths, or a wave without a
            wavenumber.
    """

    a: Column  # amplitude [m]
    kx: Column  # [rad/m]
    kz: Column = 0.0  # our ky [rad/m]
    phi: Column = 0.0  # phase [rad]
    h: float = math.inf  # mean depth [m]; inf is deep water
    loop: float = math.inf  # the surface repeats after this time [s]; inf is never
    gravity: float = GRAVITY  # [m/s^2]

    def __post_init__(self) -> None:
        set_columns(
            self,
            {
                "a": (self.a, AMPLITUDE),
                "kx": (self.kx, COMPONENT),
                "kz": (self.kz, COMPONENT),
                "phi": (self.phi, ANGLE),
            },
        )
        DEPTH.check("h", self.h)
        if self.loop != math.inf:
            LOOP.check("loop", self.loop)
        set_gravity(self, self.gravity)
        k = np.hypot(self.kx, self.kz)
        if not np.all(k >= WAVENUMBER.low):
            raise ParameterError(
                f"kx and kz must make wavenumbers of at least {WAVENUMBER.low:g} "
                f"{WAVENUMBER.unit}, got {np.min(k)}"
            )

    @property
    def waves(self) -> Waves:
        """The waves, in the order given."""
        k = np.hypot(self.kx, self.kz)
        tanh = np.tanh(k * self.h)
        omega = np.sqrt(self.gravity * k * tanh)
        if self.loop < math.inf:
            step = 2.0 * math.pi / self.loop
            omega = np.maximum(np.rint(omega / step), 1.0) * step
        return Waves(
            kx=as_array(self.kx),
            ky=as_array(self.kz),
            amplitude=as_array(self.a),
            phase=as_array(self.phi),
            omega=omega,
            sharpness=1.0 / tanh,
        )
