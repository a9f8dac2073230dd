"""
Kernels run by `wgpu`: fields, averages, foam and heights beside those of Python.

The WGSL, the HLSL by two compilers, and the GLSL that is generated run on whatever Vulkan there is:
lavapipe, a software one, will do.
"""

import functools
import itertools
import math
import re
import warnings

import numpy as np
import pytest
from builders import ROOT
from kernel_layout import Foam
from kernel_sources import KINDS, device, require_command, run, shaders

import fftocean as fo
from fftocean.cascade import from_oceans
from fftocean.fields import EIGHT
from fftocean.runtime import pack
from fftocean.runtime.shaders import files

pytestmark = pytest.mark.client

# Relative error in the L2 norm. A field in single precision loses 6e-8 in each of its 10 to 20
# steps, and the rounding errors of those add up at random.
FIELDS = 5e-7
LOOP = 64.0
SEAS = {
    "deep-64": {"n": 64, "size": 200.0, "depth": np.inf},
    "shallow-128": {"n": 128, "size": 300.0, "depth": 8.0},
    "large-256": {"n": 256, "size": 500.0, "depth": 40.0},
    "oblong": {"n": (128, 64), "size": (250.0, 90.0), "depth": 40.0},
    "longest-lines": {"n": (512, 4), "size": (500.0, 5.0), "depth": 40.0},
    "less-than-a-group": {"n": (4, 16), "size": (40.0, 70.0), "depth": 40.0},
    "nearly-along-x": {"n": 64, "size": 200.0, "depth": 40.0, "spread": 2e4},
    "cascade": {
        "tiles": [(64, 400.0), ((32, 128), (57.0, 90.0)), (16, 8.3)],
        "depth": 25.0,
    },
}


@functools.cache
def sea(name):
    """Return a sea in double precision, its tiles, and its package."""
    made = dict(SEAS[name])
    depth, spread = made.pop("depth"), made.pop("spread", None)
    wind = fo.Sea.from_wind(speed=14.0, fetch=200e3, depth=depth, direction=30.0)
    if spread:
        narrow = fo.WaveSystem(
            spectrum=wind.systems[0].spectrum, spreading=fo.CosinePower(s=spread), direction=0.0
        )
        wind = fo.Sea(narrow, depth=depth)
    kind = fo.Cascade if "tiles" in made else fo.Ocean
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)  # of tiles that are small for the waves
        water = kind(wind, seed=7, loop=LOOP, dtype="float64", choppiness=0.9, **made)
        return water, getattr(water, "oceans", (water,)), pack(water)


@pytest.fixture(scope="module")
def gpu():
    """Return a graphics processor."""
    return device()


@pytest.fixture(scope="module")
def run_by(gpu, tmp_path_factory):
    """Return a function that puts a package on the graphics processor, by a kind of shaders."""
    from kernel_runner import GpuSea

    compiled = functools.cache(lambda kind: shaders(kind, tmp_path_factory.mktemp(kind)))

    def put(package, kind="wgsl", changed=None, **options):
        text, entry = compiled(kind)
        if changed:
            text = changed(text)
            assert text != compiled(kind)[0]
        return GpuSea(gpu, package, text, entry=entry, **options)

    return put


def worst(gpu_sea, oceans, moments, ticks):
    """Return the largest relative error of each field, over tiles and moments."""
    found = dict.fromkeys(EIGHT, 0.0)
    for tick in moments:
        gpu_sea.frame(tick, choppiness=1.0)
        for i, ocean in enumerate(oceans):
            frame, seen = ocean.loop_frame(tick, ticks), gpu_sea.fields(i)
            for name in EIGHT:
                apart = np.linalg.norm(seen[name] - frame[name]) / np.linalg.norm(frame[name])
                found[name] = max(found[name], apart)
    return found


