"""`fftocean info`: describe a job before it is baked."""

import argparse
from collections.abc import Iterator
from typing import TYPE_CHECKING

from fftocean.cli import notes
from fftocean.cli.arguments import add_tiles_flag
from fftocean.cli.command import Command
from fftocean.cli.console import (
    console_for,
    key_value_table,
    plain,
    shortened,
    value_in_words,
)
from fftocean.cli.job_flags import add_job_flags, job_of

if TYPE_CHECKING:
    from rich.table import Table

    from fftocean.baking.estimate import Estimate
    from fftocean.job.job import Job
    from fftocean.ocean import Ocean
    from fftocean.statistics import Statistics

_FRAMES_MEASURED = 8
"""Most frames of the loop in which folds are looked for."""


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean info`."""
    add_tiles_flag(parser)
    add_job_flags(parser)


def run(options: argparse.Namespace) -> int:
    """Print what a job means: its keys, its sea, its tile, its cost."""
    from rich.text import Text

    from fftocean.baking.bake import scene_for
    from fftocean.baking.estimate import estimate
    from fftocean.statistics import measure

    job = job_of(options)
    if options.tiles:
        return _describe_cascade(options, job)
    scene = scene_for(job, 1, job.frames)
    statistics = measure(scene.ocean, frames=min(job.frames, _FRAMES_MEASURED))
    console = console_for()
    console.print(_keys(job))
    for key, remarks in job.measured_notes().items():
        for remark in remarks:
            console.print(Text(f"{key}: {plain(remark)}"))
    console.print(_sea(statistics))
    table = key_value_table("\nTile")
    rows = (
        *_tile(scene.ocean, statistics),
        *_foam(job, scene.ocean),
        *_cost(estimate(job, scene=scene), job, scene.ocean),
    )
    for name, text in rows:
        table.add_row(name, Text(text))
    console.print(table)
    assert statistics.specified is not None  # a job has a sea
    notes.note_unresolved_energy(
        statistics.specified.m0, statistics.energy_below, statistics.energy_above
    )
    return 0


def _keys(job: "Job") -> "Table":
    """Return the table of a job's keys."""
    from rich.text import Text

    from fftocean.job.fixed_tables import CREST, FIX
    from fftocean.job.parameters import PARAMETERS

    units = {p.key: p.unit for p in PARAMETERS}
    table = key_value_table(f"Job: {plain(job.source)}")
    for key, value in job.describe().items():
        if key in ("sea.systems", CREST, FIX):
            for i, row in enumerate(value):
                table.add_row(f"{key}[{i}]", Text(shortened(row)))
        else:
            table.add_row(key, f"{value_in_words(value)} {units[key]}".rstrip())
    return table


def _sea(statistics: "Statistics") -> "Table":
    """Return the table of the specified sea beside the realised one."""
    from rich.table import Table

    realised, specified = statistics, statistics.specified
    assert specified is not None  # a job has a sea
    table = Table(title="\nSea", title_justify="left", box=None, pad_edge=False)
    for heading in ("", "specified", "realised", "expected scatter (1 sigma)"):
        table.add_column(heading, justify="left" if not heading else "right", no_wrap=not heading)
    for name, one, other, *scatter in (
        (
            "significant wave height Hs",
            f"{specified.hs:.3f} m",
            f"{realised.hs:.3f} m",
            f"{realised.hs_scatter:.3f} m",
        ),
        ("peak period Tp", f"{specified.tp:.2f} s", f"{realised.tp:.2f} s"),
        (
            "mean direction, toward",
            f"{specified.mean_direction:.1f} deg",
            f"{realised.mean_direction:.1f} deg",
        ),
        ("directional spread", f"{specified.spread:.1f} deg", f"{realised.spread:.1f} deg"),
        *_skewness(statistics),
    ):
        table.add_row(name, one, other, *scatter)
    return table


def _skewness(statistics: "Statistics") -> Iterator[tuple[str, str, str]]:
    """Yield the row of a sea of order 2: specified, and of the waves of this seed."""
    if (found := statistics.skewness) is not None:
        expected = f"{found.expected:.3f}, {100 * found.share:.0f} % resolved"
        yield "skewness of the elevation", f"{found.specified or 0.0:.3f}", expected


def _tile(ocean: "Ocean", statistics: "Statistics") -> Iterator[tuple[str, str]]:
    """Yield what a tile holds of the sea: a name and a text each."""
    from fftocean.physics.plausibility import plausibility
    from fftocean.statistics import peak_wavelength, shortest_wavelength

    if (length := peak_wavelength(ocean)) > 0.0:
        across = min(ocean.grid.lx, ocean.grid.ly) / length
        yield "peak wavelength", f"{length:.3g} m, {across:.1f} across the tile"
    yield "shortest wave", f"{shortest_wavelength(ocean.grid):.3g} m, two samples"
    below, above = statistics.share_below, statistics.share_above
    yield (
        "unresolved energy",
        f"{100 * below:.2f} % in longer waves, {100 * above:.2f} % in shorter ones",
    )
    if error := statistics.loop:
        better = ""
        if error.better_period != error.period:
            better = f"; {error.better_period:g} s would have {100 * error.better_rms:.1f} %"
        yield (
            "loop frequency error",
            f"{100 * error.rms:.1f} % rms, {100 * error.bias:+.1f} % bias{better}",
        )
    if ocean.bound_waves is not None:
        yield "second order", str(ocean.bound_waves.report)
    yield "folds", str(statistics.folding)
    if ocean.rarity is not None:
        yield "fixed values", str(ocean.rarity)
        yield "", "they come back on every tile, and with every loop"
    assert ocean.sea is not None  # a job has a sea
    yield "wave height and steepness", str(plausibility(ocean.sea))
    for part in dict.fromkeys((ocean.sea.depth_from, ocean.sea.surface_tension_from)):
        if part:
            yield "water properties from", part
    if ocean.backend == "gpu":
        from fftocean.gpu import adapter

        yield "graphics adapter", str(adapter())
    else:
        yield "FFT library", ocean.backend


def _foam(job: "Job", ocean: "Ocean") -> Iterator[tuple[str, str]]:
    """Yield the foam of a job that bakes it: a name and a text."""
    if "foam" in job.maps:
        foam = job.describe_foam(ocean)
        yield (
            "foam",
            f"covers {100.0 * foam['coverage']:.2g} % of the water on average; threshold "
            f"{foam['threshold']:.4g}, {foam['threshold_from']}",
        )


def _cost(cost: "Estimate", job: "Job", ocean: "Ocean") -> Iterator[tuple[str, str]]:
    """Yield what a bake of the job comes to: a name and a text each."""
    from fftocean import blend_loss

    yield "files", f"{cost.files} files of {len(job.maps)} maps, about {cost.bytes / 1e6:.0f} MB"
    yield "memory", notes.memory(cost)
    yield "video memory", f"{notes.video_memory(cost)}, as textures in an engine"
    yield "time to bake", f"about {cost.seconds:.0f} s here"
    yield "frame blending", blend_loss.sentence(blend_loss.describe(ocean, job.frames))


def _describe_cascade(options: argparse.Namespace, job: "Job") -> int:
    """Print what a job means as a cascade."""
    from rich.text import Text

    from fftocean.baking.cascade import estimate_prepared
    from fftocean.baking.cascade_setup import prepare

    water = prepare(job, options.tiles)
    cost = estimate_prepared(water)
    table = key_value_table(f"Cascade: {plain(job.source)}")
    for name, text in (
        *water.rows(),
        ("files", f"{cost.files} files, about {cost.bytes / 1e6:.0f} MB"),
        ("memory", f"{notes.memory(cost)}, for the largest tile"),
        ("video memory", f"{notes.video_memory(cost)}, as textures in an engine"),
        ("time to bake", f"about {cost.seconds:.0f} s here"),
    ):
        table.add_row(name, Text(text))
    console_for().print(table)
    return 0


COMMAND = Command(
    name="info",
    arguments="[JOB.toml] [--tiles N:SIZE,...]",
    summary="describe a job: sea, tile, loop, files, memory, time",
    examples=("fftocean info", "fftocean info gale.toml --size 800"),
    run=run,
    add_flags=add_flags,
)
