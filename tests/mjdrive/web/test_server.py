"""The application from outside: what pages get, what is refused, and in what words."""

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from starlette.testclient import TestClient, WebSocketTestSession

from mjdrive.datatypes import Action
from mjdrive.episodes import store
from mjdrive.page import wire
from mjdrive.town import library
from mjdrive.web import browsing, server
from mjdrive.web.browsing import Shelf
from mjdrive.web.guard import LOOPBACK, Access
from mjdrive.web.session import Choice, Session
from models import checkpoint

HOME = "http://127.0.0.1:8123"


@pytest.fixture
def shelf(session: Session, tmp_path: Path) -> Shelf:
    return Shelf(session.runs, tmp_path / "drives", session.data)


@pytest.fixture
def drive(session: Session, shelf: Shelf) -> Path:
    """An episode of `mjdrive drive`."""
    session.begin_recording()
    for _ in range(12):
        session.step(Action(0.1, 0.0), on_motion=lambda: None, by_hand=True)
    path = shelf.drives / "today" / "episode.hdf5"
    path.parent.mkdir(parents=True)
    assert session.recording is not None
    store.write(session.recording.episode(), path)
    session.recording = None
    return path


@pytest.fixture
def client(session: Session, shelf: Shelf, drive: Path, tmp_path: Path) -> Iterator[TestClient]:
    assert drive.is_file()  # it was driven before another thread owns the session
    page = tmp_path / "page"
    page.mkdir()
    (page / "index.html").write_text("the page")
    (tmp_path / "secret.txt").write_text("secret")
    access = Access(hosts=LOOPBACK | {"testserver"})  # as the client calls it from a socket
    app = server.make_app(session, shelf=shelf, access=access, page=page)
    with TestClient(app, base_url=HOME, raise_server_exceptions=False) as found:
        yield found


def until(
    page: WebSocketTestSession, is_it: Callable[[str, dict[str, Any]], bool]
) -> dict[str, Any]:
    """Listen until something is told; what comes is acknowledged."""
    count = 0
    for _ in range(2000):
        message = page.receive()
        assert message["type"] != "websocket.close", message["reason"]
        if "bytes" in message and message["bytes"] is not None:
            head = wire.unpack(message["bytes"])[0]
            count += 1
            page.send_text(json.dumps({"op": "ack", "n": count}))
        else:
            head = json.loads(message["text"])
        if is_it(head["k"], head):
            return head
    raise AssertionError("it was never told")


def closing(page: WebSocketTestSession) -> tuple[int, str]:
    """Say nothing until the server closes the connection; its code and its words."""
    while (message := page.receive())["type"] != "websocket.close":
        pass
    return message["code"], message["reason"]


def test_a_page_is_told_everything_as_soon_as_it_comes(client: TestClient) -> None:
    with client.websocket_connect("/ws") as page:
        seen: set[str] = set()
        wanted = {"state", "history", "pose", "panel", "beat"}

        def is_all(kind: str, _: object) -> bool:
            seen.add(kind)
            return seen >= wanted

        until(page, is_all)
    scene = client.get("/api/scene")
    assert wire.unpack(scene.content)[0]["town"] == "town03"
    again = client.get("/api/scene", headers={"if-none-match": scene.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_a_town_that_is_a_copy_of_another_is_another_scene(
    client: TestClient, session: Session
) -> None:
    tag = client.get("/api/scene").headers["etag"]
    session.choice = Choice("copy", "pid", 0)
    answer = client.get("/api/scene", headers={"if-none-match": tag})
    assert answer.status_code == 200
    assert answer.headers["etag"] != tag


def test_commands_are_obeyed_and_answered(client: TestClient) -> None:
    with client.websocket_connect("/ws") as page:
        page.send_text('{"op": "pause", "on": true}')
        assert until(page, lambda kind, head: kind == "state" and head["paused"])["operator"] == 1
        page.send_text('{"op": "load", "policy": "nobody"}')
        note = until(page, lambda kind, head: kind == "note" and head["error"])
        assert "Unknown policy 'nobody'" in note["line"]


def test_a_second_page_only_watches(client: TestClient) -> None:
    with client.websocket_connect("/ws") as one, client.websocket_connect("/ws") as two:
        until(one, lambda kind, head: kind == "state" and head["you"] == head["operator"])
        two.send_text('{"op": "pause", "on": true}')
        assert "in control" in until(two, lambda kind, _: kind == "note")["line"]


def test_what_means_nothing_ends_the_connection_with_words(client: TestClient) -> None:
    with client.websocket_connect("/ws") as page:
        page.send_text('{"op": "shutdown"}')
        assert "Expected an object" in until(page, lambda kind, _: kind == "note")["line"]
        assert closing(page)[0] == server.NOT_UNDERSTOOD


def test_so_many_pages_and_no_more(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "MOST_PAGES", 1)
    with client.websocket_connect("/ws"), client.websocket_connect("/ws") as late:
        assert closing(late) == (server.TRY_LATER, "1 pages are open already.")


def test_a_page_that_says_nothing_makes_room(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "MOST_SILENCE", 0.2)
    with client.websocket_connect("/ws") as page:
        code, reason = closing(page)
        assert code == server.GOING_AWAY
        assert "said nothing" in reason


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "/..%2fsecret.txt",
        "/%2e%2e%2fsecret.txt",
        "//secret.txt",
    ],
)
def test_files_beside_the_page_are_not_served(client: TestClient, path: str) -> None:
    assert client.get("/").text == "the page"
    raw = client.build_request("GET", HOME)
    raw.url = raw.url.copy_with(raw_path=path.encode())
    answer = client.send(raw)
    assert answer.status_code == 404
    assert "secret" not in answer.text


