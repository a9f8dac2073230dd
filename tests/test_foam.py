"""
Foam remembers, decays, and closes its loop: against a dense quadrature of the integral, and against
what must hold of any.
"""

import itertools
import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.fields import DISPLACEMENT_GRADIENT
from fftocean.foam import SPAN, Foam, coverage, longest_step, spans_of

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
LOOP = 24.0
FOAM = Foam(tau=2.0, threshold=0.8, strength=40.0)


@pytest.fixture(scope="module")
def ocean():
    return fo.Ocean(
        fo.Sea.from_wind(speed=10.0, fetch=100e3),
        n=24,
        size=60.0,
        loop=LOOP,
        seed=3,
        choppiness=1.2,
    )


def whole_loop(ocean, count, foam=FOAM):
    """The states of every frame, (count, ny, nx)."""
    starts = foam.starts(
        [foam.response(ocean, count, *span) for span in spans_of(count)], ocean, count
    )
    spans = zip(spans_of(count), starts, strict=True)
    return np.stack(
        [f.copy() for span, start in spans for _, f in foam.states(ocean, count, start, *span)]
    )


def difference(a, b):
    """Root mean square of a - b over that of b."""
    return math.sqrt(np.mean((a - b) ** 2) / np.mean(b**2))


def eigenvalues_summed(ocean, ix, iy, times):
    """
    Return the smallest eigenvalue at grid points and times, (times, points): waves summed one by
    one, eigenvalues by numpy.
    """
    w = ocean.modes()
    k = np.hypot(w.kx, w.ky)
    x, y = ix * ocean.grid.lx / ocean.grid.nx, iy * ocean.grid.ly / ocean.grid.ny
    place = np.exp(1j * (np.outer(x, w.kx) + np.outer(y, w.ky) - w.phase))
    turn = np.exp(-1j * np.outer(times, w.omega))
    xx, xy, yy = (
        -np.real(np.einsum("tm,pm->tp", turn * (w.amplitude * a * b / k), place, optimize=True))
        for a, b in ((w.kx, w.kx), (w.kx, w.ky), (w.ky, w.ky))
    )
    c = ocean.choppiness
    rows = [[1 + c * xx, c * xy], [c * xy, 1 + c * yy]]
    deformation = np.stack([np.stack(row, -1) for row in rows], -1)
    return np.linalg.eigvalsh(deformation)[..., 0]


def test_against_a_dense_quadrature(ocean):
    """
    f(t) = integral over all the past of e^{-(t - s)/tau} source(s): 6000 rectangles a loop, whose
    error is 1e-4 here.

    Steps of a third of a radian, cubic between, are good for half a percent of the root mean square
    (`longest_step`).
    """
    ix, iy = (c.ravel() for c in np.meshgrid(np.arange(0, 24, 3), np.arange(0, 24, 3)))
    dense = 6000
    times = np.arange(dense) * (LOOP / dense)
    source = 40.0 * np.maximum(0.8 - eigenvalues_summed(ocean, ix, iy, times), 0.0)
    memory = np.exp(-times / 2.0) / (
        1.0 - math.exp(-LOOP / 2.0)
    )  # of all the turns of the loop before
    memory[0] = 0.5 * memory[0] + 0.5 * memory[0] * math.exp(
        -LOOP / 2.0
    )  # both ends of the integral fall on one sample
    count = 60
    truth = np.fft.ifft(np.fft.fft(source, axis=0) * np.fft.fft(memory)[:, None], axis=0).real[
        :: dense // count
    ] * (LOOP / dense)
    ours = whole_loop(ocean, count)[:, iy, ix]
    assert np.mean(truth > 1e-3) > 0.1  # there is foam to speak of
    assert difference(ours, truth) < 0.01
    assert np.max(np.abs(ours - truth)) < 0.01 * np.max(truth)


def test_the_loop_closes(ocean):
    """
    From the last stored state on to frame F: the state of frame 0, to the roundings of some hundred
    steps.
    """
    for count in (1, 5, SPAN, 2 * SPAN + 3):
        spans = spans_of(count)
        starts = FOAM.starts([FOAM.response(ocean, count, *span) for span in spans], ocean, count)
        *_, (j, last) = FOAM.states(ocean, count, starts[-1], spans[-1][0], count + 1)
        assert j == count
        assert np.max(starts[0]) > 0.1
        assert np.max(np.abs(last - starts[0])) < 1e-12
        assert np.max(np.abs(coverage(last) - coverage(starts[0]))) <= 1e-6


