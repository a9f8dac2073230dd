"""
Pictures of constrained seas and of drift for the documentation, in docs/

    python tools/water_pictures.py [crest] [drift]

It needs matplotlib and Pillow; each takes some seconds.
"""

import io
import itertools
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

import fftocean as fo
from fftocean.baking.previews import render
from fftocean.plots.theme import BLUE, FAINT, INK, VERMILION, style

OUT = Path(__file__).resolve().parents[1] / "docs"
MOST_BYTES = 120_000
YEAR = 365.25 * 86400.0

FIELDS = (
    *("height", "displace_x", "displace_y", "slope_x", "slope_y"),
    *("stretch_xx", "stretch_xy", "stretch_yy"),
)


def write(figure: Figure, name: str) -> None:
    """Write a figure as the smallest WebP of good quality."""
    FigureCanvasAgg(figure)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=160)
    image = Image.open(stream).convert("RGB")
    for quality in (88, 80, 70, 60):
        data = io.BytesIO()
        image.save(data, "WEBP", quality=quality, method=6)
        if len(data.getvalue()) <= MOST_BYTES:
            break
    (OUT / name).write_bytes(data.getvalue())
    print(f"{OUT / name}: {image.width} x {image.height}, {len(data.getvalue()) / 1e3:.0f} kB")


def mean_wave(ocean: fo.Ocean) -> tuple[np.ndarray, np.ndarray]:
    """Return the autocorrelation of the height along y: places, and values."""
    a, grid = ocean.amplitudes, ocean.grid
    waves = replace(
        a, forward=0.5 * a.variance_forward + 0j, backward=0.5 * a.variance_backward + 0j
    )
    height = ocean.with_amplitudes(waves).frame(0.0, ("height",)).height[:, 0]
    return grid.y - grid.ly / 2.0, np.roll(height, grid.ny // 2) / height[0]


def crest() -> None:
    """Draw a sea before and after it is made to have a crest that comes once in 1,000 years."""
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=5.0, tp=10.5),
            spreading=fo.CosinePower(s=14.0),
            direction=-90.0,  # toward the camera
        )
    )
    size, x, y, t = 900.0, 420.0, 500.0, 0.0
    free = fo.Ocean(sea, n=512, size=size, seed=12, dtype="float64")
    height = fo.crest_height(free, 1000.0 * YEAR)
    rogue = fo.constrained(free, fo.Crest(height=height, x=x, y=y, t=t))
    print(rogue.rarity)
    with style():
        figure = Figure(figsize=(8.0, 7.0))
        titles = ("the sea of the seed", f"the same sea with a crest of {height:.1f} m")
        for i, (ocean, title) in enumerate(zip((free, rogue), titles, strict=True)):
            light = render.perspective(
                render.Water.of(ocean.frame(t, FIELDS)), 1280, 380, place=(x, y - 105.0)
            )
            ax = figure.add_axes((0.0, 0.732 - 0.272 * i, 1.0, 0.268))
            ax.imshow(render.developed(light), aspect="auto")
            ax.set_axis_off()
            ax.text(0.012, 0.94, title, transform=ax.transAxes, va="top", fontsize=12, color=INK)
            ax.text(
                0.988,
                0.94,
                "from 10 m above the water, 105 m away; the buoy's bands are 1 m",
                transform=ax.transAxes,
                va="top",
                ha="right",
                fontsize=8,
                color=FAINT,
            )
        ax = figure.add_axes((0.065, 0.07, 0.905, 0.365))
        along = np.arange(-300.0, 300.5, 1.0)
        query = [fo.Query(ocean, mode="bicubic", level="frame") for ocean in (free, rogue)]
        before, after = (q.at(x, y + along, t, "heights").heights for q in query)
        y0, mean = mean_wave(free)
        ax.axhline(0.0, color=FAINT, linewidth=0.6)
        ax.plot(y0, height * mean, color=VERMILION, linestyle="--", linewidth=1.2)
        ax.plot(along, before, color=FAINT, linewidth=1.2)
        ax.plot(along, after, color=BLUE, linewidth=2.0)
        ax.set(xlim=(-300.0, 300.0), xlabel="distance north of the crest [m]", ylabel="height [m]")
        share = rogue.rarity.exceedance
        ax.annotate(
            f"{height:.1f} m = {height / math.sqrt(rogue.rarity.m0):.2f} standard deviations:\n"
            f"1 crest in {1.0 / share / 1e9:.1f} billion;\none in 1,000 years at one place",
            (1.0, height),
            (40.0, 0.7 * height),
            color=BLUE,
            arrowprops={"arrowstyle": "-", "color": BLUE},
        )
        ax.text(-290.0, 0.9 * height, "grey: before", color=FAINT)
        ax.text(-290.0, 0.77 * height, "blue: after", color=BLUE)
        ax.text(
            -290.0, 0.64 * height, "dashed: mean of all seas with such a crest", color=VERMILION
        )
        write(figure, "constrained.webp")


