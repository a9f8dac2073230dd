"""Seas as the page gets them: the document's roughness, foam, wind and notes."""

import asyncio
import threading

import numpy as np
import pytest
from serving import small_state

import fftocean as fo
from fftocean.errors import ParameterError
from fftocean.fields import DISPLACEMENT_GRADIENT
from fftocean.foam_coverage import mean_coverage
from fftocean.runtime.container import from_bytes
from fftocean.view.seas import MovingSeas, SeaMaker, make_exact, reference_fields
from fftocean.view.state import State
from fftocean.view.worker import Worker


def test_slopes_of_tiles_and_beyond_are_those_of_the_wind():
    """Cox & Munk 1954 along and across a wind toward 30 degrees, written out."""
    state = small_state()
    found = make_exact(state, 1).document["slope_variance"]
    angle = np.radians(30.0)
    along, across = 0.00316 * 11.0, 0.003 + 0.00192 * 11.0
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    total = turn @ np.diag([along, across]) @ turn.T
    expected = [total[0, 0], total[1, 1], total[0, 1]]
    np.testing.assert_allclose(found["total"], expected, rtol=1e-12)
    np.testing.assert_allclose(
        np.add(found["captured"], found["beyond"]), expected, rtol=1e-12, atol=1e-15
    )


def test_the_specified_density_by_direction_has_the_sea():
    """Summed over its sectors, the polar density follows S(f); it turns with the wind."""
    found = {}
    for direction in (0.0, 90.0):
        state = small_state(wind_direction=direction, swell_speed=0.0)
        made = make_exact(state, 1)
        polar = made.document["spectrum"]["polar"]
        density = np.array(polar["density"])
        assert density.max() == 1.0
        middles = (np.arange(20) + 0.5) / 20 * polar["highest"]
        expected = 2 * np.pi * state.sea()(2 * np.pi * middles)
        by_ring = density.sum(axis=1)
        assert np.corrcoef(by_ring, expected)[0, 1] > 0.98  # rings are wider than the peak
        found[direction] = density
    np.testing.assert_allclose(found[90.0], np.roll(found[0.0], 9, axis=1), atol=2e-3)


def foam_of_wind(speed, **changes):
    """Return the exact sea of a wind without swell on the page's own 3 x 64^2, and its foam."""
    state = State.default(n=64).changed({"wind_speed": speed, "swell_speed": 0.0, **changes})
    made = make_exact(state, 1, points=4)
    return made, made.document["foam"]


def test_in_still_air_nothing_foams():
    """A swell alone makes no whitecaps; the systems of a job may have a wind that nobody told."""
    made, foam = foam_of_wind(0.0, swell_speed=14.0)
    assert made.document["wind"] is None
    assert made.document["statistics"]["specified"]["hs"] > 1.0
    assert mean_coverage(made.cascade, foam["threshold"]) == 0.0
    spectrum = "{ kind = 'jonswap', hs = 2.0, tp = 11.0 }"
    job = fo.Job.from_toml(f"[[sea.systems]]\nspectrum = {spectrum}\ndirection = 20.0\n")
    told = State.of_job(job, n=16)
    assert make_exact(told, 1, points=2).document["foam"]["threshold"] == fo.Foam().threshold


def breaking_cells(made, foam, moments, cells=20_000):
    """
    Yield max(threshold - smallest eigenvalue, 0) in cells of the page at some moments.

    As in `foamStepShader`, a cell adds up one texel of every tile, unfiltered. The sizes of tiles
    have no common measure, so that all pairs of texels meet somewhere: these are random ones.
    """
    oceans, choppiness = made.cascade.oceans, made.document["choppiness"]
    chance = np.random.default_rng(4)
    places = [tuple(chance.integers(0, 64, (2, cells))) for _ in oceans]
    for moment in moments:
        frames = [ocean.frame(moment, DISPLACEMENT_GRADIENT) for ocean in oceans]
        xx, xy, yy = (
            choppiness * sum(getattr(f, name)[at] for f, at in zip(frames, places, strict=True))
            for name in DISPLACEMENT_GRADIENT
        )
        smaller = 1.0 + 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)
        yield np.maximum(foam["threshold"] - smaller, 0.0)


@pytest.mark.parametrize("speed", [2.5, 5.0, 7.0, 10.0, 15.0, 20.0])
def test_foam_of_all_waves_covers_what_whitecaps_cover(speed):
    """
    3.84e-6 U^3.41 (Monahan & O'Muircheartaigh 1980) by the library's mean coverage of all waves:
    the page's cells hold the shortest too. The default wind speeds, choppiness and sizes.
    """
    for changes in ({}, {"swell_speed": 14.0}):
        made, foam = foam_of_wind(speed, **changes)
        covered = mean_coverage(made.cascade, foam["threshold"])
        assert covered == pytest.approx(3.84e-6 * speed**3.41, rel=0.25)


