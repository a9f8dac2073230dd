"""
The readers of a package's waves in JavaScript, C# and C++, each compiled and run, and in GDScript,
run by Godot's web build: the water of `fo.Query`, and every fault of a package refused in words.
"""

import re
import shutil
import subprocess
from pathlib import Path

import bad_packages as bad
import pytest
import sea_waves
from conftest import require
from pck import pack

pytestmark = pytest.mark.client

HERE = Path(__file__).resolve().parent
READERS = HERE.parents[1] / "examples" / "readers"
ASK = HERE / "readers"
POINTS = {"javascript": 1000, "csharp": 1000, "cpp": 1000, "rust": 1000, "godot": 100}
METRES = 1e-5
"""Largest error of a reader [m]: sums in double precision are good to 1e-9."""


def run(folder, *command):
    done = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=600,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def javascript(folder):
    require(shutil.which("node"), "node is not installed")
    shutil.copy(READERS / "sea_waves.js", folder / "sea_waves.mjs")
    shutil.copy(ASK / "ask.mjs", folder)
    return run(folder, "node", "ask.mjs").splitlines()


def csharp(folder):
    for command in ("mcs", "mono"):
        require(shutil.which(command), f"{command} is not installed")
    sources = [str(READERS / "SeaWaves.cs"), str(ASK / "Ask.cs")]
    run(folder, "mcs", "-warnaserror", "-warn:4", "-out:ask.exe", *sources)
    return run(folder, "mono", "ask.exe").splitlines()


def cpp(folder):
    require(shutil.which("g++"), "g++ is not installed")
    warnings = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
    include = f"-I{READERS}"
    run(folder, "g++", "-std=c++17", "-O1", *warnings, include, str(ASK / "ask.cpp"), "-o", "ask")
    return run(folder, "./ask").splitlines()


def rust(folder):
    if not shutil.which("rustc"):  # not among the clients that are installed for these tests
        pytest.skip("rustc is not installed")
    shutil.copy(READERS / "sea_waves.rs", folder)
    shutil.copy(ASK / "ask.rs", folder)
    run(folder, "rustc", "--edition=2021", "-O", "-D", "warnings", "ask.rs", "-o", "ask-rust")
    return run(folder, "./ask-rust").splitlines()


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    """Return a folder with all packages, good and bad."""
    folder = tmp_path_factory.mktemp("packages")
    for path, data in sea_waves.packages().items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


@pytest.fixture(scope="module")
def answers(packages, request):
    """Return a function from a language to what its reader answered, once a session."""
    known = {}

    def of(language):
        if language in known:
            if known[language] is None:
                pytest.skip("the reader could not be run: see the first test of this language")
        else:
            known[language] = None  # until it has answered
            count = POINTS[language]
            (packages / "ask.txt").write_text(sea_waves.questions(count))
            if language == "godot":
                lines = godot(request.getfixturevalue("browser"), count)
            else:
                lines = globals()[language](packages)
            known[language] = sea_waves.answers(lines, count)
        return known[language]

    return of


def godot(browser, count):
    """Run the project in Godot's web build; return its lines."""
    files = {
        "project.godot": (HERE / "godot" / "project.godot").read_bytes(),
        "main.tscn": (HERE / "godot" / "main.tscn").read_bytes().replace(b"Node3D", b"Node"),
        "main.gd": (ASK / "main.gd").read_bytes(),
        "sea_waves.gd": (READERS / "sea_waves.gd").read_bytes(),
        "ask.txt": sea_waves.questions(count).encode(),
    }
    files |= sea_waves.packages()
    (browser.site.folders["bakes"] / "waves.pck").write_bytes(pack(files))
    value, _ = browser.run("godot.html", {"pack": "/bakes/waves.pck"})
    return value["answers"]["lines"]


@pytest.mark.parametrize("name", ["sea_waves.gd"])
def test_the_linter_finds_nothing(name):
    linter = pytest.importorskip("gdtoolkit.linter")
    problems = linter.lint_code((READERS / name).read_text(encoding="utf-8"))
    assert [str(problem) for problem in problems] == []


@pytest.mark.parametrize("language", POINTS)
def test_a_reader_finds_the_water_of_the_library(language, answers, packages):
    """
    Angles of 1e7 radians, as the direct sum has them a thousand kilometres out, are good to 1e-9.
    Godot's vectors, which it gives normals as, have single precision.
    """
    found = answers(language)
    unit = 1e-6 if language == "godot" else 1e-8
    sea_waves.require_right(found, packages / "good", metres=METRES, unit=unit)


@pytest.mark.parametrize("language", POINTS)
def test_the_strongest_waves_state_what_they_neglect(language, answers):
    sea_waves.require_strongest(answers(language))


@pytest.mark.parametrize("language", POINTS)
@pytest.mark.parametrize("case", bad.CASES)
def test_a_fault_is_refused_by_file_and_rule(case, language, answers):
    said = answers(language).refusals[case]
    assert said.startswith("error "), said
    assert re.search(bad.CASES[case][1], said.removeprefix("error ")), said
