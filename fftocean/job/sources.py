"""Jobs of other things than job files: a spectrum file, the folder of a bake."""

import math
import os
import warnings
from pathlib import Path
from typing import Any

from fftocean.job.job import Job
from fftocean.physics import dispersion

DEFAULT_SPREADING = {"kind": "blend"}
"""Spreading of a spectrum file without directions: that of the embedded sea."""

ACROSS, PERIODS = 6.0, 4.0
"""Peak wavelengths across the tile of a measured sea, and peak periods in its loop."""
RATE = 15  # frames a second, as in the embedded job


def is_spectrum_file(path: Path) -> bool:
    """Return True for a file that is not named as a job; what it holds is read later."""
    # of os.path, which takes a name that no system can have for one that does not exist
    return path.suffix.lower() != ".toml" and os.path.isfile(path)  # noqa: PTH113


def spectrum_job(
    path: Path, *, time: int | str | None = None, direction: float | None = None
) -> Job:
    """
    Return the job of a measured sea.

    Its tile is six wavelengths of the peak wide and its loop four peak periods long, both rounded
    up to two digits, with 15 frames a second. All else is the default.

    Args:
        path: a file of any format that `fftocean.readers` reads.
        time: number of the record, from 0, or its date; None for the first.
        direction: toward which the waves travel [degrees], for a file without directions, which
            takes the default spreading.

    Raises:
        JobError: a time that the file does not have, or directions missing or given twice.
        ReaderError: a file that cannot be read.
    """
    measured: dict[str, Any] = {"file": str(path)}
    if time is not None:
        measured["time"] = time
    system: dict[str, Any] = {"measured": measured}
    if direction is not None:
        system |= {"direction": direction, "spreading": DEFAULT_SPREADING}
    # the source has no folder: the file is named as it was given
    job = Job.from_tree({"sea": {"systems": [system]}}, source=path.name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # given again, when the sea is used
        sea = job.sea()
    if not sea.tp > 0.0:
        return job
    length = 2.0 * math.pi / float(dispersion.wavenumber(2.0 * math.pi / sea.tp, sea.depth))
    loop = _two_digits(PERIODS * sea.tp)
    return job.replaced(
        {
            "ocean.size": _two_digits(ACROSS * length),
            "ocean.loop": loop,
            "bake.frames": math.ceil(RATE * loop),
        }
    )


def _two_digits(value: float) -> float:
    """Return a number rounded up to two digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return round(math.ceil(value / step - 1e-9) * step, 10)
