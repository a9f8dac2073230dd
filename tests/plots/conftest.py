"""Oceans that the tests of the plots share."""

import pytest
from plotted import BRIEF, MEASURED, WAVES

import fftocean as fo


@pytest.fixture(scope="session")
def crossed():
    return fo.Ocean(BRIEF, n=64, size=600.0, seed=3, loop=60.0)


@pytest.fixture(scope="session")
def measured():
    return fo.Ocean(MEASURED, n=48, size=400.0, seed=5, amplitudes="fixed", dtype="float64")


@pytest.fixture(scope="session")
def given():
    return fo.Ocean.from_modes(
        WAVES, n=(32, 24), size=(90.0, 70.0), depth=4.0, loop=25.0, dtype="float64"
    )


@pytest.fixture(scope="session")
def flat():
    return fo.Ocean(fo.Sea(), n=16, size=50.0)
