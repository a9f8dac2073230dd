"""
The example of MuJoCo: a buoy and Wigley's hull, held against closed forms and linear theory.

Physics runs without a picture. The pictures need EGL or OSMesa.
"""

import importlib
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.special import j1

import fftocean as fo

REQUIRED = os.environ.get("FFTOCEAN_REQUIRE_CLIENTS", "0") not in ("", "0")
if REQUIRED:
    import mujoco
else:
    mujoco = pytest.importorskip(
        "mujoco", reason="mujoco is not installed: pip install '.[robots]'"
    )

ROOT = Path(__file__).parent.parent
FOLDER = ROOT / "examples" / "mujoco"
MODULES = ("bodies", "panels", "ride", "scene")
GRAVITY, WATER = 9.80665, 1025.0


@pytest.fixture(scope="module")
def example():
    """Import the example's modules as Python does when it is run; forget them afterwards."""
    sys.path.insert(0, str(FOLDER))
    try:
        yield importlib.import_module
    finally:
        sys.path.remove(str(FOLDER))
        for name in MODULES:
            sys.modules.pop(name, None)


def still_water():
    return fo.Ocean.from_modes([], n=16, size=50.0, loop=10.0, dtype="float64")


def regular_wave(number, amplitude=0.02):
    """Return a wave along +x that has `number` lengths in 60 m, with its true frequency."""
    return fo.Ocean.from_modes([(number, 0, amplitude, 0.3)], n=64, size=60.0, dtype="float64")


def heave_of(example, name, body, water, seconds, start=0.0):
    """Return the heave of a single body, step by step [m]."""
    ride = example("ride").Simulation({name: body}, water, places={name: (0.0, 0.0)})
    ride.data.qpos[2] = start
    out = np.empty(round(seconds * example("ride").RATE))
    for i in range(out.size):
        ride.step()
        out[i] = ride.heave(name)
    return out


def peaks(heave):
    """Return the steps and values of the maxima."""
    i = 1 + np.flatnonzero((heave[1:-1] > heave[:-2]) & (heave[1:-1] >= heave[2:]))
    return i, heave[i]


@pytest.mark.parametrize("water", ["SurfaceWater", "LinearWater"])
@pytest.mark.parametrize(("name", "damping"), [("buoy", 0.05), ("buoy", 0.15), ("hull", 0.05)])
def test_free_decay_has_period_and_damping_of_the_closed_form(example, water, name, damping):
    """
    omega0^2 = rho g A / (m + added mass), the damped period 2 pi / (omega0 sqrt(1 - zeta^2)).

    A step of 0.02 s changes the period by (omega dt)^2/24 = 2e-4; panels of the hull have 0.9 %
    less volume and 0.2 % less water plane than the curved one.
    """
    shape = getattr(example("bodies"), name)
    body = shape(damping=damping, drag=0.0)
    plane = math.pi if name == "buoy" else 2.0 / 3.0 * 9.0 * 2.6
    omega0 = math.sqrt(WATER * GRAVITY * plane / (body.mass + body.added[2]))
    period = 2.0 * math.pi / (omega0 * math.sqrt(1.0 - damping**2))
    source = getattr(example("panels"), water)(still_water())
    heave = heave_of(example, name, body, source, 5.0 * period, start=0.05)
    steps, high = peaks(heave)
    assert np.mean(np.diff(steps[:4])) / 50.0 == pytest.approx(period, rel=0.02)
    low = peaks(-heave)[1]
    decay = np.log((high[0] + low[0]) / (high[2] + low[2])) / 2.0  # free of the mean
    assert decay / math.hypot(2.0 * math.pi, decay) == pytest.approx(damping, rel=0.08)


def test_volume_and_water_plane_are_those_of_the_shapes(example):
    bodies = example("bodies")
    for body, volume, plane, within in (
        (bodies.buoy(), math.pi * 0.6, math.pi, 1e-4),
        (bodies.hull(), 4.0 / 9.0 * 9.0 * 2.6 * 0.8, 2.0 / 3.0 * 9.0 * 2.6, 0.01),
    ):
        centres, areas = body.panels
        below = centres[:, 2] < 0.0
        assert np.abs(areas.sum(axis=0)).max() < 1e-9  # the surface is closed
        assert np.sum(centres[below, 2] * areas[below, 2]) == pytest.approx(volume, rel=within)
        assert -areas[below, 2].sum() == pytest.approx(plane, rel=within)
        assert body.mass == pytest.approx(WATER * volume, rel=1e-9)


