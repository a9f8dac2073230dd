"""
The one layout in which every measured spectrum comes out, and the door through which its numbers pass.

    dims (time, freq, dir)   efth [m2/Hz/degree]      or, without directions,   dims (time, freq)   ef [m2/Hz]
    freq   [Hz] ascending    dir  [degrees] where waves come FROM, clockwise from north, ascending
    dpt    (time) water depth [m], where known        lon, lat   where known

It is the layout of the wavespectra package, so its accessor works on it (`dataset.efth.spec.hs()`).
"""

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Integer, Real, RealLike
from fftocean.errors import ReaderError, SeaWarning, how_to_install
from fftocean.limits import FREQUENCY

if TYPE_CHECKING:
    from xarray import Dataset

LARGEST: Final = 1e6  # [m2/Hz/degree]; a 30 m sea, all in one bin of 0.01 Hz by 1 degree, is 6e3
FILL: Final = 1e19  # beyond it stand the fill values of netCDF: 9.999e20, 9.969e36, 1e20, also where no attribute says so
ROUNDING: Final = 1e-7  # of the largest density: the last bit of float32, in which files are packed
MAX_VALUES: Final = 2**27  # numbers in one dataset: 1 GiB


def science() -> Any:
    """
    The xarray module, loaded when first needed: its import takes seconds.

    Raises:
        ReaderError: it is not installed; the message names the extra that brings it.
    """
    try:
        import xarray
    except ImportError as error:
        raise missing(error) from error
    return xarray


def missing(error: ImportError) -> ReaderError:
    """What to say when an optional package is not there."""
    hint = how_to_install("science")
    return ReaderError(f"xarray, h5netcdf and h5py must be installed to read spectra: {hint} ({error})")


def announce(made: "Dataset") -> "Dataset":
    """Pass a dataset on, warning of what its reader was not sure of."""
    if "direction_note" in made.attrs:
        warnings.warn(made.attrs["direction_note"], SeaWarning, stacklevel=3)
    return made


def frequencies(where: str, values: RealLike) -> tuple[Real, Integer]:
    """
    Check a frequency axis.

    Returns:
        The frequencies [Hz], ascending, and the order that sorted them: a descending axis is turned round.

    Raises:
        ReaderError: fewer than two, not finite, zero or negative, twice the same, or neither ascending nor descending.
    """
    f = np.asarray(values, dtype=np.float64).ravel()
    if f.size < 2:
        raise ReaderError(f"{where} must hold at least 2 frequencies, got {f.size}")
    bad = ~((f >= FREQUENCY.low) & (f <= FREQUENCY.high))
    if np.any(bad):
        raise ReaderError(f"{where} must be {FREQUENCY.rule}, got {f[bad][0]}")
    order = np.arange(f.size) if f[-1] > f[0] else np.arange(f.size)[::-1]
    step = np.diff(f[order])
    if np.any(step <= 0.0):
        i = int(np.argmax(step <= 0.0))
        a, b = f[order][i], f[order][i + 1]
        raise ReaderError(f"{where} must ascend or descend without repeats [Hz], got {a} " + ("twice" if a == b else f"before {b}"))
    return f[order], order


def directions(where: str, values: RealLike) -> tuple[Real, Integer]:
    """
    Check a direction axis, in degrees of any convention.

    Returns:
        The directions in [0, 360), ascending, and the order that sorted them.

    Raises:
        ReaderError: fewer than four, not finite, more than one turn, or the same direction twice (0 and 360 are the same).
    """
    d = np.asarray(values, dtype=np.float64).ravel()
    if d.size < 4:
        raise ReaderError(f"{where} must hold at least 4 directions, got {d.size}")
    bad = ~((d >= -360.0) & (d <= 720.0))
    if np.any(bad):
        raise ReaderError(f"{where} must be between -360 and 720 degrees, got {d[bad][0]}")
    if np.ptp(d) > 360.0:
        raise ReaderError(f"{where} must span at most one turn, got {d.min()} to {d.max()} degrees")
    turned = np.mod(np.round(d, 6), 360.0)  # a float32 axis of 0.1 degree steps is good to 3e-5
    order = np.argsort(turned, kind="stable")
    same = np.diff(turned[order]) <= 1e-4
    if np.any(same):
        raise ReaderError(
            f"{where} must hold each direction once (0 and 360 degrees are one), got {turned[order][int(np.argmax(same))]} twice"
        )
    return turned[order], order


