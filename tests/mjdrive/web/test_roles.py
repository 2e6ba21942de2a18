"""One page is in control; it hands over, goes, or fails to answer, and then another one is."""

from typing import Any

import pytest

from mjdrive.web.roles import ANSWERS_WITHIN, Roles


class Clock:
    """A clock that stands still until it is moved."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def roles() -> Roles:
    found = Roles(Clock())
    for who in ("a", "b", "c"):
        found.come(who)
    return found


def test_the_first_who_comes_is_in_control(roles: Roles) -> None:
    assert roles.operator == "a"


def test_control_goes_to_the_next_when_its_page_goes(roles: Roles) -> None:
    roles.leave("a")
    assert roles.operator == "b"
    roles.leave("c")
    roles.leave("b")
    assert roles.operator is None
    roles.come("d")
    assert roles.operator == "d"


def test_who_asked_first_is_served_first(roles: Roles) -> None:
    roles.ask("c")
    roles.ask("b")
    roles.ask("c")
    assert roles.asking == ("c", "b")
    roles.take_back("a")
    assert (roles.operator, roles.asking) == ("c", ())
    roles.take_back("c")
    assert roles.operator == "b"  # who has watched longest


def test_who_asked_and_went_or_thought_better_of_it_gets_nothing(roles: Roles) -> None:
    roles.ask("c")
    roles.ask("b")
    roles.leave("c")
    assert roles.asking == ("b",)
    roles.take_back("b")
    assert roles.asking == ()


def test_the_operator_may_keep_control(roles: Roles) -> None:
    roles.ask("b")
    roles.ask("a")
    assert (roles.operator, roles.asking) == ("a", ())


def test_alone_nobody_can_hand_over() -> None:
    roles = Roles(Clock())
    roles.come("a")
    roles.take_back("a")
    assert roles.operator == "a"


def test_who_does_not_answer_is_known_by_the_first_question() -> None:
    clock = Clock()
    roles = Roles(clock)
    for who in ("a", "b", "c"):
        roles.come(who)
    roles.ask("b")
    clock.now += 0.6 * ANSWERS_WITHIN
    roles.ask("c")
    assert not roles.is_unanswered
    clock.now += 0.6 * ANSWERS_WITHIN
    assert roles.is_unanswered
    roles.hand_over()
    assert (roles.operator, roles.is_unanswered) == ("b", False)


def test_strangers_get_no_control(roles: Roles) -> None:
    roles.ask("nobody")
    roles.leave("nobody")
    assert (roles.operator, roles.asking) == ("a", ())


def test_commands_of_watchers_are_answered_and_not_obeyed(desk: Any) -> None:
    desk.come("second")
    for op, values in {"pause": {"on": True}, "reset": {}, "wheel": {"on": True}}.items():
        desk.say("second", op, **values)
    assert desk.notebook.heard("Another page is in control", by="second")
    assert not desk.notebook.values["paused"]
    assert desk.notebook.standing == ("first", (), None)


def test_a_watcher_asks_and_is_handed_control_and_what_was_driven_is_kept(desk: Any) -> None:
    desk.come("second")
    desk.say("first", "wheel", on=True)
    desk.turn(12)
    desk.say("second", "control", on=True)
    assert desk.notebook.standing == ("first", ("second",), "first")
    desk.say("first", "control", on=False)
    assert desk.notebook.standing == ("second", (), None)
    assert len(desk.kept) == 1
    assert desk.notebook.heard("You are in control now", by="second")
    desk.say("second", "wheel", on=True)
    assert desk.notebook.standing.driver == "second"


def test_a_watcher_who_is_turned_down_hears_of_it(desk: Any) -> None:
    desk.come("second")
    desk.say("second", "control", on=True)
    desk.say("first", "control", on=True)
    assert desk.notebook.heard("keeps it", by="second")
    assert desk.notebook.standing == ("first", (), None)


def test_a_page_left_open_does_not_keep_the_others_out(
    desk: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.come("second")
    desk.say("first", "wheel", on=True)
    desk.say("second", "control", on=True)
    monkeypatch.setattr("mjdrive.web.roles.ANSWERS_WITHIN", -1.0)
    desk.turn(1)
    assert desk.notebook.standing == ("second", (), None)


def test_a_watcher_who_goes_changes_nothing(desk: Any) -> None:
    desk.come("second")
    desk.say("first", "wheel", on=True)
    desk.leave("second")
    assert desk.notebook.standing == ("first", (), "first")
