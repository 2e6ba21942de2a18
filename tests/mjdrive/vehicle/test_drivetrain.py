import numpy as np
import pytest

from mjdrive.vehicle.drivetrain import Drivetrain
from mjdrive.vehicle.parameters import VehicleParameters

DRIVETRAIN = Drivetrain.of(VehicleParameters.default())


@pytest.mark.parametrize("speed", [0.5, 6.0, 25.0])
@pytest.mark.parametrize("pedal", [-1.0, -0.3, 0.0, 0.2, 1.0])
def test_pedal_undoes_acceleration(pedal: float, speed: float):
    acceleration = DRIVETRAIN.acceleration(pedal, speed)
    assert DRIVETRAIN.pedal(acceleration, speed) == pytest.approx(pedal, abs=1e-12)


def test_more_than_the_car_can_give_is_full_pedal():
    assert DRIVETRAIN.pedal(50.0, 5.0) == 1.0
    assert DRIVETRAIN.pedal(-50.0, 5.0) == -1.0


def test_rolling_car_slows_down_without_a_pedal_and_the_lag_is_that_of_the_pedal_used():
    resistance = DRIVETRAIN.resistance(10.0)
    assert DRIVETRAIN.pedal(-resistance, 10.0) == pytest.approx(0.0)
    assert DRIVETRAIN.lag(-0.5 * resistance, 10.0) == DRIVETRAIN.throttle_lag
    assert DRIVETRAIN.lag(-2.0 * resistance, 10.0) == DRIVETRAIN.brake_lag


@pytest.mark.parametrize("wanted", [1.5, 0.4, -1.0, -3.0])
def test_car_takes_the_acceleration_that_was_wanted(wanted: float, ground):
    ground.car.place(0.0, 0.0, 0.0, 8.0)
    ground.drive(0.02, 0.0, 1.0)
    reached = []
    for _ in range(60):
        before = ground.car.state().speed
        ground.drive(DRIVETRAIN.pedal(wanted, before), 0.0, 0.02)
        reached.append((ground.car.state().speed - before) / 0.02)
    assert np.mean(reached[30:]) == pytest.approx(wanted, abs=0.12)


@pytest.mark.parametrize(("before", "wanted"), [(0.0, 1.0), (1.0, 0.4), (-0.5, -1.5)])
def test_pedal_beats_its_own_lag(before: float, wanted: float):
    interval, speed = 0.1, 5.0
    pedal = DRIVETRAIN.pedal_towards(wanted, before=before, speed=speed, interval=interval)
    target = DRIVETRAIN.acceleration(pedal, speed)
    left = np.exp(-interval / DRIVETRAIN.lag(wanted, speed))
    assert target + (before - target) * left == pytest.approx(wanted)
