"""
Points a second of `fo.Query`, compared with SciPy: map_coordinates of each tile, and a fixed point.

A million points on a cascade of three tiles at choppiness 1, float32, at one time whose frame is
there already. SciPy's side gets the frames for nothing, and stops when its largest residual is
below 1e-3 m, which takes it some ten rounds; ours stops at 1e-9 of the largest tile, 5e-7 m.
Contenders run in turn, warmed up, and the medians' ratios count: absolute times depend on what else
the machine does. Processor time of all threads is given beside the clock's.

    python benchmarks/query.py [--points 1000000] [--seconds 20] [--json FILE]
"""

import argparse
import json
import os
import platform
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy import ndimage

import fftocean as fo

TILES = [(512, 500.0), (512, 71.0), (256, 9.3)]
ALL = ("heights", "normals", "velocities", "accelerations")


def with_scipy(
    cascade: fo.Cascade, x: np.ndarray, y: np.ndarray, t: float, order: int
) -> Callable[[], np.ndarray]:
    """
    Return a function that iterates x0 <- x - c D(x0), with D by map_coordinates.

    Cubic splines are filtered beforehand, as in `fo.Query`.
    """
    fields = ("displace_x", "displace_y", "height")
    tiles = []
    for ocean in cascade.oceans:
        frame = ocean.frame(t, fields)
        tiles.append(
            (
                ocean.grid,
                [
                    ndimage.spline_filter(frame[f], order, mode="grid-wrap")
                    if order > 1
                    else frame[f]
                    for f in fields
                ],
            )
        )

    def sample(which: int, x0: np.ndarray, y0: np.ndarray) -> np.ndarray:
        total = np.zeros(x0.shape)
        for grid, arrays in tiles:
            at = [y0 * (grid.ny / grid.ly), x0 * (grid.nx / grid.lx)]
            total += ndimage.map_coordinates(
                arrays[which], at, order=order, mode="grid-wrap", prefilter=False
            )
        return total

    def run() -> np.ndarray:
        x0, y0 = x.copy(), y.copy()
        for _ in range(100):
            dx, dy = cascade.choppiness * sample(0, x0, y0), cascade.choppiness * sample(1, x0, y0)
            apart = max(np.max(np.abs(x0 + dx - x)), np.max(np.abs(y0 + dy - y)))
            if apart < 1e-3:
                break
            x0, y0 = x - dx, y - dy
        return sample(2, x0, y0)

    return run


def alternate(
    contenders: dict[str, Callable[[], object]], seconds: float
) -> dict[str, list[tuple[float, float]]]:
    """
    Time the contenders alternately until the time is up, three rounds at least.

    Returns:
        The elapsed and CPU time of each run of each contender [s].
    """
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in contenders}
    for run in contenders.values():
        run()
    end = time.perf_counter() + seconds
    while time.perf_counter() < end or min(len(t) for t in times.values()) < 3:
        for name, run in contenders.items():
            clock, processor = time.perf_counter(), time.process_time()
            run()
            times[name].append((time.perf_counter() - clock, time.process_time() - processor))
    return times


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument(
        "--seconds", type=float, default=20.0, help="per group of contenders (default: 20)"
    )
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    machine = {
        "machine": platform.platform(),
        "cpus": os.cpu_count(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }
    print("  ".join(f"{k} {v}" for k, v in machine.items()))
    cascade = fo.Cascade(fo.Sea.from_wind(speed=10.0, fetch=100e3), TILES, seed=7, choppiness=1.0)
    print(cascade)
    n, t = options.points, 3.7
    side = int(np.sqrt(n))
    patch = [
        a.ravel()
        for a in np.meshgrid(
            np.arange(side) * (500.0 / side), np.arange(n // side) * (500.0 / side)
        )
    ]
    places = {
        "random over 4 km": np.random.default_rng(0).uniform(-2000.0, 2000.0, (2, n)),
        "a grid over 500 m": patch,
    }
    rows = []

    def report(where: str, count: int, times: dict[str, list[tuple[float, float]]]) -> None:
        for name, pairs in times.items():
            clock, processor = (statistics.median(column) for column in zip(*pairs, strict=True))
            rows.append(
                {
                    "where": where,
                    "what": name,
                    "points": count,
                    "median_s": clock,
                    "processor_s": processor,
                    "runs": len(pairs),
                }
            )
            rate, per_core = count / clock / 1e6, count / processor / 1e6
            print(
                f"{where:18s}  {name:36s} {1e3 * clock:10.3f} ms  {rate:6.2f} M points/s, "
                f"{per_core:5.2f} M a core  ({len(pairs)} runs)"
            )

    for where, (x, y) in places.items():
        contenders: dict[str, Callable[[], object]] = {}
        for mode in ("bilinear", "bicubic"):
            for threads in (1, 2):
                query = fo.Query(cascade, mode=mode, threads=threads)
                query.at(x[:10], y[:10], t)
                contenders[f"{mode}, heights, {threads} thread{'s' * (threads > 1)}"] = (
                    lambda q=query, x=x, y=y: q.at(x, y, t, "heights")
                )
                if threads == 1:
                    contenders[f"{mode}, everything, 1 thread"] = lambda q=query, x=x, y=y: q.at(
                        x, y, t, ALL
                    )
        report(where, x.size, alternate(contenders, options.seconds))
        fewer = slice(
            0, max(n // 20, 1)
        )  # SciPy is slow, and its time goes with the number of points
        beside = {
            f"SciPy, order {order}, heights": with_scipy(cascade, x[fewer], y[fewer], t, order)
            for order in (1, 3)
        }
        report(where, x[fewer].size, alternate(beside, options.seconds / 4))
    for count in (1, 100, 10_000):
        query = fo.Query(cascade, mode="bicubic")
        x, y = places["random over 4 km"][:, :count]
        query.at(x, y, t)
        report(
            "the same t again",
            count,
            alternate(
                {"bicubic, heights": lambda q=query, x=x, y=y: q.at(x, y, t, "heights")}, 1.0
            ),
        )
        report(
            "the same t again",
            count,
            alternate({"bicubic, everything": lambda q=query, x=x, y=y: q.at(x, y, t, ALL)}, 1.0),
        )
    moments = iter(range(10**9))
    query = fo.Query(cascade, mode="bicubic")
    x, y = places["random over 4 km"][:, :100]
    report(
        "a new t each time",
        100,
        alternate(
            {"bicubic, heights": lambda: query.at(x, y, next(moments) / 50.0, "heights")}, 3.0
        ),
    )
    report(
        "a new t each time",
        100,
        alternate({"bicubic, everything": lambda: query.at(x, y, next(moments) / 50.0, ALL)}, 3.0),
    )
    exact = fo.Query(cascade, mode="exact")
    report(
        "a new t each time",
        4,
        alternate(
            {"exact, everything": lambda: exact.at(x[:4], y[:4], next(moments) / 50.0, ALL)}, 1.0
        ),
    )
    if options.json:
        options.json.write_text(json.dumps({**machine, "rows": rows}, indent=2) + "\n")


if __name__ == "__main__":
    main()
