"""Seas to plot, and the artists of a plot."""

from functools import cache

import matplotlib.text
import numpy as np

import fftocean as fo

SWELL = fo.WaveSystem(
    spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=11.0, gamma=7.0),
    spreading=fo.CosinePower(s=40.0),
    direction=110.0,
)
WIND = fo.WaveSystem(
    spectrum=fo.TMA(fo.JONSWAP.from_wind(speed=12.0, fetch=100e3), depth=12.0), direction=-30.0
)
CROSSED = fo.Sea(WIND, SWELL, depth=12.0)
BRIEF = fo.Sea(
    SWELL,
    fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=6.0), direction=-30.0),
    depth=12.0,
)  # quick to integrate
TABLE = fo.TabulatedSpectrum(
    frequency=(0.05, 0.08, 0.1, 0.15, 0.2, 0.3), density=(0.0, 1.0, 3.0, 1.2, 0.8, 0.1)
)
MEASURED = fo.Sea(fo.WaveSystem(spectrum=TABLE, spreading=fo.CosineSquared(), direction=200.0))
WAVES = [(3, 1, 0.5, 0.2), (-3, -1, 0.3, 1.0), (0, -5, 0.2, 2.0)]


@cache
def plotted(plot, subject):
    """Return a plot of a subject, drawn once for all tests."""
    return plot(subject)


def found(figure, gid):
    """Return the one artist that has this gid."""
    artists = [a for a in figure.findobj() if a.get_gid() == gid]
    assert len(artists) == 1, f"{gid}: {len(artists)}"
    return artists[0]


def words(figure):
    """Return all text of a figure."""
    return "\n".join(a.get_text() for a in figure.findobj(matplotlib.text.Text))


def angular(k, ocean):
    """Return the angular frequency of gravity waves [rad/s]."""
    return np.sqrt(9.80665 * k * np.tanh(k * ocean.depth))
