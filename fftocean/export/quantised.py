"""
16-bit steps over a range of the whole sequence, without clipping.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import OutputError, ParameterError
from fftocean.files import as_json

Limit = float | Sequence[float] | None
"""One end of the range: of the whole map, or of each of its channels."""

LARGEST = 65535


def limits(
    lo: Limit, hi: Limit, channels: int
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """
    Return lower and upper end of the range for every channel.

    Raises:
        ParameterError: an end is missing or not finite, or the lower one is the larger.
    """
    if lo is None or hi is None:
        raise ParameterError(
            "a scaled format needs the range of the whole sequence: lo and hi are required"
        )
    low, high = (
        np.broadcast_to(np.asarray(lo, float), channels),
        np.broadcast_to(np.asarray(hi, float), channels),
    )
    if not (np.all(np.isfinite(high - low)) and np.all(low <= high)):
        raise ParameterError(f"the range must be finite, lo <= hi, got {lo} to {hi}")
    return low, high


def to_steps(pixels: Real, lo: Limit, hi: Limit) -> npt.NDArray[np.uint16]:
    """
    Return the nearest of 65536 steps from lo to hi; the first step if lo equals hi.

    Raises:
        OutputError: a value is outside the range, or NaN.
        ParameterError: the range is invalid.
    """
    low, high = limits(lo, hi, pixels.shape[2])
    smallest, largest = pixels.min(axis=(0, 1)), pixels.max(axis=(0, 1))
    if not (np.all(smallest >= low) and np.all(largest <= high)):  # false for NaN too
        raise OutputError(
            f"values must lie between {low.tolist()} and {high.tolist()}, "
            f"got {smallest.tolist()} to {largest.tolist()}"
        )
    per_unit = np.divide(LARGEST, high - low, out=np.zeros_like(low), where=high > low)
    return np.rint((pixels - low) * per_unit).astype(np.uint16)


def from_steps(steps: npt.NDArray[np.uint16], lo: Limit, hi: Limit) -> npt.NDArray[np.float32]:
    """
    Return the values of steps.

    Raises:
        ParameterError: the range is invalid.
    """
    low, high = limits(lo, hi, steps.shape[2])
    return (low + steps * ((high - low) / LARGEST)).astype(np.float32)


VALUE = "lo + stored / 65535 * (hi - lo)"
"""Value of a step, as the sidecars say it."""


def sidecar(facts: Mapping[str, Any], _layout: object) -> bytes:
    """Return the sidecar of a map that is stored in steps."""
    return as_json({**facts, "dtype": "uint16"})
