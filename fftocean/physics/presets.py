"""
Wind seas of the Beaufort scale and of the sea states of WMO code table 3700, each with exactly the
wave height of its number.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

from fftocean.constants import GRAVITY
from fftocean.limits import FETCH, Count
from fftocean.physics.kinds import Way
from fftocean.physics.moments import significant_wave_height
from fftocean.physics.spectra import (
    FULLY_DEVELOPED_PEAK,
    JONSWAP,
    SPECTRA,
    TMA,
    PiersonMoskowitz,
    fetch_limited,
)
from fftocean.physics.units import KNOT

BEAUFORT = Count("", 0, 12)
SEA_STATE = Count("", 0, 9)

# name, mean wind 10 m above the sea from-to [m/s], probable wave height in the open sea [m]
_BEAUFORT: tuple[tuple[str, float, float, float], ...] = (
    ("Calm", 0.0, 0.0, 0.0),  # up to 0.2 m/s
    ("Light air", 0.3, 1.5, 0.1),
    ("Light breeze", 1.6, 3.3, 0.2),
    ("Gentle breeze", 3.4, 5.4, 0.6),
    ("Moderate breeze", 5.5, 7.9, 1.0),
    ("Fresh breeze", 8.0, 10.7, 2.0),
    ("Strong breeze", 10.8, 13.8, 3.0),
    ("Near gale", 13.9, 17.1, 4.0),
    ("Gale", 17.2, 20.7, 5.5),
    ("Strong gale", 20.8, 24.4, 7.0),
    ("Storm", 24.5, 28.4, 9.0),
    ("Violent storm", 28.5, 32.6, 11.5),
    # "32.7 and over", "14 and over": the scale has no middle here, so its beginning is taken
    (
        "Hurricane",
        32.7,
        32.7,
        14.0,
    ),
)

# name, height of well-developed wind waves of the open sea from-to [m]
_SEA_STATES: tuple[tuple[str, float, float], ...] = (
    ("Calm (glassy)", 0.0, 0.0),
    ("Calm (rippled)", 0.0, 0.1),
    ("Smooth (wavelets)", 0.1, 0.5),
    ("Slight", 0.5, 1.25),
    ("Moderate", 1.25, 2.5),
    ("Rough", 2.5, 4.0),
    ("Very rough", 4.0, 6.0),
    ("High", 6.0, 9.0),
    ("Very high", 9.0, 14.0),
    ("Phenomenal", 14.0, 14.0),  # "over 14"
)


@dataclass(frozen=True, slots=True)
class Preset:
    """
    Wind and sea of a number on a scale: the wind, and the sea of exactly `hs` under it. A calm has
    no spectrum.
    """

    number: int
    name: str
    wind: float  # U10 [m/s]
    hs: float  # significant wave height [m]
    tp: float  # peak period [s]; 0 of a calm
    gamma: float  # peak enhancement [-]: 1 is fully developed

    @property
    def wind_knots(self) -> float:
        """U10 [knots]."""
        return self.wind / KNOT

    def spectrum(self, depth: float = math.inf) -> TMA | None:
        """
        Return the spectrum of the sea, whose Hs in water of `depth` [m] is `hs`; None for a calm.

        Raises:
            ParameterError: waves that would be too steep in so little water.
        """
        return (
            TMA.from_sea_state(hs=self.hs, tp=self.tp, depth=depth, gamma=self.gamma)
            if self.hs
            else None
        )

    @property
    def measured_hs(self) -> float:
        """Hs of the spectrum in deep water, by quadrature [m]."""
        spectrum = self.spectrum()
        return significant_wave_height(spectrum) if spectrum else 0.0


def beaufort(number: int) -> Preset:
    """
    Return the open sea of a Beaufort number: the probable wave height of the scale, under the
    middle of its range of winds.

    The wind is the mean 10 m above the sea (U10), as the WMO's ranges are; Pierson and Moskowitz's
    19.5 m is inside `FULLY_DEVELOPED_PEAK`. Where the promised height is less than that of this
    wind's fully developed sea (4, and from 6 up) the sea is young: the JONSWAP sea of the fetch at
    which it is so high. Where it is more (1, 2, 3 and 5: there is old sea about), it is the fully
    developed sea of that height, as a little more wind would raise it.

    Args:
        number: 0 (a flat sea) to 12 (a hurricane's beginning: 32.7 m/s, 14 m).

    Raises:
        ParameterError: a number that is not on the scale.

    Source: winds: WMO-No. 8, Guide to Meteorological Instruments, part I chapter 5, and WMO-No.
    306, code table 1100; probable wave heights: WMO-No. 306, Manual on Codes, as guidance to the
    scale in the open sea.
    """
    number = BEAUFORT.check("number", number)
    name, low, high, hs = _BEAUFORT[number]
    wind = 0.5 * (low + high)
    return Preset(number, name, wind, hs, *_young_or_developed(wind, hs))


def sea_state(number: int) -> Preset:
    """
    Return the sea of a state of WMO code table 3700: the middle of its range of heights, fully
    developed.

    The table's heights "refer to well-developed wind waves of the open sea": so the spectrum is
    Pierson-Moskowitz, under the wind that raises just this height.

    Args:
        number: 0 (glassy: a flat sea) to 9 (phenomenal: over 14 m; 14 m is taken).

    Raises:
        ParameterError: a number that is not in the table.

    Source: WMO-No. 306, Manual on Codes, volume I.1, code table 3700.
    """
    number = SEA_STATE.check("number", number)
    name, low, high = _SEA_STATES[number]
    hs = 0.5 * (low + high)
    wind = _developing_wind(hs)
    return Preset(number, name, wind, hs, *_young_or_developed(wind, hs))


def beaufort_table() -> tuple[Preset, ...]:
    """Return the scale from 0 to 12."""
    return tuple(beaufort(number) for number in range(len(_BEAUFORT)))


def sea_state_table() -> tuple[Preset, ...]:
    """Return code table 3700 from 0 to 9, with the wind that raises each sea."""
    return tuple(sea_state(number) for number in range(len(_SEA_STATES)))


_DEVELOPED_HEIGHT = 4.0 * math.sqrt(8.1e-3 / 5.0) / FULLY_DEVELOPED_PEAK**2
"""g Hs / U10^2 of the Pierson-Moskowitz sea: m0 = alpha g^2 / (5 omega_p^4)."""


def _developing_wind(hs: float) -> float:
    """Return the wind U10 [m/s] of the fully developed sea of `hs` [m]."""
    return math.sqrt(GRAVITY * hs / _DEVELOPED_HEIGHT)


@lru_cache(maxsize=64)
def _young_or_developed(wind: float, hs: float) -> tuple[float, float]:
    """
    Return the peak period [s] and gamma of the sea of `hs` [m] under `wind` [m/s], or of the
    developed sea where the wind is too weak.
    """
    if not hs:
        return 0.0, 1.0
    from scipy.optimize import brentq

    def excess(log_fetch: float) -> float:
        return significant_wave_height(fetch_limited(wind, math.exp(log_fetch), 3.3)) - hs

    longest = math.log(FETCH.high)
    if _developing_wind(hs) >= wind or excess(longest) <= 0.0:
        spectrum: JONSWAP | PiersonMoskowitz = PiersonMoskowitz.from_wind(
            speed=_developing_wind(hs)
        )
    else:
        spectrum = fetch_limited(wind, math.exp(brentq(excess, 0.0, longest, xtol=1e-12)), 3.3)
    return 2.0 * math.pi / spectrum.peak, getattr(spectrum, "gamma", 1.0)


def _beaufort_spectrum(*, number: int, depth: float) -> TMA | None:
    """Return the spectrum of a Beaufort number; None of a calm."""
    return beaufort(number).spectrum(depth)


def _sea_state_spectrum(*, number: int, depth: float) -> TMA | None:
    """Return the spectrum of a sea state; None of a calm."""
    return sea_state(number).spectrum(depth)


SPECTRA.add("beaufort", TMA, Way(_beaufort_spectrum, water=("depth",), number=BEAUFORT))
SPECTRA.add("sea-state", TMA, Way(_sea_state_spectrum, water=("depth",), number=SEA_STATE))
