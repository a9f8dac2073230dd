"""
Compiled direct sum of the eight linear fields, for benchmarks against the FFT.

`direct.surface` is its reference in the tests.
"""

import math

import numba as nb
import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.gerstner.direct import HasWaves

NAMES = (
    "height",
    "displace_x",
    "displace_y",
    "slope_x",
    "slope_y",
    "stretch_xx",
    "stretch_xy",
    "stretch_yy",
)
"""Fields returned by `eight_fields`, in its order."""


def eight_fields(ocean: HasWaves, x0: RealLike, y0: RealLike, t: float) -> dict[str, Real]:
    """
    Sum the eight linear fields wave by wave at points (x0, y0), in float64, on one thread.

    Returns:
        The fields by name, each of the broadcast shape of x0 and y0.

    Raises:
        ParameterError: an ocean with waves of second order, which are not linear in the waves.
    """
    if getattr(ocean, "order", 1) > 1:
        raise ParameterError(
            "eight_fields sums linear waves: give ocean.linear(), or take gerstner.surface, "
            f"got an ocean of order {getattr(ocean, 'order', 1)}"
        )
    px, py = np.broadcast_arrays(np.asarray(x0, dtype=np.float64), np.asarray(y0, dtype=np.float64))
    waves = ocean.modes()
    k = np.hypot(waves.kx, waves.ky)
    potential = (
        waves.amplitude / k
        if math.isinf(ocean.depth)
        else waves.amplitude / (k * np.tanh(k * ocean.depth))
    )
    out = np.zeros((8, px.size))
    _sum(
        px.ravel().copy(),
        py.ravel().copy(),
        waves.kx,
        waves.ky,
        waves.amplitude,
        potential,
        waves.omega * t + waves.phase,
        out,
    )
    return {name: field.reshape(px.shape) for name, field in zip(NAMES, out, strict=True)}


@nb.njit(nogil=True, error_model="numpy")
def _sum(
    x: Real, y: Real, kx: Real, ky: Real, a: Real, potential: Real, start: Real, out: Real
) -> None:
    """
    Write the fields to `out`, (8, points).

    `potential` is a / (k tanh kh), the amplitude of the displacement potential.
    """
    for p in range(x.size):
        h = dx = dy = sx = sy = xx = xy = yy = 0.0
        for m in range(kx.size):
            angle = kx[m] * x[p] + ky[m] * y[p] - start[m]
            c, s = np.cos(angle), np.sin(angle)
            ac, asn, pc, ps = a[m] * c, a[m] * s, potential[m] * c, potential[m] * s
            h += ac
            dx -= kx[m] * ps
            dy -= ky[m] * ps
            sx -= kx[m] * asn
            sy -= ky[m] * asn
            xx -= kx[m] * kx[m] * pc
            xy -= kx[m] * ky[m] * pc
            yy -= ky[m] * ky[m] * pc
        out[0, p] = h
        out[1, p] = dx
        out[2, p] = dy
        out[3, p] = sx
        out[4, p] = sy
        out[5, p] = xx
        out[6, p] = xy
        out[7, p] = yy
