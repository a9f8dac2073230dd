"""
The same water by other means: what a frame costs is measured against these.

Each takes an ocean and returns a function of nothing that makes the ocean's next frame, at other
times in each call. What it makes is compared with the ocean's own frame before anything is timed
(`same_water`): a contender that computes something else is no contender. None of them shares a line
with the fast path.
"""

import ctypes
import itertools
import math
import sys
import timeit
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from fftocean.arrays import Complex, Real
from fftocean.errors import ParameterError
from fftocean.gerstner import compiled
from fftocean.ocean import Ocean

FULL = ("height", "displace_x", "displace_y", "normal", "jacobian")
"""A full frame: what a renderer needs. It takes eight real transforms' worth of work."""

T0 = 3.7  # [s], at which waters are compared


class Contender(Protocol):
    """
    Makes one frame a call, each at a later time; `at` makes the frame of a given time and returns
    its fields by name.
    """

    def __call__(self) -> object: ...
    def at(self, t: float) -> Mapping[str, Real]: ...


def times() -> Iterator[float]:
    """Times that never repeat, so that nothing can be kept from one frame to the next [s]."""
    return (T0 + 0.04 * i for i in itertools.count())


class Fast:
    """The ocean itself, into the arrays of the frame before."""

    def __init__(self, ocean: Ocean, fields: Sequence[str] = FULL) -> None:
        self._ocean, self._fields, self._times = ocean, tuple(fields), times()
        self._frame = ocean.frame(0.0, self._fields)

    def __call__(self) -> object:
        return self._ocean.frame(next(self._times), self._fields, out=self._frame)

    def at(self, t: float) -> Mapping[str, Real]:
        frame = self._ocean.frame(t, self._fields)
        return {name: frame[name] for name in self._fields}


class Textbook:
    """
    NumPy as tutorials write it: eight complex128 `ifft2` of filtered spectra, then normals and
    Jacobian, all in arrays of n x n.
    """

    def __init__(self, ocean: Ocean) -> None:
        self._h0, self._mirrored, self._omega, kx, ky, factor = spectrum(ocean)
        self._choppiness, self._times = ocean.choppiness, times()
        potential = factor * np.ones_like(kx)
        self._filters = [
            np.ones_like(kx) + 0j,
            1j * kx * potential,
            1j * ky * potential,
            1j * kx,
            1j * ky,
            -kx * kx * potential + 0j,
            -kx * ky * potential + 0j,
            -ky * ky * potential + 0j,
        ]

    def __call__(self) -> object:
        return self.at(next(self._times))

    def at(self, t: float) -> Mapping[str, Real]:
        h = self._h0 * np.exp(-1j * self._omega * t) + self._mirrored * np.exp(1j * self._omega * t)
        linear = [np.fft.ifft2(f * h).real * h.size for f in self._filters]
        height, dx, dy, sx, sy, xx, xy, yy = linear
        c = self._choppiness
        normal = np.cross(
            np.stack([1 + c * xx, c * xy, sx], -1), np.stack([c * xy, 1 + c * yy, sy], -1)
        )
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        jacobian = (1 + c * xx) * (1 + c * yy) - (c * xy) ** 2
        return {
            "height": height,
            "displace_x": dx,
            "displace_y": dy,
            "normal": normal,
            "jacobian": jacobian,
        }

    def transforms(self) -> Callable[[], object]:
        """Only its eight `np.fft.ifft2`: what no rewriting of the lines around them could save."""
        spectra = [f * self._h0 for f in self._filters]
        return lambda: [np.fft.ifft2(s) for s in spectra]


