import pytest

from mjdrive.datatypes import Action
from mjdrive.expert.handover import HANDOVER_TIME, Handover

PLANNED, OWN = Action(acceleration=-0.6, steering=0.3), Action(acceleration=0.2, steering=-0.1)


def test_stand_in_begins_where_the_other_was_and_ends_with_its_own_action():
    interval = 1e-3
    handover = Handover(interval)
    handover.watch(PLANNED, OWN)
    first = handover.take_over(OWN)
    assert (first.acceleration, first.steering) == pytest.approx((-0.6, 0.3), abs=0.01)
    for _ in range(round(8 * HANDOVER_TIME / interval)):
        last = handover.take_over(OWN)
    assert (last.acceleration, last.steering) == pytest.approx((0.2, -0.1), abs=1e-3)


def test_stand_in_that_was_forgotten_to_watch_acts_as_it_is():
    handover = Handover(0.1)
    handover.watch(PLANNED, OWN)
    handover.forget()
    assert handover.take_over(OWN) == OWN
