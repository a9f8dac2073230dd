"""Protocol of directional spreading D(omega, theta), and the checks of arguments that need one."""

from functools import partial
from types import BuiltinFunctionType, FunctionType, MethodType
from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.physics.kinds import Registry


@runtime_checkable
class Spreading(Protocol):
    """
    Function from omega [rad/s] and theta [rad] (from the system's direction) to D [1/rad]; `peak`
    is the system's omega_p [rad/s].
    """

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, which broadcast."""


SPREADINGS: Registry[Spreading] = Registry("spreading")
"""All spreadings that a job file can name."""


def require_spreading(name: str, value: object) -> None:
    """
    Raise if `value` is not a spreading.

    Raises:
        ParameterError: not callable, a model's class where a model is wanted, or a plain function,
            whose integral is not known to be 1.
    """
    if isinstance(value, (FunctionType, BuiltinFunctionType, MethodType, partial)):
        raise ParameterError(
            f"{name} must integrate to 1 round the circle (wrap a plain function: "
            f"CustomSpreading(f)), got {value!r:.60}"
        )
    if not callable(value) or isinstance(value, type):
        raise ParameterError(f"{name} must be callable as D(omega, theta, peak), got {value!r:.60}")


def wrapped(theta: RealLike) -> Real:
    """Return the same angles in [-pi, pi]."""
    theta = np.asarray(theta, dtype=np.float64)
    return theta - 2.0 * np.pi * np.rint(theta / (2.0 * np.pi))


def held(omega: RealLike, peak: float) -> Real:
    """
    Return frequencies [rad/s] of at least a millionth of the peak and at most 1e50: no formula is
    made for 0 or inf.
    """
    return np.clip(np.asarray(omega, dtype=np.float64), 1e-6 * peak, 1e50)


def relative(omega: RealLike, peak: float) -> Real:
    """Return omega/omega_p of frequencies limited by `held`."""
    return held(omega, peak) / peak
