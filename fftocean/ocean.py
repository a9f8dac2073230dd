"""A periodic patch of water: `Ocean.frame(t)` is a pure function of the ocean and the time."""

import math
import threading
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from fftocean.amplitudes import Amplitudes, Draw, Modes, place_modes, seed_amplitudes
from fftocean.arrays import Real, RealLike
from fftocean.bound_waves import BoundWaves, Shown, bound_waves
from fftocean.cells import WHOLE, Band
from fftocean.computation import Computation
from fftocean.errors import ParameterError, SeaWarning, described, suggestion
from fftocean.fields import EIGHT, FIELDS, POINTWISE, potential_factor
from fftocean.fixed_values import Rarity
from fftocean.forks import Process, in_child, no_fork
from fftocean.frame import Frame as Frame
from fftocean.gpu.device_frame import DeviceFrame
from fftocean.gpu.synthesis import DeviceSynthesis, synthesis_of
from fftocean.grid import Grid
from fftocean.host import require_memory
from fftocean.limits import (
    BAND_EDGE,
    BAND_START,
    BOUND_WAVES,
    CHOPPINESS,
    LOOP,
    MOMENTS,
    ORDER,
    TIME,
)
from fftocean.lookahead import run_in_order
from fftocean.phases import AtTime, InLoop, Moment
from fftocean.physics import dispersion
from fftocean.physics.plausibility import require_plausible
from fftocean.physics.sea import Sea
from fftocean.transforms import aligned_empty

if TYPE_CHECKING:
    from xarray import Dataset


BOUND = 1000
"""Waves whose pairs have bound waves, unless another number is given."""

_after_fork = threading.Lock()


def _renew() -> None:
    """Replace the lock in a forked child, where the thread that held it does not exist."""
    global _after_fork
    _after_fork = threading.Lock()


in_child(_renew)


