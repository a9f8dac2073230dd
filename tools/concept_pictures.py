"""
Pictures of docs/concepts, from the library itself: `python tools/concept_pictures.py [NAME ...]`.
"""

import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import fftocean as fo
from fftocean.foam_coverage import whitecap_coverage
from fftocean.physics import dispersion

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "concepts"
BLUES = ("#86c8d6", "#3a8fb7", "#1f5595", "#141c52")
VERMILION = "#c75000"
TENSION = 0.074


def axes(x: str, y: str) -> tuple[Figure, Axes]:
    """Return an empty picture with names of its axes."""
    figure = Figure(figsize=(7.0, 3.4), layout="constrained")
    ax = figure.add_subplot(xlabel=x, ylabel=y)
    ax.spines[["top", "right"]].set_visible(False)
    return figure, ax


def spectrum() -> Figure:
    """Draw JONSWAP spectra over fetches."""
    figure, ax = axes("ω [rad/s]", "S(ω) [m² s/rad]")
    omega = np.linspace(0.3, 2.5, 500)
    for fetch, colour in zip((30e3, 60e3, 100e3, 300e3), BLUES, strict=True):
        sea = fo.Sea.from_wind(speed=12.0, fetch=fetch)
        label = f"{fetch / 1e3:g} km: Hs {sea.hs:.1f} m, Tp {sea.tp:.1f} s"
        ax.plot(omega, sea(omega), color=colour, label=label)
    ax.legend(title="wind 12 m/s, fetch", frameon=False)
    return figure


def spreading() -> Figure:
    """Draw three spreadings at two frequencies."""
    figure, ax = axes("direction from the wind's [degrees]", "D(ω, θ) [1/rad]")
    theta = np.linspace(-np.pi, np.pi, 721)
    families = (
        ("Donelan-Banner", fo.DonelanBanner(), BLUES[3]),
        ("cos²", fo.CosineSquared(), BLUES[1]),
        ("Mitsuyasu, 12 m/s", fo.Mitsuyasu(speed=12.0), VERMILION),
    )
    for name, family, colour in families:
        for ratio, style in ((1.0, "-"), (2.0, "--")):
            label = f"{name}, {'peak' if ratio == 1.0 else 'twice the peak'}"
            ax.plot(
                np.rad2deg(theta), family(ratio * 0.8, theta, 0.8), style, color=colour, label=label
            )
    ax.set_xticks([-180, -90, 0, 90, 180])
    ax.legend(frameon=False, fontsize="small")
    return figure


def dispersion_relation() -> Figure:
    """Draw phase speeds."""
    figure, ax = axes("wavelength [m]", "phase speed [m/s]")
    length = np.geomspace(2e-3, 1e3, 500)
    k = 2.0 * np.pi / length
    for depth, colour in ((np.inf, BLUES[3]), (20.0, BLUES[1]), (2.0, BLUES[0])):
        speed = dispersion.angular_frequency(k, depth, TENSION) / k
        label = "deep water" if np.isinf(depth) else f"{depth:g} m deep"
        ax.loglog(length, speed, color=colour, label=label)
    slowest = dispersion.angular_frequency(k, np.inf, TENSION) / k
    i = int(np.argmin(slowest))
    ax.plot(length[i], slowest[i], "o", color=VERMILION)
    words = f"{100.0 * length[i]:.1f} cm, {100.0 * slowest[i]:.0f} cm/s"
    ax.annotate(words, (length[i], slowest[i]), (8, 10), textcoords="offset points")
    ax.legend(frameon=False)
    return figure


def choppiness() -> Figure:
    """Draw one profile at three choppinesses."""
    figure, ax = axes("x [m]", "height [m]")
    modes = [(3, 0, 0.9, 0.2), (5, 0, 0.45, 1.0), (8, 0, 0.22, 2.5), (13, 0, 0.16, 0.4)]
    for c, colour in ((0.0, BLUES[0]), (1.0, BLUES[2]), (2.0, VERMILION)):
        ocean = fo.Ocean.from_modes(modes, n=(512, 4), size=(80.0, 10.0), choppiness=c)
        frame = ocean.frame(0.0)
        x = np.arange(512) * (80.0 / 512) + c * frame.displace_x[0]
        ax.plot(x, frame.height[0], color=colour, label=f"choppiness {c:g}")
    ax.set_xlim(0.0, 80.0)
    ax.legend(frameon=False, ncols=3, loc="lower right")
    return figure


