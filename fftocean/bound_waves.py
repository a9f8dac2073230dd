"""
Second-order waves that are bound to the waves of a tile, as sums over pairs on its own cells.

The wavenumbers of a tile are whole multiples of (dkx, dky), so the product of two of its waves,
z_i z_j or z_i conj(z_j), falls on a cell of the same tile: m_i + m_j, or m_i - m_j. The factor of
each pair is computed once, from the true dispersion relation (kernels of rounded frequencies would
be resonant). At any time the phasors of the waves, with the frequencies of the loop, are then all
that is needed, and a loop stays a loop: cycles add as wavenumbers do.
"""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Complex, Integer, Real, brief_repr
from fftocean.errors import ParameterError, SeaWarning
from fftocean.host import require_memory
from fftocean.kernels import bound as kernels
from fftocean.kernels import passes
from fftocean.physics import dispersion
from fftocean.physics.second_order import Components, Interaction, interaction

WARNED, REFUSED = 0.3, 1.0
"""Ratio of the rms of second-order to that of linear elevation: warned of above, refused above."""
SHORTEST = 0.1
"""Wavelength below which waves with surface tension have no bound waves [m]."""

SURFACE, ELEVATION, POTENTIAL = "surface", "elevation", "potential"
"""
Sums over pairs: of the height over parameters x0 that the choppy surface lacks, C - c Cc [1/m]; of
the elevation over places, C [1/m]; of the potential at the mean level over i, b [1/s].
"""


@dataclass(frozen=True, slots=True, eq=False)
class Parents:
    """The waves that have bound waves, sorted by (mx, my): height = 2 Re sum h0 e^{i(k.x - wt)}."""

    mx: Integer  # (m,)
    my: Integer
    h0: Complex  # [m]
    omega: Real  # of the dispersion relation, without surface tension [rad/s]
    running: Real  # as the waves run: a whole number of cycles in a loop [rad/s]
    frequency: Real  # of `running`, in cycles a second or, on a loop, a loop
    variance: Real  # E, the expected a^2/2 [m^2]
    gaussian: bool  # True if the amplitudes are drawn: then E of a^4/4 is 2 E^2

    __repr__ = brief_repr


@dataclass(frozen=True, slots=True, eq=False)
class _Table:
    """Factors of all pairs of waves, and where the pairs are: see `kernels.bound.add_pairs`."""

    sums: Real  # of z_i z_j
    differences: Real  # of z_i conj(z_j)


@dataclass(frozen=True, slots=True)
class Report:
    """Bound waves in numbers, averaged over the phases of the waves."""

    waves: int  # that have bound waves
    ratio: float  # rms of the second-order over that of the linear elevation [-]
    dropped: float  # share of the second-order variance in sums beyond the grid [-]
    skewness: float  # of the elevation, with Gaussian waves of the parents' variances [-]
    realised: float  # the same for the amplitudes that the parents have [-]

    def __str__(self) -> str:
        return (
            f"pairs of the {self.waves} strongest waves: {100 * self.ratio:.1f} % of the rms of "
            f"the linear waves, {100 * self.dropped:.2g} % of their variance beyond the grid and "
            "left out"
        )


