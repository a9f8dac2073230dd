"""
State that all viewers of a server share, and what their messages do to it.

A message is carried out as a whole or refused as a whole; a refusal changes nothing and says why.
"""

import json
import re
import shutil
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, Protocol

from fftocean.errors import FFTOceanError, JobError
from fftocean.files import write_whole
from fftocean.job.job import Job
from fftocean.view import protocol
from fftocean.view.client import Client, Request
from fftocean.view.inbox import Incoming
from fftocean.view.protocol import (
    BakedFrame,
    Copy,
    DroppedFile,
    JobFile,
    Message,
    Refusal,
    SetValues,
    Verify,
)
from fftocean.view.seas import MadeSea, SeaMaker, reference_fields
from fftocean.view.state import State
from fftocean.view.worker import Worker

MOST_NAME: Final = 80  # characters of a file's name
SPOOLED: Final = 8  # dropped files that are kept; the state may still refer to the last


class Bake(Protocol):
    """A baked sea that is played."""

    def manifest(self) -> dict[str, Any]:
        """Return what the page must know to play it, ready for JSON."""

    def frame(self, tile: int, frame: int, /) -> bytes:
        """Return the binary message of one frame of a tile."""


class Viewer:
    """
    The sea of a server, or the bake that it plays, for all of its clients.

    Args:
        state: the sea at the start; None where a bake is played.
        bake: the bake that is played.
        source: the bake's name, as the page shows it.

    Raises:
        IntegrityError: a frame of the bake that is read at the start is damaged.
    """

    def __init__(
        self, state: State | None = None, *, bake: Bake | None = None, source: str = ""
    ) -> None:
        self.clients: set[Client] = set()
        self._state, self._bake = state, bake
        # made once: it reads frames, and a damaged one is told before anything is served
        self._bake_text = (
            json.dumps({"bake": bake.manifest(), "source": source}, allow_nan=False) if bake else ""
        )
        self._good = state  # the last of which a sea was made
        self._worker = Worker()
        self._maker = SeaMaker(self._worker, self._made, self._failed)
        self._sea: MadeSea | None = None
        self._spool: tempfile.TemporaryDirectory[str] | None = None
        self._spooled = 0

    @property
    def state(self) -> State | None:
        """The present state; None where a bake is played."""
        return self._state

    @property
    def sea(self) -> MadeSea | None:
        """The newest sea; None before the first."""
        return self._sea

    async def run(self) -> None:
        """Make seas until cancelled."""
        if self._state is not None:
            self._maker.want(self._state)
        await self._maker.run()

    def close(self, seconds: float = 0.0) -> bool:
        """Stop the worker; return True if it ended within some time [s]."""
        if self._spool is not None:
            self._spool.cleanup()
            self._spool = None
        return self._worker.stop(seconds)

    def welcome(self, client: Client) -> None:
        """Send a new client all that it needs."""
        self.clients.add(client)
        if self._bake is not None:
            client.offer("bake", self._bake_text)
            return
        client.offer("state", self._state_text())
        if self._sea is not None:
            client.offer("sea", self._sea.data)

    async def receive(self, client: Client, message: Incoming) -> bool:
        """Carry out a message of a client, or say why not; return False for a refusal."""
        try:
            if isinstance(message, Refusal):
                raise message
            await self._carry_out(client, message)
        except FFTOceanError as error:
            client.tell(protocol.refused(str(error), getattr(error, "name", None)))
            return False
        return True

    async def answer(self, request: Request) -> list[bytes | str]:
        """Return the messages that answer a request, or the refusal."""
        try:
            if isinstance(request, BakedFrame):
                bake = self._require_bake()
                return [await self._worker.run(lambda: bake.frame(request.tile, request.frame))]
            self._require_state("verify")
            sea = self._maker.exact(request.sea)
            if request.tick > sea.document["ticks"]:
                raise Refusal(
                    f"tick must be at most {sea.document['ticks']}, the ticks of the loop, "
                    f"got {request.tick}"
                )
            return list(await self._worker.run(lambda: reference_fields(sea, request.tick)))
        except FFTOceanError as error:
            return [protocol.refused(str(error))]
        except Exception as error:  # whatever it is, the server goes on
            return [protocol.refused(f"the request could not be answered: {error!r:.200}")]

    async def _carry_out(self, client: Client, message: Message) -> None:
        """Carry out one message."""
        match message:
            case SetValues(changes):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # told when the sea is made
                    self._become(self._require_state("set").changed(changes))
            case Verify() | BakedFrame():
                client.ask(message)
            case Copy(what):
                state = self._require_state("copy")
                text = state.toml() if what == "job" else state.command()
                client.tell(protocol.copied(what, text))
            case JobFile(text):
                await self._drop_job(text, "the job")
            case DroppedFile(name, data):
                await self._drop(name, data)

    async def _drop(self, name: str, data: bytes) -> None:
        """Take over a dropped file: a job by its ending, else a measured spectrum."""
        shown = shown_name(name)
        before = self._require_state("file")
        if name.lower().endswith(".toml"):
            try:
                text = data.decode("utf-8")
            except UnicodeDecodeError as error:
                raise Refusal(
                    f"{shown} must be UTF-8 text, and is not at byte {error.start}"
                ) from None
            await self._drop_job(text, shown)
            return
        file = self._spool_folder() / safe_name(name)
        write_whole(file, data)
        self._become(
            await self._read(lambda: State.of_spectrum(file, before, source=shown, dropped=True)),
        )

    async def _drop_job(self, text: str, shown: str) -> None:
        """Take over the text of a job file."""
        self._require_state("job")
        self._become(await self._read(lambda: State.of_job(_dropped_job(text, shown))))

    async def _read(self, read: Callable[[], State]) -> State:
        """Make a state in the worker thread."""

        def quietly() -> State:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # told when the sea is made
                state = read()
                state.sea()
            return state

        return await self._worker.run(quietly)

    def _become(self, state: State) -> None:
        """Take over another state, and tell every client."""
        self._state = state
        self._maker.want(state)
        self._offer_all("state", self._state_text())

    def _made(self, sea: MadeSea) -> None:
        """Send a new sea to every client."""
        self._sea, self._good = sea, sea.state
        self._offer_all("sea", sea.data)
        self._offer_all("state", self._state_text())

    def _failed(self, state: State, error: Exception) -> None:
        """Go back to the last sea that could be made, and say why."""
        if self._state is state and self._good is not None:
            self._state = self._good
        text = protocol.refused(
            str(error)
            if isinstance(error, FFTOceanError)
            else f"no sea could be made: {error!r:.200}"
        )
        for client in self.clients:
            client.tell(text)
        self._offer_all("state", self._state_text())

    def _spool_folder(self) -> Path:
        """Return a new private folder for one dropped file."""
        if self._spool is None:
            self._spool = tempfile.TemporaryDirectory(prefix="fftocean-")
        self._spooled += 1
        folder = Path(self._spool.name) / str(self._spooled)
        folder.mkdir(mode=0o700)
        old = Path(self._spool.name) / str(self._spooled - SPOOLED)
        if old.is_dir():
            shutil.rmtree(old, ignore_errors=True)
        return folder

    def _require_state(self, what: str) -> State:
        """Return the state, or raise where a bake is played."""
        if self._state is None:
            raise Refusal(_OF_A_BAKE[what])
        return self._state

    def _require_bake(self) -> Bake:
        """Return the bake, or raise where there is none."""
        if self._bake is None:
            raise Refusal("frame must be sent where a bake is played; here is a sea")
        return self._bake

    def _offer_all(self, kind: str, message: str | bytes) -> None:
        for client in self.clients:
            client.offer(kind, message)

    def _state_text(self) -> str:
        state = self._state
        assert state is not None
        current = self._sea is not None and self._sea.state is state
        return protocol.state_text(
            state.plain(),
            source=state.source,
            busy=self._maker.busy,
            notes=self._sea.notes if self._sea is not None and current else (),
            sea=self._sea.number if self._sea is not None and current else None,
            most_tiles=len(state.sizes),
        )