def loops() -> Figure:
    """Draw the error of the frequencies over the period."""
    figure, ax = axes("period of the loop, in peak periods", "error of the frequencies, rms [%]")
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3)
    periods = np.linspace(1.5, 20.0, 80)
    errors = []
    for period in periods:
        ocean = fo.Ocean(sea, n=64, size=300.0, loop=float(period * sea.tp))
        loop = fo.measure(ocean).loop
        assert loop is not None
        errors.append(100.0 * loop.rms)
    ax.plot(periods, errors, color=BLUES[2])
    ax.axvline(4.0, color=VERMILION, linewidth=1.0)
    ax.annotate("below four a warning is given", (4.0, max(errors)), (6, -8), color=VERMILION,
                textcoords="offset points")  # fmt: skip
    ax.set_ylim(0.0)
    return figure


def energy() -> Figure:
    """Draw the scatter of Hs over seeds."""
    figure, ax = axes("Hs of one seed / Hs specified", "seeds")
    sea = fo.Sea.from_wind(speed=7.0, fetch=35e3)
    length = 9.80665 * sea.tp**2 / (2.0 * np.pi)
    for across, colour in ((4, BLUES[0]), (16, BLUES[3])):
        size = across * length
        ratio = [
            4.0 * np.sqrt(np.sum(ocean.modes().amplitude ** 2 / 2.0)) / sea.hs
            for seed in range(200)
            for ocean in [fo.Ocean(sea, n=16 * across, size=size, seed=seed)]
        ]
        label = f"{across} peak wavelengths: scatter {100.0 * np.std(ratio):.0f} %"
        ax.hist(ratio, np.linspace(0.6, 1.4, 41), color=colour, alpha=0.7, label=label)
    ax.legend(frameon=False)
    return figure


def foam() -> Figure:
    """Draw the coverage of foam over the wind."""
    figure, ax = axes("wind speed 10 m above the water [m/s]", "share covered [%]")
    winds = np.array([6.0, 8.0, 10.0, 14.0, 18.0])
    found = []
    for wind in winds:
        sea = fo.Sea.from_wind(speed=float(wind), fetch=300e3)
        ocean = fo.Ocean(sea, n=128, size=float(12.0 * wind), loop=32.0, seed=3)
        response = fo.Foam.from_wind(ocean, float(wind)).loop(ocean, 64)
        found.append(100.0 * float(np.mean([np.mean(1.0 - np.exp(-f)) for f in response])))
    smooth = np.linspace(4.0, 20.0, 100)
    law = [100.0 * whitecap_coverage(float(wind)) for wind in smooth]
    ax.semilogy(smooth, law, color=BLUES[1], label="Monahan & O'Muircheartaigh 1980")
    ax.plot(winds, found, "o", color=VERMILION, label="one loop of fftocean")
    ax.legend(frameon=False)
    return figure


def second_order() -> Figure:
    """Draw one crest three ways."""
    figure, ax = axes("x [m]", "height [m]")
    modes = [(m, 0, 0.6 * np.exp(-(((m - 8) / 2.4) ** 2)), 0.0) for m in range(3, 16)]
    size, n = 600.0, (1024, 4)
    x = (np.arange(1024) - 512) * (size / 1024)
    shapes = (
        ("linear", {"choppiness": 0.0}, BLUES[0]),
        ("choppy", {"choppiness": 1.0}, BLUES[2]),
        ("second order", {"choppiness": 0.0, "order": 2}, VERMILION),
    )
    for name, arguments, colour in shapes:
        ocean = fo.Ocean.from_modes(modes, n=n, size=(size, 10.0), dtype="float64", **arguments)
        frame = ocean.frame(0.0)
        moved = x + ocean.choppiness * np.roll(frame.displace_x[0], 512)
        ax.plot(moved, np.roll(frame.height[0], 512), color=colour, label=name)
    ax.set_xlim(-110.0, 110.0)
    ax.legend(frameon=False)
    return figure


PICTURES: dict[str, Callable[[], Figure]] = {
    "spectrum": spectrum,
    "spreading": spreading,
    "dispersion": dispersion_relation,
    "choppiness": choppiness,
    "loops": loops,
    "energy": energy,
    "foam": foam,
    "second_order": second_order,
}


def main() -> None:
    """Draw the pictures that are named, or all."""
    for name in sys.argv[1:] or PICTURES:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", fo.SeaWarning)
            PICTURES[name]().savefig(FOLDER / f"{name}.png", dpi=110, metadata={"Software": None})
        print(f"{name}.png")


if __name__ == "__main__":
    main()
