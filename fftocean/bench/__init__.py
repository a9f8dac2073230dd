"""
What a frame costs, measured: the machine, contenders that take turns, fits, pictures. `fftocean
bench` and `benchmarks/` run on it.
"""

from fftocean.bench.command import main as main

__all__ = ["main"]
