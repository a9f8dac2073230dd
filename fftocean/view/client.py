"""
One viewer: what waits to be sent to it, at most one message of each kind.

A viewer that does not read holds one message in its socket and the newest of each kind here,
however many changes others make.
"""

import asyncio
from collections import OrderedDict, deque
from collections.abc import Awaitable, Callable
from typing import Final, Protocol

from fftocean.view.protocol import BakedFrame, Verify

MOST_ANSWERS: Final = 32  # texts that answer messages of this viewer
MOST_FRAMES: Final = 64  # frames of a bake that were asked for

Request = Verify | BakedFrame
Answer = Callable[[Request], Awaitable[list[bytes | str]]]
"""Computation of the messages that answer a request."""


class Socket(Protocol):
    """Connection to a viewer."""

    async def send(self, message: str | bytes, /) -> None:
        """Send a message; wait until the socket can take it."""


class Client:
    """
    Outgoing messages of one viewer.

    Args:
        socket: its connection.
        answer: computes what a request asks for, when the socket is free.
    """

    def __init__(
        self,
        socket: Socket,
        answer: Answer,
    ) -> None:
        self.socket, self._answer = socket, answer
        self._texts: deque[str] = deque(maxlen=MOST_ANSWERS)
        self._newest: OrderedDict[str, str | bytes] = OrderedDict()
        self._verify: Verify | None = None
        self._frames: OrderedDict[BakedFrame, None] = OrderedDict()
        self._wake = asyncio.Event()

    @property
    def waiting(self) -> int:
        """Length of all messages that wait here for the socket."""
        return sum(map(len, (*self._texts, *self._newest.values())))

    @property
    def requests(self) -> int:
        """Number of requests that wait here for the socket."""
        return len(self._frames) + (self._verify is not None)

    def tell(self, text: str) -> None:
        """Answer a message with text."""
        self._texts.append(text)
        self._wake.set()

    def offer(self, kind: str, message: str | bytes) -> None:
        """Send a message, instead of one of its kind that still waits."""
        self._newest[kind] = message
        self._wake.set()

    def ask(self, request: Request) -> None:
        """Answer a request when the socket is free; of several verifications, the newest."""
        if isinstance(request, Verify):
            self._verify = request
        else:
            self._frames[request] = None
            while len(self._frames) > MOST_FRAMES:
                self._frames.popitem(last=False)
        self._wake.set()

    async def pump(self) -> None:
        """Send what waits, until cancelled."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while True:
                if self._texts:
                    await self.socket.send(self._texts.popleft())
                elif self._newest:
                    await self.socket.send(self._newest.popitem(last=False)[1])
                elif (request := self._request()) is not None:
                    for message in await self._answer(request):
                        await self.socket.send(message)
                else:
                    break

    def _request(self) -> Request | None:
        """Return the next request, the newest verification first."""
        if self._verify is not None:
            request, self._verify = self._verify, None
            return request
        return self._frames.popitem(last=False)[0] if self._frames else None
