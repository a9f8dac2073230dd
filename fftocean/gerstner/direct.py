"""
Direct sum of all waves of a sea, in float64, at any points of the surface.

This is the reference that the FFT is checked against. It takes the list of waves and nothing else
from the fast path: no transform, no table of signs, no shared formula.
"""

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from fftocean.arrays import Real, RealLike, brief_repr
from fftocean.errors import ParameterError, described
from fftocean.gerstner import bound


class WaveColumns(Protocol):
    """
    A list of waves, each array (m,): height = sum of amplitude cos(kx x + ky y - omega t - phase).
    """

    @property
    def kx(self) -> Real: ...
    @property
    def ky(self) -> Real: ...
    @property
    def amplitude(self) -> Real: ...
    @property
    def phase(self) -> Real: ...
    @property
    def omega(self) -> Real: ...


class HasWaves(Protocol):
    """An `Ocean`, or any object with its waves, depth and choppiness."""

    choppiness: float

    @property
    def depth(self) -> float: ...
    def modes(self) -> WaveColumns: ...


@dataclass(frozen=True, slots=True)
class Surface:
    """
    The water surface at parameters (x0, y0), each field of their shape; float64, SI; names as in
    `Frame`.
    """

    x: Real  # position of the particle: x0 + choppiness displace_x [m]
    y: Real
    z: Real  # height [m]
    height: Real
    displace_x: Real  # before choppiness [m]
    displace_y: Real
    slope_x: Real
    slope_y: Real
    stretch_xx: Real
    stretch_xy: Real
    stretch_yy: Real
    velocity_x: Real  # before choppiness [m/s]
    velocity_y: Real
    velocity_z: Real
    normal: Real  # (..., 3), unit, of the displaced surface
    jacobian: Real

    __repr__ = brief_repr


def surface(ocean: HasWaves, x0: RealLike, y0: RealLike, t: float) -> Surface:
    """
    Return the surface of the sea, summed wave by wave.

    With phase angle f = kx x0 + ky y0 - omega t - phase, each wave of amplitude a gives height a
    cos f, and displaces the water by -a (k/|k|) coth(|k| depth) sin f: the linear Lagrangian
    solution (Gerstner 1802 in deep water; Lamb 1932, art. 229). An ocean of order 2 has the waves
    that are bound to pairs of them as well (`gerstner.bound`), as far as its grid holds them.

    Args:
        ocean: an `Ocean`, or any object with waves, depth and choppiness.
        x0, y0: undisplaced positions, which broadcast [m].
        t: time [s].

    Returns:
        Fields of the broadcast shape of x0 and y0. The cost is points times waves.

    Raises:
        ParameterError: a position or time that is not finite.
    """
    if isinstance(ocean, type) or not all(
        hasattr(ocean, name) for name in ("modes", "depth", "choppiness")
    ):
        raise ParameterError(
            f"waves to be summed must be those of an Ocean or a Cascade, got {described(ocean)}"
        )
    px, py = np.broadcast_arrays(np.asarray(x0, dtype=np.float64), np.asarray(y0, dtype=np.float64))
    if not (np.all(np.isfinite(px)) and np.all(np.isfinite(py)) and math.isfinite(t)):
        raise ParameterError("x0, y0 and t must be finite")
    waves = ocean.modes()
    k = np.sqrt(waves.kx * waves.kx + waves.ky * waves.ky)
    a, ux, uy = waves.amplitude, waves.kx / k, waves.ky / k
    horizontal = (
        a
        if math.isinf(ocean.depth)
        else a * (np.cosh(kh := np.minimum(k * ocean.depth, 350.0)) / np.sinh(kh))
    )
    on_cosine = np.stack(
        [
            a,
            horizontal * ux * waves.omega,
            horizontal * uy * waves.omega,
            -horizontal * ux * waves.kx,
            -horizontal * ux * waves.ky,
            -horizontal * uy * waves.ky,
        ]
    )
    on_sine = np.stack(
        [-horizontal * ux, -horizontal * uy, -a * waves.kx, -a * waves.ky, a * waves.omega]
    )
    start = waves.omega * t + waves.phase
    flat_x, flat_y = px.ravel(), py.ravel()
    cosines, sines = np.zeros((6, flat_x.size)), np.zeros((5, flat_x.size))
    points = max(1, _CHUNK // max(k.size, 1))
    for i in range(0, flat_x.size, points):
        part = slice(i, i + points)
        angle = np.outer(flat_x[part], waves.kx) + np.outer(flat_y[part], waves.ky) - start
        # einsum, not matmul: thin products gain nothing from BLAS, whose threads fight with
        # whatever else runs
        cosines[:, part] = np.einsum("fm,pm->fp", on_cosine, np.cos(angle))
        sines[:, part] = np.einsum("fm,pm->fp", on_sine, np.sin(angle))
    height, velocity_x, velocity_y, xx, xy, yy = (f.reshape(px.shape) for f in cosines)
    displace_x, displace_y, slope_x, slope_y, velocity_z = (f.reshape(px.shape) for f in sines)
    for tile in getattr(ocean, "oceans", (ocean,)):
        if getattr(tile, "order", 1) > 1:
            second = _second_order(tile, flat_x, flat_y, t).reshape(4, *px.shape)
            height, slope_x, slope_y, velocity_z = (
                first + more
                for first, more in zip((height, slope_x, slope_y, velocity_z), second, strict=True)
            )

    c = ocean.choppiness
    along_x = np.stack([1.0 + c * xx, c * xy, slope_x], axis=-1)
    along_y = np.stack([c * xy, 1.0 + c * yy, slope_y], axis=-1)
    cross = np.cross(along_x, along_y)
    length = np.linalg.norm(cross, axis=-1, keepdims=True)
    normal = np.where(length > 0.0, cross / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 1.0])
    return Surface(
        x=px + c * displace_x,
        y=py + c * displace_y,
        z=height,
        height=height,
        displace_x=displace_x,
        displace_y=displace_y,
        slope_x=slope_x,
        slope_y=slope_y,
        stretch_xx=xx,
        stretch_xy=xy,
        stretch_yy=yy,
        velocity_x=velocity_x,
        velocity_y=velocity_y,
        velocity_z=velocity_z,
        normal=normal,
        jacobian=cross[..., 2],
    )


