"""Sums of all waves at points."""

import math
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real
from fftocean.bound_waves import SURFACE
from fftocean.fields import potential_factor
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
        k = np.hypot(waves.kx, waves.ky)
        water = waves.amplitude * potential_factor(k, waves.depth)
        same = np.allclose(water, waves.potential, rtol=1e-14, atol=0.0)
        self._water = None if same else water  # a model's own displacement is not the water's
        self._reach = (
            FAR
            * waves.choppiness
            * math.sqrt(0.5 * float(np.sum(waves.potential**2 * (waves.kx**2 + waves.ky**2))))
        )

    def growth(self, t: float) -> float:
        """Return the factor on all waves at time t [s]: below 1 for a model that starts."""
        return _growth(self._waves, t)[0]

    def warm_up(self, _t: float) -> None:
        """Do nothing: every call takes the same loops."""

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
            if "normals" in fields:
                write_normals(grow * sums[:, :5], c, out.arrays["normals"])
            motion = _Motion(sums, grow, rate, curve)
            for name in set(fields) & {"surface_velocities", "surface_accelerations"}:
                out.arrays[name][:] = motion[name.removeprefix("surface_")] * (c, c, 1.0)
            if self._water is not None and set(fields) & {"velocities", "accelerations"}:
                table = tiles[-1].copy()
                table[kernels.POTENTIAL] = self._water
                water = (*tiles[:-1], table)
                kernels.sum_waves(water, waves.omega, x, y, out.offsets, origin, sums)
            for name in set(fields) & {"velocities", "accelerations"}:
                out.arrays[name][:] = motion[name]

        return find


@dataclass(frozen=True, slots=True, eq=False)
class _Motion:
    """Velocity and acceleration of waves that grow."""

    sums: Real  # of `kernels.query.sum_waves`
    grow: float  # and its time derivatives
    rate: float  # [1/s]
    curve: float  # [1/s^2]

    def __getitem__(self, name: str) -> Real:
        """Return "velocities" or "accelerations", (points, 3), before choppiness."""
        place, velocity, acceleration = self.sums[:, 5:8], self.sums[:, 8:11], self.sums[:, 11:14]
        if name == "velocities":
            moved: Real = self.grow * velocity + self.rate * place
            return moved
        pushed: Real = self.grow * acceleration + 2.0 * self.rate * velocity + self.curve * place
        return pushed


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
