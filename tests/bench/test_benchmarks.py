"""Benchmarks at small sizes: each answers its question, and the report has only answers."""

import ctypes
import importlib
import json
import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from builders import require

import fftocean as fo
from fftocean import host
from fftocean.bench import machine
from fftocean.bench.results import Reading, answer, read

FOLDER = Path(__file__).resolve().parents[2] / "benchmarks"
QUESTIONS = (
    *("frame", "direct_sum", "scaling", "memory", "startup", "seeding", "bake", "second_order"),
    *("series", "robots", "query", "bake_peers", "many_frames"),
)
HELPERS = ("gpu", "encino_waves", "script", "fresh", "report", "all")
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def script(monkeypatch):
    """
    Import a script of benchmarks/ as Python does when it is run from there; forget it afterwards.
    """
    monkeypatch.syspath_prepend(str(FOLDER))
    before = set(sys.modules)
    yield importlib.import_module
    for name in {*QUESTIONS, *HELPERS} & (set(sys.modules) - before):
        del sys.modules[name]


def asked(script, name, tmp_path, *flags):
    """Ask a question; its answer, and the bytes of its picture."""
    files = tmp_path / f"{name}.json", tmp_path / f"{name}.png"
    assert script(name).main([*flags, "--json", str(files[0]), "--plot", str(files[1])]) == 0
    return read(files[0]), files[1].read_bytes()


@pytest.mark.parametrize(
    ("name", "flags", "says"),
    [
        ("many_frames", ["--frames", "0"], "--frames must be a whole number between 1 and"),
        ("query", ["--points", "0"], "--points must be a whole number between 100 and"),
        ("bake_peers", ["--rounds", "0"], "--rounds must be a whole number between 1 and"),
        ("bake_peers", ["--frames", "3"], "--frames must be at least 12, got 3"),
    ],
)
def test_wrong_numbers_are_refused_by_name(script, capsys, name, flags, says):
    assert script(name).main(flags) == 2
    assert says in " ".join(capsys.readouterr().err.split())


def test_an_earlier_version_that_cannot_run_is_named(script, tmp_path, capsys):
    missing = str(tmp_path / "python")
    flags = ["--n", "16", "--frames", "12", "--rounds", "1", "--earlier", f"old={missing}"]
    assert script("bake_peers").main(flags) == 2
    assert "old could not be run" in capsys.readouterr().err


def test_encino_waves_needs_its_sources(script, tmp_path, capsys):
    assert script("encino_waves").main(["--source", str(tmp_path)]) == 2
    assert f"{tmp_path} is no checkout of EncinoWaves" in " ".join(capsys.readouterr().err.split())


def test_a_compiler_that_fails_says_why(script, tmp_path, capsys):
    header = tmp_path / "src" / "EncinoWaves" / "Propagation.h"
    header.parent.mkdir(parents=True)
    header.touch()
    flags = ["--source", str(tmp_path), "--compiler", "no-such-compiler"]
    assert script("encino_waves").main(flags) == 2
    assert "no-such-compiler could not be run" in capsys.readouterr().err


class InventedEncino:
    """Fields of one wave along x, as the library of EncinoWaves gives them."""

    def __init__(self, n, turned=1.0):
        x = 2.0 * np.pi * np.arange(n + 1) / n * np.ones((n + 1, 1))
        normals = np.zeros((n + 1, n + 1, 3))
        normals[..., 2] = 1.0
        fields = np.cos(x), turned * np.sin(x), 0.0 * x, 0.0 * x, normals
        self._fields = [np.ascontiguousarray(field, np.float32) for field in fields]
        self.times = []

    def sea_new(self, power, threads):
        assert threads == 1
        return 2**power

    def sea_free(self, sea):
        pass

    def sea_frame(self, _, t):
        self.times.append(t)

    def sea_field(self, _, number):
        kind = ctypes.POINTER(ctypes.c_float)
        return self._fields[number].ctypes.data_as(kind)


