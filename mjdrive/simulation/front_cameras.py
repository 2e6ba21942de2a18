"""The three cameras of the car that a policy may look through."""

import math
from types import TracebackType

import mujoco
import numpy as np
from jaxtyping import UInt8

from mjdrive.config import CameraConfig
from mjdrive.simulation.cameras import Cameras, Viewpoint
from mjdrive.simulation.simulation import Simulation

NAMES = ("front_left", "front", "front_right")
"""Of the cameras, from left to right."""


class FrontCameras:
    """Takes pictures of what lies ahead; use it in a `with` statement, in the thread that opened it.

    They sit on the body of the car and nod and roll with it. The same state gives the same pictures, whether it was
    driven to or restored.

    Args:
        simulation: What to look at.
        config: Size of the pictures, and where the cameras are.

    Raises:
        RenderError: If there is no OpenGL here, or the pictures are larger than the scene allows.
    """

    def __init__(self, simulation: Simulation, config: CameraConfig | None = None) -> None:
        self.config = config or CameraConfig()
        self._simulation = simulation
        parameters = simulation.car.parameters
        ahead = self.config.ahead + parameters.length / 2 - parameters.rear_overhang
        self._place = np.array([ahead, 0.0, self.config.height])
        self._cameras = Cameras(
            simulation.model, width=self.config.width_px, height=self.config.height_px
        )

    def render(self) -> UInt8[np.ndarray, "3 H W 3"]:
        """Take a picture with each camera, in the order of `NAMES`.

        Returns:
            Red, green, blue, top row first [-].
        """
        model, data = self._simulation.model, self._simulation.data
        # After a step, MuJoCo's positions are those of a physics step ago; what follows does not hang on them.
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        return self._cameras.render_from(data, self._viewpoints(), shadows=self.config.shadows)

    def close(self) -> None:
        """Give the memory of OpenGL back."""
        self._cameras.close()

    def __enter__(self) -> "FrontCameras":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _viewpoints(self) -> list[Viewpoint]:
        body = self._simulation.data.body("car")
        world_from_car = body.xmat.reshape(3, 3)
        position = body.xpos + world_from_car @ self._place
        shape = self.config.height_px / self.config.width_px
        vertical = 2.0 * math.atan(shape * math.tan(0.5 * self.config.field_of_view))
        sideways = self.config.sideways
        return [
            Viewpoint(
                position,
                world_from_car @ np.array([math.cos(yaw), math.sin(yaw), 0.0]),
                world_from_car[:, 2],
                vertical,
            )
            for yaw in (sideways, 0.0, -sideways)
        ]
