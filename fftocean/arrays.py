"""Array types."""

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.errors import ParameterError

Real = npt.NDArray[np.floating[Any]]
"""A real array, float32 or float64."""

Complex = npt.NDArray[np.complexfloating[Any, Any]]
"""A complex array, complex64 or complex128."""

Integer = npt.NDArray[np.int64]
"""Signed integers, 64 bit."""

CACHE_LINE = 64
"""Bytes in a cache line, and in the widest vector register."""

RealLike = npt.ArrayLike
"""An argument of `np.asarray(..., float)`: a number, a list, an array."""

COMPLEX_OF: dict[str, np.dtype[Any]] = {
    "float32": np.dtype(np.complex64),
    "float64": np.dtype(np.complex128),
}
"""The complex type whose parts have the named real type."""


def precision_of(dtype: Any) -> str:
    """
    Return the name of a real type, "float32" or "float64".

    Args:
        dtype: the name, or the type itself.

    Raises:
        ParameterError: another type.
    """
    name = dtype if isinstance(dtype, str) else getattr(dtype, "__name__", None) or str(dtype)
    if name not in COMPLEX_OF:
        raise ParameterError(f"dtype must be 'float32' or 'float64', got {dtype!r}")
    return name


SHOWN = 280
"""The largest length of the text of a value, in characters."""


def brief(value: Any) -> str:
    """
    Return a short text for a part of a value.

    Arrays are shown by shape and type, mappings by their keys.
    """
    if isinstance(value, np.ndarray):
        if value.size > 3:
            return f"<{' x '.join(map(str, value.shape))} {value.dtype}>"
        return np.array2string(value, precision=6)
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    if isinstance(value, dict):
        return f"{{{', '.join(map(str, value))}}}"
    return repr(value)


def brief_repr(value: Any) -> str:
    """
    Return the `repr` of a dataclass or named tuple that holds arrays.

    Each field is `brief`, and the whole is cut at `SHOWN` characters.
    """
    names = (
        [f.name for f in fields(value) if f.repr] if is_dataclass(value) else list(value._fields)
    )
    contents = ", ".join(f"{name}={brief(getattr(value, name))}" for name in names)
    return shortened(f"{type(value).__name__}({contents})")


def shortened(text: str) -> str:
    """Return a text that ends in a bracket, cut before it if it is longer than `SHOWN`."""
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 4]}...{text[-1]}"