def test_encino_waves_must_be_waves(script):
    """Displacements of another sign are another work; so is a frame at the same time again."""
    encino = script("encino_waves")
    library = InventedEncino(16)
    theirs = encino.Encino(library, 16)
    theirs.require_waves()
    theirs()
    assert library.times[0] != library.times[1]
    with pytest.raises(fo.ParameterError, match="displacement 1 of EncinoWaves is off by"):
        encino.Encino(InventedEncino(16, turned=-1.0), 16).require_waves()
    with pytest.raises(fo.ParameterError, match="power of two samples a side, got 12"):
        encino.Encino(library, 12)


def test_frame_answers(script, tmp_path, capsys):
    result, picture = asked(script, "frame", tmp_path, "--n", "16", "32", "--seconds", "0")
    assert picture[:8] == PNG
    for n in (16, 32):
        for backend in machine.backends():
            assert result.find("full frame", race="others", n=n, backend=backend).clock == "cpu"
            assert result.find("textbook / full frame", n=n, backend=backend).unit == "x"
            assert result.find("full frame / floor", n=n, backend=backend).median > 0.0
        assert result.find("height only / full frame", n=n).at["race"] == "fields"
        assert len(result.all("full frame", planning="estimate", n=n)) == 1
        for r in result.all("one thread / more", n=n):
            assert (r.clock, r.at["race"]) == ("wall", "threads")
    out, err = capsys.readouterr()
    assert "textbook / full frame" in out
    assert re.search(r"frame: 32 x 32, threads\n", err)


def test_frame_leaves_out_what_does_not_fit(script, monkeypatch, capsys):
    frame = script("frame")
    monkeypatch.setattr(frame, "available_memory", lambda: 1e5)
    monkeypatch.setattr(frame, "others", lambda *_: pytest.fail("it measured"))
    assert frame.main(["--n", "2048", "--seconds", "0"]) == 0
    assert "2048 x 2048 is left out: its contenders need 3.5 GiB" in capsys.readouterr().err


def test_direct_sum_answers(script, tmp_path):
    flags = ("--n", "4", "6", "16", "20", "24", "--seconds", "0", "--limit", "1e5")
    result, picture = asked(script, "direct_sum", tmp_path, *flags)
    assert picture[:8] == PNG
    assert [r.at["points"] == int(r.at["n"]) ** 2 for r in result.all("direct sum")] == [
        True,
        True,
        True,
        False,
        False,
    ]
    for r in result.all("direct sum / FFT", dtype="float32"):
        assert r.median > 0.0
    assert result.find("exponent of N, direct sum").count == 3


def test_a_part_of_the_direct_sum_is_scaled_to_the_whole(script, monkeypatch):
    direct_sum, seen = script("direct_sum"), []
    real = direct_sum.race
    monkeypatch.setattr(direct_sum, "race", lambda *a, **k: seen.append(real(*a, **k)) or seen[-1])
    readings = direct_sum.at_one_size(
        16, 0.0, 224 * 64.5
    )  # 224 waves: enough for 64 of the 256 points
    for raw, whole in zip(seen[0], readings, strict=True):
        assert whole.median == pytest.approx(
            raw.median * (4.0 if "direct sum" in raw.what else 1.0)
        )
    assert next(r.at["points"] for r in readings if r.what == "direct sum") == 64


def costs(n, fft, direct):
    """Readings as the question makes them, of costs that we choose [ms]."""
    for i, size in enumerate(n):
        for dtype in ("float32", "float64"):
            yield Reading.single("FFT", "ms", fft[i], {"n": size, "dtype": dtype})
            yield Reading.single(
                "direct sum / FFT", "x", direct[i] / fft[i], {"n": size, "dtype": dtype}
            )
        yield Reading.single(
            "direct sum", "ms", direct[i], {"n": size, "points": size**2, "waves": size**2}
        )


