"""
Points of the world: the surface inverted another way, differences in time and space, folds,
filters, shapes, threads, and bad input.
"""

import copy
import math
import os
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import fftocean as fo
from fftocean.amplitudes import Modes

SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
SHALLOW = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=6.0, direction=30.0)
TILES = [(64, 120.0), (64, 31.0), (32, 7.3)]
FEW = fo.gerstner.CWR(period=5.0, amplitude=0.5, number=4, steepness=0.8, scale=1.6)
MOVING = (
    *("heights", "normals", "velocities", "accelerations"),
    *("surface_velocities", "surface_accelerations"),
)
RNG = np.random.default_rng(11)


def ocean(sea=SEA, **arguments):
    return fo.Ocean(
        sea,
        **{"n": 32, "size": 60.0, "seed": 4, "dtype": "float64", "choppiness": 0.9, **arguments},
    )


def cascade(**arguments):
    return fo.Cascade(SEA, TILES, **{"seed": 2, "dtype": "float64", "choppiness": 0.7, **arguments})


@pytest.fixture
def source(request):
    """Return what the parameter makes: not before the test runs, as tiles take time to make."""
    return request.param()


def points(count, far=200.0):
    return np.random.default_rng(count).uniform(-far, far, (2, count))


SOURCES = {
    "ocean": ocean,
    "looping": lambda: ocean(loop=40.0),
    "shallow": lambda: ocean(SHALLOW, choppiness=0.5),
    "oblong": lambda: ocean(n=(24, 20), size=(60.0, 37.0)),
    "cascade": lambda: fo.Cascade(
        SEA, [(16, 60.0), (16, 23.0)], seed=2, dtype="float64", choppiness=0.7
    ),
}


def slowly(source, x, y, t):
    """
    The parameters of the water at (x, y), by a damped fixed point on `gerstner.surface` alone, with
    no Jacobian.
    """
    x0, y0 = x.copy(), y.copy()
    for _ in range(400):
        s = fo.gerstner.surface(source, x0, y0, t)
        x0, y0 = x0 + 0.6 * (x - s.x), y0 + 0.6 * (y - s.y)
        if max(np.max(np.abs(s.x - x)), np.max(np.abs(s.y - y))) < 1e-13:
            break
    return x0, y0


# What is found


@pytest.mark.parametrize("name", SOURCES)
def test_exact_equals_an_independent_inversion(name):
    """
    1e-10 in every quantity: round-off of some hundred waves, 1e-13, times the condition of the
    inversion; positions as they are.
    """
    source, t = SOURCES[name](), 3.7
    x, y = points(12, far=50.0)
    found = fo.Query(source, mode="exact", level="frame").at(x, y, t, MOVING)
    x0, y0 = slowly(source, x, y, t)
    truth = fo.gerstner.surface(source, x0, y0, t)
    assert np.max(np.hypot(truth.x - x, truth.y - y)) < 1e-12  # so the oracle has found it
    assert np.max(np.hypot(found.x0 - x0, found.y0 - y0)) < 1e-10
    assert np.max(np.abs(found.heights - truth.height)) < 1e-10
    assert np.max(np.abs(found.normals - truth.normal)) < 1e-10
    c = source.choppiness
    water = np.stack([truth.velocity_x, truth.velocity_y, truth.velocity_z], -1)
    assert np.max(np.abs(found.velocities - water)) < 1e-10
    assert np.max(np.abs(found.surface_velocities - water * (c, c, 1.0))) < 1e-10
    assert np.max(found.residual) < 1e-10
    assert not np.any(found.folded)


def test_few_wave_models():
    """`Waves.at` inverted by the same damped fixed point; also as it starts from rest."""
    x, y = points(15)
    for model, t in (
        (FEW, 4.1),
        (fo.gerstner.CWR(period=5.0, amplitude=0.5, steepness=0.7, tau=3.0), 2.0),
    ):
        query = fo.Query(model, level="frame")
        found = query.at(x, y, t, ("heights", "normals", "surface_velocities"))
        x0, y0 = x.copy(), y.copy()
        for _ in range(400):
            s = model.waves.at(x0, y0, t)
            x0, y0 = x0 + 0.6 * (x - s.x), y0 + 0.6 * (y - s.y)
        s = model.waves.at(x0, y0, t)
        assert np.max(np.abs(found.heights - s.height)) < 1e-11
        assert np.max(np.abs(found.normals - s.normal)) < 1e-11
        assert np.max(np.abs(found.surface_velocities - s.velocity)) < 1e-11
        same = fo.Query(model.waves, level="frame").at(x, y, t, "heights")
        assert np.array_equal(same.heights, found.heights)
    assert not np.any(
        fo.Query(fo.gerstner.CWR(period=5.0, amplitude=0.5, tau=3.0)).at(x, y, -1.0).heights
    )


def test_modes_are_a_source():
    source = ocean(SHALLOW)
    x, y = points(8)
    found = fo.Query(source.modes(), depth=6.0, choppiness=0.9).at(x, y, 2.0)
    expected = fo.Query(source, mode="exact").at(x, y, 2.0)
    for name in ("heights", "normals", "velocities", "accelerations"):
        assert np.max(np.abs(found[name] - expected[name])) < 1e-11


