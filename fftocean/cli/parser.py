"""Argument parser of all commands."""

import argparse
import os
import re
import sys
from typing import Any, NoReturn

import fftocean
from fftocean.cli import (
    bake,
    bench,
    check,
    export,
    export_sea,
    info,
    keys,
    plot,
    presets,
    report,
    series,
    verify,
    view,
)
from fftocean.cli.console import plain
from fftocean.errors import suggestion

COMMANDS = (
    bake.COMMAND,
    export_sea.COMMAND,
    export.COMMAND,
    series.COMMAND,
    check.COMMAND,
    info.COMMAND,
    keys.COMMAND,
    verify.COMMAND,
    bench.COMMAND,
    plot.COMMAND,
    presets.COMMAND,
    report.COMMAND,
    view.COMMAND,
)

EXIT_CODES = (
    "exit codes: 0 ok, 2 usage or job, 3 bad input file, 4 output, 5 integrity,\n"
    "            6 folder in use, 130 interrupted\n"
)


class Parser(argparse.ArgumentParser):
    """A parser that reports errors with its own command's usage and the nearest known word."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> tuple[Any, list[str]]:
        """Parse, and report unknown arguments before the main parser does."""
        known, unknown = super().parse_known_args(args, namespace)
        if unknown:
            flag = next((word for word in unknown if word.startswith("-")), "").partition("=")[0]
            hint = suggestion(flag, self._option_string_actions) or _key_named(flag)
            self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
        return known, unknown

    def error(self, message: str) -> NoReturn:
        """Print a short usage and the error on stderr; exit with 2."""
        if choice := re.search(r"invalid choice: '(.*?)' \(choose from (.*)\)", message):
            words = re.findall(r"[\w.-]+", choice[2])
            message += suggestion(choice[1], words, 0.6)
        self.print_usage(sys.stderr)
        self.exit(2, f"{self.prog}: error: {plain(message)}; see {self.prog} --help\n")


def _key_named(flag: str) -> str:
    """Return the suggestion of --set for a key without a flag of its own, or nothing."""
    from fftocean.job.parameters import PARAMETERS

    word = flag.lstrip("-").replace("-", "_")
    keys = [p.key for p in PARAMETERS if word and word in p.key.split(".")]
    return f"; did you mean --set {keys[0]}=VALUE?" if keys else ""


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    layout = argparse.RawDescriptionHelpFormatter
    parser = Parser(
        prog="fftocean",
        usage="fftocean COMMAND [options]",
        description="Specify a sea state; get a seamlessly tiling, looping ocean surface;\n"
        "verify that it has the statistics you asked for; export it to any game engine.",
        epilog=f"example:\n  fftocean bake -o sea\n\n{EXIT_CODES}",
        formatter_class=layout,
    )
    parser.add_argument("--version", action="version", version=f"fftocean {fftocean.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for command in COMMANDS:
        examples = "\n".join(f"  {line}" for line in command.examples)
        one = commands.add_parser(
            command.name,
            prog=f"fftocean {command.name}",
            usage=command.usage,
            help=command.summary,
            description=command.summary,
            epilog=f"example:\n{examples}\n\n{EXIT_CODES}",
            formatter_class=layout,
        )
        one.set_defaults(run=command.run)
        command.add_flags(one)
    _complete(parser)
    return parser


def _complete(parser: argparse.ArgumentParser) -> None:
    """Answer a shell that asks for completions, and exit; do nothing otherwise."""
    if "_ARGCOMPLETE" in os.environ:
        import argcomplete

        argcomplete.autocomplete(parser)