def test_direct_sum_concludes_from_synthetic_curves(script):
    """
    The FFT at 0.1 ms + 2e-6 N log2 N, the sum at 1e-5 N^2: they cross where N^2 = 1e4, at n = 10
    and a bit for the logarithm.
    """
    n = np.array([4, 6, 8, 9, 10, 11, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512])
    count = n.astype(float) ** 2
    found = script("direct_sum").conclusions(
        list(costs([int(v) for v in n], 0.1 + 2e-6 * count * np.log2(count), 1e-5 * count**2))
    )
    by = {(r.what, r.at.get("dtype")): r for r in found}
    cross = by["crossover", "float32"]
    assert (cross.low, cross.high) == (10.0, 11.0)
    assert 10.0 < cross.median < 10.1
    exponent = by["exponent of N, direct sum", None]
    assert exponent.median == pytest.approx(2.0, abs=1e-12)
    assert exponent.low <= exponent.median <= exponent.high
    assert by["misfit of N^2, direct sum", None].median < 1e-9
    assert by["misfit of N log N, FFT", "float64"].median < 1e-9
    assert by["misfit of N^2, FFT", "float64"].median > 10.0
    pure = script("direct_sum").conclusions(
        list(costs([int(v) for v in n], 1e-6 * count * np.log2(count), 1e-5 * count**2))
    )
    divided = {(r.what, r.at.get("dtype")): r.median for r in pure}[
        "exponent of N, FFT, the logarithm divided out", "float32"
    ]
    assert divided == pytest.approx(1.0, abs=1e-12)


def test_scaling_answers(script, tmp_path):
    result, picture = asked(
        script, "scaling", tmp_path, "--n", "16", "30", "31", "32", "33", "64", "--seconds", "0"
    )
    assert picture[:8] == PNG
    for r in result.all("full frame"):
        n = int(r.at["n"])
        per = result.find("full frame, a point and log2 N", n=n)
        assert per.median == pytest.approx(1e6 * r.median / (n * n * 2 * np.log2(n)), rel=1e-12)
    assert result.find("exponent of N, powers of two").count == 3


@pytest.mark.parametrize(
    ("n", "kind"),
    [
        (1024, "a power of two"),
        (360, "smooth"),
        (343, "smooth"),
        (257, "prime, or twice one"),
        (514, "prime, or twice one"),
        (143, "other"),
    ],
)
def test_sizes_are_of_their_kind(script, n, kind):
    assert script("scaling").kind(n) == kind


def test_memory_answers(script, tmp_path):
    result, picture = asked(script, "memory", tmp_path, "--n", "64", "--runs", "1")
    assert picture[:8] == PNG
    arrays = result.find("of it the frame's own arrays", n=64).median
    assert (
        arrays == 64 * 64 * 7 * 4 / 2**20
    )  # height, two displacements, Jacobian, three of the normal
    assert result.find("after the imports").median > 10.0  # NumPy alone takes more
    assert (
        result.find("peak above imports").median
        >= result.find("resident while streaming").median
        > 0.0
    )


def test_memory_counts_what_is_held(script):
    """
    The child's own arithmetic, on a process that holds 64 MiB while the ocean is made and lets them
    go again.
    """
    memory, fresh = script("memory"), script("fresh")
    hoard = (
        "make = lambda *a, **k: (bytearray(64 * 2**20), fo.Ocean(*a, **k))[1]\n"
        "make.from_modes = fo.Ocean.from_modes"
    )
    child = memory.CHILD.replace(
        "make = fo.Sea.from_wind(speed=10.0, fetch=100e3), fo.Ocean",
        f"_ = fo.Sea.from_wind(speed=10.0, fetch=100e3), 0\n{hoard}",
    )
    assert child != memory.CHILD
    plain, hoarding = (
        fresh.python("-c", text, "16", "height", "auto").said for text in (memory.CHILD, child)
    )
    assert hoarding["making"] - plain["making"] == pytest.approx(
        64.0, abs=4.0
    )  # pages that other allocations take or give back
    assert abs(hoarding["resident"] - plain["resident"]) < 4.0


