"""
Time series at probes, which stand at fixed points of the water, by linear wave theory or, of the
surface, to second order.

At one point a wave is a phasor that turns with its frequency. So the waves of equal frequency are
added once a probe, whatever the number of times, and three ways lead from the sums to a series:

- on a loop, where the times are equal parts of it, waves have whole numbers of cycles, and a
  Fourier transform over time gives all times together;
- at other equal steps, the frequencies lie between those of a transform: each is spread over some
  of them, by a kernel whose transform is then divided out (Barnett, Magland & af Klinteberg 2019);
- at any other times, each time is summed by itself.

The second is exact to 1e-12 of the largest sum of amplitudes, the others to rounding.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Complex, Real, RealLike, brief_repr
from fftocean.bound_waves import BoundWaves
from fftocean.cascade import Cascade
from fftocean.constants import WATER_DENSITY
from fftocean.errors import OutputError, ParameterError, described, suggestion
from fftocean.files import path_of, write_parts, write_whole
from fftocean.host import require_memory
from fftocean.kernels import passes
from fftocean.limits import Quantity
from fftocean.ocean import Ocean
from fftocean.physics import dispersion
from fftocean.physics.second_order import Components, interaction
from fftocean.wave_list import WaveList, list_waves

if TYPE_CHECKING:
    from xarray import Dataset

UNITS = {
    "height": "m",
    "slope_x": "1",
    "slope_y": "1",
    "velocity_x": "m s-1",
    "velocity_y": "m s-1",
    "velocity_z": "m s-1",
    "acceleration_x": "m s-2",
    "acceleration_y": "m s-2",
    "acceleration_z": "m s-2",
    "pressure": "Pa",
}
"""The fields and their units; those after the slopes are below the surface, at levels z."""
MEANINGS = {
    "height": "height of the surface above the still-water level",
    "slope_x": "slope of the surface toward east",
    "slope_y": "slope of the surface toward north",
    "velocity_x": "velocity of the water toward east",
    "velocity_y": "velocity of the water toward north",
    "velocity_z": "upward velocity of the water",
    "acceleration_x": "acceleration of the water toward east",
    "acceleration_y": "acceleration of the water toward north",
    "acceleration_z": "upward acceleration of the water",
    "pressure": "dynamic pressure of the waves",
}
SURFACE = ("height", "slope_x", "slope_y")

_FINITE = Quantity("m", -1e9, 1e9)
_TIME = Quantity("s", -1e12, 1e12)
_BLOCK = 2**16  # steps of time of one transform between frequencies
_TOGETHER = 2**22  # numbers that such transforms hold at once
_WIDTH = 15  # frequencies over which one is spread: the error is some 1e-14
_SHARPNESS = 2.3 * _WIDTH  # of the kernel e^{sharpness (sqrt(1 - z^2) - 1)}
_PHASORS = 2**21  # of waves at probes that are held at once
_PAIRS = 2**18  # pairs of waves that are held at once
_ROUNDINGS = 8.0 * np.finfo(np.float64).eps  # by which equal steps may differ, of the latest time
_TURNS = 64  # most loops after which the steps come round

Index = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Series:
    """
    Time series at probes; `series["height"]` is one of them. float64, SI.

    Fields of the surface are (times, probes), those below it (times, probes, levels).

    Args:
        times: (times,) [s].
        x: (probes,) [m].
        y: (probes,) [m].
        z: (levels,) up from the still-water level [m].
        values: series by the name of their field, in SI units.
    """

    times: Real
    x: Real
    y: Real
    z: Real
    values: Mapping[str, Real]

    __repr__ = brief_repr

    def __getitem__(self, field: str) -> Real:
        return self.values[field]

    def to_xarray(self) -> "Dataset":
        """Return the series as an xarray.Dataset with CF attributes."""
        import xarray as xr

        below = any(values.ndim == 3 for values in self.values.values())
        coordinates: dict[str, Any] = {
            "time": ("time", self.times, {"units": "s", "long_name": "time", "axis": "T"}),
            "x": ("probe", self.x, {"units": "m", "long_name": "place, toward east"}),
            "y": ("probe", self.y, {"units": "m", "long_name": "place, toward north"}),
        }
        if below:
            about = {"units": "m", "positive": "up", "long_name": "above the still-water level"}
            coordinates["z"] = ("z", self.z, about)
        return xr.Dataset(
            {
                name: (
                    ("time", "probe", "z")[: values.ndim],
                    values,
                    {"units": UNITS[name], "long_name": MEANINGS[name]},
                )
                for name, values in self.values.items()
            },
            coordinates,
            {"Conventions": "CF-1.8", "source": "fftocean"},
        )

    def write(self, path: str | Path) -> None:
        """
        Write the series to a file by its ending: .csv, .nc (netCDF 3) or .zarr.

        A table in CSV begins with lines of comments (#) that place the probes; its columns are
        `time`, then each field at each probe, and below the surface at each level.

        Raises:
            ParameterError: another ending.
            OutputError: the file could not be written.
        """
        WRITERS[require_writable(path)](self, path_of("path", path))


def series(
    source: Ocean | Cascade | Any,
    x: RealLike,
    y: RealLike,
    times: RealLike,
    fields: Sequence[str] = ("height",),
    *,
    z: RealLike = 0.0,
    depth: float | None = None,
    shortest: float = 0.0,
) -> Series:
    """
    Return time series of the water at fixed points, by linear wave theory; an ocean of order 2 adds
    its waves of second order to height and slopes.

    Heights are those of the linear surface above (x, y), as of `kinematics.at`: the water is not
    displaced horizontally, and choppiness has no part in it. `Query` has the displaced surface, at
    some cost a time. Velocities, accelerations and pressure are those of the waves at levels at or
    below the still-water level; with depth h and f = k.x - omega t - phase,

        velocity along k   a omega cosh k(z + h)/sinh kh cos f
        velocity upward    a omega sinh k(z + h)/sinh kh sin f
        dynamic pressure   rho a omega^2/k cosh k(z + h)/sinh kh cos f

    Args:
        source: an `Ocean`, a `Cascade`, a few-wave model or `Modes`.
        x, y: the probes [m], numbers or lists of one length.
        times: any times [s]; equal steps are much faster, most of all those that divide a loop.
        fields: names of `probe_series.UNITS`.
        z: levels of the fields below the surface [m], up from the still-water level, at most 0.
        depth: still-water depth of `Modes` [m], None is deep water; the others have their own.
        shortest: wavelength below which waves are left out [m].

    Raises:
        ParameterError: a source without waves, or one that starts from rest; a source of second
            order that does not loop, or fields below its surface; an unknown field; a level above
            the surface or below the bed; values that are not finite numbers; more than fits into
            memory.

    Pinned by tests/test_probe_series.py, against sums over the waves at each time.
    """
    waves = list_waves(source, depth=depth, shortest=shortest)
    if waves.model is not None and waves.model.tau > 0.0:
        raise ParameterError(
            "waves that start from rest do not obey linear theory: "
            f"tau must be 0, got {waves.model.tau}"
        )
    t = _list_of("times", times, _TIME)
    places = _list_of("x", x, _FINITE), _list_of("y", y, _FINITE)
    try:
        px, py = (np.array(v) for v in np.broadcast_arrays(*places))
    except ValueError:
        raise ParameterError(
            f"x and y must be of one length, got {places[0].size} and {places[1].size}"
        ) from None
    levels = _list_of("z", z, _FINITE)
    if np.any(levels > 0.0) or np.any(levels < -waves.depth):
        raise ParameterError(
            f"z must be from the bed at {-waves.depth:g} m to 0, got {levels.min():g} to "
            f"{levels.max():g} m"
        )
    columns = _columns(fields, levels)
    if waves.bound is not None:
        _require_second_order(waves, columns)
    require_memory(
        f"series of {t.size} times at {px.size} probes", 16 * t.size * px.size * len(columns)
    )
    out = np.zeros((t.size, px.size, len(columns)))
    for tile in range(len(waves.loops)):
        _add_tile(waves, tile, px, py, columns, t, out)
    if waves.bound is not None:
        _add_bound(waves, waves.bound, px, py, columns, t, out)
    return Series(t, px, py, levels, _by_field(columns, out, levels.size))


def _list_of(name: str, values: RealLike, quantity: Quantity) -> Real:
    """Return one finite number or more as a list."""
    array = quantity.check_array(name, values, least=1)
    if array.ndim > 1:
        raise ParameterError(f"{name} must be a number or a list, got shape {array.shape}")
    return np.array(array.reshape(-1))


def _columns(fields: Sequence[str], levels: Real) -> list[tuple[str, float]]:
    """Return each field, and below the surface each level of it, as (name, level)."""
    if (
        isinstance(fields, str)
        or not isinstance(fields, Sequence)
        or not fields
        or not all(isinstance(name, str) for name in fields)
    ):
        raise ParameterError(
            "fields must be a list of names such as ('height', 'pressure'), got "
            f"{described(fields)}"
        )
    columns: list[tuple[str, float]] = []
    for name in dict.fromkeys(fields):
        if name not in UNITS:
            raise ParameterError(
                f"fields must be of {', '.join(UNITS)}, got {name!r:.60}{suggestion(name, UNITS)}"
            )
        columns += [(name, 0.0)] if name in SURFACE else [(name, level) for level in levels]
    return columns


def _by_field(columns: list[tuple[str, float]], out: Real, levels: int) -> dict[str, Real]:
    """Return the columns of (times, probes, columns) as arrays by their names."""
    found, start = {}, 0
    for name in dict.fromkeys(name for name, _ in columns):
        count = 1 if name in SURFACE else levels
        part = out[:, :, start : start + count]
        found[name] = np.ascontiguousarray(part[:, :, 0] if name in SURFACE else part)
        start += count
    return found


def _add_tile(
    waves: WaveList,
    tile: int,
    x: Real,
    y: Real,
    columns: list[tuple[str, float]],
    t: Real,
    out: Real,
) -> None:
    """Add the waves of one tile to (times, probes, columns)."""
    part = slice(int(waves.first[tile]), int(waves.first[tile + 1]))
    count, loop = part.stop - part.start, waves.loops[tile]
    if not count:
        return
    turns = dispersion.turns_per_second(waves.omega[part])
    cycles = None if loop is None else np.rint(turns * loop)
    order = np.argsort(turns if cycles is None else cycles, kind="stable")
    ranked = (turns if cycles is None else cycles)[order]
    first = np.flatnonzero(np.concatenate([[True], ranked[1:] != ranked[:-1]]))
    k = waves.kx[part], waves.ky[part]
    factors = np.stack(
        [
            waves.amplitude[part] * _factor(name, level, *k, waves.omega[part], waves.depth)
            for name, level in columns
        ]
    )
    lx, ly = waves.sizes[tile]
    step = max(1, _PHASORS // count)
    for start in range(0, x.size, step):
        here = slice(start, start + step)
        # a tile repeats, so that phases are as good far away as at home
        near_x = np.fmod(x[here], lx) if math.isfinite(lx) else x[here]
        near_y = np.fmod(y[here], ly) if math.isfinite(ly) else y[here]
        angle = k[0][:, None] * near_x + k[1][:, None] * near_y - waves.phase[part][:, None]
        phasor = np.exp(1j * angle)
        summed = np.stack(
            [np.add.reduceat((f[:, None] * phasor)[order], first) for f in factors], axis=2
        ).reshape(first.size, -1)
        times_of = _turned(ranked[first], loop, summed, t)
        for rows, values in times_of:
            out[rows, here] += values.reshape(values.shape[0], -1, len(columns))


def _require_second_order(waves: WaveList, columns: list[tuple[str, float]]) -> None:
    """
    Raise where waves of second order cannot have a series.

    Raises:
        ParameterError: water without a loop, or fields below the surface.
    """
    if waves.loops[0] is None:
        raise ParameterError(
            "a series of second order needs an ocean that loops, Ocean(..., loop=600.0), in which "
            "pairs of waves share their frequencies; or give ocean.linear(), on the command line "
            "--order 1"
        )
    below = [name for name, _ in columns if name not in SURFACE]
    if below:
        raise ParameterError(
            f"fields of a series of second order must be of {', '.join(SURFACE)}, got "
            f"{below[0]!r}: give ocean.linear(), on the command line --order 1, or take "
            "kinematics.at"
        )


def _add_bound(
    waves: WaveList,
    bound: BoundWaves,
    x: Real,
    y: Real,
    columns: list[tuple[str, float]],
    t: Real,
    out: Real,
) -> None:
    """
    Add the second-order waves of one looping tile to (times, probes, columns).

    With z = h0 e^{i(k.x - omega t)} they are 2 Re of the sum over ordered pairs of C z_i z_j and of
    C z_i conj(z_j). At a probe all pairs of equal cycles are one number.
    """
    parents, grid = bound.parents, bound.amplitudes.grid
    waves_of = Components(parents.mx * grid.dkx, parents.my * grid.dky, parents.omega)
    cycles, loop = np.rint(parents.frequency).astype(np.int64), waves.loops[0]
    most = int(np.max(cycles, initial=0))
    near_x, near_y = np.fmod(x, grid.lx), np.fmod(y, grid.ly)
    angle = waves_of.kx[:, None] * near_x + waves_of.ky[:, None] * near_y
    z = parents.h0[:, None] * np.exp(1j * angle)
    summed = np.zeros((3 * most + 1, x.size, len(columns)), dtype=np.complex128)
    rows = max(1, _PAIRS // max(cycles.size, 1))
    for start in range(0, cycles.size, rows):
        ours = slice(start, start + rows)
        first = waves_of.part((ours, None))
        for sign in (1, -1):
            second = waves_of if sign > 0 else waves_of.conjugate
            factor = interaction(first, second, waves.depth).elevation
            kx, ky = first.kx + second.kx, first.ky + second.ky
            factor = np.where(np.hypot(kx, ky) * waves.shortest <= 2.0 * np.pi, factor, 0.0)
            bins = (cycles[ours, None] + sign * cycles + most).ravel()
            other = z if sign > 0 else np.conj(z)
            for probe in range(x.size):
                pairs = factor * z[ours, probe, None] * other[:, probe]
                for i, (name, _) in enumerate(columns):
                    along = {"height": 1.0, "slope_x": 1j * kx, "slope_y": 1j * ky}[name]
                    product = (pairs * along).ravel()
                    for part, turn in ((product.real, 1.0), (product.imag, 1j)):
                        summed[:, probe, i] += turn * np.bincount(bins, part, summed.shape[0])
    rate = np.arange(-most, 2 * most + 1, dtype=np.float64)
    for times, values in _turned(rate, loop, 2.0 * summed.reshape(rate.size, -1), t):
        out[times] += values.reshape(values.shape[0], x.size, -1)


def _factor(name: str, z: float, kx: Real, ky: Real, omega: Real, depth: float) -> Any:
    """Return the complex factor c of a field, which is Re(c a e^{i (k.x - omega t - phase)})."""
    if name == "height":
        return 1.0
    if name in ("slope_x", "slope_y"):
        return 1j * (kx if name == "slope_x" else ky)
    k = np.hypot(kx, ky)
    decay, mirrored, whole = np.exp(k * z), np.zeros(1), np.ones(1)
    if math.isfinite(depth):
        mirrored = np.exp(-2.0 * k * (z + depth))
        whole = -np.expm1(-2.0 * k * depth)
    even, odd = decay * (1.0 + mirrored) / whole, decay * (1.0 - mirrored) / whole
    if name == "pressure":
        return WATER_DENSITY * omega**2 / k * even
    kind, _, axis = name.rpartition("_")
    along = {"x": kx / k * even, "y": ky / k * even, "z": -1j * odd}[axis]
    return along * omega * (1.0 if kind == "velocity" else -1j * omega)


def _turned(
    rate: Real, loop: float | None, summed: Complex, t: Real
) -> Iterator[tuple[slice, Real]]:
    """
    Yield Re(sum of summed e^{-2 pi i phase}) at slices of the times.

    Args:
        rate: (groups,) of frequency: turns a second, or cycles in the loop.
        loop: the period [s], or None.
        summed: (groups, columns) phasors at t = 0.
        t: (times,) [s].
    """
    count = t.size
    if loop is not None and (found := _steps_of_loop(t, loop)):
        turns, samples = found
        yield slice(0, count), _by_transform(rate, turns, samples, t[0] / loop, summed, count)
        return
    if count > 2 and _even(t, t[0] + (t[-1] - t[0]) / (count - 1) * np.arange(count)):
        step = (t[-1] - t[0]) / (count - 1)
        yield from _between_frequencies(rate, loop, step, summed, t)
        return
    for j in range(count):
        phases = _phases(rate, loop, float(t[j]))
        yield slice(j, j + 1), np.real(np.exp(-2j * np.pi * phases) @ summed)[None]


def _even(t: Real, steps: Real) -> bool:
    """Return True if times are steps but for roundings."""
    return bool(np.all(np.abs(t - steps) <= _ROUNDINGS * np.max(np.abs(t))))


def _steps_of_loop(t: Real, loop: float) -> tuple[int, int] | None:
    """
    Return (q, m) for times that are equal steps of q/m of the loop, the smallest q; None for other
    times, and where a transform over m steps would be longer than is worth while.
    """
    count = t.size
    if count < 2 or not t[-1] > t[0]:
        return None
    step = (t[-1] - t[0]) / (count - 1)
    for turns in range(1, _TURNS + 1):
        samples = round(turns * loop / step)
        if not 0 < samples <= max(8 * count, 4096):
            return None
        if math.gcd(turns, samples) == 1 and _even(
            t, t[0] + (turns * loop / samples) * np.arange(count)
        ):
            return turns, samples
    return None


def _by_transform(
    cycles: Real, turns: int, samples: int, start: float, summed: Complex, count: int
) -> Real:
    """Return the series at `count` steps of turns/samples of the loop, from a start in loops."""
    from scipy import fft

    phase = np.empty((1, cycles.size))
    passes.phases_at(cycles[None], math.fmod(start, 1.0), phase)
    turned = summed * np.exp(-2j * np.pi * phase[0])[:, None]
    bins = np.mod(cycles * turns, samples).astype(np.int64)
    spectrum = np.zeros((samples, summed.shape[1]), dtype=np.complex128)
    np.add.at(spectrum, bins, turned)
    whole: Real = np.real(fft.fft(spectrum, axis=0, overwrite_x=True))
    return whole[np.arange(count) % samples]


def _between_frequencies(
    rate: Real, loop: float | None, step: float, summed: Complex, t: Real
) -> Iterator[tuple[slice, Real]]:
    """
    Yield the series at equal steps, some blocks of time at a time.

    With n counted from the middle of a block, e^{-2 pi i n f step} is a type 1 transform of points
    f step on a circle: spread over a grid twice as fine as the steps, transformed, and divided by
    the transform of the kernel.
    """
    from scipy import fft

    turn = np.empty((1, rate.size))
    passes.phases_at((rate if loop is None else rate / loop)[None], step, turn)
    for start in range(0, t.size, _BLOCK):
        count = min(_BLOCK, t.size - start)
        if start == 0 or count < _BLOCK:
            fine = fft.next_fast_len(max(2 * count, 2 * _WIDTH))
            spread = _spreading(turn[0], fine)
            n = np.arange(count) - count // 2
            response = _response_of_kernel(n * (np.pi * _WIDTH / fine))
        middle = float(t[start + count // 2])
        at_middle = np.exp(-2j * np.pi * _phases(rate, loop, middle))[:, None] * summed
        out = np.empty((count, summed.shape[1]))
        some = max(1, _TOGETHER // fine)
        for low in range(0, summed.shape[1], some):
            columns = slice(low, low + some)
            grid = np.ascontiguousarray((spread @ at_middle[:, columns]).T)
            values = np.real(fft.fft(grid, axis=1, overwrite_x=True)[:, n % fine])
            out[:, columns] = (values / response).T
        yield slice(start, start + count), out


def _spreading(turn: Real, fine: int) -> Any:
    """Return the sparse matrix that spreads points, in turns, over a circle of `fine` cells."""
    from scipy import sparse

    place = turn * fine
    first = np.ceil(place - 0.5 * _WIDTH)
    cells = first[:, None] + np.arange(_WIDTH)
    z = (cells - place[:, None]) * (2.0 / _WIDTH)
    weights = _kernel(np.clip(z, -1.0, 1.0))
    rows, points = np.mod(cells, fine).astype(np.int64), np.arange(turn.size)
    entries = (weights.ravel(), (rows.ravel(), np.repeat(points, _WIDTH)))
    return sparse.csr_array(entries, shape=(fine, turn.size))


def _kernel(z: Real) -> Real:
    """Return the kernel on [-1, 1]."""
    values: Real = np.exp(_SHARPNESS * (np.sqrt((1.0 - z) * (1.0 + z)) - 1.0))
    return values


def _response_of_kernel(frequency: Real) -> Real:
    """
    Return width/2 times the integral of kernel(z) cos(frequency z), by Gauss's rule.

    Frequencies are at most pi width/4, at which 60 nodes are exact to rounding.
    """
    z, weights = np.polynomial.legendre.leggauss(60)
    half = z > 0.0  # the kernel is even
    z, weights = z[half], weights[half]
    found: Real = np.cos(np.outer(frequency, z)) @ (_WIDTH * weights * _kernel(z))
    return found


def _phases(rate: Real, loop: float | None, t: float) -> Real:
    """Return the phases of groups at a time, in cycles, in [-1/2, 1/2]."""
    out = np.empty((1, rate.size))
    moment = t if loop is None else math.fmod(t, loop) / loop
    passes.phases_at(rate[None], moment, out)
    result: Real = out[0]
    return result


# Files


def require_writable(path: str | Path) -> str:
    """
    Return the ending of a file that a series can be written to.

    Raises:
        ParameterError: another ending.
    """
    file = path_of("path", path)
    ending = file.suffix.lower()
    if ending not in WRITERS:
        raise ParameterError(
            f"a series must be written to a file that ends in {', '.join(WRITERS)}, "
            f"got {file.name!r:.80}"
        )
    return ending


def _write_csv(series: Series, file: Path) -> None:
    """Write a table with one time a line."""
    names, columns = ["time"], [series.times]
    for name, values in series.values.items():
        for probe in range(series.x.size):
            if values.ndim == 2:
                names.append(f"{name}_{probe + 1}")
                columns.append(values[:, probe])
                continue
            names += [f"{name}_{probe + 1}_z{i + 1}" for i in range(series.z.size)]
            columns += list(values[:, probe].T)
    comments = [
        f"# probe {i + 1}: x = {x!r} m, y = {y!r} m" for i, (x, y) in enumerate(_places(series))
    ]
    if any(values.ndim == 3 for values in series.values.values()):
        comments += [f"# z{i + 1}: {z!r} m" for i, z in enumerate(series.z.tolist())]
    units = ", ".join(f"{name} {UNITS[name]}" for name in series.values)
    comments.append(f"# units: time s, {units}")
    head = "\n".join([*comments, ",".join(names)]) + "\n"
    table = np.stack(columns, axis=1)

    def parts() -> Iterator[bytes]:
        yield head.encode()
        for start in range(0, table.shape[0], 4096):
            rows = table[start : start + 4096].tolist()
            yield "".join(",".join(map(repr, row)) + "\n" for row in rows).encode()

    write_parts(file, parts())


def _places(series: Series) -> list[tuple[float, float]]:
    return list(zip(series.x.tolist(), series.y.tolist(), strict=True))


def _write_netcdf(series: Series, file: Path) -> None:
    write_whole(file, bytes(series.to_xarray().to_netcdf(engine="scipy")))


def _write_zarr(series: Series, file: Path) -> None:
    if file.exists():
        raise OutputError(f"{file} exists; remove it, or choose another name")
    series.to_xarray().to_zarr(file, mode="w-", consolidated=False)


WRITERS: dict[str, Callable[[Series, Path], None]] = {
    ".csv": _write_csv,
    ".nc": _write_netcdf,
    ".zarr": _write_zarr,
}
