"""Requests that must get nothing: foreign hosts, origins, tokens, methods and paths."""

import importlib.metadata
import struct

import pytest
from serving import PAGE, answer
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from fftocean.view.page_files import PARTS

LATE = int(importlib.metadata.version("websockets").partition(".")[0]) >= 17
"""From this version on websockets leaves the refusal of methods to the server."""

pytestmark = pytest.mark.usefixtures("quiet_seas")


def hosts(running):
    """Return wrong lists of Host headers."""
    return [
        [],
        ["evil.example"],
        [f"evil.example:{running.port}"],
        ["127.0.0.1"],
        [f"127.0.0.1:{running.port + 1}"],
        [f"127.0.0.1:{running.port}.evil.example"],
        [f"127.0.0.1:{running.port}", f"127.0.0.1:{running.port}"],
        [f"127.0.0.1:{running.port}", "evil.example"],
        [f"127.0.0.1:{running.port}, evil.example"],
        [f"user@127.0.0.1:{running.port}"],
        [f"0.0.0.0:{running.port}"],
        [f"[::1]:{running.port}"],
        [f"localhost:{running.port}"],
        [""],
    ]


def test_the_page_is_served_to_its_own_host(shared):
    for path, name in (
        ("/", "index.html"),
        ("/page.js", "page.js"),
        ("/page.css", "page.css"),
        ("/core.js", "core.js"),
        *((f"/{name}", name) for name in PARTS),
        ("/worker.js", "worker.js"),
    ):
        status, _, body = shared.request(path)
        assert (status, body.decode()) == (200, PAGE[name])


def test_any_other_host_is_refused(shared):
    for host in hosts(shared):
        for path in ("/", "/parameters.json", "/socket"):
            status, _, body = shared.request(path, host=host)
            assert status == 403, host
            assert b"wind" not in body
        assert shared.handshake(host=host)[0] == 403, host


@pytest.mark.parametrize(
    "method", ["POST", "PUT", "HEAD", "DELETE", "OPTIONS", "PATCH", "get", "TRACE"]
)
def test_any_other_method_is_refused(shared, method):
    status, headers, body = shared.request("/", method=method)
    assert b"<html" not in body
    if LATE:
        assert (status, headers["allow"]) == (405, "GET")
        assert shared.handshake(method=method)[0] == 405
    else:
        assert status in (0, 400)
        assert shared.handshake(method=method)[0] in (0, 400)


def test_a_request_with_a_body_gets_nothing(shared):
    head = f"POST / HTTP/1.1\r\nHost: {shared.host}\r\nContent-Length: 5\r\n\r\nhello"
    assert b"<html" not in shared.raw(head.encode())


@pytest.mark.parametrize(
    "path",
    [
        "/index.html",
        "/../page.js",
        "/..%2fpage.js",
        "/%2e%2e/page.js",
        "/%2e/page.js",
        "//page.js",
        "/./page.js",
        "/page.js/",
        "/page.js?x=1",
        "/?token",
        "/page.js#x",
        "/page.js%00",
        "/PAGE.JS",
        "/page.js;x",
        "/static.js",
        "/widget.js",
        "/__init__.py",
        "/etc/passwd",
        "/../../../../etc/passwd",
        "/..\\..\\page.js",
        "http://evil.example/",
        "*",
        "/socket/",
        "/socket?x",
        "/favicon.ico/..",
        "/" + "a" * 4000,
    ],
)
def test_any_other_path_is_not_found(shared, path):
    status, headers, body = shared.request(path)
    assert (status, body) == (404, b"not found\n")
    assert headers["content-type"] == "text/plain"


def test_every_answer_has_the_headers_that_protect_it(shared):
    answers = [
        shared.request("/"),
        shared.request("/parameters.json"),
        shared.request("/favicon.ico"),
        shared.request("/none"),
        shared.request("/", host=["evil.example"]),
        *([shared.request("/", method="POST")] if LATE else []),
        shared.handshake(origins=["http://evil.example"]),
    ]
    for _, headers, _ in answers:
        policy = dict(
            part.strip().split(" ", 1) for part in headers["content-security-policy"].split(";")
        )
        assert policy["default-src"] == "'none'"
        assert policy["script-src"] == "'self'"
        assert policy["style-src"] == "'self'"
        assert policy["frame-ancestors"] == "'none'"
        assert policy["base-uri"] == policy["form-action"] == "'none'"
        assert policy["connect-src"] == f"'self' ws://{shared.host}"
        assert "unsafe" not in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
        assert headers["cross-origin-opener-policy"] == "same-origin"
        assert headers["cross-origin-resource-policy"] == "same-origin"
        assert headers["cache-control"] == "no-store"
        assert "access-control-allow-origin" not in headers
        assert "server" not in headers