def test_startup_answers(script, tmp_path, monkeypatch):
    """
    Lives of processes that we choose: an idle one of 0.5 s, imports of 0.625 and 0.75 s, the first
    frame 9 s, later ones 2 s.
    """
    fresh = script("fresh")
    cold = []

    def python(*arguments, cache=None):
        if cache is not None:
            cold.append((cache.is_dir(), cache))
            return fresh.Run(9.0 if [c for _, c in cold].count(cache) == 1 else 2.0, 1.5, None)
        walls = {"pass": 0.5, "import numpy": 0.625, "import fftocean": 0.75, "--help": 1.0}
        wall = walls[arguments[-1]]
        return fresh.Run(wall, wall / 4.0, None)

    monkeypatch.setattr(fresh, "python", python)
    result, picture = asked(script, "startup", tmp_path, "--runs", "3", "--cold", "2")
    assert picture[:8] == PNG
    assert result.find("import fftocean, above Python", clock="cpu").median == 0.0625
    medians = {r.what: r.median for r in result.readings if r.clock == "wall"}
    assert medians["import fftocean, above Python"] == 0.25
    assert medians["fftocean --help"] == 1.0
    assert medians["first frame after installation"] == 9.0
    assert medians["first frame in later processes"] == 2.0
    assert medians["first frame in later processes, above NumPy"] == 1.375
    assert all(is_folder for is_folder, _ in cold)
    assert len({cache for _, cache in cold}) == 2  # each first one had an empty cache of its own


def test_a_fresh_process_uses_this_package_and_the_cache_it_is_given(script, tmp_path, monkeypatch):
    """And keeps modules compiled, whatever this process does."""
    import fftocean

    fresh = script("fresh")
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    program = (
        "import fftocean, json, os, sys; print(json.dumps("
        "[fftocean.__file__, os.environ['NUMBA_CACHE_DIR'], sys.dont_write_bytecode]))"
    )
    run = fresh.python("-c", program, cache=tmp_path)
    assert run.said == [fftocean.__file__, str(tmp_path), False]
    assert run.wall > 0.0
    assert run.cpu > 0.0
    assert fresh.python("-c", "print('no json')").said is None
    with pytest.raises(RuntimeError, match=r"failed with 3: .*why"):
        fresh.python("-c", "import sys; sys.exit(print('why', file=sys.stderr) or 3)")


def test_every_file_that_a_profile_is_sorted_by_exists(script):
    bake = script("bake")
    places = [place for _, places in bake.PARTS for place in places if not place.startswith("~")]
    files = [path.relative_to(bake.PACKAGE).as_posix() for path in bake.PACKAGE.rglob("*.py")]
    for place in places:
        start = place.partition(":")[0]
        assert any(file.startswith(start) for file in files), place


def test_a_profile_is_sorted_by_part_of_the_package(script):
    """
    A profile made by hand: own times belong to the part that holds the file; a library's to its
    caller; the system's to the disk.
    """
    bake = script("bake")
    at = lambda path, name: (str(bake.PACKAGE / path), 1, name)  # noqa: E731
    baker, frame, encode, halves = (
        at("baking/bake.py", "bake"),
        at("ocean.py", "loop_frame"),
        at("export/exr.py", "encode"),
        at("baking/scene/scene.py", "_halves"),
    )
    kernel, pack = at("kernels/passes.py", "pack"), at("kernels/half.py", "pack")
    library, deep = ("/lib/json.py", 5, "dumps"), ("~", 0, "<built-in method deep>")
    sync, digest, lost = (
        ("~", 0, "<built-in method posix.fsync>"),
        ("~", 0, "<built-in method _hashlib.openssl_sha256>"),
        ("/lib/x.py", 1, "root"),
    )

    stats = {
        baker: (1, 1, 1.0, 40.0, {}),
        frame: (1, 1, 2.0, 2.0, {baker: (1, 1, 2.0, 2.0)}),
        kernel: (1, 1, 4.0, 4.0, {frame: (1, 1, 4.0, 4.0)}),
        encode: (1, 1, 8.0, 8.0, {baker: (1, 1, 8.0, 8.0)}),
        pack: (1, 1, 0.5, 0.5, {halves: (1, 1, 0.5, 0.5)}),
        halves: (1, 1, 0.25, 0.75, {baker: (1, 1, 0.25, 0.75)}),
        library: (2, 2, 3.0, 3.5, {baker: (1, 1, 1.0, 1.0), encode: (1, 1, 2.0, 2.5)}),
        deep: (1, 1, 0.5, 0.5, {library: (1, 1, 0.5, 0.5)}),
        sync: (1, 1, 5.0, 5.0, {baker: (1, 1, 5.0, 5.0)}),
        digest: (1, 1, 6.0, 6.0, {baker: (1, 1, 6.0, 6.0)}),
        lost: (1, 1, 0.125, 0.125, {}),
    }
    seconds = bake.parts(stats)
    assert seconds == pytest.approx(
        {
            "simulation": 2.0 + 4.0,
            "encoder": 8.0 + 0.5 + 0.25 + 2.0 + 0.5,  # json's callee works for json's chief caller
            "Python": 1.0 + 1.0 + 0.125,
            "disk": 5.0,
            "checksums": 6.0,
        }
    )
    assert sum(seconds.values()) == pytest.approx(sum(own for _, _, own, _, _ in stats.values()))


