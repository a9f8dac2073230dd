"""
Variance of cells: adaptive quadrature written out again, closed forms, and every width that the
limits allow.
"""

import itertools
import math

import numpy as np
import pytest
from scipy import integrate, optimize

import fftocean as fo
from fftocean import cells
from fftocean.amplitudes import cell_variance, seed_amplitudes
from fftocean.cells import Cells
from fftocean.grid import Grid
from fftocean.physics.spreading import TabulatedSpreading
from fftocean.statistics import outside_band, specified

JONSWAP = fo.JONSWAP.from_sea_state(hs=2.0, tp=8.0)
GRAVITY = 9.80665


def sea_of(spreading, direction=0.0, spectrum=JONSWAP):
    return fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction))


def bell_at(centre, width):
    """A narrow bell away from the system's own direction, named in `breaks`."""
    return fo.CustomSpreading(
        lambda _, theta, __: np.exp(-0.5 * ((theta - centre) / width) ** 2), breaks=[centre]
    )


def two_rows():
    """A measured spreading of two narrow sectors, in a table."""
    direction = np.array([-40.0, -20.5, -20.0, -19.5, 10.0, 30.0, 30.5, 31.0, 90.0, 180.0])
    row = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0])
    return TabulatedSpreading(
        frequency=[0.05, 0.5], direction=direction.tolist(), density=[row.tolist(), row.tolist()]
    )


NARROW = [
    fo.WrappedNormal(spread=0.1),
    fo.CosinePower(s=1e4),
    fo.CosinePower(s=1e6),
    fo.CosineN(n=1e6),
    fo.GodaSuzuki(s_max=1e6),
    fo.Blend(fo.WrappedNormal(spread=0.1), fo.CosineSquared(), weight=0.3),
    fo.Blend(fo.LongCrested(), fo.CosineSquared(), weight=0.3),
    fo.LongCrested(),
    fo.SwellElongation(fo.WrappedNormal(spread=0.1), xi=1.0),
    bell_at(1.1, 2e-3),
    two_rows(),
    fo.CosineN(n=0.0),
]


@pytest.mark.parametrize("spreading", NARROW)
@pytest.mark.parametrize(
    ("half_x", "half_y", "band"),
    [(3.0, 3.0, (0.0, math.inf)), (3.0, 1.0, (0.2, 2.0)), (0.05, 0.05, (0.0, math.inf))],
)
def test_inside_by_a_circle_and_the_rest(spreading, half_x, half_y, band):
    """Within the circle no direction is needed; panels resolve both integrals to 1e-6."""
    tile = Cells(sea_of(spreading, 75.0), 0.1, 0.1)
    assert tile._inside(half_x, half_y, band) == pytest.approx(
        tile.inside(half_x, half_y, band), abs=2e-5 * tile.specified
    )


def cumulated(omega, spectrum):
    """Variance below omega of a Pierson-Moskowitz sea, in closed form."""
    m0 = spectrum.alpha * GRAVITY**2 / (5.0 * spectrum.peak**4)
    return m0 * math.exp(-1.25 * (spectrum.peak / omega) ** 4) if omega > 0.0 else 0.0


def along_ray(spectrum, theta, mx, my, dkx, dky):
    """
    Variance of a Pierson-Moskowitz sea on the part of a ray from k = 0 that lies in a cell: deep
    water, omega^2 = g k.
    """
    low, high = 0.0, math.inf
    for m, dk, u in ((mx, dkx, math.cos(theta)), (my, dky, math.sin(theta))):
        if u == 0.0:
            if abs(m) >= 0.5:
                return 0.0
            continue
        ends = sorted([(m - 0.5) * dk / u, (m + 0.5) * dk / u])
        low, high = max(low, ends[0]), min(high, ends[1])
    if not high > low:
        return 0.0
    return cumulated(math.sqrt(GRAVITY * high), spectrum) - cumulated(
        math.sqrt(GRAVITY * low), spectrum
    )


PM = fo.PiersonMoskowitz.from_sea_state(hs=2.0, tp=8.0)


