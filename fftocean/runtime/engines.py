"""Kernels of an engine, and the tiles that it can transform."""

from fftocean.engine_projects import KERNEL_SIDE, Engine
from fftocean.errors import ParameterError
from fftocean.grid import Grid
from fftocean.runtime import shaders


def kernels_of(engine: Engine) -> dict[str, bytes]:
    """Return the kernels of an engine's languages by file name."""
    found = {}
    for language in engine.languages:
        for name, data in shaders.files(language).items():
            for ending, wanted in engine.renamed:
                name = name.removesuffix(ending) + wanted if name.endswith(ending) else name
            found[name] = data
    return dict(sorted(found.items()))


def require_engine_sides(engine: Engine, grid: Grid, name: str) -> None:
    """
    Raise if a tile has more samples than an engine's project can transform.

    Raises:
        ParameterError: nx or ny is too large.
    """
    n = max(grid.nx, grid.ny)
    if n > engine.most_side:
        why = (
            ", since the kernels keep a line in 16 KiB of a graphics processor's shared memory"
            if engine.most_side == KERNEL_SIDE
            else ""
        )
        raise ParameterError(
            f"n of {name} must be a power of two of at most {engine.most_side} for engine "
            f"{engine.name}{why}; got {n}"
        )
