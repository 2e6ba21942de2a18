"""What is told of a decision belongs to it, and what costs nothing is told however late the simulation is."""

from typing import Any

import numpy as np
import pytest

from mjdrive.page import wire
from mjdrive.web.policies import Density
from mjdrive.web.session import LATEST_ROWS


@pytest.fixture(autouse=True)
def _every_decision_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mjdrive.web.narrator.PANEL_INTERVAL", 0.0)  # however quick this machine is


def told(desk: Any, kind: str) -> list[tuple[dict[str, Any], dict[str, np.ndarray]]]:
    return [wire.unpack(message) for name, message in desk.notebook.told if name == kind]


def test_panels_tell_the_same_steps_as_the_history(desk: Any) -> None:
    desk.turn(5)
    desk.say("first", "wheel", on=True)
    for seq in range(1, 6):
        desk.say("first", "keys", down=frozenset({"up", "left"}), seq=seq)
    desk.say("first", "pause", on=True)
    desk.say("first", "force", acceleration=0.5, steering=-0.5)
    desk.say("first", "watch")
    history = told(desk, "history")[-1][1]["rows"]
    panels = told(desk, "panel")
    assert panels[-1][0]["tick"] == len(history) > 10
    for head, blobs in panels:
        tick = head["tick"]
        np.testing.assert_array_equal(blobs["rows"], history[max(0, tick - LATEST_ROWS) : tick])
        if tick < len(history):
            now = [head["t"], head["speed"], *(head["driven"] or history[tick, 4:])]
            np.testing.assert_allclose(now, history[tick, [0, 3, 4, 5]], atol=1e-3)
    assert history[-1, 4:].tolist() == [0.5, -0.5]


def test_what_is_done_is_told_with_the_decision_and_is_open_while_paused(desk: Any) -> None:
    desk.turn(2)
    head = told(desk, "panel")[-1][0]
    assert head["driven"] == head["action"] is not None
    desk.say("first", "pause", on=True)
    paused = told(desk, "panel")[-1][0]
    assert paused["tick"] == head["tick"] + 1
    assert (paused["driven"], paused["action"] is None) == (None, False)


def test_a_reset_while_paused_shows_the_car_where_it_begins(desk: Any) -> None:
    desk.turn(3)
    desk.say("first", "pause", on=True)
    desk.say("first", "reset")
    assert told(desk, "pose")[-1][0]["t"] == told(desk, "panel")[-1][0]["t"] == 0.0


class Asked:
    """Counts how often the network is asked."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, mind: object, *, is_grid: bool) -> None:
        self.count = 0
        self._density = Density(np.zeros((2, 2), np.uint8), -1.0, 0.0)
        monkeypatch.setattr(mind, "chosen_from", lambda: self._density if is_grid else None)
        monkeypatch.setattr(mind, "density", self._answer)

    def _answer(self, observation: object) -> Density:
        del observation
        self.count += 1
        return self._density


def test_a_late_simulation_still_tells_the_landscape_that_was_chosen_from(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Asked(monkeypatch, desk.session.mind, is_grid=True)
    monkeypatch.setattr(type(desk.pace), "is_late", property(lambda self: True))
    desk.turn(3)
    assert all("density" in blobs for _, blobs in told(desk, "panel")[-3:])
    assert asked.count == 0


def test_a_late_simulation_leaves_out_what_has_to_be_asked_until_it_is_paused(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = Asked(monkeypatch, desk.session.mind, is_grid=False)
    monkeypatch.setattr(type(desk.pace), "is_late", property(lambda self: True))
    desk.turn(3)
    assert not any("density" in blobs for _, blobs in told(desk, "panel")[-3:])
    desk.say("first", "pause", on=True)
    desk.say("first", "watch")
    assert "density" in told(desk, "panel")[-1][1]
    assert asked.count == 1


def test_what_is_forced_while_a_person_holds_the_wheel_is_a_part_of_what_they_drive(
    desk: Any,
) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(5)
    desk.say("first", "pause", on=True)
    for _ in range(3):
        desk.say("first", "force", acceleration=0.25, steering=0.75)
    desk.say("first", "pause", on=False)
    desk.turn(5)
    episode = desk.session.recording.episode()
    interval = desk.session.simulation.config.control_interval
    np.testing.assert_allclose(np.diff(episode.time), interval)
    assert episode.actions.tolist().count([0.25, 0.75]) == 3
