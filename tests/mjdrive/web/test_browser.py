"""The page in a real Chromium: one server and one browser for all; every wait is for a condition, with a limit."""

import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from shutil import which
from typing import Any

import pytest

CHROMIUM = which("chromium") or which("chromium-browser") or which("google-chrome")
FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",  # compositing the page in software, too, is four times slower
]
PATIENCE_MS = 60_000

pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine"),
    pytest.mark.timeout(240),
]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [
        sys.executable,
        "-m",
        "mjdrive",
        "serve",
        "--town",
        "town03",
        "--policy",
        "pid",
        "--port",
        str(port),
    ]
    folder: Path = tmp_path_factory.mktemp("serve")
    url = f"http://127.0.0.1:{port}/"
    with subprocess.Popen(command, cwd=folder) as server:
        for _ in range(600):
            try:
                urllib.request.urlopen(url, timeout=1).close()
                break
            except OSError:
                assert server.poll() is None, "the server has ended"
                time.sleep(0.2)
        yield url
        server.terminate()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as engine:
        chromium = engine.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def page(browser: Any, address: str) -> Any:
    # wait_for_function polls with eval, which the page's own policy forbids; another test holds that policy.
    opened = browser.new_page(viewport={"width": 900, "height": 560}, bypass_csp=True)
    opened.set_default_timeout(PATIENCE_MS)
    opened.problems, opened.foreign = [], []
    opened.on("pageerror", lambda error: opened.problems.append(str(error)))
    opened.on("console", lambda it: opened.problems.append(it.text) if it.type == "error" else None)
    opened.on(
        "request", lambda it: None if it.url.startswith(address) else opened.foreign.append(it.url)
    )
    opened.goto(address + "?noaa")
    opened.wait_for_function("window.mjdrive?.live.panels > 3 && mjdrive.live.view.rendered > 3")
    return opened


def test_the_town_is_drawn_in_few_calls(page: Any) -> None:
    assert 5 < page.evaluate("mjdrive.live.view.calls") < 90


def test_panels_move_on(page: Any) -> None:
    before = page.evaluate("mjdrive.live.panels")
    page.wait_for_function(f"mjdrive.live.panels > {before + 5}")


def test_nothing_is_fetched_from_elsewhere_and_nothing_fails(page: Any) -> None:
    assert page.foreign == []
    assert page.problems == []


def test_paused_it_waits_and_steps_one_decision(page: Any) -> None:
    page.click("#pause")
    page.wait_for_function("mjdrive.state().paused")
    tick = page.inner_text("#bev-tick")
    page.click("#step")
    page.wait_for_function(f"document.querySelector('#bev-tick').textContent !== '{tick}'")
    page.click("#pause")
    page.wait_for_function("!mjdrive.state().paused")


def test_held_keys_are_recorded_as_a_demonstration(page: Any) -> None:
    page.click("#wheel")
    page.wait_for_function("mjdrive.state().wheel === 'yours'")
    page.keyboard.down("ArrowUp")
    page.wait_for_function("mjdrive.state().recorded > 20")
    page.keyboard.up("ArrowUp")
    page.click("#keep")
    page.wait_for_function(
        "document.querySelector('#note span').textContent.includes('human-0000')"
    )


def test_another_page_only_watches_while_the_wheel_is_held(
    page: Any, browser: Any, address: str
) -> None:
    assert page.evaluate("mjdrive.state().wheel") == "yours"
    other = browser.new_page(viewport={"width": 500, "height": 300}, bypass_csp=True)
    other.goto(address + "?noaa&tab=runs")
    other.wait_for_function("window.mjdrive?.state()?.wheel === 'taken'", timeout=PATIENCE_MS)
    assert other.locator("#wheel").is_disabled()
    other.close()
    page.keyboard.press("t")
    page.wait_for_function("mjdrive.state().wheel === 'free'")


def test_a_human_drive_is_listed_and_replayed(page: Any) -> None:
    page.click("#tab-episodes")
    page.click("text=human-0000")
    page.wait_for_function("mjdrive.replay.isOpen")
    assert "episode=" in page.url
    page.click("text=Back to live")
    page.wait_for_function("!mjdrive.replay.isOpen")


def test_keys_open_the_help(page: Any) -> None:
    page.keyboard.press("?")
    assert page.locator("#help").is_visible()
    page.keyboard.press("Escape")
    assert not page.locator("#help").is_visible()


def test_the_content_policy_holds_without_complaint(browser: Any, address: str) -> None:
    strict = browser.new_page()
    complaints: list[str] = []
    strict.on("console", lambda it: complaints.append(it.text) if it.type == "error" else None)
    answer = strict.goto(address + "?noaa&tab=runs")
    strict.wait_for_selector("#runs h2")
    assert "script-src 'self'" in answer.headers["content-security-policy"]
    assert complaints == []
    strict.close()


def test_without_webgl_the_panels_still_work(address: str) -> None:
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as engine:
        plain = engine.chromium.launch(
            executable_path=CHROMIUM, args=[*FLAGS[:6], "--disable-3d-apis"]
        )
        page = plain.new_page(bypass_csp=True)
        page.goto(address)
        page.wait_for_function("window.mjdrive?.live.panels > 1", timeout=PATIENCE_MS)
        assert page.locator("#no-gl").is_visible()
        plain.close()
