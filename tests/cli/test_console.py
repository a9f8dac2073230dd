"""Text on the terminal: names of files, tables on narrow terminals."""

from pathlib import Path

import pytest
from command_line import SMALL


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
