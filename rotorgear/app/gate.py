"""Who may speak to the page: the browser that was given its address, and no other program, page or machine.

A page of the web can send requests to 127.0.0.1 from the browser of its visitor, and have a name of its own lead there. So a
request needs the name of this machine as its host, no foreign origin, and the cookie that the address with its token gave.
"""

from __future__ import annotations

import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Message, Receive, Send], Awaitable[None]]

HOST = "127.0.0.1"
_NAMES = (HOST, "localhost")
# Nothing of the page comes from elsewhere, nothing of it goes elsewhere, and no other page shows it inside itself. Vue makes
# functions of its templates, and NiceGUI starts by a script of the page.
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; object-src 'none'; base-uri 'self'; form-action 'none'; "
    "frame-ancestors 'none'"
)
_HEADERS = (
    (b"content-security-policy", _POLICY.encode()),
    (b"referrer-policy", b"no-referrer"),
    (b"x-content-type-options", b"nosniff"),
    (b"cross-origin-resource-policy", b"same-origin"),
)


class Gate:
    """Lets requests through to an application that come from the browser with the token, and refuses all others."""

    def __init__(self, inside: Application, port: int) -> None:
        self.inside = inside
        self.port = port
        self.token = secrets.token_urlsafe(24)
        self.secret = secrets.token_urlsafe(24)
        self.cookie = f"rotorgear_{port}"  # cookies know no ports: another page of another process has its own

    @property
    def address(self) -> str:
        """What is typed into a browser, token and all."""
        return f"http://{HOST}:{self.port}/?token={self.token}"

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Answer one request, or hand it on."""
        if scope["type"] not in ("http", "websocket"):
            await self.inside(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        reason = self.refusal(headers, socket=scope["type"] == "websocket")
        given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        if not reason and scope["type"] == "http" and scope["path"] == "/" and self._same(given, self.token):
            cookie = f"{self.cookie}={self.secret}; HttpOnly; SameSite=Strict; Path=/"
            await _answer(send, 303, "", ((b"location", b"/"), (b"set-cookie", cookie.encode())))
        elif reason or not self._same(self._shown(headers), self.secret):
            reason = reason or "this page opens by the address, token and all, that rotorgear printed on its terminal"
            if scope["type"] == "websocket":
                await receive()
                await send({"type": "websocket.close", "code": 1008})
            else:
                await _answer(send, 403, f"refused: {reason}\n")
        else:
            await self.inside(scope, receive, _with_headers(send))

    def refusal(self, headers: dict[str, str], *, socket: bool = False) -> str:
        """Why a request with these headers is refused whatever it carries; "" if it is not."""
        known = [f"{name}:{self.port}" for name in _NAMES]
        host = headers.get("host", "")
        if host not in known:
            return "it was asked for by the name of another machine"
        origin = headers.get("origin")
        # Browsers name the origin of every socket, and of every request from another page but for plain reading.
        if origin is None:
            foreign = socket or headers.get("sec-fetch-site", "none") not in ("none", "same-origin")
        else:
            foreign = origin != f"http://{host}"
        return "it was asked for by a page of another origin" if foreign else ""

    def _shown(self, headers: dict[str, str]) -> str:
        try:
            cookies = SimpleCookie(headers.get("cookie", ""))
        except CookieError:
            return ""
        return cookies[self.cookie].value if self.cookie in cookies else ""

    @staticmethod
    def _same(given: str, known: str) -> bool:
        return secrets.compare_digest(given.encode(), known.encode())


async def _answer(send: Send, status: int, text: str, more: tuple[tuple[bytes, bytes], ...] = ()) -> None:
    head = ((b"content-type", b"text/plain; charset=utf-8"), *_HEADERS, *more)
    await send({"type": "http.response.start", "status": status, "headers": list(head)})
    await send({"type": "http.response.body", "body": text.encode()})


def _with_headers(send: Send) -> Send:
    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *_HEADERS]}
        await send(message)

    return sending
