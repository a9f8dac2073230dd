"""
The command line: what it prints and where, its exit codes, and that a wrong word costs one line and
nothing else.
"""

import contextlib
import dataclasses
import functools
import io
import json
import os
import re
import resource
import shlex
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean import cli
from fftocean.baking import bake as baker
from fftocean.baking.finished.load import load
from fftocean.baking.previews import sheets as preview
from fftocean.errors import FFTOceanError
from fftocean.export import exr
from fftocean.job.parameters import BY_KEY, PARAMETERS
from fftocean.statistics import SeaState

BAD = ["nan", "inf", "-1", "0", '"5"', "true", "1e308", "1e-308"]
SMALL = ("--n", "8", "--frames", "1")
SWELL = "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 1.5, tp = 4.0 }\n"


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """
    Each test in a folder of its own; a 160-column terminal's worth of width, no colours, whatever
    the outer ones are.
    """
    monkeypatch.chdir(tmp_path)
    for name in ("FORCE_COLOR", "NO_COLOR", "COLUMNS", "TTY_COMPATIBLE", "TTY_INTERACTIVE"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.fixture
def quick(monkeypatch):
    """
    No picture and no integrals over the sea, which take most of the time of a small bake;
    test_baker.py has them.
    """
    monkeypatch.setattr(
        baker,
        "measure",
        lambda ocean: some_statistics(0.0 if ocean.amplitudes.variance == 0.0 else 0.1),
    )
    no_pictures(monkeypatch)


def no_pictures(monkeypatch, size=7):
    monkeypatch.setattr(preview, "contact_sheet", lambda *_, **__: bytes(size))
    monkeypatch.setattr(preview, "animation", lambda *_, **__: bytes(size))


@functools.cache
def some_statistics(m0):
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    return dataclasses.replace(
        still, ordered=SeaState(m0=m0, hs=4.0 * m0**0.5, tp=5.0, mean_direction=0.0, spread=30.0)
    )


@pytest.fixture
def run(capsys):
    """Run a command; return its exit code, what it printed, and what it said on stderr."""

    def run(*arguments):
        try:
            code = cli.main([str(a) for a in arguments])
        except SystemExit as left:
            code = left.code
        out, err = capsys.readouterr()
        assert "Traceback" not in err
        return code, out, err

    return run


def clean(result, folder="out"):
    """The one line of a clean refusal: exit code 2, nothing printed, nothing made."""
    code, out, err = result
    assert code == 2
    assert not out
    assert err.startswith("fftocean: ")
    assert err.endswith("\n")
    assert err.count("\n") == 1
    assert err.rstrip("\n").isprintable()
    assert not Path(folder).exists()
    return err


# Bad values


def refused_or_finite(result, key, value):
    """
    Clean refusal with key, rule and value, or a bake without a NaN. Returns whether it was refused.
    """
    if result[0] == 2:
        message = clean(result).lower().replace("e+", "e")
        for part in (key, "must ", value.strip('"').removesuffix(".0")):
            assert part in message
        return True
    assert result[0] == 0
    manifest = json.loads(Path("out/manifest.json").read_text(), parse_constant=pytest.fail)
    for values in load("out").maps.values():
        assert np.all(np.isfinite(values))
    assert len(manifest["frames"]) >= 1
    return False


ACCEPTED = {
    "ocean.band_low": ("0", "1e-308"),
    "ocean.band_high": ("inf", "1e308", "1e-308"),
    "sea.wind.speed": ("0", "1e-308"),
    "sea.wind.direction": ("-1", "0", "1e-308"),
    "sea.wind.blend": ("0", "1e-308"),
    "sea.depth": ("inf", "1e308"),
    "sea.surface_tension": ("0", "1e-308"),
    "ocean.seed": ("0",),
    "ocean.choppiness": ("0", "1e-308"),
    "bake.mips": ("true",),
    "bake.foam.threshold": ("-1", "0", "1e-308"),
    "bake.foam.strength": ("0", "1e-308"),
}
FLAGGED = [p for p in PARAMETERS if p.flag and not p.switch]  # a switch takes no value


def others(key):
    """
    Flags that keep a bake small, but for the key in question; smaller levels need a format that has
    room for them.
    """
    return [*(["--format", "ktx2"] if key == "bake.mips" else []), *_small(key)]


def _small(key):
    return [
        part
        for flag, small in (("n", "8"), ("frames", "1"))
        if key not in (f"ocean.{flag}", f"bake.{flag}")
        for part in (f"--{flag}", small)
    ]


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("key", BY_KEY)
def test_a_bad_value_by_set(run, key, value):
    assert refused_or_finite(
        run("bake", "-o", "out", *others(key), "--set", f"{key}={value}"), key, value
    ) == (value not in ACCEPTED.get(key, ()))


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("key", BY_KEY)
def test_a_bad_value_in_a_file(run, key, value):
    table, _, name = key.rpartition(".")
    Path("job.toml").write_text(f"[{table}]\n{name} = {value}\n")
    assert refused_or_finite(run("bake", "job.toml", "-o", "out", *others(key)), key, value) == (
        value not in ACCEPTED.get(key, ())
    )


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("parameter", FLAGGED, ids=lambda p: p.flag)
def test_a_bad_value_by_flag(run, parameter, value):
    key = parameter.key
    assert refused_or_finite(
        run("bake", "-o", "out", *others(key), f"--{parameter.flag}", value), key, value
    ) == (value not in ACCEPTED.get(key, ()))


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize(
    "key", ["spectrum.hs", "spectrum.tp", "spectrum.gamma", "spreading.s", "direction"]
)
def test_a_bad_value_in_a_wave_system(run, key, value):
    """One spectrum stands for all here; tests/bake/test_job.py goes through them."""
    values = {
        "spectrum.hs": "0.5",
        "spectrum.tp": "4.0",
        "spectrum.gamma": "2.0",
        "spreading.s": "9.0",
        "direction": "30.0",
        key: value,
    }
    v = {k.replace(".", "_"): text for k, text in values.items()}
    text = "[[sea.systems]]\nspectrum = {{ kind = 'jonswap', hs = {spectrum_hs}, tp = {spectrum_tp}, gamma = {spectrum_gamma} }}\n"
    text += "spreading = {{ kind = 'cosine-power', s = {spreading_s} }}\ndirection = {direction}\n"
    Path("job.toml").write_text(text.format(**v))
    accepted = {
        "spectrum.hs": ("0", "1e-308"),
        "spreading.s": ("0", "1e-308"),
        "direction": ("-1", "0", "1e-308"),
    }.get(key, ())
    assert refused_or_finite(
        run("bake", "job.toml", "-o", "out", *SMALL), f"sea.systems[0].{key}", value
    ) == (value not in accepted)


@pytest.mark.parametrize("command", ["bake", "info", "verify", "plot"])
def test_each_command_refuses_alike(run, command):
    assert "sea.wind.speed must be between 0 and 150 m/s, got -1.0" in clean(
        run(command, "--set", "sea.wind.speed=-1")
    )


@pytest.mark.parametrize("command", ["bake", "info", "verify", "plot"])
def test_more_samples_than_memory_are_refused_before_they_are_taken(run, command, monkeypatch):
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 2.0**30)
    start = time.process_time()
    assert "n = 65536 x 65536 needs about " in clean(run(command, "--n", "65536"))
    assert "between 1 and 65536, got 1000000000" in clean(run(command, "--n", "1000000000"))
    assert "whole number" in clean(run(command, "--n", "1e9"))
    assert "whole number" in clean(run(command, "--n", "1.5"))
    assert time.process_time() - start < 2.0


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (
            "[sea.wind]\nsped = 3\n",
            ["job.toml", "unknown key 'sea.wind.sped'", "did you mean sea.wind.speed?"],
        ),
        ("[ocean]\nn = 8\nn = 9\n", ["job.toml", "TOML", "line 3"]),
        (f"[sea.wind]\nfetch = 1e4\n{SWELL}", ["sea.wind.speed must be given"]),
        ("ocean = 5\n", ["'ocean'"]),
        (
            "[[sea.systems]]\nspectrum = { kind = 'jonswap', \"a\\nb\\u001b[31m\" = 1.0 }\n",
            ["a\\nb\\x1b[31m"],
        ),
        ("a" * 100_000, ["at most 65536 bytes"]),
        (".".join("a" * 30_000) + " = 1", ["line 1", "at most 2048 characters"]),
        (".".join(['"\u2028"'] * 9000) + " = 1", ["line 1", "at most 2048 characters"]),
        ("#\n" * 40_000, ["at most 65536 bytes"]),
        ("n = " + "[" * 2000, ["nested"]),
        ("n = " + "{a = " * 400, ["nested"]),
        (b"\xff\xfe", ["UTF-8", "byte 0"]),
        (b"\0", ["TOML"]),
    ],
    ids=lambda v: repr(v[:20]),
)
def test_bad_files_are_refused_within_two_seconds(run, text, parts):
    Path("job.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    start = time.process_time()
    message = clean(run("bake", "job.toml", "-o", "out"))
    assert time.process_time() - start < 2.0
    for part in parts:
        assert part in message


@pytest.mark.parametrize(
    "path",
    [
        "/dev/zero",
        "/dev/full",
        "/dev/null",
        ".",
        "none.toml",
        "a\nb",
        "\udcff",
        "x" * 5000,
        "/dev/full/x",
        "[/red].toml",
        "",
    ],
)
def test_what_is_no_job_file_is_refused(run, path):
    clean(run("bake", path, "-o", "out"))


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--set", "a"], "a setting must be key=value"),
        (["--set", "=1"], "a setting must be key=value"),
        (["--set", "ocean.m=1"], "did you mean ocean.n?"),
        (["--set", "sea.systems=1"], "sea.systems must be given in a job file"),
        (["--set", "ocean.n=8\nocean.size=9"], "ocean.n must be a whole number"),
        (["--set", "ocean.n="], "ocean.n must be one value or two"),
        (["--set", "ocean.n=" + "[" * 1000], "ocean.n must be a whole number"),
        (["--n", ""], "ocean.n must be one value or two"),
        (["--n", "abc"], "got 'abc'"),
        (["--n", "8,0"], "between 1 and 65536, got 0"),
        (["--n", "8,8,8"], "one value or two"),
        (["--size=-inf"], "got -inf"),
        (["--maps", ""], "bake.maps must be a list"),
        (["--maps", "height,wrong"], "got 'wrong'"),
        (["--set", "bake.maps=wrong"], "got 'wrong'"),
        (["--seed", "18446744073709551616"], "got 18446744073709551616"),
    ],
)
def test_bad_arguments_are_refused(run, arguments, part):
    assert part in clean(run("bake", "-o", "out", *arguments))


