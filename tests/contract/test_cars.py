"""What every car that ships with mjdrive must do; docs/cars.md says the same of a car of your own."""

import hashlib

import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.vehicle import cars, engine
from mjdrive.vehicle.assembly import WHEELS, car_on_road
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.car_parts import PARTS
from mjdrive.vehicle.drivetrain import Drivetrain

MASSES = {"default": 1600.0, "mkz": 1696.0}  # as docs/cars.md has them [kg]
UPDATE_INTERVAL, TIMESTEP = 0.02, 0.005
GRAVITY = 9.81


class Track:
    """One car on the plane."""

    def __init__(self, name: str) -> None:
        self.model = car_on_road(timestep=TIMESTEP, car=cars.load(name).path).compile()
        self.data = mujoco.MjData(self.model)
        self.car = Car(self.model, self.data)
        self.car.place(0.0, 0.0, 0.0)

    def drive(self, acceleration: float, steering: float, duration: float) -> None:
        self.car.command(Action(acceleration, steering))
        for _ in range(round(duration / UPDATE_INTERVAL)):
            self.car.update()
            mujoco.mj_step(self.model, self.data, round(UPDATE_INTERVAL / TIMESTEP))

    def digest_of_a_drive(self) -> str:
        digest = hashlib.sha256()
        for acceleration, steering in [(1.0, 0.3), (0.6, -1.0), (-1.0, 0.2), (0.8, 1.0)]:
            self.drive(acceleration, steering, 1.0)
            digest.update(self.car.save().tobytes())
        return digest.hexdigest()


@pytest.fixture(params=cars.SHIPPED)
def track(request: pytest.FixtureRequest) -> Track:
    return Track(request.param)


@pytest.mark.parametrize("name", cars.SHIPPED)
def test_every_name_is_there_once(name):
    spec = mujoco.MjSpec.from_file(str(cars.load(name).path))
    assert all(getattr(spec, part.kind)(part.name) is not None for part in PARTS)
    assert len({(part.kind, part.name) for part in PARTS}) == len(PARTS)


@pytest.mark.parametrize("name", cars.SHIPPED)
def test_masses_add_up_to_what_the_card_says(name):
    assert cars.load(name).parameters.mass == pytest.approx(MASSES[name])


@pytest.mark.parametrize("pedal", [0.0, -1.0])
def test_it_stands_still_and_level_for_ten_seconds(track, pedal):
    track.drive(pedal, 0.0, 1.0)
    before = track.car.state()
    track.drive(pedal, 0.0, 10.0)
    after = track.car.state()
    assert np.hypot(after.x - before.x, after.y - before.y) < 1e-3
    assert np.abs(2 * track.data.qpos[4:6]).max() < 2e-3  # roll and pitch [rad]
    travel = [float(track.data.joint(f"susp_{wheel}").qpos[0]) for wheel in WHEELS]
    assert travel == pytest.approx([0.0] * 4, abs=1e-3)


def test_it_drives_straight(track):
    track.drive(0.8, 0.0, 10.0)
    assert track.car.state().x > 80.0
    assert abs(track.car.state().y) < 1e-3


def test_it_stops_within_a_tenth_of_what_friction_and_lag_allow(track):
    speed = 50 / 3.6
    track.car.place(0.0, 0.0, 0.0, speed=speed)
    track.drive(-1.0, 0.0, 4.0)
    expected = speed**2 / (2 * GRAVITY) + track.car.parameters.brake_lag * speed
    assert track.car.state().speed == pytest.approx(0.0, abs=1e-3)
    assert track.car.state().x == pytest.approx(expected, rel=0.1)


def test_full_braking_in_a_bend_does_not_turn_it_round(track):
    track.car.place(0.0, 0.0, 0.0, speed=50 / 3.6)
    track.drive(-1.0, 0.05, 4.0)
    assert abs(track.car.state().yaw) < 0.2


@pytest.mark.parametrize("steering", [-1.0, 0.5])
def test_slow_circles_have_the_radius_of_ackermann(track, steering):
    parameters = track.car.parameters
    for _ in range(300):
        error = 1.5 - track.car.state().speed
        track.drive(parameters.throttle_dead_band * (error > 0) + 0.5 * error, steering, 0.02)
    state = track.car.state()
    assert state.steering_angle == pytest.approx(steering * parameters.max_steering_angle, rel=0.01)
    radius = parameters.wheelbase / np.tan(state.steering_angle)
    assert state.speed / state.yaw_rate == pytest.approx(radius, rel=0.03)


@pytest.mark.parametrize("wanted", [1.5, 0.6, -2.0])
def test_pedal_of_the_drivetrain_gives_the_acceleration_that_is_wanted(track, wanted):
    drivetrain = Drivetrain.of(track.car.parameters)
    track.car.place(0.0, 0.0, 0.0, speed=8.0)
    track.drive(drivetrain.pedal(wanted, 8.0), 0.0, 1.0)
    before = track.car.state().speed
    pedal = drivetrain.pedal(wanted, before)
    track.drive(pedal, 0.0, 0.5)
    assert drivetrain.acceleration(pedal, before) == pytest.approx(wanted)
    assert (track.car.state().speed - before) / 0.5 == pytest.approx(wanted, abs=0.25)


def test_steering_follows_at_its_stated_rate(track):
    parameters = track.car.parameters
    duration = 0.5 * parameters.max_steering_angle / parameters.max_steering_rate
    track.drive(-1.0, 0.0, 0.5)
    track.drive(-1.0, 1.0, duration)
    turned = track.car.state().steering_angle / parameters.max_steering_angle
    assert 0.3 < turned < 0.55


def test_footprint_encloses_the_wheels(track):
    corners = track.car.footprint()
    wheels = track.car.wheel_contacts()
    assert (corners.min(axis=0) < wheels.min(axis=0)).all()
    assert (corners.max(axis=0) > wheels.max(axis=0)).all()
    mujoco.mj_kinematics(track.model, track.data)
    hubs = [track.data.body(f"wheel_{wheel}").xpos[:2] for wheel in WHEELS]
    assert wheels == pytest.approx(np.array(hubs), abs=1e-6)


def test_same_actions_give_the_same_bytes(track, request):
    other = Track(request.node.callspec.params["track"])
    assert track.digest_of_a_drive() == other.digest_of_a_drive()


def test_restored_car_repeats_its_future_bit_by_bit(track):
    track.drive(0.7, 0.3, 2.0)
    saved = track.car.save()
    first = track.digest_of_a_drive()
    track.drive(-1.0, 0.0, 2.0)
    track.car.restore(saved)
    assert track.digest_of_a_drive() == first


def test_hard_driving_warns_of_nothing(track):
    track.digest_of_a_drive()
    assert engine.num_warnings(track.data) == 0
    engine.require_sane(track.data)
