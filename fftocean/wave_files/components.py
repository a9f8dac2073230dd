"""Waves as a table in CSV: one wave a row."""

from pathlib import Path
from typing import Any

import numpy as np

from fftocean.amplitudes import Modes
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError
from fftocean.files import path_of, write_parts
from fftocean.ocean import Ocean
from fftocean.wave_list import list_waves, require_linear

COLUMNS = (
    "frequency_Hz",
    "direction_degrees",
    "amplitude_m",
    "phase_rad",
    "kx_rad_per_m",
    "ky_rad_per_m",
)


def components(source: Ocean | Cascade | Modes | Any, path: str | Path) -> str:
    """
    Write the waves of a sea as CSV: a line of names, then one wave a line.

    height = sum of amplitude cos(kx x + ky y - 2 pi frequency t - phase). Directions are
    counter-clockwise from east (+x), toward, from 0 to below 360. The strongest waves come first.

    Args:
        source: an `Ocean`, a `Cascade`, `Modes` or a few-wave model.
        path: the file, which is replaced if it exists; complete or absent.

    Returns:
        The SHA-256 of the file.

    Raises:
        ParameterError: a source without waves, or one that starts from rest.
        OutputError: the file could not be written.

    Pinned by tests/wave_files/test_components.py.
    """
    file = path_of("path", path)
    require_linear(source, "a table of waves")
    waves = list_waves(source)
    if waves.model is not None and waves.model.tau > 0.0:
        raise ParameterError(
            f"waves of a table must not start from rest: tau must be 0, got {waves.model.tau}"
        )
    columns = (
        waves.omega / (2.0 * np.pi),
        np.mod(np.rad2deg(np.arctan2(waves.ky, waves.kx)), 360.0),
        waves.amplitude,
        np.mod(waves.phase, 2.0 * np.pi),
        waves.kx,
        waves.ky,
    )
    rows = np.stack(columns, axis=1)[np.argsort(-waves.amplitude, kind="stable")]
    lines = [",".join(COLUMNS), *(",".join(f"{v:.17g}" for v in row) for row in rows.tolist())]
    return write_parts(file, [("\n".join(lines) + "\n").encode()])
