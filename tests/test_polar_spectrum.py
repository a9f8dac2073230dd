"""The directional spectrum in cells against the integral of the frequency spectrum."""

import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.polar_spectrum import polar_spectrum


@pytest.mark.parametrize(
    "spreading",
    [
        fo.LongCrested(),
        fo.CosinePower(s=1e6),
        fo.CustomSpreading(
            lambda _, t, __: np.exp(-0.5 * ((t - 1.101) / 2e-3) ** 2), breaks=[1.101]
        ),
    ],
    ids=["long-crested", "1e6", "beside"],
)
def test_narrow_seas_keep_their_energy(spreading):
    """
    Its cells add up to the integral of S, whatever the direction: midpoints in frequency, 1e-3.
    """
    spectrum = fo.JONSWAP.from_sea_state(hs=2.0, tp=8.0)
    sea = fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=10.07))
    frequency, theta, density = polar_spectrum(sea, 0.5)
    total = np.sum(density) * (frequency[1] - frequency[0]) * math.degrees(theta[1] - theta[0])
    assert total == pytest.approx(fo.moments.moment(spectrum, 0, 0.0, np.pi), rel=1e-3)


@pytest.mark.parametrize("direction", [10.0, 100.0, 190.0, 350.0])
@pytest.mark.parametrize("spreading", [fo.LongCrested(), fo.CosinePower(s=1e6)])
def test_energy_lies_in_the_direction_of_the_sea(direction, spreading):
    """The mean direction of the cells is the sea's to half a cell of 1.5 degrees."""
    spectrum = fo.JONSWAP.from_sea_state(hs=2.0, tp=8.0)
    sea = fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction))
    _, theta, density = polar_spectrum(sea, 0.5)
    middle = 0.5 * (theta[1:] + theta[:-1])
    mean = np.degrees(np.angle(np.sum(density @ np.exp(1j * middle)))) % 360.0
    assert mean == pytest.approx(direction, abs=0.75)
