import math

import numpy as np
import pytest

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL, SpeedHold
from mjdrive.manoeuvres.rig import GRAVITY, Rig

COAST = Action(0.0, 0.0)


def test_recording_has_a_row_each_update_and_begins_at_zero(rig):
    rig.drive(lambda _: COAST, duration=0.5)
    recording = rig.drive(lambda _: COAST, duration=1.0)
    assert recording.time == pytest.approx(np.arange(51) * UPDATE_INTERVAL)


def test_manoeuvre_ends_when_it_is_told_to(rig):
    rig.place(speed=10.0)
    recording = rig.drive(lambda _: COAST, duration=5.0, until=lambda moment: moment.x > 3.0)
    assert recording.x[-2] <= 3.0 < recording.x[-1]


def test_slope_pulls_the_car_back():
    slope = 0.1
    rig = Rig.of_car(slope=slope)
    recording = rig.drive(lambda _: COAST, duration=1.0)
    parameters = rig.car.parameters
    pull = parameters.mass * GRAVITY * math.sin(math.atan(slope))
    rolling = 4 * parameters.rolling_torque / parameters.wheel_radius
    wheels = 4 * parameters.wheel_inertia / parameters.wheel_radius**2
    expected = -(pull - rolling) / (parameters.mass + wheels)
    assert recording.speed[-1] == pytest.approx(expected, rel=0.03)


def test_friction_of_the_road_is_what_was_asked_for():
    assert Rig.of_car(friction=0.6).friction == 0.6


def test_speed_hold_holds(rig):
    hold = SpeedHold(15.0)
    rig.place(speed=15.0)
    recording = rig.drive(lambda moment: Action(hold(moment), 0.0), duration=10.0)
    assert recording.speed == pytest.approx(15.0, abs=0.3)
    assert recording.speed[-50:] == pytest.approx(15.0, abs=0.03)


def test_car_leans_out_of_a_left_turn_and_accelerates_into_it(rig):
    hold = SpeedHold(15.0)
    rig.place(speed=15.0)
    recording = rig.drive(lambda moment: Action(hold(moment), 0.08), duration=4.0)
    assert recording.roll[-1] > 0.01
    steady = recording.lateral_acceleration[-50:].mean()
    assert steady == pytest.approx(recording.centripetal_acceleration[-1], rel=0.02)
    # The pull towards the centre comes from path and speed alone, whatever turns with the car.
    radius = recording.speed[-1] / recording.yaw_rate[-1]
    assert steady == pytest.approx(recording.speed[-1] ** 2 / radius, rel=0.02)


def test_two_rigs_do_not_share_a_model():
    one, other = Rig.of_car(), Rig.of_car()
    one.drive(lambda _: Action(1.0, 0.5), duration=2.0)
    assert other.moment().speed == 0.0
    assert other.model.opt.impratio != one.model.opt.impratio
