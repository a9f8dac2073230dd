"""
Pictures that explain themselves: what was ordered, what was delivered, and the law that ties them.

Each returns a `matplotlib.figure.Figure` that no global state knows of; `save` writes it.
matplotlib comes with the extra `plot`. Artists that carry data have a gid, such as "ordered", by
which a test or an SVG's reader finds them.
"""

import io
import math
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

import numpy as np

from fftocean.arrays import Real
from fftocean.cells import Cells
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, how_to_install
from fftocean.files import write_whole
from fftocean.ocean import Ocean
from fftocean.physics import dispersion, moments
from fftocean.physics.panels import gauss, split
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import JONSWAP, TMA, FrequencySpectrum, TabulatedSpectrum
from fftocean.statistics import Statistics, measure, ordered

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure, FigureBase
    from matplotlib.projections.polar import PolarAxes

Subject = TypeVar("Subject", Sea, Ocean)

WIDTH, DPI = (
    7.5,
    160,
    # [in], [1/in]: 1200 pixels, whose letters are still 12 high when the sheet of four is shrunk to
    # them
)
SUFFIXES = (".png", ".svg", ".pdf")

INK, FAINT, SHADE = "#222222", "#767676", "#e9e9e9"
BLUE, VERMILION = "#0072b2", "#c75000"
SYSTEMS = (VERMILION, "#00805d", "#aa4499", "#8a6000", "#56707a")
"""
Colours that the colour-blind can tell apart  (after Okabe & Ito 2008, darkened to be read as text);
blue is the sea's own.
"""
ENERGY_COLOURS = ("#ffffff", "#d3ecef", "#86c8d6", "#3a8fb7", "#1f5595", "#141c52")
"""White to navy, each step darker than the last: a scale that survives grey printing."""

_STYLE: dict[str, Any] = {
    "font.size": 10.0,
    "text.color": INK,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.titlesize": 12.0,
    "figure.titleweight": "bold",
    "xtick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.color": FAINT,
    "ytick.labelcolor": INK,
    "svg.hashsalt": "fftocean",  # the same bytes each time
    "path.simplify": True,
}
_PAPER: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.75}
_NOTHING = 1e-24  # [m^2]: waves of a picometre are no waves


def plot_spectrum(sea: Sea) -> "Figure":
    """
    Draw S(omega) of a sea and of its systems, with their peaks.

    For TMA the deep-water spectrum that it comes from is dotted; for JONSWAP the Pierson-Moskowitz
    spectrum under it.

    Raises:
        ParameterError: not a sea, or matplotlib is not installed.
    """
    return _drawn(_draw_spectrum, sea, Sea, height=4.7)


def plot_directions(sea: Sea) -> "Figure":
    """
    Draw the spectrum over frequency and direction, as seen from above: north up, each wave where it
    goes TO.

    Raises:
        ParameterError: not a sea, or matplotlib is not installed.
    """
    return _drawn(_draw_directions, sea, Sea, height=5.0)


def plot_delivered(ocean: Ocean) -> "Figure":
    """
    Draw what was ordered against what the waves of this one draw deliver, with the scatter that
    chance allows.

    Raises:
        ParameterError: not an ocean, or matplotlib is not installed.
    """
    return _drawn(_draw_delivered, ocean, Ocean, height=5.5)


def plot_dispersion(ocean: Ocean) -> "Figure":
    """
    Draw the waves of a tile by wavenumber, the law that gives each its frequency, and the proof
    that its frames obey.

    The proof is a Fourier transform of the height in space and time, over one loop or two dozen
    periods.

    Raises:
        ParameterError: not an ocean, or matplotlib is not installed.
    """
    return _drawn(_draw_dispersion, ocean, Ocean, height=5.5)


def plot_job(ocean: Ocean) -> "Figure":
    """
    Draw the four pictures of an ocean on one sheet.

    Raises:
        ParameterError: not an ocean, or matplotlib is not installed.
    """
    return _drawn(_draw_job, ocean, Ocean, width=2.0 * WIDTH, height=11.0)


def save(figure: "Figure", path: str | Path) -> Path:
    """
    Write a picture so that the file is either whole or absent; the same figure gives the same
    bytes.

    Args:
        figure: what one of this room's functions returned.
        path: where to; its suffix, .png, .svg or .pdf, says as what.

    Raises:
        ParameterError: another suffix, or not a figure.
        OutputError: the file could not be written; nothing is left behind.
    """
    path = Path(path)
    write_whole(path, encoded(figure, path.suffix))
    return path


def encoded(figure: "Figure", suffix: str) -> bytes:
    """
    Return a picture as the bytes of a file; the same figure gives the same bytes.

    Raises:
        ParameterError: a suffix that is not .png, .svg or .pdf, or not a figure.
    """
    kind = suffix.lower()
    if kind not in SUFFIXES:
        raise ParameterError(
            f"a picture's name must end in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}, got {suffix!r:.80}"
        )
    with style():
        from matplotlib.figure import Figure

        if not isinstance(figure, Figure):
            raise ParameterError(f"figure must be a matplotlib Figure, got {figure!r:.80}")
        stream = io.BytesIO()
        undated: dict[str, Any] = {
            ".png": {"Software": None},
            ".svg": {"Date": None},
            ".pdf": {"CreationDate": None},
        }[kind]
        figure.savefig(stream, format=kind[1:], metadata=undated)
    return stream.getvalue()


def _drawn(
    draw: "Callable[[FigureBase, Subject], None]",
    subject: Subject,
    kind: type,
    *,
    height: float,
    width: float = WIDTH,
) -> "Figure":
    """A figure of its own, drawn in our style whatever the user's is."""
    if not isinstance(subject, kind):
        raise ParameterError(
            f"{kind.__name__.lower()} must be {'an' if kind is Ocean else 'a'} {kind.__name__}, got {subject!r:.80}"
        )
    with style():
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        draw(figure, subject)
    return figure


def style() -> AbstractContextManager[None]:
    """matplotlib's own defaults with ours on top, for a while."""
    try:
        from matplotlib import style
    except ImportError as error:
        hint = how_to_install("plot")
        raise ParameterError(f"plots need matplotlib: {hint} ({error})") from error
    context: AbstractContextManager[None] = style.context(["default", _STYLE])
    return context


# --- the spectrum


