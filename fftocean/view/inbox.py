"""
Messages of one viewer that wait to be carried out, in order; newer values replace waiting ones.

A slider, or a client that floods the server, sends values faster than seas can be checked. Those
that nobody has looked at yet are dropped for newer values of the same parameters.
"""

import asyncio
from collections import deque
from typing import Final

from fftocean.view.protocol import Message, Refusal, SetValues

MOST_WAITING: Final = 32  # messages; more wait in the socket

Incoming = Message | Refusal
"""A message, or the reason why it is none."""


class Inbox:
    """Queue of the messages of one viewer."""

    def __init__(self) -> None:
        self._waiting: deque[Incoming] = deque()
        self._changed = asyncio.Event()
        self._taken = asyncio.Event()
        self._closed = False

    def __len__(self) -> int:
        """Return the number of messages that wait."""
        return len(self._waiting)

    async def put(self, message: Incoming) -> None:
        """Add a message; wait while too many others do."""
        if isinstance(message, SetValues) and self._waiting:
            last = self._waiting[-1]
            if isinstance(last, SetValues) and last.changes.keys() <= message.changes.keys():
                self._waiting[-1] = message
                return
        while len(self._waiting) >= MOST_WAITING:
            self._taken.clear()
            await self._taken.wait()
        self._waiting.append(message)
        self._changed.set()

    def close(self) -> None:
        """Let `get` return None once nothing waits."""
        self._closed = True
        self._changed.set()

    async def get(self) -> Incoming | None:
        """Return the oldest message; wait for one, or return None at the end."""
        while not self._waiting:
            if self._closed:
                return None
            self._changed.clear()
            await self._changed.wait()
        self._taken.set()
        return self._waiting.popleft()
