import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjdrive import geometry
from mjdrive.bev.layers import LIGHT_LAYERS, LIGHT_VALUES, MARKED, Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Signal, Town

STATION = st.floats(-60.0, 95.0)
OFFSET = st.floats(-6.0, 6.0)
ANGLE = st.floats(-np.pi, np.pi)
PLACE = st.floats(-500.0, 500.0)
ON_STREET = st.tuples(STATION, OFFSET, ANGLE)
ANYWHERE = st.tuples(PLACE, PLACE, ANGLE)


@pytest.fixture(scope="module")
def projector(make_street) -> BevProjector:
    return BevProjector(make_street())


def view(town: Town, *, x: float, y: float, yaw: float = 0.0, time: float = 0.0) -> np.ndarray:
    return BevProjector(town).project(x=x, y=y, yaw=yaw, time=time, light_phase=0.0)


def grown(masks: np.ndarray, by: int) -> np.ndarray:
    square = np.ones((2 * by + 1, 2 * by + 1), np.uint8)
    return np.array([cv2.dilate(mask, square) for mask in masks])


def assert_same_up_to(pixels: int, first: np.ndarray, second: np.ndarray) -> None:
    """Every marked pixel of one has one of the same value or above within a few pixels in the other."""
    inside = slice(
        pixels, -pixels
    )  # what lies nearer to the border may be seen in one of them only
    for one, other in ((first, second), (second, first)):
        missing = one[:, inside, inside] > grown(other, pixels)[:, inside, inside]
        assert not missing.any(), np.argwhere(missing)[:5]


@settings(max_examples=40, deadline=None)
@given(pose=ON_STREET, move=ANYWHERE)
def test_moving_the_world_changes_nothing_but_rounding(make_street, projector, pose, move):
    (station, offset, heading), (x, y, yaw) = pose, move
    ((car_x, car_y),) = geometry.world_from_vehicle(
        np.array([[station, offset]]), x=x, y=y, yaw=yaw
    )
    still = projector.project(x=station, y=offset, yaw=heading, time=0.0, light_phase=0.0)
    moved = view(make_street(x=x, y=y, yaw=yaw), x=car_x, y=car_y, yaw=yaw + heading)
    # Corners are rounded to pixels of the raster, and OpenCV's lines are thicker along the axes than across.
    assert_same_up_to(2, still, moved)


@given(pose=ANYWHERE, ahead=st.floats(-50.0, 50.0), left=st.floats(-50.0, 50.0))
def test_world_points_land_where_the_car_sees_them(projector, pose, ahead, left):
    # The ego point, 1.35 m ahead of the rear axle, is the middle of column 96, 40 px above the bottom; 5 px are 1 m.
    x, y, yaw = pose
    (point,) = geometry.world_from_vehicle(np.array([[1.35 + ahead, left]]), x=x, y=y, yaw=yaw)
    view_from_world = projector.view_from_world(x=x, y=y, yaw=yaw)
    expected = [96 - 5 * left, 192 - 40 - 5 * ahead, 1.0]
    np.testing.assert_allclose(view_from_world @ [*point, 1.0], expected, atol=1e-9)


@settings(deadline=None)
@given(station=st.floats(75.0, 95.0), offset=OFFSET, yaw=st.floats(-0.4, 0.4))
def test_ends_of_lane_lines_are_drawn_where_view_from_world_says(projector, station, offset, yaw):
    lines = projector.project(x=station, y=offset, yaw=yaw, time=0.0, light_phase=0.0)[1]
    view_from_world = projector.view_from_world(x=station, y=offset, yaw=yaw)
    ends = np.array([[100.0, y, 1.0] for y in (-4.0, 0.0, 4.0)]) @ view_from_world.T
    in_view = ((ends[:, :2] >= 1) & (ends[:, :2] <= 190)).all(axis=1)
    for column, row in np.rint(ends[in_view, :2]).astype(int):
        assert lines[row - 1 : row + 2, column - 1 : column + 2].any()
    assert in_view.any()


