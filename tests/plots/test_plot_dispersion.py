"""The dispersion relation's plot against given waves and closed forms."""

import math

import matplotlib.patches
import numpy as np
import pytest
from plotted import WAVES, angular, found, plotted

from fftocean import plots
from fftocean.measured_dispersion import measured_dispersion


def test_each_cell_of_the_ring_is_its_wave(given):
    """Three given waves: a^2/2 at (kx, ky), signs and all; no other cell is filled."""
    image = found(plotted(plots.plot_dispersion, given), "waves")
    energy, (left, right, bottom, top) = image.get_array(), image.get_extent()
    ny, nx = energy.shape
    for mx, my, a, _ in WAVES:
        column = (mx * 2 * math.pi / 90.0 - left) / (right - left) * nx
        row = (my * 2 * math.pi / 70.0 - bottom) / (top - bottom) * ny
        assert (column % 1, row % 1) == (
            pytest.approx(0.5),
            pytest.approx(0.5),
        )  # in the middle of its cell
        assert energy[int(row), int(column)] == pytest.approx(a**2 / 2, rel=1e-12)
    assert energy.count() == len(WAVES)


def test_the_ring_holds_97_percent(crossed):
    energy = found(plotted(plots.plot_dispersion, crossed), "waves").get_array()
    m = crossed.modes()
    assert (
        0.97 * np.sum(m.amplitude**2 / 2) < energy.sum() <= np.sum(m.amplitude**2 / 2) * (1 + 1e-12)
    )


def test_rings_are_circles_of_one_period(given):
    figure = plotted(plots.plot_dispersion, given)
    rings = [
        a for a in figure.findobj(matplotlib.patches.Circle) if str(a.get_gid()).startswith("ring ")
    ]
    assert len(rings) >= 2
    for ring in rings:
        assert 2 * math.pi / angular(ring.radius, given) == pytest.approx(
            float(ring.get_gid().split()[1]), rel=1e-12
        )


def test_the_law_and_its_limits(given):
    axes = plotted(plots.plot_dispersion, given).axes
    law = next(ax for ax in axes if ax.get_title(loc="left") == "the law")
    line = {a.get_gid(): a for a in law.lines}
    k, omega = line["law"].get_data()
    assert omega == pytest.approx(angular(k, given), rel=1e-12)
    assert line["deep"].get_ydata() == pytest.approx(np.sqrt(9.80665 * k), rel=1e-12)
    assert line["shallow"].get_ydata() == pytest.approx(k * math.sqrt(9.80665 * 4.0), rel=1e-12)
    k, omega = line["loop"].get_data()
    turns = omega * 25.0 / (2 * np.pi)
    assert turns == pytest.approx(np.rint(turns), abs=1e-7)  # drawn to nine decimals
    assert np.all(np.abs(omega - angular(k, given)) <= np.pi / 25.0 + 1e-7)


def test_the_measured_mesh_is_the_energy_of_the_frames(given):
    """The mesh leaves out cells below 1e-5 of the largest."""
    measured = measured_dispersion(given)
    mesh = found(plotted(plots.plot_dispersion, given), "measured")
    assert np.ma.filled(mesh.get_array(), 0.0).reshape(measured.energy.shape) == pytest.approx(
        measured.energy, abs=1e-5 * np.max(measured.energy)
    )
