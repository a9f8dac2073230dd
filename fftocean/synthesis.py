"""
Synthesis of fields from amplitudes by two-dimensional inverse FFTs.

A two-dimensional inverse transform is a pass along y, then one along x. The fields are real, so
their spectra are needed for kx >= 0 only: each is a half-spectrum. After the first pass every row y
is the Hermitian half of a real row. Two real rows A and B then share one complex row of the second
pass, A + i B, whose spectrum is

    A(k) + i B(k)  at +k,      conj(A(k) - i B(k))  at -k.

Where B = dA/dx, i B = -kx A: the two are A times real factors, 1 - kx and 1 + kx, and one
half-spectrum serves both fields in the first pass as well. So eight fields take five transforms
along y and four along x.

    waves ----- phase in cycles ----> h(k, t), one block of columns kx at a time      first pass
    h --------- powers of ky, i^m --> half-spectra ---- inverse FFT along y ---> intermediate
    rows ------ powers of kx -------> packed rows ----- inverse FFT along x ---> fields
                                                                                      second pass

Both passes run over blocks that stay in cache. `fields.FIELDS` has the derivative of each field;
`Plan` says which transforms a set of fields takes.

Two numbers keep single precision in range. Waves are divided by the largest of them (a power of
two, which rounds nothing), and the second pass multiplies it back. And since two fields of a packed
row share the rounding errors of its transform, a power of two first makes them equally large.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import COMPLEX_OF, Complex, Real
from fftocean.bound_waves import BoundSpectrum, PhaseFunction, Shown
from fftocean.computation import Computation
from fftocean.fields import FIELDS, POINTWISE, Field, potential_factor
from fftocean.kernels import passes, surface
from fftocean.physics import dispersion
from fftocean.transforms import aligned, inverse_rows

Source = tuple[str, int]
""""height" or "potential", and the number of time derivatives, 0 or 1."""

PAIRS: tuple[tuple[str, ...], ...] = (
    ("height", "slope_x"),
    ("displace_x", "stretch_xx"),
    ("displace_y", "stretch_xy"),
    ("slope_y", "stretch_yy"),
    ("velocity_z", "velocity_y"),
    ("velocity_x",),
)
"""
The fields that share a packed row.