def _draw_spectrum(figure: "FigureBase", sea: Sea) -> None:
    if _is_flat(sea):
        _say(
            figure,
            "Spectrum: the sea is exactly flat",
            "No waves: S(ω) is 0 m² s/rad at every frequency.",
        )
        return
    low, high = _band(sea)
    omega = _frequencies(sea, low, high)
    s, m0, tp = sea(omega), sea.variance, sea.tp
    hs = 4.0 * math.sqrt(m0)
    figure.suptitle(
        f"Spectrum: a sea of Hs {_three(hs)} m whose energy peaks at a period of {_three(tp)} s",
        x=0.01,
        ha="left",
    )
    ax = figure.subplots()
    ax.set(
        xlabel="angular frequency ω [rad/s]",
        ylabel="variance density S(ω) [m² s/rad]",
        xlim=(low, high),
    )
    _period_axis(ax, low, high)
    ax.fill_between(omega, s, color=BLUE, alpha=0.12, linewidth=0.0)
    ax.plot(omega, s, color=INK, linewidth=2.0, gid="sea")
    peak = 2.0 * math.pi / tp
    top = float(sea(peak))
    labels = [
        _Label(f"peak: Tp = {_three(tp)} s", INK, (peak, top)),
        _Label(
            f"the sea: area m₀ = {_three(m0)} m², so Hs = 4√m₀ = {_three(hs)} m",
            INK,
            _flank(omega, s, 0.8),
        ),
    ]
    if len(sea.systems) > len(SYSTEMS):
        labels.append(
            _Label(f"grey: its {len(sea.systems)} wave systems", FAINT, _flank(omega, s, 0.4))
        )
    origins = [
        (i, *origin)
        for i, w in enumerate(sea.systems)
        for origin in _origins(w.spectrum, omega)
        if len(sea.systems) <= 3
    ]
    highest = max([top, *(float(np.max(origin(omega))) for _, _, origin, _ in origins)])
    ceiling = min(
        1.15 * highest, 2.2 * top
    )  # a deep-water spectrum may leave the picture, but not dwarf what is left of it
    envelope = s.copy()
    for i, system in enumerate(sea.systems):
        part = system.spectrum(omega)
        if not np.any(part > 0.0):
            continue
        few = len(sea.systems) <= len(SYSTEMS)
        colour = SYSTEMS[i] if few else FAINT
        if len(sea.systems) > 1:
            ax.plot(omega, part, color=colour, linewidth=1.3, gid=f"system {i}")
            if few:
                labels.append(_Label(_described(system), colour, _flank(omega, part, 0.6)))
        if isinstance(system.spectrum, TabulatedSpectrum):
            measured = np.asarray(system.spectrum.breaks)
            labels.append(
                _Label(
                    "dots: the frequencies measured",
                    colour,
                    _flank(measured, system.spectrum(measured), 0.15),
                )
            )
            ax.plot(
                measured,
                system.spectrum(measured),
                "o",
                color=colour,
                markersize=3.5,
                gid=f"points {i}",
                clip_on=True,
            )
    for i, name, origin, dashes in origins:
        before = origin(omega)
        ax.plot(omega, before, color=SYSTEMS[i], linestyle=dashes, linewidth=1.5, gid=f"{name} {i}")
        level = 0.5 if dashes == "--" else min(0.85, 0.85 * ceiling / float(np.max(before)))
        words = f"{name}: Hs {_three(moments.significant_wave_height(origin))} m"
        labels.append(_Label(words, SYSTEMS[i], _flank(omega, before, level)))
        if float(np.max(before)) < ceiling:
            envelope = np.maximum(envelope, before)
    ax.plot([peak, peak], [0.0, top], color=INK, linewidth=0.8, linestyle=(0, (2, 2)))
    ax.plot([peak], [top], "o", color=INK, markersize=6.0, gid="peak")
    ax.set_ylim(0.0, ceiling)
    _spell_out(ax.yaxis, ceiling)
    _label(ax, labels, (omega, envelope), height=3.3)


def _origins(spectrum: FrequencySpectrum, omega: Real) -> list[tuple[str, FrequencySpectrum, Any]]:
    """
    The spectrum that a spectrum was made from, where the two can be told apart on `omega`: a name,
    it, and a line style.
    """
    inner = spectrum.spectrum if isinstance(spectrum, TMA) else spectrum
    if not np.any(inner(omega) > 0.0):
        return []
    if np.max(np.abs(inner(omega) - spectrum(omega))) > 0.02 * np.max(inner(omega)):
        return [("in deep water", inner, ":")]
    if isinstance(inner, JONSWAP) and inner.gamma > 1.0:
        return [("Pierson-Moskowitz, γ = 1", replace(inner, gamma=1.0), "--")]
    return []


def _described(system: WaveSystem) -> str:
    """A wave system in half a line."""
    words = {
        "TabulatedSpectrum": "measured",
        "CustomSpectrum": "custom",
        "PiersonMoskowitz": "Pierson-Moskowitz",
    }
    name = type(system.spectrum).__name__
    hs, tp = moments.significant_wave_height(system.spectrum), moments.peak_period(system.spectrum)
    return f"{words.get(name, name)}: Hs {_three(hs)} m, Tp {_three(tp)} s, toward {_compass(system.direction)}"


# --- the directions


