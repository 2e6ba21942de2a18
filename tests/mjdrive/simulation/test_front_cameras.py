import math
from collections.abc import Iterator

import mujoco
import numpy as np
import pytest

from mjdrive.config import CameraConfig
from mjdrive.datatypes import Action
from mjdrive.errors import ConfigError, RenderError
from mjdrive.simulation import opengl
from mjdrive.simulation.cameras import Cameras, Viewpoint
from mjdrive.simulation.front_cameras import NAMES, FrontCameras
from mjdrive.simulation.simulation import Simulation
from mjdrive.town import library

RIGHT_ANGLE = math.radians(90.0)
SMALL = CameraConfig(width_px=96, height_px=54)

BALL = """<mujoco><visual><headlight ambient="1 1 1"/></visual>
<worldbody><geom type="sphere" size="0.5" pos="{} {} {}" rgba="1 0 0 1"/></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    return Simulation(library.load("town02"))


@pytest.fixture(scope="module")
def cameras(simulation: Simulation) -> Iterator[FrontCameras]:
    with FrontCameras(simulation, SMALL) as cameras:
        yield cameras


def start(simulation: Simulation) -> None:
    lane = next(iter(simulation.town.lanes))
    simulation.reset(lane=lane, station=0.0, seed=0)


def place_of_ball(x: float, y: float, z: float) -> tuple[float, float]:
    """Row and column, over height and width, of a ball seen from the origin, looking along x with 90 degrees."""
    model = mujoco.MjModel.from_xml_string(BALL.format(x, y, z))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    ahead, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    with Cameras(model, width=100, height=100) as cameras:
        seen = cameras.render_from(data, [Viewpoint(np.zeros(3), ahead, up, RIGHT_ANGLE)])[0]
    rows, columns = np.nonzero(seen[..., 0] > 100)
    return float(rows.mean()) / 100, float(columns.mean()) / 100


@pytest.mark.parametrize(("y", "z"), [(0.0, 0.0), (7.5, 0.0), (-5.0, 2.5), (2.5, -7.5)])
def test_a_thing_is_seen_where_a_pinhole_camera_sees_it(y: float, z: float) -> None:
    expected = (0.5 - 0.5 * z / 10, 0.5 - 0.5 * y / 10)  # left is left, up is up
    assert place_of_ball(10.0, y, z) == pytest.approx(expected, abs=0.015)


def test_they_look_half_left_ahead_and_half_right_from_above_the_bonnet(
    simulation: Simulation, cameras: FrontCameras
) -> None:
    start(simulation)
    vehicle, parameters = simulation.vehicle, simulation.car.parameters
    middle = parameters.length / 2 - parameters.rear_overhang
    ahead = np.array([math.cos(vehicle.yaw), math.sin(vehicle.yaw), 0.0])
    place = np.array([vehicle.x, vehicle.y, 0.0]) + (middle + 1.2) * ahead
    place[2] = 1.3 + simulation.data.qpos[2]  # the tyres give a little
    expected = []
    for yaw in (vehicle.yaw + RIGHT_ANGLE / 2, vehicle.yaw, vehicle.yaw - RIGHT_ANGLE / 2):
        forward = np.array([math.cos(yaw), math.sin(yaw), 0.0])
        vertical = 2 * math.atan(54 / 96)  # 90 degrees from left to right
        expected.append(Viewpoint(place, forward, np.array([0.0, 0.0, 1.0]), vertical))
    seen = cameras.render().astype(float)
    with Cameras(simulation.model, width=96, height=54) as by_hand:
        meant = by_hand.render_from(simulation.data, expected, shadows=False)
    assert seen.shape == (len(NAMES), 54, 96, 3)
    for one, other in zip(seen, meant, strict=True):
        assert np.abs(one - other).mean() < 1.0
    assert np.abs(seen[0] - seen[2]).mean() > 10.0


def test_a_state_that_is_restored_looks_as_when_it_was_driven_to(
    simulation: Simulation, cameras: FrontCameras
) -> None:
    start(simulation)
    for _ in range(15):
        simulation.step(Action(1.0, 0.3))
    driven, then = cameras.render(), simulation.save()
    for _ in range(5):
        simulation.step(Action(1.0, -1.0))
    assert not np.array_equal(cameras.render(), driven)
    simulation.restore(then)
    assert np.array_equal(cameras.render(), driven)


def test_looking_changes_nothing(simulation: Simulation, cameras: FrontCameras) -> None:
    ends = []
    for looks in (True, False):
        start(simulation)
        for _ in range(8):
            simulation.step(Action(0.8, 0.5))
            if looks:
                cameras.render()
        ends.append(simulation.save().physics)
    assert np.array_equal(*ends)


def test_machine_without_opengl_is_told_what_to_install(
    simulation: Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(opengl.platform, "system", lambda: "Linux")
    monkeypatch.setattr(opengl.ctypes.util, "find_library", lambda name: None)
    with pytest.raises(RenderError, match="apt-get install libegl1"):
        FrontCameras(simulation)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("width_px", 0),
        ("height_px", 4),
        ("field_of_view", 4.0),
        ("sideways", -0.1),
        ("height", 0.0),
    ],
)
def test_setting_without_a_meaning_is_refused_by_name(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"{name} of the cameras is {value:g}"):
        CameraConfig(**{name: value})
