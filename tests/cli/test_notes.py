"""Sentences that several commands print: energy outside the tile, folds, memory."""

import pytest

from fftocean.baking.estimate import Estimate
from fftocean.cli import notes

MIB = 2**20


def cost(**changes):
    numbers = {
        "frames": 4,
        "files": 6,
        "bytes": 1000,
        "seconds": 1.0,
        "memory": 10.0 * MIB,
        "container": 0.0,
        "video": 8.0 * MIB,
        "executor": "serial",
        "workers": 1,
    }
    return Estimate(**{**numbers, **changes})


@pytest.mark.parametrize("m0", [0.01, 1.0, 100.0])
def test_energy_is_told_from_two_percent_of_the_sea_on(m0, capsys):
    """A share of the specified energy, whatever its size."""
    notes.note_unresolved_energy(m0, 0.019 * m0, 0.019 * m0)
    assert capsys.readouterr().err == ""
    notes.note_unresolved_energy(m0, 0.05 * m0, 0.3 * m0)
    assert capsys.readouterr().err.splitlines() == [
        "note: 5 % of the energy is in waves longer than the tile; a larger --size holds them",
        "note: 30 % of the energy is in waves shorter than two samples; a larger --n holds them",
    ]


def test_a_flat_sea_is_told(capsys):
    notes.note_unresolved_energy(0.0, 0.0, 0.0)
    assert capsys.readouterr().err == "note: the sea is exactly flat\n"


def test_folds_are_told_where_there_are_any(capsys):
    extremes = {"folded": 0.0, "min_jacobian": 0.2, "largest_choppiness": None}
    notes.note_folds(extremes)
    assert capsys.readouterr().err == ""
    notes.note_folds({"folded": 0.03, "min_jacobian": -0.2, "largest_choppiness": 0.8})
    err = capsys.readouterr().err
    assert err.startswith("note: ")
    assert "0.8" in err


def test_memory_is_that_of_each_process_and_of_the_container():
    assert notes.memory(cost()) == "about 10 MiB"
    assert notes.memory(cost(workers=3)) == "about 10 MiB in each of 3 processes"
    assert notes.memory(cost(container=5.0 * MIB)) == "about 10 MiB, then 5 MiB for the container"


def test_video_memory_is_that_of_all_frames_and_of_one():
    assert notes.video_memory(cost()) == "8 MiB for 4 frames, 2 MiB a frame"


@pytest.mark.parametrize(("frames", "words"), [(1, "1 frame;"), (3, "3 frames;")])
def test_video_memory_of_a_bake_counts_its_frames(frames, words, capsys):
    listed = {"video_memory": {"bytes": 3 * MIB, "bytes_with_all_levels": 4 * MIB}}
    notes.print_video_memory(listed, frames)
    out = capsys.readouterr().out
    assert f"3 MiB for {words} with mip levels 4 MiB\n" in out
