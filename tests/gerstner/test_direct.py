"""
The slow truth itself: held to the single wave's closed form and to its own derivatives, in a voice
of its own.
"""

import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.gerstner.compiled import NAMES, eight_fields

G = 9.80665


@pytest.mark.parametrize("depth", [math.inf, 5.0, 0.3])
def test_one_wave(depth):
    """
    Lamb 1932, art. 229: orbits are ellipses with axes a and a coth(k h), run through clockwise as
    the wave goes by.
    """
    a, phase, m, size, t = 0.25, 0.8, (3, -2), (40.0, 30.0), 11.3
    ocean = fo.Ocean.from_modes(
        [(*m, a, phase)], n=(16, 12), size=size, depth=depth, choppiness=0.7
    )
    kx, ky = 2 * math.pi * m[0] / size[0], 2 * math.pi * m[1] / size[1]
    k = math.sqrt(kx * kx + ky * ky)
    omega = math.sqrt(G * k * math.tanh(k * depth))
    x, y = np.array([0.0, 3.3, -7.0]), np.array([[1.0], [-2.0]])
    s = fo.gerstner.surface(ocean, x, y, t)
    f = kx * x + ky * y - omega * t - phase
    b = a / math.tanh(k * depth)
    expected = {
        "height": a * np.cos(f),
        "displace_x": -b * kx / k * np.sin(f),
        "displace_y": -b * ky / k * np.sin(f),
        "slope_x": -a * kx * np.sin(f),
        "slope_y": -a * ky * np.sin(f),
        "stretch_xx": -b * kx * kx / k * np.cos(f),
        "stretch_xy": -b * kx * ky / k * np.cos(f),
        "stretch_yy": -b * ky * ky / k * np.cos(f),
        "velocity_x": b * omega * kx / k * np.cos(f),
        "velocity_y": b * omega * ky / k * np.cos(f),
        "velocity_z": a * omega * np.sin(f),
    }
    for name, value in expected.items():
        assert np.max(np.abs(getattr(s, name) - value)) < 1e-14 * max(1.0, b * k, b * omega)
    assert s.height.shape == (2, 3)
    assert np.allclose(s.x, x + 0.7 * expected["displace_x"], rtol=0, atol=1e-14)
    assert np.allclose(s.y, y + 0.7 * expected["displace_y"], rtol=0, atol=1e-14)
    assert np.array_equal(s.z, s.height)


def test_fields_are_each_other_s_derivatives():
    """
    Central differences over 1e-4 of the positions of many waves: relative error (k h)^2/6 < 1e-7 at
    k = 8 rad/m.
    """
    ocean = fo.Ocean(
        fo.Sea.from_wind(speed=8.0, fetch=50e3, depth=3.0, direction=200.0), n=20, size=30.0, seed=9
    )
    x, y, t, h = np.linspace(-5.0, 40.0, 7), np.linspace(3.0, 9.0, 7), 4.2, 1e-4

    def difference(name, dx=0.0, dy=0.0, dt=0.0):
        ahead, behind = (
            fo.gerstner.surface(ocean, x + s * dx, y + s * dy, t + s * dt) for s in (1, -1)
        )
        return (getattr(ahead, name) - getattr(behind, name)) / (2 * h)

    s = fo.gerstner.surface(ocean, x, y, t)
    for name, derivative in {
        "slope_x": difference("height", dx=h),
        "slope_y": difference("height", dy=h),
        "stretch_xx": difference("displace_x", dx=h),
        "stretch_xy": difference("displace_x", dy=h),
        "stretch_yy": difference("displace_y", dy=h),
        "velocity_x": difference("displace_x", dt=h),
        "velocity_y": difference("displace_y", dt=h),
        "velocity_z": difference("height", dt=h),
    }.items():
        assert np.max(np.abs(getattr(s, name) - derivative)) < 1e-6 * np.max(np.abs(derivative)), (
            name
        )
    assert np.max(np.abs(difference("displace_y", dx=h) - s.stretch_xy)) < 1e-6


def test_compiled_sum_equals_the_plain_one():
    """Same waves, other order of summing: 1e-13 of the field's largest value."""
    for depth in (math.inf, 4.0):
        ocean = fo.Ocean(
            fo.Sea.from_wind(speed=8.0, fetch=50e3, depth=depth), n=(12, 16), size=60.0, seed=2
        )
        x, y = np.meshgrid(np.linspace(0, 60, 9), np.linspace(-60, 0, 5))
        plain, compiled = fo.gerstner.surface(ocean, x, y, 8.0), eight_fields(ocean, x, y, 8.0)
        assert set(compiled) == set(NAMES)
        for name in NAMES:
            truth = getattr(plain, name)
            assert np.max(np.abs(compiled[name] - truth)) < 1e-13 * np.max(np.abs(truth))


def test_chunks_do_not_matter(monkeypatch):
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=50e3), n=12, size=60.0)
    x = np.linspace(0.0, 60.0, 37)
    whole = fo.gerstner.surface(ocean, x, 2 * x, 1.0)
    monkeypatch.setattr("fftocean.gerstner.direct._CHUNK", 300)
    parts = fo.gerstner.surface(ocean, x, 2 * x, 1.0)
    assert np.allclose(whole.height, parts.height, rtol=0, atol=1e-15 * 20)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_not_a_number_is_refused(bad):
    ocean = fo.Ocean.from_modes([(1, 0, 1.0, 0.0)], n=8, size=10.0)
    for arguments in ((bad, 0.0, 0.0), (0.0, [1.0, bad], 0.0), (0.0, 0.0, bad)):
        with pytest.raises(fo.ParameterError, match="finite"):
            fo.gerstner.surface(ocean, *arguments)


def test_a_sea_without_waves_is_flat():
    s = fo.gerstner.surface(fo.Ocean.from_modes([], n=8, size=10.0), [0.0, 1.0], 0.0, 5.0)
    assert not np.any(s.height)
    assert np.array_equal(s.normal, [[0.0, 0.0, 1.0]] * 2)
