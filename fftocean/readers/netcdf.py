"""
Wave spectra in netCDF.

The formats are WAVEWATCH III point output, ERA5 2-D wave spectra, the layouts of the wavespectra
package and of this one, NDBC and CDIP.

A variable's attributes give its meaning, its unit and the sense of its directions. Names alone
decide only if a format's documents fix them: ERA5's `d2fd` and the `efth(freq, dir)` of
wavespectra. If two attributes disagree, or the necessary one is missing or unknown, the file is
refused: a sea turned by 180 degrees looks plausible.

Source: CF standard names; WAVEWATCH III manual (netCDF point output); ECMWF, ERA5 data
documentation, "Wave spectra".
"""

import io
import math
import re
import warnings
from collections.abc import Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.errors import ParameterError, ReaderError
from fftocean.limits import Count
from fftocean.readers import (
    bands,
    bounded_reads,
    circular,
    classic,
    dataset_layout,
    hdf5,
    moments,
    package,
    units,
)
from fftocean.readers.reader import Reader

if TYPE_CHECKING:
    from xarray import DataArray, Dataset

CLASSIC: Final = (b"CDF\x01", b"CDF\x02")

_AXES: Final = {
    "freq": ("freq", "frequency", "frequencyNumber", "waveFrequency"),
    "dir": ("dir", "direction", "directionNumber"),
    "time": ("time", "valid_time", "waveTime"),
}
_STANDARD_AXES: Final = {"freq": r".*frequency", "dir": r".*wave.*direction", "time": r"time"}
_SPECTRA: Final = {
    "sea_surface_wave_directional_variance_spectral_density": True,
    "sea_surface_wave_variance_spectral_density": False,
}
_WAYS: Final = ("standard_name", "long_name", "convention")
_NAMES: Final = ("d2fd", "efth", "ef", *circular.DENSITIES)
_MOST_READ: Final = 2**31  # bytes unpacked for one place: ten seconds
_FIRST: Final = "frequency1"
_SECOND: Final = "frequency2"
_WIDTHS: Final = ("df", "waveBandwidth", "bandwidth", "frequency_bandwidth")


@dataclass(frozen=True, slots=True)
class _Family:
    """A netCDF format and its documented defaults for missing attributes."""

    name: str
    documented: bool  # Hz, degrees (or bin numbers) and density unit may be omitted
    goes_to: bool | None = None  # documented sense of the directions; None: must be stated
    per: str = "degree"  # documented unit of the density
    log10: bool = False


_ERA5: Final = _Family(
    "ERA5 2-D wave spectra netCDF", documented=True, goes_to=True, per="radian", log10=True
)
_WAVESPECTRA: Final = _Family("wavespectra netCDF", documented=True, goes_to=False)
_DECLARED: Final = _Family("CF netCDF (WAVEWATCH III)", documented=False)


def recognises(magic: bytes) -> bool:
    """Return True if a file with these first bytes is netCDF, of a readable version or not."""
    return magic.startswith((hdf5.MAGIC, b"CDF"))


def read(path: Path, *, site: int, bins: int = 72) -> "Dataset":
    """
    Read the spectra of one place.

    Raises:
        ReaderError: a broken file, one without spectra, or one whose attributes are missing,
            unknown or contradictory.
        ParameterError: `site` is not in the file.
    """
    xr = dataset_layout.load_xarray()
    magic = bounded_reads.head(path, 8)
    if not magic.startswith((hdf5.MAGIC, *CLASSIC)):
        raise ReaderError(
            f"{path.name} must be netCDF 3 (classic or 64-bit offset) or 4, "
            f"got CDF version {magic[3]} (convert it with nccopy)"
        )
    modern = magic.startswith(hdf5.MAGIC)
    with _broken(path.name), warnings.catch_warnings():
        # Warnings of two fill values or odd calendars: the checks below cover what matters.
        warnings.simplefilter("ignore")
        # One stream for check and reading: the file cannot change in between, and the libraries can
        # neither map it nor leave it open when they fail.
        with (
            bounded_reads.contents(path)
            if bounded_reads.is_packed(path)
            else bounded_reads.opened(path) as stream
        ):
            unread: list[str] = []
            if modern:
                unread = hdf5.require_sound(path.name, stream)
            else:
                classic.require_sound(path.name, stream)
            size = stream.seek(0, io.SEEK_END)
            stream.seek(0)
            for name in unread:
                if name in _NAMES:
                    raise ReaderError(
                        f"{path.name}: variable {name} must hold numbers, got another type"
                    )
            engine = "h5netcdf" if modern else "scipy"
            with xr.open_dataset(
                stream, engine=engine, decode_timedelta=False, drop_variables=unread
            ) as raw:
                return to_layout(raw, site=site, source=path.name, bins=bins, file_bytes=size)