class Ocean:
    """
    A periodic patch of a sea.

    `frame(t)` depends on t alone, so frames can be computed in any order.

    Args:
        sea: the specified sea state.
        n: samples a side, any whole number, or (nx, ny).
        size: width of the patch [m], or (lx, ly).
        seed: random seed; a finer n at the same size and seed shows the same waves, sharper.
        loop: period after which the water repeats exactly [s]; None for water that never repeats.
        choppiness: factor on the horizontal displacement [-]: 1 is linear wave theory, 0 a plain
            height field.
        dtype: "float32" or "float64", of the fields; amplitudes and phases are always float64.
        amplitudes: "gaussian" as in nature, or "fixed" for random phases alone (see
            `seed_amplitudes`).
        band: lowest and highest wavenumber |k| of the waves [rad/m], within those that the grid
            holds; a `Cascade` sets it.
        backend: "mkl", "pyfftw", "scipy", or "auto" for the first of them that is installed; "gpu"
            for the kernels of docs/gpu.md, or "gpu-or-cpu" for "auto" where "gpu" cannot compute.
        planning: "estimate" for the same bytes in every run; "measure" or "patient" for live use.
        threads: number of threads that share the work on one frame; the bytes do not depend on it.
        order: 1 for linear waves; 2 adds the waves of second order that are bound to them, which
            make crests higher and sharper, and troughs flatter: see docs/second_order.md.
        bound: number of waves whose pairs have bound waves, the strongest by a^2 k. With 1000 they
            hold about 0.93 of the skewness of a sea whose peak is a fifth of the tile.

    An ocean owns plans and buffers, and locks them while it computes. Threads can share an ocean,
    but only one of them computes at a time; give each its own to work in parallel. A fork waits
    until other threads have finished their frames (see `forks`); the child can use the oceans that
    it inherits and make new ones.

    Raises:
        ParameterError: a value out of range, a spectrum that is not finite and >= 0, a sea whose
            troughs would bare the bed, or too little memory.
    """

    def __init__(
        self,
        sea: Sea,
        *,
        n: int | tuple[int, int],
        size: float | tuple[float, float],
        seed: int = 0,
        loop: float | None = None,
        choppiness: float = 1.0,
        dtype: str = "float32",
        amplitudes: Draw = "gaussian",
        band: Band = WHOLE,
        backend: str = "auto",
        planning: str = "estimate",
        threads: int = 1,
        order: int = 1,
        bound: int = BOUND,
    ) -> None:
        if not isinstance(sea, Sea):
            raise ParameterError(f"sea must be a Sea, got {described(sea)}")
        if not isinstance(amplitudes, str):
            raise ParameterError(
                f"amplitudes must be 'gaussian' or 'fixed', got {described(amplitudes)}"
            )
        computation = Computation(dtype, backend, planning, threads)
        grid, loop = _checked(n, size, computation, loop)
        band = _checked_band(band)
        if loop is not None and loop < 4.0 * (longest := longest_period(sea, band)):
            warnings.warn(
                f"a loop of {loop:g} s is less than four peak periods ({4.0 * longest:.1f} s): "
                "its long waves run visibly too fast or too slow",
                SeaWarning,
                stacklevel=2,
            )
        self.seed: int | None = seed  # checked where it is used, next
        with no_fork():
            realised = seed_amplitudes(sea, grid, seed=seed, loop=loop, draw=amplitudes, band=band)
            second = bound_by_order(order, bound, realised, choppiness, computation)
        self._set_up(sea, realised, choppiness, computation, second)
        require_plausible(sea, stacklevel=2)

    @classmethod
    def from_modes(
        cls,
        modes: Iterable[tuple[int, int, float, float]],
        *,
        n: int | tuple[int, int],
        size: float | tuple[float, float],
        depth: float = math.inf,
        surface_tension: float = 0.0,
        loop: float | None = None,
        choppiness: float = 1.0,
        dtype: str = "float32",
        backend: str = "auto",
        planning: str = "estimate",
        threads: int = 1,
        order: int = 1,
        bound: int = BOUND,
    ) -> "Ocean":
        """
        Return an ocean of given waves.

        height = sum of a cos(k.x - omega t - phase), with k = 2 pi (mx/lx, my/ly).

        Args:
            modes: (mx, my, amplitude [m], phase [rad]) of each wave; waves on the same (mx, my) add
                up.
            depth: still-water depth [m].
            surface_tension: [N/m].
            n, size, loop, choppiness, dtype, backend, planning, threads, order, bound: as in
                `Ocean`.

        Raises:
            ParameterError: a wave that the grid cannot hold, or a value out of range.
        """
        computation = Computation(dtype, backend, planning, threads)
        grid, loop = _checked(n, size, computation, loop)
        if not isinstance(modes, Iterable):
            raise ParameterError(
                f"modes must be a list of (mx, my, amplitude, phase), got {described(modes)}"
            )
        amplitudes = place_modes(
            modes, grid, depth=depth, surface_tension=surface_tension, loop=loop
        )
        ocean = cls.__new__(cls)
        ocean.seed = None  # nothing is random
        second = bound_by_order(order, bound, amplitudes, choppiness, computation)
        ocean._set_up(None, amplitudes, choppiness, computation, second)
        return ocean

    def with_amplitudes(
        self,
        amplitudes: Amplitudes,
        *,
        sea: Sea | None = None,
        choppiness: float | None = None,
        planning: str | None = None,
        threads: int | None = None,
        order: int | None = None,
        bound: int | None = None,
    ) -> "Ocean":
        """
        Return an ocean of other waves, with the seed and computation of this one.

        Filtered waves, say, come from `dataclasses.replace(ocean.amplitudes, forward=...,
        backward=...)`. The grid, depth and loop are those of the new amplitudes.

        Args:
            amplitudes: the waves at t = 0, (ny, nx // 2 + 1) each [m]; see `Amplitudes`. Its
                arrays become read-only.
            sea: the sea that they realise; None for that of this ocean.
            choppiness, planning, threads, order, bound: as in `Ocean`; None for those of this
                ocean.

        Raises:
            ParameterError: `amplitudes` or `sea` is of another type, fields overflow `dtype`, too
                little memory, or a value out of range.
        """
        if not isinstance(amplitudes, Amplitudes):
            raise ParameterError(f"amplitudes must be Amplitudes, got {described(amplitudes)}")
        if not isinstance(sea, Sea | None):
            raise ParameterError(f"sea must be a Sea, got {described(sea)}")
        computation = self._computation
        if planning is not None:
            computation = replace(computation, planning=planning)
        if threads is not None:
            computation = replace(computation, threads=threads)
        _require_memory(amplitudes.grid, self.dtype)
        sea = self.sea if sea is None else sea
        choppiness = self.choppiness if choppiness is None else choppiness
        second = bound_by_order(
            self.order if order is None else order,
            (BOUND if self._bound is None else self.bound) if bound is None else bound,
            amplitudes,
            choppiness,
            computation,
        )
        return from_amplitudes(sea, self.seed, amplitudes, choppiness, computation, second)

    def spectrally_scaled(
        self,
        amplitudes: Amplitudes,
        gain: Real,
        rate: int = 0,
        *,
        planning: str | None = None,
        threads: int | None = None,
    ) -> "Ocean":
        """
        Return the same water with a factor on each of its cells, such as spline coefficients.

        Args:
            amplitudes: the scaled waves, on their own grid.
            gain: factor on the waves of second order [-], (ny, nx // 2 + 1) of that grid.
            rate: time derivatives of the waves of second order.
            planning, threads: as in `Ocean`; None for those of this ocean.
        """
        scaled = self.with_amplitudes(amplitudes, planning=planning, threads=threads, order=1)
        if self._bound is None:
            return scaled
        shown = Shown(self._bound.waves, gain, rate)
        return from_amplitudes(
            self.sea, self.seed, amplitudes, self.choppiness, scaled._computation, shown
        )

    def linear(self) -> "Ocean":
        """Return the ocean of the same waves without second order; this one if it has none."""
        return self if self._bound is None else self.with_amplitudes(self.amplitudes, order=1)

    def _set_up(
        self,
        sea: Sea | None,
        amplitudes: Amplitudes,
        choppiness: float,
        computation: Computation,
        bound: Shown | None = None,
    ) -> None:
        self.sea = sea
        self.amplitudes = amplitudes
        self.grid = amplitudes.grid
        self.choppiness = CHOPPINESS.check("choppiness", choppiness)
        self.dtype = computation.dtype
        self._computation, self._bound = computation, bound
        self._require_range()
        with no_fork():
            self._synthesis = synthesis_of(amplitudes, computation, bound)
        self._few_cycles = bool(np.max(self._synthesis.frequency, initial=0.0) < 2.0**50)
        self._lock, self._process = threading.Lock(), Process()
        self._recipe = (sea, self.seed, amplitudes, choppiness, computation, bound)

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute once: a change would not reach the plans and tables."""
        if hasattr(self, "_recipe") and not name.startswith("_"):
            raise AttributeError(f"an ocean is frozen: make another with the {name} that you want")
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle and copy amplitudes and settings; plans and buffers are made anew."""
        return from_amplitudes, self._recipe

    def _require_range(self) -> None:
        """Raise if a field could overflow its type, at any phases of the waves."""
        a = self.amplitudes
        reach = np.abs(a.forward) + np.abs(a.backward)
        if self._keeps_range(reach):
            return
        k = self.grid.k
        most = float(
            np.max(
                [
                    np.sum(
                        reach
                        * (1.0 + potential_factor(k, a.depth) * k)
                        * (1.0 + k)
                        * (1.0 + a.running_omega)
                    )
                ],
                initial=0.0,
            )
        )
        # The Jacobian multiplies two fields.
        limit = float(np.sqrt(np.finfo(self.dtype).max)) / max(self.choppiness, 1.0)
        if not 2.0 * most < limit:
            raise ParameterError(
                f"waves must keep every field below {limit:.0e} to be computed in {self.dtype}, "
                f"got {2.0 * most:.0e}"
            )
        steepest = (
            2.0
            * float(np.sum(reach * k * (1.0 + potential_factor(k, a.depth) * k)))
            * max(self.choppiness, 1.0)
        )
        # The length of a normal takes fourth powers of slopes and stretches.
        limit = float(np.finfo(self.dtype).max) ** 0.25
        if not steepest < limit:
            raise ParameterError(
                f"waves must keep slopes and stretches below {limit:.0e} in {self.dtype}, "
                f"got {steepest:.0e}"
            )

    def _keeps_range(self, reach: Real) -> bool:
        """
        Return whether the waves would keep the range of `_require_range` if each were as fast, as
        short and as wide as any of them: nearly all seas do.
        """
        grid, a = self.grid, self.amplitudes
        k = np.array([math.hypot(grid.kx[-1], float(np.max(np.abs(grid.ky))))])
        longest = np.array([min(grid.dkx, grid.dky)])
        fastest = (
            float(dispersion.angular_frequency(k, a.depth, a.surface_tension)[0])
            if a.cycles is None or a.loop is None
            else float(np.max(a.cycles)) * 2.0 * np.pi / a.loop
        )
        widest = 1.0 + float((potential_factor(longest, a.depth) * longest)[0])
        most = 2.0 * float(np.sum(reach)) * widest * float(1.0 + k[0]) ** 2 * (1.0 + fastest)
        stretch = max(self.choppiness, 1.0)
        return bool(most * stretch < float(np.finfo(self.dtype).max) ** 0.25)

    @property
    def depth(self) -> float:
        """Still-water depth [m]."""
        return self.amplitudes.depth

    @property
    def loop(self) -> float | None:
        """Period after which the water repeats [s], or None."""
        return self.amplitudes.loop

    @property
    def rarity(self) -> Rarity | None:
        """Rarity of the values that `fo.constrained` made these waves have, or None."""
        return self.amplitudes.rarity

    @property
    def order(self) -> int:
        """1 for linear waves, 2 with the waves of second order that are bound to them."""
        return 1 if self._bound is None else 2

    @property
    def bound(self) -> int:
        """Largest number of waves whose pairs have bound waves; 0 at order 1."""
        return 0 if self._bound is None else self._bound.waves.most

    @property
    def bound_waves(self) -> BoundWaves | None:
        """The waves of second order, or None."""
        return None if self._bound is None else self._bound.waves

    def parents(self) -> Modes:
        """Return the waves whose pairs have bound waves, each (m,), float64; see `modes`."""
        if self._bound is None:
            return Modes(*np.zeros((5, 0)))
        p, grid = self._bound.waves.parents, self.grid
        return Modes(
            kx=p.mx * grid.dkx,
            ky=p.my * grid.dky,
            amplitude=2.0 * np.abs(p.h0),
            phase=-np.angle(p.h0),
            omega=p.running,
        )

    @property
    def backend(self) -> str:
        """FFT library in use: "mkl", "pyfftw" or "scipy"; or "gpu"."""
        return self._synthesis.backend

    def modes(self) -> Modes:
        """
        Return every wave that the frames show: kx, ky, amplitude, phase and omega, each (m,),
        float64.
        """
        return self.amplitudes.modes()

    def to_spectrum(
        self, *, freq: RealLike | None = None, dir: RealLike | None = None
    ) -> "Dataset":
        """
        Return the 2-D spectrum that this ocean's waves realise, an xarray.Dataset in the layout of
        the wavespectra package.

        `efth` (freq, dir) [m2/Hz/degree], directions where waves come FROM, clockwise from north.
        `science.realised_spectrum` has the arguments and the details.
        """
        from fftocean.science import realised_spectrum

        return realised_spectrum(self, freq=freq, dir=dir)

    def frame(self, t: float, fields: Sequence[str] = EIGHT, *, out: Frame | None = None) -> Frame:
        """
        Return the water at time t.

        Args:
            t: any time [s]; on a loop, t and t + loop are the same moment.
            fields: arrays to compute: names of `fields.FIELDS`, "normal", "jacobian". No other is
                computed.
            out: an earlier frame of this shape and precision with at least the same fields; its
                arrays are overwritten, and it is returned.

        Returns:
            Arrays (ny, nx) of `dtype`, and (ny, nx, 3) for "normal"; SI units.

        Raises:
            ParameterError: an unknown field, a time that is not finite, an `out` of another shape
                or dtype.
        """
        t = TIME.check("t", t)
        return self._render(t, fields, out, self._moment(t))

    def _moment(self, t: float) -> Moment:
        return AtTime(t if self.loop is None else math.fmod(t, self.loop) / self.loop)

    def device_frame(self, t: float, fields: Sequence[str] = EIGHT) -> DeviceFrame:
        """
        Return the water at time t in the memory of the graphics processor.

        Args:
            t: time [s], as in `frame`.
            fields: as in `frame`.

        Returns:
            The fields as buffers of `wgpu`, (ny, nx) each and normals (ny, nx, 3); their `read`
            gives `frame(t, fields)`.

        Raises:
            ParameterError: this ocean is not one of `backend="gpu"`, and as `frame`.
        """
        t, fields = TIME.check("t", t), check_fields(fields)
        if not isinstance(self._synthesis, DeviceSynthesis):
            raise ParameterError(f"device_frame needs backend='gpu', got {self.backend!r}")
        with no_fork(), self._locked():
            device, buffers = self._synthesis.buffers(self._moment(t), fields, self.choppiness)
        return DeviceFrame(t, self.grid, self.choppiness, device, buffers)

    def loop_frame(
        self, j: int, count: int, fields: Sequence[str] = EIGHT, *, out: Frame | None = None
    ) -> Frame:
        """
        Return the j-th of `count` equally spaced frames of the loop.

        j and j + count give equal bits, for any whole j: the phase of each wave is a whole number
        of cycles times j/count, in exact arithmetic for `count` up to 2^32.

        Args:
            j: number of the frame, any whole number.
            count: number of frames in a loop.
            fields, out: as in `frame`.

        Raises:
            ParameterError: this ocean does not loop, `j` or `count` is not a whole number, and as
                `frame`.
        """
        if self.loop is None or self.amplitudes.cycles is None:
            raise ParameterError("loop_frame needs an ocean that loops: Ocean(..., loop=16.0)")
        count = MOMENTS.check("count", count)
        if isinstance(j, bool) or not isinstance(j, (int, np.integer)):
            raise ParameterError(f"j must be a whole number, got {j!r}")
        step = int(j) % count
        moment = InLoop(step, count, self._few_cycles)
        return self._render(self.loop * step / count, fields, out, moment)

    def frames(
        self,
        times: Iterable[float],
        fields: Sequence[str] = EIGHT,
        *,
        ahead: int = 1,
        reuse: bool = False,
    ) -> Iterator[Frame]:
        """
        Yield the water at given times, in their order, and compute the next frames meanwhile.

        A thread computes the next frames while the consumer encodes, draws or sends one, so each
        frame takes the longer of the two times, not their sum.

        Args:
            times: any times [s]; an endless iterator is fine.
            fields: as in `frame`.
            ahead: number of frames to compute before they are asked for; 0 starts no thread.
            reuse: overwrite the arrays of earlier frames: a frame is then valid only until the
                next is asked for.

        Raises:
            ParameterError: as `frame`, when the frame in question is due; `ahead` out of range.
        """
        if not isinstance(times, Iterable):
            raise ParameterError(
                f"times must be numbers of seconds in a list or a generator, got {described(times)}"
            )
        fields = check_fields(fields)
        return run_in_order((partial(self.frame, t, fields) for t in times), ahead, reuse)

    def loop_frames(
        self, count: int, fields: Sequence[str] = EIGHT, *, ahead: int = 1, reuse: bool = False
    ) -> Iterator[Frame]:
        """
        Yield the `count` equally spaced frames of one period, with the bits of `loop_frame`.

        Args:
            count: number of frames in a loop.
            fields, ahead, reuse: as in `frames`.

        Raises:
            ParameterError: as `loop_frame` and `frames`.
        """
        fields = check_fields(fields)
        steps = range(MOMENTS.check("count", count))
        return run_in_order(
            (partial(self.loop_frame, j, count, fields) for j in steps), ahead, reuse
        )

    def _render(self, t: float, fields: Sequence[str], out: Frame | None, moment: Moment) -> Frame:
        fields = check_fields(fields)
        arrays = self._outputs(fields, out)
        with no_fork(), self._locked():
            self._synthesis.run(moment, arrays, self.choppiness)
        frame = Frame(t, self.grid, self.choppiness, arrays)
        frame._layout = self._synthesis.shape, self.dtype
        if out is not None:
            out._become(frame)  # its t and fields are the new ones
            return out
        return frame

    def _outputs(self, fields: Sequence[str], out: Frame | None) -> dict[str, Real]:
        """Return the arrays to write to: new ones, or those of an earlier frame."""
        plane = self._synthesis.shape
        if out is not None and type(out) is Frame and out._layout == (plane, self.dtype):
            found = out._arrays
            if all(name in found and found[name].flags.writeable for name in fields):
                return {name: found[name] for name in fields}
        shapes = {name: (*plane, 3) if name == "normal" else plane for name in fields}
        if out is None:
            return {name: aligned_empty(shape, self.dtype) for name, shape in shapes.items()}
        arrays: dict[str, Real] = {}
        if not isinstance(out, Frame) or not set(fields) <= set(out.fields):
            raise ParameterError(
                f"out must be a frame that has {', '.join(fields)}, got {out!r:.200}"
            )
        for name, shape in shapes.items():
            array = out[name]
            if type(array) is not np.ndarray:
                raise ParameterError(
                    f"out.{name} must be a plain array, got {type(array).__name__}"
                )
            if any(np.may_share_memory(array, other) for other in arrays.values()):
                raise ParameterError(
                    f"out.{name} must be an array of its own, and shares its memory with another"
                )
            if (
                array.shape != shape
                or array.dtype != self.dtype
                or not array.flags.c_contiguous
                or not array.flags.writeable
            ):
                raise ParameterError(
                    f"out.{name} must be a writeable, C-contiguous {self.dtype} array of shape "
                    f"{shape}, got {array.dtype} {array.shape}"
                )
            arrays[name] = array
        return arrays

    def _locked(self) -> threading.Lock:
        """
        Return the lock on plans and buffers.

        A forked child makes a lock and threads of its own, since it has none of its parent's.
        """
        if not self._process.is_current:
            with _after_fork:  # several threads of the child can arrive at once
                if not self._process.is_current:
                    self._synthesis.restart()
                    self._lock = threading.Lock()
                    self._process = Process()
        return self._lock

    def _repr_html_(self) -> str:
        """Return a table of the ocean and its surface at t = 0 for notebooks."""
        from fftocean import notebook_html

        g = self.grid
        rows = [
            ("samples", f"{g.nx} x {g.ny}"),
            ("size", f"{g.lx:g} x {g.ly:g} m"),
            ("depth", f"{self.depth:g} m"),
            ("loop", "none" if self.loop is None else f"{self.loop:g} s"),
            ("choppiness", f"{self.choppiness:g}"),
            ("seed", "none: given waves" if self.seed is None else f"{self.seed}"),
            ("dtype", self.dtype),
        ]
        shown = notebook_html.table("Ocean", rows)
        if g.nx * g.ny > 2**20:  # an image is not worth a frame of a second
            return shown
        return shown + notebook_html.image(
            self.frame(0.0, ["height"]).height, "height at t = 0, north up"
        )

    def __repr__(self) -> str:
        g = self.grid
        order = "" if self._bound is None else f", order=2, bound={self.bound}"
        return (
            f"Ocean({g.nx} x {g.ny}, {g.lx:g} x {g.ly:g} m, depth={self.depth:g}, "
            f"loop={self.loop}, dtype={self.dtype!r}{order})"
        )


