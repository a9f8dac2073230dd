"""Records of a dataset by their date."""

import contextlib
from typing import TYPE_CHECKING, Any

import numpy as np

from fftocean.errors import ParameterError, ReaderError, described

if TYPE_CHECKING:
    from xarray import DataArray, Dataset

FARTHEST = np.timedelta64(3, "h")
"""Largest distance of a record from the date that is asked for: wave models write as rarely."""


def nearest_time(dataset: "Dataset | DataArray", when: str) -> int:
    """
    Return the index of the record nearest to a date.

    Args:
        dataset: with a coordinate `time`.
        when: date in UTC as in ISO 8601, such as "2020-06-03" or "2020-06-03T12:40".

    Raises:
        ParameterError: not a dataset.
        ReaderError: no such date, a dataset without times, or no record within three hours.
    """
    if not hasattr(dataset, "coords"):
        raise ParameterError(
            f"dataset must be a Dataset or DataArray of xarray, got {described(dataset)}"
        )
    when = str(when)
    wanted: np.datetime64[Any] = np.datetime64("NaT")
    with contextlib.suppress(ValueError):
        wanted = np.datetime64(when.strip().removesuffix("Z").replace(" ", "T"), "s")
    if np.isnat(wanted):
        raise ReaderError(
            f"time must be a number from 0 or a date such as 2020-06-03T12:40, got {when!r:.40}"
        )
    if "time" not in dataset.coords or dataset["time"].dtype.kind != "M":
        raise ReaderError(f"time must be a number from 0, got {when!r:.40}: the file has no dates")
    times = np.atleast_1d(dataset["time"].values)
    distance = np.abs(times - wanted)
    distance[np.isnat(distance)] = np.timedelta64(2**62, "ns")
    nearest = int(np.argmin(distance))
    if distance[nearest] > FARTHEST:
        known = times[~np.isnat(times)]
        raise ReaderError(
            f"time must be within three hours of a record, got {when}; the file has "
            f"{known.size}, from {_text(known.min())} to {_text(known.max())}"
            if known.size
            else f"time must be a number from 0, got {when!r:.40}: the file has no dates"
        )
    return nearest


def _text(time: np.datetime64) -> str:
    """Return a time to the minute."""
    return str(np.datetime_as_string(time, unit="m"))
