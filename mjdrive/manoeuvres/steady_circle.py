"""Steady-state cornering (ISO 4138, constant speed with slowly rising steering angle)."""

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from mjdrive.datatypes import Action
from mjdrive.manoeuvres.bars import Bar, around
from mjdrive.manoeuvres.plant import UPDATE_INTERVAL, Plant, SpeedHold
from mjdrive.manoeuvres.recording import Moment, Recording
from mjdrive.manoeuvres.rig import GRAVITY
from mjdrive.manoeuvres.single_track import SingleTrack

SPEEDS_KMH = (30, 50, 80)
RAMP = 0.5  # how fast the lateral acceleration rises while tyres are linear [m/s3]
SETTLING = 3.0  # straight ahead before the ramp [s]
LINEAR_RANGE = (1.0, 4.0)  # lateral acceleration in which gradients are fitted [m/s2]
GRADIENT_SHARE = 0.20  # that the understeer gradient may be off the linear model's [-]
LIMIT = (0.85, 1.0)  # of the lateral acceleration [g]
MOST_JUMP = 0.3  # that the lateral acceleration may change within JUMP_TIME [m/s2]
JUMP_TIME = 0.1  # [s]
PATIENCE = 60.0  # [s]
LARGEST_SLIP = 0.2  # of the rear axle; beyond it the car spins and the manoeuvre ends [rad]
AVERAGED = 0.5  # window of the limit [s]


class Circle(NamedTuple):
    """A slow spiral at one speed, from straight ahead to the limit.

    Attributes:
        speed_kmh: Held speed [km/h].
        recording: Of the ramp.
        single_track: The car as one track.
    """

    speed_kmh: int
    recording: Recording
    single_track: SingleTrack

    @property
    def understeer_gradient(self) -> float:
        """Rise of steering angle beyond Ackermann's with lateral acceleration, tyres linear [rad/(m/s2)]."""
        recording = self.recording
        # Of a car whose tyres do not slip; at 30 km/h its tangent matters.
        ackermann = np.arctan(self.single_track.wheelbase * recording.yaw_rate / recording.speed)
        return self._gradient(recording.steering_angle - ackermann)

    @property
    def roll_gradient(self) -> float:
        """Rise of roll with lateral acceleration, tyres linear [rad/(m/s2)]."""
        return self._gradient(self.recording.roll)

    @property
    def body_slip_gradient(self) -> float:
        """Rise of body slip with lateral acceleration, tyres linear [rad/(m/s2)]."""
        return self._gradient(self.recording.body_slip)

    @property
    def limit(self) -> float:
        """Largest lateral acceleration over half a second [m/s2]."""
        return float(_averaged(self.recording.lateral_acceleration, AVERAGED).max())

    @property
    def largest_jump(self) -> float:
        """Largest change of lateral acceleration from one tenth of a second to the next, up to the limit [m/s2]."""
        acceleration = _averaged(self.recording.lateral_acceleration, JUMP_TIME)
        step = round(JUMP_TIME / UPDATE_INTERVAL)
        rising = acceleration[: int(acceleration.argmax()) + 1]
        return float(np.abs(rising[step:] - rising[:-step]).max())

    def _gradient(self, quantity: Float[np.ndarray, " T"]) -> float:
        acceleration = self.recording.centripetal_acceleration
        # Only on the way up: a car that spins in the end passes the range once more.
        is_before = np.logical_and.accumulate(acceleration < LINEAR_RANGE[1])
        fitted = is_before & (acceleration > LINEAR_RANGE[0])
        if fitted.sum() < 10:
            return math.nan
        return float(np.polyfit(acceleration[fitted], quantity[fitted], 1)[0])


def circle(plant: Plant, speed_kmh: int) -> Circle:
    """Hold a speed and turn the wheel slowly until the car takes no more.

    Args:
        plant: On a flat road.
        speed_kmh: Speed to hold [km/h].

    Returns:
        The circle.
    """
    speed = speed_kmh / 3.6
    hold = SpeedHold(speed)
    lock = plant.max_steering_angle
    rate = RAMP / (speed * plant.single_track.yaw_rate_gain(speed))
    plant.place(speed=speed)
    plant.drive(lambda moment: Action(hold(moment), 0.0), duration=SETTLING)
    recording = plant.drive(
        lambda moment: Action(hold(moment), rate * moment.time / lock),
        duration=min(PATIENCE, lock / rate),
        until=lambda moment: _is_over(moment, plant.single_track.rear, speed),
    )
    return Circle(speed_kmh, recording, plant.single_track)


def _averaged(quantity: Float[np.ndarray, " T"], duration: float) -> Float[np.ndarray, " S"]:
    """Means over a window of some seconds that slides along."""
    window = round(duration / UPDATE_INTERVAL)
    return np.convolve(quantity, np.full(window, 1 / window), "valid")


def _is_over(moment: Moment, rear: float, speed: float) -> bool:
    sideways = moment.lateral_speed - rear * moment.yaw_rate
    return abs(math.atan2(sideways, moment.speed)) > LARGEST_SLIP or moment.speed < 0.5 * speed


def bars(circle: Circle) -> tuple[Bar, ...]:
    """Hold gradient and limit against the linear model and the friction of the road."""
    name = f"steady circle, {circle.speed_kmh} km/h"
    to_deg_per_g = math.degrees(1.0) * GRAVITY
    expected = to_deg_per_g * circle.single_track.understeer_gradient
    return (
        Bar(
            name,
            "understeer gradient",
            to_deg_per_g * circle.understeer_gradient,
            "deg/g",
            **around(expected, GRADIENT_SHARE),
            reason=f"linear single-track model {expected:.2f} deg/g, within 20 %",
        ),
        Bar(name, "limit", circle.limit / GRAVITY, "g", *LIMIT, reason="dry road, mu = 1"),
        Bar(
            name,
            "largest jump in 0.1 s",
            circle.largest_jump,
            "m/s2",
            most=MOST_JUMP,
            reason=f"the ramp itself is {RAMP * JUMP_TIME:.2f} m/s2",
        ),
    )
