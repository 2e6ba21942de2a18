"""The car against closed forms and the linear single-track model."""

import hashlib
import subprocess
import sys

import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.vehicle import engine
from mjdrive.vehicle.parameters import VehicleParameters

GRAVITY = 9.81
WILD = [(1.0, 0.3), (0.4, -1.0), (-1.0, 0.2), (0.0, 0.0), (0.8, 1.0), (-0.3, -0.5)]


def digest_of_a_wild_drive(ground) -> str:
    digest = hashlib.sha256()
    for acceleration, steering in WILD:
        ground.drive(acceleration, steering, 0.8)
        digest.update(ground.data.qpos.tobytes() + ground.data.qvel.tobytes())
    return digest.hexdigest()


def test_car_reaches_100_kmh_as_a_family_saloon_does(ground):
    ground.drive(1.0, 0.0, 7.5)
    assert ground.car.state().speed < 100 / 3.6
    ground.drive(1.0, 0.0, 2.0)
    assert ground.car.state().speed > 100 / 3.6


def test_braking_distance_is_that_of_coulomb_friction_plus_lag(ground):
    speed, friction, lag = 50 / 3.6, 1.0, 0.08
    ground.car.place(0.0, 0.0, 0.0, speed=speed)
    ground.drive(-1.0, 0.0, 4.0)
    expected = speed**2 / (2 * friction * GRAVITY) + lag * speed
    assert ground.car.state().speed == pytest.approx(0.0, abs=1e-3)
    assert ground.car.state().x == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("steering", [-1.0, -0.4, 0.4, 1.0])
def test_slow_turn_has_the_ackermann_radius(ground, steering):
    ground.cruise(1.5, steering, 6.0)
    state = ground.car.state()
    expected = ground.car.parameters.wheelbase / np.tan(state.steering_angle)
    assert state.steering_angle == pytest.approx(0.6 * steering, rel=0.01)
    assert state.speed / state.yaw_rate == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("acceleration", [0.0, -1.0])
def test_rest_stays_at_rest(ground, acceleration):
    ground.drive(acceleration, 0.0, 1.0)
    before = ground.car.state()
    ground.drive(acceleration, 0.0, 20.0)
    after = ground.car.state()
    assert np.hypot(after.x - before.x, after.y - before.y) < 1e-3


def test_brake_holds_the_car_on_a_slope_of_ten_percent(ground):
    tilt = np.arctan(0.1)
    ground.model.opt.gravity = [-GRAVITY * np.sin(tilt), 0.0, -GRAVITY * np.cos(tilt)]
    ground.drive(-1.0, 0.0, 4.0)
    before = ground.car.state()
    ground.drive(-1.0, 0.0, 20.0)
    assert abs(ground.car.state().x - before.x) < 1e-3


def test_car_rolls_down_a_slope_when_the_brake_is_released(ground):
    ground.drive(-1.0, 0.0, 2.0)
    tilt = np.arctan(0.1)
    ground.model.opt.gravity = [-GRAVITY * np.sin(tilt), 0.0, -GRAVITY * np.cos(tilt)]
    ground.drive(0.0, 0.0, 4.0)
    assert ground.car.state().speed < -2.0


def test_steady_understeer_is_that_of_the_linear_single_track_model(ground):
    parameters: VehicleParameters = ground.car.parameters
    speed, steering = 80 / 3.6, 0.03
    ground.car.place(0.0, 0.0, 0.0, speed=speed)
    ground.cruise(speed, 0.0, 2.0)
    ground.cruise(speed, steering, 4.0)
    state = ground.car.state()
    lateral_acceleration = state.speed * state.yaw_rate
    rear = parameters.centre_of_gravity_ahead
    front = parameters.wheelbase - rear
    expected = (parameters.mass / parameters.wheelbase) * (
        rear / (2 * parameters.cornering_stiffness_front)
        - front / (2 * parameters.cornering_stiffness_rear)
    )
    kinematic = parameters.wheelbase * state.yaw_rate / state.speed
    assert 1.0 < lateral_acceleration < 4.0  # where tyres are linear
    assert (state.steering_angle - kinematic) / lateral_acceleration == pytest.approx(
        expected, rel=0.2
    )


