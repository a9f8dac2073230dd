"""The live page of a job with a crest: its sea, the job that it copies, and moving sliders."""

import pytest

import fftocean as fo
from fftocean.view.seas import MovingSeas, make_exact
from fftocean.view.state import State

JOB = """
[ocean]
n = 16
size = 60.0
[[ocean.crest]]
height = 0.9
x = 20.0
y = 10.0
t = 3.0
"""


def test_the_page_shows_the_crest_and_copies_it():
    state = State.of_job(fo.Job.from_toml(JOB)).changed({"wind_speed": 9.0})
    found = fo.gerstner.surface(state.cascade(dtype="float64"), 20.0, 10.0, 3.0)
    assert float(found.height) == pytest.approx(0.9, abs=1e-12)
    again = State.of_job(fo.Job.from_toml(state.toml()))
    assert (
        again.job().crests == state.job().crests == (fo.Crest(height=0.9, x=20.0, y=10.0, t=3.0),)
    )
    assert "[[ocean.crest]]" in state.command()


def test_a_slider_makes_each_sea_anew():
    """Moving amplitudes would lose the crest."""
    state = State.of_job(fo.Job.from_toml(JOB))
    moving = MovingSeas()
    moving.start(make_exact(state, 1))
    assert not moving.can_make(state.changed({"wind_speed": 12.0}))