def test_a_wind_that_nobody_ordered_is_refused(run):
    Path("swell.toml").write_text(SWELL)
    assert "sea.wind.speed must be given where sea.wind.gamma is" in clean(
        run("bake", "swell.toml", "-o", "out", "--set", "sea.wind.gamma=2")
    )


@pytest.mark.parametrize("t", ["nan", "inf", "1e13"])
def test_times_that_cannot_be_are_refused(run, t):
    assert f"t must be between -1e+12 and 1e+12 s, got {float(t)}" in clean(
        run("verify", "--n", "8", "--t", t)
    )


# Words of the command line


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["bkae"], "did you mean bake?"),
        (["bkae"], "invalid choice: 'bkae'"),
        (["bake", "--wind", "3"], "did you mean --set sea.wind.speed=VALUE?"),
        (["info", "--frmaes", "3"], "did you mean --frames?"),
        (["check", "out", "--repiar"], "did you mean --repair?"),
        (["bake", "--frame"], "expected one argument"),
        (["bake", "--wind", "3"], "unrecognized arguments: --wind"),
        (["bake", "a.toml", "b.toml"], "unrecognized arguments: b.toml"),
        (["verify", "--t", "soon"], "invalid float value: 'soon'"),
        (["verify", "--dtype", "float16"], "invalid choice: 'float16'"),
    ],
)
def test_usage_errors_exit_2(run, arguments, part):
    code, out, err = run(*arguments)
    assert code == 2
    assert not out
    assert part in err
    assert err.startswith("usage: fftocean")


