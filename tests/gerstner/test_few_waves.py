"""
The classic few-wave models against their documents' formulas, written out again here, and against
the errors in them.
"""

import ast
import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

from fftocean import gerstner
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.gerstner import (
    CWR,
    PMS,
    SlideWaves,
    SteepnessWaves,
    TrochoidalWaves,
    Waves,
    WaveSurface,
    direction_of,
)

MODELS = {
    "PMS": PMS(period=6.0, number=4, direction=25.0, gain=1.3),
    "CWR": CWR(period=6.0, amplitude=0.4, direction=-40.0, steepness=0.7, tau=3.0),
    "steepness": SteepnessWaves(
        wavelength=[60.0, 31.0, 18.0], steepness=[0.25, 0.25, 0.2], direction=[45.0, 70.0, -10.0]
    ),
    "slides": SlideWaves(A=[0.8, 0.3], k=[0.2, 0.5], gamma=[0.4, -0.9], phi=[0.0, 1.1]),
    "trochoidal": TrochoidalWaves(
        a=[0.5, 0.2], kx=[0.15, 0.3], kz=[0.1, -0.2], phi=[0.3, 2.0], h=5.0, loop=20.0
    ),
}
SINGLE = {  # each 1.3 m high, 40 m long and toward 30 degrees, in deep water
    "CWR": CWR(
        number=1,
        period=2 * math.pi / math.sqrt(GRAVITY * 2 * math.pi / 40),
        amplitude=1.3,
        direction=30.0,
    ),
    "steepness": SteepnessWaves(wavelength=40.0, steepness=1.3 * 2 * math.pi / 40, direction=30.0),
    "slides": SlideWaves(A=1.3, k=2 * math.pi / 40, gamma=math.radians(30.0), phi=0.7),
    "trochoidal": TrochoidalWaves(
        a=1.3,
        kx=2 * math.pi / 40 * math.cos(math.pi / 6),
        kz=2 * math.pi / 40 * math.sin(math.pi / 6),
        phi=-2.0,
    ),
}
EAST, NORTH, UP = np.eye(3)
# phases here reach 1e2 rad, each good to 1e2 x 1.1e-16, over at most 4 waves of less than 1 m or
# slope 1: 1e-13
ROUNDING = 1e-12


@pytest.fixture(params=MODELS)
def waves(request) -> Waves:
    """The waves of one model."""
    return MODELS[request.param].waves


@pytest.fixture(params=SINGLE)
def single(request) -> Waves:
    """One wave, by four models."""
    return SINGLE[request.param].waves


def points(count=50):
    """Places and times all over."""
    return np.random.default_rng(3).uniform(
        [[-100.0], [-100.0], [0.1]], [[100.0], [100.0], [40.0]], (3, count)
    )


def displacement(w, x, y, t):
    """The formula of `Waves`, at once for all waves, for complex arguments too: (3, ...)."""
    theta = w.kx[:, None] * x + w.ky[:, None] * y - w.omega[:, None] * t - w.phase[:, None]
    k = np.sqrt(w.kx**2 + w.ky**2)
    grow = 1.0 - np.exp(-t / w.tau) if w.tau else 1.0
    shift_x, shift_y = (-(w.sharpness * w.amplitude * e / k) @ np.sin(theta) for e in (w.kx, w.ky))
    return grow * np.stack([shift_x, shift_y, w.amplitude @ np.cos(theta)])


def derivative(w, axis, x, y, t):
    """
    d displacement / d (x, y or t) by a complex step, which cancels nothing and so is as good as the
    formula itself.
    """
    step = 1e-30
    arguments = [x.astype(complex), y.astype(complex), t.astype(complex)]
    arguments[axis] += 1j * step
    return np.imag(displacement(w, *arguments)).T / step


# --- the surface that any few waves make


def test_position_is_the_formula(waves):
    x, y, t = points()
    s = waves.at(x, y, t)
    dx, dy, height = displacement(waves, x, y, t)
    for ours, right in [
        (s.displace_x, dx),
        (s.displace_y, dy),
        (s.height, height),
        (s.x, x + dx),
        (s.y, y + dy),
        (s.z, height),
    ]:
        np.testing.assert_allclose(ours, right, atol=ROUNDING, rtol=1e-15)
    np.testing.assert_array_equal(s.position, np.stack([s.x, s.y, s.z], axis=-1))


def test_tangents_are_the_derivatives_of_position(waves):
    x, y, t = points()
    s = waves.at(x, y, t)
    np.testing.assert_allclose(s.tangent_x, derivative(waves, 0, x, y, t) + EAST, atol=ROUNDING)
    np.testing.assert_allclose(s.tangent_y, derivative(waves, 1, x, y, t) + NORTH, atol=ROUNDING)


def test_velocity_is_the_rate_of_position(waves):
    x, y, t = points()
    velocity = waves.at(x, y, t).velocity
    np.testing.assert_allclose(velocity, derivative(waves, 2, x, y, t), atol=ROUNDING)
    half = 1e-4
    central = (waves.at(x, y, t + half).position - waves.at(x, y, t - half).position) / (2 * half)
    # omega^3 a half^2 / 6 is 3e-8 at most here, and the subtraction loses 100 x 2e-16 / 1e-4 =
    # 2e-10
    np.testing.assert_allclose(velocity, central, atol=1e-7)


def test_normal_is_unit_and_upward_across_both_tangents(waves):
    x, y, t = points()
    s = waves.at(x, y, t)
    assert s.jacobian.min() > 0.0
    np.testing.assert_allclose(np.linalg.norm(s.normal, axis=-1), 1.0, rtol=1e-15)
    for axis in (0, 1):
        tangent = derivative(waves, axis, x, y, t) + (EAST, NORTH)[axis]
        np.testing.assert_allclose(np.sum(s.normal * tangent, axis=-1), 0.0, atol=ROUNDING)
    assert s.normal[..., 2].min() > 0.0


def test_jacobian_is_the_area_of_a_patch():
    """
    Seen from above, a small triangle of particles covers J times its area at rest; the fold turns
    it over.
    """
    w = SteepnessWaves(wavelength=[50.0, 35.0], steepness=[0.7, 0.7], direction=[0.0, 50.0]).waves
    x, y, t = points(2000)
    side = 1e-5
    a, b, c = (w.at(x + dx, y + dy, t) for dx, dy in [(0, 0), (side, 0), (0, side)])
    area = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / side**2
    np.testing.assert_allclose(
        a.jacobian, area, atol=1e-5
    )  # the curvature a k^2 side = 1e-6, twice; rounding 3e-14/1e-5 = 3e-9
    assert a.jacobian.min() < -0.1
    assert a.jacobian.max() > 2.0
    np.testing.assert_array_equal(a.normal[..., 2] > 0.0, a.jacobian > 0.0)


def test_a_perfect_cusp_has_a_normal_anyway():
    """Both derivatives along x are 0 where q a k = 1: no tangent plane, and no NaN."""
    w = Waves(kx=[1.0], ky=[0.0], amplitude=[1.0], phase=[0.0], omega=[3.0], sharpness=[1.0])
    s = w.at([0.0, 1.0], 0.0, 0.0)
    assert s.jacobian[0] == 0.0
    np.testing.assert_array_equal(s.normal[0], UP)
    assert np.isfinite(s.normal).all()