def test_libraries_that_call_each_other_in_a_ring_are_sorted_too(script):
    bake = script("bake")
    a, b = ("/lib/a.py", 1, "a"), ("/lib/b.py", 1, "b")
    stats = {a: (1, 1, 1.0, 2.0, {b: (1, 1, 1.0, 2.0)}), b: (1, 1, 2.0, 2.0, {a: (1, 1, 2.0, 2.0)})}
    assert bake.parts(stats) == pytest.approx({"Python": 3.0})


def test_kernels_are_seen_by_the_profiler_and_put_back(script):
    import cProfile
    import pstats

    from fftocean.kernels import surface

    bake, before = script("bake"), surface.jacobian
    fields = np.ones((4, 8, 8), dtype=np.float32)
    surface.jacobian(*fields[:3], np.float32(1.0), fields[3])  # compiled
    with bake.kernels_seen():
        profile = cProfile.Profile()
        profile.runcall(surface.jacobian, *fields[:3], np.float32(1.0), fields[3])
    assert surface.jacobian is before
    if os.environ.get("NUMBA_DISABLE_JIT") != "1":
        assert any(
            Path(file).name == "surface.py" and name == "jacobian"
            for file, _, name in pstats.Stats(profile).stats
        )
    assert np.all(fields[3] == 3.0)  # 2 x 2 - 1 x 1


# The report


def invented(question, *readings):
    return answer(
        question,
        f"How is {question}?",
        readings,
        {"n": [64]},
        {"utc": "2026-01-31 12:00", "load": 0.25},
    )


def test_each_goal_is_held_to_its_reading(script):
    report = script("report")
    at = {"n": 256, "backend": "pyfftw", "planning": "measure"}
    results = {
        "frame": invented(
            "frame",
            Reading("textbook / full frame", "x", 18.5, 18.0, 18.9, 20, "cpu", at),
            Reading("textbook / full frame", "x", 17.5, 17.0, 17.9, 20, "cpu", {**at, "n": 512}),
            Reading(
                "full frame / floor",
                "x",
                0.71,
                0.7,
                0.73,
                20,
                "cpu",
                {"n": 256, "backend": "pyfftw"},
            ),
        ),
        "memory": invented(
            "memory", Reading("peak above imports", "MiB", 301.0, 300.0, 302.0, 3, "", {"n": 2048})
        ),
    }
    lines = report.report(results).splitlines()

    def row(words):
        (line,) = (line for line in lines if line.startswith(f"| {words} |"))
        return [cell.strip() for cell in line.strip("|").split("|")]

    assert row("textbook NumPy / full frame, 256 x 256, pyfftw")[1:] == [
        "at least 18 x",
        "18.5 x",
        "18 to 18.9",
        "met",
    ]
    assert row("textbook NumPy / full frame, 512 x 512, pyfftw")[1:] == [
        "at least 18 x",
        "17.5 x",
        "17 to 17.9",
        "**not met**",
    ]
    assert row("full frame / eight raw c2r and a copy, 256 x 256, pyfftw")[-1] == "met"
    assert row("peak memory above imports, full frames, 2048 x 2048")[1:] == [
        "at most 300 MiB",
        "301 MiB",
        "300 to 302",
        "**not met**",
    ]
    assert row("first frame after installation")[1:] == ["at most 15", "not measured", "", ""]
    assert len([line for line in lines if "not measured" in line]) == len(report.goals()) - 4