@pytest.mark.parametrize("command", ["bake", "check", "info", "verify", "bench", "plot", "presets"])
def test_a_wrong_flag_is_answered_with_its_own_command_s_usage(run, command):
    """In two lines: the usage of that command alone, and the error."""
    code, out, err = run(command, *(["out"] if command == "check" else []), "--nonsense")
    assert (code, out) == (2, "")
    usage, error = err.splitlines()
    assert usage.startswith(f"usage: fftocean {command} ")
    assert (
        error
        == f"fftocean {command}: error: unrecognized arguments: --nonsense; see fftocean {command} --help"
    )


def test_a_bare_command_says_what_to_try(run):
    code, out, err = run()
    assert (code, out) == (2, "")
    for line in ("fftocean bake -o sea", "fftocean info", "fftocean --help"):
        assert line in err


def test_version(run):
    assert run("--version") == (0, f"fftocean {fo.__version__}\n", "")


@pytest.mark.parametrize(
    "command", ["", "bake", "check", "info", "verify", "bench", "plot", "presets"]
)
def test_help_shows_an_example_and_the_exit_codes(run, command):
    code, out, err = run(*command.split(), "--help")
    assert code == 0
    assert not err
    assert f"example:\n  fftocean {command}" in out
    for number in ("0 ok", "2 usage or job", "4 output", "5 integrity", "130 interrupted"):
        assert number in out
    assert max(map(len, out.splitlines())) <= 120
    for p in FLAGGED if command in ("bake", "info", "verify", "plot") else ():
        assert f"--{p.flag} {p.flag.upper()}" in out
        assert p.help.split("%")[0][:20] in " ".join(out.split())
    assert ("--mips, --no-mips" in out) == (command in ("bake", "info", "verify", "plot"))