def shown_name(name: str) -> str:
    """Return the last part of a file's name as text that a page can show."""
    last = re.split(r"[/\\]", name)[-1]
    shown = "".join(c if c.isprintable() else "?" for c in last).strip()
    return shown[:MOST_NAME] or "the file"


def safe_name(name: str) -> str:
    """Return a name for the file on disk: letters, digits, dots, hyphens; no leading dot."""
    last = re.split(r"[/\\]", name)[-1]
    safe = re.sub(r"[^A-Za-z0-9._-]", "_", last)[-MOST_NAME:].lstrip(".-")
    return f"spectrum_{safe}" if safe.split(".")[0].lower() in _DEVICES or not safe else safe


_OF_A_BAKE: Final = {
    "set": "a bake is played as it was baked; its values cannot be changed",
    "verify": "a bake cannot be verified on the page; `fftocean check` checks its files",
    "copy": "a bake has no job to copy; its manifest holds the job",
    "file": "a file cannot be dropped on a bake; start `fftocean view` without one",
    "job": "a job cannot be dropped on a bake; start `fftocean view` without one",
}
"""Refusals of messages that are for a sea, where a bake is played."""

_DEVICES: Final = {
    "con",
    "prn",
    "aux",
    "nul",
    *(f"{d}{i}" for d in ("com", "lpt") for i in range(10)),
}
"""Names that are devices on some systems."""


def _dropped_job(text: str, shown: str) -> Job:
    """
    Return the job of a dropped file, which must not name files of this machine.

    Raises:
        JobError: the text is no job, or it names a measured file.
    """
    job = Job.from_toml(text, source=shown, at_sea=False)
    for i, table in enumerate(job.systems):
        if "measured" in table:
            raise JobError(
                f"{shown}: sea.systems[{i}].measured must not be in a job that is dropped: drop "
                "the spectrum itself, or start `fftocean view` with the job"
            )
    return job
