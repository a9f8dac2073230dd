"""Oceans of second order: their frames, and everything that is made of them."""

import json
import math
import pickle
import warnings
from dataclasses import replace

import builders
import numpy as np
import pytest

import fftocean as fo
from fftocean import gerstner, proof
from fftocean.bound_waves import ELEVATION, POTENTIAL
from fftocean.constants import GRAVITY as g
from fftocean.constants import WATER_DENSITY
from fftocean.fields import EIGHT, FIELDS
from fftocean.gerstner.compiled import eight_fields

SEA = fo.Sea(
    fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=3.0, tp=8.0, gamma=3.3),
        spreading=fo.CosinePower(s=2.0 / math.radians(30.0) ** 2 - 1.0),
    )
)
FINITE = replace(SEA, depth=20.0)


def ocean(**changes):
    given = {"n": (96, 64), "size": (480.0, 400.0), "seed": 3, "dtype": "float64", "loop": 60.0}
    return fo.Ocean(changes.pop("sea", SEA), **{**given, "order": 2, "bound": 200, **changes})


def equal(one, other):
    return all(np.array_equal(one[name], other[name]) for name in one.fields)


# closed forms


@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_one_wave_is_that_of_stokes(depth):
    """eta2 = k a^2/4 (3 - t^2)/t^3 cos 2f, without choppiness."""
    a, k, t = 0.2, 2.0 * math.pi * 2.0 / 40.0, 1.3
    water = fo.Ocean.from_modes(
        [(2, 0, a, 0.4)], n=(32, 8), size=40.0, depth=depth, order=2, dtype="float64", choppiness=0
    )
    bed = math.tanh(k * depth)
    f = k * water.grid.x - math.sqrt(g * k * bed) * t - 0.4
    truth = a * np.cos(f) + 0.25 * k * a**2 * (3.0 - bed**2) / bed**3 * np.cos(2.0 * f)
    assert np.max(np.abs(water.frame(t).height - truth)) < 1e-15


def test_two_collinear_waves_of_a_choppy_surface_in_deep_water():
    """
    The displacement has all of the sums, and of the differences min(k1, k2) a1 a2 cos(f1 - f2) is
    left.
    """
    (a1, k1, p1), (a2, k2, p2), t = (0.02, 3, 0.4), (0.03, 5, 1.1), 2.2
    water = fo.Ocean.from_modes(
        [(k1, 0, a1, p1), (k2, 0, a2, p2)], n=32, size=2.0 * math.pi, order=2, dtype="float64"
    )
    f1, f2 = (k * water.grid.x - math.sqrt(g * k) * t - p for k, p in ((k1, p1), (k2, p2)))
    truth = a1 * np.cos(f1) + a2 * np.cos(f2) + min(k1, k2) * a1 * a2 * np.cos(f1 - f2)
    assert np.max(np.abs(water.frame(t).height - truth)) < 1e-15


# the exact conditions at the free surface, on waves of ever smaller steepness


