"""
Steps of 8 or 16 numbers that compilers do not turn into vector instructions by themselves.

Each is a plain function and, for compiled callers, the same in the compiler's vectors. Arrays are
given whole, C-contiguous, with the place of the first number in them.

Some can write past the caches, which they call streamed: memory that is larger than a cache is not
read before it is written then. It must be whole cache lines, and start on one.
"""

from typing import Any

import numba
from llvmlite import ir
from numba.core import types
from numba.extending import overload

from fftocean.arrays import CACHE_LINE, Real

_intrinsic: Any = numba.extending.intrinsic

TILE = 8
"""Rows and columns of a tile of complex numbers; in single precision a row is a cache line."""

LANES = 2 * TILE
"""Real numbers in a row of a tile."""


def scale(factors: Real, f: int, source: Real, s: int, out: Real, o: int) -> None:
    """Write `LANES` products of reals."""
    out[o : o + LANES] = factors[f : f + LANES] * source[s : s + LANES]


def scale_reversed(factors: Real, f: int, source: Real, s: int, out: Real, o: int) -> None:
    """Write the same products, with the pairs of the source in reversed order."""
    pairs = source[s : s + LANES].reshape(TILE, 2)[::-1]
    out[o : o + LANES] = factors[f : f + LANES] * pairs.reshape(LANES)


def reverse(source: Real, s: int, out: Real, o: int) -> None:
    """Write `LANES` numbers in reversed order."""
    out[o : o + LANES] = source[s : s + LANES][::-1]


def split(
    pairs: Real,
    p: int,
    factor: float,
    first: Real,
    f: int,
    second: Real,
    s: int,
    stream_first: bool,
    stream_second: bool,
) -> None:
    """Write the first numbers of `LANES` pairs, and the second ones times a factor."""
    first[f : f + LANES] = pairs[p : p + 2 * LANES : 2]
    second[s : s + LANES] = pairs[p + 1 : p + 2 * LANES : 2] * factor


def interleave(source: Real, s: int, stride: int, out: Real, o: int, streamed: bool) -> None:
    """Write `LANES` triples from three rows, which are `stride` numbers apart."""
    for row in range(3):
        start = s + row * stride
        out[o + row : o + 3 * LANES : 3] = source[start : start + LANES]


def transpose(source: Real, s: int, stride: int, out: Real, o: int, streamed: bool) -> None:
    """Write a tile from 8 columns of pairs, which are `stride` numbers apart."""
    for row in range(TILE):
        for column in range(TILE):
            place, at = o + 2 * (TILE * row + column), s + column * stride + 2 * row
            out[place : place + 2] = source[at : at + 2]


def prefetch(source: Real, s: int) -> None:
    """Ask for a number and those beside it, which are read soon; it may lie past the end."""


class _Builder:
    """Vector instructions on arrays, for an intrinsic function under construction."""

    def __init__(self, context: Any, builder: ir.IRBuilder, signature: Any) -> None:
        self._context, self._builder, self._types = context, builder, signature.args

    def _pointer(self, arguments: Any, array: int, place: Any, of: ir.Type) -> Any:
        kind = self._types[array]
        data = self._context.make_array(kind)(self._context, self._builder, arguments[array]).data
        return self._builder.bitcast(self._builder.gep(data, [place]), of.as_pointer())

    def element(self, array: int) -> ir.Type:
        """Return the type of an array's numbers."""
        return self._context.get_data_type(self._types[array].dtype)

    def bytes(self, array: int) -> int:
        """Return the size of an array's numbers."""
        return int(self._types[array].dtype.bitwidth) // 8

    def load(self, arguments: Any, array: int, place: Any, of: ir.Type) -> Any:
        """Return a vector from an array."""
        loaded = self._builder.load(self._pointer(arguments, array, place, of))
        loaded.align = self.bytes(array)
        return loaded

    def store(
        self, vector: Any, arguments: Any, array: int, place: Any, streamed: Any = None
    ) -> None:
        """Write a vector to an array; if `streamed` is true, past the caches."""
        pointer = self._pointer(arguments, array, place, vector.type)
        if streamed is None:
            self._builder.store(vector, pointer, align=self.bytes(array))
            return
        with self._builder.if_else(streamed) as (past, through):
            with past:
                past_caches = self._builder.store(vector, pointer, align=CACHE_LINE)
                one = ir.Constant(ir.IntType(32), 1)
                hint = self._builder.module.add_metadata([one])
                past_caches.set_metadata("nontemporal", hint)
            with through:
                self._builder.store(vector, pointer, align=self.bytes(array))

    def prefetch(self, arguments: Any, array: int, place: Any) -> None:
        """Ask for the cache line of a number, for reading, into a cache that is not the nearest."""
        byte, number = ir.IntType(8).as_pointer(), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte, number, number, number])
        function = self._builder.module.declare_intrinsic("llvm.prefetch", [byte], kind)
        reading, locality, data = number(0), number(2), number(1)
        pointer = self._pointer(arguments, array, place, ir.IntType(8))
        self._builder.call(function, [pointer, reading, locality, data])

    def shuffle(self, a: Any, b: Any, lanes: list[int]) -> Any:
        """Return chosen lanes of two vectors."""
        mask = ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), lanes)
        return self._builder.shuffle_vector(a, b, mask)


