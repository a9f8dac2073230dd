"""Tiles that fit a budget: by costs that are given, beside the waves of the source."""

import math
import pickle

import numpy as np
import pytest

import fftocean as fo
from fftocean import query, query_budget
from fftocean.kernels import query as kernels

SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
TILES = [(64, 120.0), ((64, 48), (31.0, 29.0)), (32, 7.3)]


def cascade(**arguments):
    return fo.Cascade(SEA, TILES, **{"seed": 2, **arguments})


def samples(source):
    """Return a cost: thousands of samples of all tiles."""
    oceans = source.oceans if isinstance(source, fo.Cascade) else (source,)
    return sum(ocean.grid.nx * ocean.grid.ny for ocean in oceans) / 1000.0


def chosen(source, budget, cost=samples, shortest=0.0):
    return query_budget.within(source, budget=budget, points=200, shortest=shortest, measure=cost)


def waves(source, shortest=0.0):
    """Return amplitude by (tile, kx, ky), of waves that are long enough."""
    oceans = source.oceans if isinstance(source, fo.Cascade) else (source,)
    return {
        (i, round(kx, 9), round(ky, 9)): a
        for i, ocean in enumerate(oceans)
        for kx, ky, a, *_ in zip(*ocean.modes(), strict=True)
        if math.hypot(kx, ky) * shortest <= 2.0 * math.pi
    }


@pytest.mark.parametrize("budget", [20.0, 8.0, 5.0, 2.0, 0.6, 0.3])
def test_what_is_left_fits_and_the_next_larger_does_not(budget):
    """Against every stage in turn, without bisection."""
    source = cascade()
    stages = query_budget._stages(source.oceans, 0.0)
    costs = [sum(nx * ny for nx, ny in stage) / 1000.0 for stage in stages]
    assert costs == sorted(costs, reverse=True)
    assert stages[0] == ((64, 64), (64, 48), (32, 32))
    assert stages[-1] == ((16, 16),)
    left, report = chosen(source, budget)
    expected = next(stage for stage, cost in zip(stages, costs, strict=True) if cost <= budget)
    assert report.samples == expected
    assert tuple((o.grid.nx, o.grid.ny) for o in left.oceans) == expected
    assert report.milliseconds == samples(left) <= budget
    assert report.fits
    assert report.tiles_left_out == 3 - len(expected)
    assert report.sizes == ((120.0, 120.0), (31.0, 29.0), (7.3, 7.3))[: len(expected)]


@pytest.mark.parametrize(("budget", "shortest"), [(3.0, 0.0), (1.0, 0.0), (1.0, 2.0)])
def test_waves_that_are_left_are_those_of_the_source(budget, shortest):
    """The same amplitudes at the same wavenumbers; variance and height by their squares."""
    source = cascade()
    left, report = chosen(source, budget, shortest=shortest)
    all_waves, some = waves(source, shortest), waves(left, shortest)
    assert 0 < len(some) < len(all_waves)
    assert all(some[key] == pytest.approx(all_waves[key], rel=1e-12) for key in some)
    for i, kx, ky in all_waves:  # none that fewer samples hold is left out
        if i < len(left.oceans):
            grid = left.oceans[i].grid
            mx, my = kx * grid.lx / (2.0 * math.pi), ky * grid.ly / (2.0 * math.pi)
            held = abs(mx) < grid.nx / 2 - 0.1 and abs(my) < grid.ny / 2 - 0.1
            assert ((i, kx, ky) in some) == held
    asked, there = (0.5 * sum(a * a for a in w.values()) for w in (all_waves, some))
    assert report.variance_left_out == pytest.approx(1.0 - there / asked, abs=1e-12)
    assert report.significant_wave_height == pytest.approx(4.0 * math.sqrt(there))
    assert report.significant_wave_height_asked == pytest.approx(4.0 * math.sqrt(asked))
    shortest_left = min(2.0 * math.pi / math.hypot(kx, ky) for _, kx, ky in some)
    assert report.shortest == pytest.approx(shortest_left)
    assert not report.is_whole


