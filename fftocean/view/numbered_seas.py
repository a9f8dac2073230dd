"""
Presets of the page: Beaufort numbers and sea states, as a wind and a fetch.

In deep water the sea of this wind and fetch has exactly the significant wave height of its number.
"""

import math
import warnings
from functools import lru_cache
from typing import Any

from fftocean.constants import GRAVITY
from fftocean.errors import SeaWarning
from fftocean.physics import presets
from fftocean.physics.moments import significant_wave_height
from fftocean.physics.presets import Preset
from fftocean.physics.spectra import JONSWAP

LONGEST_FETCH = 5e6  # [m]; every sea is fully developed there


@lru_cache(maxsize=1)
def preset_rows() -> tuple[dict[str, Any], ...]:
    """Return the presets as JSON: scale, number, label, and the parameters that they set."""
    scales = (
        ("beaufort", "Beaufort", presets.beaufort_table()),
        ("sea_state", "Sea state", presets.sea_state_table()),
    )
    return tuple(
        {
            "name": f"{scale}-{preset.number}",
            "scale": title,
            "number": preset.number,
            "label": f"{title} {preset.number}: {preset.name.lower()}",
            "hs": preset.hs,
            "values": {**wind_and_fetch(preset), "swell_speed": 0.0},
        }
        for scale, title, rows in scales
        for preset in rows
    )


def wind_and_fetch(preset: Preset) -> dict[str, float]:
    """
    Return the wind speed [m/s] and the fetch [m] of the JONSWAP sea of a preset's height.

    A young sea has its own wind, and the fetch of its peak: omega_p = 22 (g^2 / U F)^(1/3)
    (Hasselmann et al. 1973). A developed one has the longest fetch, and the wind that raises just
    its height there.
    """
    if not preset.hs:
        return {"wind_speed": 0.0, "fetch": LONGEST_FETCH}
    if preset.gamma > 1.0:
        omega = 2.0 * math.pi / preset.tp
        fetch = GRAVITY**2 / preset.wind * (22.0 / omega) ** 3
        return {"wind_speed": preset.wind, "fetch": fetch}
    return {"wind_speed": _wind_for(preset.hs), "fetch": LONGEST_FETCH}


def _height(speed: float, fetch: float) -> float:
    """Return Hs under a wind over a fetch in deep water [m]."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)
        return significant_wave_height(JONSWAP.from_wind(speed=speed, fetch=fetch))


def _wind_for(hs: float) -> float:
    """Return the wind that raises `hs` [m] over the longest fetch [m/s]."""
    from scipy.optimize import brentq

    return float(brentq(lambda u: _height(u, LONGEST_FETCH) - hs, 0.1, 60.0, xtol=1e-9))
