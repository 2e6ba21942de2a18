"""A drive that was exported as a page, opened from the disk: it draws, is scrubbed and plays, and asks nobody for anything."""

import dataclasses
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mjdrive.config import BevConfig
from mjdrive.datatypes import Episode, Infraction, InfractionKind
from mjdrive.exchange import formats
from mjdrive.exchange.sources import Recording
from mjdrive.exchange.views import ViewMaker
from mjdrive.recording.playback import town_of

pytestmark = pytest.mark.timeout(900)

PATIENCE = 240.0
"""For the page to draw on a busy machine [s]."""

IS_GROUND = """
() => { // of every pixel, "1" where the page shows no road, no line and no light
  const canvas = document.getElementById("bev"), { data } = canvas.getContext("2d").getImageData(0, 0, 192, 192);
  let found = "";
  for (let at = 0; at < data.length; at += 4) found += data[at] === 22 && data[at + 1] === 25 && data[at + 2] === 30 ? "1" : "0";
  return canvas.width === 192 && canvas.height === 192 ? found : "";
}
"""


class Shown:
    """The page in the browser, and all that it asked for or complained of."""

    def __init__(self, context: Any, file: Path) -> None:
        self.problems: list[str] = []
        self.asked_for: list[str] = []
        self.page = context.new_page()
        self.page.set_default_timeout(1000 * PATIENCE)
        self.page.on("pageerror", lambda error: self.problems.append(str(error)))
        self.page.on("console", lambda it: it.type == "error" and self.problems.append(it.text))
        self.page.on("request", lambda it: self.asked_for.append(it.url))
        self.page.goto(file.as_uri())
        self.until(lambda: bool(self.page.evaluate("'mjdrive' in window")), "the drive")

    def until(self, condition: Callable[[], bool], what: str) -> None:
        """Wait for something; the page's own policy forbids the browser's way to do so."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, f"waited in vain for {what}"
            time.sleep(0.05)

    @property
    def clock(self) -> str:
        return str(self.page.inner_text("#clock"))

    @property
    def scrubber(self) -> Any:
        return self.page.locator("#replay input[type=range]")

    def is_ground(self) -> np.ndarray:
        """Where the view shows nothing, shape (192, 192)."""
        found = self.page.evaluate(IS_GROUND)
        return np.array(list(found)).reshape(192, 192) == "1"


@pytest.fixture(scope="module")
def breach(short_drive: Episode) -> Infraction:
    x, y = short_drive.vehicle[5, :2].tolist()
    return Infraction(InfractionKind.COLLISION, 0.5, x, y, "</script> & <b>pole</b>")


@pytest.fixture(scope="module")
def episode(short_drive: Episode, breach: Infraction) -> Episode:
    """A drive that turns on the spot, so that no two views are alike."""
    vehicle = short_drive.vehicle.copy()
    vehicle[:, 2] = 0.1 * np.arange(len(vehicle))
    return dataclasses.replace(short_drive, vehicle=vehicle, infractions=(breach,))


@pytest.fixture(scope="module")
def file(episode: Episode, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("exports") / "html"
    formats.export([Recording("turning", episode)], formats.known("html"), folder)
    return folder / "turning.html"


@pytest.fixture
def shown(browser: Any, file: Path, no_webgl: str) -> Iterator[Shown]:
    """The page without its 3D view, which takes all there is of a small machine."""
    yield from _opened(browser, file, script=no_webgl)


@pytest.fixture
def shown_in_3d(browser: Any, file: Path) -> Iterator[Shown]:
    yield from _opened(browser, file)


def _opened(browser: Any, file: Path, *, script: str = "") -> Iterator[Shown]:
    context = browser.new_context(offline=True, viewport={"width": 1200, "height": 700})
    if script:
        context.add_init_script(script)
    shown = Shown(context, file)
    yield shown
    context.close()
    assert shown.problems == []
    assert shown.asked_for == [file.as_uri()]


def test_what_the_policy_saw_is_drawn_at_whatever_step_it_is_scrubbed_to(
    shown: Shown, episode: Episode
) -> None:
    views, config = ViewMaker(town_of(episode)), BevConfig()
    apart = np.ones((config.size_px, config.size_px), bool)  # from where the car is drawn
    rear = config.size_px - config.ego_above_bottom_px
    apart[rear - 30 : rear + 16, config.size_px // 2 - 8 : config.size_px // 2 + 8] = False
    seen = []
    for step in (0, 14, 6):
        shown.scrubber.fill(str(step))
        assert shown.clock == f"{episode.time[step]:.1f} s"
        assert shown.page.inner_text("#kmh") == f"{abs(3.6 * episode.vehicle[step, 3]):.0f}"
        meant = ~np.any(views.bev(episode, step), axis=0)

        def agrees(meant: np.ndarray = meant) -> bool:
            return np.array_equal(shown.is_ground()[apart], meant[apart])

        shown.until(agrees, f"the view of step {step}")
        seen.append(meant[apart].tobytes())
    assert len(set(seen)) == 3


def test_the_town_is_shown_in_3d_with_the_car_where_it_was(
    shown_in_3d: Shown, episode: Episode
) -> None:
    shown = shown_in_3d
    shown.until(lambda: shown.page.evaluate("mjdrive.live.view.rendered") > 0, "a picture")
    assert shown.page.evaluate("mjdrive.live.view.calls") > 10
    shown.scrubber.fill("9")
    place = "mjdrive.live.view.town.bodies[0].position"
    goal = episode.vehicle[9, :2]

    def is_there() -> bool:
        found = shown.page.evaluate(f"[{place}.x, {place}.y]")
        return bool(np.linalg.norm(np.array(found) - goal) < 3.0)  # rear axle and body are apart

    shown.until(is_there, "the car at step 9")


def test_nothing_is_drawn_while_it_stands_still(shown_in_3d: Shown) -> None:
    shown = shown_in_3d
    drawn: list[int] = [0]

    def rests() -> bool:
        before, drawn[0] = drawn[0], shown.page.evaluate("mjdrive.live.view.rendered")
        shown.page.wait_for_timeout(700)
        return before == drawn[0] > 0

    shown.until(rests, "rest")
    for wake in (
        lambda: shown.scrubber.fill("5"),
        lambda: shown.page.set_viewport_size({"width": 1000, "height": 700}),
    ):
        wake()
        shown.until(lambda: shown.page.evaluate("mjdrive.live.view.rendered") > drawn[0], "more")
        shown.until(rests, "rest")


def test_an_infraction_has_its_mark_and_leads_there(shown: Shown, breach: Infraction) -> None:
    mark = shown.page.locator("#replay .marks button")
    assert breach.cause in str(mark.get_attribute("title"))
    mark.click()
    shown.until(lambda: shown.clock == f"{breach.time:.1f} s", "the moment of the infraction")
    assert shown.page.inner_text("#infractions").endswith("collision")
    assert shown.page.locator("#infractions b").count() == 1  # a name is no markup


def test_keys_step_and_it_plays_to_the_end(shown: Shown, episode: Episode) -> None:
    for key in ("ArrowRight", "ArrowRight", "ArrowLeft"):
        shown.page.keyboard.press(key)
    shown.until(lambda: shown.clock == "0.1 s", "the step")
    shown.scrubber.focus()
    shown.page.keyboard.press(" ")  # plays, whatever has the focus but buttons
    end = f"{episode.time[-1]:.1f} s"
    shown.until(lambda: shown.clock == end, "the end of the drive")
    shown.until(lambda: shown.page.inner_text("#replay button").startswith("Play"), "its end")


def test_nothing_that_needs_a_server_is_shown(shown: Shown) -> None:
    for hidden in ("#tabs", "#controls", "#live-again", "#energy", "#slow"):
        assert not shown.page.is_visible(hidden), hidden
    for visible in ("#view", "#bev", "#map", "#charts", "#replay"):
        assert shown.page.is_visible(visible), visible
    shown.page.keyboard.press("?")
    assert "next camera" in shown.page.inner_text("#help")
    assert "wheel" not in shown.page.inner_text("#help")
