"""Panels of frequency and direction: sums of Gauss points over them against closed forms."""

import itertools
import math

import numpy as np
import pytest

from fftocean.constants import GRAVITY
from fftocean.physics.panels import (
    direction_panels,
    energetic_frequencies,
    frequency_panels,
    gauss,
    parts_of,
    split,
)
from fftocean.physics.sea import WaveSystem
from fftocean.physics.spectra import JONSWAP, CustomSpectrum, PiersonMoskowitz, TabulatedSpectrum
from fftocean.physics.spreading import (
    Blend,
    CosinePower,
    CosineSquared,
    DonelanBanner,
    LongCrested,
)

RNG = np.random.default_rng(23)


def integral(function, edges):
    points, weights = gauss(edges[:-1], edges[1:])
    return float(np.sum(function(points) * weights))


@pytest.mark.parametrize("order", [1, 4, 8])
def test_gauss_points_integrate_polynomials(order):
    """Exact up to degree 2 order - 1, and not beyond; round-off of at most eight terms."""
    low, high = np.array([-1.0, 0.5, 3.0]), np.array([0.5, 3.0, 3.25])
    points, weights = gauss(low, high, order)
    assert points.shape == weights.shape == (3, order)
    assert np.all((low[:, None] < points) & (points < high[:, None]))
    for n in range(2 * order):
        exact = (high ** (n + 1) - low ** (n + 1)) / (n + 1)
        assert np.sum(points**n * weights, axis=1) == pytest.approx(exact, rel=1e-13, abs=1e-13)
    if order == 1:
        assert np.sum(points**2 * weights, axis=1)[0] != pytest.approx((0.125 + 1) / 3, rel=0.1)


def test_intervals_are_cut_at_edges():
    """Against a loop over intervals and edges; an edge at an end of an interval cuts nothing."""
    edges = np.array([0.0, 1.0, 2.0, 2.5, 4.0])
    low = np.array([0.0, 0.5, -1.0, 2.0, 4.5, 1.0, *RNG.uniform(-1.0, 3.0, 20)])
    high = low + np.array([1.0, 3.0, 9.0, 0.5, 1.0, 1.0, *RNG.uniform(0.0, 3.0, 20)])
    expected = []
    for i, (a, b) in enumerate(zip(low, high, strict=True)):
        cuts = [a, *(e for e in edges if a < e < b), b]
        expected += [(i, c, d) for c, d in itertools.pairwise(cuts)]
    found = list(zip(*split(low, high, edges), strict=True))
    assert found == expected


@pytest.mark.parametrize("peak", [1e-3, 0.8, 200.0])
@pytest.mark.parametrize("power", [0, 1, 2])
def test_moments_over_frequency_panels(peak, power):
    """
    m_n of Pierson & Moskowitz in closed form (substitute u = 5/4 (omega_p/omega)^4). Panels are
    bisected until their last two coefficients are 1e-6 of the integral: the sum is far closer.
    """
    s = PiersonMoskowitz(peak=peak)
    edges = frequency_panels(WaveSystem(spectrum=s)).edges
    exact = (
        s.alpha * GRAVITY**2 / 4.0 * peak ** (power - 4.0) * 1.25 ** (power / 4.0 - 1.0)
    ) * math.gamma(1.0 - power / 4.0)
    assert edges[0] == 0.0
    assert edges[-1] > 1e11 * peak
    assert np.all(np.diff(edges) > 0.0)
    assert integral(lambda w: w**power * s(w), edges) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("at", np.geomspace(0.02, 7.7, 25))
def test_a_narrow_swell_beside_the_peak_is_found(at):
    """
    Nothing names it: octaves from 1/64 of the peak to eight of it put points so near that a bell of
    3 % of its own frequency is seen by at least one, and then bisected.
    """
    wind_sea = PiersonMoskowitz.from_sea_state(hs=2.0, tp=2.0 * math.pi)
    width, energy = 0.03 * at, 0.02

    def density(omega):
        bell = np.exp(-0.5 * ((omega - at) / width) ** 2) / (width * math.sqrt(2.0 * math.pi))
        return wind_sea(omega) + energy * bell

    system = WaveSystem(spectrum=CustomSpectrum(density, peak=1.0))
    edges = frequency_panels(system).edges
    assert integral(density, edges) == pytest.approx((2.0 / 4.0) ** 2 + energy, rel=1e-5)


