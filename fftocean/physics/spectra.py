"""S(omega): how much of the sea's variance sits at each frequency."""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, SeaWarning, described
from fftocean.limits import (
    DENSITY,
    DEPTH,
    FETCH,
    FREQUENCY,
    PEAK,
    PEAK_ENHANCEMENT,
    PERIOD,
    PHILLIPS_CONSTANT,
    SIGNIFICANT_WAVE_HEIGHT,
    WIND_SPEED,
    keep_checked,
)
from fftocean.physics.dispersion import group_to_phase_speed, wavenumber
from fftocean.physics.moments import moment
from fftocean.physics.water import statements


@runtime_checkable
class FrequencySpectrum(Protocol):
    """
    Maps angular frequency [rad/s] to variance density S(omega) [m^2 s/rad], same shape; 0 where
    omega <= 0.
    """

    @property
    def peak(self) -> float:
        """The angular frequency of the spectral peak, omega_p [rad/s]."""

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`."""


def require_spectrum(name: str, value: object) -> None:
    """
    Refuse what is not a spectrum.

    Raises:
        ParameterError: not callable, without a peak, or a spectrum's class where a spectrum is
            wanted.
    """
    if isinstance(value, type) or not isinstance(value, FrequencySpectrum):
        raise ParameterError(
            f"{name} must be callable and have a peak (wrap a plain function: CustomSpectrum(f, peak=...)), got {described(value)}"
        )
    PEAK.check(f"{name}.peak", value.peak)


FULLY_DEVELOPED_PEAK = 0.877 / 1.026
"""
omega_p U10 / g of a sea that has stopped growing: 0.877 against U19.5 = 1.026 U10  (Pierson &
Moskowitz 1964).
"""

STILL_AIR = 1e-3
"""
Below this wind [m/s] no wave is raised: far less than the 0.2 m/s that the first ripples need
(Kawai 1979).
"""


def _relative(omega: RealLike, peak: float) -> Real:
    """
    omega/omega_p, held at 0.05 from below: there exp(-5/4 x^-4) is 0 in double precision, and x^-5
    does not overflow; nor does x.
    """
    return np.minimum(np.maximum(np.asarray(omega, dtype=np.float64), 0.05 * peak), 1e100) / peak


@dataclass(frozen=True, slots=True)
class PiersonMoskowitz:
    """
    S = alpha g^2 omega^-5 exp(-5/4 (omega_p/omega)^4), the fully developed sea  (Pierson &
    Moskowitz 1964).
    """

    peak: float  # omega_p [rad/s]
    alpha: float = 8.1e-3  # Phillips constant [-]

    def __post_init__(self) -> None:
        keep_checked(self, peak=PEAK, alpha=PHILLIPS_CONSTANT)

    @classmethod
    def from_wind(cls, *, speed: float) -> "PiersonMoskowitz":
        """
        Fully developed sea under a wind of `speed` (U10) [m/s]: omega_p = 0.877 g / (1.026 U10).
        """
        speed = checked_wind(speed)
        return cls(
            peak=FULLY_DEVELOPED_PEAK * GRAVITY / max(speed, STILL_AIR),
            alpha=8.1e-3 if speed else 0.0,
        )

    @classmethod
    def from_sea_state(cls, *, hs: float, tp: float) -> "PiersonMoskowitz":
        """
        Sea of significant wave height `hs` [m] and peak period `tp` [s]: alpha follows from m0 =
        alpha g^2 / (5 omega_p^4).
        """
        tp = PERIOD.check("tp", tp)
        return cls(peak=2.0 * np.pi / tp, alpha=_alpha(hs, tp, 0.2))

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        x = _relative(omega, self.peak)
        s: Real = self.alpha * GRAVITY**2 * self.peak**-5 * x**-5 * np.exp(-1.25 * x**-4)
        return s


@dataclass(frozen=True, slots=True)
class JONSWAP:
    """
    A Pierson-Moskowitz sea with its peak raised by gamma^r  (Hasselmann et al. 1973).

    r = exp(-(omega - omega_p)^2 / (2 sigma^2 omega_p^2)), sigma = 0.07 up to the peak and 0.09
    beyond.
    """

    peak: float  # omega_p [rad/s]
    alpha: float = 8.1e-3  # Phillips constant [-]
    gamma: float = 3.3  # peak enhancement [-]

    def __post_init__(self) -> None:
        keep_checked(self, peak=PEAK, alpha=PHILLIPS_CONSTANT, gamma=PEAK_ENHANCEMENT)

    @classmethod
    def from_wind(cls, *, speed: float, fetch: float, gamma: float = 3.3) -> "JONSWAP":
        """
        Sea raised by a wind of `speed` (U10) [m/s] over `fetch` [m].

        The laws of the JONSWAP experiment, alpha = 0.076 (U^2/gF)^0.22 and omega_p = 22
        (g^2/UF)^(1/3), let a sea grow for ever. Here it grows by them until its energy is 99 % of
        the fully developed sea's; from there on what is missing of that energy falls as 1/F, the
        peak goes on falling by its law to the fully developed one, and gamma relaxes to 1 over the
        same stretch: the limit of a long fetch *is* Pierson-Moskowitz, never passed, and Hs(F) only
        rises.

        Args:
            speed: wind speed 10 m above the sea [m/s]; 0 is an exactly flat sea, with a warning
                that says so.
            fetch: distance over which the wind blows [m].
            gamma: peak enhancement of the growing sea [-].

        Raises:
            ParameterError: a value out of its range (`limits.WIND_SPEED`, `limits.FETCH`,
                `limits.PEAK_ENHANCEMENT`).

        Source: Hasselmann et al. 1973; the limit from Pierson & Moskowitz 1964.
        """
        speed = checked_wind(speed)
        fetch = FETCH.check("fetch", fetch)
        warn_of_short_fetch(speed, fetch)
        return fetch_limited(speed, fetch, PEAK_ENHANCEMENT.check("gamma", gamma))

    @classmethod
    def from_sea_state(cls, *, hs: float, tp: float, gamma: float = 3.3) -> "JONSWAP":
        """
        Sea of significant wave height `hs` [m] and peak period `tp` [s], normalised exactly: 4
        sqrt(m0) is `hs`.

        Raises:
            ParameterError: a value out of its range, or waves too steep to be (alpha > 1).
        """
        tp = PERIOD.check("tp", tp)
        gamma = PEAK_ENHANCEMENT.check("gamma", gamma)
        return cls(peak=2.0 * np.pi / tp, alpha=_alpha(hs, tp, _shape_integral(gamma)), gamma=gamma)

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        x = _relative(omega, self.peak)
        sigma = np.where(x <= 1.0, 0.07, 0.09)
        r = np.exp(-((x - 1.0) ** 2) / (2.0 * sigma**2))
        s: Real = (
            self.alpha * GRAVITY**2 * self.peak**-5 * x**-5 * np.exp(-1.25 * x**-4) * self.gamma**r
        )
        return s


SHORTEST_FETCH = 100.0
"""
g F/U^2 below which a sea is hardly ever meant: the JONSWAP experiment measured from 100 on
(Hasselmann et al. 1973).
"""


def warn_of_short_fetch(speed: float, fetch: float) -> None:
    """Warn of a fetch that is so short that it may be in another unit than metres."""
    least = SHORTEST_FETCH * speed**2 / GRAVITY
    if fetch < least:
        warnings.warn(
            f"a fetch of {fetch:g} m is very short for a wind of {speed:g} m/s: g F/U^2 is "
            f"{SHORTEST_FETCH * fetch / least:.3g}, and growth was measured from {SHORTEST_FETCH:g} ({least:.4g} m) on; "
            "fetch is in metres: 200 km is 200e3",
            SeaWarning,
            stacklevel=4,
        )


def fetch_limited(speed: float, fetch: float, gamma: float) -> JONSWAP:
    """Return the sea of `JONSWAP.from_wind`, whose arguments these are, checked."""
    wind = max(speed, STILL_AIR)
    x = GRAVITY * fetch / wind**2  # dimensionless fetch
    # Dimensionless, with u = omega_p U/g and e = g^2 m0 / U^4:  e = alpha J(gamma) / u^4.
    limit = 8.1e-3 * 0.2 / FULLY_DEVELOPED_PEAK**4
    growth = 0.076 * _shape_integral(gamma) / 22.0**4
    nearly = (0.99 * limit / growth) ** (
        1.0 / (4.0 / 3.0 - 0.22)
    )  # fetch at which e is 99 % of its limit
    mature = (22.0 / FULLY_DEVELOPED_PEAK) ** 3  # fetch at which the peak is that of the limit
    u = max(22.0 * x ** (-1.0 / 3.0), FULLY_DEVELOPED_PEAK)
    alpha = 0.076 * x**-0.22
    if x > nearly:
        age = min((x - nearly) / (mature - nearly), 1.0)
        gamma = gamma ** (1.0 - age)
        alpha = limit * (1.0 - 0.01 * nearly / x) * u**4 / _shape_integral(gamma)
    return JONSWAP(peak=u * GRAVITY / wind, alpha=min(alpha, 1.0) if speed else 0.0, gamma=gamma)


@dataclass(frozen=True, slots=True)
class TMA:
    """
    A deep-water spectrum carried into water of finite depth: S = S_deep Phi  (Kitaigorodskii et al.
    1975; Bouws et al. 1985).

    Phi = tanh^2(kh) / (1 + 2kh / sinh 2kh), with the true k(omega, h): no fit, no branches.
    `spectrum` is the sea as it would be in deep water, so `TMA(JONSWAP.from_sea_state(hs=3, tp=9),
    depth=10)` has *less* than 3 m of waves; `TMA.from_sea_state(hs=3, tp=9, depth=10)` has 3 m in
    that depth.
    """

    spectrum: FrequencySpectrum  # in deep water
    depth: float  # [m]

    def __post_init__(self) -> None:
        require_spectrum("spectrum", self.spectrum)
        keep_checked(self, depth=DEPTH)
        for statement in statements("depth", "spectrum", self.spectrum):
            if statement.value != math.inf:
                raise ParameterError(
                    f"spectrum must be one of deep water, which TMA carries into {self.depth:g} m, got {statement} of {statement.value:g} m"
                )

    @classmethod
    def from_sea_state(cls, *, hs: float, tp: float, depth: float, gamma: float = 3.3) -> "TMA":
        """
        Sea whose significant wave height *in water of `depth`* is `hs` [m]; `tp` [s] and `gamma`
        are those of the deep-water JONSWAP.

        Raises:
            ParameterError: a value out of its range, or waves too steep to be.
        """
        hs = SIGNIFICANT_WAVE_HEIGHT.check("hs", hs)
        unit = cls(
            JONSWAP(
                peak=2.0 * np.pi / PERIOD.check("tp", tp),
                alpha=1.0,
                gamma=PEAK_ENHANCEMENT.check("gamma", gamma),
            ),
            depth,
        )
        m0 = moment(unit, 0)
        alpha = (hs / 4.0) ** 2 / m0 if hs else 0.0
        if not alpha <= 1.0:
            raise ParameterError(_too_steep(hs, tp, alpha) + f" in {depth:g} m of water")
        return cls(replace(unit.spectrum, alpha=alpha), depth)  # type: ignore[type-var]

    @property
    def peak(self) -> float:
        """omega_p of the deep-water spectrum [rad/s], by which spreading models scale."""
        return self.spectrum.peak

    @property
    def breaks(self) -> tuple[float, ...]:
        """The frequencies where the deep-water spectrum bends sharply [rad/s]."""
        return getattr(self.spectrum, "breaks", ())

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return self.spectrum(omega) * kitaigorodskii(omega, self.depth)

    def at_waves(self, omega: RealLike, k: Real) -> Real:
        """
        Return S at `omega` where the wavenumbers `k` [rad/m] of gravity waves in this depth are
        known, [m^2 s/rad].
        """
        return self.spectrum(omega) * _kitaigorodskii_at(k, self.depth)


def kitaigorodskii(omega: RealLike, depth: float) -> Real:
    """
    Return Phi(omega, h) [-], from omega^2 h / (2g) in shallow water to 1 in deep  (Kitaigorodskii
    et al. 1975).
    """
    omega = np.clip(
        np.asarray(omega, dtype=np.float64), 0.0, 1e20
    )  # deep in a micrometre; and inf is not a frequency
    return _kitaigorodskii_at(wavenumber(omega, depth), depth)


def _kitaigorodskii_at(k: Real, depth: float) -> Real:
    """Return Phi [-] at wavenumbers [rad/m]."""
    if math.isinf(depth):
        return np.ones_like(k)
    phi: Real = np.tanh(np.minimum(k, 20.0 / depth) * depth) ** 2 / (
        2.0 * group_to_phase_speed(k, depth)
    )
    return phi


@dataclass(frozen=True, slots=True)
class CustomSpectrum:
    """
    Any function of omega, named by its peak. It must return finite values >= 0 of the same shape.
    """

    function: Callable[[Real], RealLike]  # S(omega) [m^2 s/rad]
    peak: float  # omega_p [rad/s]

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise ParameterError(
                f"function must be callable as function(omega), got {self.function!r:.60}"
            )
        keep_checked(self, peak=PEAK)

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]; 0 where omega <= 0, where the function is not asked."""
        omega = np.asarray(omega, dtype=np.float64)
        asked = np.where(omega > 0.0, omega, self.peak)
        try:
            values = np.asarray(self.function(asked))
        except (TypeError, ValueError):  # written for one number, with math.exp or an if
            values = np.vectorize(self.function, otypes=[np.float64])(asked)
        if values.dtype.kind not in "iuf":
            raise ParameterError(
                f"the custom spectrum must return real numbers, got {values!r:.60}"
            )
        if values.shape not in (omega.shape, ()):
            raise ParameterError(
                f"the custom spectrum must return the shape it is given, {omega.shape}, got {values.shape}"
            )
        bad = ~((values >= 0.0) & (values < np.inf))
        if np.any(bad):
            raise ParameterError(
                f"the custom spectrum must be finite and at least 0 m^2 s/rad, got {values[bad].flat[0]}"
            )
        return np.where(omega > 0.0, values, 0.0)


@dataclass(frozen=True, slots=True)
class TabulatedSpectrum:
    """
    A measured spectrum S(f): straight lines between the points, nothing outside them.

    Frequencies in Hz and densities in m^2/Hz, as buoys report them; the call takes and gives omega
    like any other spectrum. With a `depth` it states that of the water in which it was measured,
    which a `Sea` then has.
    """

    frequency: Sequence[float]  # f [Hz], strictly ascending, > 0
    density: Sequence[float]  # S(f) [m^2/Hz], >= 0
    depth: float | None = field(default=None, kw_only=True)  # [m]; None states none
    _omega: Real = field(init=False, repr=False, compare=False)
    _s: Real = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        f = FREQUENCY.check_array("frequency", self.frequency, ndim=1, ascending=True)
        s = DENSITY.check_array("density", self.density, ndim=1)
        if f.size < 2 or f.size != s.size:
            raise ParameterError(
                "frequency and density must have the same length, at least 2, "
                f"got {f.size} and {s.size}"
            )
        if self.depth is not None:
            keep_checked(self, depth=DEPTH)
        object.__setattr__(self, "frequency", tuple(f.tolist()))
        object.__setattr__(self, "density", tuple(s.tolist()))
        object.__setattr__(self, "_omega", 2.0 * np.pi * f)
        object.__setattr__(self, "_s", s / (2.0 * np.pi))

    def __repr__(self) -> str:
        f = self.frequency
        depth = "" if self.depth is None else f", depth={self.depth:g}"
        return f"TabulatedSpectrum({len(f)} frequencies, {f[0]:g} to {f[-1]:g} Hz, peak at {self.peak / (2.0 * math.pi):g} Hz{depth})"

    @property
    def peak(self) -> float:
        """The tabulated frequency with the highest density, as omega_p [rad/s]."""
        return float(self._omega[np.argmax(self._s)])

    @property
    def breaks(self) -> tuple[float, ...]:
        """The tabulated frequencies as omega [rad/s]: where the straight lines meet."""
        return tuple(self._omega.tolist())

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return np.interp(
            np.asarray(omega, dtype=np.float64), self._omega, self._s, left=0.0, right=0.0
        )


def checked_wind(speed: float) -> float:
    """Check a wind speed; still air is 0, and says what it means."""
    speed = WIND_SPEED.check("speed", speed)
    if speed >= STILL_AIR:
        return speed
    warnings.warn(
        f"wind speed {speed:g} m/s raises no waves: the sea is exactly flat",
        SeaWarning,
        stacklevel=3,
    )
    return 0.0


@lru_cache(maxsize=256)
def _shape_integral(gamma: float) -> float:
    """
    J(gamma) = m0 omega_p^4 / (alpha g^2): 1/5 for gamma = 1, then growing.

    It is 1/5 plus the integral of what the peak adds to Pierson-Moskowitz, x^-5 exp(-5/4 x^-4)
    (gamma^r - 1): smooth on either side, and nothing (1e-17) nine sigma away. `moment` would say
    the same, and load half of SciPy before the first frame.
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    from_peak = 4.5 * (1.0 + nodes)  # in sigma
    raised = np.expm1(np.log(gamma) * np.exp(-0.5 * from_peak**2))
    sides = [(sigma, 1.0 + side * sigma * from_peak) for sigma, side in ((0.07, -1.0), (0.09, 1.0))]
    return 0.2 + sum(
        4.5 * sigma * float(np.sum(weights * raised * x**-5 * np.exp(-1.25 * x**-4)))
        for sigma, x in sides
    )


def _alpha(hs: float, tp: float, shape_integral: float) -> float:
    """The Phillips constant that makes m0 = hs^2/16."""
    hs = SIGNIFICANT_WAVE_HEIGHT.check("hs", hs)
    alpha = (hs / 4.0) ** 2 * (2.0 * np.pi / tp) ** 4 / (GRAVITY**2 * shape_integral)
    if not alpha <= 1.0:
        raise ParameterError(_too_steep(hs, tp, alpha))
    return float(alpha)


def _too_steep(hs: float, tp: float, alpha: float) -> str:
    return f"hs and tp must make waves that can be (Phillips constant at most 1), got {hs:g} m with {tp:g} s (alpha = {alpha:.3g})"
