"""CommonRoad's multi-body model of a BMW 320i as a car that the manoeuvres can drive.

Reference:
    Althoff, Koschi, Manzinger, CommonRoad: Composable Benchmarks for Motion Planning on Roads, IEEE IV 2017; its vehicle
    models (29 states, Pacejka tyres) are the PyPI package commonroad-vehicle-models.
"""

import importlib
import importlib.util
import math
from typing import Any

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Action
from mjdrive.errors import MissingPackageError
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL, Plant
from mjdrive.manoeuvres.recording import Moment
from mjdrive.manoeuvres.rig import GRAVITY
from mjdrive.manoeuvres.single_track import SingleTrack

PACKAGE = "commonroad-vehicle-models"
TIMESTEP = 0.002  # of Runge-Kutta; wheels are stiff [s]
FULL_ACCELERATION = 3.0  # that a command of 1 asks for [m/s2]
STEERING_LAG = 0.01  # of the steering behind its command [s]
_X, _Y, _ANGLE, _SPEED, _YAW, _YAW_RATE, _ROLL = range(7)
_LATERAL_SPEED = 10


def is_installed() -> bool:
    """Whether the package with the model can be imported."""
    return importlib.util.find_spec("vehiclemodels") is not None


def bmw_320i() -> Any:
    """Parameters of the BMW 320i, by the names of the package [SI units].

    Raises:
        MissingPackageError: If the package is not installed.
    """
    return _attribute("parameters_vehicle2")()


def cornering_stiffness(parameters: Any) -> tuple[float, float]:
    """Lateral force per slip angle of one front and one rear tyre, at their loads at rest [N/rad].

    Args:
        parameters: Of the package.
    """
    per_load = -parameters.tire.p_ky1  # Pacejka's slope at no slip, over the load [1/rad]
    load = parameters.m * GRAVITY / (2 * (parameters.a + parameters.b))
    return per_load * load * parameters.b, per_load * load * parameters.a


def single_track(parameters: Any) -> SingleTrack:
    """The same car as one track.

    Args:
        parameters: Of the package.
    """
    front, rear = cornering_stiffness(parameters)
    return SingleTrack(
        mass=parameters.m,
        yaw_inertia=parameters.I_z,
        front=parameters.a,
        rear=parameters.b,
        stiffness_front=2 * front,
        stiffness_rear=2 * rear,
    )


class MultiBodyCar(Plant):
    """The multi-body model, integrated with the classical Runge-Kutta method.

    Raises:
        MissingPackageError: If the package is not installed.
    """

    def __init__(self) -> None:
        self._parameters = parameters = bmw_320i()
        self._initial = _attribute("init_mb")
        self._dynamics = _attribute("vehicle_dynamics_mb")
        super().__init__(single_track(parameters), max_steering_angle=parameters.steering.max)
        self.place(speed=1.0)

    def place(self, *, speed: float = 0.0) -> None:
        """Put the car at the origin, headed along x, rolling.

        Args:
            speed: Forward speed, over 0.1 [m/s].
        """
        start = self._initial([0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0], self._parameters)
        self._state = np.array(start, float)
        self._time = 0.0

    def advance(self, action: Action) -> None:
        """Drive for one update interval.

        Args:
            action: What to do.
        """
        wanted = self.max_steering_angle * action.steering
        acceleration = FULL_ACCELERATION * action.acceleration
        limit = self._parameters.steering.v_max
        for _ in range(round(UPDATE_INTERVAL / TIMESTEP)):
            rate = (wanted - self._state[_ANGLE]) / STEERING_LAG
            self._step([min(max(rate, -limit), limit), acceleration])
        self._time += UPDATE_INTERVAL

    def moment(self) -> Moment:
        """How the car moves now."""
        state = self._state.tolist()
        yaw = state[_YAW]
        rear = self.single_track.rear
        return Moment(
            time=self._time,
            x=state[_X] - rear * math.cos(yaw),
            y=state[_Y] - rear * math.sin(yaw),
            yaw=yaw,
            speed=state[_SPEED],
            lateral_speed=state[_LATERAL_SPEED],
            yaw_rate=state[_YAW_RATE],
            steering_angle=state[_ANGLE],
            roll=-state[_ROLL],  # theirs is positive when the car leans to the left
        )

    def _step(self, command: list[float]) -> None:
        state, h = self._state, TIMESTEP
        k1 = self._slope(state, command)
        k2 = self._slope(state + 0.5 * h * k1, command)
        k3 = self._slope(state + 0.5 * h * k2, command)
        k4 = self._slope(state + h * k3, command)
        self._state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)

    def _slope(self, state: Float[np.ndarray, " 29"], command: list[float]) -> np.ndarray:
        return np.array(self._dynamics(state.tolist(), command, self._parameters))


def _attribute(name: str) -> Any:
    """What a module of the package is named after.

    Raises:
        MissingPackageError: If the package is not installed.
    """
    if not is_installed():
        raise MissingPackageError(PACKAGE, wanted_for="the multi-body model of a BMW 320i")
    return getattr(importlib.import_module(f"vehiclemodels.{name}"), name)
