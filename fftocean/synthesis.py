"""
From h0 to fields, block by block: the plan of a frame, drawn from the table in `fields.py`.

A two-dimensional inverse transform is a pass along y, then one along x. Fields that differ only by a derivative along x share the
first: the eight linear fields need five transforms along y. After it, each row is the Hermitian half of a real one, so two fields go
through the second as one complex row: four transforms for eight fields. Both passes run over blocks that stay in cache.
"""

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import COMPLEX_OF, Complex, Real
from fftocean.fields import FIELDS, potential_factor
from fftocean.grid import Grid
from fftocean.kernels import passes, surface
from fftocean.transforms import inverse_rows

GEOMETRY = ("slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy")
POINTWISE = {"normal": GEOMETRY, "jacobian": GEOMETRY[2:]}
"""The fields that are not linear, and the linear ones that they are made of."""

Turn = Callable[[slice, Real], None]
"""Writes how far the waves of some columns of wavenumbers have turned, (columns, ny)."""

PAIRS = (
    ("height", "slope_x"),
    ("displace_x", "stretch_xx"),
    ("displace_y", "stretch_xy"),
    ("slope_y", "stretch_yy"),
    ("velocity_x", "velocity_y"),
    ("velocity_z",),
)
"""Who shares a complex row with whom: always the same, asked for or not, so that a field has the same bits whatever is asked."""

BLOCK = 16  # columns or rows at a time: 5 x 16 x n complex numbers are 160 kB at n = 256 and 1.3 MB at 2048


@dataclass(frozen=True, slots=True)
class Plan:
    """What to compute for a set of fields: the spectra of the first pass, and the pairs of the second."""

    asked: tuple[str, ...]
    linear: tuple[str, ...]  # the linear fields computed, asked for or not
    columns: tuple[tuple[str, int, int], ...]  # (of, dt, dy) of each spectrum that goes through the first pass
    pairs: tuple[tuple[str, ...], ...]  # the one or two fields in each complex row of the second


@lru_cache(maxsize=256)
def plan_of(fields: tuple[str, ...]) -> Plan:
    """Plan a set of field names."""
    wanted = {name for field in fields for name in ((field,) if field in FIELDS else POINTWISE[field])}
    pairs = tuple(pair for pair in PAIRS if wanted & set(pair))
    linear = tuple(name for pair in pairs for name in pair)
    columns = tuple(sorted({(FIELDS[name].of, FIELDS[name].dt, FIELDS[name].dy) for name in linear}))
    return Plan(fields, linear, columns, pairs)


def magnitudes(amplitudes: Amplitudes, potential: Real) -> dict[str, float]:
    """
    The size of each field: the root mean square over waves of height, slope, displacement or stretch; velocities count as 1.

    `potential` is the transpose of `potential_factor`.
    """
    k = amplitudes.grid.k
    energy = np.abs(amplitudes.forward) ** 2 + np.abs(amplitudes.backward) ** 2
    along = (potential.T * k) ** 2
    sizes = {
        ("height", 0): np.sum(energy),
        ("height", 1): np.sum(energy * k**2),
        ("potential", 1): np.sum(energy * along),
        ("potential", 2): np.sum(energy * along * k**2),
    }
    return {name: 1.0 if f.dt else float(np.sqrt(sizes[f.of, f.dx + f.dy])) or 1.0 for name, f in FIELDS.items()}


