"""
Dataset layout of every measured spectrum, and the checks that its numbers pass.

    efth       (time, freq, dir) [m2/Hz/degree]; without directions: ef (time, freq) [m2/Hz]
    freq       [Hz], ascending
    dir        [degrees] where waves come FROM, clockwise from north, ascending
    dpt        (time) water depth [m], if known
    lon, lat   position [degrees], if known
    freq_bnds  (freq, 2) edges of the bands [Hz], if the file states them

It is the layout of the wavespectra package, so its accessor works on it (`dataset.efth.spec.hs()`).
"""

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Integer, Real, RealLike
from fftocean.errors import ParameterError, ReaderError, SeaWarning, how_to_install
from fftocean.limits import FREQUENCY

if TYPE_CHECKING:
    from xarray import Dataset

LARGEST: Final = 1e6  # [m2/Hz/degree]; a 30 m sea, all in one bin of 0.01 Hz by 1 degree, is 6e3
# Larger values are the fill values of netCDF (9.999e20, 9.969e36, 1e20), even if no attribute
# declares them.
FILL: Final = 1e19
ROUNDING: Final = 1e-7  # share of the largest density: the last bit of the float32 in files
NEGATIVE: Final = ("refuse", "clip")
MAX_VALUES: Final = 2**27  # numbers in one dataset: 1 GiB


def load_xarray() -> Any:
    """
    Return the xarray module, imported on first use because that takes seconds.

    Raises:
        ReaderError: it is not installed; the message names the extra that brings it.
    """
    try:
        import xarray
    except ImportError as error:
        raise not_installed(error) from error
    return xarray


def not_installed(error: ImportError) -> ReaderError:
    """Return the error for an optional package that is not installed."""
    hint = how_to_install("science")
    return ReaderError(
        f"xarray, h5netcdf and h5py must be installed to read spectra: {hint} ({error})"
    )


def warn_of_notes(made: "Dataset") -> "Dataset":
    """
    Return a dataset after warning of its reader's doubts, the attributes that end in `_note`.
    """
    for key, text in made.attrs.items():
        if key.endswith("_note"):
            warnings.warn(str(text), SeaWarning, stacklevel=3)
    return made


