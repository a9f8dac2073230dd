"""User-defined spreading."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import ANGLE
from fftocean.physics.spreading.base import held, wrapped
from fftocean.physics.spreading.normalisation import Function, circle_integral


@dataclass(frozen=True, slots=True)
class CustomSpreading:
    """
    Any function of (omega, theta, peak), brought to integral 1 at every frequency.

    The norm comes from Gauss quadrature on panels that narrow toward theta = 0 and toward `breaks`,
    so a bell round any of them of any width down to 0.1 degree is good to 1e-12, and so is anything
    smooth; a function with a kink or a jump that `breaks` does not name is refused when the
    quadrature sees it. Between frequencies the norm is interpolated, to 1e-12 as well.

    Args:
        function: f(omega, theta, peak) >= 0, any size; theta [rad] in [-pi, pi].
        breaks: angles theta at which it has a kink, a jump or a narrow bell [rad], besides 0,
            +-pi/2 and +-pi.

    Raises:
        ParameterError: a function that cannot be called, gives negative values, or has a kink that
            `breaks` does not name.
    """

    function: Function
    breaks: Sequence[float] = ()

    def __post_init__(self) -> None:
        if not callable(self.function) or isinstance(self.function, type):
            raise ParameterError(
                "function must be callable as function(omega, theta, peak), "
                f"got {self.function!r:.60}"
            )
        if isinstance(self.breaks, str) or not isinstance(self.breaks, Sequence):
            raise ParameterError(f"breaks must be a list of angles [rad], got {self.breaks!r:.60}")
        object.__setattr__(
            self, "breaks", tuple(ANGLE.check("every break", b) for b in self.breaks)
        )

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        omega = held(omega, peak)
        frequency, angle = (
            np.array(a, order="C") for a in np.broadcast_arrays(omega, wrapped(theta))
        )
        density: Real = self._checked(frequency, angle, peak) / circle_integral(
            self._checked, omega, peak, tuple(self.breaks)
        )
        return density

    def _checked(self, omega: Real, theta: Real, peak: float) -> Real:
        """Return the values of the function, or raise if they cannot be a spreading."""
        values = np.asarray(self.function(omega, theta, peak))
        if values.dtype.kind not in "iuf":
            raise ParameterError(
                f"the custom spreading must return real numbers, got {values!r:.60}"
            )
        if values.shape not in (omega.shape, ()):
            raise ParameterError(
                f"the custom spreading must return the shape it is given, {omega.shape}, "
                f"got {values.shape}"
            )
        bad = ~((values >= 0.0) & (values < np.inf))
        if np.any(bad):
            raise ParameterError(
                f"the custom spreading must be finite and at least 0, got {values[bad].flat[0]}"
            )
        return np.broadcast_to(values.astype(np.float64), omega.shape)
