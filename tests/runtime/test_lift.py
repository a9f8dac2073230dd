"""Lift of d displace_x/dy to the size of the height, in the tiles of a package."""

import numpy as np
import pytest

import fftocean as fo
from fftocean.runtime import pack


@pytest.mark.parametrize("wind", [5.0, 20.0])
def test_lifted_stretch_is_as_large_as_the_height(wind):
    """
    The lift is a power of two, so the ratio of the fields is within sqrt(2) of 1 in the mean over
    time; a factor of 1.5 more covers one moment of a few waves.
    """
    sea = fo.Sea.from_wind(speed=wind, fetch=150e3, direction=30.0)
    cascade = fo.Cascade(sea, tiles=[(64, 1360.0), (64, 120.0), (64, 10.6)], seed=7, loop=64.0)
    document = pack(cascade, reference=False).document
    for ocean, tile in zip(cascade.oceans, document["tiles"], strict=True):
        frame = ocean.frame(3.0)
        lifted = tile["mixed"] * np.sqrt(np.mean(frame.stretch_xy**2))
        ratio = lifted / np.sqrt(np.mean(frame.height**2))
        assert np.log2(tile["mixed"]) % 1.0 == 0.0
        assert 0.45 < ratio < 2.2


def test_waves_along_an_axis_need_no_lift():
    """Waves along x have no d displace_x/dy at all."""
    ocean = fo.Ocean.from_modes([(3, 0, 1.0, 0.0)], n=16, size=50.0, loop=16.0)
    assert pack(ocean, reference=False).document["tiles"][0]["mixed"] == 1.0
