"""
Direct sum of waves, and the classic few-wave models.

The direct sum is the reference for the fast path and shares no code with it.

The few-wave models (PMS, CWR, steepness waves, the slides' waves, trochoidal waves) keep the
parameter names of the documents that they come from. Each makes a `Waves`, where the geometry is
written once. Errors of the documents are listed in docs/errata.md and corrected here.

Shader documents have y up and z across. Here z is up: their (x, y, z) is our (x, z, y), so a
direction from x toward z is one from x toward y here. That is the same world as Unity's left-handed
frame, and the mirror image of a right-handed one (OpenGL). `WaveSurface.y_up` gives the surface
back in their order.
"""

from fftocean.gerstner.cwr import CWR as CWR
from fftocean.gerstner.direct import Surface as Surface
from fftocean.gerstner.direct import surface as surface
from fftocean.gerstner.headings import direction_of as direction_of
from fftocean.gerstner.pms import PMS as PMS
from fftocean.gerstner.slide_waves import SlideWaves as SlideWaves
from fftocean.gerstner.steepness_waves import SteepnessWaves as SteepnessWaves
from fftocean.gerstner.trochoidal_waves import TrochoidalWaves as TrochoidalWaves
from fftocean.gerstner.waves import Waves as Waves
from fftocean.gerstner.waves import WaveSurface as WaveSurface

__all__ = [
    "CWR",
    "PMS",
    "SlideWaves",
    "SteepnessWaves",
    "Surface",
    "TrochoidalWaves",
    "WaveSurface",
    "Waves",
    "direction_of",
    "surface",
]
