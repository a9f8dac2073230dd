"""Checks of the wind speed and the fetch from which spectra are made."""

import warnings

from fftocean.constants import GRAVITY
from fftocean.errors import SeaWarning
from fftocean.limits import WIND_SPEED

STILL_AIR = 1e-3
"""
Below this wind [m/s] no wave is raised: far less than the 0.2 m/s that the first ripples need
(Kawai 1979).
"""


def checked_wind(speed: float) -> float:
    """Return a checked wind speed; warn of still air and return 0 for it."""
    speed = WIND_SPEED.check("speed", speed)
    if speed >= STILL_AIR:
        return speed
    warnings.warn(
        f"wind speed {speed:g} m/s raises no waves: the sea is exactly flat",
        SeaWarning,
        stacklevel=3,
    )
    return 0.0


SHORTEST_FETCH = 100.0
"""
g F/U^2 below which a sea is hardly ever meant: the JONSWAP experiment measured from 100 on
(Hasselmann et al. 1973).
"""


def warn_of_short_fetch(speed: float, fetch: float) -> None:
    """Warn of a fetch so short that it may be in another unit than metres."""
    least = SHORTEST_FETCH * speed**2 / GRAVITY
    if fetch < least:
        warnings.warn(
            f"a fetch of {fetch:g} m is very short for a wind of {speed:g} m/s: g F/U^2 is "
            f"{SHORTEST_FETCH * fetch / least:.3g}, and growth was measured from "
            f"{SHORTEST_FETCH:g} ({least:.4g} m) on; fetch is in metres: 200 km is 200e3",
            SeaWarning,
            stacklevel=4,
        )
