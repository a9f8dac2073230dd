"""
Alternating measurements of time.

The speed of a machine changes from second to second, with its clock and its other processes.
Contenders therefore run alternately, ratios are taken within each round, and the result is the
median of these ratios with its quartiles, rather than a ratio of best times.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fftocean.arrays import Real

Clock = Literal["cpu", "wall"]
"""
`cpu`: the time of all threads of this process, which other processes hardly affect. `wall`: elapsed
time.
"""

# [s], the shortest sample: far above the clocks' resolution of 1e-6, and several frames of a tile
# that fits the cache
SAMPLE = 5e-3
ROUNDS = 3  # the smallest number of rounds


@dataclass(frozen=True, slots=True)
class Summary:
    """The median and quartiles of samples, and their number."""

    median: float
    low: float  # a quarter of the samples lie below
    high: float  # a quarter of the samples lie above
    count: int


@dataclass(frozen=True, slots=True)
class Rounds:
    """
    The samples of contenders that ran alternately.

    Each array holds seconds a call, (rounds,); entry i of all arrays is from round i.
    """

    cpu: Mapping[str, Real]
    wall: Mapping[str, Real]

    def of(self, name: str, clock: Clock) -> Real:
        """Return the samples of one contender [s]."""
        return (self.cpu if clock == "cpu" else self.wall)[name]

    def seconds(self, name: str, clock: Clock) -> Summary:
        """Return the summary of one contender [s]."""
        return summary(self.of(name, clock))

    def ratio(self, slow: str, fast: str, clock: Clock) -> Summary:
        """Return the summary of the ratios of `slow` to `fast`, round by round [-]."""
        return summary(self.of(slow, clock) / self.of(fast, clock))


def summary(samples: Sequence[float] | Real) -> Summary:
    """
    Return the median and quartiles of samples (linear between the order statistics).

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
    Time contenders alternately for about `seconds`, after a warm-up.

    Each first runs twice untimed: once to compile and plan, once to find the number of calls in a
    sample. Every other round runs in reverse, so that no contender always finds the same cache.

    Args:
        contenders: functions to call, by name.
        seconds: the time after which to stop, once there are `least` rounds [s].
        least, most: limits of the number of rounds.
        sample: shorter calls are repeated until a sample takes this long [s].
        tick: called after each round, to show progress.
    """
    calls = {name: _calls_a_sample(run, sample) for name, run in contenders.items()}
    cpu: dict[str, list[float]] = {name: [] for name in contenders}
    wall: dict[str, list[float]] = {name: [] for name in contenders}
    end = time.perf_counter() + seconds
    sequence = list(contenders)
    done = 0
    while done < most and (done < least or time.perf_counter() < end):
        for name in sequence:
            run, repeats = contenders[name], range(calls[name])
            c, w = time.process_time(), time.perf_counter()
            for _ in repeats:
                run()
            w, c = time.perf_counter() - w, time.process_time() - c
            cpu[name].append(c / calls[name])
            wall[name].append(w / calls[name])
        sequence.reverse()
        done += 1
        if tick:
            tick()
    return Rounds(
        {name: np.array(t) for name, t in cpu.items()},
        {name: np.array(t) for name, t in wall.items()},
    )


def _calls_a_sample(run: Callable[[], object], sample: float) -> int:
    """
    Warm up, and return the number of calls that fill a sample [s].

    A call that takes a quarter of a second is not repeated to warm up.
    """
    once = _seconds(run)
    if once < 0.25:
        once = _seconds(run)
    return max(1, min(10_000, round(sample / max(once, 1e-9))))


def _seconds(run: Callable[[], object]) -> float:
    """Return the elapsed time of one call [s]."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start
