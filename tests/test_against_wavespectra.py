"""The wavespectra package as a witness: its JONSWAP and TMA are ours, point by point."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import fftocean as fo

frequency = pytest.importorskip(
    "wavespectra.construct.frequency", reason="wavespectra is not installed"
)

F = np.geomspace(0.03, 1.0, 80)  # [Hz]
G_RATIO = (9.80665 / frequency.g) ** 2  # it takes g = 9.81


@pytest.mark.parametrize(
    ("tp", "gamma", "alpha"), [(9.0, 3.3, 0.0081), (5.0, 1.0, 0.012), (14.0, 7.0, 0.004)]
)
def test_jonswap(tp, gamma, alpha):
    """
    S(omega) = E(f) / 2 pi; both are the same closed form: 1e-12 of each value that is not lost
    below 1e-200.
    """
    theirs = frequency.jonswap(F, 1.0 / tp, alpha=alpha, gamma=gamma).values * G_RATIO / (2 * np.pi)
    there = theirs > 1e-200
    assert np.count_nonzero(there) > 60
    assert (
        np.max(
            np.abs(
                fo.JONSWAP(2 * np.pi / tp, alpha, gamma)(2 * np.pi * F)[there] / theirs[there] - 1
            )
        )
        < 1e-12
    )


@pytest.mark.parametrize("depth", [5.0, 15.0, 60.0])
def test_tma(depth, monkeypatch):
    """
    Its wavenumber is a rational approximation, off by up to 0.1 %; with the root itself, found here
    by bisection, 1e-6 and better.
    """

    def exact(freq, dep):
        def root(f):
            omega2 = (2 * math.pi * f) ** 2
            return brentq(
                lambda k: 9.80665 * k * math.tanh(k * dep) - omega2,
                1e-9,
                1e3,
                xtol=1e-15,
                rtol=1e-14,
            )

        return freq.copy(data=[root(float(f)) for f in freq])

    ours = fo.TMA(fo.JONSWAP(2 * np.pi / 9.0), depth)(2 * np.pi * F)
    approximate = frequency.tma(F, 1.0 / 9.0, depth).values * G_RATIO / (2 * np.pi)
    assert np.max(np.abs(ours / approximate - 1)) < 5e-3
    monkeypatch.setattr(frequency, "wavenuma", exact)
    theirs = frequency.tma(F, 1.0 / 9.0, depth).values * G_RATIO / (2 * np.pi)
    assert np.max(np.abs(ours / theirs - 1)) < 1e-9
