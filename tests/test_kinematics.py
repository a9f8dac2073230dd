"""
Below the surface: the equations that linear waves solve, boundary conditions, stretching, drift;
closed forms before all.
"""

import math

import numpy as np
import pytest

import fftocean as fo
from fftocean.constants import GRAVITY, WATER_DENSITY

WIND = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
SHALLOW = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=6.0, direction=30.0)


def ocean(sea=WIND, **arguments):
    return fo.Ocean(sea, **{"n": 16, "size": 60.0, "seed": 4, "dtype": "float64", **arguments})


def cascade(**arguments):
    return fo.Cascade(WIND, [(16, 60.0), (16, 23.0)], seed=3, **arguments)


@pytest.fixture
def source(request):
    """Return what the parameter makes: not before the test runs, as tiles take time to make."""
    return request.param()


def below(count, deepest):
    rng = np.random.default_rng(count)
    x, y = rng.uniform(-200.0, 200.0, (2, count))
    return x, y, rng.uniform(-deepest, 0.0, count)


@pytest.mark.parametrize("depth", [math.inf, 50.0, 4.0, 0.5])
def test_one_wave_in_closed_form(depth):
    """
    Dean & Dalrymple's table 4.1, written with hyperbolic functions; in deep water with
    exponentials.
    """
    a, k, phase, t = 0.2, 0.8, 0.6, 2.3
    omega = math.sqrt(GRAVITY * k * (1.0 if math.isinf(depth) else math.tanh(k * depth)))
    modes = fo.Ocean.from_modes([(1, 0, a, phase)], n=4, size=2 * math.pi / k, depth=depth).modes()
    x, _, z = below(20, min(depth, 8.0))
    found = fo.kinematics.at(modes, x, 3.0, z, t, depth=depth)
    f = k * x - omega * t - phase
    if math.isinf(depth):
        along = up = pressure = np.exp(k * z)
    else:
        along, up, pressure = (
            np.cosh(k * (z + depth)),
            np.sinh(k * (z + depth)),
            np.cosh(k * (z + depth)) / math.cosh(k * depth),
        )
        along, up = along / math.sinh(k * depth), up / math.sinh(k * depth)
    still = 0.0 * x
    velocities = np.stack(
        [a * omega * along * np.cos(f), still, a * omega * up * np.sin(f)], axis=-1
    )
    accelerations = np.stack(
        [a * omega**2 * along * np.sin(f), still, -a * omega**2 * up * np.cos(f)], axis=-1
    )
    assert np.max(np.abs(found.velocities - velocities)) < 1e-12 * max(1.0, 1.0 / depth)
    assert np.max(np.abs(found.accelerations - accelerations)) < 1e-12 * max(1.0, 1.0 / depth)
    assert (
        np.max(np.abs(found.pressures - WATER_DENSITY * GRAVITY * a * pressure * np.cos(f))) < 1e-9
    )  # of 2000 Pa
    assert np.max(np.abs(found.heights - a * np.cos(f))) < 1e-14
    assert np.all(found.wet)


