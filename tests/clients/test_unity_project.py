"""
The Unity project, without Unity: its C# compiled by mono against stubs and run as far as it goes,
its shaders compiled by glslang.
"""

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
EXAMPLES = HERE.parents[1] / "examples"
SEA = fo.Sea.from_wind(speed=12.0, fetch=200e3, depth=30.0, direction=30.0)
KERNELS = ("rows", "columns", "mips", "mips_far", "textures", "foam", "heights")


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Return the folder of an exported package with the project."""
    folder = tmp_path_factory.mktemp("unity") / "Sea"
    tiles = [(64, 420.0), ((32, 16), (61.0, 40.0))]
    cascade = fo.Cascade(SEA, tiles, loop=64.0, seed=3, choppiness=0.9)
    fo.export_sea(cascade, folder, textures=True, engine="unity")
    return folder


def levels(nx, ny):
    """Return the texels of all levels of a plane."""
    return nx * ny + (levels(max(nx // 2, 1), max(ny // 2, 1)) if nx * ny > 1 else 0)


def test_the_scripts_lay_the_waves_out_as_the_kernels_take_them(mono, project, tmp_path):
    """The arrays are those of the package's textures, to the bit but for the factors' last one."""
    compiler, runtime = mono
    scripts = sorted(project.rglob("*.cs"))
    assert {"SeaSurface.cs", "SeaWaves.cs", "SeaFileImporter.cs"} <= {s.name for s in scripts}
    stubs = [HERE / "unity" / "UnityProject.cs", HERE / "unity" / "Dump.cs"]
    # fields that Unity's inspector fills
    warnings = ["-warnaserror", "-warn:4", "-nowarn:0649,0414"]
    run(compiler, *warnings, "-out:dump.exe", *scripts, *stubs, cwd=tmp_path)
    texels = int(run(runtime, "dump.exe", project, cwd=tmp_path))
    first_map = 3 * levels(64, 64)
    assert texels == first_map + 3 * levels(32, 16)
    for name in ("h0", "wave"):
        expected = b"".join((project / f"tile{i}_{name}.bin").read_bytes() for i in range(2))
        found = np.fromfile(tmp_path / name, "<f4")
        wanted = np.frombuffer(expected, "<f4")
        assert found.shape == wanted.shape
        assert np.all(np.abs(found - wanted) <= 1.2e-7 * np.abs(wanted)), name
    found, wanted = (np.fromfile(p, "<f4") for p in (tmp_path / "twiddle", project / "twiddle.bin"))
    assert np.abs(found - wanted).max() <= 1e-7
    document = read_package(project).document
    foam, ticks = document["foam"], document["ticks"]
    head = struct.pack("<IIIIf", 0, ticks - 1, 2, 64, 1 / ticks) + bytes(44)
    head += struct.pack("<fff", foam["decay"], foam["threshold"], foam["strength"]) + bytes(20)
    rows = b""
    for i, (n, size, first, map_) in enumerate(
        [((64, 64), (420.0, 420.0), 0, 0), ((32, 16), (61.0, 40.0), 4096, first_map)]
    ):
        dk = [2 * np.pi / side for side in size]
        mixed = document["tiles"][i]["mixed"]
        rows += struct.pack("<4I8f4f", *n, first, map_, *size, *dk, 1, mixed, 1, 1, 0, 0, 0, 0)
    assert (tmp_path / "block").read_bytes() == (head + rows).ljust(1120, b"\0")


@pytest.mark.parametrize("kernel", KERNELS)
def test_the_compute_shader_compiles(kernel, project):
    require(shutil.which("glslangValidator"), "glslangValidator is not installed")
    source = project / "Sea.compute"
    assert f"#pragma kernel {kernel}\n" in source.read_text()
    glslang(source, "comp", kernel, project)


@pytest.mark.parametrize(("stage", "entry"), [("vert", "Vertex"), ("frag", "Fragment")])
def test_the_surface_shader_compiles(stage, entry, project):
    require(shutil.which("glslangValidator"), "glslangValidator is not installed")
    text = (project / "SeaWater.shader").read_text()
    (program,) = re.findall(r"HLSLPROGRAM\n(.*?)ENDHLSL", text, re.DOTALL)
    (project / "program.hlsl").write_text(program)
    glslang(project / "program.hlsl", stage, entry, project)


def glslang(source, stage, entry, folder):
    include = HERE / "unity" / "include"
    out = folder / f"{entry}.spv"
    options = ["-D", "-V", "--amb", "--aml", "-S", stage, "-e", entry, f"-I{include}", "-o", out]
    run("glslangValidator", *options, source, cwd=folder)


def test_the_project_names_every_file_that_it_needs(project):
    """Of the table in its README, and no more C# than is compiled above."""
    text = (project / "README.unity.md").read_text()
    assert text.startswith("> Not run in Unity")
    for name in ("Sea.compute", "SeaWaves.cs", "SeaPackage.cs", "SeaSurface.cs", "SeaWater.hlsl"):
        assert (project / name).is_file()
        assert f"`{name}`" in text
