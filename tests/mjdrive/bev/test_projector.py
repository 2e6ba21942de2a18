import numpy as np
import pytest

from mjdrive.bev.layers import LIGHT_VALUES, Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.datatypes import Lane, Signal, Town, TrafficLight

PROGRAM = ((Signal.GREEN, 10.0), (Signal.YELLOW, 3.0), (Signal.RED, 32.0))


def street(*, x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> Town:
    """A straight street, 4 m each way, 100 m to either side of (x, y), with a light at its far end."""
    along = np.array([np.cos(yaw), np.sin(yaw)])
    left = np.array([-along[1], along[0]])
    ends = np.array([x, y]) + np.outer([-100.0, 100.0], along)
    forward = Lane("forward", ends - 2 * left, 4.0, (), None, "light")
    back = Lane("back", (ends + 2 * left)[::-1], 4.0, (), None, None)
    end = forward.centerline[-1]
    light = TrafficLight(
        id="light",
        lane="forward",
        junction="j",
        stop_line=np.array([end + 2 * left, end - 2 * left]),
        yaw=yaw,
        pole=end,
        program=PROGRAM,
        offset=0.0,
    )
    bounds = np.array([x - 120, y - 120, x + 120, y + 120])
    return Town("street", {"forward": forward, "back": back}, {"light": light}, bounds, "")


def view(town: Town, *, x: float, y: float, yaw: float = 0.0, time: float = 0.0) -> np.ndarray:
    return BevProjector(town).project(x=x, y=y, yaw=yaw, time=time, light_phase=0.0)


def test_road_is_nine_metres_wide_in_pixels_of_twenty_centimetres():
    row = view(street(), x=0.0, y=0.0)[Layer.ROAD, 100]
    assert 45 <= np.count_nonzero(row) <= 47  # the warp touches up to a pixel more on either side


def test_lane_lines_stand_at_minus_twenty_zero_and_twenty_pixels_from_the_middle():
    columns = np.flatnonzero(view(street(), x=0.0, y=0.0)[Layer.LANE_LINES, 100])
    for expected in (76, 96, 116):
        assert np.abs(columns - expected).min() <= 1
    assert np.abs(columns[:, None] - [76, 96, 116]).min(axis=1).max() <= 1


def test_ego_stands_forty_pixels_above_the_bottom_in_the_middle_column():
    # A stop line 20 m ahead of the car's middle, on the lane 2 m to the right of the axis of the street.
    bev = view(street(), x=100.0 - 20.0 - 1.35, y=0.0)
    rows, columns = np.nonzero(bev[Layer.LIGHTS_NOW])
    assert rows.mean() == pytest.approx(192 - 40 - 20 * 5, abs=1)
    assert columns.mean() == pytest.approx(96 + 2 * 5, abs=1)
    assert np.ptp(columns) + 1 == pytest.approx(0.8 * 4.0 * 5 + 6, abs=2)


@pytest.mark.parametrize(
    ("x", "y", "yaw"), [(40.0, -7.0, 0.3), (-12.0, 3.0, 2.0), (0.4, 0.2, -1.1)]
)
def test_moving_town_and_car_together_changes_nothing_but_rounding(x, y, yaw):
    still = view(street(), x=75.0, y=-1.0)
    car = np.array([x, y]) + 75.0 * np.array([np.cos(yaw), np.sin(yaw)])
    car += -1.0 * np.array([-np.sin(yaw), np.cos(yaw)])
    moved = view(street(x=x, y=y, yaw=yaw), x=car[0], y=car[1], yaw=yaw)
    for layer, share in ((Layer.ROAD, 0.95), (Layer.LIGHTS_NOW, 0.75)):
        both = np.count_nonzero((still[layer] > 0) & (moved[layer] > 0))
        either = np.count_nonzero((still[layer] > 0) | (moved[layer] > 0))
        assert both / either > share


def test_light_channels_show_the_past_in_the_frame_of_now():
    # Green until 10 s: at 10.4 s it is yellow now, and was green 0.8 s and 1.5 s ago.
    bev = view(street(), x=75.0, y=-2.0, time=10.4)
    seen = [
        int(bev[layer].max())
        for layer in (Layer.LIGHTS_OLDEST, Layer.LIGHTS_OLDER, Layer.LIGHTS_NOW)
    ]
    green, yellow = LIGHT_VALUES[Signal.GREEN], LIGHT_VALUES[Signal.YELLOW]
    assert seen == [green, green, yellow]
    drawn = [bev[layer] > 0 for layer in (Layer.LIGHTS_OLDEST, Layer.LIGHTS_NOW)]
    np.testing.assert_array_equal(*drawn)


def test_history_does_not_reach_before_the_start():
    # Yellow began 0.5 s before the reset, and red is 0.3 s away: nothing older than the reset is shown.
    projector = BevProjector(street())
    bev = projector.project(x=75.0, y=-2.0, yaw=0.0, time=0.1, light_phase=10.0)
    assert {int(bev[layer].max()) for layer in list(Layer)[2:]} == {LIGHT_VALUES[Signal.YELLOW]}


def test_same_pose_and_time_give_the_same_bytes():
    projector = BevProjector(street())
    first = projector.project(x=70.0, y=1.0, yaw=0.2, time=3.0, light_phase=1.0)
    projector.project(x=0.0, y=0.0, yaw=1.0, time=30.0, light_phase=2.0)
    again = projector.project(x=70.0, y=1.0, yaw=0.2, time=3.0, light_phase=1.0)
    np.testing.assert_array_equal(first, again)