@pytest.mark.parametrize("count", [30, 48, 240])
def test_halving_the_step_changes_less_than_one_percent(ocean, count):
    """Twice as many frames: the same foam at the frames that both have."""
    coarse, fine = whole_loop(ocean, count), whole_loop(ocean, 2 * count)[::2]
    assert difference(coarse, fine) < 0.01
    assert np.max(np.abs(coverage(coarse) - coverage(fine))) < 0.01


def test_a_frame_s_bits_do_not_depend_on_who_asks(ocean):
    """
    From a stored state, frames alone, in any number, by another ocean: the same bits; and `loop`
    yields these.
    """
    count = 2 * SPAN + 5
    spans = spans_of(count)
    assert spans == [(0, SPAN), (SPAN, 2 * SPAN), (2 * SPAN, count)]
    starts = FOAM.starts(
        [FOAM.response(ocean, count, *span) for span in reversed(spans)][::-1], ocean, count
    )
    whole = [coverage(f) for f in whole_loop(ocean, count)]
    twin = fo.Ocean(ocean.sea, n=24, size=60.0, loop=LOOP, seed=3, choppiness=1.2)
    for j in (2 * SPAN + 2, SPAN + 7, SPAN):
        m = j // SPAN
        *_, (last, state) = FOAM.states(twin, count, starts[m], SPAN * m, j + 1)
        assert last == j
        assert np.array_equal(coverage(state), whole[j])
    assert all(np.array_equal(a, b) for a, b in zip(FOAM.loop(ocean, count), whole, strict=True))


def test_one_wave_on_average():
    """
    Threshold 1 and one wave: the source is strength c a k max(cos, 0), 1/pi of the amplitude on
    average; the mean foam is tau times that.

    Frames equally spaced over whole periods: the mean of 64 of them is exact but for overtones that
    alias; the error is the step's.
    """
    a, size, c = 0.6, 20.0, 0.9
    ocean = fo.Ocean.from_modes([(1, 0, a, 0.3)], n=8, size=size, loop=16.0, choppiness=c)
    states = whole_loop(ocean, 64, Foam(tau=1.5, threshold=1.0, strength=2.0))
    mean = 1.5 * 2.0 * c * a * (2.0 * math.pi / size) / math.pi
    assert np.mean(states) == pytest.approx(mean, rel=0.003)
    assert np.allclose(states.mean(axis=0), mean, rtol=0.01)


def test_foam_follows_the_crest():
    """
    A wave that goes east leaves its foam behind it: west of where it breaks; and where it breaks is
    the crest.
    """
    ocean = fo.Ocean.from_modes([(1, 0, 1.0, 0.0)], n=64, size=20.0, loop=16.0, dtype="float64")
    ocean_frame = ocean.loop_frame(3, 16, ("height",))
    foam = list(Foam(tau=0.5, threshold=0.9, strength=20.0).loop(ocean, 16))[3][0]
    crest = int(np.argmax(ocean_frame.height[0]))
    behind, ahead = foam[(crest - 12) % 64], foam[(crest + 12) % 64]
    assert behind > 2.0 * ahead
    assert foam[crest] > 0.2


def test_no_foam_where_nothing_breaks():
    calm = fo.Ocean.from_modes([], n=4, size=20.0, loop=8.0)
    assert not np.any(list(Foam(threshold=1.0).loop(calm, 3)))
    assert longest_step(calm) == math.inf
    assert not np.any(Foam(threshold=1.0).live(calm).at(9.0))
    small = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=20.0, loop=8.0)  # eigenvalue 0.97
    assert not np.any(list(Foam().loop(small, 3)))


def test_coverage_stays_within_0_and_1(ocean):
    for cover in Foam(tau=100.0, threshold=1.0, strength=1e6).loop(ocean, 2):
        assert cover.dtype == np.float32
        assert cover.min() >= 0.0
        assert cover.max() == 1.0


def test_live_foam_becomes_that_of_the_loop(ocean):
    """
    Ten decay times after clean water, e^-10 is left of it. The steps are other ones, and linear
    between: 3 % of the mean square.
    """
    looped = whole_loop(ocean, 48)
    live = FOAM.live(ocean, t=-10.0 * FOAM.tau)
    shown = np.stack([live.at(j * LOOP / 48) for j in range(48)])
    assert difference(shown, coverage(looped)) < 0.03
    assert abs(np.mean(shown) - np.mean(coverage(looped))) < 0.01 * np.mean(shown)


