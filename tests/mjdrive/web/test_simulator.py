"""Whatever fails, the simulator goes on and says so; and nothing that was driven by hand is lost."""

import logging
import threading
from collections.abc import Callable
from typing import Any

import pytest

from mjdrive.datatypes import Action
from mjdrive.episodes import dataset, store
from mjdrive.errors import DataError, PhysicsError, RouteError
from mjdrive.page import wire
from mjdrive.web import recording
from mjdrive.web.recording import LEAST_STEPS
from mjdrive.web.session import Session

STEPS = LEAST_STEPS + 2


def failing(error: Exception) -> Callable[..., Any]:
    def fail(*args: object, **kwargs: object) -> None:
        raise error

    return fail


@pytest.fixture(autouse=True)
def _tracebacks_are_expected(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.CRITICAL + 1, logger="mjdrive.web.cockpit")


def test_a_policy_that_raises_stops_the_drive_with_its_words_until_somebody_goes_on(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as broken:
        broken.setattr(desk.session.mind, "decide", failing(ZeroDivisionError("by zero")))
        desk.turn(3)
        assert desk.notebook.values["paused"]
        assert "ZeroDivisionError: by zero" in desk.notebook.values["fault"]
        assert sum("by zero" in line for line, _ in desk.notebook.lines) == 1
        desk.say("first", "pause", on=False)
        assert sum("by zero" in line for line, _ in desk.notebook.lines) == 2
    desk.say("first", "pause", on=False)
    assert desk.notebook.values["fault"] == ""
    before = desk.session.simulation.time
    desk.turn(2)
    assert desk.session.simulation.time > before


def test_a_person_drives_on_when_the_policy_raises(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(desk.session.mind, "decide", failing(ValueError("no idea")))
    monkeypatch.setattr("mjdrive.web.narrator.PANEL_INTERVAL", 0.0)  # however quick this machine is
    desk.say("first", "wheel", on=True)
    desk.turn(3)
    assert not desk.notebook.values["paused"]
    assert desk.session.recording is not None
    assert len(desk.session.recording) >= 3
    kinds = [message for kind, message in desk.notebook.told if kind == "panel"]
    assert wire.unpack(kinds[-1])[0]["action"] is None


def test_an_expert_who_finds_no_way_from_where_the_car_was_left_stops_the_drive(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    for let_go in (
        lambda: desk.say("first", "wheel", on=False),
        lambda: desk.leave("first"),
    ):
        desk.say("first", "wheel", on=True)
        with monkeypatch.context() as lost:
            lost.setattr(desk.session.mind, "take_over", failing(RouteError("No way from here.")))
            let_go()
        assert "No way from here." in desk.notebook.values["fault"]
        assert desk.notebook.values["paused"]
        assert desk.notebook.standing.driver is None
        desk.come("first")
        desk.say("first", "wheel", on=True)
        assert not desk.notebook.values["paused"]
        desk.say("first", "wheel", on=False)
        assert desk.notebook.values["fault"] == ""


def test_physics_that_blows_up_starts_the_drive_again_and_keeps_what_was_driven(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    with monkeypatch.context() as unstable:
        unstable.setattr(desk.session.simulation, "step", failing(PhysicsError("It flew away.")))
        desk.turn(1)
    assert desk.notebook.heard("It flew away. The drive starts again.")
    assert desk.session.simulation.time == 0.0
    assert len(desk.kept) == 1


@pytest.mark.parametrize("op", ["reset", "load", "wheel"])
def test_what_was_driven_is_kept_before_it_would_be_lost(desk: Any, op: str) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    if op == "wheel":
        desk.say("first", "wheel", on=False)
    desk.say("first", op, **{"load": {"seed": 1}, "wheel": {"on": True}}.get(op, {}))
    (path,) = desk.kept
    assert desk.notebook.heard(str(path))
    assert len(store.read(path).time) >= STEPS


def test_what_was_driven_is_kept_when_its_page_goes(desk: Any) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    desk.leave("first")
    assert len(desk.kept) == 1


def test_what_was_driven_is_kept_when_the_server_ends(session: Session, desk: Any) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    told: list[str] = []
    desk.simulator._tell_terminal = told.append
    desk.simulator.start()
    desk.simulator.stop()
    assert not any(it.name == "simulator" for it in threading.enumerate())
    assert [str(path) in line for path, line in zip(desk.kept, told, strict=True)] == [True]


def test_what_was_dropped_is_not_kept(desk: Any) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    desk.say("first", "drop")
    desk.say("first", "reset")
    assert desk.kept == []


def test_a_disk_that_fails_loses_nothing_and_keeps_the_drive_from_starting_again(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    before = desk.session.simulation.time
    with monkeypatch.context() as full:
        error = OSError(28, "No space left on device")
        full.setattr(recording, "write_atomically", failing(error))
        desk.say("first", "keep")
        assert desk.notebook.heard("No space left on device. It is still in memory")
        desk.say("first", "reset")
        assert desk.session.simulation.time > before
    desk.say("first", "keep")
    (path,) = desk.kept
    assert len(store.read(path).time) >= STEPS


def test_a_disk_that_is_nearly_full_lets_nobody_begin(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recording, "LEAST_FREE", 10**18)
    desk.say("first", "wheel", on=True)
    assert desk.notebook.heard("Make room")
    assert desk.notebook.standing.driver is None


def test_a_long_drive_is_kept_in_pieces(desk: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recording, "MOST_STEPS", STEPS)
    desk.say("first", "wheel", on=True)
    desk.turn(2 * STEPS - 4)
    assert [len(store.read(path).time) for path in desk.kept] == [STEPS]
    assert len(desk.session.recording) <= STEPS


def test_a_folder_that_holds_something_else_is_left_alone(desk: Any) -> None:
    other = desk.session.data / f"human-{desk.session.choice.town}"
    other.mkdir(parents=True)
    (other / dataset.MANIFEST).write_text('{"format": "mjdrive-dataset-9"}')
    desk.say("first", "wheel", on=True)
    desk.turn(STEPS)
    desk.say("first", "keep")
    (path,) = desk.kept
    assert path.parent.name == f"{other.name}-2"
    assert dataset.read_dataset(path.parent)[0].num_planned == 1
    assert [it.name for it in other.iterdir()] == [dataset.MANIFEST]


def test_a_file_that_the_manifest_does_not_know_is_not_written_over(session: Session) -> None:
    folder = session.data / f"human-{session.choice.town}"
    folder.mkdir(parents=True)
    (folder / "human-0000.hdf5").write_bytes(b"somebody's")
    session.begin_recording()
    for _ in range(STEPS):
        session.step(Action(0.1, 0.0), on_motion=lambda: None, by_hand=True)
    assert session.keep_recording().name == "human-0001.hdf5"
    assert (folder / "human-0000.hdf5").read_bytes() == b"somebody's"


def test_a_command_that_fails_costs_nothing_else(desk: Any) -> None:
    desk.say("first", "load", policy="nobody")
    assert desk.notebook.heard("Unknown policy 'nobody'")
    assert desk.notebook.values["fault"] == ""
    before = desk.session.simulation.time
    desk.turn(2)
    assert desk.session.simulation.time > before


def test_a_run_that_is_deleted_while_it_drives_goes_on_and_is_refused_afterwards(
    desk: Any,
) -> None:
    desk.session.mind = type(desk.session.mind)("pid")
    desk.session.choice = type(desk.session.choice)(desk.session.choice.town, "gone-run", 0)
    desk.session.mind.begin(desk.session.simulation, 0)
    desk.turn(2)
    desk.say("first", "reset")
    assert desk.notebook.values["policy"] == "gone-run"
    desk.say("first", "load", policy="pid")
    desk.say("first", "load", policy="gone-run")
    assert desk.notebook.heard("Unknown policy 'gone-run'")
    assert desk.notebook.values["policy"] == "pid"


def test_hardly_a_drive_is_refused_with_a_number(session: Session) -> None:
    session.begin_recording()
    with pytest.raises(DataError, match="0 steps"):
        session.keep_recording()