@pytest.mark.parametrize(
    "example", [line for text in cli.EXAMPLES.values() for line in text.splitlines()]
)
def test_the_examples_of_the_help_are_commands(example):
    word, *arguments = shlex.split(example)
    assert word == "fftocean"
    options = cli._parser().parse_args(arguments)
    if "set" in options:
        if ":" in (options.frames or ""):
            options.frames = None  # a part of the loop, and no key of a job
        options.job = None  # the files are the reader's own
        cli._job(options)


def test_help_does_not_wait_for_compilers():
    """
    Nor does a usage error: numba, FFTW, OpenEXR, SciPy and NumPy are loaded by the work that needs
    them.
    """
    heavy = {"numba", "pyfftw", "OpenEXR", "scipy", "numpy", "rich", "PIL"}
    program = f"import sys; from fftocean.cli import main\ntry: main(['--help'])\nexcept SystemExit: print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.stdout.endswith("\n[]\n"), done.stdout + done.stderr


def environment(**more):
    """This process's environment, with this package in sight."""
    return {**os.environ, "PYTHONPATH": str(Path(fo.__file__).parent.parent), **more}


# What is printed, and where


@pytest.mark.usefixtures("quick")
def test_a_bake_says_what_it_made(run):
    code, out, err = run(
        "bake", "-o", "out", "--n", "8,4", "--frames", "2", "--maps", "height,normal"
    )
    assert code == 0
    assert "Hs 1.26 m specified" in out
    assert "4 maps of 8 x 4 in " in out
    assert out.endswith(f"preview: {Path('out/preview.png')}\n")
    assert not err
    assert sorted(p.name for p in Path("out/normal").iterdir()) == ["0000.exr", "0001.exr"]


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("forced", [False, True])
def test_no_bar_where_there_is_no_terminal(run, forced, monkeypatch):
    """Not a byte of it, even where colours are forced on files, as CI does."""
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


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("quiet", [False, True])
def test_a_bar_where_there_is_one(quiet, monkeypatch, capsys):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert (
        cli.main(
            ["bake", "-o", "out", "--n", "8", "--frames", "3", *(["--quiet"] if quiet else [])]
        )
        == 0
    )
    shown = sys.stderr.getvalue()
    assert ("baking" in shown and "3/3" in shown) == (not quiet)
    assert "baking" not in capsys.readouterr().out


def test_no_wind_bakes_an_exactly_flat_sea_and_says_so(run, monkeypatch):
    """All heights 0, all normals up, by the whole way: only the picture is left out."""
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


def test_notes_tell_what_the_tile_cannot_hold(run):
    """
    Too short a loop, waves too long for the tile and too short for its samples: on stderr, one line
    each.
    """
    code, _, err = run(
        "info", "--n", "8", "--size", "40", "--loop", "2", "--set", "sea.wind.speed=20"
    )
    assert code == 0
    notes = err.splitlines()
    assert all(note.startswith("note: ") for note in notes)
    assert "a loop of 2 s is less than four peak periods" in err
    assert "waves longer than the tile; a larger --size holds them" in err
    assert "waves shorter than two samples" in run("info", "--n", "4", "--size", "100")[2]


@pytest.mark.parametrize("n", ["1", "2", "31,12"])
def test_info_describes_any_tile(run, n):
    code, out, _ = run("info", "--n", n)
    assert code == 0
    for part in (
        "sea.wind.speed",
        "7 m/s",
        "significant wave height Hs",
        "loop frequency error",
        "724 files of 3 maps",
        "MB",
        "time to bake",
    ):
        assert part in out
    assert "nan" not in out
    assert "inf m" in out
    assert "inf rad/m" in out
    assert out.count("inf") == 2  # the depth and the band, and nothing else


