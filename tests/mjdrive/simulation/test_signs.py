import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Sign
from mjdrive.simulation.palette import add_materials
from mjdrive.simulation.signs import BOARD_HEIGHT, BOARD_RADIUS, RIM_SHARE, add_signs


def scene(*signs: Sign) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    add_materials(spec)
    add_signs(spec, signs)
    return spec.compile()


def limit(value: float, **more: object) -> Sign:
    where = {"x": 10.0, "y": -5.0, "yaw": 0.0} | more
    return Sign(id="7", type="274", value=float(value), unit="km/h", **where)


def world_points(model: mujoco.MjModel, name: str) -> np.ndarray:
    mesh, geom = model.mesh(name), model.geom(name)
    points = model.mesh_vert[mesh.vertadr[0] :][: mesh.vertnum[0]]
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, geom.quat)
    return points @ turn.reshape(3, 3).T + geom.pos


def num_strokes(value: float) -> int:
    return len(world_points(scene(limit(value)), "boards_sign_black")) // 4


def test_post_stands_where_the_map_says_and_can_be_hit():
    post = scene(limit(30)).geom("sign_7")
    assert post.pos[:2] == pytest.approx([10.0, -5.0])
    assert post.contype[0]


@pytest.mark.parametrize(
    ("number", "strokes"), [(1, 2), (8, 7), (30, 5 + 6), (60, 6 + 6), (117, 2 + 2 + 3)]
)
def test_number_is_drawn_in_seven_segments(number, strokes):
    assert num_strokes(number) == strokes


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.0])
def test_number_faces_the_approaching_driver(yaw):
    model = scene(limit(50, yaw=yaw))
    ahead = np.array([np.cos(yaw), np.sin(yaw)])
    post = model.geom("sign_7").pos[:2]
    digits = (world_points(model, "boards_sign_black")[:, :2] - post) @ ahead
    rim = (world_points(model, "boards_sign_red")[:, :2] - post) @ ahead
    assert digits.max() < rim.min() < 0.0


def test_digits_read_from_left_to_right_for_the_driver():
    # "18": the 1 is slender, so more paint lies on the right, which is south of a driver heading east.
    points = world_points(scene(limit(18)), "boards_sign_black")
    assert points[:, 1].mean() < -5.0


@pytest.mark.parametrize("number", [5, 60, 88, 100, 130])
def test_number_fits_the_white_of_the_board(number):
    points = world_points(scene(limit(number)), "boards_sign_black")
    assert (
        np.hypot(points[:, 1] + 5.0, points[:, 2] - BOARD_HEIGHT).max() < RIM_SHARE * BOARD_RADIUS
    )


def test_other_signs_are_blank_boards():
    model = scene(Sign(id="1", type="205", value=-1.0, unit="", x=0.0, y=0.0, yaw=0.0))
    names = {model.geom(index).name for index in range(model.ngeom)}
    assert names == {"sign_1", "boards_zinc", "boards_sign_white"}
