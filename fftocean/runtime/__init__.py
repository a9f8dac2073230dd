"""
Run-time package: the waves of a sea, for programs that evolve and transform them.

`pack` makes one of an ocean or a cascade, `to_bytes` one run of bytes for a socket or a page.
docs/runtime.md has every byte.
"""

from fftocean.runtime.container import to_bytes
from fftocean.runtime.package import SeaPackage, pack
from fftocean.runtime.planes import amplitude_planes, waves_from_planes
from fftocean.runtime.source import Source

__all__ = ["SeaPackage", "Source", "amplitude_planes", "pack", "to_bytes", "waves_from_planes"]
