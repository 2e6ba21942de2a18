"""A replay shows each moment as it was: the lights, the way so far, and where rules were broken."""

from typing import Any

import numpy as np
import pytest

from mjdrive.episodes import store
from mjdrive.town import library, signals

pytestmark = pytest.mark.timeout(900)

EPISODE = "drives/drive-0/episode"
TRAIL, PIN = (108, 184, 255), (201, 176, 138)
"""Colours of the way and of the pin of a kerb, in sRGB."""

LAMPS = """
(({ count, instanceColor: { array } }) => [...Array(count / 3).keys()].map(light => {
  const lit = [0, 1, 2].map(lamp => Math.max(...array.slice(9 * light + 3 * lamp, 9 * light + 3 * lamp + 3)));
  return lit.indexOf(Math.max(...lit));
}))(mjdrive.live.view.town.lamps)
"""
PATCH = """
([x, y, dx, dy]) => {
  const { live: { map } } = mjdrive, canvas = document.querySelector("#map"), ratio = canvas.width / canvas.clientWidth;
  const to = map.projection(canvas.clientWidth, canvas.clientHeight);
  const [column, row] = [ratio * (to.x(x) + dx), ratio * (to.y(y) + dy)].map(Math.round);
  return [...canvas.getContext("2d").getImageData(column - 1, row - 1, 3, 3).data];
}
"""


def lights_at(bench: Any, time: float) -> list[int]:
    """What each light showed at a time of the episode [s]."""
    episode = store.read(bench.folder / f"{EPISODE}.hdf5")
    shown = signals.all_at(library.load(episode.town), time + episode.light_phase)
    return [int(it) for it in shown.values()]


def distance(page: Any, color: tuple[int, ...], *place: float) -> float:
    """How far the map's colours around a place in the town, and pixels from there, are from one at least [-]."""
    pixels = np.array(page.evaluate(PATCH, list(place))).reshape(-1, 4)[:, :3]
    return float(np.linalg.norm(pixels - color, axis=1).min())


def test_a_replay_shows_the_lights_as_they_were_on_the_map_and_in_3d(bench: Any) -> None:
    page = bench.open(f"episode={EPISODE}&t=1.0", webgl=True)
    page.wait_for_function("mjdrive.replay.isOpen", polling=100)
    seen = []
    for step, words in ((10, "1.0 s"), (30, "3.0 s")):
        page.fill("[type=range]", str(step))
        page.wait_for_function(f"document.querySelector('#clock').textContent === '{words}'")
        seen.append(lights_at(bench, step / 10))
        assert page.evaluate("[...mjdrive.live.map.lights]") == seen[-1]
        assert page.evaluate(LAMPS) == seen[-1]
    assert seen[0] != seen[1]
    page.close()


def test_the_map_shows_the_way_so_far_and_pins_that_keys_reach(bench: Any) -> None:
    page = bench.open(f"episode={EPISODE}&t=0.0", width=1000, height=700)
    page.wait_for_function("mjdrive.replay.isOpen", polling=100)
    page.focus("#infractions button")
    page.keyboard.press("Enter")
    page.wait_for_function("document.querySelector('#clock').textContent === '2.0 s'", polling=100)
    assert "kerb at 2.0 s: kerb/1" in page.inner_text("#map-say")
    assert distance(page, PIN, 20.0, 0.0, -5.0, -14.0) < 20
    assert distance(page, TRAIL, 8.0, 0.0, 0.0, 0.0) < 20
    assert distance(page, TRAIL, 45.0, 0.0, 0.0, 0.0) > 60
    page.fill("[type=range]", "59")
    assert distance(page, TRAIL, 45.0, 0.0, 0.0, 0.0) < 20
    assert page.inner_text("#map-tick") == page.inner_text("#charts-tick") == "step 59"
    page.close()


def test_in_a_replay_nothing_speaks_of_the_live_drive(bench: Any) -> None:
    page = bench.open(f"episode={EPISODE}", width=1400, height=800)
    page.wait_for_function("mjdrive.replay.isOpen", polling=100)
    assert "searcher in town03, seed 7" in page.inner_text("#replaying")
    for hidden in ("#controls", "#badge", "#rate"):
        assert not page.is_visible(hidden)
    heights = (
        "[...document.querySelectorAll('#replay > *')].map(it => it.getBoundingClientRect().bottom)"
    )
    bottoms = page.evaluate(heights)
    assert max(bottoms) - min(bottoms) < 20, "the bar is one row"
    page.click("text=Back to live")
    page.wait_for_function("document.querySelector('#bev-tick').textContent.startsWith('tick')")
    assert page.is_visible("#controls")
    assert "episode" not in page.url
    page.close()