Pairs are computed whole, whichever of the two is asked for, so a field has the same bits whatever
is asked beside it.
"""


@dataclass(frozen=True, slots=True)
class HalfSpectrum:
    """
    An input of the first pass: i^quarters (ky^power source [+ sign weight ky^other_power other]).

    Factors of kx follow in the second pass.
    """

    pair: tuple[str, ...]  # the fields that it is for
    source: Source
    quarters: int  # factors of i, quarter cycles of phase
    power: int
    other: Source | None = None
    other_power: int = 0
    sign: int = 1


@dataclass(frozen=True, slots=True)
class PackedRow:
    """A complex row of the second pass: its one or two fields, and their half-spectra."""

    pair: tuple[str, ...]
    plus: int  # number of the half-spectrum at +k
    minus: int  # and at -k


@dataclass(frozen=True, slots=True)
class Plan:
    """The transforms that a set of fields takes."""

    fields: tuple[str, ...]  # that were asked for
    linear: tuple[str, ...]  # that are computed, some of them for their partner's sake
    half_spectra: tuple[HalfSpectrum, ...]
    rows: tuple[PackedRow, ...]

    @property
    def sources(self) -> tuple[Source, ...]:
        """Sources of the half-spectra, potentials first."""
        used = {source for one in self.half_spectra for source in (one.source, one.other) if source}
        return tuple(sorted(used, reverse=True))


def row_pairs() -> tuple[tuple[str, ...], ...]:
    """
    Return the fields of each packed row: `PAIRS`, as far as `FIELDS` allows.

    Two fields whose spectra differ by more than a real factor and one factor of kx take a row each.
    """
    return tuple(
        row
        for pair in PAIRS
        for row in (
            [pair] if _is_x_derivative(pair) or _is_combinable(pair) else [(name,) for name in pair]
        )
    )


def _is_x_derivative(pair: tuple[str, ...]) -> bool:
    """Return True if the second field is d/dx of the first, or if there is no second."""
    if len(pair) == 1:
        return True
    a, b = (FIELDS[name] for name in pair)
    return (b.of, b.dt, b.dy, b.dx) == (a.of, a.dt, a.dy, a.dx + 1)


def _is_combinable(pair: tuple[str, ...]) -> bool:
    """Return True if A and i B have no factor of kx and differ by a real factor."""
    a, b = (FIELDS[name] for name in pair)
    return a.dx == b.dx == 0 and (1 + b.dy - a.dy) % 2 == 0


def _half_spectra(pair: tuple[str, ...]) -> tuple[HalfSpectrum, ...]:
    """
    Return the half-spectra of a pair.

    One, A, where B is its derivative along x; else two, A + i weight B and A - i weight B.
    """
    a: Field = FIELDS[pair[0]]
    if _is_x_derivative(pair):
        return (HalfSpectrum(pair, (a.of, a.dt), a.dx + a.dy, a.dy),)
    b: Field = FIELDS[pair[1]]
    sign = (-1) ** ((1 + b.dy - a.dy) // 2)  # of i B relative to A: half cycles of phase
    return tuple(
        HalfSpectrum(pair, (a.of, a.dt), a.dy, a.dy, (b.of, b.dt), b.dy, s) for s in (sign, -sign)
    )


@lru_cache(maxsize=256)
def plan_fields(fields: tuple[str, ...]) -> Plan:
    """Return the plan for a set of field names."""
    wanted = {
        name for field in fields for name in ((field,) if field in FIELDS else POINTWISE[field])
    }
    pairs = tuple(pair for pair in row_pairs() if wanted & set(pair))
    half_spectra: list[HalfSpectrum] = []
    rows = []
    for pair in pairs:
        own = _half_spectra(pair)
        rows.append(PackedRow(pair, len(half_spectra), len(half_spectra) + len(own) - 1))
        half_spectra.extend(own)
    linear = tuple(name for pair in pairs for name in pair)
    return Plan(fields, linear, tuple(half_spectra), tuple(rows))


def root_mean_squares(amplitudes: Amplitudes) -> dict[str, float]:
    """
    Return the root mean square of each field, for waves divided by the largest of them.

    A derivative along an axis that no wave runs along is 0.
    """
    grid, omega = amplitudes.grid, amplitudes.running_omega
    per_unit = 1.0 / largest_wave(amplitudes)
    kx, ky = grid.kx, grid.ky
    squares = dict.fromkeys(FIELDS, 0.0)
    at_a_time = max(1, 2**15 // kx.size)  # rows that stay in cache
    for start in range(0, ky.size, at_a_time):
        rows = slice(start, start + at_a_time)
        energy = sum(
            (np.abs(waves[rows]) * per_unit) ** 2
            for waves in (amplitudes.forward, amplitudes.backward)
        )
        k = np.hypot(kx, ky[rows, None])
        sources = {
            (of, dt): energy * (factor * omega[rows] ** dt) ** 2
            for of, factor in (
                ("height", 1.0),
                ("potential", potential_factor(k, amplitudes.depth)),
            )
            for dt in (0, 1)
        }
        for name, field in FIELDS.items():
            along_x = np.einsum("yx,x->y", sources[field.of, field.dt], kx ** (2 * field.dx))
            squares[name] += float(np.sum(along_x * ky[rows] ** (2 * field.dy)))
    return {name: math.sqrt(square) for name, square in squares.items()}


def balancing_weight(first: float, second: float, reach: int) -> float:
    """
    Return the power of two that makes a second field as large as a first.

    It is limited to 2^-reach ... 2^reach, and 1 where the second field is 0.
    """
    if not second > 0.0:
        return 1.0
    if not first > 0.0:
        return 2.0**-reach
    return 2.0 ** max(-reach, min(reach, round(math.log2(first) - math.log2(second))))


def largest_wave(amplitudes: Amplitudes) -> float:
    """Return the power of two next to the largest |h0| [m]; 1 for flat water."""
    largest = max(
        float(np.max(np.abs(a), initial=0.0)) for a in (amplitudes.forward, amplitudes.backward)
    )
    return 2.0 ** max(round(math.log2(largest)), -1000) if largest > 0.0 else 1.0


def block_size(n: int, available: int) -> int:
    """
    Return the number of rows of length n in a block; measured, and flat about there.

    Fewer would lie nearer to the processor, but every call of a kernel releases the interpreter
    lock and takes it again: with short calls two threads wait for each other more than they work
    (at n = 512, 16 rows gain 1.2 times by a second thread, 64 rows 1.8 times).
    """
    return min(max(2**16 // n, 32), 64, available)


class Synthesis:
    """
    The waves of one tile, and the workspaces that transform them into fields.

    Not thread-safe: the owner must serialise calls of `run`.

    Args:
        amplitudes: the waves at t = 0.
        computation: precision, FFT library, planning effort and threads.
        bound: second-order waves to add to the height, if any.

    Raises:
        ParameterError: a backend or planning effort that is unknown or not installed.
    """

    def __init__(
        self, amplitudes: Amplitudes, computation: Computation, bound: Shown | None = None
    ) -> None:
        self._amplitudes, self._grid = amplitudes, amplitudes.grid
        dtype = computation.dtype
        self._dtype = np.dtype(dtype)
        grid = self._grid
        self.shape = grid.shape  # of a field, (ny, nx)
        # Columns of the half plane; the Nyquist column, where there is one, is always zero.
        self.columns = (grid.nx + 1) // 2
        self._unit = largest_wave(amplitudes)
        self._waves = self._wave_table(amplitudes)
        self.frequency = _frequencies(amplitudes, self.columns)
        self._bound = (
            BoundSpectrum(bound, self._unit, self.columns, computation.threads)
            if bound is not None and len(bound.waves)
            else None
        )
        k = grid.k.T[: self.columns]
        self._potential = np.ascontiguousarray(potential_factor(k, amplitudes.depth), dtype=dtype)
        self._omega: Real | None = None
        self._buffer = np.zeros(0, dtype=COMPLEX_OF[dtype])
        size = self._size = root_mean_squares(amplitudes)
        pairs = row_pairs()
        # A field smaller still beside its partner (in a sea nearly along one axis) gets errors of
        # 1e-34 of the partner in single precision.
        reach = 90 if self._dtype == np.float32 else 500
        self._weights: dict[tuple[str, ...], float] = {
            pair: balancing_weight(size[pair[0]], size[pair[1]], reach)
            for pair in pairs
            if len(pair) == 2
        }
        self._ky_factors = {
            spectrum: self._ky_factors_of(spectrum)
            for pair in pairs
            for spectrum in _half_spectra(pair)
        }
        self._kx_factors = {pair: self._kx_factors_of(pair) for pair in pairs}
        self._widths = (block_size(grid.ny, self.columns), block_size(grid.nx, grid.ny))
        blocks = max(-(-self.columns // self._widths[0]), -(-grid.ny // self._widths[1]))
        self._workspaces = [
            _Workspace(self._widths, grid.shape, computation)
            for _ in range(min(computation.threads, blocks))
        ]
        self.restart()
        self.backend = self._workspaces[0].first.backend

    def restart(self) -> None:
        """Start the threads; a forked child calls it again, since it has none of its parent's."""
        others = len(self._workspaces) - 1
        self._pool = ThreadPoolExecutor(others, thread_name_prefix="fftocean") if others else None

    def run(self, phase: PhaseFunction, outputs: Mapping[str, Real], choppiness: float) -> None:
        """
        Compute fields.

        Args:
            phase: writes the phases of the waves.
            outputs: the arrays to write to by field name, (ny, nx) or, for normals, (ny, nx, 3).
            choppiness: factor on the horizontal displacement [-].
        """
        plan = plan_fields(tuple(outputs))
        if not plan.linear:
            return
        if self._omega is None and any(spectrum.source[1] for spectrum in plan.half_spectra):
            self._omega = np.ascontiguousarray(
                self._amplitudes.running_omega.T[: self.columns], dtype=self._dtype
            )
        if self._bound is not None:
            self._sum_bound_waves(self._bound, plan, phase)
        intermediate = self._intermediate(len(plan.half_spectra))
        transposed = _transposable(intermediate)
        c = self._dtype.type(choppiness)
        self._run_blocks(
            self.columns,
            self._widths[0],
            lambda workspace, block: self._first_pass(plan, workspace, block, phase, transposed),
        )
        rows = _parts(intermediate)
        self._run_blocks(
            self._grid.ny,
            self._widths[1],
            lambda workspace, block: self._second_pass(plan, workspace, block, rows, outputs, c),
        )

    def _run_blocks(
        self, total: int, width: int, work: "Callable[[_Workspace, slice], None]"
    ) -> None:
        """
        Do the blocks of one pass, each thread with a workspace of its own.

        The blocks do not depend on the number of threads, nor do their bytes.
        """
        blocks = [slice(start, min(start + width, total)) for start in range(0, total, width)]

        def run(workspace: _Workspace, own: Iterable[slice]) -> None:
            for block in own:
                work(workspace, block)

        (mine, *others) = [
            (workspace, blocks[i :: len(self._workspaces)])
            for i, workspace in enumerate(self._workspaces)
        ]
        tasks: list[Future[None]] = []
        try:
            for share in others:
                assert self._pool is not None  # there is one for more workspaces than one
                try:
                    tasks.append(self._pool.submit(run, *share))
                except RuntimeError:  # the interpreter is shutting down and starts nothing new
                    run(*share)
            run(*mine)  # in this thread, whose caches are warm
            for task in tasks:
                task.result()
        finally:  # after an interrupt, too, no workspace may be reused while a thread still writes
            wait(tasks)

    def _sum_bound_waves(self, bound: BoundSpectrum, plan: Plan, phase: PhaseFunction) -> None:
        """Compute the second-order height spectra that a plan needs."""
        rates = [dt for of, dt in plan.sources if of == "height"]
        if not rates:
            return
        bound.advance(phase, rates)
        self._run_blocks(bound.parts, 1, lambda _, part: bound.sum(part.start, rates))

    def _first_pass(
        self,
        plan: Plan,
        workspace: "_Workspace",
        block: slice,
        phase: PhaseFunction,
        intermediate: Real | Complex,
    ) -> None:
        """Advance the waves of some columns kx, derive and transform along y, and transpose."""
        n = block.stop - block.start
        cycles, cosine, sine = workspace.cycles[:n], workspace.cosine[:n], workspace.sine[:n]
        phase(self.frequency[block], cycles)
        (passes.phasors_single if self._dtype == np.float32 else passes.phasors)(
            cycles, cosine, sine
        )
        ready: set[Source] = set()

        def parts_of(source: Source) -> tuple[Real, Real]:
            """Return real and imaginary part of a source, computed once for the block."""
            parts: tuple[Real, Real] = workspace.parts[source]
            if source not in ready:
                ready.add(source)
                of, dt = source
                if of == "potential":
                    for whole, part in zip(parts_of(("height", dt)), parts, strict=True):
                        passes.scale(whole, self._potential[block], part)
                elif dt == 0:
                    passes.heights(self._waves[block], cosine, sine, *parts)
                else:
                    assert self._omega is not None  # made before the first pass
                    passes.height_rates(
                        self._waves[block], cosine, sine, self._omega[block], *parts
                    )
            return parts

        if self._bound is not None:
            for of, dt in plan.sources:  # potentials before heights: those have no second order
                real, imag = parts_of((of, dt))
                if of == "height":
                    self._bound.add(dt, block.start, real[:n], imag[:n])
        for s, spectrum in enumerate(plan.half_spectra):
            power, other_power, first, second = self._ky_factors[spectrum]
            parts = _swapped(parts_of(spectrum.source), spectrum.quarters)
            source = workspace.first_source
            if spectrum.other is None:
                passes.derive(*parts, power, first, second, n, source)
            else:
                other = _swapped(parts_of(spectrum.other), spectrum.quarters)
                passes.mix(*parts, power, *other, other_power, first, second, n, source)
            workspace.first()
            passes.transpose(workspace.first_result, s, block.start, n, intermediate)

    def _second_pass(
        self,
        plan: Plan,
        workspace: "_Workspace",
        block: slice,
        intermediate: Real,
        outputs: Mapping[str, Real],
        choppiness: float,
    ) -> None:
        """Derive and transform packed rows along x, split them, and finish pointwise fields."""
        n = block.stop - block.start
        rows = {
            name: outputs[name][block] if name in outputs else workspace.scratch[name][:n]
            for name in plan.linear
        }
        for row in plan.rows:
            plus, minus, undo = self._kx_factors[row.pair]
            passes.pack(
                intermediate,
                block.start,
                n,
                row.plus,
                row.minus,
                plus,
                minus,
                workspace.second_source,
            )
            workspace.second()
            if len(row.pair) == 2:
                passes.split(workspace.second_result, undo, rows[row.pair[0]], rows[row.pair[1]])
            else:
                passes.real_parts(workspace.second_result, rows[row.pair[0]])
        if "normal" in outputs:
            sx, sy, xx, xy, yy = (rows[name] for name in POINTWISE["normal"])
            surface.normals(sx, sy, xx, xy, yy, choppiness, outputs["normal"][block])
        if "jacobian" in outputs:
            xx, xy, yy = (rows[name] for name in POINTWISE["jacobian"])
            surface.jacobian(xx, xy, yy, choppiness, outputs["jacobian"][block])

    def _wave_table(self, amplitudes: Amplitudes) -> Real:
        """
        Return sums and differences of forward and backward waves, (columns, 4 ny).

        `passes.heights` has their layout.
        """
        forward, backward = (a.T[: self.columns] for a in (amplitudes.forward, amplitudes.backward))
        waves = np.empty((self.columns, 4, self._grid.ny), dtype=self._dtype)
        per_unit = 1.0 / self._unit
        for i, (combine, a, b) in enumerate((
            (np.add, forward.real, backward.real),
            (np.subtract, forward.imag, backward.imag),
            (np.add, forward.imag, backward.imag),
            (np.subtract, forward.real, backward.real),
        )):  # fmt: skip
            np.multiply(combine(a, b), per_unit, out=waves[:, i], casting="same_kind")
        if self._dtype == np.float32:
            # Waves too small to be seen beside the largest, even in their curvature, would become
            # subnormal numbers, which are slow.
            waves[np.abs(waves) < 1e-30] = 0.0
        return waves.reshape(self.columns, -1)

    def _ky_factors_of(self, spectrum: HalfSpectrum) -> tuple[Real, Real, float, float]:
        """
        Return the factors of a half-spectrum in the first pass.

        The two powers of ky, the second with its weight, (ny,) each; and the signs that i^quarters
        gives to the real and the imaginary part.
        """
        number = self._dtype.type
        weight = spectrum.sign * self._weights.get(spectrum.pair, 1.0)
        power, other = self._grid.ky**spectrum.power, weight * self._grid.ky**spectrum.other_power
        signs = 1j**spectrum.quarters * (1 + 1j)
        return (
            power.astype(self._dtype),
            other.astype(self._dtype),
            number(round(signs.real)),
            number(round(signs.imag)),
        )

    def _kx_factors_of(self, pair: tuple[str, ...]) -> tuple[Real, Real, float]:
        """
        Return the factors of a packed row: at +k, at -k, and the one that undoes the weight.

        `passes.pack` has the layout of the first two.
        """
        kx, weight = self._grid.kx[: self.columns], self._weights.get(pair, 1.0)
        slope = weight * kx if len(pair) == 2 and _is_x_derivative(pair) else 0.0
        power = self._unit * kx ** FIELDS[pair[0]].dx
        plus = np.repeat(power * (1.0 - slope), 2)
        minus = np.repeat(power * (1.0 + slope), 2)[:1:-1]
        minus[1::2] *= -1.0
        # A field without waves is exactly 0, without the rounding errors of its partner.
        undo = 1.0 / weight if self._size[pair[-1]] > 0.0 else 0.0
        return plus.astype(self._dtype), minus.astype(self._dtype), self._dtype.type(undo)

    def _intermediate(self, spectra: int) -> Complex:
        """
        Return the array between the passes, (ny, spectra, columns).

        Each row starts on a cache line.
        """
        line = 64 // self._buffer.itemsize
        columns = -(-self.columns // line) * line
        size = self._grid.ny * spectra * columns
        if self._buffer.size < size:
            self._buffer = aligned((1, size), self._dtype.name)[0]
        return self._buffer[:size].reshape(self._grid.ny, spectra, columns)


class _Workspace:
    """The buffers and FFT plans of one thread, the same for any set of fields."""

    def __init__(
        self, widths: tuple[int, int], shape: tuple[int, int], computation: Computation
    ) -> None:
        (columns, rows), (ny, nx) = widths, shape
        dtype = computation.dtype
        self.cycles = np.empty((columns, ny))
        self.cosine, self.sine = np.empty((2, columns, ny), dtype=dtype)
        sources = [(of, dt) for of in ("height", "potential") for dt in (0, 1)]
        self.parts: dict[Source, tuple[Real, Real]] = {}
        for source in sources:
            real, imaginary = np.empty((2, columns, ny), dtype=dtype)
            self.parts[source] = (real, imaginary)
        self.first, self.second = (
            inverse_rows(buffer, dtype, backend=computation.backend, planning=computation.planning)
            for buffer in ((columns, ny), (rows, nx))
        )
        self.first_source = _parts(self.first.source)
        self.first_result = _transposable(self.first.result)
        self.second_source = _parts(self.second.source)
        self.second_result = _parts(self.second.result)
        self.scratch = {name: np.empty((rows, nx), dtype=dtype) for name in FIELDS}


def _frequencies(amplitudes: Amplitudes, columns: int) -> Real:
    """
    Return the frequency of each wave in cycles a second or, on a loop, a period; (columns, ny).

    On a loop they are whole numbers. Their rounding to float64 is the only error of a phase.
    """
    if amplitudes.cycles is not None:
        return np.ascontiguousarray(amplitudes.cycles.T[:columns], dtype=np.float64)
    frequency = np.empty((columns, amplitudes.grid.ny))
    # The Nyquist column is left over.
    for column, omega in zip(frequency, amplitudes.omega.T, strict=False):
        column[:] = dispersion.turns_per_second(omega)
    return frequency


def _swapped(parts: tuple[Real, Real], quarters: int) -> tuple[Real, Real]:
    """Return real and imaginary part after multiplication by i^quarters, but for their signs."""
    return parts if quarters % 2 == 0 else parts[::-1]


def _transposable(array: Complex) -> Real | Complex:
    """Return a view for `passes.transpose`: complex64 as float64, which moves 8 bytes at once."""
    return array.view(np.float64) if array.dtype == np.complex64 else array


def _parts(array: Complex) -> Real:
    """Return a view of the interleaved real and imaginary parts, the last axis twice as long."""
    return array.view(array.real.dtype)
