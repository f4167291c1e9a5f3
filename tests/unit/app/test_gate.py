"""Who may speak to the page: each refusal by a request as its sender would make it, beside one that is let through."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from rotorgear.app.gate import Gate

PORT = 8123
OWN = f"127.0.0.1:{PORT}"


class Inside:
    """An application that notes what gets through."""

    def __init__(self) -> None:
        self.seen: list[str] = []

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        self.seen.append(scope["path"])
        if scope["type"] == "http":
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": b"inside"})
        else:
            await send({"type": "websocket.accept"})


def asked(gate: Gate, path: str = "/", kind: str = "http", query: str = "", **headers: str) -> list[dict[str, Any]]:
    """What a gate answers to a request."""
    sent: list[dict[str, Any]] = []

    async def send(message: Any) -> None:
        sent.append(message)

    async def receive() -> dict[str, Any]:
        return {"type": "websocket.connect"}

    given = {"host": OWN, **{key.replace("_", "-"): value for key, value in headers.items()}}
    scope = {
        "type": kind,
        "path": path,
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in given.items()],
    }
    asyncio.run(gate(scope, receive, send))
    return sent


@pytest.fixture
def gate() -> Gate:
    return Gate(Inside(), PORT)


def cookie(gate: Gate) -> str:
    return f"other=1; {gate.cookie}={gate.secret}"


def test_the_address_gives_a_cookie_that_scripts_and_other_pages_do_not_get(gate: Gate) -> None:
    assert gate.address == f"http://{OWN}/?token={gate.token}"
    head, _ = asked(gate, query=f"token={gate.token}")
    told = dict(head["headers"])
    assert head["status"] == 303
    assert told[b"location"] == b"/"  # the token leaves the address
    given = told[b"set-cookie"].decode()
    assert given.startswith(f"{gate.cookie}={gate.secret};")
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= {part.strip() for part in given.split(";")}
    assert gate.inside.seen == []  # type: ignore[attr-defined]


def test_who_has_the_cookie_gets_in_and_is_told_to_load_nothing_from_elsewhere(gate: Gate) -> None:
    head, body = asked(gate, cookie=cookie(gate), origin=f"http://{OWN}")
    assert (head["status"], body["body"]) == (200, b"inside")
    told = dict(head["headers"])
    assert b"default-src 'self'" in told[b"content-security-policy"]
    assert told[b"referrer-policy"] == b"no-referrer"
    assert asked(gate, kind="websocket", cookie=cookie(gate), origin=f"http://{OWN}") == [{"type": "websocket.accept"}]
    named = f"localhost:{PORT}"
    assert asked(gate, cookie=cookie(gate), host=named, origin=f"http://{named}")[0]["status"] == 200


@pytest.mark.parametrize(
    "request_of",
    [
        pytest.param(lambda gate: {}, id="no token"),
        pytest.param(lambda gate: {"query": "token=guessed"}, id="wrong token"),
        pytest.param(lambda gate: {"query": "token=%C3%A9"}, id="a token of other letters"),
        pytest.param(lambda gate: {"cookie": f"{gate.cookie}={gate.token}"}, id="the token as a cookie"),
        pytest.param(lambda gate: {"path": "/x", "query": f"token={gate.token}"}, id="a token elsewhere"),
        pytest.param(lambda gate: {"cookie": cookie(gate), "host": f"evil.example:{PORT}"}, id="foreign host"),
        pytest.param(lambda gate: {"query": f"token={gate.token}", "host": "evil.example"}, id="token, foreign host"),
        pytest.param(lambda gate: {"cookie": cookie(gate), "host": "127.0.0.1:80"}, id="another port"),
        pytest.param(lambda gate: {"cookie": cookie(gate), "origin": "http://evil.example"}, id="foreign origin"),
        pytest.param(lambda gate: {"cookie": cookie(gate), "origin": "null"}, id="an origin that hides"),
        pytest.param(lambda gate: {"cookie": cookie(gate), "origin": "http://127.0.0.1:80"}, id="a page beside"),
        pytest.param(
            lambda gate: {"cookie": cookie(gate), "sec_fetch_site": "cross-site"}, id="a link of another site"
        ),
    ],
)
def test_a_request_is_refused(gate: Gate, request_of: Any) -> None:
    head, body = asked(gate, **request_of(gate))
    assert head["status"] == 403
    assert body["body"].startswith(b"refused: ")
    assert gate.token.encode() not in body["body"]
    assert gate.inside.seen == []  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    "request_of",
    [
        pytest.param(lambda gate: {"origin": f"http://{OWN}"}, id="without cookie"),
        pytest.param(lambda gate: {"origin": f"http://{OWN}", "query": f"token={gate.token}"}, id="with a token only"),
        pytest.param(lambda gate: {"cookie": cookie(gate), "origin": "http://evil.example"}, id="foreign origin"),
        pytest.param(lambda gate: {"cookie": cookie(gate)}, id="no origin, as programs send it"),
        pytest.param(
            lambda gate: {"cookie": cookie(gate), "host": "evil.example", "origin": "http://evil.example"}, id="host"
        ),
    ],
)
def test_a_socket_is_refused(gate: Gate, request_of: Any) -> None:
    assert asked(gate, kind="websocket", **request_of(gate)) == [{"type": "websocket.close", "code": 1008}]
    assert gate.inside.seen == []  # type: ignore[attr-defined]


def test_a_cookie_that_is_none_is_a_refusal_and_no_fault(gate: Gate) -> None:
    for text in ("", ";;;", "=", f"{gate.cookie}", f"{gate.cookie}=\xff"):
        assert asked(gate, cookie=text)[0]["status"] == 403
