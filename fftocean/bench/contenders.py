"""
Other implementations of the same frame, for comparison.

Each is made from an ocean, and computes the ocean's next frame when called, at another time in each
call. Before anything is timed its fields are compared with those of the ocean (`same_water`). None
of them shares code with the fast path.
"""

import ctypes
import itertools
import math
import timeit
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from fftocean import transforms
from fftocean.arrays import Complex, Real
from fftocean.errors import ParameterError
from fftocean.gerstner import compiled
from fftocean.ocean import Ocean

FULL = ("height", "displace_x", "displace_y", "normal", "jacobian")
"""The fields of a full frame, as a renderer needs them: the work of eight real transforms."""

T0 = 3.7  # [s], at which fields are compared


class Contender(Protocol):
    """
    An implementation that computes one frame a call, each at a later time.

    `at` returns the fields at a given time by name.
    """

    def __call__(self) -> object: ...
    def at(self, t: float) -> Mapping[str, Real]: ...


def times() -> Iterator[float]:
    """Yield times that never repeat, so that no frame can be reused [s]."""
    return (T0 + 0.04 * i for i in itertools.count())


class Fast:
    """The ocean itself, which writes into the arrays of its last frame."""

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
    NumPy as in tutorials.

    Eight complex128 `ifft2` of filtered spectra, then normals and Jacobian, in arrays of n x n.
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
        """Return a function that runs only the eight `np.fft.ifft2`."""
        spectra = [f * self._h0 for f in self._filters]
        return lambda: [np.fft.ifft2(s) for s in spectra]


class Careful:
    """
    NumPy and SciPy, carefully optimised.

    Half spectra in complex64, `scipy.fft.irfft2`, and the cross product by components.
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

        # reduced in float64, cast once
        angle = np.remainder(self._omega * t, 2 * np.pi).astype(np.float32)
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
    The sum of every wave at every point: compiled, float64, one thread.

    It computes the eight linear fields at some or all points of the grid. `share` is the fraction
    of the points that one call sums; its cost is proportional to it.
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
    """An ocean's waves, listed once, so that the list is not made in timed calls."""

    def __init__(self, ocean: Ocean) -> None:
        self.choppiness, self.depth, self._modes = ocean.choppiness, ocean.depth, ocean.modes()

    def modes(self) -> Any:
        return self._modes


def spectrum(ocean: Ocean) -> tuple[Complex, Complex, Real, Real, Real, Real]:
    """
    Return the h0 of an ocean as in textbooks, from the list of its waves.

    All arrays are (ny, nx) in FFT order.

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
    Return the largest error of a contender's fields, relative to each field's largest value.

    A contender that computes only the first points of the grid is compared there.

    Args:
        ocean: the reference.
        contender: the implementation to compare.
        t: the time [s].
    """
    theirs = contender.at(t)
    ours = ocean.frame(t, tuple(theirs))
    worst = 0.0
    for name, field in theirs.items():
        own = ours[name].astype(np.float64)
        largest = float(np.max(np.abs(own))) or 1.0
        other = np.asarray(field, dtype=np.float64)
        if other.shape != own.shape:
            own, other = own.ravel()[: other.size], other.ravel()
        worst = max(worst, float(np.max(np.abs(own - other))) / largest)
    return worst


def require_same_water(
    ocean: Ocean, contenders: Mapping[str, Contender], *, within: float
) -> float:
    """
    Return the largest relative error of the contenders.

    Raises:
        AssertionError: the error of a contender exceeds `within`, so its cost would mean nothing.
    """
    errors = {name: same_water(ocean, contender) for name, contender in contenders.items()}
    for name, error in errors.items():
        if not error <= within:
            raise AssertionError(
                f"{name} computes other fields: error {error:.1e} of the largest value, "
                f"{within:.0e} allowed"
            )
    return max(errors.values(), default=0.0)


# --- the lower bound: bare transforms of the same library


