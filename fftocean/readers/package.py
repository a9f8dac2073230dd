"""Datasets and arrays of the wavespectra package."""

import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ReaderError
from fftocean.readers import units

if TYPE_CHECKING:
    from xarray import DataArray, Dataset

_NAMES: Final = ("efth", "ef")
_DIRECTIONAL: Final = "sea_surface_wave_directional_variance_spectral_density"
_UNDIRECTED: Final = "sea_surface_wave_variance_spectral_density"


def as_dataset(given: Any, source: str) -> "Dataset":
    """
    Return a dataset of spectra from a dataset or a bare array of densities.

    The package's transforms (`rotate`, `smooth`, `split`), partitions and `oned` return arrays,
    with and without a name, and keep stale attributes: those of directions on a spectrum that has
    none, radians on directions in degrees, prose as units of frequency. In the package's own
    layout, `efth` or `ef` on `freq` and perhaps `dir`, the documented attributes replace stale
    ones.

    Args:
        given: an xarray.Dataset or DataArray.
        source: name of the dataset in errors.

    Raises:
        ReaderError: neither of these, or an array that is no density.
    """
    if hasattr(given, "data_vars"):
        dataset: Dataset = given
    elif hasattr(given, "dims") and hasattr(given, "coords") and hasattr(given, "to_dataset"):
        dataset = _named(given, source)
    else:
        raise ReaderError(
            f"{source} must be an xarray.Dataset or DataArray, got {type(given).__name__}"
        )
    return _without_left_overs(dataset)


def _named(array: "DataArray", source: str) -> "Dataset":
    """Return a dataset of an array, which is `efth` if it has no name (as from `split`)."""
    said = array.attrs.get("units")
    unit = units.parse(said)
    wrong = unit is not None and unit.is_(m=2)
    if wrong or "energy" in str(array.name):
        raise ReaderError(
            f"{source} must hold densities (m2 s degree-1), got {array.name or 'an array'} in "
            f"{said!r:.40}, "
            "energies of bins (`to_energy`): give the spectrum from which they were made"
        )
    if array.name is None:
        array = array.rename("efth")
    return array.to_dataset()


def _without_left_overs(dataset: "Dataset") -> "Dataset":
    name = next((n for n in _NAMES if n in dataset.data_vars and "freq" in dataset[n].dims), None)
    if name is None:
        return dataset
    spectrum = dataset[name]
    if (
        "dir" not in spectrum.dims
        and spectrum.attrs.get("standard_name") in (_DIRECTIONAL, None)
        and name == "efth"
    ):
        attrs = {**spectrum.attrs, "standard_name": _UNDIRECTED}
        if _per_angle(attrs.get("units")):
            attrs["units"] = "m2 s"
        dataset = dataset.drop_vars("efth").assign(ef=spectrum.assign_attrs(attrs))
    for axis, right, powers in (("freq", "Hz", {"s": -1}), ("dir", "degree", {"rad": 1})):
        if axis not in dataset.coords or dataset[axis].dtype.kind not in "fiu":
            continue
        attrs = dict(dataset[axis].attrs)
        unit = units.parse(attrs.get("units"))
        prose = (
            isinstance(attrs.get("units"), str)
            and unit is None
            and re.search(r"\s", attrs["units"]) is not None
        )
        turned = axis == "dir" and unit is not None and unit.is_(**powers) and unit.scale == 1.0
        if prose or (turned and np.ptp(dataset[axis].values) > 2.0 * np.pi + 1e-3):
            attrs["units"] = right
            dataset = dataset.assign_coords({axis: (axis, dataset[axis].values, attrs)})
    return dataset


def _per_angle(text: object) -> bool:
    unit = units.parse(text)
    return unit is not None and unit.is_(m=2, s=1, rad=-1)


def once_round(values: Real, bearing: Real) -> tuple[Real, Real, dict[str, Any]]:
    """
    Return densities and directions without a last one that repeats the first, as in TRIAXYS.

    Args:
        values: (time, f, d) densities.
        bearing: (d,) directions [degrees].

    Returns:
        Both without the last direction if its densities repeat, and a note; else both unchanged.
    """
    if bearing.size < 5 or abs(abs(float(bearing[-1]) - float(bearing[0])) - 360.0) > 1e-6:
        return values, bearing, {}
    first, last = values[:, :, 0], values[:, :, -1]
    top = float(np.max(np.abs(first), initial=0.0, where=np.isfinite(first)))
    if not np.allclose(first, last, rtol=0.0, atol=1e-3 * top + 1e-9, equal_nan=True):
        return values, bearing, {}
    return values[:, :, :-1], bearing[:-1], {"repeated_directions": 1}