@pytest.mark.parametrize("axis", [0, 1], ids=["roll", "pitch"])
def test_a_tilted_hull_rights_itself_by_its_metacentric_height(example, axis):
    """
    Moment m g GM sin(angle), GM = KB + BM - KG of the curved hull: centre of buoyancy 3/8 of the
    draught below the water, BM = second moment of the water plane / volume.
    """
    panels = example("panels")
    length, beam, draught = 9.0, 2.6, 0.8
    body = example("bodies").hull()
    volume = 4.0 / 9.0 * length * beam * draught
    moment = beam**3 * length * 4.0 / 105.0 if axis == 0 else beam * length**3 / 30.0
    height = moment / volume - 0.375 * draught - body.centre
    ride = example("ride").Simulation({"hull": body}, panels.SurfaceWater(still_water()))
    angle = math.radians(1.0)
    ride.data.qpos[3:7] = math.cos(angle / 2), *(math.sin(angle / 2) * np.eye(3)[axis])
    mujoco.mj_forward(ride.model, ride.data)
    ride.forces.apply(ride.model, ride.data)
    found = -ride.data.xfrc_applied[ride.model.body("hull").id, 3 + axis]
    assert found == pytest.approx(body.mass * GRAVITY * height * math.sin(angle), rel=0.05)


@pytest.mark.parametrize("water", ["SurfaceWater", "LinearWater"])
@pytest.mark.parametrize("number", [2, 5, 8])
def test_heave_in_a_regular_wave_is_that_of_linear_theory(example, water, number):
    """
    Froude-Krylov force and relative motion: with C = rho g A, A' added mass, B damping,

        heave / wave = e^(-k d) 2 J1(k r)/(k r) |C - w^2 A' + i w B| / |C - w^2 (m + A') + i w B|

    for waves of 30 m, 12 m and 7.5 m, the last near resonance, on a buoy of 2 m.
    """
    radius, draught, damping, amplitude = 1.0, 0.6, 0.12, 0.02
    body = example("bodies").buoy(radius, draught, damping)
    k = 2.0 * math.pi * number / 60.0
    omega = math.sqrt(GRAVITY * k)
    stiffness, moved = WATER * GRAVITY * math.pi * radius**2, body.mass + body.added[2]
    resistance = 1j * omega * damping * 2.0 * math.sqrt(stiffness * moved)
    across = 2.0 * j1(k * radius) / (k * radius) * math.exp(-k * draught)
    force = stiffness - omega**2 * body.added[2] + resistance
    expected = across * abs(force / (stiffness - omega**2 * moved + resistance))
    source = getattr(example("panels"), water)(regular_wave(number, amplitude))
    heave = heave_of(example, "buoy", body, source, 24.0)[600:]  # 12 s: 1 % of what was at start
    t = 0.02 * np.arange(heave.size)
    parts = np.stack([np.cos(omega * t), np.sin(omega * t), np.ones_like(t)], axis=1)
    found = np.hypot(*np.linalg.lstsq(parts, heave, rcond=None)[0][:2]) / amplitude
    assert found == pytest.approx(expected, rel=0.05)


def test_both_waters_agree_on_a_long_wave(example):
    """Pressure, velocity and acceleration to second order in steepness, under crest and trough."""
    panels = example("panels")
    amplitude, ocean = 0.01, regular_wave(3, amplitude=0.01)
    points = np.array([[x, 0.0, z] for x in (0.0, 4.0, 9.0, 14.0) for z in (-0.1, -0.8, 0.5)])
    surface, linear = (w(ocean).at(points, 0.7) for w in (panels.SurfaceWater, panels.LinearWater))
    omega2 = GRAVITY * 2.0 * math.pi / 20.0
    assert np.array_equal(surface.pressure > 0.0, linear.pressure > 0.0)
    assert np.abs(surface.pressure - linear.pressure).max() <= 0.02 * WATER * GRAVITY * amplitude
    wet = linear.pressure > 0.0
    for found, expected, largest in (
        (surface.velocity, linear.velocity, math.sqrt(omega2) * amplitude),
        (surface.acceleration, linear.acceleration, omega2 * amplitude),
    ):
        assert np.abs(found - expected)[wet].max() <= 0.02 * largest


