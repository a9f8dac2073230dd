"""Completion in shells: what the shell's function asks for and gets, as argcomplete defines it."""

import os
import subprocess
import sys

import pytest


def complete(line):
    """Return the completions of a line, asked for as bash does."""
    read, write = os.pipe()
    environment = {
        **os.environ,
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_IFS": "\013",
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
        "COMP_TYPE": "9",
        "_ARGCOMPLETE_STDOUT_FILENAME": f"/dev/fd/{write}",
    }
    subprocess.run(
        [sys.executable, "-m", "fftocean"],
        env=environment,
        pass_fds=[write],
        timeout=600,
        check=False,
        capture_output=True,
    )
    os.close(write)
    with os.fdopen(read) as answers:
        return {word.strip() for word in answers.read().split("\013") if word.strip()}


@pytest.mark.process
@pytest.mark.skipif(sys.platform == "win32", reason="argcomplete serves POSIX shells")
def test_commands_flags_and_choices_are_completed():
    assert complete("fftocean ver") == {"verify"}
    assert {"--engine", "--executor"} <= complete("fftocean bake --e")
    assert complete("fftocean verify --dtype float3") == {"float32"}


@pytest.mark.process
@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_each_shell_has_its_function(shell):
    done = subprocess.run(
        [
            *(sys.executable, "-c"),
            "import argcomplete as a, sys; print(a.shellcode(['fftocean'], shell=sys.argv[1]))",
            shell,
        ],
        capture_output=True,
        text=True,
        timeout=600,
        check=True,
    )
    assert "fftocean" in done.stdout
