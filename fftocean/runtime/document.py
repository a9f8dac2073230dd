"""Document of a run-time package: `sea.json`, all that a program must know besides the waves."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

import fftocean
from fftocean.constants import GRAVITY
from fftocean.foam import Foam
from fftocean.grid import Grid
from fftocean.runtime import describe
from fftocean.runtime.layout import FORMAT, VERSION
from fftocean.runtime.planes import Planes
from fftocean.runtime.records import Records
from fftocean.runtime.source import Source

CONVENTIONS = {
    "axes": "x east, y north, z up; metres, seconds, radians",
    "texel": "texel (i, j) from 0 has its centre at u = (i + 1/2)/nx and is the water that rests "
    "at x = i lx/nx, y = j ly/ny; row 0 is y = 0",
    "waves": "h(k, t) = h0(k) e^(-i omega t) + conj(h0(-k)) e^(+i omega t), "
    "height = sum of h e^(+i k.x), k = 2 pi (mx/lx, my/ly); without 1/N",
    "phase": "omega t = 2 pi cycles tick/ticks; (cycles * tick) mod ticks is exact",
    "displacement": "sum of (+i k/|k|)/tanh(|k| depth) h e^(+i k.x), times choppiness",
    "records": "the whole plane of wavenumbers: +k and -k are two records; a wavenumber without "
    "a record has h0 = 0",
    "order": "little-endian",
}


def compose(
    source: Source,
    whole: Sequence[Planes],
    records: Sequence[Records],
    *,
    ticks: int,
    quality: str,
    measured: bool,
    foam: Foam | None,
    wind: tuple[float, float] | None,
    job: str | None,
) -> dict[str, Any]:
    """
    Return the document, but for the list of files.

    Args:
        source: the waves.
        whole: the planes of each tile.
        records: the waves of each tile.
        ticks: moments of the loop.
        quality: "exact" or "moving".
        measured: measure bounds on fields, which takes time, instead of estimating them.
        foam, wind, job: as in `pack`.
    """
    first = source.tiles[0]
    loop = source.loop
    waves = describe.wave_table(source, records)
    return {
        "format": FORMAT,
        "version": VERSION,
        "tool": f"fftocean {fftocean.__version__}",
        "quality": quality,
        "job": job,
        "loop": loop,
        "ticks": ticks,
        "choppiness": source.choppiness,
        "depth": first.depth if math.isfinite(first.depth) else None,
        "gravity": GRAVITY,
        "surface_tension": first.surface_tension,
        "conventions": CONVENTIONS,
        "statistics": {
            "specified": describe.specified_state(source.sea, exact=quality == "exact"),
            "realised": describe.realised_state(waves, loop),
        },
        **({} if first.rarity is None else {"constrained": first.rarity.as_plain()}),
        "slope_variance": describe.roughness(source, wind),
        "foam": describe.foam_for(source, wind)
        if foam is None
        else {"decay": foam.tau, "threshold": foam.threshold, "strength": foam.strength},
        "wind": None if wind is None else {"speed": wind[0], "direction": wind[1]},
        "bounds": describe.measured_bounds(source)
        if measured
        else describe.estimated_bounds(waves, source),
        "spectrum": describe.spectrum_table(waves, loop, source.sea),
        "tiles": [
            {
                "n": [tile.grid.nx, tile.grid.ny],
                "size": [tile.grid.lx, tile.grid.ly],
                "band": [tile.band[0], tile.band[1] if math.isfinite(tile.band[1]) else None],
                "seed": seed,
                "waves": len(own),
                "most_cycles": plane.most_cycles,
                "mixed": lift_of(tile.grid, own),
            }
            for tile, seed, plane, own in zip(
                source.tiles, source.seeds, whole, records, strict=True
            )
        ],
    }


def lift_of(grid: Grid, waves: Records) -> float:
    """
    Return the power of two that lifts d displace_x/dy to the size of the height.

    Transforms of two real fields in one complex one round the smaller field by the larger one's
    size. A power of two costs no digit. The two sizes are those of the waves in deep water, where
    one is the other times kx ky / k.
    """
    kx, ky = waves["mx"] * grid.dkx, waves["my"] * grid.dky
    weight = waves["re"].astype(np.float64) ** 2 + waves["im"].astype(np.float64) ** 2
    height, stretch = np.sum(weight), np.sum(weight * (kx * ky) ** 2 / (kx**2 + ky**2))
    if not stretch > 0.0:  # no waves, or all of them along an axis
        return 1.0
    return 2.0 ** round(0.5 * math.log2(height / stretch))