@pytest.mark.parametrize(
    "source",
    [ocean, lambda: ocean(SHALLOW), cascade, lambda: ocean(loop=40.0)],
    ids=["deep", "6m", "cascade", "loop"],
    indirect=True,
)
def test_the_equations_of_motion(source):
    """
    Central differences: no divergence, no rotation, du/dt = -grad p / rho, and acceleration is the
    velocity's rate.

    h = 1e-3 m: h^2/6 k^3 with k up to 2 rad/m, 1e-6 of the fields, against rounding of 1e-13.
    """
    x, y, z = below(12, 5.0)
    z = np.clip(z, -5.0, -0.01)
    h, t = 1e-3, 1.7

    def at(dx=0.0, dy=0.0, dz=0.0, dt=0.0):
        return fo.kinematics.at(source, x + dx, y + dy, z + dz, t + dt)

    gradients = []
    pressure = []
    for axis in ("dx", "dy", "dz"):
        plus, minus = at(**{axis: h}), at(**{axis: -h})
        gradients.append((plus.velocities - minus.velocities) / (2 * h))
        pressure.append((plus.pressures - minus.pressures) / (2 * h))
    here, scale = at(), np.max(np.abs(gradients))
    assert (
        np.max(np.abs(gradients[0][:, 0] + gradients[1][:, 1] + gradients[2][:, 2])) < 1e-5 * scale
    )
    for i, j in ((0, 1), (0, 2), (1, 2)):
        assert np.max(np.abs(gradients[i][:, j] - gradients[j][:, i])) < 1e-5 * scale
    assert np.max(
        np.abs(here.accelerations + np.stack(pressure, axis=-1) / WATER_DENSITY)
    ) < 1e-5 * np.max(np.abs(here.accelerations))
    rate = (at(dt=h).velocities - at(dt=-h).velocities) / (2 * h)
    assert np.max(np.abs(here.accelerations - rate)) < 1e-5 * np.max(np.abs(rate))


@pytest.mark.parametrize(
    "source", [ocean, lambda: ocean(SHALLOW), cascade], ids=["deep", "6m", "cascade"], indirect=True
)
def test_boundary_conditions_at_the_mean_level(source):
    """
    At z = 0: linear Bernoulli, p = rho g height, and the water goes up as the surface does; at the
    bed it does not.
    """
    x, y, _ = below(20, 1.0)
    found = fo.kinematics.at(source, x, y, 0.0, 2.9)
    assert (
        np.max(np.abs(found.pressures - WATER_DENSITY * GRAVITY * found.heights))
        < 1e-12 * WATER_DENSITY * GRAVITY
    )
    surface = fo.gerstner.surface(source, x, y, 2.9)  # parameters: the same sums
    assert np.max(np.abs(found.heights - surface.height)) < 1e-12
    assert np.max(np.abs(found.velocities[:, 2] - surface.velocity_z)) < 1e-12
    assert np.max(np.abs(found.velocities[:, 0] - surface.velocity_x)) < 1e-12
    if math.isfinite(source.depth):
        bed = fo.kinematics.at(source, x, y, -source.depth, 2.9)
        assert np.max(np.abs(bed.velocities[:, 2])) < 1e-14
        assert np.max(np.abs(bed.velocities[:, 0])) > 1e-3


@pytest.mark.parametrize(
    "source", [ocean, lambda: ocean(SHALLOW)], ids=["deep", "6m"], indirect=True
)
def test_stretching(source):
    """
    In the crests: nothing; as at z = 0; and with Wheeler the whole column moved, so that the
    surface has what z = 0 had.
    """
    x, y, _ = below(400, 1.0)
    level = fo.kinematics.at(source, x, y, 0.0, 1.0)
    crest = level.heights > 0.05
    x, y, height = x[crest], y[crest], level.heights[crest]
    z = 0.7 * height
    none, vertical, wheeler = (
        fo.kinematics.at(source, x, y, z, 1.0, stretching=name)
        for name in ("none", "vertical", "wheeler")
    )
    assert not np.any(none.wet)
    assert not np.any(none.velocities)
    assert not np.any(none.pressures)
    assert np.all(vertical.wet & wheeler.wet)
    assert np.array_equal(vertical.velocities, level.velocities[crest])
    surface = fo.kinematics.at(source, x, y, height * (1 - 1e-12), 1.0, stretching="wheeler")
    assert np.max(np.abs(surface.velocities - level.velocities[crest])) < 1e-10
    assert (
        np.max(np.abs(surface.pressures - WATER_DENSITY * GRAVITY * height)) < 1e-6
    )  # of 1e4 Pa: atmospheric at the surface
    read = (
        z - height
        if math.isinf(source.depth)
        else source.depth * (z - height) / (source.depth + height)
    )
    expected = fo.kinematics.at(source, x, y, read, 1.0)
    assert np.max(np.abs(wheeler.velocities - expected.velocities)) < 1e-13
    above = fo.kinematics.at(source, x, y, 1.01 * height, 1.0, stretching="vertical")
    assert not np.any(above.wet)
    assert not np.any(above.accelerations)
    deep = fo.kinematics.at(source, x, y, -3.0, 1.0, stretching="vertical")
    assert np.array_equal(deep.velocities, fo.kinematics.at(source, x, y, -3.0, 1.0).velocities)
    if math.isfinite(source.depth):
        bed = fo.kinematics.at(source, x, y, -source.depth, 1.0, stretching="wheeler")
        assert np.max(np.abs(bed.velocities[:, 2])) < 1e-14
        assert not np.any(
            fo.kinematics.at(source, x, y, -1.001 * source.depth, 1.0, stretching="wheeler").wet
        )


