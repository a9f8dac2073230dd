"""
Few-wave models of the live page, against the models they are made of and the sea they stand for.
"""

import json
import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.errors import ParameterError
from fftocean.gerstner import SlideWaves, Waves
from fftocean.view.few_waves import MODELS, MOST_WAVES, few_waves, looped

SEA = fo.Sea.from_wind(speed=11.0, fetch=150e3, direction=30.0)
LOOP = 64.0
# a sum of at most 64 waves of phases up to 2e3 rad, each good to 2e3 x 1.1e-16
ROUNDING = 1e-10


def surface(columns, x, y, tick):
    """
    The surface of a page's document, written out again: x, y and z, and the two tangents.
    """
    turn = (np.array(columns["cycles"], dtype=object) * tick) % columns["ticks"]
    position, along, across = np.array([x, y, 0.0]), np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    for i, (kx, ky) in enumerate(zip(columns["kx"], columns["ky"], strict=True)):
        a, q = columns["amplitude"][i], columns["sharpness"][i]
        theta = kx * x + ky * y - columns["phase"][i]
        theta -= 2.0 * math.pi * float(turn[i]) / columns["ticks"]
        unit = np.array([kx, ky]) / math.hypot(kx, ky)
        moved = [*(-q * a * unit * math.sin(theta)), a * math.cos(theta)]
        slope = np.array([*(-q * a * unit * math.cos(theta)), -a * math.sin(theta)])
        position, along, across = position + moved, along + kx * slope, across + ky * slope
    return position, along, across


@pytest.mark.parametrize("number", [1, 2, 24, MOST_WAVES])
@pytest.mark.parametrize("model", MODELS)
def test_the_document_is_the_surface(model, number):
    """Position and normal of the JSON's columns are those of the direct sum."""
    few = few_waves(SEA, model, number=number, loop=LOOP, seed=3)
    columns = json.loads(json.dumps(few.document()))
    assert 1 <= len(columns["kx"]) <= number
    for x, y, tick in ((0.0, 0.0, 0), (31.5, -12.25, 1), (-700.0, 333.0, 2**19 - 1)):
        position, along, across = surface(columns, x, y, tick)
        right = few.at(x, y, tick)
        np.testing.assert_allclose(right.position, position, atol=ROUNDING)
        normal = np.cross(along, across)
        np.testing.assert_allclose(right.normal, normal / np.linalg.norm(normal), atol=ROUNDING)
        assert right.jacobian > 0.0 or model in ("slides", "steepness")


@pytest.mark.parametrize("model", MODELS)
def test_waves_have_the_variance_and_the_direction_of_the_sea(model):
    few = few_waves(SEA, model, number=40, loop=LOOP)
    assert few.waves.variance == pytest.approx(SEA.variance, rel=1e-5)
    energy = few.waves.amplitude**2
    mean = np.sum(energy * (few.waves.kx + 1j * few.waves.ky) / few.waves.wavenumber)
    if model in ("pms", "cwr"):
        assert math.degrees(np.angle(mean)) == pytest.approx(30.0, abs=1e-3)  # to the cells' width
    else:  # the directions are a sample of 40
        assert math.degrees(np.angle(mean)) == pytest.approx(30.0, abs=10.0)
    peak = few.waves.omega[np.argmax(few.waves.amplitude)]
    assert peak == pytest.approx(SEA.peak, rel=0.2)


def test_waves_of_a_spectrum_follow_it():
    """Variance below a frequency is the integral of S, to the width of a band."""
    few = few_waves(SEA, "slides", number=MOST_WAVES, loop=1e4)
    for share in (0.8, 1.0, 1.3, 2.0):
        below = few.waves.omega < share * SEA.peak
        part = 0.5 * np.sum(few.waves.amplitude[below] ** 2) / SEA.variance
        right = fo.moments.moment(SEA, 0, 0.0, share * SEA.peak) / SEA.variance
        assert part == pytest.approx(right, abs=0.06)  # a band at the peak has up to 5 %


def test_directions_follow_the_spreading():
    """A swell of 10 degrees and a wide wind sea keep their spreads."""
    for spread in (10.0, 40.0):
        system = fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0),
            spreading=fo.WrappedNormal(spread),
            direction=-100.0,
        )
        few = few_waves(fo.Sea(system), "slides", number=MOST_WAVES, loop=LOOP)
        heading = np.degrees(np.arctan2(few.waves.ky, few.waves.kx)) + 100.0
        heading = np.remainder(heading + 180.0, 360.0) - 180.0
        assert np.std(heading) == pytest.approx(spread, rel=0.15)


def test_frequencies_are_whole_cycles():
    few = few_waves(SEA, "pms", number=9, loop=LOOP, ticks=2**20)
    np.testing.assert_allclose(few.waves.omega * LOOP / (2.0 * math.pi), few.cycles, rtol=1e-14)
    assert np.array_equal(few.cycles, np.rint(few.cycles))
    assert few.cycles.min() >= 1
    x = np.array([0.0, 10.0, 250.0])
    assert np.array_equal(few.at(x, x, 5).height, few.at(x, x, 5 + 2**20).height)
    step = 2.0 * math.pi / LOOP
    deep = np.sqrt(fo.gerstner.PMS(period=1.0).gravity * few.waves.wavenumber)
    assert np.max(np.abs(few.waves.omega - deep)) <= 0.5 * step * (1.0 + 1e-9)


def test_the_place_is_far_from_where_all_crests_meet():
    """The crest at the origin of PMS is as high as all amplitudes together; here it is not."""
    few = few_waves(SEA, "pms", number=24, loop=LOOP, seed=1)
    assert few.at(0.0, 0.0, 0).height < 0.8 * np.sum(few.waves.amplitude)
    other = few_waves(SEA, "pms", number=24, loop=LOOP, seed=2)
    assert np.array_equal(few.waves.kx, other.waves.kx)
    assert not np.allclose(few.waves.phase, other.waves.phase)


def test_a_flat_sea_is_flat():
    few = few_waves(fo.Sea(), "cwr", number=8, loop=LOOP)
    assert few.at(3.0, 4.0, 77).height == 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"model": "fft"}, "model must be one of pms, cwr, slides, steepness, got 'fft'"),
        ({"number": 65}, "number must be"),
        ({"number": 0}, "number must be"),
        ({"ticks": 1000}, "ticks must be a power of two, got 1000"),
        ({"loop": math.nan}, "loop must be"),
        ({"seed": -1}, "seed must be"),
        ({"steepness": -0.1}, "steepness must be"),
        ({"loop": 1e5, "ticks": 2**20}, r"cycles in the loop times ticks must be below 2\^32"),
    ],
)
def test_bad_values_are_refused_with_the_rule(change, message):
    with pytest.raises(ParameterError, match=message):
        few_waves(SEA, **{"model": "pms", "number": 5, "loop": LOOP, **change})


def test_other_waves_are_refused():
    with pytest.raises(ParameterError, match="must be made of a Sea"):
        few_waves("sea", "pms", loop=LOOP)
    many = SlideWaves(A=[0.1] * 65, k=[0.1] * 65).waves
    with pytest.raises(ParameterError, match="at most 64, got 65"):
        looped("slides", many, LOOP, 2**19)
    start = fo.gerstner.CWR(period=5.0, amplitude=0.1, tau=2.0).waves
    with pytest.raises(ParameterError, match="no start, tau = 0, got 2"):
        looped("cwr", start, LOOP, 2**19)
    assert isinstance(few_waves(SEA, "cwr", number=2, loop=LOOP).waves, Waves)
