"""Blending loss: the closed form on one wave, blended frames of a sea, and the sufficient rate."""

import json
import math

import numpy as np
import pytest

import fftocean as fo
from fftocean import blend_loss as blend

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")


def one_wave(m=(1, 0), size=1.0, loop=160.0):
    return fo.Ocean.from_modes([(*m, 0.01, 0.3)], n=8, size=size, loop=loop)


@pytest.mark.parametrize(("rate", "kept"), [(4.0, 0.56), (15.0, 0.97)])
def test_one_wave_of_a_metre(rate, kept):
    """
    cos(omega dt/2), omega = sqrt(2 pi g): 4 frames a second keep 56 % of it, 15 keep 97 %; all
    kinds of mean are of one wave.
    """
    b = blend.loss(one_wave(), round(160 * rate))
    omega = (
        round(160.0 * math.sqrt(2 * math.pi * 9.80665) / (2 * math.pi)) * 2 * math.pi / 160.0
    )  # a whole number of turns in the loop
    assert b.rate == pytest.approx(rate)
    assert (
        b.kept
        == b.kept_long
        == b.kept_slopes
        == pytest.approx(math.cos(0.5 * omega / rate), rel=1e-12)
    )
    assert round(b.kept, 2) == kept
    assert (
        b.enough_rate
        == b.enough_rate_slopes
        == pytest.approx(omega / (2.0 * math.acos(0.97)), rel=1e-9)
    )
    assert (
        b.enough_frames
        == b.enough_frames_slopes
        == math.ceil(160.0 * omega / (2.0 * math.acos(0.97)))
    )


def test_it_is_what_blended_frames_lose():
    """
    Frames of a sea, their mean in pairs, and the frame between: the ratio of their standard
    deviations over a loop, in float64.
    """
    ocean = fo.Ocean(
        fo.Sea.from_wind(speed=8.0, fetch=50e3), n=32, size=40.0, loop=16.0, seed=2, dtype="float64"
    )
    frames, b = 80, blend.loss(ocean, 80)
    for fields, kept in ((("height",), b.kept), (("slope_x", "slope_y"), b.kept_slopes)):
        energy = np.zeros(2)
        for j in range(frames):
            one, middle, two = (
                np.stack([f[name] for name in fields])
                for f in (ocean.loop_frame(2 * j + i, 2 * frames, fields) for i in range(3))
            )
            energy += np.mean((0.5 * (one + two)) ** 2), np.mean(middle**2)
        assert kept == pytest.approx(
            math.sqrt(energy[0] / energy[1]), rel=1e-9
        )  # all below half a turn a frame: an identity
    assert 0.5 < b.kept_slopes < b.kept < b.kept_long < 1.0


def test_a_wave_that_turns_by_half_a_period_a_frame_is_lost():
    """
    At dt = T/2 two frames cancel; at dt = T they agree, which is no merit: the wave stands still.
    """
    wave = one_wave()
    cycles = int(wave.amplitudes.cycles[0, 1])
    assert blend.loss(wave, 2 * cycles).kept == pytest.approx(0.0, abs=1e-12)
    assert blend.loss(wave, cycles).kept == pytest.approx(0.0, abs=1e-12)
    assert blend.loss(wave, 1).kept == pytest.approx(0.0, abs=1e-12)


def test_the_suggested_rates_are_enough_and_not_more():
    ocean = fo.Job.default().ocean()
    b = blend.loss(ocean, 64)
    assert b.kept_slopes < b.kept < blend.ENOUGH
    assert (
        blend.loss(ocean, b.enough_frames).kept
        >= blend.ENOUGH
        > blend.loss(ocean, b.enough_frames - 1).kept
    )
    assert (
        blend.loss(ocean, b.enough_frames_slopes).kept_slopes
        >= blend.ENOUGH
        > blend.loss(ocean, b.enough_frames_slopes - 1).kept_slopes
    )
    assert b.enough_frames == math.ceil(b.enough_rate * ocean.loop)
    assert blend.loss(ocean, 240).kept_slopes >= blend.ENOUGH  # the default job's


def test_the_mean_is_weighted_with_energy():
    """
    Two waves, one with three times the amplitude: nine parts of ten of the square are its own; the
    other is beyond twice the peak.
    """
    ocean = fo.Ocean.from_modes([(1, 0, 0.3, 0.0), (0, 5, 0.1, 1.0)], n=16, size=20.0, loop=64.0)
    slow, fast = sorted({float(w) for w in ocean.modes().omega})
    b = blend.loss(ocean, 640)
    assert b.kept == pytest.approx(
        math.sqrt(0.9 * math.cos(0.05 * slow) ** 2 + 0.1 * math.cos(0.05 * fast) ** 2), rel=1e-12
    )
    assert b.kept_long == pytest.approx(math.cos(0.05 * slow), rel=1e-12)


def test_waves_on_the_y_axis_count_once():
    """
    Along y the half plane holds +k and -k both: the same two waves, turned by 90 degrees, lose the
    same.
    """
    x, y = (
        fo.Ocean.from_modes(m, n=16, size=20.0, loop=64.0)
        for m in ([(1, 0, 0.3, 0.0), (5, 1, 0.2, 1.0)], [(0, 1, 0.3, 0.0), (-1, 5, 0.2, 1.0)])
    )
    assert blend.loss(x, 99).kept == pytest.approx(blend.loss(y, 99).kept, rel=1e-12)


def test_flat_water_loses_nothing():
    b = blend.loss(fo.Ocean.from_modes([], n=8, size=20.0, loop=8.0), 3)
    assert b.kept == b.kept_long == b.kept_slopes == 1.0
    assert b.enough_frames == b.enough_frames_slopes == 1
    assert b.enough_rate == b.enough_rate_slopes == 0.0


def test_what_is_told():
    ocean = fo.Job.default().ocean()
    few, some, many = (blend.loss(ocean, frames) for frames in (64, 80, 240))
    sentences = [blend.sentence(blend.describe(ocean, frames)) for frames in (64, 80, 240)]
    head = "blending frames at {:.3g} a second keeps {:.1f} % of the waves' height "
    head += "and {:.1f} % of their slopes"
    told = [head.format(b.rate, 100 * b.kept, 100 * b.kept_slopes) for b in (few, some, many)]
    slopes = f"{few.enough_frames_slopes} frames ({few.enough_rate_slopes:.3g} a second) "
    slopes += "keep 97 % of the slopes"
    assert (
        sentences[0] == f"{told[0]}; {few.enough_frames} frames keep 97 % of the height, {slopes}"
    )
    assert sentences[1] == f"{told[1]}; {slopes}"
    assert sentences[2] == told[2]
    plain = blend.describe(ocean, 64)
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["height"] == few.kept
    assert plain["enough"]["slopes"] == {
        "frames_per_second": few.enough_rate_slopes,
        "frames": few.enough_frames_slopes,
    }


def test_what_is_refused():
    with pytest.raises(fo.ParameterError, match="needs an ocean that loops"):
        blend.loss(fo.Ocean.from_modes([], n=8, size=20.0), 3)
    with pytest.raises(fo.ParameterError, match="frames must be a whole number"):
        blend.loss(one_wave(), 2.5)
