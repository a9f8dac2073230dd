"""
Functions for materials of Unity and Unreal, compiled by glslang and run by `wgpu`: the water of
the library, in the engine's axes and unit, and its normal.
"""

import json
import subprocess

import numpy as np
import pytest
from kernel_sources import device, require_command

import fftocean as fo
from fftocean.example_projects import project_files

pytestmark = pytest.mark.client

SEA = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
TILES = [(64, 420.0), ((32, 16), (61.0, 40.0))]
TICK, TICKS = 12345, 2**20
EYE = np.array([123.25, -45.5])  # east, north [m]

UNITY = """
#define ddx(p) float2(1e-6, 0.0)
#define ddy(p) float2(0.0, 1e-6)
#include "SeaWater.hlsl"
StructuredBuffer<float4> asked;
RWStructuredBuffer<float4> found;
[numthreads(1, 1, 1)]
void ask(uint3 id : SV_DispatchThreadID)
{
    float3 moved, normal, roughness;
    float2 rest;
    float foam;
    SeaMove_float(asked[id.x].xyz, asked[id.x].w, moved, rest);
    SeaShade_float(rest, normal, roughness, foam);
    found[2 * id.x] = float4(moved, foam);
    found[2 * id.x + 1] = float4(normal, roughness.x);
}
"""
UNREAL = """
#define ddx(p) float2(1e-6, 0.0)
#define ddy(p) float2(0.0, 1e-6)
#include "SeaWater.ush"
Texture2D Moved0, Moved1, Slopes0, Slopes1;
SamplerState Sampler;
float4 Eye, Tile0, Tile1;
StructuredBuffer<float4> asked;
RWStructuredBuffer<float4> found;
[numthreads(1, 1, 1)]
void ask(uint3 id : SV_DispatchThreadID)
{
    float2 rest = asked[id.x].xy;
    float3 moved = SeaMove(Moved0, Sampler, rest, Eye, Tile0, asked[id.x].w)
        + SeaMove(Moved1, Sampler, rest, Eye, Tile1, asked[id.x].w);
    float4 slopes = SeaSlopes(Slopes0, Sampler, rest, Eye, Tile0)
        + SeaSlopes(Slopes1, Sampler, rest, Eye, Tile1);
    float mixed = SeaSlopes(Moved0, Sampler, rest, Eye, Tile0).w
        + SeaSlopes(Moved1, Sampler, rest, Eye, Tile1).w;
    found[2 * id.x] = float4(asked[id.x].xyz + moved, 0.0);
    found[2 * id.x + 1] = float4(SeaNormal(slopes, mixed), 0.0);
}
"""


@pytest.fixture(scope="module")
def cascade():
    return fo.Cascade(SEA, TILES, loop=64.0, seed=3, choppiness=0.9, dtype="float64")


@pytest.fixture(scope="module")
def planes(cascade):
    """Return the planes of both tiles as half floats: moved, slopes, moments, each (ny, nx, 4)."""
    c, made = cascade.choppiness, []
    for frame in cascade.loop_frame(TICK, TICKS):
        x, y = frame.slope_x, frame.slope_y
        nothing = np.zeros_like(x)
        for parts in (
            (c * frame.displace_x, c * frame.displace_y, frame.height, c * frame.stretch_xy),
            (x, y, c * frame.stretch_xx, c * frame.stretch_yy),
            (x * x, y * y, x * y, nothing),
        ):
            made.append(np.stack(parts, axis=-1).astype("<f2"))
    return made


def rest_places(count=60):
    """Return places of water that rests, (count, 2): east and north [m]."""
    return EYE + np.random.default_rng(4).uniform(-300.0, 300.0, (count, 2))


