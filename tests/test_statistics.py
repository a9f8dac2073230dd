"""Specified and realised statistics, each against an independent computation."""

import dataclasses
import json
import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.grid import Grid
from fftocean.statistics import (
    loop_error,
    outside_band,
    peak_wavelength,
    shortest_wavelength,
    specified,
)

SEA = fo.Sea.from_wind(speed=12.0, fetch=150e3, depth=30.0, direction=75.0)


def ocean(**arguments):
    return fo.Ocean(SEA, **{"n": 64, "size": 400.0, "seed": 5, "dtype": "float64", **arguments})


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("loop", [None, 40.0])
def test_realised_energy_is_that_of_the_waves(loop, dtype):
    """
    Forward FFT of height and its rate tells +k from -k: m0, direction and spread equal those of
    modes(), which it does not read.
    """
    o = ocean(loop=loop, dtype=dtype)
    s, m = fo.measure(o), o.modes()
    energy, theta = m.amplitude**2 / 2, np.arctan2(m.ky, m.kx)
    rel = 1e-6 if dtype == "float32" else 1e-12
    assert s.m0 == pytest.approx(np.sum(energy), rel=rel)
    assert s.hs == pytest.approx(4 * math.sqrt(np.sum(energy)), rel=rel)
    mean = np.sum(energy * np.exp(1j * theta)) / np.sum(energy)
    assert s.mean_direction == pytest.approx(
        math.degrees(np.angle(mean)), abs=1e-4 if dtype == "float32" else 1e-9
    )
    assert s.spread == pytest.approx(math.degrees(math.sqrt(2 - 2 * abs(mean))), rel=1e-5)


def test_statistics_of_one_wave():
    o = fo.Ocean.from_modes([(3, 4, 0.5, 1.0)], n=32, size=100.0, dtype="float64", depth=9.0)
    s = fo.measure(o)
    assert s.hs == pytest.approx(4 * math.sqrt(0.125), rel=1e-13)
    assert s.mean_direction == pytest.approx(math.degrees(math.atan2(4, 3)), abs=1e-10)
    assert s.spread == pytest.approx(0.0, abs=1e-4)  # sqrt(2 - 2) of roundings
    assert s.tp == pytest.approx(2 * math.pi / o.modes().omega[0], rel=1e-12)
    assert s.specified is None
    assert (s.sampling_error, s.snapshot_error, s.energy_below, s.energy_above) == (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def test_specified_values_are_those_of_from_sea_state():
    """
    Hs and direction are those given, Tp to the resolution of its curve; the spread of cos^2 follows
    from 1 - 8/(3 pi).
    """
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=3.0, tp=9.0),
            spreading=fo.CosineSquared(),
            direction=-130.0,
        )
    )
    state = specified(sea)
    assert state.hs == pytest.approx(3.0, abs=1e-9)
    assert state.tp == pytest.approx(9.0, rel=1e-5)
    assert state.mean_direction == pytest.approx(-130.0, abs=1e-6)
    assert state.spread == pytest.approx(
        math.degrees(math.sqrt(2.0 * (1.0 - 8.0 / (3.0 * math.pi)))), rel=1e-5
    )


@pytest.mark.parametrize("size", [30.0, 120.0, 2000.0])
def test_energy_outside_the_band_in_one_direction(size):
    """
    A narrow sea along x makes the band one-dimensional: the energy below dk/2 and above (n - 1)/2
    dk is a band moment of S.
    """
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=7.0), spreading=fo.CosinePower(s=1e6)
        )
    )
    below, above = outside_band(sea, Grid.of(32, size))
    low, high = (fo.dispersion.angular_frequency(2 * math.pi / size * m) for m in (0.5, 15.5))
    spectrum, m0 = sea.systems[0].spectrum, sea.variance
    assert below == pytest.approx(
        fo.moments.moment(spectrum, 0, 0.0, float(low)), abs=1e-3 * m0
    )  # trapezoids, and s = 1e6 is still 0.1 degrees wide
    assert above == pytest.approx(fo.moments.moment(spectrum, 0, float(high)), abs=1e-3 * m0)


@pytest.mark.parametrize("amplitudes", ["gaussian", "fixed"])
def test_expected_scatter_is_that_of_100_seeds(amplitudes):
    """
    Standard deviations over 100 seeds of m0 and of one frame's variance: chi-square estimates, good
    to 7 % each, four of them.
    """
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=6.0), spreading=fo.CosinePower(s=2.0)
        )
    )
    oceans = [
        fo.Ocean(sea, n=12, size=200.0, seed=seed, amplitudes=amplitudes, dtype="float64")
        for seed in range(100)
    ]
    s = fo.measure(oceans[0])
    m0 = [np.sum(o.modes().amplitude ** 2) / 2 for o in oceans]
    variance = [np.mean(o.frame(0.0, fields=("height",)).height ** 2) for o in oceans]
    assert np.std(m0) / s.resolved == pytest.approx(s.sampling_error, rel=0.28, abs=1e-12)
    assert np.std(variance) / s.resolved == pytest.approx(s.snapshot_error, rel=0.28)
    assert s.snapshot_error > 1e-3