@_intrinsic
def _scale(_: Any, factors: Any, f: Any, source: Any, s: Any, out: Any, o: Any) -> Any:
    return _scaling((factors, f, source, s, out, o), False)


@_intrinsic
def _scale_reversed(_: Any, factors: Any, f: Any, source: Any, s: Any, out: Any, o: Any) -> Any:
    return _scaling((factors, f, source, s, out, o), True)


def _scaling(arguments: tuple[Any, ...], backwards: bool) -> Any:
    factors, _, source, _, out, _ = arguments
    signature = types.void(factors, types.intp, source, types.intp, out, types.intp)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, a: Any) -> Any:
        make = _Builder(context, builder, signature)
        vector = ir.VectorType(make.element(0), LANES)
        factors, numbers = make.load(a, 0, a[1], vector), make.load(a, 2, a[3], vector)
        if backwards:
            pairs = [i for pair in reversed(range(TILE)) for i in (2 * pair, 2 * pair + 1)]
            numbers = make.shuffle(numbers, numbers, pairs)
        make.store(builder.fmul(factors, numbers), a, 4, a[5])
        return context.get_dummy_value()

    return signature, generate


@_intrinsic
def _reverse(_: Any, source: Any, s: Any, out: Any, o: Any) -> Any:
    signature = types.void(source, types.intp, out, types.intp)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, a: Any) -> Any:
        make = _Builder(context, builder, signature)
        numbers = make.load(a, 0, a[1], ir.VectorType(make.element(0), LANES))
        make.store(make.shuffle(numbers, numbers, list(reversed(range(LANES)))), a, 2, a[3])
        return context.get_dummy_value()

    return signature, generate


@_intrinsic
def _split(
    _: Any,
    pairs: Any,
    p: Any,
    factor: Any,
    first: Any,
    f: Any,
    second: Any,
    s: Any,
    stream_first: Any,
    stream_second: Any,
) -> Any:
    places = types.intp, types.boolean
    signature = types.void(
        *(pairs, places[0], pairs.dtype, first, places[0], second, places[0]), *(places[1],) * 2
    )

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, a: Any) -> Any:
        make = _Builder(context, builder, signature)
        vector = ir.VectorType(make.element(0), LANES)
        low = make.load(a, 0, a[1], vector)
        high = make.load(a, 0, builder.add(a[1], a[1].type(LANES)), vector)
        factor = ir.Constant(vector, ir.Undefined)
        factor = builder.insert_element(factor, a[2], ir.IntType(32)(0))
        factor = make.shuffle(factor, factor, [0] * LANES)
        make.store(make.shuffle(low, high, list(range(0, 2 * LANES, 2))), a, 3, a[4], a[7])
        odd = make.shuffle(low, high, list(range(1, 2 * LANES, 2)))
        make.store(builder.fmul(odd, factor), a, 5, a[6], a[8])
        return context.get_dummy_value()

    return signature, generate


