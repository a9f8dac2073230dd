"""Usage, help and suggestions of the parser."""

import shlex
import subprocess
import sys

import pytest
from builders import environment

import fftocean as fo
from fftocean.cli import main
from fftocean.cli.job_flags import job_of
from fftocean.cli.parser import COMMANDS, build_parser
from fftocean.job.parameters import PARAMETERS


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
        (["bake", "--MAPS", "height"], "did you mean --maps?"),
        (["export-sea", "--engine", "Godoh"], "did you mean godot?"),
    ],
)
def test_usage_errors_exit_2(run, arguments, part):
    code, out, err = run(*arguments)
    assert code == 2
    assert not out
    assert part in err
    assert err.startswith("usage: fftocean")


@pytest.mark.parametrize("command", ["bake", "check", "info", "verify", "bench", "plot", "presets"])
def test_a_wrong_flag_prints_the_usage_of_its_own_command(run, command):
    """The answer has two lines: the usage of that command alone, and the error."""
    code, out, err = run(command, *(["out"] if command == "check" else []), "--nonsense")
    assert (code, out) == (2, "")
    usage, error = err.splitlines()
    assert usage.startswith(f"usage: fftocean {command} ")
    unknown = "unrecognized arguments: --nonsense"
    assert error == f"fftocean {command}: error: {unknown}; see fftocean {command} --help"


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["bake", "--maps", "Hieght"], "did you mean height?"),
        (["bake", "--executor", "seriel", "--n", "8"], "did you mean serial?"),
        (["series", "--at", "0,0", "--fields", "hieght", "-o", "p.csv"], "did you mean height?"),
        (["keys", "spreeding"], "did you mean spreading?"),
        (["bake", "--set", "ocean.sise=3"], "did you mean ocean.size?"),
    ],
)
def test_a_misspelt_value_is_answered_with_the_nearest(run, arguments, part):
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert part in err


def test_case_does_not_matter_in_names(run):
    assert run("VERIFY", "--n", "8", "--dtype", "Float32")[0] == 0
    flags = ("--n", "8", "--frames", "1", "--quiet")
    assert run("Bake", "--engine", "GODOT", "--format", "EXR", "-o", "BAKE", *flags)[0] == 0
    assert run("check", "BAKE", "--quiet")[0] == 0
    assert run("export-sea", "--engine", "Godot", "-o", "Sea", "--n", "8", "--quiet")[0] == 0


@pytest.mark.parametrize("command", ["bake", "info", "export-sea"])
@pytest.mark.parametrize("flag", [("--n", "16"), ("--size", "90"), ("--set", "ocean.n=16")])
def test_samples_beside_tiles_are_refused(run, command, flag):
    """Tiles have their own; before, a flag was ignored."""
    code, out, err = run(command, "--tiles", "8:100,8:37", *flag)
    assert (code, out) == (2, "")
    assert "and tiles must not be given together" in err


def test_order_two_is_answered_with_a_flag(run):
    for command in (
        ["export-sea"],
        ["series", "--at", "0,0", "--fields", "pressure", "-o", "p.csv"],
    ):
        code, out, err = run(*command, "--order", "2", "--n", "16")
        assert (code, out) == (2, "")
        assert "--order 1" in err


def test_version(run):
    assert run("--version") == (0, f"fftocean {fo.__version__}\n", "")


FLAGGED = [p for p in PARAMETERS if p.flag and not p.switch]  # a switch takes no value


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


@pytest.mark.parametrize("example", [line for command in COMMANDS for line in command.examples])
def test_examples_of_the_help_parse(example):
    word, *arguments = shlex.split(example)
    assert word == "fftocean"
    options = build_parser().parse_args(arguments)
    if "set" in options:
        if ":" in (options.frames or ""):
            options.frames = None  # a part of the loop, and no key of a job
        options.job = None  # the files are the reader's own
        job_of(options)


@pytest.mark.process
def test_help_loads_no_heavy_library():
    """
    numba, FFTW, OpenEXR, SciPy and NumPy are loaded by the work that needs them.
    """
    heavy = {"numba", "pyfftw", "OpenEXR", "scipy", "numpy", "rich", "PIL"}
    program = "import sys; from fftocean.cli import main\ntry: main(['--help'])\n"
    program += f"except SystemExit: print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.stdout.endswith("\n[]\n"), done.stdout + done.stderr


@pytest.mark.parametrize("number", ["0", "-1", "1.5", "", "two", "9" * 4000])
def test_workers_and_downsample_are_whole_numbers(run, number):
    for flag in ("--workers", "--downsample"):
        code, out, err = run("bake", "-o", "out", f"{flag}={number}")
        assert (code, out) == (2, "")
        assert "must be a whole number from 1 on" in err


def test_an_empty_output_is_not_the_current_folder(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as leaving:
        main(["bake", "-o", "", "--n", "8", "--frames", "1"])
    assert leaving.value.code == 2
    assert "must not be empty" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