def test_peak_period_of_a_large_tile():
    """Many waves round the peak: Young's estimator within 5 %, the width of its bins."""
    s = fo.measure(ocean(n=256, size=1500.0))
    assert s.specified is not None
    assert s.tp == pytest.approx(s.specified.tp, rel=0.05)
    assert s.mean_direction == pytest.approx(75.0, abs=3.0)
    assert s.spread == pytest.approx(s.specified.spread, rel=0.05)


def test_loop_error_of_a_given_frame():
    """Three waves: the energy-weighted rms and mean of (2 pi n / T) / omega - 1."""
    waves = [(1, 0, 1.0, 0.0), (4, 2, 0.5, 0.0), (0, -3, 0.7, 1.0)]
    o = fo.Ocean.from_modes(waves, n=16, size=200.0, loop=23.0)
    free = fo.Ocean.from_modes(waves, n=16, size=200.0).modes()
    relative = (
        np.maximum(1, np.rint(free.omega * 23.0 / (2 * np.pi))) * 2 * np.pi / 23.0 / free.omega - 1
    )
    energy = free.amplitude**2
    e = fo.measure(o).loop
    assert e is not None
    assert e.rms == pytest.approx(
        math.sqrt(np.sum(energy * relative**2) / np.sum(energy)), rel=1e-9
    )
    assert e.bias == pytest.approx(np.sum(energy * relative) / np.sum(energy), rel=1e-9)
    assert e.better_rms <= e.rms
    assert abs(e.better_period / 23.0 - 1) <= 0.1 + 1e-9
    better = fo.Ocean.from_modes(waves, n=16, size=200.0, loop=e.better_period)
    assert loop_error(better.amplitudes, e.better_period).rms == pytest.approx(
        e.better_rms, rel=1e-6
    )


@pytest.mark.parametrize("period", [1e-2, 1e9])
def test_the_shortest_and_the_longest_loop_have_an_error_too(period):
    """The better period is within the limits of loops."""
    e = fo.measure(fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=100.0, loop=period)).loop
    assert e is not None
    assert np.isfinite(e.rms)
    assert 1e-2 <= e.better_period <= 1e9


def test_statistics_of_a_flat_sea_are_zero():
    s = fo.measure(fo.Ocean(fo.Sea(), n=8, size=10.0, loop=5.0))
    assert (s.m0, s.hs, s.tp, s.mean_direction, s.spread) == (0.0,) * 5
    assert s.loop is not None
    assert (s.loop.rms, s.sampling_error) == (0.0, 0.0)


def test_folds_are_measured_over_the_loop():
    ocean = fo.Ocean(
        fo.Sea.from_wind(speed=12.0, fetch=100e3), n=32, size=80.0, loop=60.0, choppiness=2.5
    )
    assert fo.measure(ocean).folding == fo.folding(ocean.loop_frame(0, 1))
    several = fo.folding(ocean.loop_frames(6))
    assert fo.measure(ocean, frames=6).folding.min_jacobian == pytest.approx(
        several.min_jacobian, abs=1e-5
    )  # float32
    for wrong in (ocean.sea, ocean.frame(0.0), fo.Ocean, "sea"):
        with pytest.raises(fo.ParameterError, match="ocean must be an Ocean or a Cascade, got "):
            fo.measure(wrong)


def test_folds_of_a_cascade_are_those_of_its_sum():
    """
    Neither of two tiles folds, but their sum does: crests have steepnesses of 0.6 and 0.7.

    The share is that of cos f + 7/6 cos g > 1/0.6 over both phases, by quadrature; the smallest
    Jacobian is 1 - 1.3 within 2 %.
    """
    large = fo.Ocean.from_modes([(1, 0, 0.6 * 64.0 / (2 * np.pi), 0.0)], n=64, size=64.0)
    small = fo.Ocean.from_modes([(1, 0, 0.7 * 4.1 / (2 * np.pi), 0.0)], n=32, size=4.1)
    for ocean in (large, small):
        assert fo.measure(ocean).folding.share == 0.0
    cascade = fo.Cascade.__new__(fo.Cascade)
    cascade._set_up(None, 0, (large, small))
    found = fo.measure(cascade).folding
    f, g = np.meshgrid(*[(np.arange(1000) + 0.5) * (2 * np.pi / 1000)] * 2)
    assert found.share == pytest.approx(
        np.mean(0.6 * np.cos(f) + 0.7 * np.cos(g) > 1.0), abs=5e-3
    )  # 65536 points
    assert found.min_jacobian == pytest.approx(-0.3, abs=0.02)
    assert found.largest_choppiness == pytest.approx(1.0 / 1.3, rel=0.02)


