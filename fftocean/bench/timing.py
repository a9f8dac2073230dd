"""
Who is faster, and by how much: contenders that take turns, and ratios taken turn by turn.

A machine is never the same for two seconds: clocks rise and sink, others come and go. So the
contenders run in turn, each ratio is taken between two that ran side by side, and what is reported
is the median of these ratios with its quartiles, not a ratio of best times.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fftocean.arrays import Real

Clock = Literal["cpu", "wall"]
"""
`cpu`: the time of all threads of this process, which others cannot lengthen much. `wall`: what a
clock on the wall shows.
"""

# [s] that one sample takes at least: far above the clocks' own 1e-6, and several frames of what
# fits the cache
SAMPLE = 5e-3
ROUNDS = 3  # at least


@dataclass(frozen=True, slots=True)
class Summary:
    """A median with its quartiles, and of how many."""

    median: float
    low: float  # a quarter of the samples lie below
    high: float  # a quarter of the samples lie above
    count: int


@dataclass(frozen=True, slots=True)
class Rounds:
    """
    The samples of contenders that took turns: seconds a call, (rounds,) for each, of both clocks;
    entry i of all is from round i.
    """

    cpu: Mapping[str, Real]
    wall: Mapping[str, Real]

    def of(self, name: str, clock: Clock) -> Real:
        """The samples of one contender [s]."""
        return (self.cpu if clock == "cpu" else self.wall)[name]

    def seconds(self, name: str, clock: Clock) -> Summary:
        """Sum up one contender [s]."""
        return summary(self.of(name, clock))

    def ratio(self, slow: str, fast: str, clock: Clock) -> Summary:
        """How many times as long `slow` takes as `fast`, round by round [-]."""
        return summary(self.of(slow, clock) / self.of(fast, clock))


def summary(samples: Sequence[float] | Real) -> Summary:
    """
    Sum samples up by their median and quartiles (linear between the order statistics).

    Raises:
        ValueError: no samples, or one that is not finite.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.size == 0 or not np.all(np.isfinite(values)):
        raise ValueError(f"samples must be finite, and at least one, got {values!r:.80}")
    low, median, high = (float(q) for q in np.percentile(values, [25.0, 50.0, 75.0]))
    return Summary(median, low, high, int(values.size))


def alternate(
    contenders: Mapping[str, Callable[[], object]],
    *,
    seconds: float,
    least: int = ROUNDS,
    most: int = 1000,
    sample: float = SAMPLE,
    tick: Callable[[], object] | None = None,
) -> Rounds:
    """
    Time contenders in turn, warmed up, for about `seconds`.

    Each first runs twice untimed: once to compile and plan, once to see how many calls make a
    sample. Every other round goes backwards, so that nobody always inherits the same neighbour's
    cache.

    Args:
        contenders: what to call, by name.
        seconds: when to stop, once there are `least` rounds.
        least, most: rounds.
        sample: shorter calls are repeated until a sample takes this long [s].
        tick: called after each round, to show that something goes on.
    """
    calls = {name: _calls_a_sample(run, sample) for name, run in contenders.items()}
    cpu: dict[str, list[float]] = {name: [] for name in contenders}
    wall: dict[str, list[float]] = {name: [] for name in contenders}
    end = time.perf_counter() + seconds
    order = list(contenders)
    done = 0
    while done < most and (done < least or time.perf_counter() < end):
        for name in order:
            run, repeats = contenders[name], range(calls[name])
            c, w = time.process_time(), time.perf_counter()
            for _ in repeats:
                run()
            w, c = time.perf_counter() - w, time.process_time() - c
            cpu[name].append(c / calls[name])
            wall[name].append(w / calls[name])
        order.reverse()
        done += 1
        if tick:
            tick()
    return Rounds(
        {name: np.array(t) for name, t in cpu.items()},
        {name: np.array(t) for name, t in wall.items()},
    )


def _calls_a_sample(run: Callable[[], object], sample: float) -> int:
    """
    Warm up, and count how many calls fill a sample [s]. A call that takes a quarter of a second
    needs no second one to be warm.
    """
    once = _seconds(run)
    if once < 0.25:
        once = _seconds(run)
    return max(1, min(10_000, round(sample / max(once, 1e-9))))


def _seconds(run: Callable[[], object]) -> float:
    start = time.perf_counter()
    run()
    return time.perf_counter() - start