class _Totals:
    """Sums over all pairs that a `Report` is made of."""

    def __init__(self, amplitudes: Amplitudes, parents: Parents) -> None:
        self._parents, self._reach = parents, amplitudes.grid.reach
        squares = amplitudes.squares
        self._m0 = amplitudes.variance
        self._linear = float(np.sum(squares) + np.sum(squares[:, 1:]))  # sum of a^2/2
        self._energy = 2.0 * np.abs(parents.h0) ** 2  # a^2/2 of each parent
        self._elevation = self._shown = self._beyond = 0.0  # variances [m^2]
        self._expected = self._realised = 0.0  # a third of <eta^3> [m^3]

    def add(self, own: slice, sign: int, elevation: Real, shown: Real) -> None:
        """
        Add the pairs of a run with the waves before it and its own.

        Args:
            own: numbers of the waves of the run.
            sign: of the second wave of each pair.
            elevation: C of each pair, (run, waves up to its end), doubled for other runs.
            shown: the same of what the ocean shows, C - c Cc.
        """
        p, energy, before = self._parents, self._energy, slice(0, own.stop)
        row = np.arange(own.stop - own.start)
        alone = row, own.start + row  # a wave with itself
        # A pair of another run has a^2/2 = 2 (2 C |h0_i| |h0_j|)^2, given 2 C; one of this run has
        # the same, given C twice; a wave with itself 2 (C |h0_i|^2)^2.
        weight = np.ones(elevation.shape)
        weight[:, own.start :] = 2.0
        weight[alone] = 1.0
        weight *= 0.5 * energy[own, None] * energy[before]
        outside = (np.abs(p.mx[own, None] + sign * p.mx[before]) > self._reach[0]) | (
            np.abs(p.my[own, None] + sign * p.my[before]) > self._reach[1]
        )
        variances = weight * shown**2
        self._elevation += float(np.sum(weight * elevation**2))
        self._shown += float(np.sum(variances))
        self._beyond += float(np.sum(variances[outside]))
        for name, e, gaussian in (
            ("_realised", energy, False),
            ("_expected", p.variance, p.gaussian),
        ):
            total = float(np.einsum("i,ij,j->", e[own], elevation, e[before]))
            if not gaussian:  # a^4/4 = E^2, of which the Gaussian mean is 2 E^2
                total -= 0.5 * float(np.sum(elevation[alone] * e[own] ** 2))
            setattr(self, name, getattr(self, name) + total)

    def report(self) -> Report:
        """Return the report of all pairs that were added."""
        linear, m0 = self._linear, self._m0
        return Report(
            waves=int(self._parents.mx.size),
            ratio=math.sqrt(self._elevation / linear) if linear > 0.0 else 0.0,
            dropped=self._beyond / self._shown if self._shown > 0.0 else 0.0,
            skewness=3.0 * self._expected / float(m0**1.5) if m0 > 0.0 else 0.0,
            realised=3.0 * self._realised / float(linear**1.5) if linear > 0.0 else 0.0,
        )


