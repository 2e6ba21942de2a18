import mujoco
import pytest

from mjdrive.errors import CarError
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_path
from mjdrive.vehicle.car_file_checks import file_faults


@pytest.mark.parametrize("file", cars.SHIPPED.values())
def test_shipped_cars_leave_the_world_alone(file):
    assert list(file_faults(mujoco.MjSpec.from_file(str(car_path(file))))) == []


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("<custom>", '<option gravity="0 0 -1"/><custom>', "<option> sets gravity"),
        ("<custom>", '<option timestep="0.001" density="1.2"/><custom>', "<option> sets density, timestep"),
        ("<custom>", '<option><flag contact="disable"/></option><custom>', "<option> sets disableflags"),
        ('<default class="tyre">', '<geom contype="0"/><default class="tyre">', "default class sets contype of geom"),
        ('<default class="tyre">', '<mesh scale="2 2 2"/><default class="tyre">', "default class sets scale of mesh"),
        ('autolimits="true"', 'autolimits="true" discardvisual="true"', "discardvisual"),
        ("<worldbody>", '<worldbody><geom name="floor" type="plane" size="9 9 9"/>', "holds geoms 'floor'"),
        ("<worldbody>", '<worldbody><light name="sun"/><camera name="eye"/>', "lights 'sun', cameras 'eye'"),
        ("<worldbody>", '<worldbody><body name="cone"><geom size="1"/></body>', "bodies 'cone'; expected the body 'car' alone"),
        ("<equality>", '<contact><pair geom1="hull_low" geom2="tyre_fl"/></contact><equality>', "<contact> holds 1 pairs"),
    ],
)  # fmt: skip
def test_what_would_change_the_world_is_refused(my_car, old, new, found):
    with pytest.raises(CarError, match="cannot be put into a town") as caught:
        cars.load(my_car((old, new)))
    assert found in str(caught.value)


def test_options_at_their_defaults_are_no_fault(my_car):
    assert cars.load(my_car(("<custom>", '<option timestep="0.002"/><custom>'))).parameters.mass > 0