def densities(where: str, values: RealLike, unit: str) -> tuple[Real, dict[str, int]]:
    """
    Check spectral densities: mask what is missing, forgive rounding, refuse the rest.

    Args:
        where: what to call them in an error.
        values: any shape, in `unit`; NaN is missing.
        unit: m2/Hz or m2/Hz/degree.

    Returns:
        float64 values >= 0, NaN where masked, same shape; and how many were masked and how many small negatives made 0.

    Raises:
        ReaderError: infinite, negative by more than rounding (1e-7 of the largest), or larger than any sea's.
    """
    e = np.array(values, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        masked = int(np.count_nonzero(np.isnan(e)))
        largest = float(np.max(e, initial=0.0, where=~np.isnan(e)))
        wrong = (e < -max(ROUNDING * largest, 1e-12)) | (e > LARGEST)
    if np.any(wrong):
        place = tuple(int(i) for i in np.argwhere(wrong)[0])
        raise ReaderError(f"{where} must be between 0 and {LARGEST:g} {unit}, got {e[place]} at {place}")
    with np.errstate(invalid="ignore"):
        small = e < 0.0
    e[small] = 0.0
    return e, {"masked_values": masked, "rounded_negatives": int(np.count_nonzero(small))}


def dataset(
    *,
    source: str,
    source_format: str,
    frequency: Real,
    density: Real,
    direction: Real | None = None,
    time: Any = None,
    depth: Real | None = None,
    position: Mapping[str, float] | None = None,
    notes: Mapping[str, Any] | None = None,
) -> "Dataset":
    """
    Put checked numbers into the layout.

    Args:
        source: the file's name.
        source_format: the format it was in, in words.
        frequency: (f,) ascending [Hz].
        density: (time, f, d) [m2/Hz/degree], or (time, f) [m2/Hz] without directions; NaN is missing.
        direction: (d,) ascending, FROM, clockwise from north [degrees].
        time: (time,) datetime64, where known.
        depth: (time,) [m], where known.
        position: `lon`, `lat` [degrees] or `x`, `y` [m], where known.
        notes: what else is to be known, as attributes.
    """
    xr = science()
    variables: dict[str, Any] = {}
    coords: dict[str, Any] = {
        "freq": ("freq", frequency, {"standard_name": "sea_surface_wave_frequency", "units": "Hz"}),
    }
    if time is not None:
        coords["time"] = ("time", np.asarray(time, dtype="datetime64[ns]"), {"standard_name": "time"})
    if direction is None:
        name = {"standard_name": "sea_surface_wave_variance_spectral_density", "units": "m2 s"}
        variables["ef"] = (("time", "freq"), density, name)
    else:
        name = {"standard_name": "sea_surface_wave_directional_variance_spectral_density", "units": "m2 s degree-1"}
        variables["efth"] = (("time", "freq", "dir"), density, name)
        coords["dir"] = ("dir", direction, {"standard_name": "sea_surface_wave_from_direction", "units": "degree"})
    if depth is not None:
        variables["dpt"] = ("time", depth, {"standard_name": "sea_floor_depth_below_sea_surface", "units": "m"})
    for key, value in (position or {}).items():
        unit = {"lon": "degrees_east", "lat": "degrees_north"}.get(key, "m")
        coords[key] = ((), float(value), {"units": unit})
    made: Dataset = xr.Dataset(variables, coords, {"source": source, "source_format": source_format, **(notes or {})})
    return made
