"""Commands given a spectrum file or the folder of a bake instead of a job file."""

from pathlib import Path

import pytest

BUOY = str(Path(__file__).parents[1] / "data" / "44004w2000.txt")
SMALL = ("--n", "16", "--frames", "2", "--quiet")


def test_a_spectrum_file_is_described_and_baked(run):
    code, out, _ = run("info", BUOY, "--toward", "30", "--time", "2", "--n", "16")
    assert code == 0
    assert "'time': 2" in out
    assert run("bake", BUOY, "--toward", "30", "-o", "sea", *SMALL)[0] == 0
    assert run("check", "sea", "--quiet")[0] == 0


def test_a_spectrum_file_without_directions_asks_for_one(run):
    code, _, err = run("info", BUOY)
    assert code == 2
    assert "without a job file, --toward" in err


def test_the_folder_of_a_bake_is_its_job(run):
    assert run("bake", "-o", "sea", "--seed", "77", *SMALL)[0] == 0
    code, out, _ = run("info", "sea")
    assert code == 0
    assert "ocean.seed" in out
    assert "77" in out
    assert run("verify", "sea")[0] == 0
    assert run("plot", "sea", "-o", "a.png")[0] == 0


def test_the_folder_of_a_cascade_brings_its_tiles(run):
    assert run("bake", "-o", "sea", "--tiles", "16:100,16:37", *SMALL[2:])[0] == 0
    code, out, _ = run("info", "sea")
    assert code == 0
    assert "Cascade" in out
    code, _, err = run("verify", "sea")
    assert code == 2
    assert "several tiles; name one" in err
    assert run("verify", "sea/tile0")[0] == 0


DATED = str(Path(__file__).parents[1] / "data" / "spectra" / "41010.data_spec")


def test_a_buoy_is_described_at_a_date_and_baked_without_a_flag(run):
    code, out, _ = run("info", DATED, "--time", "2020-06-07T10:00", "--n", "16")
    assert code == 0
    by_number = run("info", DATED, "--time", "1", "--n", "16")[1]
    line = next(row for row in out.splitlines() if "significant wave height" in row)
    assert line not in run("info", DATED, "--time", "0", "--n", "16")[1]
    assert line in by_number
    assert run("bake", DATED, "-o", "sea", *SMALL)[0] == 0
    for command in (["info"], ["verify"], ["plot", "-o", "a.png"], ["report", "-o", "a.html"]):
        assert run(command[0], "sea", *command[1:])[0] == 0


@pytest.mark.parametrize("flag", ["--time", "--toward"])
def test_flags_of_spectrum_files_are_refused_elsewhere(run, flag):
    code, _, err = run("info", flag, "3")
    assert code == 2
    assert f"{flag} must be given with a file of measured spectra" in err


def test_another_folder_is_named(run, tmp_path):
    code, _, err = run("info", str(tmp_path))
    assert code == 2
    assert "must be a job file or the folder of a bake" in err
