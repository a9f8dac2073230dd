"""Plot of a sea's frequency spectrum."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fftocean.arrays import Real
from fftocean.physics import moments
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import JONSWAP, TMA, FrequencySpectrum, TabulatedSpectrum
from fftocean.plots.axes import mark_periods, spell_out_ticks
from fftocean.plots.figures import new_figure, write_message
from fftocean.plots.labels import Label, right_flank, write_labels
from fftocean.plots.ranges import drawn_frequencies, energetic_band, is_flat
from fftocean.plots.text import compass_point, three_digits
from fftocean.plots.theme import BLUE, FAINT, INK, SYSTEMS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase


class _Parent(NamedTuple):
    """The spectrum from which a system's own was made."""

    system: int  # its index in the sea
    name: str
    spectrum: FrequencySpectrum
    linestyle: str


def plot_spectrum(sea: Sea) -> "Figure":
    """
    Draw S(omega) of a sea and of its systems, with their peaks.

    A dotted curve is the deep-water spectrum of a TMA spectrum, a dashed one the Pierson-Moskowitz
    spectrum of a JONSWAP spectrum.

    Raises:
        ParameterError: not a sea, or matplotlib is not installed.
    """
    return new_figure(draw_spectrum, sea, Sea, height=4.7)


def draw_spectrum(figure: "FigureBase", sea: Sea) -> None:
    """Draw the spectrum of a sea on a figure."""
    if is_flat(sea):
        title = "Spectrum: the sea is exactly flat"
        write_message(figure, title, "No waves: S(ω) is 0 m² s/rad at every frequency.")
        return
    low, high = energetic_band(sea)
    omega = drawn_frequencies(sea, low, high)
    s, m0, tp = sea(omega), sea.variance, sea.tp
    hs = 4.0 * math.sqrt(m0)
    figure.suptitle(
        f"Spectrum: a sea of Hs {three_digits(hs)} m whose energy peaks at a period of "
        f"{three_digits(tp)} s",
        x=0.01,
        ha="left",
    )
    ax = figure.subplots()
    ax.set(
        xlabel="angular frequency ω [rad/s]",
        ylabel="variance density S(ω) [m² s/rad]",
        xlim=(low, high),
    )
    mark_periods(ax, low, high)
    ax.fill_between(omega, s, color=BLUE, alpha=0.12, linewidth=0.0)
    ax.plot(omega, s, color=INK, linewidth=2.0, gid="sea")
    peak = 2.0 * math.pi / tp
    top = float(sea(peak))
    area = f"the sea: area m₀ = {three_digits(m0)} m², so Hs = 4√m₀ = {three_digits(hs)} m"
    labels = [
        Label(f"peak: Tp = {three_digits(tp)} s", INK, (peak, top)),
        Label(area, INK, right_flank(omega, s, 0.8)),
    ]
    if len(sea.systems) > len(SYSTEMS):
        counted = f"grey: its {len(sea.systems)} wave systems"
        labels.append(Label(counted, FAINT, right_flank(omega, s, 0.4)))
    parents = _parents(sea, omega) if len(sea.systems) <= 3 else []
    highest = max([top, *(float(np.max(parent.spectrum(omega))) for parent in parents)])
    # a deep-water spectrum may exceed the axes, but the rest of the plot must stay legible
    ceiling = min(1.15 * highest, 2.2 * top)
    labels += _draw_systems(ax, sea, omega)
    envelope = s.copy()
    for parent in parents:
        before, colour = parent.spectrum(omega), SYSTEMS[parent.system]
        highest = float(np.max(before))
        ax.plot(
            omega,
            before,
            color=colour,
            linestyle=parent.linestyle,
            linewidth=1.5,
            gid=f"{parent.name} {parent.system}",
        )
        level = 0.5 if parent.linestyle == "--" else min(0.85, 0.85 * ceiling / highest)
        words = f"{parent.name}: Hs {_hs(parent.spectrum)} m"
        labels.append(Label(words, colour, right_flank(omega, before, level)))
        if highest < ceiling:
            envelope = np.maximum(envelope, before)
    ax.plot([peak, peak], [0.0, top], color=INK, linewidth=0.8, linestyle=(0, (2, 2)))
    ax.plot([peak], [top], "o", color=INK, markersize=6.0, gid="peak")
    ax.set_ylim(0.0, ceiling)
    spell_out_ticks(ax.yaxis, ceiling)
    write_labels(ax, labels, (omega, envelope), height=3.3)


def _draw_systems(ax: "Axes", sea: Sea, omega: Real) -> list[Label]:
    """Draw the spectrum of each wave system, and return their labels."""
    labels = []
    few = len(sea.systems) <= len(SYSTEMS)
    for i, system in enumerate(sea.systems):
        part = system.spectrum(omega)
        if not np.any(part > 0.0):
            continue
        colour = SYSTEMS[i] if few else FAINT
        if len(sea.systems) > 1:
            ax.plot(omega, part, color=colour, linewidth=1.3, gid=f"system {i}")
            if few:
                labels.append(Label(_described(system), colour, right_flank(omega, part, 0.6)))
        if isinstance(system.spectrum, TabulatedSpectrum):
            measured = np.asarray(system.spectrum.breaks)
            density = system.spectrum(measured)
            anchor = right_flank(measured, density, 0.15)
            labels.append(Label("dots: the frequencies measured", colour, anchor))
            ax.plot(measured, density, "o", color=colour, markersize=3.5, gid=f"points {i}")
    return labels


def _parents(sea: Sea, omega: Real) -> Sequence[_Parent]:
    """Return the parent spectrum of each system, if the two can be told apart at `omega`."""
    parents = []
    for i, system in enumerate(sea.systems):
        spectrum = system.spectrum
        inner = spectrum.spectrum if isinstance(spectrum, TMA) else spectrum
        if not np.any(inner(omega) > 0.0):
            continue
        if np.max(np.abs(inner(omega) - spectrum(omega))) > 0.02 * np.max(inner(omega)):
            parents.append(_Parent(i, "in deep water", inner, ":"))
        elif isinstance(inner, JONSWAP) and inner.gamma > 1.0:
            under = replace(inner, gamma=1.0)
            parents.append(_Parent(i, "Pierson-Moskowitz, γ = 1", under, "--"))
    return parents


def _described(system: WaveSystem) -> str:
    """Return a wave system's spectrum, height, period and direction in half a line."""
    words = {
        "TabulatedSpectrum": "measured",
        "CustomSpectrum": "custom",
        "PiersonMoskowitz": "Pierson-Moskowitz",
    }
    name = type(system.spectrum).__name__
    tp = three_digits(moments.peak_period(system.spectrum))
    toward = compass_point(system.direction)
    return f"{words.get(name, name)}: Hs {_hs(system.spectrum)} m, Tp {tp} s, toward {toward}"


def _hs(spectrum: FrequencySpectrum) -> str:
    """Return the significant wave height of a spectrum with three digits [m]."""
    return three_digits(moments.significant_wave_height(spectrum))
