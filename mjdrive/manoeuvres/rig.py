"""The test rig: the car alone on an endless plane, on a slope if asked for, with a recorder."""

import math
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np

from mjdrive.config import SimulationConfig
from mjdrive.datatypes import Action
from mjdrive.manoeuvres.recording import Moment, Recording
from mjdrive.manoeuvres.single_track import SingleTrack
from mjdrive.vehicle.assembly import ROAD, car_on_road
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.engine import require_sane

GRAVITY = 9.81  # [m/s2]
UPDATE_INTERVAL = (
    SimulationConfig().car_update_interval
)  # [s], of the car, the command and the recorder
TIMESTEP = SimulationConfig().timestep  # [s]

Driver = Callable[[Moment], Action]
"""Chooses pedals and steering from how the car moves."""


class Rig:
    """The car of a compiled scene, driven by the manoeuvres.

    Args:
        model: Scene of `car_on_road`; the car writes to it, so it belongs to this rig alone.

    Attributes:
        model: The scene.
        data: Its state.
        car: What drives in it.
        single_track: The same car as one track.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        self.single_track = SingleTrack.of(model)
        self.car = Car(model, self.data)
        self._steps_per_update = max(round(UPDATE_INTERVAL / model.opt.timestep), 1)
        parameters = self.car.parameters
        self._centre_of_gravity = np.array(
            [parameters.centre_of_gravity_ahead, 0.0, parameters.centre_of_gravity_height]
        )
        self._start_time = 0.0
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
        self._start_time = 0.0

    def drive(
        self,
        driver: Driver,
        *,
        duration: float,
        until: Callable[[Moment], bool] | None = None,
    ) -> Recording:
        """Let somebody drive and record it, from now on.

        Args:
            driver: Asked fifty times a second.
            duration: At most [s].
            until: Ends the manoeuvre early when it says so.

        Returns:
            The recording; its time begins at 0.

        Raises:
            PhysicsError: If the physics has become unstable.
        """
        self._start_time = self.data.time
        moments = [self.moment()]
        for _ in range(round(duration / UPDATE_INTERVAL)):
            self.car.command(driver(moments[-1]))
            self.car.update()
            mujoco.mj_step(self.model, self.data, self._steps_per_update)
            moments.append(self.moment())
            if until is not None and until(moments[-1]):
                break
        require_sane(self.data)
        return Recording.of(moments)

    def moment(self) -> Moment:
        """How the car moves now."""
        qvel = self.data.qvel
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, self.data.qpos[3:7])
        world_from_car = rotation.reshape(3, 3)
        spin = world_from_car @ qvel[3:6]
        velocity = qvel[:3] + np.cross(spin, world_from_car @ self._centre_of_gravity)
        yaw = math.atan2(world_from_car[1, 0], world_from_car[0, 0])
        return Moment(
            time=self.data.time - self._start_time,
            x=float(self.data.qpos[0]),
            y=float(self.data.qpos[1]),
            yaw=yaw,
            speed=math.cos(yaw) * velocity[0] + math.sin(yaw) * velocity[1],
            lateral_speed=math.cos(yaw) * velocity[1] - math.sin(yaw) * velocity[0],
            yaw_rate=float(spin[2]),
            steering_angle=self.car.state().steering_angle,
            roll=math.atan2(world_from_car[2, 1], world_from_car[2, 2]),
        )


class SpeedHold:
    """A cruise control of two terms, for manoeuvres at constant speed.

    Args:
        speed: To hold [m/s].
    """

    PROPORTIONAL = 0.25  # [1/(m/s)]
    INTEGRAL = 0.2  # [1/m]
    BRAKE_SHARE = 0.2  # of the command that reaches the brake [-]

    def __init__(self, speed: float) -> None:
        self._speed = speed
        self._integral = 0.15

    def __call__(self, moment: Moment) -> float:
        """Acceleration command [-]."""
        error = self._speed - moment.speed
        self._integral += self.INTEGRAL * UPDATE_INTERVAL * error
        self._integral = min(max(self._integral, 0.0), 1.0)
        command = self.PROPORTIONAL * error + self._integral
        return min(command, 1.0) if command >= 0 else max(self.BRAKE_SHARE * command, -1.0)
