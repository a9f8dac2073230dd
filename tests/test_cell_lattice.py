"""Cells on a polar lattice: adaptive quadrature, closed forms, and `cells` for many seas."""

import math

import numpy as np
import pytest
from scipy import integrate

import fftocean as fo
from fftocean.cascade import tile_jobs
from fftocean.cell_lattice import CellLattice
from fftocean.cells import QUADRANTS, Cells, parts_of_sea
from fftocean.grid import Grid
from fftocean.physics.spreading import TabulatedSpreading

GRAVITY = 9.80665
SWELL = fo.JONSWAP.from_sea_state(hs=2.0, tp=12.0, gamma=7.0)
WHOLE = (0.0, math.inf)


def sea_of(spreading, direction=75.0, spectrum=SWELL, depth=None):
    return fo.Sea(
        fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction), depth=depth
    )


def cell_of(tile, ax, ay):
    """Return the index of a cell."""
    return int(np.flatnonzero((tile.ax == ax) & (tile.ay == ay))[0])


@pytest.mark.parametrize(
    ("ax", "ay", "quadrant"), [(3, 0, 0), (0, 4, 0), (2, 3, 0), (5, 2, 1), (1, 6, 3), (7, 7, 2)]
)
def test_a_cell_is_the_integral_of_the_density(ax, ay, quadrant):
    """
    Against a double integral over kx and ky, with S, D and d omega/dk of deep water written out.

    The tolerance is the lattice's: rings of a cell, and an energy that is linear between rungs.
    """
    grid = Grid.of(32, 300.0)
    lattice = CellLattice([grid], [WHOLE])
    sea = sea_of(fo.CosineSquared(), direction=110.0)
    mean = math.radians(110.0)

    def density(ky, kx):
        k = math.hypot(kx, ky)
        theta = math.remainder(math.atan2(ky, kx) - mean, 2.0 * math.pi)
        spread = 2.0 / math.pi * math.cos(theta) ** 2 if abs(theta) < 0.5 * math.pi else 0.0
        return float(SWELL(math.sqrt(GRAVITY * k))) * spread * 0.5 * math.sqrt(GRAVITY / k) / k

    sx, sy = QUADRANTS[quadrant]
    dk = 2.0 * math.pi / 300.0
    sides = [(sign * a + s) * dk for sign, a in ((sx, ax), (sy, ay)) for s in (-0.5, 0.5)]
    expected, _ = integrate.dblquad(density, *sides, epsabs=1e-9, epsrel=1e-5)
    held = lattice.variances(sea)[0][quadrant, cell_of(lattice.tiles[0], ax, ay)]
    assert held == pytest.approx(expected, rel=5e-3, abs=1e-6)


def test_shares_below_a_direction():
    """
    Of 2/pi cos^2 from -90 degrees on: 1/2 + theta/pi + sin(2 theta)/(2 pi). Within an interval h
    the density is a parabola through three points, whose integral is off by less than a 192nd of
    h^4 times its third derivative, 8/pi at most.
    """
    lattice = CellLattice([Grid.of(32, 300.0)], [WHOLE])
    theta, cubic = lattice._directions(parts_of_sea(sea_of(fo.CosineSquared()))[0])
    assert theta[0] == -math.pi
    assert theta[-1] == math.pi
    ends = np.sum(cubic, axis=2)
    assert ends[:, :-1] == pytest.approx(cubic[:, 1:, 0], abs=1e-12)  # the next one begins there
    assert ends[:, -1] == pytest.approx(1.0, abs=1e-6)
    bound = np.max(np.diff(theta)) ** 4 * (8.0 / math.pi) / 192.0
    for u in (0.25, 0.5, 0.75):
        at = np.clip(theta[:-1] + u * np.diff(theta), -0.5 * math.pi, 0.5 * math.pi)
        exact = 0.5 + at / math.pi + np.sin(2.0 * at) / (2.0 * math.pi)
        found = cubic @ np.array([1.0, u, u**2, u**3])
        assert np.max(np.abs(found - exact)) < bound


