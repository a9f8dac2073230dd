"""
References of job files and of the command line, docs/job.md and docs/cli.md, from their tables.

`python tools/references.py` writes them; with `--check` it fails if one is stale.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from fftocean.cli.parser import COMMANDS, EXIT_CODES, build_parser
from fftocean.job.reference import key_rows, kind_rows

DOCS = Path(__file__).resolve().parents[1] / "docs"
GENERATED = "<!-- made by tools/references.py -->\n"
HOW_TO_NAME = """\
A job file is TOML. Every key has a default, so a file holds only what differs;
`fftocean info JOB.toml` shows all values, and `fftocean keys PATTERN` finds keys in the terminal.
Keys with a flag can be given on the command line, and every key by `--set KEY=VALUE`. An unknown
key is refused, with the nearest known one.

```toml
[sea.wind]
speed = 12.0    # [m/s]
fetch = 200e3   # [m]

[[sea.systems]] # a swell beside the wind sea
spectrum = { kind = "jonswap", hs = 1.5, tp = 14.0 }
spreading = { kind = "cosine-power", s = 25.0 }
direction = 160.0 # toward, degrees counter-clockwise from east

[ocean]
n = 512
size = 500.0    # [m]
loop = 60.0     # [s]

[bake]
frames = 900
maps = ["displacement", "normal", "foam"]
```
"""


def cell(text: str) -> str:
    """Return a text that is one cell of a table."""
    return text.replace("|", "\\|")


def job_page() -> str:
    """Return the reference of job files."""
    lines = [GENERATED, "# Keys of a job file\n", HOW_TO_NAME]
    table = ""
    for row in key_rows():
        head, _, _ = row.key.rpartition(".")
        if head != table:
            table = head
            heading = f"[{head}]" if "[]" not in head else f"[[{head.removesuffix('[]')}]]"
            lines += [f"\n## `{heading}`\n"]
            lines += ["| key | default | meaning | values | flag |", "|---|---|---|---|---|"]
        name = row.key.rpartition(".")[2]
        default = f"`{row.default}`" if row.default else ""
        flag = f"`{row.flag}`" if row.flag else ""
        cells = (f"`{name}`", default, row.help, row.values, flag)
        lines.append("| " + " | ".join(cell(text) for text in cells) + " |")
    role = ""
    for kind in kind_rows():
        if kind.role != role:
            role = kind.role
            lines += [f"\n## Kinds of {role}\n"]
            lines += ["| kind | keys | meaning |", "|---|---|---|"]
        ways = " or ".join(f"`{way}`" for way in kind.ways)
        keys = "; ".join(f"{name}: {values}" for name, values in kind.keys)
        meaning = f"{kind.summary} {keys}".strip()
        lines.append(f"| `{kind.name}` | {cell(ways)} | {cell(meaning)} |")
    lines.append("\nKeys in brackets can be left out.")
    return "\n".join(lines) + "\n"


def flags_of(parser: argparse.ArgumentParser) -> Iterator[tuple[str, str]]:
    """Yield each argument of a command as it is written, and its help."""
    for action in parser._actions:
        if isinstance(action, argparse._HelpAction):
            continue
        name = ", ".join(action.option_strings) or str(action.metavar or action.dest)
        if action.option_strings and action.nargs != 0:
            value = action.metavar or (
                "{" + ",".join(map(str, action.choices)) + "}"
                if action.choices
                else action.dest.upper()
            )
            name += f" {value}"
        text = (action.help or "").replace("%%", "%")
        yield name, text.replace("%(default)s", str(action.default))


def cli_page() -> str:
    """Return the reference of the command line."""
    lines = [
        GENERATED,
        "# Commands\n",
        "`fftocean COMMAND --help` prints the same in the terminal.",
    ]
    codes = EXIT_CODES.removeprefix("exit codes: ").split()
    lines += ["\nExit codes: " + " ".join(codes) + "."]
    (commands,) = (
        action.choices
        for action in build_parser()._actions
        if isinstance(action, argparse._SubParsersAction)
    )
    for command in COMMANDS:
        lines += [f"\n## `{command.name}`\n", f"{command.summary[0].upper()}{command.summary[1:]}."]
        lines += ["\n```bash", *command.examples, "```\n"]
        lines += [f"`{command.usage}`\n", "| argument | meaning |", "|---|---|"]
        lines += [f"| `{cell(n)}` | {cell(t)} |" for n, t in flags_of(commands[command.name])]
    return "\n".join(lines) + "\n"


PAGES = {"job.md": job_page, "cli.md": cli_page}


def main() -> None:
    """Write the pages, or check them."""
    for name, page in PAGES.items():
        file, new = DOCS / name, page()
        if "--check" in sys.argv and (not file.exists() or file.read_text(encoding="utf-8") != new):
            raise SystemExit(f"{name} is stale: run python tools/references.py")
        file.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    main()
