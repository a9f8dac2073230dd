"""
Kernels by which a graphics processor runs the sea of a package; docs/kernels.md describes them.

`fftocean.wgsl` and `fftocean.hlsl` are the two sources. `tools/shaders.py` generates the others,
one file an entry point: GLSL 450 for Vulkan and Godot, and Metal.
"""

from fftocean.errors import ParameterError
from fftocean.shader_files import shader

ENTRY_POINTS = ("rows", "columns", "mips", "mips_far", "textures", "foam", "heights")
"""The kernels, in the order in which a frame runs them."""

SOURCES = ("wgsl", "hlsl")
GENERATED = ("glsl", "metal")
LANGUAGES = SOURCES + GENERATED

MOST_SIDE = 512
"""Samples a side of a tile, at most: four complex fields of one line fill 16 KiB."""
MOST_TILES = 16


def names(language: str) -> tuple[str, ...]:
    """
    Return the names of the files of a language.

    Raises:
        ParameterError: there are no kernels in this language.
    """
    if language in SOURCES:
        return (f"fftocean.{language}",)
    if language in GENERATED:
        return tuple(f"fftocean_{entry}.{language}" for entry in ENTRY_POINTS)
    raise ParameterError(f"language must be one of {', '.join(LANGUAGES)}, got {language!r:.40}")


def files(language: str) -> dict[str, bytes]:
    """
    Return the kernels in a language: file name -> contents.

    Args:
        language: "wgsl" or "hlsl", one file with all entry points; "glsl" or "metal", a file each.

    Raises:
        ParameterError: there are no kernels in this language.
    """
    return {name: shader(name) for name in names(language)}
