"""Amplitudes while a sea is changed: those of the cascade of that sea, nearly, with its phases."""

import itertools

import numpy as np
import pytest

import fftocean as fo
from fftocean.moving_amplitudes import MovingAmplitudes

TILES = [(32, 300.0), (32, 41.0)]
FIRST = fo.Sea.from_wind(speed=6.0, fetch=50e3, direction=-20.0)
OTHER = fo.Sea(
    *fo.Sea.from_wind(speed=14.0, fetch=200e3, depth=25.0, direction=40.0).systems,
    fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=13.0, gamma=7.0),
        spreading=fo.CosinePower(s=25.0),
        direction=110.0,
    ),
    depth=25.0,
)


@pytest.mark.parametrize("draw", ["gaussian", "fixed"])
def test_another_sea_has_the_waves_of_its_own_cascade(draw):
    start = fo.Cascade(FIRST, TILES, seed=9, loop=64.0, amplitudes=draw)
    made = MovingAmplitudes(start).amplitudes(OTHER)
    exact = fo.Cascade(OTHER, TILES, seed=9, loop=64.0, amplitudes=draw)
    for fast, ocean in zip(made, exact.oceans, strict=True):
        slow = ocean.amplitudes
        assert (fast.grid, fast.band, fast.loop, fast.draw) == (
            *(slow.grid, slow.band, slow.loop, slow.draw),
        )
        assert (fast.depth, fast.surface_tension) == (25.0, 0.0)
        assert np.array_equal(fast.cycles, slow.cycles)
        for a, b in ((fast.forward, slow.forward), (fast.backward, slow.backward)):
            assert np.linalg.norm(a - b) < 0.01 * np.linalg.norm(b)
            both = (a != 0.0) & (b != 0.0)
            # phases are computed from the same numbers, in another order of factors
            assert np.abs(np.angle(a[both] / b[both])) == pytest.approx(0.0, abs=1e-12)
        for a, b in (
            (fast.variance_forward, slow.variance_forward),
            (fast.variance_backward, slow.variance_backward),
        ):
            assert a == pytest.approx(b, rel=0.1, abs=3e-3 * float(np.max(b)))
        assert fast.variance == pytest.approx(slow.variance, rel=5e-3)


def test_the_cascade_of_another_sea():
    """A moving cascade has the settings of the first, and nearly the frames of the exact one."""
    start = fo.Cascade(FIRST, TILES, seed=9, loop=64.0, choppiness=0.8, dtype="float64")
    moving = MovingAmplitudes(start)
    made = moving.cascade(OTHER)
    exact = fo.Cascade(OTHER, TILES, seed=9, loop=64.0, choppiness=0.8, dtype="float64")
    assert made.sea is OTHER
    assert all(ocean.sea is OTHER for ocean in made.oceans)
    assert (made.seed, made.loop, made.bands, made.choppiness, made.dtype, made.depth) == (
        *(9, 64.0, exact.bands, 0.8, "float64", 25.0),
    )
    assert [o.seed for o in made.oceans] == [o.seed for o in exact.oceans]
    for a, b in zip(made.loop_frame(77, 2**20), exact.loop_frame(77, 2**20), strict=True):
        assert np.linalg.norm(a.height - b.height) < 0.01 * np.linalg.norm(b.height)
    assert moving.cascade(OTHER, choppiness=1.3).choppiness == 1.3


def test_seas_one_after_another_do_not_disturb_each_other():
    moving = MovingAmplitudes(fo.Cascade(FIRST, TILES, seed=9))
    (before, *_), _, (after, *_) = (moving.amplitudes(sea) for sea in (OTHER, FIRST, OTHER))
    assert np.array_equal(before.forward, after.forward)
    assert not before.forward.flags.writeable


def test_a_small_step_of_a_slider_is_a_small_step_of_the_waves():
    """One degree turns the energy by one degree: nothing jumps from lattice point to point."""
    moving = MovingAmplitudes(fo.Cascade(FIRST, TILES, seed=9))
    steps = [
        moving.amplitudes(fo.Sea.from_wind(speed=14.0, fetch=200e3, direction=40.0 + 0.5 * i))[0]
        for i in range(9)
    ]
    change = [
        np.linalg.norm(b.forward - a.forward) / np.linalg.norm(a.forward)
        for a, b in itertools.pairwise(steps)
    ]
    assert max(change) < 0.02
    assert max(change) < 2.0 * min(change)


@pytest.mark.parametrize(
    "cascade", [None, "sea", fo.Ocean(FIRST, n=16, size=90.0), [fo.Ocean(FIRST, n=16, size=90.0)]]
)
def test_only_a_cascade_will_do(cascade):
    with pytest.raises(fo.ParameterError, match="cascade must be a Cascade, got "):
        MovingAmplitudes(cascade)


def test_given_waves_are_refused():
    from fftocean.cascade import from_oceans

    ocean = fo.Ocean.from_modes([(1, 2, 0.5, 0.0)], n=16, size=90.0)
    with pytest.raises(fo.ParameterError, match="made of a sea and a seed, got the given waves"):
        MovingAmplitudes(from_oceans(FIRST, 7, (ocean,)))


@pytest.mark.parametrize("sea", [None, 3.0, FIRST.systems[0]])
def test_only_a_sea_will_do(sea):
    with pytest.raises(fo.ParameterError, match="sea must be a Sea, got "):
        MovingAmplitudes(fo.Cascade(FIRST, TILES, seed=9)).amplitudes(sea)