@contextmanager
def _broken(name: str) -> Iterator[None]:
    """
    Turn any exception of the netCDF libraries on damaged bytes into one that names the file.
    """
    try:
        yield
    except ParameterError:
        raise
    except ImportError as error:
        if any(word in str(error) for word in ("xarray", "h5netcdf", "h5py")):
            raise dataset_layout.not_installed(error) from error
        raise ReaderError(
            f"{name} cannot be read as netCDF without a package that is not installed: "
            f"{error!s:.200}"
        ) from error
    except (OSError, ValueError) as error:  # whose words are about the file
        reason = str(error) or "no reason given"
        raise ReaderError(f"{name} cannot be read as netCDF: {reason:.200}") from error
    except Exception as error:  # whose words are about the program that reads it
        raise ReaderError(
            f"{name} cannot be read as netCDF: the file is cut short or damaged"
        ) from error


def to_layout(
    raw: "Dataset | DataArray",
    *,
    site: int = 0,
    time: int | None = None,
    source: str = "the dataset",
    bins: int = 72,
    negative: str = "refuse",
    file_bytes: int | None = None,
) -> "Dataset":
    """
    Return an opened dataset of any known kind in the layout of `dataset_layout`.

    A dataset already in that layout is returned unchanged.

    Args:
        raw: as xarray decodes it; dimensions in any order.
        site: index of the place: the position along all dimensions but time, frequency and
            direction, in the variable's own order (a grid is counted row by row).
        time: index of one time; None for all.
        source: name of the dataset in errors.
        bins: directions round the compass into which the moments of a buoy are unfolded.
        negative: treatment of negative densities, "refuse" or "clip", see
            `dataset_layout.densities`.
        file_bytes: size of the file from which values are still to be read, if any.

    Raises:
        ReaderError: no spectrum, or attributes that are missing, unknown or contradictory.
        ParameterError: `site` or `time` is not in the dataset.
    """
    raw = package.as_dataset(raw, source)
    spectrum, directional = _spectrum(raw, source)
    where = f"{source}: variable {spectrum.name}"
    if {"scale_factor", "add_offset", "_FillValue"} & spectrum.attrs.keys():
        raise ReaderError(
            f"{where} must be decoded, got it packed (open it with mask_and_scale=True)"
        )
    axes = _axes(raw, spectrum)
    if "freq" not in axes:
        raise ReaderError(f"{where} must have a frequency dimension, got {tuple(spectrum.dims)}")
    family = _family(spectrum, axes)
    _require_sane_packing(where, spectrum)
    if "dir" in axes and family is _WAVESPECTRA and spectrum.sizes[axes["dir"]] == 1:
        # wavespectra holds a buoy without directions in this form.
        spectrum = spectrum.isel({axes.pop("dir"): 0})
        directional = False
    if directional is None:
        directional = "dir" in axes
    if directional and "dir" not in axes:
        raise ReaderError(
            f"{where} must have a direction dimension (a spectrum without is `ef`, in m2 s), "
            f"got {tuple(spectrum.dims)}"
        )

    picked, notes = _pick(where, spectrum, axes, site=site, time=time)
    if file_bytes is not None:
        _require_sane_read(where, spectrum, picked, file_bytes)
    spectrum = spectrum.isel(picked)
    if spectrum.size > dataset_layout.MAX_VALUES:
        raise ReaderError(
            f"{where} must have at most {dataset_layout.MAX_VALUES} values at one place, "
            f"got {spectrum.size} (open and cut it with xarray)"
        )
    order = [
        axes[role]
        for role in ("time", "freq", "dir")
        if role in axes and axes[role] in spectrum.dims
    ]
    values = _numbers(where, spectrum.transpose(*order))
    with np.errstate(invalid="ignore"):
        values[np.abs(values) > dataset_layout.FILL] = np.nan
    if "time" not in axes or axes["time"] not in spectrum.dims:
        values = values[np.newaxis]

    there, f = _frequency(raw, axes, family, source)
    kept, left_out = dataset_layout.above_zero(f)
    frequency, f_order = dataset_layout.frequencies(there, f[kept])
    f_order = np.flatnonzero(kept)[f_order]
    notes |= left_out
    edges = _bands(raw, axes["freq"], frequency, f_order, source)
    if (logarithm := _logarithm(where, spectrum.attrs)) is not None and not family.log10:
        values = units.Unit(1.0, {}, logarithm.base, logarithm.offset).linear(values)
    scale = _per_degree(where, spectrum.attrs, family, directional)
    values = scale * values[:, f_order]
    direction = None
    if directional:
        there, bearing, goes_to = _direction(raw, axes, family, source)
        if goes_to and family is _WAVESPECTRA and scale == 1.0:
            goes_to = not _is_stale(raw[axes["dir"]].attrs, spectrum.attrs)
            taken = (
                "go to there, and so it is taken"
                if goes_to
                else "come from there, and so it is taken: the attribute is left over"
            )
            notes["direction_note"] = (
                f"{there} says that waves go to there, in a layout in which they come from "
                f"there: they {taken}"
            )
        values, bearing, repeated = package.once_round(values, bearing)
        notes |= repeated
        if goes_to:
            bearing = np.mod(bearing, 360.0) + 180.0
        direction, d_order = dataset_layout.directions(there, bearing)
        values = values[:, :, d_order]
    if family.log10:
        values, empty = _from_log10(where, values)
        notes["below_threshold_values"] = empty
    unit = "m2/Hz/degree" if directional else "m2/Hz"
    density, counts = dataset_layout.densities(where, values, unit, negative=negative)
    if not directional:

        def at_place(variable: "DataArray") -> Real:
            if file_bytes is not None:
                _require_sane_read(
                    f"{source}: variable {variable.name}", variable, picked, file_bytes
                )
            return _table(source, variable.isel(picked), order)[:, f_order]

        pair = circular.find(raw, spectrum.name, source, at_place)
        if pair is not None:
            density, done = moments.unfold(density, *pair, bins)
            direction = moments.compass(bins)
            notes |= done
    return dataset_layout.dataset(
        source=source if source != "the dataset" else str(raw.attrs.get("source", source)),
        source_format=str(
            raw.attrs.get("source_format", circular.FAMILIES.get(str(spectrum.name), family.name))
        ),
        frequency=frequency,
        density=density,
        direction=direction,
        time=_times(raw, axes, picked, source),
        depth=_depth(raw, axes, picked, len(density)),
        position=_position(raw, picked),
        bands=edges,
        notes={**counts, **_assumed(raw, spectrum, axes, family), **notes},
    )