def _draw_directions(figure: "FigureBase", sea: Sea) -> None:
    if _is_flat(sea):
        _say(figure, "Directions: the sea is exactly flat", "No waves: nothing goes anywhere.")
        return
    from matplotlib.colors import PowerNorm

    state = ordered(sea)
    toward = f"toward {_compass(state.mean_direction)} ({_degrees(state.mean_direction, 0)})"
    if state.spread > _ALL_ROUND:
        toward = "all round"
    goes = (
        "the energy goes"
        if len(sea.systems) == 1
        else f"{len(sea.systems)} wave systems, on average"
    )
    figure.suptitle(
        f"Directions: {goes} {toward}, spread by {state.spread:.0f}°", x=0.01, ha="left"
    )
    low, high = _band(sea, 0.02)
    rim = high / (2.0 * math.pi)  # [Hz]
    frequency, theta, density = _polar_spectrum(sea, rim)
    ax = cast("PolarAxes", figure.add_subplot(projection="polar"))
    mesh = ax.pcolormesh(
        theta,
        frequency,
        density,
        cmap=_energy_map(),
        norm=PowerNorm(0.5, 0.0, float(np.max(density))),
        rasterized=True,
    )
    mesh.set_gid("density")
    ax.set_ylim(0.0, rim)
    ax.grid(color=FAINT, alpha=0.35, linewidth=0.6)
    ax.spines["polar"].set_color(FAINT)
    names = ("E\n0°", "NE", "N  90°", "NW", "W\n180°", "SW", "S  270°", "SE")
    ax.set_xticks(np.arange(8) * math.pi / 4.0, names)
    rings = _nice_periods(0.14 * high, 0.95 * high, 0.16 * high)
    ax.set_yticks([1.0 / period for period in rings], [f"{period:g} s" for period in rings])
    ax.set_rlabel_position(state.mean_direction + 180.0 + 22.5)
    for text in ax.get_yticklabels():
        text.set(fontsize=8.5, color=INK, ha="center", va="center", bbox=_PAPER)
    for i, system in enumerate(sea.systems):
        if np.any(system.spectrum(_frequencies(sea, low, high)) > 0.0):
            _arrow(ax, system, rim, SYSTEMS[i] if len(sea.systems) <= len(SYSTEMS) else None)
    figure.supxlabel(
        "Seen from above; waves go from the centre outward. Rings: wave period, evenly spaced in frequency.",
        fontsize=8.5,
    )
    bar = figure.colorbar(mesh, ax=ax, shrink=0.75, pad=0.08)
    bar.set_label("variance density [m²/Hz/degree]")
    bar.outline.set_visible(False)


def _polar_spectrum(
    sea: Sea, highest: float, rings: int = 160, sectors: int = 240
) -> tuple[Real, Real, Real]:
    """
    Average a sea's spectrum over cells of frequency and direction; so even a swell narrower than a
    cell keeps its energy.

    Args:
        sea: what was ordered.
        highest: the frequency up to which to look [Hz].
        rings, sectors: how many cells.

    Returns:
        Edges of the cells in frequency, (rings + 1,) [Hz], and in direction, (sectors + 1,) [rad],
        counter-clockwise from +x, and the density, (rings, sectors) [m^2/Hz/degree].
    """
    parts_f = 3
    frequency, theta = (
        np.linspace(0.0, highest, rings + 1),
        np.linspace(0.0, 2.0 * math.pi, sectors + 1),
    )
    omega = (np.arange(rings * parts_f) + 0.5) * (2.0 * math.pi * highest / (rings * parts_f))
    density = np.zeros((rings * parts_f, sectors))
    for part in Cells(sea, 1.0, 1.0).parts:
        spectrum = part.share * part.system.spectrum(omega)
        if part.long_crested:
            density[:, int(part.direction / (2.0 * math.pi) * sectors) % sectors] += spectrum
            continue
        sector, low, high = split(theta[:-1], theta[1:], part.theta)
        around, weight = gauss(low, high, 4)
        spread = (
            part.system.spreading(
                omega[:, None], around.ravel() - part.direction, part.system.spectrum.peak
            )
            * weight.ravel()
        )
        pieces = spectrum[:, None] * np.sum(spread.reshape(omega.size, *weight.shape), axis=2)
        density += np.add.reduceat(pieces, np.searchsorted(sector, np.arange(sectors)), axis=1)
    density *= 2.0 * math.pi * math.pi / 180.0 / (2.0 * math.pi / sectors)
    return frequency, theta, density.reshape(rings, parts_f, sectors).mean(axis=1)


# [degrees]: the mean of all directions is then shorter than 0.05, and its own direction means
# little
_ALL_ROUND = 79.0


def _arrow(ax: "PolarAxes", system: WaveSystem, rim: float, colour: str | None) -> None:
    """
    Mark at the rim where a system goes; beside the arrow, its period and direction, if it has a
    colour of its own.
    """
    theta = math.radians(system.direction % 360.0)
    style = {
        "arrowstyle": "-|>,head_width=0.3,head_length=0.6",
        "color": colour or FAINT,
        "linewidth": 2.0,
        "shrinkA": 0.0,
        "shrinkB": 0.0,
    }
    ax.annotate("", (theta, rim), xytext=(theta, 0.78 * rim), arrowprops=style, gid="direction")
    if colour is None:
        return
    ax.annotate(
        f"Tp {_three(moments.peak_period(system.spectrum))} s\ntoward {_degrees((system.direction + 180.0) % 360.0 - 180.0, 0)}",
        (theta, 0.74 * rim),
        xytext=(40.0 * math.sin(theta), -20.0 * math.cos(theta)),  # beside the arrow
        textcoords="offset points",
        color=colour,
        fontsize=9.0,
        ha="center",
        va="center",
        bbox=_PAPER,
    )


# --- what was delivered


