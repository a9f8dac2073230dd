"""Compiled loops against their NumPy twins, and the phases at any time."""

import mpmath
import numpy as np
import pytest

from fftocean.amplitudes import place_modes
from fftocean.grid import Grid
from fftocean.kernels import passes, surface
from fftocean.ocean import _turns_per_second

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(11)
ROWS, N = 6, 5


def complex_rows(rows=ROWS, n=N):
    return RNG.standard_normal((rows, n)) + 1j * RNG.standard_normal((rows, n))


def parts(array):
    """The interleaved real parts, as the kernels take them; a view."""
    return array.view(array.real.dtype)


def test_phasors():
    """Against extended precision at 100,001 turns from -1/2 to 1/2: 6 eps, as 1 - 2 sin^2 of half the angle allows."""
    turns = np.linspace(-0.5, 0.5, 100_001)[None, :]
    cosine, sine = np.empty((2, *turns.shape))
    passes.phasors(turns, cosine, sine)
    angle = 2 * np.longdouble("3.14159265358979323846264338328") * turns.astype(np.longdouble)
    assert np.max(np.abs(cosine - np.cos(angle))) < 6 * 2.3e-16
    assert np.max(np.abs(sine - np.sin(angle))) < 6 * 2.3e-16
    assert np.max(np.abs(cosine**2 + sine**2 - 1.0)) < 12 * 2.3e-16


def test_heights_and_rates():
    forward, backward, angle, omega = complex_rows(), complex_rows(), RNG.uniform(-3, 3, (ROWS, N)), RNG.uniform(0.1, 9.0, (ROWS, N))
    phase = np.exp(-1j * angle)
    out = np.empty((ROWS, N), dtype=complex)
    arguments = parts(forward), parts(backward), np.cos(angle), np.sin(angle)
    passes.heights(*arguments, parts(out))
    assert np.max(np.abs(out - (forward * phase + backward * np.conj(phase)))) < 1e-14  # a handful of roundings of values near 3
    single = np.empty((ROWS, N), dtype=np.complex64)
    passes.heights(*arguments, parts(single))
    assert np.array_equal(single, out.astype(np.complex64))  # cast once, at the end
    passes.rates(*arguments, omega, parts(out))
    assert np.max(np.abs(out - (-1j * omega * (forward * phase - backward * np.conj(phase))))) < 1e-13


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_scale_and_derive(order):
    spectrum, factor, power = complex_rows(), RNG.standard_normal((ROWS, N)), RNG.standard_normal(N)
    out = np.empty((ROWS, N), dtype=complex)
    passes.scale(parts(spectrum), factor, parts(out))
    assert np.array_equal(out, spectrum * factor)
    unit = 1j**order
    passes.derive(parts(spectrum), power, unit.real, unit.imag, ROWS, parts(out))
    assert np.allclose(out, unit * power * spectrum, rtol=1e-15)


def test_transpose():
    block = (RNG.standard_normal((3, 4, 19)) + 1j).astype(complex)
    out = np.zeros((19, 3, 10), dtype=complex)
    passes.transpose(block, 5, 4, out)
    assert np.array_equal(out[:, :, 5:9], block.transpose(2, 0, 1))
    assert not np.any(out[:, :, :5])
    assert not np.any(out[:, :, 9:])


