"""The numbers of the car, read from its MJCF."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import mujoco
import numpy as np

from mjdrive.vehicle.assembly import WHEELS, car_path

AIR_DENSITY = 1.2  # that the drag of every car is reckoned with [kg/m3]

_SLEW = 1  # where a `pid` actuator keeps slewmax in its dynprm


@dataclass(frozen=True, slots=True)
class VehicleParameters:
    """Masses, lengths and limits of the car.

    Attributes:
        mass: Whole car with wheels [kg].
        wheelbase: Distance between the axles [m].
        track: Distance between the wheels of an axle [m].
        wheel_radius: Unloaded tyre [m].
        centre_of_gravity_ahead: Ahead of the rear axle [m].
        centre_of_gravity_height: Above the ground [m].
        length: Footprint, bumper to bumper [m].
        width: Footprint [m].
        rear_overhang: Footprint behind the rear axle [m].
        max_steering_angle: Centre steering angle of the front wheels at full lock [rad].
        max_steering_rate: How fast that angle follows the command [rad/s].
        cornering_stiffness_front: Lateral force per slip angle of one front tyre [N/rad].
        cornering_stiffness_rear: Lateral force per slip angle of one rear tyre [N/rad].
        tyre_vertical_stiffness: One tyre [N/m].
        tyre_vertical_damping: One tyre [N s/m].
        drive_torque: All driven wheels together at full throttle from rest [N m].
        drive_torque_slope: What that torque loses per speed of the wheels [N m s/rad].
        throttle_dead_band: Throttle up to which there is no torque; from there it grows in proportion [-].
        throttle_lag: Time constant with which the torque follows the throttle [s].
        brake_torque: All wheels together at full brake [N m].
        brake_front_share: Part of it on the front axle [-].
        brake_lag: Time constant with which the torque follows the brake [s].
        rolling_torque: Rolling resistance of one wheel [N m].
        wheel_inertia: One wheel about its axle [kg m2].
        drag_area: Drag coefficient times frontal area [m2].
    """

    mass: float
    wheelbase: float
    track: float
    wheel_radius: float
    centre_of_gravity_ahead: float
    centre_of_gravity_height: float
    length: float
    width: float
    rear_overhang: float
    max_steering_angle: float
    max_steering_rate: float
    cornering_stiffness_front: float
    cornering_stiffness_rear: float
    tyre_vertical_stiffness: float
    tyre_vertical_damping: float
    drive_torque: float
    drive_torque_slope: float
    throttle_dead_band: float
    throttle_lag: float
    brake_torque: float
    brake_front_share: float
    brake_lag: float
    rolling_torque: float
    wheel_inertia: float
    drag_area: float

    @property
    def front_overhang(self) -> float:
        """Footprint ahead of the front axle [m]."""
        return self.length - self.rear_overhang - self.wheelbase

    @staticmethod
    @cache
    def default() -> "VehicleParameters":
        """Numbers of the car that ships with mjdrive."""
        return VehicleParameters.read(car_path())

    @staticmethod
    def read(path: Path) -> "VehicleParameters":
        """Read the numbers out of the MJCF of a car.

        Args:
            path: MJCF file with the names of car.xml.

        Returns:
            What the file says; nothing is assumed.
        """
        return VehicleParameters.of(mujoco.MjModel.from_xml_path(str(path)))

    @staticmethod
    def of(model: mujoco.MjModel) -> "VehicleParameters":
        """Read the numbers out of a compiled scene that holds the car.

        Args:
            model: Scene, with a car that has not been driven: `Car` writes its brakes into the model.

        Returns:
            What the scene says; nothing is assumed.
        """
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        wheels = np.array([data.body(f"wheel_{wheel}").xpos for wheel in WHEELS])
        front_left, front_right, rear_left = wheels[:3]
        hull, half = model.geom("hull_low").pos, model.geom("hull_low").size
        ahead, _, height = data.body("car").subtree_com
        throttle, steering = model.actuator("throttle"), model.actuator("steering")
        front, rear = _numeric(model, "cornering_stiffness")
        return VehicleParameters(
            mass=float(model.body("car").subtreemass[0]),
            wheelbase=float(front_left[0] - rear_left[0]),
            track=float(front_left[1] - front_right[1]),
            wheel_radius=float(model.geom("tyre_fl").size[0]),
            centre_of_gravity_ahead=float(ahead),
            centre_of_gravity_height=float(height),
            length=float(2 * half[0]),
            width=float(2 * half[1]),
            rear_overhang=float(half[0] - hull[0]),
            max_steering_angle=float(model.joint("steer").range[1]),
            max_steering_rate=float(steering.dynprm[_SLEW] / steering.gear[0]),
            cornering_stiffness_front=float(front),
            cornering_stiffness_rear=float(rear),
            tyre_vertical_stiffness=float(_numeric(model, "tyre_vertical_stiffness")[0]),
            tyre_vertical_damping=float(_numeric(model, "tyre_vertical_damping")[0]),
            drive_torque=float(throttle.gainprm[0] + throttle.biasprm[0]),
            drive_torque_slope=float(-throttle.gainprm[2] - throttle.biasprm[2]),
            throttle_dead_band=float(
                1.0 - (throttle.gainprm[0] + throttle.biasprm[0]) / throttle.gainprm[0]
            ),
            throttle_lag=_lag(model, "throttle"),
            brake_torque=float(_numeric(model, "brake_torque")[0]),
            brake_front_share=float(_numeric(model, "brake_front_share")[0]),
            brake_lag=_lag(model, "brake"),
            wheel_inertia=float(model.body("wheel_rl").inertia[1]),
            rolling_torque=float(model.dof_frictionloss[model.joint("spin_fl").dofadr[0]]),
            drag_area=float(_numeric(model, "drag_area")[0]),
        )


def _numeric(model: mujoco.MjModel, name: str) -> np.ndarray:
    return model.numeric(name).data


def _lag(model: mujoco.MjModel, actuator: str) -> float:
    """Time constant of an actuator; 0 for one that follows its command at once [s]."""
    kind = model.actuator(actuator)
    filters = (int(mujoco.mjtDyn.mjDYN_FILTER), int(mujoco.mjtDyn.mjDYN_FILTEREXACT))
    return float(kind.dynprm[0]) if int(kind.dyntype[0]) in filters else 0.0
