"""
Growth of wind seas: the published laws, written here a second time, and their limits. Heights are
measured by Simpson's rule over the spectra.
"""

import math

import numpy as np
import pytest
from scipy import integrate

from fftocean.errors import ParameterError
from fftocean.physics.sea import Sea
from fftocean.physics.spectra import JONSWAP, TMA, PiersonMoskowitz
from fftocean.physics.spectra.growth import GROWTHS, peak_enhancement, shape_integral_at

G = 9.80665
FETCH = 200e3


def height(spectrum):
    """
    Return 4 sqrt(m0) [m] by Simpson's rule in the logarithm of frequency, to 1000 peaks: the
    kink at the peak is one of the points.
    """
    omega = spectrum.peak * np.concatenate(
        [np.geomspace(0.2, 1.0, 4001), np.geomspace(1.0, 1000.0, 12001)[1:]]
    )
    return 4.0 * math.sqrt(integrate.simpson(spectrum(omega) * omega, x=np.log(omega)))


def young_and_verhagen(speed, fetch, depth):
    """Return Hs [m] and Tp [s] as the paper has them."""
    x, d = G * fetch / speed**2, G * depth / speed**2
    a1, b1 = 0.493 * d**0.75, 3.13e-3 * x**0.57
    a2, b2 = 0.331 * d**1.01, 5.215e-4 * x**0.73
    energy = 3.64e-3 * (math.tanh(a1) * math.tanh(b1 / math.tanh(a1))) ** 1.74
    frequency = 0.133 * (math.tanh(a2) * math.tanh(b2 / math.tanh(a2))) ** -0.37
    return 4.0 * math.sqrt(energy) * speed**2 / G, speed / (G * frequency)


# U [m/s], h [m], Hs [m], Tp [s] at a fetch of 200 km, as published tables of the law round them
TABLE = [(10, 2, 0.46, 2.8), (20, 2, 0.74, 3.3), (20, 5, 1.35, 4.6), (30, 5, 1.79, 5.1)]


@pytest.mark.parametrize(("speed", "depth", "hs", "tp"), [*TABLE, (20, 10, 2.07, 6.0)])
def test_the_law_of_young_and_verhagen(speed, depth, hs, tp):
    """The quadrature is good to 1e-9 and cut at 1000 peaks, beyond which lie 2.5e-13 or less."""
    sea = TMA.from_wind(speed=speed, fetch=FETCH, depth=depth, growth="young-verhagen")
    exact = young_and_verhagen(speed, FETCH, depth)
    assert height(sea) == pytest.approx(exact[0], rel=1e-7)
    assert 2.0 * math.pi / sea.peak == pytest.approx(exact[1], rel=1e-12)
    assert (round(exact[0], 2), round(exact[1], 1)) == (hs, tp)


@pytest.mark.parametrize("growth", GROWTHS)
@pytest.mark.parametrize(("speed", "depth", "hs", "tp"), TABLE)
def test_the_bed_stops_every_law_alike(growth, speed, depth, hs, tp):
    """After 200 km over a bed so near, the fetch no longer matters."""
    sea = TMA.from_wind(speed=speed, fetch=FETCH, depth=depth, growth=growth)
    assert (round(height(sea), 2), round(2.0 * math.pi / sea.peak, 1)) == (hs, tp)


def test_ten_metres_under_twenty_metres_a_second_are_nearly_the_limit():
    """There the fetch still matters a little: the laws differ by 1.5 %."""
    for growth in GROWTHS:
        sea = TMA.from_wind(speed=20.0, fetch=FETCH, depth=10.0, growth=growth)
        assert height(sea) == pytest.approx(2.07, rel=0.02)
        assert 2.0 * math.pi / sea.peak == pytest.approx(6.01, rel=0.002)


@pytest.mark.parametrize("growth", GROWTHS)
@pytest.mark.parametrize(("speed", "fetch"), [(7.0, 35e3), (14.0, 200e3), (10.0, 1e6)])
def test_deep_water_is_the_limit_of_finite_depth(growth, speed, fetch):
    """tanh of a depth of 1000 m is 1 in double precision; B is recovered to some roundings."""
    deep = JONSWAP.from_wind(speed=speed, fetch=fetch, growth=growth)
    sea = TMA.from_wind(speed=speed, fetch=fetch, depth=1000.0, growth=growth)
    assert sea.peak == pytest.approx(deep.peak, rel=1e-12)
    assert height(sea) == pytest.approx(height(deep), rel=1e-7)
    assert TMA.from_wind(speed=speed, fetch=fetch, depth=math.inf, growth=growth).spectrum == deep