def test_particles_of_a_deep_wave_go_round_in_circles(single):
    x, y, t = points()
    s = single.at(x, y, t)
    np.testing.assert_allclose(s.displace_x**2 + s.displace_y**2 + s.height**2, 1.3**2, rtol=1e-12)
    speed = 1.3 * math.sqrt(GRAVITY * 2 * math.pi / 40)
    np.testing.assert_allclose(np.linalg.norm(s.velocity, axis=-1), speed, rtol=1e-12)


def test_particles_over_a_bottom_go_round_in_ellipses():
    """Lamb 1932, art. 229: coth(kh) times as wide as high."""
    k, h, a = 0.3, 2.0, 0.4
    x, y, t = points()
    s = TrochoidalWaves(a=a, kx=k, h=h).waves.at(x, y, t)
    np.testing.assert_allclose(
        (s.displace_x * math.tanh(k * h)) ** 2 + s.height**2, a**2, rtol=1e-12
    )


def test_crests_are_sharper_than_troughs(single):
    """
    A trochoid is above the mean level over lambda/2 - 2 A of its length, and below it over lambda/2
    + 2 A; both reach A.
    """
    heading = math.radians(30.0)
    along = np.linspace(0.0, 40.0, 400001)
    s = single.at(along * math.cos(heading), along * math.sin(heading), 1.7)
    distance = s.x * math.cos(heading) + s.y * math.sin(heading)
    above = np.sum(np.diff(distance)[s.height[1:] > 0.0])
    assert above == pytest.approx(
        20.0 - 2 * 1.3, abs=4e-4
    )  # two edges, each within a sample of 1e-4 m, stretched up to 1.2 x
    assert s.height.max() == pytest.approx(1.3, abs=1e-8)
    assert s.height.min() == pytest.approx(-1.3, abs=1e-8)


def test_waves_run_along_their_wavevector(single):
    """
    The whole surface moves on at omega/k toward 30 degrees, and the water of a crest moves with it.
    """
    heading = np.array([math.cos(math.pi / 6), math.sin(math.pi / 6)])
    c = math.sqrt(GRAVITY * 40 / (2 * math.pi))
    x, y, t = points()
    later = 2.3
    before, after = (
        single.at(x, y, t),
        single.at(x + c * later * heading[0], y + c * later * heading[1], t + later),
    )
    np.testing.assert_allclose(after.height, before.height, atol=ROUNDING)
    np.testing.assert_allclose(after.displace_x, before.displace_x, atol=ROUNDING)
    high = before.height > 0.5
    assert np.all(before.velocity[high, :2] @ heading > 0.0)


def test_lengths_and_times_scale_together():
    """
    Froude: all lengths times 7 and all times times sqrt(7), at one g, is the same picture 7 times
        as large.

    Only a *unit* vector times an amplitude keeps that: a displacement q A k sin(theta) would not
    even be a length.
    """
    x, y, t = points()
    c = 7.0
    for name, small, large in [
        (
            "CWR",
            CWR(period=4.0, amplitude=0.3, tau=2.0),
            CWR(period=4.0 * c**0.5, amplitude=0.3 * c, tau=2.0 * c**0.5),
        ),
        ("PMS", PMS(period=4.0), PMS(period=4.0 * c**0.5)),
        (
            "slides",
            SlideWaves(A=0.3, k=0.7, gamma=0.4),
            SlideWaves(A=0.3 * c, k=0.7 / c, gamma=0.4),
        ),
        (
            "trochoidal",
            TrochoidalWaves(a=0.3, kx=0.7, h=1.5),
            TrochoidalWaves(a=0.3 * c, kx=0.7 / c, h=1.5 * c),
        ),
    ]:
        a, b = small.waves.at(x, y, t), large.waves.at(x * c, y * c, t * c**0.5)
        np.testing.assert_allclose(
            b.position, a.position * c, atol=1e-10, err_msg=name
        )  # positions reach 700 m, phases 1e3 rad
        np.testing.assert_allclose(b.normal, a.normal, atol=ROUNDING, err_msg=name)
        np.testing.assert_allclose(b.velocity, a.velocity * c**0.5, atol=1e-11, err_msg=name)


def test_shapes_broadcast():
    w = MODELS["PMS"].waves
    s = w.at(np.zeros((4, 1)), np.arange(3.0), 2)
    assert s.height.shape == s.x.shape == s.jacobian.shape == (4, 3)
    assert (
        s.normal.shape == s.velocity.shape == s.tangent_x.shape == s.y_up.normal.shape == (4, 3, 3)
    )
    times = w.at(1.0, 2.0, np.linspace(0, 9, 5))
    assert times.velocity.shape == (5, 3)
    one = w.at(1.0, 2.0, times.height.size - 0.5)
    assert np.shape(one.height) == ()
    assert one.normal.shape == (3,)
    np.testing.assert_allclose(
        w.at(1.0, 2.0, 9.0).position, times.position[-1], atol=1e-14
    )  # vector and scalar sines may differ
    assert w.at(np.zeros((0, 2)), 0.0, 0.0).normal.shape == (0, 2, 3)


def test_grid_is_the_surface_at_its_points():
    """
    [iy, ix] at ix Lx/nx, iy Ly/ny, as an `Ocean` has it; two whole waves across make the tile
    seamless.
    """
    lx, ly, nx, ny = 60.0, 40.0, 6, 5
    w = TrochoidalWaves(a=0.5, kx=2 * math.pi * 2 / lx, kz=-2 * math.pi * 3 / ly).waves
    g = w.grid((nx, ny), (lx, ly), 1.5)
    assert g.height.shape == (ny, nx)
    for iy, ix in [(0, 0), (4, 5), (2, 3)]:
        s = w.at(ix * lx / nx, iy * ly / ny, 1.5)
        np.testing.assert_allclose(g.position[iy, ix], s.position, rtol=1e-14)
    beyond = w.at(g.x0 + lx, g.y0 - ly, 1.5)
    np.testing.assert_allclose(beyond.height, g.height, atol=1e-13)  # phases of 20 rad
    np.testing.assert_allclose(beyond.displace_y, g.displace_y, atol=1e-13)
    square = w.grid(4, 60.0)
    np.testing.assert_array_equal(square.x0[2], [0.0, 15.0, 30.0, 45.0])
    np.testing.assert_array_equal(square.y0[:, 2], [0.0, 15.0, 30.0, 45.0])


def test_variance_is_that_of_the_height():
    """
    Over whole wavelengths, the mean square height at the parameters is sum a^2/2, exactly on a grid
    that resolves it.
    """
    w = TrochoidalWaves(a=[0.5, 0.2, 0.1], kx=[0.2, 0.4, 0.6], kz=[0.0, 0.2, -0.8]).waves
    assert w.variance == pytest.approx(0.5 * (0.25 + 0.04 + 0.01), rel=1e-15)
    assert np.mean(w.grid(16, 2 * math.pi / 0.2, 3.3).height ** 2) == pytest.approx(
        w.variance, rel=1e-13
    )