def test_bicubic_is_near_the_truth():
    """
    U10 = 10 m/s, n = 256 over 200 m, choppiness 1: rms within 1.1 % of the standard deviation of
    the height, largest within 4.5 %.
    """
    source = fo.Ocean(SEA, n=256, size=200.0, seed=1)
    x, y = points(300)
    query, sigma = (
        fo.Query(source, mode="bicubic", level="frame"),
        math.sqrt(source.amplitudes.variance),
    )
    found = query.at(x, y, 3.7, "heights")
    exact = fo.gerstner.surface(source, found.x0, found.y0, 3.7)
    error = found.heights - exact.height
    assert np.sqrt(np.mean(error**2)) < 0.011 * sigma
    assert np.max(np.abs(error)) < 0.045 * sigma
    apart = np.hypot(exact.x - x, exact.y - y)
    assert (
        np.sqrt(np.mean(apart**2)) < 0.02 * sigma
    )  # two displacements with the height's own error
    bilinear = fo.Query(source, mode="bilinear", level="frame").at(x[:1], y[:1], 3.7, "heights")
    assert abs(bilinear.heights[0] - found.heights[0]) < 0.1 * sigma


@pytest.mark.parametrize("mode", ["bilinear", "bicubic"])
def test_interpolated_modes_invert_what_they_return(mode):
    """
    The surface is known at its vertices: a query at the place of one returns that vertex, as near
    as the residual allows (1e-7 m).
    """
    source = cascade(choppiness=0.6)
    single = source.oceans[0]
    frame = single.frame(5.0, ("height", "displace_x", "displace_y", "normal", "velocity_z"))
    grid = single.grid
    rows, columns = RNG.integers(0, grid.ny, 40), RNG.integers(0, grid.nx, 40)
    x = grid.x[columns] + 0.6 * frame.displace_x[rows, columns] + 3 * grid.lx
    y = grid.y[rows] + 0.6 * frame.displace_y[rows, columns] - 2 * grid.ly
    found = fo.Query(single, mode=mode, level="frame").at(x, y, 5.0)
    assert np.max(np.abs(found.heights - frame.height[rows, columns])) < 1e-7
    assert np.max(np.abs(found.normals - frame.normal[rows, columns])) < 1e-6
    assert np.max(np.abs(found.velocities[:, 2] - frame.velocity_z[rows, columns])) < 1e-6
    assert (
        np.median(np.abs(found.heights - frame.height[rows, columns])) < 1e-10
    )  # Newton mostly goes far beyond
    assert np.max(found.residual) < 1e-9 * grid.lx


@pytest.mark.parametrize("mode", ["bilinear", "bicubic"])
def test_interpolation_converges(mode):
    """
    Twice the samples: a 4th (linear) or 16th (cubic) of the error in height, half a power off; for
    waves that both resolve.
    """
    modes = [(1, 2, 0.3, 0.4), (-2, 1, 0.2, 1.0), (3, 0, 0.1, 2.0)]
    x, y = points(60)
    errors = []
    for n in (32, 64):
        source = fo.Ocean.from_modes(modes, n=n, size=40.0, dtype="float64")
        exact = fo.Query(source, mode="exact").at(x, y, 1.0)
        found = fo.Query(source, mode=mode).at(x, y, 1.0)
        errors.append(
            [
                np.max(np.abs(found[name] - exact[name]))
                for name in ("heights", "normals", "velocities", "accelerations")
            ]
        )
    ratios = np.array(errors[0]) / np.array(errors[1])
    order = 2 if mode == "bilinear" else 4
    assert np.all(ratios > 2.0 ** (order - 0.5))
    assert np.all(np.array(errors[1]) < (0.05 if mode == "bilinear" else 0.001))


def test_bicubic_of_a_cascade_is_near_exact():
    """
    Three tiles, their displacements summed before inverting: heights within 2 % of sigma of the
    waves themselves.
    """
    source = cascade()
    x, y = points(40)
    exact = fo.Query(source, mode="exact").at(x, y, 9.0)
    for mode, share in (("bicubic", 0.02), ("bilinear", 0.1)):
        found = fo.Query(source, mode=mode).at(x, y, 9.0)
        assert np.max(np.abs(found.heights - exact.heights)) < share * math.sqrt(source.variance)


# Motion


@pytest.mark.parametrize(
    "source", [ocean, cascade, lambda: FEW], ids=["ocean", "cascade", "few"], indirect=True
)
def test_surface_velocity_is_the_rate_of_the_position(source):
    """
    Of the point found: central differences of its position converge as dt^2, twice dt four times
    the error; so do accelerations.

    Positions are those of `gerstner.surface` or `Waves.at`, at the parameters found.
    """
    x, y = points(6, far=40.0)
    found = fo.Query(source, mode="exact", level="frame").at(x, y, 2.0, MOVING)

    def position(t):
        if source is FEW:
            return FEW.waves.at(found.x0, found.y0, t).position
        s = fo.gerstner.surface(source, found.x0, found.y0, t)
        return np.stack([s.x, s.y, s.z], axis=-1)

    assert np.max(np.abs(position(2.0) - np.stack([x, y, found.heights], axis=-1))) < 1e-10
    first, second = [], []
    for dt in (0.01, 0.02):
        first.append(
            np.max(
                np.abs(
                    (position(2.0 + dt) - position(2.0 - dt)) / (2 * dt) - found.surface_velocities
                )
            )
        )
        second.append(
            np.max(
                np.abs(
                    (position(2.0 + dt) - 2 * position(2.0) + position(2.0 - dt)) / dt**2
                    - found.surface_accelerations
                )
            )
        )
    assert first[1] / first[0] == pytest.approx(4.0, rel=0.1)
    assert second[1] / second[0] == pytest.approx(4.0, rel=0.1)
    assert first[0] < 1e-2 * np.max(np.abs(found.surface_velocities))


