"""Driving the wrong way, at the edges of the definition: heading more than 120 degrees against every lane underneath."""

import math
from collections.abc import Callable

import numpy as np
import pytest

Judge = Callable[..., list[tuple[str, str]]]
Poses = list[tuple[float, ...]]

AGAINST_WEST_OUT = ("WRONG_WAY", "west out")
FITS: list[tuple[str, str]] = []


def east(
    start: float, end: float, *, y: float = 2.0, yaw_deg: float = 0.0, step: float = 0.25
) -> Poses:
    """From one x to a larger one, by default on "west out", which leads west."""
    return [(x, y, math.radians(yaw_deg)) for x in np.arange(start, end + 1e-9, step)]


def u_turn(x: float, *, radius: float = 2.0) -> Poses:
    """From "west in" to "west out" on the spot that a car needs."""
    angles = np.linspace(0.0, math.pi, 40)
    return [(x + radius * math.sin(a), -radius * math.cos(a), a) for a in angles]


def spin(x: float, y: float, *, turns: float) -> Poses:
    """About the rear axle, 1.35 m behind the centre."""
    angles = np.arange(0.0, 2 * math.pi * turns, 0.1)
    return [(x + 1.35 * math.cos(a), y + 1.35 * math.sin(a), a) for a in angles]


@pytest.mark.parametrize(
    ("poses", "expected"),
    [
        pytest.param(east(-50, -20, y=-2.0), FITS, id="own lane"),
        pytest.param(east(-50, -32), [AGAINST_WEST_OUT], id="opposite lane, 3 s at 6 m per s"),
        pytest.param(east(-50, -11), [AGAINST_WEST_OUT], id="opposite lane, all the street"),
        pytest.param(east(-50, -45.25), FITS, id="4.75 m on the opposite lane"),
        pytest.param(east(-50, -44.75), [AGAINST_WEST_OUT], id="5.25 m on the opposite lane"),
        pytest.param(
            [*east(-58, -50, y=-2.0), *east(-50, -47), *east(-47, -40, y=-2.0)],
            FITS,
            id="3 m on the opposite lane, to pass something",
        ),
        pytest.param(
            [*east(-58, -50, y=-2.0), *east(-50, -30), *east(-30, -20, y=-2.0)],
            [AGAINST_WEST_OUT],
            id="overtakes 20 m",
        ),
        pytest.param(
            [*east(-58, -48), *east(-48, -40, y=-2.0), *east(-40, -30)],
            [AGAINST_WEST_OUT] * 2,
            id="opposite lane twice",
        ),
        pytest.param(
            [*east(-58, -48), *east(-48, -44, y=-2.0), *east(-44, -30)],
            [AGAINST_WEST_OUT],
            id="back for 4 m only",
        ),
        pytest.param(
            [*east(-58, -55), *east(-55, -52, y=-2.0), *east(-52, -49)],
            FITS,
            id="3 m twice do not add up",
        ),
        pytest.param(
            [*east(-58, -50), *[(-50.0, 2.0, 0.0)] * 300, *east(-50, -42)],
            [AGAINST_WEST_OUT],
            id="halts on the way",
        ),
        pytest.param([(-30.0, 2.0, 0.0)] * 600, FITS, id="stands against it for 60 s"),
        pytest.param(
            [(x, -2.0, 0.0, -3.0) for x in np.arange(-20, -40, -0.25)], FITS, id="reverses"
        ),
        pytest.param(east(-50, -30, y=-2.0, yaw_deg=119.0), FITS, id="slides at 119 degrees"),
        pytest.param(
            east(-50, -30, y=-2.0, yaw_deg=121.0),
            [("WRONG_WAY", "west in")],
            id="slides at 121 degrees",
        ),
        pytest.param(u_turn(-30), FITS, id="U-turn on a street"),
        pytest.param(u_turn(-2), FITS, id="U-turn in a junction"),
        pytest.param(spin(-30, -2, turns=5), FITS, id="spins on the spot"),
        pytest.param(east(-50, -30, y=0.0), FITS, id="on the line between both lanes"),
    ],
)
def test_driving_against_a_lane(judge: Judge, poses: Poses, expected: list) -> None:
    assert judge(poses, only="WRONG_WAY") == expected


def test_metres_off_the_road_neither_count_nor_end_it(judge: Judge) -> None:
    around = [*east(-58, -55), *east(-55, -40, y=7.0), *east(-40, -37)]
    assert judge(around, only="WRONG_WAY") == [AGAINST_WEST_OUT]
    assert judge([*around, *east(-37, -34, y=7.0), *east(-34, -20)], only="WRONG_WAY") == [
        AGAINST_WEST_OUT
    ]


def test_in_a_junction_one_lane_that_fits_is_enough(judge: Judge) -> None:
    # From "west in" left to the north, along y = 2 m for a while, against "east straight" but with "south right".
    diagonal = [(x, x + 4.0, math.pi / 4) for x in np.arange(-6.0, 2.0, 0.25)]
    assert judge(diagonal, only="WRONG_WAY") == FITS


def test_the_next_street_on_the_wrong_side_counts_anew(judge: Judge) -> None:
    # In between, the lanes of the cross street fit for 8 m: they are 90 degrees off.
    expected = [AGAINST_WEST_OUT, ("WRONG_WAY", "east straight")]
    assert judge(east(-50, 50), only="WRONG_WAY") == expected


@pytest.mark.parametrize("distance", [2.0, 10.0])
def test_the_distance_is_a_setting(judge: Judge, distance: float) -> None:
    for driven, count in ((distance - 0.25, 0), (distance + 0.25, 1)):
        poses = east(-50, -50 + driven)
        assert len(judge(poses, only="WRONG_WAY", wrong_way_distance=distance)) == count
