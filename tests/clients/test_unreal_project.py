"""
The Unreal plugin, without Unreal: its C++ compiled by g++ against stubs and run as far as it goes,
its build rules by mono, its shaders by glslang.
"""

import json
import re
import shutil
import struct
from pathlib import Path

import numpy as np
import pytest
from builders import run
from conftest import require

import fftocean as fo
from fftocean.runtime.folder import read_package

pytestmark = pytest.mark.client

HERE = Path(__file__).resolve().parent
STUBS = HERE / "unreal"
SEA = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
KERNELS = ("rows", "columns", "mips", "mips_far", "textures", "foam", "heights")
WARNINGS = ("-Wall", "-Wextra", "-Wshadow", "-Werror", "-Wno-unused-parameter")


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Return the folder of an exported package with the plugin."""
    folder = tmp_path_factory.mktemp("unreal") / "FFTOcean"
    tiles = [(64, 420.0), ((32, 16), (61.0, 40.0))]
    cascade = fo.Cascade(SEA, tiles, loop=64.0, seed=3, choppiness=0.9)
    fo.export_sea(cascade, folder, textures=True, engine="unreal")
    return folder


@pytest.fixture(scope="module")
def headers(project, tmp_path_factory):
    """Return a folder with a header of every name of Unreal's that the plugin includes."""
    folder = tmp_path_factory.mktemp("headers")
    own = {path.name for path in project.rglob("*.h*")}
    for source in project.rglob("*.[hc]*"):
        for name in re.findall(r'#include "([^"]+)"', source.read_text()):
            if Path(name).name not in own and name.endswith(".h"):
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_text(f'#include "{STUBS / "Unreal.h"}"\n')
    return folder


@pytest.mark.parametrize("name", ["FFTOceanModule.cpp", "SeaComponent.cpp", "SeaKernels.cpp"])
def test_a_source_compiles_against_stubs(name, project, headers, tmp_path):
    require(shutil.which("g++"), "g++ is not installed")
    module = project / "Source" / "FFTOcean"
    places = (project, module / "Public", module / "Private", headers)
    include = [f"-I{place}" for place in places]
    source = module / "Private" / name
    run("g++", "-std=c++20", "-fsyntax-only", *WARNINGS, *include, source, cwd=tmp_path)


def test_every_source_is_compiled(project):
    sources = {path.name for path in project.rglob("*.cpp")}
    assert sources == {"FFTOceanModule.cpp", "SeaComponent.cpp", "SeaKernels.cpp"}


def test_the_plugin_lays_the_waves_out_as_the_kernels_take_them(project, tmp_path):
    """The arrays are those of the package's textures, to the bit but for the factors' last one."""
    require(shutil.which("g++"), "g++ is not installed")
    include = [f"-I{project}", f"-I{project / 'Source' / 'FFTOcean' / 'Private'}"]
    run(
        *("g++", "-std=c++17", "-O1", *WARNINGS, *include),
        *(STUBS / "Dump.cpp", "-o", "dump"),
        cwd=tmp_path,
    )
    texels, map_texels, groups = map(int, run("./dump", project, cwd=tmp_path).split())
    # 3 planes of all levels: (4^7 - 1)/3 texels of 64 x 64; 512 + 128 + 32 + 8 + 2 + 1 of 32 x 16
    assert (texels, map_texels, groups) == (4096 + 512, 3 * (5461 + 683), 8)
    for name in ("h0", "wave"):
        expected = b"".join((project / f"tile{i}_{name}.bin").read_bytes() for i in range(2))
        found, wanted = np.fromfile(tmp_path / name, "<f4"), np.frombuffer(expected, "<f4")
        assert found.shape == wanted.shape
        assert np.all(np.abs(found - wanted) <= 1.2e-7 * np.abs(wanted)), name
    found, wanted = (np.fromfile(p, "<f4") for p in (tmp_path / "twiddle", project / "twiddle.bin"))
    assert np.abs(found - wanted).max() <= 1e-7
    document = read_package(project).document
    expected = b""
    for tile, first, first_map in zip(document["tiles"], (0, 4096), (0, 3 * 5461), strict=True):
        dk = [2 * np.pi / side for side in tile["size"]]
        whole = (*tile["n"], first, first_map)
        rest = (*tile["size"], *dk, 1, tile["mixed"], 1, 1, 0, 0, 0, 0)
        expected += struct.pack("<4I12f", *whole, *rest)
    assert (tmp_path / "tiles").read_bytes() == expected


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_kernel_compiles_with_the_bindings_of_the_plugin(kernel, project, tmp_path):
    require(shutil.which("glslangValidator"), "glslangValidator is not installed")
    text = with_includes(project / "Sea.usf", project)
    (tmp_path / "kernel.hlsl").write_text(text)
    options = ["-D", "-V", "--amb", "--aml", "-S", "comp", "-e", kernel, "-o", "kernel.spv"]
    run("glslangValidator", *options, "kernel.hlsl", cwd=tmp_path)