def left_over(order, steepness, depth):
    """
    Return the rms of what six crossing waves leave over of the two conditions, at z = eta.

    Elevation and potential are summed over all components at points of no grid.
    """
    rng = np.random.default_rng(1)
    mx, my = rng.integers(-4, 9, 6), rng.integers(-5, 6, 6)
    mx[(mx == 0) & (my == 0)] = 3
    k = np.hypot(mx, my)
    a, phase = steepness / k / 6.0 * rng.uniform(0.5, 1.5, 6), rng.uniform(0.0, 6.28, 6)
    water = fo.Ocean.from_modes(
        zip(mx.tolist(), my.tolist(), a.tolist(), phase.tolist(), strict=True),
        n=40,
        size=2.0 * math.pi,
        depth=depth,
        order=2,
        dtype="float64",
        choppiness=0.0,
    )
    x, y = rng.uniform(0.0, 2.0 * math.pi, (2, 300))
    t = 0.37
    bed = np.ones(6) if math.isinf(depth) else np.tanh(k * depth)
    omega = np.sqrt(g * k * bed)
    eta = a * np.exp(-1j * (omega * t + phase))
    phi = -1j * g / omega * eta
    kx, ky = mx.astype(float), my.astype(float)
    rates = -1j * omega * eta, -1j * omega * phi
    if order == 2:
        surface = water.bound_waves.cells(ELEVATION, t, (0, 1))
        below = water.bound_waves.cells(POTENTIAL, t, (0, 1))
        kx, ky = np.append(kx, surface.kx), np.append(ky, surface.ky)
        eta, phi = np.append(eta, surface.values[0]), np.append(phi, below.values[0])
        rates = np.append(rates[0], surface.values[1]), np.append(rates[1], below.values[1])
    wave = np.exp(1j * (np.outer(x, kx) + np.outer(y, ky)))
    height, sx, sy, rate = ((wave @ v).real for v in (eta, 1j * kx * eta, 1j * ky * eta, rates[0]))
    k, z = np.hypot(kx, ky), height[:, None]
    if math.isinf(depth):
        level = slope = np.exp(k * z)
    else:
        level = np.cosh(k * (z + depth)) / np.cosh(k * depth)
        slope = np.sinh(k * (z + depth)) / np.cosh(k * depth)
    u, v, phi_t = ((wave * level @ p).real for p in (1j * kx * phi, 1j * ky * phi, rates[1]))
    w = (wave * slope @ (k * phi)).real
    kinematic = rate + u * sx + v * sy - w
    dynamic = phi_t + 0.5 * (u * u + v * v + w * w) + g * height
    return math.sqrt(np.mean(kinematic**2)), float(np.std(dynamic))


@pytest.mark.parametrize("depth", [math.inf, 0.5, 0.2])
@pytest.mark.parametrize(("order", "power"), [(1, 2.0), (2, 3.0)])
def test_what_the_conditions_at_the_free_surface_leave_over(order, power, depth):
    """The power of the steepness, to what the next one adds at steepness 0.01."""
    left = np.array([left_over(order, steepness, depth) for steepness in (0.02, 0.01)])
    assert np.log2(left[0] / left[1]) == pytest.approx([power, power], abs=0.02)


# frames


@pytest.mark.parametrize(
    ("sea", "dtype", "tolerance", "choppiness"),
    [
        (SEA, "float32", 1e-6, 0.7),
        (SEA, "float64", 1e-12, 0.0),
        (FINITE, "float32", 1e-6, 0.0),
        (FINITE, "float64", 1e-12, 0.7),
    ],
)
def test_every_check_of_verify_passes(sea, dtype, tolerance, choppiness):
    """Direct sum of all pairs by Dalzell's coefficients, seam, loop, energy, free surface."""
    water = ocean(sea=sea, dtype=dtype, choppiness=choppiness)
    checks = {check.name: check for check in fo.verify(water)}
    assert [check.name for check in checks.values() if not check.passed] == []
    assert {"kinematic condition", "dynamic condition"} <= set(checks)
    assert checks["height"].tolerance == pytest.approx(tolerance, rel=0.1)


def test_a_wrong_coefficient_is_found(monkeypatch):
    """A sign changed in the table, and verify says so by two ways."""
    from fftocean import bound_waves

    right = bound_waves.interaction

    def wrong(first, second, depth):
        pair = right(first, second, depth)
        return pair._replace(elevation=1.01 * pair.elevation)

    monkeypatch.setattr(bound_waves, "interaction", wrong)
    failed = {check.name for check in fo.verify(ocean()) if not check.passed}
    assert {"height", "kinematic condition", "dynamic condition"} <= failed


@pytest.mark.parametrize("n", [(64, 40), 33, (50, 7)])
def test_any_grid(n):
    """Also one that drops sums; the direct sum drops them too."""
    water = ocean(n=n, loop=None)
    frame = water.frame(2.5, tuple(FIELDS))
    x, y = np.meshgrid(water.grid.x, water.grid.y)
    truth = gerstner.surface(water, x, y, 2.5)
    for name in FIELDS:
        kind = max(np.abs(frame[f]).max() for f in FIELDS if f.split("_")[0] == name.split("_")[0])
        assert np.max(np.abs(frame[name] - getattr(truth, name))) < 1e-12 * kind, name


