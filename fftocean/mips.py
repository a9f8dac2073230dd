"""
Mip chains of maps, down to a single texel.

Each level holds box means of the one before, for any number of samples: level l has max(1, n >> l)
samples a side, as GPUs count them. Every level has the mean of the first, as of a height or of
foam. The covariance of the slopes within each texel holds the roughness that a mean loses, so that
distant water, whose waves are smaller than a texel, stays rough (LEAN mapping: Olano & Baker 2010).
Over any level

    variance of the mean slopes + mean of the covariances = variance of all slopes.
"""

import numpy as np

from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.cells import Cells
from fftocean.grid import Grid
from fftocean.kernels import mips as kernel
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea

SHORTEST = 0.0173
"""
The shortest gravity wave [m]: the wave of least speed, of 363 rad/m in clean water (Lamb 1932, art.
267).
"""


def chain(texels: Real) -> list[Real]:
    """
    Return the levels of a map (ny, nx, channels), of which the first is the map itself.

    Means are computed in float64, and stored in the precision of the map.
    """
    return [texels, *(level.astype(texels.dtype) for level in _chain(texels)[1:])]


def slope_covariances(slope_x: Real, slope_y: Real, unresolved: Real | None = None) -> list[Real]:
    """
    Return the covariance of the slopes within each texel of each level.

    A texel of level 0 is one sample; the covariance within it is that of waves too short for the
    tile.

    Args:
        slope_x, slope_y: (ny, nx) each.
        unresolved: the covariance of the slopes of waves that are not in the tile, (3,), the same
            everywhere; None for none.

    Returns:
        The levels, (rows, columns, 3) each: xx, xy, yy [-].
    """
    x: Real = slope_x.astype(np.float64)
    y: Real = slope_y.astype(np.float64)
    levels = _chain(np.stack([x, y, x * x, x * y, y * y], axis=-1))
    beyond = np.zeros(3) if unresolved is None else np.asarray(unresolved, dtype=np.float64)
    within = []
    for level in levels:
        x, y = np.moveaxis(level[..., :2], -1, 0)
        covariance = level[..., 2:] - np.stack([x * x, x * y, y * y], axis=-1)
        # where all slopes are equal, rounding errors remain
        covariance[..., ::2] = np.maximum(covariance[..., ::2], 0.0)
        within.append((covariance + beyond).astype(slope_x.dtype))
    return within


def normals(
    normal: Real, geometry: tuple[Real, Real, Real, Real, Real], choppiness: float
) -> list[Real]:
    """
    Return the levels of a normal map, (rows, columns, 3): normals of the mean plane in each texel.

    Cross products of the tangents are averaged, whose length is the area, rather than normals of
    length 1. Their sum is normal to the rim of the patch, and its slope is the mean slope, weighted
    with the area seen from above. The last level of a periodic tile points up.

    Args:
        normal: level 0, returned unchanged.
        geometry: slope_x, slope_y, stretch_xx, stretch_xy, stretch_yy, each (ny, nx).
        choppiness: factor on the displacement gradient [-].
    """
    sx, sy, xx, xy, yy = (field.astype(np.float64) for field in geometry)
    a, b, d = 1.0 + choppiness * xx, choppiness * xy, 1.0 + choppiness * yy
    levels = _chain(np.stack([b * sy - sx * d, sx * b - a * sy, a * d - b * b], axis=-1))
    return [normal, *(_unit(level).astype(normal.dtype) for level in levels[1:])]


def unresolved_slopes(ocean: Ocean | Cascade, shortest: float = SHORTEST) -> Real:
    """
    Return the slope covariance of the waves that are too short for an ocean's tile.

    These waves lie beyond the tile's rectangle of wavenumbers, down to `shortest` [m]. They are the
    tail of the sea's spectrum, which falls as k^-3 in the spectra here, so that each octave of
    waves is as rough as the next. An ocean of given waves has none; neither has a tile of a cascade
    whose band ends, as the next tile holds them. A cascade has those of its last tile.

    Returns:
        (3,): xx, xy, yy [-].
    """
    if isinstance(ocean, Cascade):
        ocean = ocean.oceans[-1]
    if ocean.sea is None or np.isfinite(ocean.amplitudes.band[1]):
        return np.zeros(3)
    return beyond(ocean.sea, ocean.grid, shortest)


def beyond(sea: Sea, grid: Grid, shortest: float) -> Real:
    """
    Integrate (kx kx, kx ky, ky ky) S(k) over wavenumbers beyond a tile's, up to 2 pi / shortest.

    The integral along each ray is Simpson's rule.
    """
    highest = 2.0 * np.pi / shortest
    reach_x, reach_y = grid.reach
    total = np.zeros(3)
    for part, theta, weight, edge in Cells(sea, grid.dkx, grid.dky).rays(
        (reach_x + 0.5) * grid.dkx, (reach_y + 0.5) * grid.dky
    ):
        octaves = np.log(np.maximum(highest / edge, 1.0))
        k = edge[:, None] * np.exp(octaves[:, None] * np.linspace(0.0, 1.0, _STEPS + 1))
        steps = (
            np.array([1.0, *[4.0, 2.0] * (_STEPS // 2 - 1), 4.0, 1.0])
            * octaves[:, None]
            / (3.0 * _STEPS)
        )
        # k^2 dk = k^3 d ln k
        rough = part.share * weight * np.sum(steps * k**3 * part.density(k, theta[:, None]), axis=1)
        cosine, sine = np.cos(theta), np.sin(theta)
        total += [np.sum(rough * cosine**2), np.sum(rough * cosine * sine), np.sum(rough * sine**2)]
    return total


_STEPS = 64


def _chain(texels: Real) -> list[Real]:
    """Return the levels in float64."""
    levels: list[Real] = [np.ascontiguousarray(texels, dtype=np.float64)]
    while max(levels[-1].shape[:2]) > 1:
        rows, columns, channels = levels[-1].shape
        half = np.empty((max(1, rows // 2), max(1, columns // 2), channels))
        kernel.halve(levels[-1], half)
        levels.append(half)
    return levels


def _unit(vectors: Real) -> Real:
    """Return the vectors scaled to length 1; a vector of length 0 becomes up."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: Real = np.where(
        length > 0.0, vectors / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0]
    )
    return unit
