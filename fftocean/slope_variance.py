"""
Variance of the sea's slopes: that of the waves of some tiles, that of a wind, and the rest.

A picture of the sea needs the slopes of all its waves, down to ripples of millimetres, for the
width of the sun's glitter. Tiles hold a part of them; what they leave to the wind's total is beyond
them.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError, described
from fftocean.limits import DIRECTION, WIND_SPEED
from fftocean.ocean import Ocean

Symmetric = tuple[float, float, float]
"""The entries xx, yy and xy of a symmetric matrix."""

FLOOR = 2e-3
"""Least slope variance beyond the tiles, in every direction [-]."""


@dataclass(frozen=True, slots=True)
class SlopeVariance:
    """Covariances (xx, yy, xy) of the slopes d height/dx and d height/dy [-]."""

    captured: Symmetric  # of the waves of the tiles, the mean over seeds
    total: Symmetric  # of all waves under the wind
    beyond: Symmetric  # of the waves that the tiles leave out; positive definite
    raised: bool  # True if `beyond` is more than total - captured, to be positive definite


def slope_variance(
    source: Cascade | Ocean, *, wind_speed: float | None = None, wind_direction: float = 0.0
) -> SlopeVariance:
    """
    Return the slope variance of some tiles, that of the sea under a wind, and their difference.

    Args:
        source: the tiles; choppiness is not applied.
        wind_speed: 10 m above the sea [m/s]; None if it is not known: `total` is then `captured`
            and `FLOOR` in every direction.
        wind_direction: toward which the wind blows, counter-clockwise from +x [degrees].

    Returns:
        `SlopeVariance`, with captured + beyond = total unless `raised`: the variance beyond the
        tiles is at least `FLOOR` in every direction.

    Raises:
        ParameterError: no cascade or ocean, or a value out of range.

    Pinned by tests/test_slope_variance.py, against frames and integrals of the spectrum.
    """
    return beyond_tiles(captured_by(source), wind_speed, wind_direction)


def beyond_tiles(
    captured: Symmetric, wind_speed: float | None, wind_direction: float = 0.0
) -> SlopeVariance:
    """
    Return the slope variance of the sea under a wind, and beyond tiles that have `captured` of it.

    Arguments as of `slope_variance`.
    """
    floor = FLOOR, FLOOR, 0.0
    if wind_speed is None:
        return SlopeVariance(captured, _sum(captured, floor), floor, raised=False)
    total = cox_munk(wind_speed, wind_direction)
    rest = _sum(total, captured, -1.0)
    values, vectors = np.linalg.eigh(np.array([[rest[0], rest[2]], [rest[2], rest[1]]]))
    if values[0] >= FLOOR:
        return SlopeVariance(captured, total, rest, raised=False)
    raised: Real = (vectors * np.maximum(values, FLOOR)) @ vectors.T
    beyond = float(raised[0, 0]), float(raised[1, 1]), float(raised[0, 1])
    return SlopeVariance(captured, total, beyond, raised=True)


def captured_by(source: Cascade | Ocean) -> Symmetric:
    """
    Return the slope variance of the waves of some tiles, the mean over seeds: the sum of E_k k k^T.
    """
    if not isinstance(source, (Cascade, Ocean)):
        raise ParameterError(f"source must be a Cascade or an Ocean, got {described(source)}")
    oceans = source.oceans if isinstance(source, Cascade) else (source,)
    return captured_by_tiles([ocean.amplitudes for ocean in oceans])


def captured_by_tiles(tiles: Iterable[Amplitudes]) -> Symmetric:
    """Return the slope variance of the waves of some tiles; see `captured_by`."""
    xx = yy = xy = 0.0
    for a in tiles:
        grid = a.grid
        variance = a.variance_forward.copy()
        variance[:, 1:] += a.variance_backward[:, 1:]  # the column mx = 0 holds both k and -k
        xx += float(np.sum(variance, axis=0) @ grid.kx**2)
        yy += float(np.sum(variance, axis=1) @ grid.ky**2)
        xy += float(grid.ky @ variance @ grid.kx)
    return xx, yy, xy


def cox_munk(wind_speed: float, wind_direction: float = 0.0) -> Symmetric:
    """
    Return the slope variance of a clean sea under a wind: 0.00316 U along it, 0.003 + 0.00192 U
    across.

    Args:
        wind_speed: U [m/s], 12.5 m above the sea in the source; that at 10 m is 2 % less.
        wind_direction: toward which the wind blows, counter-clockwise from +x [degrees].

    Source: Cox & Munk, Measurement of the roughness of the sea surface from photographs of the
    sun's glitter, J. Opt. Soc. Am. 44 (1954), 838-850.
    """
    speed = WIND_SPEED.check("wind_speed", wind_speed)
    angle = math.radians(DIRECTION.check("wind_direction", wind_direction) % 360.0)
    cosine, sine = math.cos(angle), math.sin(angle)
    along, across = 0.00316 * speed, 0.003 + 0.00192 * speed
    return (
        along * cosine**2 + across * sine**2,
        along * sine**2 + across * cosine**2,
        (along - across) * cosine * sine,
    )


def _sum(a: Symmetric, b: Symmetric, factor: float = 1.0) -> Symmetric:
    """Return a + factor b."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]