class BoundWaves:
    """
    The second-order waves of the strongest waves of a tile.

    Args:
        amplitudes: the waves of the tile.
        choppiness: of its surface [-]: of the second-order height, a displaced surface has a part
            already.
        most: number of waves whose pairs are summed, those with the largest E k.
        dtype: of the tables: "float32" or "float64".

    Raises:
        ParameterError: too little memory; waves so steep, or water so shallow, that the
            second-order elevation is as large as the linear one.
    """

    def __init__(self, amplitudes: Amplitudes, choppiness: float, most: int, dtype: str) -> None:
        self.amplitudes, self.choppiness, self.most, self.dtype = (
            amplitudes,
            choppiness,
            most,
            dtype,
        )
        self._set_up()

    def _set_up(self) -> None:
        self.parents = _parents(self.amplitudes, self.most)
        self._runs = _runs(self.parents)
        count = self.parents.mx.size
        require_memory(
            f"second order of {count} waves",
            4.0 * (count + 64.0) ** 2 * np.dtype(self.dtype).itemsize / 2.0,
        )
        self._layouts = _layouts(self.parents, self._runs)
        self._tables: dict[str, _Table] = {}
        totals = _Totals(self.amplitudes, self.parents)
        self._tables[SURFACE] = self._tabulate(SURFACE, totals)
        self.report = totals.report()

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle the arguments; tables are computed anew."""
        return BoundWaves, (self.amplitudes, self.choppiness, self.most, self.dtype)

    def __len__(self) -> int:
        """Number of waves that have bound waves."""
        return int(self.parents.mx.size)

    @property
    def nbytes(self) -> int:
        """Memory of the tables that have been computed [B]."""
        tables = self._tables.values()
        return sum(t.sums.nbytes + t.differences.nbytes for t in tables)

    @property
    def reach(self) -> tuple[int, int]:
        """Largest |mx| and |my| of a bound wave."""
        p = self.parents
        return 2 * int(np.max(np.abs(p.mx), initial=0)), 2 * int(np.max(np.abs(p.my), initial=0))

    def table(self, kind: str) -> _Table:
        """Return the factors of `SURFACE`, `ELEVATION` or `POTENTIAL`, computed at first use."""
        if kind == ELEVATION and self.choppiness == 0.0:
            kind = SURFACE  # the same
        if kind not in self._tables:
            self._tables[kind] = self._tabulate(kind)
        return self._tables[kind]

    def _tabulate(self, kind: str, totals: "_Totals | None" = None) -> _Table:
        """Return the factors of all pairs, and add to the totals what the pairs come to."""
        p, (starts, counts) = self.parents, self._runs
        grid, depth, c = self.amplitudes.grid, self.amplitudes.depth, self.choppiness
        waves = Components(p.mx * grid.dkx, p.my * grid.dky, p.omega)
        chosen: Callable[[Interaction], Real] = {
            SURFACE: lambda pair: pair.elevation - c * pair.displaced,
            ELEVATION: lambda pair: pair.elevation,
            POTENTIAL: lambda pair: pair.potential,
        }[kind]
        tables = [np.empty(layout.entries, self.dtype) for layout in self._layouts]
        for run, (start, count) in enumerate(zip(starts, counts, strict=True)):
            # This run with all waves before it and its own, of which each pair occurs twice.
            own, before = slice(start, start + count), slice(0, start + count)
            ours, theirs = waves.part(own).part((slice(None), None)), waves.part(before)
            twice = np.where(np.arange(start + count) < start, 2.0, 1.0)
            for sign, layout, table in zip((1, -1), self._layouts, tables, strict=True):
                pair = interaction(ours, theirs if sign > 0 else theirs.conjugate, depth)
                layout.store(table, run, chosen(pair) * twice, starts, counts)
                if totals is not None:
                    totals.add(own, sign, pair.elevation * twice, chosen(pair) * twice)
        return _Table(*tables)

    def cells(
        self, kind: str, t: float, rates: Sequence[int] = (0,), *, beyond: bool = False
    ) -> "Cells":
        """
        Return the second-order spectrum at time t: field = Re sum of values e^{i k.x}.

        Args:
            kind: `SURFACE`, `ELEVATION` or `POTENTIAL`, of which the values are i times as much.
            t: time [s].
            rates: the time derivatives to return.
            beyond: keep the sums that are beyond the grid of the tile.
        """
        grid, loop = self.amplitudes.grid, self.amplitudes.loop
        sums = _Sums(self, 1.0, np.dtype(np.float64), 1, kind)
        moment = t if loop is None else math.fmod(t, loop) / loop
        sums.advance(lambda frequency, out: passes.phases_at(frequency, moment, out), max(rates))
        sums.sum(0, rates)
        reach_x, reach_y = self.reach
        mx, my = np.meshgrid(
            np.arange(-reach_x, reach_x + 1), np.arange(-reach_y, reach_y + 1), indexing="ij"
        )
        half = (mx > 0) | ((mx == 0) & (my > 0))
        if not beyond:
            half &= (np.abs(mx) <= grid.reach[0]) & (np.abs(my) <= grid.reach[1])
        values = []
        for rate in rates:
            real, imag = sums.results[rate]
            g = (1j if kind == POTENTIAL else 1.0) * (real + 1j * imag)
            values.append(2.0 * sums.scale * (g + np.conj(g[::-1, ::-1]))[half])
        return Cells(mx[half] * grid.dkx, my[half] * grid.dky, np.array(values))


class Cells(NamedTuple):
    """A spectrum on one half of the plane of wavenumbers: field = Re sum of values e^{i k.x}."""

    kx: Real  # (cells,) [rad/m]
    ky: Real
    values: Complex  # (time derivatives, cells)

    def kept(self, some: npt.NDArray[np.bool_]) -> "Cells":
        """Return the cells of a mask."""
        return Cells(self.kx[some], self.ky[some], self.values[:, some])

    def parts(self) -> Real:
        """Return real and imaginary parts, (time derivatives, 2, cells)."""
        return np.ascontiguousarray(np.stack([self.values.real, self.values.imag], axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """Bound waves as an ocean shows them."""

    waves: BoundWaves
    gain: Real | None = None  # factor on each cell, (ny, nx // 2 + 1) of the ocean's own grid
    rate: int = 0  # time derivatives

    __repr__ = brief_repr


PhaseFunction = Callable[[Real, Real], None]
"""Writes the phases of waves in cycles, given their frequencies; two arrays of one shape."""


class _Sums:
    """The sums over pairs at one time: phasors of the parents, and cells."""

    def __init__(
        self,
        waves: BoundWaves,
        unit: float,
        dtype: "np.dtype[Any]",
        threads: int,
        kind: str = SURFACE,
    ) -> None:
        p = self._parents = waves.parents
        # A power of two, like the unit of the tile: it rounds nothing.
        largest = float(np.max(np.abs(p.h0), initial=0.0))
        own = 2.0 ** round(math.log2(largest)) if largest > 0.0 else 1.0
        self.scale = own * own / unit
        self._dtype, self._table = dtype, waves.table(kind)
        self._layouts = waves._layouts
        self._h0 = (
            np.ascontiguousarray(p.h0.real / own, dtype),
            np.ascontiguousarray(p.h0.imag / own, dtype),
        )
        self._frequency = np.ascontiguousarray(p.frequency)[None]
        self._running = p.running.astype(dtype)
        self._cycles = np.empty(self._frequency.shape)
        self._cosine, self._sine = np.empty((2, *self._frequency.shape), dtype)
        self._phasors: list[tuple[Real, Real]] = []
        self.columns, self.rows = (2 * reach + 1 for reach in waves.reach)
        self.results: dict[int, Real] = {}
        self._edges = _shared_columns(self._layouts, self.columns, threads)

    @property
    def parts(self) -> int:
        """Number of parts of `sum` that can be computed at the same time."""
        return len(self._edges) - 1

    def advance(self, phase: PhaseFunction, most: int) -> None:
        """Compute the phasors at one time, and their time derivatives up to `most`."""
        phase(self._frequency, self._cycles)
        single = self._dtype == np.float32
        (passes.phasors_single if single else passes.phasors)(
            self._cycles, self._cosine, self._sine
        )
        real, imag = np.empty((2, self._h0[0].size), self._dtype)
        kernels.turn(self._cosine[0], self._sine[0], *self._h0, real, imag)
        self._phasors = [(real, imag)]
        for _ in range(most):
            real, imag = self._running * imag, -self._running * real  # times -i omega
            self._phasors.append((real, imag))

    def sum(self, part: int, rates: Sequence[int]) -> None:
        """Sum over the pairs of one part, each time derivative into an array of its own."""
        first, last = self._edges[part], self._edges[part + 1]
        for rate in rates:
            real, imag = self.results.setdefault(rate, self._new())
            real[first:last] = 0.0
            imag[first:last] = 0.0
            # d^n (u v) = sum of binomial coefficients times d^j u d^(n - j) v
            for j in range(rate + 1):
                factor = self._dtype.type(math.comb(rate, j))
                u_r, u_i = (factor * u for u in self._phasors[j])
                v_r, v_i = self._phasors[rate - j]
                plus, minus = self._layouts
                kernels.add_pairs(
                    plus.blocks,
                    *plus.between(first, last),
                    self._table.sums,
                    self._parents.my,
                    *(u_r, u_i, v_r, v_i, real, imag),
                )
                kernels.add_pairs(
                    minus.blocks,
                    *minus.between(first, last),
                    self._table.differences,
                    -self._parents.my,
                    *(u_r, -u_i, v_r, v_i, real, imag),
                )

    def _new(self) -> Real:
        return np.empty((2, self.columns, self.rows), self._dtype)


class BoundSpectrum:
    """
    Bound waves as part of the height spectrum of a tile, and the arrays to compute it in.

    Args:
        shown: the bound waves.
        unit: of the spectrum [m].
        columns: of the spectrum.
        threads: that share the work.
    """

    def __init__(self, shown: Shown, unit: float, columns: int, threads: int) -> None:
        dtype = np.dtype(shown.waves.dtype)
        self._sums = _Sums(shown.waves, unit, dtype, threads)
        self._rate = shown.rate
        self._scale = dtype.type(self._sums.scale)
        self._own = shown.gain is not None
        gain = np.ones((1, 1)) if shown.gain is None else shown.gain.T[:columns]
        self._gain = np.ascontiguousarray(gain, dtype=dtype)
        self.parts = self._sums.parts

    def advance(self, phase: PhaseFunction, rates: Sequence[int]) -> None:
        """Compute the phasors at one time, for the time derivatives `rates` of the spectrum."""
        for rate in rates:
            self._sums.results.setdefault(self._rate + rate, self._sums._new())
        self._sums.advance(phase, self._rate + max(rates))

    def sum(self, part: int, rates: Sequence[int]) -> None:
        """Sum over the pairs of one part."""
        self._sums.sum(part, [self._rate + rate for rate in rates])

    def add(self, rate: int, first: int, real: Real, imag: Real) -> None:
        """Add the spectrum, in the unit, to the columns first, first + 1, ... of the tile's."""
        g_real, g_imag = self._sums.results[self._rate + rate]
        gain, own, scale = self._gain, self._own, self._scale
        kernels.add_folded(g_real, g_imag, first, gain, own, scale, real, imag)

    def summed(self) -> tuple[bool, float, Real, Real, Real, Real, Real]:
        """
        Return the sums of height and rate, to be added to a spectrum in the unit.

        They are as `kernels.whole_passes.Bound` has them; those that were not asked for are empty.
        """
        empty = np.empty((0, 0), self._gain.dtype)
        height, rate = (self._sums.results.get(self._rate + r, (empty, empty)) for r in (0, 1))
        return (self._own, self._scale, *height, *rate, self._gain)


