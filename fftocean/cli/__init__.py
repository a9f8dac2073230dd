"""Command line: `fftocean bake | check | info | verify | bench | plot | presets | view`."""

from fftocean.cli.entry_point import main as main

__all__ = ["main"]
