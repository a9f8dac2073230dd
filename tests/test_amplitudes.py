"""Amplitudes h0(k): the specified energy in the right cells of any tile."""

import math

import numpy as np
import pytest
from scipy import integrate

import fftocean as fo
from fftocean import noise
from fftocean.amplitudes import cell_variance, place_modes, seed_amplitudes
from fftocean.grid import Grid
from fftocean.statistics import outside_band

pytestmark = pytest.mark.nojit

WIND_SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
SWELL = fo.Sea(
    fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=1.5, tp=14.0, gamma=7.0),
        spreading=fo.CosinePower(s=25.0),
        direction=110.0,
    ),
    depth=30.0,
)


def expected_density(sea, kx, ky):
    """
    S(omega) D(theta) (d omega/dk)/k, with a central difference for d omega/dk, written out again.
    """
    k, theta = math.hypot(kx, ky), math.atan2(ky, kx)

    def omega(k):
        tanh = math.tanh(k * sea.depth) if math.isfinite(sea.depth) else 1.0
        return math.sqrt((9.80665 * k + sea.surface_tension / 1025.0 * k**3) * tanh)

    slope = (omega(k * 1.0001) - omega(k * 0.9999)) / (2e-4 * k)
    return float(sea.density(omega(k), theta)) * slope / k


@pytest.mark.parametrize("sea", [WIND_SEA, SWELL], ids=["wind", "swell"])
@pytest.mark.parametrize(("mx", "my"), [(1, 0), (2, 1), (-1, 3), (5, 4), (30, 10)])
@pytest.mark.slow
def test_cell_variance_is_the_integral_over_the_cell(sea, mx, my):
    """
    Against adaptive quadrature of the density written out by hand: Gauss points in cells or along
    rays, 1e-3 of a cell.
    """
    dk = 2.0 * np.pi / 400.0
    truth = integrate.dblquad(
        lambda y, x: expected_density(sea, x, y),
        (mx - 0.5) * dk,
        (mx + 0.5) * dk,
        (my - 0.5) * dk,
        (my + 0.5) * dk,
        epsrel=1e-6,
    )[0]
    ours = cell_variance(sea, np.array([mx]), np.array([my]), dk, dk)[0]
    assert ours == pytest.approx(truth, rel=1e-3, abs=1e-6 * sea.variance)


@pytest.mark.parametrize(("mx", "my"), [(3, 2), (-9, 4), (20, 5), (0, 25)])
def test_cells_of_ripples_on_an_oblong_tile(mx, my):
    """
    Waves of 10 cm to 8 mm, whose group velocity the surface tension doubles: Gauss points over the
    cell, of the density written out by hand; central differences there have 1e-8.
    """
    sea = fo.Sea(fo.WaveSystem(spectrum=fo.Elfouhaily(speed=8.0), direction=30.0))
    dkx, dky = 2.0 * np.pi / 0.3, 2.0 * np.pi / 0.2
    nodes, weights = np.polynomial.legendre.leggauss(8)
    truth = sum(
        0.25 * dkx * dky * a * b * expected_density(sea, (mx + 0.5 * x) * dkx, (my + 0.5 * y) * dky)
        for x, a in zip(nodes, weights, strict=True)
        for y, b in zip(nodes, weights, strict=True)
    )
    ours = cell_variance(sea, np.array([mx]), np.array([my]), dkx, dky)[0]
    assert ours == pytest.approx(truth, rel=1e-3, abs=0.0)


@pytest.mark.parametrize("sea", [WIND_SEA, SWELL], ids=["wind", "swell"])
@pytest.mark.parametrize(
    ("n", "size"),
    [(64, 200.0), (64, 1000.0), ((128, 64), (400.0, 200.0)), (31, 150.0), (256, 60.0)],
)
def test_a_tile_keeps_the_energy_of_its_band(sea, n, size):
    """Held + lost = ordered: the cells' sum against integrals along rays outside the band."""
    grid = Grid.of(n, size)
    held = seed_amplitudes(sea, grid).variance
    assert held + sum(outside_band(sea, grid)) == pytest.approx(
        sea.variance, rel=1e-5
    )  # panels: 1e-6 each


def test_finer_grids_keep_every_wave_to_the_bit():
    """
    n -> 2n at the same size, and from square to oblong: the same h0 wherever both have the wave.
    """
    coarse = seed_amplitudes(WIND_SEA, Grid.of(32, 200.0), seed=5)
    for n in (64, 33, (64, 48)):
        fine = seed_amplitudes(WIND_SEA, Grid.of(n, 200.0), seed=5)
        rows, columns = np.nonzero(coarse.grid.active)
        my = coarse.grid.my[rows]
        assert np.array_equal(fine.forward[my, columns], coarse.forward[rows, columns])
        assert np.array_equal(fine.backward[my, columns], coarse.backward[rows, columns])


@pytest.mark.parametrize(("n", "size"), [(64, 200.0), (31, 1000.0), ((48, 80), (200.0, 100.0))])
def test_fixed_amplitudes_hold_their_energy_in_every_draw(n, size):
    """
    Sum of a^2/2 over modes() = resolved m0, to 1e-9 as ordered (roundings of a sum of thousands:
    1e-13).
    """
    for seed in (0, 1, 2**64 - 1):
        amplitudes = seed_amplitudes(WIND_SEA, Grid.of(n, size), seed=seed, draw="fixed")
        assert 0.5 * np.sum(amplitudes.modes().amplitude ** 2) == pytest.approx(
            amplitudes.variance, rel=1e-12
        )


