"""Sums of all waves at points."""

import math

import numpy as np

from fftocean.arrays import Real
from fftocean.bound_waves import SURFACE
from fftocean.kernels import bound
from fftocean.kernels import query as kernels
from fftocean.point_results import FAR, PointFunction, PointResults, write_normals
from fftocean.wave_list import WaveList, as_tiles


class SummedWaves:
    """A source whose waves are all summed at every point."""

    block = 16  # points that a thread takes at a time: each can cost as much as a frame

    def __init__(self, waves: WaveList) -> None:
        self._waves = waves
        longest = 2.0 * np.pi / np.min(np.hypot(waves.kx, waves.ky), initial=np.inf) or 1.0
        sizes = np.where(np.isfinite(waves.sizes), waves.sizes, longest)
        self.limit = 1e-9 * float(np.max(sizes, initial=0.0))
        self._reach = (
            FAR
            * waves.choppiness
            * math.sqrt(0.5 * float(np.sum(waves.potential**2 * (waves.kx**2 + waves.ky**2))))
        )

    def at(self, t: float, fields: tuple[str, ...]) -> PointFunction:
        """Return the function that finds the water at time t [s]."""
        waves = self._waves
        tiles = as_tiles(waves, t)
        grow, rate, curve = _growth(waves, t)
        c = waves.choppiness

        def find(x: Real, y: Real, out: PointResults) -> None:
            origin = np.empty(waves.sizes.shape)
            search = kernels.Search(c * grow, 1e-4 * self.limit, self.limit, self._reach)
            kernels.invert(kernels.WAVES, tiles, x, y, tuple(search), origin, out.found())
            heights = out.arrays["heights"]
            heights *= grow
            second = None if waves.bound is None else _second_order(waves, t, x, y, out.offsets)
            if second is not None:
                heights += second[:, 0]
            if not set(fields) - {"heights"}:
                return
            sums = np.empty((x.size, 14))
            kernels.sum_waves(tiles, waves.omega, x, y, out.offsets, origin, sums)
            if second is not None:
                sums[:, [0, 1, 10, 13]] += second[:, 1:]  # slopes, and z of velocity, acceleration
            place, velocity, acceleration = sums[:, 5:8], sums[:, 8:11], sums[:, 11:14]
            if "normals" in fields:
                write_normals(grow * sums[:, :5], c, out.arrays["normals"])
            if "velocities" in fields:
                out.arrays["velocities"][:] = (grow * velocity + rate * place) * (c, c, 1.0)
            if "accelerations" in fields:
                out.arrays["accelerations"][:] = (
                    grow * acceleration + 2.0 * rate * velocity + curve * place
                ) * (c, c, 1.0)

        return find


def _second_order(waves: WaveList, t: float, x: Real, y: Real, offsets: Real) -> Real:
    """
    Return height, slopes, velocity and acceleration upward of the waves of second order, at points
    x + offsets, (points, 5).
    """
    assert waves.bound is not None  # asked by the caller
    kx, ky, values = waves.bound.cells(SURFACE, t, (0, 1, 2))
    kept = np.hypot(kx, ky) * waves.shortest <= 2.0 * np.pi
    kx, ky, (height, velocity, acceleration) = kx[kept], ky[kept], values[:, kept]
    spectra = np.stack([height, 1j * kx * height, 1j * ky * height, velocity, acceleration])
    (lx, ly), out = waves.sizes[0], np.empty((x.size, 5))
    bound.sum_cells(
        kx,
        ky,
        np.stack([spectra.real, spectra.imag], axis=1),
        np.remainder(x, lx) + offsets[:, 0],
        np.remainder(y, ly) + offsets[:, 1],
        out,
    )
    return out


def _growth(waves: WaveList, t: float) -> tuple[float, float, float]:
    """
    Return the factor on all waves of a model that starts from rest, and its time derivatives.

    The first is in 1/s, the second in 1/s^2.
    """
    if waves.model is None or waves.model.tau == 0.0:
        return 1.0, 0.0, 0.0
    grow, rate = (float(v) for v in waves.model.ramp(t))
    return grow, rate, -rate / waves.model.tau