class Synthesis:
    """The waves of one tile, and the buffers that turn them into fields. Whoever owns it sees to it that it runs once at a time."""

    def __init__(self, amplitudes: Amplitudes, dtype: str, *, backend: str, planning: str, threads: int) -> None:
        self._amplitudes, self._grid = amplitudes, amplitudes.grid
        self._dtype, self._backend, self._planning, self._threads = dtype, backend, planning, threads
        # Columns of wavenumbers are contiguous: the transposes copy nothing where amplitudes are in Fortran order.
        self._forward, self._backward = (_parts(np.ascontiguousarray(a.T)) for a in (amplitudes.forward, amplitudes.backward))
        self._potential = np.ascontiguousarray(potential_factor(self._grid.k.T, amplitudes.depth).astype(dtype))
        self._magnitudes = magnitudes(amplitudes, self._potential)
        self._rate_omega: Real | None = None
        self._between = np.zeros(0, dtype=COMPLEX_OF[dtype])
        self._desks: dict[Plan, list[_Desk]] = {}
        self.restart()
        self.backend = self._desk_set(plan_of(("height",)))[0].first.backend

    def restart(self) -> None:
        """Start the threads; once more in a forked child, to which its parent's are not handed down."""
        self._pool = ThreadPoolExecutor(self._threads, thread_name_prefix="fftocean") if self._threads > 1 else None

    def run(self, turn: Turn, outputs: Mapping[str, Real], choppiness: float) -> None:
        """Compute fields into the arrays given by name, each (ny, nx), or (ny, nx, 3) for normals."""
        plan = plan_of(tuple(outputs))
        if not plan.linear:
            return
        if self._rate_omega is None and any(dt for _, dt, _ in plan.columns):
            self._rate_omega = np.ascontiguousarray(self._amplitudes.running_omega.T)
        desks, grid = self._desk_set(plan), self._grid
        half = grid.nx // 2 + 1
        size = grid.ny * len(plan.columns) * half
        if self._between.size < size:
            self._between = np.zeros(size, dtype=COMPLEX_OF[self._dtype])
        between = self._between[:size].reshape(grid.ny, len(plan.columns), half)
        self._share(desks, half, lambda desk, block: self._first_pass(desk, block, turn, between))
        c = np.dtype(self._dtype).type(choppiness)
        self._share(desks, grid.ny, lambda desk, block: self._second_pass(desk, block, _parts(between), outputs, c))

    def _share(self, desks: "list[_Desk]", total: int, work: "Callable[[_Desk, slice], None]") -> None:
        """Do the blocks of one pass, on one thread or each desk on its own. The blocks are the same, so are their bytes."""
        blocks = [slice(start, min(start + BLOCK, total)) for start in range(0, total, BLOCK)]

        def at(desk: _Desk, own: Iterable[slice]) -> None:
            for block in own:
                work(desk, block)

        if self._pool is None:
            at(desks[0], blocks)
        else:
            list(self._pool.map(at, desks, [blocks[i :: len(desks)] for i in range(len(desks))]))

    def _first_pass(self, desk: "_Desk", block: slice, turn: Turn, between: Complex) -> None:
        """Columns kx: turn the waves, derive along y, transform along y, store transposed."""
        n = block.stop - block.start
        turns, cosine, sine = desk.turns[:n], desk.cosine[:n], desk.sine[:n]
        turn(block, turns)
        passes.phasors(turns, cosine, sine)
        for dt in sorted({dt for _, dt, _ in desk.plan.columns}):
            if dt == 0:
                passes.heights(self._forward[block], self._backward[block], cosine, sine, desk.height)
            else:
                assert self._rate_omega is not None  # made before the first pass
                passes.rates(self._forward[block], self._backward[block], cosine, sine, self._rate_omega[block], desk.height)
            source = desk.height
            for of in sorted({of for of, d, _ in desk.plan.columns if d == dt}):  # the height, then the potential made of it
                if of == "potential":
                    source = desk.potential
                    passes.scale(desk.height, self._potential[block], source)
                for s, column in enumerate(desk.plan.columns):
                    if column[:2] == (of, dt):
                        dy = column[2]
                        passes.derive(source, desk.along_y[dy], *desk.units[dy], n, desk.first_parts[s])
        desk.first_parts[:, n:] = 0.0  # of the last, narrower block: else its leftovers would grow with each transform
        desk.first()
        passes.transpose(desk.first_block, block.start, n, between)

    def _second_pass(self, desk: "_Desk", block: slice, between: Real, outputs: Mapping[str, Real], choppiness: float) -> None:
        """Rows y: derive along x, transform two fields as one, split them, and finish what is made of them."""
        n = block.stop - block.start
        passes.pack(between, block.start, n, desk.sources, desk.powers, desk.turned, desk.second_parts)
        desk.second_parts[n:] = 0.0
        desk.second()
        rows = {name: outputs[name][block] if name in outputs else desk.scratch[name][:n] for name in desk.plan.linear}
        for p, pair in enumerate(desk.plan.pairs):
            if len(pair) == 2:
                passes.split(desk.second_parts, p, n, desk.weights[p], rows[pair[0]], rows[pair[1]])
            else:
                passes.split_one(desk.second_parts, p, n, rows[pair[0]])
        if "normal" in outputs:
            sx, sy, xx, xy, yy = (rows[name] for name in POINTWISE["normal"])
            surface.normals(sx, sy, xx, xy, yy, choppiness, outputs["normal"][block])
        if "jacobian" in outputs:
            xx, xy, yy = (rows[name] for name in POINTWISE["jacobian"])
            surface.jacobian(xx, xy, yy, choppiness, outputs["jacobian"][block])

    def _desk_set(self, plan: Plan) -> "list[_Desk]":
        """The desks for a plan, one a thread; those of the last few plans are kept."""
        if plan not in self._desks:
            while len(self._desks) >= 8:
                self._desks.pop(next(iter(self._desks)))
            self._desks[plan] = [
                _Desk(plan, self._grid, self._magnitudes, self._dtype, self._backend, self._planning) for _ in range(self._threads)
            ]
        return self._desks[plan]


