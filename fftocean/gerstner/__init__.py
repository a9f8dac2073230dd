"""The sea summed wave by wave: the slow truth, and the classic few-wave models. Shares no code with the fast path."""

from fftocean.gerstner.direct import Surface as Surface
from fftocean.gerstner.direct import surface as surface

__all__ = ["Surface", "surface"]
