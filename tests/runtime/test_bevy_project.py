"""
The Bevy project, without Bevy: its Rust that needs no crates compiled and run, its WGSL run by
`wgpu` on the maps of the kernels.
"""

import re
import shutil
import tomllib

import numpy as np
import pytest
from builders import run
from kernel_layout import Layout, lifts_of
from kernel_sources import device, shaders

import fftocean as fo
from fftocean.runtime.folder import read_package

pytestmark = pytest.mark.client

SEA = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
TILES = [(64, 420.0), ((32, 16), (61.0, 40.0))]
EYE = np.array([123.25, -45.5])  # east, north
TICK = 12345


@pytest.fixture(scope="module")
def cascade():
    return fo.Cascade(SEA, TILES, loop=64.0, seed=3, choppiness=0.9)


@pytest.fixture(scope="module")
def project(cascade, tmp_path_factory):
    """Return the folder of an exported package with the project."""
    folder = tmp_path_factory.mktemp("bevy") / "sea"
    fo.export_sea(cascade, folder, textures=True, engine="bevy")
    return folder


@pytest.mark.skipif(shutil.which("rustc") is None, reason="rustc is not installed")
def test_the_program_lays_the_waves_out_as_the_kernels_take_them(project, tmp_path):
    """The arrays are those of the package's textures, to the bit but for the factors' last one."""
    for source in (project / "sea_waves.rs", project / "src" / "layout.rs"):
        shutil.copy(source, tmp_path)
    shutil.copy(__file__.replace("test_bevy_project.py", "dump_layout.rs"), tmp_path)
    flags = ("--edition=2021", "-O", "-A", "dead_code", "-D", "warnings")
    run("rustc", *flags, "dump_layout.rs", "-o", "dump", cwd=tmp_path)
    texels, map_texels, groups, longest = map(int, run("./dump", project, cwd=tmp_path).split())
    package = read_package(project)
    # one lift: the others of `lifts_of` gain accuracy where all waves run along an axis
    lifts = [(1.0, tile["mixed"], 1.0, 1.0) for tile in package.document["tiles"]]
    assert len(lifts_of(package)) == len(lifts)
    layout = Layout(package.document, lifts, 0)
    assert (texels, map_texels, longest) == (layout.texels, layout.map_texels, layout.twiddles)
    assert groups == layout.groups()[0]
    for name in ("h0", "wave"):
        expected = b"".join((project / f"tile{i}_{name}.bin").read_bytes() for i in range(2))
        found, wanted = np.fromfile(tmp_path / name, "<f4"), np.frombuffer(expected, "<f4")
        assert found.shape == wanted.shape
        assert np.all(np.abs(found - wanted) <= 1.2e-7 * np.abs(wanted)), name
    found, wanted = (np.fromfile(p, "<f4") for p in (tmp_path / "twiddle", project / "twiddle.bin"))
    assert np.abs(found - wanted).max() <= 1e-7
    foam = package.document["foam"]
    block = bytearray(layout.block(TICK, choppiness=0.9))
    block[64:76] = np.array([foam[k] for k in ("decay", "threshold", "strength")], "<f4").tobytes()
    written = (tmp_path / "block").read_bytes()
    for first, last in ((0, 24), (64, 76), (96, 96 + 64 * 2)):
        assert written[first:last] == bytes(block[first:last]), first


@pytest.mark.skipif(shutil.which("rustfmt") is None, reason="rustfmt is not installed")
def test_all_of_the_program_is_rust(project):
    """rustfmt parses what cannot be compiled without Bevy."""
    run("rustfmt", "--edition=2021", "--check", "src/main.rs", cwd=project)


def water_shader(project):
    """Return the material's shader with a stub of Bevy's view in the place of its import."""
    text = (project / "sea_water.wgsl").read_text()
    (imported,) = re.findall(r"^#import .*$", text, re.MULTILINE)
    assert imported == "#import bevy_pbr::mesh_view_bindings::view"
    stub = (
        "struct View { clip_from_world: mat4x4f, world_position: vec3f }\n"
        "@group(0) @binding(0) var<uniform> view: View;"
    )
    return text.replace(imported, stub)


QUESTION = """
@group(1) @binding(0) var<storage, read> asked: array<vec4f>; // rest from the eye, footprint, plane
@group(1) @binding(1) var<storage, read_write> found: array<vec4f>;

@compute @workgroup_size(1)
fn ask(@builtin(global_invocation_id) id: vec3u) {
  let one = asked[id.x];
  var sum = vec4f(0.0);
  for (var i = 0u; i < sea.count.x; i++) { sum += plane_at(i, u32(one.w), one.xy, one.z); }
  found[id.x] = sum;
}
"""


