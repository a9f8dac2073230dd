"""Exit codes, signals, warnings and standard output of the whole command line."""

import contextlib
import io
import os
import re
import signal
import subprocess
import sys
import threading
import warnings
from pathlib import Path

import pytest
from builders import environment
from command_line import SMALL

from fftocean.cli import entry_point, main
from fftocean.errors import FFTOceanError


def test_without_arguments_the_first_steps_are_printed(run):
    code, out, err = run()
    assert (code, out) == (2, "")
    for line in ("fftocean bake -o sea", "fftocean info", "fftocean --help"):
        assert line in err


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
def test_each_way_to_stop_has_its_exit_code(run, error, code, said, monkeypatch):
    def fail(_):
        raise error

    monkeypatch.setattr(entry_point, "_discard_stdout", lambda: None)
    monkeypatch.setattr("fftocean.cli.info.job_of", fail)
    assert run("info") == (code, "", said)


def test_every_error_class_has_an_exit_code():
    kinds = [FFTOceanError]
    for kind in kinds:
        kinds += kind.__subclasses__()
    assert {kind.exit_code for kind in kinds} <= {2, 3, 4, 5, 6}


@pytest.mark.process
def test_a_full_disk_under_stdout_exits_4():
    """One line, no traceback, nothing ignored at exit. (A broken pipe: rich exits 1, silently.)"""
    command = [sys.executable, "-m", "fftocean", "info", "--n", "4"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command, env=environment(), stdout=full, stderr=subprocess.PIPE, text=True, timeout=600
        )
    assert done.returncode == 4
    assert done.stderr.endswith("fftocean: output: No space left on device\n")
    assert all(line.startswith(("note: ", "fftocean: ")) for line in done.stderr.splitlines())


@pytest.mark.usefixtures("fast_bakes")
def test_a_bake_runs_without_stdout(monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdout", None)
    assert main(["bake", "-o", "out", *SMALL]) == 0
    assert main(["info", "--n", "4"]) == 0
    assert Path("out/manifest.json").exists()
    assert "fftocean:" not in capsys.readouterr().err


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize(("at", "there"), [(1, 0), (2, 1), (5, None)])
def test_a_signal_leaves_no_manifest(run, number, code, at, there, monkeypatch):
    """
    A signal in the middle of the at-th write removes the temporary file and leaves no final one.

    The writes are the journal, the job, and for each frame its map and its line in the journal;
    maps are written by threads, so that from there on the sequence, and the number of frames that
    are finished, is chance.
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
    files = [p for p in Path("out").rglob("*") if p.is_file()]
    assert not [p for p in files if p.suffix == ".tmp"]
    if there is None:
        finished = re.search(r"(\d) of 4 frames are finished; run the same command again", err)
        assert finished
        maps = [p for p in files if p.suffix == ".exr"]
        assert int(finished[1]) <= len(maps) < 4
    else:
        assert "frames are finished" not in err or "0 of 4" in err
        assert len(calls) == at
        assert len(files) == there
    assert not Path("out/manifest.json").exists()


@pytest.mark.usefixtures("fast_bakes")
@pytest.mark.parametrize("arguments", [("bake", *SMALL), ("bake", "--n", "0"), ("--version",), ()])
def test_signal_handlers_and_warning_filters_are_restored(run, arguments):
    """After any command, SIGTERM and the warnings are the caller's again."""

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


@pytest.mark.usefixtures("fast_bakes")
def test_a_command_runs_in_a_thread():
    """Python lets only the main thread set signal handlers."""
    codes, said = [], io.StringIO()
    before = signal.getsignal(signal.SIGTERM)

    def work():
        with contextlib.redirect_stdout(said):
            codes.append(main(["bake", "-o", "out", *SMALL]))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert codes == [0]
    assert "preview:" in said.getvalue()
    assert signal.getsignal(signal.SIGTERM) is before


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
@pytest.mark.parametrize("command", [["info"], ["verify"], ["bake", "-o", "κύμα", *SMALL]])
def test_names_that_the_console_cannot_show_are_escaped(tmp_path, monkeypatch, encoding, command):
    """As on a Windows console, whose encoding has 256 characters."""
    monkeypatch.chdir(tmp_path)
    Path("θάλασσα.toml").write_text("[ocean]\nn = 8\n", encoding="utf-8")
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding, errors="strict")
    monkeypatch.setattr(sys, "stdout", stream)
    assert main([command[0], "θάλασσα.toml", *command[1:]]) == 0
    stream.flush()
    written = stream.buffer.getvalue().decode(encoding)
    name = "κύμα" if command[0] == "bake" else "θάλασσα.toml"
    assert name.encode("ascii", "backslashreplace").decode() in written
    assert stream.errors == "strict"  # as it was
