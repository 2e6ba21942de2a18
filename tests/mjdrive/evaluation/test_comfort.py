import dataclasses

import numpy as np
import pytest

from mjdrive.evaluation.comfort import jerk_rms, steering_whiteness


def with_speed(make_drive, speed):
    drive = make_drive(np.zeros(len(speed)))
    vehicle = drive.vehicle.copy()
    vehicle[:, 3] = speed
    return dataclasses.replace(drive, vehicle=vehicle)


def with_steering(drive, steering):
    labels = drive.labels.copy()
    labels[:, 1] = steering
    return dataclasses.replace(drive, labels=labels)


def test_whiteness_of_a_steady_turn_of_the_wheel_is_its_rate(make_drive):
    drive = make_drive(0.5 * np.arange(50))
    assert steering_whiteness(with_steering(drive, 0.02 * np.arange(50))) == pytest.approx(0.2)


def test_whiteness_of_a_sine_is_its_frequency_times_the_root_mean_square(make_drive):
    drive = make_drive(0.5 * np.arange(2001))
    steering = 0.3 * np.sin(2 * np.pi * 0.5 * drive.time)
    expected = 0.3 / np.sqrt(2) * 2 * np.pi * 0.5
    assert steering_whiteness(with_steering(drive, steering)) == pytest.approx(expected, rel=0.01)


def test_steering_at_a_standstill_is_no_comfort_lost(make_drive):
    drive = make_drive(np.zeros(50))
    assert steering_whiteness(with_steering(drive, np.tile([-1.0, 1.0], 25))) == 0.0


def test_driven_disturbance_does_not_count_only_what_was_wanted(make_drive):
    drive = make_drive(0.5 * np.arange(50))
    assert np.ptp(drive.actions[:, 1]) > 0
    assert steering_whiteness(drive) == 0.0


def test_jerk_of_a_cubic_is_constant(make_drive):
    time = 0.1 * np.arange(60)
    assert jerk_rms(with_speed(make_drive, 5.0 + 0.5 * 0.7 * time**2)) == pytest.approx(0.7)


def test_a_car_that_never_moves_has_no_jerk(make_drive):
    assert jerk_rms(with_speed(make_drive, np.zeros(20))) == 0.0
    assert jerk_rms(with_speed(make_drive, np.zeros(1))) == 0.0