@_intrinsic
def _interleave(_: Any, source: Any, s: Any, stride: Any, out: Any, o: Any, streamed: Any) -> Any:
    signature = types.void(source, types.intp, types.intp, out, types.intp, types.boolean)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, a: Any) -> Any:
        make = _Builder(context, builder, signature)
        vector = ir.VectorType(make.element(0), LANES)
        place, rows = a[1], []
        for _ in range(3):
            rows.append(make.load(a, 0, place, vector))
            place = builder.add(place, a[2])
        for i in range(3):  # lanes of the first two rows, then those of the third between them
            numbers = range(LANES * i, LANES * (i + 1))
            two = [n // 3 + (LANES if n % 3 == 1 else 0) for n in numbers]
            all_three = [LANES + n // 3 if n % 3 == 2 else n - LANES * i for n in numbers]
            triples = make.shuffle(make.shuffle(rows[0], rows[1], two), rows[2], all_three)
            make.store(triples, a, 3, builder.add(a[4], a[4].type(LANES * i)), a[5])
        return context.get_dummy_value()

    return signature, generate


@_intrinsic
def _prefetch(_: Any, source: Any, s: Any) -> Any:
    signature = types.void(source, types.intp)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, a: Any) -> Any:
        _Builder(context, builder, signature).prefetch(a, 0, a[1])
        return context.get_dummy_value()

    return signature, generate


@_intrinsic
def _transpose(_: Any, source: Any, s: Any, stride: Any, out: Any, o: Any, streamed: Any) -> Any:
    signature = types.void(source, types.intp, types.intp, out, types.intp, types.boolean)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, a: Any) -> Any:
        make = _Builder(context, builder, signature)
        # A pair is moved as one number.
        pair = ir.DoubleType() if make.bytes(0) == 4 else ir.IntType(128)
        vector = ir.VectorType(pair, TILE)
        place, rows = a[1], []
        for _ in range(TILE):
            rows.append(make.load(a, 0, place, vector))
            place = builder.add(place, a[2])
        step = 1
        while step < TILE:  # exchange single numbers, then pairs of them, then fours
            for i in (i for i in range(TILE) if not i & step):
                low = [TILE + k - step if k & step else k for k in range(TILE)]
                high = [TILE + k if k & step else k + step for k in range(TILE)]
                one, other = rows[i], rows[i + step]
                rows[i], rows[i + step] = (make.shuffle(one, other, lanes) for lanes in (low, high))
            step *= 2
        for i, row in enumerate(rows):
            numbers = builder.bitcast(row, ir.VectorType(make.element(3), LANES))
            make.store(numbers, a, 3, builder.add(a[4], a[4].type(LANES * i)), a[5])
        return context.get_dummy_value()

    return signature, generate


@overload(scale, strict=False)
def _compiled_scale(factors: Any, f: Any, source: Any, s: Any, out: Any, o: Any) -> Any:
    return lambda factors, f, source, s, out, o: _scale(factors, f, source, s, out, o)


@overload(scale_reversed, strict=False)
def _compiled_scale_reversed(factors: Any, f: Any, source: Any, s: Any, out: Any, o: Any) -> Any:
    return lambda factors, f, source, s, out, o: _scale_reversed(factors, f, source, s, out, o)


@overload(reverse, strict=False)
def _compiled_reverse(source: Any, s: Any, out: Any, o: Any) -> Any:
    return lambda source, s, out, o: _reverse(source, s, out, o)


@overload(split, strict=False)
def _compiled_split(
    pairs: Any,
    p: Any,
    factor: Any,
    first: Any,
    f: Any,
    second: Any,
    s: Any,
    stream_first: Any,
    stream_second: Any,
) -> Any:
    return lambda pairs, p, factor, first, f, second, s, stream_first, stream_second: _split(
        pairs, p, factor, first, f, second, s, stream_first, stream_second
    )


@overload(interleave, strict=False)
def _compiled_interleave(source: Any, s: Any, stride: Any, out: Any, o: Any, streamed: Any) -> Any:
    return lambda source, s, stride, out, o, streamed: _interleave(
        source, s, stride, out, o, streamed
    )


@overload(transpose, strict=False)
def _compiled_transpose(source: Any, s: Any, stride: Any, out: Any, o: Any, streamed: Any) -> Any:
    return lambda source, s, stride, out, o, streamed: _transpose(
        source, s, stride, out, o, streamed
    )


@overload(prefetch, strict=False)
def _compiled_prefetch(source: Any, s: Any) -> Any:
    return lambda source, s: _prefetch(source, s)
