"""Leaving the road, at the edges of the definition: the centre of the car beyond every lane."""

from collections.abc import Callable

import numpy as np
import pytest

from mjdrive.datatypes import Town, VehicleState
from mjdrive.simulation.rules import Rules
from mjdrive.vehicle.parameters import VehicleParameters

Judge = Callable[..., list[tuple[str, str]]]

EDGE = -4.0
"""Right edge of "west in" [m]."""

LEFT_WEST_IN = ("OFF_ROAD", "west in")


def wander(*beyond: float) -> list[tuple[float, float]]:
    """Eastward along "west in", 1 m a step, so far beyond its right edge [m]; negative is on the lane."""
    return [(-50.0 + step, EDGE - distance) for step, distance in enumerate(beyond)]


@pytest.mark.parametrize(
    ("poses", "count"),
    [
        pytest.param(wander(-2, -2, -2), 0, id="in the middle of the lane"),
        pytest.param(wander(-0.88, -0.88), 0, id="side of the car on the edge"),
        pytest.param(wander(-0.1, -0.1), 0, id="both right wheels on the shoulder"),
        pytest.param(wander(-1, 0.1, 0.1), 1, id="centre just beyond the edge"),
        pytest.param(wander(-1, *[3.0] * 30), 1, id="stays away"),
        pytest.param(wander(-1, 1, -1), 1, id="comes back"),
        pytest.param(wander(-1, 1, -1, 1, -1), 2, id="leaves and comes back twice"),
        pytest.param(wander(-1, *[0.1, -0.1] * 10), 1, id="weaves on the edge"),
        pytest.param(wander(-1, 1, -0.45, 1), 1, id="comes back by less than half a metre"),
        pytest.param(wander(-1, 1, -0.55, 1), 2, id="comes back by more than half a metre"),
        pytest.param(wander(0.5, 0.5), 1, id="begins beside the road"),
    ],
)
def test_wandering_over_the_edge(judge: Judge, poses: list, count: int) -> None:
    assert judge(poses) == [LEFT_WEST_IN] * count


def test_a_right_turn_along_its_lane_stays_on_the_road(judge: Judge) -> None:
    for radius in (6.2, 8.0, 9.8):  # about (-10, -10), of a lane that is 4 m wide around 8 m
        angles = np.radians(np.linspace(90, 0, 30))
        poses = [
            (-10 + radius * np.cos(a), -10 + radius * np.sin(a), a - np.pi / 2) for a in angles
        ]
        assert judge(poses, only="OFF_ROAD") == []


@pytest.mark.parametrize(
    ("start", "count"), [(8.6, 0), (8.2, 1)], ids=["inside its lane", "across the verge"]
)
def test_cutting_the_corner_of_a_right_turn(judge: Judge, start: float, count: int) -> None:
    # In a straight line between both streets, whose middle lies start / sqrt(2) from the middle of the turn; the
    # inner edge of the lane has a radius of 6 m.
    poses = [(-10 + start * s, -10 + start * (1 - s), -np.pi / 4) for s in np.linspace(0, 1, 60)]
    assert (start / np.sqrt(2) < 6.0) == bool(count)
    assert judge(poses, only="OFF_ROAD") == [("OFF_ROAD", "west right")] * count


def test_the_gaps_between_the_lanes_of_a_junction_are_road(crossroads: Town) -> None:
    rules = Rules(crossroads, VehicleParameters.default())
    for x in np.linspace(-9.5, 9.5, 20):
        for y in np.linspace(-4.0, 4.0, 20):
            assert rules.on_lane(VehicleState(x - 1.35, y, 0.0, 0.0, 0.0, 0.0)), (x, y)


@pytest.mark.parametrize(
    ("point", "lane"),
    [((-30.0, -4.2), "west in"), ((-30.0, 4.2), "west out"), ((4.2, -30.0), "south in")],
    ids=["right", "left", "another street"],
)
def test_the_lane_that_was_left_is_named(judge: Judge, point: tuple, lane: str) -> None:
    x, y = point
    assert judge([(0.98 * x, 0.9 * y), (x, y)] if abs(y) < 5 else [(0.9 * x, y), (x, y)]) == [
        ("OFF_ROAD", lane)
    ]


def test_far_from_every_lane_no_lane_was_left(judge: Judge) -> None:
    assert judge([(500.0, 500.0)]) == [("OFF_ROAD", "")]


def test_the_margin_is_a_setting(judge: Judge) -> None:
    assert len(judge(wander(-1, 1, -0.1, 1), back_on_road=0.0)) == 2
