"""A running server of the live page, and requests to it over plain sockets."""

import asyncio
import contextlib
import json
import socket
import struct
import threading

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from fftocean.view.page_files import PARTS, served_files
from fftocean.view.server import PageServer
from fftocean.view.state import State
from fftocean.view.viewer import Viewer

PAGE = {
    "index.html": '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8" />\n'
    '<title>fftocean</title>\n<link rel="stylesheet" href="page.css" />\n'
    '<script type="module" src="page.js"></script>\n</head>\n'
    '<body><main id="fftocean"></main></body>\n'
    "</html>\n",
    "page.js": 'import{e0 as a}from"./core.js";a("page");\n',
    "core.js": "var b=(t)=>console.log(t);export{b as e0};\n",
    "static.js": 'import{e0 as a}from"./core.js";a("static </script> <!-- in it");\n',
    **{name: f'import{{e0 as a}}from"./core.js";a("{name}");\n' for name in PARTS},
    "worker.js": "postMessage(1);\n",
    "page.css": "body { margin: 0 }\n",
}
"""A page as small as can be, with the elements that the static page replaces."""


def write_page(folder):
    """Write the small page into a folder; return the folder."""
    for name, text in PAGE.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def small_state(**changes):
    """Return a sea that takes little time: one tile of 16 x 16, or as many as are asked for."""
    state = State.default(n=16, tiles=[(16, 200.0)])
    return state.changed(changes) if changes else state


class Running:
    """A server in a thread of its own."""

    def __init__(self, viewer, folder):
        self.viewer = viewer
        self._server = PageServer(viewer, served_files(folder))
        self._listening = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        asyncio.run(self._serve())

    async def _serve(self):
        self._loop, self._stopped = asyncio.get_running_loop(), asyncio.Event()
        async with self._server.listening():
            self._listening.set()
            await self._stopped.wait()

    def __enter__(self):
        self._thread.start()
        assert self._listening.wait(20.0)
        return self

    def __exit__(self, *_):
        self._loop.call_soon_threadsafe(self._stopped.set)
        self._thread.join(20.0)
        assert not self._thread.is_alive()
        self.viewer.close(20.0)

    @property
    def address(self):
        """Address of the page, with its token."""
        return self._server.address

    @property
    def host(self):
        """Host and port."""
        return self.address.split("/")[2]

    @property
    def port(self):
        """The port."""
        return int(self.host.split(":")[1])

    @property
    def token(self):
        """The token."""
        return self.address.split("#")[1]

    def raw(self, data, *, wait=10.0):
        """Send bytes; return all that comes until the server closes."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=wait) as plain:
            with contextlib.suppress(ConnectionError):
                plain.sendall(data)
            received = b""
            with contextlib.suppress(ConnectionError):
                while part := plain.recv(65536):
                    received += part
            return received

    def request(self, path="/", *, method="GET", host=None, lines=()):
        """Send a request; return (status, headers in lower case, body)."""
        hosts = [self.host] if host is None else host
        head = [f"{method} {path} HTTP/1.1", *(f"Host: {h}" for h in hosts), *lines]
        return answer(self.raw(("\r\n".join(head) + "\r\n\r\n").encode()))

    def handshake(self, *, origins=None, protocols=None, host=None, method="GET"):
        """Ask for the socket; return (status, headers, body)."""
        origins = [f"http://{self.host}"] if origins is None else origins
        protocols = [f"fftocean.{self.token}"] if protocols is None else protocols
        lines = [
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
            *(f"Origin: {o}" for o in origins),
            *(f"Sec-WebSocket-Protocol: {p}" for p in protocols),
        ]
        hosts = [self.host] if host is None else host
        head = [f"{method} /socket HTTP/1.1", *(f"Host: {h}" for h in hosts), *lines]
        with socket.create_connection(("127.0.0.1", self.port), timeout=10.0) as plain:
            plain.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
            received = b""
            while b"\r\n\r\n" not in received and (part := plain.recv(65536)):
                received += part
        return answer(received)

    def connect(self, **options):
        """Return a connected client."""
        return Talk(
            connect(
                f"ws://{self.host}/socket",
                origin=f"http://{self.host}",
                subprotocols=[f"fftocean.{self.token}"],
                compression=None,
                max_size=2**26,
                open_timeout=20.0,
                proxy=None,
                **options,
            )
        )


class Talk:
    """One client of the server: a real WebSocket, whose messages are sorted by kind."""

    def __init__(self, connecting):
        self._connecting = connecting
        self._state, self._sea = {}, ({}, b"")  # the last state, and the last sea not yet returned

    def __enter__(self):
        self.socket = self._connecting.__enter__()
        return self

    def __exit__(self, *error):
        self._connecting.__exit__(*error)

    def send(self, message):
        """Send a message as JSON, or text as it is."""
        self.socket.send(message if isinstance(message, (str, bytes)) else json.dumps(message))

    def next(self, kind, good=lambda _: True, wait=30.0):
        """
        Return the next message of a kind that is good: a text by its key, a binary one by its first
        four letters. Others are passed over.
        """
        while True:
            found = self._receive(wait)
            if isinstance(found, dict):
                if kind in found and good(found):
                    return found
            elif kind == found[0] and good(found[1:]):
                return found[1:]

    def _receive(self, wait):
        """Return the next message: a text's tree, or (letters, header, bytes) of a binary one."""
        message = self.socket.recv(timeout=wait)
        if isinstance(message, bytes):
            header, body = opened(message)
            if message[:4] == b"FFTO":
                self._sea = header, body
            return message[:4].decode(), header, body
        tree = json.loads(message)
        if "state" in tree:
            self._state = tree
        return tree

    def closed(self, wait=20.0):
        """Read until the server closes; return the exception that says so."""
        while True:
            try:
                self.socket.recv(timeout=wait)
            except ConnectionClosed as error:
                return error

    def exact(self, wait=30.0, **values):
        """
        Return the next exact sea whose state has certain values: (document, files).

        Its state may have come before, and been read by another method.
        """
        while True:
            (header, body), state = self._sea, self._state
            if (
                header.get("quality") == "exact"
                and not state.get("busy", True)
                and state["sea"] == header["id"]
                and all(state["state"][name] == value for name, value in values.items())
            ):
                self._sea = {}, b""
                return header, body
            self._receive(wait)


def opened(message):
    """Return (header, bytes after it) of a binary message."""
    version, length, zero = struct.unpack_from("<3I", message, 4)
    assert (version, zero, length % 16) == (1, 0, 0)
    return json.loads(message[16 : 16 + length]), message[16 + length :]


def answer(received):
    """Return (status, headers in lower case, body) of an answer; status 0 for none."""
    head, _, body = received.partition(b"\r\n\r\n")
    first, *lines = head.decode("latin-1").split("\r\n")
    headers = {}
    for line in lines:
        name, _, value = line.partition(":")
        assert name.lower() not in headers, name
        headers[name.lower()] = value.strip()
    return (int(first.split()[1]) if first else 0), headers, body


def sea_viewer(**changes):
    """Return a viewer of the small sea."""
    return Viewer(small_state(**changes))
