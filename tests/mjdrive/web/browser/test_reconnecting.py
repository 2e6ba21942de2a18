"""A page whose server goes says so, does nothing meanwhile, and shows what the next server drives."""

import dataclasses
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
import uvicorn

from mjdrive.page.scene import scene_message
from mjdrive.web.browsing import Shelf
from mjdrive.web.guard import Access
from mjdrive.web.server import make_app
from mjdrive.web.session import Choice, Session

pytestmark = pytest.mark.timeout(900)

SHOWN = "mjdrive.live.town === 'other' && document.querySelector('#map-tick').textContent.startsWith('tick')"
FLAT = """
const context = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind === "2d" ? context.call(this, kind, ...rest) : null;
};
"""
DISABLED = "[...document.querySelectorAll('#controls button, #controls select')].filter(it => it.disabled).length"


@contextmanager
def serving(session: Session, port: int, wait: Callable[..., Any]) -> Iterator[str]:
    """A server in this process; its address."""
    shelf = Shelf(session.runs, session.data / "drives", session.data)
    app = make_app(session, shelf=shelf, access=Access())
    config = uvicorn.Config(app, port=port, log_level="warning", timeout_graceful_shutdown=1)
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run)
    thread.start()
    try:
        wait(lambda: server.started, "the server")
        yield f"http://127.0.0.1:{port}/"
    finally:
        server.should_exit = True
        thread.join()


def test_a_page_follows_a_server_that_is_started_anew_with_another_town(
    bench: Any, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    page = bench.browser.new_page(viewport={"width": 500, "height": 400}, bypass_csp=True)
    page.set_default_timeout(240_000)
    page.add_init_script(FLAT)
    with serving(session, port, bench.wait) as address:
        page.goto(f"{address}?noaa&seed=5&speed=0.25")
        page.wait_for_function("window.mjdrive?.state()?.seed === 5", polling=100)
        page.wait_for_function("mjdrive.state().speed === 0.25", polling=100)
        assert page.evaluate(DISABLED) == 0
    page.wait_for_selector("body.lost", state="attached")
    assert page.evaluate(DISABLED) > 5
    assert page.text_content("#badge") == "No connection"
    # Another one as far as a page can tell; to build a real one would take seconds.
    other = dataclasses.replace(session.simulation.town, name="other")
    monkeypatch.setattr(session, "scene", scene_message(other, session.simulation.model))
    session.choice = Choice("other", "pid", 3)
    with serving(session, port, bench.wait):
        page.wait_for_function(SHOWN, polling=100)
        assert page.evaluate(DISABLED) == 0
        assert page.input_value("#town") == "other"
        assert "town=other" in page.url
        assert "seed=3" in page.url
        page.close()
