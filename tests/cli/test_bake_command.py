"""`fftocean bake`: its summary, its files, its exit codes."""

import io
import json
import resource
import sys
from pathlib import Path

import numpy as np
import pytest
from builders import lazy
from command_line import SMALL, events, no_pictures, refusal

from fftocean.cli import main
from fftocean.cli.bake import _Follower

exr = lazy("fftocean.export.exr")


@pytest.mark.usefixtures("fast_bakes")
def test_the_summary_of_a_bake_names_heights_maps_and_preview(run):
    code, out, err = run(
        "bake", "-o", "out", "--n", "8,4", "--frames", "2", "--maps", "height,normal"
    )
    assert code == 0
    assert "Hs 1.26 m specified" in out
    assert "4 maps of 8 x 4 in " in out
    assert out.endswith(f"preview: {Path('out/preview.png')}\n")
    assert not err
    assert sorted(p.name for p in Path("out/normal").iterdir()) == ["0000.exr", "0001.exr"]


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("forced", [False, True])
def test_no_progress_bar_without_a_terminal(run, forced, monkeypatch):
    """No byte of it is printed, even if colours are forced on files, as CI does."""
    if forced:
        monkeypatch.setenv("FORCE_COLOR", "1")
        monkeypatch.setenv("TTY_COMPATIBLE", "1")
    code, out, err = run("bake", "-o", "out", *SMALL)
    assert code == 0
    assert "\x1b" not in out + err
    assert "\r" not in out + err
    assert not err
    code, out, err = run("bake", "-o", "out", *SMALL, "--quiet")
    assert (code, out, err) == (0, "", "")


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("quiet", [False, True])
def test_the_progress_bar_appears_on_a_terminal(quiet, monkeypatch, capsys):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert (
        main(["bake", "-o", "out", "--n", "8", "--frames", "3", *(["--quiet"] if quiet else [])])
        == 0
    )
    shown = sys.stderr.getvalue()
    assert ("baking" in shown and "3/3" in shown) == (not quiet)
    assert "baking" not in capsys.readouterr().out


def test_no_wind_bakes_a_flat_sea_with_a_note(run, monkeypatch):
    """All heights are 0 and all normals point up; only the preview is left out."""
    no_pictures(monkeypatch)
    code, out, err = run(
        "bake", "-o", "out", *SMALL, "--set", "sea.wind.speed=0", "--maps", "height,normal"
    )
    assert code == 0
    assert "wind speed 0 m/s raises no waves: the sea is exactly flat\n" in err
    assert "Hs 0 m specified, 0 m realised" in out
    for channel in exr.decode(Path("out/height/0000.exr").read_bytes()):
        assert not channel.any()
    x, y, z = exr.decode(Path("out/normal/0000.exr").read_bytes())
    assert not x.any()
    assert not y.any()
    assert np.all(z == 1.0)


@pytest.mark.usefixtures("fast_bakes")
def test_any_folder_name_is_accepted(run):
    for name in ("a b", "ünï", "\udcff", "line\nbreak", "[/x]"):
        code, out, err = run("bake", "-o", name, *SMALL)
        assert (code, err) == (0, "")
        assert Path(name, "manifest.json").exists()
        assert len(out.splitlines()) == 5


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("folder", ["a file", "/dev/full", "a file/below", "x" * 300])
def test_an_impossible_folder_exits_4(run, folder):
    Path("a file").write_text("")
    code, out, err = run("bake", "-o", folder, *SMALL)
    assert code == 4
    assert not out
    assert err.startswith(f"fftocean: {folder} could not be made a folder: ")
    assert err.count("\n") == 1


@pytest.mark.usefixtures("fast_bakes")
def test_a_full_disk_exits_4(run):
    run("bake", "-o", "warm", *SMALL)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        resource.setrlimit(
            resource.RLIMIT_FSIZE, (5000, limits[1])
        )  # the job and the journal fit, a picture does not
        code, out, err = run("bake", "-o", "out", "--n", "64", "--frames", "1", "--maps", "height")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert code == 4
    assert not out
    assert err == f"fftocean: {Path('out/height/0000.exr')} could not be written: File too large\n"
    assert sorted(str(p.relative_to("out")) for p in Path("out").rglob("*") if p.is_file()) == [
        ".work/journal",
        "job.json",
    ]


@pytest.mark.usefixtures("fast_bakes")
def test_another_job_s_folder_exits_4_and_overwrite_replaces_it(run):
    assert run("bake", "-o", "out", *SMALL)[0] == 0
    before = Path("out/manifest.json").read_bytes()
    code, out, err = run("bake", "-o", "out", "--n", "9", "--frames", "1")
    assert code == 4
    assert not out
    assert "ocean.n: 8 there, 9 here" in err
    assert "--overwrite" in err
    assert err.count("\n") == 1
    assert Path("out/manifest.json").read_bytes() == before
    assert run("bake", "-o", "out", "--n", "9", "--frames", "1", "--overwrite")[0] == 0
    assert json.loads(Path("out/manifest.json").read_text())["ocean"]["n"] == [9, 9]


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("n", ["1", "2", "31", "[48, 80]", "48,80", "1,5"])
def test_any_number_of_samples_bakes(run, n):
    assert run("bake", "-o", "out", "--n", n, "--frames", "1")[0] == 0
    nx, ny = json.loads(Path("out/manifest.json").read_text())["ocean"]["n"]
    assert exr.decode(Path("out/height/0000.exr").read_bytes())[0].shape == (ny, nx)


