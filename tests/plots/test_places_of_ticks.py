"""Periods stand at their frequencies, and the band that is drawn holds the energy."""

import math

import numpy as np
import pytest
from plotted import BRIEF, CROSSED, SWELL

import fftocean as fo
from fftocean import plots
from fftocean.plots.ranges import energetic_band


@pytest.mark.parametrize("sea", [CROSSED, BRIEF, fo.Sea(SWELL)])
def test_the_band_holds_all_but_the_faintest(sea):
    low, high = energetic_band(sea)
    for system in sea.systems:
        omega = np.geomspace(0.02, 50.0, 20000) * system.spectrum.peak
        s = system.spectrum(omega)
        seen = omega[s > 1e-2 * np.max(s)]
        assert low < seen[0]
        assert high > seen[-1]


def test_periods_stand_at_their_frequencies():
    import matplotlib.pyplot as plt

    figure = plots.plot_spectrum(CROSSED)
    figure.canvas.draw()
    axes = [a for ax in figure.axes for a in (ax, *ax.child_axes)]
    (top,) = [a for a in axes if a.get_xlabel() == "period [s]"]
    labels = [t.get_text() for t in top.get_xticklabels()]
    assert len(labels) >= 3
    assert top.get_xticks() == pytest.approx([2.0 * math.pi / float(t) for t in labels], rel=1e-12)
    plt.close(figure)
