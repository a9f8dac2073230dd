"""
The two passes of a synthesis over a whole tile of water, compiled with the FFTs between the loops.

A thread that runs one of them takes blocks until none is left, and needs the interpreter for none
of them. A block is eight columns kx in the first pass, eight rows y in the second; its data stay in
cache, and one transform's in the nearest one. The FFTs are called by address: a plan of FFTW or MKL
for one row. Where there is none, as with SciPy, the address is 0, and the transforms are called
from Python between the loops, many rows at once.

Complex numbers are given as pairs of reals. The indices of sources are 0 and 1 for the height and
its rate, 2 and 3 for the potential.
"""

from fftocean.arrays import Integer, Real
from fftocean.kernels.bound import add_folded
from fftocean.kernels.compiler import compiled
from fftocean.kernels.native import execute, numbers_at, take, taken
from fftocean.kernels.passes import (
    SIZE,
    derive,
    height_rates,
    heights,
    imaginary_part,
    mirror,
    mix,
    pack,
    phases,
    phasors,
    phasors_single,
    real_part,
    scaled,
    split_row,
    tile,
    unfold,
)
from fftocean.kernels.surface import jacobian_row, normal_row
from fftocean.kernels.vectors import LANES, TILE

Waves = tuple[Real, Real, Real]
"""
Frequencies, (columns, ny // 2 + 1); waves, (columns, 4 ny); factors of the potential.

Frequencies and factors are those at ky >= 0, which `passes.unfold` gives the other half.
"""

Moment = tuple[int, float, float]
"""The kind of phases, the time or step, and the number of steps: see `passes.phases`."""

Bound = tuple[bool, float, Real, Real, Real, Real, Real]
"""
Second-order sums: whether they have a gain of their own, `scale`; sums of the height and of its
rate, real and imaginary parts; the gain. See `bound.add_folded`.
"""

Spectra = tuple[Integer, Integer, Real, Real]
"""
The half-spectra of a set of fields: flags of the four sources; (spectra, 3) with source, other
source or -1, and 1 where real and imaginary part change places; the powers of ky, (spectra, 2, ny);
the signs of both parts, (spectra, 2).
"""

Columns = tuple[Real, Real, Real, Real, Real, Real, Real]
"""
Buffers of a thread: cycles, (1, ny // 2 + 1); cosine, sine, and a factor, (1, ny); real and
imaginary parts of the four sources, (4, 2, 1, ny); rows to transform, and transformed ones.
"""

Call = tuple[int, int, int, int]
"""Addresses of the function, of its plan, and of the first row of source and result."""

Rows = tuple[Integer, Real, Real, Real]
"""
The packed rows: (rows, 5) with the half-spectra at +k and -k, both fields, and 1 where only the
first is wanted, 2 where only the second; factors at +k and -k, and the one that undoes the weight.
"""

# `places` has, for each linear field, the address of its output and 1, for rows at their y; or
# that of a buffer and 0, for the rows of one block only.


WATCHED = 2000
"""Times that a thread looks whether others are done: a microsecond or two."""


@compiled
def are_done(done: Integer, count: int) -> bool:
    """Watch a short time until a number of blocks are done; return whether they are."""
    looks = 0
    while taken(done) < count and looks < WATCHED:
        looks += 1
    return looks < WATCHED


@compiled
def first_pass(
    counter: Integer,
    done: Integer,
    end: int,
    width: int,
    single: bool | None,
    moment: Moment,
    waves: Waves,
    omega: Real | None,
    bound: Bound | None,
    spectra: Spectra,
    buffers: Columns,
    call: Call,
    between: Real,
    streamed: bool,
) -> None:
    """
    Do blocks of the pass along y: advance the waves, derive half-spectra, transform and tile them.

    Without a function to call it stops before the transforms. Branches on None are left out when it
    is compiled.

    Args:
        counter, end: the number of the next block, and the one after the last.
        done: the number of blocks that are done.
        width: columns in a block; 8 where there is a function to call.
        single: None in double precision.
        omega: None where no rate is needed.
        between: has the layout of `passes.tile`.
        streamed: whether it is written past the caches.
    """
    frequency, table, potential = waves
    used, sources, powers, signs = spectra
    cycles, cosine, sine, factor, parts, source, results = buffers
    function, plan, from_address, to_address = call
    columns, ny = frequency.shape[0], table.shape[1] // 4
    tiles, count = (columns + TILE - 1) // TILE, sources.shape[0]
    row_bytes = source.shape[1] * source.itemsize
    transformed = results[: count * width].reshape(count * width * results.shape[1])
    while True:
        block = take(counter)
        if block >= end:
            break
        for c in range(min(width, columns - block * width)):
            x = block * width + c
            phases(moment[0], moment[1], moment[2], frequency[x : x + 1], cycles)
            if single is None:
                phasors(cycles, cosine, sine)
            else:
                phasors_single(cycles, cosine, sine)
            mirror(cosine[0], cycles.shape[1])
            mirror(sine[0], cycles.shape[1])
            if used[0]:
                heights(table[x : x + 1], cosine, sine, parts[0, 0], parts[0, 1])
            if omega is not None:
                unfold(omega[x], factor[0])
                height_rates(table[x : x + 1], cosine, sine, factor, parts[1, 0], parts[1, 1])
            if used[2] or used[3]:
                unfold(potential[x], factor[0])
            for rate in range(2):
                if used[2 + rate]:
                    scaled(parts[rate, 0], factor, parts[2 + rate, 0])
                    scaled(parts[rate, 1], factor, parts[2 + rate, 1])
            if bound is not None:  # after the potentials, which have no second order
                own, scale, real_sum, imag_sum, real_rate, imag_rate, gain = bound
                if used[0]:
                    add_folded(real_sum, imag_sum, x, gain, own, scale, parts[0, 0], parts[0, 1])
                if used[1]:
                    add_folded(real_rate, imag_rate, x, gain, own, scale, parts[1, 0], parts[1, 1])
            for s in range(count):
                of, other, swap = sources[s, 0], sources[s, 1], sources[s, 2]
                real, imag = parts[of, swap], parts[of, 1 - swap]
                row = s * width + c
                to = source[row : row + 1] if function == 0 else source[:1]
                a, b = signs[s, 0], signs[s, 1]
                if other < 0:
                    derive(real, imag, powers[s, 0], a, b, 1, to)
                else:
                    u, v = parts[other, swap], parts[other, 1 - swap]
                    mix(real, imag, powers[s, 0], u, v, powers[s, 1], a, b, 1, to)
                if function != 0:
                    execute(function, plan, from_address, to_address + row * row_bytes)
        if function != 0:
            tile(transformed, 0, width, count, ny, block, tiles, between, streamed)
        take(done)