def test_every_goal_names_a_reading_that_its_question_makes(script, tmp_path):
    """
    The names that the goals look for are those that the questions write, at tiny sizes here.
    """
    report = script("report")
    made = {"frame": asked(script, "frame", tmp_path, "--n", "16", "--seconds", "0")[0]}
    made["direct_sum"] = asked(script, "direct_sum", tmp_path, "--n", "4", "8", "--seconds", "0")[0]
    for goal in report.goals():
        if (
            goal.question in made
            and goal.at.get("backend", "scipy") in machine.backends()
            and host.cores() > 1
        ):
            size = {"n": 16} if goal.question == "frame" else {"n": 8}
            assert len(made[goal.question].all(goal.reading, **{**goal.at, **size})) == 1, goal
    sources = {name: (FOLDER / f"{name}.py").read_text() for name in ("memory", "startup", "bake")}
    for goal in report.goals():
        if goal.question in sources:
            words = goal.reading.replace(", above Python", "")
            assert f'"{words}"' in sources[goal.question], goal


def test_the_report_is_made_from_the_files_and_from_nothing_else(script):
    """RESULTS.md is to the byte what the JSON files give: no figure was written by hand."""
    report = script("report")
    assert (FOLDER / "RESULTS.md").read_text(encoding="utf-8") == report.report(report.gather())


def test_every_question_is_asked_by_the_one_command_and_has_its_picture(
    script, monkeypatch, tmp_path
):
    """
    `all.py` runs each script with the flags that this script knows, and writes the report of what
    is there.
    """
    everything = script("all")
    machine.describe()  # runs `uname` once, by the `subprocess` that is replaced below
    ran = []

    class Done:
        returncode = 0

    def run(command, **_):
        name = Path(command[1]).stem
        question = invented(name, Reading.single("x", "ms", 1.0, {"n": 64}, clock="cpu"))
        question.write(Path(command[command.index("--json") + 1]))
        ran.append((name, command[2:]))
        done = Done()
        done.returncode = int(name == "memory")
        return done

    monkeypatch.setattr(everything.subprocess, "run", run)
    assert everything.main(["--quick", "--output", str(tmp_path)]) == 1  # one question failed
    assert [name for name, _ in ran] == list(QUESTIONS)
    page = (tmp_path / "RESULTS.md").read_text(encoding="utf-8")
    for name, flags in ran:
        assert f"(results/{name}.png)" in page
        assert str(tmp_path / "results" / f"{name}.png") in flags
        parser = __import__("argparse").ArgumentParser()
        script(name).flags(parser)
        parser.parse_args(
            flags[: flags.index("--json")]
        )  # leaves with an error if a flag is unknown
    monkeypatch.setattr(everything.subprocess, "run", lambda *_, **__: Done())
    assert everything.main(["--only", "frame", "--output", str(tmp_path)]) == 0


def test_a_question_that_cannot_be_asked_ends_with_an_error(script, capsys):
    assert script("frame").main(["--n", "0", "--seconds", "0"]) == 2
    assert "frame: n must be" in capsys.readouterr().err


def test_json_holds_the_machine_and_the_settings(script, tmp_path):
    asked(script, "scaling", tmp_path, "--n", "8", "16", "--seconds", "0")
    tree = json.loads((tmp_path / "scaling.json").read_text())
    assert tree["settings"]["n"] == [8, 16]
    assert tree["machine"] == machine.describe()
    assert tree["before"]["utc"] <= tree["after"]["utc"]


