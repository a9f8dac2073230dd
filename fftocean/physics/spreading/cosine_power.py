"""Longuet-Higgins spreading, cos^2s(theta/2)."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.limits import SPREADING_EXPONENT, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped


@runtime_checkable
class CosinePowerLaw(Protocol):
    """A spreading that is cos^2s(theta/2) at every frequency."""

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """Return the exponent s [-] at `omega`."""


@dataclass(frozen=True, slots=True)
class CosinePower:
    """
    D = Gamma(s+1) / (2 sqrt(pi) Gamma(s+1/2)) cos^2s(theta/2), one s for all frequencies
    (Longuet-Higgins et al. 1963).

    Args:
        s: exponent [-]; 0 is all round, 25 a narrow swell.

    Raises:
        ParameterError: an exponent out of its range.
    """

    s: float

    def __post_init__(self) -> None:
        keep_checked(self, s=SPREADING_EXPONENT)

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `theta`, [1/rad]."""
        omega, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        return cosine_2s(np.float64(self.s), theta)


def cosine_2s(s: RealLike, theta: RealLike) -> Real:
    """
    Return the normalised cos^2s(theta/2) for exponents `s` [-] that may vary from point to point.

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


SPREADINGS.add("cosine-power", CosinePower, Way(CosinePower, s=SPREADING_EXPONENT))