def test_frequency_panels_end_at_breaks_and_tell_jumps():
    """Of a table, kinks are edges; where a model ends all at once it jumps."""
    table = TabulatedSpectrum([0.1, 0.15, 0.3], [0.0, 4.0, 2.0])
    panels = frequency_panels(WaveSystem(spectrum=table))
    corners = 2.0 * math.pi * np.array([0.1, 0.15, 0.3])
    assert all(np.min(np.abs(panels.edges - c)) <= 1e-12 * c for c in corners)
    assert panels.jumps == pytest.approx(corners[-1:], rel=1e-12)
    smooth = frequency_panels(WaveSystem(spectrum=JONSWAP(peak=0.8)))
    assert smooth.jumps.size == 0  # the width changes at the peak, the density does not


def test_energetic_frequencies_are_the_peak_and_where_the_energy_is():
    """
    A share exp(-5/4 (omega_p/omega)^4) of the variance of Pierson & Moskowitz lies below omega.
    """
    s = PiersonMoskowitz(peak=0.8)
    edges = frequency_panels(WaveSystem(spectrum=s)).edges
    omega, energy = energetic_frequencies(WaveSystem(spectrum=s), edges)
    assert omega[0] == 0.8
    assert 17 <= omega.size <= 33  # the peak, and every (n // 16)-th of n
    below = np.exp(-1.25 * (0.8 / omega[1:]) ** 4)
    assert np.all(np.diff(below) > 0.0)
    assert below[0] < 0.01
    assert 0.5 < below[-1] < 1.0 - 1e-6  # none where there is next to nothing
    assert energy.shape == (edges.size - 1,)
    share = np.sum(energy[edges[1:] <= 0.8]) / np.sum(energy)
    assert share == pytest.approx(math.exp(-1.25), rel=1e-6)


@pytest.mark.parametrize("s", [1.0, 30.0, 1000.0, 30000.0])
def test_directions_of_a_narrow_spreading(s):
    """
    cos^2s(theta/2) integrates to one, and its first moment is s/(s + 1) (Longuet-Higgins et al.
    1963).
    """
    model, omega = CosinePower(s), np.array([0.7, 0.8, 1.5])
    edges = direction_panels(WaveSystem(spectrum=JONSWAP(peak=0.8), spreading=model), omega).edges
    assert edges[0] == -math.pi
    assert edges[-1] == math.pi
    assert integral(lambda a: model(0.8, a, 0.8), edges) == pytest.approx(1.0, rel=1e-6)
    first = integral(lambda a: np.cos(a) * model(0.8, a, 0.8), edges)
    assert first == pytest.approx(s / (s + 1.0), rel=1e-6)


def test_directions_at_which_a_spreading_has_corners():
    """cos^2 ends at right angles; a box of one radian jumps at its sides, which it names."""
    omega, sea = np.array([0.8]), JONSWAP(peak=0.8)
    half = direction_panels(WaveSystem(spectrum=sea, spreading=CosineSquared()), omega)
    assert np.min(np.abs(half.edges - 0.5 * math.pi)) < 1e-12
    assert half.jumps.size == 0

    class Box:
        breaks = (-0.3, 0.7)

        def __call__(self, omega, theta, _peak, /):
            _, theta = np.broadcast_arrays(omega, theta)
            return np.where((theta > -0.3) & (theta < 0.7), 1.0, 0.0)

    box = direction_panels(WaveSystem(spectrum=sea, spreading=Box()), omega)
    assert box.jumps == pytest.approx([-0.3, 0.7], abs=1e-12)
    theta = box.edges
    inside = (theta[:-1] >= -0.3 - 1e-12) & (theta[1:] <= 0.7 + 1e-12)
    assert np.sum(np.diff(theta)[inside]) == pytest.approx(1.0, abs=1e-11)


def test_a_blend_with_one_direction_is_taken_apart():
    """Shares multiply down the blends, and add up to one; a smooth blend stays whole."""
    inner = Blend(LongCrested(), CosineSquared(), weight=0.25)
    system = WaveSystem(
        spectrum=JONSWAP(peak=0.8), spreading=Blend(DonelanBanner(), inner, weight=0.6)
    )
    parts = [(share, type(part.spreading)) for share, part in parts_of(system)]
    assert parts == [
        (pytest.approx(0.4), DonelanBanner),
        (pytest.approx(0.6 * 0.75), LongCrested),
        (pytest.approx(0.6 * 0.25), CosineSquared),
    ]
    smooth = WaveSystem(spectrum=JONSWAP(peak=0.8), spreading=Blend())
    assert parts_of(smooth) == [(1.0, smooth)]
    alone = WaveSystem(
        spectrum=JONSWAP(peak=0.8), spreading=Blend(CosineSquared(), LongCrested(), weight=1.0)
    )
    assert [(a, type(p.spreading)) for a, p in parts_of(alone)] == [(1.0, LongCrested)]