@pytest.mark.client
def test_gpu_answers(script, tmp_path):
    """On whatever adapter there is; each reading names it."""
    try:
        adapter = fo.gpu.adapter()
    except fo.ParameterError as error:
        require(False, str(error))
    result, picture = asked(script, "gpu", tmp_path, "--n", "16", "32", "--seconds", "0")
    assert picture[:8] == PNG
    for n in (16, 32):
        kept = result.find("full frame, kept on the device", n=n)
        assert (kept.clock, kept.at["adapter"]) == ("wall", str(adapter))
        assert result.find("reading back alone", n=n).median > 0.0
        ratio = result.find("full frame on the CPU / full frame, read back", n=n)
        assert (ratio.unit, ratio.count) == ("x", 3)


def test_series_answer(script, tmp_path):
    flags = ("--n", "16", "--hours", "0.02", "--probes", "2", "--seconds", "0")
    result, picture = asked(script, "series", tmp_path, *flags)
    assert picture[:8] == PNG
    for loop in (True, False):
        for fields in ("height", "all"):
            assert result.find("series", n=16, loop=loop, fields=fields).clock == "cpu"
        assert result.find("direct sum", loop=loop).median > 0.0
        error = result.find("largest error / largest height", loop=loop)
        assert 0.0 <= error.median < 1e-9


def test_queries_answer(script, tmp_path):
    flags = ("--n", "16", "--points", "400", "--seconds", "0")
    result, picture = asked(script, "query", tmp_path, *flags)
    assert picture[:8] == PNG
    for where in ("random over 4 km", "a grid over 500 m"):
        for mode in ("bilinear", "bicubic"):
            at = {"where": where, "mode": mode, "fields": "heights"}
            ours = result.find("points a second", by="fftocean", **at)
            assert (ours.unit, ours.clock) == ("1/s", "cpu")
            assert ours.low <= ours.median <= ours.high
            assert result.find("points a second", by="SciPy", **at).median > 0.0
            assert result.find("SciPy / fftocean", **at).unit == "x"
    assert result.find("a call, a new time", mode="exact").at["points"] == 4
    held_goals(script, result, points=None, n=None)


def held_goals(script, result, **sizes):
    """Every goal of a result's question has its reading; sizes replace those of the goals."""
    found = [goal for goal in script("report").goals() if goal.question == result.question]
    assert found
    for goal in found:
        at = {key: sizes.get(key, value) for key, value in goal.at.items()}
        assert len(result.all(goal.reading, clock=goal.clock, **at)) == 1, goal


def test_times_of_points_become_rates(script):
    query = script("query")
    reading = Reading("points a second", "ms", 2.0, 1.0, 4.0, 5, "cpu", {"mode": "bicubic"})
    rate = query.in_points(reading, 1000)
    assert (rate.low, rate.median, rate.high) == (250e3, 500e3, 1e6)
    assert (rate.unit, rate.clock, rate.count, rate.at) == ("1/s", "cpu", 5, {"mode": "bicubic"})


def test_other_heights_of_points_are_not_timed(script, monkeypatch, capsys):
    """Of water a tenth of a second later, and of another kind of interpolation."""
    query = script("query")
    monkeypatch.setattr(query, "race", lambda *_, **__: pytest.fail("it was timed"))
    real = query.with_scipy

    def later(cascade, x, y, mode, residual=1e-3):
        with monkeypatch.context() as patch:
            patch.setattr(query, "MOMENT", query.MOMENT + 0.1)
            return real(cascade, x, y, mode, residual)

    monkeypatch.setattr(query, "with_scipy", later)
    flags = ["--n", "16", "--points", "400", "--seconds", "0"]
    assert query.main(flags) == 2
    assert "bilinear heights of fo.Query and of SciPy differ by" in capsys.readouterr().err
    monkeypatch.setattr(query, "with_scipy", real)
    monkeypatch.setattr(query, "ORDERS", {"bilinear": 3})
    assert query.main(flags) == 2


