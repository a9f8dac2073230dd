"""One periodic patch of water: `Ocean.frame(t)` is a pure function of the ocean and the time."""

import math
import os
import threading
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from fftocean.amplitudes import Amplitudes, Draw, Modes, place_modes, seed_amplitudes
from fftocean.arrays import Real, RealLike, precision_of
from fftocean.cells import WHOLE, Band
from fftocean.errors import ParameterError, SeaWarning, described
from fftocean.fields import EIGHT, FIELDS, potential_factor
from fftocean.forks import no_fork
from fftocean.frame import Frame as Frame
from fftocean.grid import Grid
from fftocean.host import require_memory
from fftocean.kernels import passes
from fftocean.limits import AHEAD, BAND_EDGE, BAND_START, CHOPPINESS, LOOP, MOMENTS, THREADS, TIME
from fftocean.physics import dispersion
from fftocean.physics.sea import Sea
from fftocean.synthesis import POINTWISE, Synthesis, Turn

if TYPE_CHECKING:
    from xarray import Dataset


_forked = threading.Lock()


def _renew() -> None:
    """In a forked child: whoever held it is not there."""
    global _forked
    _forked = threading.Lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_renew)


class Ocean:
    """
    One periodic patch of a sea. `frame(t)` depends on t alone: ask for frames in any order.

    Args:
        sea: what is ordered.
        n: samples a side, any whole number, or (nx, ny).
        size: width of the patch [m], or (lx, ly).
        seed: which of all the seas that it could be; a finer n at the same size and seed shows the
            same waves, sharper.
        loop: period after which the water repeats exactly [s]; None lets it run free.
        choppiness: factor on the horizontal displacement [-]: 1 is linear wave theory, 0 a plain
            height field.
        dtype: "float32" or "float64", of the fields; amplitudes and phases are always float64.
        amplitudes: "gaussian" as in nature, or "fixed" for random phases alone (see
            `seed_amplitudes`).
        band: the wavenumbers |k| to hold of those that the tile can, from the first up to the
            second [rad/m]; a `Cascade` sets them.
        backend: "mkl", "pyfftw", "scipy", or "auto" for the first of them that is installed.
        planning: "estimate" for the same bytes in every run; "measure" or "patient" for live use.
        threads: how many threads share the work on one frame; the bytes are the same for any
            number.

    An ocean owns plans and buffers, and locks them while it computes: threads may share one, but
    only one of them works at a time; give each its own to work in parallel. A fork waits for what
    other threads have begun (see `forks`), and the child may use the oceans that it got and make
    new ones.

    Raises:
        ParameterError: a value out of range, a sea whose spectrum is not finite and >= 0, or more
            memory than there is.
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
    ) -> None:
        if not isinstance(sea, Sea):
            raise ParameterError(f"sea must be a Sea, got {described(sea)}")
        if not isinstance(amplitudes, str):
            raise ParameterError(
                f"amplitudes must be 'gaussian' or 'fixed', got {described(amplitudes)}"
            )
        grid, dtype, loop = _checked(n, size, dtype, loop)
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
            drawn = seed_amplitudes(sea, grid, seed=seed, loop=loop, draw=amplitudes, band=band)
        self._set_up(sea, drawn, choppiness, dtype, backend, planning, threads)

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
    ) -> "Ocean":
        """
        Make an ocean of given waves: height = sum of a cos(k.x - omega t - phase), k = 2 pi (mx/lx,
        my/ly).

        Args:
            modes: (mx, my, amplitude [m], phase [rad]) of each wave; waves on the same (mx, my) add
                up.
            depth: still-water depth [m].
            surface_tension: [N/m].
            n, size, loop, choppiness, dtype, backend, planning, threads: as in `Ocean`.

        Raises:
            ParameterError: a wave that the grid cannot hold, or a value out of range.
        """
        grid, dtype, loop = _checked(n, size, dtype, loop)
        if not isinstance(modes, Iterable):
            raise ParameterError(
                f"modes must be a list of (mx, my, amplitude, phase), got {described(modes)}"
            )
        amplitudes = place_modes(
            modes, grid, depth=depth, surface_tension=surface_tension, loop=loop
        )
        ocean = cls.__new__(cls)
        ocean.seed = None  # there is no chance in it
        ocean._set_up(None, amplitudes, choppiness, dtype, backend, planning, threads)
        return ocean

    def _set_up(
        self,
        sea: Sea | None,
        amplitudes: Amplitudes,
        choppiness: float,
        dtype: str,
        backend: str,
        planning: str,
        threads: int,
    ) -> None:
        self.sea = sea
        self.amplitudes = amplitudes
        self.grid = amplitudes.grid
        self.choppiness = CHOPPINESS.check("choppiness", choppiness)
        self.dtype = dtype
        self._require_range()
        workers = THREADS.check_whole("threads", threads)
        with no_fork():
            self._synthesis = Synthesis(
                amplitudes, dtype, backend=backend, planning=planning, threads=workers
            )
        self._frequency = _frequencies(amplitudes, self._synthesis.columns)
        self._few_turns = bool(np.max(self._frequency, initial=0.0) < 2.0**50)
        self._lock, self._pid = threading.Lock(), os.getpid()
        self._recipe = (sea, self.seed, amplitudes, choppiness, dtype, backend, planning, threads)

    def __setattr__(self, name: str, value: Any) -> None:
        """Set up once: a change would not reach the plans and tables that were made."""
        if hasattr(self, "_recipe") and not name.startswith("_"):
            raise AttributeError(f"an ocean is frozen: make another with the {name} that you want")
        super().__setattr__(name, value)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle and copy as what it is made of; plans and buffers are made anew."""
        return remade, self._recipe

    def _require_range(self) -> None:
        """Refuse a sea whose fields would overflow their type, however the waves meet."""
        a = self.amplitudes
        reach = np.abs(a.forward) + np.abs(a.backward)
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
        limit = float(np.sqrt(np.finfo(self.dtype).max)) / max(
            self.choppiness, 1.0
        )  # the Jacobian multiplies two of them
        if not 2.0 * most < limit:
            raise ParameterError(
                f"waves must keep every field below {limit:.0e} to be computed in {self.dtype}, got {2.0 * most:.0e}"
            )
        steepest = (
            2.0
            * float(np.sum(reach * k * (1.0 + potential_factor(k, a.depth) * k)))
            * max(self.choppiness, 1.0)
        )
        limit = (
            float(np.finfo(self.dtype).max) ** 0.25
        )  # a normal's length takes fourth powers of them
        if not steepest < limit:
            raise ParameterError(
                f"waves must keep slopes and stretches below {limit:.0e} in {self.dtype}, got {steepest:.0e}"
            )

    @property
    def depth(self) -> float:
        """Still-water depth [m]."""
        return self.amplitudes.depth

    @property
    def loop(self) -> float | None:
        """The period after which the water repeats [s], or None."""
        return self.amplitudes.loop

    @property
    def backend(self) -> str:
        """The FFT library in use."""
        return self._synthesis.backend

    def modes(self) -> Modes:
        """
        Return every wave: kx, ky, amplitude, phase and omega, each (m,), float64; the same sea as
        the frames show.
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
            fields: which arrays to compute: names of `fields.FIELDS`, "normal", "jacobian". Only
                what is asked is computed.
            out: an earlier frame of this shape and precision with at least the same fields: it
                becomes the new one and is returned.

        Raises:
            ParameterError: an unknown field, a time that is not finite, an `out` of another shape
                or dtype.
        """
        t = TIME.check("t", t)
        moment = t if self.loop is None else math.fmod(t, self.loop) / self.loop

        def turn(columns: slice, out: Real) -> None:
            passes.turns_at(self._frequency[columns], moment, out)

        return self._render(t, fields, out, turn)

    def loop_frame(
        self, j: int, count: int, fields: Sequence[str] = EIGHT, *, out: Frame | None = None
    ) -> Frame:
        """
        Return the j-th of `count` equally spaced frames of the loop; j and j + count give equal
        bits, for any whole j.

        The phase of each wave is a whole number of turns times j/count, in exact arithmetic for
        `count` up to 2^32.

        Raises:
            ParameterError: this ocean does not loop, `j` or `count` is not a whole number, and as
                `frame`.
        """
        if self.loop is None or self.amplitudes.cycles is None:
            raise ParameterError("loop_frame needs an ocean that loops: Ocean(..., loop=16.0)")
        count = MOMENTS.check_whole("count", count)
        if isinstance(j, bool) or not isinstance(j, (int, np.integer)):
            raise ParameterError(f"j must be a whole number, got {j!r}")
        step = int(j) % count

        def turn(columns: slice, out: Real) -> None:
            if count <= 2**26 and self._few_turns:
                passes.turns_in_loop(self._frequency[columns], float(step), float(count), out)
            else:
                passes.turns_in_fine_loop(self._frequency[columns], step, count, out)

        return self._render(self.loop * step / count, fields, out, turn)

    def frames(
        self,
        times: Iterable[float],
        fields: Sequence[str] = EIGHT,
        *,
        ahead: int = 1,
        reuse: bool = False,
    ) -> Iterator[Frame]:
        """
        Yield the water at each of some times, in their order, while the next is computed on a
        thread of its own.

        What the consumer does with a frame (encode, draw, send) and what it takes to make the next
        then cost the longer of the two.

        Args:
            times: any times [s], as many as there are; an endless supply is fine.
            fields: as in `frame`.
            ahead: how many frames to compute ahead of the one that was handed out; 0 does without
                the thread.
            reuse: hand out the arrays of earlier frames again: a frame is then good only until the
                next one is asked for.

        Raises:
            ParameterError: as `frame`, when the frame in question comes up; `ahead` out of range.
        """
        if not isinstance(times, Iterable):
            raise ParameterError(
                f"times must be numbers of seconds in a list or a generator, got {described(times)}"
            )
        fields = named(fields)
        return self._pipeline((partial(self.frame, t, fields) for t in times), ahead, reuse)

    def loop_frames(
        self, count: int, fields: Sequence[str] = EIGHT, *, ahead: int = 1, reuse: bool = False
    ) -> Iterator[Frame]:
        """
        Yield the `count` equally spaced frames of one period, as `frames` does and to the bits of
        `loop_frame`.

        Raises:
            ParameterError: as `loop_frame` and `frames`.
        """
        fields = named(fields)
        steps = range(MOMENTS.check_whole("count", count))
        return self._pipeline(
            (partial(self.loop_frame, j, count, fields) for j in steps), ahead, reuse
        )

    def _pipeline(
        self, jobs: Iterator[Callable[..., Frame]], ahead: int, reuse: bool
    ) -> Iterator[Frame]:
        """
        Run jobs in their order, some of them ahead; each takes an earlier frame, or None, as `out`.
        """
        ahead = AHEAD.check_whole("ahead", ahead)
        return self._inline(jobs, reuse) if ahead == 0 else self._ahead(jobs, ahead, reuse)

    def _inline(self, jobs: Iterator[Callable[..., Frame]], reuse: bool) -> Iterator[Frame]:
        frame = None
        for job in jobs:
            frame = job(out=frame if reuse else None)
            yield frame

    def _ahead(
        self, jobs: Iterator[Callable[..., Frame]], ahead: int, reuse: bool
    ) -> Iterator[Frame]:
        spare: list[Frame] = []  # frames that the consumer has done with
        coming: deque[tuple[Callable[..., Frame], Future[Frame] | None]] = deque()
        complaint: BaseException | None = None
        pid = os.getpid()

        def next_frame() -> Frame:
            job, future = coming.popleft()
            if (
                future is None or pid != os.getpid()
            ):  # nobody is at it, or somebody whom a forked child has not got
                return job()
            return future.result()

        with ThreadPoolExecutor(1, thread_name_prefix="fftocean-ahead") as worker:
            try:
                while complaint is None:
                    try:
                        job = next(jobs)
                    except StopIteration:
                        break
                    # of who supplies the times: in its turn, after the frames that were asked for
                    # before
                    except Exception as error:
                        complaint = error
                        break
                    try:
                        coming.append(
                            (
                                job,
                                worker.submit(job, out=spare.pop() if spare else None)
                                if pid == os.getpid()
                                else None,
                            )
                        )
                    except RuntimeError:  # Python is on its way out and starts nothing new
                        coming.append((job, None))
                    if len(coming) > ahead:
                        yield (frame := next_frame())
                        if reuse:
                            spare.append(frame)
                while coming:
                    yield next_frame()
            finally:  # the consumer may stop early
                for _, future in coming:
                    if future is not None:
                        future.cancel()
                if pid != os.getpid():
                    worker.shutdown(wait=False)
        if complaint is not None:
            raise complaint

    def _render(self, t: float, fields: Sequence[str], out: Frame | None, turn: Turn) -> Frame:
        fields = named(fields)
        arrays = self._outputs(fields, out)
        with no_fork(), self._locked():
            self._synthesis.run(turn, arrays, self.choppiness)
        frame = Frame(t, self.grid, self.choppiness, arrays)
        if out is not None:
            out._become(frame)  # else it would go on naming the moment before
            return out
        return frame

    def _outputs(self, fields: Sequence[str], out: Frame | None) -> dict[str, Real]:
        """The arrays to write to: new ones, or those of an earlier frame."""
        shapes = {
            name: (*self.grid.shape, 3) if name == "normal" else self.grid.shape for name in fields
        }
        if out is None:
            return {name: np.empty(shape, self.dtype) for name, shape in shapes.items()}
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
                    f"out.{name} must be a writeable, C-contiguous {self.dtype} array of shape {shape}, got {array.dtype} {array.shape}"
                )
            arrays[name] = array
        return arrays

    def _locked(self) -> threading.Lock:
        """
        The lock on plans and buffers; a forked child gets a fresh one and fresh threads, as it has
        none of its parent's.
        """
        if self._pid != os.getpid():
            with _forked:  # the child's own threads may come together
                if self._pid != os.getpid():
                    self._synthesis.restart()
                    self._lock = threading.Lock()
                    self._pid = os.getpid()
        return self._lock

    def __repr__(self) -> str:
        g = self.grid
        return f"Ocean({g.nx} x {g.ny}, {g.lx:g} x {g.ly:g} m, depth={self.depth:g}, loop={self.loop}, dtype={self.dtype!r})"


