"""Models that are driven like cars against their closed forms."""

import math

import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.manoeuvres import steady_circle, step_steer
from mjdrive.manoeuvres.single_track_cars import LinearCar, SingleTrackCar

LOCK, RATE = 0.6, 0.48


@pytest.fixture
def kinematic(track) -> SingleTrackCar:
    return SingleTrackCar(track, max_steering_angle=LOCK, steering_rate=RATE)


@pytest.fixture
def linear(track) -> LinearCar:
    return LinearCar(track, max_steering_angle=LOCK, steering_rate=RATE)


def test_kinematic_car_drives_the_circle_of_ackermann(kinematic):
    kinematic.place(speed=5.0)
    kinematic.drive(lambda _: Action(0.0, 0.5), duration=2.0)
    recording = kinematic.drive(lambda _: Action(0.0, 0.5), duration=20.0)
    radius = kinematic.single_track.wheelbase / math.tan(0.5 * LOCK)
    assert np.ptp(recording.x) == pytest.approx(2 * radius, rel=1e-3)
    assert np.ptp(recording.y) == pytest.approx(2 * radius, rel=1e-3)


def test_kinematic_car_never_understeers(kinematic):
    assert steady_circle.circle(kinematic, 50).understeer_gradient == pytest.approx(0.0, abs=1e-9)


def test_linear_car_understeers_by_its_closed_form(linear):
    circle = steady_circle.circle(linear, 80)
    expected = linear.single_track.understeer_gradient
    assert circle.understeer_gradient == pytest.approx(expected, rel=0.03)
    slip = linear.single_track.body_slip_gain(80 / 3.6)
    per_acceleration = slip / (80 / 3.6 * linear.single_track.yaw_rate_gain(80 / 3.6))
    assert circle.body_slip_gradient == pytest.approx(per_acceleration, rel=0.02)


def test_linear_car_passes_the_step_exactly(linear):
    step = step_steer.step(linear)
    assert step.gain == pytest.approx(linear.single_track.yaw_rate_gain(80 / 3.6), rel=1e-6)
    assert step.lateral_acceleration == pytest.approx(step_steer.ACCELERATION, rel=1e-6)


def test_a_step_can_be_made_for_another_acceleration(linear):
    step = step_steer.step(linear, acceleration=1.5)
    assert step.lateral_acceleration == pytest.approx(1.5, rel=1e-6)


def test_steering_turns_no_faster_than_its_rate(linear):
    linear.place(speed=10.0)
    recording = linear.drive(lambda _: Action(0.0, 1.0), duration=0.5)
    assert np.diff(recording.steering_angle).max() == pytest.approx(0.02 * RATE)
    assert recording.steering_angle[-1] == pytest.approx(0.5 * RATE)


def test_command_beyond_full_lock_is_full_lock(kinematic):
    kinematic.place(speed=1.0)
    recording = kinematic.drive(lambda _: Action(0.0, -3.0), duration=3.0)
    assert recording.steering_angle[-1] == pytest.approx(-LOCK)
