"""SWD files read back by a reader of their own, against `fo.kinematics`; what is refused."""

import math
from contextlib import nullcontext

import numpy as np
import pytest
from swd_reader import read, water

import fftocean as fo
from fftocean.constants import WATER_DENSITY


def ocean(depth=math.inf, **arguments):
    sea = fo.Sea.from_wind(speed=12.0, fetch=200e3, direction=35.0, depth=depth)
    return fo.Ocean(
        sea, **{"n": (32, 16), "size": (300.0, 240.0), "seed": 2, "dtype": "float64", **arguments}
    )


def points(times):
    rng = np.random.default_rng(5)
    x, y = rng.uniform(-500.0, 500.0, (2, 12))
    return np.column_stack([x, y, -rng.uniform(0.0, 10.0, 12), rng.choice(times, 12)])


def require_equal(path, source, where, tolerance):
    found = [water(path, *point) for point in where]
    below = fo.kinematics.at(source, *where.T)
    for i, values in enumerate((below.heights, below.velocities, below.accelerations)):
        error = np.abs(np.array([w[i] for w in found]) - values)
        assert np.max(error) < tolerance * np.max(np.abs(values))
    pressure = -WATER_DENSITY * np.array([w[3] for w in found])
    assert np.max(np.abs(pressure - below.pressures)) < tolerance * np.max(np.abs(below.pressures))


@pytest.mark.parametrize("depth", [math.inf, 12.0])
def test_a_list_of_waves_is_the_sea_at_any_time(tmp_path, depth):
    """
    Float32 amplitudes, wavenumbers and phases: omega t and k.x up to a few hundred radians are
    rounded by 6e-8 of themselves.
    """
    source = ocean(depth)
    path = tmp_path / "sea.swd"
    fo.export.swd(source, path)
    require_equal(path, source, points([0.0, 3.7, 61.3]), 2e-5)


@pytest.mark.parametrize("depth", [math.inf, 12.0])
@pytest.mark.parametrize("loop", [None, 20.0])
def test_steps_are_the_sea_at_their_times(tmp_path, depth, loop):
    """A loop rounds omega: the files carry the rounded waves. Float32: 6e-8 of each amplitude."""
    with pytest.warns(fo.SeaWarning) if loop else nullcontext():
        source = ocean(depth, loop=loop)
    path = tmp_path / "sea.swd"
    fo.export.swd(source, path, steps=41, dt=0.5)
    head, _ = read(path)
    assert (head["shape"], head["steps"], head["dt"]) == (4 if math.isinf(depth) else 5, 41, 0.5)
    require_equal(path, source, points(np.arange(41) * 0.5), 2e-5)
    if loop:
        _, steps = read(path)
        assert np.max(np.abs(steps[-1] - steps[0])) < 1e-6 * np.max(np.abs(steps[0]))


@pytest.mark.parametrize("depth", [math.inf, 20.0])
def test_steps_have_waves_of_second_order(tmp_path, depth):
    """Their potential falls off with |K|; the kinematics' pressure has -rho |u|^2/2 besides."""
    source = ocean(depth, order=2, bound=40, n=(48, 40))
    path = tmp_path / "sea.swd"
    assert source.bound_waves.report.dropped == 0.0
    fo.export.swd(source, path, steps=5, dt=0.5)
    assert read(path)[0]["order"] == 2
    where = points(np.arange(5) * 0.5)
    found = [water(path, *point) for point in where]
    below, linear = (fo.kinematics.at(source, *where.T, order=order) for order in (2, 1))
    for i, name in enumerate(("heights", "velocities", "accelerations")):
        values, second = getattr(below, name), getattr(below, name) - getattr(linear, name)
        error = np.max(np.abs(np.array([w[i] for w in found]) - values))
        assert error < 2e-5 * np.max(np.abs(values)) < 0.05 * np.max(np.abs(second))
    speed = np.sum(linear.velocities**2, axis=1)
    pressure = -WATER_DENSITY * (np.array([w[3] for w in found]) + 0.5 * speed)
    assert np.max(np.abs(pressure - below.pressures)) < 2e-5 * np.max(np.abs(below.pressures))


