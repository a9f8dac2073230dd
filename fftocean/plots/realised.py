"""Plot of the spectrum that a tile realises beside the specified one."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fftocean.arrays import Real
from fftocean.ocean import Ocean
from fftocean.plots.axes import mark_periods, spell_out_ticks
from fftocean.plots.figures import new_figure, write_message
from fftocean.plots.labels import Label, right_flank, write_labels
from fftocean.plots.ranges import NEGLIGIBLE, drawn_frequencies, energetic_band, is_flat
from fftocean.plots.text import degrees, percent, three_digits
from fftocean.plots.theme import BLUE, FAINT, INK, SHADE
from fftocean.realised_spectrum import RealisedSpectrum, realised_spectrum, tile_band
from fftocean.statistics import Statistics, measure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase

_IN_SHADE: dict[str, Any] = {"color": FAINT, "fontsize": 9.0, "ha": "center", "va": "top"}


def plot_realised(ocean: Ocean) -> "Figure":
    """
    Draw the specified spectrum beside the one that this ocean's waves realise.

    A band shows the scatter to expect from seed to seed; a table compares the statistics.

    Raises:
        ParameterError: not an ocean, or matplotlib is not installed.
    """
    return new_figure(draw_realised, ocean, Ocean, height=5.5)


def plot_delivered(ocean: Ocean) -> "Figure":
    """Return `plot_realised(ocean)`: its earlier name, kept as an alias."""
    return plot_realised(ocean)


def draw_realised(figure: "FigureBase", ocean: Ocean) -> None:
    """Draw the specified and the realised spectrum of an ocean on a figure."""
    statistics = measure(ocean)
    sea = None if ocean.sea is None or is_flat(ocean.sea) else ocean.sea
    if sea is None and statistics.m0 < NEGLIGIBLE:
        title = "Realised: the tile is exactly flat"
        write_message(figure, title, "No waves were specified, and the tile has none.")
        return
    figure.suptitle(_headline(statistics, fixed=ocean.rarity is not None), x=0.01, ha="left")
    ax, below = figure.subplots(2, 1, height_ratios=(3.0, 1.15))
    realised = realised_spectrum(ocean)
    high = _highest_drawn(realised) if sea is None else energetic_band(sea)[1]
    edges = realised.edges
    omega = np.union1d(np.linspace(0.0, high, 600), edges[edges < high])
    envelope = np.zeros_like(omega)
    labels = []
    if sea is not None and statistics.specified is not None:
        omega = np.union1d(omega, drawn_frequencies(sea, 0.0, high))
        envelope = sea(omega)
        ax.plot(omega, envelope, color=INK, linewidth=1.5, gid="specified")
        words = f"specified: Hs {three_digits(statistics.specified.hs)} m"
        labels.append(Label(words, INK, right_flank(omega, envelope, 0.9)))
    if np.any(edges[:-1] < high):
        by = "realised by this seed" if sea is not None else "the given waves"
        labels += _draw_bins(ax, realised, high, f"{by}: Hs {three_digits(statistics.hs)} m")
        envelope = np.maximum(envelope, _highest_of_bins(realised, omega))
    ax.set(
        xlabel="angular frequency ω [rad/s]",
        ylabel="variance density S(ω) [m² s/rad]",
        xlim=(0.0, high),
    )
    ax.set_ylim(0.0, 1.12 * float(np.max(envelope)))
    spell_out_ticks(ax.yaxis, float(np.max(envelope)))
    mark_periods(ax, 0.08 * high, high)
    _shade_outside(ax, ocean, high)
    write_labels(ax, labels, (omega, envelope), height=2.6)
    _write_table(below, statistics)


def _draw_bins(ax: "Axes", realised: RealisedSpectrum, high: float, words: str) -> list[Label]:
    """Draw the realised spectrum as steps, its expected scatter as a band; return their labels."""
    edges, energy, expected, scatter = realised
    width = np.diff(edges)
    seen = edges[:-1] < high
    ends = np.minimum(edges[1:], 0.98 * high)[seen]
    density = energy / width
    ax.stairs(density, edges, color=BLUE, linewidth=1.8, gid="realised")
    labels = [Label(words, BLUE, right_flank(ends, density[seen], 0.6))]
    if np.any(scatter > 0.0):
        upper = (expected + scatter) / width
        lower = np.maximum(expected - scatter, 0.0) / width
        band: dict[str, Any] = {"color": BLUE, "alpha": 0.15, "linewidth": 0.0, "gid": "scatter"}
        ax.stairs(upper, edges, baseline=lower, fill=True, **band)
        words = "shaded: specified, in these bins,\n± 1 standard deviation over seeds"
        labels.append(Label(words, FAINT, right_flank(ends, upper[seen], 0.2)))
    return labels


def _highest_of_bins(realised: RealisedSpectrum, omega: Real) -> Real:
    """Return the upper end of all that is drawn of the bins, at each frequency."""
    edges, energy, expected, scatter = realised
    upper = np.maximum(energy, expected + scatter) / np.diff(edges)
    inside = np.clip(np.searchsorted(edges, omega, side="right") - 1, 0, upper.size - 1)
    highest: Real = np.where((omega >= edges[0]) & (omega <= edges[-1]), upper[inside], 0.0)
    return highest


def _highest_drawn(realised: RealisedSpectrum) -> float:
    """Return the highest frequency to draw of an ocean without a sea [rad/s]."""
    energy = realised.energy
    return 1.2 * float(np.max(realised.edges[1:][energy > 1e-3 * np.max(energy)]))


def _shade_outside(ax: "Axes", ocean: Ocean, high: float) -> None:
    """Shade the frequencies that the tile cannot hold."""
    longest, shortest = tile_band(ocean)
    for left, right, words in (
        (0.0, longest, "longer than the tile"),
        (shortest, high, "shorter than two samples"),
    ):
        if left >= right:
            continue
        ax.axvspan(left, right, color=SHADE, linewidth=0.0, zorder=0, gid=words)
        if right - left > 0.035 * high:
            middle, transform = 0.5 * (left + right), ax.get_xaxis_transform()
            ax.text(middle, 0.97, words, transform=transform, rotation=90, **_IN_SHADE)


def _headline(statistics: Statistics, *, fixed: bool) -> str:
    """
    Return one line on how the realised height differs from the specified one, and why.

    Waves with fixed values are no draw of the sea, to be rated by chance.
    """
    hs = three_digits(statistics.hs)
    if statistics.specified is None:
        return f"Realised: the given waves, Hs {hs} m"
    both = f"Realised: Hs {hs} m of {three_digits(statistics.specified.hs)} m specified"
    if statistics.resolved < 0.9 * statistics.specified.m0:
        lost = "the rest" if statistics.m0 > NEGLIGIBLE else "any of it"
        return f"{both}; this tile cannot hold {lost}"
    if fixed:
        return f"{both}, with fixed values in it"
    scatter = _scatter_of_hs(statistics)
    if scatter > 0.0:
        deviation = abs(statistics.hs - 4.0 * math.sqrt(statistics.resolved)) / scatter
        rating = "within chance" if deviation < 2.0 else "a rare realisation"
        return f"{both}, {rating} ({deviation:.1f} σ)"
    return both


def _scatter_of_hs(statistics: Statistics) -> float:
    """
    Return the standard deviation of Hs from seed to seed [m].

    Relative to Hs it is half of that of m0.
    """
    return 0.5 * statistics.sampling_error * 4.0 * math.sqrt(statistics.resolved)


def _write_table(ax: "Axes", statistics: Statistics) -> None:
    """Write each statistic as specified and as realised, with notes on the tile and the loop."""
    ax.set_axis_off()
    sea, scatter = statistics.specified, _scatter_of_hs(statistics)
    spread = f"± {scatter:.2g} m" if scatter else "none" if sea else ""
    rows = [
        ("", "specified" if sea else "", "realised", "expected scatter" if sea else ""),
        (
            "significant wave height Hs",
            f"{three_digits(sea.hs)} m" if sea else "",
            f"{three_digits(statistics.hs)} m",
            spread,
        ),
        (
            "peak period Tp",
            f"{three_digits(sea.tp)} s" if sea else "",
            f"{three_digits(statistics.tp)} s",
            "",
        ),
        (
            "mean direction, toward",
            degrees(sea.mean_direction) if sea else "",
            degrees(statistics.mean_direction),
            "",
        ),
        ("directional spread", degrees(sea.spread) if sea else "", degrees(statistics.spread), ""),
    ]
    columns = ((0.0, INK), (0.55, INK), (0.75, BLUE), (1.0, FAINT))
    for i, row in enumerate(rows):
        for (x, colour), text in zip(columns, row, strict=True):
            align: dict[str, Any] = {"ha": "left" if x == 0.0 else "right", "va": "top"}
            ax.text(x, 1.0 - 0.15 * i, text, color=colour, in_layout=False, **align)
    small: dict[str, Any] = {"color": FAINT, "fontsize": 9.0, "ha": "left", "va": "top"}
    ax.text(0.0, 0.22, "\n".join(_notes(statistics)), in_layout=False, **small)


def _notes(statistics: Statistics) -> list[str]:
    """Return sentences on the energy outside the tile and on the loop's frequencies."""
    notes = []
    sea, loop = statistics.specified, statistics.loop
    if sea is not None and sea.m0 > 0.0:
        longer = percent(statistics.energy_below / sea.m0)
        shorter = percent(statistics.energy_above / sea.m0)
        notes.append(
            f"Outside the tile: {longer} of the energy in longer waves, {shorter} in shorter ones."
        )
    if loop is None:
        notes.append("No loop: every wave runs at its own frequency.")
        return notes
    better = ""
    if loop.better_period != loop.period:
        better = f"; one of {loop.better_period:g} s, by {percent(loop.better_rms)}"
    notes.append(
        f"A loop of {loop.period:g} s shifts the waves' frequencies by {percent(loop.rms)} "
        f"rms{better}."
    )
    return notes
