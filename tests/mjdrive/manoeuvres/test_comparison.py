"""Our laws with the numbers of a BMW beside CommonRoad's multi-body model of it."""

import json
import math

import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.errors import MissingPackageError
from mjdrive.manoeuvres import bmw_320i, comparison, comparison_figure, multi_body, step_steer
from mjdrive.manoeuvres.comparison import Behaviour, Comparison
from mjdrive.manoeuvres.rig import Rig
from mjdrive.manoeuvres.single_track_cars import LinearCar
from mjdrive.manoeuvres.steady_circle import Circle
from mjdrive.manoeuvres.step_steer import Step


@pytest.fixture(scope="module")
def bmw() -> Rig:
    return bmw_320i.rig()


@pytest.fixture(scope="module")
def our_step(bmw: Rig) -> Step:
    return step_steer.step(bmw)


@pytest.fixture(scope="module")
def behaviour(track) -> Behaviour:
    """Of the linear model with the numbers of our car: quick to drive."""
    car = LinearCar(track, max_steering_angle=0.6, steering_rate=0.48)
    circles = {kmh: comparison.steady_circle.circle(car, kmh) for kmh in (30, 80)}
    return Behaviour(circles, step_steer.step(car), slides=False)


def test_our_bmw_has_the_numbers_of_theirs(bmw):
    theirs = multi_body.single_track(multi_body.bmw_320i())
    ours = bmw.single_track
    assert ours.mass == pytest.approx(theirs.mass)
    assert ours.yaw_inertia == pytest.approx(theirs.yaw_inertia)
    assert ours.front == pytest.approx(theirs.front)
    assert ours.rear == pytest.approx(theirs.rear)
    assert ours.stiffness_front == pytest.approx(theirs.stiffness_front)
    assert ours.stiffness_rear == pytest.approx(theirs.stiffness_rear)


def test_our_bmw_stands_level_on_its_springs(bmw):
    bmw.place()
    bmw.drive(lambda _: Action(-1.0, 0.0), duration=3.0)
    travel = [float(bmw.data.joint(f"susp_{wheel}").qpos[0]) for wheel in ("fl", "fr", "rl", "rr")]
    assert travel == pytest.approx([0.0] * 4, abs=2e-3)


def test_front_wheels_of_our_bmw_are_parallel(bmw):
    bmw.place(speed=3.0)
    bmw.drive(lambda _: Action(0.1, 0.5), duration=3.0)
    left, right = (float(bmw.data.joint(f"steer_{side}").qpos[0]) for side in ("fl", "fr"))
    assert left == pytest.approx(right, abs=2e-3)
    assert left == pytest.approx(bmw.moment().steering_angle, abs=2e-3)


def test_multi_body_model_rolls_on_straight_and_turns_left_for_positive_steering():
    car = multi_body.MultiBodyCar()
    car.place(speed=20.0)
    straight = car.drive(lambda _: Action(0.0, 0.0), duration=0.5)
    assert abs(straight.y[-1]) < 1e-3
    assert straight.x[-1] - straight.x[0] == pytest.approx(10.0, rel=0.01)
    left = car.drive(lambda _: Action(0.0, 0.02), duration=1.0)
    assert left.yaw_rate[-1] > 0.05
    assert left.y[-1] > 0.1
    assert left.roll[-1] > 0.005  # leans to the right


def test_yaw_rate_gains_of_our_bmw_and_theirs_agree(our_step):
    theirs = step_steer.step(multi_body.MultiBodyCar())
    assert our_step.gain == pytest.approx(theirs.gain, rel=0.05)
    assert our_step.recording.body_slip[-1] == pytest.approx(
        theirs.recording.body_slip[-1], abs=math.radians(0.3)
    )


def test_gyroscopic_moment_of_the_wheels_is_what_makes_our_bmw_slower(our_step):
    light = bmw_320i.rig().model
    for wheel in ("fl", "fr", "rl", "rr"):
        light.body(f"wheel_{wheel}").inertia[1] = 0.2
    without = step_steer.step(Rig(light))
    assert our_step.rise_time > 1.3 * without.rise_time
    assert without.gain == pytest.approx(our_step.gain, rel=0.01)


def test_figures_name_what_a_model_has_no_answer_for(behaviour):
    figures = behaviour.figures()
    assert math.isnan(figures["80 km/h, limit"][1])
    assert math.isnan(figures["80 km/h, roll"][1])
    unit, angle = figures["80 km/h, steer at 4 m/s2"]
    speed = 80 / 3.6
    expected = 4.0 / (speed * behaviour.step.single_track.yaw_rate_gain(speed))
    assert unit == "deg"
    assert angle == pytest.approx(math.degrees(expected), rel=0.02)


def test_acceleration_that_is_never_reached_has_no_angle(behaviour):
    circle: Circle = behaviour.circles[30]
    assert math.isnan(comparison.steering_angle_at(circle, 1000.0))


def test_comparison_is_written_and_drawn(behaviour, tmp_path):
    compared = [Comparison("a car", {"car": behaviour, comparison.LINEAR: behaviour})]
    comparison.write(compared, tmp_path / "comparison.json")
    read = json.loads((tmp_path / "comparison.json").read_text())
    assert list(read["a car"]) == ["car", comparison.LINEAR]
    assert read["a car"]["car"]["80 km/h, limit"] == {"unit": "g", "value": None}
    gain = read["a car"]["car"]["80 km/h, yaw-rate gain"]["value"]
    assert np.isclose(gain, behaviour.step.gain)
    comparison_figure.draw(compared, tmp_path / "one.png")
    comparison_figure.draw(compared, tmp_path / "two.png")
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()


def test_missing_package_is_named_with_the_way_to_install_it(monkeypatch):
    monkeypatch.setattr(multi_body, "is_installed", lambda: False)
    with pytest.raises(MissingPackageError, match="pip install commonroad-vehicle-models"):
        multi_body.MultiBodyCar()
