"""Unified spectrum of Elfouhaily et al. (1997), from the longest wind wave to capillaries."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY, SURFACE_TENSION
from fftocean.errors import ParameterError
from fftocean.limits import DEPTH, FETCH, WIND_SPEED, Quantity, keep_checked
from fftocean.limits import SURFACE_TENSION as SURFACE_TENSION_RANGE
from fftocean.physics.dispersion import angular_frequency
from fftocean.physics.kinds import Way
from fftocean.physics.spectra.base import SPECTRA
from fftocean.physics.spectra.wavenumber_form import WavenumberForm, scale_wind
from fftocean.physics.spectra.wind import checked_wind, warn_of_short_fetch
from fftocean.physics.spreading.elfouhaily import (
    SHORT_PEAK,
    SLOWEST,
    ElfouhailySpreading,
    friction_velocity,
    phase_speed,
)

ANY_FETCH = Quantity("m", 1.0, math.inf)

YOUNGEST: Final = 5.0
"""The greatest U10/c_p for which the unified spectrum is given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Elfouhaily(WavenumberForm):
    """
    The unified spectrum: one formula from the longest wind wave to the shortest ripple.

    F(k) = (B_l + B_h) k^-3 with the curvature spectra
    B_l = alpha_p/2 (c_p/c) L J exp(-Omega/sqrt(10) (sqrt(k/k_p) - 1)),  L = exp(-5/4 (k_p/k)^2),  J
    = gamma^Gamma, B_h = alpha_m/2 (c_m/c) L J exp(-1/4 (k/k_m - 1)^2),
    where c = sqrt(g/k (1 + (k/k_m)^2)), k_p = Omega^2 g/U^2, and Omega = U/c_p = 0.84 tanh^-0.75((g
    F/U^2 / 2.2e4)^0.4) is 0.84 when fully developed and 5 when young. Eq. 41 of the paper leaves L
    J out of B_h by a slip; without it the short-wave half would have energy at wavelengths far
    beyond the peak.

    The wind U10 enters twice: by Omega, and by the friction velocity that drives the ripples, u* =
    U10 sqrt((0.8 + 0.065 U10) 1e-3) (Wu 1982; 1.45e-3 at 10 m/s, where the paper's figure 11 has
    1.44e-3). Below u* = c_m/e, near 2.7 m/s, there are none. Hs is 0.257 U^2/g when developed; the
    mean-square slope is Cox & Munk's within 20 % from 4 to 20 m/s, too much in less wind.

    Its own directions are in `spreading`. A `Sea` made of it has its depth and surface tension, or
    is refused.

    Args:
        speed: wind speed U10 [m/s].
        fetch: distance over which the wind blows [m]; inf is a fully developed sea.
        depth: depth of the `Sea` [m]; the spectrum itself is one of deep water.
        surface_tension: surface tension of the `Sea` [N/m].

    Raises:
        ParameterError: a wind, fetch, depth or surface tension out of its range.

    Source: Elfouhaily, Chapron, Katsaros & Vandemark, J. Geophys. Res. 102 (1997), 15781-15796,
    doi:10.1029/97JC00467, eq. 2, 3, 31-34, 40, 41, 44; the correction of eq. 41 after Mobley (Ocean
    Optics Web Book), who has it from the first author.
    Pinned by tests/physics/test_wavenumber_spectra.py: developed Hs, slopes of Cox & Munk, the
    second peak of B at k_m.
    """

    speed: float
    fetch: float = math.inf
    depth: float = math.inf
    surface_tension: float = SURFACE_TENSION

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", checked_wind(self.speed))
        keep_checked(self, fetch=ANY_FETCH, depth=DEPTH, surface_tension=SURFACE_TENSION_RANGE)
        if self.inverse_wave_age > YOUNGEST:
            shortest = (
                2.2e4
                * math.atanh((0.84 / YOUNGEST) ** (4.0 / 3.0)) ** 2.5
                * scale_wind(self.speed) ** 2
                / GRAVITY
            )
            raise ParameterError(
                f"fetch must be at least {shortest:.4g} m for a wind of {self.speed:g} m/s "
                f"(where U10/c_p is {YOUNGEST:g}), got {self.fetch:g} m"
            )
        warn_of_short_fetch(self.speed, self.fetch)

    @property
    def inverse_wave_age(self) -> float:
        """Omega = U10/c_p [-]."""
        x = GRAVITY * self.fetch / scale_wind(self.speed) ** 2
        return 0.84 * math.pow(math.tanh(math.pow(x / 2.2e4, 0.4)), -0.75)

    @property
    def friction_velocity(self) -> float:
        """u* [m/s]."""
        return friction_velocity(self.speed)

    @property
    def spreading(self) -> "ElfouhailySpreading":
        """The spreading that belongs to the spectrum, waves with the wind only."""
        return ElfouhailySpreading(
            friction_velocity=self.friction_velocity,
            depth=self.depth,
            surface_tension=self.surface_tension,
        )

    @property
    def _peak_wavenumber(self) -> float:
        """k_p [rad/m]."""
        return GRAVITY * (self.inverse_wave_age / scale_wind(self.speed)) ** 2

    @property
    def peak(self) -> float:
        """omega_p = omega(k_p) [rad/s]: within 5 % of where S is highest."""
        return float(angular_frequency(self._peak_wavenumber, self.depth, self.surface_tension))

    @property
    def breaks(self) -> tuple[float, ...]:
        """The scales of the long waves and of the ripples [rad/s]."""
        k = np.array([0.25, 1.0, 4.0, 100.0]) * self._peak_wavenumber
        k = np.concatenate([k, np.array([0.1, 1.0, 3.0]) * SHORT_PEAK])
        return tuple(np.unique(angular_frequency(k, self.depth, self.surface_tension)).tolist())

    def curvature(self, k: RealLike) -> Real:
        """Return B = k^3 F at `k` [rad/m], > 0: the saturation there [-], shaped like `k`."""
        omega_c, k_p, friction = (
            self.inverse_wave_age,
            self._peak_wavenumber,
            self.friction_velocity,
        )
        # there L is 0 in double precision
        k = np.maximum(np.asarray(k, dtype=np.float64), 0.03 * k_p)
        if not self.speed:
            return np.zeros_like(k)
        step = np.sqrt(k / k_p) - 1.0
        gamma = 1.7 + 6.0 * max(math.log10(omega_c), 0.0)
        sigma = 0.08 * (1.0 + 4.0 * omega_c**-3)
        front = np.exp(-1.25 * (k_p / k) ** 2) * gamma ** np.exp(-0.5 * (step / sigma) ** 2)  # L J
        c = phase_speed(k)
        alpha_p = 6e-3 * omega_c**0.55
        long = (
            0.5
            * alpha_p
            * (math.sqrt(GRAVITY / k_p) / c)
            * np.exp(-omega_c / math.sqrt(10.0) * step)
        )
        pull = math.log(friction / SLOWEST)
        alpha_m = 0.01 * max(1.0 + (pull if pull <= 0.0 else 3.0 * pull), 0.0)
        short = (
            0.5
            * alpha_m
            * (SLOWEST / c)
            * np.exp(-0.25 * (np.minimum(k / SHORT_PEAK, 1e3) - 1.0) ** 2)
        )
        b: Real = front * (long + short)
        return b

    def wavenumber_density(self, k: RealLike) -> Real:
        """Return F at `k` [rad/m], > 0: variance per wavenumber [m^3/rad], shaped like `k`."""
        k = np.maximum(np.asarray(k, dtype=np.float64), 0.03 * self._peak_wavenumber)
        f: Real = self.curvature(k) / k**3
        return f


SPECTRA.add(
    "elfouhaily",
    Elfouhaily,
    Way(Elfouhaily, water=("depth", "surface_tension"), speed=WIND_SPEED, fetch=FETCH),
)
