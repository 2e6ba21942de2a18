"""Drives the car of a compiled scene: commands in, state out, and the forces that MJCF cannot say."""

import math
from typing import cast

import mujoco
import numpy as np
from jaxtyping import Float

import mjdrive.vehicle.engine  # noqa: F401  (no MUJOCO_LOG.TXT in the user's folder)
from mjdrive.datatypes import Action, VehicleState
from mjdrive.geometry import world_from_vehicle, wrap_angle
from mjdrive.vehicle.assembly import WHEELS
from mjdrive.vehicle.movement import Movement
from mjdrive.vehicle.parameters import VehicleParameters
from mjdrive.vehicle.surroundings import Surroundings
from mjdrive.vehicle.tyres import Tyres

STANDSTILL_SPEED = 0.05  # [m/s] and, of the wheels, [rad/s]
_STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION) & ~int(mujoco.mjtState.mjSTATE_WARMSTART)


class Car:
    """The car in a scene built by `assembly.car_on_road`.

    It writes to the model as it drives (tyres, brakes, locks), so every simulation needs a model of its own.

    Attributes:
        parameters: Masses, lengths and limits.
        hull_geoms: Numbers of the geoms of the hull that can hit things.
        tyre_geoms: Numbers of the geoms of the tyres.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.parameters = parameters = VehicleParameters.of(model)
        self.hull_geoms = frozenset(
            number for number in range(model.ngeom) if model.geom(number).name.startswith("hull_")
        )
        self.tyre_geoms = frozenset(model.geom(f"tyre_{wheel}").id for wheel in WHEELS)
        self._model = model
        self._data = data
        _leave_static_geoms_in_place(model, data)
        self._tyres = Tyres(model, parameters)
        self._movement = Movement(model, data, parameters, self._tyres.speeds)
        self._surroundings = Surroundings(model, data)
        self._spin_dof = [int(model.joint(f"spin_{wheel}").dofadr[0]) for wheel in WHEELS]
        self._spin_qpos = np.array([model.joint(f"spin_{wheel}").qposadr[0] for wheel in WHEELS])
        self._lock = np.array([model.equality(f"lock_{wheel}").id for wheel in WHEELS])
        self._rack_qpos = model.joint("steer").qposadr[0]
        self._brake_act = model.actuator("brake").actadr[0]
        self._throttle, self._brake, self._steering = (
            model.actuator(name).id for name in ("throttle", "brake", "steering")
        )
        # Memory of MuJoCo, read and written number by number: four are done before numpy has begun.
        self._qvel, self._act, self._ctrl = map(_numbers, (data.qvel, data.act, data.ctrl))
        self._pose, self._motion, self._warm_start = data.qpos, data.qvel, data.qacc_warmstart
        self._rotation = np.empty(9)
        self._seen: tuple[bytes, VehicleState] | None = None
        self._friction = _numbers(model.dof_frictionloss)
        half, front = 0.5 * parameters.brake_torque, parameters.brake_front_share
        torques = [half * front] * 2 + [half * (1.0 - front)] * 2
        self._brake_torque = list(zip(self._spin_dof, torques, strict=True))
        self._brake_applied = 0.0
        self._holding = False

    def place(self, x: float, y: float, yaw: float, speed: float = 0.0) -> None:
        """Reset the simulation, clock included, with the car on its wheels.

        Args:
            x: Rear-axle centre, world frame [m].
            y: Rear-axle centre, world frame [m].
            yaw: Heading [rad].
            speed: Forward speed [m/s].
        """
        data, parameters = self._data, self.parameters
        mujoco.mj_resetData(self._model, data)
        weight_per_wheel = -parameters.mass * self._model.opt.gravity[2] / len(WHEELS)
        tyre_deflection = weight_per_wheel / parameters.tyre_vertical_stiffness
        data.qpos[:3] = x, y, -tyre_deflection
        data.qpos[3:7] = np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)
        data.qvel[:2] = speed * np.cos(yaw), speed * np.sin(yaw)
        data.qvel[self._spin_dof] = speed / (parameters.wheel_radius - tyre_deflection)
        self._holding = False
        # The lock angles of an earlier drive are no part of this one.
        self._model.eq_data[self._lock, 0] = 0.0
        self.update()
        mujoco.mj_forward(self._model, data)

    def command(self, action: Action) -> None:
        """Begin a control interval: set pedals and steering wheel; values beyond [-1, 1] count as the nearest limit.

        Args:
            action: Positive acceleration is throttle, negative is brake; positive steering turns left.
        """
        acceleration = min(max(action.acceleration, -1.0), 1.0)
        steering = min(max(action.steering, -1.0), 1.0)
        self._ctrl[self._throttle] = max(acceleration, 0.0)
        self._ctrl[self._brake] = max(-acceleration, 0.0)
        self._ctrl[self._steering] = steering
        # The solver starts afresh. What it found last is a third of a saved state, and noise that does not compress.
        self._warm_start[:] = 0.0

    def update(self) -> None:
        """Renew brakes, air drag, tyres and standstill hold from the state; call it some fifty times a second."""
        brake = self._act[self._brake_act]
        self._movement.read()
        self._apply(brake)
        self._hold(brake)
        self._surroundings.update(self._movement.speed())

    def state(self) -> VehicleState:
        """Read where the car is and how it moves, at the rear axle."""
        key = self._pose.tobytes() + self._motion.tobytes()
        if self._seen is None or self._seen[0] != key:  # rules, views and policies all ask
            self._seen = key, self._read()
        return self._seen[1]

    def _read(self) -> VehicleState:
        qpos, qvel = self._pose.tolist(), self._qvel
        world_from_car = self._world_from_car()
        forward_x, _, _, forward_y, *_ = self._rotation.tolist()
        yaw = float(np.arctan2(forward_y, forward_x))
        return VehicleState(
            x=qpos[0],
            y=qpos[1],
            yaw=wrap_angle(yaw),
            speed=math.cos(yaw) * qvel[0] + math.sin(yaw) * qvel[1],
            yaw_rate=float(world_from_car[2] @ self._motion[3:6]),
            steering_angle=qpos[self._rack_qpos],
        )

    @property
    def is_clear(self) -> bool:
        """Whether nothing stands so near that, until the next update, anything but the tyres touches anything but the road."""
        return not self._surroundings.are_near

    def save(self) -> Float[np.ndarray, " S"]:
        """Take all that the future of the simulation depends on from the next command on.

        Returns:
            MuJoCo's integration state without the solver's warm start, then tyre speeds [m/s], brake [-], hold flag and lock angles [rad].
        """
        physics = np.empty(mujoco.mj_stateSize(self._model, _STATE))
        mujoco.mj_getState(self._model, self._data, physics, _STATE)
        lock_angles = self._model.eq_data[self._lock, 0]
        written = [*self._tyres.speeds, self._brake_applied, float(self._holding), *lock_angles]
        return np.concatenate([physics, written])

    def restore(self, saved: Float[np.ndarray, " S"]) -> None:
        """Go back to what `save` took; from the next command on all goes bit by bit as it did then.

        Args:
            saved: What `save` returned, from a model of the same scene.
        """
        size = mujoco.mj_stateSize(self._model, _STATE)
        assert len(saved) == size + 10, f"{len(saved)} numbers saved, {size + 10} needed"
        physics, written = saved[:size].astype(float), saved[size:]
        self._tyres.speeds[:] = written[:4]
        self._apply(float(written[4]))
        self._holding = bool(written[5])
        self._model.eq_data[self._lock, 0] = written[6:]
        mujoco.mj_setState(self._model, self._data, physics, _STATE)
        self._surroundings.update(self._movement.speed())
        mujoco.mj_forward(self._model, self._data)

    def footprint(self) -> Float[np.ndarray, "4 2"]:
        """Corners of the car on the ground.

        Returns:
            Front left, front right, rear right, rear left, world frame [m].
        """
        parameters = self.parameters
        front = parameters.length - parameters.rear_overhang
        rear, side = -parameters.rear_overhang, 0.5 * parameters.width
        return self._to_world([[front, side], [front, -side], [rear, -side], [rear, side]])

    def wheel_contacts(self) -> Float[np.ndarray, "4 2"]:
        """Points on the ground under the wheel centres.

        Returns:
            Front left, front right, rear left, rear right, world frame [m].
        """
        front, side = self.parameters.wheelbase, 0.5 * self.parameters.track
        return self._to_world([[front, side], [front, -side], [0.0, side], [0.0, -side]])

    def _world_from_car(self) -> Float[np.ndarray, "3 3"]:
        """Rotation of the body, from the state itself: derived quantities of MuJoCo lag by a step."""
        mujoco.mju_quat2Mat(self._rotation, self._pose[3:7])
        return self._rotation.reshape(3, 3)

    def _to_world(self, points: list[list[float]]) -> Float[np.ndarray, "N 2"]:
        state = self.state()
        return world_from_vehicle(np.array(points), x=state.x, y=state.y, yaw=state.yaw)

    def _apply(self, brake: float) -> None:
        # Coulomb friction in the spin joints is solved together with the contacts: it holds at standstill and never
        # drives the wheel backwards, which a velocity servo or a damper would.
        rolling = self.parameters.rolling_torque
        for dof, full in self._brake_torque:
            self._friction[dof] = rolling + brake * full
        self._tyres.schedule()
        self._brake_applied = brake

    def _hold(self, brake: float) -> None:
        """Lock the wheels of a stopped car while its brake can carry it, and free them when it cannot."""
        if not self._holding and self._movement.size >= STANDSTILL_SPEED:
            return
        strong_enough = brake * self.parameters.brake_torque > self._movement.torque_to_hold
        if self._holding and not strong_enough:
            self._holding = False
            self._data.eq_active[self._lock] = 0
        elif not self._holding and strong_enough:
            self._holding = True
            self._model.eq_data[self._lock, 0] = self._data.qpos[self._spin_qpos]
            self._data.eq_active[self._lock] = 1


def _numbers(array: np.ndarray) -> "memoryview[float]":
    return cast("memoryview[float]", array.data)


def _leave_static_geoms_in_place(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Let a town cost little more than a plane: what may sleep is not placed anew at every step.

    Nothing that moves does sleep, and it moves the same bit by bit.
    """
    state = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, state, _STATE)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP
    model.tree_sleep_policy[:] = mujoco.mjtSleepPolicy.mjSLEEP_NEVER
    # Data that was made before must be told to place static geoms once.
    mujoco.mj_resetData(model, data)
    mujoco.mj_setState(model, data, state, _STATE)
