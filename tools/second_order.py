"""
Figures of docs/second_order.md: skewness and crests of many seeds, and the picture of one sea.

    python tools/second_order.py figures [--seeds 24]
    python tools/second_order.py picture docs/second_order.webp

The sea has Hs = 3 m, Tp = 8 s, a JONSWAP spectrum of gamma 3.3 and 30 degrees of spread, on 500 m
of deep water.
Crests are the highest elevations between two upward crossings of the mean level at a point, at
choppiness 0, of which the water's elevation is that of the frames.
"""

import argparse
import io
import math
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import fftocean as fo
from fftocean.constants import GRAVITY
from fftocean.statistics import sea_skewness

HS, TP = 3.0, 8.0
LEVELS = np.arange(0.5, 1.01, 0.1)
"""Crests over Hs."""
STEPS, STEP = 500, TP / 20.0
APART = 4
"""Samples between two points."""


def sea() -> fo.Sea:
    """Return the sea."""
    spreading = fo.CosinePower(s=2.0 / math.radians(30.0) ** 2 - 1.0)
    spectrum = fo.JONSWAP.from_sea_state(hs=HS, tp=TP, gamma=3.3)
    return fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=spreading))


class Crests:
    """Crests at points over time, counted above levels."""

    def __init__(self, shape: tuple[int, int]) -> None:
        self.last, self.highest = np.full(shape, np.nan), np.full(shape, np.nan)
        self.all: list[np.ndarray] = []
        self.moments = np.zeros(4)

    def add(self, height: np.ndarray) -> None:
        """Take the elevations of one more moment."""
        height = height.astype(np.float64)
        self.moments += [np.sum(height**power) for power in range(4)]
        height = height[::APART, ::APART]
        up = (self.last < 0.0) & (height >= 0.0)
        self.all.append(self.highest[up & np.isfinite(self.highest)])
        # NaN until the first crossing
        self.highest = np.where(up, height, np.maximum(self.highest, height))
        self.last = height

    @property
    def deviation(self) -> float:
        """Standard deviation of the elevation [m]."""
        return math.sqrt(self.moments[2] / self.moments[0])

    @property
    def skewness(self) -> float:
        """Skewness of the elevation [-]."""
        return float(self.moments[3] / self.moments[0] / self.deviation**3)

    def above(self, levels: np.ndarray) -> tuple[np.ndarray, int]:
        """Return the number of crests above levels [m], and of all."""
        heights = np.sort(np.concatenate(self.all))
        return heights.size - np.searchsorted(heights, levels), heights.size


def forristall() -> np.ndarray:
    """
    Return the exceedance of crests in short-crested seas over that of Rayleigh, at `LEVELS`.

    Source: Forristall 2000 (J. Phys. Oceanogr. 30), eq. 4.5 and 4.6, in deep water.
    """
    spectrum = sea().systems[0].spectrum
    t1 = 2.0 * math.pi * fo.moments.moment(spectrum, 0) / fo.moments.moment(spectrum, 1)
    steepness = 2.0 * math.pi * HS / (GRAVITY * t1**2)
    alpha, beta = 0.3536 + 0.2568 * steepness, 2.0 - 1.7912 * steepness
    return np.exp(8.0 * LEVELS**2 - (LEVELS / alpha) ** beta)


