"""Table of the engines for which a run-time package can be exported."""

from dataclasses import replace

import pytest

from fftocean import engine_projects
from fftocean.engine_projects import ENGINES, engine_of, table_of
from fftocean.errors import ParameterError


def test_the_engines_are_those_of_the_command_line():
    assert list(ENGINES) == ["unity", "unreal", "godot", "bevy", "three", "webgpu"]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"project": ""}, "engine unity must have a project"),
        ({"first_step": ""}, "engine unity must have a first_step"),
        ({"languages": ("cg",)}, "languages of engine unity must be of"),
        ({"textures": "png"}, "textures of engine unity must be of"),
        ({"most_side": 700}, "most_side of engine unity must be of"),
        ({"most_side": 1024}, "most_side of engine unity must be at most 512"),
    ],
)
def test_a_row_with_a_missing_part_is_an_error_at_import(changes, words):
    with pytest.raises(ImportError, match=words):
        table_of([replace(ENGINES["unity"], **changes)])


def test_two_engines_of_one_name_are_an_error_at_import():
    with pytest.raises(ImportError, match="'unity' twice"):
        table_of([ENGINES["unity"], ENGINES["unity"]])


def test_an_unknown_engine_is_refused_with_the_known_ones():
    assert engine_of(None) is None
    with pytest.raises(ParameterError, match=r"one of unity, .*, got 'quake'"):
        engine_of("quake")
    with pytest.raises(ParameterError, match="engine must be one of"):
        engine_of(["unity"])


def test_the_limit_of_the_kernels_is_that_of_their_memory():
    """Two complex numbers of two floats, twice, a sample: 32 bytes."""
    assert engine_projects.KERNEL_SIDE * 2 * 16 == 16 * 1024
