"""Points and times at which the water is asked for."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real, RealLike
from fftocean.limits import COORDINATE


def as_coordinates(name: str, values: RealLike) -> Real:
    """
    Return coordinates as a float64 array of any shape; masked ones become NaN.

    Raises:
        ParameterError: values that are not numbers, or rows of unequal length.
    """
    return COORDINATE.check_array(name, values, missing=True)


def group_by_time(
    t: Real, shape: tuple[int, ...]
) -> "Iterator[tuple[float, slice | npt.NDArray[np.intp]]]":
    """
    Yield each different time with the numbers of its points.

    Args:
        t: times, of any shape that broadcasts to `shape` [s].
        shape: of the points.
    """
    if t.size == 1:
        yield float(t.reshape(())), slice(None)
        return
    if 0 in shape:  # there is no point
        return
    times, inverse = np.unique(np.broadcast_to(t, shape).ravel(), return_inverse=True)
    if times.size == 1:
        yield float(times[0]), slice(None)
        return
    order = np.argsort(inverse, kind="stable")
    for moment, here in zip(
        times, np.split(order, np.cumsum(np.bincount(inverse))[:-1]), strict=True
    ):
        yield float(moment), here
