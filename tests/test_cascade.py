"""
Several tiles, one sea: no energy twice and none missing, chance that does not depend on the cut,
loops, and bad input.
"""

import copy
import itertools
import math
import pickle
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import fftocean as fo
from fftocean import noise
from fftocean.amplitudes import seed_amplitudes, share_below
from fftocean.cascade import band_edges, reach_of, tile_seed
from fftocean.cells import WHOLE, Cells
from fftocean.grid import Grid
from fftocean.statistics import outside_band

SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
CROSSED = fo.Sea(
    fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=5.0), direction=20.0),
    fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=0.5, tp=9.0, gamma=7.0),
        spreading=fo.CosinePower(s=25.0),
        direction=-70.0,
    ),
    depth=15.0,
)
TILES = [(32, 240.0), (48, 47.0), ((24, 20), (7.3, 6.1))]


def cascade(sea=SEA, **arguments):
    return fo.Cascade(sea, **{"tiles": TILES, "seed": 7, "dtype": "float64", **arguments})


def flat(level):
    """
    A sea with the same energy at every wavenumber: S = 2 pi C k/(d omega/dk), in all directions; so
    every share is an area.
    """
    density = fo.CustomSpectrum(
        lambda omega: np.where(omega < 60.0, 4.0 * np.pi * level * omega**3 / 9.80665**2, 0.0),
        peak=1.0,
    )
    return fo.Sea(fo.WaveSystem(spectrum=density, spreading=fo.CosinePower(s=0.0)))


# Energy


@pytest.mark.filterwarnings("ignore:the waves of systems:fftocean.errors.SeaWarning")
def test_no_energy_twice_and_none_missing():
    """
    With a flat density every share is an area: all tiles together cover the last one's rectangle
    less the cell of the first at k = 0.
    """
    made = cascade(flat(1e-4))
    first, *_, last = (ocean.grid for ocean in made.oceans)
    width, height = (
        (2 * reach + 1) * step for reach, step in zip(last.reach, (last.dkx, last.dky), strict=True)
    )
    # panels in direction and frequency are resolved to 1e-6 each
    assert made.variance == pytest.approx(1e-4 * (width * height - first.dkx * first.dky), rel=1e-6)


@pytest.mark.parametrize(("lowest", "highest"), [(0.3, 0.9), (0.3, 0.31), (0.05, 5.0)])
def test_a_ring_has_the_area_of_a_ring(lowest, highest):
    """
    One tile, both edges cutting cells, even both one cell: pi (b^2 - a^2), oblong cells included.
    """
    grid = Grid.of((61, 80), (70.0, 90.0))
    held = seed_amplitudes(flat(1e-4), grid, band=(lowest, highest)).variance
    outermost = math.pi * min(highest, reach_of(grid)[1]) ** 2
    if highest < reach_of(grid)[1] and lowest > reach_of(grid)[0]:
        assert held == pytest.approx(
            1e-4 * (outermost - math.pi * lowest**2), rel=1e-11
        )  # 1e-12 of the disc, of which this is a part
    else:
        width, height = (
            (2 * reach + 1) * step
            for reach, step in zip(grid.reach, (grid.dkx, grid.dky), strict=True)
        )
        inner = math.pi * lowest**2 if lowest > reach_of(grid)[0] else 0.0
        assert held <= 1e-4 * (width * height - inner)


@pytest.mark.parametrize("sea", [SEA, CROSSED], ids=["wind", "crossed"])
@pytest.mark.parametrize("cuts", [(0.4,), (0.21, 0.8), (0.3, 0.31, 0.32, 1.1)])
def test_bands_share_out_every_cell(sea, cuts):
    """
    On one grid, however it is cut: cell by cell the parts add up to the whole, to 1e-12, and no
    part is negative.
    """
    grid = Grid.of((32, 40), (100.0, 80.0))
    whole = seed_amplitudes(sea, grid)
    parts = [
        seed_amplitudes(sea, grid, band=band) for band in itertools.pairwise((0.0, *cuts, math.inf))
    ]
    for name in ("variance_forward", "variance_backward"):
        total = sum(getattr(part, name) for part in parts)
        assert np.all(np.abs(total - getattr(whole, name)) <= 1e-12 * getattr(whole, name))
        assert all(np.all(getattr(part, name) >= 0.0) for part in parts)
    assert sum(part.variance for part in parts) == pytest.approx(whole.variance, rel=1e-12)


