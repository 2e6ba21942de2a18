"""A short drive that every car file must pass: what its numbers do not give away, its motion does."""

from collections.abc import Iterator

import mujoco
import numpy as np

from mjdrive.datatypes import Action
from mjdrive.errors import PhysicsError
from mjdrive.vehicle.car import Car
from mjdrive.vehicle.engine import require_sane

UPDATE_INTERVAL = 0.02  # between two calls of `Car.update` [s]
MAX_TILT = 0.02  # of a car that stands [rad]
MAX_SINKING = 0.03  # beyond the tyres' deflection [m]
TURNING_SPEED, TURNING_COMMAND = 2.0, 0.5  # [m/s], [-]


def trial_faults(model: mujoco.MjModel) -> Iterator[str]:
    """Let a car stand, start and turn, and name everything that it does wrongly.

    Args:
        model: The car on a plane, without fault so far; it is driven and so spent.

    Yields:
        What was found and what was expected, one clause each.
    """
    data = mujoco.MjData(model)
    car = Car(model, data)
    try:
        yield from _standing_faults(model, data, car)
        car.place(0.0, 0.0, 0.0)
        _drive(model, data, car, Action(acceleration=1.0, steering=0.0), duration=2.0)
        if car.state().speed < 1.0:
            yield f"it goes at {car.state().speed:.2f} m/s after 2 s of full throttle; expected more than 1 m/s forward"
        yield from _turning_faults(model, data, car)
    except PhysicsError as error:
        yield f"a short drive broke the physics: {error}"


def _standing_faults(model: mujoco.MjModel, data: mujoco.MjData, car: Car) -> Iterator[str]:
    car.place(0.0, 0.0, 0.0)
    height = float(data.qpos[2])
    _drive(model, data, car, Action(acceleration=-1.0, steering=0.0), duration=3.0)
    roll, pitch = 2.0 * data.qpos[4:6]
    sinking = height - float(data.qpos[2])
    if max(abs(roll), abs(pitch)) > MAX_TILT or abs(sinking) > MAX_SINKING:
        yield (
            f"it stands {1e3 * sinking:.0f} mm deeper than on its tyres, rolled {roll:.3f} rad and pitched {pitch:.3f} rad; "
            "expected it level: springref of each spring is -(static load / stiffness)"
        )


def _turning_faults(model: mujoco.MjModel, data: mujoco.MjData, car: Car) -> Iterator[str]:
    car.place(0.0, 0.0, 0.0, speed=TURNING_SPEED)
    _drive(model, data, car, Action(acceleration=0.0, steering=TURNING_COMMAND), duration=2.0)
    state, parameters = car.state(), car.parameters
    asked = TURNING_COMMAND * parameters.max_steering_angle
    if abs(state.steering_angle - asked) > 0.1 * asked:
        yield (
            f"joint 'steer' is at {state.steering_angle:.3f} rad 2 s after a command of {asked:.3f} rad; expected it there: "
            "raise kp, forcerange or slewmax of 'steering'"
        )
        return
    expected = state.speed * np.tan(state.steering_angle) / parameters.wheelbase
    if abs(state.yaw_rate - expected) > 0.2 * expected:
        yield (
            f"it turns with {state.yaw_rate:.3f} rad/s at {state.speed:.2f} m/s and a steering angle of "
            f"{state.steering_angle:.3f} rad; expected about {expected:.3f} rad/s: tie the front wheels to the joint 'steer' "
            "with equalities"
        )


def _drive(
    model: mujoco.MjModel, data: mujoco.MjData, car: Car, action: Action, *, duration: float
) -> None:
    car.command(action)
    for _ in range(round(duration / UPDATE_INTERVAL)):
        car.update()
        mujoco.mj_step(model, data, round(UPDATE_INTERVAL / model.opt.timestep))
    require_sane(data)
