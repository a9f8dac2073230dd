"""
Server of the live page: files and a socket on this machine alone.

One asyncio process serves the page and its socket; seas are made in a worker thread. Every request
passes `Admission`; files are those of a closed list, held in memory.
"""

import asyncio
import contextlib
import logging
import signal
import time
from collections import OrderedDict
from collections.abc import AsyncIterator, Callable, Mapping
from http import HTTPStatus
from typing import TYPE_CHECKING, Final

from fftocean.errors import OutputError, ParameterError, how_to_install
from fftocean.limits import Count
from fftocean.view import parameters, protocol
from fftocean.view.client import Client
from fftocean.view.inbox import Inbox
from fftocean.view.numbered_seas import preset_rows
from fftocean.view.page_files import PageFile
from fftocean.view.security import (
    ADDRESS,
    SOCKET_PATH,
    Admission,
    Rejection,
    headers_for,
    new_token,
)
from fftocean.view.viewer import Viewer

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

MOST_CLIENTS: Final = 16
MOST_BAD: Final = 20  # refused messages of a client
MOST_UNFINISHED: Final = 64  # connections that have not sent their request yet
OPENING: Final = 10.0  # seconds that a request may take to come
CLOSING: Final = 0.5  # seconds that a client may take to say goodbye
STOPPING: Final = 1.0  # seconds until all connections are given up
TURN: Final = 0.005  # seconds for which the messages of one client are read at a stretch
WRITE_LIMIT: Final = 2**18  # bytes in a socket's buffer before the next message waits
PORT: Final = Count("", 0, 65535)