@pytest.mark.parametrize("name", SEAS)
def test_every_field_equals_that_of_python(run_by, name):
    """At five moments of the loop, the first and the last among them, in every tile."""
    _, oceans, package = sea(name)
    ticks = package.document["ticks"]
    moments = [0, 12345 % ticks, ticks // 3, 5 * ticks // 7, ticks - 1]
    assert max(worst(run_by(package), oceans, moments, ticks).values()) <= FIELDS


@pytest.mark.parametrize("kind", KINDS[1:])
@pytest.mark.parametrize("name", ["deep-64", "oblong", "large-256", "cascade"])
def test_other_languages_give_the_same_fields(run_by, name, kind):
    _, oceans, package = sea(name)
    ticks = package.document["ticks"]
    moments = [0, ticks // 3, ticks - 1]
    assert max(worst(run_by(package, kind), oceans, moments, ticks).values()) <= FIELDS


def test_the_loop_closes_to_the_bit(run_by):
    """Tick and tick + ticks are the same moment, for ever."""
    package = sea("cascade")[2]
    ticks = package.document["ticks"]
    gpu_sea = run_by(package)
    gpu_sea.frame(777)
    first = gpu_sea.maps().copy()
    gpu_sea.frame(777 + 1)
    assert not np.array_equal(first, gpu_sea.maps())
    gpu_sea.frame(777 + 2000 * ticks)
    assert np.array_equal(first, gpu_sea.maps())


def test_a_coarse_sine_is_seen(run_by):
    """A sine that is only good to 2^-11, as is allowed to the platform's, makes fields fail."""

    def coarse(text):
        return text.replace(
            "return select(-turned, turned, (quadrant & 2u) == 0u);",
            "return floor(select(-turned, turned, (quadrant & 2u) == 0u) * 2048.0 + 0.5) / 2048.0;",
        )

    _, oceans, package = sea("deep-64")
    ticks = package.document["ticks"]
    found = worst(run_by(package, changed=coarse), oceans, [12345], ticks)
    assert min(found.values()) > 100 * FIELDS


def test_a_field_that_is_not_lifted_drowns_beside_a_larger_one(run_by):
    """The stretch beside the height loses a digit; along x, whatever lies across loses more."""
    for name, field in (("deep-64", "stretch_xy"), ("nearly-along-x", "displace_y")):
        _, oceans, package = sea(name)
        ticks = package.document["ticks"]
        gpu_sea = run_by(package, lifts=False)
        for tile in gpu_sea.layout.document["tiles"]:
            assert tile["mixed"] != 1.0
        gpu_sea.layout.lifts = [(1.0, 1.0, 1.0, 1.0)]
        assert worst(gpu_sea, oceans, [12345], ticks)[field] > 2 * FIELDS


def test_the_lift_of_the_package_is_enough_for_a_wind_sea(run_by):
    _, oceans, package = sea("deep-64")
    gpu_sea = run_by(package, lifts=False)
    found = worst(gpu_sea, oceans, [12345], package.document["ticks"])
    assert max(found.values()) <= FIELDS


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["cascade", "longest-lines"])
def test_levels_are_averages_of_squares(run_by, name, kind):
    """Of displacements, slopes, and the squares and product of slopes, and of foam too."""
    _, oceans, package = sea(name)
    gpu_sea = run_by(package, kind, foam_side=64)
    ticks, c = package.document["ticks"], 0.9
    foam = Foam(side=64, cell=0.5, decay=2.0, threshold=0.9, strength=30.0)
    gpu_sea.frame(4321, foam=foam)
    gpu_sea.step_foam()
    gpu_sea.average()
    expected = []
    for ocean in oceans:
        f = ocean.loop_frame(4321, ticks)
        zero = np.zeros_like(f.height)
        for channels in (
            (c * f.displace_x, c * f.displace_y, f.height, c * f.stretch_xy),
            (f.slope_x, f.slope_y, c * f.stretch_xx, c * f.stretch_yy),
            (f.slope_x**2, f.slope_y**2, f.slope_x * f.slope_y, zero),
        ):
            expected.append(np.stack(channels, axis=-1))
    foam_plane = gpu_sea.plane(3 * len(oceans)).astype(float)
    assert 0.01 < foam_plane[..., 0].mean() < 0.9
    expected.append(foam_plane)
    for index, full in enumerate(expected):
        ny, nx = full.shape[:2]
        for level in range(int(math.log2(max(nx, ny))) + 1):
            w, h = max(1, nx >> level), max(1, ny >> level)
            averages = full.reshape(h, ny // h, w, nx // w, 4).mean(axis=(1, 3))
            seen = gpu_sea.plane(index, level)
            assert seen.shape == averages.shape
            # averages of many waves cancel: what is left has the rounding errors of the samples
            assert np.abs(seen - averages).max() <= 1e-6 * np.abs(full).max(), (index, level)


def test_ten_levels_of_the_largest_window(run_by):
    """1024 cells a side have ten levels, of which `mips_far` makes five."""
    package = sea("less-than-a-group")[2]
    gpu_sea = run_by(package, foam_side=1024)
    foam = Foam(side=1024, cell=0.05, decay=2.0, threshold=0.95, strength=30.0)
    gpu_sea.frame(4321, foam=foam)
    gpu_sea.step_foam()
    gpu_sea.average()
    full = gpu_sea.plane(3).astype(float)
    assert full[..., 0].mean() > 0.01
    for level in range(1, 11):
        side = 1024 >> level
        averages = full.reshape(side, 1 << level, side, 1 << level, 4).mean(axis=(1, 3))
        assert np.abs(gpu_sea.plane(3, level) - averages).max() <= 1e-6 * np.abs(full).max()


@pytest.mark.parametrize("kind", KINDS)
def test_textures_hold_the_levels_in_half_precision(run_by, kind):
    package = sea("cascade")[2]
    gpu_sea = run_by(package, kind)
    gpu_sea.frame(999)
    gpu_sea.average()
    for plane, level in ((0, 0), (1, 2), (4, 0), (5, 3), (7, 0)):
        seen, full = gpu_sea.texture(plane, level), gpu_sea.plane(plane, level)
        assert seen.shape == full.shape
        # a half has 11 digits, and 6e-8 between its smallest numbers; conversion may cut
        assert np.all(np.abs(seen - full) <= 2.0**-10 * np.abs(full) + 6e-8)
        assert np.abs(full).max() > 1e-3


# Foam


def stretches(oceans, tick, ticks, x, y):
    """Return the summed c stretches at the texels nearest to rest positions, in float64."""
    total = np.zeros((3, *x.shape))
    for ocean in oceans:
        frame, grid = ocean.loop_frame(tick, ticks), ocean.grid
        i = np.round(x / grid.lx * grid.nx).astype(int) % grid.nx
        j = np.round(y / grid.ly * grid.ny).astype(int) % grid.ny
        for row, name in enumerate(("stretch_xx", "stretch_yy", "stretch_xy")):
            total[row] += 0.9 * frame[name][j, i]
    return total


def below(threshold, stretch):
    """Return threshold - lambda, lambda by LAPACK's eigenvalues."""
    xx, yy, xy = stretch
    gradient = np.stack([np.stack([1 + xx, xy], -1), np.stack([xy, 1 + yy], -1)], -1)
    return threshold - np.linalg.eigvalsh(gradient)[..., 0]


@pytest.mark.parametrize("kind", KINDS)
def test_a_window_of_foam_moves_over_the_sum_of_all_tiles(run_by, kind):
    """
    A quadrature in NumPy of the same equation, in cells of the world; the window moves, leaves
    cells behind, and meets new ones. The sea is far from the origin of the world.
    """
    _, oceans, package = sea("cascade")
    ticks = package.document["ticks"]
    side, cell, origin = 16, 1.7, (12_345_678.9, -9_876_543.2)
    gpu_sea = run_by(package, kind, foam_side=side)
    state = {}  # of cells of the world: (f, threshold - lambda)
    decay, threshold, strength = 1.4, 1.0, 40.0
    before, corner = (2**20, 2**20), (-5, 3)
    for step, move in enumerate([(0, 0), (1, 0), (0, -2), (-3, 1), (20, 0), (2, 2)]):
        corner = tuple(a + b for a, b in zip(corner, move, strict=True))
        tick, seconds = 1000 + 900 * step, 0.07 * (1 + step % 2)
        foam = Foam(side, cell, decay, threshold, strength, seconds, corner, before)
        foam.corner_place = tuple((c + 0.5) * cell for c in corner)
        gpu_sea.frame(tick, foam=foam, origin=origin)
        gpu_sea.step_foam()
        before = corner
        i, j = np.meshgrid(*(np.arange(c, c + side) for c in corner))
        x, y = ((k + 0.5) * cell + o for k, o in zip((i, j), origin, strict=True))
        now = below(threshold, stretches(oceans, tick, ticks, x, y))
        fresh = {}
        for a, b, p in zip(i.ravel(), j.ravel(), now.ravel(), strict=True):
            if (a, b) in state:
                f, earlier = state[a, b]
                u = np.linspace(0, 1, 5)
                weight = np.array([0.5, 1, 1, 1, 0.5]) * seconds / 4
                source = np.maximum(earlier + u * (p - earlier), 0)
                f = f * math.exp(-seconds / decay) + strength * float(
                    np.sum(weight * np.exp(-(1 - u) * seconds / decay) * source)
                )
            else:
                f = decay * strength * max(p, 0.0)
            fresh[a, b] = f, p
        state = fresh
        seen = gpu_sea.plane(3 * len(oceans))
        for (a, b), (f, p) in state.items():
            coverage, amount, difference, _ = seen[b % side, a % side]
            # lambda is 1e-7 off; places at the border of two texels are taken to be equal
            assert difference == pytest.approx(p, abs=1e-6)
            assert amount == pytest.approx(f, abs=1e-4)
            assert coverage == pytest.approx(1 - math.exp(-f), abs=1e-4)
    assert 0.1 < np.mean(seen[..., 0]) < 0.9


def test_foam_is_that_of_the_library(run_by):
    """
    After a loop of steps, 64 a second, from clean water: the state that returns to itself, but for
    e^-10 of it. The library takes a cubic in time, the kernel a straight line.
    """
    wind = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        ocean = fo.Ocean(wind, n=32, size=40.0, seed=3, loop=8.0, dtype="float64", choppiness=1.2)
        package = pack(ocean)
    model = fo.Foam(tau=0.8, threshold=0.9, strength=20.0)
    count, ticks = 512, package.document["ticks"]
    gpu_sea = run_by(package, foam_side=32)
    foam = Foam(32, 40.0 / 32, model.tau, model.threshold, model.strength, 8.0 / count)
    for step in range(count):
        gpu_sea.frame(step * (ticks // count), foam=foam)
        gpu_sea.step_foam()
        foam.corner_before = foam.corner
    for step, expected in enumerate(itertools.islice(model.loop(ocean, count), 8)):
        gpu_sea.frame(step * (ticks // count), foam=foam)
        gpu_sea.step_foam()
        seen = gpu_sea.plane(3)[..., 0]
        # of a straight line: (omega dt)^2/12 of the source, 3e-4 at the 4 rad/s of this sea
        assert np.linalg.norm(seen - expected) <= 1e-3 * np.linalg.norm(expected)
        assert 0.1 < expected.mean() < 0.9


# Heights


@pytest.mark.parametrize("kind", KINDS)
def test_heights_are_those_of_the_library(run_by, kind):
    """
    At 500 points of a cascade whose waves have eight samples or more, beside the sum of all waves
    in float64, which is inverted by another iteration; and at 200 points far from the origin.
    """
    wind = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        tiles = [
            fo.Ocean(wind, n=n, size=size, seed=5, loop=LOOP, dtype="float64", band=band)
            for n, size, band in ((64, 300.0, (0.0, 0.16)), (64, 60.0, (0.16, 0.8)))
        ]
        water = from_oceans(wind, 5, tuple(tiles))
    package = pack(water)
    ticks, tick = package.document["ticks"], 54321
    rng = np.random.default_rng(2)
    gpu_sea = run_by(package, kind)
    for count, origin in ((500, (0.0, 0.0)), (200, (1_234_567.8, -7_654_321.9))):
        x, y = rng.uniform(-400, 400, (2, count)).astype(np.float32).astype(float)
        gpu_sea.frame(tick, points=count, iterations=4, origin=origin)
        seen = gpu_sea.heights(x, y)
        query = fo.Query(water, mode="exact", level="frame")
        answer = query.at(x + origin[0], y + origin[1], LOOP * tick / ticks)
        assert not answer.folded.any()
        size = np.std(answer.heights)
        # cubic interpolation of a wave of 8 samples is 1e-3 of it off, linear of its slope 0.08
        assert np.abs(seen[:, 2] - answer.heights).max() <= 1e-3 * size
        assert np.abs(seen[:, 4:7] - answer.normals).max() <= 8e-3
        assert np.std(answer.normals[:, 0]) > 0.05
        # single precision of coordinates at 400 m is 3e-5
        assert seen[:, 3].max() <= 1e-4
        rest = np.stack([answer.x0 - origin[0], answer.y0 - origin[1]], axis=-1)
        assert np.abs(seen[:, :2] - rest).max() <= 5e-3 * size
        assert np.abs(rest - np.stack([x, y], -1)).max() > 0.5 * size
        assert np.all((seen[:, 7] > 0.1) & (seen[:, 7] < 3.0))


def test_a_fold_is_told(run_by):
    """A wave that is steeper than any folds at its crest: the Jacobian there is below 0."""
    ocean = fo.Ocean.from_modes([(2, 0, 4.0, 0.0)], n=32, size=32.0, loop=LOOP, choppiness=1.0)
    package = pack(ocean)
    gpu_sea = run_by(package)
    gpu_sea.frame(0, points=2, iterations=4)
    crest, trough = gpu_sea.heights(np.array([0.0, 8.0]), np.zeros(2))
    k = 2 * np.pi * 2 / 32  # height = a cos(k x), and the stretch is - k times that
    assert crest[7] == pytest.approx(1 - 4.0 * k, abs=1e-5)
    assert trough[[2, 3, 7]] == pytest.approx([-4.0, 0.0, 1 + 4.0 * k], abs=1e-5)
    assert trough[4:7] == pytest.approx([0, 0, 1], abs=1e-6)


@pytest.mark.parametrize("tiles", [1, 4])
def test_the_shaders_of_the_page_compile_by_naga(gpu, tiles):
    """Compile them with Firefox's compiler; Chromium's has them in tests/clients/test_webgpu.py."""
    require_command("node")
    page = ROOT / "examples" / "webgpu"
    script = (
        f"import('{(page / 'water.js').as_uri()}').then((m) => console.log(m.tileCode({tiles})))"
    )
    code = files("wgsl")["fftocean.wgsl"].decode() + (page / "draw.wgsl").read_text("utf-8")
    module = gpu.create_shader_module(code=code + run("node", "--input-type=module", "-e", script))
    rgba = [{"format": "rgba8unorm"}]
    for vertex, fragment in (("sky_corner", "sky_colour"), ("mesh", "water_colour")):
        gpu.create_render_pipeline(
            layout="auto",
            vertex={"module": module, "entry_point": vertex},
            fragment={"module": module, "entry_point": fragment, "targets": rgba},
        )
    with pytest.raises(Exception, match="Shader"):
        gpu.create_shader_module(code=code)  # without the functions of the tiles


def test_the_sources_are_read(run_by):
    """A change of the WGSL reaches the processor: no stale module is used."""
    _, oceans, package = sea("less-than-a-group")
    wrong = run_by(package, changed=lambda text: re.sub(r"a \+ c;", "a - c;", text))
    assert worst(wrong, oceans, [5], package.document["ticks"])["height"] > 0.1