@pytest.mark.usefixtures("fast_bakes")
def test_an_empty_file_is_a_job(run):
    Path("job.toml").write_text("")
    assert run("bake", "job.toml", "-o", "out", *SMALL)[0] == 0


@pytest.mark.usefixtures("fast_bakes")
def test_two_bakes_give_the_same_bytes(run):
    for folder in ("one", "two"):
        assert (
            run(
                "bake",
                "-o",
                folder,
                "--n",
                "12,20",
                "--frames",
                "3",
                "--maps",
                "height,displacement,normal,jacobian",
            )[0]
            == 0
        )
    one, two = (
        {p.relative_to(f): p.read_bytes() for p in Path(f).rglob("*") if p.is_file()}
        for f in ("one", "two")
    )
    assert one == two
    assert len(one) == 3 * 4 + 4


@pytest.mark.usefixtures("fast_bakes")
def test_a_part_of_the_loop_and_a_part_of_the_samples(run):
    code, out, _ = run(
        "bake",
        "-o",
        "out",
        "--n",
        "16",
        "--set",
        "bake.frames=12",
        "--frames",
        "2:9:3",
        "--downsample",
        "2",
    )
    assert code == 0
    assert "9 maps of 8 x 8 in " in out
    assert sorted(p.name for p in Path("out/height").iterdir()) == [
        "0002.exr",
        "0005.exr",
        "0008.exr",
    ]
    manifest = json.loads(Path("out/manifest.json").read_text())
    assert [row["t"] for row in manifest["frames"]] == [16.0 * j / 12 for j in (2, 5, 8)]
    assert (manifest["subset"], manifest["downsample"]) == ("2:9:3", 2)


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (
            ["--frames", "9:2"],
            "frames must choose some of the loop's 240 in rising order, got '9:2'",
        ),
        (["--frames", "a:b"], "frames must be a count, or start:stop or start:stop:step"),
        (
            ["--n", "16", "--downsample", "3"],
            "downsample must be a whole number that divides ocean.n = 16, got 3",
        ),
        (["--executor", "thread"], "executor must be one of auto, serial, processes, dask"),
        (["--format", "r16"], "cannot hold the map 'displacement'"),
        (["--format", "exr", "--mips"], "mip levels"),
        (["--engine", "quake"], "bake.engine must be one of canonical, blender, unity"),
    ],
)
def test_impossible_bakes_are_refused(run, arguments, part):
    assert part in refusal(
        run("bake", "-o", "out", *(arguments if "--n" in arguments else ["--n", "8", *arguments]))
    )


@pytest.mark.usefixtures("fast_bakes")
def test_names_are_case_blind(run):
    """Formats, engines, maps, kinds and executors are written in one spelling."""
    Path("job.toml").write_text(
        "[[sea.systems]]\nspectrum = { kind = 'JONSWAP', hs = 1.5, tp = 4.0 }\n"
        "spreading = { kind = 'Cosine-Squared' }\n"
    )
    flags = (
        "--format",
        "EXR",
        "--engine",
        "Unity",
        "--maps",
        "Height,NORMAL",
        "--lookup",
        "Lagrangian",
        "--executor",
        "SERIAL",
    )
    assert run("bake", "job.toml", "-o", "out", *SMALL, *flags)[0] == 0
    job = json.loads(Path("out/job.json").read_text())["job"]
    assert (job["bake.format"], job["bake.engine"], job["bake.maps"]) == (
        "exr",
        "unity",
        ["height", "normal"],
    )


@pytest.mark.usefixtures("fast_bakes")
def test_a_finished_bake_is_reported_as_existing(run):
    flags = ("bake", "-o", "out", "--n", "8", "--frames", "3", "--maps", "height")
    assert "3 maps of 8 x 8 in " in run(*flags)[1]
    assert "nothing to bake: all 3 maps of 8 x 8 exist already: out\n" in run(*flags)[1]
    Path("out/height/0001.exr").unlink()
    assert ", 2 of 3 frames from an earlier run: out\n" in run(*flags)[1]


@pytest.mark.usefixtures("fast_bakes")
def test_frames_of_an_earlier_run_are_counted(run):
    """Those that were baked now are no work of an earlier run."""
    flags = ("bake", "-o", "out", "--n", "8", "--frames", "4", "--maps", "height")
    assert "from an earlier run" not in run(*flags)[1]
    for name in ("0000", "0001", "0002"):
        Path(f"out/height/{name}.exr").unlink()
    _, out, _ = run(*flags)
    assert "4 maps of 8 x 8 in " in out
    assert ", 1 of 4 frames from an earlier run: out\n" in out


