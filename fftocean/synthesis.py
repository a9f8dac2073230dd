"""
From h0 to fields, block by block: the plan of a frame, drawn from the table in `fields.py`.

A two-dimensional inverse transform is a pass along y, then one along x. After the first, each row
is the Hermitian half of a real one, so two real fields A and B go through the second as one complex
row, A + i B at k >= 0 and conj(A - i B) at -k. Where B = dA/dx both are A times a real number, 1 -+
kx: the two share one spectrum in the first pass as well. So eight fields take five transforms along
y and four along x. Both passes run over blocks that stay in cache.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import COMPLEX_OF, Complex, Real
from fftocean.fields import FIELDS, Field, potential_factor
from fftocean.kernels import passes, surface
from fftocean.transforms import aligned, inverse_rows

GEOMETRY = ("slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy")
POINTWISE = {"normal": GEOMETRY, "jacobian": GEOMETRY[2:]}
"""The fields that are not linear, and the linear ones that they are made of."""

Turn = Callable[[slice, Real], None]
"""Writes how far the waves of some columns of wavenumbers have turned, (columns, ny)."""

PAIRS: tuple[tuple[str, ...], ...] = (
    ("height", "slope_x"),
    ("displace_x", "stretch_xx"),
    ("displace_y", "stretch_xy"),
    ("slope_y", "stretch_yy"),
    ("velocity_z", "velocity_y"),
    ("velocity_x",),
)
"""
Who shares a complex row with whom: always the same, asked for or not, so that a field has the same
bits whatever is asked.
"""


@dataclass(frozen=True, slots=True)
class Spectrum:
    """
    What goes through the first pass: i^turns (ky^power source [+ sign weight ky^other_power
    other]), with no factor of kx.

    Sources are the height or the potential, or their time derivatives.
    """

    pair: tuple[str, ...]  # whose it is
    source: tuple[str, int]  # (of, dt)
    turns: int  # quarter turns
    power: int
    other: tuple[str, int] | None = None
    other_power: int = 0
    sign: int = 1


@dataclass(frozen=True, slots=True)
class Row:
    """
    One complex row of the second pass: its one or two fields, and where in the first their spectra
    at k and -k are.
    """

    pair: tuple[str, ...]
    ahead: int
    astern: int


@dataclass(frozen=True, slots=True)
class Plan:
    """What to compute for a set of fields."""

    asked: tuple[str, ...]
    linear: tuple[str, ...]  # the linear fields computed, asked for or not
    spectra: tuple[Spectrum, ...]
    rows: tuple[Row, ...]


def rows_of_the_table() -> tuple[tuple[str, ...], ...]:
    """
    The pairs, as far as the table allows them: two that differ by more than a real factor and one
    of kx go a row each.
    """
    return tuple(
        row
        for pair in PAIRS
        for row in ([pair] if _derived(pair) or _mixable(pair) else [(name,) for name in pair])
    )


def _derived(pair: tuple[str, ...]) -> bool:
    """Whether the second of a pair is the first's derivative along x, or there is none."""
    if len(pair) == 1:
        return True
    a, b = (FIELDS[name] for name in pair)
    return (b.of, b.dt, b.dy, b.dx) == (a.of, a.dt, a.dy, a.dx + 1)


def _mixable(pair: tuple[str, ...]) -> bool:
    """Whether A and i B of a pair differ by a real factor before anything is known of kx."""
    a, b = (FIELDS[name] for name in pair)
    return a.dx == b.dx == 0 and (1 + b.dy - a.dy) % 2 == 0


