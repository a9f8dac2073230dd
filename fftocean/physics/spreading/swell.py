"""Swell elongation of another spreading."""

from dataclasses import dataclass, field

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.limits import FRACTION, keep_checked
from fftocean.physics.kinds import Part, Way
from fftocean.physics.spreading.base import (
    SPREADINGS,
    Spreading,
    held,
    relative,
    require_spreading,
    wrapped,
)
from fftocean.physics.spreading.cosine_power import CosinePower, CosinePowerLaw, cosine_2s
from fftocean.physics.spreading.donelan_banner import DonelanBanner
from fftocean.physics.spreading.normalisation import circle_integral


@dataclass(frozen=True, slots=True)
class SwellElongation:
    """
    Another spreading, elongated along the swell: D cos^2s(theta/2) with s = 16 tanh(omega_p/omega)
    xi^2, brought back to integral 1.

    xi = 0 leaves it as it is, xi = 1 makes long parallel swells of the low frequencies. Where the
    base is itself a power of cos(theta/2) the exponents add and the norm is closed; else it is a
    quadrature like `CustomSpreading`'s.

    Args:
        base: spreading that is elongated.
        xi: swell, 0 to 1 [-].

    Raises:
        ParameterError: xi outside 0 to 1, or a base that is no spreading.

    Source: Horvath, Empirical directional wave spectra for computer graphics, DigiPro 2015,
    doi:10.1145/2791261.2791267 (his own code has 16.1 for 16 and a norm over the front half only).
    """

    base: Spreading = field(default_factory=DonelanBanner)
    xi: float = field(default=0.5, kw_only=True)

    def __post_init__(self) -> None:
        require_spreading("base", self.base)
        keep_checked(self, xi=FRACTION)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The directions at which the base has a kink or a jump [rad]."""
        return tuple(getattr(self.base, "breaks", ()))

    @property
    def frequency_breaks(self) -> tuple[float, ...]:
        """The frequencies at which the base has a kink [rad/s]."""
        return tuple(getattr(self.base, "frequency_breaks", ()))

    def exponent_added(self, omega: RealLike, peak: float) -> Real:
        """Return 16 tanh(omega_p/omega) xi^2 [-] at `omega`, shaped like it."""
        s: Real = 16.0 * np.tanh(1.0 / relative(omega, peak)) * self.xi**2
        return s

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        if self.xi == 0.0:
            return self.base(omega, theta, peak)
        own = self._own_exponent(omega, peak)
        if own is not None:
            return cosine_2s(own + self.exponent_added(omega, peak), wrapped(theta))
        omega = held(omega, peak)
        density: Real = self._product(omega, theta, peak) / circle_integral(
            self._product, omega, peak, self.breaks
        )
        return density

    def _own_exponent(self, omega: RealLike, peak: float) -> Real | None:
        """Return the exponent s of the base where it is a power of cos(theta/2)."""
        if isinstance(self.base, CosinePower):
            return np.full_like(np.asarray(omega, dtype=np.float64), self.base.s)
        return self.base.exponent(omega, peak) if isinstance(self.base, CosinePowerLaw) else None

    def _product(self, omega: RealLike, theta: RealLike, peak: float) -> Real:
        """Return D cos^2s(theta/2), not normalised."""
        cosine = np.maximum(np.abs(np.cos(0.5 * np.asarray(theta, dtype=np.float64))), 1e-300)
        product: Real = self.base(omega, theta, peak) * np.exp(
            2.0 * self.exponent_added(omega, peak) * np.log(cosine)
        )
        return product


SPREADINGS.add("swell", SwellElongation, Way(SwellElongation, base=Part("spreading"), xi=FRACTION))
