"""Statistics of timings on an artificial clock, independent of the machine."""

import statistics

import numpy as np
import pytest

from fftocean.bench import timing


class Clock:
    """
    A machine whose speed drifts: work of one second takes `speed` seconds, and speed changes as
    work is done.
    """

    def __init__(self, monkeypatch, drift=1.0, away=0.0):
        self.wall = self.cpu = 0.0
        self.speed, self.drift, self.away = 1.0, drift, away
        self.log = []
        monkeypatch.setattr(timing.time, "perf_counter", lambda: self.wall)
        monkeypatch.setattr(timing.time, "process_time", lambda: self.cpu)

    def work(self, name, seconds):
        def run():
            self.log.append(name)
            self.cpu += seconds * self.speed
            self.wall += seconds * self.speed + self.away
            self.speed *= self.drift

        return run


def test_a_summary_is_the_median_with_quartiles():
    s = timing.summary([4.0, 1.0, 3.0, 2.0, 5.0])
    assert (s.low, s.median, s.high, s.count) == (2.0, 3.0, 4.0, 5)
    samples = np.random.default_rng(1).lognormal(size=101)
    low, median, high = statistics.quantiles(
        samples, n=4, method="inclusive"
    )  # another author's quartiles
    s = timing.summary(samples)
    assert (s.low, s.median, s.high) == pytest.approx((low, median, high), rel=1e-13)


@pytest.mark.parametrize("samples", [[], [1.0, np.nan], [np.inf]])
def test_empty_or_infinite_samples_are_refused(samples):
    with pytest.raises(ValueError, match="finite, and at least one"):
        timing.summary(samples)


def test_contenders_alternate_and_every_other_round_is_reversed(monkeypatch):
    clock = Clock(monkeypatch)
    timing.alternate(
        {name: clock.work(name, 1.0) for name in "abc"}, seconds=0.0, least=4, sample=0.0
    )
    assert "".join(clock.log) == "abc" + "abc" + "cba" + "abc" + "cba"  # warmed up first


def test_ratios_hold_on_a_machine_that_slows_down(monkeypatch):
    """
    Work that takes 3 times as long, on a machine that becomes 10 % slower with each call: medians
    are far off, ratios are not.
    """
    clock = Clock(monkeypatch, drift=1.1)
    rounds = timing.alternate(
        {"slow": clock.work("slow", 3.0), "fast": clock.work("fast", 1.0)},
        seconds=0.0,
        least=10,
        sample=0.0,
    )
    times = rounds.of("fast", "cpu")
    assert times[-1] / times[0] > 5.0
    assert rounds.ratio("slow", "fast", "cpu").median == pytest.approx(
        3.0, rel=0.1
    )  # either runs first: 3 x 1.1 or 3 / 1.1
    ratios = rounds.of("slow", "cpu") / rounds.of("fast", "cpu")
    assert ratios == pytest.approx([3.0 / 1.1, 3.0 * 1.1] * 5)
    assert rounds.seconds("fast", "cpu").count == 10


def test_time_lost_to_other_processes_is_in_wall_time_only(monkeypatch):
    clock = Clock(monkeypatch, away=4.0)
    rounds = timing.alternate({"a": clock.work("a", 1.0)}, seconds=0.0, sample=0.0)
    assert rounds.seconds("a", "cpu").median == 1.0
    assert rounds.seconds("a", "wall").median == 5.0


def test_short_calls_are_repeated_until_a_sample_is_long_enough(monkeypatch):
    clock = Clock(monkeypatch)
    rounds = timing.alternate(
        {"short": clock.work("short", 1e-4), "long": clock.work("long", 1.0)},
        seconds=0.0,
        least=3,
        sample=5e-3,
    )
    assert clock.log.count("short") == 2 + 3 * 50
    assert clock.log.count("long") == 1 + 3  # it needs no second call to be warm
    assert rounds.seconds("short", "cpu").median == pytest.approx(
        1e-4, rel=1e-9
    )  # of one call: sums of 1e-4 round at 1e-16


@pytest.mark.parametrize(
    ("seconds", "least", "most", "expected"), [(0.0, 3, 9, 3), (10.0, 3, 100, 10), (1e9, 3, 7, 7)]
)
def test_it_stops_when_the_time_is_up_but_not_before_enough_rounds(
    monkeypatch, seconds, least, most, expected
):
    clock, ticks = Clock(monkeypatch), []
    run = {"a": clock.work("a", 1.0)}
    rounds = timing.alternate(
        run, seconds=seconds, least=least, most=most, sample=0.0, tick=lambda: ticks.append(1)
    )
    assert rounds.seconds("a", "wall").count == len(ticks) == expected


def test_the_real_clocks_run():
    """No figure is asserted but that work takes time, and sleep no processor."""
    rounds = timing.alternate({"work": lambda: sum(range(20_000))}, seconds=0.0, sample=0.0)
    assert np.all(rounds.of("work", "cpu") > 0.0)
    assert np.all(rounds.of("work", "wall") > 0.0)
    assert rounds.seconds("work", "cpu").count == timing.ROUNDS
