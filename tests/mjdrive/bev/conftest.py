"""A camera of MuJoCo that sees what the projector should see."""

import functools
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mjdrive.datatypes import Lane, Signal, Town, TrafficLight
from mjdrive.errors import RenderError
from mjdrive.simulation import opengl

SAMPLES = 3  # a pixel, along rows and columns
SIZE = 192  # [px]
PIXEL = 0.2  # [m]

Pose = tuple[float, float, float]
LookDown = Callable[..., np.ndarray]


class Camera:
    """Looks straight down on some geoms of a model and tells them apart."""

    def __init__(self, model: mujoco.MjModel) -> None:
        side = SIZE * SAMPLES
        # With smooth edges the colours of two geoms would blend into the number of a third.
        model.vis.quality.offsamples = 0
        model.vis.global_.offwidth = model.vis.global_.offheight = side
        self.opengl = opengl.open_context(side, side)
        self.scene = mujoco.MjvScene(model, maxgeom=20_000)
        self.context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self.context)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        option, camera = mujoco.MjvOption(), mujoco.MjvCamera()
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(model, data, option, None, camera, everything, self.scene)
        self.numbers = {
            model.geom(geom.objid).name: geom.segid + 1  # 0 is the background
            for geom in self.scene.geoms[: self.scene.ngeom]
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM
        }
        self.scene.flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = True
        self.scene.flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True

    def touched(self, pose: Pose, *names: str) -> np.ndarray:
        """Where each of some geoms is seen in the view from a pose, shape (names, SIZE, SIZE)."""
        rectangle = mujoco.MjrRect(0, 0, SIZE * SAMPLES, SIZE * SAMPLES)
        self._look_down(pose)
        picture = np.empty((SIZE * SAMPLES, SIZE * SAMPLES, 3), np.uint8)
        mujoco.mjr_render(rectangle, self.scene, self.context)
        mujoco.mjr_readPixels(picture, None, rectangle, self.context)
        number = picture[::-1, :, 0] + (picture[::-1, :, 1].astype(np.uint16) << 8)
        bits = np.zeros(self.scene.ngeom + 1, np.uint8)  # one for each name
        for bit, name in enumerate(names):
            bits[self.numbers[name]] = 1 << bit
        blocks = bits[number].reshape(SIZE, SAMPLES, SIZE, SAMPLES)
        seen = np.bitwise_or.reduce(np.bitwise_or.reduce(blocks, axis=3), axis=1)
        return np.array([seen >> bit & 1 for bit in range(len(names))], bool)

    def _look_down(self, pose: Pose) -> None:
        """The ego point, 1.35 m ahead of the rear axle, lies in the middle of column 96, row 152."""
        x, y, yaw = pose
        forward = np.array([np.cos(yaw), np.sin(yaw)])
        left = np.array([-forward[1], forward[0]])
        middle = (SIZE - 1) / 2  # of the picture, if whole numbers are middles of pixels
        ahead = 1.35 + (SIZE - 40 - middle) * PIXEL
        aside = (SIZE / 2 - middle) * PIXEL
        for eye in self.scene.camera:
            eye.orthographic = 1
            eye.pos = [*(np.array([x, y]) + ahead * forward + aside * left), 30.0]
            eye.forward, eye.up = [0.0, 0.0, -1.0], [*forward, 0.0]
            eye.frustum_center, eye.frustum_width = 0.0, 0.5 * SIZE * PIXEL
            eye.frustum_bottom, eye.frustum_top = -0.5 * SIZE * PIXEL, 0.5 * SIZE * PIXEL
            eye.frustum_near, eye.frustum_far = 1.0, 100.0

    def close(self) -> None:
        self.opengl.make_current()
        self.context.free()
        self.opengl.free()


def street(*, x: float = 0.0, y: float = 0.0, yaw: float = 0.0, lane_width: float = 4.0) -> Town:
    """A straight street, a lane each way, 100 m to either side of (x, y), with a light at its far end."""
    along = np.array([np.cos(yaw), np.sin(yaw)])
    left = np.array([-along[1], along[0]])
    half = 0.5 * lane_width * left
    ends = np.array([x, y]) + np.outer([-100.0, 100.0], along)
    forward = Lane("forward", ends - half, lane_width, (), None, "light")
    back = Lane("back", (ends + half)[::-1], lane_width, (), None, None)
    end = forward.centerline[-1]
    light = TrafficLight(
        id="light",
        lane="forward",
        junction="j",
        stop_line=np.array([end + half, end - half]),
        yaw=yaw,
        pole=end,
        program=((Signal.GREEN, 10.0), (Signal.YELLOW, 3.0), (Signal.RED, 32.0)),
        offset=0.0,
    )
    bounds = np.array([x - 120, y - 120, x + 120, y + 120])
    return Town("street", {"forward": forward, "back": back}, {"light": light}, bounds, "")


@pytest.fixture(scope="session")
def make_street() -> Callable[..., Town]:
    return street


@functools.cache
def why_no_opengl() -> str:
    try:
        opengl.open_context(8, 8).free()
    except RenderError as error:
        return str(error)
    return ""


@pytest.fixture(scope="session")
def look_down() -> LookDown:
    """Take pictures of a model from poses: where each of some geoms is seen, shape (poses, names, SIZE, SIZE)."""
    if why_no_opengl():
        pytest.skip(why_no_opengl())

    def take(model: mujoco.MjModel, poses: list[Pose], *names: str) -> np.ndarray:
        camera = Camera(model)
        pictures = np.array([camera.touched(pose, *names) for pose in poses])
        camera.close()
        return pictures

    return take
