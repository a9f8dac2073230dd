"""Journal and progress events of one run of a bake."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.folder.journal import Entry, Journal
from fftocean.files import digest, read_whole

Progress = Callable[[int, int], None]
"""Called with (frames done, frames in all)."""

Listen = Callable[[dict[str, Any]], None]
"""Called with each event as plain data: {"event": "start" | "survey" | "frame" | "done", ...}."""


class RunLog:
    """Entries of earlier runs, the journal of this one, and its listeners."""

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

    def recorded(self, kind: str) -> list[Any]:
        """Return the values of all entries of one kind that earlier runs recorded, in order."""
        return [entry[kind] for entry in self._known if kind in entry]

    def is_unchanged(self, path: str, sha256: str) -> bool:
        """Return whether a file of the folder exists and has a checksum."""
        data = read_whole(self.folder / path)
        return data is not None and digest(data) == sha256

    def add(self, entry: Entry) -> None:
        """Record in the journal what is finished and on the disk."""
        self._journal.add(entry)

    def progress(self, done: int, total: int) -> None:
        """Report the number of frames done."""
        if self._progress:
            self._progress(done, total)

    def report(self, event: str, **details: Any) -> None:
        """Report an event to the listener."""
        if self._listen:
            self._listen({"event": event, **details})