def test_live_foam_does_not_depend_on_how_often_it_is_asked(ocean):
    often, seldom = FOAM.live(ocean, t=1.0), FOAM.live(ocean, t=1.0)
    for t in np.arange(1.0, 9.0, 1 / 60):
        often.at(float(t))
    assert np.array_equal(often.at(9.1), seldom.at(9.1))
    assert np.array_equal(often.at(9.1), seldom.at(9.1))  # the same moment once more
    with pytest.raises(
        fo.ParameterError, match=r"cannot go back: t must be at least 9\.1, got 9\.0"
    ):
        often.at(9.0)


def test_live_foam_leaps(ocean, monkeypatch):
    """
    A leap of a thousand decay times costs twenty, and ends where a start thirty before it ends.
    """
    asked = itertools.count()
    real = fo.Ocean.frame
    monkeypatch.setattr(
        fo.Ocean, "frame", lambda self, *a, **k: (next(asked), real(self, *a, **k))[1]
    )
    live, late = FOAM.live(ocean), FOAM.live(ocean, t=1940.0)
    live.at(2000.0)
    assert next(asked) < 20.0 * FOAM.tau / longest_step(ocean) + 20
    assert np.allclose(live.at(2000.0), late.at(2000.0), atol=0.02)
    assert live.at(2000.0).max() > 0.1


def test_live_foam_starts_clean(ocean):
    live = FOAM.live(ocean, t=5.0)
    assert not np.any(live.at(5.0))
    assert np.any(live.at(6.0))


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"tau": 0.0}, "tau must be between 0.001 and 1e\\+06 s"),
        ({"tau": math.nan}, "tau must be"),
        ({"threshold": 1.1}, "threshold must be between -10 and 1,"),
        ({"strength": -1.0}, "strength must be between 0 and 1e\\+06 1/s"),
        ({"tau": "long"}, "tau must be a number"),
    ],
)
def test_impossible_foam_is_refused(changes, says):
    with pytest.raises(fo.ParameterError, match=says):
        Foam(**changes)


def test_a_sea_without_a_loop_has_no_foam_of_a_loop():
    free = fo.Ocean.from_modes([(1, 0, 1.0, 0.0)], n=8, size=20.0)
    with pytest.raises(fo.ParameterError, match="needs an ocean that loops"):
        list(Foam().loop(free, 4))
    assert np.any(Foam(threshold=1.0).live(free).at(3.0))


@pytest.mark.parametrize(
    "wrong",
    [None, 3, "sea", {}, np.zeros(3), fo.Ocean, fo.Sea.from_wind(speed=5.0, fetch=1e4)],
    ids=lambda w: type(w).__name__,
)
def test_what_is_no_water_is_refused_by_name(wrong, ocean):
    clean = np.zeros(ocean.grid.shape)
    for call in (
        lambda: list(Foam().loop(wrong, 4)),
        lambda: Foam().live(wrong),
        lambda: Foam().response(wrong, 4, 0, 4),
        lambda: Foam().starts([clean], wrong, 4),
        lambda: list(Foam().states(wrong, 4, clean, 0, 4)),
    ):
        with pytest.raises(fo.ParameterError, match="foam needs an Ocean"):
            call()
    if not isinstance(wrong, int):
        with pytest.raises(fo.ParameterError, match="count must be a whole number"):
            list(Foam().loop(ocean, wrong))


@pytest.mark.parametrize(("tau", "count"), [(1e-3, 4), (1e6, 4)])
def test_extreme_decay_times(tau, count, ocean):
    """
    Decay within a step, and none within a loop: the mean of the state is tau times the mean of the
    source, as for any tau.
    """
    states = whole_loop(ocean, count, Foam(tau=tau, threshold=0.9, strength=1.0))
    assert np.all(np.isfinite(states))
    if tau > 1.0:
        source = [
            np.maximum(
                0.9 - fo.minimum_eigenvalue(ocean.loop_frame(j, 400, DISPLACEMENT_GRADIENT)), 0.0
            )
            for j in range(400)
        ]
        assert np.mean(states) == pytest.approx(tau * np.mean(source), rel=0.003)
    else:
        now = [
            np.maximum(
                0.9 - fo.minimum_eigenvalue(ocean.loop_frame(j, count, DISPLACEMENT_GRADIENT)), 0.0
            )
            for j in range(count)
        ]
        assert difference(states, tau * np.stack(now)) < 0.01
