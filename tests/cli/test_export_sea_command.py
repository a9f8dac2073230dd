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


def test_foam_is_that_of_the_job(run):
    """Its decay and strength, and a threshold that it fixes."""
    foam = ("bake.foam.tau=2", "bake.foam.strength=40", "bake.foam.threshold=0.6")
    sets = [word for text in foam for word in ("--set", text)]
    assert run("export-sea", "-o", "out", *SMALL, "--quiet", *sets)[0] == 0
    found = json.loads(Path("out/sea.json").read_text())["foam"]
    assert found == {"decay": 2.0, "threshold": 0.6, "strength": 40.0}


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


@pytest.mark.parametrize("form", ["bin", "ktx2", "exr"])
def test_textures_are_in_the_format_that_was_asked_for(run, form):
    assert run("export-sea", "-o", "out", *SMALL, "--textures", form, "--quiet") == (0, "", "")
    assert {f"tile0_h0.{form}", f"tile0_wave.{form}"} <= {p.name for p in Path("out").iterdir()}
    assert run("check", "out", "--quiet") == (0, "", "")


def test_bare_textures_before_a_job_are_bin(run):
    """`--textures` took no value once: a job after it is still the job."""
    Path("swell.toml").write_text(SWELL)
    assert run("export-sea", "-o", "out", *SMALL, "--quiet", "--textures", "swell.toml")[0] == 0
    assert Path("out/tile0_h0.bin").is_file()
    assert json.loads(Path("out/sea.json").read_text())["wind"] is None  # of the swell
    other = run("export-sea", "swell.toml", "-o", "other", "--textures", "png")
    message = refusal(other, folder="other")
    assert "textures must be True, False or one of bin, ktx2, exr, got 'png'" in message


def test_an_engine_has_its_project_and_a_next_step(run):
    code, out, err = run("export-sea", "-o", "out", *SMALL, "--engine", "unity")
    assert (code, err) == (0, "")
    assert out.endswith(
        "Unity 2021.3 or later: move the folder into Assets, and follow README.unity.md\n"
    )
    assert {"fftocean.hlsl", "README.unity.md", "SeaWaves.cs"} <= {
        p.name for p in Path("out").iterdir()
    }
    assert run("check", "out") == (0, "no problems found: out\n", "")
    Path("out/SeaFloat.cs").write_text("// mine")
    code, out, _ = run("export-sea", "-o", "out", *SMALL, "--engine", "unity")
    assert code == 0
    assert "kept as edited: SeaFloat.cs\n" in out
    assert Path("out/SeaFloat.cs").read_text() == "// mine"
    assert run("check", "out", "--quiet") == (0, "", "")


def test_an_engine_refuses_what_its_kernels_cannot_transform(run):
    message = refusal(run("export-sea", "-o", "out", "--tiles", "1024:500", "--engine", "godot"))
    assert "must be a power of two of at most 512 for engine godot" in message
    code, _, err = run("export-sea", "-o", "out", "--engine", "quake")
    assert code == 2
    assert "invalid choice: 'quake'" in err
    assert not Path("out").exists()


def test_help_names_every_engine(run):
    code, out, _ = run("export-sea", "--help")
    assert code == 0
    assert "{unity,unreal,godot,bevy,three,webgpu}" in out
    assert "--engine godot" in out
    assert "bin, ktx2, exr" in out