@pytest.mark.parametrize("depth", [math.inf, 4.0])
def test_tracers_drift_as_stokes_says(depth):
    """
    A tracer in the linear velocity field of one wave, over 50 periods by Runge-Kutta: a^2 omega k
    cosh 2k(z + h)/(2 sinh^2 kh), within 1 %; the theory leaves out (a k)^2 = 4e-4. Its mean place
    in the last period is compared with that in the first.
    """
    k, start = 0.5, -1.0
    a = 0.02 / k
    modes = fo.Ocean.from_modes([(1, 0, a, 0.0)], n=4, size=2 * math.pi / k, depth=depth).modes()
    omega = float(modes.omega[0])
    steps, position, t = 12, np.array([0.0, 0.0, start]), 0.0

    def velocity(p, t):
        return fo.kinematics.at(modes, p[0], p[1], p[2], t, depth=depth).velocities

    dt = 2 * math.pi / omega / steps
    places = []
    for _ in range(51 * steps):
        one = velocity(position, t)
        two = velocity(position + 0.5 * dt * one, t + 0.5 * dt)
        three = velocity(position + 0.5 * dt * two, t + 0.5 * dt)
        four = velocity(position + dt * three, t + dt)
        position = position + dt / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        t += dt
        places.append(position)
    x, _, z = np.array(places).T
    mean = np.mean(z)  # the level that it swings about, a little off its first
    drift = (np.mean(x[-steps:]) - np.mean(x[:steps])) / (50 * steps * dt)
    if math.isinf(depth):
        stokes = a**2 * omega * k * math.exp(2 * k * mean)
    else:
        stokes = (
            a**2 * omega * k * math.cosh(2 * k * (mean + depth)) / (2 * math.sinh(k * depth) ** 2)
        )
    assert drift == pytest.approx(stokes, rel=0.01)


@pytest.mark.parametrize("depth", [1e-6, 1e-3, 1e3, 1e8])
def test_no_depth_overflows(depth):
    modes = fo.Ocean.from_modes(
        [(1, 0, 1e-7, 0.0), (400, 0, 1e-7, 0.0)], n=1024, size=6.0, depth=depth
    ).modes()
    for stretching in ("none", "vertical", "wheeler"):
        found = fo.kinematics.at(
            modes, [0.3, 1.0], 0.0, [-depth, 0.0], 0.4, depth=depth, stretching=stretching
        )
        for values in (found.velocities, found.accelerations, found.pressures, found.heights):
            assert np.all(np.isfinite(values))
    deep = fo.kinematics.at(
        modes._replace(omega=np.sqrt(GRAVITY * modes.kx)), 0.3, 0.0, -0.2, 0.4, depth=1e8
    )
    assert np.allclose(
        deep.velocities,
        fo.kinematics.at(
            modes._replace(omega=np.sqrt(GRAVITY * modes.kx)), 0.3, 0.0, -0.2, 0.4
        ).velocities,
    )