@pytest.mark.parametrize("sea", [SEA, CROSSED], ids=["wind", "crossed"])
def test_tiles_of_several_sizes_hold_the_sea(sea):
    """
    Held + outside = ordered: against the polar integral, whose trapezoids are good to 2e-4, as
    cells are by the midpoint rule.
    """
    made = cascade(sea)
    below, _ = outside_band(sea, made.oceans[0].grid)
    _, above = outside_band(sea, made.oceans[-1].grid)
    assert made.variance + below + above == pytest.approx(sea.variance, rel=1e-3)


def test_a_share_is_the_integral_over_the_part():
    """
    A cut cell of a real sea against a fine midpoint sum with a sharp edge: 1/1000 of the cell's
    width along the edge.
    """
    grid = Grid.of(16, 60.0)
    edge, n = 0.4, 1000
    mx, my = np.array([3, -2, 0, 4]), np.array([2, 3, -4, 0])
    shares = share_below(edge, SEA, mx, my, grid.dkx, grid.dky)
    offset = (np.arange(n) + 0.5) / n - 0.5
    for i in range(mx.size):
        kx, ky = np.meshgrid((mx[i] + offset) * grid.dkx, (my[i] + offset) * grid.dky)
        k = np.hypot(kx, ky)
        omega = np.sqrt(9.80665 * k)
        density = SEA.density(omega, np.arctan2(ky, kx)) * 0.5 * omega / k / k
        total = np.sum(density)
        expected = (
            np.sum(density[k < edge]) / total
            if total > 0.0
            else float(np.hypot(mx[i] * grid.dkx, my[i] * grid.dky) < edge)
        )
        assert shares[i] == pytest.approx(expected, abs=3e-3)
    assert np.any((shares > 0.1) & (shares < 0.9))


@pytest.fixture
def remembered(monkeypatch):
    """Energies do not depend on the seed: let the sea be integrated once for each tile."""
    for name in ("variances", "share_below"):
        integrate, known = getattr(Cells, name), {}

        def look_up(self, *arguments, integrate=integrate, known=known):
            key = (
                self.dkx,
                self.dky,
                *(a.tobytes() if isinstance(a, np.ndarray) else a for a in arguments),
            )
            if key not in known:
                known[key] = integrate(self, *arguments)
            return known[key].copy()

        monkeypatch.setattr(Cells, name, look_up)
    monkeypatch.setattr(Cells, "require_energy", lambda *_: None)


@pytest.mark.usefixtures("remembered")
def test_variance_over_seeds_is_that_of_one_big_tile():
    """
    64 seeds of three tiles against 64 of one that holds the same band: means within four standard
    errors of their difference.
    """
    tiles, big = [(20, 100.0), (20, 37.0), (20, 13.7)], Grid.of(139, 100.0)
    many = [fo.Cascade(SEA, tiles, seed=seed, dtype="float64") for seed in range(64)]
    last = many[0].oceans[-1].grid
    assert reach_of(big)[1] == pytest.approx(reach_of(last)[1], rel=0.01)
    ours = [
        sum(np.mean(frame.height**2) for frame in made.frame(3.7, ("height",))) for made in many
    ]
    oceans = (
        fo.Ocean(SEA, n=big.nx, size=big.lx, seed=1000 + seed, dtype="float64")
        for seed in range(64)
    )
    theirs = [np.mean(ocean.frame(3.7, ("height",)).height ** 2) for ocean in oceans]
    error = math.hypot(np.std(ours, ddof=1), np.std(theirs, ddof=1)) / 8.0
    assert abs(np.mean(ours) - np.mean(theirs)) < 4.0 * error
    assert error < 0.08 * np.mean(theirs)  # else the line above could not fail
    assert abs(np.mean(ours) - many[0].variance) < 4.0 * np.std(ours, ddof=1) / 8.0


def test_tiles_are_independent():
    """
    Chance at the same (mx, my) of two tiles: no correlation over 400 seeds; it would be complete if
    both had the cascade's seed.
    """
    mx, my = np.arange(1, 11), np.arange(10) - 4
    one, two = (
        np.concatenate([noise.complex_normals(seed, mx, my) for seed in seeds])
        for seeds in (range(400), [tile_seed(seed, 71.0, 71.0) for seed in range(400)])
    )
    for other in (two, np.conj(two)):
        assert abs(np.mean(one * other)) < 4.0 * 2.0 / math.sqrt(4000)  # |xi|^2 is 2 on average
    made = cascade()
    assert [ocean.seed for ocean in made.oceans] == [
        7,
        tile_seed(7, 47.0, 47.0),
        tile_seed(7, 7.3, 6.1),
    ]
    assert np.mean(np.abs(one) ** 2) == pytest.approx(2.0, rel=0.07)


