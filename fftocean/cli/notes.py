"""Sentences about a sea, a bake or its cost that several commands print."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from fftocean.cli.console import note, size_in_words

if TYPE_CHECKING:
    from fftocean.baking.estimate import Estimate
    from fftocean.job.job import Job

_MUCH = 0.02
"""Share of the energy from which a note says that the tile cannot hold it."""


def note_unresolved_energy(m0: float, below: float, above: float) -> None:
    """
    Print notes on energy that the tile cannot hold, if it is much.

    Args:
        m0: specified variance of the sea [m^2].
        below: variance of waves longer than the tile [m^2].
        above: variance of waves shorter than two samples [m^2].
    """
    if m0 == 0.0:
        note("the sea is exactly flat")
        return
    for part, words in (
        (below, "longer than the tile; a larger --size holds them"),
        (above, "shorter than two samples; a larger --n holds them"),
    ):
        if part / m0 > _MUCH:
            note(f"{100 * part / m0:.0f} % of the energy is in waves {words}")


def note_energy_of_bake(statistics: Mapping[str, Any]) -> None:
    """Print the same notes from the statistics of a manifest or of a cascade's list."""
    note_unresolved_energy(
        statistics["ordered"]["m0"], statistics["energy_below"], statistics["energy_above"]
    )


def note_folds(extremes: Mapping[str, Any]) -> None:
    """Print a note if the water of a bake is folded anywhere."""
    from fftocean.products import folding_sentence

    if extremes.get("folded", 0.0) > 0.0:
        values = (extremes[name] for name in ("folded", "min_jacobian", "largest_choppiness"))
        note(folding_sentence(*values))


def print_loading(job: "Job") -> None:
    """
    Print how files of the format get into the engine, and what plays them, if the job names one.
    """
    from fftocean.baking.folder import engine_files
    from fftocean.export.engines import profile_for

    if job.engine != "canonical":
        print(f"{job.format} in {job.engine}: {profile_for(job.engine, job.format).note}")
        print(engine_files.in_words(job.describe()))


def print_video_memory(listed: Mapping[str, Any], frames: int) -> None:
    """Print the video memory of the maps of a bake or of all tiles of a cascade."""
    held, s = listed["video_memory"], "s" * (frames != 1)
    print(
        f"video memory of the maps in an engine: {size_in_words(held['bytes'])} for {frames} "
        f"frame{s}; with mip levels {size_in_words(held['bytes_with_all_levels'])}"
    )


def print_blending(blend: Mapping[str, Any]) -> None:
    """Print the amplitude that players keep which blend two frames."""
    from fftocean.blend_loss import sentence

    print(sentence(blend))


def memory(cost: "Estimate") -> str:
    """Return the memory of a bake in words."""
    each = f"about {size_in_words(cost.memory)} in each of {cost.workers} processes"
    if cost.workers == 1:
        each = f"about {size_in_words(cost.memory)}"
    if not cost.container:
        return each
    return f"{each}, then {size_in_words(cost.container)} for the container"


def video_memory(cost: "Estimate") -> str:
    """Return the video memory of a bake's maps in words."""
    one = size_in_words(cost.video / cost.frames)
    return f"{size_in_words(cost.video)} for {cost.frames} frames, {one} a frame"
