"""`fftocean export-sea`, and `fftocean check` of what it wrote."""

import json
import re
from pathlib import Path

import pytest
from command_line import SWELL, events, refusal

import fftocean as fo

SMALL = ("--n", "16", "--loop", "40")


def test_a_package_is_written_and_checked(run):
    code, out, err = run("export-sea", "-o", "out", *SMALL)
    assert (code, err) == (0, "")
    assert "Hs 0." in out
    assert "224 waves on 1 tile, loop 40 s in 1048576 ticks" in out
    assert out.endswith(": out\n")
    assert run("check", "out") == (0, "no problems found: out\n", "")
    assert isinstance(fo.load_sea("out"), fo.Ocean)
    document = json.loads(Path("out/sea.json").read_text())
    keys = fo.Job.default().settings
    assert document["wind"] == {
        "speed": keys["sea.wind.speed"],
        "direction": keys["sea.wind.direction"],
    }
    data = bytearray(Path("out/tile0.waves").read_bytes())
    data[9] ^= 1
    Path("out/tile0.waves").write_bytes(data)
    code, out, _ = run("check", "out")
    assert code == 5
    assert "changed" in out
    assert "tile0.waves" in out
    code, _, err = run("check", "out", "--repair")
    assert code == 2
    assert "is a run-time package: export it again" in err
    assert run("export-sea", "-o", "out", *SMALL, "--quiet") == (0, "", "")
    assert run("check", "out", "--quiet") == (0, "", "")


def test_tiles_are_a_cascade_with_the_settings_of_the_job(run):
    tiles = "16:100,16:17"
    code, out, _ = run(
        *("export-sea", "-o", "out", "--tiles", tiles, "--loop", "40", "--seed", "5"),
        *("--choppiness", "0.8", "--textures", "--ticks", "1024", "--json"),
    )
    assert code == 0
    (event,) = events(out)
    assert (event["event"], event["folder"], event["tiles"]) == ("done", "out", 2)
    assert Path("out/tile1_wave.bin").stat().st_size == 16 * 16 * 8
    loaded, job = fo.load_sea("out"), fo.Job.default()
    expected = fo.Cascade(job.sea(), [(16, 100.0), (16, 17.0)], loop=40.0, seed=5, choppiness=0.8)
    assert loaded.choppiness == 0.8
    text = json.loads(Path("out/sea.json").read_text())["job"]
    assert text.startswith("# fftocean export-sea job.toml -o sea --tiles 16:100,16:17\n")
    again = fo.Job.from_toml(text)
    changes = {"ocean.loop": 40.0, "ocean.seed": 5, "ocean.choppiness": 0.8}
    assert again.settings == job.replaced(changes).settings
    for found, tile in zip(loaded.loop_frame(3, 8), expected.loop_frame(3, 8), strict=True):
        assert found.height == pytest.approx(tile.height, abs=1e-6)
    assert json.loads(Path("out/sea.json").read_text())["ticks"] == 1024


def test_another_sea_needs_overwrite(run):
    assert run("export-sea", "-o", "out", *SMALL, "--quiet")[0] == 0
    code, out, err = run("export-sea", "-o", "out", *SMALL, "--seed", "9")
    assert (code, out) == (4, "")
    assert "holds another sea (sea.json); choose another folder, or --overwrite" in err
    assert run("export-sea", "-o", "out", *SMALL, "--seed", "9", "--overwrite")[0] == 0


def test_a_sea_without_wind_says_so(run):
    Path("swell.toml").write_text(SWELL)
    assert run("export-sea", "swell.toml", "-o", "out", *SMALL, "--quiet")[0] == 0
    assert json.loads(Path("out/sea.json").read_text())["wind"] is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--n", "100"), "n of tile 0 must be a power of two .* got 100; the next one is 128"),
        ((*SMALL, "--ticks", "1000"), "ticks must be a power of two"),
        (("--tiles", "16:100,16:17", "--set", "ocean.band_low=0.1"), "band_low must be left out"),
        (("--tiles", "16:17,16:100"), "tiles must go from the largest"),
        (("--n", "16", "--loop", "1000000"), "at most 65535 cycles in a loop"),
    ],
)
def test_what_a_package_cannot_hold_is_refused_before_anything_is_written(run, arguments, words):
    message = refusal(run("export-sea", "-o", "out", *arguments))
    assert re.search(words, message)