def test_no_pairs_are_the_linear_ocean_to_the_bit():
    water = ocean(bound=0)
    assert (water.order, water.bound, len(water.bound_waves)) == (2, 0, 0)
    assert equal(water.frame(1.1), water.linear().frame(1.1))
    linear = ocean(order=1)
    assert (linear.order, linear.bound, linear.bound_waves) == (1, 0, None)
    assert equal(linear.frame(1.1), water.frame(1.1))
    assert linear.linear() is linear


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_bits_do_not_depend_on_threads_or_on_what_else_is_asked(dtype):
    one = ocean(dtype=dtype).frame(2.0, tuple(FIELDS))
    for threads in (2, 3):
        assert equal(one, ocean(dtype=dtype, threads=threads).frame(2.0, tuple(FIELDS)))
    for name in FIELDS:
        assert np.array_equal(ocean(dtype=dtype).frame(2.0, (name,))[name], one[name]), name


def test_a_loop_repeats():
    """To the bit in frames; the sum over pairs at t and t + T to the roundings of omega T."""
    water = ocean(dtype="float32")
    assert equal(water.loop_frame(7, 30), water.loop_frame(7 + 30 * 10**9, 30))
    assert equal(water.frame(0.0), water.frame(60.0))
    fine = ocean()
    x, y = fine.grid.x[:40], fine.grid.y[:40]

    def second(t):
        both = (gerstner.surface(w, x, y, t).height for w in (fine, fine.linear()))
        return next(both) - next(both)

    assert np.max(np.abs(second(13.7) - second(73.7))) < 5e-15 * np.pi * fine.loop


def test_only_heights_and_what_follows_from_them_change():
    second, linear = ocean().frame(4.0, tuple(FIELDS)), ocean(order=1).frame(4.0, tuple(FIELDS))
    # the others share transforms with those that change, and their roundings
    changed = {name for name in FIELDS if np.max(np.abs(second[name] - linear[name])) > 1e-12}
    assert changed == {"height", "slope_x", "slope_y", "velocity_z"}
    assert float(np.mean(second.height)) == pytest.approx(0.0, abs=1e-15)


def test_a_finer_grid_shows_the_same_waves():
    """
    The strongest 200 waves are those of both; the linear part has more waves, and is subtracted.
    """
    coarse, fine = ocean(n=(96, 96)), ocean(n=(192, 192))
    at = [w.frame(3.0, ("height",)).height - w.linear().frame(3.0, ("height",)).height
          for w in (coarse, fine)]  # fmt: skip
    assert np.max(np.abs(at[1][::2, ::2] - at[0])) < 1e-13


def test_pickles_and_copies():
    water = ocean(dtype="float32")
    again = pickle.loads(pickle.dumps(water))
    assert (again.order, again.bound) == (2, 200)
    assert equal(again.frame(1.0), water.frame(1.0))
    assert len(pickle.dumps(water)) < 2 * len(pickle.dumps(water.linear()))  # without tables
    other = water.with_amplitudes(water.amplitudes, choppiness=0.5, bound=100)
    assert (other.order, other.bound, other.choppiness) == (2, 100, 0.5)
    assert equal(other.frame(1.0), ocean(dtype="float32", choppiness=0.5, bound=100).frame(1.0))


# limits


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"order": 3}, "order must be a whole number between 1 and 2, got 3"),
        ({"order": 2.0}, "order must be a whole number between 1 and 2, got 2.0"),
        ({"bound": -1}, "bound must be a whole number between 0 and 8192, got -1"),
        ({"bound": 10**6}, "bound must be a whole number between 0 and 8192, got 1000000"),
    ],
)
def test_impossible_arguments(given, message):
    with pytest.raises(fo.ParameterError, match=message):
        ocean(**given)
    with pytest.raises(fo.ParameterError, match=message):
        fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=10.0, **{"order": 2, **given})


