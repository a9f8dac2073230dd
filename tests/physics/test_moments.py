"""Integral parameters of a spectrum, against closed forms."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.special import gamma

from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.physics.moments import (
    mean_direction_and_spread,
    mean_period,
    moment,
    peak_period,
    significant_wave_height,
    spectral_grid,
    zero_crossing_period,
)
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import (
    JONSWAP,
    TMA,
    CustomSpectrum,
    PiersonMoskowitz,
    TabulatedSpectrum,
)
from fftocean.physics.spreading import CosinePower, CosineSquared


def pierson_moskowitz_moment(s: PiersonMoskowitz, n: float) -> float:
    """
    m_n = alpha g^2 omega_p^(n-4)/4 (5/4)^(n/4-1) Gamma(1 - n/4): substitute u = 5/4
    (omega_p/omega)^4.
    """
    return (
        s.alpha
        * GRAVITY**2
        * s.peak ** (n - 4.0)
        / 4.0
        * 1.25 ** (n / 4.0 - 1.0)
        * float(gamma(1.0 - n / 4.0))
    )


@pytest.mark.parametrize("peak", [1e-6, 0.8, 1e6])
@pytest.mark.parametrize("n", [-5, -1, 0, 1, 2, 3, 3.9])
def test_moments_of_pierson_moskowitz(peak, n):
    """
    1e-11 is what the quadrature is asked for; with n = 3.9 the tail is omega^-1.1, and it still
    gets 1e-12.
    """
    s = PiersonMoskowitz(peak=peak)
    assert moment(s, n) == pytest.approx(pierson_moskowitz_moment(s, n), rel=1e-11)


@pytest.mark.parametrize("n", [4, 5, 40, 1000])
def test_moments_that_do_not_exist(n):
    """
    omega^n omega^-5 falls too slowly from n = 4 on; a table ends, and has them all (until 2^n
    leaves the doubles).
    """
    assert moment(PiersonMoskowitz(peak=0.8), n) == math.inf
    assert moment(JONSWAP(peak=0.8), n) == math.inf
    assert moment(TMA(JONSWAP(peak=0.8), 10.0), n) == math.inf
    assert moment(PiersonMoskowitz(peak=0.8, alpha=0.0), n) == 0.0
    assert math.isfinite(moment(TabulatedSpectrum([0.1, 0.2], [1.0, 0.0]), n))


def test_moment_of_an_omega_to_the_minus_4_tail():
    """
    S = omega/(1 + omega^2)^(5/2) has m0 = 1/3 and m2 = 2/3; its m3 grows as a logarithm, so it does
    not exist either.
    """
    s = CustomSpectrum(lambda w: w * (1.0 + w**2) ** -2.5, peak=0.5)
    assert moment(s, 0) == pytest.approx(1.0 / 3.0, rel=1e-11)
    assert moment(s, 2) == pytest.approx(2.0 / 3.0, rel=1e-11)
    assert moment(s, 3) == math.inf


@pytest.mark.parametrize(
    "s", [PiersonMoskowitz(peak=0.8), JONSWAP(peak=0.8, gamma=7.0)], ids=["pm", "jonswap"]
)
def test_bands_add_up_to_the_whole(s):
    edges = [0.0, 0.01, 0.5, 0.8, 0.81, 3.0, 1e4, 1e9, math.inf]
    bands = [moment(s, 1, a, b) for a, b in pairwise(edges)]
    assert sum(bands) == pytest.approx(moment(s, 1), rel=1e-11)
    assert bands[0] == 0.0  # e^-5e7
    assert all(b > 0.0 for b in bands[1:])


@pytest.mark.parametrize("high", [0.4, 0.8, 1.0, 50.0, 1e8, 1e12, 1e100])
def test_band_of_pierson_moskowitz(high):
    """
    The part of m0 below `high` is exp(-5/4 (omega_p/high)^4): however wide the band is, the little
    of it that holds anything is found.
    """
    s = PiersonMoskowitz(peak=0.8)
    m0, u = pierson_moskowitz_moment(s, 0), 1.25 * (0.8 / high) ** 4
    assert moment(s, 0, 0.0, high) == pytest.approx(m0 * math.exp(-u), rel=1e-11)
    assert moment(s, 0, 1e-12, high) == pytest.approx(m0 * math.exp(-u), rel=1e-11)
    assert moment(s, 0, high) == pytest.approx(-m0 * math.expm1(-u), rel=1e-11, abs=1e-300)


def test_empty_bands():
    s = PiersonMoskowitz(peak=0.8)
    assert (
        moment(s, 0, 1.0, 1.0) == moment(s, 0, 0.0, 0.0) == moment(s, 0, math.inf, math.inf) == 0.0
    )


@pytest.mark.parametrize("band", [(-1.0, 1.0), (2.0, 1.0), (math.nan, 1.0), (0.0, math.nan)])
def test_what_is_no_band_is_refused(band):
    with pytest.raises(ParameterError, match="a band must have 0 <= low <= high, got "):
        moment(PiersonMoskowitz(peak=0.8), 0, *band)


@pytest.mark.parametrize("ratio", [1.01, 3.0, 300.0, 1e5])
def test_two_systems_far_apart(ratio):
    """
    m0 of the sum is the sum of the m0: the quadrature must not overlook one peak for the other,
    however small or far.
    """
    wind_sea = PiersonMoskowitz.from_sea_state(hs=5e-9, tp=1e-2)
    swell = JONSWAP.from_sea_state(hs=3e-10 * ratio, tp=1e-2 * ratio, gamma=20.0)
    sea = Sea(WaveSystem(spectrum=swell), WaveSystem(spectrum=wind_sea))
    assert moment(sea, 0) == pytest.approx(((5e-9) ** 2 + (3e-10 * ratio) ** 2) / 16.0, rel=1e-10)


def test_narrow_swell_without_corners():
    """A Gaussian 0.1 % wide is found from its peak alone: m0 = 1, m1 = peak."""
    s = CustomSpectrum(
        lambda w: np.exp(-0.5 * ((w - 0.5) / 5e-4) ** 2) / (5e-4 * math.sqrt(2.0 * math.pi)),
        peak=0.5,
    )
    assert moment(s, 0) == pytest.approx(1.0, rel=1e-10)
    assert moment(s, 1) == pytest.approx(0.5, rel=1e-10)


def test_moments_of_a_table():
    """A triangle from a to c with its top at b: m1/m0 is the centroid, (a + b + c)/3."""
    f = np.array([0.1, 0.15, 0.3])
    s = TabulatedSpectrum(f, [0.0, 4.0, 0.0])
    assert moment(s, 0) == pytest.approx(0.5 * 0.2 * 4.0, rel=1e-14)
    assert moment(s, 1) / moment(s, 0) == pytest.approx(2.0 * math.pi * np.mean(f), rel=1e-14)


def test_a_comb_is_too_rough():
    """
    A spectrum that flickers faster than the quadrature looks is refused, not guessed at, and at
    once.
    """
    s = CustomSpectrum(
        lambda w: np.where(np.floor(w * 12345.678) % 2.0 == 0.0, 1.0, 0.0) * (w < 2.0), peak=1.0
    )
    with pytest.raises(
        ParameterError,
        match=r"the spectrum is too rough to integrate: a part of the moment came out as "
        r"0\.\d* \+- ",
    ):
        moment(s, 0)


def test_heights_and_periods_of_pierson_moskowitz():
    """
    Hs = 4 sqrt(m0); Tm01 = 2 pi m0/m1; Tz = 2 pi sqrt(m0/m2); Tp = 2 pi/omega_p: ratios known from
    the closed moments.
    """
    s = PiersonMoskowitz.from_sea_state(hs=3.0, tp=9.0)
    assert significant_wave_height(s) == pytest.approx(3.0, rel=1e-11)
    assert peak_period(s) == pytest.approx(9.0, rel=1e-15)  # the peak itself is looked at
    m0, m1, m2 = (pierson_moskowitz_moment(s, n) for n in (0, 1, 2))
    assert mean_period(s) == pytest.approx(2.0 * math.pi * m0 / m1, rel=1e-11)
    assert zero_crossing_period(s) == pytest.approx(2.0 * math.pi * math.sqrt(m0 / m2), rel=1e-11)
    assert zero_crossing_period(s) / 9.0 == pytest.approx(
        0.7104, abs=5e-5
    )  # (5 pi/4 ... )^(-1/4): the well-known 0.71
    assert mean_period(s) / 9.0 == pytest.approx(0.7718, abs=5e-5)  # and 0.77


def test_flat_sea_has_no_period():
    flat = PiersonMoskowitz(peak=0.8, alpha=0.0)
    for sea in (flat, Sea()):
        assert (
            significant_wave_height(sea)
            == mean_period(sea)
            == zero_crossing_period(sea)
            == peak_period(sea)
            == 0.0
        )


def test_peak_period_is_that_of_the_curve():
    """
    In shallow water S = S_deep q/2 there: with Pierson-Moskowitz omega^-3 exp(-5/4 x^-4) is highest
    at x = (5/3)^(1/4).
    """
    s = TMA(PiersonMoskowitz(peak=0.8), depth=1e-3)
    assert peak_period(s) == pytest.approx(
        2.0 * math.pi / (0.8 * (5.0 / 3.0) ** 0.25), rel=1e-5
    )  # Phi's own curvature: q/3 = 3e-5
    assert peak_period(TabulatedSpectrum([0.1, 0.123, 0.3], [0.0, 4.0, 0.0])) == pytest.approx(
        1.0 / 0.123, rel=1e-12
    )


@pytest.mark.parametrize("degrees", [-179.0, -90.0, 0.0, 30.0, 135.0, 180.0])
@pytest.mark.parametrize("s", [1.0, 10.0, 60.0])
def test_mean_direction_and_spread_of_cosine_power(s, degrees):
    """
    The first circular moment of cos^2s is s/(s + 1), so its spread is sqrt(2/(s + 1)); 720 equal
    steps integrate a trigonometric polynomial of that degree exactly.
    """
    theta = np.linspace(-math.pi, math.pi, 720, endpoint=False)
    energy = 3.0 * CosinePower(s=s)(1.0, theta - math.radians(degrees), 1.0)
    direction, spread = mean_direction_and_spread(energy, theta)
    assert (direction - degrees + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-10)
    assert -180.0 < direction <= 180.0
    assert spread == pytest.approx(math.degrees(math.sqrt(2.0 / (s + 1.0))), rel=1e-12)


def test_mean_direction_and_spread_of_cosine_squared():
    """
    First moment 8/(3 pi). The midpoint rule, h = 1e-3, is off by h^2/24 of the slopes' difference,
    0 here as cos^3 ends flat, so h^4.
    """
    theta = (np.arange(-1571, 1571) + 0.5) * (math.pi / 3142.0)
    _, spread = mean_direction_and_spread(CosineSquared()(1.0, theta, 1.0), theta)
    assert spread == pytest.approx(
        math.degrees(math.sqrt(2.0 * (1.0 - 8.0 / (3.0 * math.pi)))), rel=1e-10
    )


def test_mean_direction_of_single_waves():
    assert mean_direction_and_spread(np.ones(1), np.array([math.pi])) == (180.0, 0.0)
    assert mean_direction_and_spread(np.ones(1), np.array([-math.pi])) == (
        180.0,
        0.0,
    )  # in (-180, 180]
    direction, spread = mean_direction_and_spread(
        np.array([1.0, 1.0]), np.array([0.0, math.pi / 2.0])
    )
    assert direction == pytest.approx(45.0, rel=1e-15)
    assert spread == pytest.approx(math.degrees(math.sqrt(2.0 - math.sqrt(2.0))), rel=1e-14)
    assert mean_direction_and_spread(np.zeros(3), np.zeros(3)) == (0.0, 0.0)
    assert mean_direction_and_spread(np.zeros(0), np.zeros(0)) == (0.0, 0.0)
    _, spread = mean_direction_and_spread(
        np.ones((2, 2)), np.array([[0.0, 0.5], [1.0, 1.5]]) * math.pi
    )
    assert spread == pytest.approx(math.degrees(math.sqrt(2.0)), rel=1e-12)  # all round


def test_spectral_grid_sees_every_peak_and_corner():
    grid = spectral_grid([0.5, 2.0], [0.77, 1.3])
    assert np.all(np.diff(grid) > 0.0)
    assert grid[0] == pytest.approx(0.05, rel=1e-14)
    assert grid[-1] == pytest.approx(60.0, rel=1e-14)
    assert {0.77, 1.3} <= set(grid.tolist())
    for peak in (0.5, 2.0):
        near = grid[(grid > 0.7 * peak) & (grid < 1.6 * peak)]
        assert np.max(np.diff(np.log(near))) < 0.003  # a 25th of JONSWAP's sigma
    assert spectral_grid([]).size > 1