def test_nothing_is_changed_by_getting(client: TestClient, drive: Path) -> None:
    address = "/api/episode/delete?name=drives/today/episode"
    assert client.get(address).status_code in (404, 405)
    assert client.post(address, headers={"origin": "https://evil.example"}).status_code == 403
    assert drive.is_file()
    assert client.post(address, headers={"origin": HOME}).json() == {"deleted": True}
    assert not drive.exists()


@pytest.mark.parametrize(
    "name",
    ["../secret", "drives/../../secret", "drives/link", "/etc/passwd", "today/episode", "", "."],
)
def test_episodes_have_names_and_no_paths(
    client: TestClient, drive: Path, tmp_path: Path, name: str
) -> None:
    secret = tmp_path / "secret.hdf5"
    shutil.copy(drive, secret)
    (tmp_path / "drives" / "link.hdf5").symlink_to(secret)
    for answer in (
        client.get("/api/episode", params={"name": name}),
        client.get("/api/episode/view", params={"name": name, "step": "0"}),
        client.get("/api/episode/file", params={"name": name}),
        client.post("/api/episode/delete", params={"name": name}),
    ):
        assert answer.status_code == 400
        assert answer.json()["error"].startswith(f"Unknown episode '{name}'")
    assert secret.is_file()
    whole = client.get("/api/episode/file", params={"name": "drives/today/episode"})
    assert whole.content == drive.read_bytes()
    assert "drives-today-episode.hdf5" in whole.headers["content-disposition"]


@pytest.mark.parametrize(
    "name",
    [
        "../town02",
        "town02/../town02",
        "town02/",
        "/etc",
        "",
        ".",
        "..",
        str(library.towns_folder()),
    ],
)
def test_towns_have_names_and_no_paths(client: TestClient, name: str) -> None:
    answer = client.get("/api/scene", params={"town": name})
    assert answer.status_code == 400
    assert answer.json()["error"].startswith(f"Unknown town '{name}'")


def test_an_episode_is_replayed_with_its_view(client: TestClient, drive: Path) -> None:
    head, blobs = wire.unpack(client.get("/api/episode?name=drives/today/episode").content)
    assert (head["k"], len(blobs["rows"])) == ("episode", 12)
    view = wire.unpack(client.get("/api/episode/view?name=drives/today/episode&step=3").content)
    assert view[1]["bev"].shape == (5, 192, 192)


def test_an_episode_of_a_newer_version_is_named_and_hides_no_other(
    client: TestClient, drive: Path
) -> None:
    newer = drive.with_name("newer.hdf5")
    shutil.copy(drive, newer)
    with h5py.File(newer, "r+") as file:
        file.attrs["format"] = np.bytes_("mjdrive-episode-9")
    rows = {it["name"]: it for it in client.get("/api/episodes").json()}
    assert "format 'mjdrive-episode-9'; expected" in rows["drives/today/newer"]["error"]
    assert rows["drives/today/episode"]["steps"] == 12
    answer = client.get("/api/episode?name=drives/today/newer")
    assert answer.status_code == 400
    assert "mjdrive-episode-9" in answer.json()["error"]


def test_an_episode_that_was_deleted_while_shown_is_named(client: TestClient, drive: Path) -> None:
    assert client.get("/api/episode?name=drives/today/episode").status_code == 200
    assert client.get("/api/episodes").json() != []
    drive.unlink()
    assert client.get("/api/episodes").json() == []
    view = client.get("/api/episode/view?name=drives/today/episode&step=3")
    assert view.status_code == 200  # who has begun to watch it may go on
    answer = client.post("/api/episode/delete?name=drives/today/episode")
    assert "Load the list again" in answer.json()["error"]


def test_a_failure_of_ours_is_told_in_the_page(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(folder: Path) -> tuple[str, ...]:
        raise PermissionError(13, "Permission denied", str(folder))

    monkeypatch.setattr("mjdrive.web.api.policy_names", fail)
    answer = client.get("/api/catalogue")
    assert answer.status_code == 500
    assert "Permission denied" in answer.json()["error"]
    assert client.get("/").status_code == 200


def test_damaged_summaries_and_runs_hide_no_others(client: TestClient, shelf: Shelf) -> None:
    for name, text in {"a": "{", "b": '{"policy": "pid"}'}.items():
        (shelf.drives / name).mkdir(parents=True)
        (shelf.drives / name / browsing.report.SUMMARY).write_text(text)
        (shelf.runs / name).mkdir(parents=True)
        (shelf.runs / name / checkpoint.STATE).write_text(text)
    assert client.get("/api/drives").json() == [{"policy": "pid"}]
    assert ["error" in it for it in client.get("/api/runs").json()] == [True, True]
