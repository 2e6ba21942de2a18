"""One server and one Chromium for all tests of a process; what the server says is the truth that the page is held to.

The server runs out of the installed wheel, far from the checkout, beside a package of somebody else.
"""

import json
import os
import socket
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import which
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from mjdrive.page import wire


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Let one process run all of these, so that there is one browser and one server at a time.

    First, because what hands out tests to processes reads the groups in the same hook.
    """
    for item in items:
        if item.path.parent == Path(__file__).parent:
            item.add_marker(pytest.mark.xdist_group("browser"))


CHROMIUM = which("chromium") or which("chromium-browser") or which("google-chrome")
FLAGS = [f"--disable-{it}" for it in ("dev-shm-usage", "quic", "component-update", "sync")]
FLAGS += ["--no-sandbox", "--no-first-run", "--disable-background-networking"]
# Compositing the page in software, too, would be four times slower.
FLAGS += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing"]
PATIENCE = 240.0
"""On a machine that is busy with many other things [s]."""

NO_WEBGL = """
const context = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : context.call(this, kind, ...rest);
};
"""


def wait(condition: Callable[[], Any], what: str) -> Any:
    """Return what a condition comes to as soon as it is true."""
    end = time.monotonic() + PATIENCE
    while not (found := condition()):
        assert time.monotonic() < end, f"waited in vain for {what}"
        time.sleep(0.02)
    return found


class Watcher:
    """Another client of the server, without a browser."""

    def __init__(self, address: str) -> None:
        self.state: dict[str, Any] = {}
        self.pose: dict[str, Any] = {}
        self.panel: dict[str, Any] = {}
        self.num_panels = 0
        self._is_closing = False
        self._thread = threading.Thread(target=self._listen, args=(address,))
        self._thread.start()
        wait(lambda: self.state and self.pose and self.panel, "the server's first words")

    def _listen(self, address: str) -> None:
        with connect(address.replace("http", "ws") + "ws", max_size=None) as self._socket:
            try:
                for count, message in enumerate(filter(self._hear, self._socket), 1):
                    self._socket.send(json.dumps({"op": "ack", "n": count}))
                    self._see(wire.unpack(message)[0])
            except ConnectionClosed:
                if (
                    not self._is_closing
                ):  # what comes while it closes cannot be acknowledged any more
                    raise

    def _see(self, head: dict[str, Any]) -> None:
        """Note what a binary message is about."""
        if head["k"] in ("pose", "panel"):
            setattr(self, head["k"], head)
            self.num_panels += head["k"] == "panel"

    def _hear(self, message: str | bytes) -> bool:
        """Note a text message; whether this is a binary one."""
        if isinstance(message, bytes):
            return True
        told = json.loads(message)
        self.state = told if told["k"] == "state" else self.state
        return False

    def close(self) -> None:
        self._is_closing = True
        self._socket.close()
        self._thread.join()

    def pause(self) -> dict[str, Any]:
        """Wait until the drive is paused, and say what it would do next."""
        self.until(paused=True)
        before = self.num_panels
        self._socket.send(json.dumps({"op": "watch"}))
        wait(lambda: self.num_panels > before, "the decision that is paused at")
        return self.panel

    def until(self, **values: Any) -> None:
        """Wait until the state of the server has these values."""
        wait(lambda: values.items() <= self.state.items(), f"{values}")


class Bench:
    """A page, the server that it shows, and a watcher who knows what the server says."""

    wait = staticmethod(wait)

    def __init__(self, browser: Any, address: str, folder: Path) -> None:
        self.browser, self.address, self.folder = browser, address, folder
        self.problems: list[str] = []
        self.foreign: list[str] = []
        self.page = self.open(width=700, height=600)
        self.see("mjdrive.live.panels > 0")
        self.watcher = Watcher(address)

    def open(
        self, query: str = "", *, width: int = 500, height: int = 400, webgl: bool = False
    ) -> Any:
        """Open another page, and wait until the server has told it who it is.

        Without WebGL unless a test is about the 3D view: drawn in software, that takes all there is of a small machine.
        """
        # wait_for_function polls with eval, which the page's own policy forbids; another test holds that policy.
        page = self.browser.new_page(viewport={"width": width, "height": height}, bypass_csp=True)
        page.set_default_timeout(1000 * PATIENCE)
        page.on("pageerror", lambda error: self.problems.append(str(error)))
        page.on("console", lambda it: it.type == "error" and self.problems.append(it.text))
        page.on(
            "request", lambda it: it.url.startswith(self.address) or self.foreign.append(it.url)
        )
        page.on("dialog", lambda it: it.accept())
        if not webgl:
            page.add_init_script(NO_WEBGL)
        page.goto(f"{self.address}?noaa&{query}")
        page.wait_for_function("window.mjdrive?.state()", polling=100)
        return page

    def see(self, condition: str) -> None:
        """Wait until something holds in the page."""
        self.page.wait_for_function(condition, polling=100)

    def reset(self) -> None:
        """The live tab, nobody at the wheel, the expert drives."""
        self.page.click("#tab-live")
        if self.page.evaluate("mjdrive.replay.isOpen"):
            self.page.click("text=Back to live")
        if self.watcher.state["driver"]:
            self.page.click("#wheel")
            self.watcher.until(driver=0)
        if self.watcher.state["paused"]:
            self.page.click("#pause")
            self.watcher.until(paused=False)
        if self.watcher.state["policy"] != "pid":
            self.page.select_option("#policy", "pid")
            self.watcher.until(policy="pid")

    def take_the_wheel(self) -> None:
        self.page.click("#wheel")
        self.watcher.until(driver=self.page.evaluate("mjdrive.state().you"))


@pytest.fixture(scope="session")
def no_webgl() -> str:
    """A script for pages that shall find no WebGL."""
    return NO_WEBGL


@pytest.fixture(scope="session")
def address(shelves: Path, environment: dict[str, str], example_package: Path) -> Iterator[str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        url = f"http://127.0.0.1:{probe.getsockname()[1]}/"
    choice = ["--town", "town03", "--policy", "pid", "--port", url.strip("/").rsplit(":", 1)[1]]
    command = [sys.executable, "-m", "mjdrive", "serve", *choice]
    found = os.pathsep.join([environment["PYTHONPATH"], str(example_package)])

    def answers() -> bool:
        assert server.poll() is None, "the server has ended"
        try:
            urllib.request.urlopen(url, timeout=5).close()
        except OSError:
            return False
        return True

    with subprocess.Popen(command, cwd=shelves, env=environment | {"PYTHONPATH": found}) as server:
        try:
            wait(answers, "the server")
            yield url
        finally:
            server.terminate()


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")  # in CI a skipped test is a failed one
    engine = pytest.importorskip("playwright.sync_api")
    options = {"executable_path": CHROMIUM, "args": FLAGS, "timeout": 1000 * PATIENCE}
    with engine.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(**options)
        yield chromium
        chromium.close()


@pytest.fixture(scope="session")
def opened(browser: Any, address: str, shelves: Path) -> Iterator[Bench]:
    bench = Bench(browser, address, shelves)
    yield bench
    bench.watcher.close()


@pytest.fixture
def bench(opened: Bench) -> Bench:
    opened.reset()
    return opened
