from dataclasses import replace

import numpy as np
import pytest

from mjdrive.bev.layers import LIGHT_LAYERS, LIGHT_VALUES, Layer
from mjdrive.bev.projector import BevProjector
from mjdrive.config import BevConfig, from_dict
from mjdrive.datatypes import Signal, Town
from mjdrive.errors import ConfigError

GREEN, YELLOW, RED = 5.0, 11.0, 20.0  # into the program of the light [s]


def lights(town: Town, *, time: float = 5.0, x: float = 80.0, yaw: float = 0.0, **settings: object):
    projector = BevProjector(town, config=BevConfig(**settings))
    return projector.project(x=x, y=0.0, yaw=yaw, time=time, light_phase=0.0)[2:]


def extents(mask: np.ndarray, angle: float) -> tuple[float, float]:
    """Length across and thickness along a direction, corners of pixels aside [px]."""
    rows, columns = np.nonzero(mask)
    across = columns * np.cos(angle) + rows * np.sin(angle)
    middle = np.abs(across - across.mean()) <= 6  # away from the rounded ends
    return np.ptp(across) + 1, np.count_nonzero(middle) / (np.ptp(across[middle]) + 1)


@pytest.mark.parametrize("yaw_deg", range(-30, 31, 5))
def test_bars_are_three_metres_twenty_by_one_metre_twenty(make_street, yaw_deg):
    # OpenCV draws round ends beyond the two points of a line, as in Roach: 16 px between them, and 7 px more in all.
    yaw = np.radians(yaw_deg)
    bar = lights(make_street(), yaw=yaw)[2] > 0
    length, thickness = extents(bar, yaw)
    assert length - 7 == pytest.approx(3.2 * 5, abs=1.5)
    assert thickness == pytest.approx(1.2 * 5, abs=1.0)


def test_bars_follow_the_width_of_the_lane(make_street):
    wide, narrow = (extents(lights(make_street(lane_width=w))[2] > 0, 0.0)[0] for w in (4.0, 3.0))
    assert wide - narrow == pytest.approx(0.8 * 5, abs=1)


def test_bar_lies_on_the_stop_line_of_its_lane(make_street):
    # 20 m less 1.35 m ahead of the ego point, and 2 m to its right.
    rows, columns = np.nonzero(lights(make_street())[2])
    assert rows.mean() == pytest.approx(152 - 5 * (20 - 1.35), abs=1)
    assert columns.mean() == pytest.approx(96 + 5 * 2, abs=1)


@pytest.mark.parametrize(
    ("time", "grey", "binary"), [(GREEN, 80, 0), (YELLOW, 170, 0), (RED, 255, 255)]
)
def test_values_tell_colours_apart_or_red_alone(make_street, time, grey, binary):
    assert lights(make_street(), time=time)[2].max() == grey
    assert lights(make_street(), time=time, light_values="binary")[2].max() == binary


def test_binary_red_is_drawn_where_grey_red_is(make_street):
    town = make_street()
    grey = lights(town, time=14.0, light_values="grey")
    binary = lights(town, time=14.0, light_values="binary")
    assert LIGHT_VALUES[Signal.YELLOW] in grey[0]  # 1.5 s ago
    np.testing.assert_array_equal(binary, np.where(grey == 255, 255, 0))


def test_lights_beyond_their_range_are_not_drawn(make_street):
    # The middle of the bar is 2 m aside of the axis of the street, the ego point 1.35 m ahead of the rear axle.
    distance = float(np.hypot(100.0 - 80.0 - 1.35, 2.0))
    assert lights(make_street(), light_range=distance + 1e-6).any()
    assert not lights(make_street(), light_range=distance - 1e-6).any()


def test_range_is_fifty_metres_unless_told_otherwise(make_street):
    assert BevConfig().light_range == 50.0
    far_seeing = {"size_px": 640, "ego_above_bottom_px": 40}
    assert lights(make_street(), x=100 - 1.35 - 49.5, **far_seeing).any()
    assert not lights(make_street(), x=100 - 1.35 - 50.5, **far_seeing).any()


def test_every_bar_that_reaches_into_the_view_is_drawn(make_street):
    # Its middle is beyond the far left corner, 37.5 m from the ego point; half of 6.4 m reach in.
    projector = BevProjector(make_street(lane_width=8.0))
    shown = projector.project(x=100 - 1.35 - 30.2, y=-4 - 22.2, yaw=0.0, time=5.0, light_phase=0.0)
    rows, columns = np.nonzero(shown[Layer.LIGHTS_NOW])
    assert columns.min() == rows.min() == 0
    assert columns.max() == pytest.approx(96 + 5 * (3.2 - 22.2) + 3, abs=1)


def test_channels_show_their_own_time_while_lights_change(make_street):
    # Green until 10 s, yellow until 13 s: the oldest channel sees the change last.
    town = make_street()
    at = {
        age: lights(town, time=10.0 + age)[:, :, :].max(axis=(1, 2)).tolist()
        for age in (0.1, 1.0, 1.6)
    }
    assert at == {0.1: [80, 80, 170], 1.0: [80, 170, 170], 1.6: [170, 170, 170]}


def test_lights_of_one_program_are_drawn_each_at_its_line(make_street):
    town = make_street()
    light = town.lights["light"]
    back = replace(light, id="back", lane="back", stop_line=light.stop_line + np.array([-8.0, 4.0]))
    both = replace(town, lights={"light": light, "back": back})
    one, other = (replace(town, lights={name: both.lights[name]}) for name in both.lights)
    np.testing.assert_array_equal(lights(both), np.maximum(lights(one), lights(other)))
    assert (lights(both)[2] > 0).sum() > 1.5 * (lights(one)[2] > 0).sum()


def test_towns_without_lights_have_dark_channels(make_street):
    assert not lights(replace(make_street(), lights={})).any()


def test_light_channels_are_three():
    assert [layer.value for layer in LIGHT_LAYERS] == [2, 3, 4]


@pytest.mark.parametrize("values", [{"light_values": "colour"}, {"light_range": 0.0}])
def test_settings_without_meaning_are_refused(values):
    with pytest.raises(ConfigError, match=next(iter(values))):
        from_dict(BevConfig, values)