@pytest.mark.parametrize("direction", [0.0, 17.0, 45.0, 133.0, 180.0, -90.0])
def test_long_crested_cells_hold_the_energy_of_the_ray(direction):
    """
    The closed form of a Pierson-Moskowitz sea between the points where the ray enters and leaves
    each cell.
    """
    dkx, dky = 2.0 * np.pi / 300.0, 2.0 * np.pi / 200.0
    mx, my = (a.ravel() for a in np.meshgrid(np.arange(-8, 9), np.arange(-8, 9)))
    waves = (mx != 0) | (my != 0)
    mx, my = mx[waves], my[waves]
    ours = cell_variance(sea_of(fo.LongCrested(), direction, PM), mx, my, dkx, dky)
    truth = [
        along_ray(PM, math.radians(direction), x, y, dkx, dky) for x, y in zip(mx, my, strict=True)
    ]
    assert ours == pytest.approx(truth, abs=1e-9 * PM.alpha * GRAVITY**2 / (5.0 * PM.peak**4))


@pytest.mark.parametrize("direction", [0.0, 33.0])
@pytest.mark.parametrize("sigma", [0.1, 1.0, 10.0])
def test_narrow_cells_against_adaptive_quadrature(sigma, direction):
    """
    A wound normal bell times the closed radial integral, by QUADPACK in theta, cut at corners and
    round the bell.
    """
    dkx, dky = 2.0 * np.pi / 600.0, 2.0 * np.pi / 50.0
    sea = sea_of(fo.WrappedNormal(spread=sigma), direction, PM)
    centre, width = math.radians(direction), math.radians(sigma)

    def bell(theta):
        return math.exp(-0.5 * ((theta - centre) / width) ** 2) / (width * math.sqrt(2.0 * math.pi))

    total = specified(sea).m0
    for mx, my in ((5, 0), (4, 1), (9, 1), (1, 1), (2, 0), (0, 1), (3, -1)):
        corners = [
            math.atan2((my + j) * dky, (mx + i) * dkx) for i in (-0.5, 0.5) for j in (-0.5, 0.5)
        ]
        cuts = sorted(
            {
                *corners,
                *(
                    centre + s * width
                    for s in range(-10, 11, 2)
                    if min(corners) < centre + s * width < max(corners)
                ),
            }
        )
        truth = sum(
            integrate.quad(
                lambda t, x=mx, y=my: bell(t) * along_ray(PM, t, x, y, dkx, dky),
                a,
                b,
                epsabs=1e-14 * total,
                epsrel=1e-9,
            )[0]
            for a, b in itertools.pairwise(cuts)
        )
        ours = cell_variance(sea, np.array([mx]), np.array([my]), dkx, dky)[0]
        assert ours == pytest.approx(truth, abs=1e-6 * total), (mx, my)  # 8 points a panel


@pytest.mark.parametrize("spreading", NARROW, ids=lambda s: repr(s)[:40])
@pytest.mark.parametrize(
    ("n", "size"), [((64, 4), (600.0, 50.0)), (48, 400.0), ((9, 64), (20.0, 900.0))], ids=str
)
def test_held_and_lost_are_what_was_specified(spreading, n, size):
    """However narrow, in whatever direction; 1e-5: panels that eight points resolve to 1e-6."""
    for direction in (0.0, 33.0):
        sea = sea_of(spreading, direction)
        grid = Grid.of(n, size)
        held = seed_amplitudes(sea, grid).variance
        below, above = outside_band(sea, grid)
        assert held + below + above == pytest.approx(sea.variance, rel=1e-5)
        if spreading == fo.WrappedNormal(spread=0.1) and not direction:
            # the bell is as good as a ray: what lies on the tile's ray, by QUADPACK
            reach = [(0.5 + m) * 2.0 * np.pi / grid.lx for m in (0, grid.reach[0])]
            low, high = (math.sqrt(GRAVITY * k) for k in reach)
            assert held == pytest.approx(fo.moments.moment(JONSWAP, 0, low, high), rel=1e-5)