def test_values_are_frozen():
    """Models are compared and hashed by value; the columns of `Waves` cannot be written to."""
    assert SlideWaves(A=[1, 2], k=0.5) == SlideWaves(A=(1.0, 2.0), k=np.array([0.5, 0.5]))
    assert hash(PMS(period=5.0)) == hash(PMS(period=5.0, number=3))
    w = PMS(period=5.0).waves
    with pytest.raises(ValueError, match="read-only"):
        w.amplitude[0] = 9.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        w.tau = 3.0
    assert dataclasses.replace(w, tau=2.0).tau == 2.0
    assert len(w) == 3
    source = np.array([0.1])
    kept = Waves(kx=source, ky=[0.0], amplitude=[1.0], phase=[0.0], omega=[1.0], sharpness=[1.0])
    source[0] = 5.0
    assert kept.kx[0] == 0.1


def test_few_wave_models_share_no_code_with_the_fast_path():
    """
    Only plain values and checks are imported: no fields, transforms, ocean, kernels, grid, nor the
    dispersion.
    """
    folder = Path(gerstner.__file__).parent
    models = [path for path in folder.glob("*.py") if path.stem not in ("direct", "compiled")]
    assert len(models) >= 8
    for path in models:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        modules = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
        modules |= {
            a.name for node in ast.walk(tree) if isinstance(node, ast.Import) for a in node.names
        }
        ours = {name for name in modules if name.startswith("fftocean")}
        low = {f"fftocean.{name}" for name in ("arrays", "constants", "errors", "host", "limits")}
        assert {name for name in ours if not name.startswith("fftocean.gerstner.")} <= low


# --- the start


def test_the_start_is_from_a_flat_sea_at_rest():
    """
    At t = 0 nothing is displaced, up or sideways; before, nothing moves; long after, nothing is
    left of the start.
    """
    model = CWR(period=6.0, amplitude=0.4, tau=3.0)
    x, y, _ = points()
    s = model.waves.at(x, y, 0.0)
    for name in (
        "height",
        "displace_x",
        "displace_y",
        "slope_x",
        "slope_y",
        "stretch_xx",
        "stretch_xy",
        "stretch_yy",
    ):
        np.testing.assert_array_equal(getattr(s, name), 0.0, err_msg=name)
    np.testing.assert_array_equal(s.normal, np.broadcast_to(UP, (50, 3)))
    before = model.waves.at(x, y, -1.0)
    np.testing.assert_array_equal(before.position, s.position)
    np.testing.assert_array_equal(before.velocity, 0.0)
    always = dataclasses.replace(model, tau=0.0).waves
    np.testing.assert_array_equal(
        model.waves.at(x, y, 200.0).position, always.at(x, y, 200.0).position
    )  # e^-66 is below eps
    np.testing.assert_array_equal(
        model.waves.at(x, y, 200.0).velocity, always.at(x, y, 200.0).velocity
    )


def test_the_start_grows_as_documented():
    """
    Height (1 - e^{-t/tau}) times the full one: VRX note, equation 4; and its horizontal motion
    likewise.
    """
    model = CWR(period=6.0, amplitude=0.4, tau=3.0)
    x, y, t = points()
    grown, full = model.waves.at(x, y, t), dataclasses.replace(model, tau=0.0).waves.at(x, y, t)
    for name in ("height", "displace_x", "displace_y"):
        np.testing.assert_allclose(
            getattr(grown, name),
            (1 - np.exp(-t / 3.0)) * getattr(full, name),
            atol=1e-15,
            err_msg=name,
        )
    first = model.waves.at(x, y, 0.0)
    always = dataclasses.replace(model, tau=0.0).waves.at(x, y, 0.0)
    np.testing.assert_allclose(
        first.velocity_z, always.height / 3.0, rtol=1e-15
    )  # the jump that the docstring owns up to
    np.testing.assert_allclose(first.velocity_x, always.displace_x / 3.0, rtol=1e-15)


def test_erratum_start_of_height_alone_leaves_the_grid_displaced():
    """
    VRX note: equation 4 grows z only, while equation 1 still displaces x by up to sum q A at t = 0.
    """
    w = CWR(period=6.0, amplitude=0.4, tau=3.0).waves
    x, y, _ = points()
    printed = displacement(dataclasses.replace(w, tau=0.0), x, y, 0.0)[:2]
    assert np.abs(printed).max() > 0.5 * np.sum(w.sharpness * w.amplitude)
    assert np.abs(w.at(x, y, 0.0).position - np.stack([x, y, 0 * x], axis=-1)).max() == 0.0


# --- VRX: Pierson-Moskowitz sampling
# -----------------------------------------------------------------------------------------


def pierson_moskowitz(omega, peak, g=GRAVITY):
    """VRX note, equation 5."""
    return 8.1e-3 * g**2 / omega**5 * np.exp(-5 / 4 * (peak / omega) ** 4)


def test_pms_makes_the_known_figures():
    """
    N = 3, 5 s, s = 1.5, g = 9.81: worked by hand from equations 5 to 9, Delta_1 corrected; four
    figures are given.
    """
    model = PMS(number=3, period=5.0, scale=1.5, gravity=9.81)
    np.testing.assert_allclose(model.omega, [0.8378, 1.2566, 1.8850], atol=5e-5)
    np.testing.assert_allclose(model.waves.amplitude, [0.0532, 0.2732, 0.1793], atol=5e-5)
    np.testing.assert_allclose(model.waves.omega, model.omega)


def test_pms_is_the_printed_algorithm():
    """Equations 5 to 9 of the VRX note, one by one, with (s - 1/s)/2 for the middle spacing."""
    s, gain, q, theta, a, g = 1.7, 0.8, 0.6, 20.0, 0.3, 9.7
    model = PMS(
        period=7.0, scale=s, gain=gain, steepness=q, direction=theta, angle=a, tau=4.0, gravity=g
    )
    peak = 2 * math.pi / 7.0
    spacing = [peak * (1 - 1 / s), peak * (s - 1 / s) / 2, peak * (s - 1)]
    w = model.waves
    for i in range(3):
        omega = s ** (i - (3 - 1) / 2) * peak
        amplitude = gain * math.sqrt(2 * pierson_moskowitz(omega, peak, g) * spacing[i])
        k = omega**2 / g
        heading = math.radians(theta) + (i - 1) * a
        assert w.omega[i] == pytest.approx(omega, rel=1e-15)
        assert w.amplitude[i] == pytest.approx(amplitude, rel=1e-14)
        assert w.kx[i] == pytest.approx(k * math.cos(heading), rel=1e-14)
        assert w.ky[i] == pytest.approx(k * math.sin(heading), rel=1e-14)
        assert w.sharpness[i] == pytest.approx(min(1.0, q / (amplitude * k * 3)), rel=1e-14)
    assert w.tau == 4.0
    np.testing.assert_array_equal(w.phase, 0.0)
    np.testing.assert_allclose(model.spacing, spacing, rtol=1e-14)


def test_pms_spacing_is_half_the_distance_of_the_neighbours():
    for number in (2, 3, 6, 11):
        model = PMS(period=5.0, number=number, scale=1.2)
        omega = model.omega
        np.testing.assert_allclose(model.spacing[1:-1], (omega[2:] - omega[:-2]) / 2, rtol=1e-13)
        assert model.spacing[0] == pytest.approx(omega[1] - omega[0], rel=1e-13)
        assert model.spacing[-1] == pytest.approx(omega[-1] - omega[-2], rel=1e-13)
        assert np.exp(np.mean(np.log(omega))) == pytest.approx(model.peak, rel=1e-14)
    alone = PMS(period=5.0, number=1, scale=1.5)
    assert alone.omega == pytest.approx([alone.peak], rel=1e-15)
    assert alone.spacing == pytest.approx([alone.peak * (1.5 - 1 / 1.5) / 2], rel=1e-15)