@dataclass(frozen=True, slots=True)
class Floor:
    """
    A lower bound of a frame's cost: bare real transforms of n x n, and one copy of the result.
    """

    library: str
    how: str  # "all at once" or "one by one": the faster on this machine
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

    They are planned all at once and one by one, and the faster plan is kept. The buffers hold
    zeros, on which arithmetic takes as long as on other numbers: transforms overwrite their input,
    whose values would grow without bound.

    Raises:
        ParameterError: an unknown library, or one that is not installed.
    """
    if library not in _PLANNERS:
        raise ParameterError(f"library must be one of {', '.join(_PLANNERS)}, got {library!r}")
    module = transforms.loaded(library)
    if module is None:
        raise ParameterError(
            f"library {library!r} must be installed (pip install {library}), and is not"
        )
    plan = _PLANNERS[library](module)
    spectra = _aligned((count, n, n // 2 + 1), np.complex64)
    fields, copied = (_aligned((count, n, n), np.float32) for _ in range(2))
    singles = [plan(spectra[i : i + 1], fields[i : i + 1]) for i in range(count)]

    def one_by_one() -> None:
        for run in singles:
            run()

    ways = {"all at once": plan(spectra, fields), "one by one": one_by_one}
    spectra[:] = 0.0  # planning overwrites them
    how = min(ways, key=lambda name: min(timeit.repeat(ways[name], number=1, repeat=5)))
    return Floor(library, how, ways[how], spectra, fields, copied)


Planner = Callable[[Complex, Real], Callable[[], object]]
"""A function that plans transforms of (count, n, n // 2 + 1) to (count, n, n), without 1/n^2."""


def _aligned(shape: tuple[int, ...], dtype: Any) -> Any:
    """Return zeros that start at a multiple of 64 bytes, in pages that are already mapped."""
    size = math.prod(shape) * np.dtype(dtype).itemsize
    raw = np.empty(size + 64, dtype=np.uint8)
    raw.fill(0)  # otherwise the first transform would map the pages
    start = -raw.ctypes.data % 64
    return raw[start : start + size].view(dtype).reshape(shape)


def _with_scipy(fft: Any) -> Planner:
    """Return a planner that uses `scipy.fft`."""

    def plan(spectra: Complex, fields: Real) -> Callable[[], object]:
        def run() -> None:  # SciPy always returns a new array
            fields[:] = fft.irfft2(spectra, s=fields.shape[1:], norm="forward", workers=1)

        return run

    return plan


def _with_pyfftw(pyfftw: Any) -> Planner:
    """Return a planner that uses FFTW through pyfftw."""
    flags = ("FFTW_MEASURE", "FFTW_DESTROY_INPUT")

    def plan(spectra: Complex, fields: Real) -> Callable[[], object]:
        made = pyfftw.FFTW(
            spectra, fields, axes=(1, 2), direction="FFTW_BACKWARD", flags=flags, threads=1
        )
        run: Callable[[], object] = made.execute
        return run

    return plan


def _with_mkl(mkl: Any) -> Planner:
    """Return a planner that uses MKL's FFTW3 interface on one thread."""
    integer, pointer = ctypes.c_int, ctypes.c_void_p
    mkl.MKL_Set_Num_Threads_Local(1)
    many, execute = mkl.fftwf_plan_many_dft_c2r, mkl.fftwf_execute
    many.restype = pointer
    many.argtypes = [
        *(integer, pointer, integer),  # rank, n, howmany
        *(pointer, pointer, integer, integer),  # in, inembed, istride, idist
        *(pointer, pointer, integer, integer),  # out, onembed, ostride, odist
        ctypes.c_uint,  # FFTW_MEASURE is 0; MKL ignores the planning effort
    ]

    def plan(spectra: Complex, fields: Real) -> Callable[[], object]:
        count, n, half = spectra.shape
        source, target = spectra.ctypes.data, fields.ctypes.data
        shape = (ctypes.c_int * 2)(n, n)
        made = many(2, shape, count, source, None, 1, n * half, target, None, 1, n * n, 0)
        if not made:
            raise ParameterError(f"MKL has no plan for {count} transforms of {n} x {n}")
        # no `argtypes`: `fftwf_execute` belongs to the library that oceans use, too
        handle = ctypes.c_void_p(made)
        return lambda: execute(handle)

    return plan


_PLANNERS: dict[str, Callable[[Any], Planner]] = {
    "pyfftw": _with_pyfftw,
    "mkl": _with_mkl,
    "scipy": _with_scipy,
}
