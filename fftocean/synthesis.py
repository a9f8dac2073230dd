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

Both passes run over blocks that stay in cache, each compiled whole: see `kernels.whole_passes`.
Threads take the blocks in turns. `fields.FIELDS` has the derivative of each field; `Plan` says
which transforms a set of fields takes.

Two numbers keep single precision in range. Waves are divided by the largest of them (a power of
two, which rounds nothing), and the second pass multiplies it back. And since two fields of a packed
row share the rounding errors of its transform, a power of two first makes them equally large.
"""

import contextlib
import math
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import CACHE_LINE, COMPLEX_OF, Complex, Integer, Real
from fftocean.bound_waves import BoundSpectrum, Shown
from fftocean.computation import Computation
from fftocean.fields import FIELDS, GEOMETRY, POINTWISE, Field, potential_factor
from fftocean.kernels import passes, whole_passes
from fftocean.kernels.vectors import TILE
from fftocean.phases import Moment
from fftocean.physics import dispersion
from fftocean.transforms import aligned, aligned_numbers, chosen_backend, inverse_rows, row_plan

Source = tuple[str, int]
""""height" or "potential", and the number of time derivatives, 0 or 1."""

SOURCES: tuple[Source, ...] = (("height", 0), ("height", 1), ("potential", 0), ("potential", 1))
"""The sources, in the order that `kernels.whole_passes` has them."""

NUMBERS = {name: number for number, name in enumerate(FIELDS)}
"""Places of the fields in their table."""

GRADIENTS = np.array([NUMBERS[name] for name in GEOMETRY], np.int64)
"""Places of the gradients among the fields."""

STREAMED_FROM = 2**22
"""
Bytes from which arrays are written past the caches: more than a core keeps for itself.