def test_decay_below_the_surface_is_that_of_the_only_wave(example):
    ocean = regular_wave(4)
    decay_of = example("panels").decay_of
    assert decay_of(ocean, 0.0) == pytest.approx(2.0 * math.pi * 4 / 60.0, rel=1e-6)
    assert decay_of(ocean, 20.0) == 0.0  # the wave is shorter
    assert decay_of(still_water(), 0.0) == 0.0


def test_a_body_of_another_mass_than_its_water_is_refused(example):
    from dataclasses import replace

    with pytest.raises(ValueError, match="mass must be that of the water below z = 0, 19"):
        replace(example("bodies").buoy(), mass=1000.0)


def can_draw(library):
    """Return whether MuJoCo can open a context without a window."""
    program = "import mujoco; mujoco.Renderer(mujoco.MjModel.from_xml_string('<mujoco/>')).close()"
    environment = {**os.environ, "MUJOCO_GL": library}
    command = [sys.executable, "-c", program]
    return (
        subprocess.run(command, env=environment, capture_output=True, timeout=120).returncode == 0
    )


@pytest.mark.process
def test_the_height_field_is_the_water_and_a_picture_shows_it(tmp_path):
    """
    Rays from above meet the height field where the water is, and a contact sheet and a film have
    waves in them.
    """
    library = next((name for name in ("egl", "osmesa") if can_draw(name)), None)
    if library is None:
        reason = "MuJoCo opens neither EGL nor OSMesa"
        if REQUIRED:
            pytest.fail(f"{reason}, and FFTOCEAN_REQUIRE_CLIENTS is set", pytrace=False)
        pytest.skip(reason)
    program = f"""
import sys
sys.path.insert(0, {str(FOLDER)!r})
import mujoco, numpy as np
import fftocean as fo
from bodies import buoy
from scene import Picture, model_of
sea = fo.Ocean.from_modes([(1, 0, 0.4, 0.0), (1, 2, 0.2, 1.0)], n=32, size=40.0, choppiness=0.0)
model = model_of({{"buoy": buoy()}}, {{"buoy": (3.0, -4.0)}}, size=40.0, cells=161)
data = mujoco.MjData(model)
data.time = 1.3
query = fo.Query(sea)
with Picture(model, query, 96, 54) as picture:
    shot = picture.take(data)
places = np.array([(x, y) for x in (-15.0, -2.2, 7.1) for y in (-11.3, 0.4, 16.0)])
hit = np.zeros(1, np.int32)
down = np.array([0.0, 0.0, -1.0])
found = [
    50.0 - mujoco.mj_ray(model, data, np.array([x, y, 50.0]), down, None, 1, -1, hit)
    for x, y in places
]
apart = np.abs(found - query.at(*places.T, 1.3, "heights").heights).max()
assert apart < 0.005, apart  # linear between samples 0.25 m apart: a k^2 dx^2/8 = 5e-4, twice
assert shot.std() > 10.0 and shot.shape == (54, 96, 3)
sys.argv = ["ride.py", {str(FOLDER / "breeze.toml")!r}, "--seconds", "16.2", "--tiles", "16:120",
    "--width", "64", "--rate", "1", "--picture", "sheet.webp", "--film", "film.webp"]
import ride
ride.main()
"""
    environment = {**os.environ, "MUJOCO_GL": library, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", program],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "ms a step" in done.stdout
    from PIL import Image

    with Image.open(tmp_path / "film.webp") as film:
        assert film.n_frames == 16
    with Image.open(tmp_path / "sheet.webp") as drawn:
        assert drawn.size == (3 * 64 + 8, 2 * 36 + 4)
