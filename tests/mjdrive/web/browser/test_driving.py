"""Driving by hand: what is held drives, however busy the browser is, and nothing drives when it is let go."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mjdrive.episodes import store

pytestmark = pytest.mark.timeout(900)

BLOCK = "ms => { const end = performance.now() + ms; while (performance.now() < end); }"
PAD = """
window.pad = { connected: true, mapping: "standard", axes: [0, 0, 0, 0],
               buttons: Array.from({ length: 17 }, () => ({ value: 0, pressed: false })) };
navigator.getGamepads = () => [window.pad];
"""


def demonstrations(bench: Any) -> list[Path]:
    return sorted((bench.folder / "data" / "human-town03").glob("*.hdf5"))


def test_holding_up_speeds_up_and_shift_stops(bench: Any) -> None:
    bench.take_the_wheel()
    bench.page.keyboard.down("ArrowUp")
    bench.wait(lambda: bench.watcher.pose["action"][0] == 1.0, "full throttle")
    start = bench.watcher.pose["speed"]
    bench.wait(lambda: bench.watcher.pose["speed"] > start + 1.0, "a higher speed")
    bench.page.keyboard.up("ArrowUp")
    bench.page.keyboard.down("Shift")
    bench.wait(lambda: abs(bench.watcher.pose["speed"]) < 0.1, "a stop")
    bench.page.keyboard.up("Shift")


def test_two_keys_are_held_at_once(bench: Any) -> None:
    bench.take_the_wheel()
    for key in ("KeyW", "KeyA"):
        bench.page.keyboard.down(key)
    bench.wait(lambda: bench.watcher.pose["action"] == [1.0, 1.0], "throttle and left")
    for key in ("KeyW", "KeyA"):
        bench.page.keyboard.up(key)
    bench.wait(lambda: bench.watcher.pose["action"] == [0.0, 0.0], "nothing")


def test_a_busy_page_does_not_chop_what_is_held(bench: Any) -> None:
    bench.take_the_wheel()
    before = demonstrations(bench)
    bench.page.keyboard.down("ArrowUp")
    bench.wait(lambda: bench.watcher.pose["action"][0] == 1.0, "full throttle")
    enough = bench.watcher.state["recorded"] + 30
    for _ in range(3):
        bench.page.evaluate(BLOCK, 1200)  # more than twice what the server waits for
    while bench.watcher.state["recorded"] < enough:
        bench.page.evaluate(BLOCK, 1200)
    bench.page.keyboard.up("ArrowUp")
    bench.page.keyboard.press("t")
    bench.watcher.until(driver=0)
    bench.page.click("#keep")
    (kept,) = bench.wait(lambda: set(demonstrations(bench)) - set(before), "the recording")
    throttle = store.read(kept).actions[:, 0]
    full = np.flatnonzero(throttle == 1.0)
    assert len(full) > 30
    assert np.all(throttle[full[0] : full[-1] + 1] == 1.0)


def test_a_page_that_hangs_lets_go(bench: Any) -> None:
    bench.take_the_wheel()
    bench.page.keyboard.down("ArrowUp")
    bench.wait(lambda: bench.watcher.pose["action"][0] == 1.0, "full throttle")
    bench.page.evaluate(f"() => {{ setTimeout(() => ({BLOCK})(6000)); }}")
    bench.wait(lambda: bench.watcher.pose["action"][0] == 0.0, "the pedal to come up")
    bench.page.keyboard.up("ArrowUp")


def test_losing_the_focus_gives_the_wheel_back(bench: Any) -> None:
    bench.take_the_wheel()
    bench.page.keyboard.down("ArrowUp")
    bench.wait(lambda: bench.watcher.pose["action"][0] == 1.0, "full throttle")
    bench.page.evaluate("dispatchEvent(new Event('blur'))")
    bench.watcher.until(driver=0)
    bench.page.keyboard.up("ArrowUp")
    bench.see("document.querySelector('#badge').textContent.startsWith('pid drives')")


def test_what_is_driven_is_kept_as_a_demonstration(bench: Any) -> None:
    bench.take_the_wheel()
    before = demonstrations(bench)
    bench.page.keyboard.down("ArrowUp")
    bench.wait(lambda: bench.watcher.state["recorded"] > 15, "some steps")
    bench.page.keyboard.up("ArrowUp")
    bench.page.keyboard.press("Enter")
    (kept,) = bench.wait(lambda: set(demonstrations(bench)) - set(before), "the file")
    episode = store.read(kept)
    assert episode.metadata["source"] == "human"
    assert len(episode.time) > 15


def test_what_is_dropped_leaves_nothing(bench: Any) -> None:
    bench.take_the_wheel()
    before = demonstrations(bench)
    # So many that a busy machine has seconds to see that there are fewer.
    bench.wait(lambda: bench.watcher.state["recorded"] > 40, "some steps")
    bench.page.keyboard.press("Delete")
    bench.wait(lambda: bench.watcher.state["recorded"] < 40, "the recording to begin anew")
    assert demonstrations(bench) == before


def test_a_gamepad_drives(bench: Any) -> None:
    bench.page.evaluate(PAD)
    bench.take_the_wheel()
    bench.page.evaluate("pad.axes[0] = 0.5; pad.buttons[7].value = 0.75")
    bench.wait(lambda: bench.watcher.pose["action"] == [0.75, -0.5], "the stick and the trigger")
    bench.page.evaluate("pad.axes[0] = 0; pad.buttons[7].value = 0; pad.connected = false")


def test_another_page_watches_until_it_is_given_control(bench: Any) -> None:
    mine = bench.page.evaluate("mjdrive.state().you")
    other = bench.open("tab=runs")
    theirs = other.evaluate("mjdrive.state().you")
    assert bench.watcher.state["operator"] == mine
    assert other.evaluate(
        "[...document.querySelectorAll('#controls button')].every(it => it.disabled)"
    )
    other.click("#roles button:has-text('Ask for control')")
    bench.page.click("#roles button:has-text('Hand over')")
    bench.watcher.until(operator=theirs)
    other.wait_for_function("!document.querySelector('#wheel').disabled", polling=100)
    bench.page.click("#roles button:has-text('Ask for control')")
    other.click("#roles button:has-text('Hand over')")
    bench.watcher.until(operator=mine)
    other.close()
