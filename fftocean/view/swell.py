"""
Swell of a distant storm, as a table of a job.

The sea under the storm's wind is fully developed (Pierson & Moskowitz 1964); its peak period is
that of the swell, and a share of its height is left. Swell is narrow in frequency and in direction:
a peak enhancement of 7, and cos^2s with s = 25 (Goda 2010 has s_max = 25 for
swell of short decay).
"""

import math
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from fftocean.constants import GRAVITY
from fftocean.physics.spectra import FULLY_DEVELOPED_PEAK, PiersonMoskowitz

PEAK_ENHANCEMENT: Final = 7.0
SPREADING: Final = {"kind": "cosine-power", "s": 25.0}


class Swell(NamedTuple):
    """Swell by the wind of its storm."""

    speed: float  # U10 of the storm [m/s]
    share: float  # of the storm's wave height that is left [-]
    direction: float  # toward which it runs, counter-clockwise from east [degrees]


def storm_height(speed: float) -> float:
    """
    Return Hs of the fully developed sea under a wind [m]: m0 = alpha g^2 / (5 omega_p^4).

    Source: Pierson & Moskowitz 1964.
    """
    storm = PiersonMoskowitz(peak=FULLY_DEVELOPED_PEAK * GRAVITY / speed)
    return 4.0 * math.sqrt(storm.alpha * GRAVITY**2 / (5.0 * storm.peak**4))


def table_of(swell: Swell) -> dict[str, Any]:
    """Return the table of [[sea.systems]] of a swell, whose wind is above 0."""
    period = 2.0 * math.pi * swell.speed / (FULLY_DEVELOPED_PEAK * GRAVITY)
    return {
        "spectrum": {
            "kind": "tma",
            "spectrum": {
                "kind": "jonswap",
                "hs": _rounded(swell.share * storm_height(swell.speed), 9),
                "tp": _rounded(period, 9),
                "gamma": PEAK_ENHANCEMENT,
            },
        },
        "spreading": dict(SPREADING),
        "direction": swell.direction,
    }


def swell_of(table: Mapping[str, Any]) -> Swell | None:
    """Return the swell of which `table_of` made a table; None for any other table."""
    try:
        deep = table["spectrum"]["spectrum"]
        speed = _rounded(deep["tp"] * FULLY_DEVELOPED_PEAK * GRAVITY / (2.0 * math.pi), 6)
        share = _rounded(deep["hs"] / storm_height(speed), 6)
        swell = Swell(speed, share, float(table["direction"]))
        return swell if table_of(swell) == table else None
    except (KeyError, TypeError, ValueError, ZeroDivisionError, OverflowError):
        return None


def _rounded(value: float, digits: int) -> float:
    """Return a number rounded to significant digits, so that text and back is exact."""
    return float(f"{value:.{digits}g}")
