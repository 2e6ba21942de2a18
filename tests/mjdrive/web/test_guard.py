"""Pages of other origins, rebound names and strangers without the token are refused."""

import pytest
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.testclient import TestClient
from starlette.websockets import WebSocket, WebSocketDisconnect

from mjdrive.web.guard import COOKIE, LOOPBACK, Access, Guard

HOME = "http://127.0.0.1:8123"


def client(access: Access | None = None) -> TestClient:
    async def page(request: object) -> PlainTextResponse:
        del request
        return PlainTextResponse("in")

    async def socket(websocket: WebSocket) -> None:
        await websocket.accept()
        await websocket.send_text("in")

    app = Starlette(routes=[Route("/", page), WebSocketRoute("/ws", socket)])
    return TestClient(Guard(app, access or Access()), base_url=HOME)


def socket_opens(page: TestClient, **headers: str) -> bool:
    try:
        with page.websocket_connect("/ws", headers=headers) as socket:
            return socket.receive_text() == "in"
    except WebSocketDisconnect:
        return False


@pytest.mark.parametrize("host", ["127.0.0.1:8123", "localhost:8123", "[::1]:8123", "LOCALHOST"])
def test_this_machine_is_let_in(host: str) -> None:
    assert client().get("/", headers={"host": host}).status_code == 200
    assert socket_opens(client(), host=host, origin=f"http://{host}")


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8123", "127.0.0.1.evil.example", ""]
)
def test_a_name_that_was_rebound_to_this_machine_is_refused(host: str) -> None:
    assert client().get("/", headers={"host": host}).status_code == 403
    assert not socket_opens(client(), host=host, origin=f"http://{host}")


@pytest.mark.parametrize(
    "origin", ["https://evil.example", "null", "http://127.0.0.1:9999", "file://"]
)
def test_pages_of_another_origin_are_refused(origin: str) -> None:
    assert client().get("/", headers={"origin": origin}).status_code == 403
    assert not socket_opens(client(), host="127.0.0.1:8123", origin=origin)


def test_scripts_on_this_machine_need_no_origin() -> None:
    assert socket_opens(client(), host="127.0.0.1:8123")


def test_an_origin_that_is_allowed_is_let_in_with_its_host() -> None:
    tunnel = client(Access(origins=frozenset({"https://tunnel.example"})))
    assert socket_opens(tunnel, host="tunnel.example", origin="https://tunnel.example")
    assert socket_opens(tunnel, host="127.0.0.1:8123", origin="https://tunnel.example")
    assert not socket_opens(tunnel, host="tunnel.example", origin="https://evil.example")


def test_others_need_the_token_once_and_then_its_cookie() -> None:
    page = client(Access(hosts=LOOPBACK, token="secret"))
    assert page.get("/").status_code == 403
    assert page.get("/?token=wrong").status_code == 403
    assert not socket_opens(page, host="127.0.0.1:8123")
    answer = page.get("/?token=secret")
    assert answer.status_code == 200
    assert "HttpOnly" in answer.headers["set-cookie"]
    assert "SameSite=Strict" in answer.headers["set-cookie"]
    assert page.get("/").status_code == 200
    assert socket_opens(page, host="127.0.0.1:8123", cookie=f"{COOKIE}=secret")


def test_every_answer_carries_a_strict_content_policy() -> None:
    for answer in (client().get("/"), client().get("/", headers={"host": "evil.example"})):
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self';" in policy
        assert "frame-ancestors 'none'" in policy
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "no-referrer"
