"""Phillips spectrum as Tessendorf (2001) gives it."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import (
    DEPTH,
    PHILLIPS_CONSTANT,
    SIGNIFICANT_WAVE_HEIGHT,
    WIND_SPEED,
    Quantity,
    keep_checked,
)
from fftocean.limits import SURFACE_TENSION as SURFACE_TENSION_RANGE
from fftocean.physics.dispersion import angular_frequency
from fftocean.physics.kinds import Way
from fftocean.physics.spectra.base import SPECTRA
from fftocean.physics.spectra.wavenumber_form import WavenumberForm, scale_wind
from fftocean.physics.spectra.wind import checked_wind

CUTOFF = Quantity("m", 0.0, 1e3)


@dataclass(frozen=True, slots=True, kw_only=True)
class Phillips(WavenumberForm):
    """
    Tessendorf's spectrum, P(k) = A exp(-1/(kL)^2) k^-4 cos^2 theta exp(-(kl)^2), L = V^2/g. Not
    calibrated.

    The source calls A "a numeric constant" and gives no value: a wind does not tell how high this
    sea is. Here P is a density [m^4] and A has no unit, so that the sea does not change with
    the tile; set A by eye or let `from_height` set it. A = alpha / (2 pi) gives the tail of
    Phillips' constant alpha: 1.3e-3 is an ocean's.

    F(k) = pi A exp(-1/(kL)^2 - (kl)^2) k^-3 is the sum over directions. As S(omega), in deep water
    and without l, it is Pierson-Moskowitz with omega_p = 0.8^(1/4) g/V: for a calibrated sea, use
    that. The cos^2 of the source lets as many waves run against the wind as with it;
    `CosineSquared` is its front half.

    Args:
        speed: wind speed V [m/s]; the source does not say how high it blows.
        amplitude: A [-].
        cutoff: l [m]: waves shorter than about 2 pi l are smoothed away.
        depth: depth of the `Sea` [m].
        surface_tension: surface tension of the `Sea` [N/m].

    Raises:
        ParameterError: a value out of its range, or a depth or surface tension that no such sea
            has.

    Source: Tessendorf, Simulating Ocean Water, SIGGRAPH course notes (2001), eq. 23 and 24; the
    form from Phillips 1958. Pinned by tests/physics/test_wavenumber_spectra.py, against the closed
    m0 and against `PiersonMoskowitz`.
    """

    speed: float
    amplitude: float
    cutoff: float = 0.0
    depth: float = math.inf
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", checked_wind(self.speed))
        keep_checked(
            self,
            amplitude=PHILLIPS_CONSTANT,
            cutoff=CUTOFF,
            depth=DEPTH,
            surface_tension=SURFACE_TENSION_RANGE,
        )
        if self.cutoff > self._longest:
            raise ParameterError(
                f"cutoff must be at most the scale of the longest waves, {self._longest:g} m, "
                f"got {self.cutoff:g} m"
            )

    @classmethod
    def from_height(
        cls,
        *,
        hs: float,
        speed: float,
        cutoff: float = 0.0,
        depth: float = math.inf,
        surface_tension: float = 0.0,
    ) -> "Phillips":
        """
        Return the spectrum whose A makes 4 sqrt(m0) = `hs` [m]: m0 = A pi l L K1(2 l/L), which is A
        pi L^2/2 without l.

        Raises:
            ParameterError: a value out of its range, or waves too steep to be (2 pi A > 1), as any
                would be without wind.
        """
        hs = SIGNIFICANT_WAVE_HEIGHT.check("hs", hs)
        unit = cls(
            speed=speed, amplitude=1.0, cutoff=cutoff, depth=depth, surface_tension=surface_tension
        )
        amplitude = (hs / 4.0) ** 2 / unit._variance if unit._variance else math.inf if hs else 0.0
        if not 2.0 * math.pi * amplitude <= 1.0:
            raise ParameterError(
                "hs and speed must make waves that are possible (2 pi amplitude at most 1), "
                f"got hs = {hs:g} m with a wind of {speed:g} m/s (amplitude = {amplitude:.3g})"
            )
        return cls(
            speed=speed,
            amplitude=amplitude,
            cutoff=cutoff,
            depth=depth,
            surface_tension=surface_tension,
        )

    @property
    def _longest(self) -> float:
        """L = V^2/g [m]; not 0 in still air, where the amplitude is."""
        return scale_wind(self.speed) ** 2 / GRAVITY

    @property
    def _variance(self) -> float:
        """
        m0 = integral of F [m^2], with u = k^2 a Bessel integral (Gradshteyn & Ryzhik 3.471.9).
        """
        from scipy.special import k1

        if not self.speed:
            return 0.0
        z = 2.0 * self.cutoff / self._longest
        # z K1(z) = 1 + O(z^2 ln z)
        return float(
            self.amplitude * np.pi * self._longest**2 / 2.0 * (z * k1(z) if z > 1e-9 else 1.0)
        )

    @property
    def peak(self) -> float:
        """omega_p [rad/s] of S in deep water, carried to this water at the same wavelength."""
        # (k L)^2 where dS/d omega = 0
        y = 8.0 / (5.0 + math.sqrt(25.0 + 64.0 * (self.cutoff / self._longest) ** 2))
        return float(
            angular_frequency(math.sqrt(y) / self._longest, self.depth, self.surface_tension)
        )

    def wavenumber_density(self, k: RealLike) -> Real:
        """Return F at `k` [rad/m], > 0: variance per wavenumber [m^3/rad], shaped like `k`."""
        amplitude = self.amplitude if self.speed else 0.0
        # there exp(-1/x^2) is 0 in double precision
        kl = np.maximum(np.asarray(k, dtype=np.float64) * self._longest, 0.03)
        f: Real = (
            np.pi
            * amplitude
            * self._longest**3
            * kl**-3
            * np.exp(-(kl**-2) - (kl * (self.cutoff / self._longest)) ** 2)
        )
        return f


SPECTRA.add(
    "phillips",
    Phillips,
    Way(
        Phillips.from_height,
        water=("depth", "surface_tension"),
        hs=SIGNIFICANT_WAVE_HEIGHT,
        speed=WIND_SPEED,
        cutoff=CUTOFF,
    ),
    Way(
        Phillips,
        water=("depth", "surface_tension"),
        speed=WIND_SPEED,
        amplitude=PHILLIPS_CONSTANT,
        cutoff=CUTOFF,
    ),
)
