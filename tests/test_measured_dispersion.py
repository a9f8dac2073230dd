"""The dispersion relation measured in frames against the list of waves."""

import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.measured_dispersion import measured_dispersion

SWELL = fo.WaveSystem(
    spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=11.0, gamma=7.0),
    spreading=fo.CosinePower(s=40.0),
    direction=110.0,
)
WIND_SEA = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=6.0), direction=-30.0)
SEA = fo.Sea(SWELL, WIND_SEA, depth=12.0)
WAVES = [(3, 1, 0.5, 0.2), (-3, -1, 0.3, 1.0), (0, -5, 0.2, 2.0)]


@pytest.fixture(scope="module")
def given():
    return fo.Ocean.from_modes(
        WAVES, n=(32, 24), size=(90.0, 70.0), depth=4.0, loop=25.0, dtype="float64"
    )


def test_energy_of_a_loop_lies_at_each_wave_s_wavenumber_and_frequency(given):
    """
    On a loop nothing leaks: each wave's a^2/2 is in its own cell of (k, omega), also of two that
    run against each other.
    """
    measured = measured_dispersion(given)
    m = given.modes()
    k, energy = np.hypot(m.kx, m.ky), m.amplitude**2 / 2
    mine, _, _ = np.histogram2d(m.omega, k, bins=(measured.omega, measured.k), weights=energy)
    assert measured.energy == pytest.approx(mine, abs=1e-12 * np.sum(energy))
    assert np.sum(mine) == pytest.approx(sum(a**2 / 2 for *_, a, _ in WAVES))
    assert measured.on_curve == pytest.approx(1.0, abs=1e-12)
    assert measured.tolerance == pytest.approx(np.pi / 25.0)
    assert np.diff(measured.k) == pytest.approx(2.0 * np.pi / 90.0)  # the finer of two cells


@pytest.mark.parametrize("loop", [None, 3600.0])
def test_a_window_keeps_the_energy_of_an_ocean_without_a_loop(loop):
    """The Hann window keeps the energy (Parseval) and all but 1e-3 of it within two steps."""
    ocean = fo.Ocean(SEA, n=32, size=400.0, seed=1, loop=loop, dtype="float64")
    measured = measured_dispersion(ocean)
    m = ocean.modes()
    inside = np.hypot(m.kx, m.ky) <= measured.k_max
    # waves at +k and -k share a coefficient, and the window does not quite part them: 1e-3
    assert np.sum(measured.energy) == pytest.approx(np.sum(m.amplitude[inside] ** 2) / 2, rel=2e-3)
    assert 0.998 < measured.on_curve <= 1.0
    assert measured.frames <= 256


def test_frames_off_the_dispersion_relation_are_detected(monkeypatch):
    """
    The frames of deep water, under the law of 2 m: the energy is measured, not computed from the
    law.
    """
    system = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=8.0), direction=20.0)
    deep, shallow = (
        fo.Ocean(fo.Sea(system, depth=depth), n=32, size=300.0, loop=80.0)
        for depth in (math.inf, 2.0)
    )
    assert measured_dispersion(shallow).on_curve > 0.999
    real = fo.Ocean.loop_frame
    monkeypatch.setattr(
        fo.Ocean, "loop_frame", lambda _, *arguments, **options: real(deep, *arguments, **options)
    )
    assert measured_dispersion(shallow).on_curve < 0.1