@pytest.mark.parametrize("mode", ["bilinear", "bicubic"])
def test_interpolated_velocity_is_the_rate_of_the_interpolated_position(mode):
    """
    One texel's particle, followed through three queries: the central difference of where it is;
    dt^2/6 of the third derivative.
    """
    source = ocean(choppiness=0.6)
    column, row, t, dt = 5, 9, 4.0, 1e-3
    frames = [source.frame(s, ("height", "displace_x", "displace_y")) for s in (t - dt, t, t + dt)]
    place = [
        np.array(
            [
                source.grid.x[column] + 0.6 * f.displace_x[row, column],
                source.grid.y[row] + 0.6 * f.displace_y[row, column],
                f.height[row, column],
            ]
        )
        for f in frames
    ]
    found = fo.Query(source, mode=mode).at(place[1][0], place[1][1], t, MOVING)
    velocity = (place[2] - place[0]) / (2 * dt)
    acceleration = (place[2] - 2 * place[1] + place[0]) / dt**2
    assert np.max(np.abs(velocity - found.surface_velocities)) < 1e-4
    assert np.max(np.abs(acceleration - found.surface_accelerations)) < 1e-3
    water = (0.6, 0.6, 1.0)  # moves as if choppiness were 1
    assert np.array_equal(found.velocities * water, found.surface_velocities)
    assert np.array_equal(found.accelerations * water, found.surface_accelerations)


def test_normals_are_those_of_the_heights():
    """
    Central differences of queried heights in the world: -dz/dx, -dz/dy, 1; h^2 of third
    derivatives.
    """
    query, h = fo.Query(ocean(choppiness=0.6), mode="exact"), 1e-4
    x, y = points(10)
    heights = {
        step: query.at(x + step[0], y + step[1], 1.0, "heights").heights
        for step in ((h, 0), (-h, 0), (0, h), (0, -h))
    }
    normal = np.stack(
        [
            -(heights[h, 0] - heights[-h, 0]) / (2 * h),
            -(heights[0, h] - heights[0, -h]) / (2 * h),
            np.ones(10),
        ],
        axis=-1,
    )
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    assert np.max(np.abs(normal - query.at(x, y, 1.0).normals)) < 1e-5


