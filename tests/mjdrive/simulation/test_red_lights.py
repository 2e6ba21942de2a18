"""Red lights, at the edges of the definition: the tail of the car on the watched part of a stop line."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from mjdrive.config import RulesConfig
from mjdrive.datatypes import Signal, Town
from mjdrive.vehicle.parameters import VehicleParameters

Judge = Callable[..., list[tuple[str, str]]]
Poses = list[tuple[float, ...]]

LINE = -10.0
"""The stop line of "west in" lies at this x [m]."""

HALF = VehicleParameters.default().length / 2
BEGIN, END = 0.8 * HALF, HALF + 1.0
"""A car is guilty while its centre is between these distances past the line [m]."""

WEST, SOUTH = ("RED_LIGHT", "west in"), ("RED_LIGHT", "south in")
NOT_GUILTY: list[tuple[str, str]] = []


def along(start: float, end: float, *, y: float = -2.0, step: float = 0.5) -> Poses:
    """Eastward from one distance past the line to another; backwards if the second is smaller."""
    signed = step if end > start else -step
    return [(LINE + past, y) for past in np.arange(start, end, signed)]


def from_south(poses: Poses) -> Poses:
    """The same poses on the street from the south, which is that from the west turned left."""
    return [(-y, x, np.pi / 2) for x, y in poses]


def turning(*, to_the_left: bool) -> Poses:
    """Through the junction from "west in" along the middle of a turning lane, and out of it."""
    angles = np.radians(np.linspace(0, 90, 40))
    if to_the_left:
        arc = [(-10 + 12 * np.sin(a), 10 - 12 * np.cos(a), a) for a in angles]
        away = [(2.0, y, np.pi / 2) for y in np.arange(10, 25, 0.5)]
    else:
        arc = [(-10 + 8 * np.sin(a), -10 + 8 * np.cos(a), -a) for a in angles]
        away = [(-2.0, y, -np.pi / 2) for y in np.arange(-10, -25, -0.5)]
    return [*((x, y, 0.0) for x, y in along(-20, 0)), *arc, *away]


def test_limits_of_the_car_are_those_of_the_docs() -> None:
    # For the Lincoln MKZ of the Leaderboard they are 1.96 m and 3.45 m.
    assert pytest.approx((1.76, 3.20)) == (BEGIN, END)


@pytest.mark.parametrize(
    ("past", "expected"),
    [
        pytest.param(-HALF - 0.1, NOT_GUILTY, id="nose before the line"),
        pytest.param(-HALF + 0.5, NOT_GUILTY, id="nose over it, centre behind"),
        pytest.param(0.0, NOT_GUILTY, id="centre on it"),
        pytest.param(1.0, NOT_GUILTY, id="centre 1 m past it"),
        pytest.param(BEGIN - 0.01, NOT_GUILTY, id="1 cm before guilt begins"),
        pytest.param(BEGIN + 0.01, [WEST], id="1 cm after guilt begins"),
        pytest.param(1.9, [WEST], id="1.9 m past it"),
        pytest.param(2.1, [WEST], id="2.1 m past it"),
        pytest.param(END - 0.01, [WEST], id="1 cm before guilt ends"),
        pytest.param(END + 0.01, NOT_GUILTY, id="1 cm after guilt ends"),
    ],
)
def test_place_of_a_standing_car(judge: Judge, past: float, expected: list) -> None:
    assert judge([(LINE + past, -2.0)] * 3) == expected


@pytest.mark.parametrize(
    ("poses", "expected"),
    [
        pytest.param(along(-20, 10), [WEST], id="straight over it"),
        pytest.param(along(-2, 5, step=0.02), [WEST], id="at a crawl"),
        pytest.param(along(-20, 1), NOT_GUILTY, id="stops with the nose over it"),
        pytest.param(
            [*along(-20, 1), *along(1, -5), *along(-5, 1)], NOT_GUILTY, id="nose over it twice"
        ),
        pytest.param(along(-20, 10) * 2, [WEST], id="same light twice"),
        pytest.param(
            [*along(-20, 10), *from_south(along(-20, 10)), *along(-20, 10)],
            [WEST, SOUTH, WEST],
            id="same light again after another",
        ),
        pytest.param(
            [*along(-20, 4), *along(4, -8), *along(-8, 10)], [WEST], id="rolls back and on again"
        ),
        pytest.param(along(8, -8), [WEST], id="reverses over it"),
        pytest.param(
            [(x, -2 + 0.3 * (x - LINE - 2), 0.3) for x in np.arange(-16.0, 0.0, 0.5)],
            [WEST],
            id="diagonally",
        ),
        pytest.param(
            [(LINE + 2.5 * np.cos(1.6), y, 1.6) for y in np.arange(-5, 3, 0.2)],
            NOT_GUILTY,
            id="across the street on the line",
        ),
        pytest.param(
            [(x, -2.0, np.pi) for x in np.arange(0, -25, -0.5)], NOT_GUILTY, id="oncoming"
        ),
        pytest.param(along(-20, 10, y=2.0), NOT_GUILTY, id="in the lane beside it"),
        pytest.param(along(-20, 10, y=-0.45), [WEST], id="1.55 m left of the middle"),
        pytest.param(along(-20, 10, y=-0.35), NOT_GUILTY, id="1.65 m left of the middle"),
        pytest.param(along(-20, 10, y=-3.55), [WEST], id="1.55 m right of the middle"),
        pytest.param(along(-20, 10, y=-3.65), NOT_GUILTY, id="1.65 m right of the middle"),
    ],
)
def test_crossing_while_all_lights_are_red(judge: Judge, poses: Poses, expected: list) -> None:
    assert judge(poses, only="RED_LIGHT") == expected


@pytest.mark.parametrize("signal", [Signal.GREEN, Signal.YELLOW], ids=["green", "yellow"])
def test_green_and_yellow_may_be_crossed(judge: Judge, signal: Signal) -> None:
    assert judge(along(-20, 10), lights={"west in": signal}) == NOT_GUILTY


@pytest.mark.parametrize("to_the_left", [True, False], ids=["left", "right"])
def test_turning_on_green_into_a_red_cross_street_is_right(judge: Judge, to_the_left: bool) -> None:
    poses = turning(to_the_left=to_the_left)
    assert judge(poses, lights={"west in": Signal.GREEN}) == NOT_GUILTY
    assert judge(poses) == [WEST]


@pytest.mark.parametrize(
    ("past", "expected"),
    [(1.0, [WEST]), (BEGIN + 0.5, [WEST]), (END + 0.2, NOT_GUILTY)],
    ids=["centre past the line", "tail on the line", "tail past the line"],
)
def test_yellow_that_turns_red(judge: Judge, past: float, expected: list) -> None:
    poses = along(-20, 10, step=0.1)
    is_red_from = next(step for step, (x, _) in enumerate(poses) if x >= LINE + past)
    shown = lambda step: {"west in": Signal.RED if step >= is_red_from else Signal.YELLOW}  # noqa: E731
    assert judge(poses, lights=shown) == expected


def test_newer_leaderboards_watch_more_of_the_line(judge: Judge) -> None:
    poses = along(-20, 10, y=-0.35)
    assert judge(poses, stop_line_share=0.6) == [WEST]


@pytest.mark.parametrize(
    ("gate", "expected"), [(1.7, NOT_GUILTY), (1.9, [WEST]), (15.0, [WEST]), (30.0, [WEST])]
)
def test_lights_beyond_the_gate_are_not_looked_at(
    judge: Judge, gate: float, expected: list
) -> None:
    # Guilt begins 1.76 m past the line, so that the Leaderboard's 15 m never decide.
    assert judge(along(-20, 10, step=0.1), light_distance=gate) == expected


def two_lanes(town: Town, *, one_signal: bool) -> Town:
    """Add a second lane, "outer", to the right of "west in", with a light of its own or of the same signal."""
    inner, light = town.lanes["west in"], town.lights["west in"]
    shift = np.array([0.0, -4.0])
    outer = dataclasses.replace(
        inner, id="outer", centerline=inner.centerline + shift, light="outer"
    )
    second = dataclasses.replace(
        light,
        id="outer",
        lane="outer",
        stop_line=light.stop_line + shift,
        signal="west in" if one_signal else "",
    )
    return dataclasses.replace(
        town, lanes={**town.lanes, "outer": outer}, lights={**town.lights, "outer": second}
    )


@pytest.mark.parametrize("y", [-2.0, -6.0], ids=["inner", "outer"])
def test_the_light_of_the_next_lane_does_not_count(
    judge: Judge, crossroads: Town, y: float
) -> None:
    own = "west in" if y == -2.0 else "outer"
    town = two_lanes(crossroads, one_signal=False)
    poses = along(-20, 4, y=y)
    assert judge(poses, town=town, lights={own: Signal.GREEN}, only="RED_LIGHT") == NOT_GUILTY
    assert judge(poses, town=town, only="RED_LIGHT") == [("RED_LIGHT", own)]


@pytest.mark.parametrize("y", [-2.0, -3.5, -4.5, -6.0])
def test_one_signal_over_two_lanes_is_run_once(judge: Judge, crossroads: Town, y: float) -> None:
    poses = [*along(-20, 4, y=y), *along(-20, 4, y=-8.0 - y)]
    for one_signal, count in ((True, 1), (False, 2)):
        town = two_lanes(crossroads, one_signal=one_signal)
        assert len(judge(poses, town=town, only="RED_LIGHT")) == count


@pytest.mark.parametrize("speed", [6.0, 14.0, 16.0, 25.0, 60.0], ids=lambda speed: f"{speed} m/s")
def test_no_speed_jumps_the_line(judge: Judge, speed: float) -> None:
    for phase in np.linspace(0, 1, 20, endpoint=False):
        poses = along(-12 + 0.1 * speed * phase, 8, step=0.1 * speed)
        assert judge(poses) == [WEST]


def test_a_step_from_beside_the_lane_is_no_way_round(judge: Judge) -> None:
    assert judge([(-30.0, -2.0), (-14.0, 2.0), (LINE + 2.0, -2.0)], only="RED_LIGHT") == [WEST]


def test_without_the_sweep_the_line_is_jumped_above_14_m_per_s(judge: Judge) -> None:
    def missed(speed: float) -> int:
        """Number of crossings that a point in time every 0.1 s does not show, of 20."""
        starts = -12 + 0.1 * speed * np.linspace(0, 1, 20, endpoint=False)
        drives = [along(start, 8, step=0.1 * speed) for start in starts]
        return sum(judge(poses, stop_line_sweep=False) == NOT_GUILTY for poses in drives)

    assert RulesConfig().stop_line_sweep
    fastest = (END - BEGIN) / 0.1  # the length of the tail in one step, 52 km/h
    assert (missed(0.99 * fastest), missed(2 * fastest)) == (0, 10)