def _table(source: str, variable: "DataArray", order: Sequence[Hashable]) -> Real:
    """Return the values of one place, (time, f), NaN for fill values."""
    values = _numbers(f"{source}: variable {variable.name}", variable.transpose(*order))
    with np.errstate(invalid="ignore"):
        values[np.abs(values) > dataset_layout.FILL] = np.nan
    return np.atleast_2d(values)


def _spectrum(raw: "Dataset", source: str) -> tuple["DataArray", bool | None]:
    """Return the variable with the spectra, and whether its attributes state directions."""
    for name in _NAMES:
        if name in raw.data_vars:
            return raw[name], _SPECTRA.get(str(raw[name].attrs.get("standard_name")))
    found = [name for name, v in raw.data_vars.items() if v.attrs.get("standard_name") in _SPECTRA]
    if len(found) != 1:
        held = ", ".join(str(name) for name in found or raw.data_vars) or "nothing"
        raise ReaderError(
            f"{source} must hold one wave spectrum (efth, d2fd, "
            f"or a variable with its standard_name), got {held:.200}"
        )
    return raw[found[0]], _SPECTRA[raw[found[0]].attrs["standard_name"]]


def _axes(raw: "Dataset", spectrum: "DataArray") -> dict[str, Hashable]:
    """
    Return the dimensions of frequency, direction, time, by name or coordinate's standard name.
    """
    axes: dict[str, Hashable] = {}
    for role, names in _AXES.items():
        by_name = [d for d in spectrum.dims if d in names]
        by_word = [
            d
            for d in spectrum.dims
            if d in raw
            and re.fullmatch(_STANDARD_AXES[role], str(raw[d].attrs.get("standard_name", "")))
        ]
        for d in (*by_name, *by_word)[:1]:
            axes[role] = d
    return axes


