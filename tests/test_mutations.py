"""The table of deliberate errors: each can still be made. `tools/mutate.py` makes them."""

import os
import shutil
import subprocess
import sys

import imports
import mutate
import pytest


def test_every_error_can_be_made():
    """Its text is in its module once, the new one compiles, and its tests exist."""
    assert mutate.faults(mutate.read_table()) == []


def test_there_is_an_error_of_each_kind():
    table = mutate.read_table()
    assert {m.kind for m in table} == set(mutate.KINDS)
    assert all(m.why for m in table)
    assert sum(not m.equivalent for m in table) >= 150


def test_code_compiled_from_a_module_is_that_of_its_importers():
    """Machine code holds constants and functions of other modules; that of a top one, its own."""
    assert {"passes", "whole_passes", "query"} <= set(mutate.kernels_above("fftocean/arrays.py"))
    assert mutate.kernels_above("fftocean/kernels/whole_passes.py") == ("whole_passes",)
    assert mutate.kernels_above("fftocean/report.py") == ()
    assert all(mutate.kernels_above(m.module) is not None for m in mutate.read_table())


@pytest.fixture
def tree(tmp_path):
    """Return the root of a small tree with the tool, a module, an error in it, and two tests."""
    for name in ("tools/mutations", "fftocean", "tests"):
        (tmp_path / name).mkdir(parents=True)
    for module in (mutate, imports):
        shutil.copy(module.__file__, tmp_path / "tools")
    for name in mutate.COPIED_FILES:
        (tmp_path / name).touch()
    (tmp_path / "fftocean/__init__.py").touch()
    (tmp_path / "fftocean/area.py").write_text("def area(a, b):\n    return a * b\n")
    (tmp_path / "tools/mutations/all.toml").write_text(
        '[tests]\n"fftocean/area.py" = ["tests/test_area.py"]\n'
        '[[mutation]]\nmodule = "fftocean/area.py"\nkind = 2\n'
        'old = "a * b"\nnew = "a * a"\nwhy = "sides differ"\n'
    )
    return tmp_path


def a_test(root, name, condition):
    """Return the text of a test that also notes that it ran with the error in the module."""
    return (
        f"def test_{name}():\n    import pathlib\n    from fftocean import area\n"
        f"    if 'a * a' in pathlib.Path(area.__file__).read_text():\n"
        f"        with open({str(root / 'ran')!r}, 'a') as file:\n"
        f"            file.write('{name} ')\n"
        f"    assert {condition}\n"
    )


def ran(root, *tests):
    """Return the tests that ran with the error, the status of the tool, and its last result."""
    (root / "ran").write_text("")
    (root / "tests/test_area.py").write_text("\n".join(a_test(root, *test) for test in tests))
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_LIBRARIES],
        cwd=root,
        env=os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},  # slow to import, too
        capture_output=True,
        text=True,
    )
    assert not done.stderr
    last = mutate.read_results(root / "results.jsonl")[-1]
    return (root / "ran").read_text().split(), done.returncode, last.outcome


WITHOUT_LIBRARIES = """
import sys
sys.path.insert(0, "tools")
import mutate
mutate.PRELOADED = ("pytest",)  # the others are slow to import
sys.exit(mutate.main(["--results", "results.jsonl"]))
"""
SQUARE = ("square", "area.area(2, 2) == 4")
OBLONG = ("oblong", "area.area(2, 3) == 6")
OTHER = ("other", "area.area(3, 5) == 15")


@pytest.mark.process
def test_the_test_that_noticed_runs_first(tree):
    """Once tests have changed, the one that noticed an error last time is enough."""
    assert ran(tree, SQUARE, OBLONG) == (["square", "oblong"], 0, "killed")
    assert ran(tree, SQUARE, OBLONG) == ([], 0, "killed")  # known
    assert ran(tree, OTHER, SQUARE, OBLONG) == (["oblong"], 0, "killed")


@pytest.mark.process
@pytest.mark.parametrize(
    ("now", "expected"),
    [
        ((SQUARE, ("oblong", "True"), OTHER), (["oblong", "square", "oblong", "other"], 0)),
        ((SQUARE, OTHER), (["square", "other"], 0)),  # the test is gone
        ((SQUARE, ("oblong", "area.area(1, 1) == 1")), (["oblong", "square", "oblong"], 1)),
    ],
)
def test_a_test_that_no_longer_notices_proves_nothing(tree, now, expected):
    """All tests of the error run then."""
    ran(tree, SQUARE, OBLONG)
    outcome = "survived" if expected[1] else "killed"
    assert ran(tree, *now) == (*expected, outcome)


@pytest.mark.process
def test_a_test_that_fails_without_the_error_proves_nothing(tree):
    ran(tree, OBLONG)
    broken = ("oblong", "area.area(2, 3) == 7")
    assert ran(tree, broken, SQUARE) == ([], 1, "baseline")


def test_a_pattern_that_nothing_matches_is_an_error(capsys):
    with pytest.raises(SystemExit) as left:
        mutate.main(["--check", "--only", "kind:8", "--only", "no-such-module"])
    assert left.value.code == 2
    assert "no error's name or kind is 'no-such-module'" in capsys.readouterr().err
