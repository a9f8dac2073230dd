"""Text on the terminal: names of files, tables on narrow terminals."""

from pathlib import Path

import pytest
from command_line import SMALL

from fftocean.cli.console import console_for, note, plain, shortened, size_in_words, value_in_words


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
def test_file_names_are_printed_without_markup_or_escapes(run, command, name):
    """Markup in a name is text, and control characters are printed as escapes."""
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text("[ocean]\nn = 8\n")
    code, out, _ = run(command, name)
    assert code == 0
    assert name.replace("\x1b", "\\x1b").replace("\udcff", "\\udcff") in out
    assert "\x1b" not in out


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
    monkeypatch.setattr(
        f"fftocean.cli.{command[0]}.console_for", lambda **_: Console(width=80, highlight=False)
    )
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


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (0, "0 MiB"),
        (2**20, "1 MiB"),
        (10 * 2**20, "10 MiB"),
        (999 * 2**20, "999 MiB"),
        (1000 * 2**20, "0.977 GiB"),
        (3 * 2**30, "3 GiB"),
    ],
)
def test_sizes_are_in_units_of_two_to_the_twenty(size, words):
    assert size_in_words(size) == words


def test_values_are_as_a_job_file_has_them():
    assert value_in_words([16, 12.5, [1.0, 2]]) == "16, 12.5, 1, 2"
    assert value_in_words(True) == "True"
    assert value_in_words(1e-7) == "1e-07"


def test_long_values_are_cut_to_the_length():
    assert shortened("x" * 110) == "x" * 110
    assert shortened("x" * 111) == "x" * 107 + "..."
    assert shortened("abcdefgh", 6) == "abc..."


def test_plain_text_is_one_line_without_control_characters():
    assert plain("a\nb\tc\x1b[31m\u202eé") == "a\\nb\\tc\\x1b[31m\\u202eé"
    assert plain(Path("a\rb")) == "a\\rb"


def test_a_note_goes_to_the_error_output(capsys):
    note("two\nlines")
    assert capsys.readouterr() == ("", "note: two\\nlines\n")


def test_a_table_without_a_terminal_is_as_wide_as_it_needs():
    assert console_for().width == 140
