"""
Labelled datasets of frames, of realised spectra, and their files.

Frames become an xarray.Dataset with CF attributes; a realised spectrum has the layout of the
wavespectra package. Attributes are plain numbers, strings and lists of numbers, in SI; directions
and spreads are in degrees. None is left out, and infinity is written as the word `inf`, which
`float` reads back: Zarr stores attributes as JSON, which has no infinity.
"""

import importlib
import math
import os
import shutil
import tempfile
import warnings
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean import __version__
from fftocean.arrays import Real, RealLike
from fftocean.cascade import Cascade
from fftocean.errors import OutputError, ParameterError, SeaWarning, described, how_to_install
from fftocean.fields import FIELDS
from fftocean.files import write_whole
from fftocean.host import require_memory
from fftocean.limits import DIRECTION, FREQUENCY, TIME
from fftocean.ocean import Frame, Ocean
from fftocean.statistics import measure
from fftocean.window import Window

if TYPE_CHECKING:
    from xarray import Dataset, Variable

CONVENTIONS: Final = "CF-1.11"

STANDARD_NAMES: Final = {
    "height": "sea_surface_height_above_mean_sea_level",
    "velocity_x": "surface_sea_water_x_velocity",
    "velocity_y": "surface_sea_water_y_velocity",
    "velocity_z": "upward_sea_water_velocity",
}
"""
The standard names that CF has for the fields (table 93); it has none for slopes, displacements and
what is derived from them.
"""

MAPS: Final = {
    **{name: (field.unit, field.caption) for name, field in FIELDS.items()},
    "normal": ("1", "unit normal of the displaced surface"),
    "jacobian": ("1", "area of the displaced over the still surface; below 0 it is folded"),
}
"""The maps that can be computed, with unit and caption."""

_MOST = 10**6  # numbers in an argument
_UNITS: Final = (
    "Attributes are in SI units, directions and spreads in degrees; directions are toward, "
    "counter-clockwise from +x."
)
_PERIODIC: Final = "Periodic in x and y. "
_SUMMED: Final = "The sum of several tiles on a window of the world, which does not repeat. "
_LAGRANGIAN: Final = (
    "Indexed by the undisturbed position (x, y) of the water, which is found at "
    "(x + choppiness displace_x, y + choppiness displace_y, height). "
)


def to_xarray(
    ocean: Ocean | Window, times: Iterable[float], maps: Sequence[str] = ("height",)
) -> "Dataset":
    """
    Compute frames as a dataset with CF-1.11 attributes.

    Args:
        ocean: any ocean, or a `Window` on a cascade, whose tiles have no grid in common.
        times: seconds, one or more, strictly ascending or descending as CF asks of a coordinate.
        maps: names of `MAPS`: the names of `fields.FIELDS`, "normal", "jacobian".

    Returns:
        An xarray.Dataset in the ocean's own dtype: each map (time, y, x), row 0 south; `normal`
        (time, y, x, component), whose components 0, 1, 2 are x, y, z. Every number is that of
        `ocean.frame(t)`, to the bit. Attributes hold the ocean's parameters, its sea, and the
        specified and realised statistics (`measure`).

        `time` [s] is time on the ocean's own clock. It has neither `axis` nor `standard_name`: in
        CF these, and units with `since`, denote a calendar date (section 4.4), which no ocean has.
        The unit is spelt `s`, as xarray takes `seconds` for a timedelta.

    Raises:
        ParameterError: an invalid time or map, more memory than is available, or xarray is not
            installed.
    """
    xr = _require("xarray")
    if not isinstance(ocean, Window):
        _require_ocean(ocean)
    t = _seconds(times)
    names = _maps(maps)
    g = ocean.grid
    shapes = {name: (t.size, *g.shape, *((3,) if name == "normal" else ())) for name in names}
    itemsize = np.dtype(ocean.dtype).itemsize
    whole = itemsize * sum(math.prod(shape) for shape in shapes.values())
    # a normal is computed from five fields, and a Jacobian from three of those
    one_frame = 7 * itemsize * g.nx * g.ny + whole / t.size
    require_memory(
        f"{t.size} times of {g.nx} x {g.ny} samples of {', '.join(names)}", whole + one_frame
    )
    attributes = _attributes(ocean)

    data = {name: np.empty(shape, ocean.dtype) for name, shape in shapes.items()}
    frame: Frame | None = None
    for i, moment in enumerate(t.tolist()):
        frame = ocean.frame(moment, names, out=frame)
        for name in names:
            data[name][i] = frame[name]

    x, y = (ocean.x + g.x, ocean.y + g.y) if isinstance(ocean, Window) else (g.x, g.y)
    coordinates: dict[str, Any] = {
        "time": ("time", t, {"units": "s", "long_name": "time on the ocean's own clock"}),
        "y": ("y", y, _axis("y", "north")),
        "x": ("x", x, _axis("x", "east")),
    }
    if "normal" in names:
        index = np.arange(3, dtype=np.int8)
        flags = {
            "long_name": "component of a vector",
            "flag_values": index,
            "flag_meanings": "x y z",
        }
        coordinates["component"] = ("component", index, flags)
    variables = {
        name: (("time", "y", "x", "component")[: values.ndim], values, _map_attributes(name))
        for name, values in data.items()
    }
    title, place = (
        ("a window", _SUMMED) if isinstance(ocean, Window) else ("a periodic tile", _PERIODIC)
    )
    head = {
        "Conventions": CONVENTIONS,
        "title": f"Sea surface of {title}",
        "comment": place + _LAGRANGIAN + _UNITS,
    }
    made: Dataset = xr.Dataset(variables, coordinates, {**head, **attributes})
    return made


