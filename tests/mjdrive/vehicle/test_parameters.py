import mujoco
import pytest

from mjdrive.vehicle.assembly import WHEELS, car_on_road, car_path
from mjdrive.vehicle.parameters import VehicleParameters


def test_numbers_are_those_of_the_mjcf(tmp_path):
    text = car_path().read_text().replace('range="-0.60 0.60"', 'range="-0.50 0.50"')
    other = tmp_path / "car.xml"
    other.write_text(text)
    assert VehicleParameters.default().max_steering_angle == 0.6
    assert VehicleParameters.read(other).max_steering_angle == 0.5


def test_saloon_has_the_size_of_a_saloon():
    car = VehicleParameters.default()
    assert car.mass == pytest.approx(1600)
    assert (car.wheelbase, car.track) == pytest.approx((2.7, 1.54))
    assert (car.length, car.width) == pytest.approx((4.4, 1.76))
    assert (car.front_overhang, car.rear_overhang) == pytest.approx((0.85, 0.85))
    assert (car.centre_of_gravity_ahead, car.centre_of_gravity_height) == pytest.approx(
        (1.48, 0.55), abs=1e-3
    )


def test_full_command_is_full_lock_at_the_stated_rate():
    car = VehicleParameters.default()
    steering = car_on_road(timestep=0.005).compile().actuator("steering")
    assert 1.0 / steering.gear[0] == pytest.approx(car.max_steering_angle)
    assert car.max_steering_rate == pytest.approx(0.48)


def test_pedals_have_the_lags_and_the_torque_curve_of_the_mjcf(tmp_path):
    car = VehicleParameters.default()
    assert (car.throttle_lag, car.brake_lag) == (0.15, 0.08)
    assert car.drive_torque / car.drive_torque_slope == pytest.approx(180.0, rel=1e-5)
    assert car.wheel_inertia == pytest.approx(1.1)
    prompt = tmp_path / "car.xml"
    lagged = 'dyntype="filterexact" dynprm="0.08"'
    assert lagged in car_path().read_text()
    prompt.write_text(car_path().read_text().replace(lagged, ""))
    assert VehicleParameters.read(prompt).brake_lag == 0.0


def test_springs_carry_the_resting_car_at_zero_travel(ground):
    ground.drive(-1.0, 0.0, 3.0)
    travel = [float(ground.data.joint(f"susp_{wheel}").qpos[0]) for wheel in WHEELS]
    assert travel == pytest.approx([0.0] * 4, abs=1e-3)


def test_all_tyres_belong_to_a_pair_with_the_road():
    model = car_on_road(timestep=0.005, friction=0.6).compile()
    assert isinstance(model, mujoco.MjModel)
    assert model.npair == len(WHEELS)
    assert set(model.pair_geom1.tolist() + model.pair_geom2.tolist()) == {
        model.geom(name).id for name in ("road", *(f"tyre_{wheel}" for wheel in WHEELS))
    }
    assert model.pair_friction[:, 0] == pytest.approx([0.6] * 4)
