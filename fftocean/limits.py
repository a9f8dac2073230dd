"""
What each physical quantity may be: its unit, its range, and the words for it.

The ranges are generous: they admit every sea on Earth and most laboratory tanks, and they shut out
what can only be a mistake (a wind in knots times a thousand, a depth of 1e-308 m). Inside them,
every field is finite.
"""

import math
import numbers
from dataclasses import dataclass
from typing import Any

from fftocean.errors import ParameterError


@dataclass(frozen=True, slots=True)
class Quantity:
    """A kind of number: `check` lets a value through as a float, or says which rule it breaks."""

    unit: str
    low: float
    high: float

    @property
    def rule(self) -> str:
        """The rule in words, as it stands in error messages and in the documentation."""
        unit = f" {self.unit}" if self.unit else ""
        if math.isinf(self.high):
            return f"at least {self.low:g}{unit} (inf is allowed)"
        return f"between {self.low:g} and {self.high:g}{unit}"

    def check(self, name: str, value: Any) -> float:
        """
        Return `value` as a float.

        Raises:
            ParameterError: `value` is not a real number (bool and str are not), is NaN, or is out
                of range.
        """
        if isinstance(value, bool) or not isinstance(
            value, numbers.Real
        ):  # numpy's bool is no Real
            raise ParameterError(
                f"{name} must be a number {self.rule}, got {value!r:.60} ({type(value).__name__})"
            )
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not self.low <= number <= self.high:  # false for NaN too
            raise ParameterError(f"{name} must be {self.rule}, got {number!r}")
        return number


@dataclass(frozen=True, slots=True)
class Count(Quantity):
    """A whole number of things."""

    def check_whole(self, name: str, value: Any) -> int:
        """
        Return `value` as an int.

        Raises:
            ParameterError: `value` is not a whole number in range.
        """
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise ParameterError(
                f"{name} must be a whole number {self.rule}, got {value!r:.60} ({type(value).__name__})"
            )
        if not self.low <= int(value) <= self.high:
            raise ParameterError(f"{name} must be a whole number {self.rule}, got {int(value)}")
        return int(value)


def keep_checked(model: object, **quantities: Quantity) -> None:
    """
    Check the named fields of a frozen value, and keep them as plain floats.

    Raises:
        ParameterError: one of them breaks its rule.
    """
    for name, quantity in quantities.items():
        object.__setattr__(model, name, quantity.check(name, getattr(model, name)))


WIND_SPEED = Quantity(
    "m/s", 0.0, 150.0
)  # the fastest gust on record is 113 m/s (Barrow Island 1996)
FETCH = Quantity("m", 1.0, 5e7)  # the Earth's girth is 4e7 m
DEPTH = Quantity("m", 1e-6, math.inf)
SIGNIFICANT_WAVE_HEIGHT = Quantity("m", 0.0, 100.0)
PERIOD = Quantity("s", 1e-2, 1e3)
PEAK = Quantity("rad/s", 1e-6, 1e6)
FREQUENCY = Quantity("Hz", 1e-6, 1e5)
DENSITY = Quantity("m^2/Hz", 0.0, 1e12)
PHILLIPS_CONSTANT = Quantity("", 0.0, 1.0)
PEAK_ENHANCEMENT = Quantity("", 1.0, 20.0)
SPREADING_EXPONENT = Quantity("", 0.0, 1e6)
FRACTION = Quantity("", 0.0, 1.0)
DIRECTION = Quantity("degrees", -1e6, 1e6)
SURFACE_TENSION = Quantity("N/m", 0.0, 1.0)
SIZE = Quantity("m", 1e-3, 1e7)
LOOP = Quantity("s", 1e-2, 1e9)
TIME = Quantity("s", -1e12, 1e12)
CHOPPINESS = Quantity("", 0.0, 10.0)
LENGTH = Quantity("m", -1e4, 1e4)
ANGLE = Quantity("rad", -1e6, 1e6)
SAMPLES = Count("", 1, 65536)
SEED = Count("", 0, 2**64 - 1)
FOAM_TAU = Quantity("s", 1e-3, 1e6)
FOAM_THRESHOLD = Quantity("", -10.0, 1.0)
FOAM_STRENGTH = Quantity("1/s", 0.0, 1e6)
AHEAD = Count("", 0, 64)
BAND_EDGE = Quantity("rad/m", 0.0, math.inf)
BAND_START = Quantity("rad/m", 0.0, 1e9)
THREADS = Count("", 1, 1024)
FRAMES = Count("", 1, 10**6)
MOMENTS = Count("", 1, 2**32)  # of a loop: at 60 a second, two years