@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-5])
def test_a_spectral_line_keeps_its_energy(width):
    """A normal bell in omega, of variance 1, across cells of the whole circle."""
    line = fo.CustomSpectrum(
        lambda w: np.exp(-0.5 * ((w - 0.8) / width) ** 2) / (width * math.sqrt(2.0 * math.pi)),
        peak=0.8,
    )
    held = seed_amplitudes(sea_of(fo.CosineSquared(), 20.0, line), Grid.of(48, 400.0)).variance
    assert held == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize(
    "spreading",
    [
        fo.LongCrested(),
        fo.WrappedNormal(spread=0.1),
        two_rows(),
        fo.CosineN(n=0.0),
        fo.SwellElongation(xi=0.4),
        fo.CustomSpreading(
            lambda omega, theta, peak: np.exp(np.cos(theta - 0.4) * np.minimum(peak / omega, 9.0))
        ),
    ],
    ids=lambda s: repr(s)[:20],
)
def test_cells_do_not_depend_on_the_grid_or_the_band(spreading):
    """To the bit."""
    sea = sea_of(spreading, 20.0)
    coarse = seed_amplitudes(sea, Grid.of(24, (300.0, 120.0)), seed=5)
    rows, columns = np.nonzero(coarse.grid.active)
    my = coarse.grid.my[rows]
    k = coarse.grid.k[rows, columns]
    within = (k > 0.1) & (k < 0.3)  # cells that the edges do not cut
    for n, band in ((48, (0.0, math.inf)), ((25, 90), (0.0, math.inf)), (31, (0.03, 0.5))):
        fine = seed_amplitudes(sea, Grid.of(n, (300.0, 120.0)), seed=5, band=band)
        some = within if band[0] else slice(None)
        assert np.array_equal(fine.forward[my, columns][some], coarse.forward[rows, columns][some])
        assert np.array_equal(
            fine.backward[my, columns][some], coarse.backward[rows, columns][some]
        )


@pytest.mark.parametrize(
    "spreading",
    [fo.LongCrested(), fo.WrappedNormal(spread=0.1), fo.CosineSquared()],
    ids=lambda s: repr(s)[:20],
)
def test_bands_of_narrow_seas_share_out_their_cells(spreading):
    """Bands that adjoin hold the whole, each what the continuous sea has there."""
    sea, grid, cuts = sea_of(spreading, 33.0), Grid.of(40, (300.0, 120.0)), (0.06, 0.09, 0.2)
    bands = list(itertools.pairwise((0.0, *cuts, math.inf)))
    parts = [seed_amplitudes(sea, grid, band=band).variance for band in bands]
    assert sum(parts) == pytest.approx(seed_amplitudes(sea, grid).variance, rel=1e-12)
    low, high = math.sqrt(GRAVITY * cuts[0]), math.sqrt(GRAVITY * cuts[1])
    assert parts[1] == pytest.approx(
        fo.moments.moment(JONSWAP, 0, low, high), rel=1e-5
    )  # a ring that lies in the tile's rectangle


def test_a_spreading_that_does_not_integrate_to_1_is_refused():
    class Tenth:
        def __call__(self, omega, theta, _peak):
            return 0.1 + 0.0 * (np.asarray(omega) + np.asarray(theta))

    with pytest.raises(fo.ParameterError, match=r"must integrate to 1 .* got 0.628"):
        fo.Ocean(sea_of(Tenth()), n=16, size=200.0)


def test_lost_energy_is_refused_with_its_numbers(monkeypatch):
    variances = Cells.variances
    monkeypatch.setattr(Cells, "variances", lambda *a: 0.998 * variances(*a))
    with pytest.raises(
        fo.ParameterError, match=r"0\.24\d+ m\^2 of 0\.25\d* m\^2, within 0\.001, got 0\.24"
    ):
        fo.Ocean(sea_of(fo.CosineSquared()), n=64, size=400.0)


def test_a_spectrum_without_end_is_no_error():
    """White noise has infinite variance; a tile holds its part."""
    flat = fo.CustomSpectrum(lambda w: 0.0 * w + 1.0, peak=1.0)
    assert (
        seed_amplitudes(sea_of(fo.CosinePower(s=0.0), 0.0, flat), Grid.of(16, 100.0)).variance > 0.0
    )


def test_measure_says_the_realised_spread():
    along = fo.measure(fo.Ocean(sea_of(fo.LongCrested(), 90.0), n=(16, 64), size=400.0))
    assert along.specified.spread == 0.0
    assert along.spread < 1e-4  # float32 fields
    assert along.mean_direction == pytest.approx(90.0, abs=1e-4)
    oblique = fo.measure(fo.Ocean(sea_of(fo.LongCrested(), 30.0), n=64, size=500.0))
    assert 0.5 < oblique.spread < 6.0
    assert oblique.mean_direction == pytest.approx(30.0, abs=3.0)