# The same waves


@pytest.mark.parametrize("draw", ["gaussian", "fixed"])
def test_the_same_waves_whichever_way_the_band_is_cut(draw):
    """Whole cells to the bit; cut ones keep their phase, and the fraction of their energy."""
    grid = Grid.of(40, 100.0)
    whole = seed_amplitudes(SEA, grid, seed=5, draw=draw)
    for low, high in [(0.0, 0.5), (0.5, math.inf), (0.3, 0.9)]:
        part = seed_amplitudes(SEA, grid, seed=5, draw=draw, band=(low, high))
        nearest = (
            np.hypot(
                np.maximum(grid.mx - 0.5, 0)[None, :], np.maximum(np.abs(grid.my) - 0.5, 0)[:, None]
            )
            * grid.dkx
        )
        farthest = np.hypot(grid.mx[None, :] + 0.5, np.abs(grid.my)[:, None] + 0.5) * grid.dkx
        inside, outside = (
            (nearest >= low) & (farthest <= high),
            (farthest <= low) | (nearest >= high),
        )
        for name in ("forward", "backward"):
            mine, theirs = getattr(part, name), getattr(whole, name)
            assert np.array_equal(mine[inside], theirs[inside])
            assert not np.any(mine[outside])
            cut = ~inside & ~outside & (theirs != 0)
            ratio = mine[cut] / theirs[cut]
            assert np.max(np.abs(ratio.imag)) < 1e-15
            assert np.all((ratio.real >= 0.0) & (ratio.real <= 1.0))
        assert np.count_nonzero(inside & grid.active) > 10


def test_a_tile_s_waves_do_not_depend_on_the_others():
    """
    Another n, another band, another tile between: the tile of 47 m keeps its waves, and the first
    is the ocean of its size and seed.
    """
    made = cascade()
    alone = fo.Ocean(SEA, n=32, size=240.0, seed=7, dtype="float64")
    low = made.oceans[0].grid.k < 0.8 * made.bands[0][1]
    assert np.array_equal(made.oceans[0].amplitudes.forward[low], alone.amplitudes.forward[low])
    finer = cascade(tiles=[(64, 240.0), (96, 47.0), (24, 7.3)])
    between = cascade(tiles=[(64, 240.0), (48, 110.0), (48, 47.0), (24, 7.3)])
    for other, index in ((finer, 1), (between, 2)):
        mine, theirs = made.oceans[1], other.oceans[index]
        assert theirs.seed == mine.seed
        rows, columns = np.nonzero(
            mine.grid.active & (mine.grid.k > 1.2 * max(made.bands[1][0], other.bands[index][0]))
        )
        near = mine.grid.k[rows, columns] < 0.8 * min(made.bands[1][1], other.bands[index][1])
        rows, columns = rows[near], columns[near]
        assert rows.size > 10
        my = mine.grid.my[rows]
        assert np.array_equal(
            mine.amplitudes.forward[my, columns], theirs.amplitudes.forward[my, columns]
        )


def test_one_tile_is_an_ocean():
    one, ocean = fo.Cascade(SEA, [(32, 100.0)], seed=3), fo.Ocean(SEA, n=32, size=100.0, seed=3)
    assert one.bands == (WHOLE,)
    (frame,) = one.frame(5.0)
    for name in frame.fields:
        assert np.array_equal(frame[name], ocean.frame(5.0)[name])


def test_seeds_of_tiles():
    """Different for another seed and another size; 64 bits; the same for ever."""
    seeds = {
        tile_seed(seed, size, size)
        for seed in (0, 1, 2**64 - 1)
        for size in (71.0, 71.00000000000001, 9.3)
    }
    assert len(seeds) == 9
    assert all(0 <= seed < 2**64 for seed in seeds)
    assert tile_seed(7, 71.0, 9.3) != tile_seed(7, 9.3, 71.0)
    assert (
        tile_seed(7, 71.0, 71.0) == 14448063307456676198
    )  # a change would be another sea for everybody