def test_no_answer_has_the_token_but_that_of_the_socket(shared):
    token = shared.token.encode()
    assert len(token) == 32
    for path in ("/", "/page.js", "/parameters.json", "/none"):
        assert token not in shared.raw(
            f"GET {path} HTTP/1.1\r\nHost: {shared.host}\r\n\r\n".encode()
        )
    status, headers, _ = shared.handshake()
    assert (status, headers["sec-websocket-protocol"]) == (101, f"fftocean.{shared.token}")


def test_any_other_origin_is_refused(shared):
    own = f"http://{shared.host}"
    for origins in (
        [],
        ["null"],
        ["http://evil.example"],
        [f"https://{shared.host}"],
        [f"http://localhost:{shared.port}"],
        [own + "/"],
        [own + ".evil.example"],
        [own.upper()],
        [own, own],
        [own, "http://evil.example"],
        [f"{own}, http://evil.example"],
        ["http://127.0.0.1"],
        ["file://"],
    ):
        status, headers, _ = shared.handshake(origins=origins)
        assert status == 403, origins
        assert "sec-websocket-accept" not in headers


def test_any_other_token_is_refused(shared):
    right = f"fftocean.{shared.token}"
    for protocols in (
        [],
        [""],
        ["fftocean."],
        ["fftocean"],
        [shared.token],
        [right[:-1]],
        [right + "x"],
        [right.upper()],
        [right.replace("fftocean", "FFTOCEAN")],
        ["fftocean.\xe9"],
        ["other", right],
        [f"{right}, {right}"],
        [f"other, {right}"],
    ):
        assert shared.handshake(protocols=protocols)[0] == 403, protocols
    with pytest.raises(InvalidStatus):
        connect(
            f"ws://{shared.host}/socket", origin=f"http://{shared.host}", proxy=None
        ).__enter__()


@pytest.mark.parametrize(
    "data",
    [
        b"\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
        b"\x00" * 5000 + b"\n",
        b"GET /\xff HTTP/1.1\r\nHost: x\r\n\r\n",
        b"GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
        b"GET /" + b"a" * 20000 + b" HTTP/1.1\r\n\r\n",
        b"GET / HTTP/1.1\r\nX: " + b"a" * 20000 + b"\r\n\r\n",
        b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 2000 + b"\r\n",
    ],
    ids=lambda data: repr(data[:24]),
)
def test_what_is_no_request_gets_nothing(shared, data, capfd):
    """An error or a closed connection; no page, no traceback, and the server goes on."""
    status, _, body = answer(shared.raw(data + b"\r\n\r\n" if data.startswith(b"\x16") else data))
    assert status in (0, 400, 403, 414, 431)
    assert b"<html" not in body
    assert shared.request("/")[0] == 200
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    "frame",
    [
        b"\x81\x05hello",  # not masked
        b"\xc1\x85\x00\x00\x00\x00hello",  # a reserved bit
        b"\x83\x85\x00\x00\x00\x00hello",  # an unknown opcode
        b"\x81\xff" + struct.pack(">Q", 2**62) + b"\x00\x00\x00\x00",  # 4 EiB announced
        b"\x81\xfe\xff\xff\x00\x00\x00\x00" + b"\xff" * 65535,  # not UTF-8
        b"\x09\x80\x00\x00\x00\x00",  # a ping in parts
    ],
    ids=lambda frame: repr(frame[:6]),
)
def test_wrong_frames_close_the_socket_and_nothing_else(shared, frame, capfd):
    with shared.connect() as client:
        client.next("state")
        client.socket.socket.sendall(frame)
        client.closed()
    assert shared.request("/")[0] == 200
    assert capfd.readouterr() == ("", "")