# The water and its mean motion


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
@pytest.mark.parametrize("choppiness", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("depth", [math.inf, 2.0])
def test_the_water_moves_as_in_one_airy_wave(mode, choppiness, depth):
    """
    a omega coth kh cos f along, a omega sin f up, at the rest position found, whatever the
    choppiness; accelerations are their time derivatives at rest position.
    """
    a, size, phase, t = 0.2, 10.0, 0.7, 1.3
    k = 2.0 * math.pi / size
    tanh = math.tanh(k * depth)
    omega = math.sqrt(9.80665 * k * tanh)
    source = fo.Ocean.from_modes(
        [(1, 0, a, phase)], n=64, size=size, depth=depth, dtype="float64", choppiness=choppiness
    )
    x = np.linspace(0.0, size, 9)
    found = fo.Query(source, mode=mode).at(x, 0.0, t)
    f = k * found.x0 - omega * t - phase
    still = np.zeros_like(x)
    water = a * omega * np.stack([np.cos(f) / tanh, still, np.sin(f)], axis=-1)
    push = a * omega**2 * np.stack([np.sin(f) / tanh, still, -np.cos(f)], axis=-1)
    # linear interpolation of 64 samples: (k dx)^2/8 = 1.2e-3; cubic: (k dx)^4/384 = 2.4e-7
    share = {"bilinear": 2e-3, "bicubic": 1e-6, "exact": 1e-12}[mode]
    scale = a * omega / tanh
    assert np.max(np.abs(found.velocities - water)) < share * scale
    assert np.max(np.abs(found.accelerations - push)) < share * scale * omega


def test_water_of_a_sharpened_model_is_that_of_its_waves():
    """A few-wave model is read as deep water waves: the sharpness of its shape moves no water."""
    flat, sharp = (
        fo.gerstner.CWR(period=5.0, amplitude=0.5, number=4, steepness=steepness, scale=1.6)
        for steepness in (1e-9, 0.8)
    )
    x0, y0 = points(9, far=30.0)
    surface = sharp.waves.at(x0, y0, 2.0)
    found = fo.Query(sharp).at(surface.x, surface.y, 2.0)
    assert np.max(np.abs(found.x0 - x0)) < 1e-9
    there = fo.Query(flat).at(x0, y0, 2.0)
    assert np.max(np.abs(found.velocities - there.velocities)) < 1e-6
    below = fo.kinematics.at(sharp, x0, y0, 0.0, 2.0)
    assert np.max(np.abs(found.velocities - below.velocities)) < 1e-9


def world_mean(source, t):
    """
    The mean height over the world of the surface of one tile: the mean of h J over rest positions,
    by the direct sum on a lattice that resolves the products of three waves.
    """
    side = np.arange(48) * source.grid.lx / 48
    x0, y0 = (a.ravel() for a in np.meshgrid(side, side))
    s, c = fo.gerstner.surface(source, x0, y0, t), source.choppiness
    area = (1.0 + c * s.stretch_xx) * (1.0 + c * s.stretch_yy) - (c * s.stretch_xy) ** 2
    assert np.mean(area) == pytest.approx(1.0, abs=1e-12)
    return float(np.mean(s.height * area))


@pytest.mark.parametrize("depth", [math.inf, 1.5])
def test_set_down_of_one_wave(depth):
    """-a^2 k c/(2 tanh kh), by quadrature of the direct sum; one wave has no products of three."""
    a, size = 0.3, 12.0
    k = 2.0 * math.pi / size
    source = fo.Ocean.from_modes(
        [(0, 1, a, 0.9)], n=8, size=size, depth=depth, dtype="float64", choppiness=0.8
    )
    query = fo.Query(source, mode="exact")
    assert query.set_down == pytest.approx(-0.5 * 0.8 * a**2 * k / math.tanh(k * depth), rel=1e-12)
    assert query.set_down == pytest.approx(world_mean(source, 2.2), rel=1e-12)
    y = np.arange(400) * size / 400  # equidistant in the world
    exact = query.at(0.0, y, 2.2, "heights").heights
    assert abs(np.mean(exact)) < 1e-11  # of a periodic, smooth function: by roundings alone
    frame = fo.Query(source, mode="exact", level="frame").at(0.0, y, 2.2, "heights").heights
    assert np.max(np.abs(frame - exact - query.set_down)) < 1e-15


def test_heights_of_a_choppy_sea_have_mean_zero():
    """
    A gale on a loop: the mean over the world and over one period is `set_down`, to that part of the
    products of three waves that has not averaged out over 24 moments; over one moment it swings by
    the beats of waves that run against each other.
    """
    sea = fo.Sea.beaufort(9)
    source = fo.Ocean(sea, n=24, size=400.0, seed=3, loop=60.0, dtype="float64")
    query = fo.Query(source, mode="exact")
    assert query.set_down < -0.05
    means = [world_mean(source, 60.0 * j / 24) for j in range(24)]
    assert np.mean(means) == pytest.approx(query.set_down, rel=0.02)
    x, y = (a.ravel() for a in np.meshgrid(*2 * [np.arange(40) * 10.0]))
    still = np.mean(query.at(x, y, 5.0, "heights").heights)
    assert still == pytest.approx(world_mean(source, 5.0) - query.set_down, abs=2e-3)


def test_set_down_adds_up_over_tiles_and_follows_the_filter():
    both = cascade()
    whole = fo.Query(both).set_down
    assert whole == pytest.approx(sum(fo.Query(tile).set_down for tile in both.oceans), rel=1e-12)
    assert whole == fo.Query(both, mode="exact").set_down
    assert 0.0 > fo.Query(both, shortest=5.0).set_down > whole


def test_a_model_that_starts_has_its_set_down_grow_with_it():
    model = fo.gerstner.CWR(period=5.0, amplitude=0.5, number=4, steepness=0.8, scale=1.6, tau=3.0)
    still, frame = (fo.Query(model, level=level) for level in ("still", "frame"))
    for t, share in ((-1.0, 0.0), (3.0, (1.0 - math.exp(-1.0)) ** 2), (1e3, 1.0)):
        risen = still.at(1.0, 2.0, t).heights - frame.at(1.0, 2.0, t).heights
        assert risen == pytest.approx(-share * still.set_down, abs=1e-12)


@pytest.mark.parametrize("choppiness", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_tracers_of_a_drifting_query_drift_as_stokes_says(depth, choppiness):
    """
    Particles on a lattice that follow the velocities of a query, over one loop by Runge-Kutta, as
    in tests/test_kinematics.py: the mean is the closed form of each wave, to (a k)^2 = 6e-4 times
    some units; without drift it is what the docstring says that a query has of it.
    """
    loop, size, g = 12.0, 20.0, 9.80665
    waves = [(2, 1, 0.015, 0.3), (-1, 2, 0.02, 1.1), (3, -2, 0.01, 2.0)]
    source = fo.Ocean.from_modes(
        waves, n=8, size=size, depth=depth, loop=loop, dtype="float64", choppiness=choppiness
    )
    stokes, met = np.zeros(2), np.zeros(2)
    for mx, my, a, _ in waves:
        along = np.array([mx, my]) * 2.0 * math.pi / size
        k = math.hypot(*along)
        omega = round(loop * math.sqrt(g * k * math.tanh(k * depth)) / (2 * math.pi))
        omega *= 2.0 * math.pi / loop
        coth = 1.0 / math.tanh(k * depth)
        stokes += 0.5 * a**2 * omega * along * (coth**2 + 1.0)
        met += 0.5 * a**2 * omega * along * coth**2 * (1.0 - choppiness)
    side = (np.arange(7) + 0.5) * size / 7
    for drift, expected in ((True, stokes), (False, met)):
        query = fo.Query(source, mode="exact", drift=drift)
        x, y = (a.ravel().copy() for a in np.meshgrid(side, side))
        start, steps = np.array([x.mean(), y.mean()]), 120
        position, dt = np.stack([x, y]), loop / steps

        def velocity(p, t, query=query):
            return query.at(p[0], p[1], t, "velocities").velocities.T[:2]

        for i in range(steps):
            t = i * dt
            one = velocity(position, t)
            two = velocity(position + 0.5 * dt * one, t + 0.5 * dt)
            three = velocity(position + 0.5 * dt * two, t + 0.5 * dt)
            four = velocity(position + dt * three, t + dt)
            position = position + dt / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        found = (position.mean(axis=1) - start) / loop
        assert np.max(np.abs(found - expected)) < 5e-3 * np.max(np.abs(stokes))


def test_drift_is_added_to_the_water_alone():
    """To the velocities, in every mode, and not to those of the surface, nor to anything else."""
    source = cascade()
    for mode in ("bilinear", "exact"):
        plain, drifting = (
            fo.Query(source, mode=mode, drift=drift).at(*points(6), 2.0, MOVING)
            for drift in (False, True)
        )
        drift = fo.Query(source, mode=mode, drift=True).drift
        assert np.max(np.abs(drifting.velocities - plain.velocities - drift)) < 1e-14
        assert drift[2] == 0.0
        for name in set(MOVING) - {"velocities"}:
            assert np.array_equal(drifting[name], plain[name])


# Folds


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
@pytest.mark.parametrize("choppiness", [1.0, 1.3, 6.0])
def test_residuals_are_small_or_flagged(mode, choppiness):
    """
    Steep enough to fold: residuals at most 1e-9 of the tile, true by the direct sum; flags where
    the surface lies upside down.
    """
    source = ocean(choppiness=choppiness, n=64)
    frame = source.frame(3.0, ("jacobian",))
    query = fo.Query(source, mode=mode)
    x, y = points(400 if mode != "exact" else 12)
    found = query.at(x, y, 3.0)
    limit = 1e-9 * source.grid.lx
    assert np.all((found.residual <= limit) | found.folded)
    assert np.max(found.residual) <= limit  # on this surface every point is found
    if mode == "exact":
        truth = fo.gerstner.surface(source, found.x0, found.y0, 3.0)
        assert np.max(np.abs(np.hypot(truth.x - x, truth.y - y) - found.residual)) < 1e-12
        assert np.all(found.folded[truth.jacobian <= 0.0])
    assert np.any(frame.jacobian < 0.0) == (choppiness == 6.0)
    if choppiness < 6.0:
        assert not np.any(found.folded)
    elif mode != "exact":
        assert 0.0 < np.mean(found.folded) < 0.5


def test_points_without_an_answer_are_flagged(monkeypatch):
    """A search that is cut short keeps its best point, and sets the flag."""
    from fftocean.kernels import query as kernels

    def stop_early(*arguments):
        found = kernels.Found(*arguments[-1])
        found.residuals[:], found.jacobians[:] = 1.0, 1.0  # a residual of a metre, and no fold
        found.offsets[:], found.heights[:] = 0.0, 0.0

    monkeypatch.setattr(kernels, "follow", stop_early)
    # `invert` finds the points that `follow` leaves.
    assert not np.any(fo.Query(ocean()).at([1.0, 2.0], 0.0, 0.0, "heights").folded)
    monkeypatch.setattr(kernels, "invert", stop_early)
    found = fo.Query(ocean()).at([1.0, 2.0], 0.0, 0.0, "heights")
    assert np.all(found.folded)


# The filter


def test_waves_shorter_than_asked_are_ignored():
    """
    One long and one short wave: with the filter, what the long one alone gives, in every mode;
    without, it is not.
    """
    long, short = (2, 1, 0.4, 0.3), (9, 4, 0.1, 1.0)
    both, alone = (
        fo.Ocean.from_modes(modes, n=32, size=50.0, dtype="float64", choppiness=0.9)
        for modes in ([long, short], [long])
    )
    x, y = points(20)
    for mode in ("bilinear", "bicubic", "exact"):
        expected = fo.Query(alone, mode=mode).at(x, y, 2.0)
        found = fo.Query(both, mode=mode, shortest=10.0).at(x, y, 2.0)
        for name in ("heights", "normals", "velocities", "accelerations"):
            assert np.max(np.abs(found[name] - expected[name])) < 1e-11
        assert (
            np.max(np.abs(fo.Query(both, mode=mode).at(x, y, 2.0).heights - expected.heights))
            > 0.05
        )


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
def test_a_filter_that_leaves_nothing_leaves_a_flat_sea(mode):
    found = fo.Query(cascade(), mode=mode, shortest=1e4).at([1.0, 2.0], [0.0, math.nan], 3.0)
    assert np.array_equal(found.heights, [0.0, math.nan], equal_nan=True)
    assert np.array_equal(found.normals[0], [0.0, 0.0, 1.0])
    assert np.all(np.isnan(found.normals[1]))
    assert not np.any(found.velocities[0])
    assert found.residual[0] == 0.0
    assert not np.any(found.folded)


def test_a_filter_drops_whole_tiles():
    source = cascade()
    shortest = 1.6 * 2 * math.pi / source.bands[1][0]
    x, y = points(5)
    found = fo.Query(source, shortest=shortest).at(x, y, 1.0)
    assert np.allclose(
        found.heights,
        fo.Query(source.oceans[0], shortest=shortest).at(x, y, 1.0).heights,
        atol=1e-13,
    )


# Shapes and coordinates


@pytest.mark.parametrize("mode", ["bicubic", "exact"])
def test_any_shape(mode):
    query = fo.Query(ocean(), mode=mode)
    one = query.at(3.0, 4.0, 1.5)
    assert one.heights.shape == one.folded.shape == one.residual.shape == one.x0.shape == ()
    assert one.normals.shape == one.velocities.shape == one.accelerations.shape == (3,)
    assert query.at([3, 4], [4, 5], 1).heights.shape == (2,)
    grid = query.at(np.zeros((3, 1)), np.zeros((1, 4)), 1.5)
    assert grid.heights.shape == (3, 4)
    assert grid.velocities.shape == (3, 4, 3)
    assert query.at([], [], 1.5).normals.shape == (0, 3)
    several = query.at(np.full((2, 2), 3.0), 4.0, [[1.5, 2.5], [2.5, 1.5]])
    assert np.allclose(several.heights[[0, 1], [0, 1]], one.heights, atol=1e-13)
    assert several.heights[0, 1] == several.heights[1, 0] != one.heights
    x = np.asfortranarray(RNG.uniform(-9, 9, (4, 5)))
    assert np.array_equal(
        query.at(x[:, ::2], x[:, ::2].T[0, 0], 1.5).heights,
        query.at(x, x[0, 0], 1.5).heights[:, ::2],
    )


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
def test_far_away_and_negative(mode):
    """
    Whole periods away: as near the origin, to the rounding of the coordinate itself times the
    steepest slope.
    """
    source = ocean()
    query = fo.Query(source, mode=mode)
    x, y = points(10, far=30.0)
    near = query.at(x, y, 1.0)
    for periods in (-3, 1000, -(10**7), 10**12):
        found = query.at(x + 60.0 * periods, y - 120.0 * periods, 1.0)
        rounding = 4 * np.spacing(120.0 * abs(periods))
        assert np.max(np.abs(found.heights - near.heights)) < 1e-12 + rounding
        assert np.max(found.residual) < 6e-8


def test_years_later():
    """t = 1e8 s: the exact sum has the waves where the frames have them; 1e-10 rad of phase."""
    source = ocean()
    frame = source.frame(1e8, ("height", "displace_x", "displace_y"))
    x = source.grid.x[7] + 0.9 * frame.displace_x[3, 7]
    y = source.grid.y[3] + 0.9 * frame.displace_y[3, 7]
    query = fo.Query(source, mode="exact", level="frame")
    assert abs(query.at(x, y, 1e8).heights - frame.height[3, 7]) < 1e-9
    looping = ocean(loop=40.0)
    exact = fo.Query(looping, mode="exact")
    assert (
        abs(exact.at(1.0, 2.0, 40.0 * 2**30 + 1.5).heights - exact.at(1.0, 2.0, 1.5).heights)
        < 1e-12
    )


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_nan_for_that_point_only(mode, bad):
    query = fo.Query(cascade(), mode=mode)
    clean = query.at([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], 1.5)
    for x, y, t in (
        ([1.0, bad, 3.0], [4.0, 5.0, 6.0], 1.5),
        ([1.0, 2.0, 3.0], [4.0, bad, 6.0], 1.5),
        ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [1.5, bad, 1.5]),
    ):
        found = query.at(x, y, t)
        for name in ("heights", "normals", "velocities", "accelerations"):
            assert np.all(np.isnan(found[name][1]))
            assert np.array_equal(found[name][[0, 2]], clean[name][[0, 2]])
        assert math.isnan(found.residual[1])
        assert math.isnan(found.x0[1])
        assert not found.folded[1]
    assert np.all(np.isnan(query.at([1.0, 2.0], 0.0, bad).heights))


def test_without_choppiness_the_water_stays_where_it_is():
    source = ocean(choppiness=0.0)
    x, y = points(20)
    query = fo.Query(source)
    assert query.set_down == 0.0
    found = query.at(x, y, 1.0, MOVING)
    assert np.array_equal(found.x0, x)
    assert not np.any(found.residual)
    assert not np.any(found.surface_velocities[:, :2])
    assert not np.any(found.surface_accelerations[:, :2])
    assert np.all(np.abs(found.velocities[:, :2]) > 0.0)  # the water swings all the same
    assert not np.any(found.folded)


# A query as a thing


def test_only_what_is_asked_is_there():
    query = fo.Query(ocean())
    found = query.at([1.0, 2.0], 0.0, 0.5, fields=("heights",))
    with pytest.raises(fo.FieldError, match="velocities"):
        _ = found.velocities
    full = query.at([1.0, 2.0], 0.0, 0.5)
    assert np.array_equal(full.heights, found.heights)
    with pytest.raises(fo.FieldError, match="heights"):
        _ = query.at(1.0, 2.0, 0.0, "normals").heights


def test_one_time_is_synthesised_once(monkeypatch):
    calls = []
    frame = fo.Ocean.frame
    monkeypatch.setattr(
        fo.Ocean,
        "frame",
        lambda self, t, *rest, **more: (calls.append(t), frame(self, t, *rest, **more))[1],
    )
    query = fo.Query(ocean())
    for _ in range(3):
        query.at(1.0, 2.0, 0.5, ("heights", "normals"))
    assert calls == [0.5]
    query.at(1.0, 2.0, 0.5)
    assert calls == [0.5, 0.5, 0.5]  # velocities, and accelerations: what was missing
    query.at(1.0, 2.0, 0.75, "heights")
    query.at(1.0, 2.0, 0.5, "heights")
    assert calls[3:] == [0.75, 0.5]


@pytest.mark.parametrize("mode", ["bilinear", "exact"])
def test_threads_change_nothing(mode):
    source = fo.Ocean(SEA, n=16, size=60.0, dtype="float32")
    x, y = points(40000 if mode == "bilinear" else 100)
    one, two = (fo.Query(source, mode=mode, threads=threads).at(x, y, 1.0) for threads in (1, 2))
    for name in ("heights", "normals", "velocities", "accelerations"):
        assert np.array_equal(one[name], two[name])


def test_many_threads_share_a_query():
    query = fo.Query(cascade(), mode="bilinear", threads=2)
    x, y = points(50)
    times = [0.1 * (i % 5) for i in range(40)]
    alone = {t: query.at(x, y, t).accelerations for t in set(times)}
    with ThreadPoolExecutor(8) as pool:
        for t, found in zip(
            times, pool.map(lambda t: query.at(x, y, t).accelerations, times), strict=True
        ):
            assert np.array_equal(found, alone[t])


def test_a_query_is_a_frozen_value():
    query = fo.Query(ocean(), mode="bilinear", shortest=3.0, threads=2, level="frame", drift=True)
    with pytest.raises(AttributeError, match="frozen"):
        query.mode = "exact"
    for again in (pickle.loads(pickle.dumps(query)), copy.copy(query)):
        assert (again.mode, again.shortest, again.threads) == ("bilinear", 3.0, 2)
        assert again.level == "frame"
        assert np.array_equal(again.drift, query.drift)
        assert np.any(again.drift)
        assert np.array_equal(again.at(1.0, 2.0, 0.5).normals, query.at(1.0, 2.0, 0.5).normals)
    assert "bilinear" in repr(query)
    assert "heights" in repr(query.at(1.0, 2.0, 0.5))


@pytest.mark.skipif(sys.platform == "win32", reason="no fork there")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.process
def test_a_forked_child_can_ask_too():
    query = fo.Query(ocean(), mode="bilinear", threads=2)
    x, y = points(20000)
    expected = float(np.sum(query.at(x, y, 1.0, "heights").heights))
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        value = float(np.sum(query.at(x, y, 1.0, "heights").heights))
        os.write(writing, b"1" if value == expected else b"0")
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(reading, 1) == b"1"
    os.close(reading)
    os.close(writing)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: fo.Query("water"), "must come from"),
        (lambda: fo.Query(ocean(), mode="nearest"), "mode must be one of"),
        (lambda: fo.Query(FEW, mode="bicubic"), "must be 'exact'"),
        (lambda: fo.Query(ocean(), shortest=-1.0), "shortest"),
        (lambda: fo.Query(ocean(), shortest=math.nan), "shortest"),
        (lambda: fo.Query(ocean(), threads=0), "threads"),
        (lambda: fo.Query(ocean(), level="sea"), "level must be one of still, frame"),
        (lambda: fo.Query(ocean(), drift=1), "drift must be True or False"),
        (lambda: fo.Query(ocean(), depth=3.0), "go with Modes only"),
        (lambda: fo.Query(ocean(), choppiness=1.0, mode="exact"), "go with Modes only"),
        (lambda: fo.Query(ocean().modes(), depth=-1.0), "depth"),
        (lambda: fo.Query(ocean().modes()._replace(kx=np.array([math.nan]))), "columns of finite"),
        (
            lambda: fo.Query(
                ocean().modes()._replace(kx=0 * ocean().modes().kx, ky=0 * ocean().modes().kx)
            ),
            "above 0",
        ),
        (lambda: fo.Query(ocean()).at("a", 0.0, 0.0), "x must be a number"),
        (lambda: fo.Query(ocean()).at(1.0, 1j, 0.0), "y must be a number"),
        (lambda: fo.Query(ocean()).at(1.0, None, 0.0), "y must be a number"),
        (lambda: fo.Query(ocean()).at([1.0, 2.0], [1.0, 2.0, 3.0], 0.0), "broadcast"),
        (lambda: fo.Query(ocean()).at(1.0, 2.0, 1e13), "t must"),
        (lambda: fo.Query(ocean()).at(1.0, 2.0, 0.0, ("height",)), "a field must be one of"),
    ],
)
def test_bad_input_is_refused(make, says):
    with pytest.raises(fo.ParameterError, match=says):
        make()


