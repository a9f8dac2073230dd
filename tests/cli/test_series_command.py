"""`fftocean series`: time series of a job's water."""

from pathlib import Path

import numpy as np
import pytest

import fftocean as fo

SMALL = ("--n", "16", "--loop", "20")


def test_a_series_is_that_of_the_library(run):
    code, out, err = run("series", "--at", "3,4", "--at=-50,0", "-o", "new/a.csv", *SMALL)
    assert (code, err) == (0, "")
    assert "new/a.csv: height at 2 probes, 100 times from 0 to 19.8 s" in " ".join(out.split())
    lines = Path("new/a.csv").read_text().splitlines()
    table = np.genfromtxt([line for line in lines if line[0] != "#"][1:], delimiter=",")
    job = fo.Job.default().replaced({"ocean.n": 16, "ocean.loop": 20.0})
    expected = fo.series(job.ocean(), [3.0, -50.0], [4.0, 0.0], np.arange(100) / 5.0)
    assert np.array_equal(table[:, 1:], expected["height"])


def test_fields_at_depths_of_tiles(run):
    flags = ("--fields", "velocity_x,pressure", "--depths", "0,5", "--rate", "2", "--start", "7")
    tiles = ("--tiles", "16:100,16:37", "--loop", "20")
    assert run("series", "--at", "0,0", "-o", "a.csv", "--quiet", *flags, *tiles)[0] == 0
    text = Path("a.csv").read_text()
    assert "# z2: -5.0 m" in text
    assert "\ntime,velocity_x_1_z1,velocity_x_1_z2,pressure_1_z1,pressure_1_z2\n7.0," in text
    assert text.count("\n") == 4 + 1 + 40


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (("--at", "0,0", "-o", "a.mat"), "must be written to a file that ends in .csv"),
        (("--at", "0", "-o", "a.csv"), "must be X,Y such as"),
        (("--at", "0,1,2", "-o", "a.csv"), "must be X,Y such as 120,35.5, got '0,1,2'"),
        (("--at", "0,x", "-o", "a.csv"), "must be numbers such as"),
        (("--at", "0,0", "-o", "a.csv", "--fields", "depth"), "fields must be of height"),
        (("--at", "0,0", "-o", "a.csv", "--rate", "0"), "--rate must be"),
        (("--at", "0,0", "-o", "a.csv", "--depths", "-2"), "z must be from the bed"),
    ],
)
def test_bad_values_are_refused_before_anything_is_written(run, flags, message):
    code, _, err = run("series", *flags, *SMALL)
    assert code == 2
    assert message in " ".join(err.split())
    assert not Path("a.csv").exists()
