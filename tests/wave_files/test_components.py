"""The table of waves, summed again by its own formula."""

import csv

import numpy as np
import pytest

import fftocean as fo


def test_the_table_is_the_sea(tmp_path):
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
    source = fo.Cascade(sea, [(16, 200.0), (16, 37.0)], seed=3)
    fo.export.components(source, tmp_path / "waves.csv")
    with (tmp_path / "waves.csv").open() as file:
        rows = list(csv.DictReader(file))
    f, direction, a, phase, kx, ky = np.array([[float(v) for v in row.values()] for row in rows]).T
    assert list(rows[0])[:4] == ["frequency_Hz", "direction_degrees", "amplitude_m", "phase_rad"]
    assert np.all(np.diff(a) <= 0.0)
    assert np.all((direction >= 0.0) & (direction < 360.0))
    assert np.allclose(np.hypot(kx, ky) * np.exp(1j * np.deg2rad(direction)), kx + 1j * ky)
    x, y, t = 12.3, -45.6, 7.8
    height = np.sum(a * np.cos(kx * x + ky * y - 2.0 * np.pi * f * t - phase))
    assert height == pytest.approx(float(fo.kinematics.at(source, x, y, 0.0, t).heights), abs=1e-12)


def test_waves_that_start_from_rest_are_refused(tmp_path):
    model = fo.gerstner.CWR(period=5.0, amplitude=0.3, tau=2.0)
    with pytest.raises(fo.ParameterError, match="start from rest"):
        fo.export.components(model, tmp_path / "waves.csv")