def test_nobody_may_ask():
    """Empty arrays of points and times, in any shape."""
    ocean = fo.Ocean.from_modes([(1, 2, 0.1, 0.3)], n=8, size=20.0)
    query = fo.Query(ocean)
    for shape, arguments in (
        ((0,), ([], [], [])),
        ((0, 3), (np.zeros((0, 3)), 0.0, np.zeros((0, 1)))),
        ((0, 2), (np.zeros((0, 1)), 0.0, [1.0, 2.0])),
    ):
        found = query.at(*arguments)
        assert found.heights.shape == shape
        assert found.normals.shape == (*shape, 3)
    assert fo.kinematics.at(ocean, [], [], [], []).velocities.shape == (0, 3)


def test_where_the_sum_is_no_number_the_answer_is_none():
    """k x overflows: not what was in the memory before, but NaN, and flagged."""
    modes = Modes(
        np.array([10.0]), np.array([0.0]), np.array([0.01]), np.array([0.0]), np.array([9.0])
    )
    with np.errstate(all="ignore"):
        found = fo.Query(modes).at([1.7e308, 1.0], [0.0, 0.0], 0.0, ("heights",))
    assert np.isnan(found.heights[0])
    assert np.isnan(found.residual[0])
    assert found.folded[0]
    assert np.isfinite(found.heights[1])


