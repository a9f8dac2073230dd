"""The curves of a spectrum's plot against the sea itself."""

import math

import numpy as np
import pytest
from plotted import BRIEF, CROSSED, MEASURED, SWELL, TABLE, WIND, found, plotted, words

import fftocean as fo
from fftocean import plots


@pytest.mark.parametrize(
    "sea", [CROSSED, BRIEF, MEASURED], ids=["TMA and JONSWAP", "two JONSWAP", "measured"]
)
def test_curves_are_the_spectra_of_the_sea_and_its_systems(sea):
    figure = plotted(plots.plot_spectrum, sea)
    omega, s = found(figure, "sea").get_data()
    assert np.array_equal(s, sea(omega))
    for i, system in enumerate(sea.systems if len(sea.systems) > 1 else ()):
        x, part = found(figure, f"system {i}").get_data()
        assert np.array_equal(part, system.spectrum(x))
    (x,), (y,) = found(figure, "peak").get_data()
    assert 2 * math.pi / x == pytest.approx(sea.tp)
    assert y == sea(x) >= np.max(s)
    hs = 4 * math.sqrt(np.trapezoid(s, omega))
    assert (
        0.98 < hs / sea.hs < 1.0001
    )  # all but a little is in the picture; trapezoids over some 1500 points are good to 1e-4
    assert f"{sea.hs:#.3g}" in words(figure)


def test_parent_spectra_are_drawn_where_they_differ():
    """
    TMA: the deep-water spectrum; JONSWAP: the same with gamma = 1, whose m0 is alpha g^2 / (5
        omega_p^4).
    """
    figure = plotted(plots.plot_spectrum, CROSSED)
    deep, under = found(figure, "in deep water 0"), found(figure, "Pierson-Moskowitz, γ = 1 1")
    assert np.array_equal(deep.get_ydata(), WIND.spectrum.spectrum(deep.get_xdata()))
    assert deep.get_linestyle() == ":"
    omega, pm = under.get_data()
    j = SWELL.spectrum
    closed = j.alpha * 9.80665**2 * omega**-5 * np.exp(-1.25 * (j.peak / omega) ** 4)
    assert pm == pytest.approx(closed, rel=1e-12, abs=1e-300)
    # depth that no wave feels is not worth a second curve
    deep_tma = fo.Sea.from_wind(speed=5.0, fetch=3e3, depth=200.0)
    assert "in deep water" not in words(plots.plot_spectrum(deep_tma))


def test_measured_points_are_drawn_where_they_were_measured():
    points = found(plotted(plots.plot_spectrum, MEASURED), "points 0")
    assert points.get_xdata() == pytest.approx(2 * np.pi * np.array(TABLE.frequency))
    assert points.get_ydata() == pytest.approx(np.array(TABLE.density) / (2 * np.pi))


def test_many_systems_are_drawn_and_counted():
    sea = fo.Sea(
        *[
            fo.WaveSystem(
                spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=4.0 + i), direction=40.0 * i
            )
            for i in range(7)
        ]
    )
    figure = plots.plot_spectrum(sea)
    total = sum(np.interp(1.1, *found(figure, f"system {i}").get_data()) for i in range(7))
    assert total == pytest.approx(
        float(sea(1.1)), rel=1e-3
    )  # straight lines between points 0.01 apart
    assert "7 wave systems" in words(figure)


def test_a_deep_water_spectrum_does_not_dwarf_the_sea():
    sea = fo.Sea.from_wind(speed=10.0, fetch=1e5, depth=0.1)  # holds 1/100 of what deep water would
    figure = plots.plot_spectrum(sea)
    assert figure.axes[0].get_ylim()[1] < 2.5 * np.max(found(figure, "sea").get_ydata())
    assert "in deep water" in words(figure)