class _Layout:
    """
    Blocks of the pairs of two runs, in the order of their columns: see `kernels.bound.add_pairs`.

    Args:
        blocks: (blocks, 7), the last column still empty.
        pairs: the two runs of each block, (blocks, 2).
    """

    def __init__(self, blocks: Integer, pairs: Integer, runs: int, transposed: bool) -> None:
        order = np.argsort(blocks[:, 4], kind="stable")
        self.blocks, self._transposed = np.ascontiguousarray(blocks[order]), transposed
        sizes = self.blocks[:, 1] * self.blocks[:, 3]
        self.blocks[:, 6] = np.cumsum(sizes) - sizes
        self.entries = int(np.sum(sizes))
        self._place = np.full((runs, runs), -1, np.int64)
        self._place[tuple(pairs[order].T)] = self.blocks[:, 6]

    def between(self, first: int, last: int) -> tuple[int, int]:
        """Return the blocks of the columns `first` to `last` - 1: the first, and the one after."""
        low, high = np.searchsorted(self.blocks[:, 4], (first, last))
        return int(low), int(high)

    def store(self, table: Real, run: int, values: Real, starts: Integer, counts: Integer) -> None:
        """Write the factors of the pairs of a run with it and all before it, (own, others)."""
        for other in range(run + 1):
            block = values[:, starts[other] : starts[other] + counts[other]]
            place = self._place[run, other]
            table[place : place + block.size] = (block.T if self._transposed else block).ravel()


