"""
The Blender example's scenes: a run-time package evolved by NumPy alone, and a bake's maps.

The waves are compared with the library's frames and with the direct sum, the vertices, normals and
pixels in Blender itself.
"""

import importlib
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from water import FRAMES, LOOP, OBLONG, N, job

import fftocean as fo

HERE = Path(__file__).resolve().parent
EXAMPLE = HERE.parents[1] / "examples" / "blender"
MOMENTS = 8
TILES = [(32, 60.0), (32, 9.0)]


@pytest.fixture(scope="module")
def package():
    """Import the example's reader, which needs NumPy alone."""
    sys.path.insert(0, str(EXAMPLE))
    try:
        yield importlib.import_module("package")
    finally:
        sys.path.remove(str(EXAMPLE))
        sys.modules.pop("package", None)


@pytest.fixture(scope="module")
def cascade():
    sea = fo.Sea.from_wind(speed=9.0, fetch=60e3, direction=30.0, depth=30.0)
    return fo.Cascade(sea, TILES, seed=7, loop=40.0, choppiness=0.9)


@pytest.fixture(scope="module")
def folder(cascade, tmp_path_factory):
    folder = tmp_path_factory.mktemp("cascade") / "sea"
    fo.export_sea(cascade, folder)
    return folder


def test_a_mesh_of_any_spacing_has_the_direct_sum_of_all_tiles(package, cascade, folder):
    """
    At rest positions between texels, and on no grid of the tiles; amplitudes are rounded to 6e-8.
    """
    x, y = np.array([-3.0, -2.9, -2.75, 0.3, 0.42]), np.array([100.0, 100.05, 100.2, 117.0])
    sea = package.Sea(folder)
    surface = package.Surface(sea, x, y, filtered=False)
    x0, y0 = np.meshgrid(x, y)
    for frame in range(0, MOMENTS, 3):
        t = frame * sea.loop / MOMENTS
        sums = [fo.gerstner.surface(ocean, x0, y0, t) for ocean in cascade.oceans]
        fields = surface.fields(sea.tick(frame, MOMENTS))
        found = surface.vertices(fields)
        expected = np.stack(
            [
                x0 + sum(s.x - x0 for s in sums),
                y0 + sum(s.y - y0 for s in sums),
                sum(s.z for s in sums),
            ],
            axis=-1,
        )
        assert np.abs(found - expected).max() <= 2e-6


def test_waves_too_short_for_the_spacing_become_roughness(package, cascade, folder):
    """Slope variance of mesh and rest is that of the waves, sum of (a k)^2/2, at any spacing."""
    sea = package.Sea(folder)
    captured = sum(tile.slope_variance.sum() for tile in sea.tiles)
    waves = [ocean.modes() for ocean in cascade.oceans]
    expected = sum(np.sum(0.5 * w.amplitude**2 * (w.kx**2 + w.ky**2)) for w in waves)
    assert captured == pytest.approx(expected, rel=1e-6)
    fine, coarse = (
        package.Surface(sea, np.arange(4) * step, np.arange(4) * step) for step in (0.05, 1e3)
    )
    assert np.abs(fine.rough).max() <= 1e-9
    assert coarse.rough == pytest.approx(captured, rel=1e-9)
    middle = package.Surface(sea, np.arange(200) * 0.4, np.arange(200) * 0.4)
    shown = [
        np.mean(f["slope_x"] ** 2 + f["slope_y"] ** 2)
        for f in (middle.fields(sea.tick(frame, 16)) for frame in range(16))
    ]
    # means over 80 m and a loop of waves of up to 60 m: a few per cent of scatter
    assert np.mean(shown) + middle.rough.mean() == pytest.approx(captured, rel=0.1)
    assert 0.1 * captured < middle.rough.mean() < 0.9 * captured


def test_a_wave_of_two_and_a_half_samples_is_half_in_the_mesh(package, tmp_path):
    """At k d = 3/4 pi its amplitude is cos^2(pi/4); the missing variance is 1 - 1/4 of its own."""
    wave = fo.Ocean.from_modes([(4, 0, 0.1, 0.3)], n=32, size=32.0, loop=8.0, dtype="float64")
    fo.export_sea(wave, tmp_path / "sea")
    surface = package.Surface(package.Sea(tmp_path / "sea"), np.arange(32) * 3.0, np.arange(3) * 3)
    k = 2.0 * np.pi * 4 / 32.0
    assert np.std(surface.fields(0)["height"]) == pytest.approx(0.05 / np.sqrt(2.0), rel=1e-6)
    assert surface.rough == pytest.approx(0.75 * 0.5 * (0.1 * k) ** 2, rel=1e-6)