class PageServer:
    """
    Server of one viewer.

    Args:
        viewer: the sea or the bake that is shown.
        files: the files of the page by their paths.
        port: to listen on; 0 is any free one.

    Raises:
        ParameterError: the `websockets` package is missing, or an impossible port.
    """

    def __init__(self, viewer: Viewer, files: Mapping[str, PageFile], *, port: int = 0) -> None:
        require_websockets()
        self._viewer = viewer
        self._files = dict(files)
        self._port = PORT.check("port", port)
        self._admission = Admission(self._port, new_token())
        self._unfinished: OrderedDict[ServerConnection, None] = OrderedDict()
        self._connections: set[ServerConnection] = set()

    @property
    def address(self) -> str:
        """Address of the page, with its token; known once the server listens."""
        return self._admission.address

    @contextlib.asynccontextmanager
    async def listening(self) -> AsyncIterator["PageServer"]:
        """
        Listen, and stop at the end.

        Raises:
            OutputError: the port cannot be had.
        """
        from websockets.asyncio.server import serve

        rows = protocol.as_json(parameters.table(preset_rows()))
        self._files["/parameters.json"] = PageFile(rows, "application/json; charset=utf-8")
        try:
            server = await serve(
                self._converse,
                ADDRESS,
                self._port,
                process_request=self._respond,
                select_subprotocol=lambda _connection, _offered: self._admission.protocol,  # type: ignore[arg-type, return-value]
                create_connection=self._connection_class(),
                compression=None,
                max_size=protocol.MOST_TEXT,
                max_queue=4,
                open_timeout=OPENING,
                close_timeout=CLOSING,
                write_limit=WRITE_LIMIT,
                server_header=None,
                logger=quiet_logger(),
            )
        except OSError as error:
            raise OutputError(
                f"port {self._port} of {ADDRESS} cannot be had: {error.strerror or error}"
            ) from None
        self._admission = Admission(server.sockets[0].getsockname()[1], self._admission.token)
        making = asyncio.create_task(self._viewer.run())
        try:
            yield self
        finally:
            making.cancel()
            for connection in list(self._unfinished):
                connection.transport.abort()
            server.close()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(server.wait_closed(), STOPPING)
            for connection in list(self._connections):
                connection.transport.abort()
            with contextlib.suppress(asyncio.CancelledError):
                await making

    def _connection_class(self) -> "type[ServerConnection]":
        """Return the class of connections, which keeps account of requests that do not come."""
        from websockets.asyncio.server import ServerConnection

        unfinished, connections = self._unfinished, self._connections

        class Connection(ServerConnection):
            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                unfinished[self] = None
                connections.add(self)
                # the oldest is given up: a browser sends its request at once
                while len(unfinished) > MOST_UNFINISHED:
                    unfinished.popitem(last=False)[0].transport.abort()

            def connection_lost(self, exc: Exception | None) -> None:
                unfinished.pop(self, None)
                connections.discard(self)
                super().connection_lost(exc)

        return Connection

    def _respond(self, connection: "ServerConnection", request: "Request") -> "Response | None":
        """Return the answer to a request; None lets a socket open."""
        self._unfinished.pop(connection, None)
        headers = request.headers
        # before version 17 websockets itself refuses all methods but GET, and does not tell them
        method = getattr(request, "method", "GET")
        objection = self._admission.objection_to_request(method, headers.get_all("Host"))
        if objection is None and request.path == SOCKET_PATH:
            objection = self._admission.objection_to_socket(
                headers.get_all("Origin"), headers.get_all("Sec-WebSocket-Protocol")
            )
            if objection is None and len(self._viewer.clients) >= MOST_CLIENTS:
                objection = Rejection(
                    HTTPStatus.SERVICE_UNAVAILABLE, f"there are {MOST_CLIENTS} viewers already"
                )
            if objection is None:
                return None
        if objection is not None:
            return self._answer(
                objection.status, PageFile(f"{objection.reason}\n".encode(), "text/plain")
            )
        if request.path == "/favicon.ico":
            return self._answer(HTTPStatus.NO_CONTENT, PageFile(b"", "text/plain"))
        file = self._files.get(request.path)
        if file is None:
            return self._answer(HTTPStatus.NOT_FOUND, PageFile(b"not found\n", "text/plain"))
        return self._answer(HTTPStatus.OK, file)

    def _answer(self, status: HTTPStatus, file: PageFile) -> "Response":
        """Return an answer with the headers that every answer has."""
        from websockets.datastructures import Headers
        from websockets.http11 import Response

        headers = Headers(
            {
                "Content-Type": file.type,
                "Content-Length": str(len(file.data)),
                **headers_for(self._admission.origin),
            }
        )
        if status == HTTPStatus.METHOD_NOT_ALLOWED:
            headers["Allow"] = "GET"
        return Response(status.value, status.phrase, headers, file.data)

    async def _converse(self, connection: "ServerConnection") -> None:
        """Exchange messages with one client until it leaves."""
        from websockets.exceptions import ConnectionClosed

        if len(self._viewer.clients) >= MOST_CLIENTS:  # two may have been admitted at once
            await connection.close(1013, f"there are {MOST_CLIENTS} viewers already")
            return
        client = Client(connection, self._viewer.answer)
        self._viewer.welcome(client)
        inbox = Inbox()
        sending = asyncio.create_task(client.pump())
        carrying_out = asyncio.create_task(self._carry_out(connection, client, inbox))
        try:
            turn = time.monotonic()
            async for data in connection:
                await inbox.put(protocol.understood(data))
                if time.monotonic() - turn > TURN:
                    await asyncio.sleep(0)  # others take their turn however fast messages come
                    turn = time.monotonic()
            inbox.close()
            await carrying_out
        except ConnectionClosed:
            pass
        finally:
            self._viewer.clients.discard(client)
            for task in (sending, carrying_out):
                task.cancel()
            for task in (sending, carrying_out):
                with contextlib.suppress(asyncio.CancelledError, ConnectionClosed):
                    await task

    async def _carry_out(
        self, connection: "ServerConnection", client: Client, inbox: Inbox
    ) -> None:
        """Carry out the messages of one client; end its connection after too many bad ones."""
        bad = 0
        while (message := await inbox.get()) is not None:
            good = await self._viewer.receive(client, message)
            await asyncio.sleep(0)  # others take their turn, and newer values replace those here
            if not good:
                bad += 1
                if bad >= MOST_BAD:
                    await connection.close(1008, f"{bad} messages were refused")
                    return


def require_websockets() -> None:
    """
    Raise if the package of the socket is missing.

    Raises:
        ParameterError: it is; the message says how to install it.
    """
    try:
        import websockets.asyncio.server  # noqa: F401
    except ImportError:
        raise ParameterError(
            "the live page needs the package websockets 15 or later: pip install websockets, or "
            f"{how_to_install('view')}"
        ) from None


def quiet_logger() -> logging.Logger:
    """Return a logger that prints nothing: half-open connections are no news."""
    logger = logging.getLogger("fftocean.view.websockets")
    logger.propagate = False
    logger.setLevel(logging.CRITICAL + 1)
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())
    return logger


async def serve_until_stopped(server: PageServer, ready: Callable[[str], None]) -> int:
    """
    Serve until SIGINT or SIGTERM; return the number of the signal.

    Args:
        server: the server.
        ready: called with the address of the page once it listens.
    """
    loop, stopped = asyncio.get_running_loop(), asyncio.Event()
    received: list[signal.Signals] = []

    def stop(number: signal.Signals) -> None:
        received.append(number)
        stopped.set()

    handled: list[signal.Signals] = []
    async with server.listening():
        for number in (signal.SIGINT, signal.SIGTERM):
            try:
                loop.add_signal_handler(number, stop, number)
            except (NotImplementedError, RuntimeError, ValueError):  # no such handlers here
                continue
            handled.append(number)
        try:
            ready(server.address)
            await stopped.wait()
        finally:
            for number in handled:
                loop.remove_signal_handler(number)
    return received[0]