def test_what_is_masked_is_not_asked_for():
    query = fo.Query(fo.Ocean.from_modes([(1, 2, 0.1, 0.3)], n=8, size=20.0))
    found = query.at(np.ma.masked_array([1.0, 2.0], mask=[False, True]), 0.0, 0.0)
    assert np.isfinite(found.heights[0])
    assert np.isnan(found.heights[1])


@pytest.mark.parametrize(
    ("arguments", "rule"),
    [
        (([[1], [1, 2]], 1, 0), "x must be numbers in a regular array"),
        ((1, 1, 0, 5), "fields must be"),
        ((1, 1, 0, (["heights"],)), "fields must be"),
    ],
)
def test_what_is_no_question_is_refused(arguments, rule):
    query = fo.Query(fo.Ocean.from_modes([(1, 2, 0.1, 0.3)], n=8, size=20.0))
    with pytest.raises(fo.ParameterError, match=rule):
        query.at(*arguments)
    with pytest.raises(fo.ParameterError, match="mode must be"):
        fo.Query(query.source, mode=["exact"])


# Against sums over the waves that are written here


def surface_of(source, x0, y0, t):
    """
    Return position, velocity and acceleration of the displaced surface, (points, 3) each, and the
    gradient of height and displacement, wave by wave.
    """
    waves, depth, c = source.modes(), source.depth, source.choppiness
    k = np.hypot(waves.kx, waves.ky)
    f = np.outer(x0, waves.kx) + np.outer(y0, waves.ky) - waves.omega * t - waves.phase
    ratio = 1.0 / np.tanh(np.minimum(k * depth, 300.0))
    ux, uy, omega = waves.kx / k * ratio, waves.ky / k * ratio, waves.omega
    wave = waves.amplitude * np.cos(f), waves.amplitude * np.sin(f)
    position = np.stack([x0 - c * wave[1] @ ux, y0 - c * wave[1] @ uy, wave[0].sum(axis=1)], -1)
    velocity = np.stack([wave[0] @ (omega * ux), wave[0] @ (omega * uy), wave[1] @ omega], -1)
    squared = omega**2
    acceleration = np.stack(
        [wave[1] @ (squared * ux), wave[1] @ (squared * uy), -wave[0] @ squared], -1
    )
    return position, velocity, acceleration