def _draw_delivered(figure: "FigureBase", ocean: Ocean) -> None:
    statistics = measure(ocean)
    sea = None if ocean.sea is None or _is_flat(ocean.sea) else ocean.sea
    if sea is None and statistics.m0 < _NOTHING:
        _say(figure, "Delivered: the tile is exactly flat", "No waves were ordered, and none came.")
        return
    figure.suptitle(_verdict(statistics), x=0.01, ha="left")
    ax, below = figure.subplots(2, 1, height_ratios=(3.0, 1.15))
    edges, energy, expected, scatter = _delivered_spectrum(ocean)
    density = energy / np.diff(edges)
    high = (
        _band(sea)[1]
        if sea is not None
        else 1.2 * float(np.max(edges[1:][energy > 1e-3 * np.max(energy)]))
    )
    omega = np.union1d(np.linspace(0.0, high, 600), edges[edges < high])
    shown = np.zeros_like(omega)
    seen = edges[:-1] < high
    ends = np.minimum(edges[1:], 0.98 * high)[seen]
    labels = []
    if sea is not None and statistics.ordered is not None:
        omega = np.union1d(omega, _frequencies(sea, 0.0, high))
        shown = sea(omega)
        ax.plot(omega, shown, color=INK, linewidth=1.5, gid="ordered")
        labels.append(
            _Label(f"ordered: Hs {_three(statistics.ordered.hs)} m", INK, _flank(omega, shown, 0.9))
        )
    if np.any(seen):
        ax.stairs(density, edges, color=BLUE, linewidth=1.8, gid="delivered")
        by = "delivered by this draw" if sea is not None else "the waves that were given"
        labels.append(
            _Label(f"{by}: Hs {_three(statistics.hs)} m", BLUE, _flank(ends, density[seen], 0.6))
        )
        upper, lower = (
            (expected + scatter) / np.diff(edges),
            np.maximum(expected - scatter, 0.0) / np.diff(edges),
        )
        if np.any(scatter > 0.0):
            ax.stairs(
                upper,
                edges,
                baseline=lower,
                fill=True,
                color=BLUE,
                alpha=0.15,
                linewidth=0.0,
                gid="scatter",
            )
            labels.append(
                _Label(
                    "shaded: ordered, in these bins,\n± 1 standard deviation of draws",
                    FAINT,
                    _flank(ends, upper[seen], 0.2),
                )
            )
        inside = np.clip(np.searchsorted(edges, omega, side="right") - 1, 0, density.size - 1)
        shown = np.maximum(
            shown,
            np.where(
                (omega >= edges[0]) & (omega <= edges[-1]), np.maximum(density, upper)[inside], 0.0
            ),
        )
    ax.set(
        xlabel="angular frequency ω [rad/s]",
        ylabel="variance density S(ω) [m² s/rad]",
        xlim=(0.0, high),
    )
    ax.set_ylim(0.0, 1.12 * float(np.max(shown)))
    _spell_out(ax.yaxis, float(np.max(shown)))
    _period_axis(ax, 0.08 * high, high)
    longest, shortest = _tile_band(ocean)
    for left, right, words in (
        (0.0, longest, "longer than the tile"),
        (shortest, high, "shorter than two samples"),
    ):
        if left < right:
            ax.axvspan(left, right, color=SHADE, linewidth=0.0, zorder=0, gid=words)
            if right - left > 0.035 * high:
                ax.text(
                    0.5 * (left + right),
                    0.97,
                    words,
                    transform=ax.get_xaxis_transform(),
                    rotation=90,
                    **_IN_SHADE,
                )
    _label(ax, labels, (omega, shown), height=2.6)
    _tabulate(below, statistics)


_IN_SHADE: dict[str, Any] = {"color": FAINT, "fontsize": 9.0, "ha": "center", "va": "top"}


def _verdict(statistics: Statistics) -> str:
    """One line: how what came differs from what was ordered, and why."""
    if statistics.ordered is None:
        return f"Delivered: the waves that were given, Hs {_three(statistics.hs)} m"
    both = f"Delivered: Hs {_three(statistics.hs)} m of {_three(statistics.ordered.hs)} m ordered"
    if statistics.resolved < 0.9 * statistics.ordered.m0:
        return f"{both}; this tile cannot hold {'the rest' if statistics.m0 > _NOTHING else 'any of it'}"
    scatter = _scatter_of_hs(statistics)
    if scatter > 0.0:
        apart = abs(statistics.hs - 4.0 * math.sqrt(statistics.resolved)) / scatter
        return f"{both}, {'within chance' if apart < 2.0 else 'a rare draw'} ({apart:.1f} σ)"
    return both


def _scatter_of_hs(statistics: Statistics) -> float:
    """Standard deviation of Hs from draw to draw [m]: half as much, relatively, as m0's."""
    return 0.5 * statistics.sampling_error * 4.0 * math.sqrt(statistics.resolved)


def _delivered_spectrum(ocean: Ocean) -> tuple[Real, Real, Real, Real]:
    """
    Sum the energy of an ocean's waves in bins of frequency, each wide enough to hold several of
    them.

    On a loop the waves have a few frequencies only, and the bins' edges lie half way between them.

    Args:
        ocean: any ocean.

    Returns:
        Edges of the bins, (b + 1,) [rad/s], and, (b,) [m^2] each: the waves' a^2/2, its average
        over draws, and its standard deviation from draw to draw. The bins hold every wave of the
        tile; there are none if the tile has no wave.
    """
    a, grid = ocean.amplitudes, ocean.grid
    once = grid.active & ((grid.mx[None, :] > 0) | (grid.my[:, None] > 0))
    omega = a.running_omega[once]
    if not omega.size:
        return np.zeros(1), np.zeros(0), np.zeros(0), np.zeros(0)
    step, lowest, highest = (
        (_mean_omega(ocean) or float(np.max(omega))) / 24.0,
        _tile_band(ocean)[0],
        float(np.max(omega)),
    )
    if ocean.loop is not None and 2.0 * math.pi / ocean.loop > step:
        step = 2.0 * math.pi / ocean.loop
        lowest = 0.5 * step
    fine = np.arange(min(lowest, float(np.min(omega))), highest + 2.0 * step, step)
    waves, _ = np.histogram(omega, fine)
    k = dispersion.wavenumber(fine, a.depth, a.surface_tension) / max(
        grid.dkx, grid.dky
    )  # in cells
    edges, held, since = [fine[0]], 0, k[0]
    for i, count in enumerate(waves, 1):
        held += count
        if held >= _WAVES_A_BIN and k[i] - since >= _CELLS_A_BIN:
            edges.append(fine[i])
            held, since = 0, k[i]
    if len(edges) == 1 or held:
        edges.append(fine[-1])
    m = ocean.modes()
    energy, _ = np.histogram(m.omega, edges, weights=0.5 * m.amplitude**2)
    ahead, astern = a.variance_forward[once], a.variance_backward[once]
    expected, _ = np.histogram(omega, edges, weights=ahead + astern)
    square, _ = np.histogram(omega, edges, weights=ahead**2 + astern**2)
    return (
        np.asarray(edges),
        energy,
        expected,
        np.sqrt(square) if a.draw == "gaussian" else np.zeros_like(square),
    )


_WAVES_A_BIN = 4  # with those opposite to them, eight
_CELLS_A_BIN = 1.0  # two rings of wavenumbers closer than this hold now many cells, now few


def _tile_band(ocean: Ocean) -> tuple[float, float]:
    """
    The lowest and the highest frequency [rad/s] that the cells of a tile reach along the axes.
    """
    grid, a = ocean.grid, ocean.amplitudes
    (reach_x, reach_y), omega = grid.reach, dispersion.angular_frequency
    low, high = (
        min(grid.dkx, grid.dky) / 2.0,
        max((reach_x + 0.5) * grid.dkx, (reach_y + 0.5) * grid.dky),
    )
    return float(omega(low, a.depth, a.surface_tension)), float(
        omega(high, a.depth, a.surface_tension)
    )


