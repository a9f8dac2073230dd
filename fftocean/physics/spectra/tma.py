"""TMA spectrum of finite depth, a deep-water spectrum times the Kitaigorodskii factor."""

import math
from dataclasses import dataclass, replace

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import (
    DEPTH,
    FETCH,
    PEAK_ENHANCEMENT,
    PERIOD,
    SIGNIFICANT_WAVE_HEIGHT,
    WIND_SPEED,
    keep_checked,
)
from fftocean.physics.kinds import Part, Way
from fftocean.physics.moments import moment
from fftocean.physics.spectra.base import SPECTRA, FrequencySpectrum, require_spectrum, too_steep
from fftocean.physics.spectra.growth import (
    GROWTH,
    in_deep_water,
    in_finite_depth,
    peak_enhancement,
)
from fftocean.physics.spectra.jonswap import JONSWAP, of_wind_sea
from fftocean.physics.spectra.kitaigorodskii import kitaigorodskii, kitaigorodskii_at
from fftocean.physics.spectra.wind import STILL_AIR, checked_wind, warn_of_short_fetch
from fftocean.physics.water import statements


@dataclass(frozen=True, slots=True)
class TMA:
    """
    Deep-water spectrum transformed to water of finite depth: S = S_deep Phi  (Kitaigorodskii et al.
    1975; Bouws et al. 1985).

    Phi = tanh^2(kh) / (1 + 2kh / sinh 2kh), with the true k(omega, h): no fit, no branches.
    `spectrum` is the sea as it would be in deep water, so `TMA(JONSWAP.from_sea_state(hs=3, tp=9),
    depth=10)` has *less* than 3 m of waves; `TMA.from_sea_state(hs=3, tp=9, depth=10)` has 3 m in
    that depth.

    Args:
        spectrum: spectrum of the sea in deep water.
        depth: still-water depth [m].

    Raises:
        ParameterError: a depth out of its range, or a spectrum without a peak.
    """

    spectrum: FrequencySpectrum
    depth: float

    def __post_init__(self) -> None:
        require_spectrum("spectrum", self.spectrum)
        keep_checked(self, depth=DEPTH)
        for statement in statements("depth", "spectrum", self.spectrum):
            if statement.value != math.inf:
                raise ParameterError(
                    f"spectrum must be one of deep water, which TMA carries into {self.depth:g} m, "
                    f"got {statement} of {statement.value:g} m"
                )

    @classmethod
    def from_wind(
        cls,
        *,
        speed: float,
        fetch: float,
        depth: float,
        gamma: float = 3.3,
        growth: str = "jonswap",
    ) -> "TMA":
        """
        Return the sea raised by a wind of `speed` (U10) [m/s] over `fetch` [m] of water of `depth`
        [m]: its energy and its peak are those of Young and Verhagen's growth in finite depth.

        What the fetch does follows from a law for deep water, and what the bed does from Young and
        Verhagen; see `physics.spectra.growth`. In deep water it is `JONSWAP.from_wind`. (That
        spectrum wrapped in a `TMA` is another, higher sea: one that grew in deep water.)

        Args:
            speed: wind speed 10 m above the sea [m/s]; 0 is an exactly flat sea, with a warning
                that says so.
            fetch: distance over which the wind blows [m].
            depth: still-water depth, the same all along the fetch [m].
            gamma: peak enhancement of the growing sea [-].
            growth: law for deep water: "jonswap", "kahma-calkoen" or "young-verhagen".

        Raises:
            ParameterError: a value out of its range, or an unknown law.

        Source: Young & Verhagen, The growth of fetch limited waves in water of finite depth,
        Coastal Engineering 29 (1996), 47-78; the shape: Bouws et al. 1985.
        Pinned by tests/physics/test_growth.py.
        """
        depth = DEPTH.check("depth", depth)
        speed = checked_wind(speed)
        fetch = FETCH.check("fetch", fetch)
        warn_of_short_fetch(speed, fetch)
        gamma = PEAK_ENHANCEMENT.check("gamma", gamma)
        scale = GRAVITY / max(speed, STILL_AIR) ** 2
        deep = in_deep_water(GROWTH.check("growth", growth), scale * fetch, gamma)
        return cls(of_wind_sea(in_finite_depth(deep, scale * depth), speed), depth)

    @classmethod
    def from_sea_state(
        cls, *, hs: float, tp: float, depth: float, gamma: float | None = None
    ) -> "TMA":
        """
        Return the sea whose significant wave height *in water of `depth`* is `hs` [m]; `tp` [s] and
        `gamma` are those of the deep-water JONSWAP.

        Without a `gamma` it is that of DNV-RP-C205 for `hs` and `tp`, as of
        `JONSWAP.from_sea_state`.

        Raises:
            ParameterError: a value out of its range, or waves too steep to be.
        """
        hs, tp = SIGNIFICANT_WAVE_HEIGHT.check("hs", hs), PERIOD.check("tp", tp)
        gamma = (
            peak_enhancement(hs, tp) if gamma is None else PEAK_ENHANCEMENT.check("gamma", gamma)
        )
        unit = cls(JONSWAP(peak=2.0 * np.pi / tp, alpha=1.0, gamma=gamma), depth)
        m0 = moment(unit, 0)
        alpha = (hs / 4.0) ** 2 / m0 if hs else 0.0
        if not alpha <= 1.0:
            raise ParameterError(too_steep(hs, tp, alpha) + f" in {depth:g} m of water")
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
        """Return S at `omega`, [m^2 s/rad]."""
        return self.spectrum(omega) * kitaigorodskii(omega, self.depth)

    def at_waves(self, omega: RealLike, k: Real) -> Real:
        """
        Return S at `omega` where the wavenumbers `k` [rad/m] of gravity waves in this depth are
        known, [m^2 s/rad]; all have one shape.
        """
        return self.spectrum(omega) * kitaigorodskii_at(k, self.depth)


SPECTRA.add(
    "tma",
    TMA,
    Way(
        TMA.from_sea_state,
        water=("depth",),
        hs=SIGNIFICANT_WAVE_HEIGHT,
        tp=PERIOD,
        gamma=PEAK_ENHANCEMENT,
    ),
    Way(
        TMA.from_wind,
        water=("depth",),
        speed=WIND_SPEED,
        fetch=FETCH,
        gamma=PEAK_ENHANCEMENT,
        growth=GROWTH,
    ),
    Way(TMA, water=("depth",), spectrum=Part("spectrum")),
)
