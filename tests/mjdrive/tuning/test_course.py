import dataclasses

import numpy as np
import pytest

from mjdrive.datatypes import InfractionKind
from mjdrive.errors import RouteError
from mjdrive.tuning.course import APPROACH, BESIDE, course


def turned(exercise) -> float:
    """Angle between the first and the last heading of the route, positive to the left [deg]."""
    yaw = np.unwrap(exercise.route.yaw)
    return float(np.degrees(yaw[-1] - yaw[0]))


def test_course_turns_left_and_right_and_goes_straight_on(exercises02):
    angles = [round(turned(exercise) / 90) for exercise in exercises02]
    assert {-1, 0, 1} <= set(angles)


def test_tightest_bend_comes_first_and_the_start_beside_the_lane_last(exercises02):
    tightness = [np.abs(exercise.route.curvature).max() for exercise in exercises02[:-1]]
    assert tightness[0] == pytest.approx(max(tightness), rel=0.05)
    assert [exercise.offset for exercise in exercises02] == [0.0] * (len(exercises02) - 1) + [
        BESIDE
    ]


def test_bends_are_unlike_each_other(exercises02):
    shapes = {(round(turned(one)), round(one.route.station[-1])) for one in exercises02[:-1]}
    assert len(shapes) == len(exercises02) - 1


def test_fewer_bends_are_spread_from_the_tightest_to_the_widest(town02, exercises02):
    few = course(town02, bends=2)
    assert len(few) == 3
    assert few[0].name == exercises02[0].name
    assert few[-1].name == exercises02[-1].name


def test_way_before_and_after_a_bend_is_as_long_as_the_lanes_allow(exercises02):
    assert all(one.route.station[-1] <= 2 * APPROACH + 40 for one in exercises02)
    assert all(len(one.route.lanes) == 3 for one in exercises02)


def test_lights_are_green_to_the_expert_and_bends_are_finished(traces02):
    bend, beside = traces02
    assert bend.is_finished
    assert beside.is_finished
    kinds = {infraction.kind for trace in traces02 for infraction in trace.episode.infractions}
    assert kinds <= {InfractionKind.RED_LIGHT}
    waits = np.flatnonzero(bend.episode.vehicle[20:, 3] < 0.1)
    assert len(waits) == 0


def test_offsets_begin_where_the_exercise_says(traces02):
    bend, beside = traces02
    assert bend.offsets[0] == pytest.approx(0.0, abs=1e-6)
    assert beside.offsets[0] == pytest.approx(BESIDE, abs=1e-6)
    assert abs(beside.offsets[-1]) < 0.1
    assert len(bend.offsets) == len(bend.episode.time)


def test_town_without_a_way_through_a_junction_is_refused(town02):
    lanes = {name: lane for name, lane in town02.lanes.items() if lane.junction is None}
    bare = {name: dataclasses.replace(lane, successors=()) for name, lane in lanes.items()}
    with pytest.raises(RouteError, match="no way through a junction"):
        course(dataclasses.replace(town02, lanes=bare, lights={}), bends=3)