class Careful:
    """
    NumPy and SciPy as one writes them with care: half spectra in complex64, `scipy.fft.irfft2`,
    cross product by components.
    """

    def __init__(self, ocean: Ocean) -> None:
        h0, mirrored, omega, kx, ky, factor = spectrum(ocean)
        half = slice(0, ocean.grid.nx // 2 + 1)
        self._shape = ocean.grid.shape
        self._h0, self._mirrored = (h[:, half].astype(np.complex64) for h in (h0, mirrored))
        self._omega = omega[:, half]
        kx, ky, factor = (a[:, half] for a in (kx, ky, factor))
        rows = [
            factor * 1j * kx,
            factor * 1j * ky,
            1j * kx,
            1j * ky,
            -kx * kx * factor,
            -kx * ky * factor,
            -ky * ky * factor,
        ]
        self._filters = [row.astype(np.complex64) for row in rows]
        self._choppiness, self._times = np.float32(ocean.choppiness), times()

    def __call__(self) -> object:
        return self.at(next(self._times))

    def at(self, t: float) -> Mapping[str, Real]:
        from scipy import fft

        angle = np.remainder(self._omega * t, 2 * np.pi).astype(
            np.float32
        )  # reduced in float64, cast once
        phase = np.cos(angle) - 1j * np.sin(angle)
        h = self._h0 * phase + self._mirrored * np.conj(phase)
        height, dx, dy, sx, sy, xx, xy, yy = (
            fft.irfft2(spectrum, s=self._shape, norm="forward", workers=1)
            for spectrum in (h, *(f * h for f in self._filters))
        )
        c = self._choppiness
        a, b, d = 1 + c * xx, c * xy, 1 + c * yy
        jacobian = a * d - b * b
        normal = np.empty((*self._shape, 3), dtype=np.float32)
        x, y = b * sy - sx * d, sx * b - a * sy
        per_length = 1 / np.sqrt(x * x + y * y + jacobian * jacobian)
        for i, component in enumerate((x, y, jacobian)):
            np.multiply(component, per_length, out=normal[..., i])
        return {
            "height": height,
            "displace_x": dx,
            "displace_y": dy,
            "normal": normal,
            "jacobian": jacobian,
        }


class DirectSum:
    """
    Every wave at every point, compiled, float64, one thread: the eight linear fields, at some
    points of the grid or at all.

    `share` is the part of the grid's points that one call sums: its cost is exactly proportional to
    them.
    """

    def __init__(self, ocean: Ocean, points: int | None = None) -> None:
        self._sea, self._times = _Waves(ocean), times()
        x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
        count = x.size if points is None else max(1, min(points, x.size))
        self.share = count / x.size
        self._x, self._y = (p.ravel()[:count].copy() for p in (x, y))
        compiled.eight_fields(self._sea, self._x[:1], self._y[:1], 0.0)

    def __call__(self) -> object:
        return self.at(next(self._times))

    def at(self, t: float) -> Mapping[str, Real]:
        return compiled.eight_fields(self._sea, self._x, self._y, t)


class _Waves:
    """An ocean's waves, listed once: making the list is no part of the sum."""

    def __init__(self, ocean: Ocean) -> None:
        self.choppiness, self.depth, self._modes = ocean.choppiness, ocean.depth, ocean.modes()

    def modes(self) -> Any:
        return self._modes


def spectrum(ocean: Ocean) -> tuple[Complex, Complex, Real, Real, Real, Real]:
    """
    Return the h0 of an ocean as textbooks have it, made from the list of its waves: arrays (ny, nx)
    in FFT order.

    Returns:
        h0, conj(h0(-k)), omega [rad/s], kx, ky [rad/m], and 1 / (k tanh kh) [m], which is 0 at k =
        0.
    """
    grid, waves = ocean.grid, ocean.modes()
    x, y = np.fft.fftfreq(grid.nx, grid.lx / grid.nx), np.fft.fftfreq(grid.ny, grid.ly / grid.ny)
    kx, ky = np.meshgrid(2 * np.pi * x, 2 * np.pi * y)
    k = np.hypot(kx, ky)
    mx, my = (
        np.rint(k1 * length / (2 * np.pi)).astype(int)
        for k1, length in ((waves.kx, grid.lx), (waves.ky, grid.ly))
    )
    h0, omega = np.zeros(grid.shape, dtype=np.complex128), np.zeros(grid.shape)
    np.add.at(h0, (my, mx), 0.5 * waves.amplitude * np.exp(-1j * waves.phase))
    omega[my, mx] = omega[-my, -mx] = waves.omega
    steep = k * (1.0 if math.isinf(ocean.depth) else np.tanh(k * ocean.depth))
    factor = np.divide(1.0, steep, out=np.zeros_like(k), where=steep > 0.0)
    mirrored = np.conj(np.roll(h0[::-1, ::-1], 1, (0, 1)))
    return h0, mirrored, omega, kx, ky, factor


def same_water(ocean: Ocean, contender: Contender, t: float = T0) -> float:
    """
    Return how far a contender's fields are from the ocean's own at time t, at worst, relative to
    each field's largest value.

    A contender that makes only some points, the first of the grid, is compared there.
    """
    theirs = contender.at(t)
    ours = ocean.frame(t, tuple(theirs))
    worst = 0.0
    for name, field in theirs.items():
        own = ours[name].astype(np.float64)
        largest = float(np.max(np.abs(own))) or 1.0
        other = np.asarray(field, dtype=np.float64)
        apart = (
            own - other if other.shape == own.shape else own.ravel()[: other.size] - other.ravel()
        )
        worst = max(worst, float(np.max(np.abs(apart))) / largest)
    return worst


def require_same_water(
    ocean: Ocean, contenders: Mapping[str, Contender], *, within: float
) -> float:
    """
    Return how far the contenders are from the ocean at worst.

    Raises:
        AssertionError: one of them shows other water; what it costs would mean nothing.
    """
    apart = {name: same_water(ocean, contender) for name, contender in contenders.items()}
    for name, figure in apart.items():
        if not figure <= within:
            raise AssertionError(
                f"{name} shows other water: {figure:.1e} of the largest value apart, {within:.0e} allowed"
            )
    return max(apart.values(), default=0.0)


# --- the floor: bare transforms of the same library


@dataclass(frozen=True, slots=True)
class Floor:
    """
    Eight bare real transforms of n x n by one library, and one copy of what they make: no water,
    only the work under it.
    """

    library: str
    how: str  # "all at once" or "one by one": whichever turned out faster here
    run: Callable[[], object]
    spectra: Complex  # (count, n, n // 2 + 1); the transforms overwrite it
    fields: Real  # (count, n, n)
    copied: Real

    def __call__(self) -> object:
        self.run()
        np.copyto(self.copied, self.fields)
        return self.copied


def floor(n: int, library: str, count: int = 8) -> Floor:
    """
    Plan `count` inverse real transforms of n x n, float32, on one thread, with FFTW_MEASURE where
    the library plans.

    They are planned all at once and one by one, and the faster way is kept. The buffers hold zeros,
    on which arithmetic takes as long as on anything; what a transform leaves in its input would
    grow without end.

    Raises:
        ParameterError: an unknown library, or one that is not installed.
    """
    if library not in _PLANNERS:
        raise ParameterError(f"library must be one of {', '.join(_PLANNERS)}, got {library!r}")
    plan = _PLANNERS[library]()
    spectra = _aligned((count, n, n // 2 + 1), np.complex64)
    fields, copied = (_aligned((count, n, n), np.float32) for _ in range(2))
    singles = [plan(spectra[i : i + 1], fields[i : i + 1]) for i in range(count)]

    def one_by_one() -> None:
        for run in singles:
            run()

    ways = {"all at once": plan(spectra, fields), "one by one": one_by_one}
    spectra[:] = 0.0  # measuring scribbles over it
    how = min(ways, key=lambda name: min(timeit.repeat(ways[name], number=1, repeat=5)))
    return Floor(library, how, ways[how], spectra, fields, copied)


Planner = Callable[[Complex, Real], Callable[[], object]]
"""Plans inverse real transforms of (count, n, n // 2 + 1) to (count, n, n), without 1/n^2."""


def _aligned(shape: tuple[int, ...], dtype: Any) -> Any:
    """Zeros that start at a multiple of 64 bytes, and that are really there."""
    size = math.prod(shape) * np.dtype(dtype).itemsize
    raw = np.empty(size + 64, dtype=np.uint8)
    raw.fill(0)  # else the first transform would pay for the pages
    start = -raw.ctypes.data % 64
    return raw[start : start + size].view(dtype).reshape(shape)


def _with_scipy() -> Planner:
    from scipy import fft

    def plan(spectra: Complex, fields: Real) -> Callable[[], object]:
        def run() -> None:  # SciPy returns a new array each time: that is its way
            fields[:] = fft.irfft2(spectra, s=fields.shape[1:], norm="forward", workers=1)

        return run

    return plan


def _with_pyfftw() -> Planner:
    try:
        import pyfftw
    except ImportError as error:
        raise ParameterError(
            f"library 'pyfftw' must be installed (pip install pyfftw): {error}"
        ) from None
    flags = ("FFTW_MEASURE", "FFTW_DESTROY_INPUT")

    def plan(spectra: Complex, fields: Real) -> Callable[[], object]:
        made = pyfftw.FFTW(
            spectra, fields, axes=(1, 2), direction="FFTW_BACKWARD", flags=flags, threads=1
        )
        run: Callable[[], object] = made.execute
        return run

    return plan


def _with_mkl() -> Planner:
    library = _mkl()

    def plan(spectra: Complex, fields: Real) -> Callable[[], object]:
        count, n, half = spectra.shape
        source, target = spectra.ctypes.data, fields.ctypes.data
        shape = (ctypes.c_int * 2)(n, n)
        made = library.fftwf_plan_many_dft_c2r(
            2, shape, count, source, None, 1, n * half, target, None, 1, n * n, 0
        )
        if not made:
            raise ParameterError(f"MKL has no plan for {count} transforms of {n} x {n}")
        return lambda: library.fftwf_execute(made)

    return plan


def _mkl() -> Any:
    """
    MKL's FFTW3 interface, on one thread.

    Raises:
        ParameterError: it is not installed.
    """
    for path in mkl_candidates():
        try:
            library = ctypes.CDLL(str(path))
        except OSError:
            continue
        if hasattr(library, "MKL_Set_Threading_Layer"):
            library.MKL_Set_Threading_Layer(
                1
            )  # sequential; without effect where somebody was here before
        if hasattr(library, "MKL_Set_Num_Threads_Local"):
            library.MKL_Set_Num_Threads_Local(1)
        integer, pointer = ctypes.c_int, ctypes.c_void_p
        library.fftwf_plan_many_dft_c2r.restype = pointer
        library.fftwf_plan_many_dft_c2r.argtypes = [
            *(integer, pointer, integer),  # rank, n, howmany
            *(pointer, pointer, integer, integer),  # in, inembed, istride, idist
            *(pointer, pointer, integer, integer),  # out, onembed, ostride, odist
            ctypes.c_uint,  # FFTW_MEASURE is 0; MKL has its plans ready and heeds no effort
        ]
        library.fftwf_execute.restype = None
        library.fftwf_execute.argtypes = [pointer]
        return library
    raise ParameterError("library 'mkl' must be installed (pip install mkl), and is not")


_PLANNERS: dict[str, Callable[[], Planner]] = {
    "pyfftw": _with_pyfftw,
    "mkl": _with_mkl,
    "scipy": _with_scipy,
}


def mkl_candidates() -> list[Path]:
    """
    Where MKL's runtime library may lie: where its wheel says, then where environments keep their
    libraries.
    """
    found: list[Path] = []
    try:
        files = metadata.files("mkl") or []
        found += [
            Path(str(file.locate()))
            for file in files
            if file.name.startswith(("libmkl_rt", "mkl_rt"))
        ]
    except metadata.PackageNotFoundError:
        pass
    for folder, pattern in (("lib", "libmkl_rt*"), ("Library/bin", "mkl_rt*.dll")):
        found += sorted(Path(sys.prefix, folder).glob(pattern))
    return list(dict.fromkeys(path.resolve() for path in found if path.exists()))