def _family(spectrum: "DataArray", axes: Mapping[str, Hashable]) -> _Family:
    if spectrum.name == "d2fd":
        return _ERA5
    if (
        spectrum.name in ("efth", "ef")
        and axes["freq"] == "freq"
        and axes.get("dir", "dir") == "dir"
    ):
        return _WAVESPECTRA
    return _DECLARED


def _pick(
    where: str, spectrum: "DataArray", axes: Mapping[str, Hashable], *, site: int, time: int | None
) -> tuple[dict[Hashable, int], dict[str, Any]]:
    """Return the index along each dimension that is dropped."""
    others = [d for d in spectrum.dims if d not in axes.values()]
    shape = tuple(spectrum.sizes[d] for d in others)
    sites = int(np.prod(shape, dtype=np.int64))
    if sites < 1:
        raise ReaderError(
            f"{where} must hold at least one place, got dimensions {dict(spectrum.sizes)}"
        )
    site = Count("", 0, sites - 1).check("site", site)
    picked = dict(
        zip(others, (int(i) for i in np.unravel_index(site, shape)) if others else (), strict=True)
    )
    times = spectrum.sizes[axes["time"]] if "time" in axes else 1
    if times < 1:
        raise ReaderError(f"{where} must hold at least one time, got none")
    if time is not None:
        time = Count("", -times, times - 1).check("time", time) % times
        if "time" in axes:
            picked[axes["time"]] = time
    return picked, {"site": site, "sites": sites}