def _tabulate(ax: "Axes", statistics: Statistics) -> None:
    """
    Write the figures under the picture: each quantity ordered, delivered, and how far draws
    scatter.
    """
    ax.set_axis_off()
    sea, scatter = statistics.ordered, _scatter_of_hs(statistics)
    spread = f"± {scatter:.2g} m" if scatter else "none" if sea else ""
    rows = [
        ("", "ordered" if sea else "", "delivered", "expected scatter" if sea else ""),
        (
            "significant wave height Hs",
            f"{_three(sea.hs)} m" if sea else "",
            f"{_three(statistics.hs)} m",
            spread,
        ),
        ("peak period Tp", f"{_three(sea.tp)} s" if sea else "", f"{_three(statistics.tp)} s", ""),
        (
            "mean direction, toward",
            _degrees(sea.mean_direction) if sea else "",
            _degrees(statistics.mean_direction),
            "",
        ),
        (
            "directional spread",
            _degrees(sea.spread) if sea else "",
            _degrees(statistics.spread),
            "",
        ),
    ]
    for i, row in enumerate(rows):
        for x, text, colour in zip(
            (0.0, 0.55, 0.75, 1.0), row, (INK, INK, BLUE, FAINT), strict=True
        ):
            ax.text(
                x,
                1.0 - 0.15 * i,
                text,
                color=colour,
                ha="left" if x == 0.0 else "right",
                va="top",
                in_layout=False,
            )
    notes = []
    if sea is not None and sea.m0 > 0.0:
        lost = (
            _percent(statistics.energy_below / sea.m0),
            _percent(statistics.energy_above / sea.m0),
        )
        notes.append(
            f"Outside the tile: {lost[0]} of the energy in longer waves, {lost[1]} in shorter ones."
        )
    if statistics.loop is not None:
        e = statistics.loop
        better = (
            f"; one of {e.better_period:g} s, by {_percent(e.better_rms)}"
            if e.better_period != e.period
            else ""
        )
        notes.append(
            f"A loop of {e.period:g} s bends the waves' frequencies by {_percent(e.rms)} rms{better}."
        )
    else:
        notes.append("No loop: every wave runs at its own frequency.")
    ax.text(
        0.0, 0.22, "\n".join(notes), color=FAINT, fontsize=9.0, ha="left", va="top", in_layout=False
    )


def _percent(share: float) -> str:
    """A share in words; what rounds to nothing is nothing."""
    return (
        "0 %"
        if share < 5e-5
        else f"{100.0 * share:.2g} %"
        if share < 0.99
        else f"{100.0 * share:.0f} %"
    )


# --- the dispersion relation


def _draw_dispersion(figure: "FigureBase", ocean: Ocean) -> None:
    if np.sum(ocean.modes().amplitude ** 2) < _NOTHING:
        _say(figure, "Dispersion: the tile is exactly flat", "It holds no wave that could run.")
        return
    measured = _measured_dispersion(ocean)
    share, law = (
        f"{100.0 * measured.on_curve:.3g} %",
        "ω(k)" if ocean.amplitudes.surface_tension else _law(ocean),
    )
    figure.suptitle(
        f"Dispersion: {share} of the energy within {measured.tolerance:.2g} rad/s of {law}",
        x=0.01,
        ha="left",
    )
    left, right = figure.subfigures(1, 2, width_ratios=(1.2, 1.0), squeeze=False)[0]
    _draw_ring(left, ocean, measured.k_max)
    above, under = right.subplots(2, 1, sharex=True)
    _draw_law(above, ocean, measured)
    _draw_measured(under, ocean, measured)


def _law(ocean: Ocean) -> str:
    """The dispersion relation of an ocean, in letters."""
    force = (
        "(gk + σk³/ρ)"
        if ocean.amplitudes.surface_tension
        else "gk"
        if math.isfinite(ocean.depth)
        else "(gk)"
    )
    return f"ω = √({force} tanh kh)" if math.isfinite(ocean.depth) else f"ω = √{force}"


class _Measured(NamedTuple):
    """The energy of the water's height by wavenumber and frequency, out of its frames."""

    k: Real  # edges of the cells in wavenumber, (p + 1,) [rad/m]
    omega: Real  # edges of the cells in frequency, (q + 1,) [rad/s]
    energy: Real  # (q, p) [m^2]
    on_curve: float  # share of the energy within `tolerance` of omega(k) [-]
    tolerance: float  # half a step of a loop, or two steps of the window [rad/s]
    frames: int  # how many were transformed
    k_max: float  # up to which wavenumber [rad/m]


