"""Every bar of the plane holds, and the figures are those of closed forms."""

import dataclasses
import math

import numpy as np
import pytest

from mjdrive.manoeuvres import acceleration, braking, convergence, figures, standstill, step_steer
from mjdrive.manoeuvres.bars import failed
from mjdrive.manoeuvres.rig import GRAVITY, Rig


def test_every_bar_holds(driven):
    assert failed(driven.bars()) == ()


def test_there_is_a_bar_for_each_line_of_the_table(driven):
    names = {bar.manoeuvre.partition(",")[0] for bar in driven.bars()}
    assert names == {
        "acceleration", "braking", "steady circle", "step steer", "standstill", "turning circle",
    }  # fmt: skip
    assert len(driven.bars()) == 1 + 2 + 3 * 3 + 3 + 3 + 1


def test_acceleration_begins_with_the_torque_of_the_engine(driven, rig):
    parameters = rig.car.parameters
    recording = driven.acceleration
    force = (parameters.drive_torque - 4 * parameters.rolling_torque) / parameters.wheel_radius
    heavy = parameters.mass + 4 * parameters.wheel_inertia / parameters.wheel_radius**2
    after_the_lag = recording.time > 5 * parameters.throttle_lag
    assert recording.forward_acceleration[after_the_lag].max() == pytest.approx(
        force / heavy, rel=0.1
    )


def test_car_that_never_gets_there_has_no_time(driven):
    slow = dataclasses.replace(driven.acceleration, speed=0.5 * driven.acceleration.speed)
    assert math.isnan(acceleration.time_to_target(slow))
    assert failed(acceleration.bars(slow))


def test_closed_form_of_braking_doubles_on_half_the_friction():
    assert braking.stopping_distance(20.0, friction=0.5, lag=0.0) == pytest.approx(
        2 * braking.stopping_distance(20.0, friction=1.0, lag=0.0)
    )
    assert braking.stopping_distance(20.0, friction=1.0, lag=0.1) - braking.stopping_distance(
        20.0, friction=1.0, lag=0.0
    ) == pytest.approx(2.0)


def test_wet_road_takes_the_longer_distance_of_the_closed_form():
    stop = braking.brake(Rig.of_car(friction=0.6), 50)
    assert failed(braking.bars(stop)) == ()
    assert stop.distance > 1.4 * (50 / 3.6) ** 2 / (2 * GRAVITY)


def test_mean_deceleration_is_that_of_friction(driven):
    for stop in driven.stops:
        assert braking.mean_deceleration(stop) == pytest.approx(GRAVITY, rel=0.05)


def test_car_understeers_the_same_at_every_speed(driven):
    gradients = [circle.understeer_gradient for circle in driven.circles]
    assert gradients == pytest.approx(
        [driven.circles[0].single_track.understeer_gradient] * 3, rel=0.1
    )


def test_limit_is_below_the_friction_of_the_road(driven):
    for circle in driven.circles:
        assert circle.limit < GRAVITY
        assert circle.recording.lateral_acceleration.max() < 1.05 * GRAVITY


def test_roll_is_what_springs_and_bars_allow(driven, rig):
    """Moment of the sprung mass about the roll axis on the ground over the roll stiffness of springs and bars."""
    model, parameters = rig.model, rig.car.parameters
    sprung = float(model.body("car").mass[0])
    height = float(model.body("car").ipos[2])
    arm = (0.5 * parameters.track) ** 2
    stiffness = 2 * arm * sum(float(model.joint(f"susp_{axle}l").stiffness[0]) for axle in "fr")
    stiffness += parameters.track**2 * sum(
        float(model.tendon_stiffness[model.tendon(f"anti_roll_{axle}").id])
        for axle in ("front", "rear")
    )
    tyres = 4 * arm * parameters.tyre_vertical_stiffness
    in_series = 1 / (1 / stiffness + 1 / tyres)
    expected = sprung * height / (in_series - sprung * GRAVITY * height)
    assert driven.circles[-1].roll_gradient == pytest.approx(expected, rel=0.1)


def test_step_reaches_the_lateral_acceleration_it_is_made_for(driven):
    assert driven.step.lateral_acceleration == pytest.approx(step_steer.ACCELERATION, rel=0.05)


def test_step_response_follows_the_linear_model(driven):
    step, speed = driven.step, driven.step.speed_kmh / 3.6
    _, yaw_rate = step.single_track.respond(
        speed, step.recording.time, step.recording.steering_angle
    )
    difference = np.abs(step.recording.yaw_rate - yaw_rate).max()
    assert difference < 0.06 * step.steady_yaw_rate


def test_standing_car_that_slides_is_found_out(driven):
    rest = driven.standstills[0]
    x = rest.recording.x + np.linspace(0.0, 0.002, len(rest.recording.x))
    sliding = rest._replace(recording=dataclasses.replace(rest.recording, x=x))
    assert sliding.creep_mm == pytest.approx(2.0, abs=0.1)
    assert failed(standstill.bars(sliding))


def test_full_lock_is_ackermann(driven):
    circle = driven.turning_circle
    assert circle.radius == pytest.approx(circle.expected_radius, rel=0.02)
    assert circle.kerb_to_kerb == pytest.approx(10.9, abs=0.2)


def test_finer_timestep_that_changes_a_figure_is_found_out(driven):
    assert set(convergence.changes(driven, driven).values()) == {0.0}
    short, long = driven.stops
    slower = dataclasses.replace(driven, stops=(short._replace(recording=long.recording), long))
    changes = convergence.changes(driven, slower)
    assert max(changes, key=lambda name: abs(changes[name])) == "stop from 50 km/h"
    assert changes["stop from 50 km/h"] > convergence.MOST_CHANGE


@pytest.mark.parametrize("order", [("sound", "broken"), ("broken", "sound")])
def test_figure_that_is_no_number_at_the_finer_timestep_is_found_out(order):
    changed = {"sound": 1.0, "broken": math.nan}
    bar = convergence.worst_change({name: changed[name] for name in order}, 0.0025)
    assert not bar.holds
    assert bar.reason.startswith("broken")
    assert convergence.worst_change({"sound": -1.0, "small": 0.5}, 0.0025).measured == 1.0


def test_half_the_timestep_stops_and_turns_the_same(driven):
    finer = Rig.of_car(timestep=0.0025)
    stop = braking.brake(finer, 50)
    assert stop.distance == pytest.approx(driven.stops[0].distance, rel=0.01)
    step = step_steer.step(finer)
    assert step.gain == pytest.approx(driven.step.gain, rel=0.01)
    assert step.rise_time == pytest.approx(driven.step.rise_time, rel=0.05)


def test_pictures_are_small_and_the_same_for_the_same_drive(driven, tmp_path):
    drawn = figures.draw(driven, tmp_path / "first")
    assert [path.stem for path in drawn] == list(figures.DIAGRAMS)
    assert all(10_000 < path.stat().st_size < 150_000 for path in drawn)
    (again,) = figures.draw(driven, tmp_path / "second", ["step_steer"])
    assert again.read_bytes() == (tmp_path / "first" / "step_steer.png").read_bytes()