def test_erratum_pms_middle_spacing():
    """
    VRX note, equation 8: omega_p (s - 1/s)/s, where half the distance from omega_p/s to s omega_p
    has 2 below the line.

    They agree at s = 2 only; at 1.5 the middle wave would be 0.3155 m instead of 0.2732 m, and
    three waves would carry more than the whole sea.
    """
    for s, ratio in [(2.0, 1.0), (1.5, math.sqrt(2 / 1.5)), (1.1, math.sqrt(2 / 1.1))]:
        model = PMS(period=5.0, scale=s, gravity=9.81)
        printed = math.sqrt(
            2 * pierson_moskowitz(model.peak, model.peak, 9.81) * model.peak * (s - 1 / s) / s
        )
        assert printed / model.waves.amplitude[1] == pytest.approx(ratio, rel=1e-14)
    right = PMS(period=5.0, scale=1.5, gravity=9.81)
    a = right.waves.amplitude
    m0 = 8.1e-3 * 9.81**2 / (5 * right.peak**4)
    assert 0.5 * (a[0] ** 2 + 0.3155**2 + a[2] ** 2) / m0 == pytest.approx(1.075, abs=0.001)
    assert right.energy_kept == pytest.approx(0.8767, abs=5e-5)


def test_pms_reports_the_energy_it_keeps():
    """sum A^2/2 against the integral of gain^2 S, by quadrature."""
    for number, scale, gain in [(3, 1.5, 1.0), (3, 2.0, 1.0), (1, 1.5, 2.0), (5, 1.5, 0.5)]:
        model = PMS(period=8.0, number=number, scale=scale, gain=gain)
        m0, _ = integrate.quad(
            lambda x, p=model.peak: p * pierson_moskowitz(p * x, p), 0.01, np.inf
        )
        assert model.energy_kept == pytest.approx(
            model.waves.variance / (gain**2 * m0), rel=1e-7
        )  # quad: 1.5e-8
    assert [round(PMS(period=8.0, scale=s).energy_kept, 2) for s in (1.1, 1.5, 2.0)] == [
        0.39,
        0.88,
        1.22,
    ]  # as the docstring says
    assert PMS(period=8.0, gain=3.0).waves.variance == pytest.approx(
        9 * PMS(period=8.0).waves.variance, rel=1e-14
    )


def test_pms_tends_to_the_whole_sea():
    """
    From 0.14 to 7.2 omega_p all but 4e-4 is in reach (S falls as omega^-5); the midpoint rule
    leaves (ln s)^2 of a smooth curve.
    """
    kept = [
        PMS(period=8.0, number=n, scale=50.0 ** (2 / n)).energy_kept for n in (16, 64, 256, 1000)
    ]
    assert abs(kept[-1] - 1.0) < 6e-4
    assert abs(kept[-2] - 1.0) < 6e-4


def test_pms_depends_on_period_as_the_sea_does():
    """
    omega_p^-5 from S and omega_p from Delta: amplitudes go with the square of the period, steepness
    of waves stays.
    """
    a, b = PMS(period=4.0).waves, PMS(period=8.0).waves
    np.testing.assert_allclose(b.amplitude, 4 * a.amplitude, rtol=1e-13)
    np.testing.assert_allclose(b.amplitude * b.wavenumber, a.amplitude * a.wavenumber, rtol=1e-13)


# --- VRX: constant wavelength-amplitude ratio
# --------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [1, 2, 3, 4, 7])
def test_cwr_is_the_printed_algorithm(number):
    """Algorithm 1 of the VRX note, line by line, with n = i - (N-1)/2."""
    period, mean_a, s, theta_d, a, q, g = 5.0, 0.5, 1.8, math.radians(70.0), 0.25, 0.9, 9.81
    w = CWR(
        number=number,
        period=period,
        amplitude=mean_a,
        scale=s,
        direction=70.0,
        angle=a,
        steepness=q,
        gravity=g,
    ).waves
    mean_omega = 2 * math.pi / period
    mean_k = mean_omega**2 / g
    for i in range(number):
        n = i - (number - 1) / 2
        amplitude, k = mean_a * s**n, mean_k / s**n
        assert w.amplitude[i] == pytest.approx(amplitude, rel=1e-14)
        assert w.wavenumber[i] == pytest.approx(k, rel=1e-14)
        assert w.omega[i] == pytest.approx(mean_omega / math.sqrt(s**n), rel=1e-14)
        assert 2 * math.pi / w.omega[i] == pytest.approx(period * math.sqrt(s**n), rel=1e-14)
        assert math.remainder(
            math.atan2(w.ky[i], w.kx[i]) - theta_d - n * a, 2 * math.pi
        ) == pytest.approx(0.0, abs=1e-14)
        assert w.sharpness[i] == pytest.approx(min(1.0, q / (amplitude * k * number)), rel=1e-13)
    np.testing.assert_array_equal(w.phase, 0.0)


def test_cwr_keeps_the_ratio_of_amplitude_to_wavelength():
    """
    So A_i k_i is one number, and with it q_i: the algorithm's q / (A_i k_i N) does not depend on i.
    """
    w = CWR(number=5, period=5.0, amplitude=2.0).waves
    np.testing.assert_allclose(
        w.amplitude * w.wavenumber, 2.0 * (2 * math.pi / 5) ** 2 / GRAVITY, rtol=1e-14
    )
    np.testing.assert_allclose(
        w.sharpness, 1 / (5 * 2.0 * (2 * math.pi / 5) ** 2 / GRAVITY), rtol=1e-14
    )
    gentle = CWR(number=5, period=5.0, amplitude=0.1).waves
    np.testing.assert_array_equal(gentle.sharpness, 1.0)


@pytest.mark.parametrize("number", [1, 2, 3, 4, 7])
def test_erratum_cwr_is_centred_on_the_median(number):
    """
    VRX note, algorithm 1: n = i - N/2 makes every wave s^(1/2) too short and too low; the
    parameters are the *median*.
    """
    w = CWR(number=number, period=5.0, amplitude=0.5, scale=2.0).waves
    period = 2 * math.pi / w.omega
    assert np.median(np.log(period)) == pytest.approx(math.log(5.0), abs=1e-14)
    assert np.median(np.log(w.amplitude)) == pytest.approx(math.log(0.5), abs=1e-14)
    printed = 0.5 * 2.0 ** (np.arange(number) - number / 2)
    np.testing.assert_allclose(w.amplitude / printed, 2.0**0.5, rtol=1e-14)


def test_erratum_gain_belongs_to_pms_and_amplitude_to_cwr():
    """
    VRX note, 2.1, says under *amplitude* "CWR: not used", "PMS: the median amplitude"; sections 2.2
    and 2.3 do the opposite.
    """
    with pytest.raises(TypeError, match="amplitude"):
        PMS(period=5.0, amplitude=1.0)
    with pytest.raises(TypeError, match="gain"):
        CWR(period=5.0, amplitude=1.0, gain=2.0)
    np.testing.assert_allclose(
        PMS(period=5.0, gain=2.5).waves.amplitude, 2.5 * PMS(period=5.0).waves.amplitude, rtol=1e-15
    )
    assert CWR(period=5.0, amplitude=0.7).waves.amplitude[1] == 0.7