def _second_order(ocean: Any, x: Real, y: Real, t: float) -> Real:
    """Return height, slopes and vertical velocity of the bound waves at points, (4, points)."""
    waves, grid = bound.pairs(ocean.parents(), ocean.depth, ocean.choppiness), ocean.grid
    mx, my = np.rint(waves.kx / grid.dkx), np.rint(waves.ky / grid.dky)
    held = (2 * np.abs(mx) < grid.nx) & (2 * np.abs(my) < grid.ny)
    # The waves of one wavenumber are one wave, at one time.
    flip = np.where((mx < 0) | ((mx == 0) & (my < 0)), -1.0, 1.0)[held]
    mx, my = flip * mx[held], flip * my[held]
    phase = (waves.omega * t + waves.phase)[held]
    phasor = waves.amplitude[held] * np.exp(-1j * flip * phase)
    rate = -1j * flip * waves.omega[held] * phasor
    key = (mx * grid.ny + my + grid.ny // 2).astype(np.int64)
    some = np.unique(key)
    summed = [
        (np.bincount(key, part.real) + 1j * np.bincount(key, part.imag))[some]
        for part in (phasor, rate)
    ]
    kx = some // grid.ny * grid.dkx
    ky = (some % grid.ny - grid.ny // 2) * grid.dky
    spectra = np.stack([summed[0], 1j * kx * summed[0], 1j * ky * summed[0], summed[1]])
    out = np.zeros((4, x.size))
    points = max(1, _CHUNK // max(kx.size, 1))
    for i in range(0, x.size, points):
        part = slice(i, i + points)
        angle = np.outer(x[part], kx) + np.outer(y[part], ky)
        out[:, part] = np.einsum("fm,pm->fp", spectra.real, np.cos(angle))
        out[:, part] -= np.einsum("fm,pm->fp", spectra.imag, np.sin(angle))
    return out


_CHUNK = 2**21  # phase angles held at a time: 16 MiB