def check_fields(
    fields: Sequence[str], known: Sequence[str] = (*FIELDS, *POINTWISE)
) -> tuple[str, ...]:
    """
    Return names of fields, each once.

    Args:
        fields: one name, or several.
        known: the names that are allowed.

    Raises:
        ParameterError: a name that is not among `known`, or no name at all.
    """
    try:
        names = (fields,) if isinstance(fields, str) else tuple(dict.fromkeys(fields))
    except TypeError:
        raise ParameterError(
            f"fields must be names such as {tuple(known[:2])}, got {fields!r:.80}"
        ) from None
    for name in names:
        if name not in known:
            raise ParameterError(
                f"a field must be one of {', '.join(known)}, got {name!r:.80}"
                f"{suggestion(name, known)}"
            )
    return names


def from_amplitudes(
    sea: Sea | None,
    seed: int | None,
    amplitudes: Amplitudes,
    choppiness: float,
    computation: Computation,
    bound: Shown | None = None,
) -> Ocean:
    """Return the ocean of given amplitudes, which `sea` and `seed` describe."""
    ocean = Ocean.__new__(Ocean)
    ocean.seed = seed
    ocean._set_up(sea, amplitudes, choppiness, computation, bound)
    ocean.amplitudes.freeze()  # unpickled arrays are writeable again
    return ocean


