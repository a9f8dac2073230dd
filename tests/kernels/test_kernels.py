"""Compiled loops against their NumPy twins, and the phases at any time."""

import mpmath
import numpy as np
import pytest

from fftocean.kernels import evolve, surface

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(11)
SHAPE = (6, 5)


def complex_noise():
    return RNG.standard_normal(SHAPE) + 1j * RNG.standard_normal(SHAPE)


def test_evolve_and_its_rate():
    forward, backward, turns, omega = complex_noise(), complex_noise(), RNG.uniform(-0.5, 0.5, SHAPE), RNG.uniform(0.1, 9.0, SHAPE)
    phase = np.exp(-2j * np.pi * turns)
    out = np.empty(SHAPE, dtype=complex)
    evolve.evolve(forward, backward, turns, out)
    assert np.max(np.abs(out - (forward * phase + backward * np.conj(phase)))) < 1e-14  # a handful of roundings of values near 3
    evolve.evolve_rate(forward, backward, turns, omega, out)
    assert np.max(np.abs(out - (-1j * omega * (forward * phase - backward * np.conj(phase))))) < 1e-13
    single = np.empty(SHAPE, dtype=np.complex64)
    evolve.evolve(forward, backward, turns, single)
    evolve.evolve(forward, backward, turns, out)
    assert np.array_equal(single, out.astype(np.complex64))  # cast once, at the end


def test_multiply_and_differentiate():
    spectrum, factor = complex_noise(), RNG.standard_normal(SHAPE)
    out = np.empty(SHAPE, dtype=complex)
    evolve.multiply(spectrum, factor, out)
    assert np.array_equal(out, spectrum * factor)
    along_x, along_y = RNG.standard_normal(SHAPE[1]), RNG.standard_normal(SHAPE[0])
    evolve.differentiate(spectrum, along_x, along_y, 1j, out)
    assert np.allclose(out, 1j * along_y[:, None] * along_x[None, :] * spectrum, rtol=1e-15)


@pytest.mark.parametrize("t", [0.0, 3.7, -1e6, 1e7, 123456789.123, 1e9, 1e12])
def test_turns_are_exact_at_any_time(t):
    """frac(omega t / 2 pi) against 60 digits: to the rounding of the fraction, and to that of omega / 2 pi in extended precision."""
    from fftocean.amplitudes import place_modes
    from fftocean.grid import Grid
    from fftocean.ocean import _turns_per_second

    amplitudes = place_modes([(1, 1, 1.0, 0.0)], Grid.of((8, 6), (30.0, 50.0)), depth=4.0)
    coarse, fine = _turns_per_second(amplitudes)
    scale = t * 134217729.0
    t_coarse = scale - (scale - t)
    out = np.empty(coarse.shape)
    evolve.turns_at(coarse, fine, t_coarse, t - t_coarse, out)
    with mpmath.workdps(60):
        for omega, turns in zip(amplitudes.omega.ravel(), out.ravel(), strict=True):
            exact = mpmath.mpf(float(omega)) * mpmath.mpf(t) / (2 * mpmath.pi)
            apart = abs(mpmath.mpf(float(turns)) - exact)
            assert abs(apart - mpmath.nint(apart)) < 1e-15 + omega * abs(t) * float(np.finfo(np.longdouble).eps)


def test_turns_in_a_loop_are_whole_numbers():
    cycles = np.array([[1, 7, 10**6, 10**9 + 7]])
    out = np.empty(cycles.shape)
    evolve.turns_in_loop(cycles, 5, 48, out)
    assert np.array_equal(out[0], [(int(c) * 5 % 48) / 48 for c in cycles[0]])


def test_geometry_against_numpy():
    sx, sy, xx, xy, yy = (RNG.standard_normal(SHAPE) * 0.4 for _ in range(5))
    c = 1.3
    tangent_x = np.stack([1 + c * xx, c * xy, sx], axis=-1)
    tangent_y = np.stack([c * xy, 1 + c * yy, sy], axis=-1)
    cross = np.cross(tangent_x, tangent_y)
    normal = np.empty((*SHAPE, 3))
    surface.normals(sx, sy, xx, xy, yy, c, normal)
    assert np.max(np.abs(normal - cross / np.linalg.norm(cross, axis=-1, keepdims=True))) < 1e-14
    out = np.empty(SHAPE)
    surface.jacobian(xx, xy, yy, c, out)
    assert np.max(np.abs(out - cross[..., 2])) < 1e-15
    surface.minimum_eigenvalue(xx, xy, yy, c, out)
    matrices = np.stack([np.stack([1 + c * xx, c * xy], -1), np.stack([c * xy, 1 + c * yy], -1)], -2)
    assert np.max(np.abs(out - np.linalg.eigvalsh(matrices)[..., 0])) < 1e-14


def test_where_both_tangents_vanish_the_normal_is_up():
    zero, minus = np.zeros((1, 1)), -np.ones((1, 1))
    normal = np.empty((1, 1, 3))
    surface.normals(zero, zero, minus, zero, minus, 1.0, normal)
    assert np.array_equal(normal[0, 0], [0.0, 0.0, 1.0])