LONG = [(1, 0, 0.4, 0.3), (2, -1, 0.2, 1.1), (0, 2, 0.2, 2.0), (-2, 1, 0.1, 4.0), (3, 2, 0.05, 5.0)]


@pytest.mark.parametrize("loop", [None, 23.0], ids=["free", "loop"])
@pytest.mark.parametrize("t", [7.3, -41.9])
@pytest.mark.parametrize(
    ("mode", "error"), [("exact", 1e-10), ("bicubic", 2e-5), ("bilinear", 2e-2)]
)
@pytest.mark.parametrize("far", [0.0, 1.0])
def test_every_field_is_the_sum_of_the_waves(mode, error, t, loop, far):
    """
    On an oblong tile with other samples along x than along y, near and millions of periods away, at
    negative times, with the frequencies of the loop.

    The spline's error is (k d)^4/384 of a wave, d being a sample: 1e-5 of the shortest here; linear
    interpolation's (k d)^2/8, 1e-2. Times omega^2 = 4 at most, and 0.05 m.
    """
    source = fo.Ocean.from_modes(
        LONG, n=(72, 60), size=(60.0, 37.0), depth=9.0, choppiness=0.8, loop=loop, dtype="float64"
    )
    x, y = points(40, far=90.0)
    x, y = x - far * 60.0 * 2**20, y + far * 37.0 * 2**21
    found = fo.Query(source, mode=mode, level="frame").at(x, y, t)
    x0 = found.x0 + far * 60.0 * 2**20  # the same waves, at parameters that round less
    y0 = found.y0 - far * 37.0 * 2**21
    position, velocity, acceleration = surface_of(source, x0, y0, t)
    error += 1e-7 * far  # of coordinates of 1e8 m
    place = np.stack([x + far * 60.0 * 2**20, y - far * 37.0 * 2**21, found.heights], axis=-1)
    assert np.max(np.abs(position - place)) < error
    assert np.max(np.abs(velocity - found.velocities)) < 2.0 * error
    assert np.max(np.abs(acceleration - found.accelerations)) < 4.0 * error
    if loop is not None:
        cycles = source.modes().omega * loop / (2.0 * np.pi)
        assert np.max(np.abs(cycles - np.rint(cycles))) < 1e-9


