"""
Run-time package: the waves of a sea, for programs that evolve and transform them.

`pack` makes one of an ocean or a cascade; `to_bytes` and `from_bytes` make one run of bytes of it,
for a socket or a page; `ocean_of` makes the ocean or cascade again. `folder` has the files, and
docs/runtime.md every byte.
"""

from fftocean.runtime.container import from_bytes, to_bytes
from fftocean.runtime.decode import ocean_of
from fftocean.runtime.package import SeaPackage, pack
from fftocean.runtime.planes import amplitude_planes, waves_from_planes
from fftocean.runtime.source import Source

__all__ = [
    "SeaPackage",
    "Source",
    "amplitude_planes",
    "from_bytes",
    "ocean_of",
    "pack",
    "to_bytes",
    "waves_from_planes",
]
