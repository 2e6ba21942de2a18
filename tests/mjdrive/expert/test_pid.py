import numpy as np
import pytest

from mjdrive.config import PidConfig
from mjdrive.datatypes import Lane, Situation, Town, VehicleState
from mjdrive.expert.pid import Pid, PidExpert
from mjdrive.town.route_line import lay
from mjdrive.vehicle import cars
from mjdrive.vehicle.parameters import VehicleParameters

LANE = Lane("lane", np.array([[0.0, 0.0], [100.0, 0.0]]), 4.0, (), None, None)
TOWN = Town("plain", {"lane": LANE}, {}, np.array([0.0, -2.0, 100.0, 2.0]), "")
ROUTE = lay(TOWN, ("lane",), start=0.0, end=100.0)


def situation(
    *, station: float = 20.0, offset: float = 0.0, yaw: float = 0.0, speed: float = 6.0
) -> Situation:
    state = VehicleState(station, offset, yaw, speed, 0.0, 0.0)
    return Situation(0.0, state, ROUTE, station, offset, {})


def first_action(car: VehicleParameters | None = None, **place: float):
    return PidExpert(TOWN, parameters=car).act(situation(**place))


def test_integral_sees_only_a_window_of_errors():
    pid = Pid((0.0, 1.0, 0.0), window=3, interval=0.5)
    assert [pid.step(error) for error in (2.0, 4.0, 6.0, 8.0)] == [1.0, 3.0, 6.0, 9.0]


def test_derivative_is_the_difference_over_the_interval():
    pid = Pid((0.0, 0.0, 2.0), window=5, interval=0.1)
    assert pid.step(1.0) == 0.0
    assert pid.step(1.5) == pytest.approx(2.0 * 0.5 / 0.1)


def test_car_right_of_the_route_steers_left_and_mirrored():
    left, right = first_action(offset=-1.0), first_action(offset=1.0)
    assert left.steering > 0.1
    assert right.steering == pytest.approx(-left.steering)


def test_slow_car_gets_throttle_and_fast_car_brakes():
    assert first_action(speed=2.0).acceleration > 0.5
    assert first_action(speed=8.0).acceleration < -0.5


def test_steering_cuts_the_throttle():
    straight, turning = first_action(speed=5.0), first_action(speed=5.0, yaw=0.4)
    assert 0 < turning.acceleration < straight.acceleration


def test_reset_forgets_the_past():
    expert = PidExpert(TOWN)
    first = expert.act(situation(offset=0.5))
    for _ in range(10):
        expert.act(situation(offset=0.7))
    expert.reset(1)
    assert expert.act(situation(offset=0.5)) == first


def test_target_is_papers_speed_of_six_metres_a_second():
    assert PidConfig().target_speed == 6.0
    assert PidConfig().turn_speed == 4.5


def test_throttle_of_a_car_with_a_dead_band_gets_over_it_however_it_steers():
    mkz = cars.load("mkz").parameters
    share = first_action(speed=0.0, yaw=1.0).acceleration
    throttle = first_action(mkz, speed=0.0, yaw=1.0).acceleration
    assert share < mkz.throttle_dead_band < throttle
    assert throttle == pytest.approx(
        mkz.throttle_dead_band + (1.0 - mkz.throttle_dead_band) * share
    )


def test_no_throttle_stays_none_with_a_dead_band():
    assert first_action(cars.load("mkz").parameters, speed=6.05).acceleration == 0.0
