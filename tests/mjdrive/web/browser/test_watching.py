"""What a page shows of a drive, and how it is paused, stepped and looked into."""

import io
from typing import Any

import numpy as np
import pytest
from PIL import Image

from mjdrive.town import library, signals

pytestmark = pytest.mark.timeout(900)

TICKS = "['bev', 'energy', 'map', 'charts'].map(it => document.querySelector(`#${it}-tick`).textContent)"
PIXELS = "[...document.querySelector('#bev').getContext('2d').getImageData(0, 0, 192, 192).data]"


def test_the_car_is_seen_in_its_town_from_four_sides(bench: Any) -> None:
    page = bench.open(webgl=True)
    page.wait_for_function("mjdrive.live.view.rendered > 2 && mjdrive.live.poses > 1", polling=100)
    assert 5 < page.evaluate("mjdrive.live.view.calls") < 60
    picture = Image.open(io.BytesIO(page.locator("#gl").screenshot())).convert("RGB")
    rgb = np.asarray(picture).astype(int)
    assert len(np.unique(rgb.reshape(-1, 3), axis=0)) > 100
    middle = rgb[rgb.shape[0] // 3 :, rgb.shape[1] // 3 : -rgb.shape[1] // 3]
    red = (middle[..., 0] > 100) & (middle[..., 0] > 2 * middle[..., 1])
    assert red.mean() > 0.01
    places = set()
    for name in ("hood", "top", "orbit", "chase"):
        rendered = page.evaluate("mjdrive.live.view.rendered")
        page.click(f"#cameras >> text={name}")
        page.wait_for_function(f"mjdrive.live.view.rendered > {rendered + 1}", polling=100)
        look = (
            "mjdrive.live.view.cameras.camera.matrix.elements.slice(0, 11)"  # no place: it moves on
        )
        places.add(str([round(it, 2) for it in page.evaluate(f"[...{look}]")]))
        assert ("camera=" in page.url) == (name != "chase")
    assert len(places) == 4
    page.focus("#cameras [aria-checked=true]")
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("document.activeElement.textContent") == "orbit"
    assert page.evaluate("mjdrive.live.view.cameras.name") == "orbit"
    page.close()


def test_panels_follow_the_drive_of_the_server(bench: Any) -> None:
    tick = bench.watcher.panel["tick"]
    bench.see(f"parseInt(document.querySelector('#bev-tick').textContent.slice(5)) > {tick}")
    shown = int(bench.page.inner_text("#bev-tick").removeprefix("tick "))
    bench.wait(lambda: bench.watcher.panel["tick"] >= shown, "the server to have been there")


def test_all_panels_show_one_decision(bench: Any) -> None:
    for _ in range(3):
        tick = bench.watcher.panel["tick"]
        bench.see(f"parseInt(document.querySelector('#map-tick').textContent.slice(5)) > {tick}")
        assert len(set(bench.page.evaluate(TICKS))) == 1
    bench.page.click("#pause")
    panel = bench.watcher.pause()
    bench.see(f"document.querySelector('#charts-tick').textContent === 'tick {panel['tick']}'")
    assert set(bench.page.evaluate(TICKS)) == {f"tick {panel['tick']}"}
    now = [panel["t"], panel["x"], panel["y"], panel["speed"], *panel["action"]]
    assert bench.page.evaluate("mjdrive.live.charts.now") == now


def test_charts_and_trail_of_a_page_that_watched_are_those_of_one_that_comes_later(
    bench: Any,
) -> None:
    bench.page.select_option("#speed-factor", "8")  # more steps than panels
    bench.page.click("#reset")
    bench.wait(lambda: bench.watcher.panel["tick"] < 10, "the beginning")
    bench.wait(lambda: bench.watcher.panel["tick"] > 30, "some way")
    bench.page.click("#pause")
    tick = bench.watcher.pause()["tick"]
    bench.page.select_option("#speed-factor", "1")
    other = bench.open()
    for page in (bench.page, other):
        page.wait_for_function(
            f"document.querySelector('#charts-tick').textContent === 'tick {tick}'", polling=100
        )
        assert page.evaluate("mjdrive.live.charts.rows.length") == 6 * tick
        assert page.evaluate("mjdrive.live.map.trail.length") == 2 * tick
    rows = "[...mjdrive.live.charts.rows, ...mjdrive.live.map.trail]"
    assert bench.page.evaluate(rows) == other.evaluate(rows)
    other.close()


def test_lights_change_on_the_map_as_the_town_says(bench: Any) -> None:
    town = library.load("town03")

    def shown(time: float, seed: int) -> list[int]:
        lights = signals.all_at(town, time + signals.phase(town, seed))
        return [int(it) for it in lights.values()]

    now = bench.watcher.state["seed"]
    seed = next(it for it in range(1000) if it != now and shown(0.0, it) != shown(1.0, it))
    bench.page.click("#pause")
    bench.watcher.until(paused=True)
    bench.page.fill("#seed", str(seed))
    bench.page.keyboard.press("Enter")
    bench.watcher.until(seed=seed)
    bench.wait(lambda: bench.watcher.pause()["t"] == 0.0, "the beginning")
    seen = []
    for is_later in (False, True):
        if is_later:
            bench.page.click("#pause")
            bench.wait(lambda: bench.watcher.panel["t"] >= 1.0, "a light to change")
            bench.page.click("#pause")
        panel = bench.watcher.pause()
        bench.see(f"document.querySelector('#map-tick').textContent === 'tick {panel['tick']}'")
        seen.append(bench.page.evaluate("[...mjdrive.live.map.lights]"))
        assert seen[-1] == shown(panel["t"], seed)
    assert seen[0] != seen[1]


def test_paused_it_waits_and_a_step_is_one_decision(bench: Any) -> None:
    bench.page.click("#pause")
    tick = bench.watcher.pause()["tick"]
    for number in (1, 2):
        bench.page.keyboard.press(".")
        bench.wait(lambda number=number: bench.watcher.panel["tick"] >= tick + number, "a step")
        assert bench.watcher.pause()["tick"] == tick + number
    bench.see(f"document.querySelector('#bev-tick').textContent === 'tick {tick + 2}'")


def test_speed_and_seed_are_chosen_for_the_server(bench: Any) -> None:
    bench.page.select_option("#speed-factor", "4")
    bench.watcher.until(speed=4.0)
    bench.see("location.search.includes('speed=4')")
    bench.page.select_option("#speed-factor", "1")
    bench.watcher.until(speed=1.0)
    seed = bench.watcher.state["seed"] + 1
    bench.page.fill("#seed", str(seed))
    bench.page.keyboard.press("Enter")
    bench.watcher.until(seed=seed)
    assert f"seed={seed}" in bench.page.url


def test_a_reset_begins_the_drive_again(bench: Any) -> None:
    bench.wait(lambda: bench.watcher.panel["tick"] > 3, "some way")
    bench.page.click("#pause")
    before = bench.watcher.pause()["tick"]
    bench.page.keyboard.press("Backspace")
    bench.wait(lambda: bench.watcher.panel["tick"] < before, "the beginning")
    assert bench.watcher.panel["tick"] == 0


def test_a_channel_that_is_switched_off_is_not_drawn(bench: Any) -> None:
    bench.page.click("#pause")
    tick = bench.watcher.pause()["tick"]
    bench.see(f"document.querySelector('#bev-tick').textContent === 'tick {tick}'")
    whole = bench.page.evaluate(PIXELS)
    bench.page.uncheck("#channels [aria-label=road]")
    without_road = bench.page.evaluate(PIXELS)
    bench.page.check("#channels [aria-label=road]")
    assert without_road != whole
    assert bench.page.evaluate(PIXELS) == whole


def test_the_search_is_shown_by_iteration_and_a_click_forces_an_action(bench: Any) -> None:
    bench.page.select_option("#policy", "searcher")
    bench.watcher.until(policy="searcher")
    bench.page.click("#pause")
    tick = bench.watcher.pause()["tick"]  # a paused decision always has its landscape
    bench.see("document.querySelectorAll('[aria-label^=Iteration] button').length === 4")
    bench.page.hover("#energy", position={"x": 120, "y": 60})
    bench.see("/nats.* below the best/.test(document.querySelector('#energy-say').textContent)")
    box = bench.page.locator("#energy").bounding_box()
    width, height = box["width"] - 90, box["height"] - 40  # the plot, between its axes
    bench.page.click("#energy", position={"x": 44 + 0.25 * width, "y": 6 + 0.75 * height})
    bench.wait(lambda: bench.watcher.panel["tick"] == tick + 1, "the forced step")
    assert bench.watcher.pose["action"] == pytest.approx([-0.5, 0.5], abs=0.03)


def test_arrow_keys_and_enter_force_an_action_without_a_mouse(bench: Any) -> None:
    bench.page.click("#pause")
    panel = bench.watcher.pause()
    tick, (acceleration, steering) = panel["tick"], panel["action"]
    bench.see(f"document.querySelector('#energy-tick').textContent === 'tick {tick}'")
    bench.page.focus("#energy")
    for key in ("ArrowDown", "ArrowLeft", "Enter"):
        bench.page.keyboard.press(key)
    bench.wait(lambda: bench.watcher.panel["tick"] == tick + 1, "the forced step")
    wanted = [max(acceleration - 1 / 32, -1.0), min(steering + 1 / 32, 1.0)]
    assert bench.watcher.pose["action"] == pytest.approx(wanted, abs=1e-3)


def test_a_slow_link_gets_the_same_pictures_packed(bench: Any) -> None:
    bench.page.click("#pause")
    tick = bench.watcher.pause()["tick"]
    bench.page.check("#slow")
    bench.see("mjdrive.state().link === 'slow'")
    other = bench.open()
    assert other.evaluate("mjdrive.state().link") == "full"
    bench.page.keyboard.press(".")
    for page in (bench.page, other):
        page.wait_for_function(
            f"document.querySelector('#bev-tick').textContent === 'tick {tick + 1}'", polling=100
        )
    assert bench.page.evaluate(PIXELS) == other.evaluate(PIXELS)
    assert "link=slow" in bench.page.url
    other.goto(bench.page.url)
    other.wait_for_function("window.mjdrive?.state()?.link === 'slow'", polling=100)
    other.close()
    bench.page.uncheck("#slow")
    bench.see("mjdrive.state().link === 'full'")
    assert "link" not in bench.page.url


def test_a_drive_that_has_stopped_says_why(bench: Any) -> None:
    fault = "The policy asked for nothing."
    # In one go: what the server tells next would clear it.
    shown = bench.page.evaluate(
        f"(mjdrive.live.setState({{...mjdrive.state(), fault: {fault!r}}}), document.querySelector('#fault').innerText)",
    )
    assert shown == f"The drive has stopped. {fault}"
    bench.page.evaluate("mjdrive.live.setState(mjdrive.state())")
    assert not bench.page.is_visible("#fault")


def test_what_other_packages_bring_along_is_chosen_and_drives(bench: Any) -> None:
    assert bench.page.locator("#town option[value='example-town']").count() == 1
    for name in ("example-policy", "example-expert"):
        bench.page.select_option("#policy", name)
        bench.watcher.until(policy=name)
        before = bench.watcher.num_panels
        bench.wait(lambda before=before: bench.watcher.num_panels > before + 2, f"{name} to drive")
        assert bench.watcher.state["fault"] == ""
