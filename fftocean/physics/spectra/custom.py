"""User-defined spectrum."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import PEAK, keep_checked


@dataclass(frozen=True, slots=True)
class CustomSpectrum:
    """
    Any function of omega, with its peak. It must return finite values >= 0 of the same shape.

    Args:
        function: S(omega) [m^2 s/rad].
        peak: omega_p [rad/s].

    Raises:
        ParameterError: a function that cannot be called or gives no finite values >= 0, or a peak
            out of its range.
    """

    function: Callable[[Real], RealLike]
    peak: float

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise ParameterError(
                f"function must be callable as function(omega), got {self.function!r:.60}"
            )
        keep_checked(self, peak=PEAK)

    def __call__(self, omega: RealLike, /) -> Real:
        """
        Return S at `omega`, [m^2 s/rad]; 0 where omega <= 0, where the function is not called.
        """
        omega = np.asarray(omega, dtype=np.float64)
        where_positive = np.where(omega > 0.0, omega, self.peak)
        try:
            values = np.asarray(self.function(where_positive))
        except (TypeError, ValueError):  # written for one number, with math.exp or an if
            values = np.vectorize(self.function, otypes=[np.float64])(where_positive)
        if values.dtype.kind not in "iuf":
            raise ParameterError(
                f"the custom spectrum must return real numbers, got {values!r:.60}"
            )
        if values.shape not in (omega.shape, ()):
            raise ParameterError(
                f"the custom spectrum must return the shape it is given, {omega.shape}, "
                f"got {values.shape}"
            )
        bad = ~((values >= 0.0) & (values < np.inf))
        if np.any(bad):
            raise ParameterError(
                "the custom spectrum must be finite and at least 0 m^2 s/rad, "
                f"got {values[bad].flat[0]}"
            )
        return np.where(omega > 0.0, values, 0.0)