@compiled
def pack_rows(
    y: int, count: int, p: int, spectra: int, rows: Rows, between: Real, source: Real, nx: int
) -> None:
    """Write the packed rows number p of some rows y; the last of `source` is unused."""
    table, plus, minus, _ = rows
    tiles = (plus.shape[1] // 2 + TILE - 1) // TILE
    one, other, factors, mirrored = table[p, 0], table[p, 1], plus[p], minus[p]
    for r in range(count):
        band, within = (y + r) // TILE, (y + r) % TILE
        start = band * tiles * spectra * SIZE + within * LANES
        pack(between, start, spectra, one, other, factors, mirrored, source, 2 * nx * r, nx)


@compiled
def split_rows(
    y: int,
    count: int,
    p: int,
    rows: Rows,
    result: Real,
    places: Integer,
    streamed: bool,
    nx: int,
) -> None:
    """Write the fields of some transformed rows to their places."""
    table, _, _, undo = rows
    one, other, only = table[p, 2], table[p, 3], table[p, 4]
    for r in range(count):
        at = 2 * nx * r
        if only == 0:
            real, imag = _row(places, one, y, r, nx, result), _row(places, other, y, r, nx, result)
            past_real = streamed and places[one, 1] == 1  # buffers stay in cache
            past_imag = streamed and places[other, 1] == 1
            split_row(result, at, undo[p], real, imag, past_real, past_imag)
        elif only == 1:
            real_part(result, at, _row(places, one, y, r, nx, result))
        else:
            imaginary_part(result, at, undo[p], _row(places, other, y, r, nx, result))


@compiled
def _row(places: Integer, field: int, y: int, r: int, nx: int, like: Real) -> Real:
    """Return row y + r of a field."""
    row = y + r if places[field, 1] else r
    return numbers_at(places[field, 0] + row * nx * like.itemsize, nx, like)


@compiled
def finish_rows(
    y: int,
    count: int,
    geometry: Integer,
    places: Integer,
    choppiness: float,
    normal: Real,
    jacobian: Real,
    unit: Real,
    streamed: bool,
    nx: int,
) -> None:
    """
    Write normals and Jacobians of some rows, from the gradients in their places.

    Args:
        geometry: the numbers of the gradients among the fields, in the order that
            `surface.normals` takes them.
        normal, jacobian: whole outputs, or empty.
        unit: buffer of 3 nx.
        streamed: whether outputs are written past the caches; their rows are whole cache lines.
    """
    for r in range(count):
        at = (y + r) * nx
        xx = _row(places, geometry[2], y, r, nx, unit)
        xy = _row(places, geometry[3], y, r, nx, unit)
        yy = _row(places, geometry[4], y, r, nx, unit)
        if normal.size:
            sx = _row(places, geometry[0], y, r, nx, unit)
            sy = _row(places, geometry[1], y, r, nx, unit)
            out = normal[3 * at : 3 * (at + nx)]
            normal_row(sx, sy, xx, xy, yy, choppiness, unit, out, streamed)
        if jacobian.size:
            jacobian_row(xx, xy, yy, choppiness, jacobian[at : at + nx])


@compiled
def second_pass(
    counter: Integer,
    spectra: int,
    rows: Rows,
    between: Real,
    source: Real,
    result: Real,
    call: Call,
    geometry: Integer,
    places: Integer,
    choppiness: float,
    normal: Real,
    jacobian: Real,
    unit: Real,
    streamed: bool,
    ny: int,
    nx: int,
) -> None:
    """Do blocks of the pass along x; arguments as in `finish_rows`."""
    function, plan, from_address, to_address = call
    while True:
        band = take(counter)
        if band * TILE >= ny:
            break
        for y in range(band * TILE, min((band + 1) * TILE, ny)):
            for p in range(rows[0].shape[0]):
                pack_rows(y, 1, p, spectra, rows, between, source, nx)
                execute(function, plan, from_address, to_address)
                split_rows(y, 1, p, rows, result, places, streamed, nx)
            if normal.size or jacobian.size:
                finish_rows(
                    y, 1, geometry, places, choppiness, normal, jacobian, unit, streamed, nx
                )