def _parents(amplitudes: Amplitudes, most: int) -> Parents:
    """Return the `most` waves with the largest E k, what they add to skewness, sorted."""
    a, grid = amplitudes, amplitudes.grid
    mx, my = np.broadcast_arrays(grid.mx[None, :], grid.my[:, None])
    here, there = a.forward != 0.0, a.backward != 0.0
    there[:, 0] = False  # the conjugates of the same column's forward waves
    mx = np.concatenate([mx[here], -mx[there]]).astype(np.int64)
    my = np.concatenate([my[here], -my[there]]).astype(np.int64)
    h0 = np.concatenate([a.forward[here], np.conj(a.backward[there])])
    variance = np.concatenate([a.variance_forward[here], a.variance_backward[there]])
    running = np.concatenate([a.running_omega[here], a.running_omega[there]])
    k = np.hypot(mx * grid.dkx, my * grid.dky)
    # `Amplitudes` that a user changed can have waves where no variance was expected
    weight = np.where(variance > 0.0, variance, 2.0 * np.abs(h0) ** 2) * k
    if a.surface_tension > 0.0:
        weight[k * SHORTEST > 2.0 * np.pi] = 0.0
    strongest = np.argsort(-weight, kind="stable")[:most]
    strongest = strongest[weight[strongest] > 0.0]
    strongest = strongest[np.lexsort((my[strongest], mx[strongest]))]
    omega = dispersion.angular_frequency(k[strongest], a.depth)
    if a.cycles is None:
        frequency = dispersion.turns_per_second(running[strongest])
    else:
        cycles = np.concatenate([a.cycles[here], a.cycles[there]])
        frequency = cycles[strongest].astype(np.float64)
    return Parents(
        mx=mx[strongest],
        my=my[strongest],
        h0=h0[strongest],
        omega=omega,
        running=running[strongest],
        frequency=frequency,
        variance=variance[strongest],
        gaussian=a.draw in ("gaussian", "constrained"),
    )