def followed(query: fo.Query, x: np.ndarray, y: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return the places of tracers at times, (times, 2, tracers), by Runge-Kutta."""

    def velocity(place: np.ndarray, t: float) -> np.ndarray:
        return query.at(place[0], place[1], t, "velocities").velocities.T[:2]

    places = [np.stack([x, y])]
    for t, after in itertools.pairwise(times):
        dt, p = after - t, places[-1]
        one = velocity(p, t)
        two = velocity(p + 0.5 * dt * one, t + 0.5 * dt)
        three = velocity(p + 0.5 * dt * two, t + 0.5 * dt)
        four = velocity(p + dt * three, after)
        places.append(p + dt / 6.0 * (one + 2.0 * two + 2.0 * three + four))
    return np.array(places)


def drift() -> None:
    """Draw tracers that follow the velocities of a query, without and with the Stokes drift."""
    sea = fo.Sea.from_wind(speed=12.0, fetch=150e3, direction=0.0)
    ocean = fo.Ocean(sea, n=128, size=160.0, seed=3)
    times = np.arange(0.0, 120.0 + 1e-9, 0.2)
    side = np.arange(8) * 20.0
    x, y = (a.ravel() for a in np.meshgrid(side, side))
    queries = [fo.Query(ocean, drift=drift) for drift in (False, True)]
    without, drifting = (followed(query, x, y, times) for query in queries)
    stokes = fo.kinematics.stokes_drift(ocean)
    print("Stokes drift", stokes, "found", (drifting[-1] - drifting[0]).mean(axis=1) / times[-1])
    with style():
        figure = Figure(figsize=(8.0, 3.7))
        ax = figure.add_axes((0.01, 0.14, 0.56, 0.74))
        for row, i in enumerate((11, 26, 45)):
            start = np.array([[x[i]], [y[i] - 4.5 * row]])
            for places, colour in ((drifting, BLUE), (without, VERMILION)):
                ax.plot(*(places[:, :, i].T - start), color=colour, linewidth=1.0)
            ax.plot(0.0, 4.5 * row, "o", color=INK, markersize=4)
        ax.set(xlabel="east [m]", yticks=[], title="Three tracers from above, 2 minutes")
        ax.spines["left"].set_visible(False)
        ax.set_aspect("equal")
        ax = figure.add_axes((0.68, 0.14, 0.3, 0.74))
        for places, colour in ((without, VERMILION), (drifting, BLUE)):
            ax.plot(times, (places[:, 0] - places[0, 0]).mean(axis=1), color=colour, linewidth=2.0)
        ax.plot(times, stokes[0] * times, color=INK, linestyle="--", linewidth=1.0)
        ax.set(xlabel="time [s]", ylabel="metres downwind", title="Mean of 64", xlim=(0.0, 120.0))
        far = stokes[0] * 120.0
        ax.text(8.0, 0.93 * far, "with drift", color=BLUE)
        ax.text(8.0, 0.83 * far, "dashed: Stokes", color=INK)
        ax.text(60.0, 0.05 * far, "without", color=VERMILION)
        write(figure, "drift.webp")


if __name__ == "__main__":
    for name in sys.argv[1:] or ("crest", "drift"):
        globals()[name]()
