"""The polar mesh, the compass and the arrows of the directions' plot."""

import math

import numpy as np
import pytest
from matplotlib.text import Annotation
from plotted import BRIEF, found, plotted, words

import fftocean as fo
from fftocean import plots
from fftocean.statistics import specified


def cells(mesh):
    """Density of a polar mesh [m^2/Hz/degree] with the sizes of its cells, and their directions."""
    corners = mesh.get_coordinates()
    theta, f = corners[0, :, 0], corners[:, 0, 1]
    density = np.asarray(mesh.get_array()).reshape(f.size - 1, theta.size - 1)
    return (
        density,
        np.diff(f)[:, None] * np.degrees(np.diff(theta))[None, :],
        0.5 * (theta[1:] + theta[:-1]),
        f[-1],
    )


@pytest.mark.parametrize(
    "spreading", [fo.Blend(), fo.CosinePower(s=1e5)], ids=["broad", "narrower than a cell"]
)
def test_the_polar_mesh_holds_the_energy_of_its_disc(spreading):
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0), spreading=spreading, direction=71.3
        )
    )
    density, area, theta, rim = cells(found(plots.plot_directions(sea), "density"))
    whole = fo.moments.moment(sea.systems[0].spectrum, 0, 0.0, 2 * math.pi * rim)
    assert np.sum(density * area) == pytest.approx(
        whole, rel=2e-3
    )  # midpoints 0.15 degrees and rim/480 apart
    mean = np.sum(density * area * np.exp(1j * theta))
    assert math.degrees(np.angle(mean)) == pytest.approx(71.3, abs=0.05)
    assert whole > 0.9 * sea.variance


def test_the_compass_is_the_right_way_round():
    """
    Our angle is counter-clockwise from east: E at 0, N at 90 degrees; the arrows point there, and
    go outward.
    """
    figure = plotted(plots.plot_directions, BRIEF)
    axes = figure.axes[0]
    assert (axes.get_theta_offset(), axes.get_theta_direction()) == (0.0, 1)
    letters = {
        round(math.degrees(t)): label.get_text()
        for t, label in zip(axes.get_xticks(), axes.get_xticklabels(), strict=True)
    }
    assert {angle: letters[angle][0] for angle in (0, 90, 180, 270)} == {
        0: "E",
        90: "N",
        180: "W",
        270: "S",
    }
    arrows = [a for a in figure.findobj(Annotation) if a.get_gid() == "direction"]
    assert sorted(round(math.degrees(a.xy[0])) % 360 for a in arrows) == [110, 330]
    assert all(a.xy[1] > a.xyann[1] for a in arrows)
    for tick, label in zip(axes.get_yticks(), axes.get_yticklabels(), strict=True):
        assert float(label.get_text().removesuffix(" s")) == pytest.approx(1.0 / tick)
    assert "2 wave systems" in words(figure)


def test_a_sea_that_goes_all_round_has_no_mean_direction():
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0), spreading=fo.CosinePower(s=0.0)
        )
    )
    assert specified(sea).spread > 80.0
    assert "all round" in words(plots.plot_directions(sea))