def test_info_describes_a_job_with_systems_and_without_waves(run):
    Path("job.toml").write_text("sea.depth = 8.0\n" + SWELL + "direction = 45\n")
    code, out, _ = run("info", "job.toml", "--n", "16")
    assert code == 0
    assert "Job: job.toml" in out
    assert "sea.systems[0]" in out
    assert "'hs': 1.5" in out
    assert "sea.wind" not in out
    code, out, err = run("info", "--n", "8", "--set", "sea.wind.speed=0")
    assert code == 0
    assert "the sea is exactly flat" in err
    assert "nan" not in out


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("info", "[/x].toml"),
        ("verify", "[/x].toml"),
        ("info", "[bold]a[/bold].toml"),
        ("verify", "a\\[b.toml"),
        ("info", "ünï\x1b[31m\udcff.toml"),
    ],
)
def test_names_are_shown_as_they_are(run, command, name):
    """No markup of theirs is obeyed, and what a terminal would obey is spelt out."""
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text("[ocean]\nn = 8\n")
    code, out, _ = run(command, name)
    assert code == 0
    assert name.replace("\x1b", "\\x1b").replace("\udcff", "\\udcff") in out
    assert "\x1b" not in out


@pytest.mark.usefixtures("quick")
def test_a_folder_s_name_may_be_anything(run):
    for name in ("a b", "ünï", "\udcff", "line\nbreak", "[/x]"):
        code, out, err = run("bake", "-o", name, *SMALL)
        assert (code, err) == (0, "")
        assert Path(name, "manifest.json").exists()
        assert len(out.splitlines()) == 4


def test_presets_are_listed(run):
    code, out, err = run("presets")
    assert (code, err) == (0, "")
    for call in ("Sea.beaufort(0)", "Sea.beaufort(12)", "Sea.sea_state(9)"):
        assert call in out


# Output faults: tests/bake/test_baker.py has them all; here their exit code and their line


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("folder", ["a file", "/dev/full", "a file/below", "x" * 300])
def test_a_folder_that_cannot_be_exits_4(run, folder):
    Path("a file").write_text("")
    code, out, err = run("bake", "-o", folder, *SMALL)
    assert code == 4
    assert not out
    assert err.startswith(f"fftocean: {folder} could not be made a folder: ")
    assert err.count("\n") == 1


@pytest.mark.usefixtures("quick")
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


@pytest.mark.usefixtures("quick")
def test_another_job_s_folder_exits_4_and_overwrite_takes_it(run):
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


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (MemoryError(), 2, "fftocean: not enough memory; a smaller --n needs less\n"),
        (
            KeyboardInterrupt(),
            130,
            "fftocean: interrupted; a folder without manifest.json is not a finished bake\n",
        ),
        (OSError(28, "No space left on device"), 4, "fftocean: output: No space left on device\n"),
        (
            OSError(5, "Input/output error", "some/file"),
            4,
            "fftocean: some/file: Input/output error\n",
        ),
        (BrokenPipeError(), 0, ""),
    ],
    ids=lambda v: type(v).__name__ if isinstance(v, BaseException) else "",
)
def test_what_can_stop_a_command_has_its_exit_code(run, error, code, said, monkeypatch):
    def fail(_):
        raise error

    monkeypatch.setattr(cli, "_drop_stdout", lambda: None)
    monkeypatch.setattr(cli, "_job", fail)
    assert run("info") == (code, "", said)


def test_each_error_of_ours_has_an_exit_code():
    kinds = [FFTOceanError]
    for kind in kinds:
        kinds += kind.__subclasses__()
    assert {kind.exit_code for kind in kinds} <= {2, 3, 4, 5, 6}


def test_a_full_disk_under_stdout_exits_4():
    """One line, no traceback, nothing ignored at exit. (A broken pipe: rich exits 1, silently.)"""
    command = [sys.executable, "-m", "fftocean.cli", "info", "--n", "4"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command, env=environment(), stdout=full, stderr=subprocess.PIPE, text=True, timeout=600
        )
    assert done.returncode == 4
    assert done.stderr.endswith("fftocean: output: No space left on device\n")
    assert all(line.startswith(("note: ", "fftocean: ")) for line in done.stderr.splitlines())


