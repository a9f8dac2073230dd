"""Quick benchmark of frames, in about two minutes."""

import time
import warnings
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from fftocean import host
from fftocean.bench import machine
from fftocean.bench.contenders import Careful, DirectSum, Fast, Textbook, require_same_water
from fftocean.bench.fits import crossover
from fftocean.bench.results import Condition, Entry, Pair, Reading, Result, answer, race
from fftocean.errors import ParameterError, SeaWarning
from fftocean.fields import EIGHT
from fftocean.limits import SAMPLES, Quantity
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea

SIZES = (128, 256, 512, 1024)
DIRECT_SIZES = (4, 6, 8, 10, 12, 16, 24, 32, 48, 64, 128)
SECONDS = Quantity("s", 0.0, 86400.0)
ASKS = "What does a frame cost on this machine, and by other methods?"
# the largest number of waves x points in one call of the direct sum, about half a second; beyond
# this only some of the points are summed
DIRECT_CALL = 2.5e7
# of the largest value: float32 has 1e-7, the rounding of a transform ten times that, normals more;
# the difference from another sea is 1
WITHIN = 1e-5


def sea() -> Sea:
    """Return the sea of all benchmarks: a fresh breeze over 100 km, in deep water."""
    return Sea.from_wind(speed=10.0, fetch=100e3)


def ocean(
    n: int,
    *,
    size: float = 300.0,
    dtype: str = "float32",
    backend: str = "auto",
    planning: str = "measure",
    threads: int = 1,
) -> Ocean:
    """Return the tile of all benchmarks, n x n."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)
        return Ocean(
            sea(),
            n=n,
            size=size,
            seed=7,
            dtype=dtype,
            backend=backend,
            planning=planning,
            threads=threads,
        )


def quick(
    *,
    seconds: float = 120.0,
    sizes: Sequence[int] = SIZES,
    direct_sizes: Sequence[int] = DIRECT_SIZES,
    progress: Callable[[str, float], object] | None = None,
) -> Result:
    """
    Measure for about `seconds`; the shortest run takes about ten.

    Args:
        seconds: the duration, compilation and planning included [s].
        sizes: samples a side of the frames.
        direct_sizes: samples a side at which the direct sum is timed, ascending.
        progress: called with the name of the current part and the elapsed share of the time, 0
            to 1.

    Raises:
        ParameterError: a value out of range.
    """
    SECONDS.check("seconds", seconds)
    for n in (*sizes, *direct_sizes):
        SAMPLES.check("n", n)
    if not sizes or len(direct_sizes) < 2 or list(direct_sizes) != sorted(set(direct_sizes)):
        raise ParameterError(
            "sizes must be at least one, and direct_sizes at least two, strictly ascending"
        )
    before, start = machine.moment(), time.perf_counter()

    def say(part: str) -> None:
        if progress:
            progress(part, min(1.0, (time.perf_counter() - start) / max(seconds, 1e-9)))

    readings: list[Reading] = []
    shares = len(sizes) + 1.0  # of the time: one for each size, one for the direct sum
    for i, n in enumerate(sizes):
        say(f"frames of {n} x {n}")
        left = seconds * (i + 1) / shares - (time.perf_counter() - start)
        readings += frames(n, max(0.0, left), partial(say, f"frames of {n} x {n}"))
    for i, n in enumerate(direct_sizes):
        say(f"the direct sum at {n} x {n}")
        left = (seconds - (time.perf_counter() - start)) / (len(direct_sizes) - i)
        readings += direct(n, max(0.0, left))
    if cross := crossing(readings):
        readings.append(cross)
    say("done")
    settings = {
        "seconds": seconds,
        "sizes": list(sizes),
        "direct_sizes": list(direct_sizes),
        "planning": "measure",
    }
    return answer("bench", ASKS, readings, settings, before)


def frames(n: int, seconds: float, tick: Callable[[], object]) -> list[Reading]:
    """Time full frames against the textbook and careful contenders, then one thread against two."""
    own = ocean(n)
    at: dict[str, Condition] = {"n": n, "backend": own.backend, "dtype": "float32", "threads": 1}
    fast, textbook, careful = Fast(own), Textbook(own), Careful(own)
    require_same_water(own, {"textbook": textbook, "careful": careful}, within=WITHIN)
    full = Entry("full frame", fast, at)
    height = Entry("height only", Fast(own, ("height",)), at)
    others = [Entry("textbook", textbook, {"n": n}), Entry("careful", careful, {"n": n})]
    pairs = [Pair(f"{other.what} / full frame", other, full) for other in others]
    pairs.append(Pair("height only / full frame", height, full))
    readings = race([full, height, *others], pairs, clock="cpu", seconds=0.65 * seconds, tick=tick)
    if host.cores() > 1:
        two = Entry("full frame", Fast(ocean(n, threads=2)), {**at, "threads": 2})
        readings += race(
            [full, two],
            [Pair("one thread / two", full, two)],
            clock="wall",
            seconds=0.35 * seconds,
            tick=tick,
        )
    return readings


def direct(n: int, seconds: float) -> list[Reading]:
    """
    Time the eight linear fields by FFT against the direct sum.

    For many waves and points the direct sum is timed at some of the points, and scaled.
    """
    own = ocean(n)
    waves = max(1, own.modes().kx.size)
    slow = DirectSum(
        own, points=max(1, int(DIRECT_CALL / waves)) if waves * n * n > DIRECT_CALL else None
    )
    require_same_water(own, {"direct sum": slow}, within=WITHIN)
    fft = Entry("eight fields, FFT", Fast(own, EIGHT), {"n": n, "dtype": "float32"})
    summed = Entry(
        "eight fields, direct sum",
        slow,
        {"n": n, "points": round(slow.share * n * n), "waves": waves},
    )
    readings = race(
        [fft, summed], [Pair("direct sum / FFT", summed, fft)], clock="cpu", seconds=seconds
    )
    return [r.scaled(1.0 / slow.share) if "direct sum" in r.what else r for r in readings]


def crossing(readings: Sequence[Reading]) -> Reading | None:
    """
    Return the n from which the FFT costs less than the direct sum; None if there is none.

    Args:
        readings: of `direct`.
    """
    ratios = sorted((r for r in readings if r.what == "direct sum / FFT"), key=lambda r: r.at["n"])
    if len(ratios) < 2:
        return None
    sizes = [float(r.at["n"]) for r in ratios]
    cross = crossover(sizes, np.ones(len(ratios)), [r.median for r in ratios])
    return (
        None
        if cross is None
        else Reading("crossover", "n", cross.at, cross.below, cross.above, len(ratios), "cpu", {})
    )