def test_erratum_horizontal_displacement_is_along_a_unit_vector():
    """
    VRX note, equation 1: x = x0 - sum q A sin(..) sets a vector equal to a number; k for the unit
    vector would multiply it by |k|.
    """
    w = CWR(number=1, period=5.0, amplitude=0.5, direction=40.0).waves
    x, y, t = points()
    s = w.at(x, y, t)
    shift = 0.5 * np.sin(w.kx[0] * x + w.ky[0] * y - w.omega[0] * t)
    along = s.displace_x * math.cos(math.radians(40.0)) + s.displace_y * math.sin(
        math.radians(40.0)
    )
    np.testing.assert_allclose(along, -shift, atol=ROUNDING)
    printed_with_k = -np.hypot(w.kx[0] * shift, w.ky[0] * shift)
    assert np.abs(printed_with_k).max() < 0.2 * np.abs(along).max()  # |k| is 0.16 rad/m


@pytest.mark.parametrize("steepness", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("number", [1, 2, 3, 8])
@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_vrx_waves_do_not_fold(steepness, number, angle):
    """
    sum q A k <= q, so both eigenvalues of the horizontal map are at least 1 - q wherever the crests
    meet: J >= (1 - q)^2.
    """
    for model in (
        PMS(period=5.0, number=number, angle=angle, steepness=steepness, gain=20.0),
        CWR(period=5.0, number=number, amplitude=5.0, angle=angle, steepness=steepness),
    ):
        w = model.waves
        assert np.sum(w.sharpness * w.amplitude * w.wavenumber) <= steepness + 1e-14
        j = w.grid(40, 60.0).jacobian
        assert j.min() >= (1.0 - steepness) ** 2 - 1e-14
        assert j[0, 0] == pytest.approx(
            j.min(), abs=1e-14
        )  # the phases are 0: all crests meet at the origin
    if steepness == 0.0:
        np.testing.assert_array_equal(w.at(*points()).displace_x, 0.0)


def test_vrx_defaults_are_plain_gerstner_waves_in_an_ordinary_sea():
    """With steepness 1 and A k N < 1 every particle keeps its circle: q_i = 1."""
    np.testing.assert_array_equal(PMS(period=5.0).waves.sharpness, 1.0)


# --- CS175: waves by steepness


def cs175(wavelength, steepness, direction, x, z, t, g=GRAVITY):
    """
    CS175 final project, section 2: the offset of P, and the tangent and binormal less their leading
    1, for one wave; y up.
    """
    dx, dz = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    k = 2 * math.pi / wavelength
    a, s = steepness / k, steepness
    f = k * ((dx * x + dz * z) - math.sqrt(g / k) * t)
    offset = np.stack([dx * a * np.cos(f), a * np.sin(f), dz * a * np.cos(f)], axis=-1)
    tangent = np.stack(
        [-(dx**2) * s * np.sin(f), dx * s * np.cos(f), -dx * dz * s * np.sin(f)], axis=-1
    )
    binormal = np.stack(
        [-dx * dz * s * np.sin(f), dz * s * np.cos(f), -(dz**2) * s * np.sin(f)], axis=-1
    )
    return offset, tangent, binormal


def test_steepness_waves_are_the_printed_formulas():
    """
    One wave as printed, three as the sum of their offsets; in the document's frame, to which `y_up`
    leads back.
    """
    x, z, t = points()
    for columns in [
        ([40.0], [0.5], [35.0]),
        ([60.0, 31.0, 18.0], [0.25, 0.25, 0.2], [45.0, 70.0, -10.0]),
    ]:
        s = SteepnessWaves(
            wavelength=columns[0], steepness=columns[1], direction=columns[2]
        ).waves.at(x, z, t)
        offset, tangent, binormal = sum(
            np.array(cs175(*wave, x, z, t)) for wave in zip(*columns, strict=True)
        )
        tangent, binormal = tangent + EAST, binormal + UP  # z, across, is third here
        np.testing.assert_allclose(
            s.y_up.position, np.stack([x, 0 * x, z], axis=-1) + offset, atol=ROUNDING
        )
        np.testing.assert_allclose(s.y_up.tangent, tangent, atol=ROUNDING)
        np.testing.assert_allclose(s.y_up.binormal, binormal, atol=ROUNDING)
        normal = np.cross(binormal, tangent)
        np.testing.assert_allclose(
            s.y_up.normal, normal / np.linalg.norm(normal, axis=-1, keepdims=True), atol=ROUNDING
        )
        np.testing.assert_allclose(s.normal, s.y_up.normal[..., [0, 2, 1]], atol=0)


def test_steepness_one_is_a_cusp():
    w = SteepnessWaves(wavelength=20.0, steepness=1.0).waves
    x = np.linspace(0.0, 20.0, 2001)
    assert w.at(x, 0.0, 0.0).jacobian.min() == pytest.approx(0.0, abs=1e-15)
    assert x[np.argmin(w.at(x, 0.0, 0.0).jacobian)] == pytest.approx(
        5.0
    )  # f = pi/2, where A sin f is highest
    assert SteepnessWaves(wavelength=20.0, steepness=1.2).waves.at(
        5.0, 0.0, 0.0
    ).jacobian == pytest.approx(-0.2, abs=1e-14)


def test_erratum_troughs_are_flatter_not_deeper():
    """
    CS175: "sharper peaks and deeper troughs". Both are A from the mean level; the trough is the
        broader and flatter.
    """
    k, steepness = 2 * math.pi / 20, 0.6
    w = SteepnessWaves(wavelength=20.0, steepness=steepness).waves
    crest, trough = w.at(5.0, 0.0, 0.0), w.at(15.0, 0.0, 0.0)
    assert crest.height == pytest.approx(steepness / k, rel=1e-15)
    assert trough.height == pytest.approx(-steepness / k, rel=1e-15)
    # curvature d2z/dx2 of (x0 - A sin, A cos) is -+ A k^2 / (1 -+ A k)^2 at crest and trough
    for at, right in [
        (5.0, -steepness * k / (1 - steepness) ** 2),
        (15.0, steepness * k / (1 + steepness) ** 2),
    ]:
        left, right_side = w.at(at - 1e-4, 0.0, 0.0), w.at(at + 1e-4, 0.0, 0.0)
        slopes = [s.slope_x / (1 + s.stretch_xx) for s in (left, right_side)]
        assert (slopes[1] - slopes[0]) / (right_side.x - left.x) == pytest.approx(
            right, rel=1e-6
        )  # next order: (k 1e-4)^2 x 30


# --- Bailey's slides


def slides(waves, x, z, t, g=GRAVITY):
    """The equations of the slides with theta's second y read as z: x', y', z'."""
    new = [np.array(x), 0 * x, np.array(z)]
    for a, k, gamma, phi in waves:
        theta = k * math.cos(gamma) * x + k * math.sin(gamma) * z - math.sqrt(g * k) * t - phi
        new[0] = new[0] - a * math.cos(gamma) * np.sin(theta)
        new[1] = new[1] + a * np.cos(theta)
        new[2] = new[2] - a * math.sin(gamma) * np.sin(theta)
    return np.stack(new, axis=-1)


def shader(waves, x, z, t, g=1.0, corrected=False):
    """
    gerstner.vert of the slides, for any number of waves: position, ta and tb.

    Corrected: the signs of theta, of the displacement and of the derivatives, and += for the
        tangents' =.
    """
    zero, one = np.zeros_like(x), np.ones_like(x)
    new, ta, tb = np.stack([x, zero, z]), np.stack([one, zero, zero]), np.stack([zero, zero, one])
    across = 1 if corrected else -1  # of z in theta
    for a, k, gamma, phi in waves:
        theta = (
            x * k * math.cos(gamma) + across * z * k * math.sin(gamma) - math.sqrt(g * k) * t - phi
        )
        c, s = math.cos(gamma), math.sin(gamma)
        sign = -1 if corrected else 1
        new = new + np.stack(
            [sign * a * c * np.sin(theta), a * np.cos(theta), sign * a * s * np.sin(theta)]
        )
        along = np.stack(
            [
                sign * a * c * np.cos(theta),
                (1 if not corrected else -1) * a * np.sin(theta),
                sign * a * s * np.cos(theta),
            ]
        )
        if corrected:
            ta, tb = ta + along * k * c, tb + along * k * s
        else:
            ta, tb = along * k * c, along * k * s
    return (np.moveaxis(v, 0, -1) for v in (new, ta, tb))


TWO = ((0.8, 0.2, 0.4, 0.0), (0.3, 0.5, -0.9, 1.1))
COLUMNS = dict(zip(("A", "k", "gamma", "phi"), zip(*TWO, strict=True), strict=True))


def test_slide_waves_are_the_printed_equations():
    x, z, t = points()
    s = SlideWaves(**COLUMNS).waves.at(x, z, t)
    np.testing.assert_allclose(s.y_up.position, slides(TWO, x, z, t), atol=ROUNDING)


def test_slide_waves_have_the_corrected_shader_s_tangents_and_normal():
    """With G = 1, as the shader has it; and its cross(tb, ta) is upward, in a y-up frame."""
    x, z, t = points()
    s = SlideWaves(**COLUMNS, gravity=1.0).waves.at(x, z, t).y_up
    position, ta, tb = shader(TWO, x, z, t, corrected=True)
    np.testing.assert_allclose(s.position, position, atol=ROUNDING)
    np.testing.assert_allclose(s.tangent, ta, atol=ROUNDING)
    np.testing.assert_allclose(s.binormal, tb, atol=ROUNDING)
    normal = np.cross(tb, ta)
    np.testing.assert_allclose(
        s.normal, normal / np.linalg.norm(normal, axis=-1, keepdims=True), atol=ROUNDING
    )
    assert s.normal[:, 1].min() > 0.0


def test_erratum_slides_shader_has_no_normal():
    """
    = for += keeps only the last wave's part of ta and tb, without their 1: two vectors along one
    line, and cross() = 0.
    """
    x, z, t = points()
    _, ta, tb = shader(TWO, x, z, t)
    assert (
        np.linalg.norm(np.cross(tb, ta), axis=-1).max() < 1e-17
    )  # the sines of parallel vectors of length 0.1
    _, ta, tb = shader(TWO, x, z, t, corrected=True)
    assert np.linalg.norm(np.cross(tb, ta), axis=-1).min() > 0.5
    head_on = ((0.8, 0.2, 0.0, 0.0),)
    _, _, tb = shader(head_on, x, z, t)
    np.testing.assert_array_equal(tb, 0.0)  # the slides' own first example, gamma = 0


def test_erratum_slides_shader_inverts_crests():
    """
    += A cos(gamma) sin(theta), where the equation says minus: the wave toward +x is above the mean
    level *more* than half the way.
    """
    a, k = 1.3, 2 * math.pi / 40
    x = np.linspace(0.0, 40.0, 400001)
    position, _, _ = shader(((a, k, 0.0, 0.0),), x, 0 * x, 0 * x)
    above = np.sum(np.diff(position[:, 0])[position[1:, 1] > 0.0])
    assert above == pytest.approx(20.0 + 2 * a, abs=4e-4)
    ours = SlideWaves(A=a, k=k).waves.at(x, 0.0, 0.0)
    assert np.sum(np.diff(ours.x)[ours.height[1:] > 0.0]) == pytest.approx(20.0 - 2 * a, abs=4e-4)


def test_erratum_slides_shader_s_derivatives_are_not_its_surface_s():
    """
    y = A cos(theta) has dy/dtheta = -A sin(theta), not +; and theta has -k sin(gamma) z where
    dtheta/dz has +k sin(gamma).
    """
    wave = ((0.8, 0.2, 0.4, 0.0),)
    x, z, t = points()
    half = 1e-5

    def slope(axis, corrected):
        ends = [
            next(shader(wave, x + d * (axis == 0), z + d * (axis == 2), t, corrected=corrected))[
                :, 1
            ]
            for d in (half, -half)
        ]
        return (ends[0] - ends[1]) / (2 * half)

    _, ta, tb = shader(wave, x, z, t)
    np.testing.assert_allclose(
        ta[:, 1], -slope(0, False), atol=1e-9
    )  # rounding 1e-16/1e-5, and k^3 half^2
    np.testing.assert_allclose(tb[:, 1], slope(2, False), atol=1e-9)  # two wrong signs
    _, ta, tb = shader(wave, x, z, t, corrected=True)
    np.testing.assert_allclose(ta[:, 1], slope(0, True), atol=1e-9)
    np.testing.assert_allclose(tb[:, 1], slope(2, True), atol=1e-9)


def test_erratum_slides_theta_is_of_x_and_z():
    """
    The slides print theta = k cos(gamma) x + k sin(gamma) y: y is up, 0 on the mesh, so no wave
    would go toward z.
    """
    w = SlideWaves(A=0.5, k=0.3, gamma=math.pi / 2).waves
    along_z = w.at(0.0, np.linspace(0.0, 20.0, 50), 0.0)
    assert np.ptp(along_z.height) > 0.9
    printed = 0.5 * np.cos(
        0.3 * math.cos(math.pi / 2) * 0.0 + 0.3 * math.sin(math.pi / 2) * np.zeros(50)
    )
    assert np.ptp(printed) == 0.0


def test_erratum_slides_gravity():
    """G = 1 makes every wave sqrt(9.80665) times too slow; the equations' g is gravity."""
    earth, shader_g = SlideWaves(A=0.5, k=0.3).waves, SlideWaves(A=0.5, k=0.3, gravity=1.0).waves
    assert earth.omega / shader_g.omega == pytest.approx(math.sqrt(GRAVITY), rel=1e-15)
    assert earth.omega == pytest.approx(math.sqrt(GRAVITY * 0.3), rel=1e-15)


# --- Wikipedia: the trochoidal surface over a bottom


def test_trochoidal_waves_are_the_printed_formulas():
    """xi, zeta and eta of the article, summed wave by wave."""
    h = 3.0
    components = [(0.5, 0.15, 0.1, 0.3), (0.2, 0.3, -0.2, 2.0), (0.1, -0.6, 0.0, 0.0)]
    a, kx, kz, phi = (list(column) for column in zip(*components, strict=True))
    alpha, beta, t = points()
    s = TrochoidalWaves(a=a, kx=kx, kz=kz, phi=phi, h=h).waves.at(alpha, beta, t)
    xi, zeta, eta = alpha.copy(), 0 * alpha, beta.copy()
    for a_m, kx_m, kz_m, phi_m in components:
        k_m = math.sqrt(kx_m**2 + kz_m**2)
        omega_m = math.sqrt(GRAVITY * k_m * math.tanh(k_m * h))
        theta = kx_m * alpha + kz_m * beta - omega_m * t - phi_m
        xi -= kx_m / k_m * a_m / math.tanh(k_m * h) * np.sin(theta)
        eta -= kz_m / k_m * a_m / math.tanh(k_m * h) * np.sin(theta)
        zeta += a_m * np.cos(theta)
    np.testing.assert_allclose(s.y_up.position, np.stack([xi, zeta, eta], axis=-1), atol=ROUNDING)


def test_trochoidal_waves_tend_to_deep_water():
    x, y, t = points()
    columns = {"a": [0.5, 0.2], "kx": [0.15, 0.3], "kz": [0.1, -0.2]}
    deep = TrochoidalWaves(**columns).waves.at(x, y, t)
    deeper = TrochoidalWaves(**columns, h=150.0).waves.at(x, y, t)  # tanh(27) is 1 to the last bit
    np.testing.assert_array_equal(deeper.position, deep.position)
    shallow = TrochoidalWaves(a=0.01, kx=0.15, h=0.05).waves
    assert shallow.omega / 0.15 == pytest.approx(
        math.sqrt(GRAVITY * 0.05), rel=1e-5
    )  # c = sqrt(g h), less (kh)^2/6 of itself
    as_slides = SlideWaves(A=0.5, k=math.hypot(0.15, 0.1), gamma=math.atan2(0.1, 0.15)).waves.at(
        x, y, t
    )
    np.testing.assert_allclose(
        TrochoidalWaves(a=0.5, kx=0.15, kz=0.1).waves.at(x, y, t).position,
        as_slides.position,
        atol=ROUNDING,
    )


def test_trochoidal_waves_close_their_loop():
    """
    Every field is the same a loop later; each frequency is the nearest multiple of 2 pi/T, and at
    least one.
    """
    loop = 12.0
    k = np.array([0.002, 0.05, 0.15, 0.3, 2.0])
    columns = {"a": 0.1, "kx": (k * 0.8).tolist(), "kz": (k * 0.6).tolist(), "h": 20.0}
    w, free = TrochoidalWaves(**columns, loop=loop).waves, TrochoidalWaves(**columns).waves
    turns = w.omega * loop / (2 * math.pi)
    np.testing.assert_allclose(turns, np.rint(turns), rtol=1e-14)
    assert turns[0] == pytest.approx(1.0, rel=1e-15)
    assert free.omega[0] < 0.5 * 2 * math.pi / loop
    assert np.all(np.abs(w.omega - free.omega)[1:] <= math.pi / loop)
    x, y, t = points()
    now, later = w.at(x, y, t), w.at(x, y, t + loop)
    for name in (field.name for field in dataclasses.fields(WaveSurface)):
        np.testing.assert_allclose(
            getattr(later, name), getattr(now, name), atol=ROUNDING, err_msg=name
        )
    assert np.abs(free.at(x, y, t + loop).height - now.height).max() > 0.1


def test_erratum_the_loop_s_multiple_is_not_the_wave_s_number():
    """
    Wikipedia: "slightly shifting the frequencies such that omega_m = m Delta omega" with m the
        component: that is no slight shift.
    """
    k = 0.2 * np.arange(1.0, 9.0)
    loop = 30.0
    free = TrochoidalWaves(a=0.1, kx=k.tolist()).waves.omega
    ours = TrochoidalWaves(a=0.1, kx=k.tolist(), loop=loop).waves.omega
    printed = np.arange(1, 9) * 2 * math.pi / loop
    assert np.abs(ours / free - 1).max() < 0.08  # pi/T over the lowest omega, 1.4 rad/s, is 0.075
    assert np.abs(printed / free - 1).min() > 0.5


def test_erratum_cross_product_order_in_a_y_up_frame():
    """
    Wikipedia: n = ds/dalpha x ds/dbeta points down when y is up; ds/dbeta x ds/dalpha is the upward
        one.
    """
    x, z, t = points()
    s = MODELS["trochoidal"].waves.at(x, z, t)
    y_up = s.y_up
    down, up = np.cross(y_up.tangent, y_up.binormal), np.cross(y_up.binormal, y_up.tangent)
    assert down[:, 1].max() < 0.0
    assert up[:, 1].min() > 0.0
    np.testing.assert_allclose(
        y_up.normal, up / np.linalg.norm(up, axis=-1, keepdims=True), atol=1e-15
    )
    np.testing.assert_allclose(up[:, 1], s.jacobian, rtol=1e-13)


# --- GPU Gems, chapter 1, which the VRX note builds on


def gpu_gems_normal(w, x, y, t):
    """
    Finch 2004, equation 12: (-sum Dx A k C, -sum Dy A k C, 1 - sum q A k S), with crests where S =
    1.
    """
    theta = (
        w.kx[:, None] * x
        + w.ky[:, None] * y
        - w.omega[:, None] * t
        - w.phase[:, None]
        + 0.5 * math.pi
    )
    s, c = np.sin(theta), np.cos(theta)
    n = np.stack(
        [
            -(w.kx * w.amplitude) @ c,
            -(w.ky * w.amplitude) @ c,
            1 - (w.sharpness * w.amplitude * w.wavenumber) @ s,
        ],
        axis=-1,
    )
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def test_erratum_gpu_gems_normal_drops_what_crossing_waves_share():
    """
    Right for waves of one direction; where they cross, B x T has products of two waves' terms that
    the printed sum has not.
    """
    x, y, t = points(2000)
    for model in (
        SINGLE["steepness"],
        SteepnessWaves(wavelength=[40.0, 23.0], steepness=[0.4, 0.4], direction=30.0),
    ):
        np.testing.assert_allclose(
            gpu_gems_normal(model.waves, x, y, t), model.waves.at(x, y, t).normal, atol=ROUNDING
        )
    crossing = SteepnessWaves(
        wavelength=[40.0, 23.0], steepness=[0.4, 0.4], direction=[30.0, 120.0]
    ).waves
    cosine = np.sum(gpu_gems_normal(crossing, x, y, t) * crossing.at(x, y, t).normal, axis=-1)
    assert np.degrees(np.arccos(cosine.min())) > 10.0


def test_erratum_gpu_gems_waves_run_backwards():
    """
    Finch 2004, equation 9: with the phase w D.x + phi t, phi > 0, a crest is at x = -phi t/w:
    against D.
    """
    k, omega, later = 0.3, math.sqrt(GRAVITY * 0.3), 0.4
    x = np.linspace(-5.0, 5.0, 100001)
    at_rest, printed = np.sin(k * x + math.pi / 2), np.sin(k * x + math.pi / 2 + omega * later)
    assert x[np.argmax(printed)] - x[np.argmax(at_rest)] == pytest.approx(
        -omega / k * later, abs=2e-4
    )
    w = SlideWaves(A=1.0, k=k).waves
    ours = [x[np.argmax(w.at(x, 0.0, t).height)] for t in (0.0, later)]
    assert ours[1] - ours[0] == pytest.approx(omega / k * later, abs=2e-4)


# --- checks of arguments


def test_direction_of_a_vector():
    """For documents that give D: any length, counter-clockwise from +x."""
    assert direction_of(0.0, 3.0) == 90.0
    assert direction_of(-2.0, 0.0) == 180.0
    assert CWR(number=1, period=5.0, amplitude=1.0, direction=direction_of(3.0, 4.0)).waves.kx / (
        (2 * math.pi / 5) ** 2 / GRAVITY
    ) == pytest.approx(0.6, rel=1e-15)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PMS(period=0.0), "period must be between 0.01 and 1000 s, got 0.0"),
        (lambda: PMS(period=math.nan), "period must be"),
        (lambda: PMS(period="5"), "period must be a number"),
        (lambda: PMS(period=5.0, scale=1.0), "scale must be between 1.001 and 100, got 1.0"),
        (
            lambda: PMS(period=5.0, number=0),
            "number must be a whole number between 1 and 1000, got 0",
        ),
        (lambda: PMS(period=5.0, number=2.5), "number must be a whole number"),
        (
            lambda: PMS(period=5.0, number=900, scale=2.0),
            "number and scale must keep .* below 1e6, got 900 and 2",
        ),
        (lambda: PMS(period=5.0, gain=-1.0), "gain must be"),
        (lambda: PMS(period=5.0, steepness=-0.1), "steepness must be"),
        (lambda: PMS(period=5.0, tau=-1.0), "tau, unless it is 0, must be between"),
        (lambda: PMS(period=5.0, tau=math.inf), "tau, unless it is 0, must be between"),
        (lambda: PMS(period=5.0, direction=math.inf), "direction must be"),
        (lambda: PMS(period=5.0, angle=math.nan), "angle must be"),
        (lambda: PMS(period=5.0, gravity=0.0), "gravity must be"),
        (lambda: PMS(period=1000.0, gain=1000.0), "amplitude must be between -10000 and 10000 m"),
        (
            lambda: CWR(period=5.0, amplitude=-1.0),
            "amplitude must be between 0 and 1000 m, got -1.0",
        ),
        (
            lambda: SteepnessWaves(wavelength=[], steepness=0.1),
            r"wavelength must be one number, or one for each wave \(1\), got 0",
        ),
        (
            lambda: SlideWaves(A=[], k=[], gamma=[], phi=[]),
            r"A must be one number, or one for each wave \(1\), got 0",
        ),
        (
            lambda: SteepnessWaves(wavelength=[1.0, 2.0], steepness=[0.1, 0.2, 0.3]),
            r"wavelength must be .* for each wave \(3\), got 2",
        ),
        (lambda: SteepnessWaves(wavelength=-5.0, steepness=0.1), "wavelength must be"),
        (lambda: SlideWaves(A=1.0, k=0.0), "k must be between"),
        (lambda: SlideWaves(A=True, k=1.0), "A must be a number"),
        (
            lambda: TrochoidalWaves(a=1.0, kx=0.0),
            "kx and kz must make wavenumbers of at least 1e-06 rad/m, got 0.0",
        ),
        (lambda: TrochoidalWaves(a=1.0, kx=1.0, h=0.0), "h must be at least 1e-06 m"),
        (lambda: TrochoidalWaves(a=1.0, kx=1.0, loop=0.0), "loop must be"),
        (lambda: TrochoidalWaves(a=1.0, kx=1.0, loop=math.nan), "loop must be"),
        (lambda: direction_of(0.0, 0.0), "a direction must be a finite vector"),
        (
            lambda: Waves(
                kx=[0.0], ky=[0.0], amplitude=[1.0], phase=[0.0], omega=[1.0], sharpness=[1.0]
            ),
            "kx and ky must not both be 0",
        ),
        (
            lambda: Waves(
                kx=[1.0], ky=[0.0], amplitude=[1.0], phase=[0.0], omega=[-1.0], sharpness=[1.0]
            ),
            "omega must be",
        ),
        (lambda: MODELS["PMS"].waves.at(math.nan, 0.0, 0.0), "x0 must be between"),
        (lambda: MODELS["PMS"].waves.at(0.0, [0.0, math.inf], 0.0), r"y0\[1\] must be between"),
        (lambda: MODELS["PMS"].waves.at(0.0, 0.0, 1e13), "t must be between"),
        (lambda: MODELS["PMS"].waves.at("here", 0.0, 0.0), "x0 must be a number"),
        (lambda: MODELS["PMS"].waves.grid(0, 100.0), "n must be"),
        (lambda: MODELS["PMS"].waves.grid((4, 4, 4), 100.0), "n must be one number or a pair"),
        (lambda: MODELS["PMS"].waves.grid(4, -1.0), "size must be"),
    ],
)
def test_what_no_sea_can_have_is_refused(make, message):
    with pytest.raises(ParameterError, match=message):
        make()


