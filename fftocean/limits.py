"""
Units and ranges of physical quantities, and the checks of arguments against them.

The ranges are generous: they admit every sea on Earth and most laboratory tanks, and they exclude
values that can only be mistakes (a wind in knots times a thousand, a depth of 1e-308 m). Inside
them, every field is finite.
"""

import math
import numbers
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Any, ClassVar

from fftocean.errors import ParameterError

if TYPE_CHECKING:
    from fftocean.arrays import Real

LARGEST_FINITE = sys.float_info.max
SMALLEST_POSITIVE = math.ulp(0.0)


@dataclass(frozen=True, slots=True)
class Quantity:
    """
    A kind of number: its unit and its range.

    `check` is for one number and `check_array` for an array of them. A truth value, a text of
    digits, a complex number and NaN are no numbers here, although NumPy would convert them.
    """

    unit: str
    low: float
    high: float

    _noun: ClassVar[str] = "number"
    _kinds: ClassVar[str] = "iuf"  # NumPy's letters for the types of array that hold such numbers

    @property
    def rule(self) -> str:
        """The range in words, for error messages and the documentation."""
        unit = f" {self.unit}" if self.unit else ""
        if self.high == LARGEST_FINITE:
            if self.low == -LARGEST_FINITE:
                return "finite"
            least = "positive" if self.low == SMALLEST_POSITIVE else f"at least {self.low:g}{unit}"
            return f"{least} and finite"
        if math.isinf(self.low):
            return "of any size"
        if math.isinf(self.high):
            return f"at least {self.low:g}{unit} (inf is allowed)"
        return f"between {_bound(self.low)} and {_bound(self.high)}{unit}"

    def check(self, name: str, value: Any) -> float:
        """
        Return `value` as a float.

        Raises:
            ParameterError: `value` is not a real number, is NaN, or is out of range.
        """
        # numpy's bool is not a Real
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            raise ParameterError(f"{name} must be a number {self.rule}, got {_with_type(value)}")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not self.low <= number <= self.high:  # false for NaN too
            raise ParameterError(f"{name} must be {self.rule}, got {number!r}")
        return number

    def check_array(
        self,
        name: str,
        values: Any,
        *,
        ndim: int | None = None,
        least: int = 0,
        most: int | None = None,
        ascending: bool = False,
        missing: bool = False,
    ) -> "Real":
        """
        Return `values` as a float64 array, every entry of which is in range.

        Args:
            name: of the argument, for messages.
            values: an array, a number, or numbers in (nested) lists or another iterable.
            ndim: the number of dimensions that it must have.
            least: the smallest number of entries.
            most: the largest number of entries; an endless iterable is read no further.
            ascending: each entry along the last dimension must be more than the one before.
            missing: let NaN through, and masked entries as NaN.

        Raises:
            ParameterError: a rule is broken; the message names the entry, the rule and the value.
        """
        form = {
            None: "numbers",
            0: "a number",
            1: "a list of numbers",
            2: "a table of numbers",
        }.get(ndim, f"a {ndim}-dimensional array of numbers")
        if ndim and not hasattr(values, "__array__") and not _is_list(values):
            raise ParameterError(f"{name} must be {form} {self.rule}, got {_with_type(values)}")
        import numpy as np  # within functions, so that `fftocean --help` does not load it

        array = self._converted(name, values, most, missing)
        if ndim is not None and array.ndim != ndim:
            raise ParameterError(
                f"{name} must be {form} {self.rule}, got {values!r:.60} of shape {array.shape}"
            )
        if array.size < least or (most is not None and array.size > most):
            size = str(array.size) if most is None or array.size <= most else "more"
            limit = f"at least {least}" if most is None else f"{least} to {most}"
            raise ParameterError(f"{name} must be {limit} numbers, got {size}")
        anything = missing and self.low == -math.inf and self.high == math.inf
        good = anything or (array >= self.low) & (array <= self.high)
        if missing and not anything:
            good |= np.isnan(array)
        if not np.all(good):
            place = tuple(int(i) for i in np.argwhere(~good)[0])
            raise ParameterError(
                f"{_entry(name, place)} must be {self._article}{self.rule}, got {array[place]}"
            )
        if ascending and array.ndim:
            falls = np.argwhere(~(np.diff(array, axis=-1) > 0.0))
            if falls.size:
                i = tuple(int(j) for j in falls[0])
                unit = f" {self.unit}" if self.unit else ""
                raise ParameterError(
                    f"{name} must be strictly ascending, got {array[i]}{unit} before "
                    f"{array[(*i[:-1], i[-1] + 1)]}{unit}"
                )
        return array

    @property
    def _article(self) -> str:
        """The words before the range in the message of an array's entry."""
        return "" if self._noun == "number" else f"a {self._noun} "

    def _converted(self, name: str, values: Any, most: int | None, missing: bool) -> "Real":
        """Return `values` as float64; entries of arrays are not yet checked against the range."""
        import numpy as np

        if np.ma.is_masked(values):
            if not missing:
                raise ParameterError(f"{name} must have no masked entries, got {values!r:.60}")
            values = np.ma.filled(values.astype(np.float64), np.nan)
        if hasattr(values, "__array__"):
            array = np.asarray(values)
            if array.dtype.kind in self._kinds:
                with np.errstate(over="ignore"):  # an extended double out of range becomes inf
                    return array.astype(np.float64, copy=False)
            if array.dtype.kind != "O":
                raise ParameterError(
                    f"{name} must be {self._noun}s {self.rule}, got {values!r:.60} ({array.dtype})"
                )
            values = array.tolist()
        listed = self._listed(name, values, most, missing)
        try:
            return np.array(listed, dtype=np.float64)
        except ValueError:  # rows of different lengths
            raise ParameterError(
                f"{name} must be {self._noun}s in a regular array, got {values!r:.60}"
            ) from None

    def _listed(self, name: str, values: Any, most: int | None, missing: bool) -> Any:
        """Return the checked numbers in lists nested like `values`."""
        import numpy as np

        if isinstance(values, np.ndarray) and values.ndim:  # a row of a list of arrays
            return self._converted(name, values, most, missing).tolist()
        if not _is_list(values):
            if missing and isinstance(values, numbers.Real) and math.isnan(values):
                return math.nan
            return self.check(name, values)
        items = islice(values, None if most is None else most + 1)
        return [self._listed(f"{name}[{i}]", v, most, missing) for i, v in enumerate(items)]