@pytest.mark.parametrize("growth", GROWTHS)
def test_a_sea_is_higher_and_longer_in_deeper_water(growth):
    seas = [
        TMA.from_wind(speed=15.0, fetch=100e3, depth=h, growth=growth)
        for h in np.geomspace(0.5, 200.0, 9)
    ]
    heights, peaks = [height(s) for s in seas], [s.peak for s in seas]
    assert heights == sorted(heights)
    assert peaks == sorted(peaks, reverse=True)


@pytest.mark.parametrize("x", [100.0, 1e3, 1e4])
def test_the_composite_of_kahma_and_calkoen(x):
    """e = 5.2e-7 x^0.9 and omega_p U/g = 13.7 x^-0.27, below the fully developed sea."""
    speed = 12.0
    sea = JONSWAP.from_wind(speed=speed, fetch=x * speed**2 / G, growth="kahma-calkoen")
    assert height(sea) == pytest.approx(4.0 * math.sqrt(5.2e-7 * x**0.9) * speed**2 / G, rel=1e-7)
    assert sea.peak * speed / G == pytest.approx(13.7 * x**-0.27, rel=1e-12)
    assert sea.gamma == 3.3


def test_no_law_passes_its_fully_developed_sea():
    """Kahma and Calkoen's has Pierson and Moskowitz's; e of Young and Verhagen's is 3.64e-3."""
    developed = height(PiersonMoskowitz.from_wind(speed=10.0))
    fetches = np.geomspace(2e3, 4e7, 30)
    for growth, limit in (
        ("kahma-calkoen", developed),
        ("young-verhagen", 4.0 * math.sqrt(3.64e-3) * 100.0 / G),
    ):
        seas = [JONSWAP.from_wind(speed=10.0, fetch=f, growth=growth) for f in fetches]
        heights = [height(s) for s in seas]
        assert heights == sorted(heights)
        assert 0.995 * limit < heights[-1] <= limit * (1.0 + 1e-9)
        assert [s.peak for s in seas] == sorted((s.peak for s in seas), reverse=True)
        assert seas[0].gamma > 2.5
        assert 1.0 <= seas[-1].gamma < 1.15


@pytest.mark.parametrize("gamma", [1.0, 3.3, 20.0])
@pytest.mark.parametrize("kappa", [1e-6, 1e-3, 0.1, 1.0, 30.0])
def test_the_integral_of_the_shape_in_finite_depth(gamma, kappa):
    """
    Against quadrature of a TMA whose omega_p^2 h/g is kappa; in 1e-6 the tail beyond 1000 peaks,
    where Phi is 0.5 instead of what the integral takes, is 1e-6 of the whole.
    """
    peak = 0.8
    sea = TMA(JONSWAP(peak=peak, alpha=0.01, gamma=gamma), depth=kappa * G / peak**2)
    m0 = (height(sea) / 4.0) ** 2
    expected = m0 * peak**4 / (0.01 * G**2)
    assert shape_integral_at(gamma, kappa) == pytest.approx(
        expected, rel=2e-6 if kappa < 1e-5 else 2e-8
    )


def test_peak_enhancement_follows_height_and_period():
    """The three branches of DNV-RP-C205, and what the constructors make of them."""
    assert peak_enhancement(4.0, 7.2) == 5.0
    assert peak_enhancement(4.0, 10.0) == 1.0
    assert peak_enhancement(0.0, 10.0) == 1.0
    assert peak_enhancement(4.0, 8.0) == pytest.approx(math.exp(5.75 - 1.15 * 4.0), rel=1e-14)
    for make in (JONSWAP.from_sea_state, lambda **k: TMA.from_sea_state(depth=50.0, **k).spectrum):
        assert make(hs=4.0, tp=8.0).gamma == peak_enhancement(4.0, 8.0)
        assert make(hs=4.0, tp=8.0, gamma=2.0).gamma == 2.0
    assert height(JONSWAP.from_sea_state(hs=4.0, tp=8.0)) == pytest.approx(4.0, rel=1e-8)


@pytest.mark.parametrize("make", [JONSWAP.from_wind, Sea.from_wind])
def test_an_unknown_law_is_refused_with_those_that_there_are(make):
    with pytest.raises(ParameterError, match="growth must be one of jonswap, kahma-calkoen, young"):
        make(speed=10.0, fetch=1e5, growth="verhagen")


def test_a_sea_of_the_wind_grows_by_the_law_named():
    for growth in GROWTHS:
        sea = Sea.from_wind(speed=14.0, fetch=FETCH, depth=12.0, growth=growth)
        same = TMA.from_wind(speed=14.0, fetch=FETCH, depth=12.0, growth=growth)
        assert sea.systems[0].spectrum == same