def with_includes(source, project):
    """Return a shader with its includes, whose folders only Unreal knows, in their place."""

    def included(match):
        name = match[1]
        place = project / name.removeprefix("/FFTOcean/")
        return (place if place.is_file() else STUBS / "include" / name[1:]).read_text()

    return re.sub(r'#include "([^"]+)"', included, source.read_text())


def test_the_kernels_are_given_every_parameter_that_they_declare(project):
    """Names of the shader parameters are those of Sea.usf, but for the height query's."""
    usf = (project / "Sea.usf").read_text()
    usf = re.sub(r"//[^\n]*", "", usf)
    usf = re.sub(r"struct \w+\s*\{.*?\};", "", usf, flags=re.DOTALL)
    declared = {
        name.strip()
        for line in re.findall(r"^[\w<>]+ ([^;{}()]+);", usf, re.MULTILINE)
        for name in line.split(",")
    }
    source = (project / "Source/FFTOcean/Private/SeaKernels.cpp").read_text()
    given = set(re.findall(r"SHADER_PARAMETER\w*\([^,\n]+, (\w+)\)", source))
    assert given == declared - {"points", "iterations", "answers", "places"}
    assert {"tick", "table", "h0", "image"} <= given


def test_the_functions_of_materials_compile(project, tmp_path):
    require(shutil.which("glslangValidator"), "glslangValidator is not installed")
    (tmp_path / "water.hlsl").write_text(
        (project / "SeaWater.ush").read_text()
        + """
Texture2D Moved;
SamplerState Sampler;
float4 Eye, TileOf;
float4 Fragment(float2 Rest : TEXCOORD0) : SV_Target
{
    float3 D = SeaMove(Moved, Sampler, Rest, Eye, TileOf, 10.0);
    return float4(D + SeaNormal(SeaSlopes(Moved, Sampler, Rest, Eye, TileOf), 0.1), 1.0);
}
"""
    )
    options = ["-D", "-V", "--amb", "--aml", "-S", "frag", "-e", "Fragment", "-o", "water.spv"]
    run("glslangValidator", *options, "water.hlsl", cwd=tmp_path)


def test_the_build_rules_compile(mono, project, tmp_path):
    compiler, _ = mono
    rules = project / "Source" / "FFTOcean" / "FFTOcean.Build.cs"
    stubs = STUBS / "UnrealBuildTool.cs"
    run(compiler, "-warnaserror", "-target:library", "-out:rules.dll", rules, stubs, cwd=tmp_path)


def test_the_descriptor_names_the_module(project):
    descriptor = json.loads((project / "FFTOcean.uplugin").read_text())
    (module,) = descriptor["Modules"]
    assert (project / "Source" / module["Name"] / f"{module['Name']}.Build.cs").is_file()
    assert module["LoadingPhase"] == "PostConfigInit"  # shaders are mapped before they are compiled
    assert descriptor["Description"].startswith("Not run in Unreal")
    assert (project / "README.unreal.md").read_text().startswith("> Not run in Unreal")
