"""
Admission of requests to the page's server.

A page of another origin must get nothing: neither by a foreign name that resolves to this machine
(Host), nor by a socket from its own scripts (Origin), nor without the token, which stands in the
fragment of the page's address and is never sent in a request line.
"""

import hmac
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Final

ADDRESS: Final = "127.0.0.1"
SOCKET_PATH: Final = "/socket"
PROTOCOL: Final = "fftocean."


def new_token() -> str:
    """Return a token of 192 random bits."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, slots=True)
class Rejection:
    """Refusal of a request: its status, and the reason in words."""

    status: HTTPStatus
    reason: str


@dataclass(frozen=True, slots=True)
class Admission:
    """Rules of one server: its port and its token."""

    port: int
    token: str

    @property
    def host(self) -> str:
        """The only permitted Host."""
        return f"{ADDRESS}:{self.port}"

    @property
    def origin(self) -> str:
        """The only permitted Origin of a socket."""
        return f"http://{self.host}"

    @property
    def address(self) -> str:
        """Address of the page, with the token in its fragment."""
        return f"{self.origin}/#{self.token}"

    @property
    def protocol(self) -> str:
        """The only permitted subprotocol of a socket."""
        return PROTOCOL + self.token

    def objection_to_request(self, method: str, hosts: Sequence[str]) -> Rejection | None:
        """
        Return the objection to any request, or None.

        Args:
            method: of the request line.
            hosts: every Host header.
        """
        if len(hosts) != 1 or not _equal(hosts[0], self.host):
            return Rejection(HTTPStatus.FORBIDDEN, f"the Host must be {self.host}")
        if method != "GET":
            return Rejection(HTTPStatus.METHOD_NOT_ALLOWED, "the method must be GET")
        return None

    def objection_to_socket(
        self, origins: Sequence[str], protocols: Sequence[str]
    ) -> Rejection | None:
        """
        Return the objection to a socket, or None.

        Args:
            origins: every Origin header.
            protocols: every Sec-WebSocket-Protocol header.
        """
        if len(origins) != 1 or not _equal(origins[0], self.origin):
            return Rejection(HTTPStatus.FORBIDDEN, f"the Origin must be {self.origin}")
        offered = [word.strip() for header in protocols for word in header.split(",")]
        # every one is compared, so that the time does not tell which was right
        if sum(_equal(word, self.protocol) for word in offered) != 1 or len(offered) != 1:
            return Rejection(HTTPStatus.FORBIDDEN, "the token is missing or wrong")
        return None


def _equal(one: str, other: str) -> bool:
    """Compare two texts in a time that does not depend on where they differ."""
    return hmac.compare_digest(one.encode(errors="replace"), other.encode())


def policy(origin: str) -> str:
    """Return the content security policy of the served page, which has its socket at `origin`."""
    socket = origin.replace("http://", "ws://", 1)
    return "; ".join(
        (
            "default-src 'none'",
            "script-src 'self'",
            "style-src 'self'",
            "img-src 'self' data: blob:",
            f"connect-src 'self' {socket}",
            "worker-src 'self'",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        )
    )


def headers_for(origin: str) -> dict[str, str]:
    """Return the headers of every answer."""
    return {
        "Content-Security-Policy": policy(origin),
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cache-Control": "no-store",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
        "Connection": "close",
    }