@pytest.mark.parametrize(
    ("spreading", "spread"),
    [
        (fo.WrappedNormal(spread=0.1), 0.1),
        (
            fo.WrappedNormal(spread=2.0),
            math.degrees(math.sqrt(2.0 * (1.0 - math.exp(-0.5 * math.radians(2.0) ** 2)))),
        ),
        (bell_at(1.1, math.radians(0.2)), 0.2),
    ],
    ids=["0.1", "2", "beside"],
)
def test_the_specified_spread_of_narrow_seas(spreading, spread):
    """Closed form (Kuik et al. 1988); a grid of half a degree sees none of them."""
    state = specified(sea_of(spreading))
    assert state.spread == pytest.approx(spread, rel=1e-5)
    assert state.m0 == pytest.approx(0.25, rel=1e-9)


def test_long_crested_in_a_job_and_as_a_value():
    job = fo.Job.from_toml(
        "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 1.0, tp = 7.0 }\n"
        "spreading = { kind = 'long-crested' }"
    )
    assert job.sea().systems[0].spreading == fo.LongCrested()
    total = integrate.quad(
        lambda t: float(fo.LongCrested()(1.0, t, 1.0)), -0.1, 0.1, points=[0.0], epsabs=1e-12
    )[0]
    assert total == pytest.approx(1.0, rel=1e-9)


def test_the_proof_passes_on_long_crested_seas():
    from fftocean.proof import verify

    assert all(
        check.passed
        for check in verify(fo.Ocean(sea_of(fo.LongCrested(), 20.0), n=32, size=300.0, loop=40.0))
    )


def test_a_band_of_ripples_is_where_the_surface_tension_puts_it():
    """
    Ripples of 20 to 22 Hz, with jumps at both ends, in water with surface tension: all their
    energy lies between the wavenumbers that the dispersion relation gives, solved by bisection.
    """
    edges = 2.0 * np.pi * np.array([20.0, 22.0])
    box = fo.TabulatedSpectrum([20.0, 22.0], [1e-9, 1e-9], tail=None)
    tension = 0.074
    system = fo.WaveSystem(spectrum=box, spreading=fo.CosinePower(s=2.0))
    sea = fo.Sea(system, surface_tension=tension)

    def misfit(k, omega):
        return 9.80665 * k + tension / 1025.0 * k**3 - omega**2

    low, high = (optimize.brentq(misfit, 1.0, 1e4, args=(omega,)) for omega in edges)
    ocean = fo.Ocean(sea, n=128, size=0.25)
    assert ocean.amplitudes.variance == pytest.approx(2e-9, rel=1e-3)
    k = ocean.grid.k[ocean.amplitudes.variance_forward > 0.0]
    half = 0.5 * math.hypot(ocean.grid.dkx, ocean.grid.dky)
    assert low - half < np.min(k) < np.max(k) < high + half


def test_cells_are_covered_without_remainder():
    """Flat density: every cell has its area, from the axes to the corners, however long."""
    flat = fo.CustomSpectrum(lambda w: 2.0 * w**3 / GRAVITY**2, peak=1.0)  # S d omega = k dk
    sea = sea_of(fo.CosinePower(s=0.0), 0.0, flat)
    mx, my = (a.ravel() for a in np.meshgrid(np.arange(-6, 7), np.arange(-6, 7)))
    waves = (mx != 0) | (my != 0)
    for dkx, dky in ((0.1, 0.1), (0.01, 0.3), (2.0, 0.001)):
        area = cell_variance(sea, mx[waves], my[waves], dkx, dky) * 2.0 * np.pi
        assert area == pytest.approx(np.full(area.size, dkx * dky), rel=1e-4)


def test_blocks_of_cells_hold_the_same_bits(monkeypatch):
    """However many are made at a time."""
    sea = sea_of(two_rows(), 10.0)
    mx, my = (a.ravel() for a in np.meshgrid(np.arange(-9, 10), np.arange(1, 12)))
    whole = cell_variance(sea, mx, my, 0.02, 0.03)
    for name, value in (("_CELLS", 7), ("_RAYS", 100), ("_BLOCK", 640)):
        monkeypatch.setattr(cells, name, value)
    assert np.array_equal(cell_variance(sea, mx, my, 0.02, 0.03), whole)