def _measured_dispersion(ocean: Ocean) -> _Measured:
    """
    Transform the height in space and time: where energy is found, nobody told it to be.

    A loop that is not too long is taken whole: then a frequency of the transform is one of the
    loop's, and no energy leaks. Else two dozen periods are seen through a Hann window, which
    spreads each frequency over two steps to either side.

    Args:
        ocean: one that is not flat.

    Returns:
        `_Measured`; waves shorter than those which hold 97 % of the energy are left out, and all
        but the strongest 2^15.
    """
    a, grid = ocean.amplitudes, ocean.grid
    k_max = _reach(ocean)
    omega_max = float(dispersion.angular_frequency(k_max, a.depth, a.surface_tension))
    strength = a.squares
    used = np.flatnonzero(
        grid.active & ((grid.mx[None, :] > 0) | (grid.my[:, None] > 0)) & (grid.k <= k_max)
    )
    used = used[np.argsort(strength.flat[used])[-_MOST_WAVES:]]
    k = grid.k.flat[used]
    period, whole = ocean.loop or 0.0, True
    if not 0.0 < period * omega_max / math.pi < _MOST_FRAMES - 4:
        period, whole = _PERIODS * 2.0 * math.pi / _mean_omega(ocean), False
    count = 2 * math.ceil(omega_max * period / (2.0 * math.pi)) + 4
    if count > _MOST_FRAMES:
        count, period = _MOST_FRAMES, (_MOST_FRAMES - 4) * math.pi / omega_max
    series = np.empty((count, k.size), np.complex128)
    frame, fields = None, ("height",)
    for j in range(count):
        frame = (
            ocean.loop_frame(j, count, fields, out=frame)
            if whole
            else ocean.frame(j * period / count, fields, out=frame)
        )
        series[j] = np.fft.rfft2(frame.height.astype(np.float64)).flat[used] / frame.height.size
    if not whole:
        window = np.sin(np.arange(count) * (math.pi / count)) ** 2
        series *= (window / math.sqrt(np.mean(window**2)))[:, None]
    energy = (
        2.0 * np.abs(np.fft.fft(series, axis=0) / count) ** 2
    )  # (frequency, wave); the wave along +k turns backward
    step = 2.0 * math.pi / period
    turns = np.abs(np.fft.fftfreq(count, 1.0 / count))
    true = dispersion.angular_frequency(k, a.depth, a.surface_tension)
    tolerance = (
        0.5 + 1e-9 if whole else 2.0
    ) * step  # a wave half way between two frequencies of a loop has either
    near = np.abs(turns[:, None] * step - true[None, :]) <= tolerance
    width = max(min(grid.dkx, grid.dky), k_max / 100.0)
    k_edges = width * (np.arange(math.ceil(k_max / width - 0.5) + 2) - 0.5)
    omega_edges = step * (np.arange(count // 2 + 2) - 0.5)
    cells, _, _ = np.histogram2d(
        np.repeat(turns * step, k.size),
        np.tile(k, count),
        bins=(omega_edges, k_edges),
        weights=energy.ravel(),
    )
    return _Measured(
        k_edges,
        omega_edges,
        cells,
        float(np.sum(energy[near]) / np.sum(energy)),
        tolerance,
        count,
        k_max,
    )


_PERIODS, _MOST_FRAMES, _MOST_WAVES = 24.0, 256, 2**15  # 128 MiB


def _mean_omega(ocean: Ocean) -> float:
    """The energy-weighted mean frequency of an ocean's waves [rad/s]; 0 without waves."""
    m = ocean.modes()
    energy = m.amplitude**2
    total = float(np.sum(energy))
    return float(np.sum(energy * m.omega)) / total if total > 0.0 else 0.0


def _reach(ocean: Ocean) -> float:
    """The wavenumber below which 97 % of a tile's energy lies [rad/m], and room for four cells."""
    m = ocean.modes()
    k, energy = np.hypot(m.kx, m.ky), m.amplitude**2
    order = np.argsort(k)
    running = np.cumsum(energy[order])
    enough = float(k[order][np.searchsorted(running, 0.97 * running[-1])])
    return max(1.05 * enough, 4.0 * min(ocean.grid.dkx, ocean.grid.dky))


def _draw_ring(figure: "FigureBase", ocean: Ocean, k_max: float) -> None:
    """
    The plane of wavenumbers, each cell the energy of its wave; rings hold waves of one period.
    """
    from matplotlib.colors import LogNorm
    from matplotlib.patches import Circle

    ax = figure.subplots()
    a, grid, m = ocean.amplitudes, ocean.grid, ocean.modes()
    mx, my = np.rint(m.kx / grid.dkx).astype(int), np.rint(m.ky / grid.dky).astype(int)
    far_x, far_y = (
        min(math.ceil(k_max / grid.dkx), grid.reach[0]),
        min(math.ceil(k_max / grid.dky), grid.reach[1]),
    )
    seen = (np.abs(mx) <= far_x) & (np.abs(my) <= far_y)
    energy = np.zeros((2 * far_y + 1, 2 * far_x + 1))
    np.add.at(energy, (my[seen] + far_y, mx[seen] + far_x), 0.5 * m.amplitude[seen] ** 2)
    extent = (
        (-far_x - 0.5) * grid.dkx,
        (far_x + 0.5) * grid.dkx,
        (-far_y - 0.5) * grid.dky,
        (far_y + 0.5) * grid.dky,
    )
    top = float(np.max(energy))
    image = ax.imshow(
        np.ma.masked_less(energy, 1e-4 * top),
        norm=LogNorm(1e-4 * top, top),
        cmap=_energy_map(),
        extent=extent,
        origin="lower",
    )
    image.set_gid("waves")
    image.set_interpolation("nearest")
    ax.set(
        xlabel="kx, east [rad/m]",
        ylabel="ky, north [rad/m]",
        xlim=(-k_max, k_max),
        ylim=(-k_max, k_max),
    )
    ax.locator_params(nbins=6)
    _spell_out(ax.xaxis, k_max)
    _spell_out(ax.yaxis, k_max)
    ax.set_title("each cell a wave of the tile, where it goes;\nrings: waves of one period")
    away = complex(np.sum(m.amplitude**2 * np.exp(1j * np.arctan2(m.ky, m.kx))))
    opposite = -away / abs(away) if abs(away) > 0.0 else -1.0

    def radius_of(omega: float) -> float:
        return float(dispersion.wavenumber(omega, a.depth, a.surface_tension))

    low, high = (
        float(dispersion.angular_frequency(k, a.depth, a.surface_tension))
        for k in (0.1 * k_max, 0.95 * k_max)
    )
    for period in _nice_periods(low, high, 0.17 * k_max, radius_of):
        radius = radius_of(2.0 * math.pi / period)
        ax.add_patch(
            Circle(
                (0.0, 0.0),
                radius,
                fill=False,
                edgecolor=VERMILION,
                linewidth=0.8,
                alpha=0.8,
                gid=f"ring {period:g}",
            )
        )
        ax.text(
            radius * opposite.real,
            radius * opposite.imag,
            f"{period:g} s",
            color=VERMILION,
            fontsize=8.5,
            ha="center",
            va="center",
            bbox=_PAPER,
        )
    bar = figure.colorbar(image, ax=ax, orientation="horizontal", shrink=0.9, pad=0.02)
    bar.set_label("energy of the wave, a²/2 [m²]")
    bar.outline.set_visible(False)


def _draw_law(ax: "Axes", ocean: Ocean, measured: _Measured) -> None:
    """
    omega(k) in this depth and in its limits, with the frequencies that the tile's waves do have.
    """
    a, grid = ocean.amplitudes, ocean.grid
    k = np.linspace(0.0, measured.k_max, 400)
    omega = dispersion.angular_frequency(k, a.depth, a.surface_tension)
    labels = [(f"here: {_law(ocean)}", BLUE)]
    if math.isfinite(a.depth):
        deep, shallow = (
            dispersion.angular_frequency(k, math.inf, a.surface_tension),
            k * math.sqrt(GRAVITY * a.depth),
        )
        ax.plot(k, deep, color=FAINT, linestyle="--", linewidth=1.2, gid="deep")
        ax.plot(k, shallow, color=FAINT, linestyle=":", linewidth=1.5, gid="shallow")
        labels += [("dashed: in deep water", FAINT), ("dotted: in shallow water, k√(gh)", FAINT)]
    ax.plot(k, omega, color=BLUE, linewidth=1.6, gid="law")
    if ocean.loop is not None:
        used = grid.active & (grid.k <= measured.k_max)
        pairs = np.unique(np.stack([grid.k[used], a.running_omega[used]]).round(9), axis=1)
        ax.plot(*pairs, ".", color=VERMILION, markersize=2.0, rasterized=True, gid="loop")
        labels.append((f"dots: the loop of {ocean.loop:g} s", VERMILION))
    top = float(dispersion.angular_frequency(measured.k_max, a.depth, a.surface_tension))
    ax.set(ylabel="ω [rad/s]", xlim=(0.0, measured.k_max), ylim=(0.0, 1.08 * top), title="the law")
    _stack(ax, labels)


def _draw_measured(ax: "Axes", ocean: Ocean, measured: _Measured) -> None:
    """Where the frames' energy is, in wavenumber and frequency, with the law on top."""
    from matplotlib.colors import LogNorm

    a = ocean.amplitudes
    top = float(np.max(measured.energy))
    shown = np.ma.masked_less(measured.energy, 1e-5 * top)
    mesh = ax.pcolormesh(
        measured.k,
        measured.omega,
        shown,
        norm=LogNorm(1e-5 * top, top),
        cmap=_energy_map(),
        rasterized=True,
    )
    mesh.set_gid("measured")
    k = np.linspace(0.0, measured.k_max, 400)
    omega = dispersion.angular_frequency(k, a.depth, a.surface_tension)
    ax.plot(k, omega, color=VERMILION, linewidth=1.0, gid="law")
    ax.set(
        xlabel="wavenumber k [rad/m]",
        ylabel="ω [rad/s]",
        xlim=(0.0, measured.k_max),
        ylim=(0.0, 1.08 * float(omega[-1])),
    )
    _spell_out(ax.xaxis, measured.k_max)
    ax.set_title(f"measured in {measured.frames} frames, by FFT")
    ax.text(
        0.98,
        0.05,
        f"shaded: energy of the height,\nin steps of {measured.omega[1] - measured.omega[0]:.2g} rad/s",
        color=INK,
        fontsize=9.0,
        ha="right",
        va="bottom",
        transform=ax.transAxes,
    )


# --- the sheet


def _draw_job(figure: "FigureBase", ocean: Ocean) -> None:
    grid = ocean.grid
    depth = f"{ocean.depth:g} m deep" if math.isfinite(ocean.depth) else "deep water"
    loop = f"repeats every {ocean.loop:g} s" if ocean.loop is not None else "never repeats in time"
    figure.suptitle(
        f"A tile of {grid.lx:g} × {grid.ly:g} m, {grid.nx} × {grid.ny} samples, {depth}; {loop}",
        fontsize=14,
    )
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.0, 1.15), hspace=0.03, squeeze=False)[
        :, 0
    ]
    spectrum, directions = upper.subfigures(1, 2, wspace=0.03, squeeze=False)[0]
    delivered, law = lower.subfigures(1, 2, wspace=0.03, squeeze=False)[0]
    if ocean.sea is None:
        for part, name in ((spectrum, "Spectrum"), (directions, "Directions")):
            _say(part, f"{name}: none was ordered", "This ocean was made of given waves.")
    else:
        _draw_spectrum(spectrum, ocean.sea)
        _draw_directions(directions, ocean.sea)
    _draw_delivered(delivered, ocean)
    _draw_dispersion(law, ocean)