def _runs(parents: Parents) -> tuple[Integer, Integer]:
    """Return the first wave of each run, and the number of its waves."""
    mx, my = parents.mx, parents.my
    ends = np.flatnonzero((np.diff(mx) != 0) | (np.diff(my) != 1)) + 1
    starts = np.concatenate([np.zeros(min(mx.size, 1), np.int64), ends]).astype(np.int64)
    return starts, np.diff(np.append(starts, mx.size))


def _layouts(parents: Parents, runs: tuple[Integer, Integer]) -> tuple[_Layout, _Layout]:
    """Return the blocks for sums and for differences of wavenumbers."""
    starts, counts = runs
    one, other = np.tril_indices(starts.size)  # runs; one >= other
    mx, my = parents.mx, parents.my
    middle_x, middle_y = 2 * np.max(np.abs(mx), initial=0), 2 * np.max(np.abs(my), initial=0)
    pairs = np.stack([one, other], axis=1)
    a, b = starts[one], starts[other]
    empty = np.zeros_like(a)
    # z_i z_j: outer waves i of one run, inner waves j of the other
    sums = (a, counts[one], b, counts[other], mx[a] + mx[b] + middle_x, my[b] + middle_y, empty)
    # z_i conj(z_j): the other way about, so that inner waves are not conjugate
    differences = (
        *(b, counts[other], a, counts[one]),
        *(mx[a] - mx[b] + middle_x, my[a] + middle_y, empty),
    )
    return (
        _Layout(np.stack(sums, axis=1), pairs, starts.size, False),
        _Layout(np.stack(differences, axis=1), pairs, starts.size, True),
    )


def _shared_columns(layouts: tuple[_Layout, _Layout], columns: int, threads: int) -> list[int]:
    """Return the edges of parts of the columns that take about as long each."""
    work = np.zeros(columns)
    for layout in layouts:
        np.add.at(work, layout.blocks[:, 4], layout.blocks[:, 1] * (layout.blocks[:, 3] + 8.0))
    total = np.cumsum(work)
    if threads == 1 or not total[-1] > 0.0:
        return [0, columns]
    edges = np.searchsorted(total, total[-1] * np.arange(1, threads) / threads) + 1
    return sorted({0, columns, *(int(edge) for edge in edges if edge < columns)})


def bound_waves(amplitudes: Amplitudes, choppiness: float, most: int, dtype: str) -> BoundWaves:
    """
    Return the bound waves of a tile; arguments as in `BoundWaves`.

    Raises:
        ParameterError: the second-order elevation is as large as the linear one: the expansion does
            not converge there.
    """
    made = BoundWaves(amplitudes, choppiness, most, dtype)
    ratio = made.report.ratio
    if ratio > REFUSED:
        raise ParameterError(
            f"waves of second order must be smaller than the linear ones, got {ratio:.3g} times "
            f"their rms: too steep, or too high for a depth of {amplitudes.depth:g} m"
        )
    if ratio > WARNED:
        warnings.warn(
            f"the waves of second order have {ratio:.2g} times the rms of the linear ones: too "
            f"steep, or too high for a depth of {amplitudes.depth:g} m, for a second-order theory "
            f"to be good (it is up to about {WARNED:g})",
            SeaWarning,
            stacklevel=4,
        )
    return made
