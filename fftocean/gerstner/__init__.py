"""The sea summed wave by wave: the slow truth, and the classic few-wave models. Shares no code with the fast path."""

from fftocean.gerstner.direct import Surface as Surface
from fftocean.gerstner.direct import surface as surface
from fftocean.gerstner.wavefields import CWR as CWR
from fftocean.gerstner.wavefields import PMS as PMS
from fftocean.gerstner.wavefields import SlideWaves as SlideWaves
from fftocean.gerstner.wavefields import SteepnessWaves as SteepnessWaves
from fftocean.gerstner.wavefields import TrochoidalWaves as TrochoidalWaves
from fftocean.gerstner.wavefields import Waves as Waves
from fftocean.gerstner.wavefields import WaveSurface as WaveSurface

__all__ = ["CWR", "PMS", "SlideWaves", "SteepnessWaves", "Surface", "TrochoidalWaves", "WaveSurface", "Waves", "surface"]