def expected(planes, rest):
    """Return the sums over the tiles of moved and slopes at places, between their samples."""
    sums = []
    for kind in (0, 1):
        total = np.zeros((len(rest), 4))
        for i, (_, size) in enumerate(TILES):
            field = planes[3 * i + kind].astype(float)
            ny, nx = field.shape[:2]
            u, v = (rest / size * (nx, ny)).T
            i0, j0 = np.floor(u).astype(int), np.floor(v).astype(int)
            p, q = (u - i0)[:, None], (v - j0)[:, None]
            for dj, along in ((0, 1 - q), (1, q)):
                for di, across in ((0, 1 - p), (1, p)):
                    total += along * across * field[(j0 + dj) % ny, (i0 + di) % nx]
        sums.append(total)
    return sums


def normal_of(moved, slopes):
    """Return unit normals, x east, y north, z up, from the two tangents of the moved surface."""
    along_x = np.stack([1 + slopes[:, 2], moved[:, 3], slopes[:, 0]], axis=-1)
    along_y = np.stack([moved[:, 3], 1 + slopes[:, 3], slopes[:, 1]], axis=-1)
    cross = np.cross(along_x, along_y)
    return cross / np.linalg.norm(cross, axis=-1, keepdims=True)


def run(text, engine, textures, values, asked, tmp_path):
    """Run `ask` on a list of float4 and return two float4 for each, (points, 8)."""
    import wgpu

    for name, path in project_files(engine).items():
        if name.endswith((".hlsl", ".ush")):
            (tmp_path / name).write_bytes(path.read_bytes())
    (tmp_path / "ask.hlsl").write_text(text)
    for command in (
        (
            *("glslangValidator", "-D", "-V", "--amb", "--aml", "-S", "comp", "-e", "ask"),
            *("-I.", "-o", "ask.spv", "ask.hlsl"),
        ),
        ("spirv-cross", "ask.spv", "--reflect", "--output", "ask.json"),
    ):
        require_command(command[0])
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    layout = json.loads((tmp_path / "ask.json").read_text())
    gpu = device()
    usage = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
    given = gpu.create_buffer_with_data(data=np.array(asked, "<f4").tobytes(), usage=usage)
    answer = gpu.create_buffer(size=32 * len(asked), usage=usage)
    entries = []
    for block in layout["ubos"]:
        data = bytearray(block["block_size"])
        for member in layout["types"][block["type"]]["members"]:
            value = np.array(values.get(member["name"], (0, 0, 0, 0)), "<f4").tobytes()
            data[member["offset"] : member["offset"] + 16] = value
        made = gpu.create_buffer_with_data(data=bytes(data), usage=wgpu.BufferUsage.UNIFORM)
        entries.append((block["binding"], {"buffer": made, "offset": 0, "size": made.size}))
    for one in layout["ssbos"]:
        buffer = {"asked": given, "found": answer}[one["name"]]
        entries.append((one["binding"], {"buffer": buffer, "offset": 0, "size": buffer.size}))
    for image in layout["separate_images"]:
        pixels = textures.get(image["name"], np.zeros((1, 1, 4), "<f2"))
        size = (pixels.shape[1], pixels.shape[0], 1)
        flags = wgpu.TextureUsage.TEXTURE_BINDING | wgpu.TextureUsage.COPY_DST
        made = gpu.create_texture(size=size, format="rgba16float", usage=flags)
        lines = {"bytes_per_row": 8 * size[0], "rows_per_image": size[1]}
        gpu.queue.write_texture({"texture": made}, pixels.tobytes(), lines, size)
        entries.append((image["binding"], made.create_view()))
    repeat = dict.fromkeys(("address_mode_u", "address_mode_v"), "repeat")
    linear = dict.fromkeys(("min_filter", "mag_filter", "mipmap_filter"), "linear")
    for one in layout["separate_samplers"]:
        entries.append((one["binding"], gpu.create_sampler(**repeat, **linear)))
    pipeline = gpu.create_compute_pipeline(
        layout="auto",
        compute={
            "module": gpu.create_shader_module(code=(tmp_path / "ask.spv").read_bytes()),
            "entry_point": "ask",
        },
    )
    group = gpu.create_bind_group(
        layout=pipeline.get_bind_group_layout(0),
        entries=[{"binding": binding, "resource": resource} for binding, resource in entries],
    )
    encoder = gpu.create_command_encoder()
    compute = encoder.begin_compute_pass()
    compute.set_pipeline(pipeline)
    compute.set_bind_group(0, group)
    compute.dispatch_workgroups(len(asked))
    compute.end()
    gpu.queue.submit([encoder.finish()])
    return np.frombuffer(gpu.queue.read_buffer(answer), "<f4").reshape(-1, 8).astype(float)


