"""Fixtures of the tests of the command line."""

from pathlib import Path

import pytest
from command_line import no_pictures, some_statistics

from fftocean.cli import main


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """
    Run each test in its own empty folder, without the terminal settings of this environment.
    """
    monkeypatch.chdir(tmp_path)
    for name in ("FORCE_COLOR", "NO_COLOR", "COLUMNS", "TTY_COMPATIBLE", "TTY_INTERACTIVE"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.fixture
def fast_bakes(monkeypatch):
    """
    Leave out previews and integrals over the sea, which take most of the time of a small bake;
    tests/baking has them.
    """
    monkeypatch.setattr(
        "fftocean.baking.bake.measure",
        lambda ocean: some_statistics(0.0 if ocean.amplitudes.variance == 0.0 else 0.1),
    )
    no_pictures(monkeypatch)


@pytest.fixture
def run(capsys):
    """Run a command; return its exit code, its output and its error output."""

    def run(*arguments):
        try:
            code = main([str(a) for a in arguments])
        except SystemExit as left:
            code = left.code
        out, err = capsys.readouterr()
        assert "Traceback" not in err
        return code, out, err

    return run


@pytest.fixture
def baked(run, fast_bakes):  # noqa: ARG001 - for what it does
    assert run("bake", "-o", "out", "--n", "8", "--frames", "3", "--maps", "height")[0] == 0
    return Path("out")