def test_rates_are_those_of_the_amplitudes(tmp_path):
    """dh/dt and dc/dt by central differences of the file's own steps."""
    path = tmp_path / "sea.swd"
    fo.export.swd(ocean(), path, steps=3, dt=1e-2)
    _, (before, now, after) = read(path)
    for value, rate in ((0, 1), (2, 3)):
        slope = (after[value] - before[value]) / 2e-2
        assert np.max(np.abs(slope - now[rate])) < 2e-3 * np.max(np.abs(now[rate]))


def test_waves_backward_and_along_y_are_kept(tmp_path):
    """One wave of each quadrant and axis, found at the place of its sign."""
    modes = [(3, 2, 0.2, 0.3), (-3, 2, 0.1, 1.1), (0, 2, 0.3, 2.0), (0, -2, 0.15, 0.5)]
    source = fo.Ocean.from_modes(modes, n=16, size=(80.0, 50.0), dtype="float64")
    path = tmp_path / "four.swd"
    fo.export.swd(source, path, steps=1, dt=1.0)
    _, ((h, *_),) = read(path)
    for mx, my, a, phase in modes:
        place = (mx, my + 8) if mx >= 0 else (-mx, -my + 8)
        value = a * np.exp(1j * phase)
        assert h[place] == pytest.approx(value if mx >= 0 else np.conj(value), abs=1e-7)
    assert np.count_nonzero(h) == 4
    require_equal(path, source, points([0.0]), 2e-5)


def test_the_head_is_that_of_the_format(tmp_path):
    path = tmp_path / "sea.swd"
    fo.export.swd(ocean(12.0), path, date="2026-01-02 03:04:05", comment="a gale")
    head, waves = read(path)
    assert head["magic"] == np.float32(37.0221)
    assert (head["version"], head["shape"], head["amp"], head["order"]) == (100, 6, 1, 1)
    assert head["date"].rstrip(b"\0") == b"2026-01-02 03:04:05"
    assert head["program"].startswith(b"fftocean ")
    assert b"a gale" in head["about"]
    assert head["about"].endswith(b"\0")
    assert head["depth"] == 12.0
    assert path.stat().st_size == 70 + len(head["about"]) + 24 + 8 + 16 * len(waves)


def test_equal_waves_are_equal_bytes(tmp_path):
    for name in ("a", "b"):
        fo.export.swd(ocean(), tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_a_cascade_is_one_list(tmp_path):
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3)
    cascade = fo.Cascade(sea, [(16, 200.0), (16, 37.0)], seed=3)
    fo.export.swd(cascade, tmp_path / "sea.swd")
    require_equal(tmp_path / "sea.swd", cascade, points([0.0, 5.5]), 2e-5)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"dt": 0.5}, "dt goes with steps"),
        ({"steps": 0, "dt": 0.5}, "steps must be a whole number"),
        ({"steps": 3, "dt": 0.0}, "dt must be positive"),
        ({"steps": 3}, "dt must be given"),
        ({"steps": 10**6, "dt": 0.5}, "at most 68719476736 bytes"),
        ({"date": "the second of January 2026"}, "date must be a text of at most 20"),
        ({"comment": "\u00e9"}, "comment must be a text"),
    ],
)
def test_values_out_of_range_are_refused(tmp_path, arguments, message):
    source = ocean(n=(256, 256)) if "steps" in arguments else ocean()
    with pytest.raises(fo.ParameterError, match=message):
        fo.export.swd(source, tmp_path / "sea.swd", **arguments)
    assert not list(tmp_path.iterdir())


def test_waves_with_another_frequency_are_refused_as_a_list(tmp_path):
    looped = fo.Ocean.from_modes([(3, 2, 0.2, 0.3)], n=16, size=80.0, loop=30.0)
    with pytest.raises(fo.ParameterError, match="a loop rounds it; give steps"):
        fo.export.swd(looped, tmp_path / "sea.swd")
    ripples = fo.Ocean.from_modes([(3, 2, 1e-4, 0.3)], n=16, size=0.08, surface_tension=0.07)
    with pytest.raises(fo.ParameterError, match="surface tension raises it; give steps"):
        fo.export.swd(ripples, tmp_path / "sea.swd")
    cascade = fo.Cascade(fo.Sea.from_wind(speed=10.0, fetch=1e5), [(16, 200.0), (16, 37.0)])
    with pytest.raises(fo.ParameterError, match="must be of one Ocean, got"):
        fo.export.swd(cascade, tmp_path / "a", steps=2, dt=1.0)
