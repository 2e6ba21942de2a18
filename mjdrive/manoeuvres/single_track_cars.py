"""The single-track models as cars that the manoeuvres can drive, at constant speed."""

import math

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL, Plant
from mjdrive.manoeuvres.recording import Moment
from mjdrive.manoeuvres.single_track import SingleTrack, kinematic_yaw_rate


class SingleTrackCar(Plant):
    """A single-track model with a steering that turns no faster than the car's; pedals do nothing.

    Args:
        single_track: The car as one track.
        max_steering_angle: At full lock [rad].
        steering_rate: How fast the steering angle follows the command [rad/s].
    """

    def __init__(
        self, single_track: SingleTrack, *, max_steering_angle: float, steering_rate: float
    ) -> None:
        super().__init__(single_track, max_steering_angle=max_steering_angle)
        self._turn = steering_rate * UPDATE_INTERVAL
        self.place()

    def place(self, *, speed: float = 0.0) -> None:
        """Put the car at the origin, headed along x, rolling.

        Args:
            speed: Forward speed, kept for good [m/s].
        """
        self._moment = Moment(0.0, 0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0, 0.0)

    def moment(self) -> Moment:
        """How the car moves now."""
        return self._moment

    def advance(self, action: Action) -> None:
        """Drive for one update interval.

        Args:
            action: What to do.
        """
        before = self._moment
        wanted = self.max_steering_angle * min(max(action.steering, -1.0), 1.0)
        angle = before.steering_angle
        angle += min(max(wanted - angle, -self._turn), self._turn)
        lateral_speed, yaw_rate = self._motion(before, angle)
        yaw = before.yaw + 0.5 * UPDATE_INTERVAL * (before.yaw_rate + yaw_rate)
        sideways = lateral_speed - self.single_track.rear * yaw_rate  # at the rear axle
        self._moment = Moment(
            time=before.time + UPDATE_INTERVAL,
            x=before.x
            + UPDATE_INTERVAL * (before.speed * math.cos(yaw) - sideways * math.sin(yaw)),
            y=before.y
            + UPDATE_INTERVAL * (before.speed * math.sin(yaw) + sideways * math.cos(yaw)),
            yaw=yaw,
            speed=before.speed,
            lateral_speed=lateral_speed,
            yaw_rate=yaw_rate,
            steering_angle=angle,
            roll=0.0,
        )

    def _motion(self, before: Moment, angle: float) -> tuple[float, float]:
        """Lateral speed [m/s] and yaw rate [rad/s] an update interval later, by the kinematic model."""
        yaw_rate = kinematic_yaw_rate(before.speed, angle, wheelbase=self.single_track.wheelbase)
        return self.single_track.rear * yaw_rate, yaw_rate


class LinearCar(SingleTrackCar):
    """The linear single-track model with two degrees of freedom."""

    def _motion(self, before: Moment, angle: float) -> tuple[float, float]:
        start: Float[np.ndarray, " 2"] = np.array([before.lateral_speed, before.yaw_rate])
        lateral_speed, yaw_rate = self.single_track.respond(
            before.speed,
            np.array([0.0, UPDATE_INTERVAL]),
            np.array([before.steering_angle, angle]),
            start=start,
        )
        return float(lateral_speed[-1]), float(yaw_rate[-1])
