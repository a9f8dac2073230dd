"""Sample positions and wavenumbers of a periodic tile."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Integer, Real
from fftocean.errors import ParameterError
from fftocean.limits import SAMPLES, SIZE


@dataclass(frozen=True, slots=True)
class Grid:
    """
    nx x ny samples over lx x ly metres, both periodic.

    Sample [iy, ix] sits at x = ix lx/nx, y = iy ly/ny. A wave has integer wavenumbers (mx, my): k =
    2 pi (mx/lx, my/ly). Spectra are stored as the half plane mx >= 0, indexed [my, mx], my in the
    order of `np.fft.fftfreq`: the other half is its complex conjugate, as the surface is real.
    """

    nx: int
    ny: int
    lx: float  # [m]
    ly: float  # [m]

    def __post_init__(self) -> None:
        for name, n in (("nx", self.nx), ("ny", self.ny)):
            SAMPLES.check(name, n)
        for name, size in (("lx", self.lx), ("ly", self.ly)):
            SIZE.check(name, size)

    @classmethod
    def of(cls, n: int | tuple[int, int], size: float | tuple[float, float]) -> "Grid":
        """
        Make a grid from one number a side, or (nx, ny) and (lx, ly).

        Raises:
            ParameterError: `n` is not one or two whole numbers in range, `size` not one or two
                lengths in range.
        """
        nx, ny = (SAMPLES.check("n", v) for v in _pair("n", n))
        lx, ly = (SIZE.check("size", v) for v in _pair("size", size))
        return cls(nx, ny, lx, ly)

    @property
    def shape(self) -> tuple[int, int]:
        """(ny, nx): the shape of a field."""
        return self.ny, self.nx

    @property
    def half_shape(self) -> tuple[int, int]:
        """(ny, nx // 2 + 1): the shape of a half spectrum."""
        return self.ny, self.nx // 2 + 1

    @property
    def x(self) -> Real:
        """The positions of the columns, (nx,) [m]."""
        return np.arange(self.nx) * (self.lx / self.nx)

    @property
    def y(self) -> Real:
        """The positions of the rows, (ny,) [m]."""
        return np.arange(self.ny) * (self.ly / self.ny)

    @property
    def dkx(self) -> float:
        """2 pi / lx [rad/m]."""
        return 2.0 * np.pi / self.lx

    @property
    def dky(self) -> float:
        """2 pi / ly [rad/m]."""
        return 2.0 * np.pi / self.ly

    @property
    def mx(self) -> Integer:
        """Integer wavenumbers of the half plane's columns, (nx // 2 + 1,): 0, 1, ..., nx // 2."""
        return np.arange(self.nx // 2 + 1, dtype=np.int64)

    @property
    def my(self) -> Integer:
        """Integer wavenumbers of the half plane's rows, (ny,): 0, 1, ..., -2, -1."""
        return np.fft.ifftshift(np.arange(self.ny, dtype=np.int64) - self.ny // 2)

    @property
    def kx(self) -> Real:
        """Wavenumbers of the columns, (nx // 2 + 1,) [rad/m]."""
        return self.mx * self.dkx

    @property
    def ky(self) -> Real:
        """Wavenumbers of the rows, (ny,) [rad/m]."""
        return self.my * self.dky

    @property
    def k(self) -> Real:
        """Wavenumber magnitude on the half plane, [rad/m]."""
        return np.hypot(self.kx[None, :], self.ky[:, None])

    @property
    def reach(self) -> tuple[int, int]:
        """
        The largest |mx| and |my| that a wave may have: below the Nyquist index, whose row and
        column cannot tell k from -k.
        """
        return (self.nx - 1) // 2, (self.ny - 1) // 2

    @property
    def active(self) -> npt.NDArray[np.bool_]:
        """
        True for the entries of the half plane that hold a wave: all but k = 0 and the Nyquist row
        and column.
        """
        reach_x, reach_y = self.reach
        mask: npt.NDArray[np.bool_] = (self.mx <= reach_x)[None, :] & (np.abs(self.my) <= reach_y)[
            :, None
        ]
        mask[0, 0] = False
        return mask


def _pair(name: str, value: Any) -> tuple[Any, Any]:
    """Return one value for both axes, or two."""
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise ParameterError(f"{name} must be one value or two, (x, y), got {value!r}")
        return value[0], value[1]
    return value, value