def named(fields: Sequence[str], known: Sequence[str] = (*FIELDS, *POINTWISE)) -> tuple[str, ...]:
    """The names of fields, each once, all of them known."""
    try:
        names = (fields,) if isinstance(fields, str) else tuple(dict.fromkeys(fields))
    except TypeError:
        raise ParameterError(
            f"fields must be names such as {tuple(known[:2])}, got {fields!r:.80}"
        ) from None
    for name in names:
        if name not in known:
            raise ParameterError(f"a field must be one of {', '.join(known)}, got {name!r:.80}")
    return names


def remade(sea: Sea | None, seed: int | None, *made: Any) -> Ocean:
    """An ocean from its own amplitudes, without seeding them again."""
    ocean = Ocean.__new__(Ocean)
    ocean.seed = seed
    ocean._set_up(sea, *made)
    ocean.amplitudes.freeze()
    return ocean


def memory_needed(grid: Grid, dtype: str) -> float:
    """Bytes that an ocean and one frame of its eight fields take, with what it takes to seed it."""
    half, number = grid.half_shape[0] * grid.half_shape[1], np.dtype(dtype).itemsize
    waves = (
        2 * 16 + 4 * 8
    ) * half  # amplitudes, variances, frequencies, cycles; in double precision
    making = 9 * 8 * half  # what it takes to look at them all before they are used
    turning = (6 * number + 8) * half  # as the first pass wants them
    between, fields = 5 * 2 * number * half, 8 * number * grid.nx * grid.ny
    return float(waves + max(making, turning + between + fields))