# Bands


def test_automatic_bands_lie_where_both_tiles_hold_every_wave():
    made = cascade()
    assert made.bands[0][0] == 0.0
    assert made.bands[-1][1] == math.inf
    for (low, high), (again, _), large, small in zip(
        made.bands, made.bands[1:], made.oceans, made.oceans[1:], strict=False
    ):
        assert low < high == again
        assert reach_of(small.grid)[0] < high < reach_of(large.grid)[1]
        samples, waves = 2 * math.pi / high / (large.grid.lx / large.grid.nx), high / small.grid.dkx
        assert 1 / 3 < samples / waves < 3
    assert made.bands == band_edges([ocean.grid for ocean in made.oceans])


@pytest.mark.parametrize("n", [8, 9, (8, 13), (15, 6)])
@pytest.mark.parametrize("size", [50.0, (80.0, 30.0), (20.0, 90.0)])
def test_a_tile_reaches_as_far_as_circles_lie_within_its_cells(n, size):
    """
    Points of a circle belong to the nearest wavenumber of the tile: a little beyond the lowest |k|
    none belongs to k = 0, a little below it some do; a little below the highest all have one on
    the grid, short of Nyquist, a little beyond it some have not.
    """
    grid = Grid.of(n, size)
    theta = np.linspace(0.0, 2.0 * np.pi, 200_001)  # so fine that 1e-3 of a radius is seen
    low, high = reach_of(grid)

    def indices(radius):
        return (
            np.rint(radius * np.cos(theta) / (2.0 * np.pi / grid.lx)),
            np.rint(radius * np.sin(theta) / (2.0 * np.pi / grid.ly)),
        )

    for factor, whole in ((1.001, True), (0.999, False)):
        mx, my = indices(factor * low)
        assert np.all((mx != 0) | (my != 0)) == whole
        mx, my = indices(high / factor)
        assert np.all((np.abs(mx) <= (grid.nx - 1) // 2) & (np.abs(my) <= (grid.ny - 1) // 2)) == (
            whole
        )


def test_an_automatic_edge_is_a_geometric_mean():
    """Of 0.5 sqrt(2) dk of the small tile and (n/2 - 0.5) dk of the large one, if both square."""
    grids = [Grid.of(32, 100.0), Grid.of(32, 17.0), Grid.of(16, 5.0)]
    dk = [2.0 * math.pi / grid.lx for grid in grids]
    edges = [
        math.sqrt(math.sqrt(0.5) * dk[i + 1] * (grids[i].nx / 2 - 0.5) * dk[i]) for i in range(2)
    ]
    expected = [(0.0, edges[0]), (edges[0], edges[1]), (edges[1], math.inf)]
    assert np.array(band_edges(grids)) == pytest.approx(np.array(expected), rel=1e-14)


def test_given_bands():
    bands = ((0.05, 0.3), (0.3, 2.0), (2.0, 6.0))
    made = cascade(bands=bands)
    assert made.bands == bands
    for ocean, (low, high) in zip(made.oceans, bands, strict=True):
        modes = ocean.modes()
        k = np.hypot(modes.kx, modes.ky)
        slack = 0.5 * math.hypot(ocean.grid.dkx, ocean.grid.dky)
        assert np.min(k) > low - slack
        assert np.max(k) < high + slack


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"tiles": []}, "at least one"),
        ({"tiles": 5}, "a list of"),
        ({"tiles": [(32, 100.0, 3)]}, "a list of"),
        ({"tiles": [(32, 100.0), (32, 300.0)]}, "largest to the smallest"),
        ({"tiles": [(32, 100.0), (32, 100.0)]}, "largest to the smallest"),
        ({"tiles": [(8, 100.0), (32, 7.0)]}, "overlap"),
        ({"tiles": [(32, -100.0)]}, "size"),
        ({"tiles": [(2.5, 100.0)]}, "n must"),
        ({"bands": [(0, 1)]}, "one for each"),
        ({"bands": 3}, "a list of"),
        ({"bands": [(0.0, 0.3), (0.4, 2.0), (2.0, 6.0)]}, "adjoin"),
        ({"bands": [(0.0, 0.3), (0.3, 0.3), (0.3, 6.0)]}, "rise"),
        ({"bands": [(0.0, 0.01), (0.01, 2.0), (2.0, 6.0)]}, "longest waves"),
        ({"bands": [(0.0, 0.3), (0.3, 5.0), (5.0, 6.0)]}, "shortest waves"),
        ({"bands": [(0.0, math.nan), (0.3, 2.0), (2.0, 6.0)]}, "between|at least"),
        ({"loop": [30.0]}, "one for each"),
        ({"loop": -1.0}, "loop"),
        ({"seed": -1}, "seed"),
        ({"dtype": "float16"}, "dtype"),
        ({"amplitudes": "none"}, "amplitudes"),
        ({"choppiness": math.nan}, "choppiness"),
        ({"threads": 0}, "threads"),
        ({"sea": "calm"}, "sea"),
    ],
)
def test_bad_input_is_refused(arguments, says):
    with pytest.raises(fo.ParameterError, match=says):
        cascade(**arguments)


