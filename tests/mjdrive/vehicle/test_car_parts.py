import mujoco
import pytest

from mjdrive.errors import CarError
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_path
from mjdrive.vehicle.car_parts import PARTS, missing_parts


def test_empty_file_lacks_every_part():
    assert missing_parts(mujoco.MjSpec()) == PARTS


@pytest.mark.parametrize("file", cars.SHIPPED.values())
def test_shipped_cars_lack_nothing(file):
    assert missing_parts(mujoco.MjSpec.from_file(str(car_path(file)))) == ()


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.name)
def test_each_part_is_found_missing_by_its_own_name(part):
    text = car_path().read_text()
    assert f'name="{part.name}"' in text
    spec = mujoco.MjSpec.from_string(
        text.replace(f' name="{part.name}"', f' name="no_{part.name}"', 1)
    )
    assert missing_parts(spec) == (part,)


def test_all_gaps_are_named_at_once_with_their_purposes(my_car):
    path = my_car(
        ('name="brake"', 'name="brakes"'),
        ('"tyre_rl"', '"tire_rl"'),
        ('name="drag_area"', 'name="cda"'),
    )
    with pytest.raises(CarError) as caught:
        cars.load(path)
    message = str(caught.value)
    assert (
        "geom 'tyre_rl' (rear left tyre, an ellipsoid); actuator 'brake' (command 0 to 1" in message
    )
    assert "numeric 'drag_area' (drag coefficient times frontal area [m2])" in message
    assert message.count("; ") == 3  # one of them in the purpose of the brake
    assert "docs/cars.md" in message


def test_actuator_on_a_joint_that_is_missing_is_still_told_by_name(my_car):
    with pytest.raises(CarError, match=r"lacks: joint 'steer' \(hinge"):
        cars.load(my_car(('name="steer"', 'name="steering"')))
