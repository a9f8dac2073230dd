"""D(omega, theta): how a frequency's energy is shared out among the directions; every D integrates to 1 over the circle."""

from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.limits import FRACTION, SPREADING_EXPONENT


@runtime_checkable
class Spreading(Protocol):
    """Maps omega [rad/s] and theta [rad] (from the system's direction) to D [1/rad]; `peak` is the system's omega_p [rad/s]."""

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, which broadcast."""


def wrapped(theta: RealLike) -> Real:
    """The same angles in [-pi, pi]."""
    theta = np.asarray(theta, dtype=np.float64)
    return theta - 2.0 * np.pi * np.rint(theta / (2.0 * np.pi))


@dataclass(frozen=True, slots=True)
class CosineSquared:
    """D = (2/pi) cos^2(theta) in the front half, 0 behind; the same at every frequency  (Horvath 2015, eq. 29)."""

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `theta`, [1/rad]."""
        omega, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        return np.where(np.abs(theta) < 0.5 * np.pi, (2.0 / np.pi) * np.cos(theta) ** 2, 0.0)


@dataclass(frozen=True, slots=True)
class CosinePower:
    """D = Gamma(s+1) / (2 sqrt(pi) Gamma(s+1/2)) cos^2s(theta/2), one s for all frequencies  (Longuet-Higgins et al. 1963)."""

    s: float  # exponent [-]: 0 is all round, 25 a narrow swell

    def __post_init__(self) -> None:
        SPREADING_EXPONENT.check("s", self.s)

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `theta`, [1/rad]."""
        omega, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        return cosine_2s(np.float64(self.s), theta)


def cosine_2s(s: RealLike, theta: RealLike) -> Real:
    """Normalised cos^2s(theta/2) for exponents `s` [-] that may vary from point to point: in logarithms, so that s = 1e4 does not overflow."""
    from scipy.special import gammaln

    s, theta = np.asarray(s, dtype=np.float64), np.asarray(theta, dtype=np.float64)
    log_norm = gammaln(s + 1.0) - gammaln(s + 0.5) - np.log(2.0 * np.sqrt(np.pi))
    cosine = np.maximum(np.abs(np.cos(0.5 * theta)), 1e-300)
    return np.exp(log_norm + 2.0 * s * np.log(cosine))


@dataclass(frozen=True, slots=True)
class DonelanBanner:
    """
    D = beta / (2 tanh(pi beta)) sech^2(beta theta): narrowest just below the peak, wide far above it.

    With x = omega/omega_p: beta = 2.61 x^1.3 up to 0.95 (held at its value at 0.56 below that), 2.28 x^-1.3 up to 1.6
    (Donelan, Hamilton & Hui 1985), and 10^(-0.4 + 0.8393 exp(-0.567 ln x^2)) above (Banner 1990). The published coefficients
    leave a step of 0.2 % at 0.95 and of 0.01 % at 1.6.
    """

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        beta = donelan_banner_beta(np.asarray(omega, dtype=np.float64) / peak)
        # sech^2(y) = 4 e^{-2|y|} / (1 + e^{-2|y|})^2, which cannot overflow
        decay = np.exp(-2.0 * np.abs(beta * wrapped(theta)))
        return beta / (2.0 * np.tanh(np.pi * beta)) * 4.0 * decay / (1.0 + decay) ** 2


def donelan_banner_beta(x: Real) -> Real:
    """beta(omega/omega_p) [-] of `DonelanBanner`."""
    below = 2.61 * np.clip(x, 0.56, 0.95) ** 1.3
    near = 2.28 * np.clip(x, 0.95, 1.6) ** -1.3
    above = 10.0 ** (-0.4 + 0.8393 * np.exp(-0.567 * np.log(np.maximum(x, 1.6) ** 2)))
    return np.where(x < 0.95, below, np.where(x < 1.6, near, above))


@dataclass(frozen=True, slots=True)
class Blend:
    """(1 - weight) first + weight second: from the first model at weight 0 to the second at weight 1."""

    first: Spreading = field(default_factory=DonelanBanner)
    second: Spreading = field(default_factory=CosineSquared)
    weight: float = field(default=0.5, kw_only=True)  # share of `second` [-]

    def __post_init__(self) -> None:
        FRACTION.check("weight", self.weight)

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        return (1.0 - self.weight) * self.first(omega, theta, peak) + self.weight * self.second(omega, theta, peak)