def realised_spectrum(
    ocean: Ocean, *, freq: RealLike | None = None, dir: RealLike | None = None
) -> "Dataset":
    """
    Return the realised 2-D spectrum of an ocean's waves, in the layout of the wavespectra package.

    Each wave's energy a^2/2 is distributed between the two frequencies and the two directions
    around it. In frequency the shares are linear: hat functions, whose integrals are the widths
    `np.gradient(freq)` with which wavespectra sums, so that its m0 and m1 are those of the waves to
    round-off, and white noise stays white. In direction the shares are those whose resultant
    points along the wave, sin(b) : sin(a) for a wave at angles a and b from its two bins. No share
    is negative, so bins of h radians widen the spread: by about h^2/6 in its square, which makes
    16.1 degrees of 16 with bins of 5.

    Args:
        ocean: any ocean.
        freq: two or more frequencies [Hz], ascending. By default the powers of 1.05 that cover all
            waves of the tile, the same for every sea on it, with an empty one at either end, so
            that wavespectra's `hs()` adds no tail of its own.
        dir: where waves come FROM, clockwise from north [degrees], evenly spaced round the circle;
            by default every 5 degrees.

    Returns:
        An xarray.Dataset: `efth` (freq, dir) [m2/Hz/degree], float64; `dpt`, the depth [m], where
        it is finite. Frequencies are those at which the waves run: on a loop, whole cycles in its
        period. Attributes are those of `to_xarray`, with `m0_outside` [m^2]: the energy of waves
        beyond the outermost bands of `freq`, which is left out, as by a wave buoy.

    Raises:
        ParameterError: invalid frequencies or directions, or xarray is not installed.

    Warns:
        SeaWarning: more than 1 % of the energy lies beyond `freq`.

    Pinned by tests/test_science.py, with wavespectra's own integrals.
    """
    xr = _require("xarray")
    _require_ocean(ocean)
    f = _powers(ocean) if freq is None else _frequencies(freq)
    bearing = np.arange(0.0, 360.0, 5.0) if dir is None else _bearings(dir)
    width, step = np.gradient(f), float(bearing[1] - bearing[0])
    require_memory(
        f"a spectrum of {f.size} frequencies by {bearing.size} directions",
        4.0 * 8 * f.size * bearing.size,
    )

    waves = ocean.modes()
    energy, hertz = 0.5 * waves.amplitude**2, waves.omega / (2.0 * np.pi)
    inside = (hertz >= f[0] - 0.5 * width[0]) & (hertz <= f[-1] + 0.5 * width[-1])
    outside, total = float(np.sum(energy[~inside])), float(np.sum(energy))
    if outside > 0.01 * total:
        message = (
            f"{outside / total:.1%} of the energy lies outside the frequencies {f[0]:g} to "
            f"{f[-1]:g} Hz, and is left out"
        )
        warnings.warn(message, SeaWarning, stacklevel=2)

    coming_from = 270.0 - np.degrees(np.arctan2(waves.ky[inside], waves.kx[inside]))
    binned = _distributed(
        energy[inside], np.clip(hertz[inside], f[0], f[-1]), coming_from, f, bearing
    )

    name = {
        "standard_name": "sea_surface_wave_directional_variance_spectral_density",
        "units": "m2 s degree-1",
    }
    variables: dict[str, Any] = {
        "efth": (
            ("freq", "dir"),
            binned / (width[:, None] * step),
            {**name, "long_name": "variance density of the waves in the tile"},
        )
    }
    if math.isfinite(ocean.depth):
        variables["dpt"] = (
            (),
            ocean.depth,
            {
                "standard_name": "sea_floor_depth_below_sea_surface",
                "units": "m",
                "long_name": "depth",
            },
        )
    from_north = {"units": "degree", "long_name": "where waves come from, clockwise from north"}
    coordinates = {
        "freq": (
            "freq",
            f,
            {"standard_name": "wave_frequency", "units": "Hz", "long_name": "frequency"},
        ),
        "dir": ("dir", bearing, {"standard_name": "sea_surface_wave_from_direction", **from_north}),
    }
    head = {
        "Conventions": CONVENTIONS,
        "title": "Realised spectrum of a periodic tile",
        "comment": _UNITS,
    }
    made: Dataset = xr.Dataset(
        variables, coordinates, {**head, **_attributes(ocean), "m0_outside": outside}
    )
    return made


