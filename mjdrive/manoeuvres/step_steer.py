"""Step of the steering angle at constant speed (ISO 7401)."""

import math
from typing import NamedTuple

import numpy as np

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar, around
from mjdrive.manoeuvres.plant import Plant, SpeedHold
from mjdrive.manoeuvres.recording import Recording
from mjdrive.manoeuvres.single_track import SingleTrack

SPEED_KMH = 80
ACCELERATION = (
    4.0  # steady lateral acceleration that the step is made for, as ISO 7401 has it [m/s2]
)
SETTLING = 3.0  # straight ahead before the step [s]
DURATION = 4.0  # after it [s]
STEADY_SHARE = 0.15  # of the duration, at its end, that counts as steady [-]
GAIN_SHARE = 0.10  # that the gain may be off the linear model's [-]
RISE = (0.1, 0.3)  # [s]
MOST_OVERSHOOT = 15.0  # [%]


class Step(NamedTuple):
    """A step of the steering angle.

    Attributes:
        speed_kmh: Speed before the step [km/h].
        recording: From the moment of the command.
        single_track: The car as one track.
    """

    speed_kmh: float
    recording: Recording
    single_track: SingleTrack

    @property
    def steady_yaw_rate(self) -> float:
        """In the end [rad/s]."""
        return self._steady(self.recording.yaw_rate)

    @property
    def gain(self) -> float:
        """Steady yaw rate per steering angle [1/s]."""
        return self.steady_yaw_rate / self._steady(self.recording.steering_angle)

    @property
    def start_time(self) -> float:
        """When half of the steering angle is reached: the zero of times in ISO 7401 [s]."""
        angle = self.recording.steering_angle
        return self._first_time(angle, 0.5 * self._steady(angle))

    @property
    def rise_time(self) -> float:
        """From then until 90 % of the steady yaw rate [s]."""
        yaw_rate = self.recording.yaw_rate
        return self._first_time(yaw_rate, 0.9 * self.steady_yaw_rate) - self.start_time

    @property
    def overshoot(self) -> float:
        """By how much the yaw rate exceeds its steady value at most [%]."""
        return 100.0 * (float(self.recording.yaw_rate.max()) / self.steady_yaw_rate - 1.0)

    @property
    def lateral_acceleration(self) -> float:
        """In the end [m/s2]."""
        return self._steady(self.recording.centripetal_acceleration)

    def _steady(self, quantity: np.ndarray) -> float:
        return float(quantity[-round(STEADY_SHARE * len(quantity)) :].mean())

    def _first_time(self, quantity: np.ndarray, value: float) -> float:
        """When a quantity first passes a value, between two rows if need be [s]."""
        after = int(np.argmax(quantity >= value))
        if after == 0:
            return math.nan
        rows = slice(after - 1, after + 1)
        return float(np.interp(value, quantity[rows], self.recording.time[rows]))


def step_angle(
    single_track: SingleTrack, speed: float, acceleration: float = ACCELERATION
) -> float:
    """Steering angle that gives a lateral acceleration by the linear model.

    Args:
        single_track: The car.
        speed: Forward speed [m/s].
        acceleration: Wanted [m/s2].

    Returns:
        Angle [rad].
    """
    return acceleration / (speed * single_track.yaw_rate_gain(speed))


def step(plant: Plant, speed_kmh: float = SPEED_KMH, *, acceleration: float = ACCELERATION) -> Step:
    """Turn the wheel as fast as the steering allows, to where the linear model gives an acceleration, and hold it.

    Args:
        plant: On a flat road.
        speed_kmh: Speed to hold [km/h].
        acceleration: Steady lateral acceleration by the linear model; 4 m/s2, as ISO 7401 has it [m/s2].

    Returns:
        The step.
    """
    speed = speed_kmh / 3.6
    hold = SpeedHold(speed)
    command = step_angle(plant.single_track, speed, acceleration) / plant.max_steering_angle
    plant.place(speed=speed)
    plant.drive(lambda moment: Action(hold(moment), 0.0), duration=SETTLING)
    recording = plant.drive(lambda moment: Action(hold(moment), command), duration=DURATION)
    return Step(speed_kmh, recording, plant.single_track)


def bars(step: Step) -> tuple[Bar, ...]:
    """Hold the response against the linear model and what drivers find good."""
    name = f"step steer, {step.speed_kmh} km/h"
    expected = step.single_track.yaw_rate_gain(step.speed_kmh / 3.6)
    return (
        Bar(
            name,
            "yaw-rate gain",
            step.gain,
            "1/s",
            **around(expected, GAIN_SHARE),
            reason=f"linear single-track model {expected:.2f} 1/s, within 10 %",
        ),
        Bar(name, "time to 90 %", step.rise_time, "s", *RISE, reason="quick, but not a go-kart"),
        Bar(name, "overshoot", step.overshoot, "%", most=MOST_OVERSHOOT, reason="well damped"),
    )
