"""Derived quantities against a circle that is known in closed form."""

import numpy as np
import pytest

from mjdrive.manoeuvres.recording import Moment, Recording

SPEED, YAW_RATE, SLIP = 10.0, 0.4, 0.05


def circle(slip: float = SLIP) -> Recording:
    """A drive on a circle at constant speed, with constant body slip, beyond half a turn."""
    moments = []
    for time in np.arange(0.0, 12.0, 0.02):
        yaw = np.angle(np.exp(1j * YAW_RATE * time))  # jumps at pi, as atan2 does
        heading = yaw + slip
        radius = SPEED / YAW_RATE
        moments.append(
            Moment(
                time=time,
                x=radius * np.sin(heading),
                y=-radius * np.cos(heading),
                yaw=yaw,
                speed=SPEED * np.cos(slip),
                lateral_speed=SPEED * np.sin(slip),
                yaw_rate=YAW_RATE,
                steering_angle=0.1,
                roll=0.0,
            )
        )
    return Recording.of(moments)


def test_yaw_has_no_jumps():
    assert np.diff(circle().yaw) == pytest.approx(0.02 * YAW_RATE)


def test_distance_is_speed_times_time():
    recording = circle()
    assert recording.distance[-1] == pytest.approx(SPEED * recording.time[-1], rel=1e-4)


def test_acceleration_points_at_the_centre():
    recording = circle()
    inwards = np.hypot(recording.lateral_acceleration, recording.forward_acceleration)
    assert inwards == pytest.approx(SPEED * YAW_RATE)
    assert recording.forward_acceleration == pytest.approx(-SPEED * np.sin(SLIP) * YAW_RATE)


def test_body_slip_is_positive_when_the_car_moves_to_its_left():
    assert circle().body_slip == pytest.approx(SLIP)