They would leave the cache before they are read again, and would be read into it to be written.
"""

WIDTH = 64
"""Columns or rows in a block where transforms are called from Python."""

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


def _linear(fields: tuple[str, ...]) -> set[str]:
    """Return the linear fields that some fields are, or are computed from."""
    return {
        name for field in fields for name in ((field,) if field in FIELDS else POINTWISE[field])
    }


@lru_cache(maxsize=256)
def plan_fields(fields: tuple[str, ...]) -> Plan:
    """Return the plan for a set of field names."""
    wanted = _linear(fields)
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


@dataclass(frozen=True, slots=True)
class _Tables:
    """A plan as compiled loops take it."""

    plan: Plan
    spectra: whole_passes.Spectra
    rows: whole_passes.Rows


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
        k = grid.k[_half(amplitudes), : self.columns].T
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
        self._tables: dict[tuple[str, ...], _Tables] = {}
        self._workspaces = [
            _Workspace(self.columns, grid.shape, computation)
            for _ in range(min(computation.threads, -(-max(self.columns, grid.ny) // TILE)))
        ]
        self.restart()
        self.backend = self._workspaces[0].backend

    def restart(self) -> None:
        """Start the threads; a forked child calls it again, since it has none of its parent's."""
        others = len(self._workspaces) - 1
        self._pool = ThreadPoolExecutor(others, thread_name_prefix="fftocean") if others else None

    def run(self, moment: Moment, outputs: Mapping[str, Real], choppiness: float) -> None:
        """
        Compute fields.

        Args:
            moment: the time.
            outputs: the arrays to write to by field name, (ny, nx) or, for normals, (ny, nx, 3).
            choppiness: factor on the horizontal displacement [-].
        """
        fields = tuple(outputs)
        if fields not in self._tables:
            if len(self._tables) >= 32:  # of a caller that tries all sets
                self._tables.clear()
            self._tables[fields] = self._tables_of(plan_fields(fields))
        tables = self._tables[fields]
        plan = tables.plan
        if not plan.linear:
            return
        rates = any(spectrum.source[1] for spectrum in plan.half_spectra)
        if self._omega is None and rates:
            self._omega = np.ascontiguousarray(
                self._amplitudes.running_omega[_half(self._amplitudes), : self.columns].T,
                dtype=self._dtype,
            )
        first = _First(
            single=True if self._dtype == np.float32 else None,
            moment=moment.numbers,
            waves=(self.frequency, self._waves, self._potential),
            omega=self._omega if rates else None,
            bound=self._sum_bound_waves(plan, moment),
            spectra=tables.spectra,
        )
        between = self._between(len(plan.half_spectra))
        empty = np.empty(0, self._dtype)
        second = _Second(
            spectra=len(plan.half_spectra),
            rows=tables.rows,
            outputs=outputs,
            choppiness=self._dtype.type(choppiness),
            normal=outputs.get("normal", empty).reshape(-1),
            jacobian=outputs.get("jacobian", empty).reshape(-1),
            streamed=_are_streamed(outputs),
        )
        if self._workspaces[0].compiled:
            blocks = np.zeros((3, 16), np.int64)  # counters on a cache line each

            def both_passes(workspace: _Workspace) -> None:
                try:
                    workspace.first_pass(blocks[0], blocks[1], first, between)
                except BaseException:
                    blocks[1, 0] = workspace.blocks  # else the other threads would wait for ever
                    raise
                _wait_for(blocks[1], workspace.blocks)
                workspace.second_pass(blocks[2], second, between)

            self._in_threads(both_passes)
            return
        self._run_blocks(
            self.columns,
            WIDTH,
            lambda workspace, block: workspace.do_columns(block, first, between),
        )
        self._run_blocks(
            self._grid.ny,
            WIDTH,
            lambda workspace, block: workspace.do_rows(block, second, between),
        )

    def _run_blocks(
        self, total: int, width: int, work: "Callable[[_Workspace, slice], None]"
    ) -> None:
        """
        Do the blocks of one pass, each thread with a workspace of its own.

        The blocks do not depend on the number of threads, nor do their bytes.
        """
        # Several threads can ask a list's iterator: each block goes to one of them.
        blocks = iter([slice(i, min(i + width, total)) for i in range(0, total, width)])

        def run(workspace: _Workspace) -> None:
            for block in blocks:
                work(workspace, block)

        self._in_threads(run)

    def _in_threads(self, run: "Callable[[_Workspace], None]") -> None:
        """Call a function in each thread, with a workspace of its own, and wait."""
        mine, *others = self._workspaces
        if not others:
            run(mine)
            return
        tasks: list[Future[None]] = []
        try:
            for workspace in others:
                assert self._pool is not None  # there is one for more workspaces than one
                # A thread that cannot start leaves its blocks to the others.
                with contextlib.suppress(RuntimeError):  # the interpreter is shutting down
                    tasks.append(self._pool.submit(run, workspace))
            run(mine)  # in this thread, whose caches are warm
            for task in tasks:
                task.result()
        finally:  # after an interrupt, too, no workspace may be reused while a thread still writes
            wait(tasks)

    def _sum_bound_waves(self, plan: Plan, moment: Moment) -> whole_passes.Bound | None:
        """Compute the second-order height spectra that a plan needs, if there are any."""
        bound = self._bound
        if bound is None:
            return None
        rates = [dt for of, dt in plan.sources if of == "height"]
        if not rates:
            return None
        bound.advance(moment, rates)
        self._run_blocks(bound.parts, 1, lambda _, part: bound.sum(part.start, rates))
        return bound.summed()

    def _wave_table(self, amplitudes: Amplitudes) -> Real:
        """
        Return sums and differences of forward and backward waves, (columns, 4 ny).

        `passes.heights` has their layout.
        """
        forward, backward = (a.T[: self.columns] for a in (amplitudes.forward, amplitudes.backward))
        waves = aligned_numbers((self.columns, 4, self._grid.ny), self._dtype)
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

    def _tables_of(self, plan: Plan) -> _Tables:
        """Return the tables of a plan."""
        number = {source: i for i, source in enumerate(SOURCES)}
        used = np.zeros(len(SOURCES), np.int64)
        for of, dt in plan.sources:
            used[number[of, dt]] = 1
            used[number["height", dt]] = 1
        sources = np.empty((len(plan.half_spectra), 3), np.int64)
        powers = aligned_numbers((len(plan.half_spectra), 2, self._grid.ny), self._dtype)
        signs = np.empty((len(plan.half_spectra), 2), self._dtype)
        for s, spectrum in enumerate(plan.half_spectra):
            other = -1 if spectrum.other is None else number[spectrum.other]
            sources[s] = number[spectrum.source], other, spectrum.quarters % 2
            weight = spectrum.sign * self._weights.get(spectrum.pair, 1.0)
            powers[s, 0] = self._grid.ky**spectrum.power
            powers[s, 1] = weight * self._grid.ky**spectrum.other_power
            turned = 1j**spectrum.quarters * (1 + 1j)
            signs[s] = round(turned.real), round(turned.imag)
        needed = _linear(plan.fields)
        table = np.zeros((len(plan.rows), 5), np.int64)
        factors = [self._kx_factors_of(row.pair) for row in plan.rows]
        for p, row in enumerate(plan.rows):
            one, two = row.pair[0], row.pair[-1]
            only = 1 if two not in needed or one == two else 2 if one not in needed else 0
            table[p] = row.plus, row.minus, NUMBERS[one], NUMBERS[two], only
        plus, minus = (
            aligned_numbers((len(factors), 2 * self.columns), self._dtype) for _ in range(2)
        )
        undo = np.empty(len(factors), self._dtype)
        for p, parts in enumerate(factors):
            plus[p], minus[p], undo[p] = parts
        return _Tables(
            plan,
            (used, sources, powers, signs),
            (table, plus, minus, undo),
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
        minus = np.repeat(power * (1.0 + slope), 2)[::-1]
        minus[1::2] *= -1.0
        # A field without waves is exactly 0, without the rounding errors of its partner.
        undo = 1.0 / weight if self._size[pair[-1]] > 0.0 else 0.0
        return plus.astype(self._dtype), minus.astype(self._dtype), self._dtype.type(undo)

    def _between(self, spectra: int) -> Real:
        """Return the array between the passes, tiles as `passes.tile` has them."""
        size = -(-self._grid.ny // TILE) * -(-self.columns // TILE) * spectra * TILE**2
        if self._buffer.size < size:
            self._buffer = aligned((1, size), self._dtype.name)[0]
        return self._buffer[:size].view(self._dtype)


class _First(NamedTuple):
    """Arguments of the first pass."""

    single: bool | None
    moment: whole_passes.Moment
    waves: whole_passes.Waves
    omega: Real | None
    bound: whole_passes.Bound | None
    spectra: whole_passes.Spectra


class _Second(NamedTuple):
    """Arguments of the second pass."""

    spectra: int
    rows: whole_passes.Rows
    outputs: Mapping[str, Real]
    choppiness: float
    normal: Real
    jacobian: Real
    streamed: bool


class _Workspace:
    """
    The buffers and FFT plans of one thread, the same for any set of fields.

    Args:
        columns: of a half-spectrum.
        shape: (ny, nx).
        computation: precision, FFT library and planning effort.
    """

    def __init__(self, columns: int, shape: tuple[int, int], computation: Computation) -> None:
        ny, nx = self._ny, self._nx = shape
        dtype, planning = computation.dtype, computation.planning
        self.backend = chosen_backend(dtype, computation.backend, planning)
        self._plans = [row_plan(n, dtype, self.backend, planning) for n in (ny, nx)]
        self.compiled = all(self._plans)
        width = self._width = TILE if self.compiled else WIDTH
        self.blocks = self._tiles = -(-columns // TILE)  # blocks of the first pass
        most = sum(len(_half_spectra(pair)) for pair in row_pairs())
        stride = -(-ny // TILE) * TILE  # each row starts on a cache line
        rows = 1 if self.compiled else width
        cycles = aligned_numbers((1, ny // 2 + 1), np.float64)
        cosine, sine, factor = (aligned_numbers((1, ny), dtype) for _ in range(3))
        parts = aligned_numbers((len(SOURCES), 2, 1, ny), dtype)
        source = aligned((1 if self.compiled else most * width, stride), dtype)
        self._results = aligned((most * width, stride), dtype)
        self._columns = (
            *(cycles, cosine, sine, factor, parts),
            *(_parts(source), _parts(self._results)),
        )
        self._scratch = aligned_numbers((len(FIELDS), rows * nx), dtype)
        self._scratch_places = np.array([(row.ctypes.data, 0) for row in self._scratch], np.int64)
        self._unit = aligned_numbers((3 * nx,), dtype)
        self._sources = source
        self._source, self._result = (
            aligned((1, rows * nx + 1), dtype)[0],  # with a place for -0 after the last row
            aligned((1, nx), dtype)[0],
        )
        self._calls: list[whole_passes.Call] = [
            (plan.function, plan.plan, a.ctypes.data, b.ctypes.data) if plan else (0, 0, 0, 0)
            for plan, a, b in zip(
                self._plans, (source, self._source), (self._results, self._result), strict=True
            )
        ]
        if not self.compiled:
            self._first, self._second = (
                inverse_rows((width, n), dtype, backend=self.backend, planning=planning)
                for n in (ny, nx)
            )

    def _places(self, outputs: Mapping[str, Real]) -> Integer:
        """Return the places of the linear fields, as `kernels.whole_passes` has them."""
        places = self._scratch_places.copy()
        for name, array in outputs.items():
            if name in NUMBERS:
                place = NUMBERS[name]
                places[place, 0], places[place, 1] = array.__array_interface__["data"][0], 1
        return places

    def first_pass(
        self,
        counter: Integer,
        done: Integer,
        first: _First,
        between: Real,
        end: int | None = None,
    ) -> None:
        """Do blocks of the first pass until none is left, or up to block `end`."""
        whole_passes.first_pass(
            counter,
            done,
            self._tiles if end is None else end,
            self._width,
            first.single,
            first.moment,
            first.waves,
            first.omega,
            first.bound,
            first.spectra,
            self._columns,
            self._calls[0],
            between,
            between.nbytes >= STREAMED_FROM,
        )

    def second_pass(self, counter: Integer, second: _Second, between: Real) -> None:
        """Do blocks of the second pass until none is left."""
        whole_passes.second_pass(
            counter,
            second.spectra,
            second.rows,
            between,
            _parts(self._source),
            _parts(self._result),
            self._calls[1],
            GRADIENTS,
            self._places(second.outputs),
            second.choppiness,
            second.normal,
            second.jacobian,
            self._unit,
            second.streamed,
            self._ny,
            self._nx,
        )

    def do_columns(self, block: slice, first: _First, between: Real) -> None:
        """Do a block of the first pass, with transforms called from Python."""
        count, width = block.stop - block.start, self._width
        number = block.start // width
        self.first_pass(np.array([number]), np.zeros(1, np.int64), first, between, number + 1)
        spectra = first.spectra[1].shape[0]
        for s in range(spectra):
            rows = slice(s * width, s * width + count)
            self._first.source[:count] = self._sources[rows, : self._ny]
            self._first()
            self._results[rows, : self._ny] = self._first.result[:count]
        results = _parts(self._results[: spectra * width]).reshape(-1)
        for c in range(0, count, TILE):
            place = (block.start + c) // TILE
            passes.tile(results, c, width, spectra, self._ny, place, self._tiles, between, False)

    def do_rows(self, block: slice, second: _Second, between: Real) -> None:
        """Do a block of the second pass, with transforms called from Python."""
        y, count, nx = block.start, block.stop - block.start, self._nx
        places = self._places(second.outputs)
        source, result = _parts(self._source), _parts(self._second.result).reshape(-1)
        packed = self._source[: self._second.source.size].reshape(self._second.source.shape)
        for p in range(second.rows[0].shape[0]):
            whole_passes.pack_rows(y, count, p, second.spectra, second.rows, between, source, nx)
            self._second.source[:] = packed
            self._second()
            whole_passes.split_rows(y, count, p, second.rows, result, places, second.streamed, nx)
        if second.normal.size or second.jacobian.size:
            whole_passes.finish_rows(
                y,
                count,
                GRADIENTS,
                places,
                second.choppiness,
                second.normal,
                second.jacobian,
                self._unit,
                second.streamed,
                nx,
            )


def _wait_for(done: Integer, count: int) -> None:
    """Wait until all blocks of the first pass are done."""
    pause = 0.0
    while not whole_passes.are_done(done, count):
        time.sleep(pause)  # leaves the processor to the thread that is waited for
        pause = min(pause + 1e-5, 1e-3)


def _half(amplitudes: Amplitudes) -> slice:
    """Return the places of ky >= 0; what depends on |k| alone is the same at -ky."""
    return slice(amplitudes.grid.ny // 2 + 1)


def _frequencies(amplitudes: Amplitudes, columns: int) -> Real:
    """
    Return the frequencies of waves with ky >= 0, which those at -ky share; (columns, ny // 2 + 1).

    They are in cycles a second or, on a loop, whole numbers of cycles in its period. Their rounding
    to float64 is the only error of a phase.
    """
    half = _half(amplitudes)
    if amplitudes.cycles is not None:
        return np.ascontiguousarray(amplitudes.cycles[half, :columns].T, dtype=np.float64)
    omega = amplitudes.omega[half, :columns].T
    frequency = np.empty(omega.shape)
    for column, its_omega in zip(frequency, omega, strict=True):
        column[:] = dispersion.turns_per_second(its_omega)
    return frequency


def _are_streamed(outputs: Mapping[str, Real]) -> bool:
    """Return whether outputs are so large, and so placed, that they are written past the caches."""
    large = sum(array.nbytes for array in outputs.values()) >= STREAMED_FROM
    return large and all(
        array.ctypes.data % CACHE_LINE == 0 and array.strides[0] % CACHE_LINE == 0
        for array in outputs.values()
    )


def _parts(array: Complex) -> Real:
    """Return a view of the interleaved real and imaginary parts, the last axis twice as long."""
    return array.view(array.real.dtype)