@pytest.mark.parametrize("speed", [0.1, 0.5, 1.0])
def test_hardly_any_foam_in_a_light_wind(speed):
    """Not even where all waves are shorter than a metre; 1 m/s has 3e-6 by the law."""
    for changes in ({}, {"swell_speed": 14.0}, {"choppiness": 0.3}):
        made, foam = foam_of_wind(speed, **changes)
        assert mean_coverage(made.cascade, foam["threshold"]) < 3e-5


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.5, 5.0, 7.0])
def test_little_foam_in_cells_of_the_page_is_that_of_whitecaps(speed):
    """
    The mean of the state is decay x strength x the mean of what breaks, and little of it covers as
    much as it is, or less where it overlaps: by 9 % at 7 m/s. Means over 150 moments of the loop
    scatter by a tenth. At 1 m/s and less breaking is too rare to be met more than by chance.
    """
    made, foam = foam_of_wind(speed)
    moments = np.linspace(0.0, made.document["loop"], 150, endpoint=False)
    breaking = np.mean([np.mean(cells) for cells in breaking_cells(made, foam, moments)])
    state, law = foam["decay"] * foam["strength"] * breaking, 3.84e-6 * speed**3.41
    assert state == pytest.approx(law, rel=0.3, abs=1e-5)


@pytest.mark.parametrize("speed", [10.0, 15.0, 20.0])
def test_foam_in_cells_of_the_page_covers_what_whitecaps_cover(speed):
    """Stepped as in `foamStepShader`, from clean water over four times the decay on."""
    made, foam = foam_of_wind(speed)
    decay, step = foam["decay"], 0.1
    left, amount, covered = np.exp(-step / decay), 0.0, []
    for breaking in breaking_cells(made, foam, np.arange(0.0, 4.0 * decay + 10.0, step)):
        amount = left * amount + (1.0 - left) * decay * foam["strength"] * breaking
        covered.append(np.mean(-np.expm1(-amount)))
    assert np.mean(covered[-100:]) == pytest.approx(3.84e-6 * speed**3.41, rel=0.25)


def test_moving_seas_have_the_foam_of_all_waves_too():
    moving = MovingSeas()
    made, _ = foam_of_wind(9.0)
    moving.start(made)
    changed = made.state.changed({"wind_speed": 8.5})
    assert moving.can_make(changed)
    threshold = moving.make(changed, 2).document["foam"]["threshold"]
    exact = make_exact(changed, 3, points=4).cascade
    assert mean_coverage(exact, threshold) == pytest.approx(3.84e-6 * 8.5**3.41, rel=0.25)


def test_a_job_that_bakes_foam_keeps_its_own():
    text = '[ocean]\nn = 16\n[bake]\nmaps = ["foam"]\n[bake.foam]\nthreshold = 0.5\ntau = 2.0\n'
    foam = make_exact(State.of_job(fo.Job.from_toml(text)), 1).document["foam"]
    assert foam == {"decay": 2.0, "threshold": 0.5, "strength": 60.0}


def test_still_air_is_no_wind():
    """Without a speed there is no direction either; slopes below the samples are not known."""
    still = make_exact(small_state(wind_speed=0.0), 1).document
    assert still["wind"] is None
    blowing = make_exact(small_state(wind_speed=6.0, wind_direction=70.0), 1).document
    assert blowing["wind"] == {"speed": 6.0, "direction": 70.0}


def test_a_newer_state_is_wanted_until_its_own_sea_is_made():
    """The sea of the state before does not count for it."""
    first, second = small_state(seed=1), small_state(seed=2)
    seen = []

    async def run():
        worker = Worker()
        begun, go = threading.Event(), threading.Event()
        maker = SeaMaker(worker, lambda sea: seen.append((sea.state, maker.busy)), seen.append)
        waiting = asyncio.create_task(worker.run(lambda: begun.set() or go.wait(600.0)))
        while not begun.is_set():
            await asyncio.sleep(0.001)
        maker.want(first)
        making = asyncio.create_task(maker.run())
        await asyncio.sleep(0)  # the first is being made, behind what the worker waits for
        maker.want(second)
        go.set()
        await waiting
        for count in (1, 2):
            while len(seen) < count:
                await asyncio.sleep(0.005)
            assert [busy for _, busy in seen] == [True, False][:count]
        making.cancel()
        assert worker.stop(60.0)
        return maker.busy

    assert asyncio.run(run()) is False
    assert [state.values["seed"] for state, _ in seen] == [1, 2]