def errors(sea, tiles, n, bands=None):
    """
    Return, against `Cells`, the relative error of amplitudes weighted with energy,
    sqrt(sum (a - b)^2 / sum b^2) over all waves of all tiles, and the ratio of variances.
    """
    grids, _, own = zip(*tile_jobs([(n, size) for size in tiles], 7), strict=True)
    lattice = CellLattice(grids, own if bands is None else bands)
    difference = fast = exact = 0.0
    for tile, grid, found in zip(lattice.tiles, grids, lattice.variances(sea), strict=True):
        cells = Cells(sea, grid.dkx, grid.dky)
        variances = cells.variances(tile.ax, tile.ay)
        for (sx, sy), variance in zip(QUADRANTS, variances, strict=True):
            low, high = (cells.share_below(e, sx * tile.ax, sy * tile.ay) for e in tile.band)
            variance *= np.maximum(high - low, 0.0)
        difference += float(np.sum((np.sqrt(found) - np.sqrt(variances)) ** 2))
        fast, exact = fast + float(np.sum(found)), exact + float(np.sum(variances))
    return math.sqrt(difference / exact), fast / exact


def two_systems(depth):
    """Return a wind sea and a swell."""
    return fo.Sea(
        fo.WaveSystem(
            spectrum=fo.TMA(fo.JONSWAP.from_wind(speed=11.0, fetch=200e3), depth),
            spreading=fo.Blend(),
            direction=30.0,
        ),
        fo.WaveSystem(
            spectrum=fo.TMA(SWELL, depth), spreading=fo.CosinePower(s=25.0), direction=110.0
        ),
        depth=depth,
    )


def measured():
    """Return a swell of two sectors, in a table."""
    direction = np.arange(-180.0, 180.0, 15.0)
    row = np.where(np.abs(direction) < 20.0, 1.0, 0.0) + np.where(direction == 90.0, 0.5, 0.0)
    return TabulatedSpreading(
        frequency=[0.05, 0.5], direction=direction.tolist(), density=[row.tolist()] * 2
    )


WIDE = {
    "JONSWAP": sea_of(fo.DonelanBanner(), spectrum=fo.JONSWAP.from_wind(speed=11.0, fetch=200e3)),
    "5 m": fo.Sea.from_wind(speed=11.0, fetch=200e3, depth=5.0, direction=200.0),
    "40 m": fo.Sea.from_wind(speed=20.0, fetch=500e3, depth=40.0, direction=-45.0),
    "two systems": two_systems(math.inf),
    "two systems, 20 m": two_systems(20.0),
    "capillary": sea_of(fo.CosineSquared(), spectrum=fo.Elfouhaily(speed=8.0)),
    "swell": sea_of(fo.CosinePower(s=25.0)),
    "table": sea_of(measured()),
    "half plane": sea_of(fo.CosineN(n=0.0)),
    **{f"Beaufort {b}": fo.Sea.beaufort(b, direction=31.0 * b) for b in range(1, 13)},
}


@pytest.mark.parametrize("name", WIDE)
def test_amplitudes_and_variance_of_wide_seas(name):
    """Found: at most 0.2 % and 0.1 %."""
    error, ratio = errors(WIDE[name], (420.0, 61.0, 8.3), 48)
    assert error < 0.004
    assert ratio == pytest.approx(1.0, abs=0.002)


STEEP = fo.JONSWAP.from_sea_state(hs=1.0, tp=12.0, gamma=20.0)
NARROW = {
    "s = 100": sea_of(fo.CosinePower(s=100.0)),
    "s = 10,000": sea_of(fo.CosinePower(s=1e4)),
    "3 degrees": sea_of(fo.WrappedNormal(spread=3.0)),
    "1 degree": sea_of(fo.WrappedNormal(spread=1.0)),
    "0.1 degrees": sea_of(fo.WrappedNormal(spread=0.1)),
    "narrow band": sea_of(fo.WrappedNormal(spread=2.0), spectrum=STEEP),
    "elongated": sea_of(fo.SwellElongation(fo.DonelanBanner(), xi=1.0)),
    "one direction and cos^2": sea_of(fo.Blend(fo.LongCrested(), fo.CosineSquared(), weight=0.3)),
}


