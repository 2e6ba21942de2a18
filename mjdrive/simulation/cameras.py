"""Pictures of a scene, drawn without a display."""

from collections.abc import Sequence
from types import TracebackType
from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float, UInt8

from mjdrive.datatypes import Town
from mjdrive.errors import RenderError, UnknownNameError
from mjdrive.simulation.opengl import open_context
from mjdrive.simulation.stage import SUN_DISTANCE

MAX_GEOMS = 5000  # in one picture
FIELD_OF_VIEW_DEG = 45.0  # vertical, of free cameras in MuJoCo
OVERVIEW_ELEVATION_DEG = 50.0
HOUSES_AROUND = 20.0  # beyond the lanes [m]


class Viewpoint(NamedTuple):
    """Where a camera is and what it sees.

    Attributes:
        position: World frame [m].
        forward: Direction in which it looks, world frame [-].
        up: What is up in the picture, world frame [-].
        field_of_view: Angle between the lower and the upper edge of the picture [rad].
    """

    position: Float[np.ndarray, "3"]
    forward: Float[np.ndarray, "3"]
    up: Float[np.ndarray, "3"]
    field_of_view: float


class Cameras:
    """Draws what the cameras of a scene see; use it in a `with` statement, in the thread that opened it.

    Attributes:
        width: Of the pictures [px].
        height: Of the pictures [px].
    """

    def __init__(self, model: mujoco.MjModel, *, width: int = 640, height: int = 360) -> None:
        """Open OpenGL.

        Args:
            model: Compiled scene.
            width: Of the pictures [px].
            height: Of the pictures [px].

        Raises:
            RenderError: If there is no OpenGL here, or the picture is larger than the scene allows.
        """
        limit = model.vis.global_.offwidth, model.vis.global_.offheight
        if width > limit[0] or height > limit[1]:
            raise RenderError(
                f"Picture of {width} x {height} px asked for; expected at most {limit[0]} x {limit[1]} px."
            )
        self.width, self.height = width, height
        self._model = model
        self._opengl = open_context(width, height)
        self._scene = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        self._near_shadows = self._context.shadowClip
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)

    def render(
        self, data: mujoco.MjData, view: str | mujoco.MjvCamera = "chase", *, shadows: bool = True
    ) -> UInt8[np.ndarray, "H W 3"]:
        """Draw one picture.

        Args:
            data: State of the scene, positions up to date (`mujoco.mj_forward`).
            view: Camera of the scene ("hood", "chase", "top"), or a free one.
            shadows: Whether the sun throws shadows; they take more than half of the time.

        Returns:
            Red, green, blue, top row first [-].

        Raises:
            UnknownNameError: If the scene has no such camera.
        """
        camera = self._fixed_camera(view) if isinstance(view, str) else view
        self._set_scene(data, camera, shadows=shadows)
        if camera.type == mujoco.mjtCamera.mjCAMERA_FREE:
            self._aim_sun(camera)
        return self._draw()

    def render_from(
        self, data: mujoco.MjData, viewpoints: Sequence[Viewpoint], *, shadows: bool = True
    ) -> UInt8[np.ndarray, "N H W 3"]:
        """Draw what is seen from some places at one time; the sun follows the car.

        Args:
            data: State of the scene, positions up to date.
            viewpoints: At least one.
            shadows: Whether the sun throws shadows.

        Returns:
            Red, green, blue of each picture, top row first [-].
        """
        self._set_scene(data, mujoco.MjvCamera(), shadows=shadows)
        pictures = np.empty((len(viewpoints), self.height, self.width, 3), np.uint8)
        for picture, viewpoint in zip(pictures, viewpoints, strict=True):
            for eye in self._scene.camera:
                self._aim(eye, viewpoint)
            picture[:] = self._draw()
        return pictures

    def _set_scene(self, data: mujoco.MjData, camera: mujoco.MjvCamera, *, shadows: bool) -> None:
        """Take over what there is to see, and one camera."""
        self._opengl.make_current()
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = shadows
        mujoco.mjv_updateScene(
            self._model,
            data,
            mujoco.MjvOption(),
            None,
            camera,
            mujoco.mjtCatBit.mjCAT_ALL,
            self._scene,
        )
        self._context.shadowClip = self._near_shadows

    def _aim(self, eye: mujoco.MjvGLCamera, viewpoint: Viewpoint) -> None:
        near = self._model.vis.map.znear * self._model.stat.extent
        half = near * np.tan(0.5 * viewpoint.field_of_view)
        eye.pos, eye.forward, eye.up = viewpoint.position, viewpoint.forward, viewpoint.up
        eye.orthographic = 0
        eye.frustum_near, eye.frustum_far = near, self._model.vis.map.zfar * self._model.stat.extent
        eye.frustum_bottom, eye.frustum_top = -half, half
        # The width follows from the height and the shape of the picture.
        eye.frustum_center = eye.frustum_width = 0.0

    def _draw(self) -> UInt8[np.ndarray, "H W 3"]:
        rectangle = mujoco.MjrRect(0, 0, self.width, self.height)
        picture = np.empty((self.height, self.width, 3), np.uint8)
        mujoco.mjr_render(rectangle, self._scene, self._context)
        mujoco.mjr_readPixels(picture, None, rectangle, self._context)
        return np.flipud(picture)

    def close(self) -> None:
        """Give the memory of OpenGL back."""
        self._opengl.make_current()
        self._context.free()
        self._opengl.free()

    def __enter__(self) -> "Cameras":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _aim_sun(self, camera: mujoco.MjvCamera) -> None:
        """Throw shadows where a free camera looks; the sun of the scene follows the car."""
        self._context.shadowClip = max(self._near_shadows, 1.5 * camera.distance)
        for light in self._scene.lights[: self._scene.nlight]:
            if light.type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL and not light.headlight:
                light.pos = camera.lookat - SUN_DISTANCE * light.dir

    def _fixed_camera(self, name: str) -> mujoco.MjvCamera:
        known = [self._model.camera(number).name for number in range(self._model.ncam)]
        if name not in known:
            raise UnknownNameError("camera", name, known)
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        camera.fixedcamid = self._model.camera(name).id
        return camera


def overview(town: Town, *, aspect: float = 4.0 / 3.0) -> mujoco.MjvCamera:
    """Place a camera that sees the whole town from the south, as one looks at a model on a table.

    Args:
        town: Road network.
        aspect: Width of the picture over its height [-].

    Returns:
        Free camera for `Cameras.render`.
    """
    left, bottom, right, top = town.bounds + HOUSES_AROUND * np.array([-1.0, -1.0, 1.0, 1.0])
    elevation = np.radians(OVERVIEW_ELEVATION_DEG)
    reach = np.tan(0.5 * np.radians(FIELD_OF_VIEW_DEG))
    half_width, half_depth = 0.5 * (right - left), 0.5 * (top - bottom)
    # The near edge of the town is the one that has to fit.
    behind = max(half_width / (aspect * reach), half_depth * np.sin(elevation) / reach)
    camera = mujoco.MjvCamera()
    camera.lookat = [0.5 * (left + right), 0.5 * (bottom + top), 0.0]
    camera.distance = float(half_depth * np.cos(elevation) + behind)
    camera.azimuth, camera.elevation = 90.0, -OVERVIEW_ELEVATION_DEG
    return camera