@pytest.mark.parametrize("samples", [(64, 48), (64, 24), (32, 48), (32, 24), (16, 24)])
def test_waves_of_fewer_than_four_samples_count_as_lost(samples):
    """As a share of all, along x and y of an oblong tile; the waves themselves, one by one."""
    ocean = fo.Ocean(SEA, n=(64, 48), size=(31.0, 90.0), seed=2)
    modes, grid = ocean.modes(), ocean.grid
    along = samples[0] * 2.0 * math.pi / grid.lx / np.maximum(np.abs(modes.kx), 1e-9)
    across = samples[1] * 2.0 * math.pi / grid.ly / np.maximum(np.abs(modes.ky), 1e-9)
    few = np.minimum(along, across) < 4.0 - 1e-9
    expected = np.sum(modes.amplitude[few] ** 2) / np.sum(modes.amplitude**2)
    tail = query_budget._Tail(ocean, 0.0)
    assert 0.0 < expected < 1.0
    assert tail.without(samples) / tail.total == pytest.approx(expected, rel=1e-9)


def test_each_step_costs_the_least_variance():
    """The ripples of the smallest tile go before the waves of the largest do."""
    source = cascade()
    _, report = chosen(source, 4.2)
    assert report.variance_left_out < 0.01
    single = fo.Ocean(SEA, n=64, size=120.0, seed=2)
    _, alone = chosen(single, 1.1)
    assert alone.samples == ((32, 32),)


def test_what_fits_is_left_alone():
    source = cascade()
    left, report = chosen(source, 100.0)
    assert left is source
    assert report.is_whole
    assert "with every wave" in str(report)


def test_a_tile_whose_waves_nobody_asks_for_goes_first():
    """Waves below 8 m: without the tile of ripples every wave asked for is there."""
    left, report = chosen(cascade(), 4.9, shortest=8.0)
    assert len(left.oceans) == 2
    assert report.tiles_left_out == 1
    assert report.is_whole


def test_a_budget_that_nothing_fits():
    left, report = chosen(cascade(), 0.01)
    assert not report.fits
    assert report.samples == ((16, 16),)
    assert len(left.oceans) == 1


def test_second_order_is_that_of_the_waves_that_are_left():
    source = fo.Ocean(SEA, n=64, size=120.0, seed=2, order=2, bound=60)
    left, _ = chosen(source, 1.1)
    assert left.order == 2
    assert left.grid.shape == (32, 32)


# Queries


@pytest.fixture
def cost(monkeypatch):
    """Let calls cost the samples of their tiles, instead of what they take."""
    monkeypatch.setattr(query, "milliseconds_of_a_call", lambda q, _points: samples(q.source))


@pytest.mark.usefixtures("cost")
@pytest.mark.parametrize("mode", ["bilinear", "bicubic"])
def test_an_ample_budget_changes_no_bit(mode):
    source = cascade()
    x, y = np.random.default_rng(4).uniform(-200.0, 200.0, (2, 50))
    plain, ample = (fo.Query(source, mode=mode, budget=b) for b in (None, 1e3))
    assert plain.budget_report is None
    assert ample.budget_report.is_whole
    assert ample.source is source
    for name in query.WANTED:
        assert np.array_equal(plain.at(x, y, 1.5)[name], ample.at(x, y, 1.5)[name])


