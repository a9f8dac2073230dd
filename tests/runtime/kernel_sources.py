"""
Kernels as `wgpu` takes them: the WGSL, and SPIR-V of the HLSL and of the generated GLSL.
"""

import shutil
import subprocess
from pathlib import Path

from builders import require

from fftocean.runtime.shaders import ENTRY_POINTS, files

FORMAT = "FFTOCEAN_IMAGE_FORMAT=[[spv::format_rgba16f]] [[spv::nonreadable]]"
KINDS = ("wgsl", "hlsl-glslang", "hlsl-glslc", "glsl")
"""The WGSL; HLSL by two compilers, one of which optimises; and the GLSL that is generated."""


def require_command(name):
    """Skip or fail the test if a command is not installed."""
    require(shutil.which(name), f"{name} is not installed")


def run(*command):
    """Run a command; fail the test with its messages if it fails."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}"
    return done.stdout


def command_for(kind, entry, source, binary):
    """Return the command that compiles an entry point of a source to SPIR-V."""
    if kind == "hlsl-glslang":
        return (
            *("glslangValidator", "-D", "-S", "comp", "-e", entry, "-V", f"-D{FORMAT}"),
            *("-o", binary, source),
        )
    if kind == "hlsl-glslc":
        return (
            *("glslc", "-x", "hlsl", "-fshader-stage=comp", f"-fentry-point={entry}", "-O"),
            *(f"-D{FORMAT}", "-o", binary, source),
        )
    return "glslangValidator", "-S", "comp", "-V", "-o", binary, source


def shaders(kind, folder, changed=lambda text: text):
    """
    Return the shaders of a kind, as `GpuSea` takes them, and the name of their entry points.

    Args:
        kind: of `KINDS`.
        folder: for the files of the compilers.
        changed: what is done to the text before; for tests of the tests.
    """
    if kind == "wgsl":
        return changed(files("wgsl")["fftocean.wgsl"].decode()), None
    language = kind.partition("-")[0]
    require_command("glslc" if kind == "hlsl-glslc" else "glslangValidator")
    found = {}
    for entry in ENTRY_POINTS:
        name = "fftocean.hlsl" if language == "hlsl" else f"fftocean_{entry}.glsl"
        source, binary = Path(folder) / name, Path(folder) / f"{entry}.spv"
        source.write_text(changed(files(language)[name].decode()), encoding="utf-8")
        run(*command_for(kind, entry, source, binary))
        if shutil.which("spirv-val"):
            run("spirv-val", "--target-env", "vulkan1.1", binary)
        found[entry] = binary.read_bytes()
    return found, ("main" if language == "glsl" else None)


def device():
    """Return a device of `wgpu`; skip or fail the test if there is none."""
    try:
        import wgpu
    except ImportError:
        wgpu = None
    require(wgpu, "the package wgpu is not installed")
    # wgpu falls back to OpenGL, whose shaders it cannot write in every case
    adapters = [
        adapter
        for adapter in wgpu.gpu.enumerate_adapters_sync()
        if adapter.info["backend_type"] != "OpenGL"
    ]
    require(adapters, "there is no graphics processor, and no software Vulkan (lavapipe)")
    return adapters[0].request_device_sync()
