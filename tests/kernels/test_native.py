"""Addresses and counters in compiled code."""

import ctypes
import threading

import numpy as np
import pytest

from fftocean.kernels import native
from fftocean.kernels.compiler import compiled

pytestmark = pytest.mark.nojit


@compiled
def call(function, plan, source, result):
    native.execute(function, plan, source, result)


@compiled
def take_all(counter, end, taken):
    while True:
        number = native.take(counter)
        if number >= end:
            break
        taken[number] += 1


@compiled
def write_all(written, counter):
    for i in range(written.size):
        written[i] = i + 1
        native.take(counter)


@compiled
def read_all(written, counter, wrong):
    seen = 0
    while seen < written.size:
        now = native.taken(counter)
        for i in range(seen, now):
            wrong[0] += written[i] != i + 1
        seen = now


@compiled
def double(address, count, like):
    numbers = native.numbers_at(address, count, like)
    for i in range(numbers.size):
        numbers[i] *= 2


def test_a_function_is_called_with_its_three_addresses():
    seen = []
    kind = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)
    callback = kind(lambda *addresses: seen.append(addresses))
    call(ctypes.cast(callback, ctypes.c_void_p).value, 11, 22, 33)
    assert seen == [(11, 22, 33)]


def test_threads_take_each_number_once():
    """A counter that is not atomic loses some of 2^20 numbers between four threads."""
    end = 2**20 if hasattr(take_all, "py_func") else 2**12
    counter, taken = np.zeros(1, np.int64), np.zeros(end, np.int64)
    take_all(np.zeros(1, np.int64), 0, taken)
    threads = [threading.Thread(target=take_all, args=(counter, end, taken)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.all(taken == 1)


def test_who_sees_a_number_taken_sees_what_was_written_before():
    """A thread writes and counts; another reads as far as the count goes."""
    count = 2**20 if hasattr(write_all, "py_func") else 2**10
    written, counter, wrong = (np.zeros(size, np.int64) for size in (count, 1, 1))
    write_all(written[:0], counter)
    read_all(written[:0], counter, wrong)
    thread = threading.Thread(target=write_all, args=(written, counter))
    thread.start()
    read_all(written, counter, wrong)
    thread.join()
    assert native.taken(counter) == count
    assert wrong[0] == 0


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_numbers_at_an_address_are_those_of_the_array(dtype):
    numbers = np.arange(20, dtype=dtype)
    double(numbers.ctypes.data + 3 * numbers.itemsize, 5, np.empty(0, dtype))
    expected = np.arange(20, dtype=dtype)
    expected[3:8] *= 2
    assert np.array_equal(numbers, expected)
