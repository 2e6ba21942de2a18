"""What is measured during a manoeuvre."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float


class Moment(NamedTuple):
    """How the car moves at one time; ISO 8855, velocities at its centre of gravity.

    Attributes:
        time: Since the start of the recording [s].
        x: Rear-axle centre, world frame [m].
        y: Rear-axle centre, world frame [m].
        yaw: Heading [rad].
        speed: Forward velocity [m/s].
        lateral_speed: Velocity to the left [m/s].
        yaw_rate: Counter-clockwise [rad/s].
        steering_angle: Centre angle of the front wheels, positive to the left [rad].
        roll: Of the body, positive when it leans to the right [rad].
    """

    time: float
    x: float
    y: float
    yaw: float
    speed: float
    lateral_speed: float
    yaw_rate: float
    steering_angle: float
    roll: float


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """The moments of a manoeuvre in arrays, a row each update of the car.

    Attributes:
        time: Since the start of the recording, shape (T,) [s].
        x: Rear-axle centre, world frame, shape (T,) [m].
        y: Rear-axle centre, world frame, shape (T,) [m].
        yaw: Heading, without jumps, shape (T,) [rad].
        speed: Forward velocity of the centre of gravity, shape (T,) [m/s].
        lateral_speed: Its velocity to the left, shape (T,) [m/s].
        yaw_rate: Counter-clockwise, shape (T,) [rad/s].
        steering_angle: Centre angle of the front wheels, positive to the left, shape (T,) [rad].
        roll: Of the body, positive when it leans to the right, shape (T,) [rad].
    """

    time: Float[np.ndarray, " T"]
    x: Float[np.ndarray, " T"]
    y: Float[np.ndarray, " T"]
    yaw: Float[np.ndarray, " T"]
    speed: Float[np.ndarray, " T"]
    lateral_speed: Float[np.ndarray, " T"]
    yaw_rate: Float[np.ndarray, " T"]
    steering_angle: Float[np.ndarray, " T"]
    roll: Float[np.ndarray, " T"]

    @staticmethod
    def of(moments: Sequence[Moment]) -> "Recording":
        """Stack moments.

        Args:
            moments: In the order of time, two or more.
        """
        columns = dict(zip(Moment._fields, np.array(moments).T, strict=True))
        return Recording(**{**columns, "yaw": np.unwrap(columns["yaw"])})

    @property
    def distance(self) -> Float[np.ndarray, " T"]:
        """Length of the path of the rear axle since the start [m]."""
        pieces = np.hypot(np.diff(self.x), np.diff(self.y))
        return np.concatenate([[0.0], np.cumsum(pieces)])

    @property
    def body_slip(self) -> Float[np.ndarray, " T"]:
        """Angle from the car's axis to its velocity at the centre of gravity, positive to the left [rad]."""
        return np.arctan2(self.lateral_speed, self.speed)

    @property
    def centripetal_acceleration(self) -> Float[np.ndarray, " T"]:
        """Speed times yaw rate: the lateral acceleration of steady driving, without noise [m/s2]."""
        return self.speed * self.yaw_rate

    @property
    def lateral_acceleration(self) -> Float[np.ndarray, " T"]:
        """Of the centre of gravity, in the plane of the road, positive to the left [m/s2]."""
        return np.gradient(self.lateral_speed, self.time) + self.centripetal_acceleration

    @property
    def forward_acceleration(self) -> Float[np.ndarray, " T"]:
        """Of the centre of gravity, in the plane of the road [m/s2]."""
        return np.gradient(self.speed, self.time) - self.lateral_speed * self.yaw_rate
