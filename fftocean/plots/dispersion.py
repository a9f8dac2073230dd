"""Plot of the dispersion relation of a tile's waves."""

import math
from typing import TYPE_CHECKING

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.measured_dispersion import MeasuredDispersion, measured_dispersion
from fftocean.ocean import Ocean
from fftocean.physics import dispersion
from fftocean.plots.axes import round_periods, spell_out_ticks
from fftocean.plots.figures import new_figure, panels, write_message
from fftocean.plots.labels import stack_labels
from fftocean.plots.ranges import NEGLIGIBLE
from fftocean.plots.theme import BLUE, FAINT, INK, LABEL_BOX, VERMILION, energy_colormap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase


def plot_dispersion(ocean: Ocean) -> "Figure":
    """
    Draw the waves of a tile by wavenumber, their dispersion relation, and its measurement.

    The measurement is a Fourier transform of the height in space and time, over one loop or two
    dozen periods.

    Raises:
        ParameterError: not an ocean, or matplotlib is not installed.
    """
    return new_figure(draw_dispersion, ocean, Ocean, height=5.5)


def draw_dispersion(figure: "FigureBase", ocean: Ocean) -> None:
    """Draw the dispersion relation of an ocean on a figure."""
    if np.sum(ocean.modes().amplitude ** 2) < NEGLIGIBLE:
        title = "Dispersion: the tile is exactly flat"
        write_message(figure, title, "It holds no wave that could run.")
        return
    measured = measured_dispersion(ocean)
    formula = "ω(k)" if ocean.amplitudes.surface_tension else _formula(ocean)
    figure.suptitle(
        f"Dispersion: {100.0 * measured.on_curve:.3g} % of the energy within "
        f"{measured.tolerance:.2g} rad/s of {formula}",
        x=0.01,
        ha="left",
    )
    left, right = panels(figure, 1, 2, width_ratios=(1.2, 1.0))
    _draw_wavenumbers(left, ocean, measured.k_max)
    above, under = right.subplots(2, 1, sharex=True)
    _draw_relation(above, ocean, measured)
    _draw_measured(under, ocean, measured)


def _formula(ocean: Ocean) -> str:
    """Return the dispersion relation of an ocean as a formula."""
    finite = math.isfinite(ocean.depth)
    force = "gk" if finite else "(gk)"
    if ocean.amplitudes.surface_tension:
        force = "(gk + σk³/ρ)"
    return f"ω = √({force} tanh kh)" if finite else f"ω = √{force}"


def _draw_wavenumbers(figure: "FigureBase", ocean: Ocean, k_max: float) -> None:
    """
    Draw the energy of each wave in the plane of wavenumbers, with rings of equal period.
    """
    from matplotlib.colors import LogNorm

    ax = figure.subplots()
    grid, m = ocean.grid, ocean.modes()
    mx, my = np.rint(m.kx / grid.dkx).astype(int), np.rint(m.ky / grid.dky).astype(int)
    far_x = min(math.ceil(k_max / grid.dkx), grid.reach[0])
    far_y = min(math.ceil(k_max / grid.dky), grid.reach[1])
    seen = (np.abs(mx) <= far_x) & (np.abs(my) <= far_y)
    energy = np.zeros((2 * far_y + 1, 2 * far_x + 1))
    np.add.at(energy, (my[seen] + far_y, mx[seen] + far_x), 0.5 * m.amplitude[seen] ** 2)
    half_x, half_y = (far_x + 0.5) * grid.dkx, (far_y + 0.5) * grid.dky
    top = float(np.max(energy))
    image = ax.imshow(
        np.ma.masked_less(energy, 1e-4 * top),
        norm=LogNorm(1e-4 * top, top),
        cmap=energy_colormap(),
        extent=(-half_x, half_x, -half_y, half_y),
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
    spell_out_ticks(ax.xaxis, k_max)
    spell_out_ticks(ax.yaxis, k_max)
    ax.set_title("each cell a wave of the tile, where it goes;\nrings: waves of one period")
    _draw_rings(ax, ocean, k_max)
    bar = figure.colorbar(image, ax=ax, orientation="horizontal", shrink=0.9, pad=0.02)
    bar.set_label("energy of the wave, a²/2 [m²]")
    bar.outline.set_visible(False)


def _draw_rings(ax: "Axes", ocean: Ocean, k_max: float) -> None:
    """Draw rings of equal period, labelled on the side from which the waves come."""
    from matplotlib.patches import Circle

    a, m = ocean.amplitudes, ocean.modes()
    toward = complex(np.sum(m.amplitude**2 * np.exp(1j * np.arctan2(m.ky, m.kx))))
    opposite = -toward / abs(toward) if abs(toward) > 0.0 else -1.0

    def radius_of(omega: float) -> float:
        return float(dispersion.wavenumber(omega, a.depth, a.surface_tension))

    low, high = (
        float(dispersion.angular_frequency(k, a.depth, a.surface_tension))
        for k in (0.1 * k_max, 0.95 * k_max)
    )
    for period in round_periods(low, high, 0.17 * k_max, radius_of):
        radius = radius_of(2.0 * math.pi / period)
        ring = Circle((0.0, 0.0), radius, fill=False, edgecolor=VERMILION, linewidth=0.8, alpha=0.8)
        ring.set_gid(f"ring {period:g}")
        ax.add_patch(ring)
        ax.text(
            radius * opposite.real,
            radius * opposite.imag,
            f"{period:g} s",
            color=VERMILION,
            fontsize=8.5,
            ha="center",
            va="center",
            bbox=LABEL_BOX,
        )


def _draw_relation(ax: "Axes", ocean: Ocean, measured: MeasuredDispersion) -> None:
    """
    Draw omega(k) at this depth and in its limits, and the frequencies of the tile's waves.
    """
    a, grid = ocean.amplitudes, ocean.grid
    k = np.linspace(0.0, measured.k_max, 400)
    omega = dispersion.angular_frequency(k, a.depth, a.surface_tension)
    labels = [(f"here: {_formula(ocean)}", BLUE)]
    if math.isfinite(a.depth):
        deep = dispersion.angular_frequency(k, math.inf, a.surface_tension)
        shallow = k * math.sqrt(GRAVITY * a.depth)
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
    stack_labels(ax, labels)


def _draw_measured(ax: "Axes", ocean: Ocean, measured: MeasuredDispersion) -> None:
    """Draw the energy of the frames by wavenumber and frequency, with omega(k) over it."""
    from matplotlib.colors import LogNorm

    a = ocean.amplitudes
    top = float(np.max(measured.energy))
    mesh = ax.pcolormesh(
        measured.k,
        measured.omega,
        np.ma.masked_less(measured.energy, 1e-5 * top),
        norm=LogNorm(1e-5 * top, top),
        cmap=energy_colormap(),
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
    spell_out_ticks(ax.xaxis, measured.k_max)
    ax.set_title(f"measured in {measured.frames} frames, by FFT")
    step = measured.omega[1] - measured.omega[0]
    ax.text(
        0.98,
        0.05,
        f"shaded: energy of the height,\nin steps of {step:.2g} rad/s",
        color=INK,
        fontsize=9.0,
        ha="right",
        va="bottom",
        transform=ax.transAxes,
    )
