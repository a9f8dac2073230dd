"""
Foam of preview images: at one time, or from one frame of a loop to the next.

The model is that of `fftocean.foam`, in steps as coarse as an image allows. Its input is the sum of
the tiles' displacement gradients, as waves break where the sum folds.
"""

import math
from collections.abc import Sequence

import numpy as np

from fftocean.arrays import Real
from fftocean.fields import DISPLACEMENT_GRADIENT
from fftocean.foam import Foam
from fftocean.foam_coverage import whitecap_coverage
from fftocean.kernels import interpolate, surface
from fftocean.ocean import Frame

SIDE = 256
"""Texels along each side of the foam's pattern, at most, for one tile."""
SIDE_OF_SUM = 384
"""The same for a sum of tiles: the smaller ones are sampled over the largest."""
MEMORY, STEPS = 3.0, 42
"""Decay times that foam is followed for before the first image, and number of steps."""
_CALIBRATED = 4096  # points that the threshold is found from


def whitecap_cover(wind: float) -> float:
    """
    Return the share of the sea that whitecaps cover at a wind speed [m/s].

    The law is that of `foam_coverage`, from winds up to 17 m/s; here it is not continued above 20
    m/s, and no waves break below 3.7 m/s.
    """
    return 0.0 if wind < 3.7 else whitecap_coverage(min(wind, 20.0))


def minimum_eigenvalue(frames: Frame | Sequence[Frame]) -> Real:
    """
    Return the smallest eigenvalue of the deformation gradient of summed tiles, over the first one.
    """
    tiles = (frames,) if isinstance(frames, Frame) else tuple(frames)
    grid, several = tiles[0].grid, len(tiles) > 1
    nx, ny = (min(n, SIDE) for n in (grid.nx, grid.ny))
    if several:
        nx = ny = SIDE_OF_SUM
    x = np.broadcast_to(np.arange(nx) * (grid.lx / nx), (ny, nx)).ravel()
    y = np.broadcast_to((np.arange(ny) * (grid.ly / ny))[:, None], (ny, nx)).ravel()
    total = np.zeros((ny * nx, len(DISPLACEMENT_GRADIENT)))
    for tile in tiles:
        g = tile.grid
        texels = np.stack([tile[name] for name in DISPLACEMENT_GRADIENT], axis=-1)
        interpolate.bilinear(texels, x * (g.nx / g.lx), y * (g.ny / g.ly), total)
    xx, xy, yy = (np.ascontiguousarray(total[:, i].reshape(ny, nx)) for i in range(3))
    out = np.empty((ny, nx))
    surface.minimum_eigenvalue(xx, xy, yy, tiles[0].choppiness, out)
    return out


class Whitecaps:
    """Foam of a sea in rising order of time: `add` advances it, `coverage` is its visible share."""

    def __init__(self, foam: Foam) -> None:
        self.foam = foam
        self._state: Real | None = None

    @classmethod
    def before(
        cls, moments: Sequence[Real], step: float, foam: Foam, cover: float | None = None
    ) -> "Whitecaps":
        """
        Return the foam that has accumulated over some moments.

        Args:
            moments: the `minimum_eigenvalue` at equal steps of time.
            step: from one to the next [s].
            foam: parameters of foam.
            cover: share of the surface to cover; the threshold is found for it. None keeps the
                threshold of `foam`.
        """
        if cover is not None:
            foam = calibrated(moments, step, foam, cover)
        self = cls(foam)
        for values in moments:
            self.add(values, step)
        return self

    def add(self, values: Real, step: float) -> None:
        """Decay over a step [s], and add the foam that the eigenvalue at its end makes."""
        if self._state is None:
            self._state = np.zeros(values.shape)
        self._state *= math.exp(-step / self.foam.tau)
        made = np.maximum(self.foam.threshold - values, 0.0)
        self._state += (self.foam.strength * step) * made

    @property
    def coverage(self) -> Real:
        """Share of the surface that is covered, (ny, nx) in 0..1."""
        assert self._state is not None  # something was added
        result: Real = -np.expm1(-self._state)
        return result


def calibrated(moments: Sequence[Real], step: float, foam: Foam, cover: float) -> Foam:
    """Return foam with the threshold at which it covers a share after some moments."""
    stride = max(1, math.ceil(moments[0].size / _CALIBRATED))
    values = np.stack([m.ravel()[::stride] for m in moments])
    ages = step * np.arange(len(moments))[::-1, None]
    weights = foam.strength * step * np.exp(-ages / foam.tau)
    low, high = 0.0, 1.0
    for _ in range(24):
        middle = 0.5 * (low + high)
        state = np.sum(weights * np.maximum(middle - values, 0.0), axis=0)
        if np.mean(-np.expm1(-state)) < cover:
            low = middle
        else:
            high = middle
    return Foam(tau=foam.tau, threshold=low, strength=foam.strength)
