"""
Random numbers as a function of (seed, mx, my), without a generator whose state has to advance.

A wave's random numbers depend on its own integer wavenumbers alone: a finer grid, another thread
count or another machine sees the same waves. The generator is Philox-4x32-10, a keyed bijection of
counters (Salmon, Moraes, Dror & Shaw 2011).
"""

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Complex, Integer, Real

Words = npt.NDArray[np.uint64]
_LOW = np.uint64(0xFFFFFFFF)
_HALF = np.uint64(32)
_ELEVEN = np.uint64(11)
_BLOCK = 2**14  # waves at a time: what stays in cache


def philox(
    counter: tuple[Words, Words, Words, Words], key: tuple[int, int]
) -> tuple[Words, Words, Words, Words]:
    """
    Return four random 32-bit words for each four-word counter, under a two-word key.

    Words are kept in uint64, below 2^32, so that products do not overflow.

    Source: Salmon et al., Parallel random numbers: as easy as 1, 2, 3 (2011).
    Pinned by tests/test_noise.py, against the authors' known answers.
    """
    c0, c1, c2, c3 = (word.copy() for word in counter)  # written again in each round
    p0, p1 = np.empty_like(c0), np.empty_like(c0)
    k0, k1 = key
    for _ in range(10):
        np.multiply(c0, np.uint64(0xD2511F53), out=p0)
        np.multiply(c2, np.uint64(0xCD9E8D57), out=p1)
        np.right_shift(p1, _HALF, out=c0)
        c0 ^= c1
        c0 ^= np.uint64(k0)
        np.right_shift(p0, _HALF, out=c2)
        c2 ^= c3
        c2 ^= np.uint64(k1)
        np.bitwise_and(p1, _LOW, out=c1)
        np.bitwise_and(p0, _LOW, out=c3)
        k0, k1 = (k0 + 0x9E3779B9) & 0xFFFFFFFF, (k1 + 0xBB67AE85) & 0xFFFFFFFF
    return c0, c1, c2, c3


def _uniforms(seed: int, mx: Integer, my: Integer) -> tuple[Real, Real]:
    """
    Return two independent uniforms for each wave: 53 bits each, the first in (0, 1], the second in
    [0, 1).
    """
    mx, my = np.broadcast_arrays(mx, my)
    first, second = np.empty(mx.shape), np.empty(mx.shape)
    waves = mx.ravel(), my.ravel()
    for start in range(0, mx.size, _BLOCK):
        block = slice(start, start + _BLOCK)
        x, y = (m[block].astype(np.uint64) & _LOW for m in waves)
        a, b, c, d = philox(
            (x, y, np.zeros_like(x), np.zeros_like(x)), (seed & 0xFFFFFFFF, seed >> 32)
        )
        first.reshape(-1)[block] = (
            (((a << _HALF) | b) >> _ELEVEN).astype(np.float64) + 1.0
        ) * 2.0**-53
        second.reshape(-1)[block] = (((c << _HALF) | d) >> _ELEVEN).astype(np.float64) * 2.0**-53
    return first, second


def complex_normals(seed: int, mx: Integer, my: Integer) -> Complex:
    """Return xi_r + i xi_i with independent unit normals, one for each wave (Box & Muller 1958)."""
    radius, cycles = _uniforms(seed, mx, my)
    result = _phasors(cycles)
    result *= np.sqrt(-2.0 * np.log(radius))
    return result


def unit_phasors(seed: int, mx: Integer, my: Integer) -> Complex:
    """
    Return e^{i phi} with phi uniform, one for each wave: the phase of `complex_normals`, its
    modulus fixed at 1.
    """
    return _phasors(_uniforms(seed, mx, my)[1])


def _phasors(cycles: Real) -> Complex:
    # a fifth of the time of a complex exponential, and of writing straight to every other number
    angle = 2.0 * np.pi * cycles
    result: Complex = np.empty(angle.shape, np.complex128)
    result.real, result.imag = np.cos(angle), np.sin(angle)
    return result
