"""Functions and arrays at given addresses, and shared counters, for compiled code."""

import ctypes
import threading
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import overload

from fftocean.arrays import Integer, Real

_intrinsic: Any = numba.extending.intrinsic
_carray: Any = numba.carray  # type: ignore[attr-defined]
_taking = threading.Lock()  # where nothing is compiled
_EXECUTE = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)


def execute(function: int, plan: int, source: int, result: int) -> None:
    """
    Call function(plan, source, result), all four given as addresses.

    It is the signature of `fftw_execute_dft`.
    """
    _EXECUTE(int(function))(int(plan), int(source), int(result))


@overload(execute, strict=False)
def _compiled_execute(function: Any, plan: Any, source: Any, result: Any) -> Any:
    return lambda function, plan, source, result: _execute(function, plan, source, result)


@_intrinsic
def _execute(context: Any, function: Any, plan: Any, source: Any, result: Any) -> Any:
    signature = types.void(types.intp, types.intp, types.intp, types.intp)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> Any:
        address = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [address] * 3)
        callee = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(callee, [builder.inttoptr(a, address) for a in arguments[1:]])
        return context.get_dummy_value()

    return signature, generate


def take(counter: Integer) -> int:
    """
    Return the first number of an array, and add 1 to it.

    No other thread can come in between, so threads that take numbers in turns get each once. Who
    sees the new number sees all that was written before it, past the caches too.
    """
    with _taking:
        number = int(counter[0])
        counter[0] += 1
    return number


@overload(take, strict=False)
def _compiled_take(counter: Any) -> Any:
    return lambda counter: _take(counter)


@_intrinsic
def _take(context: Any, counter: Any) -> Any:
    signature = types.int64(counter)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> Any:
        first = _first_number(context, builder, signature, arguments)
        return builder.atomic_rmw("add", first, ir.IntType(64)(1), "acq_rel")

    return signature, generate


def taken(counter: Integer) -> int:
    """Return the first number of an array, which other threads `take` meanwhile."""
    return int(counter[0])


@overload(taken, strict=False)
def _compiled_taken(counter: Any) -> Any:
    return lambda counter: _taken(counter)


@_intrinsic
def _taken(context: Any, counter: Any) -> Any:
    signature = types.int64(counter)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> Any:
        first = _first_number(context, builder, signature, arguments)
        return builder.load_atomic(first, "acquire", 8)

    return signature, generate


def _first_number(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> Any:
    """Return the address of the first number of the only argument, an array."""
    return context.make_array(signature.args[0])(context, builder, arguments[0]).data


def numbers_at(address: int, count: int, like: Real) -> Real:
    """Return the array of `count` numbers at an address, of the type of another array's."""
    held: Any = (ctypes.c_char * (int(count) * like.itemsize)).from_address(int(address))
    numbers: Real = np.frombuffer(held, like.dtype)
    return numbers


@overload(numbers_at, strict=False)
def _compiled_numbers_at(address: Any, count: Any, like: Any) -> Any:
    return lambda address, count, like: _carray(_pointer(address, like), count)


@_intrinsic
def _pointer(context: Any, address: Any, like: Any) -> Any:
    signature = types.CPointer(like.dtype)(types.intp, like)

    def generate(context: Any, builder: ir.IRBuilder, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

    return signature, generate