def _distributed(energy: Real, hertz: Real, coming_from: Real, f: Real, bearing: Real) -> Real:
    """
    Return the energy of waves in the bins around them, (f, bearing) [m^2].

    `realised_spectrum` defines the shares.
    """
    i = np.clip(np.searchsorted(f, hertz, side="right") - 1, 0, f.size - 2)
    u = (hertz - f[i]) / (f[i + 1] - f[i])
    step = bearing[1] - bearing[0]
    steps = np.mod(coming_from - bearing[0], 360.0) / step
    j = np.floor(steps).astype(np.int64)
    below, above = (np.sin(np.radians(step * part)) for part in (steps - j, 1.0 - (steps - j)))
    v = below / (below + above)
    binned = np.zeros(f.size * bearing.size)
    for row, in_row in ((i, 1.0 - u), (i + 1, u)):
        for column, in_column in ((j, 1.0 - v), (j + 1, v)):
            binned += np.bincount(
                row * bearing.size + column % bearing.size, energy * in_row * in_column, binned.size
            )
    return binned.reshape(f.size, bearing.size)


def write(dataset: "Dataset", path: str | os.PathLike[str]) -> None:
    """
    Write a dataset of this module without loss: `.nc` is netCDF 4, `.zarr` is Zarr 3.

    Arrays carry checksums (Fletcher-32; CRC-32C), so that reading damaged ones raises an error. A
    chunk that is missing from a Zarr store reads as NaN, not as a flat sea. Read with
    `xarray.open_dataset(path)`.

    The file or store is either complete or absent. A netCDF file is encoded in memory and written
    from there, as HDF5 aborts the process when the disk is full; a file of that name is replaced. A
    Zarr store is a folder, which cannot be replaced in one step: an existing one is not touched.

    Args:
        dataset: from `to_xarray` or `realised_spectrum`.
        path: the file or store; its suffix sets the format.

    Raises:
        OutputError: the file or store cannot be written, or the store exists already.
        ParameterError: another suffix, more memory than is available, or h5netcdf or zarr is not
            installed.
    """
    path = Path(path)
    if not hasattr(dataset, "data_vars"):
        raise ParameterError(f"dataset must be an xarray.Dataset, got {type(dataset).__name__}")
    if path.suffix == ".nc":
        _write_netcdf(dataset, path)
    elif path.suffix == ".zarr":
        _write_zarr(dataset, path)
    else:
        raise ParameterError(f"the name must end in .nc (netCDF) or .zarr, got {str(path)!r:.200}")


def _write_netcdf(dataset: "Dataset", path: Path) -> None:
    """Write a netCDF 4 file, encoded in memory."""
    _require("h5netcdf")
    require_memory(f"encoding {path.name}", 1.1 * dataset.nbytes)
    encoding = _encoding(
        dataset, "chunksizes", lambda variable: {"fletcher32": True} if variable.ndim else {}
    )
    write_whole(path, dataset.to_netcdf(engine="h5netcdf", encoding=encoding))


