"""Spectra that are written in wavenumber, as functions of frequency."""

from abc import ABC, abstractmethod

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.physics.dispersion import group_velocity, wavenumber
from fftocean.physics.spectra.wind import STILL_AIR


class WavenumberForm(ABC):
    """
    A spectrum that is written as a density F(k), `wavenumber_density`; S(omega) = F(k) dk/d omega.
    """

    __slots__ = ()

    depth: float  # still-water depth [m]
    surface_tension: float  # [N/m]

    @property
    @abstractmethod
    def peak(self) -> float:
        """Peak frequency [rad/s]."""

    @abstractmethod
    def wavenumber_density(self, k: RealLike, /) -> Real:
        """Return F at wavenumbers `k` [rad/m], [m^3/rad]."""

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        # Below a ten-thousandth of the peak all spectra of this form are 0.
        k = wavenumber(
            np.clip(np.asarray(omega, dtype=np.float64), 1e-4 * self.peak, 1e20),
            self.depth,
            self.surface_tension,
        )
        return self.at_waves(omega, k)

    def at_waves(self, _omega: RealLike, k: Real) -> Real:
        """Return S where the wavenumbers `k` [rad/m] are known, [m^2 s/rad]."""
        return self.wavenumber_density(k) / group_velocity(k, self.depth, self.surface_tension)


def scale_wind(speed: float) -> float:
    """
    Return the wind [m/s] that sets the scale of a spectrum; any value will do in still air, where
    there is no energy to scale.
    """
    return speed if speed >= STILL_AIR else 1.0
