from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mjdrive.errors import TownFormatError
from mjdrive.town.opendrive.reference_line import curvature_of, reference_line
from mjdrive.town.streets.fillet import Pose, extend, join, length_of, turn_left


def _pose(x: float, y: float, heading: float) -> Pose:
    return Pose(np.array([x, y]), np.array([np.cos(heading), np.sin(heading)]))


@given(
    leads=st.tuples(st.floats(5.0, 50.0), st.floats(5.0, 50.0)),
    angle=st.floats(0.01, 2.5),
    side=st.sampled_from([-1.0, 1.0]),
    heading=st.floats(-3.0, 3.0),
    share=st.floats(0.1, 1.0),
)
def test_a_joint_meets_both_poses_without_a_kink(
    leads: tuple[float, float], angle: float, side: float, heading: float, share: float
) -> None:
    lead_in, lead_out = leads
    start, turn = _pose(3.0, -4.0, heading), side * angle
    middle = start.point + lead_in * start.direction
    direction = np.array([np.cos(heading + turn), np.sin(heading + turn)])
    end = Pose(middle + lead_out * direction, direction)
    radius = share * min(lead_in, lead_out) / np.tan(angle / 2.0)
    pieces = join(start, end, radius=radius, what="test")
    ends = np.array([0.0, length_of(pieces)])
    points, headings = reference_line(pieces, ends)
    np.testing.assert_allclose(points, [start.point, end.point], atol=1e-6)
    np.testing.assert_allclose(headings, [heading, heading + turn], atol=1e-7)
    for before, after in pairwise(pieces):
        (point,), (yaw,) = reference_line([before], np.array([after.s]))
        np.testing.assert_allclose([*point, yaw], [after.x, after.y, after.heading], atol=1e-6)
    assert max(abs(curvature_of(piece)) for piece in pieces) == pytest.approx(
        1.0 / radius, rel=1e-6
    )


def test_poses_on_one_line_are_joined_by_a_line() -> None:
    (line,) = join(_pose(0.0, 1.0, 0.0), _pose(20.0, 1.0, 0.0), radius=None, what="test")
    assert (line.length, curvature_of(line)) == (20.0, 0.0)


def test_without_a_radius_slight_bends_have_500_metres() -> None:
    pieces = join(_pose(0.0, 0.0, 0.0), _pose(40.0, 0.02, 0.001), radius=None, what="test")
    assert [round(curvature_of(piece), 9) for piece in pieces] == [0.0, 0.002, 0.0]


def test_without_a_radius_the_largest_that_fits_is_taken() -> None:
    pieces = join(_pose(0.0, 0.0, 0.0), _pose(10.0, 30.0, np.pi / 2), radius=None, what="test")
    assert [curvature_of(piece) for piece in pieces] == [pytest.approx(0.1), 0.0]


@pytest.mark.parametrize("radius", [10.1, 0.0, -1.0])
def test_a_radius_that_does_not_fit_is_refused(radius: float) -> None:
    with pytest.raises(TownFormatError, match=r"Bend 7 asks for .*at most 10\.00 m"):
        join(_pose(0.0, 0.0, 0.0), _pose(10.0, 30.0, np.pi / 2), radius=radius, what="Bend 7")


def test_poses_that_look_away_from_each_other_are_refused() -> None:
    with pytest.raises(TownFormatError, match="between its ends"):
        join(_pose(0.0, 0.0, 0.0), _pose(-10.0, 30.0, np.pi / 2), radius=None, what="Bend 7")


def test_a_pose_is_shifted_to_the_right_of_travel() -> None:
    np.testing.assert_allclose(_pose(1.0, 2.0, np.pi / 2).to_the_right(3.0).point, [4.0, 2.0])


def test_runs_of_pieces_follow_each_other() -> None:
    line = join(_pose(0.0, 0.0, 0.0), _pose(20.0, 0.0, 0.0), radius=None, what="test")
    arc = turn_left(_pose(20.0, 0.0, 0.0), radius=10.0, angle=1.0)
    both = extend(line, arc)
    assert [piece.s for piece in both] == [0.0, 20.0]
    assert length_of(both) == 30.0


def test_a_line_that_goes_straight_on_is_one_line() -> None:
    first = join(
        _pose(0.0, 0.0, 0.5),
        _pose(20.0 * np.cos(0.5), 20.0 * np.sin(0.5), 0.5),
        radius=None,
        what="test",
    )
    (line,) = extend(first, first)
    assert (line.s, line.length) == (0.0, 40.0)


def test_an_arc_to_the_left_ends_where_its_circle_does() -> None:
    (arc,) = turn_left(_pose(3.0, 4.0, 0.0), radius=10.0, angle=np.pi / 2)
    (end,), (heading,) = reference_line([arc], np.array([arc.length]))
    np.testing.assert_allclose([*end, heading], [13.0, 14.0, np.pi / 2], atol=1e-9)
