"""`fftocean bake --dry-run`: its estimate and its refusals."""

import json
from pathlib import Path

import pytest
from command_line import SMALL, no_pictures


def test_a_dry_run_writes_nothing_and_predicts_the_files(run, monkeypatch):
    """The number is exact, the bytes are good to a fifth: frames of a sea are much alike."""
    no_pictures(monkeypatch, 700_000)
    flags = ("--n", "64", "--frames", "6", "--maps", "height,normal")
    code, out, err = run("bake", "-o", "out", *flags, "--dry-run")
    assert (code, err) == (0, "")
    assert "would write 16 files, about " in out
    assert "for 6 frames to out" in out
    assert not Path("out").exists()
    code, out, _ = run("bake", "-o", "out", *flags, "--dry-run", "--json")
    told = json.loads(out)
    assert (told["event"], told["frames"], told["files"]) == ("estimate", 6, 16)
    assert run("bake", "-o", "out", *flags)[0] == 0
    sizes = [p.stat().st_size for p in Path("out").rglob("*") if p.is_file()]
    assert len(sizes) == told["files"]
    assert sum(sizes) == pytest.approx(told["bytes"], rel=0.2)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--executor", "thread"],
        ["--workers", "2000"],
        ["--frames", "9:2"],
        ["--downsample", "3"],
        ["--format", "r16"],
        ["--set", "bake.pictures=spectrum"],
        ["-o", "a file"],
        ["-o", "a file/below"],
        ["-o", "/dev/full"],
        ["-o", "link"],
        ["-o", "other"],
        ["-o", "foreign", "--overwrite"],
        ["-o", "foreign"],
    ],
    ids=str,
)
@pytest.mark.usefixtures("fast_bakes")
def test_a_dry_run_refuses_what_a_run_refuses(run, arguments, monkeypatch):
    """A dry run has the same message and exit code."""
    Path("a file").write_text("")
    Path("target").mkdir()
    Path("link").symlink_to("target", target_is_directory=True)
    Path("foreign/height").mkdir(parents=True)
    Path("foreign/height/0000.exr").write_bytes(b"mine")
    run("bake", "-o", "other", "--n", "9", "--frames", "1")
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    flags = ["--n", "8", "-o", "out", *arguments]
    dry = run("bake", *flags, "--dry-run")
    assert dry[0] in (2, 4)
    assert run("bake", *flags) == dry
    assert not Path("out").exists()


def test_a_rate_and_a_part_of_the_loop_go_together(run):
    code, out, _ = run(
        "bake", "-o", "out", "--n", "8", "--fps", "3", "--frames", "0:10", "--dry-run"
    )
    assert code == 0
    assert "for 10 frames to out" in out


def test_estimates_name_container_and_video_memory(run):
    """
    6 frames of 64 x 64 take 4 half floats a sample of each map, as in their files; building a
    container holds it twice.
    """
    flags = ("--n", "64", "--frames", "6", "--maps", "displacement,height", "--dry-run", "--json")
    told = json.loads(run("bake", "-o", "out", *flags, "--format", "bin")[1])
    assert told["video"] == 6 * 64 * 64 * 2 * (4 + 4)
    assert told["container"] == 2 * 6 * 64 * 64 * 2 * 3
    assert json.loads(run("bake", "-o", "out", *flags)[1])["container"] == 0.0
    out = run("bake", "-o", "out", *flags[:-1], "--format", "bin")[1]
    assert "then 0.281 MiB for the container" in out
    assert (
        "video memory of the maps in an engine: 0.375 MiB for 6 frames, 0.0625 MiB a frame" in out
    )


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("folder", ["a file", "a file/below", "link", "one", "other", "foreign"])
def test_a_dry_run_of_tiles_refuses_what_a_run_refuses(run, folder):
    """A dry run has the same message and exit code, and leaves the folder as it is."""
    Path("a file").write_text("")
    Path("target").mkdir()
    Path("link").symlink_to("target", target_is_directory=True)
    Path("foreign/height").mkdir(parents=True)
    Path("foreign/height/0000.exr").write_bytes(b"mine")
    work = ("--maps", "height", "--executor", "serial", "--set", "bake.pictures=[]")
    if folder == "one":
        run("bake", "-o", "one", *SMALL, *work)
    if folder == "other":
        run("bake", "-o", "other", "--tiles", "8:60,8:20", "--frames", "1", "--seed", "9", *work)
    before = sorted(Path().rglob("*"))
    flags = ("bake", "-o", folder, "--tiles", "8:60,8:20", "--frames", "1", *work)
    dry = run(*flags, "--dry-run")
    assert dry[0] == 4
    assert sorted(Path().rglob("*")) == before
    assert run(*flags) == dry


@pytest.mark.usefixtures("fast_bakes")
def test_the_rows_of_many_small_frames_count(run):
    """
    Frames of 4 x 4 samples take little more than their rows of the manifest; good to a fifth, as
    the bytes of all bakes are said to be.
    """
    flags = ("-o", "out", "--n", "4", "--frames", "120", "--maps", "height,normal,jacobian")
    flags += ("--set", "bake.pictures=[]", "--executor", "serial")
    told = json.loads(run("bake", *flags, "--dry-run", "--json")[1])["bytes"]
    assert run("bake", *flags, "--quiet")[0] == 0
    held = {path: path.stat().st_size for path in Path("out").rglob("*") if path.is_file()}
    assert held[Path("out/manifest.json")] > 0.4 * sum(held.values())
    assert told == pytest.approx(sum(held.values()), rel=0.2)
