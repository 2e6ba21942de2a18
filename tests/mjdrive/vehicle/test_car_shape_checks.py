import mujoco
import pytest

from mjdrive.errors import CarError
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_on_road, car_path
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.car_shape_checks import shape_faults


def swapped(one: str, other: str) -> list[tuple[str, str]]:
    """Changes that exchange two words."""
    return [(one, "\0"), (other, one), ("\0", other)]


@pytest.mark.parametrize("file", cars.SHIPPED.values())
def test_shipped_cars_have_no_fault(file):
    assert list(shape_faults(car_on_road(timestep=0.005, car=car_path(file)).compile())) == []


@pytest.mark.parametrize(
    ("changes", "found"),
    [
        ([("<freejoint name=\"root\"/>", '<joint name="root" type="slide" axis="1 0 0"/>')], "'root' does not free the body"),
        ([('<body name="car">', '<body name="car" pos="0 0 .2">')], "body 'car' begins at (0, 0, 0.2) m"),
        ([('<body name="car">', '<body name="car" euler="0 0 .1">')], "or is turned"),
        ([('mass="1438" diaginertia="520 2300 2450"', 'mass="14.38" diaginertia="5.2 23 24.5"')], "the car weighs 176 kg"),
        ([('mass="1438" diaginertia', 'mass="14380" diaginertia')], "the car weighs 14,542 kg"),
        (swapped("wheel_fl", "wheel_rl"), "hub of 'wheel_fl' is at (0, 0.77, 0.316) m; expected it ahead of the origin"),
        (swapped("wheel_fl", "wheel_fr"), "hub of 'wheel_fl' is at (2.7, -0.77, 0.316) m"),
        (swapped("wheel_rl", "wheel_rr"), "hub of 'wheel_rl' is at (0, -0.77, 0.316) m; expected (0, 0.77, 0.316) m"),
        ([('pos="0 .77 .316"', 'pos=".1 .77 .316"')], "hub of 'wheel_rl' is at (0.1, 0.77, 0.316) m"),
        ([('pos="2.70 .77 .316"', 'pos="2.70 .70 .316"')], "hub of 'wheel_fr'"),
        ([(".77 .316\"", '.77 .516"')], "(0, 0.77, 0.516) m; expected (0, 0.77, 0.316) m"),
        ([('axis="0 1 0"', 'axis="0 -1 0"')], "'spin_rr' is no hinge of 'wheel_rr' without limits about the axis (0, 1, 0)"),
        ([('name="spin_rl"', 'name="spin_rl" range="-1 1"')], "'spin_rl' is no hinge"),
        ([('type="ellipsoid"', 'type="sphere"')], "'tyre_rr' is no ellipsoid with a radius of 0.316 m"),
        ([('size="0.316 0.1025 0.316"', 'size="0.316 0.1025 0.400"')], "'tyre_fl' is no ellipsoid"),
        ([('name="tyre_rr"', 'name="tyre_rr" size="0.330 0.1025 0.330"')], "'tyre_rr' is no ellipsoid with a radius of 0.316 m"),
        ([('name="tyre_rl"', 'name="tyre_rl" pos="0 .2 0"')], "'tyre_rl' does not lie in the middle of the body 'wheel_rl'"),
        ([('name="tyre_rl"', 'name="tyre_rl" priority="0"')], "'tyre_rl' has priority 0; expected 1"),
        ([('contype="4" conaffinity="2"', 'contype="1" conaffinity="1"')], "'tyre_fl' has contype/conaffinity 1/1; expected 4/2"),
        ([('name="hull_top" class="hull"', 'name="hull_top" class="hull" contype="1"')], "'hull_top' has contype/conaffinity 1/10; expected 0/8 or 0/10"),
        ([('name="hull_top"', 'name="bumper"')], "'bumper' has contype/conaffinity 0/10; expected 0/0"),
        ([('name="hull_low" class="hull"', 'name="hull_low" class="hull" euler="0 0 .1"')], "'hull_low' is not an unturned box"),
        ([('pos="1.35 0 .48"', 'pos="3.55 0 .48"')], "'hull_low' reaches from (1.35, -0.88) to (5.75, 0.88) m; expected it over all four hubs"),
        ([('size="2.20 .88 .28"', 'size="22 .88 .28"')], "expected it over all four hubs and at most 20 m by 4 m"),
        ([('pos="1.35 0 .48"', 'pos="nan 0 .48"')], "'hull_low' reaches from (nan, -0.88)"),
    ],
)  # fmt: skip
def test_what_would_break_the_physics_without_a_word_is_refused(my_car, changes, found):
    with pytest.raises(CarError, match="cannot drive") as caught:
        cars.load(my_car(*changes))
    assert found in str(caught.value)


def test_all_faults_are_named_at_once(my_car):
    changes = [
        ('name="tyre_rl"', 'name="tyre_rl" priority="0"'),
        ('name="spin_fl"', 'name="spin_fl" range="-1 1"'),
    ]
    with pytest.raises(CarError, match=r"spin_fl.*; .*tyre_rl"):
        cars.load(my_car(*changes))


def test_every_hull_counts_as_hull(my_car):
    boot = (
        '<geom name="hull_boot" class="hull" pos="-.5 0 .9" size=".3 .6 .1"/><geom name="hull_low"'
    )
    model = car_on_road(timestep=0.005, car=my_car(('<geom name="hull_low"', boot))).compile()
    hull = {model.geom(number).name for number in Car(model, mujoco.MjData(model)).hull_geoms}
    assert hull == {"hull_boot", "hull_low", "hull_top"}


def test_parts_of_ones_own_are_welcome(my_car):
    boot = (
        '<geom name="hull_boot" class="hull" pos="-.5 0 .9" size=".3 .6 .1"/><geom name="hull_low"'
    )
    flag = (
        '<body name="flag" pos="0 0 1.4"><joint type="hinge" axis="1 0 0" stiffness="5" damping="1"/>'
        '<geom class="shown" type="capsule" size=".01 .3"/><inertial pos="0 0 .1" mass=".1" diaginertia=".01 .01 .01"/>'
        '</body><body name="rack"'
    )
    assert (
        cars.load(
            my_car(('<geom name="hull_low"', boot), ('<body name="rack"', flag))
        ).parameters.mass
        > 1600
    )
