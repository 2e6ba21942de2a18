import hashlib

import numpy as np
import pytest
from lxml import etree

from mjdrive.errors import CarError, UnknownNameError, WorkerError
from mjdrive.vehicle import cars
from mjdrive.vehicle.assembly import car_on_road, car_path
from mjdrive.vehicle.parameters import VehicleParameters


def test_default_car_is_that_of_car_xml():
    car = cars.load()
    assert (car.name, car.path) == ("default", car_path())
    assert car.parameters == VehicleParameters.default()


@pytest.mark.parametrize("name", cars.SHIPPED)
def test_digest_of_a_single_file_is_its_sha256(name):
    car = cars.load(name)
    assert car.digest == hashlib.sha256(car.path.read_bytes()).hexdigest()


def test_numbers_of_the_scene_are_those_of_the_file(my_car):
    path = my_car(('data="6000"', 'data="5000"'))
    model = car_on_road(timestep=0.005, car=path).compile()
    assert VehicleParameters.of(model) == VehicleParameters.read(path) == cars.load(path).parameters
    assert cars.load(path).parameters.brake_torque == 5000


def test_car_of_ones_own_is_called_after_its_file(my_car):
    assert cars.load(my_car()).name == "my_car.xml"
    assert cars.load(str(my_car())).name == "my_car.xml"


def test_any_change_of_the_file_changes_the_digest(my_car):
    assert cars.load(my_car()).digest == cars.load().digest
    assert (
        cars.load(my_car(("<!-- Sprung mass;", "<!-- Sprung  mass;"))).digest != cars.load().digest
    )


def test_includes_and_meshes_beside_the_file_work_and_count(my_car, tmp_path):
    (tmp_path / "parts").mkdir()
    corners = np.array([[x, y, z] for x in (0, 3) for y in (-0.8, 0.8) for z in (0.3, 0.9)])
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    faces = [
        "f 1 2 4",
        "f 1 4 3",
        "f 5 7 8",
        "f 5 8 6",
        "f 1 5 6",
        "f 1 6 2",
        "f 3 4 8",
        "f 3 8 7",
        "f 1 3 7",
        "f 1 7 5",
        "f 2 6 8",
        "f 2 8 4",
    ]
    (tmp_path / "parts/box.obj").write_text("\n".join([*lines, *faces]))
    tyres = tmp_path / "tyres.xml"
    tyres.write_text(
        '<mujocoinclude><numeric name="tyre_vertical_damping" data="600"/></mujocoinclude>'
    )
    path = my_car(
        ('<numeric name="tyre_vertical_damping" data="600"/>', '<include file="tyres.xml"/>'),
        ('autolimits="true"/>', 'autolimits="true" meshdir="parts"/>'),
        ("</asset>", '<mesh name="box" file="box.obj"/></asset>'),
        ('<geom name="cabin"', '<geom class="paint" mesh="box"/><geom name="cabin"'),
    )
    car = cars.load(path)
    assert car.parameters.tyre_vertical_damping == 600
    content = b"".join(file.read_bytes() for file in (path, tyres, tmp_path / "parts/box.obj"))
    assert car.digest == hashlib.sha256(content).hexdigest()
    tyres.write_text(tyres.read_text().replace("600", "700"))
    assert cars.load(path).digest != car.digest
    assert cars.load(path).parameters.tyre_vertical_damping == 700


def test_unknown_name_lists_the_cars():
    with pytest.raises(
        UnknownNameError, match=r"Unknown car 'mzk'\. Known: default, mkz\. Did you mean 'mkz'\?"
    ):
        cars.load("mzk")


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(CarError, match=r"There is no car file .*absent\.xml'.*default, mkz"):
        cars.load(tmp_path / "absent.xml")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "hello",
        "<mujoco",
        "<html/>",
        "<mujoco><wheel/></mujoco>",
        '<mujoco><include file="no.xml"/></mujoco>',
    ],
)
def test_file_that_is_no_mjcf_is_refused_with_the_reason(tmp_path, text):
    path = tmp_path / "my_car.xml"
    path.write_text(text)
    with pytest.raises(
        CarError, match=r"MuJoCo cannot read the car file .*my_car\.xml': .*Expected MJCF"
    ):
        cars.load(path)


def test_robot_description_of_another_kind_lacks_every_name(tmp_path):
    path = tmp_path / "robot.xml"
    path.write_text('<robot name="r"><link name="l"/></robot>')
    with pytest.raises(CarError, match=r"lacks: body 'car' .*camera 'top'"):
        cars.load(path)


def test_part_without_inertia_is_refused(my_car):
    path = my_car(('<inertial pos="0 0 0" mass="2" diaginertia=".05 .05 .05"/>', ""))
    with pytest.raises(CarError, match="mass and inertia of moving bodies must be larger"):
        cars.load(path)


def test_mesh_that_is_missing_is_refused(my_car):
    path = my_car(("</asset>", '<mesh name="box" file="box.obj"/></asset>'))
    with pytest.raises(CarError, match=r"box\.obj"):
        cars.load(path)


def test_car_that_mujoco_warns_of_is_refused(my_car):
    with pytest.raises(CarError, match="Inertia matrix is too close to singular"):
        cars.load(my_car(('armature="4"', 'armature="-4.05"')))


def test_file_without_any_one_element_is_refused_or_drives_but_never_crashes(tmp_path):
    path = tmp_path / "my_car.xml"
    outcomes, messages = set(), []
    rng = np.random.default_rng(0)
    num_elements = sum(isinstance(e.tag, str) for e in etree.parse(car_path()).iter())
    for number in rng.choice(np.arange(1, num_elements), size=25, replace=False):
        document = etree.parse(car_path())
        element = [e for e in document.iter() if isinstance(e.tag, str)][number]
        element.getparent().remove(element)
        document.write(path)
        try:
            outcomes.add(type(cars.load(path)))
        except CarError as error:
            outcomes.add(CarError)
            messages.append(str(error))
    assert outcomes == {cars.CarModel, CarError}
    assert all("docs/cars.md" in message for message in messages)


def test_car_that_changed_or_went_since_it_was_loaded_is_refused(my_car):
    path = my_car()
    car = cars.load(path)
    cars.require_same(car)
    path.write_text(path.read_text() + "<!-- heavier -->")
    with pytest.raises(
        WorkerError, match=rf"expected the files that it was loaded from, {car.digest}"
    ):
        cars.require_same(car)
    path.unlink()
    with pytest.raises(WorkerError, match="nothing that can be read"):
        cars.require_same(car)
