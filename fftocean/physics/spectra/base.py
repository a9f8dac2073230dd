"""Protocol of frequency spectra S(omega), and the checks of arguments that need one."""

from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, described
from fftocean.limits import PEAK, SIGNIFICANT_WAVE_HEIGHT
from fftocean.physics.kinds import Registry


@runtime_checkable
class FrequencySpectrum(Protocol):
    """
    Function from angular frequency [rad/s] to variance density S(omega) [m^2 s/rad], same shape; 0
    where omega <= 0.
    """

    @property
    def peak(self) -> float:
        """The angular frequency of the spectral peak, omega_p [rad/s]."""

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`."""


SPECTRA: Registry[FrequencySpectrum | None] = Registry("spectrum")
"""All spectra that a job file can name; None is a flat sea."""


def require_spectrum(name: str, value: object) -> None:
    """
    Raise if `value` is not a spectrum.

    Raises:
        ParameterError: not callable, without a peak, or a spectrum's class where a spectrum is
            wanted.
    """
    if isinstance(value, type) or not isinstance(value, FrequencySpectrum):
        raise ParameterError(
            f"{name} must be callable and have a peak (wrap a plain function: "
            f"CustomSpectrum(f, peak=...)), got {described(value)}"
        )
    PEAK.check(f"{name}.peak", value.peak)


def relative(omega: RealLike, peak: float) -> Real:
    """
    Return omega/omega_p, at least 0.05 and at most 1e100/omega_p: exp(-5/4 x^-4) is 0 there in
    double precision, and x^-5 does not overflow.
    """
    return np.minimum(np.maximum(np.asarray(omega, dtype=np.float64), 0.05 * peak), 1e100) / peak


def phillips_constant(hs: float, tp: float, shape_integral: float) -> float:
    """Return the Phillips constant of m0 = hs^2/16."""
    hs = SIGNIFICANT_WAVE_HEIGHT.check("hs", hs)
    alpha = (hs / 4.0) ** 2 * (2.0 * np.pi / tp) ** 4 / (GRAVITY**2 * shape_integral)
    if not alpha <= 1.0:
        raise ParameterError(too_steep(hs, tp, alpha))
    return float(alpha)


def too_steep(hs: float, tp: float, alpha: float) -> str:
    """Return the message about waves steeper than possible."""
    return (
        "hs and tp must make waves that are possible (Phillips constant at most 1), "
        f"got {hs:g} m with {tp:g} s (alpha = {alpha:.3g})"
    )
