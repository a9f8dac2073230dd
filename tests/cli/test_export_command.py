"""`fftocean export`: files for engineers' programs."""

from pathlib import Path

import numpy as np
import pytest

import fftocean as fo

SMALL = ("--n", "16", "--loop", "20")


def test_an_swd_file_has_the_waves_without_or_with_the_loop(run):
    """The list is that of free waves: the loop would need frequencies that no list can have."""
    code, out, err = run("export", "swd", "-o", "new/sea.swd", *SMALL)
    assert (code, err) == (0, "")
    assert out.startswith("new/sea.swd: ")
    data = Path("new/sea.swd").read_bytes()
    assert int.from_bytes(data[8:12], "little") == 6
    assert b"speed = 7.0" in data
    steps = ("--steps", "3", "--quiet")
    assert run("export", "swd", "-o", "sea.swd", *steps, *SMALL) == (0, "", "")
    assert int.from_bytes(Path("sea.swd").read_bytes()[8:12], "little") == 4
    assert run("export", "swd", "-o", "sum.swd", "--tiles", "16:100,16:37", "--quiet")[0] == 0


def test_openfast_gets_eight_files(run):
    grid = ("--grid", "20,10,8,2,2,3", "--dt", "5")
    code, out, _ = run("export", "openfast", "-o", "waves", *grid, *SMALL)
    assert code == 0
    assert out.count("waves.") == 8
    assert np.loadtxt("waves.Vxi").shape == (4, 27)
    assert np.loadtxt("waves.Elev").shape == (4, 9)


def test_components_are_a_table(run):
    assert run("export", "components", "-o", "waves.csv", *SMALL, "--quiet") == (0, "", "")
    assert Path("waves.csv").read_text().startswith("frequency_Hz,direction_degrees,")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("components", "-o", "a", "--steps", "2"), "--steps must not be given with components"),
        (("components", "-o", "a", "--dt", "1"), "--dt must not be given with components"),
        (("openfast", "-o", "a", "--steps", "2"), "--steps must not be given with openfast"),
        (("swd", "-o", "a", "--tmax", "9"), "--tmax must not be given with swd"),
        (("swd", "-o", "a", "--grid", "9,9,9,2,2,2"), "--grid must not be given with swd"),
        (
            ("openfast", "-o", "a", "--dt", "1"),
            "NZ must be given with openfast",
        ),
        (("openfast", "-o", "a", "--grid", "1,2"), "must be XHALF,YHALF,DEPTH,NX,NY,NZ"),
        (("swdd", "-o", "a"), "did you mean swd?"),
    ],
)
def test_refusals_name_the_rule(run, arguments, message):
    code, out, err = run("export", *arguments, *SMALL)
    assert (code, out) == (2, "")
    assert message in err
    assert not list(Path().iterdir())


def test_a_crest_is_kept_on_several_tiles(run):
    """Every command that takes tiles writes the waves that the job constrains."""
    text = "[[ocean.crest]]\nheight = 1.5\nx = 40.0\ny = 30.0\nt = 7.0\n[ocean]\nloop = 20.0\n"
    Path("job.toml").write_text(text)
    tiles = ("--tiles", "16:100,16:37", "--quiet")
    assert run("export", "components", "job.toml", "-o", "waves.csv", *tiles)[0] == 0
    f, _, a, phase, kx, ky = np.loadtxt("waves.csv", delimiter=",", skiprows=1).T
    angle = kx * 40.0 + ky * 30.0 - 2.0 * np.pi * f * 7.0 - phase
    assert np.sum(a * np.cos(angle)) == pytest.approx(1.5, abs=1e-9)
    assert run("export-sea", "job.toml", "-o", "sea", *tiles)[0] == 0
    sea = fo.load_sea("sea")
    found = fo.kinematics.at(sea, 40.0, 30.0, 0.0, 7.0).heights
    assert float(found) == pytest.approx(1.5, abs=1e-6)