def frequencies(where: str, values: RealLike) -> tuple[Real, Integer]:
    """
    Check a frequency axis.

    Returns:
        The frequencies [Hz], ascending, and the indices that sort them: a descending axis is
        reversed.

    Raises:
        ReaderError: fewer than two, not finite, zero or negative, twice the same, or neither
            ascending nor descending.
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
        raise ReaderError(
            f"{where} must ascend or descend without repeats [Hz], got {a} "
            + ("twice" if a == b else f"before {b}")
        )
    return f[order], order


def above_zero(values: RealLike) -> tuple[npt.NDArray[np.bool_], dict[str, Any]]:
    """
    Return which frequencies are not 0: an analysis by FFT has the mean level at exactly 0 Hz.

    Args:
        values: a frequency axis [Hz].

    Returns:
        Mask of the shape of `values`, and a note of how many were left out (empty if none).
    """
    kept = np.asarray(values, dtype=np.float64).ravel() != 0.0
    left_out = int(np.count_nonzero(~kept))
    return kept, {"zero_frequencies_left_out": left_out} if left_out else {}


def in_order(seconds: RealLike) -> tuple[Integer, int]:
    """
    Sort records by time, keeping the first of each time.

    Returns:
        The indices of the kept records, ascending in time, and the number left out.
    """
    times, first = np.unique(np.asarray(seconds), return_index=True)
    return first, int(np.size(seconds) - times.size)


def compare_heights(where: str, m0: Real, stated: Real, rounding: float) -> dict[str, Any]:
    """
    Compare significant wave heights with those that the file states.

    Args:
        where: name of the file in messages.
        m0: (time,) variances of the spectra read [m2].
        stated: (time,) significant wave heights that the file states [m]; NaN if none.
        rounding: half a unit of the last decimal of `stated` [m].

    Returns:
        Notes: the largest difference, and a warning if it exceeds 5 % plus the rounding.
    """
    read = 4.0 * np.sqrt(m0)
    apart = np.where(np.isfinite(read) & np.isfinite(stated), np.abs(read - stated), 0.0)
    notes: dict[str, Any] = {"stated_hs_difference": float(np.max(apart, initial=0.0))}
    wrong = np.flatnonzero(apart > rounding + 0.05 * np.abs(stated))
    if wrong.size:
        i = int(wrong[0])
        notes["height_note"] = (
            f"{where}: the densities of record {i} have a significant wave height of "
            f"{read[i]:.4g} m, but the file states {stated[i]:.4g} m "
            f"({wrong.size} of {read.size} records differ by more than 5 %)"
        )
    return notes


def directions(where: str, values: RealLike) -> tuple[Real, Integer]:
    """
    Check a direction axis, in degrees of any convention.

    Returns:
        The directions in [0, 360), ascending, and the indices that sort them.

    Raises:
        ReaderError: fewer than four, not finite, more than one full circle, the same direction
            twice (0 and 360 are the same), or all within 2 pi degrees: no instrument or model has
            such a sector, so the axis is in radians.
    """
    d = np.asarray(values, dtype=np.float64).ravel()
    if d.size < 4:
        raise ReaderError(f"{where} must hold at least 4 directions, got {d.size}")
    bad = ~((d >= -360.0) & (d <= 720.0))
    if np.any(bad):
        raise ReaderError(f"{where} must be between -360 and 720 degrees, got {d[bad][0]}")
    if np.ptp(d) > 360.0:
        raise ReaderError(
            f"{where} must span at most 360 degrees, got {d.min()} to {d.max()} degrees"
        )
    turned = np.mod(np.round(d, 6), 360.0)  # a float32 axis of 0.1 degree steps is good to 3e-5
    order = np.argsort(turned, kind="stable")
    same = np.diff(turned[order]) <= 1e-4
    if np.any(same):
        raise ReaderError(
            f"{where} must hold each direction once (0 and 360 degrees are one), "
            f"got {turned[order][int(np.argmax(same))]} twice"
        )
    span = 360.0 - float(np.max(np.diff(turned[order], append=turned[order][0] + 360.0)))
    if span <= 2.0 * np.pi + 1e-3:
        raise ReaderError(
            f"{where} must be in degrees, as its unit says, but spans {span:.4g} in {d.size} "
            "steps: is it in radians?"
        )
    return turned[order], order


def densities(
    where: str, values: RealLike, unit: str, *, negative: str = "refuse"
) -> tuple[Real, dict[str, Any]]:
    """
    Check spectral densities: mask missing values, set rounding below 0 to 0, refuse the rest.

    Args:
        where: name of the values in errors.
        values: any shape, in `unit`; NaN is missing.
        unit: m2/Hz or m2/Hz/degree.
        negative: "refuse" negative values beyond rounding, or "clip" them to 0. In a spectrum
            with directions (the last axis) the others of the same frequency are scaled, so that its
            energy is unchanged.

    Returns:
        float64 values >= 0, NaN where masked, same shape; and the numbers of masked values, of
        small negatives set to 0, and of clipped ones.

    Raises:
        ReaderError: infinite, negative by more than rounding (1e-7 of the largest), or larger than
            `LARGEST`.
        ParameterError: another `negative`.
    """
    if negative not in NEGATIVE:
        raise ParameterError(f"negative must be one of {', '.join(NEGATIVE)}, got {negative!r:.40}")
    e: Real = np.array(values, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        masked = int(np.count_nonzero(np.isnan(e)))
        largest = float(np.max(e, initial=0.0, where=~np.isnan(e)))
        wrong = (e < -max(ROUNDING * largest, 1e-12)) | (e > LARGEST)
    notes: dict[str, Any] = {}
    if negative == "clip":
        e, notes = _clipped(e, wrong & (e < 0.0), directional=unit == "m2/Hz/degree")
        wrong &= e > LARGEST
    if np.any(wrong):
        place = tuple(int(i) for i in np.argwhere(wrong)[0])
        hint = (
            ' (Sea.from_spectrum(dataset, negative="clip") takes them as 0)'
            if e[place] < 0.0
            else ""
        )
        raise ReaderError(
            f"{where} must be between 0 and {LARGEST:g} {unit}, got {e[place]} at {place}{hint}"
        )
    with np.errstate(invalid="ignore"):
        small = e < 0.0
    e[small] = 0.0
    return e, {"masked_values": masked, "rounded_negatives": int(np.count_nonzero(small)), **notes}


def _clipped(
    e: Real, wrong: npt.NDArray[np.bool_], *, directional: bool
) -> tuple[Real, dict[str, Any]]:
    """Set negative densities to 0; with directions, keep the sum of each frequency."""
    count = int(np.count_nonzero(wrong))
    if not count:
        return e, {}
    clipped = np.maximum(e, 0.0)  # keeps NaN
    if directional:
        before = np.nansum(e, axis=-1, keepdims=True)
        after = np.nansum(clipped, axis=-1, keepdims=True)
        clipped = clipped * np.where(
            after > 0.0, np.maximum(before, 0.0) / np.where(after > 0.0, after, 1.0), 1.0
        )
    share = float(-np.sum(e[wrong]) / np.nansum(np.abs(e)))
    kept = ", the energy of each frequency kept" if directional else ""
    return clipped, {
        "clipped_negatives": count,
        "negative_note": (
            f"{count} negative densities ({100.0 * share:.2g} % of all) were taken as 0{kept}"
        ),
    }


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
    bands: Real | None = None,
    notes: Mapping[str, Any] | None = None,
) -> "Dataset":
    """
    Return checked numbers as a dataset in this layout.

    Args:
        source: the file's name.
        source_format: the format of the file, in words.
        frequency: (f,) ascending [Hz].
        density: (time, f, d) [m2/Hz/degree], or (time, f) [m2/Hz] without directions; NaN is
            missing.
        direction: (d,) ascending, FROM, clockwise from north [degrees].
        time: (time,) datetime64, if known.
        depth: (time,) [m], if known.
        position: `lon`, `lat` [degrees] or `x`, `y` [m], if known.
        bands: (f, 2) lower and upper edge of each frequency's band [Hz], if the file has them.
        notes: further attributes.
    """
    xr = load_xarray()
    variables: dict[str, Any] = {}
    coords: dict[str, Any] = {
        "freq": ("freq", frequency, {"standard_name": "sea_surface_wave_frequency", "units": "Hz"}),
    }
    if time is not None:
        coords["time"] = (
            "time",
            np.asarray(time, dtype="datetime64[ns]"),
            {"standard_name": "time"},
        )
    if direction is None:
        name = {"standard_name": "sea_surface_wave_variance_spectral_density", "units": "m2 s"}
        variables["ef"] = (("time", "freq"), density, name)
    else:
        name = {
            "standard_name": "sea_surface_wave_directional_variance_spectral_density",
            "units": "m2 s degree-1",
        }
        variables["efth"] = (("time", "freq", "dir"), density, name)
        coords["dir"] = (
            "dir",
            direction,
            {"standard_name": "sea_surface_wave_from_direction", "units": "degree"},
        )
    if bands is not None:
        coords["freq"][2]["bounds"] = "freq_bnds"
        coords["freq_bnds"] = (("freq", "bnds"), bands)
    if depth is not None:
        variables["dpt"] = (
            "time",
            depth,
            {"standard_name": "sea_floor_depth_below_sea_surface", "units": "m"},
        )
    for key, value in (position or {}).items():
        unit = {"lon": "degrees_east", "lat": "degrees_north"}.get(key, "m")
        coords[key] = ((), float(value), {"units": unit})
    made: Dataset = xr.Dataset(
        variables, coords, {"source": source, "source_format": source_format, **(notes or {})}
    )
    return made