@pytest.mark.usefixtures("quick")
def test_a_closed_stdout_is_no_concern_of_the_bake(monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdout", None)
    assert cli.main(["bake", "-o", "out", *SMALL]) == 0
    assert cli.main(["info", "--n", "4"]) == 0
    assert Path("out/manifest.json").exists()
    assert "fftocean:" not in capsys.readouterr().err


# Signals and threads


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize(("at", "there"), [(1, 0), (2, 1), (5, 3)])
def test_a_signal_leaves_no_manifest(run, number, code, at, there, monkeypatch):
    """
    In the middle of a write, the at-th: the file's temporary name goes, its final name is not
    taken.

    They are the journal, the job, and for each frame the picture and its line in the journal.
    """
    before = signal.getsignal(signal.SIGINT)
    signal.signal(
        signal.SIGINT, signal.default_int_handler
    )  # a test runner in the background may ignore it
    calls = []
    real = os.fsync

    def fsync(descriptor):
        calls.append(descriptor)
        if len(calls) == at:
            os.kill(os.getpid(), number)
        real(descriptor)

    monkeypatch.setattr(os, "fsync", fsync)
    try:
        left, out, err = run("bake", "-o", "out", "--n", "8", "--frames", "4", "--maps", "height")
    finally:
        signal.signal(signal.SIGINT, before)
    assert left == code
    assert not out
    assert err.count("\n") <= 2
    assert ("1 of 4 frames are finished; the same command goes on from there" in err) == (at == 5)
    assert len(calls) == at
    assert len([p for p in Path("out").rglob("*") if p.is_file()]) == there
    assert not Path("out/manifest.json").exists()


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("arguments", [("bake", *SMALL), ("bake", "--n", "0"), ("--version",), ()])
def test_the_caller_keeps_its_own_handlers_and_filters(run, arguments):
    """Whatever comes of a command: SIGTERM is the caller's again, and so are the warnings."""

    def mine(*_):
        raise AssertionError

    before = signal.signal(signal.SIGTERM, mine)
    shown, filters = warnings.showwarning, list(warnings.filters)
    try:
        run(*arguments)
        assert signal.getsignal(signal.SIGTERM) is mine
    finally:
        signal.signal(signal.SIGTERM, before)
    assert warnings.showwarning is shown
    assert warnings.filters == filters


@pytest.mark.usefixtures("quick")
def test_a_command_runs_in_any_thread():
    """Signals are the main thread's business alone."""
    codes, said = [], io.StringIO()
    before = signal.getsignal(signal.SIGTERM)

    def work():
        with contextlib.redirect_stdout(said):
            codes.append(cli.main(["bake", "-o", "out", *SMALL]))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert codes == [0]
    assert "preview:" in said.getvalue()
    assert signal.getsignal(signal.SIGTERM) is before


# Several ways to the same job


@pytest.mark.usefixtures("quick")
def test_flags_override_the_file_and_so_does_set(run):
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


@pytest.mark.usefixtures("quick")
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


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("n", ["1", "2", "31", "[48, 80]", "48,80", "1,5"])
def test_any_number_of_samples_bakes(run, n):
    assert run("bake", "-o", "out", "--n", n, "--frames", "1")[0] == 0
    nx, ny = json.loads(Path("out/manifest.json").read_text())["ocean"]["n"]
    assert exr.decode(Path("out/height/0000.exr").read_bytes())[0].shape == (ny, nx)


@pytest.mark.usefixtures("quick")
def test_an_empty_file_is_a_job(run):
    Path("job.toml").write_text("")
    assert run("bake", "job.toml", "-o", "out", *SMALL)[0] == 0


@pytest.mark.usefixtures("quick")
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


def test_an_empty_output_is_not_the_current_folder(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as leaving:
        cli.main(["bake", "-o", "", "--n", "8", "--frames", "1"])
    assert leaving.value.code == 2
    assert "must not be empty" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


# Parts, rehearsals, and words for programs


@pytest.mark.usefixtures("quick")
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
def test_what_cannot_be_baked_is_refused(run, arguments, part):
    assert part in clean(
        run("bake", "-o", "out", *(arguments if "--n" in arguments else ["--n", "8", *arguments]))
    )


@pytest.mark.parametrize("number", ["0", "-1", "1.5", "", "two", "9" * 4000])
def test_workers_and_downsample_are_whole_numbers(run, number):
    for flag in ("--workers", "--downsample"):
        code, out, err = run("bake", "-o", "out", f"{flag}={number}")
        assert (code, out) == (2, "")
        assert "must be a whole number from 1 on" in err


def test_a_dry_run_writes_nothing_and_foretells_the_files(run, monkeypatch):
    """Their number to one, their bytes to a fifth: frames of a sea are much alike."""
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
    ("engine", "format_name", "words"),
    [
        ("unity", "exr-float", "exr-float in unity: choose the texture format RGBA Float"),
        ("babylon", "exr", "exr in babylon: by Texture, whose invertY is true"),
        ("canonical", "exr", None),
    ],
)
def test_a_bake_says_how_its_files_get_into_the_engine(run, engine, format_name, words):
    """In the summary, in that of tiles, and in a dry run."""
    flags = (
        "--engine",
        engine,
        "--format",
        format_name,
        "--maps",
        "displacement",
        "--frames",
        "2",
        "--executor",
        "serial",
    )
    for more in (
        ("--n", "8", "--dry-run"),
        ("--n", "8"),
        ("--tiles", "8:60,8:7", "--dry-run"),
        ("--tiles", "8:60,8:7", "--overwrite"),
    ):
        code, out, _ = run("bake", "-o", f"out{len(more)}", *flags, *more)
        assert code == 0
        found = [line for line in out.splitlines() if f" in {engine}: " in line]
        assert found == ([words] if words else [])


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
@pytest.mark.usefixtures("quick")
def test_a_dry_run_refuses_what_a_run_refuses(run, arguments, monkeypatch):
    """With the same words and code."""
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


@pytest.mark.parametrize(
    ("rate", "loop", "frames"),
    [("30", "16", 480), ("24", "2.5", 60), ("0.25", "16", 4), ("29.97", "100", 2997)],
)
def test_frames_a_second(run, rate, loop, frames):
    code, out, _ = run("info", "--n", "4", "--fps", rate, "--loop", loop)
    assert code == 0
    assert re.search(rf"bake.frames +{frames} *\n", out)


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--fps", "7.01"], "got 112.16 for 16 s at 7.01 a second; 112 frames want --loop 15.9772"),
        (["--fps", "0"], "--fps must be above 0"),
        (["--fps", "nan"], "--fps must be above 0"),
        (["--fps", "1e300"], "whole number of frames"),
        (["--fps", "1e-9"], "whole number of frames"),
        (["--fps", "30", "--frames", "480"], "--fps and a number of frames"),
    ],
)
def test_rates_that_cannot_be_are_refused(run, arguments, part):
    assert part in clean(run("bake", "-o", "out", *arguments))


