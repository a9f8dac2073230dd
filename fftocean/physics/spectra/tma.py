"""TMA spectrum of finite depth, a deep-water spectrum times the Kitaigorodskii factor."""

import math
from dataclasses import dataclass, replace

import numpy as np

from fftocean.arrays import Real, RealLike
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
from fftocean.physics.spectra.jonswap import JONSWAP
from fftocean.physics.spectra.kitaigorodskii import kitaigorodskii, kitaigorodskii_at
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
    """

    spectrum: FrequencySpectrum  # in deep water
    depth: float  # [m]

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
    def from_sea_state(cls, *, hs: float, tp: float, depth: float, gamma: float = 3.3) -> "TMA":
        """
        Return the sea whose significant wave height *in water of `depth`* is `hs` [m]; `tp` [s] and
        `gamma` are those of the deep-water JONSWAP.

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
        known, [m^2 s/rad].
        """
        return self.spectrum(omega) * kitaigorodskii_at(k, self.depth)


def _from_wind(*, speed: float, fetch: float, depth: float, gamma: float = 3.3) -> TMA:
    """Return the fetch-limited sea in water of finite depth."""
    return TMA(JONSWAP.from_wind(speed=speed, fetch=fetch, gamma=gamma), depth)


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
    Way(_from_wind, water=("depth",), speed=WIND_SPEED, fetch=FETCH, gamma=PEAK_ENHANCEMENT),
    Way(TMA, water=("depth",), spectrum=Part("spectrum")),
)