@pytest.mark.parametrize("name", NARROW)
def test_amplitudes_and_variance_of_narrow_seas(name):
    """Found: at most 1.6 % and 0.3 %: a cell is cut into 3 to 24 rings."""
    error, ratio = errors(NARROW[name], (420.0, 61.0, 8.3), 48)
    assert error < 0.04
    assert ratio == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("direction", [0.0, 45.0, 90.0, 133.0, 180.0, 217.3, 270.0])
def test_long_crested_seas_are_followed_along_their_ray(direction):
    error, ratio = errors(sea_of(fo.LongCrested(), direction), (300.0, 41.0), 48)
    assert error < 0.01
    assert ratio == pytest.approx(1.0, abs=1e-3)


def test_tiles_that_are_not_square():
    grids = [Grid.of((32, 64), (400.0, 90.0))]
    lattice = CellLattice(grids, [WHOLE])
    found = lattice.variances(WIDE["swell"])[0]
    tile = lattice.tiles[0]
    expected = Cells(WIDE["swell"], grids[0].dkx, grids[0].dky).variances(tile.ax, tile.ay)
    assert np.sqrt(
        np.sum((np.sqrt(found) - np.sqrt(expected)) ** 2) / np.sum(expected)
    ) < 0.01  # fmt: skip


def test_adjoining_bands_share_out_the_cells():
    """Variances of two bands of the same cells add up to those of one band over both."""
    grid, edge = Grid.of(32, 200.0), 0.31
    sea = WIDE["40 m"]
    (whole,) = CellLattice([grid], [WHOLE]).variances(sea)
    lattice = CellLattice([grid, grid], [(0.0, edge), (edge, math.inf)])
    total = np.zeros_like(whole)
    all_cells = CellLattice([grid], [WHOLE]).tiles[0]
    for tile, part in zip(lattice.tiles, lattice.variances(sea), strict=True):
        for i, (ax, ay) in enumerate(zip(tile.ax, tile.ay, strict=True)):
            total[:, cell_of(all_cells, ax, ay)] += part[:, i]
    assert np.sum(total) == pytest.approx(float(np.sum(whole)), rel=2e-3)
    assert total == pytest.approx(whole, rel=0.1, abs=1e-3 * float(np.max(whole)))


def test_one_tile_holds_the_whole_sea():
    """A tile far wider than the waves, and fine enough, holds Hs^2/16."""
    lattice = CellLattice([Grid.of(64, 1500.0)], [WHOLE])
    (held,) = lattice.variances(sea_of(fo.CosinePower(s=10.0)))
    tile = lattice.tiles[0]
    twice = np.where((tile.ax == 0) | (tile.ay == 0), 0.5, 1.0)  # a cell on an axis counts twice
    # waves shorter than two samples, 47 m, hold 4 %: alpha g^2 / (4 omega^4), omega = 1.15
    above = SWELL.alpha * GRAVITY**2 / (4.0 * (2.0 * math.pi * GRAVITY / 47.0) ** 2)
    assert np.sum(held * twice) == pytest.approx(2.0**2 / 16.0 - above, rel=0.02)


@pytest.mark.parametrize("sea", [fo.Sea(), fo.Sea.beaufort(0)])
def test_a_flat_sea_has_none(sea):
    assert not np.any(CellLattice([Grid.of(16, 50.0)], [WHOLE]).variances(sea)[0])


def test_tiles_without_waves():
    assert CellLattice([Grid.of(2, 50.0)], [WHOLE]).variances(WIDE["swell"])[0].shape == (4, 0)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf])
def test_a_bad_spectrum_is_refused(value):
    spectrum = fo.CustomSpectrum(lambda omega: np.where(omega > 1.0, value, 1.0), peak=0.6)
    with pytest.raises(fo.ParameterError, match="spectrum must be finite and at least 0"):
        CellLattice([Grid.of(16, 50.0)], [WHOLE]).variances(
            sea_of(fo.CosineSquared(), spectrum=spectrum)
        )
