"""
Engines for which a run-time package can be exported, with the project that is copied beside it.

An engine is one row of one table. A row with a missing part is an error at import.
"""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

from fftocean.errors import ParameterError, suggestion

LANGUAGES = ("wgsl", "hlsl", "glsl", "metal")
"""Languages of the kernels; `fftocean.runtime.shaders` has the files of each."""
TEXTURES = ("bin", "ktx2", "exr")
"""Formats of the textures of waves."""
KERNEL_SIDE, MOST_SIDE = 512, 1024
"""
Samples a side of a tile, at most: of the kernels, whose numbers of a line take 16 KiB of memory,
and of any package.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Engine:
    """An engine that can evolve a package's waves."""

    name: str  # of `--engine`
    caption: str
    project: str  # folder in `examples/`
    languages: tuple[str, ...]  # of the kernels that the project uses; () if it has its own
    renamed: tuple[tuple[str, str], ...]  # endings of kernels that the engine wants otherwise
    readers: tuple[str, ...]  # files of `examples/readers` that the project uses
    textures: str | None  # format of the textures that the project reads; None if it reads waves
    most_side: int  # samples a side of a tile, at most
    first_step: str  # what a user does next, as a sentence

    @property
    def readme(self) -> str:
        """Name of the project's README beside that of the package."""
        return f"README.{self.name}.md"


def table_of(engines: Iterable[Engine]) -> dict[str, Engine]:
    """
    Return engines by name.

    Raises:
        ImportError: two of one name, or one with a missing or unknown part.
    """
    table: dict[str, Engine] = {}
    for engine in engines:
        if engine.name in table:
            raise ImportError(f"names of engines must differ, got {engine.name!r} twice")
        table[engine.name] = engine
        for field in fields(engine):
            value = getattr(engine, field.name)
            if value == "":
                raise ImportError(f"engine {engine.name} must have a {field.name}")
        rules: dict[str, tuple[Any, tuple[Any, ...]]] = {
            "languages": (engine.languages, LANGUAGES),
            "textures": ([engine.textures], (*TEXTURES, None)),
            "most_side": ([engine.most_side], (KERNEL_SIDE, MOST_SIDE)),
        }
        for name, (values, known) in rules.items():
            if not set(values) <= set(known):
                raise ImportError(f"{name} of engine {engine.name} must be of {known}")
        if engine.languages and engine.most_side > KERNEL_SIDE:
            raise ImportError(f"most_side of engine {engine.name} must be at most {KERNEL_SIDE}")
    return table


ENGINES: dict[str, Engine] = table_of((
    Engine(
        name="unity",
        caption="Unity 2021.3 or later",
        project="unity",
        languages=("hlsl",),
        renamed=(),
        readers=("SeaWaves.cs",),
        textures=None,
        most_side=KERNEL_SIDE,
        first_step="move the folder into Assets, and follow README.unity.md",
    ),
    Engine(
        name="unreal",
        caption="Unreal Engine 5.3 or later",
        project="unreal",
        languages=("hlsl",),
        renamed=((".hlsl", ".ush"),),  # other files cannot be included there
        readers=("sea_waves.hpp",),
        textures=None,
        most_side=KERNEL_SIDE,
        first_step="move the folder into Plugins of a C++ project, and follow README.unreal.md",
    ),
    Engine(
        name="godot",
        caption="Godot 4.3 or later",
        project="godot4",
        languages=("glsl",),
        renamed=(),
        readers=("sea_waves.gd",),
        textures=None,
        most_side=KERNEL_SIDE,
        first_step="open project.godot in it",
    ),
    Engine(
        name="bevy",
        caption="Bevy 0.15",
        project="bevy",
        languages=("wgsl",),
        renamed=(),
        readers=("sea_waves.rs",),
        textures=None,
        most_side=KERNEL_SIDE,
        first_step="run `cargo run --release` in it",
    ),
    Engine(
        name="three",
        caption="three.js, WebGL 2",
        project="threejs",
        languages=(),
        renamed=(),
        readers=(),
        textures=None,
        most_side=MOST_SIDE,
        first_step="serve the folder, such as by `python -m http.server`, and open index.html",
    ),
    Engine(
        name="webgpu",
        caption="a page with WebGPU",
        project="webgpu",
        languages=("wgsl",),
        renamed=(),
        readers=(),
        textures=None,
        most_side=KERNEL_SIDE,
        first_step="serve the folder, such as by `python -m http.server`, and open index.html",
    ),
))  # fmt: skip


def engine_of(name: Any) -> Engine | None:
    """
    Return an engine by name; None for None.

    Raises:
        ParameterError: there is none of this name.
    """
    if name is None:
        return None
    if not isinstance(name, str) or name not in ENGINES:
        raise ParameterError(
            f"engine must be one of {', '.join(ENGINES)}, got {name!r:.40}"
            f"{suggestion(name, ENGINES)}"
        )
    return ENGINES[name]
