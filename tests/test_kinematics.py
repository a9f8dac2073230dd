"""
Below the surface: the equations that linear waves solve, boundary conditions, stretching, drift;
closed forms before all.
"""

import gc
import math
import weakref

import numpy as np
import pytest

import fftocean as fo
from fftocean import kinematics
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


@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_particles_drift_as_stokes_drift_says(depth):
    """
    Particles on a lattice, in the linear velocity of three crossing waves, over one loop by
    Runge-Kutta: each wave is back at its start, so that what is left is drift. The mean over the
    lattice has no first-order part, and no wave is the sum of two others. The theory leaves out
    (a k)^2, 6e-4 for the three together; the error is 1e-3, and a quarter at half the amplitudes.
    """
    loop, size, z = 12.0, 20.0, -0.4
    waves = [(2, 1, 0.015, 0.3), (-1, 2, 0.02, 1.1), (3, -2, 0.01, 2.0)]
    source = fo.Ocean.from_modes(
        waves, n=8, size=size, depth=depth, loop=loop, dtype="float64", choppiness=0.0
    )
    side = (np.arange(7) + 0.5) * size / 7  # no wave of the sums and differences is 0 mod 7
    start = np.stack([*(a.ravel() for a in np.meshgrid(side, side)), np.full(49, z)], axis=-1)
    position, steps = start.copy(), 120
    dt = loop / steps

    def velocity(p, t):
        return fo.kinematics.at(source, p[:, 0], p[:, 1], p[:, 2], t).velocities

    for i in range(steps):
        t = i * dt
        one = velocity(position, t)
        two = velocity(position + 0.5 * dt * one, t + 0.5 * dt)
        three = velocity(position + 0.5 * dt * two, t + 0.5 * dt)
        four = velocity(position + dt * three, t + dt)
        position = position + dt / 6.0 * (one + 2.0 * two + 2.0 * three + four)
    drift = np.mean(position - start, axis=0) / loop
    stokes = fo.kinematics.stokes_drift(source, z)
    assert stokes.shape == (3,)
    assert np.max(np.abs(drift - stokes)) < 2e-3 * np.max(np.abs(stokes))


@pytest.mark.parametrize("depth", [math.inf, 40.0, 2.0, 0.3])
def test_stokes_drift_of_one_wave(depth):
    """The closed form with hyperbolic functions, along the wave's own direction, at any level."""
    a, size, heading = 0.1, 9.0, math.atan2(2.0, 1.0)
    source = fo.Ocean.from_modes([(1, 2, a, 0.4)], n=8, size=size, depth=depth)
    k = 2.0 * math.pi * math.hypot(1.0, 2.0) / size
    omega = math.sqrt(GRAVITY * k * math.tanh(k * depth))
    levels = -min(depth, 3.0) * np.array([0.0, 0.1, 0.5, 1.0])
    profile = (
        np.exp(2.0 * k * levels)
        if math.isinf(depth)
        else np.cosh(2.0 * k * (levels + depth)) / (2.0 * math.sinh(k * depth) ** 2)
    )
    found = fo.kinematics.stokes_drift(source, levels)
    expected = a**2 * omega * k * profile[:, None] * [math.cos(heading), math.sin(heading), 0.0]
    assert found == pytest.approx(expected, rel=1e-12, abs=0.0)
    at_rest = fo.kinematics.stokes_drift(source, [0.7, math.nan, -1.01 * depth])
    assert at_rest[0] == pytest.approx(found[0])
    assert np.all(np.isnan(at_rest[1]))
    assert math.isinf(depth) or not np.any(at_rest[2])


def test_stokes_drift_adds_up():
    """Over waves, tiles, and the levels of any shape; waves too short are left out."""
    both, levels = cascade(), np.linspace(-8.0, 0.0, 6).reshape(2, 3)
    whole = fo.kinematics.stokes_drift(both, levels)
    assert whole.shape == (2, 3, 3)
    parts = sum(fo.kinematics.stokes_drift(tile, levels) for tile in both.oceans)
    assert whole == pytest.approx(parts, rel=1e-12)
    swell = fo.kinematics.stokes_drift(both, levels, shortest=20.0)
    assert np.all(np.hypot(*swell[..., :2].T) < np.hypot(*whole[..., :2].T))
    with pytest.raises(fo.ParameterError, match="start from rest"):
        fo.kinematics.stokes_drift(fo.gerstner.CWR(period=5.0, amplitude=0.3, tau=2.0))


@pytest.mark.parametrize(
    "source", [ocean, lambda: ocean(SHALLOW)], ids=["deep", "6m"], indirect=True
)
def test_extrapolation_goes_on_along_the_tangent(source):
    """
    Above z = 0 the tangent there, by differences of the profile below, of third order with steps
    of 4 mm: their error is (k h)^3 = 1e-6 of the values. Below z = 0 nothing is changed.
    """
    x, y, _ = below(300, 1.0)
    level = fo.kinematics.at(source, x, y, 0.0, 1.0)
    crest = level.heights > 0.05
    x, y, height = x[crest], y[crest], level.heights[crest]
    z, step = 0.8 * height, 4e-3
    found = fo.kinematics.at(source, x, y, z, 1.0, stretching="extrapolation")
    assert np.all(found.wet)
    assert not np.any(
        fo.kinematics.at(source, x, y, 1.01 * height, 1.0, stretching="extrapolation").wet
    )
    down = [fo.kinematics.at(source, x, y, -i * step, 1.0) for i in range(4)]
    for name in ("velocities", "accelerations", "pressures"):
        at = [getattr(one, name) for one in down]
        tangent = (11.0 * at[0] - 18.0 * at[1] + 9.0 * at[2] - 2.0 * at[3]) / (6.0 * step)
        far = z if name == "pressures" else z[:, None]
        scale = np.max(np.abs(at[0]))
        assert np.max(np.abs(getattr(found, name) - at[0] - far * tangent)) < 1e-4 * scale
    deep = [
        fo.kinematics.at(source, x, y, -0.3, 1.0, stretching=name).velocities
        for name in ("none", "extrapolation")
    ]
    assert np.array_equal(*deep)