def test_foam_is_the_periodic_solution_of_its_equation(package, folder):
    """A patch that breaks once decays by its rate, and the loop closes."""
    sea = package.Sea(folder)
    foam = package.Foam(package.Surface(sea, np.arange(2.0), np.arange(2.0)), 80)
    rate = 3.0
    foam._rates = {j: np.full((2, 2), rate if j == 5 else 0.0) for j in range(80)}
    step, tau = sea.loop / 80, foam.decay
    risen = rate * tau * (1.0 - np.exp(-step / tau))
    for later in (0, 1, 7):
        found = -np.log(1.0 - foam.coverage(5 + later)[0, 0])
        assert found == pytest.approx(risen * np.exp(-later * step / tau), rel=0.02)
    assert np.array_equal(foam.coverage(85), foam.coverage(5))
    foam._rates = {j: np.full((2, 2), rate) for j in range(80)}
    assert -np.log(1.0 - foam.coverage(0)[0, 0]) == pytest.approx(rate * tau, rel=1e-9)


def test_spacing_grows_with_the_distance(package):
    at = package.graded(0.1, 0.02, -50.0, 4000.0)
    assert at[0] == pytest.approx(-50.0)
    assert at[-1] == pytest.approx(4000.0)
    steps = np.diff(at)
    assert (steps > 0.0).all()
    assert steps[np.searchsorted(at, 0.0)] == pytest.approx(0.1, rel=0.05)
    assert steps[-1] == pytest.approx(0.02 * 4000.0, rel=0.05)


def test_a_package_that_is_not_whole_is_refused(package, folder, tmp_path):
    with pytest.raises(SystemExit, match=r"must hold a run-time package with its sea\.json"):
        package.Sea(tmp_path)
    for change, why in (
        ({"version": 2}, r"must be fftocean-runtime 1, got fftocean-runtime 2"),
        ({"format": "other"}, r"must be fftocean-runtime 1, got other 1"),
    ):
        bent = tmp_path / why[-9:].replace(" ", "")
        shutil.copytree(folder, bent)
        document = json.loads((bent / "sea.json").read_text())
        (bent / "sea.json").write_text(json.dumps({**document, **change}))
        with pytest.raises(SystemExit, match=why):
            package.Sea(bent)
    cut = tmp_path / "cut"
    shutil.copytree(folder, cut)
    (cut / "tile1.waves").write_bytes((cut / "tile1.waves").read_bytes()[:-14])
    with pytest.raises(SystemExit, match=r"tile1\.waves must be the file of sea\.json"):
        package.Sea(cut)
    (cut / "tile1.waves").unlink()
    with pytest.raises(SystemExit, match=r"tile1\.waves must be there"):
        package.Sea(cut)


@pytest.mark.client
def test_vertices_normals_and_pixels_in_blender(blender, tmp_path):
    """
    Every vertex of a tile at every frame, its normals, and pictures of a package and of a bake;
    frame F is frame 0, in vertices and in pixels.

    Blender holds positions in single precision: half a step at 50 m is 1.9e-6 m.
    """
    baked = job(
        bake__engine="blender", bake__format="exr", bake__maps=["displacement", "normal", "foam"]
    )
    fo.bake(baked, tmp_path / "bake", executor="serial")
    ocean = baked.ocean(dtype="float64")
    fo.export_sea(ocean, tmp_path / "sea")
    script = HERE / "blender" / "evolve.py"
    done = subprocess.run(
        [str(blender), "-I", script, EXAMPLE, "sea", str(MOMENTS), "out.npz", "bake"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    found = np.load(tmp_path / "out.npz")
    j, i = np.mgrid[0 : N[1], 0 : N[0]]
    apart, turned = [], []
    for frame in range(MOMENTS):
        water = ocean.loop_frame(frame, MOMENTS)
        expected = np.stack(
            [
                i * OBLONG[0] / N[0] + ocean.choppiness * water.displace_x,
                j * OBLONG[1] / N[1] + ocean.choppiness * water.displace_y,
                water.height,
            ],
            axis=-1,
        ).reshape(-1, 3)
        apart.append(np.abs(found["moved"][frame] - expected).max())
        turned.append(np.abs(found["normals"][frame] - fo.normals(water).reshape(-1, 3)).max())
    print(f"largest distance {max(apart):.3g} m, of normals {max(turned):.3g}")
    assert max(apart) <= 0.5 * float(np.spacing(np.float32(OBLONG[0]))) + 2e-7
    assert max(turned) <= 1e-6
    for name in ("moved", "normals", "foam"):
        assert np.array_equal(found[name][MOMENTS], found[name][0])
    assert np.ptp(found["foam"]) > 0.0
    for name, frames in (("package", MOMENTS), ("bake", FRAMES)):
        first, second, again = found[f"{name}_pixels"]
        assert np.array_equal(first, again)
        assert np.abs(first - second).max() > 0.02
        assert first.std() > 0.02
        assert found[f"{name}_frames"] == pytest.approx((frames, frames, frames / LOOP), rel=1e-5)