@dataclass(frozen=True, slots=True)
class Count(Quantity):
    """A kind of whole number: `check` returns an int and refuses 7.0."""

    _noun: ClassVar[str] = "whole number"
    _kinds: ClassVar[str] = "iu"

    def check(self, name: str, value: Any) -> int:
        """
        Return `value` as an int.

        Raises:
            ParameterError: `value` is not a whole number in range.
        """
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise ParameterError(
                f"{name} must be a whole number {self.rule}, got {_with_type(value)}"
            )
        if not self.low <= int(value) <= self.high:
            raise ParameterError(f"{name} must be a whole number {self.rule}, got {int(value)}")
        return int(value)


def _bound(value: float) -> str:
    """Return a limit as text; a whole number keeps all digits where six would be another limit."""
    text = f"{value:g}"
    return str(value) if isinstance(value, int) and float(text) != value else text


def _is_list(values: Any) -> bool:
    """Return True for an iterable of entries; a text and a dictionary are none."""
    import numpy as np

    return isinstance(values, Iterable) and not isinstance(values, (str, bytes, dict, np.ndarray))


def _with_type(value: Any) -> str:
    """Return a value that is no number as a message shows it."""
    return f"{value!r:.60} ({type(value).__name__})"


def _entry(name: str, place: tuple[int, ...]) -> str:
    """Return the name of one entry of an array, such as density[2][0]."""
    return name + "".join(f"[{i}]" for i in place)


def check_bool(name: str, value: Any) -> bool:
    """
    Return `value`, which must be True or False.

    Raises:
        ParameterError: it is anything else; 0 and 1 are numbers.
    """
    if not isinstance(value, bool):
        raise ParameterError(f"{name} must be True or False, got {value!r:.60}")
    return value


def keep_checked(model: object, **quantities: Quantity) -> None:
    """
    Check the named fields of a frozen value, and store them as plain floats.

    Raises:
        ParameterError: a field breaks its rule.
    """
    for name, quantity in quantities.items():
        object.__setattr__(model, name, quantity.check(name, getattr(model, name)))


# the fastest gust on record is 113 m/s (Barrow Island 1996)
WIND_SPEED = Quantity("m/s", 0.0, 150.0)
FETCH = Quantity("m", 1.0, 5e7)  # the Earth's circumference is 4e7 m
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
COORDINATE = Quantity("", -math.inf, math.inf)
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
ORDER = Count("", 1, 2)
BOUND_WAVES = Count("", 0, 8192)  # 8192 have 67 million pairs, 270 MB in single precision