def _write_zarr(dataset: "Dataset", path: Path) -> None:
    """Write a Zarr 3 store under a private name, and rename it when it is complete."""
    checksum = _require("zarr.codecs").Crc32cCodec()
    if os.path.lexists(path):
        raise OutputError(
            f"{path} exists already: a Zarr store is a folder, and cannot be replaced in one step"
        )
    encoding = _encoding(
        dataset,
        "chunks",
        lambda variable: {"compressors": (checksum,), **_fill_value(variable.dtype)},
    )
    try:
        private = Path(tempfile.mkdtemp(prefix=f".{path.name}.", dir=path.parent))
        try:
            whole = private / path.name
            with warnings.catch_warnings():
                # All metadata in one file is not in the specification yet; without it,
                # xarray.open_zarr warns at every reading.
                warnings.filterwarnings(
                    "ignore", message="Consolidated metadata is currently not part"
                )
                dataset.to_zarr(
                    whole, mode="w-", zarr_format=3, consolidated=True, encoding=encoding
                )
            for file in whole.rglob("*"):
                if file.is_file():
                    with file.open("r+b") as opened:
                        os.fsync(opened.fileno())
            whole.rename(path)
        finally:
            shutil.rmtree(private, ignore_errors=True)
    except OSError as error:
        raise OutputError(f"{path} could not be written: {error.strerror or error}") from error