def _spectra_of(pair: tuple[str, ...]) -> tuple[Spectrum, ...]:
    """
    The spectra that a pair needs: A alone where the rest is a factor of kx, else A + i weight B and
    A - i weight B.
    """
    a: Field = FIELDS[pair[0]]
    if _derived(pair):
        return (Spectrum(pair, (a.of, a.dt), a.dx + a.dy, a.dy),)
    b: Field = FIELDS[pair[1]]
    sign = (-1) ** ((1 + b.dy - a.dy) // 2)  # i B leads A by so many half turns
    return tuple(
        Spectrum(pair, (a.of, a.dt), a.dy, a.dy, (b.of, b.dt), b.dy, s) for s in (sign, -sign)
    )


@lru_cache(maxsize=256)
def plan_of(fields: tuple[str, ...]) -> Plan:
    """Plan a set of field names."""
    wanted = {
        name for field in fields for name in ((field,) if field in FIELDS else POINTWISE[field])
    }
    pairs = tuple(pair for pair in rows_of_the_table() if wanted & set(pair))
    spectra: list[Spectrum] = []
    rows = []
    for pair in pairs:
        own = _spectra_of(pair)
        rows.append(Row(pair, len(spectra), len(spectra) + len(own) - 1))
        spectra.extend(own)
    return Plan(fields, tuple(name for pair in pairs for name in pair), tuple(spectra), tuple(rows))


def magnitudes(amplitudes: Amplitudes) -> dict[str, float]:
    """
    Return the root mean square of each field, for waves of which the largest is about 1; 0 where
    they all run along the other axis.
    """
    grid, omega = amplitudes.grid, amplitudes.running_omega
    per_unit = 1.0 / largest_wave(amplitudes)
    energy = (np.abs(amplitudes.forward) * per_unit) ** 2 + (
        np.abs(amplitudes.backward) * per_unit
    ) ** 2
    sources = {
        (of, dt): energy * (factor * omega**dt) ** 2
        for of, factor in (
            ("height", 1.0),
            ("potential", potential_factor(grid.k, amplitudes.depth)),
        )
        for dt in (0, 1)
    }
    kx, ky = grid.kx, grid.ky

    def size(field: Field) -> float:
        energy = sources[field.of, field.dt]
        return math.sqrt(
            float(np.sum(np.sum(energy * kx ** (2 * field.dx), axis=1) * ky ** (2 * field.dy)))
        )

    return {name: size(field) for name, field in FIELDS.items()}


def balance(first: float, second: float, reach: int) -> float:
    """
    Return the power of two, from 2^-reach to 2^reach, that makes a second field as large as a
    first; 1 where the second is 0.
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


def block_of(n: int, available: int) -> int:
    """
    How many rows of n to work on at a time; measured, and flat about there.

    Fewer would lie nearer to the processor, but every call of a kernel gives the interpreter up and
    takes it back: with short calls two threads wait for each other more than they work (at n = 512,
    16 rows gain 1.2 times by a second thread, 64 rows 1.8 times).
    """
    return min(max(2**16 // n, 32), 64, available)


class Synthesis:
    """
    The waves of one tile, and the buffers that turn them into fields. Whoever owns it sees to it
    that it runs once at a time.
    """

    def __init__(
        self, amplitudes: Amplitudes, dtype: str, *, backend: str, planning: str, threads: int
    ) -> None:
        self._amplitudes, self._grid = amplitudes, amplitudes.grid
        self._dtype = np.dtype(dtype)
        grid = self._grid
        self.columns = (
            grid.nx + 1
        ) // 2  # of the half plane; the Nyquist column, where there is one, is always zero
        # Powers of two, which round nothing, keep all numbers on the way within the range of single
        # precision: waves are taken
        # over the largest of them, which the second pass multiplies with again.
        self._unit = largest_wave(amplitudes)
        self._waves = self._prepared(amplitudes)
        k = grid.k.T[: self.columns]
        self._potential = np.ascontiguousarray(potential_factor(k, amplitudes.depth), dtype=dtype)
        self._omega: Real | None = None
        self._between = np.zeros(0, dtype=COMPLEX_OF[dtype])
        size = self._size = magnitudes(amplitudes)
        pairs = rows_of_the_table()
        # The transform's rounding errors are shared out between a pair: a power of two makes them
        # equals. A field smaller still beside
        # its partner (in a sea nearly along one axis) gets errors of 1e-34 of the partner in single
        # precision.
        reach = 90 if self._dtype == np.float32 else 500
        self._weights: dict[tuple[str, ...], float] = {
            pair: balance(size[pair[0]], size[pair[1]], reach) for pair in pairs if len(pair) == 2
        }
        self._numbers = {
            spectrum: self._numbers_of(spectrum) for pair in pairs for spectrum in _spectra_of(pair)
        }
        self._factors = {pair: self._factors_of(pair) for pair in pairs}
        self._widths = (block_of(grid.ny, self.columns), block_of(grid.nx, grid.ny))
        blocks = max(-(-self.columns // self._widths[0]), -(-grid.ny // self._widths[1]))
        self._desks = [
            _Desk(self._widths, grid.shape, dtype, backend, planning)
            for _ in range(min(threads, blocks))
        ]
        self.restart()
        self.backend = self._desks[0].first.backend

    def restart(self) -> None:
        """
        Start the threads; once more in a forked child, to which its parent's are not handed down.
        """
        others = len(self._desks) - 1
        self._pool = ThreadPoolExecutor(others, thread_name_prefix="fftocean") if others else None

    def run(self, turn: Turn, outputs: Mapping[str, Real], choppiness: float) -> None:
        """
        Compute fields into the arrays given by name, each (ny, nx), or (ny, nx, 3) for normals.
        """
        plan = plan_of(tuple(outputs))
        if not plan.linear:
            return
        if self._omega is None and any(spectrum.source[1] for spectrum in plan.spectra):
            self._omega = np.ascontiguousarray(
                self._amplitudes.running_omega.T[: self.columns], dtype=self._dtype
            )
        between = self._between_passes(len(plan.spectra))
        moved = _movable(between)
        c = self._dtype.type(choppiness)
        self._share(
            self.columns,
            self._widths[0],
            lambda desk, block: self._first_pass(plan, desk, block, turn, moved),
        )
        halves = _parts(between)
        self._share(
            self._grid.ny,
            self._widths[1],
            lambda desk, block: self._second_pass(plan, desk, block, halves, outputs, c),
        )

    def _share(self, total: int, width: int, work: "Callable[[_Desk, slice], None]") -> None:
        """
        Do the blocks of one pass, on one thread or each desk on its own. The blocks are the same,
        so are their bytes.
        """
        blocks = [slice(start, min(start + width, total)) for start in range(0, total, width)]

        def at(desk: _Desk, own: Iterable[slice]) -> None:
            for block in own:
                work(desk, block)

        (mine, *others) = [
            (desk, blocks[i :: len(self._desks)]) for i, desk in enumerate(self._desks)
        ]
        tasks: list[Future[None]] = []
        try:
            for share in others:
                assert self._pool is not None  # there is one for more desks than one
                try:
                    tasks.append(self._pool.submit(at, *share))
                except (
                    RuntimeError
                ):  # Python is on its way out and starts nothing new: the same work, here
                    at(*share)
            at(*mine)  # here, where the caller's caches are warm and nobody has to be woken
            for task in tasks:
                task.result()
        finally:  # of an interrupt, too: nobody may have the desks before the last has left them
            wait(tasks)

    def _first_pass(
        self, plan: Plan, desk: "_Desk", block: slice, turn: Turn, between: Real | Complex
    ) -> None:
        """Columns kx: turn the waves, derive along y, transform along y, store transposed."""
        n = block.stop - block.start
        turns, cosine, sine = desk.turns[:n], desk.cosine[:n], desk.sine[:n]
        turn(block, turns)
        (passes.phasors_single if self._dtype == np.float32 else passes.phasors)(
            turns, cosine, sine
        )
        ready: set[tuple[str, int]] = set()

        def parts_of(source: tuple[str, int]) -> tuple[Real, Real]:
            """
            Real and imaginary part of the height, the potential, or a rate of one, made once a
            block.
            """
            parts: tuple[Real, Real] = desk.parts[source]
            if source not in ready:
                ready.add(source)
                of, dt = source
                if of == "potential":
                    for whole, part in zip(parts_of(("height", dt)), parts, strict=True):
                        passes.scale(whole, self._potential[block], part)
                elif dt == 0:
                    passes.turn_waves(self._waves[block], cosine, sine, *parts)
                else:
                    assert self._omega is not None  # made before the first pass
                    passes.turn_rates(self._waves[block], cosine, sine, self._omega[block], *parts)
            return parts

        for s, spectrum in enumerate(plan.spectra):
            power, other_power, first, second = self._numbers[spectrum]
            parts = _swapped(parts_of(spectrum.source), spectrum.turns)
            if spectrum.other is None:
                passes.derive(*parts, power, first, second, n, desk.first_source)
            else:
                other = _swapped(parts_of(spectrum.other), spectrum.turns)
                passes.mix(*parts, power, *other, other_power, first, second, n, desk.first_source)
            desk.first()
            passes.transpose(desk.first_result, s, block.start, n, between)

    def _second_pass(
        self,
        plan: Plan,
        desk: "_Desk",
        block: slice,
        between: Real,
        outputs: Mapping[str, Real],
        choppiness: float,
    ) -> None:
        """
        Rows y: derive along x, transform two fields as one, split them, and finish what is made of
        them.
        """
        n = block.stop - block.start
        rows = {
            name: outputs[name][block] if name in outputs else desk.scratch[name][:n]
            for name in plan.linear
        }
        for row in plan.rows:
            ahead, astern, undo = self._factors[row.pair]
            passes.pack(
                between, block.start, n, row.ahead, row.astern, ahead, astern, desk.second_source
            )
            desk.second()
            if len(row.pair) == 2:
                passes.split(desk.second_result, undo, rows[row.pair[0]], rows[row.pair[1]])
            else:
                passes.real_parts(desk.second_result, rows[row.pair[0]])
        if "normal" in outputs:
            sx, sy, xx, xy, yy = (rows[name] for name in POINTWISE["normal"])
            surface.normals(sx, sy, xx, xy, yy, choppiness, outputs["normal"][block])
        if "jacobian" in outputs:
            xx, xy, yy = (rows[name] for name in POINTWISE["jacobian"])
            surface.jacobian(xx, xy, yy, choppiness, outputs["jacobian"][block])

    def _prepared(self, amplitudes: Amplitudes) -> Real:
        """
        Sums and differences of forward and backward waves, as `passes.turn_waves` wants them,
        (columns, 4 ny).
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
            # What cannot be seen beside the largest, not even as curvature, must not end as
            # subnormal, which is slow.
            waves[np.abs(waves) < 1e-30] = 0.0
        return waves.reshape(self.columns, -1)

    def _numbers_of(self, spectrum: Spectrum) -> tuple[Real, Real, float, float]:
        """
        The powers of ky of a spectrum, the second with its weight, (ny,); the signs that its
        quarter turns give its parts.
        """
        number = self._dtype.type
        weight = spectrum.sign * self._weights.get(spectrum.pair, 1.0)
        power, other = self._grid.ky**spectrum.power, weight * self._grid.ky**spectrum.other_power
        turned = 1j**spectrum.turns * (1 + 1j)
        return (
            power.astype(self._dtype),
            other.astype(self._dtype),
            number(round(turned.real)),
            number(round(turned.imag)),
        )

    def _factors_of(self, pair: tuple[str, ...]) -> tuple[Real, Real, float]:
        """
        The factors of kx that a pair's spectra take at k and at -k, laid out as `passes.pack` wants
        them; what undoes the weight.
        """
        kx, weight = self._grid.kx[: self.columns], self._weights.get(pair, 1.0)
        slant = weight * kx if len(pair) == 2 and _derived(pair) else 0.0
        order = FIELDS[pair[0]].dx
        power = self._unit * kx**order
        ahead, astern = (
            np.repeat(power * (1.0 - slant), 2),
            np.repeat(power * (1.0 + slant), 2)[:1:-1],
        )
        astern[1::2] *= -1.0
        undo = (
            1.0 / weight if self._size[pair[-1]] > 0.0 else 0.0
        )  # no wave, no field: not even roundings of the other one
        return ahead.astype(self._dtype), astern.astype(self._dtype), self._dtype.type(undo)

    def _between_passes(self, spectra: int) -> Complex:
        """
        What the first pass leaves for the second, (ny, spectra, columns), each row on cache lines
        of its own.
        """
        line = 64 // self._between.itemsize
        columns = -(-self.columns // line) * line
        size = self._grid.ny * spectra * columns
        if self._between.size < size:
            self._between = aligned((1, size), self._dtype.name)[0]
        return self._between[:size].reshape(self._grid.ny, spectra, columns)


class _Desk:
    """What one thread needs to work: buffers and FFT plans, the same for whatever is asked."""

    def __init__(
        self,
        widths: tuple[int, int],
        shape: tuple[int, int],
        dtype: str,
        backend: str,
        planning: str,
    ) -> None:
        (columns, rows), (ny, nx) = widths, shape
        self.turns = np.empty((columns, ny))
        self.cosine, self.sine = np.empty((2, columns, ny), dtype=dtype)
        sources = [(of, dt) for of in ("height", "potential") for dt in (0, 1)]
        self.parts: dict[tuple[str, int], tuple[Real, Real]] = {}
        for source in sources:
            real, imaginary = np.empty((2, columns, ny), dtype=dtype)
            self.parts[source] = (real, imaginary)
        self.first = inverse_rows((columns, ny), dtype, backend=backend, planning=planning)
        self.second = inverse_rows((rows, nx), dtype, backend=backend, planning=planning)
        self.first_source, self.first_result = (
            _parts(self.first.source),
            _movable(self.first.result),
        )
        self.second_source, self.second_result = (
            _parts(self.second.source),
            _parts(self.second.result),
        )
        self.scratch = {name: np.empty((rows, nx), dtype=dtype) for name in FIELDS}


def _swapped(parts: tuple[Real, Real], quarters: int) -> tuple[Real, Real]:
    """
    What becomes the real part and what the imaginary, but for their signs, when a number is turned
    by quarters.
    """
    return parts if quarters % 2 == 0 else parts[::-1]


def _movable(array: Complex) -> Real | Complex:
    """
    A complex array as `passes.transpose` moves it: those of single precision as reals of 8 bytes; a
    view.
    """
    return array.view(np.float64) if array.dtype == np.complex64 else array


def _parts(array: Complex) -> Real:
    """A complex array as its interleaved real parts, the last axis twice as long; a view."""
    return array.view(array.real.dtype)
