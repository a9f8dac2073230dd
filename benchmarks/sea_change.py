"""
CPU time of what follows when a sea is changed: while a slider moves, and at rest.

Three tiles over 420, 61 and 8.3 m. Of each step the median of CPU time of all threads, since the
clock on the wall depends on what else the machine does; the first run, which compiles, is left out.
For the moving amplitudes also their error and variance against the exact cascade.

    python benchmarks/sea_change.py [--n 128] [--runs 9]
"""

import argparse
import math
import os
import platform
import statistics
import time
from collections.abc import Callable

import numpy as np

import fftocean as fo
from fftocean.foam_coverage import threshold_for
from fftocean.moving_amplitudes import MovingAmplitudes
from fftocean.slope_variance import slope_variance

SIZES = (420.0, 61.0, 8.3)


def sea(depth: float, *, swell: bool) -> fo.Sea:
    """Return a wind sea of 11 m/s, with or without a swell."""
    wind = fo.Sea.from_wind(speed=11.0, fetch=200e3, depth=depth, direction=30.0)
    if not swell:
        return wind
    spectrum = fo.JONSWAP.from_sea_state(hs=1.5, tp=12.0, gamma=7.0)
    system = fo.WaveSystem(
        spectrum=fo.TMA(spectrum, depth), spreading=fo.CosinePower(s=25.0), direction=110.0
    )
    return fo.Sea(*wind.systems, system, depth=depth)


def median_cpu(run: Callable[[], object], runs: int) -> float:
    """Return the median CPU time of a function [ms]."""
    run()
    times = []
    for _ in range(runs):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return 1e3 * statistics.median(times)


def against(made: fo.Cascade, exact: fo.Cascade) -> tuple[float, float]:
    """Return sqrt(sum |a - b|^2 / sum |b|^2) over all waves, and the ratio of variances."""
    difference = total = 0.0
    for a, b in zip(made.oceans, exact.oceans, strict=True):
        for one, other in (
            (a.amplitudes.forward, b.amplitudes.forward),
            (a.amplitudes.backward, b.amplitudes.backward),
        ):
            difference += float(np.sum(np.abs(one - other) ** 2))
            total += float(np.sum(np.abs(other) ** 2))
    return math.sqrt(difference / total), made.variance / exact.variance


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--n", type=int, default=128, help="samples a side (default: 128)")
    parser.add_argument("--runs", type=int, default=9, help="of each step (default: 9)")
    options = parser.parse_args()
    tiles = [(options.n, size) for size in SIZES]
    print(
        f"{platform.platform()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, "
        f"Python {platform.python_version()}, NumPy {np.__version__}; 3 x {options.n}^2"
    )
    for depth in (math.inf, 40.0):
        for swell in (False, True):
            new = sea(depth, swell=swell)
            exact = fo.Cascade(new, tiles, seed=7, loop=64.0)
            start = fo.Cascade(sea(math.inf, swell=swell), tiles, seed=7, loop=64.0)
            moving = MovingAmplitudes(start)
            steps = {
                "prepare to move": lambda start=start: MovingAmplitudes(start),
                "moving amplitudes": lambda new=new, moving=moving: moving.amplitudes(new),
                "moving cascade": lambda new=new, moving=moving: moving.cascade(new),
                "exact cascade": lambda new=new: fo.Cascade(new, tiles, seed=7, loop=64.0),
                "threshold of foam": lambda exact=exact: threshold_for(exact, 11.0),
                "slope variance": lambda exact=exact: slope_variance(exact, wind_speed=11.0),
            }
            print(f"depth {depth:g} m, {'wind sea and swell' if swell else 'wind sea'}")
            for name, run in steps.items():
                print(f"  {name:20s} {median_cpu(run, options.runs):7.1f} ms of CPU")
            error, ratio = against(moving.cascade(new), exact)
            print(f"  moving: amplitudes {100 * error:.2f} % off, variance x {ratio:.4f}")


if __name__ == "__main__":
    main()