@pytest.mark.parametrize(
    ("n", "size"),
    [(64, 200.0), (64, 1000.0), (256, 200.0), (256, 1000.0), ((128, 64), (400.0, 200.0))],
)
@pytest.mark.slow
def test_mean_variance_over_seeds_is_m0(n, size):
    """
    E[var height]/m0 over 64 seeds within four standard errors of 1; m0 is what an independent polar
    integral leaves in the band.
    """
    grid = Grid.of(n, size)
    expected = seed_amplitudes(WIND_SEA, grid)
    m0 = WIND_SEA.variance - sum(outside_band(WIND_SEA, grid))
    cells = np.sqrt(expected.variance_forward), np.sqrt(expected.variance_backward)
    rows, columns = np.nonzero(grid.active)
    mx, my = grid.mx[columns], grid.my[rows]
    variances = []
    for seed in range(64):
        # seed_amplitudes without the sea's integrals, which do not depend on the seed
        f = 0.5 * cells[0][rows, columns] * noise.complex_normals(seed, mx, my)
        b = 0.5 * cells[1][rows, columns] * np.conj(noise.complex_normals(seed, -mx, -my))
        spectrum = np.zeros(grid.half_shape, dtype=complex)
        spectrum[rows, columns] = f + b
        if seed == 3:
            assert np.array_equal(
                spectrum, (a := seed_amplitudes(WIND_SEA, grid, seed=3)).forward + a.backward
            )
        variances.append(np.var(np.fft.irfft2(spectrum, s=grid.shape, norm="forward")))
    ratio = np.array(variances) / m0
    assert abs(np.mean(ratio) - 1.0) < 4.0 * np.std(ratio, ddof=1) / 8.0
    assert np.std(ratio) < 0.5  # else the line above cannot fail


@pytest.mark.slow
def test_the_literature_s_factor_of_eight_is_not_here():
    """
    h0 = sqrt(2 S dk dk)(xi_r + i xi_i), as often printed, has eight times the variance of 1/2 (xi_r
    + i xi_i) sqrt(S dk dk).
    """
    grid = Grid.of(32, 300.0)
    ours = np.mean(
        [
            np.sum(seed_amplitudes(WIND_SEA, grid, seed=seed).modes().amplitude ** 2) / 2.0
            for seed in range(40)
        ]
    )
    assert ours == pytest.approx(
        WIND_SEA.variance, rel=0.15
    )  # a tenth lies above the band; 40 draws scatter by 3 %
    mx, my = np.array([4]), np.array([2])
    printed = np.sqrt(
        2.0 * cell_variance(WIND_SEA, mx, my, grid.dkx, grid.dky)
    ) * noise.complex_normals(1, mx, my)
    assert abs(
        printed[0] / seed_amplitudes(WIND_SEA, grid, seed=1).forward[2, 4]
    ) ** 2 == pytest.approx(8.0, rel=1e-12)


def test_modes_rebuild_the_surface():
    a = seed_amplitudes(WIND_SEA, Grid.of((12, 10), (90.0, 70.0)), seed=2)
    m = a.modes()
    assert m.kx.size == 11 * 9 - 1
    assert m.kx.dtype == m.amplitude.dtype == np.float64
    x, y = 13.0, -4.0
    direct = np.sum(m.amplitude * np.cos(m.kx * x + m.ky * y - m.phase))
    total = 0.0
    for j, i in zip(*np.nonzero(a.grid.active), strict=True):
        h = a.forward[j, i] + a.backward[j, i]
        wave = (h * np.exp(1j * (a.grid.kx[i] * x + a.grid.ky[j] * y))).real
        total += wave if i == 0 else 2.0 * wave
    assert direct == pytest.approx(total, rel=1e-12)


@pytest.mark.parametrize(
    "wave",
    [
        (0, 0, 1.0, 0.0),
        (4, 0, 1.0, 0.0),
        (0, -4, 1.0, 0.0),
        (1.5, 0, 1.0, 0.0),
        (1, 0, math.nan, 0.0),
        (1, 0, 1.0, math.inf),
        (1, 0),
        "ab",
        3,
    ],
)
def test_waves_that_the_grid_cannot_hold_are_refused(wave):
    with pytest.raises(fo.ParameterError):
        place_modes([wave], Grid.of(8, 10.0), depth=math.inf)


def test_waves_on_one_wavenumber_add_up():
    grid = Grid.of(8, 10.0)
    two = place_modes(
        [(1, 2, 1.0, 0.3), (1, 2, 0.5, 0.3), (0, -2, 0.25, 1.0), (-3, 1, 2.0, 0.1)], grid, depth=5.0
    )
    m = two.modes()
    assert sorted(np.round(m.amplitude, 12)) == [0.25, 1.5, 2.0]


@pytest.mark.parametrize("draw", ["", "Gaussian", "given", "constrained", "normal", None, 1])
def test_a_draw_that_is_not_known_is_refused(draw):
    """Also those of amplitudes that were not drawn."""
    with pytest.raises(fo.ParameterError, match="must be 'gaussian' or 'fixed', got "):
        seed_amplitudes(fo.Sea(), Grid.of(8, 10.0), draw=draw)


def test_a_sea_that_is_not_a_number_is_refused():
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.CustomSpectrum(lambda w: np.where(w > 1.0, np.nan, 1.0), peak=0.5)
        )
    )
    with pytest.raises(fo.ParameterError, match="finite"):
        seed_amplitudes(sea, Grid.of(32, 100.0))