def _encoding(
    dataset: "Dataset", chunks: str, more: Callable[["Variable"], dict[str, Any]]
) -> dict[Hashable, dict[str, Any]]:
    """
    Return the encoding of each variable.

    Chunks are parts of one frame, of at most 64 MiB; coordinates have no fill value, as CF demands.
    """
    encoding: dict[Hashable, dict[str, Any]] = {}
    for name, variable in dataset.variables.items():
        encoding[name] = more(variable) | ({"_FillValue": None} if name in dataset.coords else {})
        if variable.ndim:
            row = math.prod(variable.shape[2:]) * variable.dtype.itemsize
            by_frame = (
                (1, min(variable.shape[1], max(1, 2**26 // row)), *variable.shape[2:])
                if variable.ndim > 2
                else variable.shape
            )
            encoding[name][chunks] = by_frame
    return encoding


def _fill_value(dtype: np.dtype[Any]) -> dict[str, Any]:
    """Return the value of a missing chunk of a Zarr store, which no valid data have."""
    if dtype.kind == "f":
        return {"fill_value": dtype.type(np.nan)}
    return {"fill_value": np.iinfo(dtype).min} if dtype.kind == "i" else {}


def _attributes(ocean: Ocean | Window) -> dict[str, Any]:
    """Return an ocean's parameters, its sea, and its specified and realised statistics."""
    source = ocean.source if isinstance(ocean, Window) else ocean
    tiles = source.oceans if isinstance(source, Cascade) else (source,)
    grid, amplitudes, statistics = ocean.grid, tiles[0].amplitudes, asdict(measure(source))
    seed = getattr(ocean, "seed", None)  # an ocean of given waves has none
    found: dict[str, Any] = {
        "source": f"fftocean {__version__}",
        "n": [grid.nx, grid.ny],
        "size": [grid.lx, grid.ly],
        "depth": ocean.depth,
        "surface_tension": amplitudes.surface_tension,
        "loop": ocean.loop,
        "choppiness": ocean.choppiness,
        "order": tiles[0].order if tiles[0].order > 1 else None,
        "bound": tiles[0].bound if tiles[0].order > 1 else None,
        "amplitudes": amplitudes.draw,
        "seed": None
        if seed is None
        else str(seed),  # 64 bits: more than an integer of netCDF 3 has
        "dtype": ocean.dtype,
        "backend": tiles[0].backend,
    }
    if tiles[0].rarity is not None:
        found["constrained"] = str(tiles[0].rarity)
    if len(tiles) > 1:
        found["tiles"] = "; ".join(
            f"{t.grid.nx} x {t.grid.ny} over {t.grid.lx:g} x {t.grid.ly:g} m" for t in tiles
        )
    for i, system in enumerate(ocean.sea.systems if ocean.sea is not None else (), 1):
        found[f"sea_system_{i}"] = repr(system)
    specified, loop, folding, skewness = (
        statistics.pop(name) or {} for name in ("specified", "loop", "folding", "skewness")
    )
    for prefix, numbers in (
        ("ordered", specified),  # the attributes' name in files of all versions
        ("measured", statistics),
        ("loop", loop),
        ("folding", folding),
        ("skewness", skewness),
    ):
        found |= {f"{prefix}_{name}": value for name, value in numbers.items()}
    return {
        name: str(value) if value in (math.inf, -math.inf) else value
        for name, value in found.items()
        if value is not None
    }


def _map_attributes(name: str) -> dict[str, str]:
    """Return a map's attributes."""
    unit, caption = MAPS[name]
    return {"units": unit, "long_name": caption} | (
        {"standard_name": STANDARD_NAMES[name]} if name in STANDARD_NAMES else {}
    )


def _axis(name: str, direction: str) -> dict[str, str]:
    """Return a horizontal coordinate's attributes."""
    return {
        "units": "m",
        "axis": name.upper(),
        "standard_name": f"projection_{name}_coordinate",
        "long_name": f"{name}, {direction}",
    }


def _powers(ocean: Ocean) -> Real:
    """
    Return the powers of 1.05 [Hz] that cover all waves of a tile, and one more at either end.
    """
    hertz = ocean.amplitudes.running_omega[ocean.grid.active] / (2.0 * np.pi)
    low, high = np.log([np.min(hertz), np.max(hertz)] if hertz.size else [1.0, 1.0]) / math.log(
        1.05
    )
    powers: Real = 1.05 ** np.arange(math.floor(low) - 1.0, math.ceil(high) + 2.0)
    return powers


def _seconds(times: Iterable[float]) -> Real:
    """Return checked times, in a new array [s]."""
    t = np.array(TIME.check_array("times", times, ndim=1, least=1, most=_MOST))
    step = np.diff(t)
    if not (np.all(step > 0.0) or np.all(step < 0.0)):
        i = int(np.argmax(step * np.sign(t[-1] - t[0]) <= 0.0))
        raise ParameterError(
            f"times must be strictly ascending or descending, got {t[i + 1]:g} s after {t[i]:g} s"
        )
    return t


def _maps(maps: Sequence[str]) -> tuple[str, ...]:
    """Return checked names of maps, each once."""
    try:
        names = (maps,) if isinstance(maps, str) else tuple(dict.fromkeys(maps))
    except TypeError:
        names = (repr(maps),)
    for name in names or ("",):
        if name not in MAPS:
            raise ParameterError(f"maps must be one or more of {', '.join(MAPS)}, got {name!r:.60}")
    return names


def _frequencies(freq: RealLike) -> Real:
    """Return checked frequencies, in a new array [Hz]."""
    return np.array(
        FREQUENCY.check_array("freq", freq, ndim=1, least=2, most=_MOST, ascending=True)
    )


def _bearings(dir: RealLike) -> Real:
    """Return checked bearings in [0, 360), ascending [degrees]."""
    checked = DIRECTION.check_array("dir", dir, ndim=1, least=4, most=_MOST)
    bearing: Real = np.sort(np.mod(checked, 360.0))
    steps = np.diff(bearing, append=bearing[0] + 360.0)
    if np.max(np.abs(steps - 360.0 / bearing.size)) > 1e-6:
        raise ParameterError(
            "dir must be evenly spaced round the circle, got steps of "
            f"{steps.min():g} to {steps.max():g} degrees"
        )
    return bearing


def _require_ocean(ocean: Any) -> None:
    """Raise if `ocean` is not an Ocean."""
    if isinstance(ocean, Cascade):
        raise ParameterError(
            "ocean must be an Ocean, got a Cascade, whose tiles have no grid in common: "
            "take fo.Window(cascade) for to_xarray, or one of cascade.oceans"
        )
    if not isinstance(ocean, Ocean):
        raise ParameterError(f"ocean must be an Ocean, got {described(ocean)}")


def _require(name: str) -> Any:
    """
    Import and return a module of the extra `science`: xarray takes a second to import.

    Raises:
        ParameterError: the module is not installed.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.partition(".")[0]
        hint = how_to_install("science")
        raise ParameterError(
            f"{package} must be installed for labelled data: {hint} ({error})"
        ) from error
