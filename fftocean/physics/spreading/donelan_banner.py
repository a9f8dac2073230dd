"""Donelan-Banner spreading, sech^2(beta theta)."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped


@dataclass(frozen=True, slots=True)
class DonelanBanner:
    """
    D = beta / (2 tanh(pi beta)) sech^2(beta theta): narrowest just below the peak, wide far above
    it.

    With x = omega/omega_p: beta = 2.61 x^1.3 up to 0.95 (held at its value at 0.56 below that),
    2.28 x^-1.3 up to 1.6 (Donelan, Hamilton & Hui 1985), and 10^(-0.4 + 0.8393 exp(-0.567 ln x^2))
    above (Banner 1990). The published coefficients leave a step of 0.2 % at 0.95 and of 0.01 % at
    1.6.
    """

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        beta = donelan_banner_beta(np.asarray(omega, dtype=np.float64) / peak)
        # sech^2(y) = 4 e^{-2|y|} / (1 + e^{-2|y|})^2, which cannot overflow
        decay = np.exp(-2.0 * np.abs(beta * wrapped(theta)))
        density: Real = beta / (2.0 * np.tanh(np.pi * beta)) * 4.0 * decay / np.square(1.0 + decay)
        return density


def donelan_banner_beta(x: Real) -> Real:
    """Return beta(omega/omega_p) [-] of `DonelanBanner`."""
    x = np.asarray(x)
    # 10^y as e^(y ln 10), and powers where they are wanted: few waves are that long
    far = np.exp(-0.567 * np.log(np.square(np.maximum(x, 1.6))))
    beta: Real = np.asarray(np.exp(math.log(10.0) * (-0.4 + 0.8393 * far)))
    near, below = (x >= 0.95) & (x < 1.6), x < 0.95
    beta[near] = 2.28 * np.power(x[near], -1.3)
    beta[below] = 2.61 * np.power(np.maximum(x[below], 0.56), 1.3)
    return beta


SPREADINGS.add("donelan-banner", DonelanBanner, Way(DonelanBanner))
