import pytest

from mjdrive.errors import CarError
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_on_road, car_path
from mjdrive.vehicle.car_trial import trial_faults


@pytest.mark.parametrize("file", cars.SHIPPED.values())
def test_shipped_cars_pass(file):
    assert list(trial_faults(car_on_road(timestep=0.005, car=car_path(file)).compile())) == []


@pytest.mark.parametrize(
    ("changes", "found"),
    [
        ([('springref="-0.139624"', 'springref="0"')], "pitched 0.0"),
        ([('springref="-0.139624"', ""), ('springref="-0.121297"', "")], "mm deeper than on its tyres"),
        ([('gainprm="2400 0 -13.3333" biastype="none" forcerange="0 2400"', 'gainprm="20 0 -0.1" biastype="none" forcerange="0 20"')], "after 2 s of full throttle"),
        ([('kp="40000"', 'kp="400"')], "joint 'steer' is at"),
        ([('slewmax="0.8"', 'slewmax="0.1"')], "raise kp, forcerange or slewmax"),
        ([('<joint joint1="steer_fl" joint2="steer" polycoef="0 1.0021 .28609 .0534359 -.082257"/>', ""), ('<joint joint1="steer_fr" joint2="steer" polycoef="0 1.0021 -.28609 .0534359 .082257"/>', "")], "tie the front wheels to the joint 'steer'"),
        ([('polycoef="0 1.0021 ', 'polycoef="0 -1.0021 ')], "tie the front wheels to the joint 'steer'"),
    ],
)  # fmt: skip
def test_car_whose_motion_is_no_cars_is_refused(my_car, changes, found):
    with pytest.raises(CarError, match="does not drive as a car") as caught:
        cars.load(my_car(*changes))
    assert found in str(caught.value)


def test_car_that_flies_apart_is_refused_and_not_a_crash(my_car):
    path = my_car(('stiffness="28000"', 'stiffness="2.8e12"'))
    with pytest.raises(CarError, match="does not drive as a car"):
        cars.load(path)
