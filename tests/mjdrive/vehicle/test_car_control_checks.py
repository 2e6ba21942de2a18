import pytest

from mjdrive.errors import CarError
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_on_road, car_path
from mjdrive.vehicle.car_control_checks import control_faults

PID = 'gear="1.666666666666667" ctrlrange="-1 1" input="pos" kp="40000" kv="600"\n         slewmax="0.8" forcerange="-4000 4000"'
GAIN = 'gainprm="2400 0 -13.3333" biastype="none"'
DRIVE = 'gainprm="2400 0 -13.3333" biastype="none" forcerange="0 2400"'
POSITION = '<position name="steering" joint="steer" gear="1.666666666666667" ctrlrange="-1 1" kp="40000" kv="600"/>'


@pytest.mark.parametrize("file", cars.SHIPPED.values())
def test_shipped_cars_have_no_fault(file):
    assert list(control_faults(car_on_road(timestep=0.005, car=car_path(file)).compile())) == []


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ('tendon="rear_axle" ctrlrange="0 1" dyntype="filterexact" dynprm="0.15"', 'tendon="rear_axle" dyntype="filterexact" dynprm="0.15"', "'throttle' has no ctrlrange=\"0 1\""),
        ('ctrlrange="0 1" dyntype="filterexact" dynprm="0.15"', 'ctrlrange="-1 1" dyntype="filterexact" dynprm="0.15"', "'throttle' has no ctrlrange=\"0 1\""),
        ('ctrlrange="-1 1"', 'ctrlrange="-2 2"', "'steering' has no ctrlrange=\"-1 1\""),
        ('joint="spin_rl" coef=".5"', 'joint="spin_rl" coef="1"', "'throttle' drives shares that add up to 1.5"),
        ('joint="spin_rl" coef=".5"', 'joint="susp_rl" coef=".5"', "'throttle' drives something else"),
        ('name="throttle" tendon="rear_axle"', 'name="throttle" joint="spin_rl"', "'throttle' drives something else"),
        ('name="throttle" tendon="rear_axle"', 'name="throttle" gear="2" tendon="rear_axle"', "expected gear 1"),
        (GAIN, 'gainprm="-2400 0 13.3333" biastype="none"', "a positive first gainprm"),
        (GAIN, 'gainprm="2400 5 -13.3333" biastype="none"', "has gainprm (2400, 5, -13.33)"),
        (GAIN, 'gainprm="2400 0 -13.3333" biastype="affine" biasprm="300 0 0"', "biasprm (300, 0, 0); expected gainprm"),
        (GAIN, 'gainprm="2400 0 -13.3333" biastype="affine" biasprm="-300 0 0"', "a negative share of it, the dead band"),
        (DRIVE, 'gainprm="2400 0 -13.3333" biastype="none"', "no forcerange from 0 to its torque from rest, 2400 N m"),
        (DRIVE, DRIVE.replace('"0 2400"', '"-2400 2400"'), "would drive backwards"),
        (DRIVE, DRIVE.replace('"0 2400"', '"0 1200"'), "or less than it says"),
        ('dyntype="filterexact" dynprm="0.15"', "", "'throttle' has no lag"),
        ('dyntype="filterexact" dynprm="0.15"', 'dyntype="integrator"', "'throttle' has no lag"),
        ('dyntype="filterexact" dynprm="0.08"', "", "'brake' has no lag"),
        ('gainprm="0" biastype="none"', 'gainprm="-500" biastype="none"', "'brake' exerts a force"),
        ('range="-0.60 0.60"', 'range="-0.60 0.50"', "range (-0.6, 0.5) rad; expected a hinge"),
        ('range="-0.60 0.60"', 'range="-1.5 1.5"', "at most 1.4 rad"),
        ('range="-0.60 0.60"', "", "range (0, 0) rad"),
        ('name="steer" axis="0 0 1"', 'name="steer" axis="0 0 -1"', "expected a hinge about (0, 0, 1)"),
        ('slewmax="0.8"', "", "'steering' is no `pid` with a slewmax"),
        ("<pid name=\"steering\" joint=\"steer\" " + PID + "/>", POSITION, "'steering' is no `pid` with a slewmax"),
        ('name="steering" joint="steer"', 'name="steering" joint="steer_fl"', "expected it on the joint 'steer'"),
        ('gear="1.666666666666667"', 'gear="1"', "gear 1; expected it on the joint 'steer' with 1 / (full lock in rad)"),
        ('joint1="spin_fr" active="false"', 'joint1="spin_fr"', "'lock_fr' is not asleep"),
        ('joint1="spin_fr" active="false"', 'joint1="spin_fl" active="false"', "'lock_fr' is not asleep on 'spin_fr' alone"),
        ('joint1="spin_fr" active="false"', 'joint1="spin_fr" joint2="spin_fl" active="false"', "'lock_fr' is not asleep"),
        ('data="65000 95000"', 'data="65000"', "'cornering_stiffness' is (6.5e+04); expected 2 from 1000 to 1e+06"),
        ('data="65000 95000"', 'data="65 95"', "'cornering_stiffness' is (65, 95); expected 2 from 1000 to 1e+06"),
        ('data="65000 95000"', 'data="65000 nan"', "'cornering_stiffness' is (6.5e+04, nan)"),
        ('armature="4" damping="20"', 'armature="4" damping="-20"', "'steer' has a negative frictionloss, damping or armature"),
        ('data="220000"', 'data="-220000"', "'tyre_vertical_stiffness' is (-2.2e+05); expected 1 from"),
        ('data="6000"', 'data="0"', "'brake_torque' is (0); expected 1 from"),
        ('data="0.66"/>          ', 'data="66"/>', "'brake_front_share' is (66); expected 1 from 0 to 1"),
        ('name="spin_rr" class="spin"', 'name="spin_rr" class="spin" frictionloss="90"', "frictionloss (14, 14, 14, 90); expected one for all"),
    ],
)  # fmt: skip
def test_what_would_break_the_physics_without_a_word_is_refused(my_car, old, new, found):
    with pytest.raises(CarError, match="cannot drive") as caught:
        cars.load(my_car((old, new)))
    assert found in str(caught.value)


def test_dead_band_is_read_from_the_throttle(my_car):
    banded = 'gainprm="3000 0 -15" biastype="affine" biasprm="-600 0 3" forcerange="0 2400"'
    car = cars.load(my_car((DRIVE, banded))).parameters
    assert (car.drive_torque, car.drive_torque_slope) == (2400, 12)
    assert car.throttle_dead_band == pytest.approx(0.2)
    assert cars.load().parameters.throttle_dead_band == 0.0
