"""Compiled loops against their NumPy twins, and the phases at any time."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

from fftocean.amplitudes import place_modes
from fftocean.grid import Grid
from fftocean.kernels import passes, surface
from fftocean.synthesis import _frequencies

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(11)
ROWS, N = 6, 5


def complex_rows(rows=ROWS, n=N):
    return RNG.standard_normal((rows, n)) + 1j * RNG.standard_normal((rows, n))


def parts(array):
    """The interleaved real parts, as the kernels take them; a view."""
    return array.view(array.real.dtype)


def test_phasors():
    """
    Against extended precision at 100,001 turns from -1/2 to 1/2: 6 eps, as 1 - 2 sin^2 of half the
    angle allows.
    """
    turns = np.linspace(-0.5, 0.5, 100_001)[None, :]
    cosine, sine = np.empty((2, *turns.shape))
    passes.phasors(turns, cosine, sine)
    angle = 2 * np.longdouble("3.14159265358979323846264338328") * turns.astype(np.longdouble)
    assert np.max(np.abs(cosine - np.cos(angle))) < 6 * 2.3e-16
    assert np.max(np.abs(sine - np.sin(angle))) < 6 * 2.3e-16
    assert np.max(np.abs(cosine**2 + sine**2 - 1.0)) < 12 * 2.3e-16


def test_phasors_in_single_precision():
    """
    1 - 2 sin^2 has four times the sine's rounding, eps, and two of its own: 6 eps, where the
    processor does not fuse them.
    """
    turns = np.linspace(-0.5, 0.5, 100_001)[None, :]
    cosine, sine = np.empty((2, *turns.shape), dtype=np.float32)
    passes.phasors_single(turns, cosine, sine)
    assert np.max(np.abs(cosine - np.cos(2 * np.pi * turns))) < 6 * 1.2e-7
    assert np.max(np.abs(sine - np.sin(2 * np.pi * turns))) < 6 * 1.2e-7


def waves_of(forward, backward, dtype):
    """Return the table that `passes.heights` takes."""
    sums = (
        forward.real + backward.real,
        forward.imag - backward.imag,
        forward.imag + backward.imag,
        forward.real - backward.real,
    )
    return np.concatenate(sums, axis=1).astype(dtype)


@pytest.mark.parametrize(("dtype", "eps"), [(np.float64, 2.2e-16), (np.float32, 1.2e-7)])
def test_waves_and_rates(dtype, eps):
    forward, backward, angle, omega = (
        complex_rows(),
        complex_rows(),
        RNG.uniform(-3, 3, (ROWS, N)),
        RNG.uniform(0.1, 9.0, (ROWS, N)),
    )
    phase = np.exp(-1j * angle)
    real, imag = np.empty((2, ROWS, N), dtype=dtype)
    arguments = (
        waves_of(forward, backward, dtype),
        np.cos(angle).astype(dtype),
        np.sin(angle).astype(dtype),
    )
    passes.heights(*arguments, real, imag)
    assert (
        np.max(np.abs(real + 1j * imag - (forward * phase + backward * np.conj(phase))))
        < 10 * 6 * eps
    )  # ten roundings of values to 6
    passes.height_rates(*arguments, omega.astype(dtype), real, imag)
    assert (
        np.max(
            np.abs(real + 1j * imag - (-1j * omega * (forward * phase - backward * np.conj(phase))))
        )
        < 10 * 54 * eps
    )


@pytest.mark.parametrize("signs", [(1, 1), (-1, 1), (-1, -1), (1, -1)])
def test_scaled_derive_and_mix(signs):
    one, two, factor, power, other = (
        complex_rows(),
        complex_rows(),
        RNG.standard_normal((ROWS, N)),
        *RNG.standard_normal((2, N)),
    )
    first, second = signs
    out = np.empty((ROWS, N))
    passes.scaled(one.real.copy(), factor, out)
    assert np.array_equal(out, one.real * factor)
    mixed = np.empty((ROWS, N), dtype=complex)
    halves = [part.copy() for part in (one.real, one.imag)]
    passes.derive(*halves, power, float(first), float(second), ROWS, parts(mixed))
    assert np.array_equal(mixed, first * power * one.real + 1j * second * power * one.imag)
    passes.mix(
        *halves,
        power,
        two.real.copy(),
        two.imag.copy(),
        other,
        float(first),
        float(second),
        ROWS,
        parts(mixed),
    )
    real, imag = power * one.real + other * two.real, power * one.imag + other * two.imag
    assert np.allclose(
        mixed, first * real + 1j * second * imag, rtol=0, atol=1e-14
    )  # the compiler may fuse a multiply and an add


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("ny", [1, 7, 8, 19])
def test_tile(ny, dtype):
    """Each number goes to its row, spectrum and column, and nothing else changes."""
    width, spectra, tiles, bands, stride = 16, 2, 3, -(-ny // 8), 2 * ny + 6
    results = RNG.standard_normal((spectra, width, stride)).astype(dtype)
    out = np.zeros((bands, tiles, spectra, 8, 8, 2), dtype=dtype)
    passes.tile(results.reshape(-1), 8, width, spectra, ny, 1, tiles, out.reshape(-1), False)
    pairs = results[:, 8:, : 2 * ny].reshape(spectra, 8, ny, 2)
    for y in range(ny):
        assert np.array_equal(out[y // 8, 1, :, y % 8], pairs[:, :, y])
        out[y // 8, 1, :, y % 8] = 0.0
    assert not np.any(out)


@pytest.mark.parametrize("nx", [1, 2, 7, 8, 15, 16, 33, 64])
def test_pack_and_split(nx):
    """
    Two half spectra go in as A + iB and A - iB; numpy's transform of the packed row has the two
    real fields as its parts.
    """
    columns = (nx + 1) // 2
    tiles = -(-columns // 8)
    a, b = np.zeros((2, columns), dtype=complex)
    for field in (a, b):
        field[1:] = RNG.standard_normal(columns - 1) + 1j * RNG.standard_normal(columns - 1)
    k = 0.7 * np.arange(columns)
    # the row is number 3 of its tiles; numbers beyond the columns are never used
    between = np.full((tiles, 3, 8, 8), np.nan, dtype=complex)
    for s, half in enumerate((a + 1j * b, a - 1j * b, a)):
        row = np.full(8 * tiles, 1e3 - 1e3j)
        row[:columns] = half
        between[:, s, 3] = row.reshape(tiles, 8)
    padded = np.zeros(nx // 2 + 1, dtype=complex)
    packed = np.zeros(2 * nx + 1, dtype=complex)  # two rows, and a place for -0
    first, second = np.empty((2, nx))

    def laid_out(plus, minus):
        conjugated = np.repeat(minus, 2)[::-1].copy()
        conjugated[1::2] *= -1
        return np.repeat(plus, 2), conjugated

    def real_field(half):
        padded[:columns] = half
        return np.fft.irfft(padded, nx) * nx

    ones = np.ones(columns)
    for (plus, minus), factors, fields in (
        ((0, 1), laid_out(ones, ones), (real_field(a), real_field(b))),
        ((2, 2), laid_out(1 - 0.5 * k, 1 + 0.5 * k), (real_field(a), 0.5 * real_field(1j * k * a))),
    ):
        for r in range(2):
            start, o = 3 * 16, 2 * nx * r
            passes.pack(
                parts(between).reshape(-1), start, 3, plus, minus, *factors, parts(packed), o, nx
            )
        rows = packed[: 2 * nx].reshape(2, nx)
        assert np.array_equal(rows[0], rows[1])
        transformed = parts(np.fft.ifft(rows, axis=-1) * nx).reshape(-1)
        passes.split_row(transformed, 2 * nx, 4.0, first, second, False, False)
        assert np.max(np.abs(first - fields[0])) < 1e-13 * nx
        assert np.max(np.abs(second - 4.0 * fields[1])) < 1e-13 * nx
        alone = np.empty((2, nx))
        passes.real_part(transformed, 2 * nx, alone[0])
        passes.imaginary_part(transformed, 2 * nx, 4.0, alone[1])
        assert np.array_equal(alone, [first, second])


@pytest.mark.parametrize(
    ("kind", "count", "most"),
    [(1, 1, 50), (1, 24, 50), (1, 2**26, 50), (2, 24, 63), (2, 2**32 - 5, 63), (2, 2**32, 63)],
)
def test_phases_of_a_loop_lie_within_half_a_cycle(kind, count, most):
    """cycles step / count less the nearest whole number, by fractions; to the last division."""
    cycles = np.array([[0.0, 1.0, 2.0, 3.0, *np.floor(2.0 ** RNG.uniform(1, most, 50))]])
    out = np.empty_like(cycles)
    for step in {0, 1, count // 2, count // 3, count - 1}:
        passes.phases(kind, float(step), float(count), cycles, out)
        assert np.max(np.abs(out)) <= 0.5
        for c, phase in zip(cycles[0], out[0], strict=True):
            whole = Fraction(int(c) * step, count)
            off = (whole - Fraction(phase) + Fraction(1, 2)) % 1 - Fraction(1, 2)
            assert abs(off) <= Fraction(1, 2**53)


@pytest.mark.parametrize("t", [0.0, 3.7, -1e6, 1e7, 123456789.123, 1e9, 1e12])
def test_turns_are_exact_at_any_time(t):
    """
    frac(f t) against 60 digits: to the rounding of the fraction, and of the last 26 bits' product
    with time.
    """
    amplitudes = place_modes([(1, 1, 1.0, 0.0)], Grid.of((8, 6), (30.0, 50.0)), depth=4.0)
    frequency = _frequencies(amplitudes, 4)
    out = np.empty(frequency.shape)
    passes.phases_at(frequency, t, out)
    assert np.max(np.abs(out)) <= 0.5
    with mpmath.workdps(60):
        for f, turns in zip(frequency.ravel(), out.ravel(), strict=True):
            exact = mpmath.mpf(float(f)) * mpmath.mpf(t)
            apart = abs(mpmath.mpf(float(turns)) - exact)
            assert abs(apart - mpmath.nint(apart)) < 1e-15 + 2.0**-27 * f * abs(t) * 2.2e-16


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("ny", [*range(1, 9), 33, 34, 64, 65, 100, 129, 150])
def test_what_depends_on_the_wavenumber_is_given_for_ky_from_0(ny, dtype):
    """By the frequencies of numpy's transforms: |ky|, and the row before and after stay."""
    k = np.abs(np.fft.fftfreq(ny, 1 / ny)).astype(dtype)
    out = np.full((3, ny), -1, dtype)
    passes.unfold(k[: ny // 2 + 1], out[1])
    assert np.array_equal(out[1], k)
    assert np.all(out[::2] == -1)


def test_frequencies_are_the_nearest_doubles():
    amplitudes = place_modes([(1, 1, 1.0, 0.0)], Grid.of((9, 6), (30.0, 50.0)), depth=4.0)
    frequency = _frequencies(amplitudes, 5)
    with mpmath.workdps(40):
        for omega, f in zip(amplitudes.omega[:4].T.ravel(), frequency.ravel(), strict=True):
            assert float(mpmath.mpf(float(omega)) / (2 * mpmath.pi)) == pytest.approx(
                f, rel=2.3e-16, abs=0.0
            )


@pytest.mark.parametrize(("step", "count"), [(0, 1), (5, 48), (47, 48), (30, 31), (999_999, 10**6)])
def test_turns_in_a_loop_are_whole_numbers(step, count):
    """(cycles step mod count) / count, up to whole turns, by Python's own integers."""
    cycles = np.array([[1.0, 7.0, 1e6, 1e9 + 7, 160_000_000_003.0]])
    out = np.empty(cycles.shape)
    passes.phases_in_loop(cycles, float(step), float(count), out)
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
    assert (
        np.max(np.abs(normal - cross / length) * length) < 20 * eps
    )  # ten operations on values up to 2, before the division
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
