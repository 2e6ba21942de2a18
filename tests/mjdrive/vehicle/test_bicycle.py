import casadi as ca
import numpy as np
import pytest

from mjdrive.vehicle.bicycle import Bicycle, BicycleInput, BicycleState, Trigonometry
from mjdrive.vehicle.parameters import VehicleParameters

NUMBERS = Trigonometry(np.sin, np.cos, np.tan)
SYMBOLS = Trigonometry(ca.sin, ca.cos, ca.tan)
CAR = VehicleParameters.default()
BICYCLE = Bicycle.of(CAR)
COAST = BicycleInput(0.0, 0.0)


def drive(
    state: BicycleState, *, duration: float, interval: float, curvature: float = 0.0
) -> BicycleState:
    for _ in range(round(duration / interval)):
        state = BICYCLE.step(state, COAST, interval=interval, curvature=curvature, maths=NUMBERS)
    return state


def test_numpy_and_casadi_compute_the_same_step():
    symbols = ca.SX.sym("state", 7), ca.SX.sym("drive", 2), ca.SX.sym("curvature")
    step = BICYCLE.step(
        BicycleState(*ca.vertsplit(symbols[0])),
        BicycleInput(*ca.vertsplit(symbols[1])),
        interval=0.1,
        curvature=symbols[2],
        maths=SYMBOLS,
    )
    function = ca.Function("step", list(symbols), [ca.vertcat(*step)])
    rng = np.random.default_rng(0)
    for _ in range(20):
        state, inputs, curvature = rng.normal(size=7) * 0.3, rng.normal(size=2), rng.normal() * 0.1
        expected = BICYCLE.step(
            BicycleState(*state),
            BicycleInput(*inputs),
            interval=0.1,
            curvature=curvature,
            maths=NUMBERS,
        )
        found = np.asarray(function(state, inputs, curvature).full()).ravel()
        np.testing.assert_allclose(found, expected, atol=1e-14)


def test_slow_car_turns_on_the_radius_of_wheelbase_over_tangent():
    curvature = BICYCLE.path_curvature(0.4, 0.1, NUMBERS)
    assert 1 / curvature == pytest.approx(CAR.wheelbase / np.tan(0.4), rel=1e-3)


def test_fast_car_needs_more_lock_for_the_same_bend():
    slow, fast = (BICYCLE.path_curvature(0.1, speed, NUMBERS) for speed in (1.0, 20.0))
    assert fast < slow
    assert BICYCLE.understeer == pytest.approx(np.radians(1.7) / 9.81, rel=0.05)  # 1.7 deg/g


def test_car_that_follows_a_bend_keeps_its_place_on_it():
    speed, curvature = 4.0, 0.15
    angle = np.arctan(curvature * (CAR.wheelbase + BICYCLE.understeer * speed**2))
    slip = BICYCLE.rear_compliance * speed**2 * curvature
    start = BicycleState(0.0, 0.0, slip, speed, 0.0, angle, 0.0)
    end = drive(start, duration=3.0, interval=0.1, curvature=curvature)
    assert end.station == pytest.approx(12.0, rel=1e-6)
    assert (end.offset, end.heading_error) == pytest.approx((0.0, slip), abs=1e-6)


def test_path_does_not_hang_on_the_line_that_it_is_measured_from():
    """Along a straight line and along a circle the same drive ends at the same place of the world."""
    state = BicycleState(0.0, 0.3, 0.1, 3.0, 0.2, 0.12, 0.0)
    straight = drive(state, duration=2.0, interval=0.01)
    curvature = 0.1
    bent = drive(state, duration=2.0, interval=0.01, curvature=curvature)
    angle, radius = curvature * bent.station, 1 / curvature - bent.offset
    place = np.array([np.sin(angle), -np.cos(angle)]) * radius + np.array([0.0, 1 / curvature])
    np.testing.assert_allclose(place, [straight.station, straight.offset], atol=1e-4)
    assert bent.heading_error + angle == pytest.approx(straight.heading_error, abs=1e-4)


def test_error_of_a_drive_falls_with_the_square_of_the_interval():
    state = BicycleState(0.0, 0.3, 0.1, 5.0, 0.5, 0.2, 0.0)
    exact = drive(state, duration=2.0, interval=0.001, curvature=0.1)
    errors = [
        abs(drive(state, duration=2.0, interval=interval, curvature=0.1).offset - exact.offset)
        for interval in (0.1, 0.05)
    ]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)


def test_model_turns_as_the_car_does(ground):
    ground.car.place(0.0, 0.0, 0.0, 5.0)
    ground.cruise(5.0, 0.3, 5.0)
    state = ground.car.state()
    assert state.yaw_rate / state.speed == pytest.approx(
        BICYCLE.path_curvature(state.steering_angle, state.speed, NUMBERS), rel=0.01
    )