@pytest.mark.parametrize(("ursell", "verdict"), [(0.1, "fine"), (0.6, "warned"), (4.0, "refused")])
def test_shallow_water(ursell, verdict):
    """
    One Stokes wave: eta2/eta1 = 3/4 a/(k^2 h^3) in shallow water, so 3/8 of Ursell's H/(k^2 h^3).
    """
    k, h = 2.0 * math.pi / 100.0, 1.0
    a = 0.5 * ursell * k**2 * h**3 * 2.0
    modes = [(1, 0, a, 0.0)]

    def make():
        return fo.Ocean.from_modes(modes, n=16, size=100.0, depth=h, order=2)

    if verdict == "refused":
        with pytest.raises(fo.ParameterError, match="for a depth of 1 m"):
            make()
        return
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        made = make()
    ratio = made.bound_waves.report.ratio
    assert ratio == pytest.approx(0.75 * a / (k**2 * h**3), rel=0.02)
    assert [w.category for w in caught] == ([fo.SeaWarning] if verdict == "warned" else [])
    if caught:
        assert caught[0].filename == __file__


def test_capillary_ripples_have_no_bound_waves():
    """Gravity alone is in the coefficients; at 0.1 m surface tension raises omega^2 by 3 %."""
    sea = fo.Sea.from_wind(speed=4.0, fetch=200.0)
    water = fo.Ocean(
        replace(sea, surface_tension=0.074), n=128, size=2.0, order=2, bound=8192, loop=None
    )
    parents, k = water.parents(), np.hypot(water.modes().kx, water.modes().ky)
    shortest = 2.0 * math.pi / np.hypot(parents.kx, parents.ky).max()
    assert shortest >= 0.1
    assert 0 < parents.kx.size == np.count_nonzero(k * 0.1 <= 2.0 * np.pi)


def test_sums_beyond_an_oblong_grid_are_those_of_the_grid_turned():
    """x and y change places: sums beyond 15 along one axis, beyond 5 along the other."""
    modes = [(9, 1, 0.3, 0.1), (8, -1, 0.2, 0.4), (4, 4, 0.3, 2.0), (3, 3, 0.2, 1.0)]
    given = {"size": 100.0, "choppiness": 0.0, "order": 2, "bound": 10}
    water, turned = (
        fo.Ocean.from_modes([(m[x], m[1 - x], *m[2:]) for m in modes], n=n, **given)
        for x, n in ((0, (32, 12)), (1, (12, 32)))
    )
    dropped = water.bound_waves.report.dropped
    assert 0.01 < dropped < 0.99
    assert turned.bound_waves.report.dropped == pytest.approx(dropped, rel=1e-9)
    wide = fo.Ocean.from_modes(modes, n=(32, 32), **given)
    assert 0.0 < wide.bound_waves.report.dropped < dropped


def test_sums_beyond_the_grid_are_reported():
    assert ocean().bound_waves.report.dropped < 1e-4
    assert ocean(n=24, bound=400).bound_waves.report.dropped > 0.01


# points


@pytest.mark.parametrize("sea", [SEA, FINITE], ids=["deep", "20 m"])
def test_queries(sea):
    """
    "exact" is the direct sum at the water that it finds; interpolation errors of the second-order
    part are those of waves of its length.
    """
    source, t = ocean(sea=sea, choppiness=0.6), 7.3
    x, y = np.random.default_rng(0).uniform(-1000.0, 1000.0, (2, 12))
    exact = fo.Query(source, mode="exact", level="frame").at(x, y, t)
    truth = gerstner.surface(source, exact.x0, exact.y0, t)
    assert np.max(np.abs(truth.x - x)) < 1e-9
    assert np.max(np.abs(truth.z - exact.heights)) < 1e-11
    assert np.max(np.abs(truth.normal - exact.normals)) < 1e-11
    assert np.max(np.abs(truth.velocity_z - exact.velocities[:, 2])) < 1e-11
    h = 1e-3  # the error of a central difference is h^2 omega^3 a/6
    ahead, behind = (
        gerstner.surface(source, exact.x0, exact.y0, t + step).velocity_z for step in (h, -h)
    )
    assert np.max(np.abs((ahead - behind) / (2.0 * h) - exact.accelerations[:, 2])) < 1e-5
    linear = fo.Query(source.linear(), mode="exact", level="frame").at(x, y, t)
    for mode, error in (("bilinear", 0.3), ("bicubic", 0.04)):
        one, other = (fo.Query(w, mode=mode).at(x, y, t) for w in (source, source.linear()))
        for name in ("heights", "velocities", "accelerations"):
            truth = exact[name] - linear[name]
            assert np.max(np.abs(one[name] - other[name] - truth)) < error * np.abs(truth).max()