def test_sizes_that_repeat_together_are_warned_of():
    with pytest.warns(fo.SeaWarning, match="exactly 5 times"):
        cascade(tiles=[(32, 100.0), (32, 20.0)])


# Time, and being a value


def test_tiles_add_up_to_the_direct_sum():
    """All modes of all tiles, summed without an FFT, at three points that are on both grids."""
    made = cascade(tiles=[(16, 120.0), (20, 50.0)], choppiness=1.2)
    x = made.oceans[0].grid.x[:3]  # 0, 7.5, 15 m: texels 0, 3, 6 of the second tile
    truth = fo.gerstner.surface(made, x, 0.0 * x, 7.7)
    one, two = made.frame(7.7, ("height", "displace_x", "velocity_z"))
    for name in ("height", "displace_x", "velocity_z"):
        total = one[name][0, :3] + two[name][0, [0, 3, 6]]
        assert np.max(np.abs(total - getattr(truth, name))) < 1e-12
    assert made.modes().kx.size == sum(ocean.modes().kx.size for ocean in made.oceans)


def test_loops():
    common, free = cascade(loop=40.0), cascade()
    assert (common.loop, common.loops) == (40.0, (40.0,) * 3)
    assert (free.loop, free.loops) == (None, (None,) * 3)
    for a, b in zip(common.frame(1.5, ("height",)), common.frame(41.5, ("height",)), strict=True):
        assert np.array_equal(a.height, b.height)
    for a, b in zip(
        common.loop_frame(3, 8, ("height",)), common.loop_frame(11, 8, ("height",)), strict=True
    ):
        assert np.array_equal(a.height, b.height)
    each = cascade(loop=(40.0, 20.0, 8.0))
    assert (each.loop, each.loops) == (None, (40.0, 20.0, 8.0))
    for frame, again in zip(
        each.frame(1.5, ("height",)), each.frame(41.5, ("height",)), strict=True
    ):
        assert np.allclose(frame.height, again.height, atol=1e-12)  # 40 is a multiple of all three
    for made in (each, free):
        with pytest.raises(fo.ParameterError, match="one period"):
            made.loop_frame(0, 8)
    with pytest.warns(fo.SeaWarning, match="four periods"):
        cascade(loop=5.0)


def test_a_short_loop_is_enough_for_short_waves():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cascade(loop=(60.0, 30.0, 10.0))


def test_a_cascade_is_a_frozen_value():
    made = cascade(loop=40.0, choppiness=1.1)
    with pytest.raises(AttributeError, match="frozen"):
        made.seed = 8
    for again in (pickle.loads(pickle.dumps(made)), copy.deepcopy(made)):
        assert (again.seed, again.bands, again.loops, again.choppiness) == (
            made.seed,
            made.bands,
            made.loops,
            made.choppiness,
        )
        for a, b in zip(again.frame(2.0), made.frame(2.0), strict=True):
            assert np.array_equal(a.height, b.height)
    assert len(made) == 3
    assert made.depth == SEA.depth
    assert made.dtype == "float64"
    said = repr(made)
    assert "32 x 32 over 240 x 240 m" in said
    assert "24 x 20 over 7.3 x 6.1 m" in said


def test_threads_share_a_cascade():
    made = cascade(threads=2)
    times = [0.5 * i for i in range(12)]
    alone = [made.frame(t, ("height",))[1].height.copy() for t in times]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda t: made.frame(t, ("height",))[1].height, times))
    assert all(np.array_equal(a, b) for a, b in zip(alone, together, strict=True))
