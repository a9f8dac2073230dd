"""
What is known of a bake while it runs: what earlier runs say, what the disk bears out, what the
journal and the listeners are told.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.folder.journal import Journal
from fftocean.baking.folder.plan import Entry
from fftocean.files import digest, read_whole

Progress = Callable[[int, int], None]
"""Called with (frames done, frames in all)."""

Listen = Callable[[dict[str, Any]], None]
"""
Called with what happens, as plain data: {"event": "start" | "survey" | "frame" | "done", ...}.
"""


class Ledger:
    """The books of one run."""

    def __init__(
        self,
        folder: Path,
        journal: Journal,
        known: Sequence[Entry],
        progress: Progress | None = None,
        listen: Listen | None = None,
    ) -> None:
        self.folder = folder
        self._journal, self._known = journal, known
        self._progress, self._listen = progress, listen

    def claimed(self, kind: str) -> list[Any]:
        """All that earlier runs say of one kind, in order."""
        return [entry[kind] for entry in self._known if kind in entry]

    def holds(self, path: str, sha256: str) -> bool:
        """Whether a file is there and is what it was."""
        data = read_whole(self.folder / path)
        return data is not None and digest(data) == sha256

    def add(self, entry: Entry) -> None:
        """Put down what is finished, and on the disk."""
        self._journal.add(entry)

    def progress(self, done: int, total: int) -> None:
        """Tell how far it is."""
        if self._progress:
            self._progress(done, total)

    def say(self, event: str, **what: Any) -> None:
        """Tell what happens."""
        if self._listen:
            self._listen({"event": event, **what})