def places_in_tiles():
    """Return the vector of each tile: sides, and the eye's place, half a sample on."""
    vectors = []
    for n, size in TILES:
        sides, samples = np.broadcast_to(size, 2), np.broadcast_to(n, 2)
        vectors.append((*sides, *(EYE / sides % 1.0 + 0.5 / samples)))
    return vectors


# A filter weighs by fractions of 8 bits along each axis: 1/256 of the largest step between samples.
FILTER = 2 / 256


def steepest(planes, kind):
    """Return the largest step between neighbouring samples, summed over the tiles, of a channel."""
    return sum(
        np.max(np.abs(np.diff(planes[3 * i + kind].astype(float), axis=axis)), axis=(0, 1))
        for i in range(len(TILES))
        for axis in (0, 1)
    )


def test_unitys_functions_give_the_water(planes, tmp_path):
    rest = rest_places()
    textures = {
        f"_Sea{name}{i}": planes[3 * i + k]
        for i in range(len(TILES))
        for k, name in enumerate(("Moved", "Slopes", "Moments"))
    }
    values = {f"_SeaTile{i}": vector for i, vector in enumerate(places_in_tiles())}
    for i, (n, _) in enumerate(TILES):
        values[f"_SeaTexels{i}"] = (*np.broadcast_to(n, 2), 0, 0)
    values["_SeaEye"] = (EYE[0], 2.0, EYE[1], len(TILES))  # still water at 2 m
    asked = [(east, 2.0, north, 0.01) for east, north in rest]  # Unity: x east, y up, z north
    found = run(UNITY, "unity", textures, values, asked, tmp_path)
    moved, slopes = expected(planes, rest)
    wanted = np.stack(
        [rest[:, 0] + moved[:, 0], 2.0 + moved[:, 2], rest[:, 1] + moved[:, 1]], axis=-1
    )
    tolerance = FILTER * steepest(planes, 0)[[0, 2, 1]] + 1e-4
    assert np.all(np.abs(found[:, :3] - wanted) <= tolerance)
    assert np.ptp(moved[:, 2]) > 20 * tolerance[1]
    normal = normal_of(moved, slopes)[:, [0, 2, 1]]
    tolerance = FILTER * (steepest(planes, 0)[3] + steepest(planes, 1).max())
    assert np.abs(found[:, 4:7] - normal).max() <= tolerance
    assert np.ptp(normal[:, 0]) > 10 * tolerance


def test_unreals_functions_give_the_water(planes, tmp_path):
    """Centimetres, with y to the south."""
    rest = rest_places()
    textures = {
        f"{name}{i}": planes[3 * i + k]
        for i in range(len(TILES))
        for k, name in enumerate(("Moved", "Slopes"))
    }
    values = {f"Tile{i}": vector for i, vector in enumerate(places_in_tiles())}
    values["Eye"] = (100 * EYE[0], -100 * EYE[1], 0.0, 0.0)
    asked = [(100 * east, -100 * north, 200.0, 1.0) for east, north in rest]
    found = run(UNREAL, "unreal", textures, values, asked, tmp_path)
    moved, slopes = expected(planes, rest)
    wanted = 100 * np.stack(
        [rest[:, 0] + moved[:, 0], -rest[:, 1] - moved[:, 1], 2.0 + moved[:, 2]], axis=-1
    )
    tolerance = 100 * FILTER * steepest(planes, 0)[:3] + 0.01
    assert np.all(np.abs(found[:, :3] - wanted) <= tolerance)
    normal = normal_of(moved, slopes) * (1, -1, 1)
    tolerance = FILTER * (steepest(planes, 0)[3] + steepest(planes, 1).max())
    assert np.abs(found[:, 4:7] - normal).max() <= tolerance