def figures(seeds: int) -> None:
    """Print the figures of many seeds."""
    warnings.simplefilter("ignore", fo.SeaWarning)
    water = sea()
    specified = sea_skewness(water)
    print(f"skewness of the sea: {specified:.4f}")
    for bound in (125, 250, 500, 1000, 2000, 4000):
        ocean = fo.Ocean(water, n=256, size=500.0, seed=0, order=2, bound=bound, choppiness=0.0)
        report = ocean.bound_waves.report
        share = report.skewness / specified
        print(
            f"  {bound:4} waves: {report.skewness:.4f}, {100 * share:.0f} %; "
            f"{100 * report.dropped:.2f} % beyond the grid"
        )
    gained, counts = [], np.zeros((2, LEVELS.size))
    totals = np.zeros(2)
    for seed in range(seeds):
        both = []
        ocean = fo.Ocean(water, n=128, size=500.0, seed=seed, order=2, choppiness=0.0)
        for one in (ocean.linear(), ocean):
            crests = Crests((128 // APART, 128 // APART))
            for step in range(STEPS):
                crests.add(one.frame(STEP * step, ("height",)).height)
            both.append(crests)
        gained.append(both[1].skewness - both[0].skewness)
        for i, crests in enumerate(both):
            count, total = crests.above(4.0 * both[0].deviation * LEVELS)
            counts[i] += count
            totals[i] += total
    error = np.std(gained, ddof=1) / math.sqrt(seeds)
    print(f"skewness gained, {seeds} seeds: {np.mean(gained):.4f} +- {error:.4f}")
    print(f"crests: {totals[0]:.0f} linear, {totals[1]:.0f} of second order")
    print("crest/Hs  second/linear  Forristall/Rayleigh")
    for level, ratio, law in zip(
        LEVELS, counts[1] / totals[1] / (counts[0] / totals[0]), forristall(), strict=True
    ):
        print(f"{level:8.1f}  {ratio:13.2f}  {law:19.2f}")


STEEP = {"hs": 5.0, "tp": 8.5, "gamma": 3.3}
"""Sea of the picture."""
KINDS = (
    ("linear", "#7a7a7a", {"choppiness": 0.0, "order": 1}),
    ("choppy, order 1", "#0072b2", {"choppiness": 1.0, "order": 1}),
    ("choppy, order 2", "#c75000", {"choppiness": 1.0, "order": 2}),
)
PIXELS = 480, 300


def picture(path: Path) -> None:
    """Draw one sea linear, choppy, and of second order: surfaces and profiles."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    from fftocean import plots
    from fftocean.baking.previews.render import Water, developed, perspective

    spreading = fo.CosinePower(s=2.0 / math.radians(30.0) ** 2 - 1.0)
    # the crests come toward the camera, which looks north
    steep = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(**STEEP), spreading=spreading, direction=-90.0
        )
    )
    seas = [fo.Ocean(steep, n=512, size=500.0, seed=8, bound=1500, **given) for *_, given in KINDS]
    moment, (x, y) = highest(seas[-1])
    with plots.style():
        figure = Figure(figsize=(9.6, 5.4), dpi=125, layout="constrained")
        FigureCanvasAgg(figure)
        grid = figure.add_gridspec(2, 3, height_ratios=(1.0, 1.15))
        for i, (ocean, (name, colour, _)) in enumerate(zip(seas, KINDS, strict=True)):
            water = Water.of(ocean.frame(moment))
            image = developed(perspective(water, *PIXELS, place=(x, y - 55.0)))
            ax = figure.add_subplot(grid[0, i])
            ax.imshow(image)
            ax.set_axis_off()
            ax.set_title(name, color=colour, fontweight="bold")
        ax = figure.add_subplot(grid[1, :])
        along = np.linspace(-80.0, 80.0, 1200)
        for row, (ocean, (name, colour, _)) in enumerate(zip(seas, KINDS, strict=True)):
            z = fo.Query(ocean).at(x, y - along, moment, ("heights",)).heights
            ax.plot(along, z, color=colour, linewidth=1.8)
            words = f"{name}: {z.max():.2f} m"
            ax.text(
                0.985, 0.93 - 0.1 * row, words, color=colour, ha="right", transform=ax.transAxes
            )
        ax.axhline(0.0, color="#bbbbbb", linewidth=0.8, zorder=0)
        ax.set(xlabel="distance along the waves [m]", ylabel="elevation [m]", xlim=(-80, 80))
        text = f"The same waves (Hs {STEEP['hs']:g} m, Tp {STEEP['tp']:g} s, deep water)"
        ax.set_title(f"{text}, and the profile through the highest crest")
        stream = io.BytesIO()
        figure.savefig(stream, format="png")
    image = Image.open(stream).convert("RGB")
    path.parent.mkdir(parents=True, exist_ok=True)
    image.save(path, quality=80, method=6)


def highest(ocean: fo.Ocean) -> tuple[float, tuple[float, float]]:
    """Return the moment of the highest crest of many, and its place."""
    moments = np.arange(0.0, 240.0, 3.0)
    tops = [float(ocean.frame(t, ("height",)).height.max()) for t in moments]
    moment = float(moments[int(np.argmax(tops))])
    frame = ocean.frame(moment)
    row, column = np.unravel_index(int(np.argmax(frame.height)), frame.height.shape)
    x0, y0 = ocean.grid.x[column], ocean.grid.y[row]
    c = ocean.choppiness
    place = (
        float(x0 + c * frame.displace_x[row, column]),
        float(y0 + c * frame.displace_y[row, column]),
    )
    return moment, place


def main(arguments: Sequence[str] | None = None) -> int:
    """Print figures or write the picture; return the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    kinds = parser.add_subparsers(dest="kind", required=True)
    of_figures = kinds.add_parser("figures")
    of_figures.add_argument("--seeds", type=int, default=24)
    of_picture = kinds.add_parser("picture")
    of_picture.add_argument("path", type=Path)
    options = parser.parse_args(arguments)
    if options.kind == "figures":
        figures(options.seeds)
    else:
        picture(options.path)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
