"""The reference models against closed forms."""

import dataclasses
import math

import numpy as np
import pytest

from mjdrive.manoeuvres.single_track import SingleTrack, kinematic_yaw_rate

SPEED = 22.0
ANGLE = 0.03


def held(value: float, *, duration: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    time = np.arange(0.0, duration + 0.5 * step, step)
    return time, np.full(len(time), value)


def mass_of_thirds() -> SingleTrack:
    """Numbers with which closed forms can be worked out by hand."""
    return SingleTrack(
        mass=1500.0,
        yaw_inertia=2500.0,
        front=1.0,
        rear=2.0,
        stiffness_front=100e3,
        stiffness_rear=100e3,
    )


def test_understeer_gradient_of_simple_numbers():
    # 1500 / 3 (2 / 1e5 - 1 / 1e5)
    assert mass_of_thirds().understeer_gradient == pytest.approx(0.005)
    assert mass_of_thirds().characteristic_speed == pytest.approx(math.sqrt(3 / 0.005))


def test_car_with_balanced_axles_is_neutral(track):
    neutral = dataclasses.replace(
        track, stiffness_front=track.rear * 1e5, stiffness_rear=track.front * 1e5
    )
    assert neutral.understeer_gradient == pytest.approx(0.0, abs=1e-12)
    assert neutral.characteristic_speed > 1e6
    assert neutral.yaw_rate_gain(SPEED) == pytest.approx(SPEED / track.wheelbase)


def test_gain_is_largest_at_the_characteristic_speed(track):
    best = track.characteristic_speed
    speeds = np.linspace(0.5 * best, 1.5 * best, 2001)
    gains = [track.yaw_rate_gain(speed) for speed in speeds]
    assert speeds[int(np.argmax(gains))] == pytest.approx(best, rel=1e-3)
    # There it is half that of a neutral car.
    assert track.yaw_rate_gain(best) == pytest.approx(0.5 * best / track.wheelbase)


def test_integration_ends_in_the_closed_forms(track):
    time, angle = held(ANGLE, duration=5.0, step=0.01)
    lateral_speed, yaw_rate = track.respond(SPEED, time, angle)
    assert yaw_rate[-1] == pytest.approx(track.yaw_rate_gain(SPEED) * ANGLE, rel=1e-9)
    slip = lateral_speed[-1] / SPEED
    assert slip == pytest.approx(track.body_slip_gain(SPEED) * ANGLE, rel=1e-9)


def test_steady_state_balances_forces_and_moments(track):
    A, B = track.matrices(SPEED)
    steady = np.linalg.solve(A, -B * ANGLE)
    assert steady[1] == pytest.approx(track.yaw_rate_gain(SPEED) * ANGLE)
    assert steady[0] == pytest.approx(SPEED * track.body_slip_gain(SPEED) * ANGLE)


def test_step_response_is_that_of_a_second_order_system(track):
    """Yaw rate of a step from its transfer function, with one zero and two complex poles."""
    time, angle = held(ANGLE, duration=1.0, step=0.001)
    _, yaw_rate = track.respond(SPEED, time, angle)
    A, B = track.matrices(SPEED)
    poles, vectors = np.linalg.eig(A)
    steady = np.linalg.solve(A, -B * ANGLE)
    shares = np.linalg.solve(vectors, -steady.astype(complex))
    closed = steady[1] + (vectors[1] * shares * np.exp(np.outer(time, poles))).sum(axis=1).real
    assert yaw_rate == pytest.approx(closed, abs=1e-8)


def test_frequency_and_damping_are_those_of_the_poles(track):
    poles = np.linalg.eigvals(track.matrices(SPEED)[0])
    assert abs(poles[0]) == pytest.approx(track.natural_frequency(SPEED))
    assert -poles[0].real / abs(poles[0]) == pytest.approx(track.damping_ratio(SPEED))


def test_integration_is_of_fourth_order(track):
    errors = []
    for step in (0.04, 0.02, 0.01):
        time = np.arange(0.0, 0.4001, step)
        ramp = 0.1 * time  # linear between the times, as the integrator takes it
        fine = np.arange(0.0, 0.4001, 0.0005)
        exact = track.respond(SPEED, fine, 0.1 * fine)[1][-1]
        errors.append(abs(track.respond(SPEED, time, ramp)[1][-1] - exact))
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx([4.0, 4.0], abs=0.5)


def test_integration_goes_on_where_it_was_left(track):
    time, angle = held(ANGLE, duration=0.4, step=0.02)
    whole = track.respond(SPEED, time, angle)
    first = track.respond(SPEED, time[:11], angle[:11])
    start = np.array([first[0][-1], first[1][-1]])
    second = track.respond(SPEED, time[10:], angle[10:], start=start)
    assert second[0] == pytest.approx(whole[0][10:], abs=1e-12)
    assert second[1] == pytest.approx(whole[1][10:], abs=1e-12)


def test_slow_linear_car_turns_as_the_kinematic_one(track):
    speed, angle = 0.5, 0.01
    kinematic = kinematic_yaw_rate(speed, angle, wheelbase=track.wheelbase)
    assert track.yaw_rate_gain(speed) * angle == pytest.approx(kinematic, rel=1e-3)
    assert track.body_slip_gain(speed) == pytest.approx(track.rear / track.wheelbase, rel=1e-2)


def test_track_of_the_car_has_its_mass_and_geometry(rig):
    track, parameters = rig.single_track, rig.car.parameters
    assert track.mass == parameters.mass
    assert track.wheelbase == pytest.approx(parameters.wheelbase)
    assert track.rear == parameters.centre_of_gravity_ahead
    assert track.stiffness_front == 2 * parameters.cornering_stiffness_front


def test_yaw_inertia_adds_body_knuckles_and_wheels(rig):
    model, track = rig.model, rig.single_track
    about_centre = 0.0
    for index in range(1, model.nbody):
        inertia = model.body_inertia[index]
        # Of all bodies the vertical is the third principal axis, but of a wheel it is either small one.
        own = inertia[2] if model.body(index).name == "car" else min(inertia[0], inertia[2])
        rig.place()
        x, y, _ = rig.data.xipos[index]
        about_centre += own + model.body_mass[index] * ((x - track.rear) ** 2 + y**2)
    assert track.yaw_inertia == pytest.approx(about_centre, rel=1e-3)