def test_a_grid_that_cannot_fit_is_refused_before_it_is_made(monkeypatch):
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 1e6)
    with pytest.raises(ParameterError, match="a surface of 200 x 100 samples needs about"):
        MODELS["PMS"].waves.grid((200, 100), 100.0)


@pytest.mark.parametrize(
    "model",
    [
        PMS(period=0.01),
        PMS(period=1e3, gain=0.0),
        PMS(period=5.0, number=1000, scale=1.001),
        PMS(period=5.0, number=2, scale=100.0),
        CWR(period=5.0, amplitude=0.0, steepness=0.0),
        CWR(period=5.0, amplitude=1e-300),
        CWR(period=1e3, amplitude=1e3, number=1, tau=1e-3),
        CWR(period=5.0, amplitude=1.0, scale=1.0, steepness=1e3),
        SteepnessWaves(wavelength=1e-5, steepness=1.0),
        SteepnessWaves(wavelength=[1e7, 1.0], steepness=0.0),
        TrochoidalWaves(a=1e3, kx=1e-6, h=1e-6),
        TrochoidalWaves(a=1.0, kx=[1e6, -1e-6], kz=[-1e6, 0.0], h=1e-6, loop=1e9),
        TrochoidalWaves(a=1.0, kx=0.1, loop=0.01),
    ],
)
def test_every_field_is_finite_at_the_ends_of_the_ranges(model):
    x, y, t = points()
    t[:4] = [0.0, -1e12, 1e12, 1e-300]
    x[:3] = [0.0, 1e12, -1e12]
    s = model.waves.at(x, y, t)
    for name in [field.name for field in dataclasses.fields(s)] + [
        "normal",
        "jacobian",
        "velocity",
    ]:
        assert np.isfinite(getattr(s, name)).all(), name


def test_they_feed_the_same_exporters():
    """
    A bake takes the same from these as from a frame: height, displacement and normal pictures,
    read back to half an ulp.
    """
    from fftocean.baking.scene.maps import MAPS
    from fftocean.export import formats

    surface = PMS(
        number=3, period=5.0, scale=1.5, gain=1.0, direction=20.0, angle=0.3, steepness=0.8, tau=0.0
    ).waves.grid(16, 60.0, t=2.0)
    for name in ("height", "displacement", "normal", "jacobian"):
        channels = MAPS[name].channels(surface)
        stored = formats.decode(
            "exr",
            formats.encode("exr", np.ascontiguousarray(channels, dtype=np.float32)),
            shape=channels.shape,
        )
        assert np.array_equal(stored, channels.astype(np.float32).astype(np.float16))
    assert np.array_equal(
        MAPS["displacement"].channels(surface)[..., 0], surface.displace_x.astype(np.float32)
    )