class _Desk:
    """What one thread needs to work on a plan: buffers, FFT plans, and the table's signs and powers as arrays."""

    def __init__(self, plan: Plan, grid: Grid, magnitudes: Mapping[str, float], dtype: str, backend: str, planning: str) -> None:
        self.plan = plan
        columns, pairs = len(plan.columns), len(plan.pairs)
        number = np.dtype(dtype).type
        self.turns, self.cosine, self.sine = np.empty((3, BLOCK, grid.ny))
        self.height, self.potential = np.zeros((2, BLOCK, 2 * grid.ny), dtype=dtype)
        self.first = inverse_rows((columns * BLOCK, grid.ny), dtype, backend=backend, planning=planning)
        self.first_block = self.first.rows.reshape(columns, BLOCK, grid.ny)
        self.first_parts = _parts(self.first_block)
        self.second = inverse_rows((BLOCK * pairs, grid.nx), dtype, backend=backend, planning=planning)
        self.second_parts = _parts(self.second.rows.reshape(BLOCK, pairs, grid.nx))
        self.scratch = {name: np.empty((BLOCK, grid.nx), dtype=dtype) for name in plan.linear if name not in plan.asked}
        orders = range(max(max(f.dx, f.dy) for f in FIELDS.values()) + 1)
        self.along_y = [(grid.ky**order).astype(dtype) for order in orders]
        self.units = [(number((1j**order).real), number((1j**order).imag)) for order in orders]
        self.sources = np.zeros((2, pairs), dtype=np.int64)
        self.powers = np.zeros((2, pairs, grid.nx // 2 + 1), dtype=dtype)
        self.turned = np.zeros((2, pairs, 2), dtype=dtype)
        self.weights = [number(1.0) for _ in plan.pairs]
        for p, pair in enumerate(plan.pairs):
            if len(pair) == 2:
                # The transform's rounding errors are shared out between the two: a power of two, which rounds nothing, makes them equals.
                self.weights[p] = number(2.0 ** round(np.log2(magnitudes[pair[0]] / magnitudes[pair[1]])))
            for half, name in enumerate(pair):
                field = FIELDS[name]
                self.sources[half, p] = plan.columns.index((field.of, field.dt, field.dy))
                self.powers[half, p] = grid.kx**field.dx
                self.turned[half, p] = np.array(self.units[field.dx]) * (self.weights[p] if half else 1)


def _parts(array: Complex) -> Real:
    """A complex array as its interleaved real parts, the last axis twice as long; a view."""
    return array.view(array.real.dtype)
