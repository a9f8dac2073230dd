"""Ranges and argument checks shared by the few-wave models."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError
from fftocean.limits import Count, Quantity

NUMBER = Count("", 1, 1000)
AMPLITUDE = Quantity("m", 0.0, 1e3)
WAVENUMBER = Quantity("rad/m", 1e-6, 1e6)
COMPONENT = Quantity("rad/m", -1e6, 1e6)  # of a wavevector
FREQUENCY = Quantity("rad/s", 0.0, 1e6)
WAVELENGTH = Quantity("m", 1e-5, 1e7)
RATIO = Quantity("", 1.0, 100.0)  # of one wave to the next
# at 1 no wave would have any share of the frequency axis
FREQUENCY_RATIO = Quantity("", 1.001, 100.0)
SHARPNESS = Quantity("", 0.0, 1e13)  # coth(kh) of the longest wave in the thinnest film is 1e12
FACTOR = Quantity("", 0.0, 1e3)  # gain, steepness
TAU = Quantity("s", 1e-3, 1e6)
ACCELERATION = Quantity("m/s^2", 1e-3, 1e3)
POSITION = Quantity("m", -1e12, 1e12)

Column = float | Sequence[float]
"""One number for every wave, or one for each."""


def check_tau(tau: Any) -> float:
    """Return a checked time constant; 0 means no start-up ramp."""
    if isinstance(tau, (int, float)) and not isinstance(tau, bool) and tau == 0:
        return 0.0
    return TAU.check("tau, unless it is 0,", tau)


def set_gravity(model: Any, gravity: float) -> None:
    object.__setattr__(model, "gravity", ACCELERATION.check("gravity", gravity))


def as_array(values: Any) -> Real:
    return np.asarray(values, dtype=np.float64)


def check_columns(**given: tuple[Any, Quantity]) -> dict[str, tuple[float, ...]]:
    """Check each value, and repeat single numbers to the common length."""
    columns = {}
    for name, (values, quantity) in given.items():
        if isinstance(values, np.ndarray):
            values = values.tolist()
        items = list(values) if isinstance(values, (list, tuple)) else [values]
        columns[name] = tuple(quantity.check(name, value) for value in items)
    length = max(len(column) for column in columns.values())
    for name, column in columns.items():
        if len(column) not in (1, length) or not column:
            raise ParameterError(
                f"{name} must be one number, or one for each wave ({max(length, 1)}), "
                f"got {len(column)}"
            )
    return {name: column * (length // len(column)) for name, column in columns.items()}


def set_columns(model: Any, given: dict[str, tuple[Any, Quantity]]) -> None:
    for name, column in check_columns(**given).items():
        object.__setattr__(model, name, column)


def pair(name: str, value: Any) -> tuple[Any, Any]:
    """Return (x, y) of one value for both, or of a pair."""
    if isinstance(value, tuple):
        if len(value) != 2:
            raise ParameterError(f"{name} must be one number or a pair (x, y), got {value!r}")
        return value
    return value, value
