"""Completion in shells: what the shell's function asks for and gets, as argcomplete defines it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

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


def function_of(shell):
    """Return the function of a shell, as `register-python-argcomplete fftocean` prints it."""
    import argcomplete

    return argcomplete.shellcode(["fftocean"], shell=shell)


def ask(shell, *arguments):
    """Return the words that a shell prints, with this environment's `fftocean` on its path."""
    beside = str(Path(sys.executable).parent)
    environment = {**os.environ, "PATH": beside + os.pathsep + os.environ["PATH"]}
    done = subprocess.run(
        [shell, *arguments],
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=True,
    )
    return done.stdout.split()


@pytest.mark.process
@pytest.mark.skipif(not shutil.which("bash"), reason="bash is not installed")
def test_bash_completes():
    line = """
    COMP_LINE='fftocean ver' COMP_POINT=12 COMP_TYPE=9 COMP_CWORD=1 COMP_WORDS=(fftocean ver)
    complete -p fftocean >/dev/null && _python_argcomplete fftocean ver fftocean
    echo "${COMPREPLY[@]}"
    """
    assert ask("bash", "--norc", "-c", function_of("bash") + line) == ["verify"]


@pytest.mark.process
@pytest.mark.skipif(not shutil.which("fish"), reason="fish is not installed")
def test_fish_completes(tmp_path):
    script = tmp_path / "fftocean.fish"
    script.write_text(function_of("fish") + "\ncomplete -C 'fftocean ver'\n", encoding="utf-8")
    assert ask("fish", "--no-config", str(script))[0] == "verify"


@pytest.mark.process
@pytest.mark.skipif(not shutil.which("zsh"), reason="zsh is not installed")
def test_zsh_takes_the_function(tmp_path):
    """Zsh completes on a terminal only; here it must load the function and bind it."""
    script = tmp_path / "fftocean.zsh"
    head = "autoload -Uz compinit\ncompinit -u -D\n"
    tail = '\nprint -r -- "$_comps[fftocean]"\n'
    script.write_text(head + function_of("zsh") + tail, encoding="utf-8")
    assert ask("zsh", "-f", str(script)) == ["_python_argcomplete"]
