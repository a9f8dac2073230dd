"""Records of waves: the bytes of `tile0.waves` and its like."""

from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.runtime.layout import RECORD
from fftocean.runtime.planes import Planes

Records = npt.NDArray[Any]
"""Waves, each a `RECORD`."""


def records_of(planes: Planes) -> Records:
    """
    Return the waves of a tile, row by row of the plane; waves of amplitude 0 are left out.

    The plane is whole: the waves along +k and -k are two records, each with its own h0.
    """
    ny, nx = planes.h0.shape
    some = np.flatnonzero(planes.h0)
    records = np.empty(some.size, RECORD)
    my, mx = np.divmod(some, nx)
    records["mx"] = np.where(2 * mx > nx, mx - nx, mx)
    records["my"] = np.where(2 * my > ny, my - ny, my)
    records["cycles"] = planes.cycles.ravel()[some]
    h0 = planes.h0.ravel()[some]
    records["re"], records["im"] = h0.real, h0.imag
    return records
