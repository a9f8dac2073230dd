"""
Spectra written in wavenumber: Phillips as computer graphics has it, and the unified spectrum of
Elfouhaily down to capillaries.

Both give F(k), the variance per wavenumber magnitude [m^3/rad]; a `FrequencySpectrum` is asked for
S(omega), and the two are the same energy: S(omega) d omega = F(k) dk, so S = F(k) / (d omega/dk)
with k = k(omega). `depth` and `surface_tension` only say how fast a wave of wavenumber k turns: a
`Sea` takes them from the spectrum, and so has exactly F(k).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY, SURFACE_TENSION
from fftocean.errors import ParameterError
from fftocean.limits import (
    DEPTH,
    PHILLIPS_CONSTANT,
    SIGNIFICANT_WAVE_HEIGHT,
    Quantity,
    keep_checked,
)
from fftocean.limits import SURFACE_TENSION as SURFACE_TENSION_RANGE
from fftocean.physics.dispersion import angular_frequency, group_velocity, wavenumber
from fftocean.physics.spectra import STILL_AIR, checked_wind, warn_of_short_fetch
from fftocean.physics.spreading import wrapped

ANY_FETCH = Quantity("m", 1.0, math.inf)
CUTOFF = Quantity("m", 0.0, 1e3)
FRICTION_VELOCITY = Quantity("m/s", 0.0, 20.0)


def _per_frequency(
    density: Callable[[Real], Real],
    omega: RealLike,
    peak: float,
    depth: float,
    surface_tension: float,
) -> Real:
    """
    S(omega) = F(k) dk/d omega; held at a ten-thousandth of the peak, where both spectra here are 0,
    and far beyond any wave.
    """
    k = wavenumber(
        np.clip(np.asarray(omega, dtype=np.float64), 1e-4 * peak, 1e20), depth, surface_tension
    )
    return density(k) / group_velocity(k, depth, surface_tension)


def _scale(speed: float) -> float:
    """
    The wind [m/s] that sets the scale of a spectrum; any will do in still air, where there is no
    energy to scale.
    """
    return speed if speed >= STILL_AIR else 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Phillips:
    """
    Tessendorf's spectrum, P(k) = A exp(-1/(kL)^2) k^-4 cos^2 theta exp(-(kl)^2), L = V^2/g. Not
    calibrated.

    The source calls A "a numeric constant" and gives no value: a wind does not tell how high this
    sea is. Here P is a density [m^4] and A has no unit, so that the picture does not change with
    the tile; set A by eye or let `from_height` set it. A = alpha / (2 pi) gives the tail of
    Phillips' constant alpha: 1.3e-3 is an ocean's.

    F(k) = pi A exp(-1/(kL)^2 - (kl)^2) k^-3 is the sum over directions. As S(omega), in deep water
    and without l, it is Pierson-Moskowitz with omega_p = 0.8^(1/4) g/V: for a calibrated sea, use
    that. The cos^2 of the source lets as many waves run against the wind as with it;
    `CosineSquared` is its front half.

    Source: Tessendorf, Simulating Ocean Water, SIGGRAPH course notes (2001), eq. 23 and 24; the
    form from Phillips 1958. Pinned by tests/physics/test_wind_wavenumber.py, against the closed m0
    and against `PiersonMoskowitz`.
    """

    speed: float  # V [m/s]; the source does not say how high it blows
    amplitude: float  # A [-]
    cutoff: float = 0.0  # l [m]: waves shorter than about 2 pi l are smoothed away
    depth: float = math.inf  # of the Sea [m]
    surface_tension: float = 0.0  # of the Sea [N/m]

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
                f"cutoff must be at most the scale of the longest waves, {self._longest:g} m, got {self.cutoff:g} m"
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
        The same shape with A chosen so that 4 sqrt(m0) is `hs` [m]: m0 = A pi l L K1(2 l/L), which
        is A pi L^2/2 without l.

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
                f"hs and speed must make waves that can be (2 pi amplitude at most 1), got hs = {hs:g} m with a wind of "
                f"{speed:g} m/s (amplitude = {amplitude:.3g})"
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
        return _scale(self.speed) ** 2 / GRAVITY

    @property
    def _variance(self) -> float:
        """
        m0 = integral of F [m^2], with u = k^2 a Bessel integral (Gradshteyn & Ryzhik 3.471.9).
        """
        from scipy.special import k1

        if not self.speed:
            return 0.0
        z = 2.0 * self.cutoff / self._longest
        return float(
            self.amplitude * np.pi * self._longest**2 / 2.0 * (z * k1(z) if z > 1e-9 else 1.0)
        )  # z K1(z) = 1 + O(z^2 ln z)

    @property
    def peak(self) -> float:
        """omega_p [rad/s] of S in deep water, carried to this water at the same wavelength."""
        y = 8.0 / (
            5.0 + math.sqrt(25.0 + 64.0 * (self.cutoff / self._longest) ** 2)
        )  # (k L)^2 where dS/d omega = 0
        return float(
            angular_frequency(math.sqrt(y) / self._longest, self.depth, self.surface_tension)
        )

    def wavenumber_density(self, k: RealLike) -> Real:
        """F at `k` [rad/m], > 0: variance per wavenumber magnitude [m^3/rad]."""
        amplitude = self.amplitude if self.speed else 0.0
        kl = np.maximum(
            np.asarray(k, dtype=np.float64) * self._longest, 0.03
        )  # there exp(-1/x^2) is 0 in double precision
        f: Real = (
            np.pi
            * amplitude
            * self._longest**3
            * kl**-3
            * np.exp(-(kl**-2) - (kl * (self.cutoff / self._longest)) ** 2)
        )
        return f

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return _per_frequency(
            self.wavenumber_density, omega, self.peak, self.depth, self.surface_tension
        )

    def at_waves(self, _omega: RealLike, k: Real) -> Real:
        """Return S where the wavenumbers `k` [rad/m] are known, [m^2 s/rad]."""
        return self.wavenumber_density(k) / group_velocity(k, self.depth, self.surface_tension)


SHORT_PEAK: Final = 370.0
"""
k_m [rad/m]: the wavenumber of the slowest wave, 1.7 cm long, where gravity and surface tension pull
alike  (Elfouhaily et al. 1997).
"""

SLOWEST: Final = 0.23
"""c_m [m/s]: its speed."""

YOUNGEST: Final = 5.0
"""The greatest U10/c_p for which the unified spectrum is given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Elfouhaily:
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

    Source: Elfouhaily, Chapron, Katsaros & Vandemark, J. Geophys. Res. 102 (1997), 15781-15796,
    doi:10.1029/97JC00467, eq. 2, 3, 31-34, 40, 41, 44; the correction of eq. 41 after Mobley (Ocean
    Optics Web Book), who has it from the first author.
    Pinned by tests/physics/test_wind_wavenumber.py: developed Hs, Cox & Munk's slopes, the second
    peak of B at k_m.
    """

    speed: float  # U10 [m/s]
    fetch: float = math.inf  # [m]; inf is a fully developed sea
    depth: float = math.inf  # of the Sea [m]; the spectrum itself is one of deep water
    surface_tension: float = SURFACE_TENSION  # of the Sea [N/m]

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", checked_wind(self.speed))
        keep_checked(self, fetch=ANY_FETCH, depth=DEPTH, surface_tension=SURFACE_TENSION_RANGE)
        if self.inverse_wave_age > YOUNGEST:
            shortest = (
                2.2e4
                * math.atanh((0.84 / YOUNGEST) ** (4.0 / 3.0)) ** 2.5
                * _scale(self.speed) ** 2
                / GRAVITY
            )
            raise ParameterError(
                f"fetch must be at least {shortest:.4g} m for a wind of {self.speed:g} m/s (where U10/c_p is {YOUNGEST:g}), "
                f"got {self.fetch:g} m"
            )
        warn_of_short_fetch(self.speed, self.fetch)

    @property
    def inverse_wave_age(self) -> float:
        """Omega = U10/c_p [-]."""
        x = GRAVITY * self.fetch / _scale(self.speed) ** 2
        return 0.84 * math.pow(math.tanh(math.pow(x / 2.2e4, 0.4)), -0.75)

    @property
    def friction_velocity(self) -> float:
        """u* [m/s]."""
        return self.speed * math.sqrt((0.8 + 0.065 * self.speed) * 1e-3)

    @property
    def spreading(self) -> "ElfouhailySpreading":
        """The directions that belong to it, waves with the wind only."""
        return ElfouhailySpreading(
            friction_velocity=self.friction_velocity,
            depth=self.depth,
            surface_tension=self.surface_tension,
        )

    @property
    def _peak_wavenumber(self) -> float:
        """k_p [rad/m]."""
        return GRAVITY * (self.inverse_wave_age / _scale(self.speed)) ** 2

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
        """B = k^3 F at `k` [rad/m], > 0: how saturated the waves of that length are [-]."""
        omega_c, k_p, friction = (
            self.inverse_wave_age,
            self._peak_wavenumber,
            self.friction_velocity,
        )
        k = np.maximum(
            np.asarray(k, dtype=np.float64), 0.03 * k_p
        )  # there L is 0 in double precision
        if not self.speed:
            return np.zeros_like(k)
        step = np.sqrt(k / k_p) - 1.0
        gamma = 1.7 + 6.0 * max(math.log10(omega_c), 0.0)
        sigma = 0.08 * (1.0 + 4.0 * omega_c**-3)
        front = np.exp(-1.25 * (k_p / k) ** 2) * gamma ** np.exp(-0.5 * (step / sigma) ** 2)  # L J
        c = _phase_speed(k)
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
        """F at `k` [rad/m], > 0: variance per wavenumber magnitude [m^3/rad]."""
        k = np.maximum(np.asarray(k, dtype=np.float64), 0.03 * self._peak_wavenumber)
        f: Real = self.curvature(k) / k**3
        return f

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return _per_frequency(
            self.wavenumber_density, omega, self.peak, self.depth, self.surface_tension
        )

    def at_waves(self, _omega: RealLike, k: Real) -> Real:
        """Return S where the wavenumbers `k` [rad/m] are known, [m^2 s/rad]."""
        return self.wavenumber_density(k) / group_velocity(k, self.depth, self.surface_tension)


def _phase_speed(k: Real) -> Real:
    """c of deep water as the unified spectrum takes it [m/s]: slowest at k_m."""
    c: Real = np.sqrt(GRAVITY / k * (1.0 + (k / SHORT_PEAK) ** 2))
    return c


@dataclass(frozen=True, slots=True, kw_only=True)
class ElfouhailySpreading:
    """
    D = (1 + Delta cos 2 theta) / pi in the front half, Delta = tanh(ln2/4 + 4 (c/c_p)^2.5 + 0.13
    (u*/c_m) (c_m/c)^2.5).

    Narrow at the peak, nearly all round between, and narrow again at the ripples, which the wind
    combs.

    The paper writes it over the whole circle, as D/2, because a photograph cannot tell a wave from
    its opposite; taken at its word, half of the energy runs against the wind and the sea stands
    still. `both_ways=True` takes it at its word.

    Source: Elfouhaily et al. 1997, eq. 49, 57 and 59.
    """

    friction_velocity: float  # u* [m/s], as `Elfouhaily.friction_velocity` gives it
    both_ways: bool = False  # as many waves against the wind as with it
    depth: float = math.inf  # of the Sea [m]
    surface_tension: float = SURFACE_TENSION  # of the Sea [N/m]

    def __post_init__(self) -> None:
        keep_checked(
            self,
            friction_velocity=FRICTION_VELOCITY,
            depth=DEPTH,
            surface_tension=SURFACE_TENSION_RANGE,
        )
        if not isinstance(self.both_ways, bool):
            raise ParameterError(f"both_ways must be True or False, got {self.both_ways!r:.60}")

    def delta(self, omega: RealLike, peak: float) -> Real:
        """Delta [-] at `omega` [rad/s]: (D(0) - D(90 degrees)) / (D(0) + D(90 degrees))."""
        omega = np.clip(np.asarray(omega, dtype=np.float64), 1e-4 * peak, 1e20)
        c = _phase_speed(wavenumber(omega, self.depth, self.surface_tension))
        c_p = _phase_speed(wavenumber(peak, self.depth, self.surface_tension))
        ripples = 0.13 * self.friction_velocity / SLOWEST
        delta: Real = np.tanh(
            math.log(2.0) / 4.0 + 4.0 * (c / c_p) ** 2.5 + ripples * (SLOWEST / c) ** 2.5
        )
        return delta

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        theta = wrapped(theta)
        d = (1.0 + self.delta(omega, peak) * np.cos(2.0 * theta)) / np.pi
        return 0.5 * d if self.both_ways else np.where(np.abs(theta) < 0.5 * np.pi, d, 0.0)