# --- what they share


class _Label(NamedTuple):
    """Words in a curve's colour, and the point of it that they speak of."""

    text: str
    colour: str
    anchor: tuple[float, float]


def _stack(ax: "Axes", labels: Sequence[tuple[str, str]]) -> None:
    """
    Write labels, each with its colour, one above another in the lower right corner, which a rising
    curve leaves empty.
    """
    from matplotlib.transforms import offset_copy

    for i, (text, colour) in enumerate(reversed(labels)):
        corner = offset_copy(
            ax.transAxes, fig=ax.get_figure(root=True), x=-4.0, y=10.0 + 13.0 * i, units="points"
        )
        ax.text(
            1.0, 0.0, text, transform=corner, color=colour, ha="right", va="center", fontsize=9.0
        )


def _label(
    ax: "Axes", labels: Sequence[_Label], curve: tuple[Real, Real], *, height: float
) -> None:
    """
    Write each label right of its anchor, above all that is drawn there and clear of the others, and
    tie it to the anchor.

    Args:
        ax: with its limits set; the upper one is raised until all labels are under it.
        labels: in any order.
        curve: x and the highest y of all that is drawn.
        height: about how high the axes will be [in].
    """
    for _ in range(_ATTEMPTS):
        places = _places(ax, labels, curve, height)
        top = ax.get_ylim()[1]
        if all(y + half <= top for _, y, half, _ in places):
            break
        ax.set_ylim(top=1.06 * top)
    tie = {
        "arrowstyle": "-",
        "linewidth": 0.7,
        "relpos": (0.0, 0.5),
        "shrinkA": 0.0,
        "shrinkB": 1.0,
    }
    for (text, colour, anchor), (x, y, _, _) in zip(_from_below(labels), places, strict=True):
        place: dict[str, Any] = {
            "color": colour,
            "fontsize": _LABEL_SIZE,
            "va": "center",
            "bbox": _PAPER,
        }
        ax.annotate(text, anchor, xytext=(x, y), arrowprops={**tie, "color": colour}, **place)


