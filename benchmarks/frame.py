"""
How long does a full frame take, against the textbook's eight complex transforms and against the direct sum?

A full frame is height, two displacements, Jacobian and unit normals of the displaced surface, float32, one thread. The
contenders run in turn, warmed up, and the medians' ratios are what counts: absolute times depend on what else the machine does.

    python benchmarks/frame.py [--n 256 512] [--seconds 10] [--json FILE]
"""

import argparse
import json
import math
import os
import platform
import statistics
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

import fftocean as fo
from fftocean.gerstner.compiled import eight_fields

FULL = ("height", "displace_x", "displace_y", "normal", "jacobian")


def textbook(ocean: fo.Ocean) -> Callable[[], object]:
    """Eight complex128 ifft2 of filtered spectra, as tutorials do it; then normals and Jacobian in NumPy."""
    n = ocean.grid.nx
    k1 = 2 * np.pi * np.fft.fftfreq(n, ocean.grid.lx / n)
    kx, ky = np.meshgrid(k1, k1)
    k = np.hypot(kx, ky)
    k[0, 0] = 1.0
    rng = np.random.default_rng(0)
    h0 = (rng.standard_normal((n, n)) + 1j * rng.standard_normal((n, n))) / k**2
    h0_minus = np.conj(np.roll(h0[::-1, ::-1], 1, (0, 1)))
    omega = np.sqrt(9.80665 * k)
    filters = [1, 1j * kx / k, 1j * ky / k, 1j * kx, 1j * ky, -kx * kx / k, -kx * ky / k, -ky * ky / k]

    def frame() -> object:
        h = h0 * np.exp(-1j * omega * 3.7) + h0_minus * np.exp(1j * omega * 3.7)
        fields = [np.fft.ifft2(f * h).real * n * n for f in filters]
        _, _, _, sx, sy, xx, xy, yy = fields
        normal = np.cross(np.stack([1 + xx, xy, sx], -1), np.stack([xy, 1 + yy, sy], -1))
        return fields, normal / np.linalg.norm(normal, axis=-1, keepdims=True)

    return frame


def alternate(contenders: dict[str, Callable[[], object]], seconds: float) -> dict[str, list[float]]:
    """Time the contenders in turn until the time is up, at least three rounds; milliseconds."""
    times: dict[str, list[float]] = {name: [] for name in contenders}
    for run in contenders.values():
        run()
    end = time.perf_counter() + seconds
    while time.perf_counter() < end or min(len(t) for t in times.values()) < 3:
        for name, run in contenders.items():
            start = time.perf_counter()
            run()
            times[name].append(1e3 * (time.perf_counter() - start))
    return times


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--n", type=int, nargs="+", default=[256, 512])
    parser.add_argument("--seconds", type=float, default=10.0, help="per n (default: 10)")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    machine = {"machine": platform.platform(), "cpus": os.cpu_count(), "python": platform.python_version(), "numpy": np.__version__}
    print("  ".join(f"{k} {v}" for k, v in machine.items()))
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3)
    rows = []
    for n in options.n:
        ocean = fo.Ocean(sea, n=n, size=300.0)
        out = ocean.frame(0.0, FULL)
        times = alternate({"fftocean": lambda o=ocean, f=out: o.frame(3.7, FULL, out=f), "textbook": textbook(ocean)}, options.seconds)
        points = min(n * n, max(1, 4_000_000 // (n * n)))  # of the direct sum, which is then scaled to the whole tile
        x, y = np.linspace(0.0, 300.0, points), np.zeros(points)
        eight_fields(ocean, x[:2], y[:2], 0.0)
        start = time.perf_counter()
        eight_fields(ocean, x, y, 3.7)
        direct = 1e3 * (time.perf_counter() - start) * n * n / points
        for name, t in times.items():
            q = statistics.quantiles(t, n=4)
            rows.append({"n": n, "what": name, "median_ms": q[1], "quartiles_ms": [q[0], q[2]], "runs": len(t)})
            print(f"n = {n:5d}  {name:9s} {q[1]:9.2f} ms  (quartiles {q[0]:.2f} to {q[2]:.2f}, {len(t)} runs)")
        ours, theirs = (statistics.median(times[name]) for name in ("fftocean", "textbook"))
        rows.append({"n": n, "what": "direct sum, compiled, scaled up", "median_ms": direct, "points": points})
        print(f"n = {n:5d}  direct sum, compiled: {direct:.0f} ms (from {points} points)")
        print(f"n = {n:5d}  textbook / fftocean = {theirs / ours:.1f}   direct sum / fftocean = {direct / ours:,.0f}")
        assert math.isfinite(ours)
    if options.json:
        options.json.write_text(json.dumps({**machine, "rows": rows}, indent=2) + "\n")


if __name__ == "__main__":
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        main()
