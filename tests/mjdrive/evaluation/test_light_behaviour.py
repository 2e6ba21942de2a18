"""A straight street of 200 m with a light at 100 m, and drives that are drawn by hand."""

import numpy as np
import pytest

from mjdrive.datatypes import Episode, Lane, Route, Signal, Town, TrafficLight
from mjdrive.evaluation.light_behaviour import LightPassage, is_rash, light_passages
from mjdrive.town.route_line import lay

LINE = 100.0
NOSE = 3.0
PROGRAM = ((Signal.GREEN, 10.0), (Signal.YELLOW, 3.0), (Signal.RED, 17.0))
LIGHT = TrafficLight(
    "light",
    "approach",
    "j",
    np.array([[LINE, 2.0], [LINE, -2.0]]),
    0.0,
    np.zeros(2),
    PROGRAM,
    0.0,
)
LANES = {
    "approach": Lane(
        "approach", np.array([[0, 0], [LINE, 0]], float), 4.0, ("rest",), None, "light"
    ),
    "rest": Lane("rest", np.array([[LINE, 0], [200, 0]], float), 4.0, (), "j", None),
}
TOWN = Town("street", LANES, {"light": LIGHT}, np.array([0.0, -2.0, 200.0, 2.0]), "")


def route_from(x: float) -> Route:
    """The street from a place on."""
    return lay(TOWN, ("approach", "rest"), start=x, end=200.0 - LINE)


def drive(x: np.ndarray, *, start: float) -> tuple[LightPassage, ...]:
    """Judge a drive of ten rear axles a second that begins so long after green begins [s]."""
    vehicle = np.zeros((len(x), 6))
    vehicle[:, 0], vehicle[:, 3] = x, np.gradient(x, 0.1)
    episode = Episode(
        town="street",
        policy="p",
        seed=0,
        light_phase=start,
        time=0.1 * np.arange(len(x)),
        physics=np.zeros((len(x), 1)),
        vehicle=vehicle,
        actions=np.zeros((len(x), 2)),
        labels=np.zeros((len(x), 2)),
        on_lane=np.ones(len(x), bool),
        infractions=(),
        metadata={},
    )
    return light_passages(episode, TOWN, route_from(float(x[0])), nose_ahead=NOSE)


def at_speed(speed: float, *, to_line: float, steps: int = 60) -> np.ndarray:
    """Positions at constant speed whose nose is so far before the line at first."""
    return LINE - NOSE - to_line + 0.1 * speed * np.arange(steps)


def test_green_all_the_way_asks_for_nothing() -> None:
    (passage,) = drive(at_speed(6.0, to_line=10.0), start=2.0)
    assert passage.station == pytest.approx(10.0 + NOSE)
    assert (passage.shown, passage.braking_needed, passage.start_delay) == (
        Signal.GREEN,
        None,
        None,
    )
    assert not is_rash(passage, late_braking=5.0)


@pytest.mark.parametrize(("to_line", "rash"), [(3.0, False), (8.0, True)])
def test_yellow_that_left_room_to_stop_is_rash(to_line: float, rash: bool) -> None:
    # The light turns yellow in the first step.
    (passage,) = drive(at_speed(6.0, to_line=to_line + 0.6), start=9.95)
    assert passage.shown is Signal.YELLOW
    assert passage.braking_needed == pytest.approx(36.0 / (2 * to_line), rel=1e-6)
    assert is_rash(passage, late_braking=5.0) is rash


def test_yellow_that_came_with_the_line_left_no_room_to_stop() -> None:
    # Green at the step before the nose comes over, yellow at the first step beyond.
    (passage,) = drive(at_speed(6.0, to_line=5.7), start=9.0)
    assert (passage.shown, passage.braking_needed) == (Signal.YELLOW, np.inf)
    assert not is_rash(passage, late_braking=5.0)


def test_red_is_rash_however_late_it_came() -> None:
    (passage,) = drive(at_speed(6.0, to_line=3.0), start=14.0)
    assert (passage.shown, passage.braking_needed) == (Signal.RED, None)
    assert is_rash(passage, late_braking=0.0)


def test_start_is_timed_from_the_last_step_that_was_not_green() -> None:
    waits = np.full(20, LINE - NOSE - 1.0)  # green comes between steps 9 and 10
    moves = waits[-1] + 0.5 * np.arange(1, 60)
    (passage,) = drive(np.concatenate([waits, moves]), start=29.05)
    assert passage.start_delay == pytest.approx(0.1 * (19 - 9), abs=0.01)
    assert passage.shown is Signal.GREEN


def test_line_that_is_never_reached_is_not_judged() -> None:
    assert drive(at_speed(1.0, to_line=50.0), start=0.0) == ()