def test_straight_stays_straight(ground):
    ground.drive(0.6, 0.0, 20.0)
    assert ground.car.state().x > 150.0
    assert abs(ground.car.state().y) < 1e-3


def test_positive_steering_turns_left(ground):
    ground.drive(0.5, 1.0, 2.0)
    assert ground.car.state().y > 0.1
    assert ground.car.state().yaw_rate > 0.1


def test_steering_angle_changes_no_faster_than_its_limit(ground):
    ground.drive(0.0, 0.0, 0.5)
    ground.drive(0.0, 1.0, 0.5)
    limit = 0.5 * ground.car.parameters.max_steering_rate
    assert 0.8 * limit < ground.car.state().steering_angle < limit


def test_commands_beyond_the_limits_count_as_the_limits(ground):
    ground.car.command(Action(-7.0, 3.0))
    assert ground.data.ctrl == pytest.approx([0.0, 1.0, 1.0])


def test_motion_does_not_depend_on_where_and_which_way_the_car_starts(ground):
    ground.car.place(0.0, 0.0, 0.0, speed=8.0)
    ground.drive(0.2, 0.3, 2.0)
    here = ground.car.state()
    ground.car.place(100.0, -50.0, 2.0, speed=8.0)
    ground.drive(0.2, 0.3, 2.0)
    there = ground.car.state()
    forward, left = here.x, here.y
    assert there.x == pytest.approx(100 + forward * np.cos(2) - left * np.sin(2), abs=1e-6)
    assert there.y == pytest.approx(-50 + forward * np.sin(2) + left * np.cos(2), abs=1e-6)
    assert there.speed == pytest.approx(here.speed, abs=1e-6)


def test_restored_car_repeats_its_future_bit_by_bit(ground):
    ground.drive(0.5, 0.3, 2.0)
    ground.car.update()
    mujoco.mj_step(ground.model, ground.data, 1)  # between two updates, the hardest moment
    saved = ground.car.save()
    first = digest_of_a_wild_drive(ground)
    ground.drive(-1.0, 0.0, 3.0)
    ground.car.restore(saved)
    assert digest_of_a_wild_drive(ground) == first


def test_restored_hold_is_a_hold(ground):
    ground.drive(-1.0, 0.0, 1.0)
    saved = ground.car.save()
    ground.drive(-1.0, 0.0, 1.0)
    first = ground.car.save()
    ground.drive(1.0, 0.5, 3.0)
    ground.car.restore(saved)
    ground.drive(-1.0, 0.0, 1.0)
    assert np.array_equal(ground.car.save(), first)


def test_drive_is_the_same_bit_by_bit_in_another_process(ground):
    script = (
        f"import sys; sys.path.insert(0, {str(__file__.rpartition('/')[0])!r})\n"
        "from conftest import ProvingGround\nfrom test_car import digest_of_a_wild_drive\n"
        "print(digest_of_a_wild_drive(ProvingGround()))"
    )
    other = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    ).stdout.strip()
    assert digest_of_a_wild_drive(ground) == other


def test_footprint_surrounds_the_wheels_and_moves_with_the_car(ground):
    ground.car.place(10.0, 20.0, np.pi / 2)
    corners, wheels = ground.car.footprint(), ground.car.wheel_contacts()
    assert corners.min(axis=0) == pytest.approx([9.12, 19.15])
    assert corners.max(axis=0) == pytest.approx([10.88, 23.55])
    assert wheels == pytest.approx(np.array([[9.23, 22.7], [10.77, 22.7], [9.23, 20], [10.77, 20]]))
    mujoco.mj_kinematics(ground.model, ground.data)
    front_left = ground.data.body("wheel_fl").xpos[:2]
    assert wheels[0] == pytest.approx(front_left)


def test_full_braking_never_puts_the_hull_on_the_road(ground):
    ground.car.place(0.0, 0.0, 0.0, speed=30.0)
    ground.car.command(Action(-1.0, 0.1))
    road = ground.model.geom("road").id
    for _ in range(200):
        ground.tick()
        pairs = ground.data.contact.geom
        assert not any(
            road in pair and ground.car.hull_geoms.intersection(pair.tolist()) for pair in pairs
        )


def test_hard_driving_warns_of_nothing(ground):
    digest_of_a_wild_drive(ground)
    assert engine.num_warnings(ground.data) == 0
    engine.require_sane(ground.data)
