"""Tabulated spectrum, such as a buoy's."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import DENSITY, DEPTH, FREQUENCY, Quantity, keep_checked
from fftocean.physics.kinds import Numbers, Way
from fftocean.physics.spectra.base import SPECTRA

TAIL = Quantity("", 1.5, 100.0)
"""Exponents of a tail: m0 exists above 1, and at 1.5 a third of it lies beyond ten times f_last."""


@dataclass(frozen=True, slots=True)
class TabulatedSpectrum:
    """
    A measured spectrum S(f): straight lines between the points, nothing outside them, or beyond
    the last one a tail S = S(f_last) (f / f_last)^-tail.

    Frequencies in Hz and densities in m^2/Hz, as buoys report them; the call takes and gives omega
    like any other spectrum. With a `depth` it states that of the water in which it was measured,
    which a `Sea` then has.

    Args:
        frequency: f [Hz], strictly ascending, > 0.
        density: S(f) [m^2/Hz], >= 0.
        depth: still-water depth of the measurement [m]; None states none.
        tail: exponent of the tail [-]; None has none.

    Raises:
        ParameterError: tables of different lengths, frequencies that do not rise, negative
            densities, or a tail out of its range.
    """

    frequency: Sequence[float]
    density: Sequence[float]
    depth: float | None = field(default=None, kw_only=True)
    tail: float | None = field(default=None, kw_only=True)
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
        if self.tail is not None:
            keep_checked(self, tail=TAIL)
        object.__setattr__(self, "frequency", tuple(f.tolist()))
        object.__setattr__(self, "density", tuple(s.tolist()))
        object.__setattr__(self, "_omega", 2.0 * np.pi * f)
        object.__setattr__(self, "_s", s / (2.0 * np.pi))

    def __repr__(self) -> str:
        f = self.frequency
        depth = "" if self.depth is None else f", depth={self.depth:g}"
        tail = "" if self.tail is None else f", tail f^-{self.tail:g}"
        return (
            f"TabulatedSpectrum({len(f)} frequencies, {f[0]:g} to {f[-1]:g} Hz, "
            f"peak at {self.peak / (2.0 * math.pi):g} Hz{tail}{depth})"
        )

    @property
    def peak(self) -> float:
        """The tabulated frequency with the highest density, as omega_p [rad/s]."""
        return float(self._omega[np.argmax(self._s)])

    @property
    def breaks(self) -> tuple[float, ...]:
        """The tabulated frequencies as omega [rad/s]: where the straight lines meet."""
        return tuple(self._omega.tolist())

    @property
    def tail_variance(self) -> float:
        """m0 of the tail, S(f_last) f_last / (tail - 1) [m^2]; 0 without one."""
        if self.tail is None:
            return 0.0
        return float(self.density[-1] * self.frequency[-1] / (self.tail - 1.0))

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        omega = np.asarray(omega, dtype=np.float64)
        inside: Real = np.interp(omega, self._omega, self._s, left=0.0, right=0.0)
        if self.tail is None:
            return inside
        last = self._omega[-1]
        beyond = self._s[-1] * (last / np.maximum(omega, last)) ** self.tail
        joined: Real = np.where(omega > last, beyond, inside)
        return joined


SPECTRA.add(
    "tabulated",
    TabulatedSpectrum,
    Way(TabulatedSpectrum, frequency=Numbers(), density=Numbers(), tail=TAIL),
)