class Water:
    """The maps of a package at a moment, and the material that reads them."""

    def __init__(self, cascade, project):
        import wgpu
        from kernel_runner import GpuSea

        self.device = device()
        package = read_package(project)
        self.gpu = GpuSea(self.device, package, shaders("wgsl", None)[0])
        self.gpu.frame(TICK, choppiness=cascade.choppiness)
        self.gpu.average()
        self.tiles = package.document["tiles"]
        block = np.zeros((3 + 32, 4), "<f4")
        block[0] = EYE[0], 0.0, -EYE[1], 0.0
        block[2] = 0.45, 0.35, -0.6, 20.0
        whole = block.view("<u4")
        whole[1, 0] = len(self.tiles)
        for i, tile in enumerate(self.tiles):
            block[3 + i] = *tile["size"], *(EYE / tile["size"] % 1.0)
            whole[19 + i, :3] = *tile["n"], self.gpu.layout.plane(3 * i)[0]
        usage = wgpu.BufferUsage.UNIFORM
        self.places = self.device.create_buffer_with_data(data=block.tobytes(), usage=usage)
        self.module = self.device.create_shader_module(code=water_shader(project) + QUESTION)

    def ask(self, questions):
        """Return sums of a plane over the tiles: rows are rest (east, north), footprint, plane."""
        import wgpu

        asked = np.array(questions, "<f4")
        usage = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
        given = self.device.create_buffer_with_data(data=asked.tobytes(), usage=usage)
        answer = self.device.create_buffer(size=asked.nbytes, usage=usage)
        pipeline = self.device.create_compute_pipeline(
            layout="auto", compute={"module": self.module, "entry_point": "ask"}
        )
        encoder = self.device.create_command_encoder()
        compute = encoder.begin_compute_pass()
        compute.set_pipeline(pipeline)
        for group, buffers in ((2, (self.gpu.buffers[5], self.places)), (1, (given, answer))):
            entries = [
                {"binding": i, "resource": {"buffer": buffer, "offset": 0, "size": buffer.size}}
                for i, buffer in enumerate(buffers)
            ]
            bound = self.device.create_bind_group(
                layout=pipeline.get_bind_group_layout(group), entries=entries
            )
            compute.set_bind_group(group, bound)
        compute.dispatch_workgroups(len(asked))
        compute.end()
        self.device.queue.submit([encoder.finish()])
        return np.frombuffer(self.device.queue.read_buffer(answer), "<f4").reshape(-1, 4)


@pytest.fixture(scope="module")
def water(cascade, project):
    return Water(cascade, project)


def test_the_material_finds_the_water_of_the_library(cascade, water):
    """
    Sums over the tiles at places of the world, beside the same interpolation of Python's frames.

    Single precision of a place within a tile moves the water by 1e-5 of a sample.
    """
    rng = np.random.default_rng(2)
    rest = rng.uniform(-300.0, 300.0, (50, 2))
    frames = cascade.loop_frame(TICK, water.gpu.layout.document["ticks"])
    c = cascade.choppiness
    for plane, names, factors in (
        (0, ("displace_x", "displace_y", "height", "stretch_xy"), (c, c, 1.0, c)),
        (1, ("slope_x", "slope_y", "stretch_xx", "stretch_yy"), (1.0, 1.0, c, c)),
    ):
        found = water.ask([[*place, 0.0, plane] for place in rest])
        for i, (name, factor) in enumerate(zip(names, factors, strict=True)):
            wanted = sum(
                factor * bilinear(frame[name], EYE + rest, ocean.grid)
                for frame, ocean in zip(frames, cascade.oceans, strict=True)
            )
            assert np.abs(found[:, i] - wanted).max() <= 1e-4 * np.abs(wanted).max(), name


def bilinear(field, place, grid):
    """Return a periodic field between its samples, at places (points, 2)."""
    u, v = place[:, 0] / grid.lx * grid.nx, place[:, 1] / grid.ly * grid.ny
    i, j = np.floor(u).astype(int), np.floor(v).astype(int)
    p, q = u - i, v - j
    at = lambda di, dj: field[(j + dj) % grid.ny, (i + di) % grid.nx].astype(float)  # noqa: E731
    south = (1 - p) * at(0, 0) + p * at(1, 0)
    return (1 - q) * south + q * ((1 - p) * at(0, 1) + p * at(1, 1))


def test_a_large_footprint_sees_the_mean(water):
    """The last level of a plane is the mean of the tile: 0 of displacement, heights and slopes."""
    rest = np.random.default_rng(3).uniform(-300.0, 300.0, (20, 2))
    near = water.ask([[*place, 0.0, 0] for place in rest])
    far = water.ask([[*place, 1e6, 0] for place in rest])
    assert np.abs(far).max() <= 1e-5 * np.abs(near).max()
    moments = water.ask([[*place, 1e6, 2] for place in rest])
    assert np.ptp(moments, axis=0).max() <= 1e-6 * moments[:, :2].max()
    assert moments[0, 0] > 0.0


def test_levels_keep_their_place(water):
    """
    Averaged over four samples of a tile, waves stay where they were; a level that is put where its
    texels begin, not where their squares have their middle, would be 10 m off.
    """
    rest = np.stack([np.linspace(-100.0, 100.0, 41), np.zeros(41)], axis=1)
    spacing = TILES[0][1] / TILES[0][0]
    fine, coarse = (
        water.ask([[*place, footprint, 0] for place in rest])[:, 2]
        for footprint in (0.0, 4.0 * spacing)
    )
    shifts = np.arange(-8, 9)
    likeness = [np.corrcoef(fine[8:-8], np.roll(coarse, s)[8:-8])[0, 1] for s in shifts]
    assert shifts[int(np.argmax(likeness))] == 0  # in steps of 5 m


def test_the_manifest_names_bevy_alone(project):
    manifest = tomllib.loads((project / "Cargo.toml").read_text())
    assert list(manifest["dependencies"]) == ["bevy"]
    assert (project / "Cargo.toml").read_text().startswith("# Not run in Bevy")
    assert (project / "README.bevy.md").read_text().startswith("> Not run in Bevy")