def test_waves_that_a_hull_does_not_feel():
    """Bound waves shorter than `shortest` are left out in every mode."""
    source = ocean(loop=None)
    x, y = np.random.default_rng(1).uniform(0.0, 300.0, (2, 5))
    found = [
        fo.Query(source, mode=mode, shortest=60.0).at(x, y, 2.0, ("heights",)).heights
        for mode in ("exact", "bicubic")
    ]
    assert np.max(np.abs(found[0] - found[1])) < 2e-3
    assert np.max(np.abs(found[0] - fo.Query(source, mode="exact").at(x, y, 2.0).heights)) > 0.05


def test_windows_and_eulerian_frames():
    source, t = ocean(), 5.0
    window = fo.Window(source, n=24, size=60.0, x=33.0, y=-12.0)
    x, y = np.meshgrid(window.x + window.grid.x, window.y + window.grid.y)
    truth = [gerstner.surface(w, x, y, t).height for w in (source, source.linear())]
    shown = [
        fo.Window(w, n=24, size=60.0, x=33.0, y=-12.0).frame(t, ("height",)).height
        for w in (source, source.linear())
    ]
    second = truth[0] - truth[1]
    assert np.max(np.abs(shown[0] - shown[1] - second)) < 1e-3 * np.abs(second).max()
    frame = fo.Eulerian(source).frame(t)
    x, y = np.meshgrid(source.grid.x[::16], source.grid.y[::16])
    exact = fo.Query(source, mode="exact", level="frame").at(x, y, t, ("heights",)).heights
    assert np.max(np.abs(frame.height[::16, ::16] - exact)) < 1e-4


# below the surface


@pytest.mark.parametrize("sea", [SEA, FINITE], ids=["deep", "20 m"])
def test_kinematics(sea):
    """
    Central differences: Laplace's equation, no rotation, accelerations, Bernoulli's pressure with
    the velocity of the linear waves, and still water at the bed.
    """
    source, h = ocean(sea=sea, n=(48, 48), bound=60), 1e-2
    x, y, z, t = np.array([10.0, 140.0]), np.array([-30.0, 60.0]), np.array([-4.0, -9.0]), 6.0

    def at(dx=0.0, dy=0.0, dz=0.0, dt=0.0, order=None):
        return fo.kinematics.at(source, x + dx, y + dy, z + dz, t + dt, order=order)

    def slope(value, **step):
        back = {name: -size for name, size in step.items()}
        return (value(at(**step)) - value(at(**back))) / (2.0 * h)

    here = at()
    gradient = [slope(lambda found: found.velocities, **{name: h}) for name in ("dx", "dy", "dz")]
    divergence = sum(gradient[i][:, i] for i in range(3))
    size = max(np.abs(g).max() for g in gradient)
    assert np.max(np.abs(divergence)) < 1e-6 * size
    for i, j in ((0, 1), (1, 2), (2, 0)):
        assert np.max(np.abs(gradient[i][:, j] - gradient[j][:, i])) < 1e-6 * size
    rate = slope(lambda found: found.velocities, dt=h)
    assert np.max(np.abs(rate - here.accelerations)) < 1e-4 * np.abs(here.accelerations).max()

    def head(found_at):
        """-d potential/dt, of which the acceleration is minus the gradient."""
        one, other = found_at
        speed = np.sum(other.velocities**2, axis=1)
        return one.pressures / WATER_DENSITY + 0.5 * speed

    for i, name in enumerate(("dx", "dy", "dz")):
        ends = [head((at(**{name: s}), at(**{name: s}, order=1))) for s in (h, -h)]
        pushed = -(ends[0] - ends[1]) / (2.0 * h)
        assert np.max(np.abs(pushed - here.accelerations[:, i])) < 1e-4
    linear = at(order=1)
    assert np.max(np.abs(here.velocities - linear.velocities)) > 1e-3
    assert np.max(np.abs(at(order=2).velocities - here.velocities)) == 0.0
    plain = fo.kinematics.at(source.linear(), x, y, z, t)
    assert np.array_equal(linear.pressures, plain.pressures)
    if math.isfinite(sea.depth):
        bed = fo.kinematics.at(source, x, y, np.full(2, -sea.depth), t)
        assert np.max(np.abs(bed.velocities[:, 2])) < 1e-15