def test_a_rate_and_a_part_of_the_loop_go_together(run):
    code, out, _ = run(
        "bake", "-o", "out", "--n", "8", "--fps", "3", "--frames", "0:10", "--dry-run"
    )
    assert code == 0
    assert "for 10 frames to out" in out


@pytest.mark.usefixtures("quick")
def test_names_are_case_blind(run):
    """Of formats, engines, maps, kinds and executors; what is written is one spelling."""
    Path("job.toml").write_text(
        "[[sea.systems]]\nspectrum = { kind = 'JONSWAP', hs = 1.5, tp = 4.0 }\nspreading = { kind = 'Cosine-Squared' }\n"
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


@pytest.mark.usefixtures("quick")
def test_a_finished_bake_says_that_all_was_there(run):
    flags = ("bake", "-o", "out", "--n", "8", "--frames", "3", "--maps", "height")
    assert "3 maps of 8 x 8 in " in run(*flags)[1]
    assert "nothing to bake: all 3 maps of 8 x 8 were there: out\n" in run(*flags)[1]
    Path("out/height/0001.exr").unlink()
    assert ", 2 of 3 frames were there: out\n" in run(*flags)[1]


def test_memory_counts_containers_and_video_memory_is_named(run):
    """
    Of 6 frames of 64 x 64: 4 halves of a displacement, whose container is held twice; one of
    height.
    """
    flags = ("--n", "64", "--frames", "6", "--maps", "displacement,height", "--dry-run", "--json")
    told = json.loads(run("bake", "-o", "out", *flags, "--format", "bin")[1])
    assert told["video"] == 6 * 64 * 64 * 2 * (4 + 1)  # graphics cards have no three channels
    assert told["container"] == 2 * 6 * 64 * 64 * 2 * 3
    assert json.loads(run("bake", "-o", "out", *flags)[1])["container"] == 0.0
    out = run("bake", "-o", "out", *flags[:-1], "--format", "bin")[1]
    assert "then 0.281 MiB for the container" in out
    assert (
        "video memory of the maps in an engine: 0.234 MiB for 6 frames, 0.0391 MiB a frame" in out
    )


@pytest.mark.parametrize(
    "command",
    [["info", "--n", "16"], ["presets"], ["verify", "--n", "8"], ["check", "out"]],
    ids=lambda c: c[0],
)
def test_tables_keep_their_figures_at_80_columns(run, command, monkeypatch):
    """No line is longer, no number or call is cut with an ellipsis, and the verdicts are there."""
    from rich.console import Console

    (Path("out") / "height").mkdir(parents=True)
    run("bake", "-o", "out", *SMALL, "--maps", "height", "--set", "bake.pictures=[]")
    Path("out/height/0000.exr").write_bytes(b"")
    monkeypatch.setattr(cli, "_console", lambda **_: Console(width=80, highlight=False))
    _, out, _ = run(*command)
    assert max(map(len, out.splitlines())) <= 80
    assert "…" not in out
    for part in {
        "info": ["significant wave height Hs", "directional spread"],
        "presets": ["Sea.beaufort(12)", "Sea.sea_state(9)", "Smooth (wavelets)"],
        "verify": ["stretch_xx", "1.0e-12", "ok"],
        "check": ["height/0000.exr"],
    }[command[0]]:
        assert part in out


def events(out):
    """Lines of JSON, each one event."""
    return [json.loads(line) for line in out.splitlines()]


@pytest.mark.usefixtures("quick")
def test_events_tell_all_that_happens(run):
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


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    ("stop", "code", "word"),
    [(KeyboardInterrupt(), 130, "interrupted"), (SystemExit(143), 143, "terminated")],
)
def test_events_tell_of_a_stop(run, stop, code, word, monkeypatch):
    def fail(*_, **__):
        raise stop

    monkeypatch.setattr(baker, "_finish", fail)
    left, out, err = run("bake", "-o", "out", "--n", "8", "--frames", "2", "--json")
    assert left == code
    assert events(out)[-1] == {"event": "error", "message": word, "exit_code": code}
    assert "2 of 2 frames are finished; the same command goes on from there" in err


