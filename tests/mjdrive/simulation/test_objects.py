import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import StaticObject
from mjdrive.simulation.objects import add_objects
from mjdrive.simulation.palette import add_materials

HOOK = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [6.0, 9.0], [6.0, 3.0], [0.0, 3.0]])
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def scene(*objects: StaticObject) -> mujoco.MjModel:
    """The objects and a ball to touch them with."""
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_objects(spec, objects, rng=np.random.default_rng(0))
    ball = spec.worldbody.add_body(name="ball")
    ball.add_freejoint()
    ball.add_geom(name="ball", size=[0.3, 0.0, 0.0], contype=1, conaffinity=10)
    return spec.compile()


def touched(model: mujoco.MjModel, *where: float) -> set[str]:
    data = mujoco.MjData(model)
    data.qpos[:3] = where
    mujoco.mj_forward(model, data)
    return {model.geom(geom).name for geom in data.contact.geom.ravel()} - {"ball"}


def test_building_is_solid_and_its_hollow_is_not():
    model = scene(StaticObject("hook", "building", HOOK, 6.0))
    assert touched(model, 7.5, 6.0, 1.0)
    assert touched(model, 0.1, 1.5, 1.0)
    assert not touched(model, 3.0, 6.0, 1.0)
    assert not touched(model, 7.5, 6.0, 6.5)


def test_outline_that_runs_the_other_way_is_the_same_building():
    there, back = (
        scene(StaticObject("b", "building", points, 4.0)) for points in (SQUARE, SQUARE[::-1])
    )
    assert touched(there, 1.0, 1.0, 1.0) == touched(back, 1.0, 1.0, 1.0) == {"object_0_0"}


def test_tree_stops_a_car_by_its_trunk_and_not_by_its_crown():
    model = scene(StaticObject("oak", "tree", 2.0 * SQUARE, 8.0))
    assert touched(model, 2.0, 2.0, 1.0) == {"object_tree_0"}
    assert not touched(model, 2.9, 2.0, 1.0)


def test_objects_of_one_name_are_told_apart():
    poles = [StaticObject("p", "pole", SQUARE + np.array([x, 0.0]), 3.0) for x in (0.0, 5.0)]
    model = scene(*poles)
    assert touched(model, 0.0, 1.0, 1.0) != touched(model, 5.0, 1.0, 1.0)


@pytest.mark.parametrize("kind", ["tree", "building", "barrier"])
def test_outline_without_area_is_left_out(kind):
    line = np.array([[0.0, 0.0], [5.0, 0.0], [2.0, 0.0]])
    assert scene(StaticObject("line", kind, line, 3.0)).ngeom == 1


def test_outline_that_crosses_itself_can_be_built():
    bow = np.array([[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]])
    model = scene(StaticObject("bow", "building", bow, 5.0))
    assert touched(model, 0.7, 2.0, 1.0)
    assert not touched(model, 2.0, 0.3, 1.0)


@pytest.mark.parametrize("thickness", [1e-7, 4e-4, 0.02])
def test_a_wall_stops_a_car_however_thin_the_map_draws_it(thickness):
    turn = np.array([[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]])
    outline = np.array([[0.0, 0.0], [8.0, 0.0], [8.0, thickness], [0.0, thickness]]) @ turn
    model = scene(StaticObject("wall", "barrier", outline, 2.0))
    assert touched(model, *(np.array([4.0, 0.5 * thickness]) @ turn), 1.0)
    assert not touched(model, *(np.array([4.0, 1.0]) @ turn), 1.0)