def test_the_earlier_name_and_the_json_key_of_the_specified_sea_remain():
    """Manifests of all versions have the key "ordered" there, before "resolved"."""
    s = fo.measure(ocean(n=16))
    assert s.ordered is s.specified
    plain = json.loads(json.dumps(s.as_plain(), allow_nan=False))
    assert list(plain)[:7] == ["m0", "hs", "tp", "mean_direction", "spread", "ordered", "resolved"]
    assert plain["ordered"] == dataclasses.asdict(s.specified)
    assert plain["hs"] == s.hs
    assert "specified" not in plain


def test_plain_data_has_no_infinity():
    """Water that no choppiness folds has an infinite largest choppiness, and JSON has no number."""
    flat = fo.measure(fo.Ocean.from_modes([], n=8, size=50.0))
    assert flat.folding.largest_choppiness == math.inf
    assert flat.as_plain()["folding"]["largest_choppiness"] is None


def test_shares_and_scatter_follow_from_the_energies():
    s = fo.measure(ocean(n=8, size=30.0))
    # the specified m0 is a sum over panels, the sea's own is adaptive quadrature, to 1e-8
    assert s.share_below == pytest.approx(s.energy_below / SEA.variance, rel=1e-7)
    assert s.share_above == pytest.approx(s.energy_above / SEA.variance, rel=1e-7)
    assert 0.0 < s.share_below < 1.0
    # Hs goes as the square root of m0: half the relative deviation
    assert s.hs_scatter == pytest.approx(s.hs * s.sampling_error / 2.0, rel=1e-12)
    flat = fo.measure(fo.Ocean(fo.Sea(), n=8, size=10.0))
    assert (flat.share_below, flat.share_above, flat.hs_scatter) == (0.0, 0.0, 0.0)


def test_wavelengths_of_peak_and_samples():
    """Deep water: L = g Tp^2 / (2 pi). A grid's shortest wave has two of its wider samples."""
    sea = fo.Sea.from_wind(speed=12.0, fetch=150e3)
    o = fo.Ocean(sea, n=(16, 8), size=(100.0, 80.0))
    assert peak_wavelength(o) == pytest.approx(9.80665 * sea.tp**2 / (2.0 * math.pi), rel=1e-9)
    assert shortest_wavelength(o.grid) == 20.0
    assert peak_wavelength(fo.Ocean(fo.Sea(), n=8, size=10.0)) == 0.0
    assert peak_wavelength(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0)) == 0.0


def test_a_frame_of_opposite_systems_scatters_more():
    """
    Waves at +k and -k share a coefficient: of two equal systems that run against each other, the
    variance of a frame scatters sqrt(2) times as much as the energy of the waves does.
    """
    spectrum = fo.JONSWAP.from_sea_state(hs=1.0, tp=6.0)
    narrow = fo.CosinePower(s=60.0)
    one, other = (
        fo.WaveSystem(spectrum=spectrum, spreading=narrow, direction=d) for d in (20.0, 200.0)
    )
    both = fo.measure(fo.Ocean(fo.Sea(one, other), n=32, size=300.0))
    assert both.snapshot_error / both.sampling_error == pytest.approx(math.sqrt(2.0), rel=1e-6)
    alone = fo.measure(fo.Ocean(fo.Sea(one), n=32, size=300.0))
    assert alone.snapshot_error / alone.sampling_error == pytest.approx(1.0, rel=1e-2)


@pytest.mark.parametrize("gamma", [1.0, 3.3])
def test_peak_period_is_weighted_by_the_fourth_power(gamma):
    """2 pi int S^4 / int omega S^4 (Young 1995), to the bins of 6 %, within which S bends."""
    from fftocean.statistics import peak_period

    s = fo.JONSWAP(peak=0.8, gamma=gamma)
    omega = np.linspace(0.3, 8.0, 200_001)
    fourth = s(omega) ** 4
    expected = 2.0 * math.pi * np.sum(fourth) / np.sum(omega * fourth)
    square = 2.0 * math.pi * np.sum(s(omega) ** 2) / np.sum(omega * s(omega) ** 2)
    assert abs(square - expected) > 0.02 * expected
    assert peak_period(s(omega), omega) == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("omega", [0.3, 0.8, 2.5])
def test_peak_period_of_one_and_of_two_lines(omega):
    """
    All energy at one frequency: its period. Of two lines a third apart S^4 is 256 times higher in
    the higher, up to the widths of their bins, so that its period is found within 1 %.
    """
    from fftocean.statistics import peak_period

    one = np.array([1.0])
    assert peak_period(one, omega * one) == pytest.approx(2.0 * math.pi / omega, rel=1e-12)
    lines = omega * np.array([1.0, 4.0 / 3.0])
    assert peak_period(np.array([5.0, 1.0]), lines) == pytest.approx(
        2.0 * math.pi / omega, rel=0.01
    )


def test_share_of_the_skewness():
    from fftocean.statistics import Skewness

    assert Skewness(specified=0.2, resolved=0.15, expected=0.1, realised=0.3).share == 0.15 / 0.2
    assert Skewness(specified=None, resolved=0.15, expected=0.1, realised=0.3).share == 0.0