# fftocean check: tests/bake/test_check.py has what it finds; here its words and its exit code


@pytest.fixture
def baked(run, quick):  # noqa: ARG001 - for what it does
    assert run("bake", "-o", "out", "--n", "8", "--frames", "3", "--maps", "height")[0] == 0
    return Path("out")


def test_check_says_that_all_is_well(run, baked):
    assert run("check", baked) == (0, "no problems found: out\n", "")
    assert run("check", baked, "--quiet") == (0, "", "")
    code, out, err = run("check", baked, "--json")
    assert (code, events(out), err) == (0, [{"event": "done", "findings": 0}], "")


def test_check_names_what_is_wrong_and_repair_mends_it(run, baked):
    expected = {p: p.read_bytes() for p in baked.rglob("*") if p.is_file()}
    (baked / "height/0001.exr").write_bytes(b"")
    (baked / "height/0002.exr").unlink()
    code, out, err = run("check", baked)
    assert (code, err) == (5, "")
    assert "cut" in out
    assert "height/0001.exr" in out
    assert out.endswith("2 problems: out\n")
    code, out, _ = run("check", baked, "--json")
    assert code == 5
    found = events(out)
    assert [e["event"] for e in found] == ["finding", "finding", "done"]
    assert {(e["kind"], e["path"], e["map"], e["frame"]) for e in found[:2]} == {
        ("cut", "height/0001.exr", "height", 1),
        ("missing", "height/0002.exr", "height", 2),
    }
    code, out, _ = run("check", baked, "--repair")
    assert code == 0
    assert "repaired: 2 frames were written again" in out
    assert out.endswith("no problems found: out\n")
    assert {p: p.read_bytes() for p in baked.rglob("*") if p.is_file()} == expected


def test_check_of_an_unfinished_bake_and_of_none(run, baked):
    (baked / "manifest.json").unlink()
    code, out, _ = run("check", baked)
    assert code == 5
    assert "unfinished" in out
    code, out, err = run("check", "nowhere")
    assert (code, out) == (4, "")
    assert err == "fftocean: nowhere must be the folder of a bake, and is not there\n"
