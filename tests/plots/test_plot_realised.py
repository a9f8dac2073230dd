"""The steps, shades and table of the realised spectrum's plot against the list of waves."""

import math

import numpy as np
import pytest
from plotted import MEASURED, found, plotted, words

import fftocean as fo
from fftocean import plots


@pytest.mark.parametrize("which", ["crossed", "measured"])
def test_the_steps_are_the_energy_of_the_waves(which, request):
    ocean = request.getfixturevalue(which)
    figure = plotted(plots.plot_realised, ocean)
    density, edges, _ = found(figure, "realised").get_data()
    m = ocean.modes()
    energy = m.amplitude**2 / 2
    assert np.sum(density * np.diff(edges)) == pytest.approx(np.sum(energy), rel=1e-12)
    for i in range(density.size):
        inside = (m.omega >= edges[i]) & (m.omega < edges[i + 1])
        assert density[i] * (edges[i + 1] - edges[i]) == pytest.approx(
            np.sum(energy[inside]), rel=1e-9, abs=1e-12 * np.sum(energy)
        )
    omega, s = found(figure, "specified").get_data()
    assert np.array_equal(s, ocean.sea(omega))
    if ocean.loop:  # edges half way between the loop's frequencies
        turns = edges * ocean.loop / (2 * np.pi)
        assert turns - np.floor(turns) == pytest.approx(0.5, abs=1e-9)


def test_the_shade_is_where_the_tile_has_no_waves(measured):
    """Half a cell below the longest wave, half a cell above the shortest: omega^2 = g k."""
    figure = plotted(plots.plot_realised, measured)
    dk, reach = 2 * math.pi / 400.0, 23
    low, high = found(figure, "longer than the tile"), found(figure, "shorter than two samples")
    assert low.get_x() + low.get_width() == pytest.approx(math.sqrt(9.80665 * dk / 2))
    assert high.get_x() == pytest.approx(math.sqrt(9.80665 * dk * (reach + 0.5)))


def test_the_table_says_what_measure_says(crossed):
    figure, s = plotted(plots.plot_realised, crossed), fo.measure(crossed)
    text = words(figure)
    assert figure.get_suptitle().startswith(
        f"Realised: Hs {s.hs:#.3g} m of {s.specified.hs:#.3g} m specified, "
    )
    for value in (
        f"{s.hs:#.3g} m",
        f"{s.specified.hs:#.3g} m",
        f"{s.tp:#.3g} s",
        f"{s.spread:.1f}°",
        f"{s.specified.spread:.1f}°",
    ):
        assert value in text
    assert f"± {0.5 * s.sampling_error * 4 * math.sqrt(s.resolved):.2g} m" in text
    assert f"{100 * s.loop.rms:.2g} % rms" in text


def test_a_tile_too_small_says_so():
    ocean = fo.Ocean(MEASURED, n=16, size=20.0)
    assert "cannot hold" in words(plotted(plots.plot_realised, ocean))
    none = fo.Ocean(MEASURED, n=1, size=20.0)
    assert "cannot hold any of it" in words(plots.plot_realised(none))
    assert "holds no wave" in words(plots.plot_dispersion(none))


def test_the_earlier_name_draws_the_same_plot(flat):
    former, plot = plots.plot_delivered(flat), plots.plot_realised(flat)
    assert plots.encoded(former, ".svg") == plots.encoded(plot, ".svg")
