"""Tabulated spreading, such as measured directions."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import LARGEST_FINITE, SMALLEST_POSITIVE, Quantity
from fftocean.physics.kinds import Numbers, Way
from fftocean.physics.spreading.base import SPREADINGS

# wide ranges: a table in any unit is brought to integral 1
_FREQUENCY = Quantity("Hz", SMALLEST_POSITIVE, LARGEST_FINITE)

_DIRECTION = Quantity("degrees", -LARGEST_FINITE, LARGEST_FINITE)

_DENSITY = Quantity("", 0.0, LARGEST_FINITE)


@dataclass(frozen=True, slots=True, kw_only=True)
class TabulatedSpreading:
    """
    Measured spreading: linear between the points of a table, in frequency and round the circle.

    Each row is normalised to integrate to 1 along its straight lines; then so does every frequency
    between two rows. A row without any energy says nothing about directions and takes the nearest
    row's that has some; so do frequencies outside the table.
    """

    frequency: Sequence[float]  # f [Hz], strictly ascending, > 0
    direction: Sequence[
        float
    ]  # from the system's direction, counter-clockwise [degrees], in any order, no angle twice
    density: Sequence[Sequence[float]] = field(repr=False)  # (frequency, direction), any unit, >= 0
    _f: Real = field(init=False, repr=False, compare=False)
    # ascending [rad], the first again a turn later
    _theta: Real = field(init=False, repr=False, compare=False)
    _d: Real = field(init=False, repr=False, compare=False)  # (f, theta) [1/rad]

    def __post_init__(self) -> None:
        f = _FREQUENCY.check_array("frequency", self.frequency, ndim=1, least=2, ascending=True)
        angle = _DIRECTION.check_array("direction", self.direction, ndim=1, least=3)
        table = _DENSITY.check_array("density", self.density, ndim=2)
        if table.shape != (f.size, angle.size):
            raise ParameterError(
                f"density must be a table of {f.size} frequencies by {angle.size} directions, "
                f"got shape {table.shape}"
            )
        order = np.argsort(np.mod(angle, 360.0))
        turned = np.mod(angle, 360.0)[order]
        if np.any(np.diff(turned, append=turned[0] + 360.0) <= 0.0):
            raise ParameterError(
                "direction must hold each angle once (0 and 360 degrees are one), "
                f"got {self.direction!r:.60}"
            )
        filled = np.flatnonzero(np.any(table > 0.0, axis=1))
        if not filled.size:
            raise ParameterError("density must be more than 0 somewhere, got 0 everywhere")
        nearest = filled[np.argmin(np.abs(f[:, None] - f[filled]), axis=1)]
        d = table[nearest][:, order]
        d = d / d.max(axis=1, keepdims=True)  # no table is too large or small to be summed
        d /= np.radians(d @ bin_widths(turned))[:, None]
        object.__setattr__(self, "frequency", tuple(f.tolist()))
        object.__setattr__(self, "direction", tuple(angle.tolist()))
        object.__setattr__(self, "density", tuple(map(tuple, table.tolist())))
        object.__setattr__(self, "_f", f)
        object.__setattr__(self, "_theta", np.radians(np.append(turned, turned[0] + 360.0)))
        object.__setattr__(self, "_d", np.concatenate([d, d[:, :1]], axis=1))

    @property
    def breaks(self) -> tuple[float, ...]:
        """The directions of the table, where the straight lines meet [rad]."""
        return tuple(self._theta[:-1].tolist())

    @property
    def frequency_breaks(self) -> tuple[float, ...]:
        """The frequencies of the table [rad/s]."""
        return tuple((2.0 * np.pi * self._f).tolist())

    def __repr__(self) -> str:
        f = self.frequency
        return (
            f"TabulatedSpreading({len(f)} frequencies, {f[0]:g} to {f[-1]:g} Hz, "
            f"{len(self.direction)} directions)"
        )

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """Return D at `omega` and `theta`, which broadcast, [1/rad]."""
        f, angle = np.broadcast_arrays(
            np.asarray(omega, dtype=np.float64) / (2.0 * np.pi), np.asarray(theta, dtype=np.float64)
        )
        i, u = _between(self._f, f)
        j, v = _between(self._theta, self._theta[0] + np.mod(angle - self._theta[0], 2.0 * np.pi))
        low = (1.0 - v) * self._d[i, j] + v * self._d[i, j + 1]
        high = (1.0 - v) * self._d[i + 1, j] + v * self._d[i + 1, j + 1]
        return (1.0 - u) * low + u * high


def bin_widths(directions: Real) -> Real:
    """
    Return the width of each direction's bin [degrees], half way to its neighbours round the circle;
    `directions` ascend in [0, 360).
    """
    gaps = np.diff(directions, append=directions[0] + 360.0)
    return 0.5 * (gaps + np.roll(gaps, 1))


def _between(nodes: Real, x: Real) -> tuple[np.typing.NDArray[np.intp], Real]:
    """
    Return the interval of `nodes` that holds x, and the position within it, from 0 to 1; the first
    and the last hold values outside.
    """
    i = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, nodes.size - 2)
    return i, np.clip((x - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)


SPREADINGS.add(
    "tabulated",
    TabulatedSpreading,
    Way(TabulatedSpreading, frequency=Numbers(), direction=Numbers(), density=Numbers()),
)