@pytest.mark.usefixtures("cost")
def test_a_query_says_what_its_budget_leaves_out():
    source = cascade()
    with pytest.warns(fo.SeaWarning, match=r"left out to fit the budget: 20 points in .* ms of 4"):
        asked = fo.Query(source, budget=4.0, points=20, shortest=0.5, drift=True)
    report = asked.budget_report
    assert (report.budget, report.points) == (4.0, 20)
    assert f"budget: {report}"[:60] in repr(asked)
    plain = fo.Query(asked.source, shortest=0.5, drift=True)
    assert asked.set_down == plain.set_down != fo.Query(source, shortest=0.5).set_down
    x = np.linspace(-50.0, 50.0, 9)
    for name in query.WANTED:
        assert np.array_equal(asked.at(x, 3.0, 2.0)[name], plain.at(x, 3.0, 2.0)[name])


@pytest.mark.usefixtures("cost")
def test_a_pickle_keeps_the_choice(monkeypatch):
    with pytest.warns(fo.SeaWarning):
        asked = fo.Query(cascade(), budget=4.0)
    monkeypatch.setattr(query, "milliseconds_of_a_call", lambda *_: pytest.fail("it measured"))
    again = pickle.loads(pickle.dumps(asked))
    assert again.budget_report == asked.budget_report
    assert again.at(1.0, 2.0, 3.0).heights == asked.at(1.0, 2.0, 3.0).heights


@pytest.mark.usefixtures("cost")
def test_a_budget_that_no_tiles_fit_is_warned_of():
    with pytest.warns(fo.SeaWarning, match="longer than the budget even with the fewest waves"):
        asked = fo.Query(cascade(), budget=0.01)
    assert not asked.budget_report.fits


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"budget": 0.0}, "budget must be"),
        ({"budget": math.nan}, "budget must be"),
        ({"budget": 1.0, "points": 0}, "points must be"),
        ({"budget": 1.0, "points": 2.5}, "points must be"),
        ({"budget": 1.0, "mode": "exact"}, "a budget needs tiles to leave out"),
    ],
)
def test_bad_budgets_are_refused(arguments, says):
    with pytest.raises(fo.ParameterError, match=says):
        fo.Query(fo.Ocean(SEA, n=16, size=60.0), **arguments)


def test_waves_without_tiles_have_no_budget():
    with pytest.raises(fo.ParameterError, match="a budget needs tiles to leave out"):
        fo.Query(fo.Ocean(SEA, n=16, size=60.0).modes(), budget=5.0)


def test_the_time_of_a_call_is_measured_at_new_times(monkeypatch):
    """The median of differences of a clock that we turn: calls take the seconds that we say."""
    asked = fo.Query(fo.Ocean(SEA, n=16, size=60.0))
    clock, times = [0.0], []
    durations = iter([5.0, 5.0, 5.0, 5.0, 0.25, 0.25, 0.25, 0.25, 0.5])
    real = fo.Query.at

    def at(self, x, y, t, *fields):
        if fields == ():  # a timed one
            times.append(t)
            assert x.shape == (7,)
            clock[0] += next(durations)
        return real(self, x, y, t, *fields)

    monkeypatch.setattr(fo.Query, "at", at)
    monkeypatch.setattr(query.time, "thread_time", lambda: clock[0])
    assert query.milliseconds_of_a_call(asked, 7) == 500.0
    assert len(set(times)) == query.CALLS


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
def test_after_a_warm_up_nothing_is_made_anew(mode, monkeypatch):
    """Oceans of accelerations, and the search beside folds, are there; later calls make frames."""
    searches, made = [], []
    invert, filtered = kernels.invert, fo.Ocean.spectrally_scaled
    monkeypatch.setattr(kernels, "invert", lambda *a: searches.append(1) or invert(*a))
    monkeypatch.setattr(
        fo.Ocean, "spectrally_scaled", lambda *a, **m: made.append(1) or filtered(*a, **m)
    )
    asked = fo.Query(fo.Ocean(SEA, n=16, size=60.0, seed=1), mode=mode)
    asked.warm_up(20)
    assert searches
    before = len(made)
    asked.at(1.0, 2.0, 0.5)
    assert len(made) == before
    with pytest.raises(fo.ParameterError, match="points must be"):
        asked.warm_up(0)
