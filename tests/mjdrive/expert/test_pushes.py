"""A push is seen in the wheels, and lasts until the car is back on its line."""

import numpy as np
import pytest

from mjdrive.datatypes import Action, Lane, Situation, Town, VehicleState
from mjdrive.expert.pushes import PUSHED, RECOVERED_HEADING, RECOVERED_OFFSET, PushWatch
from mjdrive.town.route_line import lay

LANE = Lane("lane", np.array([[0.0, 0.0], [100.0, 0.0]]), 4.0, (), None, None)
TOWN = Town("plain", {"lane": LANE}, {}, np.array([0.0, -2.0, 100.0, 2.0]), "")
ROUTE = lay(TOWN, ("lane",), start=0.0, end=100.0)
FULL_LOCK = 0.6
LAST = Action(acceleration=0.0, steering=0.5)


def at(*, offset: float = 0.0, yaw: float = 0.0, wheels: float) -> Situation:
    state = VehicleState(20.0, offset, yaw, 5.0, 0.0, wheels)
    return Situation(0.0, state, ROUTE, 20.0, offset, {})


@pytest.fixture
def watch() -> PushWatch:
    return PushWatch(FULL_LOCK)


def test_wheels_that_follow_their_command_are_no_push(watch: PushWatch) -> None:
    late = at(offset=2.0, wheels=0.5 * FULL_LOCK - 0.9 * PUSHED)
    assert not watch.look(late, LAST, follows_plan=True)


@pytest.mark.parametrize(("last", "follows_plan"), [(None, True), (LAST, False)])
def test_who_commanded_nothing_or_followed_no_plan_was_not_pushed(
    watch: PushWatch, last: Action | None, follows_plan: bool
) -> None:
    assert not watch.look(at(wheels=0.0), last, follows_plan=follows_plan)


@pytest.mark.parametrize(
    "astray",
    [{"offset": 1.1 * RECOVERED_OFFSET}, {"yaw": 1.1 * RECOVERED_HEADING}],
    ids=["beside its line", "across it"],
)
def test_a_pushed_car_recovers_until_it_is_back(watch: PushWatch, astray: dict[str, float]) -> None:
    still = 0.5 * FULL_LOCK
    assert watch.look(at(wheels=still - 1.1 * PUSHED), LAST, follows_plan=True)
    assert watch.look(at(wheels=still, **astray), LAST, follows_plan=False)
    assert not watch.look(at(wheels=still), LAST, follows_plan=False)
    assert not watch.look(at(wheels=still, **astray), LAST, follows_plan=False)


def test_a_new_drive_knows_of_no_push(watch: PushWatch) -> None:
    assert watch.look(at(wheels=0.0), LAST, follows_plan=True)
    watch.forget()
    beside = at(offset=1.1 * RECOVERED_OFFSET, wheels=0.5 * FULL_LOCK)
    assert not watch.look(beside, LAST, follows_plan=False)
