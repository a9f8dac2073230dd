"""Jobs from a file, from --set and from flags."""

import json
import re
from pathlib import Path

import pytest
from command_line import SMALL, refusal


@pytest.mark.usefixtures("fast_bakes")
def test_flags_override_set_and_set_overrides_the_file(run):
    Path("job.toml").write_text(
        "[ocean]\nn = 16\nseed = 5\n[bake]\nframes = 9\nmaps = ['jacobian']\n"
    )
    assert (
        run(
            "bake",
            "job.toml",
            "-o",
            "out",
            "--n",
            "8,4",
            "--set",
            "bake.frames=1",
            "--set",
            "ocean.seed=6",
            "--seed",
            "7",
        )[0]
        == 0
    )
    described = json.loads(Path("out/job.json").read_text())["job"]
    assert described["ocean.n"] == [8, 4]
    assert described["ocean.seed"] == 7  # a flag is the last word
    assert described["bake.frames"] == 1
    assert described["bake.maps"] == ["jacobian"]


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize(
    "maps",
    [
        "--maps height",
        "--set bake.maps=height",
        "--set bake.maps=['height']",
        "--maps height,height",
    ],
)
def test_one_map_needs_no_brackets(run, maps):
    assert run("bake", "-o", "out", *SMALL, *maps.split())[0] == 0
    assert sorted(p.name for p in Path("out").iterdir()) == [
        "height",
        "job.json",
        "manifest.json",
        "preview.png",
        "preview.webp",
    ]


@pytest.mark.parametrize(
    ("rate", "loop", "frames"),
    [("30", "16", 480), ("24", "2.5", 60), ("0.25", "16", 4), ("29.97", "100", 2997)],
)
def test_a_frame_rate_sets_the_number_of_frames(run, rate, loop, frames):
    code, out, _ = run("info", "--n", "4", "--fps", rate, "--loop", loop)
    assert code == 0
    assert re.search(rf"bake.frames +{frames} *\n", out)


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (
            ["--fps", "7.01"],
            "got 112.16 for 16 s at 7.01 a second; 112 frames need a loop of 15.9772 s",
        ),
        (["--fps", "0"], "fps must be positive and finite"),
        (["--fps", "nan"], "fps must be positive and finite"),
        (["--fps", "1e300"], "whole number of frames"),
        (["--fps", "1e-9"], "whole number of frames"),
        (["--fps", "30", "--frames", "480"], "--fps and a number of frames"),
    ],
)
def test_impossible_frame_rates_are_refused(run, arguments, part):
    assert part in refusal(run("bake", "-o", "out", *arguments))