@pytest.mark.parametrize("mode", ["bilinear", "bicubic", "exact"])
@pytest.mark.parametrize("apart", [1e-12, 1e-6, 1e-3])
def test_times_a_little_apart_are_different_moments(mode, apart):
    """A query that has a frame of t answers at t + apart as one that has none."""
    source = ocean()
    x, y = points(10)
    kept = fo.Query(source, mode=mode)
    for t in (0.0, 5.0, -5.0):
        kept.at(x, y, t)
        found, fresh = kept.at(x, y, t + apart), fo.Query(source, mode=mode).at(x, y, t + apart)
        for name in ("heights", "normals", "velocities", "accelerations"):
            assert np.array_equal(found[name], fresh[name])
    if apart >= 1e-6:
        assert not np.array_equal(kept.at(x, y, 5.0).heights, kept.at(x, y, 5.0 + apart).heights)


@pytest.mark.parametrize("t", [0.4, 2.0, 11.0])
def test_a_model_that_starts_moves_as_its_positions_do(t):
    """
    The ramp 1 - e^{-t/tau} multiplies all waves, so that rates follow the product rule: central
    differences of positions, h^2/6 of a third derivative below 20 m/s^3, and h^2/12 of a fourth.
    """
    model = fo.gerstner.CWR(period=5.0, amplitude=0.5, number=4, steepness=0.5, scale=1.6, tau=3.0)
    x, y = points(8, far=30.0)
    found = fo.Query(model, level="frame").at(x, y, t, MOVING)
    h = 1e-3
    before, now, after = (model.waves.at(found.x0, found.y0, s).position for s in (t - h, t, t + h))
    assert np.max(np.abs(now - np.stack([x, y, found.heights], axis=-1))) < 1e-9
    assert np.max(np.abs((after - before) / (2 * h) - found.surface_velocities)) < 1e-5
    assert np.max(np.abs((after - 2 * now + before) / h**2 - found.surface_accelerations)) < 1e-4