@settings(max_examples=40, deadline=None)
@given(pose=ON_STREET, time=st.floats(1.5, 60.0))
def test_oldest_lights_are_those_of_now_as_they_were_drawn_then(projector, pose, time):
    x, y, yaw = pose
    now = projector.project(x=x, y=y, yaw=yaw, time=time, light_phase=0.0)
    then = projector.project(x=x, y=y, yaw=yaw, time=time - 1.5, light_phase=0.0)
    np.testing.assert_array_equal(now[Layer.LIGHTS_OLDEST], then[Layer.LIGHTS_NOW])


@settings(max_examples=40, deadline=None)
@given(
    pose=st.tuples(st.floats(82.0, 90.0), st.floats(-3.0, 3.0), st.floats(-0.2, 0.2)),
    driven=st.floats(0.0, 9.0),
    turned=st.floats(-0.2, 0.2),
    time=st.floats(1.5, 60.0),
)
def test_oldest_lights_are_those_of_a_drive_moved_into_the_frame_of_now(
    projector, pose, driven, turned, time
):
    station, offset, yaw = pose
    now = {"x": station, "y": offset, "yaw": yaw}
    then = {"x": station - driven, "y": offset, "yaw": yaw + turned}
    seen_now = projector.project(**now, time=time, light_phase=0.0)[Layer.LIGHTS_OLDEST]
    seen_then = projector.project(**then, time=time - 1.5, light_phase=0.0)[Layer.LIGHTS_NOW]
    then_from_world = projector.view_from_world(**then)
    now_from_then = projector.view_from_world(**now) @ np.linalg.inv(then_from_world)
    moved = cv2.warpAffine(seen_then, now_from_then[:2], (192, 192), flags=cv2.INTER_NEAREST)
    assert moved.any()
    assert_same_up_to(2, seen_now[None], moved[None])


def test_light_channels_show_the_past_in_the_frame_of_now(make_street):
    # Green until 10 s: at 10.4 s it is yellow now, and was green 0.8 s and 1.5 s ago.
    bev = view(make_street(), x=75.0, y=-2.0, time=10.4)
    green, yellow = LIGHT_VALUES[Signal.GREEN], LIGHT_VALUES[Signal.YELLOW]
    assert [int(bev[layer].max()) for layer in LIGHT_LAYERS] == [green, green, yellow]
    drawn = [bev[layer] > 0 for layer in (Layer.LIGHTS_OLDEST, Layer.LIGHTS_NOW)]
    np.testing.assert_array_equal(*drawn)


def test_history_does_not_reach_before_the_start(projector):
    # Yellow began 0.5 s before the reset, and red is 0.3 s away: nothing older than the reset is shown.
    bev = projector.project(x=75.0, y=-2.0, yaw=0.0, time=0.1, light_phase=10.0)
    assert {int(bev[layer].max()) for layer in LIGHT_LAYERS} == {LIGHT_VALUES[Signal.YELLOW]}


def test_same_pose_and_time_give_the_same_bytes(projector):
    first = projector.project(x=70.0, y=1.0, yaw=0.2, time=3.0, light_phase=1.0)
    projector.project(x=0.0, y=0.0, yaw=1.0, time=30.0, light_phase=2.0)
    again = projector.project(x=70.0, y=1.0, yaw=0.2, time=3.0, light_phase=1.0)
    np.testing.assert_array_equal(first, again)


def test_road_and_lane_lines_are_marked_or_not(make_street):
    bev = view(make_street(), x=75.0, y=-2.0, yaw=0.3)
    assert set(np.unique(bev[:2])) == {0, MARKED}


@pytest.mark.parametrize("x", [-1e4, 1e4])
def test_nothing_is_seen_far_from_the_town(make_street, x):
    assert not view(make_street(), x=x, y=0.0).any()