def test_progress_of_tiles_and_previews_is_said():
    """Tiles are counted from 1; previews come when every frame of one tile is finished."""
    shown = []
    follower = _Follower(lambda *told: shown.append(told), None)
    tile = {"tile": 0, "tiles": 2}
    for event in (
        {"event": "start", "frames": 2, "kept": 1, **tile},
        {"event": "survey", "what": "range", "done": 1, "total": 6, **tile},
        {"event": "frame", "frames": 2, "done": 2, **tile},
        {"event": "start", "frames": 2, "kept": 0, **{**tile, "tile": 1}},
    ):
        follower(event)
    assert shown == [
        (1, 2, "baking tile 1 of 2"),
        (1, 6, "surveying range tile 1 of 2"),
        (2, 2, "baking tile 1 of 2"),
        (0, 2, "baking tile 2 of 2"),
    ]
    shown.clear()
    follower = _Follower(lambda *told: shown.append(told), None)
    follower({"event": "start", "frames": 2, "kept": 0})
    follower({"event": "frame", "frames": 2, "done": 1})
    follower({"event": "frame", "frames": 2, "done": 2})
    assert shown == [(0, 2, "baking"), (1, 2, "baking"), (2, 2, "rendering previews")]


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("tiles", [(), ("--tiles", "16:100,16:15")])
@pytest.mark.parametrize(("stop", "code"), [(KeyboardInterrupt(), 130), (SystemExit(143), 143)])
def test_an_interrupted_bake_says_how_far_it_is(run, stop, code, tiles, monkeypatch):
    """The code is that of the signal, never that of a finished bake."""

    def fail(*_, **__):
        raise stop

    monkeypatch.setattr("fftocean.baking.bake._finish", fail)
    flags = ("bake", "-o", "out", "--frames", "2", "--maps", "height", *(tiles or ("--n", "8")))
    left, out, err = run(*flags)
    assert left == code
    assert "preview" not in out
    of = " of tile 1 of 2" if tiles else ""
    assert f"2 of 2 frames{of} are finished; run the same command again to resume" in err


@pytest.mark.usefixtures("fast_bakes")
def test_json_events_cover_the_whole_bake(run):
    code, out, err = run(
        "bake",
        "-o",
        "out",
        "--n",
        "8",
        "--frames",
        "3",
        "--maps",
        "height",
        "--format",
        "png16",
        "--json",
    )
    assert (code, err) == (0, "")
    told = events(out)
    assert [e["event"] for e in told] == [
        "start",
        "survey",
        "survey",
        "survey",
        "frame",
        "frame",
        "frame",
        "done",
    ]
    assert told[0] == {
        "event": "start",
        "folder": "out",
        "frames": 3,
        "kept": 0,
        "executor": "serial",
        "workers": 1,
    }
    assert told[4] == {"event": "frame", "frame": 0, "t": 0.0, "done": 1, "frames": 3}
    assert told[-1]["manifest"] == str(Path("out/manifest.json"))
    code, out, err = run("bake", "-o", "out", "--n", "9", "--frames", "3", "--json")
    assert code == 4
    (error,) = events(out)
    assert (error["event"], error["exit_code"]) == ("error", 4)
    assert error["message"] in err


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize(
    ("stop", "code", "word"),
    [(KeyboardInterrupt(), 130, "interrupted"), (SystemExit(143), 143, "terminated")],
)
def test_the_last_json_event_of_a_stopped_bake_is_an_error(run, stop, code, word, monkeypatch):
    def fail(*_, **__):
        raise stop

    monkeypatch.setattr("fftocean.baking.bake._finish", fail)
    left, out, err = run("bake", "-o", "out", "--n", "8", "--frames", "2", "--json")
    assert left == code
    assert events(out)[-1] == {"event": "error", "message": word, "exit_code": code}
    assert "2 of 2 frames are finished; run the same command again to resume" in err


@pytest.mark.parametrize(
    ("engine", "form", "words"),
    [
        ("unity", "exr-float", "exr-float in unity: choose the texture format RGBA Float"),
        ("babylon", "exr", "exr in babylon: by Texture, whose invertY is true"),
        ("canonical", "exr", None),
    ],
)
def test_a_bake_says_how_its_files_are_loaded_into_the_engine(run, engine, form, words):
    """The summaries of a tile, of a cascade and of a dry run have the same line."""
    flags = ["--engine", engine, "--format", form, "--maps", "displacement", "--frames", "2"]
    for number, more in enumerate(
        (
            ["--n", "8", "--dry-run"],
            ["--n", "8"],
            ["--tiles", "8:60,8:15", "--dry-run"],
            ["--tiles", "8:60,8:15"],
        )
    ):
        code, out, _ = run("bake", "-o", f"out{number}", *flags, "--executor", "serial", *more)
        assert code == 0
        found = [line for line in out.splitlines() if f" in {engine}: " in line]
        assert found == ([words] if words else [])
