"""How the car moves, as its tyres, its brakes and the air take it."""

import functools
import math
from typing import cast

import casadi as ca
import mujoco
import numpy as np
from jaxtyping import Float

from mjdrive.vehicle.assembly import WHEELS
from mjdrive.vehicle.bound import bind
from mjdrive.vehicle.parameters import AIR_DENSITY, VehicleParameters

HOLD_RESERVE = 20.0  # brake torque beyond engine and gravity before the wheels are locked [N m]


class Movement:
    """Reads the state of MuJoCo some fifty times a second, and writes the drag of the air to it.

    Args:
        model: Scene of `car_on_road`.
        data: Its state, whose memory is read.
        parameters: Of the car.
        tyre_speeds: Where to write the larger of travel and rolling speed of each tyre, in the order of `WHEELS` [m/s].
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        parameters: VehicleParameters,
        tyre_speeds: Float[np.ndarray, " 4"],
    ) -> None:
        self._qvel = cast("memoryview[float]", data.qvel.data)
        # One number each: travel is written for the function below, the others are what it finds.
        self._travel, self._turning, self._torque = np.zeros(1), np.zeros(1), np.zeros(1)
        travel, gravity = ca.SX.sym("travel"), ca.SX.sym("gravity", 3)
        qpos, qvel = ca.SX.sym("qpos", model.nq), ca.SX.sym("qvel", model.nv)
        act = ca.SX.sym("act", model.na)
        spins = [int(model.joint(f"spin_{wheel}").dofadr[0]) for wheel in WHEELS]
        rolling = [ca.fabs(qvel[dof]) for dof in spins]
        speeds = [ca.fmax(travel, rate * parameters.wheel_radius) for rate in rolling]
        drag = -0.5 * AIR_DENSITY * parameters.drag_area * travel * qvel[:2]
        downhill = ca.fabs(ca.dot(_forward(qpos), gravity))
        torque = (
            act[model.actuator("throttle").actadr[0]] * parameters.drive_torque
            + parameters.mass * downhill * parameters.wheel_radius
            + HOLD_RESERVE
        )
        self._compute = bind(
            [
                (travel, self._travel),
                (qpos, data.qpos),
                (qvel, data.qvel),
                (act, data.act),
                (gravity, model.opt.gravity),
            ],
            [
                (ca.vertcat(*speeds), tyre_speeds),
                (drag, data.xfrc_applied[model.body("car").id, :2]),
                (functools.reduce(ca.fmax, rolling), self._turning),
                (torque, self._torque),
            ],
        )

    def read(self) -> None:
        """Find out how the car moves now."""
        self._travel[0] = self.speed()
        self._compute()

    def speed(self) -> float:
        """Speed of the car in the plane as it is now, whatever was read [m/s]."""
        # Not by casadi, whose hypotenuse is that of the system's C library.
        return math.hypot(self._qvel[0], self._qvel[1])

    @property
    def size(self) -> float:
        """Speed in the plane [m/s] and rate of the fastest wheel [rad/s], added: 0 if all stands."""
        return self._travel.item() + self._turning.item()

    @property
    def torque_to_hold(self) -> float:
        """Wheel torque that engine and gravity, with a reserve, bring against the brake [N m]."""
        return self._torque.item()


def _forward(qpos: ca.SX) -> ca.SX:
    """Where the nose of the car points, world frame, from the positions of the scene [-]."""
    w, i, j, k = ca.vertsplit(qpos[3:7])
    return ca.vertcat(w * w + i * i - j * j - k * k, 2 * (i * j + w * k), 2 * (i * k - w * j))
