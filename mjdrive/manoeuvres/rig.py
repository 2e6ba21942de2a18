"""The test rig: the car in MuJoCo, alone on an endless plane, on a slope if asked for."""

import math
from pathlib import Path

import mujoco
import numpy as np

from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL, Plant
from mjdrive.manoeuvres.recording import Moment
from mjdrive.manoeuvres.single_track import SingleTrack
from mjdrive.vehicle.assembly import ROAD, car_on_road
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.engine import require_sane

GRAVITY = 9.81  # [m/s2]
TIMESTEP = SimulationConfig().timestep  # [s]


class Rig(Plant):
    """The car of a compiled scene.

    Args:
        model: Scene of `car_on_road`; the car writes to it, so it belongs to this rig alone.

    Attributes:
        model: The scene.
        data: Its state.
        car: What drives in it.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        single_track = SingleTrack.of(model)  # of the car as it was built, before it drives
        self.model = model
        self.data = mujoco.MjData(model)
        self.car = Car(model, self.data)
        parameters = self.car.parameters
        super().__init__(single_track, max_steering_angle=parameters.max_steering_angle)
        self._steps_per_update = max(round(UPDATE_INTERVAL / model.opt.timestep), 1)
        self._rack = int(model.joint("steer").qposadr[0])
        self._centre_of_gravity = np.array(
            [parameters.centre_of_gravity_ahead, 0.0, parameters.centre_of_gravity_height]
        )
        self.place()

    @staticmethod
    def of_car(
        car: Path | None = None,
        *,
        timestep: float = TIMESTEP,
        friction: float = 1.0,
        slope: float = 0.0,
    ) -> "Rig":
        """Put a car onto the plane.

        Args:
            car: Its MJCF; the default car if None.
            timestep: Of the physics; divides the update interval of the car [s].
            friction: Between tyre and road [-].
            slope: Rise over run of the road ahead; it is gravity that tilts [-].
        """
        spec = car_on_road(timestep=timestep, friction=friction, car=car)
        angle = math.atan(slope)
        spec.option.gravity = [-GRAVITY * math.sin(angle), 0.0, -GRAVITY * math.cos(angle)]
        return Rig(spec.compile())

    @property
    def friction(self) -> float:
        """Between tyre and road [-]."""
        return float(self.model.geom(ROAD).friction[0])

    def place(self, *, speed: float = 0.0) -> None:
        """Put the car at the origin, headed along x, rolling.

        Args:
            speed: Forward speed [m/s].
        """
        self.car.place(0.0, 0.0, 0.0, speed=speed)

    def advance(self, action: Action) -> None:
        """Drive for one update interval.

        Args:
            action: What to do.

        Raises:
            PhysicsError: If the physics has become unstable.
        """
        self.car.command(action)
        self.car.update()
        mujoco.mj_step(self.model, self.data, self._steps_per_update)
        require_sane(self.data)

    def moment(self) -> Moment:
        """How the car moves now."""
        qvel = self.data.qvel
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, self.data.qpos[3:7])
        world_from_car = rotation.reshape(3, 3)
        roll_rate, pitch_rate, yaw_rate = (world_from_car @ qvel[3:6]).tolist()
        ahead, left, up = (world_from_car @ self._centre_of_gravity).tolist()
        # Of the centre of gravity: that of the rear axle and spin x arm.
        x_speed = float(qvel[0]) + pitch_rate * up - yaw_rate * left
        y_speed = float(qvel[1]) + yaw_rate * ahead - roll_rate * up
        yaw = math.atan2(rotation[3], rotation[0])
        return Moment(
            time=self.data.time,
            x=float(self.data.qpos[0]),
            y=float(self.data.qpos[1]),
            yaw=yaw,
            speed=math.cos(yaw) * x_speed + math.sin(yaw) * y_speed,
            lateral_speed=math.cos(yaw) * y_speed - math.sin(yaw) * x_speed,
            yaw_rate=yaw_rate,
            steering_angle=float(self.data.qpos[self._rack]),
            roll=math.atan2(rotation[7], rotation[8]),
        )
