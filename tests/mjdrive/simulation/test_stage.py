import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Town
from mjdrive.simulation.stage import SUN, set_stage
from mjdrive.vehicle.assembly import car_on_road
from mjdrive.vehicle.car import Car


@pytest.fixture
def model() -> mujoco.MjModel:
    spec = car_on_road(timestep=0.005)
    set_stage(spec, Town("t", {}, {}, np.array([0.0, 0.0, 200.0, 100.0]), ""))
    return spec.compile()


def test_sun_stands_where_mujoco_throws_shadows_without_speckles():
    # MuJoCo takes the up direction of its shadow map from the z axis only if |y| of the rays is over one half.
    direction = SUN / np.linalg.norm(SUN)
    assert abs(direction[1]) > 0.5
    assert direction[2] < 0.0


def test_sun_follows_the_car(model):
    data = mujoco.MjData(model)
    car = Car(model, data)
    sun = model.light("sun").id
    offsets = []
    for x, y, yaw in ((0.0, 0.0, 0.0), (150.0, 80.0, 2.0)):
        car.place(x, y, yaw)
        mujoco.mj_forward(model, data)
        assert data.light_xdir[sun] == pytest.approx(SUN / np.linalg.norm(SUN), abs=1e-6)
        offsets.append(data.light_xpos[sun] - data.body("car").xpos)
    assert offsets[0] == pytest.approx(offsets[1], abs=1e-6)


def test_pictures_look_at_the_middle_of_the_town(model):
    assert model.stat.center == pytest.approx([100.0, 50.0, 0.0])
