"""A drive that was exported as a page, opened from the disk: it draws, is scrubbed and plays, and asks nobody for anything."""

import dataclasses
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mjdrive.bev.layers import Layer
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
(side) => { // of every pixel that the policy saw, "1" where the page has the colour of what is no road
  const canvas = document.getElementById("view"), scale = canvas.width / side, width = canvas.width;
  const { data } = canvas.getContext("2d").getImageData(0, 0, width, canvas.height);
  let found = "";
  for (let row = 0; row < side; row++)
    for (let column = 0; column < side; column++) {
      const at = 4 * (Math.floor((row + 0.5) * scale) * width + Math.floor((column + 0.5) * scale));
      found += data[at] === 0xf4 && data[at + 1] === 0xf5 && data[at + 2] === 0xf7 ? "1" : "0";
    }
  return found;
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

    def until(self, condition: Callable[[], bool], what: str) -> None:
        """Wait for something; the page's own policy forbids the browser's way to do so."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, f"waited in vain for {what}"
            time.sleep(0.05)

    @property
    def clock(self) -> str:
        return str(self.page.inner_text("#clock"))

    def is_ground(self) -> np.ndarray:
        """Where the view shows no road, shape (192, 192)."""
        found = self.page.evaluate(IS_GROUND, 192)
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
def shown(browser: Any, file: Path) -> Iterator[Shown]:
    context = browser.new_context(offline=True, viewport={"width": 1100, "height": 900})
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
    apart[rear - 30 : rear + 10, config.size_px // 2 - 8 : config.size_px // 2 + 8] = False
    seen = []
    for step in (0, 14, 6):
        shown.page.locator("#scrubber").fill(str(step))
        assert shown.clock == f"{episode.time[step]:.1f} s"
        assert f"speed {3.6 * episode.vehicle[step, 3]:.1f} km/h" in shown.page.inner_text("body")
        bev = views.bev(episode, step)
        meant = ~np.any(bev[[Layer.ROAD, Layer.LANE_LINES, Layer.LIGHTS_NOW]], axis=0)

        def agrees(meant: np.ndarray = meant) -> bool:
            return np.array_equal(shown.is_ground()[apart], meant[apart])

        shown.until(agrees, f"the view of step {step}")
        seen.append(meant[apart].tobytes())
    assert len(set(seen)) == 3


def test_an_infraction_is_told_when_it_happens_and_leads_there(
    shown: Shown, breach: Infraction
) -> None:
    assert shown.page.inner_text("#told") == ""
    shown.page.locator("#scrubber").fill("7")
    assert breach.cause in shown.page.inner_text("#told")
    shown.page.locator("#scrubber").fill("0")
    shown.page.click("#infractions button")
    assert shown.clock == f"{breach.time:.1f} s"
    assert shown.page.locator("#infractions b").count() == 0  # a name is no markup


def test_keys_step_and_it_plays_to_the_end(shown: Shown, episode: Episode) -> None:
    shown.page.keyboard.press("ArrowRight")
    shown.page.keyboard.press("ArrowRight")
    shown.page.keyboard.press("ArrowLeft")
    assert shown.clock == "0.1 s"
    shown.page.keyboard.press(" ")
    end = f"{episode.time[-1]:.1f} s"
    shown.until(lambda: shown.clock == end, "the end of the drive")
    assert shown.page.get_attribute("#play", "aria-label") == "Play"