@pytest.mark.process
def test_bakes_of_peers_answer(script, tmp_path, capsys):
    """Without `bpy` in this Python that bake is skipped, which is said, unless it is installed."""
    flags = ("--n", "16", "--frames", "12", "--rounds", "2", "--blender", "/no/such/python")
    result, picture = asked(script, "bake_peers", tmp_path, *flags)
    assert picture[:8] == PNG
    assert result.find("frames a second", by="this version").count == 2
    assert {r.at["by"] for r in result.readings} == {"this version"}
    assert "Blender is skipped: /no/such/python has no bpy" in capsys.readouterr().err
    assert "/no/such/python" not in (tmp_path / "bake_peers.json").read_text()


def test_peers_are_compared_by_frames_of_one_size(script, tmp_path, monkeypatch):
    """
    Figures that we choose: Blender's side for n = 512 is 23 x 23 = 529, so its 10 frames a second
    count as 10.675; ratios are taken round by round.
    """
    peers = script("bake_peers")
    speeds = {"this version": iter([40.0, 60.0]), "Blender": iter([10.0, 20.0])}
    seen = []

    def bake(name, python, _, side, __):
        seen.append((name, side, list(python)))
        return {"wall": next(speeds[name]), "cpu": 30.0, "size": 2.0}

    monkeypatch.setattr(peers, "one_bake", bake)
    monkeypatch.setattr(peers, "has_bpy", lambda _: True)
    result, _ = asked(script, "bake_peers", tmp_path, "--rounds", "2", "--blender", "other")
    scale = (23 * 23 / 512) ** 2
    assert result.find("frames a second", by="Blender").median == pytest.approx(15.0 * scale)
    ratio = result.find("frames a second, this version / others", by="Blender")
    assert ratio.median == pytest.approx((4.0 + 3.0) / 2.0 / scale)
    cpu = result.find("processor time of a frame", by="Blender").median
    assert cpu == pytest.approx(30.0 / scale)
    assert seen == [("this version", 23, []), ("Blender", 23, ["other"])] * 2
    goals = [goal for goal in script("report").goals() if goal.question == "bake_peers"]
    for goal in goals:
        at = {**goal.at, "by": "Blender"}
        assert len(result.all(goal.reading, clock=goal.clock, **at)) == 1


def test_other_pixels_of_a_peer_are_refused(script, tmp_path):
    """Frames of another seed; and the same frames pass."""
    pytest.importorskip("OpenEXR")
    peers = script("bake_peers")
    job = fo.Job.default().replaced(
        {"ocean.n": 8, "bake.frames": 2, "bake.maps": ["displacement"], "bake.pictures": []}
    )
    for name, seed in (("ours", 7), ("same", 7), ("other", 8)):
        fo.bake(job.replaced({"ocean.seed": seed}), tmp_path / name, executor="serial")
    peers.compare(tmp_path / "ours", tmp_path / "same")
    with pytest.raises(fo.ParameterError, match=r"0000\.exr of displacement differs by"):
        peers.compare(tmp_path / "ours", tmp_path / "other")


@pytest.mark.process
def test_many_frames_answer(script, tmp_path):
    result, picture = asked(script, "many_frames", tmp_path, "--frames", "4", "12", "--n", "8")
    assert picture[:8] == PNG
    for frames in (4, 12):
        assert result.find("time of a frame", frames=frames).clock == "cpu"
        journal = result.find("size of the journal", frames=frames).median
        assert 0.0 < journal < result.find("size of the manifest", frames=frames).median
    held_goals(script, result, frames=12, n=8)


def test_growth_is_that_from_the_fewest_frames_to_the_most(script):
    many = script("many_frames")
    readings = [
        Reading.single(what, unit, value * factor, {"frames": frames, "n": 16})
        for what, unit in many.WHAT.values()
        for frames, value in ((1000, 2.0), (10, 1.0), (100, 7.0))
        for factor in ({"time of a frame": 3.0}.get(what, 1.0),)
    ]
    found = many.growth(readings)
    assert [(r.what, r.median, r.at["frames"]) for r in found] == [
        (f"{what}, of the most / the fewest", 2.0, 1000)
        for what in ("time of a frame", "time to check a frame", "time to resume, a frame")
    ]
    assert many.growth([r for r in readings if r.at["frames"] == 10]) == []
