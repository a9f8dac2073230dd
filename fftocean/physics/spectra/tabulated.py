"""Tabulated spectrum, such as a buoy's."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import DENSITY, DEPTH, FREQUENCY, keep_checked
from fftocean.physics.kinds import Numbers, Way
from fftocean.physics.spectra.base import SPECTRA


@dataclass(frozen=True, slots=True)
class TabulatedSpectrum:
    """
    A measured spectrum S(f): straight lines between the points, nothing outside them.

    Frequencies in Hz and densities in m^2/Hz, as buoys report them; the call takes and gives omega
    like any other spectrum. With a `depth` it states that of the water in which it was measured,
    which a `Sea` then has.
    """

    frequency: Sequence[float]  # f [Hz], strictly ascending, > 0
    density: Sequence[float]  # S(f) [m^2/Hz], >= 0
    depth: float | None = field(default=None, kw_only=True)  # [m]; None states none
    _omega: Real = field(init=False, repr=False, compare=False)
    _s: Real = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        f = FREQUENCY.check_array("frequency", self.frequency, ndim=1, ascending=True)
        s = DENSITY.check_array("density", self.density, ndim=1)
        if f.size < 2 or f.size != s.size:
            raise ParameterError(
                "frequency and density must have the same length, at least 2, "
                f"got {f.size} and {s.size}"
            )
        if self.depth is not None:
            keep_checked(self, depth=DEPTH)
        object.__setattr__(self, "frequency", tuple(f.tolist()))
        object.__setattr__(self, "density", tuple(s.tolist()))
        object.__setattr__(self, "_omega", 2.0 * np.pi * f)
        object.__setattr__(self, "_s", s / (2.0 * np.pi))

    def __repr__(self) -> str:
        f = self.frequency
        depth = "" if self.depth is None else f", depth={self.depth:g}"
        return (
            f"TabulatedSpectrum({len(f)} frequencies, {f[0]:g} to {f[-1]:g} Hz, "
            f"peak at {self.peak / (2.0 * math.pi):g} Hz{depth})"
        )

    @property
    def peak(self) -> float:
        """The tabulated frequency with the highest density, as omega_p [rad/s]."""
        return float(self._omega[np.argmax(self._s)])

    @property
    def breaks(self) -> tuple[float, ...]:
        """The tabulated frequencies as omega [rad/s]: where the straight lines meet."""
        return tuple(self._omega.tolist())

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        return np.interp(
            np.asarray(omega, dtype=np.float64), self._omega, self._s, left=0.0, right=0.0
        )


SPECTRA.add(
    "tabulated", TabulatedSpectrum, Way(TabulatedSpectrum, frequency=Numbers(), density=Numbers())
)