def _checked(n: Any, size: Any, dtype: Any, loop: Any) -> tuple[Grid, str, float | None]:
    """Check what the two ways to make an ocean have in common, before anything is allocated."""
    grid = Grid.of(n, size)
    name = precision_of(dtype)
    require_memory(f"an ocean of n = {grid.nx} x {grid.ny}", memory_needed(grid, name))
    return grid, name, None if loop is None else LOOP.check("loop", loop)


def longest_period(sea: Sea, band: Band) -> float:
    """The period of the sea's peak, or of the longest waves of a band above it [s]."""
    slowest = float(dispersion.angular_frequency(band[0], sea.depth, sea.surface_tension))
    return min(sea.tp, 2.0 * math.pi / slowest) if slowest > 0.0 else sea.tp


def _checked_band(band: Any) -> Band:
    """Two wavenumbers, the first below the second."""
    try:
        low, high = band
    except (TypeError, ValueError):
        raise ParameterError(f"band must be two wavenumbers [rad/m], got {band!r:.80}") from None
    low, high = BAND_START.check("band[0]", low), BAND_EDGE.check("band[1]", high)
    if not low < high:
        raise ParameterError(f"band must rise, got {low:g} to {high:g} rad/m")
    return low, high


def _frequencies(amplitudes: Amplitudes, columns: int) -> Real:
    """
    Return the turns that each wave makes in a second or, on a loop, in its period: whole numbers
    then; (columns, ny), float64.

    What they are rounded by is all that a phase ever loses.
    """
    if amplitudes.cycles is not None:
        return np.ascontiguousarray(amplitudes.cycles.T[:columns], dtype=np.float64)
    frequency = np.empty((columns, amplitudes.grid.ny))
    for column, omega in zip(
        frequency, amplitudes.omega.T, strict=False
    ):  # the Nyquist column is left over
        column[:] = dispersion.turns_per_second(omega)
    return frequency