def _require_sane_read(
    where: str, spectrum: "DataArray", picked: Mapping[Hashable, int], file_bytes: int
) -> None:
    """
    Raise if values unpack to more than a file of this size can hold, or take too long to unpack.
    """
    chunks = spectrum.encoding.get("chunksizes") or (1,) * spectrum.ndim
    read = np.dtype(spectrum.encoding.get("dtype", spectrum.dtype)).itemsize
    for dim, chunk in zip(spectrum.dims, chunks, strict=True):
        # Chunks are unpacked whole.
        read *= chunk * (1 if dim in picked else -(-spectrum.sizes[dim] // chunk))
    if read > _MOST_READ or read > 2**20 + hdf5.MOST_RATIO * file_bytes:
        raise ReaderError(
            f"{where} must be readable for one place by unpacking at most {_MOST_READ >> 20} "
            f"MiB, and no more than its file of {file_bytes} bytes can hold, "
            f"got {read >> 20} MiB (cut out the place with xarray)"
        )


def _numbers(where: str, variable: "DataArray") -> Real:
    """
    Return the values of a variable as float64; NaN stands for a missing one.

    This is the only conversion of arrays from netCDF files. `Quantity.check_array` is for
    arguments: it judges entries by a range and blames the caller. Here the type of the variable is
    judged, the entries later by what they mean, and the file is blamed.

    Raises:
        ReaderError: the variable holds times, texts or objects.
    """
    if variable.dtype.kind not in "fiu":
        raise ReaderError(f"{where} must hold numbers, got {variable.dtype}")
    return np.array(variable.values, dtype=np.float64)


def _coordinate(
    raw: "Dataset", axes: Mapping[str, Hashable], role: str, source: str
) -> tuple[str, "DataArray"]:
    name = axes[role]
    if name not in raw.variables or raw[name].dims != (name,):
        raise ReaderError(
            f"{source}: dimension {name} must have a coordinate variable along itself, got none"
        )
    _require_sane_packing(f"{source}: variable {name}", raw[name])
    return f"{source}: variable {name}", raw[name]


def _frequency(
    raw: "Dataset", axes: Mapping[str, Hashable], family: _Family, source: str
) -> tuple[str, Real]:
    """Return the error prefix and the frequencies [Hz]."""
    where, f = _coordinate(raw, axes, "freq", source)
    values = _numbers(where, f)
    if family is _ERA5 and (numbers := _bin_numbers(where, values, 30)) is not None:
        return where, 0.03453 * 1.1 ** (numbers - 1.0)
    unit = units.parse(f.attrs.get("units", "Hz" if family.documented else ""))
    if unit is None or not unit.is_(s=-1):
        raise ReaderError(f"{where} must have units Hz or s-1, got {f.attrs.get('units')!r}")
    return where, values * unit.scale


def _bands(
    raw: "Dataset", axis: Hashable, frequency: Real, order: Integer, source: str
) -> Real | None:
    """
    Return the edges of the bands that the file states, (f, 2) [Hz], or None.

    By CF's `bounds` attribute, WAVEWATCH III's `frequency1` and `frequency2`, or a width of each
    band.
    """
    f = raw[axis]
    name = f.attrs.get("bounds", f.encoding.get("bounds"))
    found: list[tuple[Hashable, DataArray]] = []
    if name in raw.variables:
        found = [
            (name, raw[name].isel({raw[name].dims[-1]: i}))
            for i in range(2)
            if raw[name].ndim == 2 and raw[name].shape[1] == 2
        ]
    elif _FIRST in raw.variables and _SECOND in raw.variables:
        found = [(_FIRST, raw[_FIRST]), (_SECOND, raw[_SECOND])]
    else:
        width = next((w for w in _WIDTHS if w in raw.variables and raw[w].dims == (axis,)), None)
        if width is None:
            return None
        where = f"{source}: variable {width}"
        return bands.of_widths(
            where, frequency, _hertz(where, raw[width], f.attrs.get("units", "Hz"))[order]
        )
    if not found or any(edge.dims != (axis,) for _, edge in found):
        raise ReaderError(
            f"{source}: variable {name or _FIRST} must hold two edges of the band of each {axis}"
        )
    edges = [
        _hertz(f"{source}: variable {name}", edge, f.attrs.get("units", "Hz"))[order]
        for name, edge in found
    ]
    return bands.checked(f"{source}: variable {found[0][0]}", frequency, np.stack(edges, axis=1))


def _hertz(where: str, variable: "DataArray", unit: str) -> Real:
    """Return frequencies in Hz; bounds without a unit have that of their axis, as CF says."""
    said = variable.attrs.get("units", unit)
    parsed = units.parse(said)
    if parsed is None or not parsed.is_(s=-1):
        raise ReaderError(f"{where} must have units Hz or s-1, got {said!r:.60}")
    return _numbers(where, variable) * parsed.scale


def _direction(
    raw: "Dataset", axes: Mapping[str, Hashable], family: _Family, source: str
) -> tuple[str, Real, bool]:
    """
    Return the error prefix, the directions [degrees, clockwise from N], and whether they are TO.
    """
    where, d = _coordinate(raw, axes, "dir", source)
    values = _numbers(where, d)
    if family is _ERA5 and (numbers := _bin_numbers(where, values, 24)) is not None:
        values = 7.5 + 15.0 * (numbers - 1.0)
    else:
        unit = units.parse(d.attrs.get("units", "degree" if family.documented else ""))
        turn = np.nanmax(np.abs(values), initial=0.0)
        if unit is not None and unit.is_(rad=1) and unit.scale == 1.0:
            if turn > 4.0 * np.pi + 1e-3:
                raise ReaderError(
                    f"{where} must be in radians, as its unit says, but reaches {turn:.4g}: "
                    "is it in degrees?"
                )
            values = np.degrees(values)
        elif unit is None or not unit.is_(rad=1):
            raise ReaderError(
                f"{where} must have units degree or radian, got {d.attrs.get('units')!r}"
            )
    return where, values, _goes_to(where, d.attrs, family)


def _bin_numbers(where: str, values: Real, most: int) -> Real | None:
    """
    Return the values of an ERA5 axis of bin numbers, 1 to `most`, or None if it has Hz or degrees.

    Integers are bin numbers: no sea has only waves of 1, 2, 3 Hz.
    """
    whole = bool(np.all(values == np.rint(values))) and bool(np.all(np.abs(np.diff(values)) == 1.0))
    if not whole or values.size < 2:
        return None
    if values.min() < 1.0 or values.max() > most:
        raise ReaderError(
            f"{where} must hold bin numbers between 1 and {most}, "
            f"got {values.min():g} to {values.max():g}"
        )
    return values


def _goes_to(where: str, attrs: Mapping[str, Any], family: _Family) -> bool:
    """Return True if waves go TO the directions, False if they come FROM them."""
    said: dict[bool, str] = {}
    for key in _WAYS:
        text = str(attrs.get(key, ""))
        words = set(
            re.split(r"[^a-z]+", re.sub(r"(relative|respect|referred) to", "", text.lower()))
        )
        if key == "standard_name" and text and "wave" not in words:
            raise ReaderError(f"{where} must be a wave direction, got standard_name {text!r:.60}")
        if words & {"to", "toward", "towards"}:
            said[True] = f"{key} {text!r:.60}"
        if words & {"from"}:
            said[False] = f"{key} {text!r:.60}"
    if len(said) == 2:
        raise ReaderError(
            f"{where} must state one sense, where waves come from or where they go to, "
            f"got {said[False]} and {said[True]}"
        )
    if said:
        return next(iter(said))
    if family.goes_to is None:
        raise ReaderError(
            f"{where} must state whether waves come from there or go there (standard_name "
            "sea_surface_wave_from_direction or _to_direction)"
        )
    return family.goes_to


def _is_stale(direction: Mapping[str, Any], density: Mapping[str, Any]) -> bool:
    """
    Return True if the attributes of `dir` are stale ones of WAVEWATCH III.

    The wavespectra package reverses that model's directions and converts densities to per degree,
    but leaves the model's attributes on `dir`; only they include `globwave_name` or an axis "Z".
    """
    return (
        "globwave_name" in direction
        or direction.get("axis") == "Z"
        or "_variable_name" in density
        or density.get("units") is None
    )


def _require_sane_packing(where: str, variable: "DataArray") -> None:
    """Raise if a scale or an offset would make all values 0, or not finite."""
    for key, low, high in (("scale_factor", 1e-30, 1e30), ("add_offset", 0.0, 1e30)):
        number = np.asarray(variable.encoding.get(key, 1.0))
        right = (
            number.size == 1
            and number.dtype.kind in "iuf"
            and bool(low <= abs(float(number.ravel()[0])) <= high)
        )
        if not right or (key == "scale_factor" and float(number.ravel()[0]) < 0.0):
            rule = (
                f"between {low:g} and {high:g}"
                if key == "scale_factor"
                else f"of a size up to {high:g}"
            )
            raise ReaderError(
                f"{where}: attribute {key} must be a number {rule}, "
                f"got {variable.encoding.get(key)!r:.40}"
            )


def _assumed(
    raw: "Dataset", spectrum: "DataArray", axes: Mapping[str, Hashable], family: _Family
) -> dict[str, str]:
    """
    Return a note of the facts that attributes omit and the format's documents supply.
    """
    silent = []
    if "units" not in spectrum.attrs and "GRIB_units" not in spectrum.attrs:
        silent.append(f"densities per {family.per}" if "dir" in axes else "densities in m2/Hz")
    if "units" not in raw[axes["freq"]].attrs:
        silent.append("frequencies in Hz")
    if "dir" in axes:
        attrs = raw[axes["dir"]].attrs
        if "units" not in attrs:
            silent.append("directions in degrees")
        if not re.search(
            r"(^|[^a-z])(to|towards?|from)([^a-z]|$)",
            " ".join(str(attrs.get(k, "")).lower() for k in _WAYS),
        ):
            silent.append(
                "directions to which waves go"
                if family.goes_to
                else "directions from which waves come"
            )
    return (
        {"assumed": f"{', '.join(silent)}, as {family.name} is documented"}
        if silent and family.documented
        else {}
    )


def _per_degree(where: str, attrs: Mapping[str, Any], family: _Family, directional: bool) -> float:
    """
    Return the factor from the variable's unit to m2/Hz/degree (m2/Hz without directions).

    The factor is 1 for logarithms, which are scaled later.
    """
    text = attrs.get("units", attrs.get("GRIB_units"))
    if text is None and family.documented:
        scale = np.pi / 180.0 if directional and family.per == "radian" else 1.0
    else:
        scale = _unit(where, text, directional)
    if family.log10:
        if abs(scale - np.pi / 180.0) > 1e-12:
            raise ReaderError(f"{where} must have units m**2 s radian**-1, got {text!r:.60}")
        return 1.0
    return scale


def _unit(where: str, text: Any, directional: bool) -> float:
    """
    Return the factor from a unit, in any spelling of UDUNITS, to m2/Hz/degree (m2/Hz).
    """
    unit = units.parse(text)
    right = {"m": 2, "s": 1, "rad": -1} if directional else {"m": 2, "s": 1}
    if unit is None or not unit.is_(**right):
        raise ReaderError(
            f"{where} must have units m2/Hz{' per degree or radian' if directional else ''}, "
            f"got {text!r:.60}"
        )
    return unit.scale * (np.pi / 180.0 if directional else 1.0)


def _logarithm(where: str, attrs: Mapping[str, Any]) -> units.Unit | None:
    """
    Return the logarithm (base and added offset) that a variable declares, or None.
    """
    unit = units.parse(attrs.get("units"))
    if unit is not None and unit.base is not None:
        return unit
    said = " ".join(str(attrs.get(key, "")) for key in ("standard_name", "long_name"))
    words = set(re.split(r"[^a-z0-9]+", said.lower()))
    if not words & {"logarithm", "log", "log10", "ln", "lg"}:
        return None
    if words & {"natural", "ln"}:
        return units.Unit(base=math.e)
    if words & {"ten", "10", "log10", "lg", "decadic", "common"}:
        return units.Unit(base=10.0)
    raise ReaderError(
        f"{where} must state the base of its logarithm (in units: 'log10(m2 s rad-1)'), "
        f"got {said!r:.80}"
    )


def _from_log10(where: str, values: Real) -> tuple[Real, int]:
    """
    Return densities from ERA5's log10 of m2/Hz/radian, and the number set to 0.

    ERA5 omits values of almost no energy: they become 0. A spectrum that is missing altogether
    (land, ice) stays missing.
    """
    with np.errstate(invalid="ignore"):
        wrong = values > np.log10(dataset_layout.LARGEST * 180.0 / np.pi)
    if np.any(wrong):
        raise ReaderError(
            f"{where} must be log10 of a density, at most 7.7, got {values[wrong][0]}"
        )
    nothing = np.isnan(values)
    gaps = nothing & ~np.all(nothing, axis=(1, 2), keepdims=True)
    with np.errstate(under="ignore"):
        values = 10.0**values * (np.pi / 180.0)
    values[gaps] = 0.0
    return values, int(np.count_nonzero(gaps))


def _times(
    raw: "Dataset", axes: Mapping[str, Hashable], picked: Mapping[Hashable, int], source: str
) -> Any:
    """Return the times as datetime64, or None."""
    name = axes.get("time", "time")
    if name not in raw.variables:
        return None
    times = np.asarray(
        raw[name].isel({d: i for d, i in picked.items() if d in raw[name].dims}).values
    )
    if not np.issubdtype(times.dtype, np.datetime64):
        raise ReaderError(
            f"{source}: variable {name} must be a time of the usual calendar with units like "
            f"'days since 1990-01-01', got {times.dtype}"
        )
    if np.any(np.isnat(times)):
        raise ReaderError(f"{source}: variable {name} must have no missing times")
    return np.atleast_1d(times)


def _at(variable: "DataArray", picked: Mapping[Hashable, int]) -> "DataArray":
    return variable.isel({d: i for d, i in picked.items() if d in variable.dims})


def _depth(
    raw: "Dataset", axes: Mapping[str, Hashable], picked: Mapping[Hashable, int], count: int
) -> Real | None:
    """Return the water depth at each time [m], NaN if unknown or not positive."""
    for name, variable in raw.variables.items():
        if name == "dpt" or str(variable.attrs.get("standard_name", "")).startswith(
            "sea_floor_depth_below"
        ):
            depth = _at(raw[name], picked)
            unit = units.parse(variable.attrs.get("units", "m"))
            if set(depth.dims) <= {axes.get("time")} and unit is not None and unit.is_(m=1):
                values = unit.scale * np.broadcast_to(
                    np.asarray(depth.values, dtype=np.float64), (count,)
                )
                return np.where((values > 0.0) & (values < 1e5), values, np.nan)
    return None


def _position(raw: "Dataset", picked: Mapping[Hashable, int]) -> dict[str, float]:
    """Return longitude and latitude, or x and y, at the first time."""
    position = {}
    for key, names in (
        ("lon", ("lon", "longitude")),
        ("lat", ("lat", "latitude")),
        ("x", ("x",)),
        ("y", ("y",)),
    ):
        for name in names:
            if name in raw.variables:
                values = np.asarray(_at(raw[name], picked).values).ravel()
                if (
                    values.size
                    and np.issubdtype(values.dtype, np.number)
                    and np.isfinite(values[0])
                ):
                    position[key] = float(values[0])
    return position


READER: Final = Reader(
    name="netCDF",
    extensions=(".nc",),
    description="Spectra of WAVEWATCH III, ERA5, the wavespectra package, NDBC, "
    "and what follows the CF conventions.",
    sniff=lambda head: recognises(head.data),
    read=lambda path, site, bins: read(path, site=site, bins=bins),
)