@pytest.mark.parametrize("nx", [1, 2, 7, 8])
def test_pack_and_split(nx):
    """Two half spectra go in, derived along x; numpy's transform of the packed row has the two real fields as its parts."""
    half = nx // 2 + 1
    columns = np.zeros((3, 2, half), dtype=complex)
    active = slice(1, (nx - 1) // 2 + 1)  # k = 0 and Nyquist carry nothing
    columns[:, :, active] = RNG.standard_normal(columns[:, :, active].shape) + 1j * RNG.standard_normal(columns[:, :, active].shape)
    kx = np.arange(half) * 0.7
    powers = np.stack([np.ones((2, half)), np.stack([kx, kx**2])])  # first fields as they are, second fields d/dx and d2/dx2
    units = np.array([[[1.0, 0.0], [1.0, 0.0]], [[0.0, 1.0], [-1.0, 0.0]]])
    sources = np.array([[0, 1], [1, 0]])
    packed = np.zeros((2, 2, nx), dtype=complex)
    passes.pack(parts(columns), 1, 2, sources, powers, units, parts(packed))
    fields = np.fft.ifft(packed, axis=-1) * nx
    first, second = np.empty((2, 2, nx))
    for p, (a, b) in enumerate([(columns[1:, 0], 1j * kx * columns[1:, 1]), (columns[1:, 1], -(kx**2) * columns[1:, 0])]):
        passes.split(parts(fields), p, 2, 0.25, first, second)
        assert np.max(np.abs(first - np.fft.irfft(a, nx) * nx)) < 1e-14
        assert np.max(np.abs(0.25 * second - np.fft.irfft(b, nx) * nx)) < 1e-13
        passes.split_one(parts(fields), p, 2, second)
        assert np.array_equal(first, second)


@pytest.mark.parametrize("t", [0.0, 3.7, -1e6, 1e7, 123456789.123, 1e9, 1e12])
def test_turns_are_exact_at_any_time(t):
    """frac(omega t / 2 pi) against 60 digits: to the rounding of the fraction, and to that of omega / 2 pi in extended precision."""
    amplitudes = place_modes([(1, 1, 1.0, 0.0)], Grid.of((8, 6), (30.0, 50.0)), depth=4.0)
    coarse, fine = _turns_per_second(amplitudes)
    scale = t * 134217729.0
    t_coarse = scale - (scale - t)
    out = np.empty(coarse.shape)
    passes.turns_at(coarse, fine, t_coarse, t - t_coarse, out)
    assert np.max(np.abs(out)) <= 0.5
    with mpmath.workdps(60):
        for omega, turns in zip(amplitudes.omega.T.ravel(), out.ravel(), strict=True):
            exact = mpmath.mpf(float(omega)) * mpmath.mpf(t) / (2 * mpmath.pi)
            apart = abs(mpmath.mpf(float(turns)) - exact)
            assert abs(apart - mpmath.nint(apart)) < 1e-15 + omega * abs(t) * float(np.finfo(np.longdouble).eps)


@pytest.mark.parametrize(("step", "count"), [(0, 1), (5, 48), (47, 48), (30, 31), (999_999, 10**6)])
def test_turns_in_a_loop_are_whole_numbers(step, count):
    """(cycles step mod count) / count, up to whole turns, by Python's own integers."""
    cycles = np.array([[1.0, 7.0, 1e6, 1e9 + 7, 1.6e11]])
    out = np.empty(cycles.shape)
    passes.turns_in_loop(cycles, float(step), float(count), out)
    for c, turns in zip(cycles[0], out[0], strict=True):
        exact = int(c) * step % count
        assert round(turns * count) % count == exact
        assert turns * count == pytest.approx(round(turns * count), abs=1e-9)
    assert np.max(np.abs(out)) <= 0.5


@pytest.mark.parametrize(("dtype", "eps"), [(np.float64, 2.2e-16), (np.float32, 1.2e-7)])
def test_geometry_against_numpy(dtype, eps):
    sx, sy, xx, xy, yy = ((RNG.standard_normal((ROWS, N)) * 0.4).astype(dtype) for _ in range(5))
    c = dtype(1.3)
    tangent_x = np.stack([1 + c * xx, c * xy, sx], axis=-1).astype(float)
    tangent_y = np.stack([c * xy, 1 + c * yy, sy], axis=-1).astype(float)
    cross = np.cross(tangent_x, tangent_y)
    normal = np.empty((ROWS, N, 3), dtype=dtype)
    surface.normals(sx, sy, xx, xy, yy, c, normal)
    length = np.linalg.norm(cross, axis=-1, keepdims=True)
    assert np.max(np.abs(normal - cross / length) * length) < 20 * eps  # ten operations on values up to 2, before the division
    out = np.empty((ROWS, N), dtype=dtype)
    surface.jacobian(xx, xy, yy, c, out)
    assert np.max(np.abs(out - cross[..., 2])) < 10 * eps
    surface.minimum_eigenvalue(xx, xy, yy, c, out)
    matrices = np.stack([tangent_x[..., :2], tangent_y[..., :2]], -2)
    assert np.max(np.abs(out - np.linalg.eigvalsh(matrices)[..., 0])) < 20 * eps
    assert out.dtype == normal.dtype == dtype


def test_where_both_tangents_vanish_the_normal_is_up():
    zero, minus = np.zeros((1, 1)), -np.ones((1, 1))
    normal = np.empty((1, 1, 3))
    surface.normals(zero, zero, minus, zero, minus, 1.0, normal)
    assert np.array_equal(normal[0, 0], [0.0, 0.0, 1.0])
