"""Who may talk to the server: this machine by default, others with a token, and no page of another origin.

Browsers let any web page open a socket to a server on this machine, so the origin of each request must be the server's own,
and the host that it was called by must be one of ours, or a foreign name could be made to point here (DNS rebinding).
"""

import hmac
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
COOKIE = "mjdrive-token"
POLICY_VIOLATION = 1008

CONTENT_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; font-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors "
)
HEADERS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}


@dataclass(frozen=True, slots=True)
class Access:
    """Who may talk to the server.

    Attributes:
        hosts: Names that the server may be called by.
        origins: Other origins whose pages may talk to it, as "https://tunnel.example".
        token: What others must know; empty if nobody needs one.
        frames: Origins of pages that may show ours in a frame, such as a notebook's.
    """

    hosts: frozenset[str] = LOOPBACK
    origins: frozenset[str] = frozenset()
    token: str = ""
    frames: frozenset[str] = frozenset()

    @property
    def headers(self) -> dict[str, str]:
        """What every answer carries."""
        frames = " ".join(sorted(self.frames)) or "'none'"
        return {"content-security-policy": CONTENT_POLICY + frames, **HEADERS}

    def refusal(self, headers: Mapping[str, str], query: str) -> str:
        """Why a request is refused; empty if it is not.

        Args:
            headers: Of the request, names in lower case.
            query: Of its address.
        """
        host = headers.get("host", "")
        name = host.rsplit(":", 1)[0] if not host.endswith("]") else host
        tunnels = {origin.split("://", 1)[-1] for origin in self.origins}
        if name.strip("[]").lower() not in self.hosts and host not in tunnels:
            return "This server is not called by that host name; see --allow-origin."
        origin = headers.get("origin")
        own = {f"http://{host}", f"https://{host}", *self.origins}
        if origin is not None and origin not in own:
            return "Pages of another origin may not talk to this server; see --allow-origin."
        if self.token and not self._knows(headers, query):
            return "The token is missing or wrong; open the address that `mjdrive serve` printed."
        return ""

    def _knows(self, headers: Mapping[str, str], query: str) -> bool:
        told = parse_qs(query).get("token", [""])[0] or _cookie(headers)
        return hmac.compare_digest(told.encode(), self.token.encode())


def _cookie(headers: Mapping[str, str]) -> str:
    try:
        morsel = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return morsel.value if morsel else ""


class Guard:
    """Stands before an application: refuses who may not talk to it, and puts safe headers on every answer.

    Args:
        app: The application.
        access: Who may talk to it.
    """

    def __init__(self, app: ASGIApp, access: Access) -> None:
        self._app, self._access = app, access

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request or socket."""
        if scope["type"] not in ("http", "websocket"):
            return await self._app(scope, receive, send)
        headers = {
            key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]
        }
        query = scope["query_string"].decode("latin-1")
        safe = self._access.headers
        refusal = self._access.refusal(headers, query)
        if refusal and scope["type"] == "websocket":
            return await send({"type": "websocket.close", "code": POLICY_VIOLATION})
        if refusal:
            return await PlainTextResponse(refusal, 403, safe)(scope, receive, send)
        cookies = [self._new_cookie()] if self._access.token and "token=" in query else []

        async def send_safely(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message["headers"], *_encoded(safe.items()), *cookies]
            await send(message)

        return await self._app(scope, receive, send_safely)

    def _new_cookie(self) -> tuple[bytes, bytes]:
        value = f"{COOKIE}={self._access.token}; Path=/; HttpOnly; SameSite=Strict"
        return b"set-cookie", value.encode()


def _encoded(headers: Collection[tuple[str, str]]) -> list[tuple[bytes, bytes]]:
    return [(name.encode(), value.encode()) for name, value in headers]