def test_pressure_at_the_surface():
    """
    rho g height everywhere with Wheeler, in the crests with vertical, and not in its troughs, where
    one wave has rho g height e^{k height}.
    """
    a, k = 0.3, 0.5
    source = fo.Ocean.from_modes([(1, 0, a, 0.0)], n=4, size=2 * math.pi / k)
    x = np.array([0.0, math.pi / k])  # crest and trough
    height = np.array([a, -a])
    shares = {"wheeler": (1.0, 1.0), "vertical": (1.0, math.exp(-k * a))}
    shares["extrapolation"] = (1.0 + k * a, math.exp(-k * a))
    for stretching, share in shares.items():
        found = fo.kinematics.at(source, x, 0.0, height - 1e-12, 0.0, stretching=stretching)
        expected = WATER_DENSITY * GRAVITY * height * share
        assert found.pressures == pytest.approx(expected, rel=1e-9)


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


@pytest.mark.parametrize("stretching", ["none", "vertical", "extrapolation", "wheeler"])
@pytest.mark.parametrize(
    "arguments",
    [
        {"n": (12, 18), "size": (70.0, 41.0)},
        {"n": (12, 18), "size": (70.0, 41.0), "loop": 37.0},
        {"sea": SHALLOW, "n": (18, 12), "size": (41.0, 70.0)},
    ],
    ids=["deep", "loop", "6m"],
)
def test_every_point_is_the_sum_of_the_waves(arguments, stretching):
    """
    Wave by wave with NumPy, at more points than are summed at a time, far away, at negative
    coordinates and times. To 1e-9 of the largest: k x at 4 km is 1e4 rad, rounded to 1e-12.
    """
    source = ocean(**arguments)
    waves, depth, t = source.modes(), source.depth, -13.7
    rng = np.random.default_rng(5)
    x, y = rng.uniform(-4000.0, 4000.0, (2, 150))
    z = rng.uniform(-4.0, 1.0, 150)
    found = fo.kinematics.at(source, x, y, z, t, stretching=stretching)
    k = np.hypot(waves.kx, waves.ky)
    f = np.outer(x, waves.kx) + np.outer(y, waves.ky) - waves.omega * t - waves.phase
    heights = np.cos(f) @ waves.amplitude
    top = 0.0 if stretching == "none" else heights
    wet = (z <= top) & (z >= -depth)
    level = z
    if stretching == "wheeler":
        level = z - heights if math.isinf(depth) else depth * (z - heights) / (depth + heights)
    rise = np.maximum(level, 0.0) if stretching == "extrapolation" else 0.0 * z
    level = np.minimum(level, 0.0)[:, None]
    if math.isinf(depth):
        along = up = np.exp(k * level) + np.outer(rise, k)
    else:
        whole = np.sinh(k * depth)
        along = np.cosh(k * (level + depth)) / whole + np.outer(rise, k)
        up = np.sinh(k * (level + depth)) / whole + np.outer(rise, k / np.tanh(k * depth))
    a, omega = waves.amplitude, waves.omega
    along, up = along * a * omega / k, up * a * omega
    parts = [along * waves.kx * np.cos(f), along * waves.ky * np.cos(f), up * np.sin(f)]
    rates = [along * waves.kx * np.sin(f), along * waves.ky * np.sin(f), -up * np.cos(f)]
    expected = [
        (found.velocities, np.stack([np.sum(p, axis=1) for p in parts], axis=-1)),
        (found.accelerations, np.stack([p @ omega for p in rates], axis=-1)),
        (found.pressures, WATER_DENSITY * ((along * np.cos(f)) @ omega)),
        (found.heights, heights),
    ]
    assert np.array_equal(found.wet, wet)
    for got, want in expected:
        if got is not found.heights:
            want = np.where(wet.reshape(-1, *(1,) * (want.ndim - 1)), want, 0.0)
        assert np.max(np.abs(got - want)) < 1e-9 * np.max(np.abs(want))


def test_the_waves_of_a_source_are_kept_as_long_as_it_is(monkeypatch):
    """Waves are grouped once for a source and a `shortest`, and go with the source."""
    made = []
    real = kinematics.WaveRings
    monkeypatch.setattr(kinematics, "WaveRings", lambda waves: made.append(1) or real(waves))
    source = ocean()
    first = fo.kinematics.at(source, 1.0, 2.0, -1.0, 0.5)
    again = fo.kinematics.at(source, 1.0, 2.0, -1.0, 0.5)
    assert len(made) == 1
    assert np.array_equal(first.velocities, again.velocities)
    fewer = fo.kinematics.at(source, 1.0, 2.0, -1.0, 0.5, shortest=20.0)
    assert len(made) == 2
    assert not np.array_equal(first.velocities, fewer.velocities)
    assert source in kinematics._rings
    other = weakref.ref(source)
    del source
    gc.collect()
    assert other() is None
