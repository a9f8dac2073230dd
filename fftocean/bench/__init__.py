"""
Benchmarks of frames.

`fftocean bench` and the scripts in `benchmarks/` are built on this package.
"""

from fftocean.bench.command import main as main

__all__ = ["main"]
