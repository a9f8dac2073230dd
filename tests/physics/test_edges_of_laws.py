"""Laws at the places where their branches meet, and where an approximation could cut them off."""

import math

import numpy as np
import pytest
from scipy import integrate

from fftocean.physics.spectra import TMA, OchiHubble, TabulatedSpectrum
from fftocean.physics.spectra.growth import in_deep_water
from fftocean.physics.spreading import LongCrested

G = 9.80665


def test_energy_grows_without_a_step():
    """
    A fetch 0.1 % longer has at most 0.12 % more energy (4/3 - 0.22 = 1.113 is the power of the
    law), also where the growing sea becomes a nearly developed one.
    """
    for law in ("jonswap", "kahma-calkoen"):
        x = np.exp(np.arange(math.log(3e3), math.log(1e5), 1e-3))
        energy = np.array([in_deep_water(law, v, 3.3).energy for v in x])
        steps = np.diff(np.log(energy)) / 1e-3
        assert np.all((steps > -1e-6) & (steps < 1.12))


@pytest.mark.parametrize("d", [9.0, 11.0, 20.0])
def test_the_bed_is_felt_far_down(d):
    """Young & Verhagen 1996 at g h/U^2 = d: tanh(0.331 d^1.01) is 0.996 at 9, 1 - 2e-6 at 20."""
    speed, fetch = 6.0, 3e5
    x = G * fetch / speed**2
    a, b = math.tanh(0.331 * d**1.01), 5.215e-4 * x**0.73
    expected = 2.0 * math.pi * 0.133 * (a * math.tanh(b / a)) ** -0.37
    sea = TMA.from_wind(speed=speed, fetch=fetch, depth=d * speed**2 / G, growth="young-verhagen")
    assert sea.peak * speed / G == pytest.approx(expected, rel=1e-9)


def test_the_peak_of_two_halves_is_the_higher_density():
    """2.2 m at 5 s are lower than 2 m at 14 s: a density is m0 times a period."""
    sea = OchiHubble(
        hs_low=2.0, tp_low=14.0, lambda_low=1.0, hs_high=2.2, tp_high=5.0, lambda_high=1.0
    )
    omega = np.linspace(0.2, 2.0, 20001)
    assert sea.peak == pytest.approx(2.0 * math.pi / 14.0, rel=1e-12)
    assert omega[np.argmax(sea(omega))] == pytest.approx(sea.peak, rel=0.01)


def test_tail_of_a_table():
    f = np.linspace(0.05, 0.4, 30)
    s = TabulatedSpectrum(f, np.exp(-f), tail=4.5)
    last = 2.0 * math.pi * f[-1]
    assert s(3.0 * last) / s(last) == pytest.approx(3.0**-4.5, rel=1e-12)


def test_the_bell_of_long_crests_has_integral_one():
    sigma = math.radians(0.1)
    area, _ = integrate.quad(lambda t: float(LongCrested()(1.0, t, 1.0)), -12 * sigma, 12 * sigma)
    assert area == pytest.approx(1.0, rel=1e-9)