def _places(
    ax: "Axes", labels: Sequence[_Label], curve: tuple[Real, Real], height: float
) -> list[tuple[float, float, float, float]]:
    """
    For each label from below: left end, middle, half height and right end, in the units of the
    axes.
    """
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    points_x, points_y = (WIDTH - 0.9) * 72.0 / (right - left), height * 72.0 / (top - bottom)
    taken: list[tuple[float, float, float, float]] = []
    for text, _, (x, y) in _from_below(labels):
        lines = text.split("\n")
        width = 0.56 * _LABEL_SIZE * max(map(len, lines)) / points_x
        half = 0.7 * _LABEL_SIZE * len(lines) / points_y
        start = max(min(x + 10.0 / points_x, right - width), left)
        beside = (curve[0] >= start - 4.0 / points_x) & (curve[0] <= start + width)
        level = max(y, float(np.max(curve[1][beside], initial=0.0)) + half)
        for from_x, middle, other, to_x in sorted(taken, key=lambda place: place[1]):
            if abs(level - middle) < half + other and start < to_x and from_x < start + width:
                level = middle + other + half
        taken.append((start, level, half, start + width))
    return taken


def _from_below(labels: Sequence[_Label]) -> list[_Label]:
    """Labels in the order in which they are placed."""
    return sorted(labels, key=lambda label: label.anchor[1])


_ATTEMPTS = 12
_LABEL_SIZE = 9.5


def _period_axis(ax: "Axes", low: float, high: float) -> None:
    """Mark the periods [s] along the top of an axis of frequencies."""
    top = ax.secondary_xaxis("top")
    longest = max(len(f"{period:g}") for period in _nice_periods(low, high, 0.055 * (high - low)))
    periods = _nice_periods(low, high, (0.055 + 0.014 * max(longest - 3, 0)) * (high - low))
    top.set_xticks(
        [2.0 * math.pi / period for period in periods], [f"{period:g}" for period in periods]
    )
    top.set_xlabel("period [s]")


def _nice_periods(
    low: float, high: float, apart: float, place: Callable[[float], float] = float
) -> list[float]:
    """
    Round periods [s], longest first, of frequencies from `low` to `high` [rad/s] whose places are
    at least `apart`; the roundest win.
    """
    first, last = (2.0 * math.pi / omega for omega in (high, max(low, 1e-3 * high)))
    kept: list[float] = []
    for mantissas in ((1.0, 2.0, 5.0), (3.0, 4.0, 8.0), (6.0, 1.5, 2.5, 7.0), (1.2, 9.0, 3.5, 4.5)):
        for exponent in range(math.floor(math.log10(first)), math.floor(math.log10(last)) + 1):
            for mantissa in mantissas:
                period = float(f"{mantissa}e{exponent}")
                far = all(
                    abs(place(2.0 * math.pi / period) - place(2.0 * math.pi / other)) >= apart
                    for other in kept
                )
                if first <= period <= last and far:
                    kept.append(period)
    return sorted(kept, reverse=True)


def _compass(direction: float) -> str:
    """The point of the compass nearest a direction given counter-clockwise from east [degrees]."""
    points = (
        "N",
        "NNE",
        "NE",
        "ENE",
        "E",
        "ESE",
        "SE",
        "SSE",
        "S",
        "SSW",
        "SW",
        "WSW",
        "W",
        "WNW",
        "NW",
        "NNW",
    )
    return points[round(((90.0 - direction) % 360.0) / 22.5) % 16]


def _three(value: float) -> str:
    """Three digits, zeros too, and an exponent only where nobody could count the zeros."""
    if not 1e-4 <= abs(value) < 1e6:
        return f"{value:.3g}"
    return f"{value:.0f}" if abs(value) >= 999.5 else f"{value:#.3g}".rstrip(".")


def _spell_out(axis: "Axis", most: float) -> None:
    """
    Write very small and very large numbers in full at each tick: an exponent above the axis is
    easily overlooked.
    """
    if not 1e-3 <= most < 1e5:
        from matplotlib.ticker import MaxNLocator

        axis.set_major_locator(MaxNLocator(4))
        axis.set_major_formatter("{x:.3g}")


def _degrees(value: float, digits: int = 1) -> str:
    """An angle with a true minus sign, and no minus zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}°".replace("-", "−")


def _energy_map() -> Any:
    """The colours of energy."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("energy", ENERGY_COLOURS)


def _say(figure: "FigureBase", title: str, words: str) -> None:
    """A picture of nothing, that says so."""
    figure.suptitle(title, x=0.01, ha="left")
    ax = figure.subplots()
    ax.set(xticks=[], yticks=[])
    for spine in ax.spines.values():
        spine.set_visible(False)
    ax.axhline(0.0, color=BLUE, linewidth=2.0)
    ax.set(xlim=(0.0, 1.0), ylim=(-1.0, 1.0))
    ax.text(0.5, 0.1, words, ha="center", va="bottom", fontsize=11)


def _is_flat(sea: Sea) -> bool:
    """Whether a sea has no waves to speak of."""
    omega = moments.spectral_grid([s.spectrum.peak for s in sea.systems], sea.breaks)
    return float(np.trapezoid(sea(omega), omega)) < _NOTHING


def _band(sea: Sea, faintest: float = 5e-3) -> tuple[float, float]:
    """
    The frequencies between which some system's spectrum is more than `faintest` of its highest
    [rad/s], with some room.
    """
    omega = moments.spectral_grid([s.spectrum.peak for s in sea.systems], sea.breaks)
    ends = []
    for system in sea.systems:
        s = system.spectrum(omega)
        if (top := float(np.max(s))) > 0.0:
            ends += [float(omega[i]) for i in np.flatnonzero(s >= faintest * top)[[0, -1]]]
    return 0.8 * min(ends), 1.08 * max(ends)


def _frequencies(sea: Sea, low: float, high: float) -> Real:
    """
    Frequencies on which to draw a sea [rad/s]: even, and dense round each peak, and every corner.
    """
    omega = np.union1d(
        np.linspace(low, high, 600),
        moments.spectral_grid([s.spectrum.peak for s in sea.systems], sea.breaks),
    )
    within: Real = omega[(omega >= low) & (omega <= high)]
    return within


def _flank(x: Real, y: Real, level: float) -> tuple[float, float]:
    """The last point of a curve that is still at `level` of its highest: on its right flank."""
    i = int(np.flatnonzero(y >= level * np.max(y))[-1])
    return float(x[i]), float(y[i])
