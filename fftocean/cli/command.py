"""Description of one command: its name, its help texts, its flags, its function."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Command:
    """A command of `fftocean`, as the parser presents and runs it."""

    name: str
    arguments: str  # the usage after the name, without flags
    summary: str  # one line of help
    examples: tuple[str, ...]  # whole command lines
    run: Callable[[argparse.Namespace], int]  # returns the exit code
    add_flags: Callable[[argparse.ArgumentParser], None] = lambda _: None

    @property
    def usage(self) -> str:
        """The usage line, without the word "usage"."""
        return " ".join(f"fftocean {self.name} {self.arguments} [options]".split())
