"""Physical constants of water waves, in SI."""

from typing import Final

GRAVITY: Final = 9.80665
"""Standard gravity [m/s^2] (CGPM 1901)."""

WATER_DENSITY: Final = 1025.0
"""Sea water at 35 g/kg and 15 degrees C, rounded [kg/m^3] (TEOS-10 gives 1026)."""

SURFACE_TENSION: Final = 0.074
"""Sea water against air at 15 degrees C, rounded [N/m] (Nayar et al. 2014)."""