def test_kinematics_of_second_order_need_such_an_ocean():
    with pytest.raises(fo.ParameterError, match="order 2 needs an ocean or a cascade that has it"):
        fo.kinematics.at(ocean(order=1), 0.0, 0.0, -1.0, 0.0, order=2)


# statistics


def test_skewness():
    """
    Share of the specified skewness by the number of waves, on a tile of 500 m: FRONTIER's figures
    are sums over all pairs of that tile's waves; and the scatter of one seed is large.
    """
    wide = {"n": 128, "size": 500.0, "loop": None}
    for bound, resolved in ((125, 0.082), (500, 0.113), (1000, 0.1207)):
        found = fo.measure(ocean(bound=bound, **wide), frames=2).skewness
        assert found.specified == pytest.approx(0.130, abs=1.5e-3)
        assert found.resolved == pytest.approx(resolved, abs=1.5e-3)
        assert found.share == found.resolved / found.specified
    assert 0.0 < found.realised < 0.3
    assert fo.measure(ocean(order=1)).skewness is None


def test_the_report_is_that_of_frames():
    """
    Ratio of rms and skewness, as means over 300 frames. One frame of waves of fixed moduli scatters
    by 20 %, so the mean by 1.2 %.
    """
    water = ocean(n=96, bound=100, loop=None, choppiness=0.0, amplitudes="fixed", dtype="float32")
    linear, moments = water.linear(), np.zeros(3)
    for t in np.linspace(0.0, 30000.0, 300):
        first = linear.frame(t, ("height",)).height.astype(float)
        more = water.frame(t, ("height",)).height - first
        moments += [np.mean(first**2), np.mean(more**2), 3.0 * np.mean(first**2 * more)]
    m0, second, third = moments / 300
    report = water.bound_waves.report
    assert math.sqrt(second / m0) == pytest.approx(report.ratio, rel=0.04)
    assert third / m0**1.5 == pytest.approx(report.realised, rel=0.05)
    assert report.realised == pytest.approx(report.skewness, rel=1e-9)  # fixed moduli


def test_skewness_of_given_waves():
    """One Stokes wave: 3/2 C E^2 / E^1.5, in closed form, in frames and by the table."""
    a, k = 0.1, 2.0 * math.pi / 20.0
    for choppiness in (0.0, 1.0):
        water = fo.Ocean.from_modes(
            [(1, 0, a, 0.3)], n=(64, 4), size=20.0, order=2, dtype="float64", choppiness=choppiness
        )
        found = fo.measure(water).skewness
        truth = 1.5 * k * math.sqrt(0.5 * a**2)
        assert found.specified is None
        assert found.share == 0.0
        assert found.expected == pytest.approx(truth, rel=1e-12)
        # of the frames' own variance, and with terms of the next order
        assert found.realised == pytest.approx(truth, rel=2.0 * (k * a) ** 2)


# jobs, bakes, and what holds linear waves only


