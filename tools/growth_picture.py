"""Draw docs/growth.webp: growth of a wind sea by law and by depth, and foam by wind."""

import io
import math
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import fftocean as fo
from fftocean.foam_coverage import whitecap_coverage
from fftocean.physics.plausibility import plausibility
from fftocean.physics.spectra.growth import GROWTHS

WIND = 15.0  # [m/s]
DEPTHS = {math.inf: "deep", 40.0: "40 m", 15.0: "15 m", 5.0: "5 m"}
TARGET = Path(__file__).resolve().parents[1] / "docs" / "growth.webp"


def growth(axes: plt.Axes) -> None:
    """Draw Hs by fetch, a style for each law and a colour for each depth."""
    fetches = np.geomspace(3e3, 1e6, 60)
    for (depth, label), colour in zip(
        DEPTHS.items(), ("#1b4965", "#2a9d8f", "#e9a23b", "#c8553d"), strict=True
    ):
        for law, style in zip(GROWTHS, ("-", "--", ":"), strict=True):
            hs = [
                plausibility(fo.Sea.from_wind(speed=WIND, fetch=f, depth=depth, growth=law)).hs
                for f in fetches
            ]
            axes.loglog(fetches / 1e3, hs, style, color=colour, lw=1.6)
        axes.annotate(label, (1.03e3, hs[-1]), color=colour, va="center", annotation_clip=False)
    for law, style in zip(GROWTHS, ("-", "--", ":"), strict=True):
        axes.plot([], [], style, color="0.3", label=law)
    axes.legend(frameon=False, loc="lower right")
    axes.set_yticks([0.5, 1.0, 2.0, 4.0], ["0.5", "1", "2", "4"])
    axes.set_yticks([], minor=True)
    axes.set_xticks([3, 10, 30, 100, 300, 1000], ["3", "10", "30", "100", "300", "1000"])
    axes.set(xlabel="fetch [km]", ylabel="Hs [m]", title=f"A wind of {WIND:g} m/s", xlim=(3, 1e3))


def foam(axes: plt.Axes) -> None:
    """Draw the coverage of the law, and that of live foam on tiles of three sample distances."""
    winds = np.linspace(5.0, 25.0, 50)
    axes.semilogy(winds, [100.0 * whitecap_coverage(u) for u in winds], color="0.3", label="law")
    for step, marker, colour in (
        (0.4, "o", "#1b4965"),
        (0.8, "s", "#2a9d8f"),
        (1.6, "^", "#e9a23b"),
    ):
        at = (8.0, 12.0, 16.0, 20.0)
        shown = []
        for u in at:
            sea = fo.Sea.from_wind(speed=u, fetch=200e3)
            tiles = [fo.Ocean(sea, n=96, size=96.0 * step, seed=seed) for seed in range(5)]
            shown.append(
                np.mean([fo.Foam.whitecaps(tile, u).live(tile).at(14.0) for tile in tiles])
            )
        axes.semilogy(
            at,
            100.0 * np.array(shown),
            marker,
            color=colour,
            ms=5,
            label=f"samples {step:g} m apart",
        )
    axes.legend(frameon=False, loc="lower right")
    axes.set_yticks([0.1, 1.0, 10.0], ["0.1", "1", "10"])
    axes.set(xlabel="wind [m/s]", ylabel="covered with foam [%]", title="Foam.whitecaps, 5 seeds")


def main() -> None:
    """Write the picture."""
    warnings.simplefilter("ignore")
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.9), layout="constrained")
    growth(left)
    foam(right)
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    stream = io.BytesIO()
    figure.savefig(stream, dpi=110)
    Image.open(stream).convert("RGB").save(TARGET, quality=82, method=6)


if __name__ == "__main__":
    main()