def bound_by_order(
    order: Any, most: Any, amplitudes: Amplitudes, choppiness: float, computation: Computation
) -> Shown | None:
    """
    Return the second-order waves of a tile, or None at order 1.

    Raises:
        ParameterError: an order or a number of waves out of range, and as `bound_waves`.
    """
    order, most = ORDER.check("order", order), BOUND_WAVES.check("bound", most)
    if order == 1:
        return None
    choppiness = CHOPPINESS.check("choppiness", choppiness)
    return Shown(bound_waves(amplitudes, choppiness, most, computation.dtype))


def memory_needed(grid: Grid, dtype: str) -> float:
    """Return the memory for seeding an ocean and for one frame of its eight fields [B]."""
    half, number = grid.half_shape[0] * grid.half_shape[1], np.dtype(dtype).itemsize
    # Amplitudes, variances, frequencies and cycles, in double precision.
    waves = (2 * 16 + 4 * 8) * half
    checking = 9 * 8 * half  # the sums of `_require_range`
    tables = (6 * number + 8) * half  # the inputs of the first pass
    intermediate, fields = 5 * 2 * number * half, 8 * number * grid.nx * grid.ny
    return float(waves + max(checking, tables + intermediate + fields))


def _checked(n: Any, size: Any, computation: Computation, loop: Any) -> tuple[Grid, float | None]:
    """Return the grid and the checked loop; raise if there is too little memory."""
    grid = Grid.of(n, size)
    _require_memory(grid, computation.dtype)
    return grid, None if loop is None else LOOP.check("loop", loop)


def _require_memory(grid: Grid, dtype: str) -> None:
    require_memory(f"an ocean of n = {grid.nx} x {grid.ny}", memory_needed(grid, dtype))


def longest_period(sea: Sea, band: Band, tp: float | None = None) -> float:
    """
    Return the period of the sea's peak, or of the longest waves of a band above it [s].

    `tp` spares the search for the sea's peak if that is known.
    """
    tp = sea.tp if tp is None else tp
    slowest = float(dispersion.angular_frequency(band[0], sea.depth, sea.surface_tension))
    return min(tp, 2.0 * math.pi / slowest) if slowest > 0.0 else tp


def _checked_band(band: Any) -> Band:
    """Return a band of two wavenumbers, the first below the second [rad/m]."""
    try:
        low, high = band
    except (TypeError, ValueError):
        raise ParameterError(f"band must be two wavenumbers [rad/m], got {band!r:.80}") from None
    low, high = BAND_START.check("band[0]", low), BAND_EDGE.check("band[1]", high)
    if not low < high:
        raise ParameterError(f"band must rise, got {low:g} to {high:g} rad/m")
    return low, high