JOB = {"ocean.order": 2, "ocean.bound": 60, "ocean.n": 32, "bake.frames": 4, "bake.pictures": []}


def test_jobs_and_bakes(tmp_path):
    """The same bytes from one process and from workers; the manifest names the order."""
    job = builders.job({**JOB, "bake.maps": ["displacement", "normal", "velocity"]})
    assert (job.ocean().order, job.ocean().bound) == (2, 60)
    manifests = [
        fo.bake(job, tmp_path / name, executor=executor)
        for name, executor in (("one", "serial"), ("two", "processes"))
    ]
    files = [
        {file["path"]: file["sha256"] for frame in m["frames"] for file in frame["files"].values()}
        if isinstance(m, dict) and "files" in m["frames"][0]
        else None
        for m in manifests
    ]
    assert files[0] == files[1]
    manifest = json.loads((tmp_path / "one" / "manifest.json").read_text())
    assert manifest["job"]["ocean.order"] == 2
    assert (manifest["ocean"]["order"], manifest["ocean"]["bound"]) == (2, 60)
    assert 0.0 < manifest["statistics"]["skewness"]["resolved"] < 0.3
    assert fo.Job.from_toml("[ocean]\norder = 2\nbound = 5\nn = 16\n").ocean().bound == 5


@pytest.mark.filterwarnings("ignore::fftocean.SeaWarning")
def test_only_the_largest_tile_of_a_cascade_has_second_order():
    tiles = [(32, 200.0), (32, 33.0)]
    cascade = fo.Cascade(SEA, tiles, seed=3, order=2, bound=50)
    assert [tile.order for tile in cascade.oceans] == [2, 1]
    assert (cascade.order, cascade.bound, cascade.linear().order) == (2, 50, 1)
    assert equal(
        cascade.frame(1.0)[0],
        fo.Ocean(SEA, n=32, size=200.0, seed=3, order=2, bound=50, band=cascade.bands[0]).frame(
            1.0
        ),
    )
    x, y = np.array([12.0, -77.0]), np.array([3.0, 40.0])
    exact = fo.Query(cascade, mode="exact", level="frame").at(x, y, 2.0)
    truth = gerstner.surface(cascade.oceans[0], exact.x0, exact.y0, 2.0).height
    truth = truth + gerstner.surface(cascade.oceans[1], exact.x0, exact.y0, 2.0).height
    assert np.max(np.abs(exact.heights - truth)) < 1e-9  # the residual of the search


def test_what_holds_linear_waves_refuses_others(tmp_path):
    water = ocean(n=32, size=480.0)
    for use in (
        lambda: fo.export_sea(water, tmp_path / "sea"),
        lambda: fo.export.swd(water, tmp_path / "a.swd"),
        lambda: fo.export.components(water, tmp_path / "a.csv"),
        lambda: fo.export.openfast(water, None, tmp_path / "a", wave_mod=7),
        lambda: eight_fields(water, 0.0, 0.0, 0.0),
    ):
        with pytest.raises(fo.ParameterError, match=r"give (ocean|cascade).linear\(\)"):
            use()
    assert list(tmp_path.iterdir()) == []
    from fftocean.view.state import State

    with pytest.raises(fo.JobError, match=r"ocean\.order must be 1 for the live page"):
        State.of_job(builders.job(JOB))


def test_the_direct_sum_of_pairs_has_no_mean():
    """Opposite waves have a sum of no wavenumber, equal ones a difference: neither is a wave."""
    water = fo.Ocean.from_modes(
        [(2, 1, 0.2, 0.0), (-2, -1, 0.1, 1.0)], n=16, size=30.0, order=2, dtype="float64"
    )
    pairs = gerstner.bound.pairs(water.parents(), math.inf, 1.0)
    assert np.all(np.hypot(pairs.kx, pairs.ky) > 0.1)
    assert proof.verify(water)
    assert all(check.passed for check in proof.verify(water))
    assert set(EIGHT) <= set(water.frame(0.0).fields)