def test_shapes_threads_and_what_is_not_finite():
    source = ocean()
    one = fo.kinematics.at(source, 1.0, 2.0, -3.0, 0.5)
    assert one.velocities.shape == (3,)
    assert one.pressures.shape == one.wet.shape == ()
    grid = fo.kinematics.at(source, np.ones((3, 1)), 2.0, [-3.0, -4.0], [[0.5], [0.6], [0.5]])
    assert grid.accelerations.shape == (3, 2, 3)
    assert np.array_equal(grid.velocities[0, 0], one.velocities)
    assert np.array_equal(grid.velocities[0], grid.velocities[2])
    assert not np.array_equal(grid.velocities[0], grid.velocities[1])
    x, y, z = below(1000, 4.0)
    single, double = (fo.kinematics.at(source, x, y, z, 0.5, threads=threads) for threads in (1, 2))
    assert np.array_equal(single.velocities, double.velocities)
    for bad in (math.nan, math.inf):
        for place in (
            (bad, 2.0, -3.0, 0.5),
            (1.0, bad, -3.0, 0.5),
            (1.0, 2.0, bad, 0.5),
            (1.0, 2.0, -3.0, bad),
        ):
            arguments = [
                np.array([good, value, good])
                for good, value in zip((1.0, 2.0, -3.0, 0.5), place, strict=True)
            ]
            found = fo.kinematics.at(source, *arguments)
            assert np.array_equal(found.velocities[0], one.velocities)
            assert np.array_equal(found.velocities[2], one.velocities)
            assert np.all(np.isnan(found.velocities[1]))
            assert math.isnan(found.pressures[1])
            assert list(found.wet) == [True, False, True]


def test_sources_and_filter():
    few = fo.gerstner.CWR(period=5.0, amplitude=0.3, number=3)
    listed = fo.kinematics.at(few, 1.0, 2.0, -1.0, 3.0)
    waves = few.waves
    modes = fo.Ocean.from_modes([(1, 0, 1.0, 0.0)], n=4, size=9.0).modes()
    modes = modes._replace(**{name: getattr(waves, name) for name in modes._fields})
    same = fo.kinematics.at(modes, 1.0, 2.0, -1.0, 3.0)
    assert np.allclose(listed.velocities, same.velocities, atol=1e-15)
    both = fo.Ocean.from_modes([(1, 0, 0.3, 0.0), (5, 1, 0.1, 0.0)], n=16, size=50.0)
    long = fo.Ocean.from_modes([(1, 0, 0.3, 0.0)], n=16, size=50.0)
    assert np.allclose(
        fo.kinematics.at(both, 1.0, 2.0, -1.0, 3.0, shortest=20.0).velocities,
        fo.kinematics.at(long, 1.0, 2.0, -1.0, 3.0).velocities,
    )


@pytest.mark.parametrize(
    ("arguments", "more", "says"),
    [
        ((ocean, 0.0, 0.0, 0.0, 0.0), {"stretching": "chakrabarti"}, "stretching must be one of"),
        ((3.0, 0.0, 0.0, 0.0, 0.0), {}, "must come from"),
        (
            (fo.gerstner.CWR(period=5.0, amplitude=0.3, tau=2.0), 0.0, 0.0, 0.0, 0.0),
            {},
            "start from rest",
        ),
        ((ocean, "x", 0.0, 0.0, 0.0), {}, "x must be a number"),
        ((ocean, [1.0, 2.0], [1.0, 2.0, 3.0], 0.0, 0.0), {}, "broadcast"),
        ((ocean, 0.0, 0.0, 0.0, 1e13), {}, "t must"),
        ((ocean, 0.0, 0.0, 0.0, 0.0), {"threads": 0}, "threads"),
        ((ocean, 0.0, 0.0, 0.0, 0.0), {"depth": 5.0}, "Modes only"),
    ],
)
def test_bad_input_is_refused(arguments, more, says):
    source, *place = arguments
    source = ocean() if source is ocean else source
    with pytest.raises(fo.ParameterError, match=says):
        fo.kinematics.at(source, *place, **more)
