"""
D(omega, theta): how a frequency's energy is shared out among the directions; every D integrates to
1 over the circle.
"""

import math
from dataclasses import dataclass, field
from functools import partial
from types import BuiltinFunctionType, FunctionType, MethodType
from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import FRACTION, SPREADING_EXPONENT, keep_checked


@runtime_checkable
class Spreading(Protocol):
    """
    Maps omega [rad/s] and theta [rad] (from the system's direction) to D [1/rad]; `peak` is the
    system's omega_p [rad/s].
    """

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, which broadcast."""


def require_spreading(name: str, value: object) -> None:
    """
    Refuse what cannot spread waves.

    Raises:
        ParameterError: not callable, a model's class where a model is wanted, or a plain function,
            whose integral nobody has seen to.
    """
    if isinstance(value, (FunctionType, BuiltinFunctionType, MethodType, partial)):
        raise ParameterError(
            f"{name} must integrate to 1 round the circle (wrap a plain function: CustomSpreading(f)), got {value!r:.60}"
        )
    if not callable(value) or isinstance(value, type):
        raise ParameterError(f"{name} must be callable as D(omega, theta, peak), got {value!r:.60}")


def wrapped(theta: RealLike) -> Real:
    """The same angles in [-pi, pi]."""
    theta = np.asarray(theta, dtype=np.float64)
    return theta - 2.0 * np.pi * np.rint(theta / (2.0 * np.pi))


@dataclass(frozen=True, slots=True)
class CosineSquared:
    """
    D = (2/pi) cos^2(theta) in the front half, 0 behind; the same at every frequency  (Horvath
    2015).
    """

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """D at `theta`, [1/rad]."""
        omega, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        return np.where(np.abs(theta) < 0.5 * np.pi, (2.0 / np.pi) * np.square(np.cos(theta)), 0.0)


@dataclass(frozen=True, slots=True)
class CosinePower:
    """
    D = Gamma(s+1) / (2 sqrt(pi) Gamma(s+1/2)) cos^2s(theta/2), one s for all frequencies
    (Longuet-Higgins et al. 1963).
    """

    s: float  # exponent [-]: 0 is all round, 25 a narrow swell

    def __post_init__(self) -> None:
        keep_checked(self, s=SPREADING_EXPONENT)

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """D at `theta`, [1/rad]."""
        omega, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        return cosine_2s(np.float64(self.s), theta)


def cosine_2s(s: RealLike, theta: RealLike) -> Real:
    """
    Normalised cos^2s(theta/2) for exponents `s` [-] that may vary from point to point.

    The ratio of Gamma functions is Pochhammer's symbol (s + 1/2)_(1/2): the difference of two
    log-gammas, each of size s ln s, would lose as many digits (nine at s = 1e6). The power is taken
    in logarithms; in front as ln(1 - sin^2)/2, as a cosine near 1 has lost the angle.
    """
    from scipy.special import poch

    s, theta = np.asarray(s, dtype=np.float64), np.asarray(theta, dtype=np.float64)
    sine2 = np.square(np.sin(0.5 * theta))
    in_front = 0.5 * np.log1p(-np.minimum(sine2, 0.5))
    log_cosine = np.where(
        sine2 < 0.5, in_front, np.log(np.maximum(np.abs(np.cos(0.5 * theta)), 1e-300))
    )
    density: Real = poch(s + 0.5, 0.5) / (2.0 * np.sqrt(np.pi)) * np.exp(2.0 * s * log_cosine)
    return density


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
        """D at `omega` and `theta`, [1/rad]."""
        beta = donelan_banner_beta(np.asarray(omega, dtype=np.float64) / peak)
        # sech^2(y) = 4 e^{-2|y|} / (1 + e^{-2|y|})^2, which cannot overflow
        decay = np.exp(-2.0 * np.abs(beta * wrapped(theta)))
        density: Real = beta / (2.0 * np.tanh(np.pi * beta)) * 4.0 * decay / np.square(1.0 + decay)
        return density


def donelan_banner_beta(x: Real) -> Real:
    """beta(omega/omega_p) [-] of `DonelanBanner`."""
    below = 2.61 * np.power(np.clip(x, 0.56, 0.95), 1.3)
    near = 2.28 * np.power(np.clip(x, 0.95, 1.6), -1.3)
    above = np.power(10.0, -0.4 + 0.8393 * np.exp(-0.567 * np.log(np.square(np.maximum(x, 1.6)))))
    return np.where(x < 0.95, below, np.where(x < 1.6, near, above))


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


@dataclass(frozen=True, slots=True)
class Blend:
    """
    (1 - weight) first + weight second: from the first model at weight 0 to the second at weight 1.
    """

    first: Spreading = field(default_factory=DonelanBanner)
    second: Spreading = field(default_factory=CosineSquared)
    weight: float = field(default=0.5, kw_only=True)  # share of `second` [-]

    def __post_init__(self) -> None:
        require_spreading("first", self.first)
        require_spreading("second", self.second)
        keep_checked(self, weight=FRACTION)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The directions at which one of the two has a kink or a jump [rad]."""
        return tuple(b for model in (self.first, self.second) for b in getattr(model, "breaks", ()))

    @property
    def frequency_breaks(self) -> tuple[float, ...]:
        """The frequencies at which one of the two has a kink [rad/s]."""
        return tuple(
            b for model in (self.first, self.second) for b in getattr(model, "frequency_breaks", ())
        )

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        return (1.0 - self.weight) * self.first(omega, theta, peak) + self.weight * self.second(
            omega, theta, peak
        )