def test_notes_are_the_warnings_of_the_library():
    made = make_exact(small_state(wind_speed=0.0, swell_speed=0.0), 1)
    assert any("exactly flat" in note for note in made.notes)
    assert make_exact(small_state(), 1).notes == ()
    short = make_exact(small_state(loop=10.0), 1)
    assert any("loop of 10 s" in note for note in short.notes)


def test_the_container_is_a_package_that_the_library_reads():
    made = make_exact(small_state(), 5, points=4)
    package = from_bytes(made.data)
    assert package.document["id"] == 5
    assert package.document["wind"] == {"speed": 11.0, "direction": 30.0}
    assert make_exact(small_state(wind_speed=0.0), 1).document["wind"] is None


def test_moving_seas_are_made_for_another_sea_on_the_same_tiles_alone():
    state, moving = small_state(), MovingSeas()
    assert not moving.can_make(state)
    moving.start(make_exact(state, 1))
    for changes in (
        {"wind_speed": 6.0},
        {"wind_direction": 90.0},
        {"fetch": 20e3},
        {"swell_speed": 0.0},
        {"swell_direction": 0.0},
        {"swell_share": 0.1},
        {"depth": 15.0},
    ):
        changed = state.changed(changes)
        assert moving.can_make(changed), changes
        made = moving.make(changed, 2)
        assert (made.quality, made.cascade) == ("moving", None)
        if changes.keys() & {"wind_speed", "depth"}:
            exact = make_exact(changed, 3)
            hs = [sea.document["statistics"]["realised"]["hs"] for sea in (made, exact)]
            assert hs[0] == pytest.approx(hs[1], rel=0.01)  # variance within 2 %
    for changes in ({"seed": 1}, {"loop": 80.0}, {"choppiness": 0.5}, {"model": "pms"}):
        assert not moving.can_make(state.changed(changes)), changes


def test_waves_are_used_again_where_only_the_choppiness_changes():
    state = small_state()
    before = make_exact(state, 1)
    after = make_exact(state.changed({"choppiness": 0.5}), 2, before=before)
    for one, other in zip(before.cascade.oceans, after.cascade.oceans, strict=True):
        assert one.amplitudes is other.amplitudes
    assert (after.document["choppiness"], after.cascade.choppiness) == (0.5, 0.5)
    another = make_exact(state.changed({"seed": 9}), 3, before=before)
    assert another.cascade.oceans[0].amplitudes is not before.cascade.oceans[0].amplitudes


def test_a_reference_at_the_end_of_the_loop_is_that_at_its_beginning():
    made = make_exact(small_state(), 1)
    first, last = (reference_fields(made, tick)[0] for tick in (0, made.document["ticks"]))
    assert first[-8 * 4 * 256 :] == last[-8 * 4 * 256 :]


def run_maker(states, *, until):
    """Ask for states one after another at once; return the seas and the failures."""
    made, failed = [], []

    async def run():
        worker = Worker()
        maker = SeaMaker(worker, made.append, lambda state, error: failed.append((state, error)))
        making = asyncio.create_task(maker.run())
        for state in states:
            maker.want(state)
            await asyncio.sleep(0)
        while not until(made, failed) or maker.busy:
            await asyncio.sleep(0.005)
        making.cancel()
        assert worker.stop(20.0)
        return maker

    return made, failed, asyncio.run(run())


def test_the_newest_state_wins():
    states = [small_state(seed=i) for i in range(50)]
    made, failed, maker = run_maker(
        states, until=lambda made, _: made and made[-1].state is states[-1]
    )
    assert failed == []
    assert len(made) <= 3  # the first, perhaps one more, the last
    assert [sea.number for sea in made] == sorted(sea.number for sea in made)
    assert maker.exact(None).state is states[-1]
    with pytest.raises(ParameterError, match="an exact sea that is kept"):
        maker.exact(10**6)


def test_a_sea_that_fails_in_any_way_is_told_and_the_next_is_made(monkeypatch):
    good, bad = small_state(), small_state(seed=1)
    cascade = State.cascade

    def fail(state, **options):
        if state.values["seed"] == 1:
            raise MemoryError("no memory")
        return cascade(state, **options)

    monkeypatch.setattr(State, "cascade", fail)
    _, failed, _ = run_maker([bad], until=lambda _, failed: failed)
    assert [(state, repr(error)) for state, error in failed] == [(bad, "MemoryError('no memory')")]
    made, _, _ = run_maker([good], until=lambda made, _: made)
    assert made[0].state is good


def test_a_worker_ends_without_waiting_for_its_function():
    release = threading.Event()

    async def run():
        worker = Worker()
        task = asyncio.create_task(worker.run(lambda: release.wait(20.0)))
        await asyncio.sleep(0.05)
        assert not worker.stop(0.0)
        task.cancel()
        release.set()
        assert worker.stop(20.0)

    asyncio.run(run())
