"""Crests and fixed values in job files: read, described, passed on, and refused."""

import json

import numpy as np
import pytest
from builders import job_text

import fftocean as fo
from fftocean.job.job_text import job_text as text_of

SMALL = {"ocean__n": 32, "ocean__size": 100.0, "ocean__loop": 40.0, "sea__wind__speed": 8.0}
CREST = "[[ocean.crest]]\nheight = 1.2\nx = 30\ny = 20.5\nt = 3.0\n"
FIX = "[[ocean.fix]]\nfield = 'slope_x'\nvalue = -0.1\nx = 70.0\n"


def read(tables, **keys):
    return fo.Job.from_toml(job_text(**{**SMALL, **keys}) + tables)


def test_the_ocean_of_a_job_has_its_crests_and_values():
    """By the direct sum; keys that are left out are 0."""
    made = read(CREST + FIX)
    assert made.crests == (fo.Crest(height=1.2, x=30.0, y=20.5, t=3.0),)
    assert made.fixes == (fo.Fix("slope_x", 70.0, 0.0, 0.0, -0.1),)
    ocean = made.ocean(dtype="float64")
    assert float(fo.gerstner.surface(ocean, 30.0, 20.5, 3.0).height) == pytest.approx(1.2)
    assert float(fo.gerstner.surface(ocean, 70.0, 0.0, 0.0).slope_x) == pytest.approx(-0.1)
    assert ocean.rarity.crests == made.crests
    assert read("").ocean().rarity is None


def test_a_job_with_crests_is_described_and_read_again():
    """Through the plain data of a manifest, the text of a job file, and changes of other keys."""
    made = read(CREST + FIX)
    plain = json.loads(json.dumps(made.describe()))
    assert plain["ocean.crest"] == [{"height": 1.2, "x": 30.0, "y": 20.5, "t": 3.0}]
    again = fo.Job.from_description(plain)
    text = fo.Job.from_toml(text_of(made))
    changed = made.replaced({"ocean.seed": 9}).downsampled(2)
    for other in (again, text, changed):
        assert other.fixed == made.fixed
    assert "ocean.crest" not in read("").describe()  # as before: the same headers of bakes


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ("[[ocean.crest]]\nx = 3.0\n", r"ocean\.crest\[0\]\.height must be given"),
        ("[[ocean.crest]]\nheight = 1.0\ndepth = 3.0\n", r"must have the keys height, x, y, t"),
        ("[[ocean.crest]]\nhieght = 1.0\n", r"did you mean height\?"),
        ("[[ocean.crest]]\nheight = 'high'\n", r"ocean\.crest\[0\]\.height must be"),
        ("[[ocean.crest]]\nheight = inf\n", r"ocean\.crest\[0\]\.height must be"),
        ("[[ocean.crest]]\nheight = 0\n", r"height must not be 0"),
        (CREST + "[[ocean.crest]]\nheight = 1\nt = true\n", r"ocean\.crest\[1\]\.t must be"),
        ("[ocean.crest]\nheight = 1.0\n", r"must be tables, written \[\[ocean\.crest\]\]"),
        ("[[ocean.fix]]\nfield = 'foam'\nvalue = 1\n", r"ocean\.fix\[0\]\.field must be one of"),
        ("[[ocean.fix]]\nvalue = 1.0\n", r"ocean\.fix\[0\]\.field must be given"),
        (65 * CREST, r"at most 64 tables"),
    ],
)
def test_bad_tables_are_refused(tables, says):
    with pytest.raises(fo.JobError, match=says):
        read(tables)


def test_values_that_no_water_has_are_refused_with_the_job():
    near = CREST + CREST.replace("x = 30", "x = 30.0000001").replace("1.2", "1.3")
    with pytest.raises(fo.JobError, match="too near each other"):
        read(near).ocean()
    with pytest.raises(fo.JobError, match=r"must be given in a job file, as \[\[ocean\.crest\]\]"):
        fo.Job.default().replaced({"ocean.crest": [{"height": 1.0}]})


def test_frames_of_a_job_pass_through_the_crest():
    """At a sample of the grid and a frame of the loop."""
    made = read("[[ocean.crest]]\nheight = 1.5\nx = 50.0\ny = 25.0\nt = 10.0\n")
    frame = made.ocean().loop_frame(1, 4, ("height", "displace_x"))
    assert frame.height[8, 16] == pytest.approx(1.5, abs=1e-5)
    assert abs(frame.displace_x[8, 16]) < 1e-5
    assert np.max(frame.height) < 1.6
